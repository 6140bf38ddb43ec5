//! Derivatives, the search for a parameter, and totals to a given accuracy, from the command line.

use std::fs;

use serde_json::Value;

use crate::program::{dpana, folder};

fn square(cells: usize) -> String {
    crate::square::scene(cells, 0.2, 1.0).to_json().unwrap()
}

fn run(name: &str, scene: &str, arguments: &[&str]) -> (Option<i32>, String, String) {
    let folder = folder(name);
    fs::write(folder.join("scene.json"), scene).unwrap();
    let output = dpana(&folder, arguments);
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (
        output.status.code(),
        text(&output.stdout),
        text(&output.stderr),
    )
}

fn report(said: &str) -> Value {
    serde_json::from_str(said).unwrap()
}

#[test]
fn a_total_is_refined_until_its_error_is_within_the_request_and_holds_the_true_one() {
    // Friction of the square on fine meshes, by the published displacements and an independent solver: −1.40536e6 N.
    for (request, within) in [("2%", 0.02), ("0.5%", 0.005)] {
        let arguments = [
            "solve",
            "scene.json",
            "--accuracy",
            request,
            "--of",
            "friction_x",
            "--report",
            "-",
        ];
        let (code, said, error) = run("accuracy", &square(4), &arguments);
        assert_eq!(code, Some(0), "{error}");
        let found = &report(&said)["accuracy"];
        let number = |key: &str| found[key].as_f64().unwrap();
        assert!(number("error") <= within * number("value").abs(), "{found}");
        assert!(
            (number("value") + 1.40536e6).abs() <= number("error"),
            "{found}"
        );
        assert!(found["levels"].as_array().unwrap().len() >= 3);
        assert!(error.contains("accuracy        friction_x"), "{error}");
    }
}

#[test]
fn a_request_that_memory_does_not_allow_says_so_and_ends_with_one() {
    let arguments = [
        "solve",
        "scene.json",
        "--accuracy",
        "1e-9",
        "--memory",
        "0.001",
    ];
    let (code, said, error) = run("accuracy_memory", &square(4), &arguments);
    assert_eq!(code, Some(1), "{error}");
    assert!(
        said.contains("NOT within 0.000000001: the next mesh takes about"),
        "{said}"
    );
    for (arguments, reason) in [
        (["--accuracy", "0", "-q"], "expected a part between 0 and 1"),
        (["--accuracy", "1%", "--of=u_x@0"], "u_x@0.5,0"),
        (["--accuracy", "1%", "--of=nrmal"], "did you mean"),
        (["--accuracy", "1%", "--meshes=a.msh"], "three at least"),
    ] {
        let arguments = [&["solve", "scene.json"], &arguments[..]].concat();
        let (code, _, error) = run("accuracy_refused", &square(2), &arguments);
        assert!(code == Some(2) && error.contains(reason), "{error}");
    }
}

#[test]
fn the_friction_that_gives_a_measured_force_is_found_and_its_state_is_certified() {
    let vary = [
        "find",
        "scene.json",
        "--vary",
        "friction=0.05:2",
        "--so-that",
    ];
    let arguments = [&vary[..], &["friction_x=-1e6", "--report", "-"]].concat();
    let (code, said, error) = run("find", &square(8), &arguments);
    assert_eq!(code, Some(0), "{error}");
    let report = report(&said);
    assert_eq!(report["status"], "certified");
    let pull = report["totals"]["friction"][0].as_f64().unwrap();
    assert!((pull / -1e6 - 1.0).abs() < 1e-9, "{pull}");
    assert!(
        report["found"]["states"].as_u64().unwrap() <= 12,
        "{}",
        report["found"]
    );
    let (code, _, error) = run(
        "find",
        &square(8),
        &[&vary[..], &["friction_x=1e9"]].concat(),
    );
    assert!(
        code == Some(2) && error.contains("the totals seen there run from"),
        "{error}"
    );
    let (code, _, error) = run(
        "find",
        &square(8),
        &[&vary[..], &["slip_area=0.022"]].concat(),
    );
    assert!(code == Some(2) && error.contains("jumps"), "{error}");
}

#[test]
fn derivatives_are_lines_of_the_summary_and_columns_of_the_table() {
    let arguments = ["solve", "scene.json", "--sensitivity", "--table", "t.csv"];
    let (code, said, error) = run("sensitivity", &square(4), &arguments);
    assert_eq!(code, Some(0), "{error}");
    assert!(
        said.contains("per unit of     bodies[0].loads[1]"),
        "{said}"
    );
    let table = fs::read_to_string(folder_of("sensitivity").join("t.csv")).unwrap();
    assert!(table.contains("d(normal)/d(bodies[0].loads[0])"), "{table}");
    // Loads and reactions in one proportion: the derivatives of a total by all of them sum up to it.
    let table = dpana::report::Table::read(&table).unwrap();
    for total in ["normal", "friction_x", "peak_pressure", "largest_slip"] {
        let of = |load: usize| {
            table
                .column(&format!("d({total})/d(bodies[0].loads[{load}])"))
                .unwrap()[0]
        };
        let value = table.column(total).unwrap()[0];
        assert!(((of(0) + of(1)) / value - 1.0).abs() < 1e-9, "{total}");
    }
    // Twice as stiff is half as far, under the same forces.
    let slip = table.column("largest_slip").unwrap()[0];
    let by_young = table.column("d(largest_slip)/d(bodies[0].young)").unwrap()[0];
    assert!((by_young / slip + 1.0).abs() < 1e-9);
}

fn folder_of(test: &str) -> std::path::PathBuf {
    std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join(test)
}
