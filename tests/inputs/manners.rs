//! What the program says of itself: completions, manual pages, silence and threads.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::program::{dpana, folder};

const SCENE: &str = r#"{"bodies": [{"name": "block", "model": "plane_strain",
        "mesh": {"rectangle": {"x": [0, 1], "y": [0, 1], "cells": [8, 8]}},
        "materials": [{"young": 1000, "poisson": 0.3}],
        "supports": [{"group": "top", "displacement": [0.002, -0.01]}]}],
    "contacts": [{"group": "bottom", "friction": 0.3,
        "obstacle": {"plane": {"point": [0, 0], "normal": [0, 1]}}}]}"#;

/// Standard output of a run that must succeed.
fn said(arguments: &[&str]) -> String {
    let output = dpana(Path::new(env!("CARGO_TARGET_TMPDIR")), arguments);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {output:?}");
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn every_shell_gets_a_script_with_commands_and_options() {
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = said(&["completions", shell]);
        for word in ["half-space", "solve", "restart", "threads"] {
            assert!(script.contains(word), "{shell}: {word}");
        }
    }
    let output = dpana(&folder("no-shell"), &["completions", "dos"]);
    let words = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(words.contains("bash, elvish, fish"), "{words}");
}

#[test]
fn bash_completes_commands_and_options() {
    let folder = folder("bash");
    fs::write(folder.join("script"), said(&["completions", "bash"])).unwrap();
    for (words, expected) in [("che", "check"), ("solve --rest", "--restart")] {
        let words: Vec<&str> = words.split(' ').collect();
        let ask = format!(
            ". ./script; COMP_WORDS=(dpana {}); COMP_CWORD={}; _dpana dpana {} {}; echo ${{COMPREPLY[@]}}",
            words.join(" "),
            words.len(),
            words.last().unwrap(),
            if words.len() == 1 { "dpana" } else { words[0] },
        );
        let output = Command::new("bash")
            .current_dir(&folder)
            .args(["-c", &ask])
            .output();
        let output = output.unwrap();
        let found = String::from_utf8(output.stdout).unwrap();
        assert_eq!(found.trim(), expected, "{ask}");
    }
}

#[test]
fn the_manual_lists_every_command_and_describes_each() {
    let page = said(&["man"]);
    assert!(page.contains(".TH dpana 1"), "{page}");
    let help = said(&["--help"]);
    let (_, commands) = help.split_once("Commands:\n").unwrap();
    let commands = commands.lines().take_while(|line| !line.is_empty());
    let names = commands.filter(|line| line.starts_with("  ") && !line.starts_with("   "));
    let names: Vec<&str> = names
        .filter_map(|line| line.split_whitespace().next())
        .collect();
    assert!(names.len() > 9, "{help}");
    for name in names.iter().filter(|name| **name != "help") {
        let escaped = name.replace('-', "\\-");
        assert!(
            page.contains(&format!("dpana\\-{escaped}(1)")),
            "{name}: {page}"
        );
        let own = said(&["man", name]);
        assert!(own.contains(&format!(".TH dpana-{name} 1")), "{own}");
    }
    assert!(said(&["man", "solve"]).contains("\\-\\-restart"));
    let output = dpana(&folder("no-page"), &["man", "solv"]);
    let words = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(
        words.contains("man solv: no such command; expected one of solve"),
        "{words}"
    );
}

