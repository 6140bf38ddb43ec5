//! Contacts solved again where the bodies move otherwise than their condensed problem says (C24).

use std::time::Instant;

use super::Setup;
use crate::alternation;
use crate::alternation::{Outcome, Settings, Shortfall, Status};
use crate::condensation::{Condensed, Correction, Fallback};
use crate::error::Error;

/// Part of the largest displacement by which contacts of recovered bodies may move otherwise than the contact
/// problem says without being solved again.
const AHEAD: f64 = 1e-9;

/// Rounds at most: each takes as many digits as the factor has.
const ROUNDS: usize = 8;

/// Residual to which contacts are solved before the first round on a factor in single precision: it has no more digits.
const FIRST: f64 = 1e-6;

/// First residual of recovered bodies beyond which single precision is not enough.
const RESIDUAL: f64 = 3e-5;

/// Second change of the reactions over the first beyond which it is not.
const CONTRACTION: f64 = 1e-3;

/// Part by which another round would change reactions, or residuals what acts, that is round-off.
const SETTLED: f64 = 1e-13;

/// A solved problem and the displacements of its bodies, per body and unknown in metre.
pub(super) type Solved = (Outcome, Vec<Vec<f64>>);

impl Setup {
    /// Displacements of the bodies of a solved problem, and the outcome that they belong to.
    pub(super) fn displacements(&mut self, mut outcome: Outcome) -> Result<Solved, Error> {
        let mut displacements = self.condensed.recover(&outcome.reaction, &outcome.motion)?;
        if outcome.status != Status::Certified || !self.condensed.corrects() {
            return Ok((outcome, displacements));
        }
        let mut before = f64::INFINITY;
        for _ in 0..ROUNDS {
            let ahead = largest(&self.ahead(&outcome, &displacements)?);
            let settled = ahead <= AHEAD * largest(displacements.iter().flatten());
            // What no longer gets less is rounding of û and t.
            if settled || ahead > 0.5 * before || outcome.status != Status::Certified {
                break;
            }
            before = ahead;
            self.refine(&outcome, &mut displacements)?;
            let ahead = self.ahead(&outcome, &displacements)?;
            self.condensed.shift(&ahead)?;
            let problem = self.condensed.problem();
            let again = alternation::solve_again(problem, &self.settings, &outcome)?;
            outcome = again.after(outcome);
            displacements = self.condensed.recover(&outcome.reaction, &outcome.motion)?;
            self.refine(&outcome, &mut displacements)?;
        }
        Ok((outcome, displacements))
    }

    fn ahead(&self, outcome: &Outcome, displacements: &[Vec<f64>]) -> Result<Vec<f64>, Error> {
        let said = of_bodies(&self.condensed, outcome);
        self.condensed.ahead(&said, displacements)
    }

    /// The bodies set right under the reactions as they are.
    fn refine(&self, outcome: &Outcome, displacements: &mut [Vec<f64>]) -> Result<(), Error> {
        let correction = self.correction(outcome, displacements)?;
        let none = vec![0.0; outcome.reaction.len()];
        self.condensed.advance(correction, &none, displacements)
    }

    /// Solves with factors in single precision (C32), to all digits by rounds of (C24); or says by what sign they
    /// have too few.
    ///
    /// `spent` takes the seconds of all that is not the contacts' own.
    pub(super) fn solve_rounded(
        &mut self,
        spent: &mut f64,
    ) -> Result<Result<Solved, Fallback>, Error> {
        let first = Settings {
            tolerance: self.settings.tolerance.max(FIRST),
            ..self.settings
        };
        let mut outcome = alternation::solve(self.condensed.problem(), &first)?;
        let start = Instant::now();
        let contacts = outcome.work.seconds.total();
        let mut displacements = self.condensed.recover(&outcome.reaction, &outcome.motion)?;
        let (mut left, mut changed) = (Vec::new(), Vec::new());
        for round in 0..ROUNDS {
            if let Some(ended) = ended(&outcome) {
                return Ok(ended.map(|()| (outcome, displacements)));
            }
            let correction = self.correction(&outcome, &displacements)?;
            left.push(correction.part());
            if left[0] > RESIDUAL || left[0].is_nan() {
                return Ok(Err(Fallback::Residual { part: left[0] }));
            }
            let (next, change) = self.round(outcome, correction, &mut displacements)?;
            outcome = next;
            changed.push(change);
            let again = outcome.work.seconds.total() - contacts;
            *spent = start.elapsed().as_secs_f64() - again;
            if settled(&left) && settled(&changed) && ended(&outcome).is_none() {
                return Ok(Ok((outcome, displacements)));
            }
            let factor = change / changed[round.saturating_sub(1)];
            if round > 0 && factor > CONTRACTION && change > SETTLED {
                return Ok(Err(Fallback::Contraction { factor }));
            }
        }
        Ok(Err(Fallback::Contacts))
    }

    fn correction(
        &self,
        outcome: &Outcome,
        displacements: &[Vec<f64>],
    ) -> Result<Correction, Error> {
        let said = of_bodies(&self.condensed, outcome);
        self.condensed
            .correction(&said, &outcome.reaction, displacements)
    }

    /// Contacts solved again where the bodies are, which follow; and by what part of them the reactions changed.
    fn round(
        &mut self,
        outcome: Outcome,
        correction: Correction,
        displacements: &mut [Vec<f64>],
    ) -> Result<(Outcome, f64), Error> {
        let condensed = &mut self.condensed;
        condensed.shift(correction.ahead())?;
        let again = alternation::solve_again(condensed.problem(), &self.settings, &outcome)?;
        let pairs = again.reaction.iter().zip(&outcome.reaction);
        let change: Vec<f64> = pairs.map(|(now, before)| now - before).collect();
        condensed.advance(correction, &change, displacements)?;
        let part = largest(&change) / largest(&again.reaction);
        Ok((again.after(outcome), if part > 0.0 { part } else { 0.0 }))
    }
}

/// Whether no round is to follow: as the time is over, or as contacts were not solved.
fn ended(outcome: &Outcome) -> Option<Result<(), Fallback>> {
    match (outcome.status, outcome.shortfall) {
        (Status::Certified, _) => None,
        (_, Some(Shortfall::TimeLimit | Shortfall::Interrupted)) => Some(Ok(())),
        _ => Some(Err(Fallback::Contacts)),
    }
}

/// Whether changes from round to round, two at least, are such that another is round-off.
fn settled(changes: &[f64]) -> bool {
    match changes {
        [.., before, now] => *now <= SETTLED || now * (now / before) <= SETTLED && now < before,
        _ => false,
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
