//! What cells can represent comes out exactly: uniform pressure on a rigid plane, whatever
//! the cells, the model and the layers of the body.

use dpana::body::{CellKind, Group, Mesh, box_mesh, graded, rectangle};
use dpana::report::Report;
use dpana::scene::MeshSource;
use dpana::{Scene, Solution, Status, solve};
use serde_json::{Value, json};

const YOUNG: f64 = 1000.0;
const POISSON: f64 = 0.3;

/// The top goes down by this, in metre, on a height of 2 m.
const LOWERED: f64 = 0.004;

/// A block of 3 × 2 (× 1) with graded cells.
fn block(kind: CellKind) -> Mesh {
    let xs = graded(0.0, 3.0, 5, 2.5).unwrap();
    let heights = graded(0.0, 2.0, 4, 0.4).unwrap();
    if kind.dimension() == 2 {
        return rectangle(&xs, &heights, kind).unwrap();
    }
    box_mesh(&xs, &graded(0.0, 1.0, 3, 0.7).unwrap(), &heights, kind).unwrap()
}

/// Bends everything inside.
fn distort(mesh: &mut Mesh) {
    let depth = if mesh.dimension == 3 { 1.0 } else { 0.0 };
    for [x, y, z] in &mut mesh.nodes {
        let (height, depth) = if depth > 0.0 { (*z, *y) } else { (*y, 0.5) };
        let bubble = *x * (3.0 - *x) * height * (2.0 - height) * depth * (1.0 - depth);
        let (across, up) = (*x + 0.1 * bubble, height - 0.2 * bubble);
        *x = across;
        *(if mesh.dimension == 3 { z } else { y }) = up;
    }
}

/// The block on a rigid plane, held by symmetry planes, its top lowered.
fn scene(mesh: Mesh, model: &Value, materials: &Value, friction: f64) -> Scene {
    let (supports, origin, normal) = match mesh.dimension {
        2 => (
            json!([
                {"group": "left", "displacement": [0, null]},
                {"group": "top", "displacement": [null, -LOWERED]}
            ]),
            json!([0, 0]),
            json!([0, 1]),
        ),
        _ => (
            json!([
                {"group": "left", "displacement": [0, null, null]},
                {"group": "front", "displacement": [null, 0, null]},
                {"group": "top", "displacement": [null, null, -LOWERED]}
            ]),
            json!([0, 0, 0]),
            json!([0, 0, 1]),
        ),
    };
    let scene = json!({
        "bodies": [{
            "mesh": {"file": "given in code"}, "model": model,
            "materials": materials, "supports": supports
        }],
        "contacts": [{
            "group": "bottom", "friction": friction,
            "obstacle": {"plane": {"point": origin, "normal": normal}}
        }]
    });
    let mut scene = Scene::from_json(&scene.to_string(), "").unwrap();
    scene.bodies[0].mesh = MeshSource::Given(mesh);
    scene
}

fn certified(scene: &Scene) -> (Solution, Report) {
    let solution = solve(scene).unwrap();
    assert_eq!(solution.status(), Status::Certified);
    let report = solution.report().unwrap();
    (solution, report)
}

/// Every contact carries the pressure and no friction.
fn check_pressure(report: &Report, expected: impl Fn(&[f64]) -> f64) {
    for contact in &report.contacts {
        let (pressure, expected) = (contact.pressure.unwrap(), expected(&contact.position));
        assert!(
            (pressure - expected).abs() < 1e-12 * expected,
            "{contact:?}"
        );
        let friction = contact.friction_traction.as_ref().unwrap();
        assert!(
            friction.iter().all(|q| q.abs() < 1e-12 * expected),
            "{contact:?}"
        );
    }
}

/// The displacement of every node is `expected(position)`.
fn check_displacement(solution: &Solution, expected: impl Fn([f64; 3]) -> [f64; 3]) {
    let mesh = &solution.bodies()[0].mesh;
    let nodal = solution.displacements()[0].chunks(mesh.dimension);
    for (&position, found) in mesh.nodes.iter().zip(nodal) {
        for (u, expected) in found.iter().zip(expected(position)) {
            assert!(
                (u - expected).abs() < 1e-12 * 0.01,
                "{position:?}: {found:?}"
            );
        }
    }
}

#[test]
fn a_lowered_block_carries_its_pressure_evenly_whatever_its_cells() {
    let material = json!([{"young": YOUNG, "poisson": POISSON}]);
    let plate = json!({"plane_stress": {"thickness": 0.05}});
    // Pressure and widening per shortening: plane strain E/(1 − ν²) and ν/(1 − ν), else E and ν.
    let strain = (YOUNG / (1.0 - POISSON * POISSON), POISSON / (1.0 - POISSON));
    let free = (YOUNG, POISSON);
    let cases = CellKind::all().flat_map(|kind| match kind.dimension() {
        2 => vec![
            (kind, json!("plane_strain"), strain),
            (kind, plate.clone(), free),
            (kind, json!("axisymmetric"), free),
        ],
        _ => vec![(kind, json!("solid"), free)],
    });
    for (kind, model, (modulus, widening)) in cases {
        let mut mesh = block(kind);
        // A curved tetrahedron is not integrated exactly.
        if kind != CellKind::Tet10 {
            distort(&mut mesh);
        }
        let (solution, report) = certified(&scene(mesh, &model, &material, 0.0));
        let shortening = LOWERED / 2.0;
        check_pressure(&report, |_| modulus * shortening);
        let across = widening * shortening;
        check_displacement(&solution, |[x, y, z]| match kind.dimension() {
            2 => [across * x, -shortening * y, 0.0],
            _ => [across * x, across * y, -shortening * z],
        });
        let stress = solution.stresses().remove(0);
        let pressure = modulus * shortening;
        for found in stress.cells.iter().chain(&stress.nodes) {
            let up = found[kind.dimension() - 1];
            assert!(
                (up + pressure).abs() < 1e-11 * pressure,
                "{kind:?}: {found:?}"
            );
            assert!(
                found[3..]
                    .iter()
                    .all(|shear| shear.abs() < 1e-11 * pressure)
            );
        }
    }
}

