//! The matrix that is factorised, or a triangle of it, column by column in the order of elimination.
//!
//! ```text
//!                      [ P K' Pᵀ   P Bᵀ ]
//! P K' Pᵀ     or       [ B Pᵀ      C    ]   with a border (C17)
//! ```

use faer::sparse::SymbolicSparseColMatRef;
use sprs::CsMat;

/// A row of B over the body's degrees of freedom: `(degree of freedom, coefficient)`.
pub(crate) type BorderRow = Vec<(usize, f64)>;

use super::local_axes::Frames;
use super::ordering::{HELD, Ordering};

/// The diagonal C of a border (C17), over the largest compliance of a single unknown: beyond that of
/// any body that is not singular.
const BORDER: f64 = 1e30;

/// Largest C: far from overflow.
const LARGEST: f64 = 1e300;

/// Rows unsorted, repeated entries add up.
pub(super) struct Columns {
    starts: Vec<usize>,
    pub(super) rows: Vec<usize>,
    pub(super) values: Vec<f64>,
}

impl Columns {
    /// The entries with `keep(row, column)`.
    pub(super) fn new(
        stiffness: &CsMat<f64>,
        frames: &Frames,
        ordering: &Ordering,
        keep: impl Fn(usize, usize) -> bool,
    ) -> Self {
        let mut columns = Self::with_room((stiffness.nnz() + stiffness.rows()) / 2);
        for (column, &dof) in ordering.dof.iter().enumerate() {
            // K' is symmetric: its row is its column.
            frames.visit_row(stiffness, dof, |other, value| {
                let row = ordering.position[other];
                if row != HELD && keep(row, column) {
                    columns.rows.push(row);
                    columns.values.push(value);
                }
            });
            columns.starts.push(columns.rows.len());
        }
        columns
    }

    /// Adds B, Bᵀ and C of (C17), as far as they are to be kept.
    pub(super) fn surround(
        &mut self,
        ordering: &Ordering,
        border: &[BorderRow],
        keep: impl Fn(usize, usize) -> bool,
    ) {
        if border.is_empty() {
            return;
        }
        let size = ordering.unknowns();
        let diagonals = (0..size).map(|column| self.diagonal(column));
        let largest_compliance = diagonals.fold(f64::INFINITY, f64::min).recip();
        let corner = (BORDER * largest_compliance).min(LARGEST);
        let mut added = vec![Vec::new(); size + border.len()];
        for (k, row) in border.iter().enumerate() {
            for &(dof, b) in row {
                let position = ordering.position[dof];
                for (row, column) in [(size + k, position), (position, size + k)] {
                    if keep(row, column) {
                        added[column].push((row, b));
                    }
                }
            }
            added[size + k].push((size + k, corner));
        }
        let old = std::mem::replace(self, Self::with_room(self.rows.len()));
        for (column, added) in added.iter().enumerate() {
            if column < size {
                let entries = old.starts[column]..old.starts[column + 1];
                self.rows.extend_from_slice(&old.rows[entries.clone()]);
                self.values.extend_from_slice(&old.values[entries]);
            }
            self.rows.extend(added.iter().map(|(row, _)| row));
            self.values.extend(added.iter().map(|(_, value)| value));
            self.starts.push(self.rows.len());
        }
    }

    fn with_room(entries: usize) -> Self {
        Self {
            starts: vec![0],
            rows: Vec::with_capacity(entries),
            values: Vec::with_capacity(entries),
        }
    }

    pub(super) fn pattern(&self) -> SymbolicSparseColMatRef<'_, usize> {
        let size = self.starts.len() - 1;
        SymbolicSparseColMatRef::new_unsorted_checked(size, size, &self.starts, None, &self.rows)
    }

    pub(super) fn diagonal(&self, column: usize) -> f64 {
        (self.starts[column]..self.starts[column + 1])
            .filter(|&entry| self.rows[entry] == column)
            .map(|entry| self.values[entry])
            .sum()
    }
}
