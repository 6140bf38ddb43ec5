//! Free variables of a quadratic program, eliminated with a dense Cholesky factor.
//!
//! ```text
//! min over x_F free:  ½ x·P x + q·x       P_FF = L Lᵀ,   W = L⁻¹ P_FC,   y = L⁻¹ q_F
//!
//! P_CC ← P_CC − Wᵀ W        q_C ← q_C − Wᵀ y        x_F = −L⁻ᵀ (y + W x_C)
//! ```

use faer::linalg::matmul::matmul;
use faer::linalg::matmul::triangular::{self, BlockStructure};
use faer::linalg::triangular_solve::{
    solve_lower_triangular_in_place, solve_upper_triangular_in_place,
};
use faer::{Accum, Col, Mat, MatRef, Par, Side, get_global_parallelism};

/// The split of a quadratic form into free variables F and variables in cones C.
pub(crate) struct Elimination {
    lower: Mat<f64>,
    coupling: Mat<f64>,
    /// `P_CC − Wᵀ W`; only the upper triangle is valid.
    pub(crate) reduced: Mat<f64>,
}

impl Elimination {
    /// Splits `form`; `None` if P_FF is not positive definite.
    pub(crate) fn new(form: MatRef<'_, f64>, free: &[usize], cone: &[usize]) -> Option<Self> {
        let par = get_global_parallelism();
        let mut reduced = gather(form, cone, cone);
        let mut coupling = gather(form, free, cone);
        let lower = gather(form, free, free)
            .llt(Side::Lower)
            .ok()?
            .L()
            .to_owned();
        solve_lower_triangular_in_place(lower.as_ref(), coupling.as_mut(), par);
        triangular::matmul(
            reduced.as_mut(),
            BlockStructure::TriangularUpper,
            Accum::Add,
            coupling.transpose(),
            BlockStructure::Rectangular,
            coupling.as_ref(),
            BlockStructure::Rectangular,
            -1.0,
            par,
        );
        Some(Self {
            lower,
            coupling,
            reduced,
        })
    }

    /// `(y, q_C − Wᵀ y)` for the linear terms of the free and the cone variables.
    pub(crate) fn reduce(&self, free: &[f64], cone: &[f64]) -> (Col<f64>, Vec<f64>) {
        let mut y = Col::from_fn(free.len(), |i| free[i]);
        solve_lower_triangular_in_place(self.lower.as_ref(), y.as_mat_mut(), Par::Seq);
        let mut linear = Col::from_fn(cone.len(), |i| cone[i]);
        matmul(
            linear.as_mut(),
            Accum::Add,
            self.coupling.transpose(),
            y.as_ref(),
            -1.0,
            Par::Seq,
        );
        (y, linear.iter().copied().collect())
    }

    /// The free variables that belong to cone variables `x`.
    pub(crate) fn recover(&self, y: &Col<f64>, x: &[f64]) -> Vec<f64> {
        let x = Col::from_fn(x.len(), |i| x[i]);
        let mut free = -y;
        matmul(
            free.as_mut(),
            Accum::Add,
            &self.coupling,
            x.as_ref(),
            -1.0,
            Par::Seq,
        );
        solve_upper_triangular_in_place(self.lower.transpose(), free.as_mat_mut(), Par::Seq);
        free.iter().copied().collect()
    }
}

/// The entries of `form` at the given rows and columns.
pub(crate) fn gather(form: MatRef<'_, f64>, rows: &[usize], columns: &[usize]) -> Mat<f64> {
    Mat::from_fn(rows.len(), columns.len(), |i, j| {
        form[(rows[i], columns[j])]
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use faer::mat;

    #[test]
    fn the_minimum_over_all_is_the_minimum_over_what_is_left() {
        // P x + q = 0 with x = (1, −2, 3): q = −P x = (−1, 1, −4).
        let form = mat![
            [2.0, 1.0, 0.333_333_333_333_333_3],
            [1.0, 3.0, 1.0],
            [0.333_333_333_333_333_3, 1.0, 2.0]
        ];
        let x = [1.0, -2.0, 3.0];
        let q: Vec<f64> = (0..3)
            .map(|i| -(0..3).map(|j| form[(i, j)] * x[j]).sum::<f64>())
            .collect();
        let split = Elimination::new(form.as_ref(), &[0, 2], &[1]).unwrap();
        let (y, linear) = split.reduce(&[q[0], q[2]], &[q[1]]);
        let left = -linear[0] / split.reduced[(0, 0)];
        assert!((left - x[1]).abs() < 1e-14);
        let free = split.recover(&y, &[left]);
        assert!((free[0] - x[0]).abs() < 1e-14 && (free[1] - x[2]).abs() < 1e-14);
    }

    #[test]
    fn a_form_that_is_singular_on_the_free_variables_is_not_split() {
        let form = mat![[1.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        assert!(Elimination::new(form.as_ref(), &[0, 1], &[2]).is_none());
    }
}
