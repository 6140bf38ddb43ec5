//! Nearly incompressible bodies against closed forms: nothing locks.
//!
//! A plane-strain body is also a plate of the constants `E/(1−ν²)`, `ν/(1−ν)`, where no
//! dilatation is averaged: so the plain cell can be asked as well, and locks.

use super::samples::{body, facets, hold, solve};
use crate::body::{
    Body, CellKind, Load, Material, Model, box_mesh, cell_stress, graded, nodal_stress, rectangle,
};

const YOUNG: f64 = 10.0;

/// A body in plane strain (in 3D a slab of one cell between two smooth walls) on a grid
/// of the unit square that is mapped into the plane.
fn slab(kind: CellKind, counts: [usize; 2], map: impl Fn(f64, f64) -> [f64; 2]) -> Body {
    let [xs, ys] = counts.map(|count| graded(0.0, 1.0, count, 1.0).unwrap_or_default());
    let solid = kind.dimension() == 3;
    let (mesh, model) = if solid {
        let depth = [0.0, 1.0 / counts[1] as f64];
        (box_mesh(&xs, &ys, &depth, kind), Model::Solid)
    } else {
        (rectangle(&xs, &ys, kind), Model::PlaneStrain)
    };
    let mut mesh = mesh.unwrap_or_default();
    for position in &mut mesh.nodes {
        let [x, y] = map(position[0], position[1]);
        *position = [x, y, position[2]];
    }
    let mut body = body(mesh, model, 0.4999);
    if solid {
        hold(&mut body, "bottom", 2);
        hold(&mut body, "top", 2);
    }
    body
}

/// Least and greatest second coordinate of the unit square: the slab's walls bear the names of z.
fn sides(kind: CellKind) -> [&'static str; 2] {
    if kind.dimension() == 3 {
        ["front", "back"]
    } else {
        ["bottom", "top"]
    }
}

/// The same plane body with the plain form of the λ-term.
fn plain(mut body: Body) -> Body {
    let Material { young, poisson, .. } = body.materials[0];
    body.materials[0] = Material::new(young / (1.0 - poisson * poisson), poisson / (1.0 - poisson));
    body.model = Model::PlaneStress { thickness: 1.0 };
    body
}

/// Quarter of a tube with radii 1 and 2 m under an inner pressure of 1 Pa.
fn tube(kind: CellKind, count: usize) -> Body {
    let quarter = std::f64::consts::FRAC_PI_2;
    let mut body = slab(kind, [count; 2], |r, t| {
        let (sin, cos) = (quarter * t).sin_cos();
        [(1.0 + r) * cos, (1.0 + r) * sin]
    });
    let [start, end] = sides(kind);
    hold(&mut body, start, 1);
    hold(&mut body, end, 0);
    let facets = facets(&body.mesh, "left");
    body.loads = vec![Load::Pressure {
        facets,
        pressure: 1.0,
    }];
    body
}

/// Widening of the bore over Lamé's: `u_r(a) = (1+ν) p a²/(E (b²−a²)) ((1−2ν) a + b²/a)`.
fn widening(body: &Body) -> f64 {
    let poisson: f64 = 0.4999;
    let exact = (1.0 + poisson) / (3.0 * YOUNG) * ((1.0 - 2.0 * poisson) + 4.0);
    solve(body)[0] / exact
}

/// Kinds with incompatible modes, which need no means.
fn with_modes(mut body: Body) -> Body {
    body.formulation = crate::body::Formulation::IncompatibleModes;
    body
}

#[test]
fn cells_with_incompatible_modes_do_not_lock_either() {
    for kind in [CellKind::Quad4, CellKind::Hex8] {
        let [coarse, fine] =
            [4, 8].map(|count| (widening(&with_modes(tube(kind, count))) - 1.0).abs());
        assert!(
            fine < 0.006 && fine < 0.4 * coarse,
            "{kind:?}: {coarse} {fine}"
        );
        let bent = deflection(&with_modes(beam(kind, 0.4999)));
        assert!((bent - 1.0).abs() < 0.01, "{kind:?}: {bent}");
        let fine = axial_stress_error(&with_modes(tube(kind, 8)));
        assert!(fine < 0.1, "{kind:?}: {fine}");
    }
}

#[test]
fn an_incompressible_tube_widens_as_lame_says_and_the_error_falls_with_refinement() {
    for kind in CellKind::LINEAR {
        // The chords of the bore, of the angle h = π/16, stand off it by h²/8 = 0.005; simplices start with five to
        // six times the error of the tensor-product cells. Order two leaves a quarter, on meshes this coarse 0.4.
        let accepted = if kind.is_tensor_product() {
            0.006
        } else {
            0.04
        };
        let [coarse, fine] = [4, 8].map(|count| (widening(&tube(kind, count)) - 1.0).abs());
        assert!(fine < accepted, "{kind:?}: {fine}");
        assert!(fine < 0.4 * coarse, "{kind:?}: {coarse} {fine}");
    }
}

