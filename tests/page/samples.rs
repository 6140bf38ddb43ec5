//! Scenes whose answers are known, and what their pages hold.

use std::fs;
use std::path::{Path, PathBuf};

use dpana::body::{CellKind, Mesh};
use dpana::report::Page;
use dpana::scene::{
    SceneBody, SceneContact, SceneLoad, SceneMaterial, SceneModel, SceneObstacle, SceneSupport,
};
use dpana::{Scene, solve};
use serde_json::{Value, json};

/// A strip of two unit squares, E = 1000, ν = 0, under a pressure of 5 on a smooth floor: σ_yy = −5,
/// u_y = −0.005 y, and a pressure of 5 at three contacts.
pub(crate) fn strip() -> Scene {
    let positions = [0.0, 0.0, 1.0, 0.0, 2.0, 0.0, 0.0, 1.0, 1.0, 1.0, 2.0, 1.0];
    let mesh = Mesh::from_arrays(CellKind::Quad4, &positions, &[0, 1, 4, 3, 1, 2, 5, 4]).unwrap();
    let mesh = mesh.with_surface("bottom", |[_, y, _]| y == 0.0).unwrap();
    let mesh = mesh.with_surface("top", |[_, y, _]| y == 1.0).unwrap();
    let mesh = mesh.with_surface("left", |[x, ..]| x == 0.0).unwrap();
    let strip = SceneBody::new("strip", mesh)
        .with_model(SceneModel::PlaneStrain)
        .with_material(SceneMaterial::new(1000.0, 0.0))
        .with_support(SceneSupport::of("left", &[Some(0.0), None]))
        .with_load(SceneLoad::pressure("top", 5.0));
    let floor = SceneObstacle::plane(&[0.0, 0.0], &[0.0, 1.0]);
    let mut scene = Scene::new(vec![strip], vec![SceneContact::on(floor, "bottom", 0.0)]);
    "a < b </script>".clone_into(&mut scene.title);
    "mm, N, MPa".clone_into(&mut scene.units);
    scene
}

/// The same in space and in JSON, by two steps: half the pressure and all of it; cells of `kind`.
pub(crate) fn block(kind: &str) -> Value {
    json!({
        "title": "block", "units": "m, N, Pa",
        "bodies": [{
            "name": "block",
            "mesh": {"box": {"x": [0, 2], "y": [0, 2], "z": [0, 2], "cells": [2, 2, 2], "cell": kind}},
            "materials": [{"young": 1000, "poisson": 0}],
            "supports": [{"group": "left", "displacement": [0, null, null]},
                         {"group": "front", "displacement": [null, 0, null]}],
            "loads": [{"group": "top", "pressure": 5}],
        }],
        "contacts": [{"group": "bottom", "friction": 0.3,
                      "obstacle": {"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}}}],
        "steps": {"at": [1, 2], "factors": {"bodies[0].loads[0]": [[0, 0], [2, 1]]}},
    })
}

/// Writes the page of a solved scene.
pub(crate) fn page_of(scene: &Scene, folder: &Path) -> PathBuf {
    let path = folder.join("page.html");
    let mut page = Page::new(&path);
    solve(scene).unwrap().add_to_page(&mut page).unwrap();
    path
}

/// The elements of a class, read.
pub(crate) fn elements(path: &Path, class: &str) -> Vec<Value> {
    let text = fs::read_to_string(path).unwrap();
    let open = format!("<script type=\"application/json\" class=\"{class}\">");
    let parts = text.split(&open).skip(1);
    let parts = parts.map(|part| part.split("</script>").next().unwrap());
    parts
        .map(|part| serde_json::from_str(part).unwrap())
        .collect()
}

/// Words of 32 bits out of base64 (RFC 4648).
fn words(text: &Value) -> Vec<[u8; 4]> {
    let letters = text
        .as_str()
        .unwrap()
        .bytes()
        .filter(|letter| *letter != b'=');
    let sextets = letters.map(|letter| match letter {
        b'A'..=b'Z' => letter - b'A',
        b'a'..=b'z' => letter - b'a' + 26,
        b'0'..=b'9' => letter - b'0' + 52,
        b'+' => 62,
        b'/' => 63,
        other => unreachable!("a letter of base64, not {other}"),
    });
    let bits: Vec<u8> = sextets
        .flat_map(|sextet| (0..6).rev().map(move |bit| sextet >> bit & 1))
        .collect();
    let byte = |bits: &[u8]| bits.iter().fold(0, |byte, bit| byte << 1 | bit);
    let bytes: Vec<u8> = bits.chunks_exact(8).map(byte).collect();
    let words = bytes.chunks_exact(4);
    words.map(|word| word.try_into().unwrap()).collect()
}

pub(crate) fn reals(text: &Value) -> Vec<f32> {
    words(text).into_iter().map(f32::from_le_bytes).collect()
}

pub(crate) fn integers(text: &Value) -> Vec<u32> {
    words(text).into_iter().map(u32::from_le_bytes).collect()
}
