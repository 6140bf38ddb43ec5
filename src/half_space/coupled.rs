//! A state of all contacts with its displacements, and how far it is from all laws.

use super::friction::onto_disc;
use super::points::Points;
use super::problem::{Drag, HalfSpaceProblem, Press};
use super::vectors::{Pair, add, dot, norm, scaled, sum, total};

/// What decides a state: forces per cell, and the rigid motion of the other side.
#[derive(Clone, Debug)]
pub(super) struct Held {
    /// p, and q along x and y, in N per cell.
    pub(super) force: [Vec<f64>; 3],
    /// In metre.
    pub(super) approach: f64,
    pub(super) shift: [f64; 2],
}

/// A state with its displacements, on the whole grid.
#[derive(Clone, Debug)]
pub(super) struct Coupled {
    pub(super) held: Held,
    /// g and w, in metre per cell.
    pub(super) gap: Vec<f64>,
    pub(super) slip: Pair,
    /// Natural map and resultants that are missing.
    pub(super) residual: f64,
}

impl Coupled {
    /// With fresh products.
    pub(super) fn new(problem: &HalfSpaceProblem, held: Held) -> Self {
        let Held {
            force,
            approach,
            shift,
        } = &held;
        let operator = &problem.operator;
        let points = Points::select(operator.grid(), |cell| {
            force.iter().any(|part| part[cell] != 0.0)
        });
        let [p, x, y] = [0, 1, 2].map(|c| points.gather(&force[c]));
        let raised = scaled(&p, -1.0);
        let [normal, x, y] = operator.full([&raised, &x, &y], &points, operator.whole());
        let gaps = problem.initial_gap.iter().zip(&normal);
        let gap = gaps.map(|(gap, u)| gap - approach - u).collect();
        let mut slip = [x, y];
        for axis in 0..2 {
            add(&mut slip[axis], -1.0, &problem.reference[axis]);
            slip[axis].iter_mut().for_each(|w| *w -= shift[axis]);
        }
        let mut state = Self {
            held,
            gap,
            slip,
            residual: 0.0,
        };
        state.residual = state.measure(problem);
        state
    }

    fn measure(&self, problem: &HalfSpaceProblem) -> f64 {
        let [of_normal, of_tangent, _] = problem.operator.diagonal();
        let [p, x, y] = &self.held.force;
        let square = sum(p.len(), |at| {
            let normal = p[at].min(self.gap[at] / of_normal);
            let bound = problem.friction[at] * p[at].max(0.0);
            let [q_x, q_y] = onto_disc(self.trial(at, of_tangent), bound);
            normal.powi(2) + (x[at] - q_x).powi(2) + (y[at] - q_y).powi(2)
        });
        let size = norm(p).hypot(norm(x)).hypot(norm(y));
        let most = dot(&problem.friction, p);
        let missing = self.missing(problem);
        let wanted = [total(p), most.max(norm(&missing[1..]))];
        let off = [0, 1, 2].map(|row| match missing[row] == 0.0 {
            true => 0.0,
            false => missing[row] / wanted[row.min(1)],
        });
        let laws = if square > 0.0 {
            square.sqrt() / size
        } else {
            square
        };
        laws.hypot(norm(&off))
    }

    /// `q − w/G_xx`.
    pub(super) fn trial(&self, at: usize, of_tangent: f64) -> [f64; 2] {
        [0, 1].map(|axis| self.held.force[axis + 1][at] - self.slip[axis][at] / of_tangent)
    }

    /// Resultants given, less those there are.
    pub(super) fn missing(&self, problem: &HalfSpaceProblem) -> [f64; 3] {
        let normal = match problem.press {
            Press::Load(load) => load - total(&self.held.force[0]),
            Press::Approach(_) => 0.0,
        };
        let Drag::Force(wanted) = problem.drag else {
            return [normal, 0.0, 0.0];
        };
        let [x, y] = [0, 1].map(|axis| wanted[axis] - total(&self.held.force[axis + 1]));
        [normal, x, y]
    }
}