#[test]
fn the_force_of_a_plate_counts_its_thickness_and_its_pressure_does_not() {
    let material = json!([{"young": YOUNG, "poisson": POISSON}]);
    let model = json!({"plane_stress": {"thickness": 0.05}});
    let (_, report) = certified(&scene(block(CellKind::Quad4), &model, &material, 0.0));
    // 1000 Pa · 0.002 = 2 Pa, on 3 m · 0.05 m.
    assert!((report.totals.normal - 0.3).abs() < 1e-12);
    assert!((report.totals.contact_area - 0.15).abs() < 1e-13);
    assert!((report.totals.peak_pressure - 2.0).abs() < 1e-11);
}

/// The cells whose mean position along an axis is below a bound, and the others.
fn split(mesh: &mut Mesh, axis: usize, bound: f64) {
    let mean = |cell: usize| {
        let nodes = mesh.cell(cell).nodes;
        nodes
            .iter()
            .map(|&node| mesh.nodes[node][axis])
            .sum::<f64>()
            / nodes.len() as f64
    };
    let cells = 0..mesh.cell_count();
    let (below, above) = cells.partition(|&cell| mean(cell) < bound);
    mesh.groups.insert("below".into(), Group::Cells(below));
    mesh.groups.insert("above".into(), Group::Cells(above));
}

#[test]
fn layers_in_series_add_their_compliances_and_stick_without_friction_force() {
    // ν = 0: no layer widens, so no contact wants to slip. Layers of h₁, h₂ shorten by p h/E each.
    let materials = json!([
        {"group": "below", "young": 500, "poisson": 0},
        {"group": "above", "young": 4000, "poisson": 0}
    ]);
    for kind in CellKind::all() {
        let mut mesh = block(kind);
        let axis = kind.dimension() - 1;
        let height = graded(0.0, 2.0, 4, 0.4).unwrap()[2];
        split(&mut mesh, axis, height);
        let model = if axis == 1 {
            json!("plane_strain")
        } else {
            json!("solid")
        };
        let (solution, report) = certified(&scene(mesh, &model, &materials, 0.4));
        let pressure = LOWERED / (height / 500.0 + (2.0 - height) / 4000.0);
        check_pressure(&report, |_| pressure);
        assert_eq!(report.totals.stick, report.size.contacts);
        check_displacement(&solution, |position| {
            let (low, high) = (
                position[axis].min(height),
                (position[axis] - height).max(0.0),
            );
            let mut u = [0.0; 3];
            u[axis] = -pressure * (low / 500.0 + high / 4000.0);
            u
        });
    }
}

#[test]
fn columns_side_by_side_carry_pressure_in_proportion_to_their_stiffness() {
    // ν = 0 and a shortening of 0.002: p = 0.002 E in each column.
    let materials = json!([
        {"group": "below", "young": 500, "poisson": 0},
        {"group": "above", "young": 4000, "poisson": 0}
    ]);
    let mut mesh = block(CellKind::Quad4);
    let lines = graded(0.0, 3.0, 5, 2.5).unwrap();
    split(&mut mesh, 0, lines[3]);
    let scene = scene(mesh, &json!("plane_strain"), &materials, 0.4);
    let (_, report) = certified(&scene);
    // The node between them carries the force of half a cell of each.
    let (left, right) = (lines[3] - lines[2], lines[4] - lines[3]);
    let between = (1.0 * left + 8.0 * right) / (left + right);
    check_pressure(&report, |position| match position[0] {
        x if x < lines[3] - 1e-9 => 1.0,
        x if x > lines[3] + 1e-9 => 8.0,
        _ => between,
    });
}

#[test]
fn a_nearly_incompressible_block_carries_its_pressure_evenly() {
    let material = json!([{"young": YOUNG, "poisson": 0.4999}]);
    for kind in CellKind::LINEAR {
        let (model, modulus) = match kind.dimension() {
            2 => (json!("plane_strain"), YOUNG / (1.0 - 0.4999 * 0.4999)),
            _ => (json!("solid"), YOUNG),
        };
        let (_, report) = certified(&scene(block(kind), &model, &material, 0.0));
        let expected = modulus * LOWERED / 2.0;
        let contacts = report.contacts.iter().map(|c| c.pressure.unwrap());
        let worst = contacts.fold(0.0_f64, |worst, p| worst.max((p / expected - 1.0).abs()));
        // The bulk modulus is 5000 times the shear modulus: as many digits are lost.
        assert!(worst < 1e-10, "{kind:?}: {worst:e}");
    }
}
