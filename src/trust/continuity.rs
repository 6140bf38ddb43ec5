//! Whether a state can be reached from an earlier one without a jump.
//!
//! ```text
//! (T2)  û(λ) = û₀ + λ (û − û₀),   e(λ) = e₀ + λ (e − e₀),    λ: 1 → 0
//! ```
//!
//! Where friction couples strongly a small step of the load can leave no state near the last one: bodies
//! then snap, and what quasi-statics says of the way is void. The state is followed back to the earlier one
//! while all that acts goes back in proportion: in the plane exactly, along (D10); in space, and between
//! bodies that float, by Newton steps in as small parts as they need.

use super::proportion::Proportion;
use crate::alternation::{End, Outcome, PlanePath, Settings, Status, solve_near};
use crate::error::{Error, check_finite, check_length};
use crate::problem::ContactProblem;

/// First and least part of the way that is tried in space.
const PART: (f64, f64) = (0.125, 1e-3);

/// Newton steps that allow a larger part.
const FEW: usize = 5;

/// Where a step begins the laws are at their corners, as no contact has slipped yet: the way back in the
/// plane ends at this part of it.
const BEGINNING: f64 = 1e-9;

/// There displacements are those of the earlier state to this part of the change of û.
const SAME: f64 = 1e-6;

/// Displacements that change by more than this many times û have jumped.
const JUMP: f64 = 10.0;

/// An earlier state, from the same reference on as the problem that follows it (C13).
#[derive(Clone, Debug, PartialEq)]
pub struct Earlier {
    /// In newton per unknown.
    pub reaction: Vec<f64>,
    /// In metre per unknown.
    pub displacement: Vec<f64>,
    /// In metre per free mode.
    pub motion: Vec<f64>,
}

/// What became of a state that was followed back to an earlier one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WayBack {
    /// It leads there: the state is reached without a jump.
    Continuous,
    /// It turns at this part of the step, before which there is no state near it: bodies jump there or later.
    Turns(f64),
    /// It leads to another state under the earlier load: bodies jump on the way.
    Elsewhere,
    /// It could not be followed below this part of the step.
    Lost(f64),
}

impl Earlier {
    /// Bodies without any load, contacts with an overlap just closed.
    #[must_use]
    pub fn rest(problem: &ContactProblem) -> Self {
        let mut displacement = vec![0.0; problem.unknowns()];
        for (&n, gap) in problem.offsets().iter().zip(problem.initial_gap()) {
            displacement[n] = gap.min(0.0);
        }
        Self {
            reaction: vec![0.0; problem.unknowns()],
            displacement,
            motion: vec![0.0; problem.free_modes()],
        }
    }

    fn check(&self, problem: &ContactProblem) -> Result<(), Error> {
        let (unknowns, modes) = (problem.unknowns(), problem.free_modes());
        for (place, expected, entries) in [
            ("earlier.reaction", unknowns, &self.reaction),
            ("earlier.displacement", unknowns, &self.displacement),
            ("earlier.motion", modes, &self.motion),
        ] {
            check_length(place, expected, entries.len())?;
            check_finite(place, entries)?;
        }
        Ok(())
    }
}

/// Follows a certified state of a problem back to an earlier state (T2).
///
/// # Errors
///
/// An earlier state that is not of the problem's length or not finite.
pub fn way_back(
    problem: &ContactProblem,
    settings: &Settings,
    outcome: &Outcome,
    earlier: &Earlier,
) -> Result<WayBack, Error> {
    earlier.check(problem)?;
    let way = Way::new(problem, earlier);
    let start = way.line.at(0.0)?;
    let [from, to] = &way.line.free;
    let drive: Vec<f64> = to.iter().zip(from).map(|(to, from)| to - from).collect();
    let Some(mut path) = PlanePath::back(&start, outcome, &drive) else {
        return way.back(settings, outcome);
    };
    Ok(match path.follow(BEGINNING, false) {
        End::Reached(reaction) => {
            let displacement = way.line.at(BEGINNING)?.displacement(&reaction);
            way.arrival(&displacement, SAME)
        }
        End::Turned(part) => WayBack::Turns(part),
        End::Lost(part) => WayBack::Lost(part),
    })
}

/// The way from an earlier state.
struct Way<'a> {
    earlier: &'a Earlier,
    line: Proportion<'a>,
}

impl<'a> Way<'a> {
    fn new(problem: &'a ContactProblem, earlier: &'a Earlier) -> Self {
        let end = problem.free_displacement().to_vec();
        let moved = problem.displacement(&earlier.reaction);
        let mut start: Vec<f64> = earlier.displacement.clone();
        for ((start, moved), end) in start.iter_mut().zip(&moved).zip(&end) {
            *start -= moved - end;
        }
        let mut load = [Vec::new(), Vec::new()];
        if let Some(floating) = problem.floating() {
            for (mode, along) in floating.modes().col_iter().zip(&earlier.motion) {
                for (start, r) in start.iter_mut().zip(mode.iter()) {
                    *start -= r * along;
                }
            }
            let carried = floating.modes().col_iter().map(|mode| {
                let products = mode.iter().zip(&earlier.reaction);
                -products.map(|(r, t)| r * t).sum::<f64>()
            });
            load = [carried.collect(), floating.load().to_vec()];
        }
        Self {
            earlier,
            line: Proportion::new(problem, [start, end], load),
        }
    }

    /// By Newton steps from the end of the way.
    fn back(&self, settings: &Settings, outcome: &Outcome) -> Result<WayBack, Error> {
        // A sweep would leave the state that is followed.
        let settings = Settings {
            max_sweeps: 1,
            ..*settings
        };
        let most = JUMP * self.driven();
        let (mut near, mut at, mut stride) = (outcome.clone(), 1.0, PART.0);
        while at > 0.0 && stride >= PART.1 {
            let next = f64::max(at - stride, 0.0);
            let found = solve_near(&self.line.at(next)?, &settings, &near)?;
            let apart = distance(&found.verdict.displacement, &near.verdict.displacement);
            let followed = found.status == Status::Certified
                && found.work.sweeps == 0
                && apart <= most * (at - next);
            if !followed {
                stride *= 0.5;
                continue;
            }
            if found.work.newton_steps <= FEW {
                stride *= 2.0;
            }
            (near, at) = (found, next);
        }
        // Newton steps need more room at the corners.
        Ok(match at > 2.0 * PART.1 {
            true => WayBack::Lost(at),
            false => self.arrival(&near.verdict.displacement, JUMP * f64::max(at, PART.1)),
        })
    }

    /// Whether the displacement at the start of the way is the earlier one, to a part of what drives
    /// the contacts on the whole way.
    fn arrival(&self, start: &[f64], part: f64) -> WayBack {
        match distance(start, &self.earlier.displacement) <= part * self.driven() {
            true => WayBack::Continuous,
            false => WayBack::Elsewhere,
        }
    }

    /// Largest change of û, in metre: contacts that stick do not move by themselves.
    fn driven(&self) -> f64 {
        distance(&self.line.free[0], &self.line.free[1])
    }
}

fn distance(one: &[f64], other: &[f64]) -> f64 {
    let pairs = one.iter().zip(other);
    pairs.fold(0.0, |most, (a, b)| f64::max(most, (a - b).abs()))
}
