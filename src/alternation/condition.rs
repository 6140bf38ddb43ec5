//! How much of a reaction's digits a residual stands for.
//!
//! ```text
//! (D7)  κ = λ_max(D^-½ G D^-½) · λ_max(D^½ S D^½),   D: diagonal of G
//! ```
//!
//! A residual of r leaves a reaction wrong by up to κ r. Both by a few power iterations: an
//! estimate from below.

use faer::linalg::matmul::matmul;
use faer::{Accum, Col, Mat, Par};

use crate::problem::ContactProblem;

/// Power iterations per matrix.
const ITERATIONS: usize = 8;

/// `S` that does not undo `G` on its own largest vector by this part is that of a shifted G.
const UNDONE: f64 = 0.5;

/// κ; infinite where G is singular.
pub(super) fn condition(problem: &ContactProblem) -> f64 {
    let compliance = problem.compliance();
    let Some(stiffness) = problem.operator().stiffness() else {
        return f64::INFINITY;
    };
    let size = problem.unknowns();
    let root = Col::from_fn(size, |k| compliance[(k, k)].sqrt());
    if root.iter().any(|root| *root <= 0.0) {
        return f64::INFINITY;
    }
    let inverse = Col::from_fn(size, |k| root[k].recip());
    let (softest, _) = largest(compliance, &inverse);
    let (stiffest, vector) = largest(stiffness, &root);
    let held = Col::from_fn(size, |k| root[k] * vector[k]);
    let back = times(compliance, &times(stiffness, &held));
    let lost = (&back - &held).norm_l2() > UNDONE * held.norm_l2();
    if lost {
        f64::INFINITY
    } else {
        softest * stiffest
    }
}

/// Largest eigenvalue of `D A D` for a diagonal D, and its vector.
fn largest(matrix: &Mat<f64>, diagonal: &Col<f64>) -> (f64, Col<f64>) {
    let scaled = |vector: &Col<f64>| Col::from_fn(vector.nrows(), |k| diagonal[k] * vector[k]);
    // Uneven enough not to be at right angles with what it should find.
    let mut vector = Col::from_fn(matrix.nrows(), |k| 1.0 + (2.4 * k as f64).sin());
    let mut value = 0.0;
    for _ in 0..ITERATIONS {
        let length = vector.norm_l2();
        if length == 0.0 || !length.is_finite() {
            break;
        }
        let unit = vector * faer::Scale(length.recip());
        vector = scaled(&times(matrix, &scaled(&unit)));
        value = vector.norm_l2();
    }
    (value, vector)
}

/// `A x`, on one thread: several would add up in their own order.
pub(super) fn times(matrix: &Mat<f64>, vector: &Col<f64>) -> Col<f64> {
    let mut product = Col::zeros(matrix.nrows());
    matmul(
        product.as_mut(),
        Accum::Replace,
        matrix,
        vector,
        1.0,
        Par::Seq,
    );
    product
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::problem::Operator;
    use faer::mat;

    fn of(compliance: Mat<f64>) -> f64 {
        let size = compliance.nrows();
        let operator = Operator::from_compliance(compliance).unwrap();
        let zero = vec![0.0; size];
        let problem =
            ContactProblem::new(&vec![0; size], zero.clone(), zero.clone(), zero, operator);
        condition(&problem.unwrap())
    }

    #[test]
    fn the_condition_does_not_see_units() {
        // [[1, c], [c, 1]] has the eigenvalues 1 ± c: κ = 1.99/0.01; scaled by 1e6 on one unknown, the same.
        let (c, k) = (0.99, 1e3);
        // Power iterations that stop early; half a percent of an order of magnitude.
        assert!((of(mat![[1.0, c], [c, 1.0]]) - 199.0).abs() < 1.0);
        assert!((of(mat![[1.0, c * k], [c * k, k * k]]) - 199.0).abs() < 1.0);
    }

    #[test]
    fn contacts_that_cannot_be_told_apart_have_none() {
        assert_eq!(of(mat![[1.0, 1.0], [1.0, 1.0]]), f64::INFINITY);
        assert_eq!(of(mat![[1.0, 0.0], [0.0, 0.0]]), f64::INFINITY);
    }
}
