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
        let (points, forces) = self.spread(on, residual);
        let [normal, x, y] = forces;
        let normal = self.inverse_normal(&normal, &points);
        let [x, y] = self.inverse_tangential(&[x, y], &points);
        gather(on, &points, &[normal, x, y])
    }

    fn apply_block(&self, to: &[usize], of: &[usize], force: &[f64]) -> Vec<f64> {
        let ((from, forces), (points, _)) = (self.spread(of, force), self.spread(to, &[]));
        let moved = self.full([&forces[0], &forces[1], &forces[2]], &from, &points);
        gather(to, &points, &moved)
    }
}

impl HalfSpace {
    /// Cells of some unknowns in rising order, and values of these unknowns there, by direction.
    fn spread(&self, unknowns: &[usize], values: &[f64]) -> (Points, [Vec<f64>; 3]) {
        let mut chosen = vec![false; self.grid().len()];
        unknowns.iter().for_each(|at| chosen[at / 3] = true);
        let points = Points::select(self.grid(), |cell| chosen[cell]);
        let mut parts = [0, 1, 2].map(|_| vec![0.0; points.len()]);
        for (&unknown, value) in unknowns.iter().zip(values) {
            if let Ok(at) = points.cells().binary_search(&(unknown / 3)) {
                parts[unknown % 3][at] = *value;
            }
        }
        (points, parts)
    }
}

/// What some unknowns have of fields on their cells.
fn gather(unknowns: &[usize], points: &Points, parts: &[Vec<f64>; 3]) -> Vec<f64> {
    let of = |&unknown: &usize| {
        let at = points.cells().binary_search(&(unknown / 3));
        at.map_or(0.0, |at| parts[unknown % 3][at])
    };
    unknowns.iter().map(of).collect()
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
