//! Derivatives of solved scenes: against the scene solved anew with every number changed, and closed forms.

use std::f64::consts::PI;

use dpana::body::{CellKind, Mesh, graded, rectangle};
use dpana::report::{Report, Table};
use dpana::scene::MeshSource;
use dpana::{Scene, Search, Solution, Status, Variation, cases, find, solve};
use serde_json::{Value, json};

use crate::hertz::parabola;

/// Totals whose derivatives are compared with differences.
pub(crate) const TOTALS: [&str; 5] = [
    "normal",
    "friction_x",
    "contact_force_y",
    "peak_pressure",
    "largest_slip",
];

fn certified(scene: &Value) -> Solution {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/scene.json");
    let solution = solve(&Scene::from_json(&scene.to_string(), file).unwrap()).unwrap();
    assert_eq!(solution.status(), Status::Certified);
    solution
}

fn total(report: &Report, name: &str) -> f64 {
    let mut table = Table::default();
    table.push(&[], report);
    match (name, table.column(name)) {
        (_, Some(column)) => column[0],
        _ => report.totals.moment[0],
    }
}

/// Multiplies or moves the number at a place.
fn changed(scene: &Value, places: &[String], change: impl Fn(f64) -> f64) -> Value {
    let mut scene = scene.clone();
    for place in places {
        let number = scene.pointer_mut(place).unwrap();
        *number = json!(change(number.as_f64().unwrap()));
    }
    scene
}

/// A warm block on springs that nothing else holds, under one whose top is moved, beside a curved obstacle.
fn pressed() -> Value {
    json!({
        "bodies": [
            {
                "name": "lower",
                "mesh": {"rectangle": {"x": [0, 3], "y": [0, 1], "cells": [9, 3]}},
                "model": "plane_strain",
                "materials": [{"young": 1000, "poisson": 0.3, "expansion": 1e-3}],
                "foundation": [{"group": "bottom", "stiffness": [400, 500]}],
                "loads": [{"temperature": 2.0}, {"body_force": [0, -1]}]
            },
            {
                "name": "upper",
                "mesh": {"rectangle": {"x": [0.55, 2.3], "y": [1, 2], "cells": [6, 3], "cell": "quad8"}},
                "model": "plane_strain",
                "materials": [{"young": 2000, "poisson": 0.2}],
                "supports": [{"group": "top", "displacement": [0.05, -0.02]}],
                "loads": [{"group": "left", "traction": [2, 0]}]
            }
        ],
        "settings": {"tolerance": 1e-13},
        "contacts": [
            {
                "body": "upper", "group": "bottom", "friction": 0.3, "gap": 1e-3,
                "against": {"body": "lower", "group": "top"}
            },
            {
                "body": "lower", "group": "right", "friction": 0.2,
                "obstacle": {"circle": {"center": [5.0, 0.5], "radius": 1.9995}}
            }
        ]
    })
}

