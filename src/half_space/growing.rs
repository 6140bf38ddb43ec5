//! Strong friction: the coefficient grows to what it is, and the contacts with it.
//!
//! ```text
//! (S17)  μ_s = s μ,  Q_s = s Q,   s: s₀ → 1        s₀ max μ |β| = 1/2
//! ```
//!
//! Half-steps in turn contract by about μ|β|, so that beyond 1 they part from the solution, and Newton's method
//! (S13) finds it only from nearby. At s₀ half-steps converge; from there every s starts Newton's method at the
//! state before, slipping forces grown with their discs. Factors between one s and the next are squared where it
//! succeeds and rooted where it fails. A given force grows with s, so that friction can carry it all the way.

use super::coupled::Coupled;
use super::outcome::HalfSpaceWork;
use super::problem::{Drag, HalfSpaceProblem};
use super::vectors::largest;

/// μ|β| that half-steps in turn cope with.
const WEAK: f64 = 0.5;

/// Residual of the states on the way.
const ON_THE_WAY: f64 = 1e-4;

/// First, largest and least factor from one s to the next.
const FACTORS: [f64; 3] = [1.5, 2.0, 1.002];

/// A force this close to the edge of its disc, relative to the radius, slips.
const ON_EDGE: f64 = 1e-6;

impl HalfSpaceProblem {
    /// Largest μ|β|.
    pub(super) fn strength(&self) -> f64 {
        largest(&self.friction) * self.operator.dundurs()
    }

    /// Follows (S17) from rest; nothing where s cannot reach 1.
    pub(super) fn grown(&self, tolerance: f64, work: &mut HalfSpaceWork) -> Option<Coupled> {
        let mut share = (WEAK / self.strength()).min(1.0);
        let mut problem = self.clone();
        problem.take_share(self, share);
        // Products on this grid are the caller's to count.
        let mut of_coarse = HalfSpaceWork::default();
        let start = problem.start(ON_THE_WAY, &mut of_coarse).ok()?;
        work.transforms += of_coarse.transforms;
        let end = problem.run(start, ON_THE_WAY, &mut of_coarse);
        let mut state = end.iterate.coupled(&problem);
        let mut factor = FACTORS[0];
        while share < 1.0 {
            let next = (share * factor).min(1.0);
            problem.take_share(self, next);
            let start = state.grown(&problem, next / share);
            let found = problem.finish(start, ON_THE_WAY);
            if found.residual <= ON_THE_WAY {
                (state, share) = (found, next);
                factor = (factor * factor).min(FACTORS[1]);
            } else {
                factor = factor.sqrt();
                if factor < FACTORS[2] {
                    return None;
                }
            }
        }
        Some(self.finish(state, tolerance))
    }

    /// Friction and force become a share of what they are in the whole problem.
    fn take_share(&mut self, whole: &Self, share: f64) {
        for (mu, whole) in self.friction.iter_mut().zip(&whole.friction) {
            *mu = whole * share;
        }
        if let Drag::Force(force) = whole.drag {
            self.drag = Drag::Force(force.map(|part| part * share));
        }
    }
}

impl Coupled {
    /// The state where friction is `factor` times as strong: what slips grows with its disc.
    fn grown(&self, problem: &HalfSpaceProblem, factor: f64) -> Self {
        let mut held = self.held.clone();
        let [p, x, y] = &mut held.force;
        for at in 0..p.len() {
            let edge = problem.friction[at] * p[at].max(0.0) / factor;
            if x[at].hypot(y[at]) >= edge * (1.0 - ON_EDGE) {
                (x[at], y[at]) = (x[at] * factor, y[at] * factor);
            }
        }
        Self::new(problem, held)
    }
}
