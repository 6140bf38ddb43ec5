//! How wrong a total is, judged on a family of meshes.
//!
//! ```text
//! f_i = f + C h_iᵖ      of the last three meshes, h_i = cells^(−1/d)
//! error = s |f − f_n|   s = 1.25 where two rates in a row agree, 3 where they do not or only one is known
//! ```
//!
//! The grid convergence index of Roache, J. Fluids Eng. 116 (1994) 405–413, around the extrapolated value. The
//! rate counts as 2 at most, and one that is better by more than rates may differ is none until it is seen twice: the last change may
//! be small by luck, where what a total depends on falls into cells in another way on every mesh. Where totals do not approach each
//! other with a rate between a half and eight there is no extrapolation, and the last one is wrong by three times the
//! change to it, at least. A total that jumps from contact to contact, such as an area, is wrong by a jump at least, whatever
//! meshes agree.

use serde::Serialize;

use super::digits::{number, size};

/// Rates that are believed.
const RATES: (f64, f64) = (0.5, 8.0);

/// Largest rate that is extrapolated with.
const MOST: f64 = 2.0;

/// Two rates that differ by less than this part agree.
const AGREE: f64 = 0.3;

/// Safety of a rate that is seen twice, and of any other change.
const SAFETY: (f64, f64) = (1.25, 3.0);

/// Changes below this part of the total are rounding.
const ROUNDED: f64 = 1e-9;

/// A total, extrapolated over a family of meshes, and its error.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Accuracy {
    /// Which total.
    pub of: String,
    /// Error that was asked for, relative to the total.
    pub within: f64,
    /// The total on meshes without end.
    pub value: f64,
    /// What it may be wrong by.
    pub error: f64,
    /// Observed rate of convergence with the size of cells; `null` where none is observed.
    pub rate: Option<f64>,
    /// Factor between what is left to the extrapolated value and the error.
    pub safety: f64,
    /// Whether the error is within what was asked for.
    pub reached: bool,
    /// Why the meshes end here, where it is not.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stopped: Option<String>,
    /// The meshes, from coarse to fine.
    pub levels: Vec<AccuracyLevel>,
}

/// A mesh of the family.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct AccuracyLevel {
    /// Cells of all bodies.
    pub cells: usize,
    /// Unknowns of the contact problem.
    pub contact_unknowns: usize,
    /// The total.
    pub value: f64,
    /// What it jumps by as one contact opens or slips; zero of totals that do not jump.
    pub grain: f64,
}

impl Accuracy {
    /// What a family of meshes of a dimension says of a total.
    #[must_use]
    pub(crate) fn new(of: &str, within: f64, dimension: usize, levels: Vec<AccuracyLevel>) -> Self {
        let steps: Vec<(f64, f64)> = levels
            .iter()
            .map(|level| {
                (
                    (level.cells as f64).powf(-1.0 / dimension as f64),
                    level.value,
                )
            })
            .collect();
        let last = levels.last().map_or(f64::NAN, |level| level.value);
        let judged = judge(&steps);
        let (value, error, rate, safety) = judged.unwrap_or((last, f64::INFINITY, None, SAFETY.1));
        let error = levels.last().map_or(error, |level| error.max(level.grain));
        Self {
            of: of.to_owned(),
            within,
            value,
            error,
            rate,
            safety,
            reached: error <= within * value.abs(),
            stopped: None,
            levels,
        }
    }

    /// As the summary says it.
    #[must_use]
    pub fn words(&self) -> String {
        let (value, of) = (number(self.value), &self.of);
        let rate = match self.rate {
            Some(rate) => format!("observed rate {rate:.2}"),
            None => "NO RATE observed".to_owned(),
        };
        let part = size(self.error / self.value.abs());
        let reached = match &self.stopped {
            None => String::new(),
            Some(why) => format!("; NOT within {}: {why}", self.within),
        };
        format!(
            "{of} {value} +- {} ({part} of it; {rate}, {} meshes, safety {}){reached}",
            size(self.error),
            self.levels.len(),
            self.safety
        )
    }
}

