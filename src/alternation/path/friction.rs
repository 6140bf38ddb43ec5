//! Where the sweeps do not settle: friction raised from nothing, or lowered from rough, to what it is;
//! in the plane then surfaces that approach from afar (D10).
//!
//! ```text
//! (D9)  t(λ): the state for λ μ,  λ: 0 → 1, or 1000 → 1,  each by Newton steps (D4) from the one before
//! ```
//!
//! From state to state few contacts change what they do, and Newton steps follow where from afar
//! they would cycle. Without friction a normal program finds the first state; rough contacts slip
//! nowhere. Such a way ends where its states turn back (more than one state for the same friction); that of
//! (D10) goes round. Where all fail sweeping goes on.

use std::time::Instant;

use faer::linalg::solvers::Solve;
use faer::{Col, Mat, Side};

use super::plane::{End, PlanePath};
use crate::alternation::Shortfall;
use crate::alternation::condition::times;
use crate::alternation::finish::Finish;
use crate::alternation::iterate::Iterate;
use crate::alternation::run::Run;
use crate::cone::Role;
use crate::kkt::Judge;
use crate::problem::ContactProblem;

/// Sweeps that get their chance before.
const SWEEPS: usize = 2;

/// Friction of rough contacts, as a multiple.
const ROUGH: f64 = 1e3;

/// First and least step, as parts of the way.
const STRIDE: (f64, f64) = (0.125, 1e-3);

/// Newton steps to a state on the way at most, and how few allow a longer stride.
const STEPS: (usize, usize) = (9, 5);

/// Newton steps on the whole way at most.
const STEPS_IN_ALL: usize = 200;

/// Tolerance of the normal program, and of states on the way: their sets are right.
const CLOSE: f64 = 1e-8;

impl Run<'_> {
    /// (D9) and in the plane (D10), once, with Newton steps to the last digits.
    pub(in crate::alternation) fn follow_a_path(&mut self) {
        let given_up = self.shortfall == Some(Shortfall::ConeSolver);
        if self.is_solved() || (self.work.sweeps != SWEEPS && !given_up) {
            return;
        }
        let far = match PlanePath::of_approach(self.problem) {
            Some(_) => Self::approach,
            None => Self::descend_from_rough,
        };
        for way in [Self::climb_from_smooth, far] {
            let start = Instant::now();
            let found = way(self);
            self.work.seconds.finish += start.elapsed().as_secs_f64();
            if let Some(reaction) = found {
                self.state.reaction = reaction;
                self.judge();
                self.newton_finish();
            }
            if self.is_solved() {
                break;
            }
        }
    }

    /// (D9) from no friction.
    fn climb_from_smooth(&mut self) -> Option<Vec<f64>> {
        let reaction = self.without_friction()?;
        self.follow(reaction, |way| way)
    }

    /// (D9) from rough contacts.
    fn descend_from_rough(&mut self) -> Option<Vec<f64>> {
        let stuck = stuck(self.problem)?;
        self.follow(stuck, |way| ROUGH.powf(1.0 - way))
    }

    /// (D10).
    fn approach(&mut self) -> Option<Vec<f64>> {
        let mut path = PlanePath::of_approach(self.problem)?;
        let end = path.follow(0.0, true);
        self.work.path_changes += path.changes;
        match end {
            End::Reached(reaction) => Some(reaction),
            End::Turned(_) | End::Lost(_) => None,
        }
    }

    /// Normal reactions without friction: by Newton steps from all contacts pressed (which most often
    /// only open), or else by a normal program.
    fn without_friction(&mut self) -> Option<Vec<f64>> {
        if let Some(pressed) = pressed(self.problem) {
            let (found, steps) = state_at(self.problem, 0.0, &pressed)?;
            self.work.newton_steps += steps;
            if found.is_some() {
                return found;
            }
        }
        let mut reaction = vec![0.0; self.problem.unknowns()];
        let mut roles = vec![Role::Cone; self.problem.contacts()];
        let work = self.normal.solve(&mut reaction, &mut roles, CLOSE)?;
        self.work.normal_programs += work.programs;
        self.work.cone_iterations += work.iterations;
        Some(reaction)
    }

    /// The state for the problem's own friction, from that at the start of a way; none if the way ends
    /// before. `part` is λ at a part of the way.
    fn follow(&mut self, start: Vec<f64>, part: impl Fn(f64) -> f64) -> Option<Vec<f64>> {
        let most = self.work.newton_steps + STEPS_IN_ALL;
        let (mut reaction, mut way, mut stride) = (start, 0.0, 0.0);
        loop {
            self.work.friction_parts += 1;
            let next = f64::min(way + stride, 1.0);
            let (near, steps) = state_at(self.problem, part(next), &reaction)?;
            self.record.newton_steps += steps;
            self.work.newton_steps += steps;
            match near {
                Some(state) if next == 1.0 => return Some(state),
                Some(state) => {
                    (reaction, way) = (state, next);
                    stride = match stride {
                        0.0 => STRIDE.0,
                        _ if steps <= STEPS.1 => 2.0 * stride,
                        _ => stride,
                    };
                }
                None => stride *= 0.5,
            }
            if stride < STRIDE.1 || self.work.newton_steps > most {
                return None;
            }
        }
    }
}

/// Normal reactions that close every gap, pulling where need be; none if G does not tell them apart.
fn pressed(problem: &ContactProblem) -> Option<Vec<f64>> {
    let normals = &problem.offsets()[..problem.contacts()];
    let g = problem.compliance();
    let form = Mat::from_fn(normals.len(), normals.len(), |i, j| {
        g[(normals[i], normals[j])]
    });
    let apart = Col::from_fn(normals.len(), |contact| {
        problem.initial_gap()[contact] - problem.free_displacement()[normals[contact]]
    });
    let closing = form.llt(Side::Lower).ok()?.solve(apart);
    let mut reaction = vec![0.0; problem.unknowns()];
    for (&n, t) in normals.iter().zip(closing.iter()) {
        reaction[n] = *t;
    }
    Some(reaction)
}

/// What closes every gap and undoes every slip, pulling where need be; none without a stiffness.
pub(in crate::alternation) fn stuck(problem: &ContactProblem) -> Option<Vec<f64>> {
    let free = problem.free_displacement();
    let mut back = Col::from_fn(free.len(), |k| -free[k]);
    for (&n, gap) in problem.offsets().iter().zip(problem.initial_gap()) {
        back[n] += gap;
    }
    let reaction = times(problem.operator().stiffness()?, &back);
    Some(reaction.iter().copied().collect())
}

/// The state for this part of friction if Newton steps lead there, and how many were taken; none
/// where no Newton step is possible at all.
fn state_at(
    problem: &ContactProblem,
    part: f64,
    from: &[f64],
) -> Option<(Option<Vec<f64>>, usize)> {
    let friction = problem.friction().iter().map(|mu| part * mu).collect();
    let problem = problem.with_friction(friction).ok()?;
    let (judge, finish) = (Judge::new(&problem), Finish::new(&problem)?);
    let mut state = Iterate::new(&judge, from.to_vec(), Vec::new());
    for steps in 0..=STEPS.0 {
        if state.residual() <= CLOSE {
            return Some((Some(state.reaction), steps));
        }
        let Some(step) = finish.step(&state, &state.verdict.displacement) else {
            return Some((None, steps));
        };
        state = state.moved(&step, 1.0, &judge);
    }
    Some((None, STEPS.0 + 1))
}
