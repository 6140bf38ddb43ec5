//! Scenes of half-spaces, from the library and the command line.

use std::f64::consts::PI;
use std::fs;
use std::path::Path;

use dpana::half_space::{Drag, Press};
use dpana::scene::HalfSpaceScene;
use dpana::{Variation, half_space_cases, solve_half_space};
use vtkio::model::{DataSet, Piece};

use crate::program::{dpana, folder};

const ROUGH: &str = "examples/half_space/rough.json";

fn scene(text: &str) -> Result<HalfSpaceScene, String> {
    HalfSpaceScene::from_json(text, "").map_err(|error| error.to_string())
}

/// A sphere on 16 × 16 cells; `more` is put behind its other keys.
fn sphere(surface: &str, more: &str) -> String {
    format!(
        r#"{{"half_space": {{"material": {{"young": 2, "poisson": 0.3}}, "cells": [16, 16],
        "size": [1, 1]}}, "surface": [{surface}]{more}}}"#
    )
}

const BALL: &str = r#"{"sphere": {"radius": 10}}"#;

#[test]
fn the_shipped_history_is_certified_and_remembers_its_slip() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(ROUGH);
    let scene = HalfSpaceScene::from_file(path).unwrap();
    let mut shifts = Vec::new();
    let report = solve_half_space(&scene, |_, _, outcome| {
        shifts.push(outcome.state.shift[0]);
        Ok(())
    })
    .unwrap();
    assert!(report.steps.iter().all(|step| step.certified()));
    let area: Vec<f64> = report.steps.iter().map(|step| step.area_fraction).collect();
    assert!(area[0] < area[1] && area[1] < area[2], "{area:?}");
    // Sheared to and fro by the same force: on the way back it stops short of the mirror image, as
    // Mindlin's sphere does.
    assert!(
        shifts[3] > 0.0 && shifts[4] < 0.0 && -shifts[4] < shifts[3],
        "{shifts:?}"
    );
}

