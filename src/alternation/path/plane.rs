//! A path of states of plane contact, followed exactly from one change of a contact to the next.
//!
//! ```text
//!        u = û + λ h + G t
//!
//!        open    t = 0                           while  g₀ − u_N ≥ 0
//! (D10)  slip    u_N = g₀,  t_T = −μ t_N d       while  −t_N ≥ 0,  −d u_T ≥ 0        d = ±1
//!        stick   u_N = g₀,  u_T = 0              while  −μ t_N ∓ t_T ≥ 0
//! ```
//!
//! In the plane the laws have straight pieces only: while no contact changes what it does, `t` and `u`
//! are linear in λ. Where a condition is about to break its contact changes, and λ goes on, or turns
//! back where one λ has several states, whichever leads into the new piece: complementary pivoting
//! (Cottle, Pang, Stone, The Linear Complementarity Problem, 1992, §4.4).
//!
//! With `h = −1` along the normals nothing touches while λ is large, and the path brings the surfaces
//! together. It cannot come back to where it started, as `t = 0` is the only state there, nor
//! run off, as a positive definite G bounds all states: it ends at λ = 0, in a state of the problem, however
//! much friction there is.
//!
//! That end may be far: pieces can be as many as the sets of contacts. A path is left, as lost, after a thousand
//! changes per contact, or after the products of two numbers that a minute has time for (a change takes a third of
//! the cube of the pressed unknowns, and twice the square of all), or when the time of the solve is over.

use faer::Col;

use super::plane_piece::{Condition, Does, Line, Piece, is_rough};
use crate::alternation::Outcome;
use crate::alternation::settings::Clock;
use crate::kkt::ContactStatus;
use crate::problem::ContactProblem;

/// Changes of contacts on a path at most, per contact.
const CHANGES: usize = 1000;

/// Products of two numbers on a path at most: that of a minute.
const PRODUCTS: f64 = 1e12;

/// A condition that changes by less than this part of the fastest does not change.
const STILL: f64 = 1e-13;

/// How a path ended.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum End {
    /// At the λ asked for, with this reaction.
    Reached(Vec<f64>),
    /// Where it turned back.
    Turned(f64),
    /// Where it was left: no next piece, or too many.
    Lost(f64),
}

/// A path on its way.
pub(crate) struct PlanePath<'a> {
    piece: Piece<'a>,
    /// λ.
    parameter: f64,
    /// Sign of the change of λ.
    way: f64,
    /// Contacts that changed so far, one after the other.
    pub(crate) changes: usize,
    products: f64,
    bound: Bound,
}

/// What a path may take.
struct Bound {
    changes: usize,
    products: f64,
    clock: Clock,
}

impl<'a> PlanePath<'a> {
    /// From surfaces far apart; none if a contact has two tangents or another law than Coulomb's, or bodies float.
    pub(in crate::alternation) fn of_approach(problem: &'a ContactProblem) -> Option<Self> {
        let mut drive = Col::zeros(problem.unknowns());
        let mut deepest = 0.0_f64;
        for (&n, gap) in problem.offsets().iter().zip(problem.initial_gap()) {
            drive[n] = -1.0;
            deepest = deepest.max(problem.free_displacement()[n] - gap);
        }
        Self::new(
            problem,
            drive,
            vec![Does::Open; problem.contacts()],
            2.0 * deepest,
        )
    }

    /// From a state with λ = 1 of a problem that is given with λ = 0, driven by `drive` in metre per
    /// unknown; none if a contact has two tangents, or bodies float.
    pub(crate) fn back(
        problem: &'a ContactProblem,
        outcome: &Outcome,
        drive: &[f64],
    ) -> Option<Self> {
        let does = outcome.verdict.status.iter().enumerate();
        let does = does.map(|(contact, status)| match status {
            ContactStatus::Open => Does::Open,
            ContactStatus::Stick => Does::Stick,
            ContactStatus::Slip => {
                let friction = outcome.reaction.get(problem.offsets()[contact] + 1);
                match friction {
                    Some(t) if is_rough(problem, contact) => Does::Slip(t.signum()),
                    _ => Does::Slip(0.0),
                }
            }
        });
        let drive = Col::from_fn(drive.len(), |k| drive[k]);
        Self::new(problem, drive, does.collect(), 1.0)
    }

