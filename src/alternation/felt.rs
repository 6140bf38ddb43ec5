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
        Outcome {
            motion: all(&outcome.motion),
            failure: outcome.failure.map(|failure| Failure {
                motion: all(&failure.motion),
                apparent: all(&failure.apparent),
                ..failure
            }),
            ..outcome
        }
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
