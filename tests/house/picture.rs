//! The picture of a solved contact shows what the report says: states, pressure, enlarged displacements.

use std::fs;

use dpana::body::{CellKind, Mesh};
use dpana::scene::{
    SceneBody, SceneContact, SceneLoad, SceneMaterial, SceneModel, SceneObstacle, SceneSupport,
};
use dpana::{Scene, solve};
use serde_json::json;

use crate::program::{dpana, folder};

/// A strip of two unit squares under a uniform pressure on a smooth floor.
fn strip() -> Scene {
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
    "a < b".clone_into(&mut scene.title);
    scene
}

/// The numbers in the first attribute `d` behind `mark`.
fn path_after(svg: &str, mark: &str) -> Vec<f64> {
    let rest = &svg[svg.find(mark).unwrap()..];
    let start = rest.find(" d=\"").unwrap() + 4;
    let path = &rest[start..start + rest[start..].find('"').unwrap()];
    let numbers = path.split(['M', 'L', 'Z', ' ']);
    let numbers = numbers.filter(|word| !word.is_empty());
    numbers.map(|word| word.parse().unwrap()).collect()
}

#[test]
fn a_uniform_pressure_stands_as_a_rectangle_of_a_sixth_of_the_diagonal() {
    let svg = solve(&strip()).unwrap().to_svg().unwrap();
    assert!(svg.contains("<title>a &lt; b</title>") && svg.ends_with("</svg>\n"));
    // ε = p/E = 0.005 and u = 0.005 m at the top; 20 is the largest round factor that keeps it below √5/12 m.
    assert!(
        svg.contains("peak pressure 5.00000, displacements × 20"),
        "{svg}"
    );
    // Three contacts that slide, none that sticks, and one mark of each kind in the legend.
    assert_eq!(svg.matches("fill=\"#d55e00\"").count(), 4);
    assert_eq!(svg.matches("fill=\"#0072b2\"").count(), 1);

    // Two cells of four corners; strip and pressure together fill the height of 520.
    let cells = path_after(&svg, "<path fill=\"#eef3f7\"");
    assert_eq!(cells.len(), 16);
    let scale = cells[2] - cells[0];
    let expected = 520.0 / (0.9 + 5.0_f64.sqrt() / 6.0);
    assert!((scale - expected).abs() < 0.11, "{scale}");
    // The top came down by 20 × 0.005 m.
    assert!((cells[1] - cells[5] - 0.9 * scale).abs() < 0.21);

    let pressure = path_after(&svg, "fill-opacity");
    let height = 5.0_f64.sqrt() / 6.0 * scale;
    let [foot, tip, other_tip, other_foot] = [1, 3, 5, 7].map(|at| pressure[at]);
    assert!((tip - foot - height).abs() < 0.21 && (other_tip - other_foot - height).abs() < 0.21);
}

#[test]
fn the_program_draws_bodies_in_2d_and_refuses_those_in_3d_before_it_solves() {
    let folder = folder("picture");
    let scene = |mesh: serde_json::Value, model: Option<&str>, normal: &[f64]| {
        let axes = normal.len();
        let mut down = vec![0.0; axes];
        down[axes - 1] = -0.01;
        json!({
            "bodies": [{"mesh": mesh, "model": model, "materials": [{"young": 1, "poisson": 0.3}],
                        "supports": [{"group": "top", "displacement": down}]}],
            "contacts": [{"group": "bottom", "friction": 0.3,
                          "obstacle": {"plane": {"point": vec![0; axes], "normal": normal}}}]
        })
    };
    let side = [0, 1];
    let flat = json!({"rectangle": {"x": side, "y": side, "cells": [2, 2]}});
    let flat = scene(flat, Some("plane_strain"), &[0.0, 1.0]);
    fs::write(folder.join("flat.json"), flat.to_string()).unwrap();
    let done = dpana(&folder, &["solve", "flat.json", "--svg", "flat.svg"]);
    assert_eq!(done.status.code(), Some(0));
    let svg = fs::read_to_string(folder.join("flat.svg")).unwrap();
    assert!(svg.starts_with("<svg ") && svg.contains("displacements ×"));

    let solid = json!({"box": {"x": side, "y": side, "z": side, "cells": [1, 1, 1]}});
    let solid = scene(solid, None, &[0.0, 0.0, 1.0]);
    fs::write(folder.join("solid.json"), solid.to_string()).unwrap();
    let refused = dpana(&folder, &["solve", "solid.json", "--svg", "solid.svg"]);
    assert_eq!(refused.status.code(), Some(2));
    let said = String::from_utf8(refused.stderr).unwrap();
    assert!(said.contains("--svg solid.svg: bodies in 3D"), "{said}");
    assert!(!folder.join("solid.svg").exists());
}
