//! A hyphen is standard input and output; what is no file is written into, and links stay links.

use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use dpana::report::replace_file;
use serde_json::Value;

use crate::program::{dpana, folder};

const SCENE: &str = r#"{"$schema": "scene.schema.json", "comment": "a block on a line",
    "bodies": [{"name": "block", "model": "plane_strain",
        "mesh": {"rectangle": {"x": [0, 1], "y": [0, 1], "cells": [2, 2]}},
        "materials": [{"young": 1000, "poisson": 0.3}],
        "supports": [{"group": "top", "displacement": [0, -0.01]}]}],
    "contacts": [{"group": "bottom", "friction": 0.3,
        "obstacle": {"plane": {"point": [0, 0], "normal": [0, 1]}}}]}"#;

/// Runs the program with a text on standard input.
fn fed(folder: &Path, arguments: &[&str], text: &str) -> Output {
    let mut child = Command::new(env!("CARGO_BIN_EXE_dpana"))
        .current_dir(folder)
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // Who is refused before reading has closed the pipe.
    let _ = child.stdin.take().unwrap().write_all(text.as_bytes());
    child.wait_with_output().unwrap()
}

#[test]
fn a_scene_comes_from_standard_input_and_the_report_goes_to_standard_output() {
    let folder = folder("hyphen");
    let output = fed(&folder, &["solve", "-", "--report", "-"], SCENE);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(report["status"], "certified");
    // The summary makes room.
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.contains("status          certified"), "{said}");
    let output = fed(&folder, &["solve", "-", "--table", "-"], SCENE);
    let table = String::from_utf8(output.stdout).unwrap();
    assert!(
        table.starts_with("status,natural_map,open,stick,slip"),
        "{table}"
    );
    assert_eq!(table.lines().count(), 2);
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 0);
}

#[test]
fn what_needs_a_file_and_two_texts_in_one_stream_are_refused() {
    let folder = folder("no-hyphen");
    for (arguments, words) in [
        (
            ["--vtu", "-", "--report", "r.json"],
            "--vtu -: expected a file",
        ),
        (["--report", "-", "--table", "-"], "the same file"),
    ] {
        let arguments = [&["solve", "-"][..], &arguments].concat();
        let output = fed(&folder, &arguments, SCENE);
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(
            output.status.code() == Some(2) && said.contains(words),
            "{said}"
        );
    }
    let output = fed(&folder, &["check", "-"], "{\"bodies\": 3}");
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.contains("standard input:1:12: bodies"), "{said}");
}

#[test]
fn a_mark_of_byte_order_in_front_of_a_scene_is_passed_over() {
    let folder = folder("mark");
    let marked = [b"\xef\xbb\xbf", SCENE.as_bytes()].concat();
    fs::write(folder.join("marked.json"), marked).unwrap();
    assert_eq!(
        dpana(&folder, &["check", "marked.json"]).status.code(),
        Some(0)
    );
}

#[test]
fn an_option_that_is_misspelt_gets_the_near_one() {
    let folder = folder("misspelt");
    fs::write(folder.join("a.json"), SCENE).unwrap();
    for (arguments, words) in [
        (&["solve", "a.json", "--reprot", "r.json"][..], "'--report'"),
        (&["solv", "a.json"], "'solve'"),
        (
            &[
                "cases",
                "a.json",
                "--vary",
                "frction=0.1,0.2",
                "--out",
                "t.csv",
            ],
            "did you mean `friction`?",
        ),
        (
            &[
                "study", "a.json", "--quick", "--out", "s", "--known", "nromal=1",
            ],
            "did you mean `normal`?",
        ),
    ] {
        let output = dpana(&folder, arguments);
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(
            output.status.code() == Some(2) && said.contains(words),
            "{said}"
        );
    }
}

#[cfg(unix)]
#[test]
fn links_stay_links_and_pipes_and_devices_are_written_into() {
    use std::os::unix::fs::symlink;
    let folder = folder("links");
    let (link, target) = (folder.join("link.json"), folder.join("target.json"));
    symlink("target.json", &link).unwrap();
    // Nothing there yet, then something.
    for text in ["one", "two"] {
        replace_file(&link, text).unwrap();
        assert_eq!(fs::read_to_string(&target).unwrap(), text);
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    }
    replace_file(Path::new("/dev/null"), "gone").unwrap();
    assert!(!fs::metadata("/dev/null").unwrap().is_file());

    let pipe = folder.join("pipe");
    assert!(
        Command::new("mkfifo")
            .arg(&pipe)
            .status()
            .unwrap()
            .success()
    );
    let reader = Command::new("cat")
        .arg(&pipe)
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    replace_file(&pipe, "through").unwrap();
    assert_eq!(reader.wait_with_output().unwrap().stdout, b"through");
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 3);
}
