//! Rigid bodies that are moved, or free under a force: closed forms, statics, and one against the other.

use dpana::body::{CellKind, Mesh, box_mesh, rectangle};
use dpana::closed_forms::{FlatRoundPunch, HertzSphere, wedge_pull};
use dpana::report::{Beyond, Report};
use dpana::{Scene, Status, Variation, cases, limit, solve, solve_steps};
use serde_json::{Value, json};

use crate::axisymmetric::{certified, falling, growing, with_meshes};
use crate::sensitivity::TOTALS;

const YOUNG: f64 = 1.0;
const MODULUS: f64 = YOUNG / 0.91;

/// A block on a smooth floor below a rigid body, which `moves` as is said.
fn scene(model: &str, surface: &Value, moves: &Value, friction: f64) -> Value {
    let mut rigid = json!({"name": "indenter", "surfaces": [surface], "reference": [0, 0]});
    for (key, value) in moves.as_object().unwrap() {
        rigid[key] = value.clone();
    }
    let held = if model == "axisymmetric" {
        json!([null, 0])
    } else {
        json!([0, 0])
    };
    json!({
        "bodies": [{
            "name": "block", "mesh": {"file": "given in code"}, "model": model,
            "materials": [{"young": YOUNG, "poisson": 0.3}],
            "supports": [{"group": "bottom", "displacement": held}]
        }],
        "rigid_bodies": [rigid],
        "contacts": [{"group": "top", "friction": friction, "rigid_body": "indenter"}]
    })
}

fn report(scene: &Value, mesh: &Mesh) -> Report {
    certified(&with_meshes(scene, vec![mesh.clone()])).1
}

/// Force at a depth, and the same force's depth.
fn round_trip(surface: &Value, depth: f64, mesh: &Mesh) -> (f64, Report) {
    let moved = json!({"displacement": [0, -depth]});
    let moved = report(&scene("axisymmetric", surface, &moved, 0.0), mesh);
    let force = moved.totals.normal;
    assert!((moved.rigid_bodies[0].contact.force[1] / force - 1.0).abs() < 0.01);
    let force = moved.rigid_bodies[0].contact.force[1];
    let pushed = json!({"displacement": [0, null], "force": [0, -force]});
    let pushed = report(&scene("axisymmetric", surface, &pushed, 0.0), mesh);
    let found = &pushed.rigid_bodies[0];
    let off = (found.displacement[1] / -depth - 1.0).abs();
    assert!(off < 1e-9, "{surface} {off:e}");
    assert!(found.force_defect.scaled < 1e-10, "{found:?}");
    (force, pushed)
}

#[test]
fn a_ball_under_a_force_sinks_as_hertz_says() {
    let hertz = HertzSphere::new(1e-3, 10.0, MODULUS).unwrap();
    let fine = hertz.contact_radius / 16.0;
    let lines = growing(fine, 20.0 * fine, 400.0 * hertz.contact_radius);
    let mesh = rectangle(&lines, &falling(&lines), CellKind::Quad4).unwrap();
    let ball = json!({"circle": {"center": [0, 10], "radius": 10}});
    let (force, _) = round_trip(&ball, hertz.approach, &mesh);
    // As in `axisymmetric`: the far side takes up to 0.3 %, 16 contacts miss the pressure by 0.7 %.
    assert!((force / hertz.load - 1.0).abs() < 0.015, "{force}");
    // A paraboloid and an ellipsoid of the same radius at the apex are the same to a²/R², 1e-5.
    for other in [
        json!({"paraboloid": {"apex": [0, 0], "axis": [0, -1], "radius": 10}}),
        json!({"ellipsoid": {"center": [0, 2.5], "radii": [5, 2.5]}}),
    ] {
        let (same, _) = round_trip(&other, hertz.approach, &mesh);
        assert!((same / force - 1.0).abs() < 1e-3, "{other} {same} {force}");
    }
}

