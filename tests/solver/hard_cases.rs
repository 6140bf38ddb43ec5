//! Scenes that were built to break the method end as they should; what cannot be certified says why;
//! other starts tell whether a state is the only one.

use crate::square;
use dpana::alternation::{Outcome, Settings, Shortfall, Status, solve};
use dpana::condensation::Condensed;
use dpana::problem::{ContactProblem, Operator};
use dpana::study::Variant;
use dpana::trust::{contraction, other_starts};
use dpana::verify::{Reach, hard_cases};
use faer::{Mat, mat};
use serde_json::Value;

fn square_problem(cells: usize, poisson: f64, friction: f64) -> ContactProblem {
    let mechanics = square::scene(cells, poisson, friction).mechanics().unwrap();
    let condensed = Condensed::new(&mechanics.bodies, &mechanics.contacts).unwrap();
    condensed.problem().clone()
}

/// Contacts of two unknowns each, `G` in blocks.
fn blocks(blocks: &[[[f64; 2]; 2]], free: &[f64], friction: f64) -> ContactProblem {
    let size = 2 * blocks.len();
    let compliance = Mat::from_fn(size, size, |i, j| match i / 2 == j / 2 {
        true => blocks[i / 2][i % 2][j % 2],
        false => 0.0,
    });
    let operator = Operator::from_compliance(compliance).unwrap();
    let count = blocks.len();
    ContactProblem::new(
        &vec![1; count],
        vec![friction; count],
        vec![0.0; count],
        free.to_vec(),
        operator,
    )
    .unwrap()
}

fn solved(problem: &ContactProblem) -> Outcome {
    solve(problem, &Settings::default()).unwrap()
}

fn passes(reach: Reach, least: usize) {
    let found = hard_cases(reach, |_| ()).unwrap();
    assert!(found.passed, "\n{}", found.summary());
    assert!(found.cases.len() >= least, "{}", found.cases.len());
}

#[test]
fn coarse_hard_cases_end_as_they_should() {
    passes(Reach::Coarse, 120);
}

#[test]
#[ignore = "finer meshes take minutes"]
fn all_hard_cases_end_as_they_should() {
    passes(Reach::All, 400);
}

#[test]
#[ignore = "thousands of contacts take minutes and gigabytes"]
fn thousands_of_contacts_end_as_they_should() {
    passes(Reach::Largest, 2);
}

/// The alternation diverges here from μ = 2 on; proximal steps lead there.
#[test]
fn proximal_steps_lead_where_sweeps_do_not_settle() {
    for (cells, friction) in [(96, 10.0), (32, 50.0)] {
        let outcome = solved(&square_problem(cells, 0.0, friction));
        assert_eq!(outcome.status, Status::Certified);
        let work = outcome.work;
        assert!(work.proximal_steps > 0 && work.sweeps == 1, "{work:?}");
        // 24 and 204 where this was written.
        assert!(work.newton_steps <= 300, "{work:?}");
    }
}

/// A beam of 40 m and 4 cm: 1e5 times the digits that plain sums have are lost in `û + G t`.
#[test]
fn a_slender_body_is_certified_with_deep_sums() {
    let scene = serde_json::json!({
        "bodies": [{
            "mesh": {"rectangle": {"x": [0, 40], "y": [0, 0.04], "cells": [60, 4]}},
            "model": "plane_strain",
            "materials": [{"young": 1.3e11, "poisson": 0.3}],
            "supports": [
                {"group": "right", "displacement": [0, null]},
                {"at": [40, 0], "displacement": [null, 0]}
            ],
            "loads": [{"group": "top", "pressure": 5e7}]
        }],
        "contacts": [{
            "group": "bottom", "friction": 0,
            "obstacle": {"plane": {"point": [0, 0], "normal": [0, 1]}}
        }]
    });
    let scene = dpana::Scene::from_json(&scene.to_string(), "").unwrap();
    let solution = dpana::solve(&scene).unwrap();
    assert_eq!(solution.status(), Status::Certified);
    let condition = solution.outcome().condition.unwrap();
    assert!(condition > 1e8, "{condition:e}");
    let report = solution.report().unwrap();
    assert!(
        report
            .notes
            .iter()
            .any(|note| note.starts_with("ill-conditioned"))
    );
}