#[test]
fn contact_that_reaches_the_border_of_a_free_grid_is_noted() {
    let punch = r#"{"flat_punch": {"radius": 2}}"#;
    let strip = BALL
        .replace("sphere", "paraboloid")
        .replace("radius", "radius_x");
    for (surface, more, cells) in [
        // A ball that stays inside, that reaches the middle of every side, that touches everywhere.
        (BALL, r#", "approach": 0.02"#, 0),
        (BALL, r#", "approach": 0.0215"#, 8),
        (BALL, r#", "approach": 0.2"#, 60),
        // A cylinder along y touches two sides, a punch that ends with the grid none beyond it.
        (&*strip, r#", "approach": 1e-3"#, 8),
        (punch, r#", "approach": 1e-3"#, 0),
    ] {
        let scene = scene(&sphere(surface, more)).unwrap();
        let mut found = Vec::new();
        let report = solve_half_space(&scene, |_, _, outcome| {
            found.push(outcome.at_border);
            Ok(())
        });
        let report = report.unwrap();
        assert_eq!(found, [cells], "{surface} {more}");
        let note = format!("note: {cells} cells at the border of the grid press: ");
        assert_eq!(report.summary().contains(&note), cells > 0);
        assert_eq!(
            report.to_json().contains("enlarge `half_space.size`"),
            cells > 0
        );
        assert_eq!(report.table().column("at_border").unwrap(), [cells as f64]);
    }
    let periodic =
        sphere(BALL, r#", "load": 10"#).replace("[1, 1]", r#"[1, 1], "surroundings": "periodic""#);
    let report = solve_half_space(&scene(&periodic).unwrap(), |_, _, _| Ok(())).unwrap();
    assert!(report.steps[0].open == 0 && report.steps[0].notes.is_empty());
}

#[test]
fn every_shipped_scene_is_sound() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/half_space");
    let files = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path());
    let scenes = files.filter(|path| {
        path.extension().is_some_and(|ending| ending == "json")
            && !path.ends_with("scene.schema.json")
    });
    let sound = scenes.map(|path| HalfSpaceScene::from_file(path).unwrap().history().unwrap());
    assert_eq!(sound.count(), 3);
}

#[test]
fn a_step_keeps_what_it_does_not_name() {
    let steps = r#", "approach": 0.001, "friction": 0.2, "steps": [{}, {"shift": [1e-4, 0]}, {"load": 0.001}]"#;
    let history = scene(&sphere(BALL, steps)).unwrap().history().unwrap();
    assert_eq!(
        history.steps,
        [
            (Press::Approach(0.001), Drag::Shift([0.0; 2])),
            (Press::Approach(0.001), Drag::Shift([1e-4, 0.0])),
            (Press::Load(0.001), Drag::Shift([1e-4, 0.0])),
        ]
    );
}

#[test]
fn what_is_wrong_in_a_scene_is_told_with_its_place() {
    let far = r#"{"self_affine": {"hurst": 2, "roll_off": 1, "cut_off": 1, "slope": 1}}"#;
    let missing = r#"{"height_map": {"file": "nowhere.npy"}}"#;
    for (text, place) in [
        (sphere(BALL, ""), "scene: neither `load` nor `approach`"),
        (
            sphere(BALL, r#", "load": 1, "approach": 1"#),
            "scene: both `load` and `approach`",
        ),
        (
            sphere(
                BALL,
                r#", "load": 1, "steps": [{"shift": [0, 0], "force": [0, 0]}]"#,
            ),
            "steps[0]: both",
        ),
        (sphere(BALL, r#", "load": -1"#), "load: -1"),
        (
            sphere(BALL, r#", "load": 1, "friction": -1"#),
            "friction[0]: -1",
        ),
        (
            sphere(r#"{"cone": {"slope": 0}}"#, r#", "load": 1"#),
            "surface[0].slope: 0",
        ),
        (
            sphere(far, r#", "load": 1"#),
            "surface[0]: surface.hurst: 2",
        ),
        (
            sphere(missing, r#", "load": 1"#),
            "surface[0].file: cannot read the file nowhere.npy",
        ),
        (
            sphere(
                BALL,
                r#", "load": 1, "force": [0.1, 0], "rolling": {"spin": 1}"#,
            ),
            "rolling: a shift or a force beside it",
        ),
        (
            sphere(BALL, r#", "load": 1"#).replace("[16, 16]", "[0, 16]"),
            "grid.cells[0]: 0",
        ),
    ] {
        let found = scene(&text).unwrap().history().unwrap_err().to_string();
        assert!(found.starts_with(place), "{found} for {place}");
    }
    let unknown = scene(&sphere(BALL, r#", "laod": 1"#)).unwrap_err();
    assert!(unknown.contains("did you mean `load`"), "{unknown}");
}

#[test]
fn height_maps_press_with_their_peaks_and_must_fit() {
    let folder = folder("height_maps");
    let write = |name: &str, text: &str| fs::write(folder.join(name), text).unwrap();
    let map = "# Width: 2 µm\n# Height: 2 µm\n# Value units: nm\n0 1\n5 2\n";
    write("map.txt", map);
    let text = |more: &str, cells: &str| {
        format!(
            r#"{{"half_space": {{"material": {{"young": 1, "poisson": 0.3}}, "cells": {cells},
            "size": [0.002, 0.002]}}, "load": 1,
            "surface": [{{"height_map": {{"file": "map.txt"{more}}}}}]}}"#
        )
    };
    let gap = |more: &str, cells: &str| {
        let scene = HalfSpaceScene::from_json(&text(more, cells), folder.join("scene.json"));
        scene
            .unwrap()
            .history()
            .map(|history| history.problem.initial_gap().to_vec())
    };
    // The peak of 5 nm touches first; the scene is in mm.
    let found = gap(r#", "unit": "mm""#, "[2, 2]").unwrap();
    for (found, expected) in found.iter().zip([5e-6, 4e-6, 0.0, 3e-6]) {
        assert!((found - expected).abs() < 1e-18);
    }
    let refused = |more: &str, cells: &str| gap(more, cells).unwrap_err().to_string();
    assert!(refused("", "[2, 2]").contains("expected `unit`"));
    assert!(refused(r#", "unit": "mm""#, "[2, 3]").contains("3 rows of 2"));
    assert!(refused(r#", "unit": "m""#, "[2, 2]").contains("half_space.size[0]"));
    assert!(refused(r#", "unit": "inch""#, "[2, 2]").contains("unit `inch`"));
}

#[test]
fn height_maps_of_every_form_are_refused_with_place_where_they_are_no_surface() {
    let folder = folder("height_maps_gone_wrong");
    // What `numpy.save` writes.
    let npy = |rows: usize, columns: usize, heights: &[f64]| {
        let header =
            format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({rows}, {columns}), }}\n");
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((header.len() as u16).to_le_bytes());
        bytes.extend(header.as_bytes());
        heights
            .iter()
            .for_each(|height| bytes.extend(height.to_le_bytes()));
        bytes
    };
    let profile = |words: &str, heights: &str| {
        format!("# Width: 2 mm\n# Height: 2 mm\n# Value units: {words}\n{heights}").into_bytes()
    };
    let mm = r#", "unit": "mm""#;
    for (file, bytes, more, said) in [
        (
            "a.npy",
            npy(2, 2, &[0.0, 1.0, f64::NAN, 2.0]),
            "",
            "row 1, column 0 is NaN",
        ),
        (
            "b.npy",
            npy(2, 2, &[0.0, 1.0, f64::INFINITY, 2.0]),
            "",
            "row 1, column 0 is inf",
        ),
        (
            "a.csv",
            b"0,1\nnan,2\n".to_vec(),
            "",
            "row 1, column 0 is NaN",
        ),
        (
            "a.txt",
            profile("nm", "0 1\nNaN 2\n"),
            mm,
            "row 1, column 0 is NaN",
        ),
        ("c.npy", npy(2, 3, &[0.0; 6]), "", "2 rows of 3"),
        (
            "d.npy",
            npy(2, 2, &[0.0; 3]),
            "",
            "24 bytes of numbers; expected 32",
        ),
        ("b.csv", b"0,1,2\n3,4,5\n".to_vec(), "", "2 rows of 3"),
        (
            "c.csv",
            b"0,1\n3\n".to_vec(),
            "",
            "line 2: 1 heights; expected 2",
        ),
        ("b.txt", profile("nm", "0 1 2\n3 4 5\n"), mm, "2 rows of 3"),
        (
            "c.txt",
            profile("furlong", "0 1\n2 3\n"),
            mm,
            "line 3: unit `furlong`",
        ),
        ("d.txt", profile("nm", "0 1\n2 3\n"), "", "expected `unit`"),
        (
            "e.txt",
            profile("nm", "0 1\n2 3\n"),
            r#", "unit": "m""#,
            "half_space.size[0]",
        ),
        (
            "e.npy",
            npy(2, 2, &[0.0; 4]),
            r#", "unit": "ell""#,
            "unit `ell`",
        ),
        (
            "d.csv",
            b"0,1\n2,3\n".to_vec(),
            r#", "unit": "ell""#,
            "unit `ell`",
        ),
    ] {
        fs::write(folder.join(file), bytes).unwrap();
        let text = format!(
            r#"{{"half_space": {{"material": {{"young": 1, "poisson": 0.3}}, "cells": [2, 2],
            "size": [2, 2]}}, "load": 1,
            "surface": [{{"height_map": {{"file": "{file}"{more}}}}}]}}"#
        );
        let scene = HalfSpaceScene::from_json(&text, folder.join("scene.json")).unwrap();
        let found = scene.history().unwrap_err().to_string();
        let placed = found.contains("surface[0]") || found.contains("half_space.size[0]");
        assert!(placed && found.contains(said), "{file}: {found}");
    }
}

#[test]
fn the_command_line_writes_what_numpy_and_vtk_read() {
    let folder = folder("half_space");
    fs::write(
        folder.join("ball.json"),
        sphere(BALL, r#", "load": 0.001, "friction": 0.1"#),
    )
    .unwrap();
    let outputs = [
        "--vti",
        "a.vti",
        "--npy",
        "a.npy",
        "--table",
        "a.csv",
        "--report",
        "a.json",
        "--spectrum",
        "s.csv",
    ];
    let output = dpana(
        &folder,
        &[["half-space", "ball.json"].as_slice(), &outputs].concat(),
    );
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let pressure = fs::read(folder.join("a_pressure.npy")).unwrap();
    let start = pressure.len() - 16 * 16 * 8;
    assert_eq!((start % 64, &pressure[..6]), (0, b"\x93NUMPY".as_slice()));
    let numbers = pressure[start..]
        .as_chunks()
        .0
        .iter()
        .map(|bytes| f64::from_le_bytes(*bytes));
    // Σ p A, A = 1/256.
    assert!((numbers.sum::<f64>() / 256.0 / 0.001 - 1.0).abs() < 1e-9);
    let image = vtkio::Vtk::import(folder.join("a.vti")).unwrap();
    let DataSet::ImageData { mut pieces, .. } = image.data else {
        panic!("no image");
    };
    let Piece::Inline(piece) = pieces.remove(0) else {
        panic!("no inline piece");
    };
    assert_eq!(piece.data.cell.len(), 6);
    let table = fs::read_to_string(folder.join("a.csv")).unwrap();
    assert_eq!(table.lines().count(), 2);
    let spectrum = fs::read_to_string(folder.join("s.csv")).unwrap();
    assert!(spectrum.starts_with("wave_number,power,waves\n") && spectrum.lines().count() > 8);
    let vary = [
        "cases",
        "ball.json",
        "--vary",
        "load=1e-4,1e-3",
        "--out",
        "c.csv",
    ];
    assert_eq!(dpana(&folder, &vary).status.code(), Some(0));
    let cases = fs::read_to_string(folder.join("c.csv")).unwrap();
    assert!(cases.lines().next().unwrap().ends_with("status,stiffness"));
    let refused = dpana(
        &folder,
        &["half-space", "ball.json", "--vti", "nowhere/a.vti"],
    );
    assert_eq!(refused.status.code(), Some(2));
    // What has no mesh is told where to go.
    for command in ["solve", "limit", "check"] {
        let sent = dpana(&folder, &[command, "ball.json"]);
        let said = String::from_utf8(sent.stderr).unwrap();
        assert_eq!(sent.status.code(), Some(2), "{said}");
        assert!(said.contains("dpana half-space ball.json"), "{said}");
    }
}

#[test]
fn the_published_schema_is_that_of_the_types() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/half_space/scene.schema.json");
    let published: serde_json::Value = serde_json::from_slice(&fs::read(file).unwrap()).unwrap();
    assert!(
        published == dpana::scene::half_space_schema(),
        "write it anew: cargo run -- schema --half-space > examples/half_space/scene.schema.json"
    );
}

fn vary(name: &str, values: &[f64]) -> Variation {
    Variation {
        name: name.to_owned(),
        values: values.to_vec(),
    }
}

#[test]
fn cases_tabulate_load_area_and_stiffness_as_hertz_has_them() {
    // a³ = 3 P R/(4 E*), δ = a²/R, dP/dδ = 2 E* a.
    let text = sphere(BALL, "").replace("[16, 16]", "[64, 64]");
    let loads = [2e-3, 4e-3, 8e-3];
    let table = half_space_cases(&scene(&text).unwrap(), &[vary("load", &loads)], |_, _| {});
    let table = table.unwrap();
    let column = |name: &str| table.column(name).unwrap();
    let stiffness = column("stiffness");
    let modulus = 2.0 / 0.91;
    for (at, load) in loads.into_iter().enumerate() {
        let a = (3.0 * load * 10.0 / (4.0 * modulus)).cbrt();
        assert!((column("approach")[at] / (a * a / 10.0) - 1.0).abs() < 0.005);
        assert!((column("contact_area")[at] / (PI * a * a) - 1.0).abs() < 0.05);
        let found = stiffness[at] / (2.0 * modulus * a) - 1.0;
        assert!(found.abs() < 0.03, "{load} {found}");
    }
    assert_eq!(column("load").len(), 3);
    // What is varied is a column once.
    let text = table.to_csv();
    let names = text.lines().next().unwrap().split(',');
    assert_eq!(names.filter(|name| *name == "load").count(), 1);
}

#[test]
fn cases_refuse_what_they_cannot_vary() {
    let ball = scene(&sphere(BALL, r#", "load": 1e-3"#)).unwrap();
    let refused = |scene: &HalfSpaceScene, vary: &[Variation]| {
        half_space_cases(scene, vary, |_, _| {})
            .unwrap_err()
            .to_string()
    };
    let unknown = refused(&ball, &[vary("lod", &[1.0])]);
    assert!(unknown.contains("did you mean `load`"), "{unknown}");
    let twice = refused(&ball, &[vary("load", &[1.0]), vary("load", &[1.0])]);
    assert!(twice.contains("twice"), "{twice}");
    let both = refused(&ball, &[vary("load", &[1.0]), vary("approach", &[1.0])]);
    assert!(both.contains("both `load` and `approach`"), "{both}");
    let negative = refused(&ball, &[vary("friction", &[0.1, -0.1])]);
    assert!(negative.starts_with("friction: -0.1"), "{negative}");
    let history = scene(&sphere(BALL, r#", "steps": [{"load": 1e-3}]"#)).unwrap();
    assert!(refused(&history, &[vary("friction", &[0.1])]).starts_with("steps"));
    let empty = refused(&ball, &[vary("load", &[])]);
    assert!(empty.starts_with("load"), "{empty}");
}

#[test]
fn a_periodic_surface_in_full_contact_is_stiff_without_bound() {
    let text = sphere(r#"{"cone": {"slope": 1e-3}}"#, r#", "load": 1"#);
    let text = text.replace(
        r#""size": [1, 1]"#,
        r#""size": [1, 1], "surroundings": "periodic""#,
    );
    let loads = [vary("load", &[0.0, 1e-4, 1.0])];
    let table = half_space_cases(&scene(&text).unwrap(), &loads, |_, _| {}).unwrap();
    let (stiffness, area) = (
        table.column("stiffness").unwrap(),
        table.column("area_fraction").unwrap(),
    );
    assert!(stiffness[0] == 0.0 && stiffness[1].is_finite() && stiffness[1] > 0.0);
    assert!(area[2] == 1.0 && stiffness[2] == f64::INFINITY);
}
