//! The matrix that is factorised, column by column in the order of elimination: its lower triangle, and the
//! pattern from which the factor's follows.
//!
//! ```text
//!                      [ P K' Pᵀ   P Bᵀ ]
//! P K' Pᵀ     or       [ B Pᵀ      C    ]   with a border (C17)
//! ```

use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use sprs::CsMat;

/// A row of B over the body's degrees of freedom: `(degree of freedom, coefficient)`.
pub(crate) type BorderRow = Vec<(usize, f64)>;

use super::local_axes::Frames;
use super::ordering::{HELD, Ordering};
use super::supernodes::Number;

/// The diagonal C of a border (C17), over the largest compliance of a single unknown: beyond that of
/// any body that is not singular.
const BORDER: f64 = 1e30;

/// Largest C: far from overflow.
const LARGEST: f64 = 1e300;

/// What is factorised: the stiffness in the contact's axes, its order, and maybe a border.
#[derive(Clone, Copy)]
pub(super) struct Matrix<'a> {
    pub(super) stiffness: &'a CsMat<f64>,
    pub(super) frames: &'a Frames,
    pub(super) ordering: &'a Ordering,
    pub(super) border: &'a [BorderRow],
}

impl Matrix<'_> {
    /// Number of columns.
    pub(super) fn size(&self) -> usize {
        self.ordering.unknowns() + self.border.len()
    }

    /// Diagonal entry of each unknown, in order of elimination.
    pub(super) fn diagonal(&self) -> Vec<f64> {
        let dofs = self.ordering.dof.iter();
        let of_one = |&dof: &usize| {
            let mut sum = 0.0;
            let add = |other, value| {
                if other == dof {
                    sum += value;
                }
            };
            self.frames.visit_row(self.stiffness, dof, add);
            sum
        };
        dofs.map(of_one).collect()
    }

    /// Rows of the border below each column.
    fn below(&self) -> Vec<Vec<(usize, f64)>> {
        let size = self.ordering.unknowns();
        let mut below = vec![Vec::new(); size];
        for (k, row) in self.border.iter().enumerate() {
            for &(dof, b) in row {
                below[self.ordering.position[dof]].push((size + k, b));
            }
        }
        below
    }
}

/// A lower triangle; rows unsorted, repeated entries add up.
pub(super) struct Columns<T> {
    starts: Vec<usize>,
    rows: Vec<usize>,
    values: Vec<T>,
}

impl<T: Number> Columns<T> {
    /// The lower triangle of `D A D`, with factors D that are 1 where there are none.
    pub(super) fn new(matrix: &Matrix<'_>, scale: Option<&[f64]>) -> Self {
        let (stiffness, ordering) = (matrix.stiffness, matrix.ordering);
        let room = (stiffness.nnz() + stiffness.rows()) / 2;
        let mut columns = Self {
            starts: vec![0],
            rows: Vec::with_capacity(room),
            values: Vec::with_capacity(room),
        };
        let factor = |at: usize| scale.map_or(1.0, |scale| scale[at]);
        for (column, &dof) in ordering.dof.iter().enumerate() {
            let of_column = factor(column);
            // K' is symmetric: its row is its column.
            matrix.frames.visit_row(stiffness, dof, |other, value| {
                let row = ordering.position[other];
                if row != HELD && row >= column {
                    let value = of_column * factor(row) * value;
                    columns.rows.push(row);
                    columns.values.push(T::nearest(value));
                }
            });
            columns.starts.push(columns.rows.len());
        }
        columns.surround(matrix);
        columns
    }

    /// Adds B and C of (C17).
    fn surround(&mut self, matrix: &Matrix<'_>) {
        if matrix.border.is_empty() {
            return;
        }
        let size = matrix.ordering.unknowns();
        let diagonals = (0..size).map(|column| self.diagonal(column));
        let largest_compliance = diagonals.fold(f64::INFINITY, f64::min).recip();
        let corner = (BORDER * largest_compliance).min(LARGEST);
        let mut whole = Self {
            starts: vec![0],
            rows: Vec::with_capacity(self.rows.len()),
            values: Vec::with_capacity(self.rows.len()),
        };
        for (column, below) in matrix.below().iter().enumerate() {
            let entries = self.starts[column]..self.starts[column + 1];
            whole.rows.extend_from_slice(&self.rows[entries.clone()]);
            whole.values.extend_from_slice(&self.values[entries]);
            whole.rows.extend(below.iter().map(|(row, _)| row));
            let values = below.iter().map(|&(_, value)| T::nearest(value));
            whole.values.extend(values);
            whole.starts.push(whole.rows.len());
        }
        for row in size..matrix.size() {
            whole.rows.push(row);
            whole.values.push(T::nearest(corner));
            whole.starts.push(whole.rows.len());
        }
        *self = whole;
    }

