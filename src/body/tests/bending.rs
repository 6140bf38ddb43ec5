//! Incompatible modes against beams and plates; the plain cells miss them.

use super::samples::{body, facets, hold, solve};
use crate::body::{
    Affine, Body, CellKind, Formulation, Load, Material, Model, box_mesh, cell_stress, graded,
    nodal_stress, rectangle,
};

const YOUNG: f64 = 10.0;

/// A strip of 20 × 1 m, four cells through its depth and twenty along it, 1 m wide.
fn strip(kind: CellKind, model: Model) -> Body {
    let [xs, ys] =
        [(20.0, 20), (1.0, 4)].map(|(end, count)| graded(0.0, end, count, 1.0).unwrap_or_default());
    let mesh = match kind.dimension() {
        2 => rectangle(&xs, &ys, kind),
        _ => box_mesh(&xs, &[0.0, 1.0], &ys, kind),
    };
    let mut strip = body(mesh.unwrap_or_default(), model, 0.3);
    strip.formulation = Formulation::IncompatibleModes;
    strip
}

fn strips() -> [Body; 3] {
    [
        strip(CellKind::Quad4, Model::PlaneStrain),
        strip(CellKind::Quad4, Model::PlaneStress { thickness: 0.1 }),
        strip(CellKind::Hex8, Model::Solid),
    ]
}

/// E of a beam in the model.
fn young(body: &Body) -> f64 {
    match body.model {
        Model::PlaneStrain | Model::Axisymmetric => {
            YOUNG / (1.0 - body.materials[0].poisson.powi(2))
        }
        _ => YOUNG,
    }
}

/// Displacement along the last axis at a position, in metre.
fn rise(body: &Body, u: &[f64], at: [f64; 3]) -> f64 {
    let axes = body.mesh.dimension;
    let distance = |x: &[f64; 3]| (0..3).map(|k| (x[k] - at[k]).abs()).sum::<f64>();
    let nodes = body.mesh.nodes.iter().enumerate();
    let nearest = nodes.min_by(|a, b| distance(a.1).total_cmp(&distance(b.1)));
    u[axes * nearest.map_or(0, |(node, _)| node) + axes - 1]
}

#[test]
fn a_cantilever_of_four_cells_bends_as_a_beam_and_of_plain_ones_too_little() {
    // −P L³/(3 E I) (1 + 0.6 E h²/(κ' …)): Timoshenko's share of shear is P L/(κ G A) with κ = 5/6.
    for mut beam in strips() {
        let axes = beam.mesh.dimension;
        for axis in [0, axes - 1] {
            hold(&mut beam, "left", axis);
        }
        if axes == 3 {
            hold(&mut beam, "front", 1);
        }
        let mut traction = [0.0; 3];
        traction[axes - 1] = 1e-3;
        beam.loads = vec![Load::Traction {
            facets: facets(&beam.mesh, "right"),
            traction,
        }];
        let shear = YOUNG / 2.6;
        let expected = 1e-3 * (8000.0 / (3.0 * young(&beam) / 12.0) + 20.0 / (shear * 5.0 / 6.0));
        let middle = if axes == 2 {
            [20.0, 0.5, 0.0]
        } else {
            [20.0, 0.0, 0.5]
        };
        let found = rise(&beam, &solve(&beam), middle) / expected;
        assert!((found - 1.0).abs() < 0.01, "{:?}: {found}", beam.model);
        beam.formulation = Formulation::Standard;
        let plain = rise(&beam, &solve(&beam), middle) / expected;
        assert!(plain < 0.95, "{:?}: {plain}", beam.model);
    }
}

/// Symmetry at the left, the middle of its bottom held.
fn free(body: &mut Body) {
    hold(body, "left", 0);
    let axes = body.mesh.dimension;
    let origin = body
        .mesh
        .nodes
        .iter()
        .position(|x| *x == [0.0; 3])
        .unwrap_or_default();
    body.supports
        .push(super::samples::support(&[origin], &[axes - 1]));
    if axes == 3 {
        hold(body, "front", 1);
    }
}

