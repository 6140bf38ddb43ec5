//! What a solve refuses before it begins, a check refuses in the same words; what it may refuse for want
//! of room, a check foresees; what is within a limit to the last digit is within it.

use std::fs;
use std::path::Path;

use dpana::{Scene, Status, check, solve};
use serde_json::{Value, json};

use crate::program::{dpana, folder};

/// Two rings of one height, the upper one from `low` on: the lower one ends at 5.
fn rings(low: f64) -> Value {
    let ring = |name: &str, x: [f64; 2], y: [f64; 2], held: &str| {
        json!({"name": name, "model": "axisymmetric",
            "mesh": {"rectangle": {"x": x, "y": y, "cells": [2, 1]}},
            "materials": [{"young": 2000, "poisson": 0.3}],
            "supports": [{"group": held, "displacement": [null, 0]}]})
    };
    json!({"bodies": [
            ring("lower", [4.0, 9.0], [0.0, 5.0], "bottom"),
            ring("upper", [4.0, 8.0], [low, 9.0], "top")],
        "contacts": [{"body": "upper", "group": "bottom", "friction": 0,
            "against": {"body": "lower", "group": "top"}}]})
}

/// A cube in front of a plane that looks the way of `up`.
fn cube(up: f64, moved: &[f64]) -> Value {
    json!({"bodies": [{"name": "cube",
            "mesh": {"box": {"x": [0, 1], "y": [0, 1], "z": [0, 1], "cells": [2, 2, 2]}},
            "materials": [{"young": 10, "poisson": 0.3}],
            "supports": [{"group": "bottom", "displacement": moved}]}],
        "contacts": [{"group": "top", "friction": 0.2,
            "obstacle": {"plane": {"point": [0, 0, 0.96], "normal": [0, 0, up]}}}]})
}

fn scene(value: &Value) -> Scene {
    Scene::from_json(&value.to_string(), "scene.json").unwrap()
}

#[test]
fn whatever_a_solve_refuses_a_check_refuses_in_the_same_words() {
    let mut dragged = cube(-1.0, &[0.0, 0.0, 0.0]);
    dragged["bodies"][0]["supports"][0] = json!({"group": "top", "displacement": [0.1, 0, null]});
    let mut askew = cube(-1.0, &[0.0, 0.0, 0.0]);
    askew["bodies"][0]["supports"][0] = json!({"group": "top", "displacement": [0, null, null]});
    askew["contacts"][0]["obstacle"]["plane"]["normal"] = json!([0.3, 0, -1]);
    let mut held = cube(-1.0, &[0.0, 0.0, 0.0]);
    held["bodies"][0]["supports"][0]["group"] = json!("top");
    for (value, words) in [
        (rings(4.5), "the bodies overlap by"),
        (cube(1.0, &[0.0, 0.0, 0.0]), "faces the obstacle"),
        (dragged, "a support moves it"),
        (askew, "supports that hold the normal"),
        (held, "contact surface is empty"),
    ] {
        let scene = scene(&value);
        let [solved, checked] = [
            solve(&scene).map(drop).unwrap_err().to_string(),
            check(&scene).map(drop).unwrap_err().to_string(),
        ];
        assert_eq!(solved, checked);
        assert!(checked.contains(words), "{checked}");
        // The unit of lengths is the scene's, which no message knows.
        assert!(!checked.contains(" m "), "{checked}");
        let folder = folder("check-refuses");
        fs::write(folder.join("scene.json"), value.to_string()).unwrap();
        assert_eq!(
            dpana(&folder, &["check", "scene.json"]).status.code(),
            Some(2)
        );
    }
}

#[test]
fn supports_that_load_steps_set_against_each_other_are_found_before_the_first_step() {
    let mut value = cube(-1.0, &[0.0, 0.0, 0.01]);
    let twice = json!({"group": "front", "displacement": [null, null, 0.01]});
    value["bodies"][0]["supports"]
        .as_array_mut()
        .unwrap()
        .push(twice);
    value["steps"] = json!({"at": [1, 2, 3],
        "factors": {"bodies[0].supports[0]": [[1, 1], [2, 1], [3, 2]]}});
    let refused = check(&scene(&value)).map(drop).unwrap_err().to_string();
    assert!(refused.contains("bodies[0].supports[1]"), "{refused}");
    value["steps"]["at"] = json!([1, 2]);
    assert!(check(&scene(&value)).is_ok());
}

#[test]
fn an_overlap_of_exactly_a_twentieth_is_accepted() {
    // A twentieth of the upper ring's 4 is 0.2: from 4.8, whose difference to 5 is no binary number.
    let solution = solve(&scene(&rings(4.8))).unwrap();
    assert_eq!(solution.status(), Status::Certified);
    let refused = solve(&scene(&rings(4.8 - 1e-6))).unwrap_err().to_string();
    assert!(refused.contains("expected at most 2e-1,"), "{refused}");
}

#[test]
fn a_check_says_how_many_contacts_there_are_and_what_room_they_take() {
    let mut value = cube(-1.0, &[0.0, 0.0, 0.0]);
    value["bodies"][0]["mesh"]["box"]["cells"] = json!([30, 30, 1]);
    let checked = check(&scene(&value)).unwrap();
    // 31² contacts of three unknowns, three matrices of doubles.
    assert_eq!(checked.surface.nodes.len(), 961);
    assert_eq!(checked.dense_bytes, 3 * 8 * (3 * 961_usize).pow(2));
}

#[test]
fn the_estimate_is_what_a_solve_takes() {
    // Held bodies and floating ones, in the plane and in space.
    for value in [rings(4.8), cube(-1.0, &[0.0, 0.0, 0.0])] {
        let found = check(&scene(&value)).unwrap().estimate;
        let solution = solve(&scene(&value)).unwrap();
        let work = solution.condensed().work();
        assert_eq!(found.unknowns, work.unknowns);
        assert_eq!(found.factor_entries, work.factor_entries);
        assert_eq!(found.contacts, solution.condensed().surface().nodes.len());
        // Every entry of L is computed by some operation, and by fewer than there are unknowns.
        let (entries, unknowns) = (work.factor_entries as f64, work.unknowns as f64);
        assert!(found.operations > 0.5 * entries && found.operations < 2.0 * entries * unknowns);
    }
}

#[test]
fn a_surface_drawn_clockwise_is_turned_back_with_a_note() {
    let mesh = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/meshes/E_clockwise.msh");
    let value = json!({"bodies": [{"mesh": {"file": mesh}, "model": "plane_strain",
            "materials": [{"young": 1000, "poisson": 0.3}],
            "loads": [{"group": "top", "pressure": 1}]}],
        "contacts": [{"group": "bottom", "friction": 0.3,
            "obstacle": {"plane": {"point": [0, 0], "normal": [0, 1]}}}]});
    let solution = solve(&Scene::from_json(&value.to_string(), "").unwrap()).unwrap();
    let report = solution.report().unwrap();
    // A pressure of 1 on a width of 2.
    assert!(
        (report.totals.normal - 2.0).abs() < 1e-12,
        "{}",
        report.totals.normal
    );
    assert!(
        report.notes[0].contains("ran clockwise"),
        "{:?}",
        report.notes
    );
}