    fn new(
        problem: &'a ContactProblem,
        drive: Col<f64>,
        does: Vec<Does>,
        parameter: f64,
    ) -> Option<Self> {
        let blocks = problem.offsets().windows(2);
        let plane = blocks.into_iter().all(|ends| ends[1] - ends[0] <= 2);
        (plane && problem.floating().is_none() && problem.laws().is_none()).then(|| Self {
            piece: Piece {
                problem,
                drive,
                does,
            },
            parameter,
            way: -1.0,
            changes: 0,
            products: 0.0,
            bound: Bound {
                changes: CHANGES * problem.contacts(),
                products: PRODUCTS,
                clock: Clock::endless(),
            },
        })
    }

    /// The same, left when the time of a solve is over.
    pub(in crate::alternation) fn until(mut self, clock: Clock) -> Self {
        self.bound.clock = clock;
        self
    }

    /// Follows the path down to a λ, round its turns if it may turn.
    pub(crate) fn follow(&mut self, end: f64, turning: bool) -> End {
        let mut next = self.piece.line(self.parameter);
        while let Some(line) = next {
            let (stride, broken) = match self.first_to_break(&line, end) {
                None => break,
                Some((_, None)) => return End::Reached(self.piece.last(end)),
                Some((stride, Some(broken))) => (stride, broken),
            };
            self.parameter += self.way * stride;
            let Some((line, way)) = self.cross(broken) else {
                break;
            };
            if way != self.way && !turning {
                return End::Turned(self.parameter);
            }
            (next, self.way) = (Some(line), way);
        }
        End::Lost(self.parameter)
    }

    /// The condition that breaks first on the way, and the distance to it; or to the end. None if λ
    /// grows without end.
    fn first_to_break(&self, line: &Line, end: f64) -> Option<(f64, Option<Condition>)> {
        let mut first = (self.way < 0.0).then_some((self.parameter - end, None));
        for contact in 0..self.piece.problem.contacts() {
            for condition in self.piece.conditions(line, contact).into_iter().flatten() {
                let rate = self.way * condition.rate;
                if rate >= -STILL * condition.scale {
                    continue;
                }
                let distance = condition.value.max(0.0) / -rate;
                if first.is_none_or(|(nearest, _)| distance < nearest) {
                    first = Some((distance, Some(condition)));
                }
            }
        }
        first
    }

    fn is_too_far(&self) -> bool {
        let Bound {
            changes,
            products,
            clock,
        } = self.bound;
        self.changes > changes || self.products > products || clock.over().is_some()
    }

