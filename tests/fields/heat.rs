//! Heat and initial stress, beside closed forms.
//! (Timoshenko & Goodier, Theory of Elasticity, § 28 and 151.)

use std::fs;

use dpana::{Scene, Status, solve, solve_steps};
use serde_json::{Value, json};

use crate::gaps::{POISSON, TOO_THICK, YOUNG, fit, lame, off, read};
use crate::stacks::certified;

const EXPANSION: f64 = 1.2e-5;

#[test]
fn a_fit_by_heat_is_the_fit_by_gap() {
    // A ring of one temperature, held between plates, grows by (1 + ν) α T r.
    let rise = TOO_THICK / ((1.0 + POISSON) * EXPANSION * 20.0);
    let mut hot = fit(16, json!({}));
    hot["bodies"][0]["materials"][0]["expansion"] = json!(EXPANSION);
    hot["bodies"][0]["loads"] = json!([{"temperature": rise}]);
    let (by_heat, heated) = certified(&read(&hot));
    let (by_gap, fitted) = certified(&read(&fit(16, json!({"gap": -TOO_THICK}))));
    assert!(off(&heated, lame(TOO_THICK)) < 4e-3);
    for (a, b) in heated.contacts.iter().zip(&fitted.contacts) {
        let [a, b] = [a, b].map(|contact| contact.pressure.unwrap());
        assert!((a / b - 1.0).abs() < 1e-10, "{a} {b}");
    }
    // The hub does not know where its load comes from, nor does the shaft's von Mises stress in its plane.
    let [hot, cold] = [&by_heat, &by_gap].map(|solution| &solution.displacements()[1]);
    let largest = cold.iter().fold(0.0_f64, |most, u| most.max(u.abs()));
    assert!(
        hot.iter()
            .zip(cold)
            .all(|(a, b)| (a - b).abs() < 1e-10 * largest)
    );
    assert_eq!(by_heat.condensed().work().factorisations, 2);
    let substitutions =
        [&by_heat, &by_gap].map(|solution| solution.condensed().work().substitutions);
    assert_eq!(substitutions[0], substitutions[1]);
}

/// A hollow cylinder with radii 10 and 30 between plates, the lower one a contact; loads as given.
fn tube(kind: &str, cells: usize, loads: &Value) -> Value {
    json!({
        "bodies": [{
            "name": "tube",
            "mesh": {"rectangle": {"x": [10, 30], "y": [0, 5], "cells": [cells, 2], "cell": kind}},
            "model": "axisymmetric",
            "materials": [{"young": YOUNG, "poisson": POISSON, "expansion": EXPANSION,
                           "density": 7.85e-9}],
            "supports": [{"group": "top", "displacement": [null, 0]}],
            "loads": loads
        }],
        "contacts": [{"group": "bottom", "friction": 0,
                      "obstacle": {"plane": {"point": [0, 0], "normal": [0, 1]}}}]
    })
}

/// u_r and −σ_z at a radius under T = t + g r, no strain along the axis.
fn hot_tube(t: f64, g: f64, r: f64) -> [f64; 2] {
    let [a, b] = [10.0_f64, 30.0];
    let heat = |to: f64| t * (to * to - a * a) / 2.0 + g * (to.powi(3) - a.powi(3)) / 3.0;
    let all = heat(b) / (b * b - a * a);
    let u = (1.0 + POISSON) / (1.0 - POISSON) * EXPANSION / r
        * (heat(r) + ((1.0 - 2.0 * POISSON) * r * r + a * a) * all);
    let axial = EXPANSION * YOUNG / (1.0 - POISSON) * (t + g * r - 2.0 * POISSON * all);
    [u, axial]
}

#[test]
fn a_tube_with_a_temperature_across_its_wall_grows_and_presses_as_the_closed_form() {
    let load = json!([{"temperature": {"value": 60, "gradient": [-2, 0], "at": [10, 0]}}]);
    for (kind, most) in [
        ("quad4", 6e-3),
        ("tri3", 3e-2),
        ("quad8", 3e-4),
        ("quad9", 3e-4),
    ] {
        let (solution, report) = certified(&read(&tube(kind, 32, &load)));
        for r in [10.0, 20.0, 30.0] {
            let u = solution.displacement_near(0, [r, 2.5, 0.0]).unwrap()[0];
            let [expected, _] = hot_tube(80.0, -2.0, r);
            assert!(
                (u / expected - 1.0).abs() < most,
                "{kind} {r} {u} {expected}"
            );
        }
        let inside = report
            .contacts
            .iter()
            .filter(|c| c.position[0] > 11.0 && c.position[0] < 29.0);
        for contact in inside {
            let [_, expected] = hot_tube(80.0, -2.0, contact.position[0]);
            let pressure = contact.pressure.unwrap();
            assert!(
                (pressure / expected - 1.0).abs() < 3.0 * most,
                "{kind} {contact:?} {expected}"
            );
        }
    }
}

