//! Rigid motions that no contact feels are left out of a solve.
//!
//! ```text
//! (D14)  α = V α′,   R V = U Σ,   Vᵀ V = 1        without the directions in which Σ is round-off
//! ```
//!
//! A body between smooth parallel planes slides without any contact noticing. Along such a direction nothing
//! says where it stops, and what rounding has left of R would move it by anything. It is left out, so that
//! the motion found is the least one; a load along it leaves the problem as it is, for the proof that nothing
//! holds the bodies.

use faer::linalg::solvers::Svd;
use faer::{Mat, MatRef};

use super::iterate::Motion;
use super::{Failure, Outcome};
use crate::error::Error;
use crate::problem::{ContactProblem, Floating};

/// Part of the most that contacts feel of a motion below which they feel nothing.
const UNFELT: f64 = 1e-11;

/// Part of the loads on all motions below which one has none.
const UNLOADED: f64 = 1e-11;

/// The same contacts without the motions that none of them feels.
struct Felt {
    problem: ContactProblem,
    /// V, amplitudes per motion that is felt.
    motions: Mat<f64>,
    /// Vᵀ back: felt motions per amplitude.
    back: Mat<f64>,
}

/// Solves a problem without the motions that none of its contacts feels; `solve` gets it, and what turns
/// amplitudes of all motions into those of it.
pub(super) fn on_felt_motions(
    problem: &ContactProblem,
    solve: impl Fn(&ContactProblem, &dyn Fn(&[f64]) -> Vec<f64>) -> Result<Outcome, Error>,
) -> Result<Outcome, Error> {
    match problem
        .floating()
        .map(|floating| Felt::new(problem, floating))
    {
        Some(Some(felt)) => {
            let felt = felt?;
            let outcome = solve(&felt.problem, &|motion| times(felt.back.as_ref(), motion))?;
            Ok(felt.of_all(outcome))
        }
        _ => solve(problem, &<[f64]>::to_vec),
    }
}

impl Felt {
    /// None if the contacts feel all motions, or if a load acts on one that they do not feel.
    fn new(problem: &ContactProblem, floating: &Floating) -> Option<Result<Self, Error>> {
        let (modes, sizes) = (floating.modes(), floating.sizes());
        let scaled = Mat::from_fn(modes.nrows(), modes.ncols(), |i, k| {
            modes[(i, k)] / sizes[k]
        });
        if is_felt(&scaled) {
            return None;
        }
        let svd = Svd::new_thin(scaled.as_ref()).ok()?;
        let values = svd.S().column_vector();
        let count = values.iter().filter(|s| **s > UNFELT * values[0]).count();
        let loads: Vec<f64> = floating
            .load()
            .iter()
            .zip(sizes)
            .map(|(e, size)| e / size)
            .collect();
        let kept = svd.V().subcols(0, count);
        let on = times(kept.transpose(), &loads);
        let rest = loads.iter().zip(times(kept, &on)).map(|(e, felt)| e - felt);
        let size = |terms: &mut dyn Iterator<Item = f64>| terms.fold(0.0, f64::hypot);
        if count == 0 || size(&mut rest.into_iter()) > UNLOADED * size(&mut loads.iter().copied()) {
            return None;
        }
        let motions = Mat::from_fn(modes.ncols(), count, |k, j| kept[(k, j)] / sizes[k]);
        let back = Mat::from_fn(count, modes.ncols(), |j, k| kept[(k, j)] * sizes[k]);
        let felt = Floating::of_bodies(&scaled * kept, on);
        let problem = felt.and_then(|felt| problem.clone().float(felt));
        Some(problem.map(|problem| Self {
            problem,
            motions,
            back,
        }))
    }

    /// What was found, in amplitudes of all motions.
    fn of_all(&self, outcome: Outcome) -> Outcome {
        let all = |motion: &[f64]| times(self.motions.as_ref(), motion);
        let motion = self.moved(&outcome.motion, &outcome.motion_left_out);
        Outcome {
            motion: motion.amplitudes,
            motion_left_out: motion.left_out,
            failure: outcome.failure.map(|failure| Failure {
                motion: all(&failure.motion),
                apparent: all(&failure.apparent),
                ..failure
            }),
            ..outcome
        }
    }
}

