//! A state that bodies reach without a jump is told from one that they snap into.

use crate::square;
use dpana::alternation::{Outcome, Settings, Status, solve};
use dpana::condensation::Condensed;
use dpana::problem::{ContactProblem, Operator};
use dpana::report::Continuity;
use dpana::scene::SceneSteps;
use dpana::trust::{Earlier, WayBack, way_back};
use faer::mat;
use serde_json::json;

/// One contact, `G = [[1, −1], [−1, 2]]`, `K = G⁻¹ = [[2, 1], [1, 1]]` (references: unique below μ = 1), μ = 1.5.
/// Under û = (n, τ) it may be open for n ≤ 0, sticks with t = −K û for n ≥ 0 or τ ≥ −4 n, and slips along +
/// with t_N = 2 n for n ≤ 0 and τ ≥ −4 n.
fn contact(free: [f64; 2]) -> ContactProblem {
    let operator = Operator::from_compliance(mat![[1.0, -1.0], [-1.0, 2.0]]).unwrap();
    ContactProblem::new(&[1], vec![1.5], vec![0.0], free.to_vec(), operator).unwrap()
}

fn solved(problem: &ContactProblem) -> Outcome {
    let outcome = solve(problem, &Settings::default()).unwrap();
    assert_eq!(outcome.status, Status::Certified);
    outcome
}

fn back(problem: &ContactProblem, earlier: &Earlier) -> WayBack {
    way_back(problem, &Settings::default(), &solved(problem), earlier).unwrap()
}

fn earlier(reaction: [f64; 2], displacement: [f64; 2]) -> Earlier {
    Earlier {
        reaction: reaction.to_vec(),
        displacement: displacement.to_vec(),
        motion: Vec::new(),
    }
}

#[test]
fn a_contact_that_snaps_shut_has_no_path() {
    // Open under (−0.1, 0.3), sticking under (0.1, 0.5). In between it may stay open up to n = 0, half way,
    // and stick from τ = −4 n on, which is a tenth of the way.
    let WayBack::Turns(part) = back(&contact([0.1, 0.5]), &earlier([0.0; 2], [-0.1, 0.3])) else {
        unreachable!()
    };
    // The end is certified to 1e-12, and λ moves five times as fast as n.
    assert!((part - 0.1).abs() < 1e-11, "{part}");
}

#[test]
fn a_contact_that_springs_open_has_no_path() {
    // It sticks under (−0.1, 0.5) with t = (−0.3, −0.4), which nothing holds from τ = 0.4 down; open under
    // (−0.1, 0.3) it would have been open all the way.
    let sticking = earlier([-0.3, -0.4], [0.0; 2]);
    assert_eq!(back(&contact([-0.1, 0.3]), &sticking), WayBack::Elsewhere);
    // The same two states at n > 0, where each load has one: no jump.
    let sticking = earlier([-0.7, -0.6], [0.0; 2]);
    assert_eq!(back(&contact([0.1, 0.3]), &sticking), WayBack::Continuous);
}

#[test]
fn a_square_is_dragged_from_rest_without_a_jump() {
    for friction in [0.0, 0.3, 1.0] {
        let scene = square::scene(16, 0.2, friction);
        let trust = dpana::solve(&scene).unwrap().trust(0).unwrap().unwrap();
        assert_eq!(trust.continuity, Continuity::Continuous, "{}", trust.words);
    }
}

/// Pushed and then pressed on in steps, contacts stick or have just touched: nothing of theirs moves, be it by
/// round-off.
#[test]
fn a_square_that_sticks_does_not_jump() {
    for friction in [0.5, 50.0] {
        for (pushed, pressed) in [("loads[0]", "loads[1]"), ("loads[1]", "loads[0]")] {
            let mut scene = square::scene(16, 0.0, friction);
            let factors = [
                (pushed, [[0.0, 0.0], [1.0, 1.0]]),
                (pressed, [[1.0, 0.0], [4.0, 1.0]]),
            ];
            let factors = factors
                .map(|(load, rows)| (format!("bodies[0].{load}"), rows.map(Vec::from).to_vec()));
            scene.steps = Some(SceneSteps {
                at: vec![1.0, 2.0, 3.0, 4.0],
                factors: factors.into(),
                ..SceneSteps::default()
            });
            dpana::solve_steps(&scene, None, |solution| {
                let found = solution.continuity()?;
                assert_eq!(found, Some(Continuity::Continuous), "{friction}, {pushed}");
                Ok(())
            })
            .unwrap();
        }
    }
}

#[test]
fn an_overlap_is_pressed_apart_without_a_jump() {
    let problem = square_problem(16, 1.0)
        .with_initial_gap(vec![-1e-5; 16])
        .unwrap();
    assert_eq!(
        back(&problem, &Earlier::rest(&problem)),
        WayBack::Continuous
    );
}

fn square_problem(cells: usize, friction: f64) -> ContactProblem {
    let mechanics = square::scene(cells, 0.2, friction).mechanics().unwrap();
    let condensed = Condensed::new(&mechanics.bodies, &mechanics.contacts).unwrap();
    condensed.problem().clone()
}

/// A cube of 4 cells a side, pressed and then dragged over a plane, or lying loose on it under a weight.
fn cube(loose: bool) -> dpana::Scene {
    let moved = [json!([null, null, -0.01]), json!([0.0045, 0, null])];
    let supports = moved.map(|u| json!({"group": "top", "displacement": u}));
    let pushed = [json!([0, 0, -5]), json!([1, 0, 0])];
    let loads = pushed.map(|q| json!({"group": "top", "traction": q}));
    let (kind, acting) = match loose {
        false => ("supports", json!(supports)),
        true => ("loads", json!(loads)),
    };
    let mut body = json!({
        "mesh": {"box": {"x": [0, 1], "y": [0, 1], "z": [0, 1], "cells": [4, 4, 4]}},
        "materials": [{"young": 1000, "poisson": 0.3}]
    });
    body[kind] = acting;
    let scene = json!({
        "bodies": [body],
        "contacts": [{
            "group": "bottom", "friction": 0.3,
            "obstacle": {"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}}
        }],
        "steps": {
            "at": [1, 2],
            "factors": {format!("bodies[0].{kind}[1]"): [[1, 0], [2, 1]]}
        }
    });
    dpana::Scene::from_json(&scene.to_string(), "").unwrap()
}

#[test]
fn steps_in_space_and_of_loose_bodies_follow_each_other_without_a_jump() {
    for loose in [false, true] {
        let mut seen = 0;
        dpana::solve_steps(&cube(loose), None, |solution| {
            let trust = solution.trust(0)?.unwrap();
            assert_eq!(
                trust.continuity,
                Continuity::Continuous,
                "{loose}: {}",
                trust.words
            );
            seen += 1;
            Ok(())
        })
        .unwrap();
        assert_eq!(seen, 2);
    }
}

#[test]
fn an_earlier_state_of_another_problem_is_refused() {
    let problem = contact([0.1, 0.5]);
    let outcome = solved(&problem);
    let mut wrong = earlier([0.0; 2], [0.0; 2]);
    wrong.displacement.push(0.0);
    let error = way_back(&problem, &Settings::default(), &outcome, &wrong).unwrap_err();
    assert!(
        error.to_string().contains("earlier.displacement"),
        "{error}"
    );
    let mut wrong = earlier([0.0; 2], [0.0; 2]);
    wrong.reaction[1] = f64::NAN;
    let error = way_back(&problem, &Settings::default(), &outcome, &wrong).unwrap_err();
    assert!(error.to_string().contains("earlier.reaction"), "{error}");
}
