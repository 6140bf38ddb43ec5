//! Contact stiffness: how the load grows with the approach.
//!
//! ```text
//! (S16)  dP/dδ = P/δ of a flat punch without friction that has the contact's shape
//! ```
//!
//! At its edge a contact carries nothing, so that what it grows by does not count (Barber, Proc. R. Soc.
//! Lond. A 459 (2003) 53–66); what friction adds is left out.

use super::operator::Surroundings;
use super::outcome::{HalfSpaceOutcome, HalfSpaceState};
use super::problem::{HalfSpaceProblem, Press};
use crate::error::Error;

/// Residual of the punch.
const TOLERANCE: f64 = 1e-8;

impl HalfSpaceProblem {
    /// dP/dδ (S16), in N/m, at a solved state; without bound where all of a periodic surface touches. For
    /// the price of one more solve.
    ///
    /// # Errors
    ///
    /// [`Error::Length`] if the outcome is not of the problem's cells.
    pub fn normal_stiffness(&self, outcome: &HalfSpaceOutcome) -> Result<f64, Error> {
        let normal = &outcome.state.reaction[0];
        let load: f64 = normal.iter().map(|t| -t).sum();
        if load <= 0.0 {
            return Ok(0.0);
        }
        let periodic = self.operator.surroundings() == Surroundings::Periodic;
        if periodic && normal.iter().all(|t| *t < 0.0) {
            return Ok(f64::INFINITY);
        }
        // More than the load on a single cell would sink it by.
        let far = 10.0 * self.operator.diagonal()[0] * load;
        let gap = normal.iter().map(|t| if *t < 0.0 { 0.0 } else { far });
        let gap = gap.collect();
        let punch = Self::new(self.operator.clone(), gap, &[0.0], Press::Load(load))?;
        let none = vec![0.0; normal.len()];
        let near = HalfSpaceState {
            reaction: [normal.clone(), none.clone(), none],
            approach: 0.0,
            shift: [0.0; 2],
        };
        Ok(load / punch.solve_from(&near, TOLERANCE)?.state.approach)
    }
}
