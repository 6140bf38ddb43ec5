//! Load histories pay only for what a step needs: counts of programs, sweeps and substitutions.

use dpana::report::Report;
use dpana::{Scene, Status, solve_steps};
use serde_json::{Value, json};

/// A block of 2 m × 1 m held at its top, above a plane that just touches it.
fn block(friction: f64, loads: &Value, steps: &Value) -> Scene {
    let scene = json!({
        "bodies": [{
            "mesh": {"rectangle": {"x": [0, 2], "y": [0, 1], "cells": [12, 6]}},
            "model": "plane_strain",
            "materials": [{"young": 1000, "poisson": 0.3}],
            "supports": [{"group": "top", "displacement": [0, 0]}],
            "loads": loads
        }],
        "contacts": [{
            "group": "bottom", "friction": friction,
            "obstacle": {"plane": {"point": [0, 0], "normal": [0, 1]}}
        }],
        "steps": steps
    });
    Scene::from_json(&scene.to_string(), "").unwrap()
}

/// The reports of all states on one factorisation and so many pairs of substitutions.
fn reports(scene: &Scene, substitutions: usize) -> Vec<Report> {
    let mut reports = Vec::new();
    let last = solve_steps(scene, None, |solution| {
        assert_eq!(solution.status(), Status::Certified);
        reports.push(solution.report()?);
        Ok(())
    });
    let work = last.unwrap().condensed().work();
    assert_eq!(
        (work.factorisations, work.substitutions),
        (1, substitutions)
    );
    reports
}

/// Nothing touches, and at most one Newton step from the state before was taken to find that out:
/// it is not passed over, as with friction a state without contact need not be the only one.
fn is_free(report: &Report) -> bool {
    let work = &report.work;
    let programs = work.normal_programs + work.friction_programs + work.coulomb_programs;
    let sweeps = work.sweeps + work.passes;
    let unloaded = report
        .contacts
        .iter()
        .all(|c| c.force.iter().all(|&f| f == 0.0));
    let cheap = programs + sweeps == 0 && work.newton_steps <= 1;
    unloaded && report.totals.open == report.size.contacts && cheap
}

#[test]
fn an_obstacle_driven_away_and_back_costs_nothing_while_it_is_away() {
    let up = [0.01, -0.02, -0.001, 0.01, -1.0];
    let rows = (1..).zip(up).map(|(at, y)| json!([at, 0, y]));
    let steps =
        json!({"at": [1, 2, 3, 4, 5], "obstacles": {"contacts[0]": rows.collect::<Vec<_>>()}});
    for friction in [0.0, 0.4] {
        let reports = reports(&block(friction, &json!([]), &steps), 1);
        let free: Vec<bool> = reports.iter().map(is_free).collect();
        assert_eq!(free, [false, true, true, false, true]);
        // From contacts that were open, as at first: the same state.
        let [first, back] = [&reports[0].totals, &reports[3].totals];
        assert!(first.normal > 1.0 && (back.normal / first.normal - 1.0).abs() < 1e-12);
        assert_eq!((first.stick, first.slip), (back.stick, back.slip));
        let last = &reports[4].step.as_ref().unwrap().total;
        assert!(last.elastic.abs() < 1e-15 * last.obstacles.abs().max(1.0));
    }
}

#[test]
fn a_load_removed_in_full_leaves_no_reaction() {
    let loads = json!([{"body_force": [3, -8]}, {"traction": [0, -2], "group": "left"}]);
    let steps = json!({"at": [1, 2, 3, 4], "factors": {
        "bodies[0].loads[0]": [[0, 0], [1, 1], [2, 0], [3, 1], [4, 0]],
        "bodies[0].loads[1]": [[0, 0], [1, 1], [2, 0], [3, 1], [4, 0]]
    }});
    // The body as stated, without its loads, and under each alone.
    let reports = reports(&block(0.3, &loads, &steps), 4);
    for (report, loaded) in reports.iter().zip([true, false, true, false]) {
        assert_eq!(report.totals.normal > 1.0, loaded);
        if !loaded {
            // In touch without a gap all over: stuck, and nothing pressed.
            assert!(
                report
                    .contacts
                    .iter()
                    .all(|c| c.force.iter().all(|f| f.abs() < 1e-12))
            );
            assert_eq!(
                report.work.normal_programs + report.work.friction_programs,
                0
            );
        }
    }
}

#[test]
fn without_friction_no_step_has_tangents_or_a_friction_program() {
    let loads = json!([{"body_force": [3, -8]}]);
    let at: Vec<u32> = (1..=8).collect();
    let steps = json!({"at": at, "factors": {
        "bodies[0].loads[0]": [[0, 0], [3, 1], [5, -0.5], [8, 2]]
    }});
    let reports = reports(&block(0.0, &loads, &steps), 3);
    for report in &reports {
        assert_eq!(report.size.contact_unknowns, report.size.contacts);
        assert_eq!((report.work.friction_programs, report.totals.stick), (0, 0));
        assert_eq!(report.step.as_ref().unwrap().total.dissipation, 0.0);
    }
    assert!(is_free(&reports[4]));
    assert!(
        reports
            .iter()
            .filter(|report| report.work.normal_programs > 0)
            .count()
            <= 2
    );
}

#[test]
fn near_steps_take_newton_steps_and_no_program() {
    let loads = json!([{"body_force": [0, -8]}, {"body_force": [3, 0]}]);
    let at: Vec<f64> = (10..=40).map(|k| 0.1 * f64::from(k)).collect();
    let steps = json!({"at": at, "factors": {
        "bodies[0].loads[1]": [[1, 0], [2, 1], [4, -1]]
    }});
    let reports = reports(&block(0.3, &loads, &steps), 3);
    assert!(reports[1..].iter().all(|report| report.work.sweeps == 0));
    assert!(
        reports[1..]
            .iter()
            .all(|report| report.work.newton_steps <= 6)
    );
    let slips = reports
        .iter()
        .filter(|r| r.totals.slip > 0 && r.totals.stick > 0);
    assert!(slips.count() > 5);
}
