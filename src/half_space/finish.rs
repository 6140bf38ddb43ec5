//! Finish: Newton's method on all laws at once, for strong coupling of pressure and friction.
//!
//! ```text
//! pressed   p − g/G_NN > 0          others: p = 0, q = 0
//! slips     ‖z‖ > μ p, z = q − w/G_xx,  n = z/‖z‖,  τ ⊥ n        others of the pressed ones stick
//!
//! (S13)  g + dg = 0                                            pressed
//!        w + dw = 0                                            sticks: dq free
//!        τ·(w + dw) + Λ τ·(q + dq) = 0,   dq = μ n dp + τ dy     slips: Λ = G_xx (‖z‖ − μ p)/(μ p)
//!        Σ dp = P − Σ p   with dδ,   Σ dq = Q − Σ q   with dU      resultants that are given
//! ```
//!
//! (S13) is solved by GMRES, preconditioned on the right by the inverse symbols of (S7) and (S8) and
//! block elimination of dδ and dU. A step whose projection on the laws does not lower the residual
//! is halved; where that fails too, the loop goes on with half-steps.

use std::collections::VecDeque;

use super::coupled::Coupled;
use super::gmres::{Linear, gmres};
use super::points::Points;
use super::problem::{Drag, HalfSpaceProblem, Press};
use super::vectors::{Pair, add, total};

/// Newton steps.
const MOST_STEPS: usize = 20;

/// Steps whose largest residual the next one has to be below: where contacts change their state, a good step
/// may raise it (Grippo, Lampariello, Lucidi, SIAM J. Numer. Anal. 23 (1986) 707–716).
const MEMORY: usize = 4;

/// Share of the diagonal's Λ in the preconditioner, as in the friction half-step.
const CURVATURE: f64 = 0.7;

/// The contacts of one linearisation, and their laws' tangents.
struct Tangent<'a> {
    problem: &'a HalfSpaceProblem,
    points: Points,
    slips: Vec<bool>,
    /// n on slipping contacts.
    outward: Pair,
    /// μ.
    friction: Vec<f64>,
    /// Λ, and D of the preconditioner.
    curvature: Vec<f64>,
    damping: Vec<f64>,
    /// Rows of the resultants: 0 normal, 1 and 2 along x and y; their columns after the preconditioner.
    resultants: Vec<usize>,
    bordered: Vec<Vec<f64>>,
}

impl HalfSpaceProblem {
    /// Newton steps until the residual is below the tolerance, as long as they help; gives the best state.
    pub(super) fn finish(&self, mut state: Coupled, tolerance: f64) -> Coupled {
        let (mut best, mut last) = (state.clone(), VecDeque::from([state.residual]));
        for _ in 0..MOST_STEPS {
            if best.residual <= tolerance {
                break;
            }
            let most = last
                .iter()
                .fold(0.0, |most: f64, residual| most.max(*residual));
            let Some(next) = self.newton(&state, most, tolerance) else {
                break;
            };
            state = next;
            if state.residual < best.residual {
                best = state.clone();
            }
            last.push_back(state.residual);
            if last.len() > MEMORY {
                last.pop_front();
            }
        }
        best
    }

    /// One step of (S13); nothing if it does not lower the residual by a tenth of `most`.
    fn newton(&self, state: &Coupled, most: f64, tolerance: f64) -> Option<Coupled> {
        let tangent = Tangent::new(self, state);
        if tangent.points.is_empty() {
            return None;
        }
        let placed = tangent.placed(state);
        let right = tangent.right(&placed);
        let relative = tolerance / state.residual;
        let wanted = if state.residual > 1e-3 {
            (0.03 * relative).max(1e-3)
        } else {
            (0.1 * relative).max(1e-7)
        };
        let step = gmres(&tangent, &right, wanted)?;
        let mut share = 1.0;
        for _ in 0..4 {
            let next = tangent.moved(&placed, &step, share);
            if next.residual < 0.9 * most {
                return Some(next);
            }
            share *= 0.5;
        }
        None
    }
}

