//! The least of a quadratic function under linear conditions, some of which follow from others.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// Part of the conditions' matrix that is added to its diagonal, as some follow from others.
const ADDED: f64 = 1e-8;

/// Steps at most that take what is added away again, and how far: slow are those of rings that are wide beside their
/// cells.
const STEPS: usize = 200;
const CLOSE: f64 = 1e-12;

/// The least `½ cᵀ H c − gᵀ c` with `A c = d`, H in blocks: `c = H⁻¹ (g + Aᵀ λ)`, `A H⁻¹ Aᵀ λ = d − A H⁻¹ g`.
pub(super) struct Least {
    factors: Vec<Cholesky<f64, Dyn>>,
    schur: Cholesky<f64, Dyn>,
    pull: DVector<f64>,
    pub(super) matrix: DMatrix<f64>,
    pub(super) right: DVector<f64>,
    /// Rows of tractions, edge by edge.
    pub(super) outer: Vec<Outer>,
}

/// A row that holds a traction.
pub(super) struct Outer {
    pub(super) row: usize,
    /// Coefficient along the edge.
    pub(super) along: usize,
    /// Component.
    pub(super) axis: usize,
    /// What the row was divided by.
    pub(super) size: f64,
}

impl Least {
    pub(super) fn new(
        weights: &[DMatrix<f64>],
        pull: DVector<f64>,
        matrix: DMatrix<f64>,
        right: DVector<f64>,
        outer: Vec<Outer>,
    ) -> Option<Self> {
        let factors = weights.iter().map(|block| block.clone().cholesky());
        let factors: Vec<_> = factors.collect::<Option<_>>()?;
        let mut half = matrix.transpose();
        let mut first = 0;
        for factor in &factors {
            let lower = factor.l();
            let size = lower.nrows();
            lower.solve_lower_triangular_mut(&mut half.rows_mut(first, size));
            first += size;
        }
        let mut schur = half.transpose() * &half;
        let added = ADDED * schur.diagonal().amax();
        (0..schur.nrows()).for_each(|k| schur[(k, k)] += added);
        Some(Self {
            factors,
            schur: schur.cholesky()?,
            pull,
            matrix,
            right,
            outer,
        })
    }

    /// `H⁻¹ force`.
    fn free(&self, force: &DVector<f64>) -> DVector<f64> {
        let mut moved = force.clone();
        let mut first = 0;
        for factor in &self.factors {
            let size = factor.l_dirty().nrows();
            factor.solve_mut(&mut moved.rows_mut(first, size));
            first += size;
        }
        moved
    }

    /// By steps in λ.
    pub(super) fn closest(&self) -> DVector<f64> {
        let mut force = self.pull.clone();
        let mut found = self.free(&force);
        for _ in 0..STEPS {
            let off = &self.right - &self.matrix * &found;
            if off.amax() <= CLOSE * found.amax().max(self.right.amax()) {
                break;
            }
            force += self.matrix.transpose() * self.schur.solve(&off);
            found = self.free(&force);
        }
        found
    }

    /// Second and first derivative of the least along changes of d, the columns.
    pub(super) fn along(&self, changes: &DMatrix<f64>) -> (DMatrix<f64>, DVector<f64>) {
        let off = &self.right - &self.matrix * self.free(&self.pull);
        let bend = changes.transpose() * self.schur.solve(changes);
        let slope = changes.transpose() * self.schur.solve(&off);
        (bend, slope)
    }
}
