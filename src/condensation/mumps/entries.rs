//! What one rank knows of a matrix: entries of its lower triangle that add up with those of the others.

use sprs::CsMat;

use crate::body;
use crate::body::Body;
use crate::condensation::columns::BorderRow;
use crate::condensation::ordering::{HELD, Ordering};
use crate::error::Error;

/// Rows, columns (both from 1, in the order of elimination) and values.
#[derive(Debug, Default)]
pub(super) struct Entries {
    rows: Vec<i32>,
    columns: Vec<i32>,
    values: Vec<f64>,
}

impl Entries {
    /// The lower triangle of a matrix over the degrees of freedom.
    pub(super) fn of(stiffness: &CsMat<f64>, ordering: &Ordering) -> Self {
        let mut entries = Self::default();
        let room = (stiffness.nnz() + stiffness.rows()) / 2;
        entries.rows.reserve(room);
        entries.columns.reserve(room);
        entries.values.reserve(room);
        for (column, &dof) in ordering.dof.iter().enumerate() {
            let of_dof = stiffness.outer_view(dof);
            for (other, &value) in of_dof.iter().flat_map(|row| row.iter()) {
                let row = ordering.position[other];
                if row != HELD && row >= column {
                    entries.push(row, column, value);
                }
            }
        }
        entries
    }

    /// That of the stiffness of a rank's cells.
    pub(super) fn of_cells(
        body: &Body,
        (rank, count): (usize, usize),
        ordering: &Ordering,
    ) -> Result<Self, Error> {
        let part = body::part_of_stiffness(body, rank, count);
        Ok(match body::dependence(body)? {
            None => Self::of(&part, ordering),
            Some(tied) => Self::of(&tied.reduce(&part), ordering),
        })
    }

    /// Adds B of (C17) below.
    pub(super) fn border(&mut self, ordering: &Ordering, border: &[BorderRow]) {
        for (k, row) in border.iter().enumerate() {
            for &(dof, b) in row {
                self.push(ordering.unknowns() + k, ordering.position[dof], b);
            }
        }
    }

    /// Adds to the diagonal.
    pub(super) fn spring(&mut self, position: usize, stiffness: f64) {
        self.push(position, position, stiffness);
    }

    /// Makes every diagonal entry larger by a part of it.
    pub(super) fn shift(&mut self, part: f64) {
        let places = self.rows.iter().zip(&self.columns);
        for ((row, column), value) in places.zip(&mut self.values) {
            if row == column {
                *value *= 1.0 + part;
            }
        }
    }

    fn push(&mut self, row: usize, column: usize, value: f64) {
        // The numbers of unknowns fit: see `Divided::new`.
        self.rows.push(row as i32 + 1);
        self.columns.push(column as i32 + 1);
        self.values.push(value);
    }

    /// The three lists.
    #[cfg(mumps)]
    pub(super) fn parts(&mut self) -> (&mut [i32], &mut [i32], &mut [f64]) {
        (&mut self.rows, &mut self.columns, &mut self.values)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::body::CellKind;
    use crate::body::tests::samples::distorted;
    use faer::Mat;

    #[test]
    fn the_cells_of_all_ranks_add_up_to_the_body() {
        for kind in CellKind::all() {
            for poisson in [0.3, 0.4999] {
                let mut body = distorted(kind);
                body.materials[0].poisson = poisson;
                let whole = body::stiffness(&body);
                let size = whole.rows();
                // Backwards, and the first degree of freedom held.
                let dof: Vec<usize> = (1..size).rev().collect();
                let mut position = vec![HELD; size];
                dof.iter().enumerate().for_each(|(at, &d)| position[d] = at);
                let ordering = Ordering {
                    position,
                    dof,
                    contact_unknowns: 0,
                };
                let dense = |all: Vec<Entries>| {
                    let mut sum = Mat::<f64>::zeros(size - 1, size - 1);
                    for of_rank in all {
                        for (k, value) in of_rank.values.iter().enumerate() {
                            sum[(
                                of_rank.rows[k] as usize - 1,
                                of_rank.columns[k] as usize - 1,
                            )] += value;
                        }
                    }
                    sum
                };
                let expected = dense(vec![Entries::of(&whole, &ordering)]);
                for count in [1, 2, 5] {
                    let of_rank = |rank| Entries::of_cells(&body, (rank, count), &ordering);
                    let found = dense((0..count).map(|rank| of_rank(rank).unwrap()).collect());
                    let difference = (&found - &expected).norm_max();
                    assert!(
                        difference <= 1e-14 * expected.norm_max(),
                        "{kind:?} {count}"
                    );
                }
            }
        }
    }
}