/// Value, error, rate and safety from sizes and totals; none of fewer than three meshes.
fn judge(steps: &[(f64, f64)]) -> Option<(f64, f64, Option<f64>, f64)> {
    let [.., first, middle, last] = steps else {
        return None;
    };
    let value = last.1;
    let changes = [middle.1 - first.1, value - middle.1];
    let largest = changes[0].abs().max(changes[1].abs());
    if largest <= ROUNDED * value.abs() {
        return Some((value, SAFETY.1 * largest, None, SAFETY.1));
    }
    let before = match steps {
        [.., before, _, _, _] => observed([*before, *first, *middle]),
        _ => None,
    };
    let agrees = |rate: f64| before.is_some_and(|before| (before - rate).abs() <= AGREE * rate);
    let believed = |rate: &f64| agrees(*rate) || *rate <= (1.0 + AGREE) * MOST;
    let Some(rate) = observed([*first, *middle, *last]).filter(believed) else {
        let change = changes[1].abs().max(0.5 * changes[0].abs());
        return Some((value, SAFETY.1 * change, None, SAFETY.1));
    };
    let safety = if agrees(rate) { SAFETY.0 } else { SAFETY.1 };
    let finer = (middle.0 / last.0).powf(rate.min(MOST));
    let left = changes[1] / (finer - 1.0);
    Some((value + left, safety * left.abs(), Some(rate), safety))
}

/// p of `f_i = f + C h_iᵖ`, by halving: the ratio of the changes grows with it.
fn observed([first, middle, last]: [(f64, f64); 3]) -> Option<f64> {
    let ratio = (middle.1 - first.1) / (last.1 - middle.1);
    let of = |rate: f64| {
        let [a, b, c] = [first.0, middle.0, last.0].map(|h| (h / last.0).powf(rate));
        (a - b) / (b - c)
    };
    let (mut low, mut high) = RATES;
    if !(ratio >= of(low) && ratio <= of(high)) {
        return None;
    }
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        match of(middle) < ratio {
            true => low = middle,
            false => high = middle,
        }
    }
    Some(low)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn family(totals: &[f64], sides: &[usize]) -> Accuracy {
        let levels = totals
            .iter()
            .zip(sides)
            .map(|(&value, side)| AccuracyLevel {
                cells: side * side,
                contact_unknowns: 2 * side,
                value,
                grain: 0.0,
            });
        Accuracy::new("normal", 0.01, 2, levels.collect())
    }

    #[test]
    fn a_power_of_the_size_is_taken_to_its_end_on_any_family() {
        // f = 3 + 2 h^1.5 with h = 1/n.
        let sides = [4, 6, 10, 12];
        let totals = sides.map(|n| 3.0 + 2.0 * f64::from(n).powf(-1.5));
        let found = family(&totals, &sides.map(|n| n as usize));
        assert!((found.value - 3.0).abs() < 1e-12, "{found:?}");
        assert!(found.rate.is_some_and(|rate| (rate - 1.5).abs() < 1e-12));
        // 1.25 of what is left, 2/12^1.5 = 0.0481: 2 % of 3.
        assert!((found.error - 1.25 * 2.0 / 12.0_f64.powf(1.5)).abs() < 1e-12 && !found.reached);
    }

    #[test]
    fn totals_that_jump_about_have_no_rate_and_a_wide_error() {
        let found = family(&[1.0, 1.2, 1.1], &[2, 4, 8]);
        assert_eq!((found.rate, found.value), (None, 1.1));
        assert!((found.error - 0.3).abs() < 1e-15);
        // Twenty times less than before by luck, and the fourth says so.
        let lucky = family(&[1.0, 1.2, 1.21], &[2, 4, 8]);
        assert_eq!((lucky.rate, lucky.value), (None, 1.21));
        assert!((lucky.error - 0.3).abs() < 1e-15);
        let twice = family(
            &[
                1.0 - 0.2 / 0.95,
                1.0,
                1.0 + 0.2 / 20.0,
                1.0 + 0.2 / 20.0 * 1.05,
            ],
            &[2, 4, 8, 16],
        );
        assert!(twice.rate.is_some_and(|rate| rate > 4.0) && twice.safety == 1.25);
        let still = family(&[2.0; 3], &[2, 4, 8]);
        assert!(still.reached && still.error == 0.0 && still.rate.is_none());
        assert!(!family(&[2.0; 2], &[2, 4]).reached);
        // An area that stays the same by whole contacts.
        let mut levels = still.levels;
        levels.iter_mut().for_each(|level| level.grain = 0.05);
        let area = Accuracy::new("contact_area", 0.01, 2, levels);
        assert!(area.error == 0.05 && !area.reached);
    }
}
