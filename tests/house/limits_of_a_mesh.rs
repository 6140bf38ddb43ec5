//! What mesh and theory cannot give is said with numbers, and nothing is said where they can; extremes
//! and support forces are those of statics.

use std::f64::consts::PI;

use dpana::body::{CellKind, Facet, Group, Mesh, graded, rectangle};
use dpana::report::Report;
use dpana::scene::MeshSource;
use dpana::{Scene, solve};
use serde_json::{Value, json};

fn report(scene: &Value) -> Report {
    let scene = Scene::from_json(&scene.to_string(), "").unwrap();
    solve(&scene).unwrap().report().unwrap()
}

/// Exactly one note, and it says this.
fn noted(report: &Report, words: &[&str]) {
    let about = |note: &&String| words.iter().all(|word| note.contains(word));
    assert_eq!(
        report.notes.iter().filter(about).count(),
        1,
        "{words:?} {:?}",
        report.notes
    );
}

/// A block of 1 × 1 × 1, pressed on a plane by a pressure on its top.
fn block(pressure: f64) -> Value {
    json!({"bodies": [{"name": "block", "model": "plane_strain",
            "mesh": {"rectangle": {"x": [0, 1], "y": [0, 1], "cells": [4, 4]}},
            "materials": [{"young": 1000, "poisson": 0}],
            "supports": [{"group": "left", "displacement": [0, null]}],
            "loads": [{"group": "top", "pressure": pressure}]}],
        "contacts": [{"group": "bottom", "friction": 0,
            "obstacle": {"plane": {"point": [0, 0], "normal": [0, 1]}}}]})
}

#[test]
fn extremes_and_support_forces_are_those_of_a_column_and_nothing_is_noted() {
    let mut scene = block(2.0);
    scene["bodies"][0]["loads"][0] = json!({"group": "top", "traction": [0.3, -2]});
    scene["bodies"][0]["supports"] = json!([
        {"group": "left", "displacement": [0, null]},
        {"group": "right", "displacement": [0, null]}]);
    let found = report(&scene);
    // Held across its axis, ν = 0: ε = σ/E = 2e-3 along it; the traction across goes into both sides.
    assert!((found.extremes.von_mises.value / 2.0 - 1.0).abs() < 0.5);
    let across: f64 = found.supports.iter().map(|support| support.force[0]).sum();
    assert!((across + 0.3).abs() < 1e-12, "{across}");
    assert_eq!(found.supports[1].place, "bodies[0].supports[1]");
    let straight = report(&block(2.0));
    assert!((straight.extremes.displacement.value - 2e-3).abs() < 1e-15);
    assert!((straight.extremes.von_mises.value - 2.0).abs() < 1e-12);
    assert!((straight.extremes.strain.value - 2e-3).abs() < 1e-15);
    assert!(straight.extremes.rotation.value < 1e-12);
    assert!(straight.supports[0].force[0].abs() < 1e-12);
    assert!(straight.notes.is_empty(), "{:?}", straight.notes);
    let said = straight.summary();
    assert!(
        said.contains("von Mises       2.00000 at most, at the centre of cell"),
        "{said}"
    );
    assert!(said.contains("by bodies[0].supports[0]"), "{said}");
}

#[test]
fn strain_and_rotation_beyond_small_displacements_are_told() {
    // 6 % of strain; 4 % is let pass.
    assert!(report(&block(40.0)).notes.is_empty());
    noted(&report(&block(60.0)), &["strain of 6.0 %"]);
    // A cantilever of slenderness 20 whose end goes down by a fifth of its length.
    let beam = json!({"bodies": [{"name": "beam", "model": "plane_stress",
            "mesh": {"rectangle": {"x": [0, 20], "y": [0, 1], "cells": [20, 2], "cell": "quad8"}},
            "materials": [{"young": 1000, "poisson": 0}],
            "supports": [{"group": "left", "displacement": [0, 0]},
                {"at": [20, 0.5], "displacement": [null, -4]}]}],
        "contacts": [{"group": "bottom", "friction": 0,
            "obstacle": {"plane": {"point": [0, -9], "normal": [0, 1]}}}]});
    let mut beam = beam;
    beam["bodies"][0]["model"] = json!({"plane_stress": {"thickness": 1}});
    let found = report(&beam);
    // Slope at the end 3/2 δ/l = 0.3, which is 17 degrees.
    noted(&found, &["turns by 17", "degrees"]);
    noted(&found, &["nothing touches", "5"]);
}

#[test]
fn a_block_dragged_over_another_by_more_than_a_cell_is_told() {
    let part = |name: &str, y: [f64; 2], held: &str, moved: [f64; 2]| {
        json!({"name": name, "model": "plane_strain",
            "mesh": {"rectangle": {"x": [0, 1], "y": y, "cells": [5, 2]}},
            "materials": [{"young": 1000, "poisson": 0}],
            "supports": [{"group": held, "displacement": moved}]})
    };
    let dragged = |by: f64| {
        report(&json!({"bodies": [
                part("upper", [1.0, 2.0], "top", [by, -0.01]),
                part("lower", [0.0, 1.0], "bottom", [0.0, 0.0])],
            "contacts": [{"body": "upper", "group": "bottom", "friction": 0,
                "against": {"body": "lower", "group": "top"}}]}))
    };
    // Cells of 0.2; what belongs to a contact is 1/6 in the mean of six.
    assert!(dragged(0.15).notes.is_empty());
    noted(
        &dragged(0.25),
        &["contacts[0]", "moves by 0.25", "a cell (0.1667)"],
    );
}

