//! MUMPS on the processes of an MPI run against the crate's own factors: same operator, states and certificate.
//!
//! Started by `cargo test` this program starts itself again under `mpirun`, per case and number of ranks; there
//! it is a rank.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

use std::env;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use dpana::condensation::Condensed;
use dpana::report::Report;
use dpana::scene::{Mechanics, SceneBody, SceneContact, SceneMaterial, SceneModel};
use dpana::scene::{SceneObstacle, SceneSupport};
use dpana::{Engine, Error, Ranks, Scene, Status, body, solve};

/// What a rank is told to do.
const CASE: &str = "DPANA_CASE";

/// What every number of ranks solves: made here, or a shipped scene.
const SOLVED: [&str; 8] = [
    "cube 6",
    "cube 12",
    "two_cubes.json",
    "pad.json",
    "foundation.json",
    "tied.json",
    "fretting.json",
    "soft tetrahedra",
];

fn main() {
    if let Ok(case) = env::var(CASE) {
        return rank(&case);
    }
    for ranks in [1, 2, 4] {
        for case in SOLVED {
            passes(case, ranks);
        }
        passes("hinge", ranks);
        passes("another scene", ranks);
        the_program_tells_memory_and_writes_once(ranks);
    }
    the_program_refuses_what_ranks_cannot_do();
    println!("ranks: all passed");
}

/// Starts this program again on so many ranks.
fn passes(case: &str, ranks: usize) {
    let program = env::current_exe().unwrap();
    let output = on_ranks(ranks, &program, &[], case);
    let (out, err) = (text(&output.stdout), text(&output.stderr));
    assert!(
        output.status.success(),
        "{case} on {ranks} ranks:\n{out}\n{err}"
    );
    print!("{out}");
}

fn on_ranks(ranks: usize, program: &Path, arguments: &[&str], case: &str) -> Output {
    let mut mpirun = Command::new("mpirun");
    mpirun.args([
        "--oversubscribe",
        "--allow-run-as-root",
        "--bind-to",
        "none",
        "-n",
    ]);
    mpirun.arg(ranks.to_string()).arg(program).args(arguments);
    mpirun.env(CASE, case).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// One rank of a case.
fn rank(case: &str) {
    let ranks = Ranks::join().unwrap();
    assert!(Ranks::join().is_err(), "MPI begins once");
    if ranks.rank() > 0 {
        let bodies = match case {
            "another scene" => scene("cube 12"),
            case => scene(case),
        };
        return ranks.serve(bodies.mechanics().map(|mechanics| mechanics.bodies));
    }
    match case {
        "hinge" => a_hinge_is_refused_with_body_and_node(),
        "another scene" => ranks_with_another_scene_are_named(ranks.count()),
        case => the_same_as_without_ranks(case, ranks.count()),
    }
}

fn scene(case: &str) -> Scene {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/scenes");
    match case {
        "cube 6" => cube(6, "hex8", 0.3),
        "cube 12" | "another scene" => cube(12, "hex8", 0.3),
        // Averaged dilatation: patches of cells, which ranks share out too.
        "soft tetrahedra" => cube(5, "tet4", 0.4999),
        "hinge" => hinge(),
        file => Scene::from_file(folder.join(file)).unwrap(),
    }
}

fn cube(cells: usize, cell: &str, poisson: f64) -> Scene {
    let text = format!(
        r#"{{ "bodies": [{{ "name": "cube",
              "mesh": {{ "box": {{ "x": [0, 1], "y": [0, 1], "z": [0, 1], "cells": [{cells}, {cells}, {cells}],
                                   "cell": "{cell}" }} }},
              "materials": [{{ "young": 1000, "poisson": {poisson} }}],
              "supports": [{{ "group": "top", "displacement": [0.0045, 0, -0.01] }}] }}],
            "contacts": [{{ "group": "bottom", "friction": 0.3,
              "obstacle": {{ "plane": {{ "point": [0, 0, 0], "normal": [0, 0, 1] }} }} }}] }}"#
    );
    Scene::from_json(&text, "").unwrap()
}

/// Two squares that share a node, of which one is held: the other turns about it.
fn hinge() -> Scene {
    let positions = [0., 0., 1., 0., 1., 1., 0., 1., 2., 1., 2., 2., 1., 2.];
    let cells = [0, 1, 2, 3, 2, 4, 5, 6];
    let mesh = body::Mesh::from_arrays(body::CellKind::Quad4, &positions, &cells).unwrap();
    let mesh = mesh
        .with_surface("under", |[x, y, _]| y == 1.0 && x >= 1.0)
        .unwrap();
    let mesh = mesh.with_surface("left", |[x, ..]| x == 0.0).unwrap();
    let hinged = SceneBody::new("hinged", mesh)
        .with_model(SceneModel::PlaneStrain)
        .with_material(SceneMaterial::new(1000.0, 0.3))
        .with_support(SceneSupport::of("left", &[Some(0.0), Some(0.0)]));
    let floor = SceneObstacle::plane(&[0.0, 0.0], &[0.0, 1.0]);
    Scene::new(vec![hinged], vec![SceneContact::on(floor, "under", 0.5)])
}

fn condensed(scene: &Scene, engine: Engine) -> Result<Condensed, Error> {
    let mechanics = scene.mechanics().unwrap();
    let Mechanics {
        bodies,
        contacts,
        rigid_bodies,
        ..
    } = &mechanics;
    Condensed::with_engine(engine, bodies, contacts, rigid_bodies)
}