#[test]
fn the_stress_of_pure_bending_is_exact_at_the_nodes() {
    // σ_x = E κ (y − ½), all others zero (plane strain: σ_z = ν σ_x).
    for mut beam in strips() {
        free(&mut beam);
        let (axes, slope) = (beam.mesh.dimension, young(&beam) * 1e-3);
        let mut gradient = [0.0; 3];
        gradient[axes - 1] = slope;
        let along = Affine {
            value: -0.5 * slope,
            gradient,
        };
        let none = Affine::default();
        beam.loads = vec![Load::VaryingTraction {
            facets: facets(&beam.mesh, "right"),
            traction: [along, none, none],
        }];
        let u = solve(&beam);
        let stress = nodal_stress(&beam, &u, &cell_stress(&beam, &u));
        for (stress, x) in stress.iter().zip(&beam.mesh.nodes) {
            let mut expected = [slope * (x[axes - 1] - 0.5), 0.0, 0.0, 0.0, 0.0, 0.0];
            if beam.model == Model::PlaneStrain {
                expected[2] = 0.3 * expected[0];
            }
            let off = stress.iter().zip(expected).map(|(a, b)| (a - b).abs());
            assert!(
                off.fold(0.0, f64::max) < 1e-9 * slope,
                "{:?} {stress:?} {expected:?}",
                beam.model
            );
        }
    }
}

#[test]
fn a_strip_warmer_above_bends_without_stress() {
    // T = y: u_x = α x y, and no stress, in plane stress and 3D.
    for mut strip in strips() {
        if strip.model == Model::PlaneStrain {
            continue;
        }
        free(&mut strip);
        strip.materials[0].expansion = 1e-3;
        let up = strip.mesh.dimension - 1;
        strip.loads = vec![Load::Temperature {
            cells: (0..strip.mesh.cell_count()).collect(),
            rise: strip.mesh.nodes.iter().map(|x| x[up]).collect(),
        }];
        let u = solve(&strip);
        let stress = cell_stress(&strip, &u);
        let stress = [nodal_stress(&strip, &u, &stress), stress]
            .concat()
            .concat();
        let largest = stress.iter().fold(0.0_f64, |m, s| m.max(s.abs()));
        // E α = 1e-2.
        assert!(largest < 1e-11, "{:?} {largest:e}", strip.model);
        for (node, x) in strip.mesh.nodes.iter().enumerate() {
            assert!((u[(up + 1) * node] - 1e-3 * x[0] * x[up]).abs() < 1e-11);
        }
    }
}

#[test]
fn a_clamped_disc_under_pressure_sags_as_a_plate() {
    // w = q R⁴/(64 D) + q R²/(4 κ G t), D = E t³/(12 (1 − ν²)), κ = 5/6 (Timoshenko & Woinowsky-Krieger, art. 17, 20).
    let mut disc = strip(CellKind::Quad4, Model::Axisymmetric);
    hold(&mut disc, "right", 0);
    hold(&mut disc, "right", 1);
    disc.loads = vec![Load::Pressure {
        facets: facets(&disc.mesh, "bottom"),
        pressure: 1e-6,
    }];
    let bending = 1.6e5 / 64.0 / (YOUNG / (12.0 * 0.91));
    let expected = 1e-6 * (bending + 400.0 / 4.0 / (5.0 / 6.0 * YOUNG / 2.6));
    let middle = [0.0, 0.5, 0.0];
    let found = rise(&disc, &solve(&disc), middle) / expected;
    assert!((found - 1.0).abs() < 0.01, "{found}");
    disc.formulation = Formulation::Standard;
    let plain = rise(&disc, &solve(&disc), middle) / expected;
    assert!(plain < 0.95, "{plain}");
}

#[test]
fn a_nearly_incompressible_strip_bends_as_well() {
    for mut beam in strips() {
        beam.materials = vec![Material::new(YOUNG, 0.4999)];
        let axes = beam.mesh.dimension;
        free(&mut beam);
        let slope = young(&beam) * 1e-3;
        let mut gradient = [0.0; 3];
        gradient[axes - 1] = slope;
        let along = Affine {
            value: -0.5 * slope,
            gradient,
        };
        beam.loads = vec![Load::VaryingTraction {
            facets: facets(&beam.mesh, "right"),
            traction: [along, Affine::default(), Affine::default()],
        }];
        // −κ L²/2 along the bottom.
        let found = rise(&beam, &solve(&beam), [20.0, 0.0, 0.0]) / (-1e-3 * 200.0);
        assert!((found - 1.0).abs() < 0.01, "{:?}: {found}", beam.model);
    }
}
