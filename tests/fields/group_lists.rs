//! A list of groups stands wherever a group does: as one group of all their members.

use dpana::scene::{SceneBody, SceneContact, SceneObstacle};
use dpana::{Scene, Solution, Status, solve};
use serde_json::{Value, json};

use crate::gaps::read;

/// Two blocks, the lower one on springs and split into two materials along x; every group is `name`, or the list that
/// `of` makes of it.
fn scene(of: impl Fn(&str) -> Value) -> Scene {
    let halves = |low: f64, high: f64| json!({ "x": [0, 4], "y": [low, high], "cells": [8, 4] });
    read(&json!({
        "bodies": [
            { "name": "lower", "mesh": { "rectangle": halves(0.0, 1.0) }, "model": "plane_strain",
              "groups": { "ends": ["left", "right"], "skin": ["top", "bottom"] },
              "materials": [{ "young": 1000, "poisson": 0.3, "group": of("body") }],
              "foundation": [{ "group": of("bottom"), "normal": 500, "stiffness": [100, 0] }],
              "supports": [{ "group": of("ends"), "displacement": [0, null] }] },
            { "name": "upper", "mesh": { "rectangle": halves(1.0, 2.0) }, "model": "plane_strain",
              "groups": { "ends": ["left", "right"], "skin": ["top", "bottom"] },
              "materials": [{ "young": 1000, "poisson": 0.3 }],
              "supports": [{ "group": of("ends"), "displacement": [0.001, null] }],
              "loads": [{ "group": of("top"), "pressure": 3 },
                        { "group": of("body"), "body_force": [0, -1] },
                        { "group": of("ends"), "traction": [0.5, 0] }] }
        ],
        "contacts": [{ "body": "upper", "group": of("skin"), "friction": 0.1,
                       "against": { "body": "lower", "group": of("skin") } }]
    }))
}

fn certified(scene: &Scene) -> Solution {
    let solution = solve(scene).unwrap();
    assert_eq!(solution.status(), Status::Certified);
    solution
}

#[test]
fn a_list_says_what_its_joined_group_says() {
    let joined = certified(&scene(|name| json!(name)));
    let listed = certified(&scene(|name| match name {
        "ends" => json!(["left", "right"]),
        "skin" => json!(["top", "bottom"]),
        // The same twice is once.
        one => json!([one, one]),
    }));
    assert_eq!(joined.displacements(), listed.displacements());
    assert_eq!(joined.outcome().reaction, listed.outcome().reaction);
}

#[test]
fn a_scene_with_lists_is_written_as_it_was_read() {
    let listed = scene(|name| json!([name, "top"]));
    let text = listed.to_json().unwrap();
    assert_eq!(Scene::from_json(&text, "").unwrap(), listed);
    let plain = scene(|name| json!(name)).to_json().unwrap();
    assert!(plain.contains(r#""group": "ends""#), "{plain}");
}

#[test]
fn lists_that_are_no_group_are_refused_by_place() {
    let refused = |group: Value| {
        let of = |name: &str| {
            if name == "ends" {
                group.clone()
            } else {
                json!(name)
            }
        };
        solve(&scene(of)).unwrap_err().to_string()
    };
    let said = refused(json!(["left", "rihgt"]));
    assert!(
        said.contains("bodies[0].supports[0].group[1]") && said.contains("right"),
        "{said}"
    );
    let said = refused(json!([]));
    assert!(
        said.contains("bodies[0].supports[0].group") && said.contains("empty"),
        "{said}"
    );
    let said = refused(json!(["left", "body"]));
    assert!(
        said.contains("group[1]") && said.contains("`body` of cells"),
        "{said}"
    );
    let text = scene(|name| json!(name)).to_json().unwrap();
    let wrong = text.replace(r#""group": "skin""#, r#""group": 7"#);
    let said = Scene::from_json(&wrong, "").unwrap_err().to_string();
    assert!(
        said.contains("the name of a group, or a list of names"),
        "{said}"
    );
}

#[test]
fn a_scene_in_code_takes_several_groups() {
    let mut of = scene(|name| json!(name));
    of.bodies.truncate(1);
    let body: &mut SceneBody = &mut of.bodies[0];
    body.foundation.clear();
    let plane = SceneObstacle::plane(&[0.0, -0.001], &[0.0, 1.0]);
    let mut contact = SceneContact::on(plane, "bottom", 0.0);
    contact.group = ["bottom", "left"].into();
    of.contacts = vec![contact];
    body.loads = vec![dpana::scene::SceneLoad::pressure("top", 1.0)];
    let report = certified(&of).report().unwrap();
    assert!((report.totals.normal - 4.0).abs() < 1e-9);
}
