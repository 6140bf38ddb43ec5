//! An iterate of the outer loop.

use crate::kkt::{Judge, Verdict};

/// Reaction, rigid motion, and the judge's word on them.
#[derive(Clone, Debug)]
pub(super) struct Iterate {
    pub(super) reaction: Vec<f64>,
    pub(super) motion: Vec<f64>,
    pub(super) verdict: Verdict,
}

/// What one step leads to.
pub(super) struct Step {
    pub(super) reaction: Vec<f64>,
    pub(super) motion: Vec<f64>,
    /// Part of the step after which a first slip ends, between bodies that float.
    pub(super) first_stick: Option<f64>,
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

    /// The state after `part` of a Newton step.
    pub(super) fn moved(&self, step: &Step, part: f64, judge: &Judge<'_>) -> Self {
        let along = |from: &[f64], to: &[f64]| -> Vec<f64> {
            if part == 1.0 {
                return to.to_vec();
            }
            let pairs = from.iter().zip(to);
            pairs.map(|(a, b)| a + part * (b - a)).collect()
        };
        let reaction = along(&self.reaction, &step.reaction);
        Self::new(judge, reaction, along(&self.motion, &step.motion))
    }

    pub(super) fn residual(&self) -> f64 {
        self.verdict.certificate.residual()
    }
}
