//! Rolling: contacts that flow through the contact zone.
//!
//! ```text
//! (S14)  w(x) = u_T(x) − u_T⁻(x + h e_x) − h (ξ_x − φ y,  ξ_y + φ x)        one step: the zone rolls one
//!                                                                        cell, h, on along x
//! ```
//!
//! u_T⁻ is the tangential displacement of the step before: what stood one cell ahead is here now. Steps
//! from rest end in the steady state after a few lengths of the contact zone (CONTACT's transient
//! rolling: Vollebregt, User guide; Kalker, Three-Dimensional Elastic Bodies in Rolling Contact, 1990).
//!
//! Totals are of first order in h. Kalker's creep coefficients of a circle (ν = 0.25) come within 1 % as the limit that grids of
//! 22² and 44² cells name together (`cargo test --test half_space kalker`).

use super::operator::Surroundings;
use super::outcome::HalfSpaceOutcome;
use super::problem::HalfSpaceProblem;
use crate::error::{Error, check_finite};

/// Change of the tangential forces in one step, relative to them, that counts as none.
const STEADY: f64 = 1e-6;

/// Lengths of the grid after which rolling gives up: the force of a line contact, whose displacements
/// reach far, takes ten half-widths and more to settle.
const CROSSINGS: usize = 20;

/// Residual of the steps on the way.
const ON_THE_WAY: f64 = 1e-8;

/// Rigid motion of the half-space past the other side, per length rolled; the zone rolls along x.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Creepage {
    /// ξ: relative velocity of the other side along x and y over the rolling speed.
    pub along: [f64; 2],
    /// φ: relative spin about the normal over the rolling speed, in 1/m.
    pub spin: f64,
}

impl HalfSpaceProblem {
    /// Rolls cell by cell until the tangential forces do not change, or the grid has been crossed many
    /// times; then solves the last step to the full tolerance. Gives the last step and the number of
    /// steps.
    ///
    /// # Errors
    ///
    /// [`Error::NotFinite`] for the creepage, [`Error::NotAccepted`] for a periodic grid.
    pub fn roll(&self, creepage: Creepage) -> Result<(HalfSpaceOutcome, usize), Error> {
        let [x, y] = creepage.along;
        check_finite("creepage", &[x, y, creepage.spin])?;
        if self.operator.surroundings() == Surroundings::Periodic {
            return Err(Error::NotAccepted {
                place: "surroundings".to_owned(),
                found: "rolling on a periodic half-space".to_owned(),
                accepted: "a free half-space or a half-plane".to_owned(),
            });
        }
        let most = CROSSINGS * self.operator.grid().cells[0];
        let mut step = self.clone().after(self.flow(creepage, None))?;
        let mut outcome = step.solve_to(ON_THE_WAY)?;
        for number in 2..=most {
            let before = step.moved_so_far(&outcome);
            step = self.clone().after(self.flow(creepage, Some(&before)))?;
            let next = step.solve_from(&outcome.state, ON_THE_WAY)?;
            let change = change(&outcome, &next);
            outcome = next;
            if change <= STEADY || number == most {
                return Ok((step.solve_from(&outcome.state, 1e-10)?, number));
            }
        }
        Ok((outcome, 1))
    }

    /// Reference of (S14): displacement of the step before, one cell ahead, and the rigid slip.
    fn flow(&self, creepage: Creepage, before: Option<&[Vec<f64>; 2]>) -> [Vec<f64>; 2] {
        let grid = self.operator.grid();
        let rolled = grid.spacing[0];
        [0, 1].map(|axis| {
            let of = |cell: usize| {
                let [x, y] = grid.position(cell);
                let spin = creepage.spin * if axis == 0 { -y } else { x };
                let ahead = !(cell + 1).is_multiple_of(grid.cells[0]);
                let came = before
                    .filter(|_| ahead)
                    .map_or(0.0, |before| before[axis][cell + 1]);
                came + rolled * (creepage.along[axis] + spin)
            };
            (0..grid.len()).map(of).collect()
        })
    }
}

/// Σ ‖t_T − t_T⁻‖ / Σ ‖t_T‖.
fn change(before: &HalfSpaceOutcome, now: &HalfSpaceOutcome) -> f64 {
    let (mut change, mut size) = (0.0, 0.0);
    for cell in 0..now.gap.len() {
        let [x, y] = [1, 2].map(|c| now.state.reaction[c][cell]);
        let [old_x, old_y] = [1, 2].map(|c| before.state.reaction[c][cell]);
        change += (x - old_x).hypot(y - old_y);
        size += x.hypot(y);
    }
    if change > 0.0 { change / size } else { 0.0 }
}