#[test]
fn an_obstacle_deeper_than_a_fit_and_a_single_contact_are_told() {
    let mut deep = block(0.0);
    deep["contacts"][0]["obstacle"]["plane"]["point"] = json!([0, 0.06]);
    deep["bodies"][0]["supports"] = json!([{"group": "top", "displacement": [0, 0]}]);
    noted(&report(&deep), &["lies 0.06 deep", "extent 1 "]);
    let mut tip = block(1e-4);
    tip["bodies"][0]["supports"][0]["group"] = json!("top");
    tip["contacts"][0]["obstacle"] = json!({"circle": {"center": [0.5, -3], "radius": 3}});
    noted(&report(&tip), &["one contact alone carries, node 2"]);
}

/// Half a ring of inner radius 0.5 and outer radius 1, `cells` straight facets around, pushed up into a
/// plane on its top by `moved`.
fn ring(cells: usize, moved: f64) -> Report {
    let mut mesh = Mesh::new(2, Vec::new());
    for radius in [0.5, 1.0] {
        let at = |k: usize| {
            let angle = PI * k as f64 / cells as f64;
            [radius * angle.cos(), radius * angle.sin(), 0.0]
        };
        mesh.nodes.extend((0..=cells).map(at));
    }
    let outer = |k: usize| cells + 1 + k;
    (0..cells).for_each(|k| mesh.push_cell(CellKind::Quad4, &[k, outer(k), outer(k + 1), k + 1]));
    let facet = |k: usize| Facet {
        nodes: vec![outer(k), outer(k + 1)],
    };
    let skin = Group::Facets((0..cells).map(facet).collect());
    mesh.groups.insert("skin".into(), skin);
    mesh.groups
        .insert("held".into(), Group::Points((0..=cells).collect()));
    let body = json!({"mesh": {"rectangle": {"x": [0, 1], "y": [0, 1], "cells": [1, 1]}},
        "model": "plane_strain", "materials": [{"young": 1000, "poisson": 0.3}],
        "supports": [{"group": "held", "displacement": [0, moved]}]});
    let contact = json!({"group": "skin", "friction": 0,
        "obstacle": {"plane": {"point": [0, 1], "normal": [0, -1]}}});
    let scene = json!({"bodies": [body], "contacts": [contact]}).to_string();
    let mut scene = Scene::from_json(&scene, "").unwrap();
    scene.bodies[0].mesh = MeshSource::Given(mesh);
    solve(&scene).unwrap().report().unwrap()
}

#[test]
fn facets_that_turn_too_far_or_stand_off_by_as_much_as_bodies_approach_are_told() {
    // Ten facets on the half turn by 18 degrees.
    noted(&ring(10, 0.02), &["facets turn by up to 18 degrees"]);
    // Twenty turn by 0.1571, their middles 0.1564 apart: 2/3 of L φ/8 is 0.002048; the neighbours of the top stand 1 − cos 9° off.
    noted(
        &ring(20, 0.03),
        &["by 0.002048 in the mean", "each other by 0.01231"],
    );
    // Facets of one degree stand off by 2.5e-5: nothing beside a contact of many of them.
    let fine = ring(180, 0.1).notes;
    assert!(fine.iter().all(|note| !note.contains("facets")), "{fine:?}");
}

/// A wide block on a narrow one, or the other way round, and only the part of the wide face that lies over the
/// narrow one as a contact group.
#[test]
fn a_rim_is_not_noted_where_the_other_body_simply_ends() {
    let rims = |width: f64| {
        let part =
            |name: &str, x: [f64; 2], y: [f64; 2], cells: [usize; 2], held: &str, up: f64| {
                json!({"name": name, "model": "plane_strain",
                "mesh": {"rectangle": {"x": x, "y": y, "cells": cells}},
                "materials": [{"young": 1000, "poisson": 0.3}],
                "supports": [{"group": held, "displacement": [0, up]}]})
            };
        let scene = json!({"bodies": [
                part("wide", [0.0, 4.0], [0.0, 1.0], [8, 2], "bottom", 0.0),
                part("punch", [0.0, width], [1.0, 2.0], [4, 2], "top", -0.01)],
            "contacts": [{"body": "wide", "group": "top", "friction": 0.2,
                "against": {"body": "punch", "group": "bottom"}}]});
        let mut scene = Scene::from_json(&scene.to_string(), "").unwrap();
        let MeshSource::Rectangle { rectangle } = &scene.bodies[0].mesh else {
            unreachable!()
        };
        let mut mesh = rectangle_mesh(rectangle.x, rectangle.y, [8, 2]);
        // Nodes of the top row from left to right; the first four facets only.
        let facet = |k: usize| Facet {
            nodes: vec![18 + k + 1, 18 + k],
        };
        let top = Group::Facets((0..4).map(facet).collect());
        mesh.groups.insert("top".into(), top);
        scene.bodies[0].mesh = MeshSource::Given(mesh);
        let notes = solve(&scene).unwrap().report().unwrap().notes;
        notes.iter().filter(|note| note.contains("rim")).count()
    };
    // The punch ends where the group ends, at 2; or goes on to 3.
    assert_eq!((rims(2.0), rims(3.0)), (0, 1));
}

fn rectangle_mesh(x: [f64; 2], y: [f64; 2], cells: [usize; 2]) -> Mesh {
    let lines = |[from, to]: [f64; 2], cells: usize| graded(from, to, cells, 1.0).unwrap();
    rectangle(&lines(x, cells[0]), &lines(y, cells[1]), CellKind::Quad4).unwrap()
}
