//! How far a load is from those that admissible reactions hold, and the motion that separates it from them.
//!
//! ```text
//! (H5)  min ½ ‖r‖²,   r = Qᵀ t + e,   s.t.  t ∈ K              Q r ∈ K*,  (Q r)·t = 0
//! ```
//!
//! `K* = { v : v_N + μ ‖v_T‖ ≤ 0 }` holds the velocities that no admissible reaction works against. If `r = 0`, `t` holds
//! the load; if not, `β = r/‖r‖` proves that nothing does: whatever the admissible `s`,
//! `β·(Qᵀ s + e) = (Q β)·s + e·β ≥ e·β = ‖r‖ > 0`. (H5) has no special cases: it never is infeasible or unbounded.
//!
//! It is solved by proximal steps of falling softness ε, from `t` to the minimiser of `½ ‖r‖² + ½ ε ‖s − t‖²`:
//!
//! ```text
//! s = Π(t + Q γ),   Qᵀ Π(t + Q γ) + e + ε γ = 0                 r = −ε γ
//! ```
//!
//! The equations are the gradient of the convex `φ(γ) = ½ ‖Π(t + Q γ)‖² + e·γ + ½ ε ‖γ‖²`; semismooth Newton
//! with a line search solves them (as in Zhao, Sun, Toh, SIAM J. Optim. 20 (2010) 1737–1765). They are as many as
//! there are rigid motions, however many the contacts, and every iterate is admissible.

use faer::linalg::solvers::Solve;
use faer::{Col, MatRef, Side};

use super::cone_projection::CoulombCones;
use crate::problem::velocity_basis::{norm, product};

/// Softness after a step that brought the load nearer, and after one that did not, relative to that of the step.
const SOFTER: f64 = 0.02;
const HARDER: f64 = 5.0;

/// Least softness: the motion of a load that is barely not held comes out as sharp as γ is large.
const SOFTEST: f64 = 1e-16;

/// A rest that differs by less is the same, for a load of unit size.
const SAME: f64 = 1e-14;

/// Newton steps per proximal step.
const NEWTON_STEPS: usize = 40;

/// Defect of the equations in γ, relative to the size of the trial reactions, that round-off leaves.
const ROUND_OFF: f64 = 2e-15;

/// Part of the decrease that the slope promises which a Newton step has to bring (Armijo).
const DECREASE: f64 = 1e-4;

/// Shortest part of a Newton step that is tried.
const SHORTEST: f64 = 1e-6;

/// Regularisation of the Newton matrix: relative to its diagonal, and to the defect.
const PIVOT: f64 = 1e-14;
const DAMPING: f64 = 1e-3;

/// The search for (H5), one proximal step at a time.
pub(super) struct Separation<'a> {
    cones: CoulombCones<'a>,
    q: MatRef<'a, f64>,
    load: &'a [f64],
    /// Admissible t.
    pub(super) reaction: Vec<f64>,
    /// What it leaves of the load, `r = Qᵀ t + e`.
    rest: Vec<f64>,
    softness: f64,
}

/// A trial of the Newton iteration.
struct Trial {
    gamma: Vec<f64>,
    /// `t + Q γ`, and its projection.
    target: Vec<f64>,
    reaction: Vec<f64>,
    /// `∇φ`, its size, and φ.
    gradient: Vec<f64>,
    defect: f64,
    potential: f64,
}

impl<'a> Separation<'a> {
    /// From no reaction at all, for a load of unit size.
    pub(super) fn new(cones: CoulombCones<'a>, q: MatRef<'a, f64>, load: &'a [f64]) -> Self {
        Self {
            cones,
            q,
            load,
            reaction: vec![0.0; q.nrows()],
            rest: load.to_vec(),
            softness: 1.0,
        }
    }

    /// `‖r‖`.
    pub(super) fn remainder(&self) -> f64 {
        norm(self.rest.iter().copied())
    }

    /// One proximal step; returns the motion β along which the rest of the load pulls.
    pub(super) fn step(&mut self) -> Vec<f64> {
        let found = self.minimise();
        let rest = self.rest_of(&found.reaction);
        if norm(rest.iter().copied()) <= self.remainder() + SAME {
            (self.reaction, self.rest) = (found.reaction, rest);
            self.softness = (self.softness * SOFTER).max(SOFTEST);
        } else {
            self.softness = (self.softness * HARDER).min(1.0);
        }
        let size = norm(found.gamma.iter().copied()).max(f64::MIN_POSITIVE);
        found.gamma.iter().map(|g| -g / size).collect()
    }

    /// What a motion proves: the work `e·β`, and the largest resistance of a contact to `Q β`.
    pub(super) fn work_and_resistance(&self, motion: &[f64]) -> (f64, f64) {
        let velocity = product(self.q, motion);
        (dot(self.load, motion), self.cones.resistance(&velocity))
    }

    fn rest_of(&self, reaction: &[f64]) -> Vec<f64> {
        let mut rest = product(self.q.transpose(), reaction);
        rest.iter_mut().zip(self.load).for_each(|(r, e)| *r += e);
        rest
    }

