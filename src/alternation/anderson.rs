//! Anderson acceleration of the sweep, seen as a map of the normal reaction.
//!
//! ```text
//! (D3)  x⁺ = x + f − (ΔX + ΔF) γ,    γ = argmin ‖f − ΔF γ‖,    f = F(x) − x
//! ```
//!
//! ΔX and ΔF hold the differences of the last iterates and residuals. Walker, Ni,
//! SIAM J. Numer. Anal. 49 (2011) 1715–1735.

use std::collections::VecDeque;

use faer::{Col, Mat};

/// Differences kept; fine meshes at high friction need ten (five suffice below).
const WINDOW: usize = 10;

/// Singular values below this, relative to the largest, carry no direction.
const RANK: f64 = 1e-8;

/// The memory of the acceleration.
#[derive(Debug, Default)]
pub struct Anderson {
    last: Option<(Col<f64>, Col<f64>)>,
    steps: VecDeque<(Col<f64>, Col<f64>)>,
}

impl Anderson {
    /// The next iterate, from an iterate `x` and its image `F(x)`.
    #[must_use]
    pub fn next(&mut self, x: &[f64], image: &[f64]) -> Vec<f64> {
        let x = Col::from_fn(x.len(), |i| x[i]);
        let residual = Col::from_fn(image.len(), |i| image[i] - x[i]);
        if let Some((last_x, last_residual)) = self.last.take() {
            self.steps
                .push_back((&x - last_x, &residual - last_residual));
            if self.steps.len() > WINDOW {
                self.steps.pop_front();
            }
        }
        let mut next = &x + &residual;
        for (weight, (step, change)) in self.weights(&residual).iter().zip(&self.steps) {
            next -= faer::Scale(*weight) * (step + change);
        }
        self.last = Some((x, residual));
        next.iter().copied().collect()
    }

    /// γ of (D3) by a truncated singular value decomposition of ΔF.
    fn weights(&self, residual: &Col<f64>) -> Vec<f64> {
        let columns = self.steps.len();
        let changes = Mat::from_fn(residual.nrows(), columns, |i, j| self.steps[j].1[i]);
        let Ok(svd) = changes.thin_svd() else {
            return vec![0.0; columns];
        };
        let values: Vec<f64> = svd.S().column_vector().iter().copied().collect();
        let cut = RANK * values.first().copied().unwrap_or(0.0);
        let projected = svd.U().transpose() * residual;
        let inverse = Col::from_fn(values.len(), |i| {
            if values[i] > cut {
                projected[i] / values[i]
            } else {
                0.0
            }
        });
        (svd.V() * inverse).iter().copied().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_linear_map_of_two_numbers_is_solved_in_three_steps() {
        // F(x) = (0.9 x₁ + 1, −2 x₂ + 3) has the fixed point (10, 1), though it diverges.
        let map = |x: &[f64]| vec![0.9 * x[0] + 1.0, -2.0 * x[1] + 3.0];
        let (mut anderson, mut x) = (Anderson::default(), vec![0.0, 0.0]);
        for _ in 0..3 {
            x = anderson.next(&x, &map(&x));
        }
        // Residuals change by 9 and by 0.1: ε times a condition of a hundred, and a digit for sums of ten.
        assert!((x[0] - 10.0).abs() < 1e-12 && (x[1] - 1.0).abs() < 1e-12);
    }
}
