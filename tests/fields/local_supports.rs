//! Supports in axes of their own, beside the same scene in global axes and closed forms.
//! (Timoshenko & Goodier, Theory of Elasticity, § 28.)

use dpana::body::{CellKind, Group, Mesh, graded};
use dpana::report::Report;
use dpana::scene::{SceneAxis, SceneContact, SceneLoad, SceneObstacle, SceneSupport};
use dpana::{Error, Solution, solve};
use nalgebra::{Rotation3, Vector3};

use crate::stacks::{block, body, certified, scene};

fn turned(mut mesh: Mesh, turn: Rotation3<f64>) -> Mesh {
    for node in &mut mesh.nodes {
        *node = (turn * Vector3::from(*node)).into();
    }
    mesh
}

/// A block of twice the width as its half beyond `x = 0` if it is halved, pressed and turned; distances along x
/// stay those of the halves.
fn pressed(kind: CellKind, halved: bool, turn: Rotation3<f64>) -> Solution {
    let axes = kind.dimension();
    let mut half = block(kind, [0.0; 3], [1.0, 1.0, 1.0], [4, 3, 3]);
    let cut = half.nodes.iter().map(|x| x[0] == 0.0).collect::<Vec<_>>();
    let mut mesh = half.clone();
    if !halved {
        // The mirror image, which runs the other way round.
        let mut image = vec![0; half.nodes.len()];
        for (node, x) in half.nodes.iter().enumerate() {
            image[node] = if cut[node] { node } else { mesh.nodes.len() };
            if !cut[node] {
                mesh.nodes.push([-x[0], x[1], x[2]]);
            }
        }
        for cell in half.cells() {
            let nodes: Vec<usize> = cell.nodes.iter().map(|node| image[*node]).collect();
            let order: &[usize] = match axes {
                2 => &[1, 0, 3, 2],
                _ => &[1, 0, 3, 2, 5, 4, 7, 6],
            };
            let nodes: Vec<usize> = order.iter().map(|k| nodes[*k]).collect();
            mesh.push_cell(kind, &nodes);
        }
        mesh.groups.clear();
        half = mesh;
    }
    half.groups.clear();
    let up = axes - 1;
    let left = if halved { 0.0 } else { -1.0 };
    let mesh = half
        .with_surface("cut", |x| x[0] == left)
        .and_then(|mesh| mesh.with_surface("bottom", |x| x[up] == 0.0))
        .and_then(|mesh| mesh.with_surface("top", |x| x[up] == 1.0));
    let mesh = turned(mesh.unwrap(), turn);
    let vector = |axis: usize, size: f64| {
        let moved = turn * Vector3::ith(axis, size);
        moved.as_slice()[..axes].to_vec()
    };
    let down = vector(up, -0.01);
    let down: Vec<Option<f64>> = down.into_iter().map(Some).collect();
    let mut body = body("block", mesh, 1000.0, 0.3).with_support(SceneSupport::of("top", &down));
    if halved {
        body = body.with_support(SceneSupport::normal("cut", 0.0));
    }
    let floor = SceneObstacle::plane(&vec![0.0; axes], &vector(up, 1.0));
    let contact = SceneContact::on(floor, "bottom", 0.1);
    certified(&scene(vec![body], vec![contact])).0
}

/// Pressure and friction over area of the contacts at `x >= 0`, by their place in the straight scene.
fn tractions(solution: &Solution, turn: Rotation3<f64>) -> Vec<([i64; 3], f64, f64)> {
    let report = solution.report().unwrap();
    let mut found: Vec<_> = report
        .contacts
        .iter()
        .map(|contact| {
            let mut x = [0.0; 3];
            x[..contact.position.len()].copy_from_slice(&contact.position);
            let x = turn.inverse() * Vector3::from(x);
            let place = [x.x, x.y, x.z].map(|x| (1e6 * x).round() as i64);
            let friction = contact.friction_traction.iter().flatten();
            let friction = friction.fold(0.0_f64, |sum, t| sum.hypot(*t));
            (place, contact.pressure.unwrap(), friction)
        })
        .filter(|(place, ..)| place[0] >= 0)
        .collect();
    found.sort_by_key(|(place, ..)| *place);
    found
}

