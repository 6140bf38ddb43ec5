//! The matrix of a Newton step, factored, and how much of a reaction's digits a residual stands for.
//!
//! ```text
//! (D7)  κ = ‖A‖₁ ‖A⁻¹‖      A: matrix of (D4), scaled
//! ```
//!
//! A residual of r leaves a reaction wrong by up to κ r. The norm of the inverse by a few power
//! iterations: an estimate from below.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::lu::partial_pivoting::{factor, solve};
use faer::linalg::matmul::matmul;
use faer::perm::PermRef;
use faer::{Accum, Col, Mat, Par};

/// Power iterations.
const ITERATIONS: usize = 8;

/// A matrix as LU, and its largest column sum; on one thread, as several would round in their own way.
pub(super) struct Factored {
    /// L below the diagonal, U from it on.
    lu: Mat<f64>,
    /// The row of the matrix that each row of LU was, and the way back.
    rows: [Vec<usize>; 2],
    size: f64,
}

impl Factored {
    /// In place of the matrix.
    pub(super) fn new(matrix: Mat<f64>) -> Self {
        let sums = matrix.col_iter().map(|column| column.norm_l1());
        let size = sums.fold(0.0, f64::max);
        let count = matrix.nrows();
        let mut lu = matrix;
        let mut rows = [vec![0; count], vec![0; count]];
        let [forward, back] = &mut rows;
        let room =
            factor::lu_in_place_scratch::<usize, f64>(count, count, Par::Seq, Default::default());
        factor::lu_in_place(
            lu.as_mut(),
            forward,
            back,
            Par::Seq,
            MemStack::new(&mut MemBuffer::new(room)),
            Default::default(),
        );
        Self { size, lu, rows }
    }

    pub(super) fn solve(&self, right: &Col<f64>) -> Col<f64> {
        let (mut solution, count) = (right.clone(), self.lu.nrows());
        let room = solve::solve_in_place_scratch::<usize, f64>(count, 1, Par::Seq);
        solve::solve_in_place(
            self.lu.as_ref(),
            self.lu.as_ref(),
            PermRef::new_checked(&self.rows[0], &self.rows[1], count),
            solution.as_mat_mut(),
            Par::Seq,
            MemStack::new(&mut MemBuffer::new(room)),
        );
        solution
    }

    /// Sign of the determinant.
    pub(super) fn sign(&self) -> f64 {
        let pivots = self.lu.diagonal().column_vector();
        let odd = is_odd(&self.rows[0]);
        let sign = |negative: bool| if negative { -1.0 } else { 1.0 };
        pivots.iter().map(|pivot| pivot.signum()).product::<f64>() * sign(odd)
    }

    /// Products of two numbers that it took.
    pub(super) fn products(&self) -> f64 {
        (self.lu.nrows() as f64).powi(3) / 3.0
    }

    /// κ; infinite where the matrix is singular.
    pub(super) fn condition(&self) -> f64 {
        // Uneven enough not to be at right angles with what it should find.
        let rows = self.lu.nrows();
        let mut vector = Col::from_fn(rows, |k| 1.0 + (2.4 * k as f64).sin());
        let mut value = 0.0;
        for _ in 0..ITERATIONS {
            let length = vector.norm_l2();
            if length == 0.0 || !length.is_finite() {
                break;
            }
            vector = self.solve(&(vector * faer::Scale(length.recip())));
            value = vector.norm_l2();
        }
        match value.is_nan() {
            true => f64::INFINITY,
            false => self.size * value,
        }
    }
}

/// Whether a permutation takes an odd number of exchanges.
fn is_odd(permutation: &[usize]) -> bool {
    let (mut seen, mut cycles) = (vec![false; permutation.len()], 0);
    for start in 0..permutation.len() {
        cycles += usize::from(!seen[start]);
        let mut at = start;
        while !seen[at] {
            seen[at] = true;
            at = permutation[at];
        }
    }
    (permutation.len() - cycles) % 2 == 1
}

/// `A x`, on one thread: several would add up in their own order.
pub(crate) fn times(matrix: &Mat<f64>, vector: &Col<f64>) -> Col<f64> {
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
    use super::*;
    use faer::mat;

    #[test]
    fn the_condition_is_that_of_the_sums_of_columns_and_the_inverse() {
        // [[1, c], [c, 1]] has columns of 1 + c and the least eigenvalue 1 − c.
        let found = Factored::new(mat![[1.0, 0.99], [0.99, 1.0]]).condition();
        // Power iterations that stop early; half a percent of an order of magnitude.
        assert!((found - 199.0).abs() < 1.0, "{found}");
    }

    #[test]
    fn the_sign_is_that_of_the_determinant() {
        // A shift of three rows is even, an exchange of two is odd; and two pivots of four are negative.
        let of = |matrix: Mat<f64>| Factored::new(matrix).sign();
        assert_eq!(
            of(mat![[0.0, 2.0, 0.0], [0.0, 0.0, 3.0], [4.0, 0.0, 0.0]]),
            1.0
        );
        assert_eq!(of(mat![[0.0, 2.0], [3.0, 1.0]]), -1.0);
        assert_eq!(of(mat![[-1.0, 0.0], [0.0, 2.0]]), -1.0);
        assert_eq!(of(mat![[-1.0, 0.0], [0.0, -2.0]]), 1.0);
    }

    #[test]
    fn contacts_that_cannot_be_told_apart_have_none() {
        let found = Factored::new(mat![[1.0, 1.0], [1.0, 1.0]]).condition();
        assert_eq!(found, f64::INFINITY);
    }
}
