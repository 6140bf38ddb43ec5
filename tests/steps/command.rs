//! Load histories and sweeps from the command line: what they leave on disk.

use std::fs;
use std::path::Path;

use crate::program::{dpana, folder};

const SCENE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/scenes/fretting.json");

fn solved(folder: &Path, arguments: &[&str]) -> String {
    let output = dpana(folder, &[&["solve", SCENE], arguments].concat());
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
    String::from_utf8(output.stdout).unwrap()
}

fn refused(folder: &Path, arguments: &[&str]) -> String {
    let output = dpana(folder, arguments);
    assert_eq!(output.status.code(), Some(2));
    String::from_utf8(output.stderr).unwrap()
}

/// A column of a table in CSV, as text.
fn column(table: &str, name: &str) -> Vec<String> {
    let mut lines = table.lines();
    let at = lines
        .next()
        .unwrap()
        .split(',')
        .position(|column| column == name)
        .unwrap();
    lines
        .map(|line| line.split(',').nth(at).unwrap().to_owned())
        .collect()
}

#[test]
fn a_history_leaves_a_table_a_plot_and_a_series() {
    let folder = folder("steps_outputs");
    let loop_axes = "bodies[0].supports[1],friction_x";
    let said = solved(
        &folder,
        &[
            "--table", "t.csv", "--plot", "loop.svg", "--axes", loop_axes, "--vtu", "pad",
        ],
    );
    assert!(
        said.contains("step            18 at 5") && said.contains("energy          work"),
        "{said}"
    );
    let table = fs::read_to_string(folder.join("t.csv")).unwrap();
    assert_eq!(column(&table, "step").len(), 18);
    assert_eq!(column(&table, "step")[..2], ["1", "2"]);
    assert_eq!(column(&table, "at")[..3], ["0.5", "1.0", "1.25"]);
    assert_eq!(column(&table, "bodies[0].supports[1]")[5], "1.0");
    assert!(
        column(&table, "status")
            .iter()
            .all(|status| status == "certified")
    );
    assert!(
        column(&table, "factorisations")
            .iter()
            .all(|count| count == "1")
    );
    // Friction never gives work back.
    let dissipated: Vec<f64> = column(&table, "dissipation")
        .iter()
        .map(|value| value.parse().unwrap())
        .collect();
    assert!(dissipated.windows(2).all(|two| two[0] <= two[1]) && dissipated[17] > 0.3);
    // A point of the plot per state.
    let plot = fs::read_to_string(folder.join("loop.svg")).unwrap();
    let points = plot
        .split("points=\"")
        .nth(1)
        .unwrap()
        .split('"')
        .next()
        .unwrap();
    assert_eq!(points.split(' ').count(), 18);
    let series = fs::read_to_string(folder.join("pad.pvd")).unwrap();
    assert_eq!(series.matches("<DataSet").count(), 18);
    assert!(series.contains("timestep=\"1.25\" file=\"pad_0003.vtu\""));
    let contacts = fs::read_to_string(folder.join("pad_contact.pvd")).unwrap();
    assert_eq!(contacts, series.replace(".vtu", "_contact.vtu"));
    for file in ["pad_0001.vtu", "pad_0018.vtu", "pad_0018_contact.vtu"] {
        assert!(folder.join(file).is_file(), "{file}");
    }
    assert!(!folder.join("pad.vtu").exists());
}

#[test]
fn a_history_taken_on_from_a_file_ends_in_the_same_report() {
    let folder = folder("steps_restart");
    // A scene that ends early leaves its state.
    let scene = fs::read_to_string(SCENE).unwrap();
    let early = scene.replace(", 3.25, 3.5, 3.75, 4, 4.25, 4.5, 4.75, 5]", "]");
    assert_ne!(early, scene);
    fs::write(folder.join("early.json"), early).unwrap();
    let output = dpana(&folder, &["solve", "early.json", "--state", "state.json"]);
    assert_eq!(output.status.code(), Some(0));
    solved(&folder, &["--table", "whole.csv"]);
    solved(&folder, &["--table", "rest.csv", "--restart", "state.json"]);
    let [whole, rest] =
        ["whole.csv", "rest.csv"].map(|file| fs::read_to_string(folder.join(file)).unwrap());
    let [whole, rest]: [Vec<&str>; 2] = [&whole, &rest].map(|table| table.lines().collect());
    assert_eq!(rest[0], whole[0]);
    assert_eq!(rest[1..], whole[11..]);

    let damaged = "{\"bodies\": 1, \"history\": 1, \"steps\": 3, \"at\": \"soon\"}";
    fs::write(folder.join("damaged.json"), damaged).unwrap();
    let said = refused(&folder, &["solve", SCENE, "--restart", "damaged.json"]);
    assert!(
        said.contains("damaged.json:1") && said.contains("`soon` is no number"),
        "{said}"
    );
    let said = refused(&folder, &["solve", SCENE, "--restart", "absent.json"]);
    assert!(said.contains("--restart absent.json"), "{said}");
}

