//! Materials with directions against closed forms, and against isotropic ones.

use nalgebra::{Matrix3, Rotation3, Vector3};

use super::samples::{block, distorted, facets, hold, solve};
use crate::body::{
    Body, CellKind, Line, Load, Material, MaterialAxes, Model, Orthotropic, Support, cell_stress,
    load_vector, nodal_stress, stiffness, stress_recovery,
};

/// Spruce by size: along, across and radial.
const WOOD: Orthotropic = Orthotropic {
    young: [11.0, 0.5, 0.8],
    poisson: [0.4, 0.35, 0.25],
    shear: [0.6, 0.7, 0.04],
    expansion: [4e-3, 3e-2, 2e-2],
    axes: MaterialAxes::GLOBAL,
};

fn isotropic(material: Material) -> Orthotropic {
    Orthotropic {
        young: [material.young; 3],
        poisson: [material.poisson; 3],
        shear: [material.young / (2.0 * (1.0 + material.poisson)); 3],
        expansion: [material.expansion; 3],
        axes: MaterialAxes::spanned([1.0, 2.0, 0.0], [-3.0, 1.0, 0.0])
            .unwrap_or(MaterialAxes::GLOBAL),
    }
}

/// Distorted blocks of every kind in every model but the ring, which a block at the axis can be as well.
fn bodies() -> Vec<Body> {
    let mut bodies = Vec::new();
    for kind in CellKind::all() {
        bodies.push(distorted(kind));
        if kind.dimension() == 2 {
            for model in [Model::PlaneStress { thickness: 0.1 }, Model::Axisymmetric] {
                let mut body = distorted(kind);
                body.model = model;
                body.mesh.nodes.iter_mut().for_each(|x| x[0] += 1.0);
                bodies.push(body);
            }
        }
    }
    bodies
}

fn warm(body: &mut Body) {
    body.loads = vec![Load::Temperature {
        cells: (0..body.mesh.cell_count()).collect(),
        rise: body
            .mesh
            .nodes
            .iter()
            .map(|x| 1.0 + x[0] - 2.0 * x[1])
            .collect(),
    }];
}

fn largest<'a>(values: impl IntoIterator<Item = &'a f64>) -> f64 {
    values.into_iter().fold(0.0, |m: f64, v| m.max(v.abs()))
}

fn assert_near(found: &[f64], expected: &[f64], what: &str) {
    let scale = largest(expected);
    let off = found.iter().zip(expected).map(|(a, b)| (a - b).abs());
    let off = off.fold(0.0, f64::max);
    assert!(
        found.len() == expected.len() && off <= 1e-12 * scale,
        "{what}: {off:e} of {scale:e}"
    );
}

#[test]
fn isotropic_constants_give_the_same_through_the_orthotropic_door() {
    for mut body in bodies() {
        warm(&mut body);
        for poisson in [0.3, 0.49, -0.5] {
            body.materials[0] = Material {
                poisson,
                expansion: 1e-2,
                ..body.materials[0]
            };
            let mut oriented = body.clone();
            oriented.materials[0] = Material::oriented(isotropic(body.materials[0]));
            let u: Vec<f64> = (0..body.mesh.dimension * body.mesh.nodes.len())
                .map(|i| (i as f64).sin())
                .collect();
            let what = format!("{:?} {:?} {poisson}", body.mesh.cell(0).kind, body.model);
            let of = |body: &Body| {
                let cells = cell_stress(body, &u);
                let nodes = nodal_stress(body, &u, &cells);
                let recovery = stress_recovery(body, &u);
                let stress = [cells, nodes].concat().concat();
                (
                    stiffness(body).data().to_vec(),
                    load_vector(body),
                    stress,
                    vec![recovery.error, recovery.energy],
                )
            };
            let (found, expected) = (of(&oriented), of(&body));
            assert_near(&found.0, &expected.0, &what);
            assert_near(&found.1, &expected.1, &what);
            assert_near(&found.2, &expected.2, &what);
            assert_near(&found.3, &expected.3, &what);
        }
    }
}

/// The block with rollers on left, bottom and front, so that it may stretch.
fn on_rollers(body: &mut Body) {
    let axes = body.mesh.dimension;
    let sides = [("left", 0), ("bottom", axes - 1), ("front", 1)];
    sides
        .into_iter()
        .take(axes)
        .for_each(|(side, axis)| hold(body, side, axis));
}

