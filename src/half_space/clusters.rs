//! Clusters of contacts: cells that touch along a side.

use super::grid::Grid;
use super::operator::Surroundings;

/// Numbers of cells of the clusters of those that `pressed` accepts, the largest first; those of a
/// periodic grid go on across its edges.
#[must_use]
pub fn clusters(
    grid: &Grid,
    surroundings: Surroundings,
    pressed: impl Fn(usize) -> bool,
) -> Vec<usize> {
    let mut left: Vec<bool> = (0..grid.len()).map(pressed).collect();
    let (mut sizes, mut open) = (Vec::new(), Vec::new());
    for start in 0..grid.len() {
        if !left[start] {
            continue;
        }
        left[start] = false;
        open.push(start);
        let mut size = 0;
        while let Some(cell) = open.pop() {
            size += 1;
            for next in neighbours(grid, surroundings, cell).into_iter().flatten() {
                if left[next] {
                    left[next] = false;
                    open.push(next);
                }
            }
        }
        sizes.push(size);
    }
    sizes.sort_unstable_by(|one, other| other.cmp(one));
    sizes
}

/// Cells to the left, to the right, below and above.
fn neighbours(grid: &Grid, surroundings: Surroundings, cell: usize) -> [Option<usize>; 4] {
    let [columns, rows] = grid.cells;
    let (column, row) = (cell % columns, cell / columns);
    let step = |at: usize, count: usize, forward: bool| {
        let next = if forward { at + 1 } else { at + count - 1 };
        let inside = if forward { next < count } else { at > 0 };
        (inside || surroundings == Surroundings::Periodic).then_some(next % count)
    };
    let along = |forward: bool| Some(step(column, columns, forward)? + columns * row);
    let across = |forward: bool| Some(column + columns * step(row, rows, forward)?);
    [along(false), along(true), across(false), across(true)]
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn corners_do_not_join_and_edges_of_a_periodic_grid_do() {
        let grid = Grid::new([4, 3], [1.0; 2]).unwrap();
        // x . . x
        // . x . .
        // . x x .
        let pressed = |cell: usize| [0, 3, 5, 9, 10].contains(&cell);
        assert_eq!(clusters(&grid, Surroundings::Free, pressed), [3, 1, 1]);
        assert_eq!(clusters(&grid, Surroundings::Periodic, pressed), [3, 2]);
        assert!(clusters(&grid, Surroundings::Free, |_| false).is_empty());
    }
}
