//! The command line: exit status, and what it leaves on disk.

use std::fs;
use std::path::Path;

use crate::program::{dpana, folder};

/// Exit status and what was said on standard error.
fn refused(folder: &Path, arguments: &[&str]) -> (Option<i32>, String) {
    let output = dpana(folder, arguments);
    let said = String::from_utf8(output.stderr).unwrap();
    (output.status.code(), said)
}

/// A square of 4 × 4 cells on a line, pressed by its top; `supports` hold it.
fn scene(supports: &str) -> String {
    format!(
        r#"{{"bodies": [{{"name": "block", "model": "plane_strain",
        "mesh": {{"rectangle": {{"x": [0, 1], "y": [0, 1], "cells": [4, 4]}}}},
        "materials": [{{"young": 1000, "poisson": 0.3}}], "supports": [{supports}]}}],
        "contacts": [{{"group": "bottom", "friction": 0.3,
        "obstacle": {{"plane": {{"point": [0, 0], "normal": [0, 1]}}}}}}]}}"#
    )
}

const PRESSED: &str = r#"{"group": "top", "displacement": [0, -0.01]}"#;

#[test]
fn a_sound_scene_is_described_and_a_floating_one_named() {
    let folder = folder("check");
    fs::write(folder.join("sound.json"), scene(PRESSED)).unwrap();
    let output = dpana(&folder, &["check", "sound.json"]);
    let said = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(0));
    assert!(said.contains("25 nodes, 16 cells"), "{said}");
    assert!(
        said.contains("contact `bottom`: 4 facets, friction 0.3"),
        "{said}"
    );

    fs::write(folder.join("floating.json"), scene("")).unwrap();
    let output = dpana(&folder, &["check", "floating.json"]);
    let said = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(0));
    assert!(
        said.contains("body `block`: 3 rigid motions that only contact holds"),
        "{said}"
    );
}

#[cfg(not(feature = "mumps"))]
#[test]
fn an_engine_that_was_not_built_in_is_named_with_what_it_needs() {
    let folder = folder("engine");
    fs::write(folder.join("scene.json"), scene(PRESSED)).unwrap();
    let (code, said) = refused(&folder, &["solve", "scene.json", "--engine", "mumps"]);
    assert_eq!(code, Some(2));
    for part in [
        "without the feature `mumps`",
        "--features mumps",
        "libmumps-dev",
    ] {
        assert!(said.contains(part), "{said}");
    }
    let (code, said) = refused(&folder, &["solve", "scene.json", "--engine", "pardiso"]);
    assert_eq!(code, Some(2));
    assert!(said.contains("faer, mumps"), "{said}");
}

#[test]
fn the_schema_is_json_and_describes_scenes() {
    let output = dpana(&folder("schema"), &["schema"]);
    assert_eq!(output.status.code(), Some(0));
    let schema: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(schema["title"], "Scene");
    assert_eq!(schema, dpana::scene::schema());
}

#[test]
fn bad_input_exits_with_2_and_overwrites_nothing() {
    let folder = folder("bad");
    let bad = scene(PRESSED).replace("0.3}]", "0.5}]");
    fs::write(folder.join("bad.json"), &bad).unwrap();
    fs::write(folder.join("report.json"), "kept").unwrap();
    let solve = [
        "solve",
        "bad.json",
        "--report",
        "report.json",
        "--vtu",
        "body.vtu",
    ];
    let (code, said) = refused(&folder, &solve);
    assert_eq!(code, Some(2));
    assert!(
        said.contains("bad.json: bodies[0].materials[0].poisson: 0.5"),
        "{said}"
    );
    let kept = fs::read_to_string(folder.join("report.json")).unwrap();
    assert_eq!(kept, "kept");
    assert!(!folder.join("body.vtu").exists());
}

#[test]
fn output_that_cannot_be_written_is_refused_before_the_solve() {
    let folder = folder("output");
    fs::write(folder.join("sound.json"), scene(PRESSED)).unwrap();
    for (report, words) in [
        ("nowhere/report.json", "its folder does not exist"),
        (".", "is a folder"),
        ("./sound.json", "would overwrite the scene"),
    ] {
        let (code, said) = refused(&folder, &["solve", "sound.json", "--report", report]);
        assert_eq!(code, Some(2));
        assert!(said.contains("--report") && said.contains(words), "{said}");
    }
    let text = fs::read_to_string(folder.join("sound.json")).unwrap();
    assert_eq!(text, scene(PRESSED));
}

