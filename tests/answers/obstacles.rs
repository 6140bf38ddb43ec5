//! Where an obstacle stands, and how it is described, does not change the mechanics.

use std::f64::consts::PI;

use crate::square;
use dpana::body::{CellKind, Mesh, box_mesh, graded, rectangle};
use dpana::scene::{MeshSource, SceneContact, SceneObstacle, SceneSupport};
use dpana::{Scene, Solution, Status, solve};
use nalgebra::{Rotation3, Vector3};
use serde_json::json;

/// A rotation about `axis` and a shift.
struct Motion {
    turn: Rotation3<f64>,
    shift: Vector3<f64>,
}

impl Motion {
    fn new(axis: [f64; 3], angle: f64, shift: [f64; 3]) -> Self {
        let axis = nalgebra::Unit::new_normalize(Vector3::from(axis));
        Self {
            turn: Rotation3::from_axis_angle(&axis, angle),
            shift: Vector3::from(shift),
        }
    }

    fn place(&self, position: [f64; 3]) -> [f64; 3] {
        (self.turn * Vector3::from(position) + self.shift).into()
    }

    fn turn(&self, vector: [f64; 3]) -> [f64; 3] {
        (self.turn * Vector3::from(vector)).into()
    }
}

/// A body of E = 1000, ν = 0.3 on an obstacle, its bottom the contact surface, its top moved by a
/// vector; all of it carried along by a motion.
struct Pressing {
    mesh: Mesh,
    top: [f64; 3],
    friction: f64,
    obstacle: fn(&Motion) -> SceneObstacle,
}

impl Pressing {
    fn solve(&self, motion: &Motion) -> Solution {
        let dimension = self.mesh.dimension;
        let scene = json!({
            "bodies": [{
                "mesh": {"file": "given in code"},
                "model": if dimension == 2 { "plane_strain" } else { "solid" },
                "materials": [{"young": 1000, "poisson": 0.3}]
            }],
            "contacts": []
        });
        let mut scene = Scene::from_json(&scene.to_string(), "").unwrap();
        let mut mesh = self.mesh.clone();
        for node in &mut mesh.nodes {
            *node = motion.place(*node);
        }
        scene.bodies[0].mesh = MeshSource::Given(mesh);
        let top = motion.turn(self.top)[..dimension].to_vec();
        scene.bodies[0].supports.push(SceneSupport::Group {
            group: "top".into(),
            displacement: top.into_iter().map(Some).collect(),
        });
        let obstacle = (self.obstacle)(motion);
        scene
            .contacts
            .push(SceneContact::on(obstacle, "bottom", self.friction));
        certified(&scene)
    }
}

fn certified(scene: &Scene) -> Solution {
    let solution = solve(scene).unwrap();
    assert_eq!(solution.status(), Status::Certified);
    solution
}

/// Displacement per node, padded to 3D.
fn nodal(solution: &Solution) -> Vec<[f64; 3]> {
    let chunks = solution.displacements()[0].chunks(solution.bodies()[0].mesh.dimension);
    let padded = |u: &[f64]| [u[0], u[1], u.get(2).copied().unwrap_or(0.0)];
    chunks.map(padded).collect()
}

/// Largest difference of nodal vectors, relative to the largest expected one.
fn difference(found: &[[f64; 3]], expected: &[[f64; 3]]) -> f64 {
    assert_eq!(found.len(), expected.len());
    let pairs = found.iter().zip(expected);
    let most = pairs.map(|(a, b)| (Vector3::from(*a) - Vector3::from(*b)).norm());
    let size = expected.iter().map(|b| Vector3::from(*b).norm());
    most.fold(0.0, f64::max) / size.fold(0.0, f64::max)
}

/// Certified to 1e-12; two digits for the condition of G, about the number of contacts across.
const SAME: f64 = 1e-10;

fn block_2d(cells: usize) -> Mesh {
    let lines = graded(-1.0, 1.0, cells, 1.0).unwrap();
    rectangle(
        &lines,
        &graded(0.0, 2.0, cells, 1.0).unwrap(),
        CellKind::Quad4,
    )
    .unwrap()
}