    /// The least φ, or what is left of the search for it.
    fn minimise(&self) -> Trial {
        let mut trial = self.trial(self.rest.iter().map(|r| -r / self.softness).collect());
        for _ in 0..NEWTON_STEPS {
            let floor = ROUND_OFF * (1.0 + norm(trial.target.iter().copied()));
            if trial.defect <= floor {
                break;
            }
            let Some(next) = self
                .newton_direction(&trial)
                .and_then(|d| self.descend(&trial, &d))
            else {
                break;
            };
            trial = next;
        }
        trial
    }

    fn trial(&self, gamma: Vec<f64>) -> Trial {
        let mut target = product(self.q, &gamma);
        target
            .iter_mut()
            .zip(&self.reaction)
            .for_each(|(m, t)| *m += t);
        let reaction = self.cones.project(target.clone());
        let mut gradient = self.rest_of(&reaction);
        gradient
            .iter_mut()
            .zip(&gamma)
            .for_each(|(l, g)| *l += self.softness * g);
        let potential = 0.5 * dot(&reaction, &reaction)
            + dot(self.load, &gamma)
            + 0.5 * self.softness * dot(&gamma, &gamma);
        Trial {
            defect: norm(gradient.iter().copied()),
            gamma,
            target,
            reaction,
            gradient,
            potential,
        }
    }

    /// `−(Qᵀ Π' Q + ε)⁻¹ ∇φ`.
    fn newton_direction(&self, trial: &Trial) -> Option<Vec<f64>> {
        let rank = self.q.ncols();
        let mut form = self.q.transpose() * self.cones.derivative(&trial.target, self.q);
        let largest = (0..rank).map(|j| form[(j, j)]).fold(0.0, f64::max);
        let shift = self.softness + PIVOT * largest + DAMPING * trial.defect.min(DAMPING);
        for j in 0..rank {
            form[(j, j)] += shift;
        }
        let factor = form.llt(Side::Lower).ok()?;
        let direction = factor.solve(&Col::from_fn(rank, |j| -trial.gradient[j]));
        let direction: Vec<f64> = direction.iter().copied().collect();
        direction.iter().all(|d| d.is_finite()).then_some(direction)
    }

    /// The longest of the halved steps after which φ is smaller; `None` if there is none but by round-off.
    fn descend(&self, trial: &Trial, direction: &[f64]) -> Option<Trial> {
        let slope = dot(direction, &trial.gradient);
        let mut length = 1.0;
        while length >= SHORTEST {
            let gamma = trial
                .gamma
                .iter()
                .zip(direction)
                .map(|(g, d)| g + length * d);
            let next = self.trial(gamma.collect());
            // φ is convex: as long as it falls at the end of a step it has fallen all along. Near the
            // minimum this is seen when differences of φ itself are round-off.
            if dot(direction, &next.gradient) <= 0.0
                || next.potential <= trial.potential + DECREASE * length * slope
            {
                return Some(next);
            }
            length *= 0.5;
        }
        None
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use faer::mat;

    #[test]
    fn reactions_that_hold_a_load_hold_it_to_the_last_digit_and_keep_their_cones() {
        // Two contacts side by side, μ = 0.5, under (x, down) = (0.9, 2): 0.9 < 0.5 · 2.
        let half = 0.5_f64.sqrt();
        let q = mat![[0.0, -half], [half, 0.0], [0.0, -half], [half, 0.0]];
        let cones = CoulombCones {
            offsets: &[0, 2, 4],
            friction: &[0.5; 2],
        };
        let load = [0.9 * half, -2.0 * half];
        let mut search = Separation::new(cones, q.as_ref(), &load);
        let steps = (0..20).take_while(|_| {
            search.step();
            search.remainder() > 1e-15
        });
        assert!(steps.count() < 10, "{:e}", search.remainder());
        let t = &search.reaction;
        assert!((t[1] + t[3] + 0.9).abs() < 1e-14 && (t[0] + t[2] + 2.0).abs() < 1e-14);
        assert!(t[1].abs() <= -0.5 * t[0] * (1.0 + 1e-15));
    }

    #[test]
    fn where_nothing_holds_the_load_its_rest_pulls_along_a_motion_without_resistance() {
        // As above under (2, 2): K* is 0.5 |x| ≤ up. The nearest load that is held is (1.2, 2.4), so the rest
        // (0.8, 0.4) pulls along (2, 1)/√5, on which the load (2, down 2) works with 2/√5.
        let half = 0.5_f64.sqrt();
        let q = mat![[0.0, -half], [half, 0.0], [0.0, -half], [half, 0.0]];
        let cones = CoulombCones {
            offsets: &[0, 2, 4],
            friction: &[0.5; 2],
        };
        let mut search = Separation::new(cones, q.as_ref(), &[2.0, -2.0]);
        let motion = (0..10).map(|_| search.step()).last().unwrap_or_default();
        let root = 5.0_f64.sqrt().recip();
        assert!((motion[0] - 2.0 * root).abs() < 1e-12 && (motion[1] - root).abs() < 1e-12);
        let (work, resistance) = search.work_and_resistance(&motion);
        assert!((work - 2.0 * root).abs() < 1e-12 && resistance < 1e-12);
        assert!((search.remainder() - 2.0 * root).abs() < 1e-12);
    }
}
