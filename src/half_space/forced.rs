//! Friction half-step under a given force: the shift is found together with the tangential forces.
//!
//! ```text
//! (S18)  Σ q(U) = Q,   q(U): (S8) with c − U         Q − Σ q: slope of a concave function of U
//!        U ← U + K⁻¹ (Q − Σ q),                      K = Σ E (G_TT + Λ)⁻¹ E
//! ```
//!
//! K vanishes where all contacts slip: their sum nears what friction carries like the inverse square of
//! the shift, to which a tangent tells nothing far away. So a move ends where K would have lifted all that
//! friction carries some times over. Where the slope along it has turned it went too far, and the next one
//! goes back by half of it at most.

use super::friction::{FrictionHalfStep, Rubbed};
use super::vectors::{Pair, add_pair, total, zero_pair};

/// Moves of the other side after which the half-step gives up.
const MOST_MOVES: usize = 60;

/// Relative tolerance of the stiffness K: it only steers.
const STIFFNESS: f64 = 0.1;

/// Longest move, over what K along x or y would take for all that friction carries.
const FARTHEST: f64 = 3.0;

/// Determinant of K, over the product of its diagonal, below which a move just follows the missing force.
const SINGULAR: f64 = 1e-12;

impl FrictionHalfStep<'_> {
    /// Solves (S18) until natural map and missing force are below `tolerance`, the latter relative to what
    /// friction carries; gives also by how much the shift changed, which the slip without tangential
    /// forces then has.
    pub(super) fn solve_under(
        &mut self,
        wanted: [f64; 2],
        force: Pair,
        tolerance: f64,
    ) -> (Rubbed, [f64; 2]) {
        let (most, size) = (total(self.bound), wanted[0].hypot(wanted[1]));
        let mut state = self.solve(force, tolerance);
        let (mut shift, mut moved, mut reach) = ([0.0; 2], [0.0; 2], f64::INFINITY);
        for _ in 0..MOST_MOVES {
            let missing = [0, 1].map(|axis| wanted[axis] - total(&state.force[axis]));
            if missing[0].hypot(missing[1]) <= tolerance * most.max(size) {
                break;
            }
            let turned = missing[0] * moved[0] + missing[1] * moved[1] < 0.0;
            reach = if turned {
                0.5 * moved[0].hypot(moved[1])
            } else {
                2.0 * reach
            };
            let force;
            (moved, force) = self.aim(&state, missing, reach);
            for axis in 0..2 {
                shift[axis] += moved[axis];
                self.constant[axis]
                    .iter_mut()
                    .for_each(|w| *w -= moved[axis]);
            }
            state = self.solve(force, tolerance);
            if size > most {
                break;
            }
        }
        (state, shift)
    }

    /// A move of the other side by what the missing force takes, and the forces that go with it.
    fn aim(&self, state: &Rubbed, missing: [f64; 2], reach: f64) -> ([f64; 2], Pair) {
        // Slipped on by what the missing force at least moves, so that contacts which did not slip yet
        // stick where it takes them back.
        let least = self.operator.diagonal()[1] / self.bound.len() as f64;
        let mut slip = state.slip.clone();
        for (part, missing) in slip.iter_mut().zip(missing) {
            part.iter_mut().for_each(|w| *w -= least * missing);
        }
        let tangent = self.tangent(&state.force, &slip);
        let steps = [0, 1].map(|axis| {
            let mut unit = zero_pair(self.bound.len());
            unit[axis].fill(1.0);
            self.newton(&tangent, unit, STIFFNESS).0
        });
        let [[k_xx, k_yx], [k_xy, k_yy]] =
            [0, 1].map(|axis| [0, 1].map(|row| total(&steps[axis][row])));
        let determinant = k_xx * k_yy - k_xy * k_yx;
        let reach = reach.min(FARTHEST * total(self.bound) / k_xx.max(k_yy));
        let wished = match determinant > SINGULAR * k_xx * k_yy {
            true => [
                (k_yy * missing[0] - k_xy * missing[1]) / determinant,
                (k_xx * missing[1] - k_yx * missing[0]) / determinant,
            ],
            false => missing.map(|part| part * reach / missing[0].hypot(missing[1])),
        };
        let share = (reach / wished[0].hypot(wished[1])).min(1.0);
        let moved = wished.map(|part| part * share);
        let mut force = state.force.clone();
        for (moved, step) in moved.iter().zip(&steps) {
            add_pair(&mut force, *moved, step);
        }
        (moved, force)
    }
}