#[test]
fn every_parameter_of_two_bodies_changes_the_totals_as_the_scene_solved_anew() {
    let scene = pressed();
    let solution = certified(&scene);
    let sensitivities = solution.sensitivities().unwrap().unwrap();
    let text = |places: &[&str]| places.iter().map(|p| (*p).to_owned()).collect::<Vec<_>>();
    let factor = |h: f64| move |x: f64| x * (1.0 + h);
    let shift = |h: f64| move |x: f64| x + h;
    let young = |body: usize| format!("/bodies/{body}/materials/0/young");
    let support = [
        "/bodies/1/supports/0/displacement/0",
        "/bodies/1/supports/0/displacement/1",
    ];
    // Places that change in proportion, then those that are moved.
    let parameters: [(&str, Vec<String>, bool); 9] = [
        ("bodies[0].young", vec![young(0)], true),
        ("bodies[1].young", vec![young(1)], true),
        (
            "bodies[0].loads[0]",
            text(&["/bodies/0/loads/0/temperature"]),
            true,
        ),
        (
            "bodies[0].loads[1]",
            text(&["/bodies/0/loads/1/body_force/1"]),
            true,
        ),
        (
            "bodies[1].loads[0]",
            text(&["/bodies/1/loads/0/traction/0"]),
            true,
        ),
        ("bodies[1].supports[0]", text(&support), true),
        ("contacts[0].gap", text(&["/contacts/0/gap"]), false),
        (
            "contacts[0].friction",
            text(&["/contacts/0/friction"]),
            false,
        ),
        (
            "contacts[1].friction",
            text(&["/contacts/1/friction"]),
            false,
        ),
    ];
    for (name, places, proportional) in parameters {
        let h = if proportional { 1e-5 } else { 1e-6 };
        let beside = [-h, h].map(|h| match proportional {
            true => certified(&changed(&scene, &places, factor(h))),
            false => certified(&changed(&scene, &places, shift(h))),
        });
        let reports = [0, 1].map(|side| beside[side].report().unwrap());
        let found = sensitivities
            .iter()
            .find(|one| one.parameter == name)
            .unwrap();
        for derivative in &found.derivatives {
            assert!(derivative.falling.is_none(), "{name}: {derivative:?}");
            let [below, above] = [0, 1].map(|side| total(&reports[side], &derivative.of));
            let difference = (above - below) / (2.0 * h);
            // Differences lose the digits of the step, of totals that have twelve, and of lengths as large as the bodies.
            let rounding = (1e-12 * below.abs() + 3.0 * f64::EPSILON) / h;
            let off = (derivative.growing - difference).abs();
            assert!(
                off <= 1e-6 * difference.abs() + rounding,
                "d({})/d({name}) = {} and {difference}",
                derivative.of,
                derivative.growing
            );
        }
        let moved = solution.displacement_rates(name).unwrap().unwrap().growing;
        let corner = [0, 1].map(|side| beside[side].displacements()[0][10]);
        let difference = (corner[1] - corner[0]) / (2.0 * h);
        let size = moved[0].iter().fold(0.0, |most: f64, u| most.max(u.abs()));
        assert!((moved[0][10] - difference).abs() < 1e-6 * size, "{name}");
    }
}

#[test]
fn an_obstacle_that_moves_changes_the_totals_as_cases_say() {
    let scene = pressed();
    let sensitivities = certified(&scene).sensitivities().unwrap().unwrap();
    let scene = Scene::from_json(&scene.to_string(), "").unwrap();
    for name in ["contacts[1].x", "contacts[1].y", "gap"] {
        let values = vec![-1e-6, 1e-6];
        let name = name.to_owned();
        let table = cases(
            &scene,
            &[Variation {
                name: name.clone(),
                values,
            }],
        )
        .unwrap();
        let found = sensitivities
            .iter()
            .find(|one| one.parameter == name)
            .unwrap();
        for of in TOTALS {
            let column = table.column(of).unwrap();
            let difference = (column[1] - column[0]) / 2e-6;
            let off = (found.of(of).unwrap() - difference).abs();
            let rounding = 1e-5 * column[0].abs();
            assert!(
                off <= 1e-6 * difference.abs() + rounding,
                "d({of})/d({name}): {off:e} {difference}"
            );
        }
    }
}

/// A block on a plane under a pressure, of this contact law.
fn under_law(contact: Value, supports: Value) -> Value {
    let mut contact = contact;
    contact["group"] = json!("bottom");
    contact["obstacle"] = json!({"plane": {"point": [0, 0], "normal": [0, 1]}});
    json!({
        "bodies": [{
            "mesh": {"rectangle": {"x": [0, 1], "y": [0, 1], "cells": [4, 4]}},
            "model": "plane_strain",
            "materials": [{"young": 1000, "poisson": 0}],
            "loads": [{"group": "top", "pressure": 5}],
            "supports": supports
        }],
        "contacts": [contact]
    })
}

