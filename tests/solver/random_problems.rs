//! Random bare problems: the judge certifies them, and the answer does not depend on
//! the order of contacts, the choice of tangents or the units.

use dpana::alternation::{Outcome, Settings, Status, solve};
use dpana::kkt::Judge;
use dpana::problem::{ContactProblem, Operator};
use faer::Mat;
use proptest::prelude::*;

/// A problem in plain numbers, to be varied.
#[derive(Clone, Debug)]
pub(crate) struct Numbers {
    pub(crate) tangents: usize,
    pub(crate) friction: Vec<f64>,
    pub(crate) gap: Vec<f64>,
    pub(crate) free: Vec<f64>,
    pub(crate) compliance: Mat<f64>,
}

impl Numbers {
    fn block(&self) -> usize {
        1 + self.tangents
    }

    pub(crate) fn solve(&self) -> (ContactProblem, Outcome) {
        self.solve_to(Settings::default().tolerance)
    }

    pub(crate) fn solve_to(&self, tolerance: f64) -> (ContactProblem, Outcome) {
        let settings = Settings::default().with_tolerance(tolerance);
        let tangents = vec![self.tangents; self.gap.len()];
        let operator = Operator::from_compliance(self.compliance.clone()).unwrap();
        let (friction, gap, free) = (self.friction.clone(), self.gap.clone(), self.free.clone());
        let problem = ContactProblem::new(&tangents, friction, gap, free, operator).unwrap();
        let outcome = solve(&problem, &settings).unwrap();
        (problem, outcome)
    }

    fn reaction(&self) -> Vec<f64> {
        let (_, outcome) = self.solve();
        assert_eq!(outcome.status, Status::Certified);
        outcome.reaction
    }
}

/// `G = AᵀA/n + shift · 1` with entries of A in [−1, 1]: strongly coupled where the shift is small.
pub(crate) fn numbers(
    contacts: std::ops::RangeInclusive<usize>,
    tangents: std::ops::RangeInclusive<usize>,
    friction: f64,
    shift: std::ops::Range<f64>,
) -> impl Strategy<Value = Numbers> {
    (contacts, tangents, shift).prop_flat_map(move |(count, tangents, shift)| {
        let size = count * (1 + tangents);
        let signed = -1.0..1.0_f64;
        (
            prop::collection::vec(0.0..friction, count),
            prop::collection::vec(-0.3..0.3_f64, count),
            prop::collection::vec(signed.clone(), size),
            prop::collection::vec(signed, size * size),
        )
            .prop_map(move |(friction, gap, free, entries)| {
                let a = Mat::from_fn(size, size, |i, j| entries[i * size + j]);
                let product = a.transpose() * &a;
                let compliance = Mat::from_fn(size, size, |i, j| {
                    let (i, j) = (i.min(j), i.max(j));
                    product[(i, j)] / size as f64 + if i == j { shift } else { 0.0 }
                });
                Numbers {
                    tangents,
                    friction,
                    gap,
                    free,
                    compliance,
                }
            })
    })
}

/// Two answers, each certified to 1e-12 of ‖t‖, which is √60 times its largest entry at most, under a G of condition
/// (4/3 + shift)/shift ≤ 4 and friction up to 1/2, which may double that.
const SAME: f64 = 2e-10;

