//! Cells of several kinds in one mesh, cells that bend, bodies that are parts of a mesh file.

use dpana::Scene;
use dpana::body::{CellKind, Mesh, mixed_box};
use dpana::scene::MeshSource;
use serde_json::{Value, json};

use crate::stacks::certified;

fn shipped(name: &str) -> Value {
    let file = format!("{}/examples/scenes/{name}.json", env!("CARGO_MANIFEST_DIR"));
    serde_json::from_str(&std::fs::read_to_string(file).unwrap()).unwrap()
}

fn read(scene: &Value) -> Result<Scene, dpana::Error> {
    let source = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/scenes/given.json");
    Scene::from_json(&scene.to_string(), source)
}

#[test]
fn the_shipped_leaves_bend_as_two_beams_and_plain_cells_do_not() {
    // w = P L³/(3 · 2 E' I), I = 4³/12, E' = E/(1 − ν²), P = 20 per mm of depth; shear adds 3 E' I/(κ G h L²) of it,
    // κ = 5/6, and friction at the tip, where the leaves press each other by P/2, takes ¾ μ h/L.
    let young = 210e3 / (1.0 - 0.09);
    let shear = 3.0 * young * 64.0 / 12.0 / (5.0 / 6.0 * 210e3 / 2.6 * 4.0 * 1600.0);
    let expected = -20.0 * 64e3 / (6.0 * young * 64.0 / 12.0) * (1.0 + shear - 0.0075);
    let tip = |scene: &Value| {
        let (solution, _) = certified(&read(scene).unwrap());
        let nodes = &solution.bodies()[1].mesh.nodes;
        let at = nodes.iter().position(|x| *x == [40.0, 0.0, 0.0]).unwrap();
        solution.displacements()[1][2 * at + 1] / expected
    };
    let mut scene = shipped("leaf_spring");
    let found = tip(&scene);
    assert!((found - 1.0).abs() < 0.01, "{found}");
    for body in scene["bodies"].as_array_mut().unwrap() {
        body.as_object_mut().unwrap().remove("formulation");
    }
    let plain = tip(&scene);
    assert!(plain < 0.95, "{plain}");
}

#[test]
fn the_shipped_bridge_carries_its_load_in_one_piece_and_as_an_assembly() {
    // 300 kPa on 2 m × 1 m.
    for name in ["bridge", "assembly"] {
        let (_, report) = certified(&read(&shipped(name)).unwrap());
        let normal = report.totals.normal.abs();
        assert!((normal / 600.0 - 1.0).abs() < 1e-10, "{name}: {normal}");
    }
}

#[test]
fn general_contact_finds_the_pairs_that_a_scene_would_name() {
    let mut scene = shipped("assembly");
    let (_, named) = certified(&read(&scene).unwrap());
    scene.as_object_mut().unwrap().remove("contacts");
    scene["general_contact"] = json!({"distance": 0.01, "friction": 0.5});
    let (_, found) = certified(&read(&scene).unwrap());
    assert_eq!(found.totals.pairs[0].place, "general_contact: deck, feet");
    assert!((found.totals.normal / named.totals.normal - 1.0).abs() < 1e-10);
    assert!((found.totals.peak_pressure / named.totals.peak_pressure - 1.0).abs() < 1e-9);
    let say = |change: &dyn Fn(&mut Value)| {
        let mut scene = scene.clone();
        change(&mut scene);
        read(&scene)
            .and_then(|scene| scene.mechanics().map(|_| ()))
            .unwrap_err()
            .to_string()
    };
    let found = say(&|scene| scene["general_contact"]["distance"] = json!(0));
    assert!(found.contains("general_contact.distance: 0"), "{found}");
    let found = say(&|scene| scene["bodies"].as_array_mut().unwrap().truncate(1));
    assert!(found.contains("general_contact.distance: 0.01"), "{found}");
    let found = say(&|scene| scene["general_contact"]["friction"] = json!(-1));
    assert!(
        found.contains("general_contact: deck, feet.friction: -1"),
        "{found}"
    );
}

