//! The bound of the stress error: none of exact solutions, and between the true error and three times it otherwise.

#![allow(clippy::unwrap_used)]

use nalgebra::Vector3;

use super::samples::{PLANE, block, body, distorted, facets, hold, solve, support};
use crate::body::{
    Affine, Body, CellKind, Line, Load, Material, Mesh, Model, Support, Wrench, stiffness,
    stress_error_bound, stress_recovery,
};

const MODELS: [Model; 3] = [
    Model::PlaneStrain,
    Model::PlaneStress { thickness: 0.3 },
    Model::Axisymmetric,
];

fn nodal(body: &Body, u: impl Fn(Vector3<f64>) -> [f64; 2]) -> Vec<f64> {
    let nodes = body.mesh.nodes.iter();
    nodes.flat_map(|x| u(Vector3::from(*x))).collect()
}

/// Gives all nodes of the surface their displacement.
fn give(body: &mut Body, displacement: &[f64]) {
    let surface = body.mesh.boundary_facets();
    let mut nodes: Vec<usize> = surface.into_iter().flat_map(|facet| facet.nodes).collect();
    nodes.sort_unstable();
    nodes.dedup();
    let offset = |node: &usize| [displacement[2 * node], displacement[2 * node + 1], 0.0];
    body.supports = vec![Support {
        place: "surface".to_owned(),
        offsets: nodes.iter().map(offset).collect(),
        nodes,
        displacement: [Some(0.0), Some(0.0), None],
        axes: Vec::new(),
    }];
}

#[test]
fn a_displacement_that_is_exact_has_no_error() {
    for kind in PLANE {
        for model in MODELS {
            let mut body = distorted(kind);
            body.model = model;
            body.materials[0] = Material::new(10.0, 0.25);
            // Uniform strain, of a ring also around the axis.
            let u = nodal(&body, |x| match model {
                Model::Axisymmetric => [0.3 * x.x, 0.7 * x.y],
                _ => [x.x + 2.0 * x.y, 3.0 * x.y],
            });
            give(&mut body, &u);
            let energy = stress_recovery(&body, &u).energy;
            let bound = stress_error_bound(&body, &u, &[]).unwrap();
            assert!(
                bound < 1e-14 * energy,
                "{kind:?} {model:?} {bound:e} {energy:e}"
            );
        }
    }
    // λ = μ = 4, u = (x² + x y, y²): div σ = (24, 32).
    for kind in [CellKind::Tri6, CellKind::Quad8, CellKind::Quad9] {
        let mut body = block(kind);
        body.materials[0] = Material::new(10.0, 0.25);
        let cells = (0..body.mesh.cell_count()).collect();
        let density = [-24.0, -32.0, 0.0];
        body.loads = vec![Load::BodyForce { cells, density }];
        let u = nodal(&body, |x| [x.x * x.x + x.x * x.y, x.y * x.y]);
        give(&mut body, &u);
        let energy = stress_recovery(&body, &u).energy;
        let bound = stress_error_bound(&body, &u, &[]).unwrap();
        assert!(bound < 1e-14 * energy, "{kind:?} {bound:e} {energy:e}");
    }
}

/// Held on its left side or, a ring, from below, under weight, a pressure that varies, and a spread force or a spin.
fn loaded(mesh: Mesh, model: Model) -> Body {
    let mut body = body(mesh, model, 0.3);
    body.materials[0].density = 2.0;
    let cells: Vec<usize> = (0..body.mesh.cell_count()).collect();
    let [top, right] = ["top", "right"].map(|name| facets(&body.mesh, name));
    let weight = Load::Gravity {
        cells: cells.clone(),
        acceleration: [0.0, -1.0, 0.0],
    };
    let pressure = Affine {
        value: 1.0,
        gradient: [2.0, 0.0, 0.0],
    };
    let pressed = Load::VaryingPressure {
        facets: top,
        pressure,
    };
    let last = if model == Model::Axisymmetric {
        hold(&mut body, "bottom", 1);
        Load::Centrifugal {
            cells,
            axis: Line {
                point: [0.0; 3],
                direction: [0.0, 1.0, 0.0],
            },
            speed_squared: 0.5,
        }
    } else {
        let left = facets(&body.mesh, "left").into_iter();
        let left: Vec<usize> = left.flat_map(|facet| facet.nodes).collect();
        body.supports.push(support(&left, &[0, 1]));
        Load::Spread {
            facets: right,
            wrench: Wrench {
                force: [1.0, -0.5, 0.0],
                moment: [0.0, 0.0, 0.2],
                at: None,
            },
        }
    };
    body.loads = vec![weight, pressed, last];
    body
}

