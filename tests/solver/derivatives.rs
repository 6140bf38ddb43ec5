//! Derivatives of solved states: against differences of states solved anew, and at kinks by hand.

use std::cell::Cell;

use dpana::alternation::{Centred, Drive, Linearised, Rate, Settings, Sides, solve};
use dpana::problem::{Floating, Operator};
use dpana::{ContactProblem, Status};
use faer::{Mat, mat};
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};

use crate::random_problems::{Numbers, numbers};

/// The drive of a step `h` of everything at once.
fn moved(numbers: &Numbers, along: &[f64], h: f64) -> Numbers {
    let mut moved = numbers.clone();
    let values = moved
        .free
        .iter_mut()
        .chain(&mut moved.gap)
        .chain(&mut moved.friction);
    for (value, along) in values.zip(along) {
        *value += h * along;
    }
    moved
}

fn drive(problem: &ContactProblem, along: &[f64]) -> Drive {
    let (unknowns, contacts) = (problem.unknowns(), problem.contacts());
    let mut drive = Drive::none(problem);
    drive.beyond.copy_from_slice(&along[..unknowns]);
    for (&n, gap) in problem.normals().iter().zip(&along[unknowns..]) {
        drive.beyond[n] -= gap;
    }
    let friction = &along[unknowns + contacts..][..contacts];
    drive.friction.copy_from_slice(friction);
    drive
}

/// Certified ten times closer than by default: differences lose digits.
const CLOSE: f64 = 1e-13;

/// Step of the differences.
const STEP: f64 = 1e-4;

#[test]
fn two_hundred_random_states_away_from_kinks_change_as_differences_say() {
    let strategy = (
        numbers(1..=8, 1..=2, 0.5, 0.5..1.5),
        prop::collection::vec(-1.0..1.0_f64, 8 * 5),
    );
    let compared = Cell::new(0);
    let mut runner = TestRunner::new(Config::with_cases(260));
    let run = runner.run(&strategy, |(mut numbers, along)| {
        // Friction stays positive under every step.
        numbers.friction.iter_mut().for_each(|mu| *mu += 0.01);
        let (problem, outcome) = numbers.solve_to(CLOSE);
        let centred = Centred::new(&problem).unwrap();
        let mut laws = Linearised::new(&centred, &outcome).unwrap().unwrap();
        let solved = |h: f64| moved(&numbers, &along, h).solve_to(CLOSE).1;
        let beside = [-2.0, -1.0, 1.0, 2.0].map(|k| solved(k * STEP));
        let all = || beside.iter().chain([&outcome]);
        let smooth = all().all(|one| {
            one.status == Status::Certified && one.verdict.status == outcome.verdict.status
        });
        if laws.edges() > 0 || !smooth {
            return Ok(());
        }
        let found = laws.along(&drive(&problem, &along)).unwrap().unwrap();
        prop_assert!(found.falling.is_none() && laws.factorisations() == 1);
        // Central differences of two steps, extrapolated.
        let differences = |values: &dyn Fn(usize) -> f64| {
            let near = (values(2) - values(1)) / (2.0 * STEP);
            let far = (values(3) - values(0)) / (4.0 * STEP);
            (4.0 * near - far) / 3.0
        };
        let size = found
            .growing
            .reaction
            .iter()
            .fold(1.0, |most: f64, t| most.max(t.abs()));
        for k in 0..problem.unknowns() {
            let reaction = differences(&|at| beside[at].reaction[k]);
            let beyond = differences(&|at| beside[at].verdict.beyond[k]);
            let off = (found.growing.reaction[k] - reaction).abs();
            let slipped = (found.growing.beyond[k] - beyond).abs();
            prop_assert!(
                off <= 1e-6 * size && slipped <= 1e-6 * size,
                "{k}: {off:e} {slipped:e}"
            );
        }
        compared.set(compared.get() + 1);
        Ok(())
    });
    run.unwrap();
    assert!(compared.get() >= 200, "{} were compared", compared.get());
}

/// One contact, G = 1, μ = ½, at the solution for û.
fn one(free: [f64; 2], gap: f64) -> (ContactProblem, dpana::Outcome) {
    let operator = Operator::from_compliance(mat![[1.0, 0.0], [0.0, 1.0]]).unwrap();
    let problem = ContactProblem::new(&[1], vec![0.5], vec![gap], free.to_vec(), operator).unwrap();
    let outcome = solve(&problem, &Settings::default()).unwrap();
    assert_eq!(outcome.status, Status::Certified);
    (problem, outcome)
}