#[test]
fn sweeps_that_run_out_are_named() {
    let settings = Settings::default().with_max_sweeps(2);
    let outcome = Variant::PLAIN
        .solve(&square_problem(8, 0.2, 1.0), &settings)
        .unwrap();
    assert_eq!(outcome.status, Status::NotConverged);
    assert_eq!(outcome.shortfall, Some(Shortfall::SweepLimit));
    // The best state comes along.
    assert!(outcome.verdict.certificate.residual() < 0.5);
}

#[test]
fn a_tolerance_below_round_off_ends_soon_and_says_so() {
    let settings = Settings::default().with_tolerance(1e-15);
    let outcome = solve(&square_problem(48, 0.2, 1.0), &settings).unwrap();
    let Some(Shortfall::RoundOff { floor }) = outcome.shortfall else {
        unreachable!("{:?}", outcome.shortfall);
    };
    let residual = outcome.verdict.certificate.residual();
    // ε/2 · ‖|G| |t|‖ / ‖G t‖, some 48 contacts across; within four times that the loop calls it round-off.
    assert!(
        floor < 1e-13 && residual < 4.0 * floor,
        "{floor:e} {residual:e}"
    );
    assert!(outcome.work.sweeps <= 5, "{:?}", outcome.work);
}

/// Numbers that look random, in [−1, 1).
fn scattered(k: usize) -> f64 {
    let x = (12.9898 * (k + 1) as f64).sin() * 43_758.545_3;
    2.0 * (x - x.floor()) - 1.0
}

/// In space, μ = 100, every contact coupled with every other: neither sweeps nor friction raised from nothing lead there.
#[test]
fn proximal_steps_lead_where_coupling_is_strong_in_space() {
    let (contacts, size, seed) = (20, 60, 8_400_000);
    let a = Mat::from_fn(size, size, |i, j| scattered(seed + i * size + j));
    let product = a.transpose() * &a;
    let compliance = Mat::from_fn(size, size, |i, j| {
        product[(i.min(j), i.max(j))] / size as f64 + if i == j { 0.1 } else { 0.0 }
    });
    let free = (0..size).map(|k| scattered(seed + size * size + k));
    let problem = ContactProblem::new(
        &[2; 20],
        vec![100.0; contacts],
        vec![0.0; contacts],
        free.collect(),
        Operator::from_compliance(compliance).unwrap(),
    )
    .unwrap();
    let outcome = solved(&problem);
    assert_eq!(outcome.status, Status::Certified);
    // The third start, of 231 subproblems and 1,614 Newton steps in all where this was written.
    assert!(outcome.work.sweeps <= 3, "{:?}", outcome.work);
}

#[test]
fn an_overlap_that_nothing_gives_way_to_is_named() {
    // A body that nothing moves: G = 0 and u_N = 1 m, so (L1) cannot hold. The other has two contacts that face
    // each other and overlap both: u_N = 1 ± (t_1 − t_2), and only the last digits of G resist t_1 = t_2.
    let facing = blocks(&[[[1.0, -1.0], [-1.0, 1.0]]], &[1.0, 1.0], 0.0);
    let facing = ContactProblem::new(
        &[0, 0],
        vec![0.0; 2],
        vec![0.0; 2],
        vec![1.0; 2],
        facing.operator().clone(),
    );
    for problem in [blocks(&[[[0.0; 2]; 2]], &[1.0, 0.0], 0.5), facing.unwrap()] {
        let outcome = solved(&problem);
        assert_eq!(outcome.status, Status::NotConverged);
        let Some(Shortfall::IllConditioned { excess }) = outcome.shortfall else {
            unreachable!("{:?}", outcome.shortfall);
        };
        assert!(excess > 1e3, "{excess:e}");
    }
}

#[test]
fn numbers_that_overflow_are_given_up_with_the_state_at_rest() {
    // t = −û/G = −1e400 N.
    let outcome = solved(&blocks(
        &[[[1e-200, 0.0], [0.0, 1e-200]]],
        &[1e200, 0.0],
        0.5,
    ));
    assert_eq!(outcome.shortfall, Some(Shortfall::ConeSolver));
    assert_eq!(outcome.reaction, [0.0, 0.0]);
}

#[test]
fn a_report_without_certificate_has_its_reason_and_advice() {
    let mut scene = square::scene(32, 0.2, 1.0);
    scene.settings.tolerance = Some(1e-15);
    let report = dpana::solve(&scene).unwrap().report().unwrap();
    let json: Value = serde_json::from_str(&report.to_json()).unwrap();
    assert_eq!(json["reason"], "round_off");
    assert!(
        json["advice"]
            .as_str()
            .unwrap()
            .contains("settings.tolerance")
    );
    let said = report.summary();
    assert!(
        said.contains("reason          what is left is round-off"),
        "{said}"
    );
    assert!(said.contains("advice "), "{said}");
    // A certified one has neither.
    scene.settings.tolerance = None;
    let report = dpana::solve(&scene).unwrap().report().unwrap();
    let json: Value = serde_json::from_str(&report.to_json()).unwrap();
    assert!(json.get("reason").is_none() && json.get("advice").is_none());
}

