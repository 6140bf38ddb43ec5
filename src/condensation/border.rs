//! A body condensed onto what its contacts see of it, where that is much less than its nodes there.
//!
//! ```text
//!         ordinary  seen
//!        [  K'       Bᵀ  ]   [ L         ] [ Lᵀ   Wᵀ   ]
//! (C17)  [  B        C   ] = [ W    L_cc ] [      L_ccᵀ ]
//!
//!        G = B K'⁻¹ Bᵀ = W Wᵀ,   v̂ = B K'⁻¹ f = W y,   Lᵀ u = y + Wᵀ t
//! ```
//!
//! The rows of B (C11) border the stiffness, a row per contact unknown that the body takes part in.
//! Contacts of quadratic facets and of mortar pairs move with several nodes each: with the nodes
//! last (C2), the dense block has all of these, with the border it has as many rows as there are
//! contact unknowns, and the nodes are eliminated like any others. C is a diagonal that keeps the
//! whole positive definite; nothing of what is read depends on it.

use faer::linalg::matmul::triangular::{self, BlockStructure};
use faer::{Accum, Mat, get_global_parallelism};

use super::factor::Factor;

impl Factor {
    /// `G = W Wᵀ` (C17), in m/N; both triangles are filled.
    pub(crate) fn border_compliance(&self) -> Mat<f64> {
        let size = self.contact_unknowns();
        let ordinary = self.unknowns() - size;
        let mut compliance = Mat::zeros(size, size);
        for index in self.ordinary_supernodes() {
            let supernode = self.supernode(index);
            let (rows, width) = (
                supernode.rows_from(ordinary),
                supernode.width_before(ordinary),
            );
            if width == 0 || rows.is_empty() {
                continue;
            }
            let block = supernode.lowest(rows.len(), width);
            let mut product = Mat::<f64>::zeros(rows.len(), rows.len());
            triangular::matmul(
                product.as_mut(),
                BlockStructure::TriangularLower,
                Accum::Replace,
                block,
                BlockStructure::Rectangular,
                block.transpose(),
                BlockStructure::Rectangular,
                1.0,
                get_global_parallelism(),
            );
            for (j, &column) in rows.iter().enumerate() {
                let sums = compliance.col_as_slice_mut(column);
                for (&row, entry) in rows[j..].iter().zip(&product.col_as_slice(j)[j..]) {
                    sums[row] += entry;
                }
            }
        }
        for j in 0..size {
            for i in 0..j {
                compliance[(i, j)] = compliance[(j, i)];
            }
        }
        compliance
    }

    /// `v̂ = W y` (C17) in metre; `force` in newton becomes y.
    pub(crate) fn border_displacement(&self, force: &mut Vec<f64>) -> Vec<f64> {
        force.resize(self.unknowns(), 0.0);
        self.forward_before_contact(force);
        let ordinary = self.unknowns() - self.contact_unknowns();
        force.split_off(ordinary).iter().map(|v| -v).collect()
    }

    /// `Lᵀ u = y + Wᵀ t` (C17), in metre; t in newton per row of the border.
    pub(crate) fn displacement_under(&self, half_solved: &[f64], forces: &[f64]) -> Vec<f64> {
        let mut x = half_solved.to_vec();
        x.extend(forces.iter().map(|t| -t));
        self.backward_before_contact(&mut x);
        x
    }
}