fn along(
    (problem, outcome): &(ContactProblem, dpana::Outcome),
    beyond: [f64; 2],
    friction: f64,
) -> (Rate, Rate) {
    let centred = Centred::new(problem).unwrap();
    let mut laws = Linearised::new(&centred, outcome).unwrap().unwrap();
    assert_eq!(laws.edges(), 1);
    let drive = Drive {
        beyond: beyond.to_vec(),
        friction: vec![friction],
        load: Vec::new(),
    };
    let Sides { growing, falling } = laws.along(&drive).unwrap().unwrap();
    (growing, falling.unwrap())
}

fn assert_close(found: &[f64], expected: [f64; 2]) {
    let off = (found[0] - expected[0]).hypot(found[1] - expected[1]);
    assert!(off < 1e-12, "{found:?}, expected {expected:?}");
}

#[test]
fn a_contact_that_just_touches_presses_one_way_and_parts_the_other() {
    // û_N grows by 1 and û_T by 0.2: t = (−1, −0.2) sticks. As it falls there is nothing.
    let (growing, falling) = along(&one([0.0, 0.0], 0.0), [1.0, 0.2], 0.0);
    assert_close(&growing.reaction, [-1.0, -0.2]);
    assert_close(&falling.reaction, [0.0, 0.0]);
    assert_close(&falling.beyond, [1.0, 0.2]);
    // û_T by 0.8: more than half of the pressure, so that it slips by 0.3.
    let (growing, _) = along(&one([0.0, 0.0], 0.0), [1.0, 0.8], 0.0);
    assert_close(&growing.reaction, [-1.0, -0.5]);
    assert_close(&growing.beyond, [0.0, 0.3]);
    // One that slides already when it touches is held back at its bound.
    let (growing, _) = along(&one([0.3, 0.7], 0.3), [1.0, 0.0], 0.0);
    assert_close(&growing.reaction, [-1.0, -0.5]);
}

#[test]
fn friction_at_its_bound_slips_one_way_and_sticks_the_other() {
    // t = (−1, −½) holds û = (1, ½) without slip.
    let state = one([1.0, 0.5], 0.0);
    let (growing, falling) = along(&state, [0.0, 1.0], 0.0);
    assert_close(&growing.reaction, [0.0, 0.0]);
    assert_close(&growing.beyond, [0.0, 1.0]);
    assert_close(&falling.reaction, [0.0, -1.0]);
    assert_close(&falling.beyond, [0.0, 0.0]);
    // More friction changes nothing; less lets go: t_T = −μ, so that ṫ_T = −1, u̇_T = û̇ + ṫ = −1.
    let (growing, falling) = along(&state, [0.0, 0.0], 1.0);
    assert_close(&growing.reaction, [0.0, 0.0]);
    assert_close(&falling.reaction, [0.0, -1.0]);
    assert_close(&falling.beyond, [0.0, -1.0]);
}

#[test]
fn a_floating_lid_gives_way_under_more_load() {
    // Two smooth contacts of ½ and ¼ m/N: u = G t + (α + β, α − β) = 0, t_1 + t_2 + e_1 = 0, t_1 − t_2 + e_2 = 0.
    let operator = Operator::from_compliance(mat![[0.5, 0.0], [0.0, 0.25]]).unwrap();
    let zero = vec![0.0; 2];
    let problem = ContactProblem::new(&[0, 0], zero.clone(), zero.clone(), zero, operator);
    let modes: Mat<f64> = mat![[1.0, 1.0], [1.0, -1.0]];
    let floating = Floating::new(modes, vec![6.0, 2.0]).unwrap();
    let problem = problem.unwrap().float(floating).unwrap();
    let outcome = solve(&problem, &Settings::default()).unwrap();
    let centred = Centred::new(&problem).unwrap();
    let mut laws = Linearised::new(&centred, &outcome).unwrap().unwrap();
    let mut drive = Drive::none(&problem);
    drive.load = vec![1.0, 0.0];
    let found = laws.along(&drive).unwrap().unwrap().growing;
    assert_close(&found.reaction, [-0.5, -0.5]);
    // α + β = ¼, α − β = ⅛.
    assert_close(&found.motion, [0.1875, 0.0625]);
}
