//! Contacts solved again where the bodies move otherwise than their condensed problem says (C24).

use super::Setup;
use crate::alternation;
use crate::alternation::{Outcome, Status};
use crate::condensation::Condensed;
use crate::error::Error;

/// Part of the largest displacement by which contacts of recovered bodies may move otherwise than the contact
/// problem says without being solved again.
const AHEAD: f64 = 1e-9;

/// Rounds at most: each takes as many digits as the factor has.
const ROUNDS: usize = 8;

impl Setup {
    /// Displacements of the bodies of a solved problem, per body and unknown in metre, and the outcome that they
    /// belong to.
    pub(super) fn displacements(
        &mut self,
        mut outcome: Outcome,
    ) -> Result<(Outcome, Vec<Vec<f64>>), Error> {
        let condensed = &mut self.condensed;
        let mut displacements = condensed.recover(&outcome.reaction, &outcome.motion)?;
        if outcome.status != Status::Certified || !condensed.corrects() {
            return Ok((outcome, displacements));
        }
        let mut before = f64::INFINITY;
        for _ in 0..ROUNDS {
            let said = of_bodies(condensed, &outcome);
            let ahead = largest(&condensed.ahead(&said, &displacements)?);
            let settled = ahead <= AHEAD * largest(displacements.iter().flatten());
            // What no longer gets less is rounding of û and t.
            if settled || ahead > 0.5 * before || outcome.status != Status::Certified {
                break;
            }
            before = ahead;
            condensed.refine(&outcome.reaction, &mut displacements)?;
            condensed.shift(&condensed.ahead(&said, &displacements)?)?;
            let again = alternation::solve_near(condensed.problem(), &self.settings, &outcome)?;
            outcome = again.after(outcome);
            displacements = condensed.recover(&outcome.reaction, &outcome.motion)?;
            condensed.refine(&outcome.reaction, &mut displacements)?;
        }
        Ok((outcome, displacements))
    }
}

/// What the contact problem says of the bodies, in metre per unknown.
fn of_bodies(condensed: &Condensed, outcome: &Outcome) -> Vec<f64> {
    let displacement = &outcome.verdict.displacement;
    condensed
        .problem()
        .displacement_of_bodies(displacement, &outcome.reaction)
}

fn largest<'a>(values: impl IntoIterator<Item = &'a f64>) -> f64 {
    values
        .into_iter()
        .fold(0.0, |most, value| value.abs().max(most))
}
