//! Scenes whose every value is acceptable but which cannot be solved are refused with what is
//! wrong and where; a contact node that cannot touch is left out and said so.

use dpana::scene::{SceneLoad, SceneObstacle, SceneSupport};
use dpana::{Scene, Status, solve};
use serde_json::{Value, json};

/// A unit square of 4 × 4 cells on the line y = 0, its top moved down.
fn square() -> Value {
    json!({
        "bodies": [{
            "name": "square",
            "mesh": {"rectangle": {"x": [0, 1], "y": [0, 1], "cells": [4, 4]}},
            "model": "plane_strain",
            "materials": [{"young": 1000, "poisson": 0.3}],
            "supports": [{"group": "top", "displacement": [0, -0.01]}]
        }],
        "contacts": [{
            "group": "bottom", "friction": 0.3,
            "obstacle": {"plane": {"point": [0, 0], "normal": [0, 1]}}
        }]
    })
}

fn with(mut scene: Value, pointer: &str, value: Value) -> Scene {
    *scene.pointer_mut(pointer).unwrap() = value;
    Scene::from_json(&scene.to_string(), "scene.json").unwrap()
}

/// What is said when a scene is solved; the file is always named.
fn said(scene: &Scene) -> String {
    let message = match solve(scene) {
        Ok(solution) => format!("{:?}", solution.status()),
        Err(error) => error.to_string(),
    };
    assert!(message.starts_with("scene.json: "), "{message}");
    message
}

fn check(scene: &Scene, words: &[&str]) {
    let message = said(scene);
    for word in words {
        assert!(message.contains(word), "no `{word}` in {message}");
    }
}

#[test]
fn a_support_at_an_angle_to_a_contact_normal_is_refused() {
    // The bottom's corners are held along x, the plane leans by 45°.
    let mut scene = square();
    scene["bodies"][0]["supports"] = json!([
        {"group": "left", "displacement": [0, null]},
        {"group": "top", "displacement": [null, 0]}
    ]);
    let leaning = json!({"plane": {"point": [0, -1], "normal": [1, 1]}});
    check(
        &with(scene, "/contacts/0/obstacle", leaning),
        &[
            "contacts[0]: node 0",
            "supported along x",
            "hold the normal or leave it free",
        ],
    );
}

#[test]
fn a_support_that_drags_a_contact_with_friction_is_refused() {
    let mut scene = square();
    scene["bodies"][0]["supports"] = json!([
        {"group": "left", "displacement": [0.001, null]},
        {"group": "top", "displacement": [null, 0]}
    ]);
    let rough = Scene::from_json(&scene.to_string(), "scene.json").unwrap();
    check(
        &rough,
        &["contacts[0]: node 0", "friction 0.3", "0.001 along x"],
    );
    // Without friction the same motion is nobody's concern.
    let smooth = with(scene, "/contacts/0/friction", json!(0));
    assert_eq!(solve(&smooth).unwrap().status(), Status::Certified);
}

#[test]
fn a_contact_surface_without_a_node_that_can_touch_is_refused() {
    // All of the bottom is held; then all of the contact surface looks away from the plane.
    let held = json!([
        {"group": "bottom", "displacement": [0, 0]},
        {"group": "top", "displacement": [0, -0.01]}
    ]);
    check(
        &with(square(), "/bodies/0/supports", held),
        &["the contact surface is empty", "5 nodes left out"],
    );
    check(
        &with(square(), "/contacts/0/group", json!("top")),
        &["contacts[0]: none of the 4 facets faces the obstacle"],
    );
}

#[test]
fn a_contact_node_whose_normal_is_supported_is_left_out_and_noted() {
    let supports = json!([
        {"group": "top", "displacement": [0, -0.01]},
        {"at": [0.25, 0], "displacement": [null, 0]},
        {"at": [0.75, 0], "displacement": [0, 0]}
    ]);
    let solution = solve(&with(square(), "/bodies/0/supports", supports)).unwrap();
    assert_eq!(solution.status(), Status::Certified);
    let report = solution.report().unwrap();
    assert_eq!(report.size.contacts, 3);
    assert!(
        report
            .contacts
            .iter()
            .all(|contact| ![1, 3].contains(&contact.node))
    );
    let note = "nodes 1, 3: no contact here, a support holds the normal displacement";
    assert_eq!(report.notes, [note]);
    // What the supports prescribe there holds exactly.
    assert_eq!(
        solution.displacement_near(0, [0.25, 0.0, 0.0]).unwrap()[1],
        0.0
    );
    assert_eq!(
        solution.displacement_near(0, [0.75, 0.0, 0.0]).unwrap(),
        [0.0; 3]
    );
}

#[test]
fn a_tangential_support_where_a_symmetry_plane_meets_the_contact_just_works() {
    // The right half of a square of 2 m under its own symmetry, against the whole.
    let whole = json!({"rectangle": {"x": [-1, 1], "y": [0, 1], "cells": [8, 4]}});
    let mut halved = square();
    halved["bodies"][0]["supports"] = json!([
        {"group": "left", "displacement": [0, null]},
        {"group": "top", "displacement": [null, -0.01]}
    ]);
    let half = Scene::from_json(&halved.to_string(), "scene.json").unwrap();
    halved["bodies"][0]["supports"][0] = json!({"at": [0, 1], "displacement": [0, null]});
    let whole = with(halved, "/bodies/0/mesh", whole);
    let [half, whole] = [half, whole].map(|scene| {
        let solution = solve(&scene).unwrap();
        assert_eq!(solution.status(), Status::Certified);
        solution
    });
    let report = half.report().unwrap();
    assert_eq!((report.size.contacts, report.size.contact_unknowns), (5, 9));
    assert!(report.notes.is_empty(), "{:?}", report.notes);
    for (&position, u) in half.bodies()[0]
        .mesh
        .nodes
        .iter()
        .zip(half.displacements()[0].chunks(2))
    {
        let expected = whole.displacement_near(0, position).unwrap();
        let (x, y) = (u[0] - expected[0], u[1] - expected[1]);
        assert!(x.hypot(y) < 1e-12, "{position:?}: {u:?} {expected:?}");
    }
}