impl Felt {
    /// `V (α′ + δ)` for amplitudes and what their rounding leaves out, without the rounding of products and sums.
    fn moved(&self, amplitudes: &[f64], left_out: &[f64]) -> Motion {
        let columns = self.motions.col_iter().zip(amplitudes.iter().zip(left_out));
        let rest = Motion::of(vec![0.0; self.motions.nrows()]);
        columns.fold(rest, |sum, (column, (amplitude, left_out))| {
            let entries = || column.iter();
            let whole: Vec<f64> = entries().map(|v| v * amplitude).collect();
            let terms = entries().zip(&whole);
            let lost = terms.map(|(v, product)| v.mul_add(*amplitude, -product) + v * left_out);
            sum.plus(&whole).plus(&lost.collect::<Vec<_>>())
        })
    }
}

/// Whether a glance shows that contacts feel all motions: by the squares of what they feel.
fn is_felt(modes: &Mat<f64>) -> bool {
    let dot = |i: usize, k: usize| {
        let pairs = modes.col_as_slice(i).iter().zip(modes.col_as_slice(k));
        pairs.map(|(a, b)| a * b).sum()
    };
    let squares: Mat<f64> = Mat::from_fn(modes.ncols(), modes.ncols(), dot);
    match squares.self_adjoint_eigenvalues(faer::Side::Lower) {
        Ok(values) => {
            let most = values.iter().copied().fold(0.0, f64::max);
            values.iter().all(|value| *value > 1e-12 * most)
        }
        Err(_) => true,
    }
}

fn times(matrix: MatRef<'_, f64>, vector: &[f64]) -> Vec<f64> {
    let mut product = vec![0.0; matrix.nrows()];
    for (column, factor) in matrix.col_iter().zip(vector) {
        for (sum, entry) in product.iter_mut().zip(column.iter()) {
            *sum += factor * entry;
        }
    }
    product
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use faer::mat;

    use super::*;
    use crate::alternation::{Settings, Status, solve};
    use crate::problem::Operator;

    #[test]
    fn a_motion_that_no_contact_feels_stays_zero_and_keeps_all_modes() {
        // One smooth contact that feels (1, 1)/√2 of two modes alone, pressed by 2: −3 − 0.5 · 2 + (α_1 + α_2)/√2 = 0.
        let operator = Operator::from_compliance(mat![[0.5]]).unwrap();
        let free = vec![-3.0];
        let problem = ContactProblem::new(&[0], vec![0.0], vec![0.0], free, operator).unwrap();
        let share = 0.5_f64.sqrt();
        let modes = mat![[share, share]];
        let floating = Floating::new(modes, vec![2.0 * share; 2]).unwrap();
        let problem = problem.float(floating).unwrap();
        let outcome = solve(&problem, &Settings::default()).unwrap();
        assert_eq!(outcome.status, Status::Certified);
        assert!((outcome.reaction[0] + 2.0).abs() < 1e-12);
        assert_eq!(
            (outcome.motion.len(), outcome.motion_left_out.len()),
            (2, 2)
        );
        assert!(
            (outcome.motion[0] - 4.0 * share).abs() < 1e-11,
            "{:?}",
            outcome.motion
        );
        assert!((outcome.motion[0] - outcome.motion[1]).abs() < 1e-14);
    }

    #[test]
    fn what_rounding_left_out_is_carried_back() {
        let (third, tiny) = (1.0 / 3.0, 1e-20);
        let felt = Felt {
            problem: ContactProblem::new(
                &[0],
                vec![0.0],
                vec![0.0],
                vec![0.0],
                Operator::from_compliance(mat![[1.0]]).unwrap(),
            )
            .unwrap(),
            motions: mat![[1.0], [third]],
            back: mat![[1.0, third]],
        };
        let moved = felt.moved(&[3.0], &[tiny]);
        assert_eq!(moved.amplitudes, [3.0, 1.0]);
        // A third of a double is less than a third by what the product has lost.
        let lost = third.mul_add(3.0, -1.0);
        assert_eq!(moved.left_out, [tiny, lost + third * tiny]);
    }
}
