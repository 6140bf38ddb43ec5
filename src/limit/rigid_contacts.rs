//! Rigid bodies that contact alone must hold, as plain data.

use faer::{Mat, MatRef};

use super::cone_projection::{CoulombCones, slip};
use crate::error::{Error, check_finite, check_length};
use crate::problem::velocity_basis::{VelocityBasis, product};
use crate::problem::{ContactProblem, Floating};

/// Velocities below this part of the largest are none.
const MOVES: f64 = 1e-4;

/// The contacts of floating bodies: which reactions can answer a load on the rigid motions?
///
/// Contact `i` owns a block of `1 + tangents[i]` unknowns, normal first. Column `k` of the
/// modes is the relative displacement of every contact, in its own axes, under a unit of
/// rigid motion `k`: positive along the normal closes the gap. A load is given by its
/// virtual work `e_k` on each mode. Reactions `t` are in equilibrium with it if
///
/// ```text
/// (H4)  Rᵀ t + e = 0
/// ```
///
/// Any unit of length and any basis of the motions serves; a mode that moves no contact is best
/// scaled to displace its body as far as the others do.
#[derive(Clone, Debug)]
pub struct RigidContacts {
    offsets: Vec<usize>,
    friction: Vec<f64>,
    modes: Mat<f64>,
    pub(super) basis: VelocityBasis,
}

impl RigidContacts {
    /// Checks and joins the parts: `tangents` (0 to 2) and `friction` μ ≥ 0 per contact, modes R.
    ///
    /// # Errors
    ///
    /// A length that does not fit, a NaN or infinity, a negative coefficient, more than two tangents.
    pub fn new(tangents: &[usize], friction: Vec<f64>, modes: Mat<f64>) -> Result<Self, Error> {
        check_length("friction", tangents.len(), friction.len())?;
        ContactProblem::check_friction(&friction)?;
        let offsets = ContactProblem::block_offsets(tangents)?;
        check_length("modes", offsets[tangents.len()], modes.nrows())?;
        for k in 0..modes.ncols() {
            check_finite(&format!("modes column {k}"), modes.col_as_slice(k))?;
        }
        let basis = VelocityBasis::new(modes.as_ref()).ok_or_else(|| Error::NotAccepted {
            place: "modes".to_owned(),
            found: "a matrix whose singular values cannot be computed".to_owned(),
            accepted: "entries of comparable size".to_owned(),
        })?;
        Ok(Self {
            offsets,
            friction,
            modes,
            basis,
        })
    }

    /// The contacts of a problem whose bodies float; `None` if the modes have no basis.
    #[must_use]
    pub fn of(problem: &ContactProblem, floating: &Floating) -> Option<Self> {
        Some(Self {
            offsets: problem.offsets().to_vec(),
            friction: problem.friction().to_vec(),
            modes: floating.modes().to_owned(),
            basis: VelocityBasis::new(floating.modes())?,
        })
    }

    /// Number of contacts.
    #[must_use]
    pub fn contacts(&self) -> usize {
        self.friction.len()
    }

    /// First unknown of each contact, and the number of unknowns at the end.
    #[must_use]
    pub fn offsets(&self) -> &[usize] {
        &self.offsets
    }

    /// Coefficient of friction per contact.
    #[must_use]
    pub fn friction(&self) -> &[f64] {
        &self.friction
    }

    /// The modes R.
    #[must_use]
    pub fn modes(&self) -> MatRef<'_, f64> {
        self.modes.as_ref()
    }

    /// The same contacts with every coefficient of friction multiplied.
    pub(super) fn with_friction_times(&self, multiple: f64) -> Self {
        let friction = self.friction.iter().map(|mu| multiple * mu).collect();
        Self {
            friction,
            ..self.clone()
        }
    }

    /// Coulomb's cones of the contacts.
    pub(super) fn cones(&self) -> CoulombCones<'_> {
        CoulombCones {
            offsets: &self.offsets,
            friction: &self.friction,
        }
    }

    /// Velocity `R α` of every contact unknown under a rigid motion.
    #[must_use]
    pub fn velocity(&self, motion: &[f64]) -> Vec<f64> {
        product(self.modes.as_ref(), motion)
    }

    /// The speed that counts in a velocity `v = R α`: that of the fastest sliding contact
    /// where one slides, else that of the fastest opening one; zero if none moves.
    pub(super) fn speed(&self, motion: &[f64]) -> f64 {
        let velocity = &self.velocity(motion);
        let (sliding, opening) = self.sliding_and_opening(motion, velocity);
        let fastest = |contacts: &[usize], speed: fn(&[f64]) -> f64| {
            let blocks = contacts
                .iter()
                .map(|&contact| self.block(velocity, contact));
            blocks.map(speed).fold(0.0, f64::max)
        };
        if sliding.is_empty() {
            fastest(&opening, |block| block[0].abs())
        } else {
            fastest(&sliding, |block| slip(&block[1..]))
        }
    }

    /// Contacts that slide (they open no faster than friction lets them), and contacts that open.
    ///
    /// What a contact does is measured by the whole motion: smooth contacts that slide see nothing of it.
    pub(super) fn sliding_and_opening(
        &self,
        motion: &[f64],
        velocity: &[f64],
    ) -> (Vec<usize>, Vec<usize>) {
        let whole = self.basis.largest_amplitude(motion);
        let nothing = MOVES * velocity.iter().fold(whole, |m, v| m.max(v.abs()));
        let (mut sliding, mut opening) = (Vec::new(), Vec::new());
        for (contact, mu) in self.friction.iter().enumerate() {
            let block = self.block(velocity, contact);
            let slip = slip(&block[1..]);
            if block[0] + mu * slip < -nothing * (1.0 + mu) {
                opening.push(contact);
            } else if slip > nothing {
                sliding.push(contact);
            }
        }
        (sliding, opening)
    }

    fn block<'a>(&self, velocity: &'a [f64], contact: usize) -> &'a [f64] {
        &velocity[self.offsets[contact]..self.offsets[contact + 1]]
    }

    /// Refuses a load that does not belong to the modes.
    pub(super) fn check_load(&self, place: &str, load: &[f64]) -> Result<(), Error> {
        check_length(place, self.modes.ncols(), load.len())?;
        check_finite(place, load)
    }
}
