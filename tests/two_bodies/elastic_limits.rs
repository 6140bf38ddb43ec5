//! Limits of elastic bodies that hold by what was locked in: by load, by displacement and by `limit`, beside closed forms.

use std::f64::consts::{FRAC_PI_2, PI};

use dpana::body::{CellKind, Mesh, rectangle};
use dpana::report::{Beyond, LoadLimit};
use dpana::scene::MeshSource;
use dpana::{Scene, Solution, Status, limit, solve};
use serde_json::{Value, json};

use crate::rounds::quarter;

/// By load, by displacement and by `limit`.
const AGREE: f64 = 1e-4;

fn scene(value: &Value, meshes: Vec<Mesh>) -> Scene {
    let mut scene = Scene::from_json(&value.to_string(), "").unwrap();
    for (body, mesh) in scene.bodies.iter_mut().zip(meshes) {
        body.mesh = MeshSource::Given(mesh);
    }
    scene
}

fn close(found: f64, expected: f64, relative: f64) {
    let apart = (found - expected).abs();
    assert!(apart <= relative * expected.abs(), "{found} {expected}");
}

/// The limit of the scene's only load that the free motions feel, known to a millionth.
fn of(limits: &[LoadLimit], load: usize) -> f64 {
    let elastic = limits[load].elastic.as_ref().unwrap();
    let (held, fails) = (elastic.held.unwrap(), elastic.fails.unwrap());
    assert!(fails - held <= 1e-6 * fails, "{elastic:?}");
    0.5 * (held + fails)
}

/// Where a thousandth less than a factor is certified and a thousandth more has no equilibrium; returns the latter.
fn is_the_limit(at: impl Fn(f64) -> Scene, factor: f64) -> Solution {
    let below = solve(&at(factor * (1.0 - 1e-3))).unwrap();
    assert_eq!(below.status(), Status::Certified);
    let above = solve(&at(factor * (1.0 + 1e-3))).unwrap();
    assert_eq!(above.status(), Status::NoEquilibrium);
    assert!(above.outcome().failure.as_ref().unwrap().elastic);
    above
}

fn missing(solution: &Solution) -> f64 {
    solution.outcome().failure.as_ref().unwrap().missing
}

fn certified(scene: &Scene) -> dpana::report::Report {
    let solution = solve(scene).unwrap();
    assert_eq!(solution.status(), Status::Certified);
    solution.report().unwrap()
}

/// A block of 2 m × 1 m between plates that squeeze it by a thousandth, ν = 0: 2 N on either side, whatever pulls it along
/// (Betti, against the state of uniform squeezing, which has no displacement along). Friction of 0.3 holds 1.2 N.
#[test]
fn a_clamp_holds_twice_its_friction() {
    let clamp = |supports: Value, pull: f64| {
        let plate = |y: f64, up: f64| json!({ "plane": { "point": [0, y], "normal": [0, up] } });
        let value = json!({
            "bodies": [{ "name": "block", "model": "plane_strain",
                         "mesh": { "rectangle": { "x": [0, 2], "y": [0, 1], "cells": [6, 3] } },
                         "materials": [{ "young": 1000, "poisson": 0 }], "supports": supports,
                         "loads": [{ "body_force": [0.5 * pull, 0] }] }],
            "contacts": [{ "group": "bottom", "friction": 0.3, "obstacle": plate(0.0, 1.0) },
                         { "group": "top", "friction": 0.3, "obstacle": plate(0.999, -1.0) }]
        });
        scene(&value, Vec::new())
    };
    let limits = limit(&clamp(json!([]), 1.0)).unwrap();
    assert_eq!(limits.loads[0].beyond, Beyond::Unbounded);
    let found = of(&limits.loads, 0);
    close(found, 1.2, 1e-6);
    let words = limits.summary();
    assert!(words.contains("then block slides along +x"), "{words}");
    let pulled = json!([{ "at": [1, 1.0 / 3.0], "displacement": [0.1, null] },
                        { "at": [1, 2.0 / 3.0], "displacement": [0.1, null] }]);
    close(
        -certified(&clamp(pulled, 0.0)).totals.friction[0],
        found,
        AGREE,
    );
    let above = is_the_limit(|part| clamp(json!([]), part), found);
    close(missing(&above), 1e-3 * found, 1e-3);
}

/// A shaft of radius 1 in a hub of radius 2, both 2 m long, 1 mm of overlap, E = 1000, ν = 0: p = 3 E δ/(8 R) (Lamé), and
/// friction of 0.3 holds 0.3 p 2π R · 2 along the axis. Without lateral contraction a pull leaves the sum of p as it is.
#[test]
fn a_press_fit_is_pulled_out_by_its_friction() {
    let fit = |supports: Value, pull: f64| {
        let body = |name: &str, x: [f64; 2], supports: Value, loads: Value| {
            json!({ "name": name, "model": "axisymmetric",
                    "mesh": { "rectangle": { "x": x, "y": [0, 2], "cells": [6, 6] } },
                    "materials": [{ "young": 1000, "poisson": 0 }], "supports": supports, "loads": loads })
        };
        let held = json!([{ "group": "right", "displacement": [null, 0] }]);
        let value = json!({
            "bodies": [body("shaft", [0.0, 1.0], supports, json!([{ "body_force": [0, 0.1 * pull] }])),
                       body("hub", [1.0, 2.0], held, json!([]))],
            "contacts": [{ "body": "shaft", "group": "right", "friction": 0.3, "gap": -1e-3,
                           "against": { "body": "hub", "group": "left" } }]
        });
        scene(&value, Vec::new())
    };
    let limits = limit(&fit(json!([]), 1.0)).unwrap();
    assert_eq!(limits.loads[0].beyond, Beyond::Unbounded);
    let found = of(&limits.loads, 0);
    let pressed = certified(&fit(json!([]), 0.0)).totals.normal;
    close(0.1 * 2.0 * PI * found, 0.3 * pressed, 1e-6);
    // Linear cells on a pressure that falls as 1/r².
    close(found, 2.25, 0.02);
    let pulled = json!([{ "group": "left", "displacement": [null, 0.1] }]);
    let driven = certified(&fit(pulled, 0.0));
    close(
        driven.totals.friction[1].abs(),
        0.1 * 2.0 * PI * found,
        AGREE,
    );
    let above = is_the_limit(|part| fit(json!([]), part), found);
    close(missing(&above), 1e-3 * 0.1 * 2.0 * PI * found, 1e-3);
}