#[test]
fn half_a_model_on_an_inclined_plane_of_symmetry_is_the_whole_one() {
    for (kind, axis) in [
        (CellKind::Quad4, [0.0, 0.0, 1.0]),
        (CellKind::Hex8, [0.6, 0.0, 0.8]),
    ] {
        let still = Rotation3::identity();
        let turn = Rotation3::from_scaled_axis(Vector3::from(axis) * 0.4);
        let whole = tractions(&pressed(kind, false, still), still);
        let half = tractions(&pressed(kind, true, turn), turn);
        assert_eq!(half.len(), whole.len());
        let largest = whole.iter().fold(0.0_f64, |most, (_, p, _)| most.max(*p));
        for ((place, p, t), (at, p0, t0)) in half.iter().zip(&whole) {
            assert_eq!(place, at);
            // The tolerance of the solve and the condition of G.
            assert!(
                (p - p0).abs() < 1e-8 * largest,
                "{kind:?} {place:?} {p} {p0}"
            );
            assert!(
                (t - t0).abs() < 1e-8 * largest,
                "{kind:?} {place:?} {t} {t0}"
            );
        }
        // Some of it slides.
        assert!(half.iter().any(|(_, p, t)| (t / p - 0.1).abs() < 1e-6));
    }
}

/// A roof and what stands on it, cells that do not match, each beyond `x = 0` only if halved, and turned.
fn on_a_roof(kind: CellKind, slope: f64, halved: bool, turn: Rotation3<f64>) -> Report {
    let part = |width: f64, cells: usize, below: bool| {
        let (from, cells) = match halved {
            true => (0.0, cells),
            false => (-width, 2 * cells),
        };
        let (xs, heights) = (graded(from, width, cells, 1.0), graded(0.0, 1.0, 4, 1.0));
        let mut mesh = dpana::body::rectangle(&xs.unwrap(), &heights.unwrap(), kind).unwrap();
        for x in &mut mesh.nodes {
            let roof = slope * x[0].abs();
            x[1] = match below {
                true => (1.0 + roof) * x[1] - 1.0,
                false => roof + (1.5 - roof) * x[1],
            };
        }
        turned(mesh, turn)
    };
    let vector = |x: f64, y: f64| (turn * Vector3::new(x, y, 0.0)).as_slice()[..2].to_vec();
    let fixed = [Some(0.0), Some(0.0)];
    let mut upper =
        body("upper", part(1.0, 5, false), 1000.0, 0.3).with_load(SceneLoad::pressure("top", 10.0));
    let mut lower = body("lower", part(1.5, 7, true), 2000.0, 0.3)
        .with_support(SceneSupport::of("bottom", &fixed));
    if halved {
        upper = upper.with_support(SceneSupport::along("left", &vector(1.0, 0.0), 0.0));
        lower = lower.with_support(SceneSupport::along("left", &vector(1.0, 0.0), 0.0));
    }
    let contact = SceneContact::between(["upper", "bottom"], ["lower", "top"], 0.3);
    certified(&scene(vec![upper, lower], vec![contact])).1
}

#[test]
fn half_of_a_roof_under_its_load_is_the_whole_whatever_meets_at_the_ridge() {
    for kind in [CellKind::Quad4, CellKind::Quad8, CellKind::Tri6] {
        for slope in [0.0, 0.3, -0.3] {
            let whole = on_a_roof(kind, slope, false, Rotation3::identity())
                .totals
                .normal;
            for angle in [0.0, 0.4] {
                let turn = Rotation3::from_scaled_axis(Vector3::z() * angle);
                let half = on_a_roof(kind, slope, true, turn).totals.normal;
                // Diagonals of triangles are not mirrored.
                let close = if kind == CellKind::Tri6 { 1e-3 } else { 1e-8 };
                let off = 2.0 * half / whole - 1.0;
                assert!(off.abs() < close, "{kind:?} {slope} {angle}: {off:e}");
            }
        }
    }
}

/// A sector of a ring from 1 to 2 m between two angles.
pub(crate) fn sector(kind: CellKind, cells: [usize; 2], angles: [f64; 2]) -> Mesh {
    let radii = graded(1.0, 2.0, cells[0], 1.0).unwrap();
    let around = graded(angles[0], angles[1], cells[1], 1.0).unwrap();
    let mut mesh = dpana::body::rectangle(&radii, &around, kind).unwrap();
    for x in &mut mesh.nodes {
        let (sin, cos) = x[1].sin_cos();
        *x = [x[0] * cos, x[0] * sin, 0.0];
    }
    mesh
}