#[test]
fn an_interrupted_history_loses_the_step_in_progress_and_no_more() {
    let folder = folder("steps_interrupted");
    let outputs = ["--vtu", "pad.vtu", "--state", "state.json"];
    let whole = ["--table", "whole.csv", "--vtu", "whole.vtu"];
    solved(&folder, &whole);
    let whole = fs::read_to_string(folder.join("whole.csv")).unwrap();
    for table in ["t.csv", "t.json"] {
        // A folder stands where the tenth step would write.
        fs::create_dir(folder.join("pad_0010.vtu")).unwrap();
        let outputs = [&outputs[..], &["--table", table]].concat();
        let said = refused(&folder, &[&["solve", SCENE], &outputs[..]].concat());
        assert!(said.contains("pad_0010.vtu"), "{said}");
        let series = fs::read_to_string(folder.join("pad.pvd")).unwrap();
        assert_eq!(series.matches("<DataSet").count(), 9);
        if table == "t.csv" {
            let rows = fs::read_to_string(folder.join(table)).unwrap();
            assert!(whole.starts_with(&rows) && rows.lines().count() == 11);
        }
        // Taken on, its files end as those of the history that was not interrupted.
        fs::remove_dir(folder.join("pad_0010.vtu")).unwrap();
        solved(
            &folder,
            &[&outputs[..], &["--restart", "state.json"]].concat(),
        );
        let series = fs::read_to_string(folder.join("pad.pvd")).unwrap();
        let expected = fs::read_to_string(folder.join("whole.pvd")).unwrap();
        assert_eq!(series, expected.replace("whole_", "pad_"));
        for file in ["0009.vtu", "0010.vtu", "0018_contact.vtu"] {
            let [found, expected] = ["pad_", "whole_"]
                .map(|name| fs::read(folder.join(format!("{name}{file}"))).unwrap());
            assert!(found == expected, "{file}");
        }
        fs::remove_file(folder.join("pad_0010.vtu")).unwrap();
    }
    assert_eq!(fs::read_to_string(folder.join("t.csv")).unwrap(), whole);
    solved(&folder, &["--table", "whole.json"]);
    let [found, expected] =
        ["t.json", "whole.json"].map(|file| fs::read_to_string(folder.join(file)).unwrap());
    assert!(found == expected);
    // Any other file in its place is left alone.
    fs::write(folder.join("notes.csv"), "remember\n").unwrap();
    let said = refused(
        &folder,
        &[
            "solve",
            SCENE,
            "--restart",
            "state.json",
            "--table",
            "notes.csv",
        ],
    );
    assert!(
        said.contains("--table notes.csv: has no column `step`"),
        "{said}"
    );
    assert_eq!(
        fs::read_to_string(folder.join("notes.csv")).unwrap(),
        "remember\n"
    );
}

#[test]
fn nothing_but_the_answer_is_said_where_nobody_watches() {
    let folder = folder("steps_quiet");
    let output = dpana(&folder, &["solve", SCENE]);
    assert!(output.status.success() && output.stderr.is_empty());
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/scenes/ssnv128.json");
    let vary = ["--vary", "friction=0.5,1", "--out", "t.csv"];
    let output = dpana(&folder, &[&["cases", scene], &vary[..]].concat());
    assert!(output.status.success() && output.stderr.is_empty());
}

#[test]
fn outputs_and_values_that_make_no_sense_are_refused() {
    let folder = folder("steps_refused");
    let said = refused(&folder, &["solve", SCENE, "--table", "a", "--state", "a"]);
    assert!(said.contains("--table, --state: the same file"), "{said}");
    let said = refused(
        &folder,
        &["solve", SCENE, "--plot", "p.svg", "--axes", "at"],
    );
    assert!(said.contains("expected two columns"), "{said}");
    let said = refused(
        &folder,
        &["solve", SCENE, "--plot", "p.svg", "--axes", "at,force"],
    );
    assert!(
        said.contains("no column `force`") && said.contains("contact_force_x"),
        "{said}"
    );
    for values in [
        "friction",
        "friction=",
        "friction=0:1",
        "friction=0:1:1",
        "friction=0:1:many",
    ] {
        let said = refused(
            &folder,
            &["sweep", SCENE, "--vary", values, "--out", "t.csv"],
        );
        assert!(
            said.contains("expected NAME=FROM:TO:COUNT"),
            "{values}: {said}"
        );
    }
    let said = refused(
        &folder,
        &["sweep", SCENE, "--vary", "gap=0", "--out", "t.csv"],
    );
    assert!(said.contains("a scene without steps"), "{said}");
    let said = refused(&folder, &["limit", SCENE]);
    assert!(said.contains("supports that hold every body"), "{said}");
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 0);
}

#[test]
fn a_sweep_to_json_holds_columns_and_rows() {
    let folder = folder("sweep_json");
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/scenes/ssnv128.json");
    let output = dpana(
        &folder,
        &[
            "sweep",
            scene,
            "--vary",
            "friction=0.5:1:3",
            "--out",
            "t.json",
        ],
    );
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let text = fs::read_to_string(folder.join("t.json")).unwrap();
    let table: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(table["columns"][0], "friction");
    let friction: Vec<f64> = table["rows"]
        .as_array()
        .unwrap()
        .iter()
        .map(|row| row[0].as_f64().unwrap())
        .collect();
    assert_eq!(friction, [0.5, 0.75, 1.0]);
}
