//! The bound of the stress error: never below the true error, which a mesh four times finer tells, and not far above it.

use dpana::body::{Body, CellKind, Mesh, graded, rectangle};
use dpana::scene::MeshSource;
use dpana::{Scene, Solution, Status, solve};
use serde_json::{Value, json};

fn certified(scene: &Scene) -> Solution {
    let solution = solve(scene).unwrap();
    assert_eq!(solution.status(), Status::Certified);
    solution
}

/// A displacement on a mesh with every cell split twice.
fn on_finer(body: &Body, displacement: &[f64]) -> Vec<f64> {
    let axes = body.mesh.dimension;
    let with = |by: f64| -> Mesh {
        let mut mesh = body.mesh.clone();
        for (node, u) in mesh.nodes.iter_mut().zip(displacement.chunks(axes)) {
            (0..axes).for_each(|k| node[k] = by * u[k]);
        }
        mesh.refined().refined()
    };
    let moved = with(1.0);
    let nodes = moved.nodes.iter();
    nodes.flat_map(|node| node[..axes].to_vec()).collect()
}

/// `u · K u`.
fn energy(body: &Body, u: &[f64]) -> f64 {
    let stiffness = body.stiffness().unwrap();
    stiffness
        .iter()
        .map(|(entry, (i, j))| u[i] * entry * u[j])
        .sum()
}

/// Bound, estimate and error against cells four times smaller, all relative to the stress.
fn errors(scene: &Scene) -> [f64; 3] {
    let coarse = certified(scene);
    let finer = scene
        .with_halved_cells()
        .unwrap()
        .with_halved_cells()
        .unwrap();
    let fine = certified(&finer);
    let (mut off, mut all) = (0.0, 0.0);
    for (at, body) in fine.bodies().iter().enumerate() {
        let u = &fine.displacements()[at];
        let before = on_finer(&coarse.bodies()[at], &coarse.displacements()[at]);
        let change: Vec<f64> = u.iter().zip(before).map(|(a, b)| a - b).collect();
        off += energy(body, &change);
        all += energy(body, u);
    }
    let bound = coarse.stress_error_bound().unwrap();
    [bound, coarse.stress_error_estimate(), (off / all).sqrt()]
}

/// A rectangle whose inner nodes are moved by up to a fifth of a cell.
fn distorted(x: [f64; 2], y: [f64; 2], cells: [usize; 2], kind: CellKind) -> Mesh {
    let lines = |[from, to]: [f64; 2], count| graded(from, to, count, 1.0).unwrap();
    let mut mesh = rectangle(&lines(x, cells[0]), &lines(y, cells[1]), kind).unwrap();
    let size = (x[1] - x[0]) / cells[0] as f64;
    for node in &mut mesh.nodes {
        let inside = |at: f64, [from, to]: [f64; 2]| at > from + 1e-9 && at < to - 1e-9;
        if inside(node[0], x) && inside(node[1], y) {
            let phase = 7.0 * node[0] / size + 11.0 * node[1] / size;
            node[0] += 0.2 * size * phase.sin();
            node[1] += 0.2 * size * phase.cos();
        }
    }
    mesh
}

struct Case {
    name: &'static str,
    scene: Value,
    meshes: Vec<Mesh>,
}

impl Case {
    fn scene(&self) -> Scene {
        let mut scene = Scene::from_json(&self.scene.to_string(), "").unwrap();
        for (body, mesh) in scene.bodies.iter_mut().zip(&self.meshes) {
            body.mesh = MeshSource::Given(mesh.clone());
        }
        scene
    }
}

/// SSNV128: stress without bound nowhere, friction along the whole side.
fn square(cells: usize, kind: CellKind) -> Case {
    let scene = crate::square::scene(cells, 0.2, 1.0).to_json().unwrap();
    Case {
        name: "square",
        scene: serde_json::from_str(&scene).unwrap(),
        meshes: vec![distorted([0.0, 0.04], [0.0, 0.04], [cells, cells], kind)],
    }
}