fn assert_close(found: &[f64], expected: &[f64]) -> Result<(), TestCaseError> {
    let scale = expected
        .iter()
        .fold(0.0_f64, |largest, t| largest.max(t.abs()));
    for (a, b) in found.iter().zip(expected) {
        prop_assert!((a - b).abs() <= SAME * scale, "{found:?}\n{expected:?}");
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 128, failure_persistence: None, ..ProptestConfig::default() })]

    /// Friction up to 2 and near-singular operators: certified, and by a judge of its own.
    #[test]
    fn the_judge_certifies_what_the_solver_calls_certified(numbers in numbers(1..=40, 1..=2, 2.0, 1e-4..0.5)) {
        let (problem, outcome) = numbers.solve();
        let residual = Judge::new(&problem).measure(&outcome.reaction).certificate.natural_map;
        prop_assert_eq!(residual, outcome.verdict.certificate.natural_map);
        prop_assert_eq!(outcome.status, Status::Certified, "residual {}", residual);
        prop_assert!(residual <= Settings::default().tolerance);
        // A sweep or two and a short finish: a silent slowdown fails here.
        prop_assert!(outcome.work.sweeps <= 5 && outcome.work.newton_steps <= 40, "{:?}", outcome.work);
    }

    /// However much friction: in the plane a definite operator has a state, and it is found.
    #[test]
    fn rough_contacts_in_the_plane_are_certified(numbers in numbers(1..=30, 1..=1, 100.0, 0.01..0.5)) {
        let (problem, outcome) = numbers.solve();
        let residual = Judge::new(&problem).measure(&outcome.reaction).certificate.natural_map;
        prop_assert_eq!(outcome.status, Status::Certified, "residual {}, {:?}", residual, outcome.shortfall);
        prop_assert!(residual <= 1e-12);
        prop_assert!(outcome.work.sweeps <= 3, "{:?}", outcome.work);
    }

    /// The certificate is honest: moving one reaction by a part in a thousand loses it.
    #[test]
    fn the_judge_rejects_a_disturbed_answer(numbers in numbers(1..=20, 1..=2, 1.0, 0.1..0.5), pick in any::<prop::sample::Index>()) {
        let (problem, outcome) = numbers.solve();
        let mut reaction = outcome.reaction;
        let scale = reaction.iter().fold(0.0_f64, |largest, t| largest.max(t.abs()));
        prop_assume!(scale > 0.0);
        reaction[pick.index(problem.unknowns())] += 1e-3 * scale;
        // 1e-3 · least over largest eigenvalue of G, 0.1/1.8, of ‖t‖ ≤ √60 · scale: 7e-6.
        prop_assert!(Judge::new(&problem).measure(&reaction).certificate.natural_map > 1e-6);
    }

    #[test]
    fn the_order_of_contacts_does_not_matter(numbers in numbers(2..=20, 1..=2, 0.5, 0.5..1.0)) {
        let (count, block) = (numbers.gap.len(), numbers.block());
        let from = |unknown: usize| (count - 1 - unknown / block) * block + unknown % block;
        let mut turned = numbers.clone();
        turned.friction.reverse();
        turned.gap.reverse();
        turned.free = (0..numbers.free.len()).map(|i| numbers.free[from(i)]).collect();
        turned.compliance = Mat::from_fn(turned.free.len(), turned.free.len(), |i, j| {
            numbers.compliance[(from(i), from(j))]
        });
        let found = turned.reaction();
        let back: Vec<f64> = (0..found.len()).map(|i| found[from(i)]).collect();
        assert_close(&back, &numbers.reaction())?;
    }

    #[test]
    fn the_choice_of_tangents_does_not_matter(numbers in numbers(1..=15, 1..=2, 0.5, 0.5..1.0), angle in 0.0..6.2_f64) {
        // In 2D the tangent can only change its sign.
        let size = numbers.free.len();
        let turn = Mat::from_fn(size, size, |i, j| {
            let (block, a, b) = (numbers.block(), i % numbers.block(), j % numbers.block());
            match (a, b) {
                _ if i / block != j / block => 0.0,
                (0, 0) => 1.0,
                (1, 1) if block == 2 => -1.0,
                (1, 1) | (2, 2) => angle.cos(),
                (1, 2) => -angle.sin(),
                (2, 1) => angle.sin(),
                _ => 0.0,
            }
        });
        let mut turned = numbers.clone();
        let compliance = &turn * &numbers.compliance * turn.transpose();
        turned.compliance = Mat::from_fn(size, size, |i, j| compliance[(i.min(j), i.max(j))]);
        let times = |matrix: &Mat<f64>, x: &[f64]| -> Vec<f64> {
            (0..size).map(|i| (0..size).map(|j| matrix[(i, j)] * x[j]).sum()).collect()
        };
        turned.free = times(&turn, &numbers.free);
        assert_close(&turned.reaction(), &times(&turn, &numbers.reaction()))?;
    }

    /// Lengths × a and forces × b: reactions × b, in the same number of sweeps.
    #[test]
    fn units_do_not_matter(numbers in numbers(1..=20, 1..=2, 0.5, 0.5..1.0), a in -9..=9_i32, b in -9..=9_i32) {
        let (length, force) = (10_f64.powi(a), 10_f64.powi(b));
        let mut scaled = numbers.clone();
        scaled.gap.iter_mut().chain(&mut scaled.free).for_each(|x| *x *= length);
        let size = numbers.free.len();
        scaled.compliance = Mat::from_fn(size, size, |i, j| numbers.compliance[(i, j)] * length / force);
        let (_, expected) = numbers.solve();
        let (_, found) = scaled.solve();
        let back: Vec<f64> = found.reaction.iter().map(|t| t / force).collect();
        assert_close(&back, &expected.reaction)?;
        prop_assert!(found.work.sweeps.abs_diff(expected.work.sweeps) <= 1);
    }
}
