//! Other starts: whether a solve from elsewhere ends in the same state.
//!
//! With much friction several states can satisfy all laws for the same load. Nothing short of
//! trying tells how many, and trying proves nothing but what it finds: every state given here is certified.

use faer::Col;

use crate::alternation::{Outcome, Settings, Status, solve_from, times};
use crate::error::Error;
use crate::problem::ContactProblem;
use crate::random::Random;

/// States whose displacements differ by less than this, relative to what the reactions move, are one.
const SAME: f64 = 1e-6;

/// Random starts push up to this many times as hard as the state that was found.
const HARDER: f64 = 2.0;

/// What came of solves from other starts.
#[derive(Clone, Debug)]
pub struct OtherStarts {
    /// Number of starts.
    pub starts: usize,
    /// The different certified states, and how many of the starts led to each; the state that was
    /// already known comes first, even if no start led back to it.
    pub solutions: Vec<(Outcome, usize)>,
    /// Starts that led to no certified state.
    pub lost: usize,
}

/// Solves again from `starts` other reactions than the default one: none, friction turned round, all
/// slipping one way and the other, all sticking, then random ones, the same in every run.
///
/// `found` is a certified state of the problem.
///
/// # Errors
///
/// Those of [`solve_from`].
pub fn other_starts(
    problem: &ContactProblem,
    settings: &Settings,
    found: &Outcome,
    starts: usize,
) -> Result<OtherStarts, Error> {
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    let mut others = OtherStarts {
        starts,
        solutions: vec![(found.clone(), 0)],
        lost: 0,
    };
    let stuck = stuck(problem).unwrap_or_else(|| vec![0.0; problem.unknowns()]);
    for number in 0..starts {
        let start = start(problem, &found.reaction, &stuck, number, &mut random);
        let outcome = solve_from(problem, settings, &start, &found.motion)?;
        others.add(problem, outcome);
    }
    Ok(others)
}

impl OtherStarts {
    fn add(&mut self, problem: &ContactProblem, outcome: Outcome) {
        if outcome.status != Status::Certified {
            self.lost += 1;
            return;
        }
        let mut known = self.solutions.iter_mut();
        let found = &outcome.verdict.displacement;
        let free = problem.free_displacement();
        match known.find(|(known, _)| same(free, &known.verdict.displacement, found)) {
            Some((_, led)) => *led += 1,
            None => self.solutions.push((outcome, 1)),
        }
    }
}

/// Whether two displacements are one, where nothing but the reactions moves contacts from `free`.
fn same(free: &[f64], one: &[f64], other: &[f64]) -> bool {
    let (mut apart, mut moved) = (0.0_f64, 0.0_f64);
    for ((a, b), free) in one.iter().zip(other).zip(free) {
        apart = apart.max((a - b).abs());
        moved = moved.max((a - free).abs()).max((b - free).abs());
    }
    apart <= SAME * moved
}

/// The start of this number.
fn start(
    problem: &ContactProblem,
    found: &[f64],
    stuck: &[f64],
    number: usize,
    random: &mut Random,
) -> Vec<f64> {
    if number == 4 {
        return stuck.to_vec();
    }
    let sizes = found.iter().chain(stuck).map(|t| t.abs());
    let largest = sizes.fold(0.0, f64::max);
    let mut start = vec![0.0; found.len()];
    for (contact, ends) in problem.offsets().windows(2).enumerate() {
        let (n, tangents) = (ends[0], ends[0] + 1..ends[1]);
        let bound = within(problem.friction_bound(contact, found[n]), largest);
        match number {
            0 => {}
            1 => {
                start[n] = found[n];
                tangents.for_each(|k| start[k] = -found[k]);
            }
            2 | 3 => {
                start[n] = found[n];
                let way = if number == 2 { 1.0 } else { -1.0 };
                tangents.take(1).for_each(|k| start[k] = way * bound);
            }
            _ => {
                start[n] = -HARDER * largest * random.part();
                let reach = within(problem.friction_bound(contact, start[n]), largest);
                tangents.for_each(|k| start[k] = reach * (2.0 * random.part() - 1.0));
            }
        }
    }
    start
}

/// A radius; of one without end, the largest reaction.
fn within(bound: f64, largest: f64) -> f64 {
    if bound.is_finite() { bound } else { largest }
}

/// What closes every gap and undoes every slip, pulling where need be; none without a stiffness.
fn stuck(problem: &ContactProblem) -> Option<Vec<f64>> {
    let free = problem.free_displacement();
    let mut back = Col::from_fn(free.len(), |k| -free[k]);
    for (&n, gap) in problem.offsets().iter().zip(problem.initial_gap()) {
        back[n] += gap;
    }
    let reaction = times(problem.operator().stiffness()?, &back);
    Some(reaction.iter().copied().collect())
}
