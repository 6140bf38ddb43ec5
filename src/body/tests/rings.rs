//! Axisymmetric bodies against Lamé: tubes and hollow balls, compressible and nearly not.
//!
//! ```text
//! tube   u_r(r) = (1+ν) p a² / (E (b²−a²)) ((1−2ν) r + b²/r)          no axial strain
//! ball   u_r(r) = p a³ / (E (b³−a³)) ((1−2ν) r + (1+ν) b³ / (2r²))
//! ```
//!
//! under a pressure p inside, radii a and b. Timoshenko & Goodier, Theory of Elasticity (1970),
//! art. 28 and 136.

use super::samples::{body, facets, hold, solve};
use crate::body::{Body, CellKind, Load, Model, cell_stress, graded, load_vector, rectangle};

const YOUNG: f64 = 10.0;

fn plane_kinds() -> impl Iterator<Item = CellKind> {
    CellKind::all().filter(|kind| kind.dimension() == 2)
}

/// The unit square of `count` cells per side, mapped into the plane, with 1 Pa on its left side.
fn pressed(kind: CellKind, count: usize, poisson: f64, map: fn([f64; 2]) -> [f64; 2]) -> Body {
    let lines = graded(0.0, 1.0, count, 1.0).unwrap_or_default();
    let mut mesh = rectangle(&lines, &lines, kind).unwrap_or_default();
    for position in &mut mesh.nodes {
        let [x, y] = map([position[0], position[1]]);
        *position = [x, y, 0.0];
    }
    let mut body = body(mesh, Model::Axisymmetric, poisson);
    let facets = facets(&body.mesh, "left");
    body.loads = vec![Load::Pressure {
        facets,
        pressure: 1.0,
    }];
    body
}

/// Radii 1 and 2 m, height 1 m, between two smooth plates.
fn tube(kind: CellKind, count: usize, poisson: f64) -> Body {
    let mut body = pressed(kind, count, poisson, |[x, y]| [1.0 + x, y]);
    hold(&mut body, "bottom", 1);
    hold(&mut body, "top", 1);
    body
}

/// Radii 1 and 2 m, the upper half on its plane of symmetry; nothing but the model holds the axis.
fn ball(kind: CellKind, count: usize, poisson: f64) -> Body {
    let mut body = pressed(kind, count, poisson, |[x, y]| {
        let (sin, cos) = (std::f64::consts::FRAC_PI_2 * y).sin_cos();
        [(1.0 + x) * cos, (1.0 + x) * sin]
    });
    hold(&mut body, "bottom", 1);
    body
}

/// Relative errors of the radial displacement of the first node, at r = 1 m, y = 0.
fn errors(
    body: fn(CellKind, usize, f64) -> Body,
    kind: CellKind,
    poisson: f64,
    u: f64,
) -> [f64; 2] {
    // Triangles of constant strain start with several times the error of the others.
    let counts = if kind == CellKind::Tri3 {
        [8, 16]
    } else {
        [4, 8]
    };
    counts.map(|count| (solve(&body(kind, count, poisson))[0] / u - 1.0).abs())
}

#[test]
fn a_tube_widens_as_lame_says() {
    for kind in plane_kinds() {
        for poisson in [0.3, 0.4999] {
            let exact = (1.0 + poisson) / (3.0 * YOUNG) * ((1.0 - 2.0 * poisson) + 4.0);
            let [coarse, fine] = errors(tube, kind, poisson, exact);
            // Quadratic triangles that are nearly incompressible start a tenth off.
            let (accepted, fall) = match (kind.is_linear(), poisson > 0.45) {
                (true, _) | (false, true) => (0.01, 0.4),
                (false, false) => (1e-3, 0.25),
            };
            assert!(
                fine < accepted && fine < fall * coarse,
                "{kind:?} {poisson}: {coarse:e} {fine:e}"
            );
        }
    }
}

#[test]
fn a_hollow_ball_widens_as_lame_says() {
    for kind in plane_kinds() {
        let exact = ((1.0 - 0.6) + 1.3 * 4.0) / (7.0 * YOUNG);
        let [coarse, fine] = errors(ball, kind, 0.3, exact);
        let (accepted, fall) = match kind.is_linear() {
            true => (0.04, 0.4),
            false => (1e-3, 0.25),
        };
        assert!(
            fine < accepted && fine < fall * coarse,
            "{kind:?}: {coarse:e} {fine:e}"
        );
    }
}

#[test]
fn a_solid_cylinder_squeezed_from_the_side_has_one_stress() {
    // σ_rr = σ_θθ = −p, σ_yy = 0: u_r = −(1−ν) p r/E, u_y = 2 ν p y/E, exact on any cells.
    for kind in plane_kinds() {
        let mut body = pressed(kind, 3, 0.3, |[x, y]| [1.0 - x, 1.0 - y]);
        hold(&mut body, "top", 1);
        let found = solve(&body);
        for (node, [r, y, _]) in body.mesh.nodes.iter().enumerate() {
            let expected = [-0.7 * r / YOUNG, 0.6 * y / YOUNG];
            for (axis, expected) in expected.into_iter().enumerate() {
                assert!(
                    (found[2 * node + axis] - expected).abs() < 1e-14,
                    "{kind:?} {r} {y}"
                );
            }
        }
        for stress in cell_stress(&body, &found) {
            let expected = [-1.0, 0.0, -1.0, 0.0, 0.0, 0.0];
            for (found, expected) in stress.into_iter().zip(expected) {
                assert!((found - expected).abs() < 1e-12, "{stress:?}");
            }
        }
    }
}

#[test]
fn loads_are_those_of_the_whole_circumference() {
    for kind in plane_kinds() {
        let mut body = pressed(kind, 3, 0.3, |[x, y]| [1.0 + x, y]);
        let total = |body: &Body, axis: usize| -> f64 {
            load_vector(body).iter().skip(axis).step_by(2).sum()
        };
        // 1 Pa on 2π · 1 m · 1 m, outward.
        let around = std::f64::consts::TAU;
        assert!((total(&body, 0) - around).abs() < 1e-13);
        // 3 Pa on π (2² − 1²) m², 5 N/m³ on as many m³.
        body.loads = vec![Load::Pressure {
            facets: facets(&body.mesh, "top"),
            pressure: 3.0,
        }];
        assert!((total(&body, 1) + 1.5 * around * 3.0).abs() < 1e-12);
        body.loads = vec![Load::BodyForce {
            cells: (0..body.mesh.cell_count()).collect(),
            density: [0.0, -5.0, 0.0],
        }];
        assert!((total(&body, 1) + 1.5 * around * 5.0).abs() < 1e-12);
    }
}