/// A heavy plate, bent by a moment, over a floor from which it lifts off.
fn plate(cells: usize, kind: CellKind) -> Case {
    let scene = json!({
        "bodies": [{
            "name": "plate", "mesh": {"file": "given in code"},
            "model": {"plane_stress": {"thickness": 0.3}},
            "materials": [{"young": 1000, "poisson": 0.3, "density": 2, "expansion": 1e-3}],
            "supports": [{"group": "left", "displacement": [0, 0]}],
            "loads": [
                {"gravity": [0, -10]}, {"temperature": 2.0},
                {"group": "right", "force": [1, -8], "moment": [3]},
                {"group": "top", "pressure": {"value": 1, "gradient": [2, 0]}}
            ]
        }],
        "contacts": [{
            "group": "bottom", "friction": 0.3,
            "obstacle": {"plane": {"point": [0, -0.02], "normal": [0, 1]}}
        }]
    });
    Case {
        name: "plate",
        scene,
        meshes: vec![distorted([0.0, 3.0], [0.0, 1.0], [3 * cells, cells], kind)],
    }
}

/// A solid shaft that spins and is pressed on a rough floor by a ring of pressure.
fn shaft(cells: usize, kind: CellKind) -> Case {
    let scene = json!({
        "bodies": [{
            "name": "shaft", "mesh": {"file": "given in code"}, "model": "axisymmetric",
            "materials": [{"young": 1000, "poisson": 0.3, "density": 2}],
            "loads": [
                {"centrifugal": {"speed": 1.5}}, {"gravity": [0, -1]},
                {"group": "top", "pressure": {"value": 1, "gradient": [3, 0]}}
            ]
        }],
        "contacts": [{
            "group": "bottom", "friction": 0.2,
            "obstacle": {"plane": {"point": [0, 0], "normal": [0, 1]}}
        }]
    });
    Case {
        name: "shaft",
        scene,
        meshes: vec![distorted([0.0, 1.0], [0.0, 1.0], [cells, cells], kind)],
    }
}

/// A stiff block of oriented fibres on a soft one, which bulges; meshes that do not match.
fn blocks(cells: usize, kind: CellKind) -> Case {
    let scene = json!({
        "bodies": [
            {
                "name": "lower", "mesh": {"file": "given in code"}, "model": "plane_strain",
                "materials": [{"young": 1000, "poisson": 0.4}],
                "supports": [{"group": "bottom", "displacement": [0, 0]}]
            },
            {
                "name": "upper", "mesh": {"file": "given in code"}, "model": "plane_strain",
                "materials": [{"orthotropic": {
                    "young": [4000, 2000, 1000], "poisson": [0.3, 0.2, 0.1], "shear": [800, 700, 600]
                }}],
                "supports": [{"group": "top", "displacement": [0.01, -0.02]}]
            }
        ],
        "contacts": [{
            "body": "upper", "group": "bottom", "friction": 0.3,
            "against": {"body": "lower", "group": "top"}
        }]
    });
    Case {
        name: "blocks",
        scene,
        meshes: vec![
            distorted([0.0, 2.0], [-1.0, 0.0], [2 * cells, cells], kind),
            distorted([0.5, 1.5], [0.0, 1.0], [cells + 1, cells + 1], kind),
        ],
    }
}

const CASES: [fn(usize, CellKind) -> Case; 4] = [square, plate, shaft, blocks];

#[test]
fn the_bound_is_above_the_true_error_and_at_most_three_times_it() {
    let mut off = Vec::new();
    for case in CASES {
        for (kind, cells) in [
            (CellKind::Quad4, 4),
            (CellKind::Tri3, 4),
            (CellKind::Quad4, 8),
        ] {
            let case = case(cells, kind);
            let [bound, estimate, error] = errors(&case.scene());
            let [effectivity, of_estimate] = [bound, estimate].map(|found| found / error);
            // Three, to the digits shown, on the coarsest triangles.
            if !(1.0..3.005).contains(&effectivity) {
                off.push(format!(
                    "{} {kind:?} {cells}: {effectivity:.2}, estimate {of_estimate:.2}, {error:.1e}",
                    case.name
                ));
            }
        }
    }
    assert!(off.is_empty(), "{off:#?}");
}
