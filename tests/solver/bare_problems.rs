//! Bare condensed problems from other codes, and one small enough to solve by hand.

use std::path::Path;

use approx::assert_abs_diff_eq;
use dpana::alternation::{Outcome, Settings, Status, solve};
use dpana::kkt::ContactStatus;
use dpana::problem::{ContactProblem, Operator};
use dpana::scene::BareProblem;
use dpana::study::Variant;
use faer::mat;

fn load(name: &str) -> BareProblem {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/data/discrete")
        .join(name);
    BareProblem::from_json(&std::fs::read_to_string(path).unwrap(), name).unwrap()
}

/// The accuracy that FCLIB, the public library of such problems, asks for.
const ACCURACY: f64 = 1e-8;

fn run(bare: &BareProblem) -> (ContactProblem, Outcome) {
    let problem = bare.to_problem().unwrap();
    let settings = Settings::default().with_tolerance(ACCURACY);
    let outcome = solve(&problem, &settings).unwrap();
    (problem, outcome)
}

/// Residual of the rigid-body problem in its own terms, written out here once more:
/// |(r − P(r − ρ (v + μ ‖v_T‖ e_N)))/ρ| / |q| with the projection P on Coulomb's cone.
fn rigid_body_residual(bare: &BareProblem, reaction: &[f64]) -> f64 {
    let (size, d) = (bare.q.len(), bare.dimension);
    let r: Vec<f64> = (0..size)
        .map(|i| {
            if i % d == 0 {
                -reaction[i]
            } else {
                reaction[i]
            }
        })
        .collect();
    let mut v = bare.q.clone();
    let mut diagonal = vec![0.0; size];
    for ((&i, &j), w) in bare.w_rows.iter().zip(&bare.w_cols).zip(&bare.w_values) {
        v[i] += w * r[j];
        if i == j {
            diagonal[i] += w;
        }
    }
    let norm = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
    let mut sum = 0.0;
    for (contact, mu) in bare.mu.iter().enumerate() {
        let block = contact * d..(contact + 1) * d;
        let rho = d as f64 / diagonal[block.clone()].iter().sum::<f64>();
        let (r, v) = (&r[block.clone()], &v[block]);
        let shifted = v[0] + mu * norm(&v[1..]);
        let mut z: Vec<f64> = r.iter().zip(v).map(|(r, v)| r - rho * v).collect();
        z[0] = r[0] - rho * shifted;
        let (n, t) = (z[0], norm(&z[1..]));
        if t <= mu * n {
        } else if mu * t <= -n {
            z.fill(0.0);
        } else {
            let along = (n + mu * t) / (1.0 + mu * mu);
            z[0] = along;
            z[1..].iter_mut().for_each(|x| *x *= mu * along / t);
        }
        sum += r
            .iter()
            .zip(&z)
            .map(|(r, z)| ((r - z) / rho).powi(2))
            .sum::<f64>();
    }
    sum.sqrt() / norm(&bare.q)
}

/// Elastic and rigid-body problems alike, four of them with rank-deficient operators.
#[test]
fn every_public_problem_is_certified_and_passes_a_second_residual() {
    for name in [
        "Box_Stacks-i0122-82-5.json",
        "Confeti-ex03-Fc3D-SBM.json",
        "FC3D_Example1.json",
        "FrictionContactProblem00374.json",
        "NESpheres_30_1.json",
        "fem_float_N4_mu0.4_dt10.json",
        "fem_static_N4_mu0.8.json",
    ] {
        let bare = load(name);
        let (_, outcome) = run(&bare);
        let second = rigid_body_residual(&bare, &outcome.reaction);
        assert_eq!(outcome.status, Status::Certified, "{name}");
        assert!(second <= ACCURACY, "{name}: {second:e}");
        // Whatever the prediction found, the default ran cone programs.
        assert!(
            outcome.work.sweeps >= 1 && outcome.work.cone_iterations >= 1,
            "{name}"
        );
    }
}

/// `K = [[2, −1], [−1, 1]]`, `G = K⁻¹ = [[1, 1], [1, 2]]` in a convention whose normal
/// opens; ours turns the sign of the normal. μ = 1/2.
fn one_contact(free: [f64; 2]) -> (ContactProblem, Outcome) {
    let operator = Operator::from_compliance(mat![[1.0, -1.0], [-1.0, 2.0]]).unwrap();
    let problem = ContactProblem::new(&[1], vec![0.5], vec![0.0], free.to_vec(), operator).unwrap();
    let outcome = solve(&problem, &Settings::default()).unwrap();
    (problem, outcome)
}

#[test]
fn one_contact_slips_as_by_hand() {
    // K u = f + r, f = (−1, 0.75): û = K⁻¹ f = (−0.25, 0.5); slips with u = (0, 0.5), r = (0.5, −0.25).
    let (_, outcome) = one_contact([0.25, 0.5]);
    assert_eq!(outcome.verdict.status, [ContactStatus::Slip]);
    assert_abs_diff_eq!(outcome.reaction[0], -0.5, epsilon = 1e-12);
    assert_abs_diff_eq!(outcome.reaction[1], -0.25, epsilon = 1e-12);
    assert_abs_diff_eq!(outcome.verdict.displacement[1], 0.5, epsilon = 1e-12);
}

#[test]
fn one_contact_opens_as_by_hand() {
    // f = (−1, 1.25): û = (0.25, 1.5) opens.
    let (_, outcome) = one_contact([-0.25, 1.5]);
    assert_eq!(outcome.verdict.status, [ContactStatus::Open]);
    assert_eq!(outcome.reaction, [0.0, 0.0]);
    assert_eq!((outcome.work.sweeps, outcome.work.cone_iterations), (0, 0));
}

#[test]
fn the_three_loops_agree() {
    let problem = load("fem_static_N4_mu0.8.json").to_problem().unwrap();
    let run = |variant: Variant, tolerance, max_sweeps| {
        let settings = Settings::default()
            .with_tolerance(tolerance)
            .with_max_sweeps(max_sweeps);
        let outcome = variant.solve(&problem, &settings).unwrap();
        assert_eq!(outcome.status, Status::Certified, "{variant:?}");
        outcome.reaction
    };
    let default = solve(&problem, &Settings::default()).unwrap();
    assert_eq!(default.status, Status::Certified);
    let default = default.reaction;
    let norm = |x: &mut dyn Iterator<Item = f64>| x.fold(0.0, |norm: f64, x| norm.hypot(x));
    for (variant, tolerance, max_sweeps) in
        [(Variant::PLAIN, 1e-5, 200), (Variant::Nsgs, 1e-8, 20_000)]
    {
        let other = run(variant, tolerance, max_sweeps);
        let off = norm(&mut default.iter().zip(&other).map(|(a, b)| a - b));
        // The eigenvalues of W lie between 5.4 and 122.5: a residual may be 23 times as large in t,
        // and twice that where friction follows the pressure.
        let size = norm(&mut default.iter().copied());
        assert!(
            off < 50.0 * tolerance * size,
            "{variant:?}: {off:e} of {size:e}"
        );
    }
}
