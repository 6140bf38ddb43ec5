//! A quantity up a ladder of meshes: errors, rate, verdict.

use crate::report::{Criterion, Rung, VerifiedQuantity};

/// What one mesh gave for one quantity.
#[derive(Clone, Copy, Debug)]
pub(super) struct Measured {
    /// Value found and known value; none for a field.
    values: Option<[f64; 2]>,
    error: f64,
}

impl Measured {
    /// A number, `exact` not zero; its error is relative (V1).
    pub(super) fn number(computed: f64, exact: f64) -> Self {
        Self {
            values: Some([computed, exact]),
            error: (computed / exact - 1.0).abs(),
        }
    }

    /// Value found over value known; a NaN for a field.
    pub(super) fn ratio(&self) -> f64 {
        self.values.map_or(f64::NAN, |[found, known]| found / known)
    }

    /// A field by the relative norm of its error.
    pub(super) fn field(error: f64) -> Self {
        let values = None;
        Self { values, error }
    }

    /// Mean of the errors of several scenes on one mesh; a number shows that of the last scene.
    pub(super) fn mean(all: &[Self]) -> Self {
        let error = all.iter().map(|one| one.error).sum::<f64>() / all.len() as f64;
        let values = all.last().and_then(|last| last.values);
        Self { values, error }
    }

    /// The worst of several, a NaN being the worst of all; of none, a NaN.
    pub(super) fn worst(all: impl IntoIterator<Item = Self>) -> Self {
        let worse = |worst: Self, one: Self| {
            if one.error > worst.error || one.error.is_nan() {
                one
            } else {
                worst
            }
        };
        all.into_iter()
            .reduce(worse)
            .unwrap_or(Self::field(f64::NAN))
    }
}

/// A quantity whose ladder is being climbed.
#[derive(Clone, Debug)]
pub(super) struct Ladder {
    quantity: &'static str,
    rungs: Vec<Rung>,
}

impl Ladder {
    pub(super) fn new(quantity: &'static str) -> Self {
        let rungs = Vec::new();
        Self { quantity, rungs }
    }

    /// Adds a finer mesh, of which `settled` says whether its scenes ended as they should.
    pub(super) fn climb(&mut self, mesh: &str, size: f64, settled: bool, found: Measured) {
        self.rungs.push(Rung {
            mesh: mesh.to_owned(),
            size,
            settled,
            computed: found.values.map(|values| values[0]),
            exact: found.values.map(|values| values[1]),
            error: found.error,
        });
    }

    /// Holds the ladder against a criterion.
    pub(super) fn judge(self, criterion: Criterion) -> VerifiedQuantity {
        let every = matches!(criterion, Criterion::EveryMesh { .. });
        let fitted = if every { None } else { rate(&self.rungs) };
        let last = |within| self.rungs.last().is_some_and(|rung| rung.error <= within);
        let held = match criterion {
            Criterion::EveryMesh { within } => {
                !self.rungs.is_empty() && self.rungs.iter().all(|rung| rung.error <= within)
            }
            Criterion::FinestMesh { within } => last(within),
            Criterion::Converges { within, rate } => {
                last(within) && fitted.is_some_and(|fitted| fitted >= rate)
            }
            Criterion::Compared => true,
        };
        VerifiedQuantity {
            quantity: self.quantity,
            criterion,
            rate: fitted,
            passed: held && self.rungs.iter().all(|rung| rung.settled),
            ladder: self.rungs,
        }
    }
}

/// Slope of ln error over ln size (V2); none for fewer than two sizes or an error of zero.
fn rate(rungs: &[Rung]) -> Option<f64> {
    let points = rungs.iter().map(|rung| [rung.size.ln(), rung.error.ln()]);
    let points: Vec<[f64; 2]> = points.collect();
    let mean = |axis: usize| points.iter().map(|p| p[axis]).sum::<f64>() / points.len() as f64;
    let center = [mean(0), mean(1)];
    let (mut rise, mut run) = (0.0, 0.0);
    for [x, y] in &points {
        rise += (x - center[0]) * (y - center[1]);
        run += (x - center[0]).powi(2);
    }
    let slope = rise / run;
    slope.is_finite().then_some(slope)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Errors on meshes of size 1, 1/2, 1/4 …
    fn ladder(errors: &[f64]) -> Ladder {
        let mut ladder = Ladder::new("x");
        for (k, error) in errors.iter().enumerate() {
            ladder.climb(
                "mesh",
                0.5_f64.powi(k as i32),
                true,
                Measured::field(*error),
            );
        }
        ladder
    }

    fn passes(errors: &[f64], criterion: Criterion) -> bool {
        ladder(errors).judge(criterion).passed
    }

    #[test]
    fn errors_that_fall_by_four_have_rate_two() {
        let judged = ladder(&[1.6, 0.4, 0.1]).judge(Criterion::Compared);
        assert!(judged.rate.is_some_and(|rate| (rate - 2.0).abs() < 1e-14));
        assert_eq!(ladder(&[0.1]).judge(Criterion::Compared).rate, None);
    }

    #[test]
    fn every_criterion_can_fail() {
        let falling = [1.6, 0.4, 0.1];
        assert!(passes(&falling, Criterion::FinestMesh { within: 0.1 }));
        assert!(!passes(&falling, Criterion::FinestMesh { within: 0.09 }));
        assert!(!passes(&falling, Criterion::EveryMesh { within: 0.1 }));
        let converges = |rate| Criterion::Converges { within: 0.1, rate };
        assert!(passes(&falling, converges(1.9)) && !passes(&falling, converges(2.1)));
        assert!(!passes(&[], Criterion::EveryMesh { within: 1.0 }));
        assert!(!passes(&[f64::NAN], Criterion::EveryMesh { within: 1.0 }));
    }

    #[test]
    fn a_scene_that_did_not_settle_fails_whatever_its_numbers() {
        let mut unsettled = Ladder::new("x");
        unsettled.climb("mesh", 1.0, false, Measured::number(1.0, 1.0));
        assert!(!unsettled.judge(Criterion::Compared).passed);
    }

    #[test]
    fn a_nan_is_the_worst() {
        let all = [0.1, f64::NAN, 0.2].map(Measured::field);
        assert!(Measured::worst(all).error.is_nan());
        assert!(Measured::worst([]).error.is_nan());
        assert!((Measured::mean(&[0.1, 0.2].map(Measured::field)).error - 0.15).abs() < 1e-15);
    }
}