#[test]
fn a_cone_under_a_force_sinks_as_sneddon_says() {
    // P = 2 E* δ² / (π tan a), a: slope of the flank.
    let (slope, depth) = (0.01_f64, 0.006);
    let lines = growing(0.02, 0.5, 120.0);
    let mesh = rectangle(&lines, &falling(&lines), CellKind::Quad4).unwrap();
    let half_angle = 90.0 - slope.atan().to_degrees();
    let cone = json!({"cone": {"apex": [0, 0], "axis": [0, -1], "half_angle": half_angle}});
    let (force, _) = round_trip(&cone, depth, &mesh);
    let exact = 2.0 * MODULUS * depth * depth / (std::f64::consts::PI * slope);
    // Twice as coarse as in `axisymmetric`.
    assert!((force / exact - 1.0).abs() < 0.03, "{force} {exact}");
    // The same as a profile, whose first point is on the axis.
    let profile = json!({"profile": {"points": [[1, slope], [0, 0]]}});
    let (same, _) = round_trip(&profile, depth, &mesh);
    assert!((same / force - 1.0).abs() < 1e-9, "{same} {force}");
}

#[test]
fn a_round_punch_under_a_force_sinks_as_boussinesq_says_and_ends_at_its_edge() {
    let mut xs: Vec<f64> = falling(&growing(0.004, 0.004, 1.0))
        .iter()
        .map(|x| 1.0 + x)
        .collect();
    xs.extend(growing(0.004, 0.004, 299.0)[1..].iter().map(|x| 1.0 + x));
    let mesh = rectangle(
        &xs,
        &falling(&growing(0.004, 0.008, 300.0)),
        CellKind::Quad4,
    )
    .unwrap();
    let punch = json!({"punch": {"center": [0, 0], "axis": [0, -1], "radius": 1}});
    let (force, pushed) = round_trip(&punch, 1e-3, &mesh);
    let exact = FlatRoundPunch::new(force, 1.0, MODULUS).unwrap();
    assert!(
        (exact.approach / 1e-3 - 1.0).abs() < 0.01,
        "{}",
        exact.approach
    );
    assert!(
        pushed
            .contacts
            .iter()
            .all(|contact| contact.position[0] <= 1.0 + 1e-12)
    );
}

/// A block of 60 × 30 below a strip from −1 to 1.
fn under_a_strip() -> Mesh {
    let half: Vec<f64> = falling(&growing(0.01, 0.02, 1.0))
        .iter()
        .map(|x| 1.0 + x)
        .collect();
    let beside: Vec<f64> = growing(0.01, 0.02, 29.0)[1..]
        .iter()
        .map(|x| 1.0 + x)
        .collect();
    let right: Vec<f64> = half.into_iter().chain(beside).collect();
    let left = right[1..].iter().rev().map(|x| -x);
    let xs: Vec<f64> = left.chain(right.iter().copied()).collect();
    rectangle(&xs, &falling(&growing(0.02, 0.04, 30.0)), CellKind::Quad4).unwrap()
}

#[test]
fn a_punch_under_an_eccentric_force_tilts_as_the_closed_form() {
    // A flat punch of half-width a on a half-plane, pressed all over: φ = 4 M/(π E* a²), from
    // p = E* φ x / (2 √(a² − x²)). (Muskhelishvili, Some Basic Problems, § 115; Johnson, § 2.8.)
    let mesh = under_a_strip();
    let strip = json!({"punch": {"center": [0, 0], "axis": [0, -1], "radius": 1}});
    let (load, moment) = (1e-3, -2e-4);
    let pushed = json!({
        "displacement": [0, null], "force": [0, -load], "rotation": [null], "moment": [moment]
    });
    let tilted = report(&scene("plane_strain", &strip, &pushed, 0.0), &mesh);
    let found = &tilted.rigid_bodies[0];
    let exact = 4.0 * moment / (std::f64::consts::PI * MODULUS);
    // Cells of 0.01 at the edge widen the punch by up to half of one, and a² twice that; the block is finite.
    assert!(
        (found.rotation[0] / exact - 1.0).abs() < 0.015,
        "{} {exact}",
        found.rotation[0]
    );
    assert!((found.contact.moment[0] + moment).abs() < 1e-12 * load);
    assert_eq!(tilted.totals.open, 0);
    // Moved by what was found it carries what it was pushed with.
    let moved = json!({"displacement": [0, found.displacement[1]], "rotation": found.rotation});
    let moved = report(&scene("plane_strain", &strip, &moved, 0.0), &mesh);
    let carried = &moved.rigid_bodies[0].contact;
    assert!((carried.force[1] / load - 1.0).abs() < 1e-9, "{carried:?}");
    assert!(
        (carried.moment[0] / -moment - 1.0).abs() < 1e-9,
        "{carried:?}"
    );
    // Beyond e = a/2 the far edge lifts off.
    let pushed = json!({
        "displacement": [0, null], "force": [0, -load], "rotation": [null], "moment": [-0.6 * load]
    });
    let lifted = report(&scene("plane_strain", &strip, &pushed, 0.0), &mesh);
    assert!(lifted.totals.open > 0);
}