fn a_hinge_is_refused_with_body_and_node() {
    let refused = condensed(&hinge(), Engine::Mumps).unwrap_err();
    let Error::NotPositiveDefinite {
        body,
        node,
        pivot,
        diagonal,
        ..
    } = &refused
    else {
        panic!("{refused}");
    };
    // Nodes 4, 5 and 6 turn about node 2, on which all hangs.
    assert!(body == "hinged" && [4, 5, 6].contains(node), "{refused}");
    assert!(pivot.abs() < 1e-10 * diagonal, "{refused}");
}

fn ranks_with_another_scene_are_named(count: usize) {
    let found = condensed(&cube(6, "hex8", 0.3), Engine::Mumps);
    match count {
        1 => assert!(found.is_ok()),
        _ => {
            let refused = found.unwrap_err().to_string();
            let expected = "cube: rank 1: another scene than on rank 0";
            assert!(refused.starts_with(expected), "{refused}");
        }
    }
}

fn the_same_as_without_ranks(case: &str, count: usize) {
    let mut scene = scene(case);
    let [expected, found] = [Engine::Faer, Engine::Mumps].map(|by| condensed(&scene, by).unwrap());
    let far = (expected.problem().compliance() - found.problem().compliance()).norm_max();
    let far = far / expected.problem().compliance().norm_max();
    let free = |of: &Condensed| of.problem().free_displacement().to_vec();
    let moved = apart(&free(&expected), &free(&found));
    // Either factor errs by ε times the condition of K: 1e5 on soft ground, 1e6 near incompressibility.
    let bound = match case {
        "foundation.json" => 1e-11,
        "soft tetrahedra" => 1e-10,
        _ => 1e-12,
    };
    assert!(
        far <= bound && moved <= bound,
        "{case}: G {far:e}, û {moved:e}"
    );
    assert_eq!(found.ranks().len(), count);
    let memory = found.ranks();
    assert!(
        memory
            .iter()
            .all(|rank| rank.used > 0.0 && rank.used <= 2.0 * rank.estimated)
    );
    drop((expected, found));

    let [expected, found] = [Engine::Faer, Engine::Mumps].map(|by| {
        scene.settings.engine = by;
        solve(&scene).unwrap()
    });
    assert_eq!(
        [expected.status(), found.status()],
        [Status::Certified; 2],
        "{case}"
    );
    let recovered = apart(
        &expected.displacements().concat(),
        &found.displacements().concat(),
    );
    assert!(recovered <= 1e-9, "{case}: displacements {recovered:e}");
    let reports = [expected, found].map(|solution| solution.report().unwrap());
    same_states(&reports, case);
    println!("{case:16} {count} ranks: G {far:.0e}, û {moved:.0e}, u {recovered:.0e}");
}

fn same_states([expected, found]: &[Report; 2], case: &str) {
    let states = |report: &Report| -> Vec<_> {
        let contacts = report.contacts.iter();
        contacts
            .map(|contact| format!("{:?}", contact.state))
            .collect()
    };
    assert_eq!(states(expected), states(found), "{case}");
}

/// Largest difference, as a part of the largest.
fn apart(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let largest = a
        .iter()
        .fold(f64::MIN_POSITIVE, |most, x| most.max(x.abs()));
    let pairs = a.iter().zip(b);
    pairs.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs())) / largest
}

fn program(ranks: usize, arguments: &[&str]) -> (Option<i32>, String, String) {
    let output = on_ranks(ranks, Path::new(env!("CARGO_BIN_EXE_dpana")), arguments, "");
    (
        output.status.code(),
        text(&output.stdout),
        text(&output.stderr),
    )
}

fn the_program_tells_memory_and_writes_once(ranks: usize) {
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/scenes/fretting.json");
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("ranks");
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    let report = folder.join("report.json");
    let arguments = [
        "solve",
        scene,
        "--engine",
        "mumps",
        "--report",
        report.to_str().unwrap(),
    ];
    let (code, out, err) = program(ranks, &arguments);
    assert_eq!(code, Some(0), "{out}{err}");
    let told = format!("ranks           {ranks}: factors of ");
    assert_eq!(out.matches(&told).count(), 1, "{out}");
    let report: serde_json::Value = serde_json::from_slice(&fs::read(report).unwrap()).unwrap();
    let of_ranks = report["work"]["ranks"].as_array().unwrap();
    assert_eq!(of_ranks.len(), ranks);
    assert!(of_ranks[0]["estimated_bytes"].is_number());
}

fn the_program_refuses_what_ranks_cannot_do() {
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/scenes/square.json");
    let mumps = ["--engine", "mumps"];
    for (arguments, expected) in [
        ([&["solve", "-"], &mumps[..]].concat(), "expected a file"),
        (
            [&["solve", "absent.json"], &mumps[..]].concat(),
            "absent.json",
        ),
        (
            [&["solve", scene], &mumps[..], &["--accuracy", "1%"]].concat(),
            "--accuracy",
        ),
    ] {
        let (code, out, err) = program(2, &arguments);
        assert_eq!(code, Some(2), "{out}{err}");
        // By every rank that sees it before they are joined.
        assert!(err.contains("error: "), "{err}");
        assert!(err.contains(expected), "{err}");
    }
}
