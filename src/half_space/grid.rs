//! The grid of rectangles that carries the tractions.

use super::range::check_range;
use crate::error::{Error, check_finite};

/// Most cells of a grid: beyond, one solve would need more than some 16 GiB.
const MOST_CELLS: usize = 1 << 25;

/// `cells[0] × cells[1]` equal rectangles; cell `i + cells[0] j` is the `i`-th along x in row `j`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// Number of cells along x and y.
    pub cells: [usize; 2],
    /// Sides of a cell, in metre.
    pub spacing: [f64; 2],
}

impl Grid {
    /// Checks the numbers.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for no cells or more than 2²⁵, and for a side that is not
    /// positive or beyond 1e±50;
    /// [`Error::NotFinite`].
    pub fn new(cells: [usize; 2], spacing: [f64; 2]) -> Result<Self, Error> {
        check_finite("grid.spacing", &spacing)?;
        for axis in 0..2 {
            let (count, side) = (cells[axis], spacing[axis]);
            let accepted = "from 1 to 33554432 cells";
            let good = (1..=MOST_CELLS).contains(&count);
            check_range(format!("grid.cells[{axis}]"), count as f64, good, accepted)?;
            let accepted = "spacing > 0, from 1e-50 to 1e50";
            let good = (1e-50..=1e50).contains(&side);
            check_range(format!("grid.spacing[{axis}]"), side, good, accepted)?;
        }
        let accepted = "at most 33554432 cells in all";
        let good = cells[0].saturating_mul(cells[1]) <= MOST_CELLS;
        check_range("grid.cells[1]", cells[1] as f64, good, accepted)?;
        Ok(Self { cells, spacing })
    }

    /// Number of cells.
    #[must_use]
    pub fn len(&self) -> usize {
        self.cells[0] * self.cells[1]
    }

    /// Never: a grid has a cell.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Area of a cell, in m².
    #[must_use]
    pub fn cell_area(&self) -> f64 {
        self.spacing[0] * self.spacing[1]
    }

    /// Centre of a cell from the middle of the grid, in metre.
    #[must_use]
    pub fn position(&self, cell: usize) -> [f64; 2] {
        let number = [cell % self.cells[0], cell / self.cells[0]];
        let along = |axis: usize| {
            (number[axis] as f64 - 0.5 * (self.cells[axis] as f64 - 1.0)) * self.spacing[axis]
        };
        [along(0), along(1)]
    }

    /// Whether a cell is the first or the last along an axis that has several.
    pub(super) fn at_border(&self, cell: usize) -> bool {
        let number = [cell % self.cells[0], cell / self.cells[0]];
        let ends = |axis: usize| number[axis] == 0 || number[axis] + 1 == self.cells[axis];
        (0..2).any(|axis| self.cells[axis] > 1 && ends(axis))
    }

    /// The cell of a coarser grid over the same area that a cell lies in, for every cell.
    pub(super) fn within(&self, coarser: &Self) -> Vec<usize> {
        let of = |cell: usize| {
            let [column, row] = [cell % self.cells[0], cell / self.cells[0]];
            let along = |axis: usize, at: usize| at * coarser.cells[axis] / self.cells[axis];
            along(0, column) + coarser.cells[0] * along(1, row)
        };
        (0..self.len()).map(of).collect()
    }

    /// A value at every cell, from its position.
    pub fn sample(&self, value: impl Fn([f64; 2]) -> f64) -> Vec<f64> {
        (0..self.len())
            .map(|cell| value(self.position(cell)))
            .collect()
    }
}