fn block_3d(cells: usize) -> Mesh {
    let lines = graded(-1.0, 1.0, cells, 1.0).unwrap();
    let heights = graded(0.0, 2.0, cells, 1.0).unwrap();
    box_mesh(&lines, &lines, &heights, CellKind::Hex8).unwrap()
}

/// The scene moved by every motion has the moved answer, with the same states.
fn check_moved(scene: &Pressing, motions: &[Motion]) {
    let still = Motion::new([0.0, 0.0, 1.0], 0.0, [0.0; 3]);
    let reference = scene.solve(&still);
    let totals = reference.report().unwrap().totals;
    assert!(totals.stick > 0 && totals.slip > 0, "{totals:?}");
    for motion in motions {
        let found = scene.solve(motion);
        let expected: Vec<_> = nodal(&reference)
            .into_iter()
            .map(|u| motion.turn(u))
            .collect();
        let change = difference(&nodal(&found), &expected);
        assert!(change < SAME, "{change:e}");
        let (found, expected) = (found.outcome(), reference.outcome());
        assert_eq!(found.verdict.status, expected.verdict.status);
        assert!(found.work.sweeps.abs_diff(expected.work.sweeps) <= 1);
    }
}

#[test]
fn a_square_on_a_tilted_line_or_a_moved_circle_has_the_turned_answer() {
    let angles = [0.3, PI / 2.0, -2.0];
    let motions = angles.map(|angle| Motion::new([0.0, 0.0, 1.0], angle, [0.7, -0.2, 0.0]));
    let line = |motion: &Motion| SceneObstacle::Plane {
        point: motion.place([5.0, 0.0, 0.0])[..2].to_vec(),
        normal: motion.turn([0.0, 3.0, 0.0])[..2].to_vec(),
    };
    let circle = |motion: &Motion| SceneObstacle::Circle {
        center: motion.place([0.0, -5.0, 0.0])[..2].to_vec(),
        radius: 5.0,
    };
    for obstacle in [line as fn(&Motion) -> SceneObstacle, circle] {
        let scene = Pressing {
            mesh: block_2d(24),
            top: [0.004, -0.01, 0.0],
            friction: 0.3,
            obstacle,
        };
        check_moved(&scene, &motions);
    }
}

#[test]
fn a_cube_on_a_tilted_plane_a_cylinder_or_a_sphere_has_the_turned_answer() {
    let motions = [
        Motion::new([1.0, 2.0, -0.5], 0.8, [0.1, 0.2, 0.3]),
        Motion::new([1.0, 0.0, 0.0], PI / 2.0, [0.0; 3]),
        Motion::new([1.0, 1.0, 1.0], 2.0 * PI / 3.0, [-3.0, 0.0, 0.0]),
    ];
    let plane = |motion: &Motion| SceneObstacle::Plane {
        point: motion.place([0.5, -4.0, 0.0]).to_vec(),
        normal: motion.turn([0.0, 0.0, 0.25]).to_vec(),
    };
    let cylinder = |motion: &Motion| SceneObstacle::Cylinder {
        center: motion.place([0.0, 3.0, -8.0]).to_vec(),
        axis: motion.turn([0.0, -2.0, 0.0]).to_vec(),
        radius: 8.0,
    };
    let sphere = |motion: &Motion| SceneObstacle::Sphere {
        center: motion.place([0.0, 0.0, -12.0]).to_vec(),
        radius: 12.0,
    };
    for obstacle in [plane as fn(&Motion) -> SceneObstacle, cylinder, sphere] {
        let scene = Pressing {
            mesh: block_3d(6),
            top: [0.01, 0.003, -0.04],
            friction: 0.3,
            obstacle,
        };
        check_moved(&scene, &motions);
    }
}

