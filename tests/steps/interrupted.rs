//! A load history that is stopped on the way leaves its last complete state, to go on from.
#![cfg(unix)]

use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::program::{dpana, folder};
use serde_json::{Value, json};

/// A block with many load steps, each long enough to be stopped in.
fn scene() -> Value {
    let steps: Vec<f64> = (1..=60).map(f64::from).collect();
    json!({
        "bodies": [{
            "mesh": {"rectangle": {"x": [0, 1], "y": [0, 1], "cells": [64, 64]}},
            "model": "plane_strain",
            "materials": [{"young": 1e9, "poisson": 0.3}],
            "supports": [
                {"group": "top", "displacement": [null, -0.01]},
                {"group": "top", "displacement": [0.01, null]}
            ]
        }],
        "contacts": [{
            "group": "bottom", "friction": 0.5,
            "obstacle": {"plane": {"point": [0, 0], "normal": [0, 1]}}
        }],
        "steps": {
            "at": steps,
            "factors": {"bodies[0].supports[1]": [[1, 0], [30, 1], [60, -1]]}
        }
    })
}

/// The program on that scene, once its first state is there.
fn begun(folder: &Path, arguments: &[&str]) -> Child {
    fs::write(folder.join("scene.json"), scene().to_string()).unwrap();
    let child = Command::new(env!("CARGO_BIN_EXE_dpana"))
        .current_dir(folder)
        .args(["solve", "scene.json", "--state", "state.json"])
        .args(arguments)
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    let start = Instant::now();
    while !folder.join("state.json").exists() && start.elapsed() < Duration::from_secs(120) {
        sleep(Duration::from_millis(1));
    }
    child
}

/// Takes the history on from the state that is there, to its end.
fn goes_on(folder: &Path) {
    // Whole: the file reads, and whatever else was being written is not in its place.
    let left = fs::read_to_string(folder.join("state.json")).unwrap();
    let left: Value = serde_json::from_str(&left).unwrap();
    let steps = left["steps"].as_u64().unwrap();
    assert!((1..60).contains(&steps), "{steps}");
    let rest = ["--restart", "state.json", "--table", "rest.csv"];
    let output = dpana(folder, &[&["solve", "scene.json"], &rest[..]].concat());
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(0), "{said}");
    let rest = fs::read_to_string(folder.join("rest.csv")).unwrap();
    assert_eq!(rest.lines().count() as u64 - 1, 60 - steps);
}

#[test]
fn a_program_that_is_ended_leaves_the_last_complete_state_and_the_history_goes_on_from_it() {
    let folder = folder("ended");
    let mut child = begun(&folder, &[]);
    child.kill().unwrap();
    assert!(!child.wait().unwrap().success(), "it was over before");
    goes_on(&folder);
}

#[test]
fn ctrl_c_ends_with_the_best_state_and_the_history_goes_on_from_the_last_certified_one() {
    let folder = folder("interrupted");
    let mut child = begun(&folder, &["--report", "report.json"]);
    let signal = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status();
    assert!(signal.unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(1));
    let report = fs::read_to_string(folder.join("report.json")).unwrap();
    let report: Value = serde_json::from_str(&report).unwrap();
    assert_eq!(report["status"], "not_converged");
    assert_eq!(report["reason"], "interrupted");
    goes_on(&folder);
}
