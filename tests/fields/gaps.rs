//! A gap as a number: clearance and interference of bodies whose meshes touch.
//! (Timoshenko & Goodier, Theory of Elasticity, § 28.)

use dpana::report::Report;
use dpana::{Scene, Status, Variation, cases, solve_steps};
use serde_json::{Value, json};

use crate::stacks::certified;

/// Radii of the bore of the shaft, of the joint and of the hub in mm, by how much the shaft is too thick.
const RADII: [f64; 3] = [8.0, 20.0, 40.0];
pub(crate) const TOO_THICK: f64 = 0.02;
pub(crate) const YOUNG: f64 = 210e3;
pub(crate) const POISSON: f64 = 0.3;

/// Shaft and hub as bodies of revolution in plane strain, `cells` across the shaft; contact as given.
pub(crate) fn fit(cells: usize, contact: Value) -> Value {
    let ring = |name: &str, [inner, outer]: [f64; 2]| {
        json!({
            "name": name,
            "mesh": {"rectangle": {"x": [inner, outer], "y": [0, 4], "cells": [cells, 2]}},
            "model": "axisymmetric",
            "materials": [{"young": YOUNG, "poisson": POISSON}],
            "supports": [{"group": "bottom", "displacement": [null, 0]},
                         {"group": "top", "displacement": [null, 0]}]
        })
    };
    let mut pair = json!({
        "body": "shaft", "group": "right", "friction": 0,
        "against": {"body": "hub", "group": "left"}
    });
    for (key, value) in contact.as_object().unwrap() {
        pair[key] = value.clone();
    }
    json!({
        "bodies": [ring("shaft", [RADII[0], RADII[1]]), ring("hub", [RADII[1], RADII[2]])],
        "contacts": [pair]
    })
}

pub(crate) fn read(scene: &Value) -> Scene {
    Scene::from_json(&scene.to_string(), "").unwrap()
}

/// p in MPa, in plane strain, of a shaft too thick by `interference`.
pub(crate) fn lame(interference: f64) -> f64 {
    let (young, poisson) = (YOUNG / (1.0 - POISSON * POISSON), POISSON / (1.0 - POISSON));
    let [a, b, c] = RADII.map(|r| r * r);
    let give = (c + b) / (c - b) + poisson + (b + a) / (b - a) - poisson;
    interference * young / (RADII[1] * give)
}

/// Largest departure of a pressure from one value, as a part of it.
pub(crate) fn off(report: &Report, pressure: f64) -> f64 {
    let pressures = report.contacts.iter().map(|c| c.pressure.unwrap());
    pressures.fold(0.0, |most, p| (p / pressure - 1.0).abs().max(most))
}

#[test]
fn an_interference_on_a_mesh_without_overlap_presses_as_lame_says() {
    let errors = [8, 16, 32].map(|cells| {
        let (_, report) = certified(&read(&fit(cells, json!({"gap": -TOO_THICK}))));
        assert_eq!(report.totals.open, 0);
        off(&report, lame(TOO_THICK))
    });
    // Linear cells, second order.
    assert!(errors[2] < 1e-3, "{errors:?}");
    assert!(
        errors[0] > 3.5 * errors[1] && errors[1] > 3.5 * errors[2],
        "{errors:?}"
    );
}

#[test]
fn the_shipped_fit_has_the_pressure_of_lame() {
    let file = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/examples/scenes/press_fit.json"
    );
    let (_, report) = certified(&Scene::from_file(file).unwrap());
    assert!(off(&report, lame(TOO_THICK)) < 2e-3);
}

/// A block of 2 × 1 with E = 1000 and ν = 0 on a plane that it is drawn on, its top moved down.
fn block(gap: f64, down: f64) -> Value {
    json!({
        "bodies": [{
            "mesh": {"rectangle": {"x": [0, 2], "y": [0, 1], "cells": [4, 3]}},
            "model": "plane_strain",
            "materials": [{"young": 1000, "poisson": 0}],
            "supports": [{"group": "top", "displacement": [0, -down]}]
        }],
        "contacts": [{
            "group": "bottom", "friction": 0.3, "gap": gap,
            "obstacle": {"plane": {"point": [0, 0], "normal": [0, 1]}}
        }]
    })
}