/// In the bore, touching nothing.
fn shaft() -> SceneObstacle {
    SceneObstacle::Circle {
        center: vec![0.0, 0.0],
        radius: 0.5,
    }
}

/// Of E = 1000 Pa, ν = 0.3 in plane strain under 10 Pa in the bore, u_r at r. (§ 28)
fn lame(r: f64) -> f64 {
    1.3 * 10.0 / (1000.0 * 3.0) * (0.4 * r + 4.0 / r)
}

#[test]
fn a_sector_between_planes_through_the_axis_widens_as_the_whole_ring() {
    let centre = || SceneAxis {
        point: vec![0.0, 0.0],
        direction: None,
    };
    let radial = |solution: &Solution, angle: f64| {
        let at = [angle.cos(), angle.sin(), 0.0];
        let u = solution.displacement_near(0, at).unwrap();
        [u[0] * at[0] + u[1] * at[1], u[1] * at[0] - u[0] * at[1]]
    };
    let errors = [4, 8].map(|cells| {
        let mesh = sector(CellKind::Quad4, [cells, cells], [0.2, 0.9]);
        let ring = body("ring", mesh, 1000.0, 0.3)
            .with_support(SceneSupport::around("top", centre(), &[None, Some(0.0)]))
            .with_support(SceneSupport::normal("bottom", 0.0))
            .with_load(SceneLoad::pressure("left", 10.0));
        let contact = SceneContact::on(shaft(), "left", 0.0);
        let (solution, report) = certified(&scene(vec![ring], vec![contact]));
        // Both ends are turned back across the plane: ∫ σ_θ dr = p a of each unit of depth.
        for support in &report.supports {
            let force = support.force.iter().fold(0.0_f64, |sum, f| sum.hypot(*f));
            assert!((force - 10.0).abs() < 0.2, "{force}");
        }
        [0.2, 0.55, 0.9].map(|angle| {
            let [u, across] = radial(&solution, angle);
            assert!(across.abs() < 1e-12);
            (u / lame(1.0) - 1.0).abs()
        })
    });
    for (coarse, fine) in errors[0].iter().zip(errors[1]) {
        assert!(fine < 0.01 && *coarse > 3.5 * fine, "{errors:?}");
    }
}

#[test]
fn a_block_between_slanted_planes_slides_on_a_smooth_floor() {
    // Cells whose axes are no global ones, with contacts along one: uniform pressure, with and without friction.
    for kind in CellKind::LINEAR
        .into_iter()
        .filter(|kind| kind.dimension() == 3)
    {
        for friction in [0.0, 0.3] {
            let mesh = block(kind, [0.0; 3], [1.0; 3], [2; 3]);
            let mesh = turned(mesh, Rotation3::from_axis_angle(&Vector3::z_axis(), 0.5));
            let block = body("block", mesh, 1000.0, 0.3)
                .with_support(SceneSupport::normal("left", 0.0))
                .with_support(SceneSupport::normal("front", 0.0))
                .with_load(SceneLoad::pressure("top", 2.0));
            let floor = SceneObstacle::plane(&[0.0; 3], &[0.0, 0.0, 1.0]);
            let contact = SceneContact::on(floor, "bottom", friction);
            let (_, report) = certified(&scene(vec![block], vec![contact]));
            assert!((report.totals.normal - 2.0).abs() < 1e-9);
        }
    }
}

#[test]
fn a_bore_that_is_widened_by_a_length_answers_with_lames_pressure() {
    let mesh = sector(CellKind::Quad8, [4, 8], [0.2, 0.9]);
    let axis = SceneAxis {
        point: vec![0.0, 0.0],
        direction: None,
    };
    let ring = body("ring", mesh, 1000.0, 0.3)
        .with_support(SceneSupport::around(
            "left",
            axis.clone(),
            &[Some(lame(1.0)), None],
        ))
        .with_support(SceneSupport::around("top", axis, &[None, Some(0.0)]))
        .with_support(SceneSupport::along(
            "bottom",
            &[-0.2_f64.sin(), 0.2_f64.cos()],
            0.0,
        ));
    let contact = SceneContact::on(shaft(), "left", 0.0);
    let (_, report) = certified(&scene(vec![ring], vec![contact]));
    let force = report.supports[0]
        .force
        .iter()
        .fold(0.0_f64, |sum, f| sum.hypot(*f));
    // 10 Pa on the chord of the arc.
    assert!(
        (force / (20.0 * 0.35_f64.sin()) - 1.0).abs() < 1e-3,
        "{force}"
    );
}