/// `G = [[1, −1], [−1, 2]]` under û = (−0.1, 0.5) (references: one contact, unique below μ = 1).
const ONE: [[f64; 2]; 2] = [[1.0, -1.0], [-1.0, 2.0]];

#[test]
fn other_starts_find_the_other_states_each_certified() {
    // μ = 3: open t = 0; stick t = −K û = −(2 · (−0.1) + 0.5, −0.1 + 0.5) = (−0.3, −0.4);
    // slip along +: t_N = −n/(1 − μ) = −0.05, t_T = μ t_N = −0.15, u_T = 0.5 + 0.05 − 0.3 = 0.25 > 0.
    let exact = [[0.0, 0.0], [-0.3, -0.4], [-0.05, -0.15]];
    let problem = blocks(&[ONE], &[-0.1, 0.5], 3.0);
    let found = solved(&problem);
    let others = other_starts(&problem, &Settings::default(), &found, 20).unwrap();
    assert!(others.solutions.len() >= 2, "{others:?}");
    // Certified to 1e-12 of t, and 1/(1 − μ) is no amplification; the states are 0.1 apart.
    let mut seen = Vec::new();
    for (outcome, _) in &others.solutions {
        assert_eq!(outcome.status, Status::Certified);
        let near =
            |t: &[f64; 2]| (outcome.reaction[0] - t[0]).hypot(outcome.reaction[1] - t[1]) < 1e-10;
        seen.push(exact.iter().position(near).unwrap());
    }
    seen.sort_unstable();
    seen.dedup();
    assert_eq!(seen.len(), others.solutions.len(), "each once");
}

#[test]
fn one_solution_is_found_from_every_start_where_there_is_but_one() {
    for problem in [
        blocks(&[ONE], &[-0.1, 0.5], 0.5),
        square_problem(16, 0.2, 0.5),
    ] {
        let found = solved(&problem);
        let others = other_starts(&problem, &Settings::default(), &found, 12).unwrap();
        assert_eq!((others.solutions.len(), others.lost), (1, 0));
        assert_eq!(others.solutions[0].1, 12);
    }
}

/// Factors of the plain alternation at μ = 1 (references, item 8, measured with another program), and
/// that it diverges from about 1/β on: 2 for ν = 0, 8/3 for ν = 0.2.
#[test]
fn the_factor_of_the_alternation_is_that_of_its_sweeps() {
    for (poisson, rate, critical) in [(0.0, 0.495, 2.0), (0.2, 0.37, 8.0 / 3.0)] {
        let problem = square_problem(64, poisson, 1.0);
        let found = contraction(&problem, &solved(&problem)).unwrap();
        // The digits of the other program; 1/β bounds from below where states change on the way.
        assert!((found.factor - rate).abs() < 0.02, "{found:?}");
        let multiple = found.critical.unwrap();
        assert!((multiple / critical - 1.0).abs() < 0.1, "{found:?}");
    }
}

#[test]
fn two_uncoupled_halves_have_a_factor_by_hand() {
    // One slipping contact: δt_T = −μ d δt_N with d = −1, δt_N' = −(G_NT/G_NN) δt_T = μ d G_NT/G_NN δt_N:
    // 0.5 · 1 · 1 at μ = 0.5, and 1 at twice that.
    let problem = blocks(&[ONE], &[0.25, 0.5], 0.5);
    let found = contraction(&problem, &solved(&problem)).unwrap();
    assert!((found.factor - 0.5).abs() < 1e-12, "{found:?}");
    // Between 1 and 1024 in the logarithm, halved twelve times: 0.8e-3 of it to either side.
    assert!(
        (found.critical.unwrap() / 2.0 - 1.0).abs() < 0.9e-3,
        "{found:?}"
    );
    // Without friction there is no alternation.
    let smooth = ContactProblem::new(
        &[0],
        vec![0.0],
        vec![0.0],
        vec![1.0],
        Operator::from_compliance(mat![[1.0]]).unwrap(),
    )
    .unwrap();
    assert_eq!(contraction(&smooth, &solved(&smooth)), None);
}
