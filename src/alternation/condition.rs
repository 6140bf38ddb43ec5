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
use faer::linalg::triangular_solve::solve_unit_lower_triangular_in_place;
use faer::perm::PermRef;
use faer::{Accum, Col, Mat, MatMut, MatRef, Par};
use rayon::prelude::*;

use crate::processor::add_column;

/// Power iterations.
const ITERATIONS: usize = 8;

/// A pivot, or a singular value, below this part of the largest is round-off.
const SINGULAR: f64 = 1e-14;

/// Part of a right side that the least solution may leave.
const SOLVED: f64 = 1e-10;

/// Unknowns up to which a singular matrix is decomposed.
const SMALL: usize = 600;

/// Unknowns beyond which it pays to divide the elimination among threads,
const LARGE: usize = 1024;

/// columns that are then eliminated at a time, and columns behind them of which a thread takes so many.
const PANEL: usize = 128;
const TAKEN: usize = 512;

/// A matrix as LU, and its largest column sum; every number on one thread, as several would round in their own way.
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
        let mut was: Vec<usize> = (0..count).collect();
        let panel = if count > LARGE { PANEL } else { count };
        for start in (0..count).step_by(panel.max(1)) {
            let width = panel.min(count - start);
            let (before, mut panel, after) = split(lu.as_mut(), start, width);
            let found = eliminate(panel.as_mut());
            let moved: Vec<usize> = found[0].iter().map(|at| was[start + at]).collect();
            was[start..].copy_from_slice(&moved);
            exchange(before, &found);
            let chunks = after.par_col_chunks_mut(TAKEN);
            chunks.for_each(|columns| update(columns, panel.as_ref(), &found));
        }
        let mut back = vec![0; count];
        was.iter().enumerate().for_each(|(at, &row)| back[row] = at);
        Self {
            size,
            lu,
            rows: [was, back],
        }
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

    /// Whether some direction moves nothing but for round-off.
    pub(super) fn is_singular(&self) -> bool {
        let pivots = self.lu.diagonal().column_vector();
        let sizes = pivots.iter().map(|pivot| pivot.abs());
        let (least, largest) = sizes.fold((f64::INFINITY, 0.0), |(least, most), size| {
            (f64::min(least, size), f64::max(most, size))
        });
        least <= SINGULAR * largest
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
        condition(self.size, self.lu.nrows(), |right| self.solve(right))
    }
}

/// κ of a matrix of that largest column sum, by solving with it; infinite where it is singular.
pub(super) fn condition(size: f64, rows: usize, solve: impl Fn(&Col<f64>) -> Col<f64>) -> f64 {
    // Uneven enough not to be at right angles with what it should find.
    let mut vector = Col::from_fn(rows, |k| 1.0 + (2.4 * k as f64).sin());
    let mut value = 0.0;
    for _ in 0..ITERATIONS {
        let length = vector.norm_l2();
        if length == 0.0 || !length.is_finite() {
            break;
        }
        vector = solve(&(vector * faer::Scale(length.recip())));
        value = vector.norm_l2();
    }
    match value.is_nan() {
        true => f64::INFINITY,
        false => size * value,
    }
}

/// The rows from `start` on, of all columns before, those of a panel, and all after.
fn split(
    matrix: MatMut<'_, f64>,
    start: usize,
    width: usize,
) -> (MatMut<'_, f64>, MatMut<'_, f64>, MatMut<'_, f64>) {
    let rows = matrix.nrows() - start;
    let below = matrix.subrows_mut(start, rows);
    let (before, rest) = below.split_at_col_mut(start);
    let (panel, after) = rest.split_at_col_mut(width);
    (before, panel, after)
}

/// LU of a panel in its place; the row that each of its rows was, and the way back.
fn eliminate(panel: MatMut<'_, f64>) -> [Vec<usize>; 2] {
    let (height, width) = (panel.nrows(), panel.ncols());
    let mut rows = [vec![0; height], vec![0; height]];
    let [forward, back] = &mut rows;
    let room =
        factor::lu_in_place_scratch::<usize, f64>(height, width, Par::Seq, Default::default());
    factor::lu_in_place(
        panel,
        forward,
        back,
        Par::Seq,
        MemStack::new(&mut MemBuffer::new(room)),
        Default::default(),
    );
    rows
}

