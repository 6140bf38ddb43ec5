//! The half-space as the compliance of a contact problem: three unknowns per cell.

use std::ops::Range;

use faer::Mat;

use super::operator::HalfSpace;
use super::points::Points;
use super::problem::{Drag, HalfSpaceProblem, Press};
use crate::error::Error;
use crate::problem::{Compliance, ContactProblem, Floating};

impl Compliance for HalfSpace {
    fn size(&self) -> usize {
        3 * self.grid().len()
    }

    fn add_product(&self, force: &[f64], displacement: &mut [f64]) {
        let part = |axis: usize| force.iter().skip(axis).step_by(3).copied().collect();
        let forces: [Vec<f64>; 3] = [0, 1, 2].map(part);
        let moved = self.full(
            [&forces[0], &forces[1], &forces[2]],
            self.whole(),
            self.whole(),
        );
        for (at, u) in displacement.iter_mut().enumerate() {
            *u += moved[at % 3][at / 3];
        }
    }

    fn diagonal_block(&self, _: Range<usize>) -> [[f64; 3]; 3] {
        let [normal, x, y] = self.diagonal();
        [[normal, 0.0, 0.0], [0.0, x, 0.0], [0.0, 0.0, y]]
    }

    fn precondition(&self, on: &[usize], residual: &[f64]) -> Vec<f64> {
        let cells = self.grid().len();
        let mut chosen = vec![false; cells];
        let mut forces = [0, 1, 2].map(|_| vec![0.0; cells]);
        for (&unknown, value) in on.iter().zip(residual) {
            chosen[unknown / 3] = true;
            forces[unknown % 3][unknown / 3] = *value;
        }
        let points = Points::select(self.grid(), |cell| chosen[cell]);
        let [normal, x, y] = forces.map(|force| points.gather(&force));
        let normal = self.inverse_normal(&normal, &points);
        let [x, y] = self.inverse_tangential(&[x, y], &points);
        let moved = [normal, x, y].map(|part| points.scatter(&part, cells));
        on.iter().map(|at| moved[at % 3][at / 3]).collect()
    }
}

impl HalfSpaceProblem {
    /// The same as a contact problem on the same operator, two tangents per cell; what is free of the
    /// rigid motion is a mode of its own (C3).
    ///
    /// # Errors
    ///
    /// None once the problem stands.
    pub fn contact_problem(&self) -> Result<ContactProblem<HalfSpace>, Error> {
        let cells = self.friction.len();
        let (mut motion, mut modes) = ([0.0; 3], Vec::new());
        match self.press {
            Press::Approach(approach) => motion[0] = approach,
            Press::Load(load) => modes.push((0, load)),
        }
        match self.drag {
            Drag::Shift([x, y]) => (motion[1], motion[2]) = (-x, -y),
            Drag::Force([x, y]) => modes.extend([(1, -x), (2, -y)]),
        }
        let free = (0..cells).flat_map(|cell| {
            let [x, y] = [0, 1].map(|axis| self.reference[axis][cell]);
            [motion[0], motion[1] - x, motion[2] - y]
        });
        let problem = ContactProblem::on(
            self.operator.clone(),
            &vec![2; cells],
            self.friction.clone(),
            self.initial_gap.clone(),
            free.collect(),
        )?;
        if modes.is_empty() {
            return Ok(problem);
        }
        let moves = |row: usize, mode: usize| f64::from(u8::from(row % 3 == modes[mode].0));
        let matrix = Mat::from_fn(3 * cells, modes.len(), moves);
        let load = modes.iter().map(|(_, load)| *load).collect();
        problem.float(Floating::new(matrix, load)?)
    }
}
