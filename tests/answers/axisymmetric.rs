//! Axisymmetric bodies in contact: discs, balls and flat punches at the price of a section.

use dpana::body::{CellKind, Facet, Group, Mesh, rectangle};
use dpana::closed_forms::{FlatRoundPunch, HertzSphere, friction_of_stick_sphere};
use dpana::report::{Report, ReportedContactState};
use dpana::scene::MeshSource;
use dpana::{Scene, Solution, Status, solve};
use serde_json::{Value, json};

const PLANE_KINDS: [CellKind; 5] = [
    CellKind::Tri3,
    CellKind::Quad4,
    CellKind::Tri6,
    CellKind::Quad8,
    CellKind::Quad9,
];

pub(crate) fn with_meshes(scene: &Value, meshes: Vec<Mesh>) -> Scene {
    let mut scene = Scene::from_json(&scene.to_string(), "").unwrap();
    for (body, mesh) in scene.bodies.iter_mut().zip(meshes) {
        body.mesh = MeshSource::Given(mesh);
    }
    scene
}

pub(crate) fn certified(scene: &Scene) -> (Solution, Report) {
    let solution = solve(scene).unwrap();
    assert_eq!(solution.status(), Status::Certified);
    let report = solution.report().unwrap();
    (solution, report)
}

/// Coordinates from 0 to `end` whose first cells have the size `fine` up to `even`, then each is a
/// fifth larger than the one before.
pub(crate) fn growing(fine: f64, even: f64, end: f64) -> Vec<f64> {
    let count = (even / fine).round() as usize;
    let mut lines: Vec<f64> = (0..=count)
        .map(|k| k as f64 * even / count as f64)
        .collect();
    let (mut size, mut last) = (fine, even);
    while last + 2.0 * size < end {
        size *= 1.2;
        last += size;
        lines.push(last);
    }
    lines.push(end);
    lines
}

/// From `−end` up to 0.
pub(crate) fn falling(lines: &[f64]) -> Vec<f64> {
    lines.iter().rev().map(|y| 0.0 - y).collect()
}

fn body(name: &str, young: f64, poisson: f64, supports: &Value, loads: &Value) -> Value {
    json!({
        "name": name, "mesh": {"file": "given in code"}, "model": "axisymmetric",
        "materials": [{"young": young, "poisson": poisson}],
        "supports": supports, "loads": loads
    })
}

#[test]
fn two_cylinders_carry_their_pressure_evenly_on_meshes_that_do_not_match() {
    // p = E δ/2 for unit heights, 1000 · 0.002; the force is π R² p = 2π with R = 1.
    for kinds in [
        [CellKind::Quad4, CellKind::Quad4],
        [CellKind::Tri3, CellKind::Quad8],
        [CellKind::Quad9, CellKind::Tri6],
        [CellKind::Tri6, CellKind::Quad4],
    ] {
        let scene = json!({
            "bodies": [
                body("lower", 1000.0, 0.3, &json!([{"group": "bottom", "displacement": [null, 0]}]), &json!([])),
                body("upper", 1000.0, 0.3, &json!([{"group": "top", "displacement": [null, -0.004]}]), &json!([])),
            ],
            "contacts": [{
                "body": "upper", "group": "bottom", "friction": 0.3,
                "against": {"body": "lower", "group": "top"}
            }]
        });
        let block = |kind, count: usize, low: f64| {
            let xs: Vec<f64> = (0..=count)
                .map(|k| (k as f64 / count as f64).powf(1.3))
                .collect();
            rectangle(&xs, &[low, low + 0.4, low + 1.0], kind).unwrap()
        };
        let meshes = vec![block(kinds[0], 5, 0.0), block(kinds[1], 7, 1.0)];
        let (_, report) = certified(&with_meshes(&scene, meshes));
        // Certified to 1e-12, and a digit for the condition of G, 6 to 15 contacts across.
        for contact in &report.contacts {
            let off = (contact.pressure.unwrap() / 2.0 - 1.0).abs();
            assert!(off < 1e-11, "{kinds:?} {off:e} {contact:?}");
        }
        let total = std::f64::consts::TAU;
        assert!((report.totals.normal / total - 1.0).abs() < 1e-12);
        assert!(report.certificate.bodies[0].force_defect.scaled < 1e-12);
        assert!(report.certificate.bodies[1].moment_defect.scaled < 1e-12);
    }
}

#[test]
fn a_disc_that_nothing_holds_rests_on_the_plane_by_its_weight() {
    for kind in PLANE_KINDS {
        let load = json!([{"body_force": [0, -3]}]);
        let scene = json!({
            "bodies": [body("disc", 1000.0, 0.3, &json!([]), &load)],
            "contacts": [{
                "group": "bottom", "friction": 0.3,
                "obstacle": {"plane": {"point": [0, 0], "normal": [0, 1]}}
            }]
        });
        let mesh = rectangle(&[0.0, 0.3, 0.7, 1.0], &[0.0, 0.2, 0.5], kind).unwrap();
        let (_, report) = certified(&with_meshes(&scene, vec![mesh]));
        // 3 N/m³ · π · 1² · 0.5 m³.
        let weight = 1.5 * std::f64::consts::PI;
        assert!(
            (report.totals.normal / weight - 1.0).abs() < 1e-12,
            "{kind:?}"
        );
    }
}