fn assert_linear(body: &Body, u: &[f64], slopes: [f64; 3], what: &str) {
    let axes = body.mesh.dimension;
    let nodes = body.mesh.nodes.iter();
    let expected: Vec<f64> = nodes
        .flat_map(|x| (0..axes).map(move |k| slopes[k] * x[k]))
        .collect();
    let off = u
        .iter()
        .zip(&expected)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max);
    assert!(off < 1e-10 * largest(&expected), "{what}: {off:e}");
}

#[test]
fn a_bar_of_wood_stretches_along_each_axis_by_the_constants_of_that_axis() {
    // σ_xx = 3: ε = 3 (1/E_1, −ν_12/E_1, −ν_13/E_1); plane stress the same without z, plane strain with
    // E' = E_1/(1 − ν_13 ν_31), ν' = (ν_12 + ν_13 ν_32)/(1 − ν_13 ν_31), ν_31 = ν_13 E_3/E_1, ν_32 = ν_23 E_3/E_2.
    let [n12, n13, n23] = WOOD.poisson;
    let [e1, e2, e3] = WOOD.young;
    let out = 1.0 - n13 * n13 * e3 / e1;
    for kind in CellKind::all() {
        let mut body = distorted(kind);
        body.materials[0] = Material::oriented(WOOD);
        on_rollers(&mut body);
        let facets = facets(&body.mesh, "right");
        body.loads = vec![Load::Pressure {
            facets,
            pressure: -3.0,
        }];
        let plane = [3.0 * out / e1, -3.0 * (n12 + n13 * n23 * e3 / e2) / e1, 0.0];
        let free = [3.0 / e1, -3.0 * n12 / e1, -3.0 * n13 / e1];
        let slopes = if kind.dimension() == 2 { plane } else { free };
        assert_linear(&body, &solve(&body), slopes, &format!("{kind:?}"));
        if kind.dimension() == 2 {
            body.model = Model::PlaneStress { thickness: 0.1 };
            assert_linear(&body, &solve(&body), free, &format!("{kind:?} plate"));
        }
    }
}

#[test]
fn a_warm_bar_of_wood_grows_along_each_axis_by_its_own_expansion_without_stress() {
    for kind in CellKind::all() {
        let mut body = distorted(kind);
        body.materials[0] = Material::oriented(WOOD);
        if kind.dimension() == 2 {
            body.model = Model::PlaneStress { thickness: 0.1 };
        }
        on_rollers(&mut body);
        warm(&mut body);
        body.loads[0] = match &body.loads[0] {
            Load::Temperature { cells, rise } => Load::Temperature {
                cells: cells.clone(),
                rise: vec![2.0; rise.len()],
            },
            other => other.clone(),
        };
        let u = solve(&body);
        assert_linear(
            &body,
            &u,
            WOOD.expansion.map(|alpha| 2.0 * alpha),
            &format!("{kind:?}"),
        );
        let stress = cell_stress(&body, &u).concat();
        assert!(largest(&stress) < 1e-11, "{kind:?}");
    }
}

#[test]
fn a_lamina_pulled_aslant_has_the_modulus_of_its_angle() {
    // 1/E_x = c⁴/E_1 + (1/G_12 − 2 ν_12/E_1) s² c² + s⁴/E_2 (Jones, eq. 2.97): the energy of σ_xx = 1 is V/E_x.
    let (sin, cos) = 0.6_f64.sin_cos();
    let [e1, e2, _] = WOOD.young;
    let expected = cos.powi(4) / e1
        + (1.0 / WOOD.shear[0] - 2.0 * WOOD.poisson[0] / e1) * (sin * cos).powi(2)
        + sin.powi(4) / e2;
    let axes =
        MaterialAxes::spanned([cos, sin, 0.0], [-sin, cos, 0.0]).unwrap_or(MaterialAxes::GLOBAL);
    for kind in CellKind::all() {
        let mut body = distorted(kind);
        body.materials[0] = Material::oriented(Orthotropic { axes, ..WOOD });
        if kind.dimension() == 2 {
            body.model = Model::PlaneStress { thickness: 1.0 };
        }
        // Held at three points without strain; the left side is pulled as the right one.
        let corner = |at: [f64; 3]| {
            body.mesh
                .nodes
                .iter()
                .position(|x| *x == at)
                .unwrap_or_default()
        };
        let mut pins = vec![([0.0; 3], vec![0, 1]), ([2.0, 0.0, 0.0], vec![1])];
        if kind.dimension() == 3 {
            pins = vec![
                ([0.0; 3], vec![0, 1, 2]),
                ([2.0, 0.0, 0.0], vec![1, 2]),
                ([0.0, 1.0, 0.0], vec![2]),
            ];
        }
        let pins: Vec<Support> = pins
            .into_iter()
            .map(|(at, axes)| super::samples::support(&[corner(at)], &axes))
            .collect();
        body.supports = pins;
        body.loads = ["left", "right"]
            .map(|side| Load::Pressure {
                facets: facets(&body.mesh, side),
                pressure: -1.0,
            })
            .into();
        let u = solve(&body);
        let found = stress_recovery(&body, &u);
        assert!(
            (found.energy / (2.0 * expected) - 1.0).abs() < 1e-10,
            "{kind:?} {found:?} {expected}"
        );
        assert!(found.error < 1e-18, "{kind:?} {found:?}");
    }
}

