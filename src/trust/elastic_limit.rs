//! By what factor a load can grow before nothing holds elastic bodies.
//!
//! ```text
//! (T3)  û(λ), e(λ) as in (T2);  λ holds: a certified state;  λ fails: nothing holds the bodies, (H5) or (D6)
//!
//!        λ ← λ − (e(λ) + Rᵀ t)·a / (e₁ − e₀)·a          where λ fails, with motion a and reactions t meanwhile
//! ```
//!
//! Rigid bodies between what overlaps are held however hard they are pulled: their contacts may press as they like.
//! Elastic ones press as their overlap lets them, and give way. Where one load fails, the factor becomes an unknown
//! of the state that gives way: the one with which equilibrium holds along its motion, Newton's method from above as in
//! limit analysis (H6). Once contacts that all slide carry what they can, it is exact. Where it does not lead on,
//! as before a peak that the sliding state is below, the interval between a factor that holds and one that fails
//! is halved. Each factor tried starts from the nearest state that holds.

use super::proportion::Proportion;
use crate::alternation::{Failure, Outcome, Settings, Status, solve, solve_from, solve_near};
use crate::error::{Error, check_length};
use crate::problem::ContactProblem;

/// Distance of the last two factors, relative to the larger.
const WIDTH: f64 = 1e-6;

/// Factors tried at most.
const TRIALS: usize = 60;

/// A factor that holds grows by this while none has failed, up to the largest that is tried.
const GROWTH: f64 = 4.0;
const MOST: f64 = 1e6;

/// Where none holds up to the load as it stands, none is looked for beyond this.
const FIRST: f64 = 64.0;

/// Trials that leave more than half of the interval, before it is halved.
const SLOW: usize = 3;

/// Where the distance of a trial from the expected limit leaves it undecided it is ten times as large, up to this.
const AWAY: f64 = 1e-2;

/// What is known of the factor by which a load can grow (T3).
#[derive(Clone, Debug, PartialEq)]
pub struct ElasticLimit {
    /// Largest factor that was found to hold: its state is certified.
    pub held: Option<f64>,
    /// Least factor at which nothing was found to hold the bodies, and how they give way.
    pub fails: Option<(f64, Failure)>,
    /// Factors tried.
    pub trials: usize,
}

/// Where the search for a limit begins.
#[derive(Clone, Copy, Debug, Default)]
pub struct LimitStart<'a> {
    /// A factor that is tried first, such as that of rigid bodies.
    pub guess: Option<f64>,
    /// Reaction and rigid motion of a state that is likely near, as for [`solve_from`].
    pub state: Option<(&'a [f64], &'a [f64])>,
}

/// Follows a load on bodies that only contact holds up to its limit (T3): `without` is their problem without the load,
/// `stated` with it as it stands, at the factor one.
///
/// Factors are known to a millionth, where the states between can be told apart. Displacements are taken for small
/// throughout: a body that turns within facets may jam on them after a turn that no such theory knows, and be found to
/// hold beyond what its friction carries. Solve at the factor, and read the slip.
///
/// # Errors
///
/// Problems of different contacts, a start that is not of their length, or settings outside their range.
pub fn elastic_limit(
    without: &ContactProblem,
    stated: &ContactProblem,
    settings: &Settings,
    start: LimitStart<'_>,
) -> Result<ElasticLimit, Error> {
    check_length("unknowns", without.unknowns(), stated.unknowns())?;
    check_length("free_modes", without.free_modes(), stated.free_modes())?;
    let both = [without, stated];
    let loads = both.map(|problem| problem.floating().map(|floating| floating.load().to_vec()));
    let free = both.map(|problem| problem.free_displacement().to_vec());
    let mut search = Search {
        line: Proportion::new(stated, free, loads.map(Option::unwrap_or_default)),
        settings,
        start,
        held: None,
        fails: None,
        trials: 0,
        largest: 0.0,
        aside: 0.5 * WIDTH,
        slow: 0,
    };
    search.run()?;
    Ok(ElasticLimit {
        held: search.held.map(|(factor, _)| factor),
        fails: search.fails,
        trials: search.trials,
    })
}

