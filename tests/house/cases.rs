//! Sweeps over values: every case is the scene solved alone, on one factorisation.

use std::process::Command;
use std::sync::Mutex;

use dpana::report::{Cell, Table};
use dpana::{Scene, Variation, cases, cases_watched, solve};
use serde_json::{Value, json};

fn block() -> Value {
    json!({
        "bodies": [{
            "name": "block",
            "mesh": {"rectangle": {"x": [0, 2], "y": [0, 1], "cells": [12, 6]}},
            "model": "plane_strain",
            "materials": [{"young": 1000, "poisson": 0.3}],
            "supports": [{"group": "top", "displacement": [0, 0]}],
            "loads": [{"traction": [0, -3], "group": "left"}, {"body_force": [2, -8]}]
        }],
        "contacts": [{
            "group": "bottom", "friction": 0.0,
            "obstacle": {"plane": {"point": [0, 0], "normal": [0, 1]}}
        }]
    })
}

fn scene(value: &Value) -> Scene {
    Scene::from_json(&value.to_string(), "").unwrap()
}

fn vary(name: &str, values: &[f64]) -> Variation {
    Variation {
        name: name.to_owned(),
        values: values.to_vec(),
    }
}

fn number(table: &Table, row: usize, column: &str) -> f64 {
    table.column(column).unwrap()[row]
}

#[test]
fn every_case_is_the_scene_solved_alone() {
    let variations = [
        vary("friction", &[0.0, 0.2, 0.7]),
        vary("bodies[0].loads[0]", &[1.0, -0.5]),
        vary("gap", &[0.0, 1e-4]),
        vary("contacts[0].y", &[0.0, 3e-4]),
    ];
    let table = cases(&scene(&block()), &variations).unwrap();
    assert_eq!(table.rows.len(), 24);
    assert!(
        table
            .rows
            .iter()
            .all(|row| row.contains(&Cell::Word("certified".into())))
    );
    assert!(
        table
            .column("factorisations")
            .unwrap()
            .iter()
            .all(|&count| count == 1.0)
    );
    let mut row = 0;
    for friction in [0.0, 0.2, 0.7] {
        for factor in [1.0, -0.5] {
            for gap in [0.0, 1e-4] {
                for moved in [0.0, 3e-4] {
                    let mut alone = block();
                    alone["contacts"][0]["friction"] = json!(friction);
                    alone["bodies"][0]["loads"][0]["traction"] = json!([0, -3.0 * factor]);
                    let plane = &mut alone["contacts"][0]["obstacle"]["plane"];
                    plane["point"] = json!([0, moved - gap]);
                    let report = solve(&scene(&alone)).unwrap().report().unwrap();
                    let totals = &report.totals;
                    for (column, expected) in [
                        ("friction", friction),
                        ("normal", totals.normal),
                        ("friction_x", totals.friction[0]),
                        ("contact_force_y", totals.contact_force[1]),
                        ("contact_area", totals.contact_area),
                        ("slip_area", totals.slip_area),
                        ("peak_pressure", totals.peak_pressure),
                    ] {
                        let found = number(&table, row, column);
                        // Certified to 1e-12, the condition of G 13 contacts, an area a twelfth.
                        let size = totals.normal.max(totals.peak_pressure).max(1.0);
                        assert!(
                            (found - expected).abs() < 1e-9 * size,
                            "{row} {column}: {found} {expected}"
                        );
                    }
                    row += 1;
                }
            }
        }
    }
}

#[test]
fn friction_that_the_scene_does_not_have_is_swept_all_the_same() {
    let friction = [0.0, 0.1, 0.3];
    let table = cases(&scene(&block()), &[vary("contacts[0].friction", &friction)]).unwrap();
    let forces: Vec<f64> = (0..3)
        .map(|row| number(&table, row, "friction_x").abs())
        .collect();
    assert!(
        forces[0] == 0.0 && forces[1] > 0.0 && forces[2] > 1.5 * forces[1],
        "{forces:?}"
    );
}

#[test]
fn cases_that_change_no_contact_take_one_newton_step_and_no_cone_program() {
    // From no gap the body is loaded in proportion: every contact keeps its state and direction.
    let loaded = |load: &[f64]| {
        let mut stated = block();
        stated["contacts"][0]["friction"] = json!(0.2);
        stated["bodies"][0]["loads"] = json!([{"body_force": [2, -8]}]);
        cases(&scene(&stated), &[vary("bodies[0].loads[0]", load)]).unwrap()
    };
    let table = loaded(&[1.0, 0.3, 2.5, 7.0, 0.5]);
    assert!(number(&table, 0, "stick") > 0.0 && number(&table, 0, "slip") > 0.0);
    assert!(number(&table, 0, "sweeps") == 1.0);
    for row in 1..5 {
        assert_eq!(number(&table, row, "sweeps"), 0.0);
        assert_eq!(number(&table, row, "newton_steps"), 1.0);
        for column in ["slip_area", "contact_area", "stick", "open"] {
            assert_eq!(number(&table, row, column), number(&table, 0, column));
        }
    }
    let ratio = number(&table, 3, "normal") / number(&table, 0, "normal");
    assert!((ratio - 7.0).abs() < 1e-12);
}