#[test]
fn a_turned_material_is_a_turned_body() {
    // K of the turned body is Q K Qᵀ, node by node; nearly incompressible too.
    let turn = Rotation3::from_euler_angles(0.4, -0.7, 1.1).into_inner();
    let rubbery = Orthotropic {
        young: [3.0, 2.0, 2.5],
        poisson: [0.58, 0.5, 0.42],
        ..WOOD
    };
    assert!(Material::oriented(rubbery).validate("rubber").is_ok());
    assert!(
        Material::oriented(rubbery).is_nearly_incompressible()
            && !Material::oriented(WOOD).is_nearly_incompressible()
    );
    for constants in [WOOD, rubbery] {
        for kind in CellKind::all().filter(|kind| kind.dimension() == 3) {
            let mut body = distorted(kind);
            body.materials[0] = Material::oriented(constants);
            let mut turned = body.clone();
            let rows = turn.column_iter().map(|axis| [axis[0], axis[1], axis[2]]);
            let rows: Vec<[f64; 3]> = rows.collect();
            let axes = MaterialAxes::Fixed([rows[0], rows[1], rows[2]]);
            turned.materials[0] = Material::oriented(Orthotropic { axes, ..constants });
            for x in &mut turned.mesh.nodes {
                *x = (turn * Vector3::from(*x)).into();
            }
            let scale = largest(stiffness(&body).data());
            let (plain, turned) = (stiffness(&body), stiffness(&turned));
            let block = |k: &sprs::CsMat<f64>, a: usize, b: usize| {
                Matrix3::from_fn(|i, j| k.get(3 * a + i, 3 * b + j).copied().unwrap_or(0.0))
            };
            for a in 0..body.mesh.nodes.len().min(30) {
                for b in 0..body.mesh.nodes.len() {
                    let expected = turn * block(&plain, a, b) * turn.transpose();
                    assert!(
                        (block(&turned, a, b) - expected).amax() < 1e-13 * scale,
                        "{kind:?}"
                    );
                }
            }
        }
    }
}

/// Quarter of a plate with a hole, radii 1 and 2 m, wound around: `E_r = 1`, `E_θ = 9`, under 1 Pa in the hole.
fn wound(kind: CellKind) -> Body {
    let mut body = block(kind);
    let along = crate::body::graded(0.0, 1.0, 8, 1.0).unwrap_or_default();
    body.mesh = crate::body::rectangle(&along, &along, kind).unwrap_or_default();
    body.material_of_cell = vec![0; body.mesh.cell_count()];
    for x in &mut body.mesh.nodes {
        let (sin, cos) = (std::f64::consts::FRAC_PI_2 * x[1]).sin_cos();
        *x = [(1.0 + x[0]) * cos, (1.0 + x[0]) * sin, 0.0];
    }
    body.model = Model::PlaneStress { thickness: 1.0 };
    hold(&mut body, "bottom", 1);
    hold(&mut body, "top", 0);
    body
}