/// A tower of three blocks and a wall beside the second one.
#[test]
fn every_two_skins_that_face_each_other_make_a_pair_and_no_others() {
    let block = |name: &str, x: [f64; 2], y: [f64; 2], cells: [usize; 2]| {
        json!({"name": name, "model": "plane_strain", "materials": [{"young": 1000, "poisson": 0}],
            "mesh": {"rectangle": {"x": x, "y": y, "cells": cells}}})
    };
    let mut bodies = vec![
        block("low", [0.0, 1.0], [0.0, 1.0], [4, 4]),
        block("middle", [0.0, 1.0], [1.0, 2.0], [5, 5]),
        block("high", [0.0, 1.0], [2.0, 3.0], [4, 4]),
        block("wall", [1.0, 2.0], [1.0, 2.0], [3, 3]),
    ];
    bodies[0]["supports"] = json!([{"group": "bottom", "displacement": [0, 0]}]);
    bodies[2]["loads"] = json!([{"group": "top", "pressure": 1}]);
    bodies[3]["supports"] = json!([{"group": "right", "displacement": [0, 0]}]);
    let scene = json!({"bodies": bodies, "general_contact": {"distance": 0.01, "friction": 0.3}});
    let (_, report) = certified(&read(&scene).unwrap());
    let places: Vec<_> = report
        .totals
        .pairs
        .iter()
        .map(|pair| pair.place.as_str())
        .collect();
    let expected = ["low, middle", "middle, high", "middle, wall"]
        .map(|pair| format!("general_contact: {pair}"));
    assert_eq!(places, expected);
    // ν = 0: nothing pushes on the wall.
    let normal = [0, 1, 2].map(|at| report.totals.pairs[at].totals.normal.abs());
    assert!(
        (normal[0] - 1.0).abs() < 1e-9 && (normal[1] - 1.0).abs() < 1e-9 && normal[2] < 1e-9,
        "{normal:?}"
    );
}

#[test]
fn parts_and_joined_groups_that_are_none_are_refused() {
    let say = |change: &dyn Fn(&mut Value)| {
        let mut scene = shipped("assembly");
        change(&mut scene);
        match read(&scene).and_then(|scene| scene.mechanics().map(|_| ())) {
            Ok(()) => String::new(),
            Err(error) => error.to_string(),
        }
    };
    assert_eq!(say(&|_| ()), "");
    let cases: [(&str, Value, &[&str]); 7] = [
        (
            "/bodies/0/mesh/groups",
            json!(["dekc"]),
            &["bodies[0].mesh.groups[0]", "dekc", "deck"],
        ),
        ("/bodies/0/mesh/groups", json!([]), &["at least one group"]),
        (
            "/bodies/0/mesh/groups",
            json!(["loaded"]),
            &["bodies[0].mesh.groups[0]", "a group of cells"],
        ),
        (
            "/bodies/0/groups/under",
            json!(["seam_left", "deck"]),
            &["groups.under[1]", "`deck` of cells", "surface facets"],
        ),
        (
            "/bodies/0/groups/under",
            json!([]),
            &["bodies[0].groups.under", "empty"],
        ),
        (
            "/bodies/0/groups",
            json!({"deck": ["deck"]}),
            &["groups.deck", "which the mesh has"],
        ),
        (
            "/bodies/0/groups/under",
            json!(["ground_left"]),
            &["groups.under[0]", "ground_left"],
        ),
    ];
    for (at, value, said) in cases {
        let found = say(&|scene| *scene.pointer_mut(at).unwrap() = value.clone());
        assert!(
            said.iter().all(|part| found.contains(part)),
            "{said:?}: {found}"
        );
    }
    let mut scene = shipped("leaf_spring");
    scene["bodies"][0]["mesh"]["rectangle"]["cell"] = json!("tri3");
    let found = read(&scene)
        .and_then(|scene| scene.mechanics().map(|_| ()))
        .unwrap_err()
        .to_string();
    assert!(
        found.contains("formulation") && found.contains("quad4"),
        "{found}"
    );
}

#[test]
fn a_quadrilateral_beside_two_triangles_is_refused() {
    let line = [0.0, 1.0];
    let kind = |[_, _, k]: [usize; 3]| [CellKind::Hex8, CellKind::Prism6][k];
    let mesh: Mesh = mixed_box(&line, &line, &[0.0, 1.0, 2.0], kind).unwrap();
    let mut scene = read(&shipped("cube")).unwrap();
    scene.bodies.truncate(1);
    scene.bodies[0].mesh = MeshSource::Given(mesh);
    scene.bodies[0].supports.clear();
    scene.bodies[0].loads.clear();
    let found = scene.mechanics().unwrap_err().to_string();
    assert!(found.contains("a pyramid goes between"), "{found}");
}