#[test]
fn a_loose_rigid_wedge_is_pulled_up_a_slope_by_the_force_of_the_formula() {
    // NAFEMS CGS-4: F/G = (tan a + μ)/(1 − μ tan a). The slope is elastic, the wedge is not.
    let tan = 0.1;
    let mut mesh = rectangle(
        &(0..=8).map(|k| f64::from(k) * 0.5).collect::<Vec<_>>(),
        &[0.0, 0.5, 1.0],
        CellKind::Quad4,
    )
    .unwrap();
    for [x, y, _] in &mut mesh.nodes {
        *y += tan * *x;
    }
    let plane = json!({"plane": {"point": [2, 1.2], "normal": [tan, -1]}});
    let with = |friction: f64, pull: f64| {
        let free = json!({
            "reference": [2, 1.2], "displacement": [null, null], "rotation": [null], "force": [pull, -1e-3]
        });
        with_meshes(
            &scene("plane_strain", &plane, &free, friction),
            vec![mesh.clone()],
        )
    };
    for friction in [0.1, 0.2, 0.3] {
        let exact = 1e-3 * wedge_pull(tan, friction).unwrap();
        let held = solve(&with(friction, exact * (1.0 - 1e-8))).unwrap();
        assert_eq!(held.status(), Status::Certified, "{friction}");
        let report = held.report().unwrap();
        let force = &report.rigid_bodies[0].contact.force;
        assert!((force[0] / -exact - 1.0).abs() < 1e-7 && (force[1] / 1e-3 - 1.0).abs() < 1e-9);
        let pulled = solve(&with(friction, exact * (1.0 + 1e-8))).unwrap();
        assert_eq!(pulled.status(), Status::NoEquilibrium, "{friction}");
        let words = pulled.report().unwrap().failure.unwrap().words;
        assert!(
            words.starts_with("indenter slides along (0.995, 0.100"),
            "{words}"
        );
        let limits = limit(&with(friction, 1e-3)).unwrap();
        let pull = limits
            .loads
            .iter()
            .find(|load| load.place == "rigid_bodies[0].force[0]");
        let (factor, certified) = match &pull.unwrap().beyond {
            Beyond::Grows {
                factor, certified, ..
            } => (*factor, *certified),
            _ => (f64::NAN, false),
        };
        assert!(
            certified && (factor * 1e-3 / exact - 1.0).abs() < 1e-6,
            "{factor} {exact}"
        );
    }
}

#[test]
fn a_torque_on_a_roller_is_friction_times_its_radius() {
    let (radius, load) = (50.0, 1e-3);
    let roller = json!({"circle": {"center": [0, radius], "radius": radius}});
    let lines: Vec<f64> = (-40..=40).map(|k| f64::from(k) * 0.05).collect();
    let mesh = rectangle(&lines, &falling(&growing(0.05, 0.2, 4.0)), CellKind::Quad4).unwrap();
    let turned = |torque: f64| {
        let free = json!({
            "reference": [0, radius], "displacement": [0, null], "force": [0, -load],
            "rotation": [null], "moment": [torque]
        });
        with_meshes(
            &scene("plane_strain", &roller, &free, 0.3),
            vec![mesh.clone()],
        )
    };
    let torque = 0.2 * load * radius;
    let (_, report) = certified(&turned(torque));
    let found = &report.rigid_bodies[0];
    assert!(
        (found.contact.moment[0] / -torque - 1.0).abs() < 1e-10,
        "{found:?}"
    );
    assert!(
        (found.contact.force[1] / load - 1.0).abs() < 1e-10,
        "{found:?}"
    );
    // Friction acts at the surface of the block, within its gap of 0.3²/2R of the roller's.
    let push = report.totals.friction[0].abs();
    assert!((push * radius / torque - 1.0).abs() < 1e-4, "{push}");
    assert!(report.totals.stick > 0 && report.totals.slip > 0);
    let spun = solve(&turned(0.31 * load * radius)).unwrap();
    assert_eq!(spun.status(), Status::NoEquilibrium);
    let words = spun.report().unwrap().failure.unwrap().words;
    assert!(
        words.starts_with("indenter turns about +z through (0, 50, 0)"),
        "{words}"
    );
}