#[test]
fn a_clearance_takes_away_from_an_approach_and_an_interference_adds_to_it() {
    // E (0.01 − gap) / 1.
    for (gap, pressure) in [(0.004, 6.0), (0.0, 10.0), (-0.002, 12.0)] {
        let (solution, report) = certified(&read(&block(gap, 0.01)));
        assert!(off(&report, pressure) < 1e-11, "{gap}");
        // What is added is no part of the mesh: the plane is where it is drawn, and the bottom `gap` from it.
        for (contact, node) in report
            .contacts
            .iter()
            .zip(&solution.condensed().surface().nodes)
        {
            assert!(contact.gap.abs() < 1e-14 && node.initial_gap == 0.0);
        }
        let bottom = solution.displacement_near(0, [1.0, 0.0, 0.0]).unwrap();
        assert!((bottom[1] + gap).abs() < 1e-14);
    }
    let (_, report) = certified(&read(&block(0.02, 0.01)));
    assert_eq!(report.totals.normal, 0.0);
    assert!((report.contacts[0].gap - 0.01).abs() < 1e-15);
}

#[test]
fn a_gap_over_steps_is_work_that_the_fit_stores_and_gives_back() {
    let mut scene = fit(16, json!({}));
    scene["steps"] = json!({
        "at": [0.25, 0.5, 1, 1.5, 2],
        "gaps": {"contacts[0]": [[0, 0], [1, -TOO_THICK], [2, 0.01]]}
    });
    let mut reports = Vec::new();
    solve_steps(&read(&scene), None, |solution| {
        assert_eq!(solution.status(), Status::Certified);
        assert_eq!(solution.condensed().work().factorisations, 2);
        assert!(solution.continuity()?.is_some());
        reports.push(solution.report()?);
        Ok(())
    })
    .unwrap();
    let (_, whole) = certified(&read(&fit(16, json!({"gap": -TOO_THICK}))));
    let stored = reports[2].totals.normal * TOO_THICK / 2.0;
    for (report, gap) in reports.iter().zip([-0.005, -0.01, -0.02, -0.005, 0.01]) {
        let part = (-gap / TOO_THICK).max(0.0);
        assert!(
            (report.totals.normal - part * whole.totals.normal).abs() < 1e-9 * whole.totals.normal
        );
        let total = report.step.as_ref().unwrap().total;
        // ½ F δ of a linear fit; open at the end, where nothing is left of it.
        assert!(
            (total.elastic - part * part * stored).abs() < 1e-9 * stored,
            "{total:?}"
        );
        if gap < 0.0 {
            assert!(
                (total.fits - total.elastic).abs() < 1e-9 * stored,
                "{total:?}"
            );
            assert!(total.closure.abs() < 1e-9 * stored, "{total:?}");
        }
    }
    assert_eq!(reports[4].totals.normal, 0.0);
    assert!((reports[4].contacts[0].gap - 0.01).abs() < 1e-12);
    let driven = &reports[1].step.as_ref().unwrap().driven;
    assert_eq!(driven[0].0, "contacts[0].gap");
}

#[test]
fn cases_vary_a_gap_on_top_of_the_stated_one() {
    let vary = Variation {
        name: "gap".to_owned(),
        values: vec![0.0, 0.002],
    };
    let table = cases(&read(&block(0.004, 0.01)), &[vary]).unwrap();
    let peak = table.column("peak_pressure").unwrap();
    assert!(
        (peak[0] - 6.0).abs() < 1e-9 && (peak[1] - 4.0).abs() < 1e-9,
        "{peak:?}"
    );
    assert!(
        table
            .column("certified")
            .is_none_or(|c| c.iter().all(|c| *c == 1.0))
    );
}

#[test]
fn gaps_that_make_no_sense_are_refused_by_place() {
    let mut coded = read(&block(0.0, 0.01));
    coded.contacts[0].gap = f64::INFINITY;
    let refused = coded.mechanics().unwrap_err().to_string();
    assert!(
        refused.contains("contacts[0].gap: inf is not a finite number"),
        "{refused}"
    );
    for (gap, name, rows, expected) in [
        (
            0.1,
            "contacts[0]",
            json!([[0, 0]]),
            "steps.gaps.contacts[0]: a table beside `gap`",
        ),
        (
            0.0,
            "contact[0]",
            json!([[0, 0]]),
            "did you mean `contacts[0]`?",
        ),
        (
            0.0,
            "contacts[0]",
            json!([[0, 0, 1]]),
            "steps.gaps.contacts[0][0]: expected 2 entries",
        ),
        (
            0.0,
            "contacts[0]",
            json!([]),
            "steps.gaps.contacts[0]: empty",
        ),
    ] {
        let mut scene = block(gap, 0.01);
        scene["steps"] = json!({"at": [1], "gaps": {name: rows}});
        let refused = read(&scene).mechanics().unwrap_err().to_string();
        assert!(refused.contains(expected), "{refused}");
    }
    let mut text = block(0.0, 0.01);
    text["contacts"][0]["gap"] = json!("tight");
    assert!(Scene::from_json(&text.to_string(), "").is_err());
}
