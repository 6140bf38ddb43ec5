//! One body condensed onto its interface, and the way back.
//!
//! ```text
//! (C6)  Lᵀ x = y + [0, L_cc⁻¹ t],  u = u_p + Q Pᵀ x           Q: the frames (C4), P: the ordering
//! ```
//!
//! One forward and one backward substitution serve the free displacement (C5) and the
//! recovered body together.

use std::sync::Arc;

use sprs::CsMat;

use super::engine::BodyFactor;
use super::factor::Factor;
use super::grounding::Grounding;
use super::load_case::{Action, Given};
use super::local_axes::Frames;
use super::ordering::Ordering;
use crate::body::{Dependence, Equation};
use crate::error::Error;

/// A body, the factor that joins it to its interface, and what acts on it; copies share the factor.
#[derive(Clone, Debug)]
pub struct CondensedBody {
    pub(super) factored: Arc<FactoredBody>,
    pub(super) action: Action,
}

/// What no load or support changes.
#[derive(Debug)]
pub(super) struct FactoredBody {
    pub(super) stiffness: CsMat<f64>,
    pub(super) dependence: Option<Dependence>,
    pub(super) frames: Frames,
    pub(super) ordering: Ordering,
    pub(super) factor: BodyFactor,
    pub(super) grounding: Grounding,
}

impl CondensedBody {
    /// A body under a load, in newton, and given displacements, in metre.
    pub(super) fn new(factored: FactoredBody, load: Vec<f64>, given: Given) -> Self {
        let action = factored.answer(load, given);
        let factored = Arc::new(factored);
        Self { factored, action }
    }

    /// What comes of another load, in newton, and of other given displacements at the same
    /// unknowns, in metre (C5): one pair of substitutions.
    pub(super) fn answer(&self, load: Vec<f64>, given: Given) -> Action {
        self.factored.answer(load, given)
    }

    pub(super) fn dependence(&self) -> Option<&Dependence> {
        self.factored.dependence.as_ref()
    }

    pub(super) fn grounding(&self) -> &Grounding {
        &self.factored.grounding
    }

    /// Stiffness K of the whole body in global axes, supports not applied, in N/m.
    #[must_use]
    pub fn stiffness(&self) -> &CsMat<f64> {
        &self.factored.stiffness
    }

    /// Load f per degree of freedom (`node · dimension + axis`), in newton.
    #[must_use]
    pub fn load(&self) -> &[f64] {
        &self.action.load
    }

    /// Prescribed displacement per degree of freedom, in metre.
    #[must_use]
    pub fn prescribed(&self) -> &[Option<f64>] {
        &self.action.prescribed
    }

    /// Equations between displacements (B16), and their right hand sides in metre; none where supports give
    /// single displacements only.
    #[must_use]
    pub fn equations(&self) -> (&[Equation], &[f64]) {
        let equations = self.dependence().map_or(&[][..], Dependence::equations);
        (equations, &self.action.values)
    }

    /// Displacement per degree of freedom under the load and a force per interface unknown (C6),
    /// moved by an amplitude per free mode (C3).
    pub(super) fn recover(&self, forces: &[f64], motion: &[f64]) -> Result<Vec<f64>, Error> {
        let displacement = self.factored.recover(&self.action, forces, motion);
        match self.factored.factor.failure() {
            None => Ok(displacement),
            Some(found) => Err(Error::NotAccepted {
                place: "recovery".to_owned(),
                found,
                accepted: "ranks that solve".to_owned(),
            }),
        }
    }
}

