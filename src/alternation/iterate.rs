//! An iterate of the outer loop.

use crate::kkt::{Judge, Verdict};

/// Reaction, rigid motion, and the judge's word on them.
#[derive(Clone, Debug)]
pub(super) struct Iterate {
    pub(super) reaction: Vec<f64>,
    pub(super) motion: Vec<f64>,
    pub(super) verdict: Verdict,
}

impl Iterate {
    pub(super) fn new(judge: &Judge<'_>, reaction: Vec<f64>, motion: Vec<f64>) -> Self {
        let verdict = judge.measure_floating(&reaction, &motion);
        Self {
            reaction,
            motion,
            verdict,
        }
    }

    pub(super) fn measure(&mut self, judge: &Judge<'_>) {
        self.verdict = judge.measure_floating(&self.reaction, &self.motion);
    }

    pub(super) fn residual(&self) -> f64 {
        self.verdict.certificate.residual()
    }
}