/// A guard that the cells above owe their answer to their dilatation: these miss most of the widening.
#[test]
fn the_plain_cells_lock_on_the_same_tube() {
    assert!(widening(&plain(tube(CellKind::Quad4, 8))) < 0.25);
    assert!(widening(&plain(tube(CellKind::Tri3, 8))) < 0.7);
}

/// Root mean square over the nodes of the error of `σ_zz` in a tube; Lamé has the same
/// `σ_zz = 2 ν p a²/(b²−a²) = 2 ν/3` everywhere.
fn axial_stress_error(body: &Body) -> f64 {
    let found = solve(body);
    let nodes = nodal_stress(body, &found, &cell_stress(body, &found));
    let squares = nodes
        .iter()
        .map(|stress| (stress[2] - 0.9998 / 3.0).powi(2));
    (squares.sum::<f64>() / nodes.len() as f64).sqrt()
}

#[test]
fn the_pressure_in_an_incompressible_tube_is_not_noise() {
    // λ = 1.7e4 Pa times the strains' error would be tens of pascal. Order two leaves a quarter, the constant
    // dilatations of simplices half, of pressures that are up to h/(2r) = 0.1 of 1 Pa apart in a cell.
    for kind in CellKind::LINEAR {
        let [coarse, fine] = [4, 8].map(|count| axial_stress_error(&tube(kind, count)));
        let (accepted, fall) = if kind.is_tensor_product() {
            (1e-3, 0.4)
        } else {
            (0.13, 0.8)
        };
        assert!(
            fine < accepted && fine < fall * coarse,
            "{kind:?}: {coarse} {fine}"
        );
    }
}

/// A beam of 4 × 1 m, bent by a linear traction `E' κ y` at its right end, with `κ = 1e-3 / m`.
fn beam(kind: CellKind, poisson: f64) -> Body {
    let mut body = slab(kind, [32, 8], |x, y| [4.0 * x, y - 0.5]);
    body.materials[0].poisson = poisson;
    hold(&mut body, "left", 0);
    for node in 0..body.mesh.nodes.len() {
        if body.mesh.nodes[node][..2] == [0.0, 0.0] {
            let place = "middle".to_owned();
            let displacement = [None, Some(0.0), None];
            body.supports.push(crate::body::Support {
                place,
                nodes: vec![node],
                displacement,
                offsets: Vec::new(),
                axes: Vec::new(),
            });
        }
    }
    for facet in facets(&body.mesh, "right") {
        let heights = facet.nodes.iter().map(|node| body.mesh.nodes[*node][1]);
        // The cells' middle, also where a cell's side is two triangles.
        let height =
            (heights.clone().fold(f64::MAX, f64::min) + heights.fold(f64::MIN, f64::max)) / 2.0;
        let traction = [1e-3 * YOUNG / (1.0 - poisson * poisson) * height, 0.0, 0.0];
        body.loads.push(Load::Traction {
            facets: vec![facet],
            traction,
        });
    }
    body
}

/// Deflection of the beam's end over `−κ L²/2` (1 − 1/8²): eight steps in place of the
/// linear traction have that much of its moment.
fn deflection(body: &Body) -> f64 {
    let found = solve(body);
    let axes = body.mesh.dimension;
    let at_end = |x: &[f64; 3]| x[0] == 4.0 && x[1] == 0.0;
    let node = body.mesh.nodes.iter().position(at_end).unwrap_or_default();
    found[axes * node + 1] / (-1e-3 * 8.0 * (1.0 - 1.0 / 64.0))
}

#[test]
fn a_bent_incompressible_beam_is_as_flexible_as_a_compressible_one() {
    for kind in CellKind::LINEAR {
        let [soft, tight] = [0.3, 0.4999].map(|poisson| deflection(&beam(kind, poisson)));
        // Of the order of what eight steps are short of, 1/8²; simplices have four to six times the error.
        let accepted = if kind.is_tensor_product() { 0.01 } else { 0.06 };
        assert!((tight - 1.0).abs() < accepted, "{kind:?}: {tight}");
        assert!((tight - soft).abs() < 0.02, "{kind:?}: {soft} {tight}");
    }
}

#[test]
fn the_plain_cells_lock_in_the_same_beam() {
    for kind in [CellKind::Tri3, CellKind::Quad4] {
        assert!(deflection(&plain(beam(kind, 0.4999))) < 0.15);
    }
}