#[test]
fn a_table_of_nodes_is_the_function_that_it_tabulates() {
    let affine = json!([{"temperature": {"value": 60, "gradient": [-2, 1], "at": [10, 0]}}]);
    let scene = read(&tube("quad4", 8, &affine));
    let (expected, _) = certified(&scene);
    let mut text = String::from("# r, z, T\n\n");
    for [r, z, _] in &expected.bodies()[0].mesh.nodes {
        let rise = 60.0 - 2.0 * (r - 10.0) + z;
        text += &format!("{r}, {z} {rise:.17} # a node\n");
    }
    let folder = concat!(env!("CARGO_TARGET_TMPDIR"), "/tables");
    fs::create_dir_all(folder).unwrap();
    let table = |name: &str, text: &str| {
        fs::write(format!("{folder}/{name}"), text).unwrap();
        let scene = tube("quad4", 8, &json!([{"temperature": {"file": name}}]));
        Scene::from_json(&scene.to_string(), format!("{folder}/scene.json")).unwrap()
    };
    let (found, _) = certified(&table("whole.csv", &text));
    let [a, b] = [&found, &expected].map(|solution| &solution.displacements()[0]);
    assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-15));
    for (name, text, says) in [
        ("short.csv", "10, 0, 5\n", "no row for node 1"),
        ("wide.csv", "10, 0, 0, 5\n", "line 1: 4 entries; expected 3"),
        (
            "words.csv",
            "\n10, 0, hot\n",
            "line 2: `hot`; expected a finite number",
        ),
        ("nan.csv", "10, 0, NaN\n", "line 1: `NaN`"),
        (
            "twice.csv",
            "10, 0, 5\n10, 0, 6\n",
            "line 2: 6 at node 0, which has 5 already",
        ),
    ] {
        let refused = table(name, text).mechanics().unwrap_err().to_string();
        assert!(refused.contains(says), "{refused}");
        assert!(
            refused.contains("bodies[0].loads[0].temperature.file"),
            "{refused}"
        );
    }
    let gone = table("whole.csv", &text);
    fs::remove_file(format!("{folder}/whole.csv")).unwrap();
    assert!(
        gone.mechanics()
            .unwrap_err()
            .to_string()
            .contains("whole.csv")
    );
}

/// A plate of 2 × 1, held along x at both ends, on a plane; E = 1000, α = 1e-4.
fn held(loads: &Value, steps: &Value) -> Scene {
    read(&json!({
        "bodies": [{
            "mesh": {"rectangle": {"x": [0, 2], "y": [0, 1], "cells": [4, 2]}},
            "model": {"plane_stress": {"thickness": 0.5}},
            "materials": [{"young": 1000, "poisson": 0.3, "expansion": 1e-4}],
            "supports": [{"group": "left", "displacement": [0, null]},
                         {"group": "right", "displacement": [0, null]}],
            "loads": loads
        }],
        "contacts": [{"group": "bottom", "friction": 0,
                      "obstacle": {"plane": {"point": [0, 0], "normal": [0, 1]}}}],
        "steps": steps
    }))
}

#[test]
fn stress_follows_the_factor_of_heat_and_of_initial_stress() {
    // σ_xx = −E α T = −4 at a factor of one, and 6 of the initial stress that cannot relax along x;
    // the plate is free along y.
    let loads = json!([{"temperature": 40}, {"initial_stress": [6, 0, 0]}]);
    let steps = json!({"at": [1, 2, 3], "factors": {
        "bodies[0].loads[0]": [[1, 0], [2, 1], [3, 2]],
        "bodies[0].loads[1]": [[1, 1], [2, 1], [3, -1]]
    }});
    let mut found = Vec::new();
    solve_steps(&held(&loads, &steps), None, |solution| {
        assert_eq!(solution.status(), Status::Certified);
        assert!(solution.stress_error_estimate() < 1e-7);
        found.push(solution.extremes()[0].von_mises.value);
        Ok(())
    })
    .unwrap();
    for (found, expected) in found.iter().zip([6.0, 2.0, 14.0]) {
        assert!((found - expected).abs() < 1e-9, "{found} {expected}");
    }
}

