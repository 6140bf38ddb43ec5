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

use nalgebra::{DMatrix, DVector};

use super::coupled::{Coupled, Held};
use super::friction::{Tangent, onto_disc, pick, put};
use super::gmres::{Linear, gmres};
use super::points::Points;
use super::problem::{Drag, HalfSpaceProblem, Press};
use super::vectors::{add, largest, scaled, total};

/// Newton steps.
const MOST_STEPS: usize = 20;

/// Steps whose largest residual the next one has to be below: where contacts change their state, a good step
/// may raise it (Grippo, Lampariello, Lucidi, SIAM J. Numer. Anal. 23 (1986) 707–716).
const MEMORY: usize = 4;

/// The contacts of one linearisation, and their laws' tangents.
struct Linearised<'a> {
    problem: &'a HalfSpaceProblem,
    points: Points,
    tangent: Tangent,
    /// μ.
    friction: Vec<f64>,
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
            let Some(next) = self.newton(&state, largest(&last), tolerance) else {
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
        let laws = Linearised::new(self, state);
        if laws.points.is_empty() {
            return None;
        }
        let placed = laws.placed(state);
        let right = laws.right(&placed);
        let relative = tolerance / state.residual;
        let (part, least) = match state.residual > 1e-3 {
            true => (0.03, 1e-3),
            false => (0.1, 1e-7),
        };
        let step = gmres(&laws, &right, f64::max(part * relative, least))?;
        let mut shares = [1.0, 0.5, 0.25, 0.125].into_iter();
        shares.find_map(|share| {
            let next = laws.moved(&placed, &step, share);
            (next.residual < 0.9 * most).then_some(next)
        })
    }
}

impl<'a> Linearised<'a> {
    fn new(problem: &'a HalfSpaceProblem, state: &Coupled) -> Self {
        let [of_normal, of_tangent, _] = problem.operator.diagonal();
        let pressed = |cell: usize| state.held.force[0][cell] - state.gap[cell] / of_normal > 0.0;
        let points = Points::select(problem.operator.grid(), pressed);
        let friction = points.gather(&problem.friction);
        let mut tangent = Tangent::new(points.len());
        for (at, &cell) in points.cells().iter().enumerate() {
            let trial = state.trial(cell, of_tangent);
            let length = trial[0].hypot(trial[1]);
            let bound = friction[at] * state.held.force[0][cell].max(0.0);
            if length > 0.0 && bound > 0.0 && length > bound {
                let curvature = of_tangent * (length - bound) / bound;
                let outward = trial.map(|part| part / length);
                tangent.slip(at, outward, curvature, of_tangent);
            } else if length > bound || friction[at] <= 0.0 {
                tangent.slip(at, [0.0; 2], 0.0, of_tangent);
            }
        }
        let mut resultants = Vec::new();
        if matches!(problem.press, Press::Load(_)) {
            resultants.push(0);
        }
        if matches!(problem.drag, Drag::Force(_)) && problem.has_friction() {
            resultants.extend([1, 2]);
        }
        let mut laws = Self {
            problem,
            points,
            tangent,
            friction,
            resultants,
            bordered: Vec::new(),
        };
        let columns = laws.resultants.iter().map(|&row| {
            let mut column = [0, 1, 2].map(|_| vec![0.0; laws.points.len()]);
            column[row].fill(-1.0);
            laws.inverse(&laws.projected(column))
        });
        laws.bordered = columns.collect();
        laws
    }