#[test]
fn a_rigid_body_that_nothing_stops_is_told_with_its_motion() {
    let strip = json!({"punch": {"center": [0, 0], "axis": [0, -1], "radius": 1}});
    let mesh = rectangle(&[-2.0, -1.0, 0.0, 1.0, 2.0], &[-1.0, 0.0], CellKind::Quad4).unwrap();
    let lifted = json!({"displacement": [0, null], "force": [0, 2e-3]});
    let found = with_meshes(&scene("plane_strain", &strip, &lifted, 0.0), vec![mesh]);
    let found = solve(&found).unwrap();
    assert_eq!(found.status(), Status::NoEquilibrium);
    let failure = found.report().unwrap().failure.unwrap();
    assert_eq!(failure.motions[0].body, "indenter");
    assert!(
        failure.words.starts_with("indenter moves off along +y"),
        "{}",
        failure.words
    );
}

#[test]
fn tables_drive_forces_and_motions_and_the_ledger_closes() {
    let mesh = under_a_strip();
    let strip = json!({"punch": {"center": [0, 0], "axis": [0, -1], "radius": 1}});
    let pushed = json!({"displacement": [0, null], "force": [0, -1e-3]});
    let mut stepped = scene("plane_strain", &strip, &pushed, 0.0);
    stepped["steps"] = json!({
        "at": [1, 2], "factors": {"rigid_bodies[0].force[1]": [[0, 0], [1, 0.5], [2, 1]]}
    });
    let mut seen = Vec::new();
    let scene_of = |scene: &Value| with_meshes(scene, vec![mesh.clone()]);
    solve_steps(&scene_of(&stepped), None, |solution| {
        let report = solution.report()?;
        seen.push((report.rigid_bodies[0].displacement[1], report.step.unwrap()));
        Ok(())
    })
    .unwrap();
    // The contact of a flat punch does not grow: all is linear.
    assert!((seen[1].0 / seen[0].0 - 2.0).abs() < 1e-9, "{seen:?}");
    let total = &seen[1].1.total;
    // ½ F δ.
    assert!(
        (total.obstacles / (0.5 * 1e-3 * -seen[1].0) - 1.0).abs() < 1e-9,
        "{total:?}"
    );
    assert!(
        (total.obstacles - total.elastic).abs() < 1e-9 * total.elastic,
        "{total:?}"
    );
    let factor = Variation {
        name: "rigid_bodies[0].force[1]".to_owned(),
        values: vec![0.5, 1.0],
    };
    let plain = scene("plane_strain", &strip, &pushed, 0.0);
    let table = cases(&scene_of(&plain), &[factor]).unwrap();
    let normal = table.column("normal").unwrap();
    assert!((normal[1] / 1e-3 - 1.0).abs() < 1e-9 && (normal[1] / normal[0] - 2.0).abs() < 1e-9);
}

/// A quarter of a block with cells of `fine` around the origin, seven along each axis and then growing.
fn quarter(fine: f64) -> Mesh {
    let mut lines = vec![0.0];
    let mut size = fine;
    while lines.len() < 14 {
        lines.push(lines[lines.len() - 1] + size);
        size *= if lines.len() > 7 { 2.0 } else { 1.0 };
    }
    let depth: Vec<f64> = falling(&lines);
    let mesh = box_mesh(&lines, &lines, &depth, CellKind::Hex8).unwrap();
    mesh.with_surface("across_x", |[x, _, _]| x == 0.0)
        .and_then(|mesh| mesh.with_surface("across_y", |[_, y, _]| y == 0.0))
        .and_then(|mesh| mesh.with_surface("base", |[_, _, z]| z == depth[0]))
        .and_then(|mesh| mesh.with_surface("face", |[_, _, z]| z == 0.0))
        .unwrap()
}

/// Four times the force on a rigid surface that is moved into it; the same force moves it as far.
fn in_space(surface: &Value, depth: f64, mesh: &Mesh) -> (f64, Report) {
    let mut value = json!({
        "bodies": [{
            "name": "block", "mesh": {"file": "given in code"},
            "materials": [{"young": YOUNG, "poisson": 0.3}],
            "supports": [
                {"group": "base", "displacement": [null, null, 0]},
                {"group": "across_x", "displacement": [0, null, null]},
                {"group": "across_y", "displacement": [null, 0, null]}
            ]
        }],
        "rigid_bodies": [{"name": "indenter", "surfaces": [surface], "displacement": [0, 0, -depth]}],
        "contacts": [{"group": "face", "friction": 0, "rigid_body": "indenter"}]
    });
    let moved = report(&value, mesh);
    let force = moved.rigid_bodies[0].contact.force[2];
    value["rigid_bodies"][0]["displacement"] = json!([0, 0, null]);
    value["rigid_bodies"][0]["force"] = json!([0, 0, -force]);
    let pushed = report(&value, mesh);
    let sunk = pushed.rigid_bodies[0].displacement[2];
    assert!((sunk / -depth - 1.0).abs() < 1e-9, "{surface} {sunk}");
    (4.0 * force, pushed)
}

