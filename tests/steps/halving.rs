//! Load steps in halves: what the size of a step hides, and how far it is followed.

use dpana::report::{Report, ReportedStep};
use dpana::scene::SavedState;
use dpana::{Scene, Status, solve_steps};
use serde_json::{Value, json};

/// A block of 2 m × 1 m, pressed down until 1 and then pushed to and fro, with an instant every
/// `1 / parts`.
fn rocked(parts: u32, resolve: Option<f64>) -> Scene {
    let at = (1..=4 * parts).map(|k| f64::from(k) / f64::from(parts));
    let mut steps = json!({
        "at": at.collect::<Vec<_>>(),
        "factors": {
            "bodies[0].supports[0]": [[0, 0], [1, 1]],
            "bodies[0].supports[1]": [[1, 0], [2, 1.2], [4, -1.2]]
        }
    });
    if let Some(resolve) = resolve {
        steps["resolve"] = json!(resolve);
    }
    scene(&steps)
}

fn scene(steps: &Value) -> Scene {
    let scene = json!({
        "bodies": [{
            "mesh": {"rectangle": {"x": [0, 2], "y": [0, 1], "cells": [12, 6]}},
            "model": "plane_strain",
            "materials": [{"young": 1000, "poisson": 0.3}],
            "supports": [
                {"group": "top", "displacement": [null, -0.01]},
                {"group": "top", "displacement": [0.01, null]}
            ]
        }],
        "contacts": [{
            "group": "bottom", "friction": 0.4,
            "obstacle": {"plane": {"point": [0, 0], "normal": [0, 1]}}
        }],
        "steps": steps
    });
    Scene::from_json(&scene.to_string(), "").unwrap()
}

fn reports(scene: &Scene) -> Vec<Report> {
    let mut reports = Vec::new();
    let last = solve_steps(scene, None, |solution| {
        assert_eq!(solution.status(), Status::Certified);
        reports.push(solution.report()?);
        Ok(())
    });
    // However many parts a step has: one factor, and three answers beside the first.
    let work = last.unwrap().condensed().work();
    assert_eq!((work.factorisations, work.substitutions), (1, 4));
    reports
}

fn steps(reports: &[Report]) -> Vec<&ReportedStep> {
    let steps = reports.iter().map(|report| report.step.as_ref().unwrap());
    steps.collect()
}

#[test]
fn steps_that_are_resolved_dissipate_what_fine_steps_do() {
    let [coarse, fine] = [1, 256].map(|parts| reports(&rocked(parts, None)));
    let exact = steps(&fine).last().unwrap().total;
    let scale = exact.supports;
    let error = |reports: &[Report]| {
        let total = steps(reports).last().unwrap().total;
        (total.dissipation - exact.dissipation).abs() / scale
    };
    assert!(
        coarse
            .iter()
            .all(|report| report.step.as_ref().unwrap().halving.is_none())
    );
    // Far above the 1e-5 and 1e-6 that are asked for below: there is something to resolve.
    assert!(error(&coarse) > 2e-4);
    let mut solved = Vec::new();
    for resolve in [1e-3, 1e-5, 1e-6] {
        let resolved = reports(&rocked(1, Some(resolve)));
        assert_eq!(resolved.len(), 4);
        assert!(steps(&resolved)[0].halving.is_none());
        let after_first = steps(&resolved).into_iter().skip(1);
        let halvings: Vec<_> = after_first.map(|step| step.halving.unwrap()).collect();
        for halving in &halvings {
            assert!(halving.resolved && halving.parts >= 2, "{halving:?}");
        }
        assert!(
            error(&resolved) < resolve,
            "{resolve}: {}",
            error(&resolved)
        );
        solved.push(halvings.iter().map(|halving| halving.parts).sum::<usize>());
    }
    assert!(solved.is_sorted() && solved[0] < solved[2], "{solved:?}");
    let sum: f64 = steps(&coarse)
        .iter()
        .map(|step| step.ledger.dissipation)
        .sum();
    assert!((sum - steps(&coarse)[3].total.dissipation).abs() < 1e-12 * scale);
}