/// Rows of other columns in the order of a panel's; only those that moved are touched.
fn exchange(columns: MatMut<'_, f64>, rows: &[Vec<usize>; 2]) {
    let moved = rows[0].iter().enumerate().filter(|(to, from)| to != *from);
    let moved: Vec<(usize, usize)> = moved.map(|(to, &from)| (to, from)).collect();
    let mut held = vec![0.0; moved.len()];
    for mut column in columns.col_iter_mut() {
        for (held, &(_, from)) in held.iter_mut().zip(&moved) {
            *held = column[from];
        }
        for (held, &(to, _)) in held.iter().zip(&moved) {
            column[to] = *held;
        }
    }
}

/// What a panel's elimination makes of columns after it.
fn update(mut columns: MatMut<'_, f64>, panel: MatRef<'_, f64>, rows: &[Vec<usize>; 2]) {
    exchange(columns.as_mut(), rows);
    let (above, below) = panel.split_at_row(panel.ncols());
    let (mut top, rest) = columns.split_at_row_mut(panel.ncols());
    solve_unit_lower_triangular_in_place(above, top.as_mut(), Par::Seq);
    matmul(rest, Accum::Add, below, top.as_ref(), -1.0, Par::Seq);
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

/// The least solution of a singular system, by singular values; none of a large one, or where there is none.
pub(super) fn least_solution(matrix: &Mat<f64>, right: &Col<f64>) -> Option<Col<f64>> {
    if matrix.nrows() > SMALL {
        return None;
    }
    let decomposed = matrix.svd().ok()?;
    let mut along = decomposed.U().transpose() * right;
    let values = decomposed.S().column_vector();
    for (along, value) in along.iter_mut().zip(values.iter()) {
        let felt = *value > SINGULAR * values[0];
        *along = if felt { *along / value } else { 0.0 };
    }
    let found = decomposed.V() * along;
    let left = (times(matrix, &found) - right).norm_l2();
    (left <= SOLVED * right.norm_l2()).then_some(found)
}

/// Adds so much of each column. Rows are divided among threads, each of which adds them up in their order.
pub(super) fn add_columns(sum: &mut [f64], matrix: &Mat<f64>, parts: &[(usize, f64)]) {
    let chunks = sum.par_chunks_mut(TAKEN).enumerate();
    chunks.for_each(|(chunk, sum)| {
        for &(column, part) in parts {
            let entries = &matrix.col_as_slice(column)[chunk * TAKEN..];
            add_column(sum, part, entries);
        }
    });
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
    #![allow(clippy::unwrap_used)]
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
    fn of_all_solutions_of_a_singular_system_the_least_is_found() {
        // x + y = 2 twice, and a direction that moves nothing.
        let matrix = mat![[1.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0, 0.0, 0.0]];
        let right = Col::from_fn(3, |k| [2.0, 2.0, 0.0][k]);
        assert!(Factored::new(matrix.clone()).is_singular());
        let found = least_solution(&matrix, &right).unwrap();
        assert!((found[0] - 1.0).abs() + (found[1] - 1.0).abs() + found[2].abs() < 1e-14);
        assert!(least_solution(&matrix, &Col::from_fn(3, |k| k as f64)).is_none());
        assert!(!Factored::new(mat![[1.0, 1.0], [1.0, 1.0 + 1e-12]]).is_singular());
    }

    #[test]
    fn panels_solve_what_one_elimination_would_whatever_the_order_of_rows() {
        // Nine panels; the largest entry of column j is in row 7 j mod n.
        let count = LARGE + 5;
        let entry = |i: usize, j: usize| ((i * 31 + j * 17) % 23) as f64 / 23.0;
        let matrix = Mat::from_fn(count, count, |i, j| {
            entry(i, j) + if i == 7 * j % count { 1e3 } else { 0.0 }
        });
        let expected = Col::from_fn(count, |k| (k as f64).sin());
        let right = times(&matrix, &expected);
        let found = Factored::new(matrix).solve(&right);
        assert!((found - expected).norm_max() < 1e-13);
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