/// A search between a factor that holds and one that fails.
struct Search<'a> {
    line: Proportion<'a>,
    settings: &'a Settings,
    start: LimitStart<'a>,
    held: Option<(f64, Outcome)>,
    fails: Option<(f64, Failure)>,
    trials: usize,
    /// Largest factor tried.
    largest: f64,
    /// Distance of trials from the expected limit, relative to it.
    aside: f64,
    slow: usize,
}

impl Search<'_> {
    fn run(&mut self) -> Result<(), Error> {
        let guess = self
            .start
            .guess
            .filter(|guess| (0.0..=MOST).contains(guess));
        if let Some(guess) = guess
            && self.holds(guess * (1.0 - self.aside))? == Some(true)
        {
            self.holds(guess * (1.0 + self.aside))?;
        }
        if self.held.is_none() && self.fails.is_none() {
            self.holds(1.0)?;
        }
        while self.trials < TRIALS {
            let before = self.interval();
            let Some(next) = self.next() else {
                break;
            };
            if self.holds(next)?.is_none() && !self.steps_aside(next)? {
                break;
            }
            let halved = self.interval() <= 0.5 * before;
            self.slow = if halved { 0 } else { self.slow + 1 };
        }
        Ok(())
    }

    /// Whether a factor holds; none where its solve tells neither.
    fn holds(&mut self, factor: f64) -> Result<Option<bool>, Error> {
        self.trials += 1;
        let problem = self.line.at(factor)?;
        let mut found = match (&self.held, self.start.state) {
            (Some((_, near)), _) => solve_near(&problem, self.settings, near)?,
            (None, Some((t, motion))) => solve_from(&problem, self.settings, t, motion)?,
            (None, None) => solve(&problem, self.settings)?,
        };
        self.largest = self.largest.max(factor);
        if found.status == Status::Certified {
            self.fails.take_if(|(fails, _)| *fails < factor);
            self.held = Some((factor, found));
            return Ok(Some(true));
        }
        Ok(found.failure.take().map(|failure| {
            if self.fails.as_ref().is_none_or(|(least, _)| factor < *least) {
                self.fails = Some((factor, failure));
            }
            false
        }))
    }

    /// The next factor to try; none where nothing is left to tell.
    fn next(&self) -> Option<f64> {
        let held = self.held.as_ref().map(|(held, _)| *held);
        let Some((fails, _)) = self.fails else {
            let held = held.filter(|held| *held < MOST)?;
            return Some(if held > 0.0 { GROWTH * held } else { 1.0 });
        };
        if self.interval() <= WIDTH * fails {
            return None;
        }
        let expected = self.expected().filter(|_| self.slow < SLOW);
        let [below, above] =
            [-1.0, 1.0].map(|way| expected.map(|at| at * (1.0 + way * self.aside)));
        let inside = |at: &f64| (held.unwrap_or(0.0)..fails).contains(at) && Some(*at) != held;
        let expected = below.filter(inside).or(above.filter(inside));
        expected.or(match held {
            Some(held) => Some(0.5 * (held + fails)),
            None if fails > 0.0 => Some(0.0),
            // It may be what holds the others.
            None => Some(GROWTH * self.largest.max(1.0)).filter(|next| *next <= FIRST),
        })
    }

    /// (T3), from the least factor that fails.
    fn expected(&self) -> Option<f64> {
        let (fails, failure) = self.fails.as_ref()?;
        let [start, end] = &self.line.load;
        let growing = end.iter().zip(start).zip(&failure.motion);
        let power: f64 = growing.map(|((end, start), a)| (end - start) * a).sum();
        (power > 0.0).then(|| fails - failure.missing / power)
    }

    /// Tries farther from the expected limit what was undecided nearer to it; false where that is not near it at all.
    fn steps_aside(&mut self, tried: f64) -> Result<bool, Error> {
        let Some(expected) = self.expected() else {
            return Ok(false);
        };
        let near = (tried - expected).abs() <= 2.0 * self.aside * expected.abs();
        self.aside *= 10.0;
        Ok(near && self.aside <= AWAY)
    }

    /// Length between what holds, or nothing, and what fails.
    fn interval(&self) -> f64 {
        let held = self
            .held
            .as_ref()
            .map_or(f64::NEG_INFINITY, |(held, _)| *held);
        let fails = self
            .fails
            .as_ref()
            .map_or(f64::INFINITY, |(fails, _)| *fails);
        fails - held
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use faer::{Mat, mat};

    use super::*;
    use crate::problem::{Floating, Operator};

    /// One contact that overlaps by half a metre, G = 1 m/N, μ = ½, on a block that moves along it and off it by `off`.
    fn wedged(off: f64, pull: f64) -> ContactProblem {
        let operator = Operator::from_compliance(Mat::identity(2, 2)).unwrap();
        let problem = ContactProblem::new(&[1], vec![0.5], vec![-0.5], vec![0.0; 2], operator);
        let floating = Floating::new(mat![[-off], [1.0]], vec![pull]).unwrap();
        problem.unwrap().float(floating).unwrap()
    }

    fn limit(off: f64, pulls: [f64; 2], guess: Option<f64>) -> ElasticLimit {
        let [without, stated] = pulls.map(|pull| wedged(off, pull));
        let start = LimitStart { guess, state: None };
        elastic_limit(&without, &stated, &Settings::default(), start).unwrap()
    }

    fn assert_close(found: &ElasticLimit, expected: f64) {
        let (held, fails) = (found.held.unwrap(), found.fails.as_ref().unwrap().0);
        assert!(held <= expected && expected <= fails, "{found:?}");
        assert!(fails - held <= WIDTH * fails, "{found:?}");
    }

    #[test]
    fn a_clamp_gives_way_at_its_friction_from_whatever_is_tried_first() {
        // N = ½ whatever slides: μ N = ¼.
        for (pull, guess) in [
            (1.0, None),
            (1e-3, None),
            (0.1, Some(2.5)),
            (0.1, Some(80.0)),
        ] {
            let found = limit(0.0, [0.0, pull], guess);
            assert_close(&found, 0.25 / pull);
            // One state of sliding tells where it is: the rest is to enclose it.
            assert!(found.trials <= 12, "{found:?}");
        }
    }

    #[test]
    fn a_wedge_gives_way_at_the_peak_of_its_resistance() {
        // N = ½ − α/10. It sticks with T = α up to α = μ N, N = ½/1.05; and comes loose when it slides on. Along the
        // motion the pull is T − N/10.
        for pull in [1.0, 0.1] {
            assert_close(&limit(0.1, [0.0, pull], None), 0.4 * 0.5 / 1.05 / pull);
        }
    }

    #[test]
    fn a_load_that_presses_has_no_end_and_one_that_is_too_much_without_it_none_to_begin_with() {
        // Pushed in it presses itself: N = ½ + α/10.
        let pressed = limit(0.1, [0.0, -1.0], None);
        assert!(
            pressed.fails.is_none() && pressed.held >= Some(MOST),
            "{pressed:?}"
        );
        let never = limit(0.0, [0.3, 0.4], None);
        assert_eq!(
            (never.held, never.fails.map(|(factor, _)| factor)),
            (None, Some(0.0))
        );
    }

    #[test]
    fn problems_of_different_contacts_are_refused() {
        let held = ContactProblem::new(
            &[1],
            vec![0.5],
            vec![0.0],
            vec![0.0; 2],
            Operator::from_compliance(Mat::identity(2, 2)).unwrap(),
        );
        let (held, floats) = (held.unwrap(), wedged(0.0, 1.0));
        let found = elastic_limit(&held, &floats, &Settings::default(), LimitStart::default());
        assert!(found.unwrap_err().to_string().contains("free_modes"));
    }
}
