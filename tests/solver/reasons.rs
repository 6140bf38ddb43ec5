//! Every reason for an answer without certificate in a case in which it is the right one, and its advice, which
//! mends that case.

use std::sync::atomic::AtomicBool;

use dpana::Scene;
use dpana::alternation::{Interrupt, Outcome, Settings, Shortfall, Status, solve};
use dpana::condensation::Condensed;
use dpana::problem::{ContactProblem, Operator};
use dpana::study::Variant;
use faer::{Mat, mat};
use serde_json::{Value, json};

use crate::square;

/// Status, reason and advice of a scene's report.
fn told(scene: &Scene) -> [String; 3] {
    let report = dpana::solve(scene).unwrap().report().unwrap();
    let report: Value = serde_json::from_str(&report.to_json()).unwrap();
    ["status", "reason", "advice"].map(|key| report[key].as_str().unwrap_or("").to_owned())
}

fn assert_told(scene: &Scene, reason: &str, advice: &str) {
    let [status, found, said] = told(scene);
    assert!(
        status != "certified" && found == reason,
        "{status}, {found}"
    );
    assert!(said.contains(advice), "no `{advice}` in {said}");
}

fn assert_mended(scene: &Scene) {
    assert_eq!(told(scene), ["certified", "", ""]);
}

fn smooth(compliance: Mat<f64>, gap: [f64; 2]) -> Outcome {
    let operator = Operator::from_compliance(compliance).unwrap();
    let (zero, free) = (vec![0.0; 2], vec![1.0; 2]);
    let problem = ContactProblem::new(&[0, 0], zero, gap.to_vec(), free, operator).unwrap();
    solve(&problem, &Settings::default()).unwrap()
}

/// A block that is pressed down by 1 N and pulled along by 0.35 N; its edge would bear 0.5 N.
#[test]
fn no_equilibrium_is_mended_by_more_friction() {
    let scene = |friction: f64| {
        let scene = json!({
            "bodies": [{
                "mesh": {"rectangle": {"x": [0, 1], "y": [0, 1], "cells": [4, 4]}},
                "model": "plane_strain",
                "materials": [{"young": 1000, "poisson": 0.3}],
                "loads": [{"group": "top", "pressure": 1}, {"group": "top", "traction": [0.35, 0]}]
            }],
            "contacts": [{
                "group": "bottom", "friction": friction,
                "obstacle": {"plane": {"point": [0, 0], "normal": [0, 1]}}
            }]
        });
        Scene::from_json(&scene.to_string(), "").unwrap()
    };
    assert_told(&scene(0.3), "no_equilibrium", "by more friction");
    assert_mended(&scene(0.36));
}

/// Of the plain alternation: the loop itself would not need so many.
#[test]
fn sweeps_that_run_out_are_mended_by_more_of_them() {
    let mechanics = square::scene(8, 0.2, 1.0).mechanics().unwrap();
    let condensed = Condensed::new(&mechanics.bodies, &mechanics.contacts).unwrap();
    let with = |max_sweeps| {
        let settings = Settings::default().with_max_sweeps(max_sweeps);
        Variant::PLAIN
            .solve(condensed.problem(), &settings)
            .unwrap()
    };
    assert_eq!(with(2).shortfall, Some(Shortfall::SweepLimit));
    assert_eq!(with(1000).status, Status::Certified);
}

#[test]
fn a_time_limit_is_mended_by_leaving_it_out() {
    let mut scene = square::scene(32, 0.2, 1.0);
    scene.settings.time_limit = Some(1e-9);
    assert_told(&scene, "time_limit", "settings.time_limit");
    scene.settings.time_limit = None;
    assert_mended(&scene);
}

#[test]
fn an_interrupt_is_mended_by_letting_it_run() {
    static RAISED: AtomicBool = AtomicBool::new(true);
    let mut scene = square::scene(32, 0.2, 1.0);
    scene.settings.interrupt = Some(Interrupt::new(&RAISED));
    assert_told(&scene, "interrupted", "let it run");
    scene.settings.interrupt = None;
    assert_mended(&scene);
}

/// Stiffness in one unit, motions in another: t = −û/G = −1e400 N is no number.
#[test]
fn numbers_of_very_different_size_are_mended_by_their_unit() {
    let of = |compliance: f64, length: f64| {
        let operator = Operator::from_compliance(mat![[compliance, 0.0], [0.0, compliance]]);
        let free = vec![length, 0.0];
        let problem =
            ContactProblem::new(&[1], vec![0.5], vec![0.0], free, operator.unwrap()).unwrap();
        solve(&problem, &Settings::default()).unwrap()
    };
    assert_eq!(of(1e-200, 1e200).shortfall, Some(Shortfall::ConeSolver));
    assert_eq!(of(1.0, 1.0).status, Status::Certified);
}

