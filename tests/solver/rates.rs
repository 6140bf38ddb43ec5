//! Plain exact sweeps contract at the rate that elasticity dictates: |ρ| ≈ μ β on fine meshes,
//! β = (1 − 2ν)/(2 (1 − ν)) against a rigid obstacle, which is 1/2, 3/8, 2/7 for ν = 0, 0.2, 0.3.
//!
//! With the states of the contacts fixed, a sweep is linear in the change of the normal reaction.
//! The rate is the modulus of its leading eigenvalues, a pair near ±iμβ; the next pair is 2 % behind,
//! so that sweeps from a cold start are still a little faster when they reach Clarabel's accuracy.

use crate::square;
use dpana::alternation::{Outcome, Settings, Status, solve};
use dpana::condensation::Condensed;
use dpana::cone::{FrictionHalfStep, NormalHalfStep, Role};
use dpana::kkt::ContactStatus;
use dpana::problem::ContactProblem;
use dpana::study::Variant;
use faer::linalg::solvers::Solve;
use faer::{Col, Mat};

/// Poisson's ratio and the rate of the square with 64 cells per side at μ = 1, to two digits, which is
/// what the tests ask for.
const RATES: [(f64, f64); 3] = [(0.0, 0.495), (0.2, 0.37), (0.3, 0.28)];

fn square(poisson: f64, friction: f64) -> Condensed {
    let mechanics = square::scene(64, poisson, friction).mechanics().unwrap();
    Condensed::new(&mechanics.bodies, &mechanics.contacts).unwrap()
}

fn plain(problem: &ContactProblem, max_sweeps: usize) -> Outcome {
    let settings = Settings::default().with_max_sweeps(max_sweeps);
    Variant::PLAIN.solve(problem, &settings).unwrap()
}

fn default(problem: &ContactProblem) -> Outcome {
    solve(problem, &Settings::default()).unwrap()
}

/// The sweep, linearised at a solution.
struct LinearSweep {
    /// Pressed contacts.
    pressed: Vec<usize>,
    /// From one change of their normal reaction to the next.
    map: Mat<f64>,
}

impl LinearSweep {
    /// `δt_T = ∓μ δt_N` where a contact slips, `δu_T = 0` where it sticks, then `δu_N = 0`.
    fn new(problem: &ContactProblem, outcome: &Outcome) -> Self {
        let (g, first) = (problem.compliance(), problem.offsets());
        let with = |wanted: &[ContactStatus]| -> Vec<usize> {
            let status = &outcome.verdict.status;
            (0..problem.contacts())
                .filter(|&contact| wanted.contains(&status[contact]))
                .collect()
        };
        let pressed = with(&[ContactStatus::Stick, ContactStatus::Slip]);
        let stick = with(&[ContactStatus::Stick]);
        let count = pressed.len();
        let mut friction = Mat::<f64>::zeros(problem.unknowns(), count);
        for (column, &contact) in pressed.iter().enumerate() {
            let tangent = first[contact] + 1;
            if outcome.verdict.status[contact] == ContactStatus::Slip {
                let sense = outcome.reaction[tangent].signum();
                friction[(tangent, column)] = -problem.friction()[contact] * sense;
            }
        }
        let block = |rows: &[usize], columns: &[usize]| {
            Mat::from_fn(rows.len(), columns.len(), |i, j| g[(rows[i], columns[j])])
        };
        let normals: Vec<usize> = pressed.iter().map(|&contact| first[contact]).collect();
        let tangents: Vec<usize> = stick.iter().map(|&contact| first[contact] + 1).collect();
        let slipping = g * &friction;
        let moved = Mat::from_fn(tangents.len(), count, |i, j| slipping[(tangents[i], j)]);
        let moved = moved + block(&tangents, &normals);
        let held = block(&tangents, &tangents).partial_piv_lu().solve(moved);
        for (row, &tangent) in tangents.iter().enumerate() {
            (0..count).for_each(|column| friction[(tangent, column)] = -held[(row, column)]);
        }
        let indented = g * &friction;
        let indented = Mat::from_fn(count, count, |i, j| -indented[(normals[i], j)]);
        let map = block(&normals, &normals).partial_piv_lu().solve(indented);
        Self { pressed, map }
    }

