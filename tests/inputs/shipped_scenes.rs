//! Every scene that ships is solved and certified, and the published schema is the one
//! that the scene's types make.

use std::fs;
use std::path::{Path, PathBuf};

use dpana::scene::schema;
use dpana::{Scene, Solution, Status, solve};

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

fn scenes() -> Vec<PathBuf> {
    let folder = fs::read_dir(Path::new(ROOT).join("examples/scenes")).unwrap();
    let files = folder.map(|entry| entry.unwrap().path());
    files
        .filter(|path| !path.ends_with("scene.schema.json"))
        .collect()
}

fn assert_certified(solution: &Solution, name: &str) {
    let certificate = &solution.outcome().verdict.certificate;
    assert_eq!(solution.status(), Status::Certified, "{name}");
    assert!(certificate.natural_map <= 1e-12, "{name}: {certificate:?}");
    for balance in solution.balances() {
        // K u sums forces of cells that are larger than the loads by the body's slenderness.
        assert!(balance.equilibrium.scaled < 1e-10, "{name}: {balance:?}");
        // Of the slender clip a digit less than of the others.
        assert!(balance.force_defect.scaled < 1e-11, "{name}: {balance:?}");
    }
    assert_eq!(
        solution.condensed().work().factorisations,
        solution.bodies().len(),
        "{name}"
    );
}

#[test]
fn every_shipped_scene_is_certified_and_in_balance() {
    let scenes = scenes();
    assert_eq!(scenes.len(), 33, "{scenes:?}");
    for path in scenes {
        let solution = solve(&Scene::from_file(&path).unwrap()).unwrap();
        assert_certified(&solution, &path.display().to_string());
    }
}

#[test]
fn the_scene_in_the_readme_is_certified() {
    let readme = fs::read_to_string(Path::new(ROOT).join("README.md")).unwrap();
    let (_, block) = readme.split_once("```json\n").unwrap();
    let (scene, _) = block.split_once("```").unwrap();
    let solution = solve(&Scene::from_json(scene, "README.md").unwrap()).unwrap();
    assert_certified(&solution, "README.md");
}

#[test]
fn the_published_schema_is_that_of_the_types() {
    let file = Path::new(ROOT).join("examples/scenes/scene.schema.json");
    let published: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(file).unwrap()).unwrap();
    assert!(
        published == schema(),
        "write it anew: cargo run -- schema > examples/scenes/scene.schema.json"
    );
}
