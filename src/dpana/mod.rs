//! OUTER LOOP: D-PANA, sweeps of normal and friction half-steps.

mod history;
mod settings;

pub use history::{Seconds, Status, SweepRecord, Work};
pub use settings::{Settings, Variant};

use crate::condensation::ContactProblem;
use crate::error::Error;
use crate::kkt::Verdict;

/// A solved contact problem.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Certified, or why not.
    pub status: Status,
    /// Reaction per unknown, in newton.
    pub reaction: Vec<f64>,
    /// The judge's last word: displacement, state of each contact, residuals.
    pub verdict: Verdict,
    /// One record per sweep.
    pub history: Vec<SweepRecord>,
    /// What it took.
    pub work: Work,
}

/// Solves a condensed contact problem.
///
/// # Errors
///
/// Settings outside their range.
pub fn solve(problem: &ContactProblem, settings: &Settings) -> Result<Outcome, Error> {
    todo!("{problem:?} {settings:?}")
}