#[test]
fn a_ball_in_space_sinks_under_a_force_as_far_as_it_is_moved() {
    // Hertz within the mesh, four cells per radius of contact.
    let hertz = HertzSphere::new(1e-3, 10.0, MODULUS).unwrap();
    let mesh = quarter(hertz.contact_radius / 4.0);
    let ball = json!({"sphere": {"center": [0, 0, 10], "radius": 10}});
    let (force, _) = in_space(&ball, hertz.approach, &mesh);
    assert!((force / hertz.load - 1.0).abs() < 0.1, "{force} {hertz:?}");
}

#[test]
fn a_cone_in_space_sinks_as_sneddon_says() {
    // P = 2 E* d² / (π s), a = 2 d / (π s); four cells per radius of contact.
    let (slope, depth) = (0.01_f64, 0.006);
    let radius = 2.0 * depth / (std::f64::consts::PI * slope);
    let half_angle = 90.0 - slope.atan().to_degrees();
    let cone = json!({"cone": {"apex": [0, 0, 0], "axis": [0, 0, -1], "half_angle": half_angle}});
    let (force, _) = in_space(&cone, depth, &quarter(radius / 4.0));
    let exact = 2.0 * MODULUS * depth * depth / (std::f64::consts::PI * slope);
    assert!((force / exact - 1.0).abs() < 0.1, "{force} {exact}");
}

#[test]
fn a_round_punch_in_space_sinks_as_boussinesq_says() {
    // Its edge crosses cells of a quarter of its radius.
    let punch = json!({"punch": {"center": [0, 0, 0], "axis": [0, 0, -1], "radius": 1}});
    let (force, pushed) = in_space(&punch, 1e-3, &quarter(0.25));
    let exact = FlatRoundPunch::new(force, 1.0, MODULUS).unwrap();
    assert!(
        (exact.approach / 1e-3 - 1.0).abs() < 0.1,
        "{}",
        exact.approach
    );
    let contacts = pushed.contacts.iter();
    let mut pressed = contacts.filter(|contact| contact.pressure.is_some_and(|p| p > 0.0));
    assert!(pressed.all(|contact| contact.position[0].hypot(contact.position[1]) <= 1.0 + 1e-12));
}

#[test]
fn a_punch_with_a_rounded_edge_sinks_as_sneddons_integrals_say() {
    // Flat up to b, then of radius R (Ciavarella, Int. J. Solids Struct. 36 (1999) 4149): of r = a sin t,
    // d = a ∫ f'(r) dt, P = 2 E* a² ∫ sin² t f'(r) dt, f' = (r − b)/R, over r > b (Sneddon 1965).
    let (flat, edge, reach) = (0.5_f64, 100.0, 0.7);
    let start = (flat / reach).asin();
    let steps = 2000;
    let step = (std::f64::consts::FRAC_PI_2 - start) / f64::from(steps);
    let (mut depth, mut load) = (0.0, 0.0);
    for k in 0..steps {
        let sin = (start + (f64::from(k) + 0.5) * step).sin();
        let slope = (reach * sin - flat) / edge;
        depth += reach * slope * step;
        load += 2.0 * MODULUS * (reach * sin).powi(2) * slope * step;
    }
    let lines = growing(0.02, 0.8, 300.0);
    let mesh = rectangle(&lines, &falling(&lines), CellKind::Quad4).unwrap();
    let punch = json!({
        "punch": {"center": [0, 0], "axis": [0, -1], "radius": flat + edge, "edge": edge}
    });
    let (force, pushed) = round_trip(&punch, depth, &mesh);
    assert!((force / load - 1.0).abs() < 0.02, "{force} {load}");
    let contacts = pushed
        .contacts
        .iter()
        .filter(|contact| contact.force[1] != 0.0);
    let last = contacts
        .map(|contact| contact.position[0])
        .fold(0.0, f64::max);
    assert!((last - reach).abs() < 0.04, "{last}");
}

