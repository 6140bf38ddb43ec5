//! How far a load can grow before what only contact holds begins to move, and the least friction.

use dpana::body::{CellKind, rectangle};
use dpana::report::{Beyond, Limits, ReportedLeastFriction};
use dpana::scene::MeshSource;
use dpana::{Scene, Status, limit, solve};
use serde_json::{Value, json};

fn scene(value: &Value) -> Scene {
    Scene::from_json(&value.to_string(), "limits.json").unwrap()
}

/// The factor of a load, which the judge has certified, and the sentence for what begins there.
fn factor(limits: &Limits, load: usize) -> (f64, String) {
    match &limits.loads[load].beyond {
        Beyond::Grows {
            factor,
            motions,
            certified,
        } => {
            assert!(certified, "{limits:?}");
            (*factor, motions[0].words.clone())
        }
        other => unreachable!("{other:?}"),
    }
}

/// A limit is certified if reactions hold its load to 1e-9 of it, a pull of a tenth of it to ten times that.
const LIMIT: f64 = 1e-8;

fn close(found: f64, expected: f64, relative: f64) {
    assert!(
        (found - expected).abs() <= relative * expected.abs(),
        "{found} {expected}"
    );
}

/// A wedge of weight 1 on a slope of 1 : 10 (NAFEMS CGS-4), pulled up by a horizontal traction of 1 in all.
fn wedge(friction: f64) -> Scene {
    let a = f64::atan(0.1);
    let (sin, cos) = a.sin_cos();
    let value = json!({
        "bodies": [{ "name": "wedge",
                     "mesh": { "rectangle": { "x": [0, 4], "y": [0, 1], "cells": [8, 2] } },
                     "model": "plane_strain", "materials": [{ "young": 1e3, "poisson": 0.3 }],
                     "loads": [{ "body_force": [0, -0.25] },
                               { "group": "bottom", "traction": [0.25, 0] }] }],
        "contacts": [{ "group": "bottom", "friction": friction,
                       "obstacle": { "plane": { "point": [0, 0], "normal": [-sin, cos] } } }]
    });
    let mut scene = scene(&value);
    let steps = |count: usize, length: f64| -> Vec<f64> {
        (0..=count)
            .map(|k| length * k as f64 / count as f64)
            .collect()
    };
    let mut mesh = rectangle(&steps(8, 4.0), &steps(2, 1.0), CellKind::Quad4).unwrap();
    for [x, y, _] in &mut mesh.nodes {
        (*x, *y) = (cos * *x - sin * *y, sin * *x + cos * *y);
    }
    scene.bodies[0].mesh = MeshSource::Given(mesh);
    scene
}

/// references.md, item 9: F/G = (tan a + μ)/(1 − μ tan a).
#[test]
fn the_wedge_is_pulled_up_by_the_force_of_the_formula() {
    for (friction, published) in [
        (0.0, 0.1),
        (0.1, 0.202_020_2),
        (0.2, 0.306_122_4),
        (0.3, 0.412_371_1),
    ] {
        let limits = limit(&wedge(friction)).unwrap();
        let (found, words) = factor(&limits, 1);
        close(found, (0.1 + friction) / (1.0 - 0.1 * friction), LIMIT);
        // Seven digits are published.
        assert!((found - published).abs() < 1e-7);
        assert_eq!(words, "slides along (0.995, 0.100, 0.000)");
    }
}

#[test]
fn the_elastic_wedge_holds_below_the_limit_and_slides_above() {
    for (part, status) in [
        (1.0 - 1e-6, Status::Certified),
        (1.0 + 1e-6, Status::NoEquilibrium),
    ] {
        let mut scene = wedge(0.2);
        let pull = part * 0.3 / (1.0 - 0.02) / 4.0;
        if let dpana::scene::SceneLoad::Traction { traction, .. } = &mut scene.bodies[0].loads[1] {
            traction[0] = pull;
        }
        assert_eq!(solve(&scene).unwrap().status(), status);
    }
}

/// references.md, item 10: 3600 N are all that μ = 0.3 holds under 12000 N.
#[test]
fn the_pad_holds_3600_newton_and_needs_a_coefficient_of_0_297() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/scenes/pad.json");
    let limits = limit(&Scene::from_file(file).unwrap()).unwrap();
    assert_eq!(limits.loads[0].beyond, Beyond::Unbounded);
    let (found, words) = factor(&limits, 1);
    close(3564.0 * found, 3600.0, LIMIT);
    assert_eq!(words, "slides along +x");
    match limits.least_friction {
        ReportedLeastFriction::Multiple {
            coefficient: Some(coefficient),
            ..
        } => close(coefficient, 0.297, LIMIT),
        other => unreachable!("{other:?}"),
    }
    assert!(
        limits.summary().contains("up to 1.010101010 times"),
        "{}",
        limits.summary()
    );
}

/// A crate of 1 × 2 m pushed at its top: it tips at F h = W w/2 before it slides at μ W.
#[test]
fn a_tall_crate_tips_before_it_slides() {
    let crate_ = |height: f64| {
        scene(&json!({
            "bodies": [{ "name": "crate",
                         "mesh": { "rectangle": { "x": [0, 1], "y": [0, height], "cells": [4, 6] } },
                         "model": "plane_strain", "materials": [{ "young": 1e6, "poisson": 0.2 }],
                         "loads": [{ "body_force": [0, -100.0 / height] },
                                   { "group": "top", "traction": [1, 0] }] }],
            "contacts": [{ "group": "bottom", "friction": 0.5,
                           "obstacle": { "plane": { "point": [0, 0], "normal": [0, 1] } } }]
        }))
    };
    let (tall, words) = factor(&limit(&crate_(2.0)).unwrap(), 1);
    close(tall, 100.0 * 0.5 / 2.0, LIMIT);
    assert_eq!(words, "tips about -z through (1, 0, 0)");
    let (low, words) = factor(&limit(&crate_(0.5)).unwrap(), 1);
    close(low, 0.5 * 100.0, LIMIT);
    assert_eq!(words, "slides along +x");
}

#[test]
fn a_load_that_is_not_held_at_all_says_so() {
    let lifted = json!({
        "bodies": [{ "name": "block",
                     "mesh": { "rectangle": { "x": [0, 1], "y": [0, 1], "cells": [2, 2] } },
                     "model": "plane_strain", "materials": [{ "young": 1e6, "poisson": 0.2 }],
                     "loads": [{ "body_force": [0, 3] }, { "group": "top", "traction": [1, 0] }] }],
        "contacts": [{ "group": "bottom", "friction": 0.5,
                       "obstacle": { "plane": { "point": [0, 0], "normal": [0, 1] } } }]
    });
    let limits = limit(&scene(&lifted)).unwrap();
    assert!(
        matches!(limits.loads[1].beyond, Beyond::Never { .. }),
        "{limits:?}"
    );
    assert!(matches!(
        limits.least_friction,
        ReportedLeastFriction::Never { .. }
    ));
}

#[test]
fn a_scene_whose_supports_hold_everything_has_no_limit() {
    let file = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/examples/scenes/two_cubes.json"
    );
    let said = limit(&Scene::from_file(file).unwrap())
        .unwrap_err()
        .to_string();
    assert!(said.contains("supports that hold every body"), "{said}");
}
