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

use super::factor::Factor;

impl Factor {
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
