//! Contacts under what acts at two ends, and in proportion between and beyond them (T2).

use crate::error::Error;
use crate::problem::ContactProblem;

/// The problems of (T2): λ is 0 at the first end and 1 at the second.
pub(super) struct Proportion<'a> {
    problem: &'a ContactProblem,
    /// û at both ends, in metre per unknown.
    pub(super) free: [Vec<f64>; 2],
    /// e at both ends, in newton per free mode.
    pub(super) load: [Vec<f64>; 2],
}

impl<'a> Proportion<'a> {
    /// The contacts of a problem between û and e of both ends.
    pub(super) fn new(
        problem: &'a ContactProblem,
        free: [Vec<f64>; 2],
        load: [Vec<f64>; 2],
    ) -> Self {
        Self {
            problem,
            free,
            load,
        }
    }

    /// The problem at a part of the way.
    pub(super) fn at(&self, part: f64) -> Result<ContactProblem, Error> {
        let between = |[start, end]: &[Vec<f64>; 2]| -> Vec<f64> {
            let ends = start.iter().zip(end);
            ends.map(|(start, end)| start + part * (end - start))
                .collect()
        };
        let none = vec![0.0; self.problem.unknowns()];
        let problem = self.problem.step(between(&self.free), none)?;
        match self.problem.floating() {
            None => Ok(problem),
            Some(floating) => problem.float(floating.under(between(&self.load))?),
        }
    }
}