/// A rigid ball of radius 10 pressed 0.010184090 into a block of 2.1e5, ν = 0.3: P = 1000.
fn ball(kind: CellKind, fine: f64) -> (HertzSphere, Report) {
    let hertz = HertzSphere::new(1000.0, 10.0, 2.1e5 / 0.91).unwrap();
    let supports = json!([{"group": "bottom", "displacement": [null, hertz.approach]}]);
    let scene = json!({
        "bodies": [body("block", 2.1e5, 0.3, &supports, &json!([]))],
        "contacts": [{
            "group": "top", "friction": 0,
            "obstacle": {"circle": {"center": [0, 10], "radius": 10}}
        }]
    });
    let lines = growing(fine, 0.4, 120.0);
    let mesh = rectangle(&lines, &falling(&lines), kind).unwrap();
    (hertz, certified(&with_meshes(&scene, vec![mesh])).1)
}

#[test]
fn a_ball_on_a_block_is_hertz_contact() {
    for (kind, fine) in [
        (CellKind::Quad4, 0.01),
        (CellKind::Tri6, 0.02),
        (CellKind::Quad8, 0.02),
        (CellKind::Quad9, 0.02),
    ] {
        let (hertz, report) = ball(kind, fine);
        // A point force moves what lies L = 120 below by 0.73 a/L = 0.2 % of the approach; a base that may not move
        // takes up to twice that, which is 0.6 % of the force, 0.2 % of p₀ and of a. n = 32 contacts per radius miss
        // the pressure by 0.11/n = 0.35 % (references: strips in the plane).
        let force = report.totals.normal;
        assert!((force / hertz.load - 1.0).abs() < 0.01, "{kind:?} {force}");
        let peak = report.totals.peak_pressure;
        assert!((peak / hertz.peak - 1.0).abs() < 0.01, "{kind:?} {peak}");
        // ∫ p r² dA = 2/5 a² P.
        let moment: f64 = report
            .contacts
            .iter()
            .map(|c| c.pressure.unwrap() * c.area * c.position[0].powi(2))
            .sum();
        let radius = (2.5 * moment / force).sqrt();
        let off = (radius / hertz.contact_radius - 1.0).abs();
        assert!(off < 0.01, "{kind:?} {radius}");
        let inside = report
            .contacts
            .iter()
            .filter(|c| c.position[0] < 0.8 * hertz.contact_radius);
        // A rim that is a quarter of a cell off, a/(4n), counts 1/(1 − 0.8²) times as much there: 2 %.
        for contact in inside {
            let expected = hertz.pressure(contact.position[0]);
            let off = (contact.pressure.unwrap() / expected - 1.0).abs();
            assert!(off < 0.015, "{kind:?} {off} {contact:?}");
        }
    }
}

/// A flat punch of radius 1 pressed 1e-3 into a block of unit modulus; its face has 2 · 24 cells.
fn punch(kind: CellKind, poisson: f64, friction: f64, even: bool) -> (Solution, Report) {
    let supports = json!([{"group": "bottom", "displacement": [null, 1e-3]}]);
    let scene = json!({
        "bodies": [body("block", 1.0, poisson, &supports, &json!([]))],
        "contacts": [{
            "group": "face", "friction": friction,
            "obstacle": {"plane": {"point": [0, 0], "normal": [0, -1]}}
        }]
    });
    let fine = if even { 0.02 } else { 0.002 };
    let mut xs: Vec<f64> = if even {
        (0..=50).map(|k| f64::from(k) / 50.0).collect()
    } else {
        falling(&growing(fine, fine, 1.0))
            .iter()
            .map(|x| 1.0 + x)
            .collect()
    };
    xs.extend(growing(fine, fine, 299.0)[1..].iter().map(|x| 1.0 + x));
    let ys = falling(&growing(fine, 2.0 * fine, 300.0));
    let mut mesh = rectangle(&xs, &ys, kind).unwrap();
    let Group::Facets(top) = mesh.groups["top"].clone() else {
        unreachable!()
    };
    let below = |facet: &Facet| facet.nodes.iter().all(|node| mesh.nodes[*node][0] <= 1.0);
    let face = top.into_iter().filter(below).collect();
    mesh.groups.insert("face".to_owned(), Group::Facets(face));
    certified(&with_meshes(&scene, vec![mesh]))
}

#[test]
fn a_flat_punch_sinks_as_boussinesq_says() {
    for kind in [CellKind::Quad4, CellKind::Quad9] {
        let (_, report) = punch(kind, 0.3, 0.0, false);
        let exact = FlatRoundPunch::new(report.totals.normal, 1.0, 1.0 / 0.91).unwrap();
        // The mesh's punch is up to half a cell wider, 0.1 %, and the far side takes up to a/L = 0.33 %; the
        // pressure at 0.9 a feels its radius 1/(1 − 0.9²) = 5.3 times.
        let off = (exact.approach / 1e-3 - 1.0).abs();
        assert!(off < 0.01, "{kind:?} {off}");
        for contact in report.contacts.iter().filter(|c| c.position[0] < 0.9) {
            let expected = exact.pressure(contact.position[0]);
            let off = (contact.pressure.unwrap() / expected - 1.0).abs();
            assert!(off < 0.015, "{kind:?} {off} {contact:?}");
        }
    }
}

