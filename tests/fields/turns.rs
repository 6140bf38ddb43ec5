//! Groups that turn as rigid bodies: torsion, beside its closed form.
//! (Timoshenko & Goodier, Theory of Elasticity, § 101.)

use std::f64::consts::PI;

use dpana::body::{CellKind, Facet, Group, Mesh};
use dpana::scene::{SceneContact, SceneLoad, SceneObstacle, SceneSupport, SceneTurn};
use dpana::{Scene, Solution};
use serde_json::json;

use crate::gaps::read;
use crate::stacks::{body, certified, scene};

/// Radii and length of a hollow bar, E, ν.
const RADII: [f64; 2] = [1.0, 2.0];
pub(crate) const LENGTH: f64 = 3.0;
pub(crate) const YOUNG: f64 = 1000.0;
pub(crate) const POISSON: f64 = 0.25;

/// The bar along z in `around` cells, with groups `bottom`, `top` and `outer`.
pub(crate) fn bar(around: usize) -> Mesh {
    let (across, along) = (around / 8, around / 4);
    let at = |layer: usize, ring: usize, spoke: usize| {
        (layer * (across + 1) + ring) * around + spoke % around
    };
    let mut nodes = Vec::new();
    for layer in 0..=along {
        for ring in 0..=across {
            for spoke in 0..around {
                let r = RADII[0] + (RADII[1] - RADII[0]) * ring as f64 / across as f64;
                let (sin, cos) = (2.0 * PI * spoke as f64 / around as f64).sin_cos();
                nodes.push([r * cos, r * sin, LENGTH * layer as f64 / along as f64]);
            }
        }
    }
    let mut mesh = Mesh::new(3, nodes);
    let face = |layer, ring, spoke| {
        [
            at(layer, ring, spoke),
            at(layer, ring + 1, spoke),
            at(layer, ring + 1, spoke + 1),
            at(layer, ring, spoke + 1),
        ]
    };
    let [mut bottom, mut top, mut outer] = [const { Vec::new() }; 3];
    for spoke in 0..around {
        for ring in 0..across {
            for layer in 0..along {
                let cell = [face(layer, ring, spoke), face(layer + 1, ring, spoke)].concat();
                mesh.push_cell(CellKind::Hex8, &cell);
            }
            bottom.push(Facet {
                nodes: face(0, ring, spoke).to_vec(),
            });
            top.push(Facet {
                nodes: face(along, ring, spoke).to_vec(),
            });
        }
        for layer in 0..along {
            let nodes = [
                (layer, spoke),
                (layer, spoke + 1),
                (layer + 1, spoke + 1),
                (layer + 1, spoke),
            ];
            outer.push(Facet {
                nodes: nodes.map(|(l, s)| at(l, across, s)).to_vec(),
            });
        }
    }
    for (name, facets) in [("bottom", bottom), ("top", top), ("outer", outer)] {
        mesh.groups.insert(name.to_owned(), Group::Facets(facets));
    }
    mesh
}

/// G J / L.
pub(crate) fn stiffness() -> f64 {
    let shear = YOUNG / (2.0 * (1.0 + POISSON));
    shear * PI / 2.0 * (RADII[1].powi(4) - RADII[0].powi(4)) / LENGTH
}

fn about_z(angle: f64) -> SceneTurn {
    SceneTurn {
        angle,
        point: vec![0.0, 0.0, 5.0],
        direction: Some(vec![0.0, 0.0, 3.0]),
    }
}

/// The bar with its bottom stuck to the floor by friction, its top pushed down and turned.
fn turned(around: usize, angle: f64) -> Solution {
    let bar = body("bar", bar(around), YOUNG, POISSON);
    let down = [Some(0.0), Some(0.0), Some(-0.01)];
    let bar = bar.with_support(SceneSupport::turned("top", &down, about_z(angle)));
    let floor = SceneObstacle::plane(&[0.0; 3], &[0.0, 0.0, 1.0]);
    certified(&scene(
        vec![bar],
        vec![SceneContact::on(floor, "bottom", 3.0)],
    ))
    .0
}

#[test]
fn friction_carries_the_torque_of_a_turned_bar() {
    let angle = 1e-3;
    let errors = [24, 48].map(|around| {
        let solution = turned(around, angle);
        let torque = -solution.balances()[0].contact.moment[2];
        let supports = solution.balances()[0].supports.moment[2];
        assert!((torque + supports - 2.0 * torque).abs() < 1e-9 * torque.abs());
        (torque.abs() / (stiffness() * angle) - 1.0).abs()
    });
    // A polygon of n sides: second order.
    assert!(
        errors[1] < 0.01 && errors[0] > 3.0 * errors[1],
        "{errors:?}"
    );
}