    /// The piece beyond a condition, and the sign of the change of λ that leads into it; none if there
    /// is none, or if it would be one too many.
    fn cross(&mut self, broken: Condition) -> Option<(Line, f64)> {
        self.changes += 1;
        self.products += self.piece.products();
        if self.is_too_far() {
            return None;
        }
        let before = std::mem::replace(&mut self.piece.does[broken.contact], broken.beyond);
        let line = self.piece.line(self.parameter)?;
        // An open contact closes into the slip that its motion asks for, be it not the one it came from.
        let open = broken.beyond == Does::Open;
        let edges = self.piece.conditions(&line, broken.contact);
        let mut edges = edges.into_iter().flatten();
        let edge = edges.find(|edge| open || edge.beyond == before)?;
        (edge.rate != 0.0).then(|| (line, edge.rate.signum()))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use std::time::Duration;

    use faer::{Mat, mat};

    use super::*;
    use crate::alternation::{Settings, solve};
    use crate::problem::Operator;

    /// One contact, K = G⁻¹ = [[2, 1], [1, 1]]; more than one state for some loads if μ > 1.
    fn contact(friction: f64, free: [f64; 2]) -> ContactProblem {
        let operator = Operator::from_compliance(mat![[1.0, -1.0], [-1.0, 2.0]]).unwrap();
        ContactProblem::new(&[1], vec![friction], vec![0.0], free.to_vec(), operator).unwrap()
    }

    fn assert_reaches(path: &mut PlanePath<'_>, expected: [f64; 2]) {
        let End::Reached(found) = path.follow(0.0, true) else {
            unreachable!()
        };
        let off = (found[0] - expected[0]).hypot(found[1] - expected[1]);
        assert!(off < 1e-14, "{found:?}");
    }

    #[test]
    fn an_approach_ends_in_a_state_that_sticks() {
        // û = (1, 0.2): t = −K û = (−2.2, −1.2), |t_T| <= 1.5 · 2.2.
        let problem = contact(1.5, [1.0, 0.2]);
        assert_reaches(&mut PlanePath::of_approach(&problem).unwrap(), [-2.2, -1.2]);
    }

    #[test]
    fn an_approach_goes_round_its_turn() {
        // û = (−0.1, 0.5) is open, slips with t = (−0.2, −0.3), or sticks (references, item 12, μ > 1). Closing
        // gaps from afar, n = −0.1 − λ, never touches.
        let problem = contact(1.5, [-0.1, 0.5]);
        let mut path = PlanePath::of_approach(&problem).unwrap();
        assert_eq!(path.follow(0.0, true), End::Reached(vec![0.0, 0.0]));
        // From û = (0.1, 0.5) every approach passes n = 0, where the open contact starts to slip along its
        // friction: u_N = n − λ + t_N − t_T = 0 with t_T = 1.5 t_N gives t_N = 2 (n − λ) < 0 only while λ
        // grows again, up to where it sticks (τ = 4 |n − λ|: λ = 0.225), and on to t = −K û.
        let problem = contact(1.5, [0.1, 0.5]);
        let mut path = PlanePath::of_approach(&problem).unwrap();
        assert_reaches(&mut path, [-0.7, -0.6]);
        assert_eq!(path.changes, 2);
    }

    #[test]
    fn a_path_that_takes_more_than_it_may_is_left() {
        // The same path: it closes at λ = 0.1, sticks at 0.225, and is there.
        let problem = contact(1.5, [0.1, 0.5]);
        let path = || PlanePath::of_approach(&problem).unwrap();
        let left = |mut path: PlanePath<'_>, at: f64, changes: usize| {
            let End::Lost(parameter) = path.follow(0.0, true) else {
                unreachable!()
            };
            assert!((parameter - at).abs() < 1e-11, "{parameter}");
            assert_eq!(path.changes, changes);
        };
        let mut short = path();
        short.bound.changes = 1;
        left(short, 0.225, 2);
        // A piece with one column of two unknowns: 1/3 + 2 · 4 products; the next one takes more.
        let mut slow = path();
        slow.bound.products = 10.0;
        left(slow, 0.225, 2);
        let over = Settings {
            time_limit: Some(Duration::ZERO),
            ..Settings::default()
        };
        left(path().until(Clock::start(&over)), 0.1, 1);
    }

    #[test]
    fn a_way_back_stops_where_the_state_turns() {
        // From û = (0.1, 0.5), sticking, to (−0.1, 0.3): n = −0.1 + 0.2 λ, τ = 0.3 + 0.2 λ. It sticks
        // while τ >= 4 |n|, to λ = 0.1, and slips from there on with more load only.
        let end = contact(1.5, [0.1, 0.5]);
        let outcome = solve(&end, &Settings::default()).unwrap();
        let start = contact(1.5, [-0.1, 0.3]);
        let mut path = PlanePath::back(&start, &outcome, &[0.2, 0.2]).unwrap();
        let End::Turned(part) = path.follow(0.0, false) else {
            unreachable!()
        };
        // The end is certified to 1e-12 and its gaps are shifted by as much; λ moves five times as fast as n.
        assert!((part - 0.1).abs() < 1e-11, "{part}");
    }

    #[test]
    fn contacts_in_space_have_no_plane_path() {
        let operator = Operator::from_compliance(Mat::identity(3, 3)).unwrap();
        let problem = ContactProblem::new(&[2], vec![0.5], vec![0.0], vec![0.0; 3], operator);
        assert!(PlanePath::of_approach(&problem.unwrap()).is_none());
    }
}
