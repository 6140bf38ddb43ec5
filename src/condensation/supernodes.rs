//! L in supernodes: blocks of columns with one pattern, each a dense matrix of single or double precision.
//!
//! Rows of a block's own columns come first, then the rows of its pattern.

use std::ops::Range;

use faer::linalg::matmul::triangular::{self, BlockStructure};
use faer::sparse::linalg::cholesky::supernodal::SymbolicSupernodalCholesky;
use faer::traits::RealField;
use faer::{Accum, Mat, MatRef, get_global_parallelism};

/// A pivot this small against the diagonal entry it is left of is round-off,
const ROUND_OFF: f64 = 1e-14;

/// and in single precision.
const ROUND_OFF_OF_SINGLE: f64 = 1e-6;

/// What an entry of L is stored as.
pub(super) trait Number: RealField + Copy + Into<f64> {
    /// A pivot this small against the diagonal entry it is left of is round-off.
    const SINGULAR: f64;

    /// The nearest number of this kind.
    fn nearest(value: f64) -> Self;
}

impl Number for f64 {
    const SINGULAR: f64 = ROUND_OFF;

    fn nearest(value: f64) -> Self {
        value
    }
}

impl Number for f32 {
    const SINGULAR: f64 = ROUND_OFF_OF_SINGLE;

    fn nearest(value: f64) -> Self {
        value as Self
    }
}

/// The factor: where it has entries, and the entries.
#[derive(Clone, Copy)]
pub(super) struct Lower<'a, T> {
    pub(super) symbolic: &'a SymbolicSupernodalCholesky<usize>,
    pub(super) values: &'a [T],
    pub(super) contact_unknowns: usize,
}

impl<'a, T: Number> Lower<'a, T> {
    /// Number of unknowns, with the rows of a border.
    pub(super) fn unknowns(&self) -> usize {
        self.symbolic.nrows()
    }

    /// Number of unknowns before the first contact unknown.
    pub(super) fn ordinary(&self) -> usize {
        self.unknowns() - self.contact_unknowns
    }

    /// All supernodes.
    pub(super) fn all(&self) -> Range<usize> {
        0..self.symbolic.n_supernodes()
    }

    /// The supernodes from that on which holds the first contact unknown.
    pub(super) fn of_contacts(&self) -> Range<usize> {
        let ends = self.symbolic.supernode_end();
        let ordinary = self.ordinary();
        ends.partition_point(|&end| end <= ordinary)..self.symbolic.n_supernodes()
    }

    /// The supernodes that hold an ordinary unknown, and perhaps one more.
    pub(super) fn of_ordinary(&self) -> Range<usize> {
        0..(self.of_contacts().start + 1).min(self.symbolic.n_supernodes())
    }

    /// Supernode number `index`.
    pub(super) fn supernode(&self, index: usize) -> Supernode<'a, T> {
        let symbolic = self.symbolic.supernode(index);
        let start = symbolic.start();
        let values = self.symbolic.col_ptr_for_val();
        Supernode {
            start,
            width: self.symbolic.supernode_end()[index] - start,
            pattern: symbolic.pattern(),
            values: &self.values[values[index]..values[index + 1]],
        }
    }

    /// `L_cc`, the lower triangle of the trailing block (C2).
    pub(super) fn trailing_block(&self) -> Mat<T> {
        let ordinary = self.ordinary();
        let mut block = Mat::zeros(self.contact_unknowns, self.contact_unknowns);
        for index in self.of_contacts() {
            let supernode = self.supernode(index);
            let end = supernode.start + supernode.width;
            for column in supernode.start.max(ordinary)..end {
                let entries = supernode.column(column - supernode.start);
                let target = block.col_as_slice_mut(column - ordinary);
                let own = column - supernode.start;
                target[column - ordinary..end - ordinary]
                    .copy_from_slice(&entries[own..supernode.width]);
                for (&row, &entry) in supernode.pattern.iter().zip(&entries[supernode.width..]) {
                    target[row - ordinary] = entry;
                }
            }
        }
        block
    }

    /// `G = W Wᵀ` (C17), in m/N; both triangles are filled.
    pub(super) fn border_compliance(&self) -> Mat<f64> {
        let (size, ordinary) = (self.contact_unknowns, self.ordinary());
        let mut compliance = Mat::zeros(size, size);
        for index in self.of_ordinary() {
            let supernode = self.supernode(index);
            let (rows, width) = (
                supernode.rows_from(ordinary),
                supernode.width_before(ordinary),
            );
            if width == 0 || rows.is_empty() {
                continue;
            }
            let block = supernode.lowest(rows.len(), width);
            let mut product = Mat::<T>::zeros(rows.len(), rows.len());
            triangular::matmul(
                product.as_mut(),
                BlockStructure::TriangularLower,
                Accum::Replace,
                block,
                BlockStructure::Rectangular,
                block.transpose(),
                BlockStructure::Rectangular,
                T::nearest(1.0),
                get_global_parallelism(),
            );
            for (j, &column) in rows.iter().enumerate() {
                let sums = compliance.col_as_slice_mut(column);
                for (&row, &entry) in rows[j..].iter().zip(&product.col_as_slice(j)[j..]) {
                    sums[row] += entry.into();
                }
            }
        }
        mirror(&mut compliance);
        compliance
    }
}

/// Fills the upper triangle from the lower one.
pub(super) fn mirror(matrix: &mut Mat<f64>) {
    for j in 0..matrix.ncols() {
        for i in 0..j {
            matrix[(i, j)] = matrix[(j, i)];
        }
    }
}

/// One supernode: a dense matrix, its own columns' rows first, then its pattern's.
#[derive(Clone, Copy)]
pub(super) struct Supernode<'a, T> {
    pub(super) start: usize,
    pub(super) width: usize,
    pub(super) pattern: &'a [usize],
    values: &'a [T],
}

impl<'a, T: Number> Supernode<'a, T> {
    /// Number of rows.
    pub(super) fn height(&self) -> usize {
        self.width + self.pattern.len()
    }

    /// Number of its columns before an unknown; they come first.
    pub(super) fn width_before(&self, unknown: usize) -> usize {
        unknown.saturating_sub(self.start).min(self.width)
    }

    /// Its rows from an unknown on, counted from there: they are the last ones.
    fn rows_from(&self, unknown: usize) -> Vec<usize> {
        let own = self.start..self.start + self.width;
        let rows = own.chain(self.pattern.iter().copied());
        rows.filter_map(|row| row.checked_sub(unknown)).collect()
    }

    /// Its first columns, as many as `columns`, in the last rows, as many as `rows`.
    fn lowest(&self, rows: usize, columns: usize) -> MatRef<'a, T> {
        let values = &self.values[self.height() - rows..];
        MatRef::from_column_major_slice_with_stride(values, rows, columns, self.height())
    }

    /// One of its columns.
    pub(super) fn column(&self, own: usize) -> &'a [T] {
        &self.values[own * self.height()..(own + 1) * self.height()]
    }
}