    /// Modulus of the leading eigenvalue, and the real part of its vector.
    fn leading(&self) -> (f64, Col<f64>) {
        let eigen = self.map.eigen().unwrap();
        let sizes = eigen.S().column_vector().iter().map(|value| value.norm());
        let (at, rate) = sizes
            .enumerate()
            .max_by(|a, b| a.1.total_cmp(&b.1))
            .unwrap();
        let vector = eigen.U().col(at).iter().map(|entry| entry.re).collect();
        (rate, vector)
    }
}

#[test]
fn the_leading_eigenvalue_of_a_sweep_is_near_friction_times_beta() {
    for (poisson, expected) in RATES {
        let condensed = square(poisson, 1.0);
        let outcome = default(condensed.problem());
        let (rate, _) = LinearSweep::new(condensed.problem(), &outcome).leading();
        assert!((rate - expected).abs() < 0.01, "ν = {poisson}: {rate}");
        let beta = (1.0 - 2.0 * poisson) / (2.0 * (1.0 - poisson));
        assert!(rate < beta && rate > 0.96 * beta, "ν = {poisson}: {rate}");
    }
}

#[test]
fn plain_sweeps_from_a_disturbed_solution_contract_at_that_rate() {
    for (poisson, expected) in RATES {
        let condensed = square(poisson, 1.0);
        let problem = condensed.problem();
        let solution = default(problem);
        let sweep = LinearSweep::new(problem, &solution);
        let (_, vector) = sweep.leading();
        let mut reaction = solution.reaction.clone();
        let normals = sweep.pressed.iter().map(|&i| problem.offsets()[i]);
        let normals: Vec<usize> = normals.collect();
        // So little that every contact keeps its state.
        let ratios = normals.iter().zip(vector.iter());
        let ratio = ratios.fold(0.0_f64, |most, (&n, v)| most.max((v / reaction[n]).abs()));
        for (&n, v) in normals.iter().zip(vector.iter()) {
            reaction[n] += 1e-3 / ratio * v;
        }
        let distance = |reaction: &[f64]| {
            let changes = normals.iter().map(|&n| reaction[n] - solution.reaction[n]);
            changes.map(|change| change * change).sum::<f64>().sqrt()
        };
        let (mut normal, mut friction) =
            (NormalHalfStep::new(problem), FrictionHalfStep::new(problem));
        let start = distance(&reaction);
        for _ in 0..4 {
            let mut cones = vec![Role::Cone; problem.contacts()];
            friction.solve(&mut reaction, &mut cones, 1e-12).unwrap();
            let mut cones = vec![Role::Cone; problem.contacts()];
            normal.solve(&mut reaction, &mut cones, 1e-12).unwrap();
        }
        let rate = (distance(&reaction) / start).powf(0.25);
        assert!((rate - expected).abs() < 0.01, "ν = {poisson}: {rate}");
    }
}

#[test]
fn plain_sweeps_from_a_cold_start_come_close_to_that_rate() {
    for (poisson, expected) in RATES {
        let condensed = square(poisson, 1.0);
        let outcome = plain(condensed.problem(), 30);
        let residuals = outcome.history.iter().map(|sweep| sweep.residual);
        let clean: Vec<f64> = residuals.filter(|r| (1e-7..1e-3).contains(r)).collect();
        // An even number of sweeps: the leading pair turns by a right angle in each.
        let sweeps = (clean.len() - 1) / 2 * 2;
        let rate = (clean[sweeps] / clean[0]).powf(1.0 / sweeps as f64);
        assert!(
            sweeps >= 4 && (rate - expected).abs() < 0.02,
            "ν = {poisson}: {rate}"
        );
    }
}

#[test]
fn plain_sweeps_diverge_at_high_friction_where_the_default_is_certified() {
    let condensed = square(0.2, 5.0);
    let sweeps = plain(condensed.problem(), 60);
    assert_eq!(sweeps.status, Status::NotConverged);
    assert!(sweeps.history.iter().all(|sweep| sweep.residual > 1e-2));
    // The leading eigenvalue says why; and the default does not care.
    let accelerated = default(condensed.problem());
    assert_eq!(accelerated.status, Status::Certified);
    assert!(accelerated.verdict.certificate.natural_map <= 1e-12);
    let (rate, _) = LinearSweep::new(condensed.problem(), &accelerated).leading();
    assert!(rate > 1.0, "{rate}");
}