#[test]
fn heat_in_some_cells_pushes_the_others() {
    // Two bars in series between walls, ν = 0, one of them warmed: σ = −E α T ½.
    let scene = json!({
        "bodies": [{
            "name": "warm",
            "mesh": {"rectangle": {"x": [0, 1], "y": [0, 1], "cells": [3, 2]}},
            "model": "plane_strain",
            "materials": [{"young": 1000, "poisson": 0, "expansion": 1e-4}],
            "supports": [{"group": "left", "displacement": [0, null]},
                         {"group": "bottom", "displacement": [null, 0]}],
            "loads": [{"temperature": 40, "group": "body"}]
        }, {
            "name": "cold",
            "mesh": {"rectangle": {"x": [1, 2], "y": [0, 1], "cells": [2, 3]}},
            "model": "plane_strain",
            "materials": [{"young": 1000, "poisson": 0}],
            "supports": [{"group": "right", "displacement": [0, null]},
                         {"group": "bottom", "displacement": [null, 0]}]
        }],
        "contacts": [{"body": "warm", "group": "right", "friction": 0,
                      "against": {"body": "cold", "group": "left"}}]
    });
    let (solution, report) = certified(&read(&scene));
    // In plane strain with ν = 0 nothing of the other directions enters.
    assert!(off(&report, 2.0) < 1e-10, "{:?}", report.contacts);
    let middle = solution.displacement_near(0, [1.0, 0.5, 0.0]).unwrap()[0];
    assert!((middle - 0.002).abs() < 1e-12);
}

#[test]
fn a_loose_hot_block_lies_on_the_floor_under_its_weight() {
    let scene = |rise: f64| {
        read(&json!({
            "bodies": [{
                "mesh": {"box": {"x": [0, 2], "y": [0, 1], "z": [0, 1], "cells": [4, 3, 2]}},
                "materials": [{"young": 1000, "poisson": 0.3, "expansion": 1e-3, "density": 2}],
                "loads": [{"gravity": [0, 0, -10]}, {"temperature": rise}]
            }],
            "contacts": [{"group": "bottom", "friction": 0.3,
                          "obstacle": {"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}}}]
        }))
    };
    for rise in [0.0, 1.0, 100.0] {
        let mut scene = scene(rise);
        if rise == 0.0 {
            scene.bodies[0].loads.pop();
        }
        let solution = solve(&scene).unwrap();
        assert_eq!(solution.status(), Status::Certified, "{rise}");
        let report = solution.report().unwrap();
        assert!((report.totals.normal - 40.0).abs() < 1e-8, "{rise}");
    }
}

#[test]
fn heat_that_makes_no_sense_is_refused_by_place() {
    let refused = |load: Value| {
        let mut scene = tube("quad4", 4, &json!([load]));
        scene["bodies"][0]["materials"][0]["expansion"] = json!(0);
        match Scene::from_json(&scene.to_string(), "") {
            Ok(scene) => scene.mechanics().unwrap_err().to_string(),
            Err(error) => error.to_string(),
        }
    };
    for (load, says) in [
        (
            json!({"temperature": 5}),
            "a `expansion` of a material that the load acts on",
        ),
        (
            json!({"temperature": "hot"}),
            "expected a number or an object",
        ),
        (json!({"temperature": {"value": 5}}), "or `file` alone"),
        (
            json!({"temperature": {"value": 5, "gradent": [1]}}),
            "did you mean `gradient`",
        ),
        (
            json!({"temperature": {"value": 5, "gradient": [1]}}),
            "bodies[0].loads[0].temperature.gradient: expected 2 entries, found 1",
        ),
        (
            json!({"temperature": 5, "group": "bottom"}),
            "a group of cells",
        ),
        (json!({"temperature": 5, "pressure": 1}), "exactly one of"),
        (
            json!({"initial_stress": [1, 2, 3]}),
            "initial_stress: expected 4 entries, found 3",
        ),
    ] {
        let found = refused(load);
        assert!(found.contains(says), "{found}");
    }
}
