//! From a state of the program over all cones to one of Coulomb's law, for bodies that float.
//!
//! With no shift the program (H8) lets contacts open as they slide: its state is one of the problem whose gaps are those that
//! it left. What is beyond the gaps as they are is taken away little by little.
//!
//! ```text
//! (D19)  g_θ = g₀ − (1 − θ) δ,     δ = g₀ − u_N at θ = 0 where contacts are pressed, zero elsewhere
//! ```
//!
//! Each θ is solved by Newton steps (D4) from the state at the one before. Strides of θ that fail are shortened; a path
//! that turns back is lost.

use super::super::finish::{Finish, Springs};
use super::super::iterate::Iterate;
use super::super::settings::Clock;
use crate::kkt::Judge;
use crate::problem::ContactProblem;

/// First stride of θ, and the least.
const STRIDE: (f64, f64) = (0.25, 1e-3);

/// A stride that fails is so much shorter the next time; one that succeeds twice as long.
const SHORTER: f64 = 4.0;

/// Newton steps per θ at most, and the residual that ends them: the next θ goes on from there.
const STEPS: usize = 12;
const CLOSE: f64 = 1e-9;

/// Strides at most.
const STRIDES: usize = 200;

/// A path on its way.
pub(super) struct DilationPath<'a> {
    problem: &'a ContactProblem,
    /// δ per contact, in metre.
    dilation: Vec<f64>,
    clock: Clock,
    /// Newton steps so far.
    pub(super) steps: usize,
}

impl<'a> DilationPath<'a> {
    /// From a state of the program.
    pub(super) fn new(problem: &'a ContactProblem, start: &Iterate, clock: Clock) -> Self {
        let (beyond, normals) = (&start.verdict.beyond, problem.normals());
        let dilation = normals.iter().map(|&n| {
            let pressed = start.reaction[n] < 0.0;
            if pressed { -beyond[n] } else { 0.0 }
        });
        Self {
            problem,
            dilation: dilation.collect(),
            clock,
            steps: 0,
        }
    }

    /// The state at θ = 1; none if the path is lost.
    pub(super) fn follow(&mut self, start: &Iterate) -> Option<Iterate> {
        let mut state = self.settle(0.0, start)?;
        let (mut part, mut stride) = (0.0, STRIDE.0);
        for _ in 0..STRIDES {
            let next = f64::min(part + stride, 1.0);
            match self.settle(next, &state) {
                Some(found) if next == 1.0 => return Some(found),
                Some(found) => {
                    (state, part) = (found, next);
                    stride *= 2.0;
                }
                None => stride /= SHORTER,
            }
            if stride < STRIDE.1 || self.clock.over().is_some() {
                break;
            }
        }
        None
    }

    /// Newton steps at a θ from the state at another.
    fn settle(&mut self, part: f64, from: &Iterate) -> Option<Iterate> {
        let gaps = self.problem.initial_gap().iter().zip(&self.dilation);
        let gaps = gaps.map(|(gap, dilation)| gap - (1.0 - part) * dilation);
        let problem = self.problem.with_initial_gap(gaps.collect()).ok()?;
        let (judge, mut finish) = (Judge::new(&problem), Finish::new(&problem)?);
        let mut state = Iterate::new(&judge, from.reaction.clone(), from.motion.clone());
        for _ in 0..STEPS {
            if state.residual() <= CLOSE {
                return Some(state);
            }
            let springs = Springs {
                softness: 0.0,
                anchor: &state.reaction,
            };
            let point = finish.point(&state);
            let next = finish.step(&point, &point.beyond, springs)?;
            let motion = finish.moved(&state.motion, &next.drift);
            state = Iterate::new(&judge, next.reaction, motion);
            self.steps += 1;
        }
        (state.residual() <= CLOSE).then_some(state)
    }
}
