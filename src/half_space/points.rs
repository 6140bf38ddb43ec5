//! Some cells of a grid, row by row: what vectors of the solver stand on.

use super::grid::Grid;

/// Cells in rising order, and where each row of the grid starts among them.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Points {
    cells: Vec<usize>,
    starts: Vec<usize>,
    width: usize,
}

impl Points {
    /// The cells that `chosen` accepts.
    pub(super) fn select(grid: &Grid, chosen: impl Fn(usize) -> bool) -> Self {
        let [width, rows] = grid.cells;
        let (mut cells, mut starts) = (Vec::new(), Vec::with_capacity(rows + 1));
        for row in 0..rows {
            starts.push(cells.len());
            cells.extend((row * width..(row + 1) * width).filter(|&cell| chosen(cell)));
        }
        starts.push(cells.len());
        Self {
            cells,
            starts,
            width,
        }
    }

    pub(super) fn whole(grid: &Grid) -> Self {
        Self::select(grid, |_| true)
    }

    pub(super) fn len(&self) -> usize {
        self.cells.len()
    }

    pub(super) fn is_empty(&self) -> bool {
        self.cells.is_empty()
    }

    pub(super) fn cells(&self) -> &[usize] {
        &self.cells
    }

    pub(super) fn has_row(&self, row: usize) -> bool {
        self.starts[row] < self.starts[row + 1]
    }

    /// Columns of the chosen cells of a row.
    pub(super) fn columns(&self, row: usize) -> impl Iterator<Item = usize> + '_ {
        let cells = &self.cells[self.starts[row]..self.starts[row + 1]];
        cells.iter().map(move |cell| cell - row * self.width)
    }

    /// The part of a vector on these points that belongs to a row.
    pub(super) fn row<'a>(&self, row: usize, values: &'a [f64]) -> &'a [f64] {
        &values[self.starts[row]..self.starts[row + 1]]
    }

    /// The parts of a vector on these points, row by row.
    pub(super) fn rows_mut<'a>(&self, mut values: &'a mut [f64]) -> Vec<&'a mut [f64]> {
        let mut parts = Vec::with_capacity(self.starts.len() - 1);
        for pair in self.starts.windows(2) {
            let (part, rest) = values.split_at_mut(pair[1] - pair[0]);
            parts.push(part);
            values = rest;
        }
        parts
    }

    /// What a field on the grid has at these points.
    pub(super) fn gather(&self, field: &[f64]) -> Vec<f64> {
        self.cells.iter().map(|&cell| field[cell]).collect()
    }

    /// A vector on other points, seen here: zero where those had none.
    pub(super) fn carry(&self, other: &Self, values: &[f64]) -> Vec<f64> {
        let mut old = other.cells.iter().zip(values).peekable();
        let of = |&cell: &usize| {
            while old.next_if(|(old, _)| **old < cell).is_some() {}
            old.next_if(|(old, _)| **old == cell)
                .map_or(0.0, |(_, value)| *value)
        };
        self.cells.iter().map(of).collect()
    }

    /// A field on a grid of `cells` cells, zero elsewhere.
    pub(super) fn scatter(&self, values: &[f64], cells: usize) -> Vec<f64> {
        let mut field = vec![0.0; cells];
        for (&cell, value) in self.cells.iter().zip(values) {
            field[cell] = *value;
        }
        field
    }
}