/// Energy norm of a displacement, squared.
fn energy(body: &Body, u: &[f64]) -> f64 {
    let stiffness = stiffness(body);
    let terms = stiffness.iter();
    terms.map(|(entry, (i, j))| u[i] * entry * u[j]).sum()
}

#[test]
fn the_bound_is_above_the_error_against_cells_four_times_smaller_and_below_three_times_it() {
    for kind in PLANE {
        for model in MODELS {
            let coarse = loaded(distorted(kind).mesh, model);
            let u = solve(&coarse);
            // A mesh whose nodes are where they move to is split like the mesh itself.
            let mut moved = coarse.mesh.clone();
            for (node, u) in moved.nodes.iter_mut().zip(u.chunks(2)) {
                *node = [u[0], u[1], 0.0];
            }
            let moved = moved.refined().refined();
            let fine = loaded(coarse.mesh.refined().refined(), model);
            let change = solve(&fine)
                .into_iter()
                .zip(moved.nodes.iter().flat_map(|x| [x[0], x[1]]));
            let change: Vec<f64> = change.map(|(fine, coarse)| fine - coarse).collect();
            let error = energy(&fine, &change);
            let bound = stress_error_bound(&coarse, &u, &[]).unwrap();
            let effectivity = (bound / error).sqrt();
            assert!(
                (1.0..3.0).contains(&effectivity),
                "{kind:?} {model:?} {effectivity}"
            );
        }
    }
}

#[test]
fn the_bound_is_the_same_in_other_units_places_and_directions() {
    let bound = |kind: CellKind, young: f64, size: f64, angle: f64, shift: f64| {
        let mut body = distorted(kind);
        body.materials[0] = Material::new(young, 0.3);
        let moved = nodal(&body, |x| [(2.0 * x.x).sin() * x.y, x.y.cos() * x.x]);
        let turned = |[x, y]: [f64; 2]| {
            let (sin, cos) = angle.sin_cos();
            [size * (cos * x - sin * y), size * (sin * x + cos * y)]
        };
        for node in &mut body.mesh.nodes {
            let [x, y] = turned([node[0], node[1]]);
            *node = [x + shift, y - shift, 0.0];
        }
        let moved = moved.chunks(2).flat_map(|u| turned([u[0], u[1]]));
        give(&mut body, &moved.collect::<Vec<_>>());
        let u = solve(&body);
        stress_error_bound(&body, &u, &[]).unwrap() / (young * size * size)
    };
    for kind in PLANE {
        let here = bound(kind, 1.0, 1.0, 0.0, 0.0);
        for (young, size, angle, shift) in [
            (2.1e11, 1e-6, 0.0, 0.0),
            (1e-3, 1e4, 0.7, 0.0),
            (1.0, 1.0, 2.5, 1e3),
        ] {
            let there = bound(kind, young, size, angle, shift);
            assert!(
                (there / here - 1.0).abs() < 1e-6,
                "{kind:?} {angle} {here} {there}"
            );
        }
    }
}

#[test]
fn what_the_bound_does_not_know_is_refused_by_name() {
    let says = |change: fn(&mut Body), part: &str| {
        let mut body = loaded(distorted(CellKind::Quad8).mesh, Model::PlaneStrain);
        change(&mut body);
        let zero = vec![0.0; 2 * body.mesh.nodes.len()];
        let found = stress_error_bound(&body, &zero, &[])
            .unwrap_err()
            .to_string();
        assert!(found.contains(part), "{found}");
    };
    says(|body| body.mesh.nodes[4][0] += 0.01, "curved cells");
    says(
        |body| {
            body.loads.push(Load::PointForce {
                node: 0,
                force: [1.0; 3],
            });
        },
        "a force at a node",
    );
    // Not in equilibrium with its loads.
    says(|_| (), "a force on the single node");
    let solid = block(CellKind::Hex8);
    let zero = vec![0.0; 3 * solid.mesh.nodes.len()];
    let found = stress_error_bound(&solid, &zero, &[]).unwrap_err();
    assert!(found.to_string().contains("3D"), "{found}");
}