#[test]
fn what_a_rigid_body_cannot_be_is_refused_with_its_place() {
    let strip = json!({"punch": {"center": [0, 0], "axis": [0, -1], "radius": 1}});
    let mesh = rectangle(&[0.0, 1.0, 2.0], &[-1.0, 0.0], CellKind::Quad4).unwrap();
    let refused = |scene: &Value| {
        let scene = Scene::from_json(&scene.to_string(), "")
            .map(|_| with_meshes(scene, vec![mesh.clone()]));
        scene
            .and_then(|scene| solve(&scene))
            .unwrap_err()
            .to_string()
    };
    for (model, moves, expected) in [
        (
            "plane_strain",
            json!({"force": [0, -1]}),
            "rigid_bodies[0].force[1]",
        ),
        (
            "plane_strain",
            json!({"displacement": [0]}),
            "rigid_bodies[0].displacement",
        ),
        (
            "plane_strain",
            json!({"rotation": [0, 0, 0]}),
            "rigid_bodies[0].rotation",
        ),
        (
            "plane_strain",
            json!({"surfaces": []}),
            "rigid_bodies[0].surfaces",
        ),
        (
            "plane_strain",
            json!({"name": "block"}),
            "rigid_bodies[0].name",
        ),
        (
            "axisymmetric",
            json!({"displacement": [null, 0]}),
            "rigid_bodies[0].displacement[0]",
        ),
        ("axisymmetric", json!({"rotation": [null]}), "torsion"),
        (
            "axisymmetric",
            json!({"rotation": [0.1]}),
            "rigid_bodies[0].rotation[0]",
        ),
        (
            "axisymmetric",
            json!({"surfaces": [{"punch": {"center": [1, 0], "axis": [0, -1], "radius": 1}}]}),
            "apex[0]",
        ),
        (
            "plane_strain",
            json!({"surfaces": [{"cone": {"apex": [0, 0], "axis": [0, -1], "half_angle": 90}}]}),
            "half_angle",
        ),
        (
            "plane_strain",
            json!({"surfaces": [{"profile": {"points": [[0, 0], [0, 0]]}}]}),
            "points[1]",
        ),
        (
            "plane_strain",
            json!({"surfaces": [{"sphere": {"center": [0, 0], "radius": 1}}]}),
            "a sphere",
        ),
    ] {
        let found = refused(&scene(model, &strip, &moves, 0.0));
        assert!(found.contains(expected), "{moves}: {found}");
    }
    let mut other = scene("plane_strain", &strip, &json!({"rotation": [null]}), 0.0);
    other["rigid_bodies"][0]
        .as_object_mut()
        .unwrap()
        .remove("reference");
    assert!(refused(&other).contains("rigid_bodies[0].reference"));
    let mut other = scene("plane_strain", &strip, &json!({}), 0.0);
    other["contacts"][0]["rigid_body"] = json!("indentre");
    assert!(
        refused(&other).contains("`indenter`"),
        "{}",
        refused(&other)
    );
    other["contacts"][0]["rigid_body"] = json!("indenter");
    other["contacts"][0]["surface"] = json!(1);
    assert!(refused(&other).contains("contacts[0].surface"));
    other["contacts"][0] = json!({"group": "top", "friction": 0, "obstacle": strip});
    assert!(refused(&other).contains("no contact names"));
}