/// A quarter of a belt round a drum, pulled with 1 N at one end: e^(μ π/2) holds at the other (Euler, Eytelwein).
#[test]
fn a_belt_holds_what_euler_says() {
    let belt = |supports: Value, pull: f64| {
        let thick = 0.1;
        let value = json!({
            "bodies": [{ "name": "belt", "model": "plane_strain", "mesh": { "file": "given in code" },
                         "materials": [{ "young": 1e5, "poisson": 0 }], "supports": supports,
                         "loads": [{ "group": "left", "traction": [-1.0 / thick, 0] },
                                   { "group": "right", "traction": [0, -pull / thick] }] }],
            "contacts": [{ "group": "bottom", "friction": 0.3,
                           "obstacle": { "circle": { "center": [0, 0], "radius": 10 } } }]
        });
        scene(
            &value,
            vec![quarter(CellKind::Quad8, [10.0, 10.0 + thick], [48, 1])],
        )
    };
    let limits = limit(&belt(json!([]), 1.0)).unwrap();
    let found = of(&limits.loads, 1);
    // Friction acts half a thickness below the tension: a belt of a hundredth of the radius.
    close(found, (0.3 * FRAC_PI_2).exp(), 0.02);
    let Beyond::Grows { factor, .. } = limits.loads[1].beyond else {
        unreachable!("{limits:?}")
    };
    assert!(factor > found * (1.0 - 1e-6), "{factor}");
    is_the_limit(|part| belt(json!([]), part), found);
}

/// A wedge of slope 0.1 between elastic jaws that overlap it, pulled at its middle towards its thick end: as it moves out it
/// comes loose, so that what it resists falls from the first slip of the last contact on, a peak and no plateau.
#[test]
fn a_wedge_comes_loose_from_its_jaws_at_the_peak_of_its_resistance() {
    let half = |x: f64| 0.5 + 0.1 * x;
    let steps = |count: usize, low: f64, high: f64| -> Vec<f64> {
        let at = |k: usize| low + (high - low) * k as f64 / count as f64;
        (0..=count).map(at).collect()
    };
    let bent = |low: &dyn Fn(f64) -> f64, high: &dyn Fn(f64) -> f64, up: usize| {
        let (along, across) = (steps(4, 0.0, 2.0), steps(up, 0.0, 1.0));
        let mut mesh = rectangle(&along, &across, CellKind::Quad4).unwrap();
        for [x, y, _] in &mut mesh.nodes {
            *y = low(*x) + (high(*x) - low(*x)) * *y;
        }
        mesh
    };
    let wedge = |supports: Value, pull: f64| {
        let body = |name: &str, supports: Value, loads: Value| {
            json!({ "name": name, "model": "plane_strain", "mesh": { "file": "given in code" },
                    "materials": [{ "young": 1000, "poisson": 0.3 }], "supports": supports, "loads": loads })
        };
        let held = |group: &str| json!([{ "group": group, "displacement": [0, 0] }]);
        let load = json!([{ "point_force": [pull, 0], "at": [1, 0] }]);
        let joint = |own: &str, jaw: &str, other: &str| {
            json!({ "body": "wedge", "group": own, "friction": 0.3, "gap": -1e-3,
                    "against": { "body": jaw, "group": other } })
        };
        let value = json!({
            "bodies": [body("wedge", supports, load), body("upper", held("top"), json!([])),
                       body("lower", held("bottom"), json!([]))],
            "contacts": [joint("top", "upper", "bottom"), joint("bottom", "lower", "top")]
        });
        let meshes = vec![
            bent(&|x| -half(x), &half, 4),
            bent(&half, &|_| 2.0, 3),
            bent(&|_| -2.0, &|x| -half(x), 3),
        ];
        scene(&value, meshes)
    };
    let limits = limit(&wedge(json!([]), 0.1)).unwrap();
    assert_eq!(limits.loads[0].beyond, Beyond::Unbounded);
    let found = 0.1 * of(&limits.loads, 0);
    // The greatest pull of all displacements of the node, in nine rounds.
    let pull = |d: f64| {
        let held = json!([{ "at": [1, 0], "displacement": [d, null] }]);
        certified(&wedge(held, 0.0)).certificate.bodies[0]
            .supports
            .force[0]
            .abs()
    };
    let (mut low, mut high, mut most) = (0.0, 0.02, 0.0);
    for _ in 0..9 {
        let tried = steps(8, low, high);
        let pulls: Vec<f64> = tried.iter().map(|&d| pull(d)).collect();
        let best = (0..pulls.len())
            .max_by(|&a, &b| pulls[a].total_cmp(&pulls[b]))
            .unwrap();
        most = f64::max(most, pulls[best]);
        (low, high) = (tried[best.max(1) - 1], tried[(best + 1).min(8)]);
    }
    close(most, found, AGREE);
    is_the_limit(|part| wedge(json!([]), part), found);
}