#[test]
fn a_slice_on_a_cylinder_is_the_plane_strain_body_on_its_circle() {
    // One cell of depth, held along y at both ends: strain is plane, cell by cell.
    let plane = Pressing {
        mesh: block_2d(24),
        top: [0.004, -0.01, 0.0],
        friction: 0.3,
        obstacle: |_| SceneObstacle::Circle {
            center: vec![0.0, -5.0],
            radius: 5.0,
        },
    };
    let still = Motion::new([0.0, 0.0, 1.0], 0.0, [0.0; 3]);
    let plane = plane.solve(&still);
    let scene = json!({
        "bodies": [{
            "mesh": {"box": {"x": [-1, 1], "y": [0, 1], "z": [0, 2], "cells": [24, 1, 24]}},
            "materials": [{"young": 1000, "poisson": 0.3}],
            "supports": [
                {"group": "front", "displacement": [null, 0, null]},
                {"group": "back", "displacement": [null, 0, null]},
                {"group": "top", "displacement": [0.004, null, -0.01]}
            ]
        }],
        "contacts": [{
            "group": "bottom", "friction": 0.3,
            "obstacle": {"cylinder": {"center": [0, 0, -5], "axis": [0, 1, 0], "radius": 5}}
        }]
    });
    let slice = certified(&Scene::from_json(&scene.to_string(), "").unwrap());
    let mesh = &slice.bodies()[0].mesh;
    for (position, u) in mesh.nodes.iter().zip(nodal(&slice)) {
        let expected = plane
            .displacement_near(0, [position[0], position[2], 0.0])
            .unwrap();
        let (x, z) = (u[0] - expected[0], u[2] - expected[1]);
        assert!(u[1] == 0.0 && x.hypot(z) < SAME * 0.01, "{position:?}");
    }
    let (slice, plane) = (
        slice.report().unwrap().totals,
        plane.report().unwrap().totals,
    );
    assert!((slice.normal / plane.normal - 1.0).abs() < SAME);
    assert_eq!((slice.stick, slice.slip), (2 * plane.stick, 2 * plane.slip));
}

/// The SSNV128 square on another obstacle.
fn displaced(obstacle: SceneObstacle) -> Vec<[f64; 3]> {
    let mut scene = square::scene(32, 0.2, 1.0);
    scene.contacts[0].obstacle = Some(obstacle);
    nodal(&certified(&scene))
}

fn plane(gap: f64) -> SceneObstacle {
    SceneObstacle::Plane {
        point: vec![0.0, -gap],
        normal: vec![0.0, 1.0],
    }
}

#[test]
fn a_gap_of_a_millionth_of_a_millionth_of_the_size_is_none() {
    let flush = displaced(plane(0.0));
    // 4e-14 m beside displacements of 4e-5 m.
    for gap in [0.04e-12, -0.04e-12] {
        let change = difference(&displaced(plane(gap)), &flush);
        assert!(change < 1e-9, "{change:e}");
    }
}

#[test]
fn a_circle_becomes_a_line_as_its_radius_grows() {
    // The gap that curvature opens, (x − x₀)²/(2R), is the only difference: first order in 1/R.
    let flat = displaced(plane(0.0));
    let [coarse, fine] = [1e4, 1e5].map(|radius| {
        let circle = SceneObstacle::Circle {
            center: vec![0.02, -radius],
            radius,
        };
        difference(&displaced(circle), &flat)
    });
    // One of the twenty contacts that slip may change its state on the way: 5 %. The gap is up to
    // (20 mm)²/(2R) = 2e-9 m beside displacements of 3e-5 m.
    assert!((coarse / fine - 10.0).abs() < 0.5, "{coarse:e} {fine:e}");
    assert!(fine < 1e-4);
}