impl<'a> Tangent<'a> {
    fn new(problem: &'a HalfSpaceProblem, state: &Coupled) -> Self {
        let [of_normal, of_tangent, _] = problem.operator.diagonal();
        let pressed = |cell: usize| state.force[0][cell] - state.gap[cell] / of_normal > 0.0;
        let points = Points::select(problem.operator.grid(), pressed);
        let contacts = points.len();
        let mut resultants = Vec::new();
        if matches!(problem.press, Press::Load(_)) {
            resultants.push(0);
        }
        if matches!(problem.drag, Drag::Force(_)) && problem.has_friction() {
            resultants.extend([1, 2]);
        }
        let mut tangent = Self {
            problem,
            friction: points.gather(&problem.friction),
            points,
            slips: vec![false; contacts],
            outward: [vec![0.0; contacts], vec![0.0; contacts]],
            curvature: vec![0.0; contacts],
            damping: vec![1.0; contacts],
            resultants,
            bordered: Vec::new(),
        };
        for at in 0..contacts {
            let cell = tangent.points.cells()[at];
            let trial = state.trial(cell, of_tangent);
            let length = trial[0].hypot(trial[1]);
            let bound = tangent.friction[at] * state.force[0][cell].max(0.0);
            if length <= bound && tangent.friction[at] > 0.0 {
                continue;
            }
            tangent.slips[at] = true;
            if length > 0.0 && bound > 0.0 {
                (tangent.outward[0][at], tangent.outward[1][at]) =
                    (trial[0] / length, trial[1] / length);
                let ratio = (length - bound) / bound;
                tangent.curvature[at] = of_tangent * ratio;
                tangent.damping[at] = (1.0 + CURVATURE * ratio).sqrt().recip();
            }
        }
        let columns = tangent.resultants.iter().map(|&row| {
            let mut column = vec![0.0; 3 * contacts];
            column[row * contacts..(row + 1) * contacts].fill(-1.0);
            tangent.project(&mut column);
            tangent.inverse(&column)
        });
        tangent.bordered = columns.collect();
        tangent
    }

    fn contacts(&self) -> usize {
        self.points.len()
    }

    /// Forces where the linearised laws want them: none where open, slipping ones on their circle.
    fn placed(&self, state: &Coupled) -> Coupled {
        let cells = state.gap.len();
        let [p, mut x, mut y] = [0, 1, 2].map(|c| self.points.gather(&state.force[c]));
        for at in (0..self.contacts()).filter(|&at| self.slips[at]) {
            let [n_x, n_y] = [self.outward[0][at], self.outward[1][at]];
            let along = n_x * y[at] - n_y * x[at];
            let bound = self.friction[at] * p[at];
            (x[at], y[at]) = (bound * n_x - along * n_y, bound * n_y + along * n_x);
        }
        let force = [p, x, y].map(|part| self.points.scatter(&part, cells));
        Coupled::new(self.problem, force, state.approach, state.shift)
    }

    /// Right side of (S13): normal, x, y of the contacts, then the resultants.
    fn right(&self, placed: &Coupled) -> Vec<f64> {
        let gather = |field: &[f64]| self.points.gather(field);
        let [p, q_x, q_y] = [0, 1, 2].map(|c| gather(&placed.force[c]));
        let mut right = gather(&placed.gap);
        for (slip, force) in placed.slip.iter().zip([&q_x, &q_y]) {
            let parts = gather(slip).into_iter().zip(force).zip(&self.curvature);
            right.extend(parts.map(|((slip, force), curvature)| slip + curvature * force));
        }
        // Frictionless contacts have no equation along the tangents.
        self.project(&mut right);
        right.iter_mut().for_each(|entry| *entry = -*entry);
        debug_assert_eq!(p.len(), self.contacts());
        let missing = placed.missing(self.problem);
        right.extend(self.resultants.iter().map(|&row| missing[row]));
        right
    }

    /// What is along τ of slipping contacts; sticking ones keep all.
    fn project(&self, vector: &mut [f64]) {
        let contacts = self.contacts();
        let (_, tangential) = vector.split_at_mut(contacts);
        let (x, y) = tangential.split_at_mut(contacts);
        for at in (0..contacts).filter(|&at| self.slips[at]) {
            let [n_x, n_y] = [self.outward[0][at], self.outward[1][at]];
            let along = n_x * y[at] - n_y * x[at];
            (x[at], y[at]) = (-along * n_y, along * n_x);
        }
    }

    /// dp and dq of unknowns.
    fn forces(&self, unknown: &[f64]) -> [Vec<f64>; 3] {
        let contacts = self.contacts();
        let p = unknown[..contacts].to_vec();
        let [x, y] = [0, 1].map(|axis| {
            let start = (axis + 1) * contacts;
            let of = |at: usize| {
                unknown[start + at] + self.friction[at] * self.outward[axis][at] * p[at]
            };
            (0..contacts).map(of).collect()
        });
        [p, x, y]
    }

    fn inverse(&self, right: &[f64]) -> Vec<f64> {
        let (contacts, operator) = (self.contacts(), &self.problem.operator);
        let mut result = operator.inverse_normal(&right[..contacts], &self.points);
        let damped = |axis: usize| -> Vec<f64> {
            let part = &right[(axis + 1) * contacts..(axis + 2) * contacts];
            part.iter()
                .zip(&self.damping)
                .map(|(entry, damping)| entry * damping)
                .collect()
        };
        let pair = operator.inverse_tangential(&[damped(0), damped(1)], &self.points);
        for part in pair {
            result.extend(
                part.iter()
                    .zip(&self.damping)
                    .map(|(entry, damping)| entry * damping),
            );
        }
        self.project(&mut result);
        result
    }