#[test]
fn half_of_a_flat_punch_sticks_with_the_friction_that_goodman_says() {
    // β = (1 − 2ν)/(2(1 − ν)); what shear does to pressure is of the order β² and neglected there.
    let poisson = 0.44;
    let beta = (1.0 - 2.0 * poisson) / (2.0 * (1.0 - poisson));
    let friction = friction_of_stick_sphere(beta, 0.5).unwrap();
    for kind in [CellKind::Quad4, CellKind::Quad8] {
        let (_, report) = punch(kind, poisson, friction, true);
        let sticks = report
            .contacts
            .iter()
            .filter(|c| c.state == ReportedContactState::Stick);
        let radius = sticks.map(|c| c.position[0]).fold(0.0, f64::max);
        // A cell of 0.02 on either side, and 1 % of β².
        assert!((radius - 0.5).abs() < 0.03, "{kind:?} {radius}");
        let slips = report
            .contacts
            .iter()
            .filter(|c| c.state == ReportedContactState::Slip);
        assert!(slips.clone().count() > 10 && slips.clone().all(|c| c.position[0] > radius));
    }
}

#[test]
fn a_cone_meets_the_axis_with_its_apex() {
    // Sneddon: P = 2 E* δ² / (π tan a), a: slope of the cone's flank; a contact radius of 2δ/(π tan a).
    // Steeper flanks also feel how points move along the surface, which Sneddon neglects.
    let slope: f64 = 0.01;
    let depth = 0.006;
    let supports = json!([{"group": "bottom", "displacement": [null, depth]}]);
    let scene = json!({
        "bodies": [body("block", 1.0, 0.3, &supports, &json!([]))],
        "contacts": [{
            "group": "top", "friction": 0,
            "obstacle": {"plane": {"point": [0, 0], "normal": [slope, -1]}}
        }]
    });
    for kind in [CellKind::Quad4, CellKind::Quad9] {
        let lines = growing(0.01, 0.5, 120.0);
        let mesh = rectangle(&lines, &falling(&lines), kind).unwrap();
        let (_, report) = certified(&with_meshes(&scene, vec![mesh]));
        let exact = 2.0 / 0.91 * depth * depth / (std::f64::consts::PI * slope);
        // A radius of 0.38 is 38 cells, and 0.3 % of the height, which counts twice: P goes with δ².
        let off = (report.totals.normal / exact - 1.0).abs();
        assert!(off < 0.015, "{kind:?} {off} {}", report.totals.normal);
    }
}

#[test]
fn what_does_not_go_around_the_axis_is_refused() {
    let scene = |supports: &Value, obstacle: &Value| {
        json!({
            "bodies": [body("block", 1.0, 0.3, supports, &json!([]))],
            "contacts": [{"group": "top", "friction": 0, "obstacle": obstacle}]
        })
    };
    let refused = |scene: &Value, xs: &[f64]| {
        let mesh = rectangle(xs, &[-1.0, 0.0], CellKind::Quad4).unwrap();
        solve(&with_meshes(scene, vec![mesh]))
            .unwrap_err()
            .to_string()
    };
    let held = json!([{"group": "bottom", "displacement": [null, 0]}]);
    let plane = json!({"plane": {"point": [0, 0], "normal": [0, -1]}});
    let found = refused(&scene(&held, &plane), &[-0.5, 0.0, 1.0]);
    assert!(
        found.contains("-0.5") && found.contains("radius"),
        "{found}"
    );
    let circle = json!({"circle": {"center": [0.25, 1], "radius": 1}});
    let found = refused(&scene(&held, &circle), &[0.0, 1.0]);
    assert!(
        found.contains("center") && found.contains("0.25"),
        "{found}"
    );
    let pulled = json!([{"group": "left", "displacement": [0.125, 0]}]);
    let found = refused(&scene(&pulled, &plane), &[0.0, 1.0]);
    assert!(found.contains("0.125") && found.contains("axis"), "{found}");
    let mut mixed = json!({
        "bodies": [
            body("ring", 1.0, 0.3, &held, &json!([])),
            body("plate", 1.0, 0.3, &json!([]), &json!([])),
        ],
        "contacts": [{
            "body": "plate", "group": "bottom", "friction": 0,
            "against": {"body": "ring", "group": "top"}
        }]
    });
    mixed["bodies"][1]["model"] = json!("plane_strain");
    let mesh = |low: f64| rectangle(&[0.0, 1.0], &[low, low + 1.0], CellKind::Quad4).unwrap();
    let found = solve(&with_meshes(&mixed, vec![mesh(-1.0), mesh(0.0)])).unwrap_err();
    assert!(found.to_string().contains("axisymmetric"), "{found}");
}