#[test]
fn a_moment_turns_the_bar_by_its_angle_and_the_other_way_with_its_sign() {
    let wall = SceneObstacle::plane(&[9.0, 0.0, 0.0], &[-1.0, 0.0, 0.0]);
    for sign in [1.0, -1.0] {
        let bar = body("bar", bar(48), YOUNG, POISSON)
            .with_support(SceneSupport::of("bottom", &[Some(0.0); 3]))
            .with_load(SceneLoad::moment(
                "top",
                &[0.0, 0.0, sign * stiffness() * 1e-3],
            ));
        let contact = SceneContact::on(wall.clone(), "outer", 0.0);
        let (solution, _) = certified(&scene(vec![bar], vec![contact]));
        let u = solution.displacement_near(0, [2.0, 0.0, LENGTH]).unwrap();
        // u_y = θ r at (r, 0).
        assert!((u[1] / (sign * 2e-3) - 1.0).abs() < 0.015, "{u:?}");
        assert!(u[0].abs() < 1e-5 && u[2].abs() < 1e-5);
    }
}

#[test]
fn a_turned_block_that_nothing_holds_elsewhere_turns_as_a_whole() {
    // In the plane: u = θ z × (x − c), free of stress; a factor turns it back.
    let block = json!({
        "bodies": [{
            "mesh": {"rectangle": {"x": [0, 2], "y": [0, 1], "cells": [4, 2]}},
            "model": "plane_strain",
            "materials": [{"young": 1000, "poisson": 0.3}],
            "supports": [{"group": "top", "displacement": [0.25, 0.5],
                          "turn": {"angle": 0.01, "point": [1, 2]}}]
        }],
        "contacts": [{"group": "bottom", "friction": 0,
                      "obstacle": {"plane": {"point": [0, -9], "normal": [0, 1]}}}],
        "steps": {"at": [1, 2], "factors": {"bodies[0].supports[0]": [[1, 5], [2, -1]]}}
    });
    let solution = dpana::solve(&read(&block)).unwrap();
    for [x, y] in [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0]] {
        let u = solution.displacement_near(0, [x, y, 0.0]).unwrap();
        let expected = [-(0.25 - 0.01 * (y - 2.0)), -(0.5 + 0.01 * (x - 1.0))];
        assert!((u[0] - expected[0]).abs() < 1e-13 && (u[1] - expected[1]).abs() < 1e-13);
    }
    assert!(solution.extremes()[0].von_mises.value < 1e-10);
}

#[test]
fn turns_that_make_no_sense_are_refused_by_place() {
    let refused = |mesh: &str, support: serde_json::Value, model: &str| {
        let mesh: serde_json::Value = serde_json::from_str(mesh).unwrap();
        let text = json!({
            "bodies": [{"mesh": mesh, "model": model, "supports": [support],
                        "materials": [{"young": 1, "poisson": 0.3}]}],
            "contacts": [{"group": "bottom", "friction": 0,
                          "obstacle": {"plane": {"point": [0, 0], "normal": [0, 1]}}}]
        });
        match Scene::from_json(&text.to_string(), "") {
            Ok(scene) => scene.mechanics().unwrap_err().to_string(),
            Err(error) => error.to_string(),
        }
    };
    let plane = r#"{"rectangle": {"x": [0, 2], "y": [0, 1], "cells": [2, 2]}}"#;
    for (support, model, says) in [
        (
            json!({"group": "top", "displacement": [0, 0], "turn": {"angle": 1, "point": [0]}}),
            "plane_strain",
            "supports[0].turn.point: expected 2 entries, found 1",
        ),
        (
            json!({"group": "top", "displacement": [0, 0],
                   "turn": {"angle": 1, "point": [0, 0], "direction": [0, 0, 1]}}),
            "plane_strain",
            "in 2D the axis is out of the plane",
        ),
        (
            json!({"group": "top", "displacement": [0, 0], "turn": {"angle": 1, "point": [0, 0]}}),
            "axisymmetric",
            "turns about no axis",
        ),
        (
            json!({"at": [0, 1], "displacement": [0, 0], "turn": {"angle": 1, "point": [0, 0]}}),
            "plane_strain",
            "beside `group` perhaps `turn`",
        ),
    ] {
        let found = refused(plane, support, model);
        assert!(found.contains(says), "{says}: {found}");
    }
}
