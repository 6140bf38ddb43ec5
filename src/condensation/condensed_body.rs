//! One body condensed onto its interface, and the way back.
//!
//! ```text
//! (C5)  L y = P Qᵀ (f − K u_p),   v̂ = L_cc⁻ᵀ y_c             u_p: prescribed displacement
//! (C6)  Lᵀ x = y + [0, L_cc⁻¹ t],  u = u_p + Q Pᵀ x           Q: the frames (C4), P: the ordering
//! ```
//!
//! One forward and one backward substitution serve the free displacement and the
//! recovered body together.

use sprs::CsMat;

use super::factor::Factor;
use super::frames::Frames;
use super::grounding::Grounding;
use super::ordering::Ordering;

/// A body and the factor that joins it to its interface.
#[derive(Debug)]
pub struct CondensedBody {
    pub(super) stiffness: CsMat<f64>,
    pub(super) load: Vec<f64>,
    pub(super) prescribed: Vec<Option<f64>>,
    pub(super) frames: Frames,
    pub(super) ordering: Ordering,
    pub(super) factor: Factor,
    /// `y` of (C5).
    pub(super) half_solved: Vec<f64>,
    pub(super) grounding: Grounding,
}

impl CondensedBody {
    /// Puts the body under a load, in newton, and given displacements at the same unknowns as
    /// before, in metre; returns `v̂` of (C5), in metre, for one pair of substitutions.
    pub(super) fn act(&mut self, load: Vec<f64>, prescribed: Vec<Option<f64>>) -> Vec<f64> {
        (self.load, self.prescribed) = (load, prescribed);
        self.half_solved = self.right_hand_side();
        self.factor.forward(&mut self.half_solved);
        let mut solved = self.half_solved.clone();
        self.factor.backward_on_contact(&mut solved).to_vec()
    }

    /// `P Qᵀ (f − K u_p)`, in newton.
    fn right_hand_side(&self) -> Vec<f64> {
        let mut force = self.load.clone();
        for (column, value) in self.prescribed.iter().enumerate() {
            let Some(value) = value.filter(|&value| value != 0.0) else {
                continue;
            };
            // K is symmetric: its row is its column.
            let entries = self.stiffness.indptr().outer_inds_sz(column);
            let rows = &self.stiffness.indices()[entries.clone()];
            for (&row, entry) in rows.iter().zip(&self.stiffness.data()[entries]) {
                force[row] -= entry * value;
            }
        }
        self.frames.turn_to_local(&mut force);
        self.ordering.dof.iter().map(|&dof| force[dof]).collect()
    }

    /// Stiffness K of the whole body in global axes, supports not applied, in N/m.
    #[must_use]
    pub fn stiffness(&self) -> &CsMat<f64> {
        &self.stiffness
    }

    /// Load f per degree of freedom (`node · dimension + axis`), in newton.
    #[must_use]
    pub fn load(&self) -> &[f64] {
        &self.load
    }

    /// Prescribed displacement per degree of freedom, in metre.
    #[must_use]
    pub fn prescribed(&self) -> &[Option<f64>] {
        &self.prescribed
    }

    /// Displacement per degree of freedom under the load and a force per interface unknown (C6),
    /// moved by an amplitude per free mode (C3).
    pub(super) fn recover(&self, forces: &[f64], motion: &[f64]) -> Vec<f64> {
        let ordinary = self.ordering.ordinary();
        let mut x = vec![0.0; self.ordering.unknowns()];
        x[ordinary..].copy_from_slice(forces);
        self.factor.forward_on_contact(&mut x);
        for (x, y) in x.iter_mut().zip(&self.half_solved) {
            *x += y;
        }
        self.factor.backward(&mut x);

        let mut displacement = vec![0.0; self.load.len()];
        for (&dof, &value) in self.ordering.dof.iter().zip(&x) {
            displacement[dof] = value;
        }
        self.frames.turn_to_global(&mut displacement);
        for (k, amplitude) in motion.iter().enumerate() {
            for (u, mode) in displacement
                .iter_mut()
                .zip(self.grounding.modes.col_as_slice(k))
            {
                *u += amplitude * mode;
            }
        }
        for (u, prescribed) in displacement.iter_mut().zip(&self.prescribed) {
            // A held tangent is a global axis: nothing else moves the node along it.
            if let Some(value) = prescribed {
                *u = *value;
            }
        }
        displacement
    }
}
