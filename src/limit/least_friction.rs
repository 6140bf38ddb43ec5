//! The least friction that still holds a load.
//!
//! ```text
//! (H7)  min k ≥ 0   s.t.  Rᵀ t + e = 0,  t_N ≤ 0,  ‖t_T,i‖ ≤ −k μ_i t_N,i
//! ```
//!
//! More friction only widens the cones, so there is one threshold; it is found by bisection
//! on (H5), whose answers at both ends are the evidence.

use super::equilibrium::Equilibrium;
use super::rigid_contacts::RigidContacts;
use crate::error::Error;

/// Coefficients beyond this count as no friction that a surface could have.
const HIGHEST: f64 = 1e3;

/// Width of the last bracket, relative to k.
const WIDTH: f64 = 1e-8;

/// How much friction a load takes.
#[derive(Clone, Debug, PartialEq)]
pub enum LeastFriction {
    /// The load is held from a multiple of the coefficients on.
    Multiple {
        /// Least k, to 1e-8 relative, from above; zero if the load needs no friction.
        multiple: f64,
        /// Admissible reactions at k, in newton per contact unknown.
        reaction: Vec<f64>,
        /// Rigid motion that begins just below k; `None` at zero.
        motion: Option<Vec<f64>>,
    },
    /// No friction holds the load (coefficients beyond 1000 were not tried).
    Never {
        /// Rigid motion that no contact resists, as in [`Equilibrium::Impossible`].
        motion: Vec<f64>,
        /// Power of the load on it, in newton.
        excess: f64,
    },
    /// Too badly conditioned to tell.
    Undecided,
}

impl RigidContacts {
    /// The least multiple of the coefficients of friction at which `load` is held; with coefficients of
    /// one it is the least uniform coefficient.
    ///
    /// # Errors
    ///
    /// A load of the wrong length, or one that is not finite.
    pub fn least_friction(&self, load: &[f64]) -> Result<LeastFriction, Error> {
        self.check_load("load", load)?;
        let largest = self.friction().iter().copied().fold(0.0, f64::max);
        if let Equilibrium::Held { reaction } = self.at_multiple(0.0, load) {
            return Ok(LeastFriction::Multiple {
                multiple: 0.0,
                reaction,
                motion: None,
            });
        }
        let mut above = if largest > 0.0 { largest.recip() } else { 0.0 };
        let (mut below, mut motion) = (0.0, None);
        let mut reaction = loop {
            match self.at_multiple(above, load) {
                Equilibrium::Held { reaction } => break reaction,
                Equilibrium::Impossible { motion, excess }
                    if above * largest >= HIGHEST || largest == 0.0 =>
                {
                    return Ok(LeastFriction::Never { motion, excess });
                }
                Equilibrium::Impossible { motion: found, .. } => motion = Some(found),
                Equilibrium::Undecided { .. } if above * largest >= HIGHEST => {
                    return Ok(LeastFriction::Undecided);
                }
                Equilibrium::Undecided { .. } => {}
            }
            below = above;
            above *= 4.0;
        };
        while above - below > WIDTH * above {
            let between = 0.5 * (below + above);
            match self.at_multiple(between, load) {
                Equilibrium::Held { reaction: found } => (above, reaction) = (between, found),
                Equilibrium::Impossible { motion: found, .. } => {
                    (below, motion) = (between, Some(found));
                }
                Equilibrium::Undecided { .. } => below = between,
            }
        }
        Ok(LeastFriction::Multiple {
            multiple: above,
            reaction,
            motion,
        })
    }

    fn at_multiple(&self, multiple: f64, load: &[f64]) -> Equilibrium {
        self.with_friction_times(multiple).decide(load)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::limit::tests::blocks::{Blocks, incline};

    fn multiple(found: &LeastFriction) -> f64 {
        match found {
            LeastFriction::Multiple { multiple, .. } => *multiple,
            other => unreachable!("{other:?}"),
        }
    }

    #[test]
    fn a_block_on_a_slope_takes_the_tangent_of_its_angle() {
        for dimension in [2, 3] {
            for (mu, slope) in [(1.0, 0.3), (0.5, 1e-4), (0.01, 1.7)] {
                let (contacts, weight) = incline(dimension, mu, slope, [4.0, 1.0]);
                let found = multiple(&contacts.least_friction(&weight).unwrap());
                // On a slope of 1e-4, `HELD` is 1e-7 of the friction that is looked for.
                assert!((found * mu / slope - 1.0).abs() < 1e-6, "{found}");
            }
        }
    }

    #[test]
    fn a_block_on_the_level_takes_none_and_one_that_tips_no_finite_one() {
        let (contacts, weight) = incline(3, 0.5, 0.0, [1.0, 1.0]);
        assert_eq!(multiple(&contacts.least_friction(&weight).unwrap()), 0.0);
        let (contacts, weight) = incline(3, 0.5, 0.6, [1.0, 2.0]);
        let found = contacts.least_friction(&weight).unwrap();
        assert!(matches!(found, LeastFriction::Never { .. }), "{found:?}");
    }

    #[test]
    fn smooth_contacts_stay_smooth_at_every_multiple() {
        let pad = Blocks::pad(2, 0.0);
        let side = pad.load(&[(0, [1.0, -2.0, 0.0], [0.0; 3])]);
        let found = pad.contacts().least_friction(&side).unwrap();
        assert!(matches!(found, LeastFriction::Never { .. }), "{found:?}");
    }
}