#[test]
fn a_quiet_solve_writes_its_files_and_says_nothing() {
    let folder = folder("quiet");
    fs::write(folder.join("scene.json"), SCENE).unwrap();
    for flag in ["-q", "--quiet"] {
        let output = dpana(
            &folder,
            &["solve", "scene.json", flag, "--report", "report.json"],
        );
        assert_eq!(output.status.code(), Some(0));
        assert!(
            output.stdout.is_empty() && output.stderr.is_empty(),
            "{output:?}"
        );
        let report = fs::read_to_string(folder.join("report.json")).unwrap();
        assert!(report.contains("\"certified\""));
    }
    // What cannot be solved is still named.
    let output = dpana(&folder, &["solve", "none.json", "-q"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(
        String::from_utf8(output.stderr)
            .unwrap()
            .contains("none.json")
    );
}

#[test]
fn threads_are_a_number_that_changes_no_bit() {
    let folder = folder("threads");
    fs::write(folder.join("scene.json"), SCENE).unwrap();
    let table = |arguments: &[&str]| {
        let solve = ["solve", "scene.json", "--table", "-"];
        let output = dpana(&folder, &[arguments, &solve].concat());
        assert_eq!(output.status.code(), Some(0), "{output:?}");
        String::from_utf8(output.stdout).unwrap()
    };
    let one = table(&["--threads", "1"]);
    assert_eq!(one, table(&["--threads", "3"]));
    assert_eq!(one, table(&[]));
    for count in ["0", "1025", "-1", "many", "99999999999999999999"] {
        let option = format!("--threads={count}");
        let output = dpana(&folder, &["solve", "scene.json", &option]);
        let words = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{words}");
        assert!(words.contains("--threads"), "{words}");
    }
}

#[test]
fn the_report_or_the_sweeps_are_printed_on_request() {
    let folder = folder("printed");
    fs::write(folder.join("scene.json"), SCENE).unwrap();
    let output = dpana(&folder, &["solve", "scene.json", "--json"]);
    assert_eq!(output.status.code(), Some(0));
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(report["status"], "certified");
    assert!(output.stderr.is_empty(), "{output:?}");
    let output = dpana(&folder, &["solve", "scene.json", "-v"]);
    let words = String::from_utf8(output.stdout).unwrap();
    let rows = words.lines().skip_while(|line| !line.starts_with("sweep "));
    let sweeps = report["work"]["sweeps"].as_u64().unwrap() as usize;
    assert_eq!(rows.count(), 1 + sweeps, "{words}");
    for flags in [
        ["--json", "-v"],
        ["-q", "-v"],
        ["--json", "--report=a.json"],
    ] {
        let output = dpana(&folder, &[&["solve", "scene.json"], &flags[..]].concat());
        assert_eq!(output.status.code(), Some(2), "{flags:?}");
    }
}

#[test]
fn a_starter_scene_of_a_mesh_is_sound_and_overwrites_nothing() {
    let folder = folder("starter");
    let data = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/meshes");
    let lug = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/meshes/lug.msh");
    for (from, parts) in [
        (
            lug.to_owned(),
            ["\"shank\"", "\"hole\"", "\"base\"", "\"pressure\": 1.0"],
        ),
        (
            format!("{data}/F_tets.msh"),
            ["\"split\"", "right block.own", "\"base\"", "left block"],
        ),
        (
            format!("{data}/F_hexes_zlib.vtu"),
            ["\"split\"", ".own", "\"base\"", "left_block"],
        ),
    ] {
        let name = Path::new(&from).file_name().unwrap().to_str().unwrap();
        fs::copy(&from, folder.join(name)).unwrap();
        let output = dpana(&folder, &["new", name]);
        let words = String::from_utf8(output.stdout).unwrap();
        assert_eq!(output.status.code(), Some(0), "{words}");
        assert!(words.contains("next: dpana check"), "{words}");
        let scene = Path::new(name).with_extension("json");
        let scene = scene.to_str().unwrap();
        let text = fs::read_to_string(folder.join(scene)).unwrap();
        for part in parts {
            assert!(text.contains(part), "`{part}` is not in {text}");
        }
        assert_eq!(dpana(&folder, &["check", scene]).status.code(), Some(0));
        let output = dpana(&folder, &["new", name]);
        assert_eq!(output.status.code(), Some(2));
        let words = String::from_utf8(output.stderr).unwrap();
        assert!(words.contains("is there already"), "{words}");
    }
    // A mesh without named surfaces has nothing to begin from.
    let bare = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n\
        $Elements\n1\n1 2 2 0 1 1 2 3\n$EndElements\n";
    fs::write(folder.join("bare.msh"), bare).unwrap();
    let output = dpana(&folder, &["new", "bare.msh"]);
    let words = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(words.contains("Physical Surface"), "{words}");
}