#[test]
fn a_ring_in_a_rigid_bore_presses_on_it_as_lame_says() {
    // Plane strain, σ_r = A − B/r², u = (1 + ν)/E ((1 − 2ν) A r + B/r): u(b) = 0 and σ_r(a) = −p leave
    // p_b = 2 (1 − ν) p/(1 + (1 − 2ν) b²/a²).
    let (inner, outer, poisson) = (2.0, 3.0, 0.3);
    let rs: Vec<f64> = (0..=16).map(|k| inner + f64::from(k) / 16.0).collect();
    let angles: Vec<f64> = (0..=24).map(|k| f64::from(k) / 24.0).collect();
    let mut mesh = rectangle(&rs, &angles, CellKind::Quad4).unwrap();
    for [x, y, _] in &mut mesh.nodes {
        let (sin, cos) = (std::f64::consts::FRAC_PI_2 * *y).sin_cos();
        (*x, *y) = (*x * if *y == 1.0 { 0.0 } else { cos }, *x * sin);
    }
    let scene = json!({
        "bodies": [{
            "name": "ring", "mesh": {"file": "given in code"}, "model": "plane_strain",
            "materials": [{"young": YOUNG, "poisson": poisson}],
            "supports": [{"group": "bottom", "displacement": [null, 0]}, {"group": "top", "displacement": [0, null]}],
            "loads": [{"group": "left", "pressure": 1e-3}]
        }],
        "contacts": [{
            "group": "right", "friction": 0, "obstacle": {"bore": {"center": [0, 0], "radius": outer}}
        }]
    });
    let report = report(&scene, &mesh);
    let ratio = (outer / inner) * (outer / inner);
    let exact = 2e-3 * (1.0 - poisson) / (1.0 + (1.0 - 2.0 * poisson) * ratio);
    for contact in &report.contacts {
        // Linear cells of a sixteenth of the wall.
        let off = (contact.pressure.unwrap() / exact - 1.0).abs();
        assert!(off < 5e-3, "{off} {contact:?}");
    }
}