#[test]
fn a_missing_scene_and_unknown_words_exit_with_2() {
    let folder = folder("unknown");
    let (code, said) = refused(&folder, &["check", "none.json"]);
    assert_eq!(
        (code, said.contains("none.json")),
        (Some(2), true),
        "{said}"
    );
    assert_eq!(refused(&folder, &["solv"]).0, Some(2));
    assert_eq!(refused(&folder, &["solve"]).0, Some(2));
}

/// The block of 1 × 1 m under 10 N/m² of weight that nothing but the floor holds, pulled along it.
fn loose(pull: f64) -> String {
    let mut scene: serde_json::Value = serde_json::from_str(&scene("")).unwrap();
    scene["bodies"][0]["loads"] = serde_json::json!([
        { "body_force": [0, -10] },
        { "group": "bottom", "traction": [pull, 0] }
    ]);
    scene.to_string()
}

#[test]
fn other_numbers_of_cells_are_refused_for_meshes_from_files() {
    let folder = folder("levels");
    let file = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/tests/data/meshes/A_block_n32.msh"
    );
    let mut scene: serde_json::Value = serde_json::from_str(&scene(PRESSED)).unwrap();
    scene["bodies"][0]["mesh"] = serde_json::json!({ "file": file });
    scene["contacts"][0]["group"] = "contact".into();
    fs::write(folder.join("file.json"), scene.to_string()).unwrap();
    for asked in [["--levels", "3"], ["--refine", "1,2"]] {
        let arguments = [&["study", "file.json", "--out", "s"][..], &asked].concat();
        let (code, said) = refused(&folder, &arguments);
        assert_eq!(code, Some(2));
        assert!(
            said.contains(asked[0]) && said.contains("--meshes"),
            "{said}"
        );
    }
    assert!(!folder.join("s").exists());
}

#[test]
fn friction_is_not_advised_to_a_body_that_lifts() {
    let folder = folder("lifts");
    let mut lifted: serde_json::Value = serde_json::from_str(&loose(0.0)).unwrap();
    lifted["bodies"][0]["loads"][0] = serde_json::json!({ "body_force": [0, 10] });
    fs::write(folder.join("lifted.json"), lifted.to_string()).unwrap();
    fs::write(folder.join("slides.json"), loose(3.5)).unwrap();
    for (scene, helps) in [("lifted.json", false), ("slides.json", true)] {
        let output = dpana(&folder, &["solve", scene]);
        let said = String::from_utf8(output.stdout).unwrap();
        assert_eq!(said.contains("by more friction"), helps, "{said}");
        assert_eq!(said.contains("held by no friction"), !helps, "{said}");
    }
}

#[test]
fn limits_are_printed_and_written() {
    let folder = folder("limit");
    fs::write(folder.join("loose.json"), loose(1.5)).unwrap();
    let output = dpana(&folder, &["limit", "loose.json", "--report", "limits.json"]);
    let said = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(0), "{said}");
    // μ W / pull = 0.3 · 10 / 1.5.
    assert!(
        said.contains("up to 2.000000000 times; then block slides along +x"),
        "{said}"
    );
    let written = fs::read_to_string(folder.join("limits.json")).unwrap();
    let limits: serde_json::Value = serde_json::from_str(&written).unwrap();
    assert_eq!(limits["loads"][1]["limit"], "grows");
    assert_eq!(limits["loads"][1]["certified"], true);
}

#[test]
fn a_block_that_slides_away_is_an_answer_with_exit_status_one() {
    let folder = folder("slides");
    fs::write(folder.join("loose.json"), loose(3.5)).unwrap();
    let output = dpana(&folder, &["solve", "loose.json"]);
    let said = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("NO EQUILIBRIUM"), "{said}");
    assert!(
        said.contains("block slides along +x; missing friction: 0.5"),
        "{said}"
    );
}
