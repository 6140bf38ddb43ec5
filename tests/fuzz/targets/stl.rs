//! Bytes to the reader of STL files, by way of a scene: a cube stands over the triangles and is pressed on them.
//! A first byte below 8 says that a binary file follows, whose head and number of triangles are put right.
#![no_main]

use std::fs;
use std::path::PathBuf;
use std::sync::LazyLock;

use dpana::Scene;
use dpana_fuzz::attempt;
use libfuzzer_sys::fuzz_target;

/// Folder of this process, for the file that the scene names.
static FOLDER: LazyLock<PathBuf> = LazyLock::new(|| {
    let folder = std::env::temp_dir().join(format!("dpana-fuzz-stl-{}", std::process::id()));
    fs::create_dir_all(&folder).expect("a folder for files");
    folder
});

const SCENE: &str = r#"{
    "bodies": [{ "mesh": { "box": { "x": [-1, 1], "y": [-1, 1], "z": [0, 1], "cells": [2, 2, 1] } },
                 "materials": [{ "young": 1000, "poisson": 0.3 }],
                 "supports": [{ "group": "top", "displacement": [0, 0, -0.01] }] }],
    "contacts": [{ "group": "bottom", "friction": 0.3, "obstacle": { "triangles": { "file": "part.stl" } } }] }"#;

fuzz_target!(|bytes: &[u8]| {
    let bytes = match bytes {
        [0..8, triangles @ ..] => binary(triangles),
        _ => bytes.to_vec(),
    };
    fs::write(FOLDER.join("part.stl"), bytes).expect("a file");
    let scene = Scene::from_json(SCENE, FOLDER.join("scene.json")).expect("a scene");
    let _ = attempt(scene);
});

/// A binary file of as many whole triangles as there are.
fn binary(triangles: &[u8]) -> Vec<u8> {
    let count = triangles.len() / 50;
    let mut file = vec![0; 80];
    file.extend((count as u32).to_le_bytes());
    file.extend(&triangles[..50 * count]);
    file
}