#[test]
fn a_wound_disc_widens_as_lekhnitskii_says() {
    // k² = E_θ/E_r, c = a/b: σ_r = P ((r/b)^(k−1) − (r/b)^(−k−1)), σ_θ = k P ((r/b)^(k−1) + (r/b)^(−k−1)),
    // P = p c^(k+1)/(1 − c^(2k)), u_r = r (σ_θ − ν_θr σ_r)/E_θ (Lekhnitskii, Anisotropic Plates (1968), art. 26).
    let (k, c) = (3.0_f64, 0.5_f64);
    let constants = Orthotropic {
        young: [1.0, 9.0, 2.0],
        poisson: [0.03, 0.0, 0.0],
        shear: [0.7; 3],
        expansion: [0.0; 3],
        axes: MaterialAxes::Around(Line {
            point: [0.0; 3],
            direction: [0.0, 0.0, 1.0],
        }),
    };
    let amplitude = c.powf(k + 1.0) / (1.0 - c.powf(2.0 * k));
    let [near, far] = [c.powf(k - 1.0), c.powf(-k - 1.0)].map(|x| amplitude * x);
    let expected = (k * (near + far) - 0.03 * 9.0 * (near - far)) / 9.0;
    for kind in [CellKind::Quad8, CellKind::Quad9, CellKind::Tri6] {
        let mut disc = wound(kind);
        disc.materials[0] = Material::oriented(constants);
        let mut ring = wound(kind);
        let radii = crate::body::graded(1.0, 2.0, 8, 1.0).unwrap_or_default();
        ring.mesh = crate::body::rectangle(&radii, &[0.0, 0.3], kind).unwrap_or_default();
        ring.material_of_cell = vec![0; ring.mesh.cell_count()];
        ring.model = Model::Axisymmetric;
        // No coupling with the axis: each slice of the ring is a plate. In the section 1 is radial, 2 axial, 3 around.
        let section = Orthotropic {
            young: [1.0, 2.0, 9.0],
            poisson: [0.0, 0.03, 0.0],
            axes: MaterialAxes::GLOBAL,
            ..constants
        };
        ring.materials[0] = Material::oriented(section);
        ring.supports.clear();
        hold(&mut ring, "bottom", 1);
        for mut body in [disc, ring] {
            let facets = facets(&body.mesh, "left");
            body.loads = vec![Load::Pressure {
                facets,
                pressure: 1.0,
            }];
            let found = solve(&body)[0];
            // Cubic in the size of a cell where the field goes as r^−4.
            assert!(
                (found / expected - 1.0).abs() < 2e-3,
                "{kind:?} {:?}: {found} {expected}",
                body.model
            );
        }
    }
}

#[test]
fn a_nearly_incompressible_oriented_body_has_the_stress_and_energy_of_a_linear_displacement() {
    let rubbery = Orthotropic {
        young: [3.0, 2.0, 2.5],
        poisson: [0.58, 0.5, 0.42],
        ..WOOD
    };
    let h = Matrix3::new(0.3, 0.1, 0.0, 0.4, -0.6, 0.0, 0.0, 0.0, 0.0);
    for kind in CellKind::all() {
        let mut body = distorted(kind);
        body.materials[0] = Material::oriented(rubbery);
        let axes = kind.dimension();
        let nodes = body.mesh.nodes.iter().map(|x| h * Vector3::from(*x));
        let u: Vec<f64> = nodes.flat_map(|u| (0..axes).map(move |k| u[k])).collect();
        let recovery = stress_recovery(&body, &u);
        let twice: f64 = stiffness(&body)
            .iter()
            .map(|(entry, (i, j))| u[i] * entry * u[j])
            .sum();
        assert!((recovery.energy / twice - 1.0).abs() < 1e-11, "{kind:?}");
        assert!(
            recovery.error < 1e-18 * recovery.energy,
            "{kind:?} {recovery:?}"
        );
    }
}

#[test]
fn constants_without_positive_energy_are_refused_with_their_place_and_a_cure() {
    let say = |change: &dyn Fn(&mut Orthotropic)| {
        let mut constants = WOOD;
        change(&mut constants);
        constants
            .validate("m")
            .map_or_else(|error| error.to_string(), |()| String::new())
    };
    assert_eq!(say(&|_| ()), "");
    assert!(say(&|c| c.young[1] = 0.0).contains("m.young[1]: 0"));
    assert!(say(&|c| c.shear[2] = f64::NAN).contains("m.shear[2]: NaN"));
    // |ν_23| < √(0.5/0.8) = 0.7906.
    let ratio = say(&|c| c.poisson[2] = 0.8);
    assert!(
        ratio.contains("m.poisson[2]: 0.8") && ratio.contains("±0.7906"),
        "{ratio}"
    );
    let all = say(&|c| c.poisson = [4.0, 3.0, 0.7]);
    assert!(
        all.contains("m.poisson:") && all.contains("smaller"),
        "{all}"
    );
    assert!(say(&|c| c.axes = MaterialAxes::Fixed([[1.0; 3]; 3])).contains("m.axes"));
    assert!(WOOD.check_plane("m", Model::PlaneStrain).is_ok());
    let aslant =
        MaterialAxes::spanned([1.0, 0.0, 1.0], [0.0, 1.0, 0.0]).unwrap_or(MaterialAxes::GLOBAL);
    let aslant = Orthotropic {
        axes: aslant,
        ..WOOD
    };
    assert!(
        aslant.check_plane("m", Model::PlaneStrain).is_err()
            && aslant.check_plane("m", Model::Solid).is_ok()
    );
}