#[test]
fn a_body_that_only_contact_holds_is_swept_to_where_it_slides_off() {
    // 2 N press, μ = 0.5: friction carries a push of up to 1 N.
    let pad = json!({
        "bodies": [{
            "mesh": {"rectangle": {"x": [0, 2], "y": [0, 0.5], "cells": [8, 2]}},
            "model": "plane_strain",
            "materials": [{"young": 1000, "poisson": 0}],
            "loads": [{"pressure": 1, "group": "top"}, {"traction": [0.5, 0], "group": "bottom"}]
        }],
        "contacts": [{"group": "bottom", "friction": 0.5,
            "obstacle": {"plane": {"point": [0, 0], "normal": [0, 1]}}}]
    });
    let pushes = [0.0, 0.9, -0.5, 1.1, 0.3, -0.99];
    let table = cases(&scene(&pad), &[vary("bodies[0].loads[1]", &pushes)]).unwrap();
    for (row, push) in pushes.into_iter().enumerate() {
        let status = if push > 1.0 {
            "no_equilibrium"
        } else {
            "certified"
        };
        assert!(
            table.rows[row].contains(&Cell::Word(status.into())),
            "{push}"
        );
        if push < 1.0 {
            // Equilibrium is certified to 1e-12 of 2 N.
            assert!((number(&table, row, "friction_x") + push).abs() < 1e-11);
            assert!((number(&table, row, "normal") - 2.0).abs() < 1e-11);
        }
    }
}

#[test]
fn progress_counts_every_case_once() {
    let seen = Mutex::new(Vec::new());
    let variations = [
        vary("gap", &[0.0, 1e-4, 2e-4]),
        vary("friction", &[0.1, 0.2]),
    ];
    cases_watched(&scene(&block()), &variations, |done, all| {
        seen.lock().unwrap().push((done, all));
    })
    .unwrap();
    let mut seen = seen.into_inner().unwrap();
    seen.sort_unstable();
    assert_eq!(seen, (1..=6).map(|done| (done, 6)).collect::<Vec<_>>());
}

#[test]
fn what_cannot_be_varied_is_refused_by_name() {
    let refused = |variation: Variation| {
        cases(&scene(&block()), &[variation])
            .unwrap_err()
            .to_string()
    };
    assert!(
        refused(vary("bodies[0].loads[2]", &[1.0])).contains("no quantity `bodies[0].loads[2]`")
    );
    assert!(refused(vary("friction", &[0.1, -0.1])).contains("friction: -0.1 is not accepted"));
    assert!(refused(vary("gap", &[])).contains("gap: empty"));
    assert!(refused(vary("gap", &[f64::NAN])).contains("NaN is not a finite number"));
    let twice = [vary("gap", &[0.0]), vary("gap", &[1.0])];
    let refused_twice = cases(&scene(&block()), &twice).unwrap_err().to_string();
    assert!(refused_twice.contains("`gap` twice"), "{refused_twice}");
    let mut stepped = block();
    stepped["steps"] = json!({"at": [1]});
    let refused = cases(&scene(&stepped), &[vary("gap", &[0.0])])
        .unwrap_err()
        .to_string();
    assert!(refused.contains("a scene without steps"), "{refused}");
}

#[test]
fn the_table_does_not_depend_on_the_number_of_threads() {
    let folder = std::env::temp_dir().join(format!("dpana-sweep-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let file = folder.join("scene.json");
    std::fs::write(&file, block().to_string()).unwrap();
    let tables = ["1", "2", "3"].map(|threads| {
        let out = folder.join(format!("table-{threads}.csv"));
        let done = Command::new(env!("CARGO_BIN_EXE_dpana"))
            .args([
                "sweep",
                file.to_str().unwrap(),
                "--out",
                out.to_str().unwrap(),
            ])
            .args(["--vary", "gap=0,1e-4", "--vary", "friction=0.1:0.9:30"])
            .env("RAYON_NUM_THREADS", threads)
            .output()
            .unwrap();
        assert!(
            done.status.success(),
            "{}",
            String::from_utf8_lossy(&done.stderr)
        );
        assert_eq!(
            String::from_utf8_lossy(&done.stdout),
            "60 cases, 60 certified\n"
        );
        std::fs::read_to_string(out).unwrap()
    });
    std::fs::remove_dir_all(&folder).unwrap();
    assert_eq!(tables[0].lines().count(), 61);
    assert!(
        tables[0]
            .lines()
            .nth(31)
            .unwrap()
            .starts_with("0.0001,0.1,certified,")
    );
    assert!(tables[0] == tables[1] && tables[0] == tables[2]);
}