#[test]
fn a_body_fitted_with_interference_carries_its_squeeze() {
    // The square's 40 mm stand between a ceiling that holds still and a plane 10 µm too high, free
    // to widen without friction: σ = E/(1 − ν²) · 10 µm/40 mm in plane strain.
    let mut scene = square::scene(8, 0.2, 0.0);
    scene.bodies[0].loads.clear();
    scene.bodies[0].supports[1] = SceneSupport::Group {
        group: "top".into(),
        displacement: vec![None, Some(0.0)],
    };
    scene.contacts[0].obstacle = Some(plane(-1e-5));
    let report = certified(&scene).report().unwrap();
    let expected = 1.3e11 / (1.0 - 0.04) * 1e-5 / 0.04;
    // 10 µm as a difference of 40 mm is rounded to 1e-12 of itself.
    for contact in &report.contacts {
        let pressure = contact.pressure.unwrap();
        assert!((pressure / expected - 1.0).abs() < 1e-11, "{contact:?}");
    }
}

/// A unit square of n cells a side on a profile, its top moved down.
fn on_profile(points: &[[f64; 2]], n: usize, down: f64) -> Solution {
    let lines = graded(0.0, 1.0, n, 1.0).unwrap();
    let scene = json!({
        "bodies": [{
            "mesh": {"file": "given in code"},
            "model": "plane_strain",
            "materials": [{"young": 1000, "poisson": 0.3}],
            "supports": [{"group": "top", "displacement": [0, -down]}]
        }],
        "contacts": [{"group": "bottom", "friction": 0.0, "obstacle": {"profile": {"points": points}}}]
    });
    let mut scene = Scene::from_json(&scene.to_string(), "").unwrap();
    scene.bodies[0].mesh = MeshSource::Given(rectangle(&lines, &lines, CellKind::Quad4).unwrap());
    solve(&scene).unwrap()
}

#[test]
fn contacts_over_a_wall_stay_open_and_need_no_normal() {
    // What presses is the flat top, however steep its walls are.
    let force = |wall: f64| {
        let points = [
            [-1.0, -0.5],
            [0.46 - wall, -0.5],
            [0.46, 0.0],
            [0.54, 0.0],
            [0.54 + wall, -0.5],
            [2.0, -0.5],
        ];
        let solution = on_profile(&points, 20, 0.01);
        assert_eq!(solution.status(), Status::Certified, "{wall}");
        solution.report().unwrap().totals.normal
    };
    let gentle = force(0.1);
    for wall in [0.03, 0.01, 0.003] {
        assert!((force(wall) / gentle - 1.0).abs() < 1e-9, "{wall}");
    }
}

#[test]
fn a_node_over_a_corner_is_pressed_along_the_normal_of_its_own_face() {
    // A ridge below the middle node, or as far beside it as drawings differ: the force is straight up, and the same.
    for slope in [0.02, 0.5, 3.0] {
        let force = |aside: f64| {
            let points = [
                [-1.0, -1.5 * slope],
                [0.5 + aside, 0.0],
                [2.0, -1.5 * slope],
            ];
            let solution = on_profile(&points, 4, 0.01);
            assert_eq!(solution.status(), Status::Certified);
            solution.report().unwrap().totals.contact_force
        };
        let below = force(0.0);
        assert!(below[1] > 1.0 && below[0].abs() < 1e-9, "{slope} {below:?}");
        // Sides steeper than 60 degrees are not looked at: beside such an edge the judge sees nothing that touches.
        let asides = [1e-9, -1e-7, 1e-6].into_iter();
        for aside in asides.filter(|_| slope < 1.7) {
            let beside = force(aside);
            assert!(
                (beside[1] / below[1] - 1.0).abs() < 0.01,
                "{slope} {aside} {beside:?}"
            );
            assert!(
                beside[0].abs() < 0.01 * below[1],
                "{slope} {aside} {beside:?}"
            );
        }
    }
}

#[test]
fn an_obstacle_that_pokes_in_between_contacts_is_told() {
    let ridge = [[-1.0, -0.15], [0.5, 0.0], [2.0, -0.15]];
    let told = |n: usize| {
        let report = on_profile(&ridge, n, 0.01).report().unwrap();
        report
            .notes
            .iter()
            .any(|note| note.contains("in each other between contacts"))
    };
    assert!(told(5) && !told(40));
}