/// Two contacts that face each other and overlap both: u_N = 1 ± (t_1 − t_2), and only the last digits of G resist
/// t_1 = t_2. Where one of them has room for the other's overlap they need nothing of the kind.
#[test]
fn an_overlap_that_nothing_gives_way_to_is_mended_by_taking_it_away() {
    let facing = mat![[1.0, -1.0], [-1.0, 1.0]];
    let reason = smooth(facing.clone(), [0.0, 0.0]).shortfall;
    assert!(
        matches!(reason, Some(Shortfall::IllConditioned { .. })),
        "{reason:?}"
    );
    let mended = smooth(facing, [0.0, 2.0]);
    assert_eq!(mended.status, Status::Certified);
    assert!((mended.reaction[0] + 1.0).abs() < 1e-12 && mended.reaction[1] == 0.0);
}

/// The same contacts with a little give of their own: t = −1/δ each is an answer, however large, and it is found.
#[test]
fn large_reactions_that_more_than_last_digits_resist_are_certified() {
    let give = 1e-6;
    let found = smooth(mat![[1.0 + give, -1.0], [-1.0, 1.0 + give]], [0.0, 0.0]);
    assert_eq!(found.status, Status::Certified);
    // The last digits of 1 + δ are 1e-16/δ of the answer.
    assert!((found.reaction[0] * give + 1.0).abs() < 1e-9, "{found:?}");
}

/// Cells of 1 by 1 by 2e19, and the same body with its coordinate as it was meant.
#[test]
fn a_body_out_of_balance_is_mended_by_the_unit_of_its_coordinates() {
    let scene = |far: f64| {
        let scene = json!({
            "bodies": [{
                "materials": [{"poisson": 0.3, "young": 1000}],
                "mesh": {"box": {"cells": [2, 1, 2], "x": [0, 1], "y": [far, 1], "z": [0, 1]}},
                "supports": [{"displacement": [0.0045, 0, -0.01], "group": "top"}]
            }],
            "contacts": [{
                "friction": 1.3, "group": "bottom",
                "obstacle": {"plane": {"normal": [0, 0, 1], "point": [0, 0, 0]}}
            }]
        });
        Scene::from_json(&scene.to_string(), "").unwrap()
    };
    assert_told(&scene(-2e19), "out_of_balance", "unit among coordinates");
    assert_mended(&scene(-2.0));
}

#[test]
fn a_beam_whose_load_is_rounding_of_its_cells_is_mended_by_more_thickness() {
    // 5 by 1/1000, nearly incompressible: held with twenty times its load, in other units it moved three times as far.
    let beam = |thick: f64| {
        let scene = json!({
            "bodies": [{
                "model": "plane_strain",
                "mesh": {"rectangle": {"x": [0, 8.5], "y": [0, thick], "cells": [20, 1], "cell": "quad8"}},
                "materials": [{"young": 0.013, "poisson": 0.4999}],
                "supports": [{"group": "right", "displacement": [0, 0]}],
                "loads": [{"group": "top", "traction": [0, -1.4e-15]}]
            }],
            "contacts": [{"group": "bottom", "friction": 0.3,
                          "obstacle": {"plane": {"point": [0, -1.7], "normal": [0, 1]}}}]
        });
        Scene::from_json(&scene.to_string(), "").unwrap()
    };
    assert_told(
        &beam(0.0017),
        "out_of_balance",
        "thousands of times as long as thick",
    );
    assert_mended(&beam(0.17));
}

#[test]
fn a_tolerance_below_round_off_is_mended_by_one_above_the_floor() {
    let mut scene = square::scene(32, 0.2, 1.0);
    scene.settings.tolerance = Some(1e-15);
    assert_told(&scene, "round_off", "settings.tolerance");
    // The advice names the floor: "no residual much below … can be had".
    let [_, _, said] = told(&scene);
    let floor = said
        .split("below ")
        .nth(1)
        .and_then(|rest| rest.split(' ').next());
    let floor: f64 = floor.unwrap().parse().unwrap();
    scene.settings.tolerance = Some(4.0 * floor);
    assert_mended(&scene);
}