fn rate(scene: &Value, parameter: &str, of: &str) -> f64 {
    let found = certified(scene).sensitivity(parameter).unwrap().unwrap();
    found.of(of).unwrap()
}

#[test]
fn what_a_cap_bounds_does_not_grow_with_friction() {
    let pushed = json!([{"group": "top", "displacement": [0.02, null]}]);
    let law = |law: Value| under_law(json!({"law": {"coulomb": law}}), pushed.clone());
    let friction = |law: Value| rate(&law, "friction", "friction_x");
    // Capped at 0.5 per area everywhere; not at all; then T = μ p.
    assert_eq!(
        friction(law(json!({"friction": 0.3, "shear_cap": 0.5}))),
        0.0
    );
    let free = friction(law(json!({"friction": 0.3, "shear_cap": 50})));
    assert!((free + 5.0).abs() < 1e-9, "{free}");
}

#[test]
fn slip_is_what_slides_on_an_obstacle_that_moves_and_on_a_layer_that_gives() {
    // Held by a spring alone: the block sticks to the plane and goes along.
    let mut carried = under_law(json!({"friction": 0.5}), json!([]));
    carried["bodies"][0]["foundation"] = json!([{"group": "top", "stiffness": [1, 0]}]);
    assert!(rate(&carried, "contacts[0].x", "largest_slip").abs() < 1e-9);
    let text = Scene::from_json(&carried.to_string(), "").unwrap();
    let (name, values) = ("contacts[0].x".to_owned(), vec![1e-3]);
    let slip = cases(&text, &[Variation { name, values }]).unwrap();
    assert!(slip.column("largest_slip").unwrap()[0] < 1e-12);
    // A disc whose rim is moved outward on a layer that takes all of it: contacts stick, but for that on the axis
    // all have a tangent.
    let layer = json!({"friction": 0.9, "compliance": {"tangential": 2e-4}, "dragged": true});
    let mut disc = under_law(
        layer,
        json!([{"group": "right", "displacement": [1e-4, null]}]),
    );
    disc["bodies"][0]["model"] = json!("axisymmetric");
    for parameter in ["bodies[0].supports[0]", "gap"] {
        assert!(
            rate(&disc, parameter, "largest_slip").abs() < 1e-9,
            "{parameter}"
        );
    }
    // Without friction everything slides, layer or none.
    let slid = |contact: Value| {
        let scene = under_law(
            contact,
            json!([{"group": "right", "displacement": [1e-3, null]}]),
        );
        total(&certified(&scene).report().unwrap(), "largest_slip")
    };
    let bare = slid(json!({"friction": 0}));
    assert!(bare > 1e-3);
    assert!(
        (slid(json!({"friction": 0, "compliance": {"tangential": 2e-4}})) / bare - 1.0).abs()
            < 1e-9
    );
}

#[test]
fn a_line_contact_grows_as_hertz_says() {
    // p₀ ∝ √P and a ∝ √P: dp₀/dP = p₀/(2P), da/dP = a/(2P) with a = 2P/(π p₀); whatever the far side of the body.
    let solution = certified(&parabola());
    let report = solution.report().unwrap();
    let totals = &report.totals;
    let (load, peak) = (2.0 * totals.normal, totals.peak_pressure);
    let found = solution
        .sensitivity("bodies[0].supports[1]")
        .unwrap()
        .unwrap();
    let [load_rate, peak_rate] = ["normal", "peak_pressure"].map(|of| found.of(of).unwrap());
    let per_load = peak_rate / (2.0 * load_rate);
    // Between two nodes the zone stays as it is: pressure is added as under a flat punch of that width, which is half a
    // strip off at most. dp₀/dP = 1/(π a) is off by as much, and da/dP too.
    let half_width = 2.0 * load / (PI * peak);
    let strips = half_width / report.contacts[1].position[0];
    let off = per_load / (peak / (2.0 * load)) - 1.0;
    assert!(off.abs() < 0.5 / strips, "dp₀/dP {off:e}, {strips} strips");
    let width_rate = 2.0 / (PI * peak) - half_width / peak * per_load;
    let off = width_rate / (half_width / (2.0 * load)) - 1.0;
    assert!(off.abs() < 0.5 / strips, "da/dP {off:e}");
}