#[test]
fn what_grows_in_proportion_is_not_changed_by_halving() {
    let scene = scene(&json!({"at": [0.5, 1, 2, 4], "resolve": 1e-9, "factors": {
        "bodies[0].supports[0]": [[0, 0], [4, 1]],
        "bodies[0].supports[1]": [[0, 0], [4, 0.8]]
    }}));
    for report in &reports(&scene)[1..] {
        assert!(report.totals.slip > 0 && report.totals.stick > 0);
        let step = report.step.as_ref().unwrap();
        let halving = step.halving.unwrap();
        assert_eq!((halving.parts, halving.contacts), (2, 0));
        assert!(halving.dissipation < 1e-12 * step.ledger.supports);
        assert!(halving.resolved && report.notes.iter().all(|note| !note.contains("resolved")));
    }
}

#[test]
fn a_step_that_cannot_be_resolved_ends_and_says_so() {
    let reports = reports(&rocked(1, Some(1e-12)));
    let unresolved = reports.iter().find(|report| {
        let halving = report.step.as_ref().unwrap().halving;
        halving.is_some_and(|halving| !halving.resolved)
    });
    let unresolved = unresolved.unwrap();
    let halving = unresolved.step.as_ref().unwrap().halving.unwrap();
    assert!(halving.parts <= 128 && halving.dissipation > 0.0);
    let note = unresolved
        .notes
        .iter()
        .find(|note| note.contains("not resolved"));
    assert!(note.unwrap().contains(&format!("{} parts", halving.parts)));
    assert!(unresolved.summary().contains("halving         the step's"));
}

#[test]
fn a_halved_history_is_taken_on_bit_for_bit() {
    let scene = rocked(1, Some(1e-2));
    let mut states: Vec<SavedState> = Vec::new();
    solve_steps(&scene, None, |solution| {
        states.push(solution.saved_state().unwrap());
        Ok(())
    })
    .unwrap();
    let mut after = Vec::new();
    solve_steps(&scene, Some(&states[1]), |solution| {
        after.push(solution.saved_state().unwrap());
        Ok(())
    })
    .unwrap();
    assert_eq!(after, states[2..]);
}

#[test]
fn a_history_that_ends_between_two_instants_ends_where_nothing_holds_the_body() {
    // 2 N press, μ = 0.5, and 0.9 N · 1.5 t push: it slides off at t = 1 / 1.35.
    let pad = json!({
        "bodies": [{
            "mesh": {"rectangle": {"x": [0, 2], "y": [0, 0.5], "cells": [8, 2]}},
            "model": "plane_strain",
            "materials": [{"young": 1000, "poisson": 0}],
            "loads": [{"pressure": 1, "group": "top"}, {"traction": [0.45, 0], "group": "bottom"}]
        }],
        "contacts": [{"group": "bottom", "friction": 0.5,
            "obstacle": {"plane": {"point": [0, 0], "normal": [0, 1]}}}],
        "steps": {"at": [0.5, 1, 2], "resolve": 1e-3,
            "factors": {"bodies[0].loads[1]": [[0, 0], [1, 1.5], [2, 0]]}}
    });
    let pad = Scene::from_json(&pad.to_string(), "").unwrap();
    let last = solve_steps(&pad, None, |_| Ok(())).unwrap();
    assert_eq!(last.status(), Status::NoEquilibrium);
    let at = last.step().unwrap().at();
    let (limit, part) = (1.0 / 1.35, 0.5 / 128.0);
    assert!(limit < at && at < limit + part, "{at} {limit}");
}

#[test]
fn a_resolution_that_makes_no_sense_is_refused() {
    for resolve in [0.0, -1.0, 2.0] {
        let refused = rocked(1, Some(resolve))
            .mechanics()
            .unwrap_err()
            .to_string();
        assert!(refused.contains("steps.resolve"), "{refused}");
        assert!(refused.contains("1e-12 <= resolve <= 1"), "{refused}");
    }
}
