//! An iterate of the outer loop.

use crate::kkt::{Judge, Verdict};

/// Reaction, rigid motion, and the judge's word on them.
#[derive(Clone, Debug)]
pub(super) struct Iterate {
    pub(super) reaction: Vec<f64>,
    pub(super) motion: Motion,
    pub(super) verdict: Verdict,
}

/// Amplitudes of the free modes, in metre, and what their rounding leaves out.
#[derive(Clone, Debug, Default)]
pub(super) struct Motion {
    pub(super) amplitudes: Vec<f64>,
    pub(super) left_out: Vec<f64>,
}

impl Motion {
    /// Of amplitudes as they are.
    pub(super) fn of(amplitudes: Vec<f64>) -> Self {
        Self {
            left_out: vec![0.0; amplitudes.len()],
            amplitudes,
        }
    }

    /// After a further motion, without the rounding of their sum.
    pub(super) fn plus(&self, further: &[f64]) -> Self {
        let mut sum = Self::default();
        let known = self.amplitudes.iter().zip(&self.left_out);
        for ((whole, left_out), further) in known.zip(further) {
            let (first, lost) = two_sum(*whole, *further);
            let (amplitude, left_out) = two_sum(first, lost + left_out);
            sum.amplitudes.push(amplitude);
            sum.left_out.push(left_out);
        }
        sum
    }

    /// Of the free modes from an earlier motion to this one, in metre.
    pub(super) fn since(&self, earlier: &Self) -> Vec<f64> {
        let whole = self.amplitudes.iter().zip(&earlier.amplitudes);
        let left_out = self.left_out.iter().zip(&earlier.left_out);
        let both = whole.zip(left_out);
        both.map(|((now, before), (more, less))| (now - before) + (more - less))
            .collect()
    }
}

/// A sum and what its rounding leaves out (Knuth).
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let back = sum - a;
    (sum, (a - (sum - back)) + (b - back))
}

impl Iterate {
    pub(super) fn new(judge: &Judge<'_>, reaction: Vec<f64>, motion: Motion) -> Self {
        let verdict = judge.measure_moved(&reaction, &motion.amplitudes, &motion.left_out);
        Self {
            reaction,
            motion,
            verdict,
        }
    }

    pub(super) fn measure(&mut self, judge: &Judge<'_>) {
        let Motion {
            amplitudes,
            left_out,
        } = &self.motion;
        self.verdict = judge.measure_moved(&self.reaction, amplitudes, left_out);
    }

    pub(super) fn residual(&self) -> f64 {
        self.verdict.certificate.residual()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_motion_keeps_what_its_rounding_leaves_out() {
        // 1 + 2⁻⁶⁰ + 2⁻⁶⁰ − 1 = 2⁻⁵⁹.
        let tiny = 2.0_f64.powi(-60);
        let start = Motion::of(vec![1.0]);
        let moved = start.plus(&[tiny]).plus(&[tiny]);
        assert_eq!((moved.amplitudes[0], moved.left_out[0]), (1.0, 2.0 * tiny));
        assert_eq!(moved.since(&start), [2.0 * tiny]);
        assert_eq!(moved.plus(&[-1.0]).amplitudes, [2.0 * tiny]);
    }
}
