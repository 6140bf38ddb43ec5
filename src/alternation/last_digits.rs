//! Whether an answer hangs on the last digits of G.
//!
//! ```text
//! (D12)  G'_ij = (1 ± ε) G_ij,   G' = G'ᵀ      ε: the last digit of a double
//! ```
//!
//! One Newton step (D4) from the same state with G and with G': where their reactions differ, nothing but round-off
//! resists them, and no method can answer.

use super::finish::{Finish, Springs};
use super::iterate::Iterate;
use super::run::Run;
use crate::kkt::Judge;
use crate::problem::{ContactProblem, Operator};
use faer::Mat;

/// Reactions that differ by more than this part are two answers.
const PART: f64 = 1e-3;

impl Run<'_> {
    /// (D12) at the best state.
    pub(super) fn hangs_on_last_digits(&self) -> bool {
        let shaken = shaken(self.problem);
        let answers = shaken.as_ref().and_then(|shaken| {
            let as_it_is = answer(self.problem, &self.best)?;
            Some((as_it_is, answer(shaken, &self.best)?))
        });
        answers.is_none_or(|(one, other)| {
            let (mut apart, mut size) = (0.0_f64, 0.0_f64);
            for (a, b) in one.iter().zip(&other) {
                (apart, size) = (apart.hypot(a - b), size.hypot(*a));
            }
            apart > PART * size
        })
    }
}

/// The problem with other last digits; `None` if its operator has no such neighbour.
fn shaken(problem: &ContactProblem) -> Option<ContactProblem> {
    let g = problem.compliance();
    let shaken = Mat::from_fn(g.nrows(), g.ncols(), |i, j| {
        let (low, high) = (i.min(j), i.max(j));
        // Some up, some down, as if at random.
        let up = (low * high + 31 * low + 17 * high).is_multiple_of(2);
        g[(i, j)] * (1.0 + if up { f64::EPSILON } else { -f64::EPSILON })
    });
    let operator = Operator::from_bodies(shaken).ok()?;
    Some(problem.with_operator(operator))
}

/// The reaction after a Newton step from a state; `None` if its matrix is singular.
fn answer(problem: &ContactProblem, state: &Iterate) -> Option<Vec<f64>> {
    let judge = Judge::new(problem);
    let state = Iterate::new(&judge, state.reaction.clone(), state.motion.clone());
    let mut finish = Finish::new(problem)?;
    let springs = Springs {
        softness: 0.0,
        anchor: &state.reaction,
    };
    let point = finish.point(&state);
    let next = finish.step(&point, &point.beyond, springs)?;
    Some(next.reaction)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use faer::mat;

    use super::*;
    use crate::alternation::iterate::Motion;

    #[test]
    fn a_step_hangs_on_the_last_digits_of_a_matrix_that_has_no_more() {
        // Two smooth contacts that both press; [[1, c], [c, 1]] has the eigenvalues 1 ± c.
        let of = |c: f64| {
            let operator = Operator::from_bodies(mat![[1.0, c], [c, 1.0]]).unwrap();
            let (zero, free) = (vec![0.0; 2], vec![2.0, 2.5]);
            let problem = ContactProblem::new(&[0, 0], zero.clone(), zero, free, operator).unwrap();
            let judge = Judge::new(&problem);
            let state = Iterate::new(&judge, vec![-1.0, -1.0], Motion::default());
            let shaken = shaken(&problem).unwrap();
            let (one, other) = (answer(&problem, &state), answer(&shaken, &state));
            one.zip(other).map(|(a, b)| ((a[0] - b[0]) / a[0]).abs())
        };
        // t = −½ (4.5/(1 + c) ∓ 0.5/(1 − c)): ε/(1 − c) of it is the last digits'.
        assert!(of(0.5).unwrap() < 1e-15);
        let found = of(1.0 - 1e-9).unwrap();
        assert!((1e-8..1e-6).contains(&found), "{found:e}");
        assert!(of(1.0).is_none_or(|part| part > PART));
    }
}