#[test]
fn a_floor_of_triangles_or_a_profile_is_a_plane() {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("rigid_floor");
    std::fs::create_dir_all(&folder).unwrap();
    let corner = |[x, y]: [f64; 2]| format!("   vertex {x} {y} 0\n");
    let facet = |corners: [[f64; 2]; 3]| {
        let corners: String = corners.into_iter().map(corner).collect();
        format!(" facet normal 0 0 1\n  outer loop\n{corners}  endloop\n endfacet\n")
    };
    let facets = [
        facet([[-9.0, -9.0], [9.0, -8.0], [8.0, 9.0]]),
        facet([[-9.0, -9.0], [8.0, 9.0], [-7.0, 9.0]]),
    ];
    let text = format!("solid floor\n{}endsolid floor\n", facets.concat());
    std::fs::write(folder.join("floor.stl"), text).unwrap();
    let solved = |mesh: Value, held: Value, obstacle: Value| {
        let mut body = json!({
            "mesh": mesh, "materials": [{"young": YOUNG, "poisson": 0.3}],
            "supports": [{"group": "top", "displacement": held}]
        });
        if held.as_array().unwrap().len() == 2 {
            body["model"] = json!("plane_strain");
        }
        let contacts = json!([{"group": "bottom", "friction": 0.3, "obstacle": obstacle}]);
        let scene = json!({"bodies": [body], "contacts": contacts}).to_string();
        certified(&Scene::from_json(&scene, folder.join("scene.json")).unwrap()).1
    };
    let cube = json!({"box": {"x": [0, 1], "y": [0, 1], "z": [0, 1], "cells": [3, 3, 3]}});
    let square = json!({"rectangle": {"x": [0, 1], "y": [0, 1], "cells": [5, 5]}});
    for (mesh, held, plane, other) in [
        (
            cube,
            json!([0.002, 0.001, -0.01]),
            json!({"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}}),
            json!({"triangles": {"file": "floor.stl"}}),
        ),
        (
            square,
            json!([0.002, -0.01]),
            json!({"plane": {"point": [0, 0], "normal": [0, 1]}}),
            json!({"profile": {"points": [[-1, 0], [0.37, 0], [3, 0]]}}),
        ),
    ] {
        let [expected, found] =
            [plane, other].map(|floor| solved(mesh.clone(), held.clone(), floor));
        assert_eq!(found.contacts.len(), expected.contacts.len());
        for (found, expected) in found.contacts.iter().zip(&expected.contacts) {
            for (a, b) in found.force.iter().zip(&expected.force) {
                assert!(
                    (a - b).abs() < 1e-12 * expected.area.max(1e-2),
                    "{found:?} {expected:?}"
                );
            }
        }
    }
}

#[test]
fn what_is_given_to_a_rigid_body_changes_the_totals_as_differences_say() {
    // Pressed in by a force and tilted by a moment, or moved and turned; drawn aside in both cases.
    let lines = growing(0.1, 0.3, 1.0);
    let mesh = rectangle(&lines, &falling(&lines), CellKind::Quad4).unwrap();
    let ball = json!({"circle": {"center": [0.5, 2], "radius": 2}});
    let free = json!({"displacement": [1e-3, null], "rotation": [null], "force": [0, -0.03], "moment": [0.001]});
    let given = json!({"displacement": [1e-3, -5e-3], "rotation": [2e-3]});
    for (moves, friction) in [(&free, 0.3), (&given, 0.3), (&given, 0.0), (&free, 0.0)] {
        let mut scene = scene("plane_strain", &ball, moves, friction);
        scene["rigid_bodies"][0]["reference"] = json!([0.5, 0]);
        let solve = |scene: &Value| {
            let mut scene = scene.clone();
            scene["settings"] = json!({"tolerance": 1e-13});
            solve(&with_meshes(&scene, vec![mesh.clone()])).unwrap()
        };
        let all = solve(&scene).sensitivities().unwrap().unwrap();
        let given = moves.as_object().unwrap();
        let places = given.iter().flat_map(|(key, values)| {
            let values = values.as_array().unwrap().iter().enumerate();
            let stated =
                values.filter(|(_, value)| value.as_f64().is_some_and(|value| value != 0.0));
            stated.map(move |(entry, _)| (key.as_str(), entry))
        });
        let mut compared = 0;
        for (key, entry) in places {
            let name = format!("rigid_bodies[0].{key}[{entry}]");
            let found = all.iter().find(|one| one.parameter == name).unwrap();
            let at = |factor: f64| {
                let mut moved = scene.clone();
                let number = moved["rigid_bodies"][0][key][entry].as_f64().unwrap();
                moved["rigid_bodies"][0][key][entry] = json!(number * factor);
                let mut table = dpana::report::Table::default();
                table.push(&[], &solve(&moved).report().unwrap());
                table
            };
            let (below, above) = (at(1.0 - 1e-5), at(1.0 + 1e-5));
            for of in TOTALS {
                let [low, high] = [&below, &above].map(|table| table.column(of).unwrap()[0]);
                let difference = (high - low) / 2e-5;
                let off = (found.of(of).unwrap() - difference).abs();
                let rounding = 1e-7 * low.abs() + 1e-12;
                assert!(
                    off <= 1e-6 * difference.abs() + rounding,
                    "{friction}: d({of})/d({name}) = {} and {difference}",
                    found.of(of).unwrap()
                );
                compared += 1;
            }
        }
        assert!(compared >= 10, "{friction} {moves}");
    }
}

#[test]
fn a_ball_stiffens_as_hertz_says() {
    // P = 4/3 E* √R δ^(3/2): dP/dδ = 3/2 P/δ = 2 E* a. Between two nodes the zone stays as it is, half a ring off at most.
    let hertz = HertzSphere::new(1e-3, 10.0, MODULUS).unwrap();
    let fine = hertz.contact_radius / 16.0;
    let lines = growing(fine, 20.0 * fine, 400.0 * hertz.contact_radius);
    let mesh = rectangle(&lines, &falling(&lines), CellKind::Quad4).unwrap();
    let ball = json!({"circle": {"center": [0, 10], "radius": 10}});
    let moved = json!({"displacement": [0, -hertz.approach]});
    let scene = scene("axisymmetric", &ball, &moved, 0.0);
    let (solution, report) = certified(&with_meshes(&scene, vec![mesh]));
    let name = "rigid_bodies[0].displacement[1]";
    let found = solution.sensitivity(name).unwrap().unwrap();
    // Per factor of δ.
    let rate = found.of("normal").unwrap() / report.totals.normal;
    assert!((rate / 1.5 - 1.0).abs() < 0.5 / 16.0, "{rate}");
}

#[test]
fn a_smooth_circle_takes_no_moment_from_quadratic_cells() {
    // Off the middle of the cells, so that contacts on both sides differ: each one's force goes through the centre.
    for kind in [CellKind::Quad8, CellKind::Tri6] {
        let lines: Vec<f64> = (0..=12).map(|k| f64::from(k) * 0.1 - 0.47).collect();
        let mesh = rectangle(&lines, &[-1.0, -0.5, -0.2, 0.0], kind).unwrap();
        let circle = json!({"circle": {"center": [0, 2], "radius": 2}});
        let moved = json!({"reference": [0, 2], "displacement": [0, -0.02], "rotation": [0]});
        let found = report(&scene("plane_strain", &circle, &moved, 0.0), &mesh);
        let of_circle = &found.rigid_bodies[0].contact;
        assert!(found.totals.stick + found.totals.slip > 3);
        let arm = of_circle.moment[0] / of_circle.force[1];
        assert!(arm.abs() < 1e-12, "{kind:?} {arm}");
    }
}