#[test]
fn supports_that_contradict_each_other_along_any_direction_are_refused_by_place() {
    let mesh = block(CellKind::Quad4, [0.0; 3], [1.0; 3], [2, 2, 0]);
    let body = body("block", mesh, 1000.0, 0.3)
        .with_support(SceneSupport::of("top", &[Some(0.0), Some(0.1)]))
        .with_support(SceneSupport::along("left", &[1.0, 1.0], 0.0));
    let floor = SceneObstacle::plane(&[0.0, 0.0], &[0.0, 1.0]);
    let contact = SceneContact::on(floor, "bottom", 0.0);
    let found = solve(&scene(vec![body], vec![contact])).unwrap_err();
    let words = found.to_string();
    assert!(matches!(found, Error::NotAccepted { .. }));
    assert!(
        words.contains("supports[1]") && words.contains("supports[0]"),
        "{words}"
    );
}

#[test]
fn a_support_that_drags_a_contact_where_it_is_meant_slips_against_friction() {
    // Between walls that move along, p = E (1−ν)/((1+ν)(1−2ν)) · 0.01; all nodes are dragged, half of them in 3D along
    // both tangents. In the second scene one side alone is.
    let pressure = 1000.0 * 0.7 / (1.3 * 0.4) * 0.01;
    for (kind, group) in [
        (CellKind::Quad4, "all"),
        (CellKind::Quad8, "all"),
        (CellKind::Hex8, "all"),
        (CellKind::Quad4, "left"),
    ] {
        let axes = kind.dimension();
        let mut mesh = block(kind, [0.0; 3], [1.0; 3], [4, 3, 3]);
        let nodes = (0..mesh.nodes.len()).collect();
        mesh.groups.insert("all".to_owned(), Group::Points(nodes));
        let mut along = vec![None; axes];
        along[0] = Some(0.003);
        if axes == 3 {
            along[1] = Some(-0.004);
        }
        let (mut down, mut up) = (vec![None; axes], vec![0.0; axes]);
        (down[axes - 1], up[axes - 1]) = (Some(-0.01), 1.0);
        let block = body("block", mesh, 1000.0, 0.3)
            .with_support(SceneSupport::of(group, &along))
            .with_support(SceneSupport::of("top", &down));
        let floor = SceneObstacle::plane(&vec![0.0; axes], &up);
        let mut contact = SceneContact::on(floor, "bottom", 0.2);
        let refused = solve(&scene(vec![block.clone()], vec![contact.clone()])).unwrap_err();
        assert!(matches!(refused, Error::DraggedContact { .. }), "{refused}");
        contact.dragged = true;
        let (_, report) = certified(&scene(vec![block], vec![contact]));
        for contact in report
            .contacts
            .iter()
            .filter(|c| group == "all" || c.position[0] == 0.0)
        {
            let (p, t) = (
                contact.pressure.unwrap(),
                contact.friction_traction.as_ref().unwrap(),
            );
            let expected = if axes == 3 { [-0.6, 0.8] } else { [-1.0, 0.0] };
            for (t, expected) in t[..axes - 1].iter().zip(expected) {
                assert!(
                    (t - 0.2 * p * expected).abs() < 1e-9 * pressure,
                    "{kind:?} {contact:?}"
                );
            }
            assert!(
                group == "left" || (p / pressure - 1.0).abs() < 1e-9,
                "{kind:?} {p}"
            );
        }
        let support = report.supports[0].force[0];
        assert!((support + report.totals.friction[0]).abs() < 1e-9 * pressure);
    }
}

/// A scene that ships.
pub(crate) fn shipped(name: &str) -> dpana::Scene {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/scenes");
    dpana::Scene::from_file(format!("{folder}/{name}.json")).unwrap()
}

#[test]
fn a_block_between_floor_and_guide_is_a_wedge() {
    // Everything slides: N = ¾⁻¹ (P − μ N), the guide pushes along (0.6, 0.8).
    let (_, report) = certified(&shipped("guide"));
    let normal = 800.0 / (0.75 + 0.1);
    assert!((report.totals.normal / normal - 1.0).abs() < 1e-9);
    let [x, y] = [report.supports[0].force[0], report.supports[0].force[1]];
    assert!(
        (y + normal).abs() < 1e-6 && (x - 0.75 * y).abs() < 1e-6,
        "{x} {y}"
    );
}
