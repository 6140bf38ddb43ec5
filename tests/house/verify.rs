//! The gallery of known answers passes, on ladders of meshes, from the command line as well.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use dpana::verify;
use serde_json::Value;

fn dpana(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_dpana"))
        .current_dir(env!("CARGO_TARGET_TMPDIR"))
        .args(arguments)
        .output()
        .unwrap()
}

#[test]
fn the_quick_gallery_passes_and_its_report_holds_every_number() {
    let files = ["--report", "quick.json", "--page", "quick.html"];
    let output = dpana(&[["verify", "--quick"].as_slice(), &files].concat());
    let said = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(said.contains("14 of 14 scenes pass"), "{said}");
    assert!(!said.contains("FAIL"), "{said}");

    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join("quick.json");
    let report: Value = serde_json::from_str(&fs::read_to_string(file).unwrap()).unwrap();
    assert_eq!(
        (&report["quick"], &report["passed"]),
        (&true.into(), &true.into())
    );
    let page = Path::new(env!("CARGO_TARGET_TMPDIR")).join("quick.html");
    let page = fs::read_to_string(page).unwrap();
    // Seven plane scenes are drawn; what a mesh changes is drawn against its size.
    assert!(page.matches("On a coarse mesh").count() == 7 && page.matches("<svg").count() >= 7 + 9);
    for scene in report["scenes"].as_array().unwrap() {
        let name = scene["name"].as_str().unwrap();
        assert!(page.contains(name) || name.contains(['&', '<']), "{name}");
        for quantity in scene["quantities"].as_array().unwrap() {
            let ladder = quantity["ladder"].as_array().unwrap();
            assert!(ladder.len() >= 2, "{quantity}");
            for rung in ladder {
                assert_eq!(rung["settled"], true, "{quantity}");
                // (V1), from the values beside it: means over loads show the last load's values.
                let [computed, exact, error] =
                    ["computed", "exact", "error"].map(|key| rung[key].as_f64());
                let error = error.unwrap();
                if let (Some(computed), Some(exact), false) = (computed, exact, error == 0.0) {
                    let own = (computed / exact - 1.0).abs();
                    assert!(own < 10.0 * error + 1e-15, "{quantity}");
                }
            }
        }
    }
}

#[test]
fn a_report_that_cannot_be_written_is_refused_before_anything_is_computed() {
    let output = dpana(&["verify", "--report", "no such folder/report.json"]);
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(said.contains("its folder does not exist"), "{said}");
    assert!(output.stdout.is_empty());
}

#[test]
#[ignore = "the finest meshes take minutes"]
fn the_whole_gallery_passes() {
    let gallery = verify(false).unwrap();
    assert!(gallery.passed, "\n{}", gallery.summary());
    let quantities = gallery.scenes.iter().flat_map(|scene| &scene.quantities);
    let finest: Vec<_> = quantities
        .filter_map(|quantity| quantity.ladder.last())
        .map(|rung| rung.mesh.as_str())
        .collect();
    for mesh in [
        "80 quad4 per mm",
        "28³ hex8",
        "6 hex8 per mm",
        "0.125 mm quad4",
    ] {
        assert!(finest.contains(&mesh), "{mesh} is not among {finest:?}");
    }
}