impl FactoredBody {
    /// (C5).
    fn answer(&self, load: Vec<f64>, given: Given) -> Action {
        let Given { prescribed, values } = given;
        let dependence = self.dependence.as_ref();
        let constant = dependence.map_or_else(Vec::new, |tied| tied.constant(&values));
        let mut half_solved = match constant.is_empty() {
            true => {
                let known = prescribed.iter().map(|value| value.unwrap_or(0.0));
                self.right_hand_side(&load, known)
            }
            false => self.right_hand_side(&load, constant.iter().copied()),
        };
        let free_displacement = match self.factor.plain() {
            None => self.factor.border_displacement(&mut half_solved),
            Some(factor) => {
                factor.forward(&mut half_solved);
                let mut solved = half_solved.clone();
                factor.backward_on_contact(&mut solved).to_vec()
            }
        };
        Action {
            load,
            prescribed,
            values,
            constant,
            half_solved,
            free_displacement,
        }
    }

    /// `P Qᵀ Tᵀ (f − K u_p)`, in newton.
    fn right_hand_side(&self, load: &[f64], known: impl Iterator<Item = f64>) -> Vec<f64> {
        let mut force = load.to_vec();
        for (column, value) in known.enumerate().filter(|(_, value)| *value != 0.0) {
            // K is symmetric: its row is its column.
            let entries = self.stiffness.indptr().outer_inds_sz(column);
            let rows = &self.stiffness.indices()[entries.clone()];
            for (&row, entry) in rows.iter().zip(&self.stiffness.data()[entries]) {
                force[row] -= entry * value;
            }
        }
        self.in_order(force)
    }

    /// `P Qᵀ Tᵀ f`.
    pub(super) fn in_order(&self, mut force: Vec<f64>) -> Vec<f64> {
        if let Some(tied) = &self.dependence {
            tied.gather(&mut force);
        }
        self.frames.turn_to_local(&mut force);
        self.ordering.dof.iter().map(|&dof| force[dof]).collect()
    }

    /// `T Q Pᵀ x`, in metre.
    pub(super) fn in_space(&self, solved: &[f64]) -> Vec<f64> {
        let mut displacement = vec![0.0; self.stiffness.rows()];
        for (&dof, &value) in self.ordering.dof.iter().zip(solved) {
            displacement[dof] = value;
        }
        self.frames.turn_to_global(&mut displacement);
        if let Some(tied) = &self.dependence {
            tied.spread(&mut displacement);
        }
        displacement
    }

    /// `y + [0, L_cc⁻¹ t]` of (C6).
    pub(super) fn half_solved_under(
        &self,
        factor: &Factor,
        half_solved: &[f64],
        forces: &[f64],
    ) -> Vec<f64> {
        let mut x = vec![0.0; self.ordering.unknowns()];
        x[self.ordering.ordinary()..].copy_from_slice(forces);
        factor.forward_on_contact(&mut x);
        for (x, y) in x.iter_mut().zip(half_solved) {
            *x += y;
        }
        x
    }

    /// x of (C6).
    pub(super) fn solve(&self, factor: &Factor, half_solved: &[f64], forces: &[f64]) -> Vec<f64> {
        let mut x = self.half_solved_under(factor, half_solved, forces);
        factor.backward(&mut x);
        x
    }

    /// (C6), or (C17) with a border.
    pub(super) fn recover(&self, action: &Action, forces: &[f64], motion: &[f64]) -> Vec<f64> {
        let x = match self.factor.plain() {
            None => self.factor.displacement_under(&action.half_solved, forces),
            Some(factor) => self.solve(factor, &action.half_solved, forces),
        };
        let mut displacement = self.in_space(&x);
        for (u, constant) in displacement.iter_mut().zip(&action.constant) {
            *u += constant;
        }
        for (k, amplitude) in motion.iter().enumerate() {
            for (u, mode) in displacement
                .iter_mut()
                .zip(self.grounding.modes.col_as_slice(k))
            {
                *u += amplitude * mode;
            }
        }
        for (u, prescribed) in displacement.iter_mut().zip(&action.prescribed) {
            // A held tangent is a global axis: nothing else moves the node along it.
            if let Some(value) = prescribed {
                *u = *value;
            }
        }
        displacement
    }
}