    /// Sums of the forces of unknowns that resultants are given for.
    fn sums(&self, unknown: &[f64]) -> Vec<f64> {
        let forces = self.forces(unknown);
        self.resultants
            .iter()
            .map(|&row| total(&forces[row]))
            .collect()
    }

    /// The state after a share of a step, drawn back to `p ≥ 0` and the discs.
    fn moved(&self, placed: &Coupled, step: &[f64], share: f64) -> Coupled {
        let (contacts, cells) = (self.contacts(), placed.gap.len());
        let change = self.forces(&step[..3 * contacts]);
        let [mut p, mut x, mut y] = [0, 1, 2].map(|c| {
            let mut part = self.points.gather(&placed.force[c]);
            add(&mut part, share, &change[c]);
            part
        });
        for at in 0..contacts {
            p[at] = p[at].max(0.0);
            let (length, bound) = (x[at].hypot(y[at]), self.friction[at] * p[at]);
            if length > bound {
                (x[at], y[at]) = (x[at] * bound / length, y[at] * bound / length);
            }
        }
        let (mut approach, mut shift) = (placed.approach, placed.shift);
        for (&row, scalar) in self.resultants.iter().zip(&step[3 * contacts..]) {
            match row {
                0 => approach += share * scalar,
                _ => shift[row - 1] += share * scalar,
            }
        }
        let force = [p, x, y].map(|part| self.points.scatter(&part, cells));
        Coupled::new(self.problem, force, approach, shift)
    }
}

impl Linear for Tangent<'_> {
    fn apply(&self, unknown: &[f64]) -> Vec<f64> {
        let contacts = self.contacts();
        let [p, x, y] = self.forces(&unknown[..3 * contacts]);
        let lifted: Vec<f64> = p.iter().map(|p| -p).collect();
        let [u_n, u_x, u_y] =
            self.problem
                .operator
                .full([&lifted, &x, &y], &self.points, &self.points);
        let mut image: Vec<f64> = u_n.iter().map(|u| -u).collect();
        for (axis, u) in [u_x, u_y].iter().enumerate() {
            let own = &unknown[(axis + 1) * contacts..(axis + 2) * contacts];
            let parts = u.iter().zip(own).zip(&self.curvature);
            image.extend(parts.map(|((u, own), curvature)| u + curvature * own));
        }
        for (&row, scalar) in self.resultants.iter().zip(&unknown[3 * contacts..]) {
            let part = &mut image[row * contacts..(row + 1) * contacts];
            part.iter_mut().for_each(|entry| *entry -= scalar);
        }
        self.project(&mut image);
        image.extend(self.sums(&unknown[..3 * contacts]));
        image
    }

    /// `x = M r − (M B) s`, `s = (C M B)⁻¹ (C M r − ρ)`.
    fn precondition(&self, right: &[f64]) -> Vec<f64> {
        let contacts = self.contacts();
        let mut result = self.inverse(&right[..3 * contacts]);
        let count = self.resultants.len();
        let mut rest = self.sums(&result);
        for (rest, given) in rest.iter_mut().zip(&right[3 * contacts..]) {
            *rest -= given;
        }
        let columns: Vec<Vec<f64>> = self
            .bordered
            .iter()
            .map(|column| self.sums(column))
            .collect();
        let scalars = eliminate(columns, rest);
        for (column, scalar) in self.bordered.iter().zip(&scalars) {
            add(&mut result, -scalar, column);
        }
        debug_assert_eq!(scalars.len(), count);
        result.extend(scalars);
        result
    }
}

/// Solves for up to three unknowns, by elimination with the largest pivots; unknowns without one are zero.
fn eliminate(mut columns: Vec<Vec<f64>>, mut right: Vec<f64>) -> Vec<f64> {
    let count = right.len();
    let mut pivots = vec![None; count];
    let mut free: Vec<usize> = (0..count).collect();
    for column in 0..count {
        let best = free.iter().copied().max_by(|&a, &b| {
            columns[column][a]
                .abs()
                .total_cmp(&columns[column][b].abs())
        });
        let Some(row) = best.filter(|&row| columns[column][row] != 0.0) else {
            continue;
        };
        free.retain(|&other| other != row);
        pivots[column] = Some(row);
        for other in (0..count).filter(|&other| other != row) {
            let factor = columns[column][other] / columns[column][row];
            for entries in &mut columns {
                entries[other] -= factor * entries[row];
            }
            right[other] -= factor * right[row];
        }
    }
    let value = |column: usize| pivots[column].map_or(0.0, |row| right[row] / columns[column][row]);
    (0..count).map(value).collect()
}