    /// Normal, x and y of a vector of unknowns or of their equations.
    fn parts<'v>(&self, vector: &'v [f64]) -> [&'v [f64]; 3] {
        let contacts = self.points.len();
        [0, 1, 2].map(|component| &vector[component * contacts..(component + 1) * contacts])
    }

    /// One vector of three parts: along τ of slipping contacts, all of sticking ones.
    fn projected(&self, [normal, mut x, mut y]: [Vec<f64>; 3]) -> Vec<f64> {
        self.tangent.project([&mut x, &mut y]);
        [normal, x, y].concat()
    }

    /// Forces where the linearised laws want them: none where open, slipping ones on their circle.
    fn placed(&self, state: &Coupled) -> Coupled {
        let [p, x, y] = [0, 1, 2].map(|c| self.points.gather(&state.held.force[c]));
        let placed = self.forces(&self.projected([p, x, y]));
        self.coupled(state, placed, 0.0, &[])
    }

    /// A state of such forces on the contacts, moved by a share of a step's approach and shift.
    fn coupled(&self, from: &Coupled, force: [Vec<f64>; 3], share: f64, step: &[f64]) -> Coupled {
        let mut held = Held {
            force: force.map(|part| self.points.scatter(&part, from.gap.len())),
            approach: from.held.approach,
            shift: from.held.shift,
        };
        for (&row, scalar) in self.resultants.iter().zip(step) {
            match row {
                0 => held.approach += share * scalar,
                _ => held.shift[row - 1] += share * scalar,
            }
        }
        Coupled::new(self.problem, held)
    }

    /// Right side of (S13): normal, x, y of the contacts, then the resultants.
    fn right(&self, placed: &Coupled) -> Vec<f64> {
        let [q_x, q_y] = [1, 2].map(|axis| self.points.gather(&placed.held.force[axis]));
        let mut laws =
            [&placed.gap, &placed.slip[0], &placed.slip[1]].map(|w| self.points.gather(w));
        let [_, x, y] = &mut laws;
        self.tangent.bend([x, y], [&q_x, &q_y]);
        // Frictionless contacts have no equation along the tangents.
        let mut right = self.projected(laws);
        right.iter_mut().for_each(|entry| *entry = -*entry);
        let missing = placed.missing(self.problem);
        right.extend(self.resultants.iter().map(|&row| missing[row]));
        right
    }

    /// dp and dq of unknowns.
    fn forces(&self, unknown: &[f64]) -> [Vec<f64>; 3] {
        let [p, x, y] = self.parts(unknown);
        let along = |own: &[f64], outward: &[f64]| {
            let of = |at: usize| own[at] + self.friction[at] * outward[at] * p[at];
            (0..p.len()).map(of).collect()
        };
        let [n_x, n_y] = &self.tangent.outward;
        [p.to_vec(), along(x, n_x), along(y, n_y)]
    }

    fn inverse(&self, right: &[f64]) -> Vec<f64> {
        let (operator, [normal, x, y]) = (&self.problem.operator, self.parts(right));
        let mut result = operator.inverse_normal(normal, &self.points);
        let tangential = [x.to_vec(), y.to_vec()];
        let pair = self.tangent.inverse(operator, &tangential, &self.points);
        result.extend(pair.concat());
        result
    }

    /// Sums of the forces of unknowns that resultants are given for.
    fn sums(&self, unknown: &[f64]) -> DVector<f64> {
        let forces = self.forces(unknown);
        let sums = self.resultants.iter().map(|&row| total(&forces[row]));
        DVector::from_iterator(self.resultants.len(), sums)
    }

    /// The state after a share of a step, drawn back to `p ≥ 0` and the discs.
    fn moved(&self, placed: &Coupled, step: &[f64], share: f64) -> Coupled {
        let change = self.forces(step);
        let [mut p, x, y] = [0, 1, 2].map(|c| {
            let mut part = self.points.gather(&placed.held.force[c]);
            add(&mut part, share, &change[c]);
            part
        });
        let mut pair = [x, y];
        for (at, p) in p.iter_mut().enumerate() {
            *p = p.max(0.0);
            let drawn = onto_disc(pick(&pair, at), self.friction[at] * *p);
            put(&mut pair, at, drawn);
        }
        let [x, y] = pair;
        self.coupled(placed, [p, x, y], share, &step[3 * self.points.len()..])
    }
}

impl Linear for Linearised<'_> {
    fn apply(&self, unknown: &[f64]) -> Vec<f64> {
        let (operator, points) = (&self.problem.operator, &self.points);
        let [p, x, y] = self.forces(unknown);
        let lifted = scaled(&p, -1.0);
        let [mut normal, x, y] = operator.full([&lifted, &x, &y], points, points);
        normal.iter_mut().for_each(|u| *u = -*u);
        let mut image = [normal, x, y];
        let [_, x, y] = &mut image;
        let [_, of_x, of_y] = self.parts(unknown);
        self.tangent.bend([x, y], [of_x, of_y]);
        for (&row, scalar) in self.resultants.iter().zip(&unknown[3 * points.len()..]) {
            image[row].iter_mut().for_each(|entry| *entry -= scalar);
        }
        let mut image = self.projected(image);
        image.extend(&self.sums(unknown));
        image
    }

    /// `x = M r − (M B) s`, `s = (C M B)⁻¹ (C M r − ρ)`.
    fn precondition(&self, right: &[f64]) -> Vec<f64> {
        let mut result = self.inverse(right);
        if self.resultants.is_empty() {
            return result;
        }
        let given = DVector::from_column_slice(&right[3 * self.points.len()..]);
        let rest = self.sums(&result) - given;
        let columns: Vec<_> = self
            .bordered
            .iter()
            .map(|column| self.sums(column))
            .collect();
        let border = DMatrix::from_columns(&columns).svd(true, true);
        // What no force answers to, such as the approach of a full periodic surface, is left as it is.
        let none = f64::EPSILON * border.singular_values.max();
        let scalars = border.solve(&rest, none).unwrap_or(rest);
        for (column, scalar) in self.bordered.iter().zip(&scalars) {
            add(&mut result, -scalar, column);
        }
        result.extend(&scalars);
        result
    }
}