#[test]
fn a_nan_anywhere_in_a_scene_built_in_code_is_refused_at_its_place() {
    let sound = Scene::from_json(&square().to_string(), "scene.json").unwrap();
    let refused = |place: &str, change: &dyn Fn(&mut Scene)| {
        let mut scene = sound.clone();
        change(&mut scene);
        check(&scene, &[place, "NaN"]);
    };
    refused("bodies[0].supports[0].displacement[1]", &|scene| {
        scene.bodies[0].supports[0] = SceneSupport::Group {
            group: "top".into(),
            displacement: vec![None, Some(f64::NAN)],
        };
    });
    refused("bodies[0].supports[0].at", &|scene| {
        scene.bodies[0].supports[0] = SceneSupport::At {
            at: vec![f64::NAN, 1.0],
            displacement: vec![Some(0.0), Some(0.0)],
        };
    });
    refused("bodies[0].loads[0]", &|scene| {
        scene.bodies[0].loads.push(SceneLoad::Pressure {
            group: "top".into(),
            pressure: f64::NAN,
        });
    });
    refused("bodies[0].loads[0]", &|scene| {
        scene.bodies[0].loads.push(SceneLoad::BodyForce {
            group: None,
            body_force: vec![0.0, f64::NAN],
        });
    });
    refused("bodies[0].materials[0].poisson", &|scene| {
        scene.bodies[0].materials[0].poisson = Some(f64::NAN);
    });
    refused("contacts[0].obstacle.plane.normal", &|scene| {
        scene.contacts[0].obstacle = Some(SceneObstacle::Plane {
            point: vec![0.0, 0.0],
            normal: vec![f64::NAN, 1.0],
        });
    });
    refused("contacts[0].obstacle.circle.radius", &|scene| {
        scene.contacts[0].obstacle = Some(SceneObstacle::Circle {
            center: vec![0.0, -1.0],
            radius: f64::NAN,
        });
    });
}

#[test]
fn numbers_at_the_end_of_the_range_of_doubles_never_get_a_certified_answer() {
    for (pointer, value) in [
        ("/bodies/0/materials/0/young", json!(1e308)),
        ("/bodies/0/materials/0/young", json!(1e-308)),
        ("/bodies/0/supports/0/displacement", json!([0, -1e308])),
        ("/contacts/0/obstacle/plane/point", json!([0, 1e308])),
    ] {
        let found = solve(&with(square(), pointer, value.clone()));
        let certified = found.is_ok_and(|found| found.status() == Status::Certified);
        assert!(!certified, "{pointer}: {value}");
    }
}

#[test]
fn friction_without_bound_is_a_weld() {
    let welded = |friction: f64| {
        let mut scene = square();
        scene["bodies"][0]["supports"][0]["displacement"] = json!([0.003, -0.01]);
        let solution = solve(&with(scene, "/contacts/0/friction", json!(friction))).unwrap();
        assert_eq!(solution.status(), Status::Certified);
        assert_eq!(solution.report().unwrap().totals.slip, 0);
        solution.displacements()[0].to_vec()
    };
    for (found, expected) in welded(1e308).iter().zip(welded(1e3)) {
        assert!((found - expected).abs() < 1e-14, "{found} {expected}");
    }
}

#[test]
fn bodies_that_glue_alone_holds_have_no_equilibrium_under_a_load_that_nothing_answers() {
    let block = |name: &str, y: [i32; 2]| {
        json!({
            "name": name,
            "mesh": {"rectangle": {"x": [0, 1], "y": y, "cells": [4, 4]}},
            "model": "plane_strain",
            "materials": [{"young": 1000, "poisson": 0.3}]
        })
    };
    let mut scene = json!({
        "bodies": [block("low", [0, 1]), block("up", [1, 2])],
        "contacts": [{"body": "up", "group": "bottom", "against": {"body": "low", "group": "top"}}]
    });
    for law in [
        json!("bonded"),
        json!({"no_separation": {"friction": 0.3}}),
        json!({"cohesion": {"tension": 5, "shear": 5}}),
    ] {
        scene["contacts"][0]["law"] = law.clone();
        scene["bodies"][1]["loads"] = json!([{"group": "top", "pressure": 1}]);
        let loaded = solve(&Scene::from_json(&scene.to_string(), "").unwrap()).unwrap();
        assert_eq!(loaded.status(), Status::NoEquilibrium, "{law}");
        let failure = loaded.outcome().failure.as_ref().unwrap();
        assert!(
            failure.proof.work > 0.0 && failure.proof.least_reaction > 1e3,
            "{law} {failure:?}"
        );
        // Pressed from both sides they hold each other.
        scene["bodies"][0]["loads"] = json!([{"group": "bottom", "pressure": 1}]);
        let answered = solve(&Scene::from_json(&scene.to_string(), "").unwrap()).unwrap();
        assert_eq!(answered.status(), Status::Certified, "{law}");
        scene["bodies"][0].as_object_mut().unwrap().remove("loads");
    }
}