/// Half a ring of one cell across its thickness, inside radius 50 and 0.5 thick, with straight ends that hang down.
fn belt() -> Mesh {
    let ring = graded(0.0, PI, 60, 1.0).unwrap();
    let tails = [7.5, 5.0, 2.5];
    let left = [10.0].iter().chain(&tails).map(|y| -y);
    let right = tails.iter().rev().chain(&[10.0]).map(|y| PI + y);
    let lines: Vec<f64> = left.chain(ring).chain(right).collect();
    let mut mesh = rectangle(&lines, &[0.0, 0.5], CellKind::Quad8).unwrap();
    for node in &mut mesh.nodes {
        let (along, radius) = (node[0], 50.0 + node[1]);
        let angle = along.clamp(0.0, PI);
        let hanging = along.min(0.0) - (along - PI).max(0.0);
        *node = [-radius * angle.cos(), radius * angle.sin() + hanging, 0.0];
    }
    let inside = |[x, y, _]: [f64; 3]| y > -6.0 && x.hypot(y.max(0.0)) < 50.1;
    mesh.with_surface("inside", inside).unwrap()
}

fn over_a_cylinder(friction: f64) -> Scene {
    let scene = json!({
        "bodies": [{
            "name": "belt", "mesh": {"file": "given in code"},
            "model": {"plane_stress": {"thickness": 1}},
            "materials": [{"young": 1000, "poisson": 0}],
            "supports": [{"group": "right", "displacement": [0, -3]}],
            "loads": [{"group": "left", "traction": [0, -2]}]
        }],
        "contacts": [{
            "group": "inside", "friction": friction,
            "obstacle": {"circle": {"center": [0, 0], "radius": 50}}
        }]
    });
    let mut scene = Scene::from_json(&scene.to_string(), "").unwrap();
    scene.bodies[0].mesh = MeshSource::Given(belt());
    scene
}

#[test]
fn a_belt_is_held_by_more_friction_as_euler_says() {
    // T_2 = T_1 e^(μθ): friction acts at 50, the tension in the middle at 50.25, θ = π 50/50.25. The force of both
    // pulls on the cylinder is T_1 + T_2, so that its derivative is θ T_2 (Eytelwein, 1808).
    let solution = solve(&over_a_cylinder(0.3)).unwrap();
    assert_eq!(solution.status(), Status::Certified);
    let totals = solution.report().unwrap().totals;
    let (slack, pull) = (1.0, totals.contact_force[1].abs() - 1.0);
    let angle = PI * 50.0 / 50.25;
    assert!(
        (pull / slack / (0.3 * angle).exp() - 1.0).abs() < 3e-3,
        "{pull}"
    );
    let found = solution.sensitivity("friction").unwrap().unwrap();
    let rate = found.of("contact_force_y").unwrap().abs();
    assert!(
        (rate / (angle * pull) - 1.0).abs() < 5e-3,
        "{rate} {}",
        angle * pull
    );

    // And back: which friction holds 2.2 against 1?
    let search = Search {
        parameter: "friction".to_owned(),
        between: [0.1, 0.5],
        total: "contact_force_y".to_owned(),
        target: totals.contact_force[1].signum() * 3.2,
    };
    let (found, _) = find(&over_a_cylinder(0.3), &search).unwrap();
    assert!(
        (found.value / (2.2_f64.ln() / angle) - 1.0).abs() < 5e-3,
        "{found:?}"
    );
    assert!(found.states <= 12, "{} states", found.states);
}