    pub(super) fn as_matrix(&self) -> SparseColMatRef<'_, usize, T> {
        SparseColMatRef::new(pattern(&self.starts, &self.rows), &self.values)
    }

    pub(super) fn diagonal(&self, column: usize) -> f64 {
        (self.starts[column]..self.starts[column + 1])
            .filter(|&entry| self.rows[entry] == column)
            .map(|entry| self.values[entry].into())
            .sum()
    }
}

/// Entries of an upper triangle that lead to the fill of all of them: of the unknowns of a node, which are
/// eliminated one after the other and see the same others, the first stands for all.
pub(super) struct Skeleton {
    starts: Vec<usize>,
    pub(super) rows: Vec<usize>,
}

impl Skeleton {
    pub(super) fn new(matrix: &Matrix<'_>, axes: usize) -> Self {
        let ordering = matrix.ordering;
        let heads = Heads::new(ordering, axes);
        let mut skeleton = Self {
            starts: Vec::with_capacity(matrix.size() + 1),
            rows: Vec::new(),
        };
        skeleton.starts.push(0);
        let mut seen = vec![usize::MAX; heads.starts.len()];
        let mut around = Vec::new();
        for (column, &dof) in ordering.dof.iter().enumerate() {
            let node = dof / axes;
            if heads.of(node).contains(&column) {
                around.clear();
                heads.around(matrix.stiffness, node, (&mut seen, column), &mut around);
            }
            let before = around.iter().copied().filter(|&head| head < column);
            skeleton.rows.extend(before);
            skeleton.rows.push(column);
            skeleton.starts.push(skeleton.rows.len());
        }
        for (k, row) in matrix.border.iter().enumerate() {
            let positions = row.iter().map(|&(dof, _)| ordering.position[dof]);
            skeleton.rows.extend(positions);
            skeleton.rows.push(ordering.unknowns() + k);
            skeleton.starts.push(skeleton.rows.len());
        }
        skeleton
    }

    pub(super) fn pattern(&self) -> SymbolicSparseColMatRef<'_, usize> {
        pattern(&self.starts, &self.rows)
    }
}

/// Positions at which the unknowns of each node begin in the order of elimination: those before the contact
/// unknowns, and those of the contact.
struct Heads {
    starts: Vec<usize>,
    positions: Vec<usize>,
    axes: usize,
}

impl Heads {
    fn new(ordering: &Ordering, axes: usize) -> Self {
        let node = |position: usize| ordering.dof[position] / axes;
        let is_head =
            |&at: &usize| at == 0 || at == ordering.ordinary() || node(at) != node(at - 1);
        let heads: Vec<usize> = (0..ordering.unknowns()).filter(is_head).collect();
        let nodes = ordering.position.len() / axes;
        let mut starts = vec![0; nodes + 1];
        heads.iter().for_each(|&head| starts[node(head) + 1] += 1);
        (0..nodes).for_each(|at| starts[at + 1] += starts[at]);
        let (mut next, mut positions) = (starts.clone(), vec![0; heads.len()]);
        for head in heads {
            let at = &mut next[node(head)];
            positions[*at] = head;
            *at += 1;
        }
        Self {
            starts,
            positions,
            axes,
        }
    }

    /// Those of a node.
    fn of(&self, node: usize) -> &[usize] {
        &self.positions[self.starts[node]..self.starts[node + 1]]
    }

    /// Adds those of a node and its neighbours, each once for a mark.
    fn around(
        &self,
        stiffness: &CsMat<f64>,
        node: usize,
        (seen, mark): (&mut [usize], usize),
        around: &mut Vec<usize>,
    ) {
        for row in node * self.axes..(node + 1) * self.axes {
            for &column in &stiffness.indices()[stiffness.indptr().outer_inds_sz(row)] {
                let other = column / self.axes;
                if std::mem::replace(&mut seen[other], mark) != mark {
                    around.extend_from_slice(self.of(other));
                }
            }
        }
    }
}

fn pattern<'a>(starts: &'a [usize], rows: &'a [usize]) -> SymbolicSparseColMatRef<'a, usize> {
    let size = starts.len() - 1;
    SymbolicSparseColMatRef::new_unsorted_checked(size, size, starts, None, rows)
}
