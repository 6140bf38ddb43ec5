//! The sparse Cholesky factor of the supported body, and its trailing block.
//!
//! ```text
//!            ordinary  contact
//!          [  L_oo       0   ]
//! P K' Pᵀ = L Lᵀ,   L =  [  L_co     L_cc  ]        S = L_cc L_ccᵀ  (C2)
//! ```
//!
//! Supernodes are blocks of columns with one pattern, each a dense matrix: rows of its
//! own columns first, then the rows of its pattern.

use std::ops::Range;
use std::time::Instant;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltError;
use faer::sparse::SparseColMatRef;
use faer::sparse::linalg::cholesky::simplicial::{
    prefactorize_symbolic_cholesky, prefactorize_symbolic_cholesky_scratch,
};
use faer::sparse::linalg::cholesky::supernodal::{
    SymbolicSupernodalCholesky, factorize_supernodal_numeric_llt,
    factorize_supernodal_numeric_llt_scratch, factorize_supernodal_symbolic_cholesky,
    factorize_supernodal_symbolic_cholesky_scratch,
};
use faer::{Mat, MatRef, get_global_parallelism};
use sprs::CsMat;

use super::columns::{BorderRow, Columns};
use super::local_axes::Frames;
use super::ordering::Ordering;

/// A pivot this small against the diagonal entry it is left of is round-off.
const SINGULAR: f64 = 1e-14;

/// Why there is no factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Breakdown {
    /// Not enough memory, or more entries than an index can count.
    TooLarge,
    /// A pivot that is negative, not a number, or zero up to round-off.
    Pivot {
        /// Degree of freedom at which it happened.
        dof: usize,
        /// The pivot; NaN where the elimination stopped before computing it.
        pivot: f64,
        /// The diagonal entry of K' there.
        diagonal: f64,
    },
}

/// `P K' Pᵀ = L Lᵀ`, contact unknowns last; or bordered by what contacts see of it (C17).
#[derive(Debug)]
pub(crate) struct Factor {
    pub(super) symbolic: SymbolicSupernodalCholesky<usize>,
    pub(super) values: Vec<f64>,
    contact_unknowns: usize,
    bordered: bool,
    /// Wall time of the numeric factorisation alone, in second.
    pub(crate) numeric_seconds: f64,
}

impl Factor {
    /// Factorises the stiffness of the supported body, with a border where that has rows.
    pub(crate) fn new(
        stiffness: &CsMat<f64>,
        frames: &Frames,
        ordering: &Ordering,
        border: &[BorderRow],
    ) -> Result<Self, Breakdown> {
        let columns = |keep: fn(usize, usize) -> bool| {
            let mut columns = Columns::new(stiffness, frames, ordering, keep);
            columns.surround(ordering, border, keep);
            columns
        };
        let symbolic = analyse(&columns(|row, column| row <= column))?;
        let lower = columns(|row, column| row >= column);
        let start = Instant::now();
        // Asked for first, because `vec!` ends the program where there is no memory.
        Vec::<f64>::new()
            .try_reserve_exact(symbolic.len_val())
            .map_err(|_| Breakdown::TooLarge)?;
        let mut values = vec![0.0; symbolic.len_val()];
        let result = eliminate(&symbolic, &mut values, &lower);
        let factor = Self {
            symbolic,
            values,
            contact_unknowns: ordering.contact_unknowns + border.len(),
            bordered: !border.is_empty(),
            numeric_seconds: start.elapsed().as_secs_f64(),
        };
        match result? {
            None => factor.check_pivots(&lower, ordering)?,
            Some(column) => {
                // In the border it is an overflow of all that came before.
                let dof = ordering.dof.get(column).or(ordering.dof.last());
                return Err(Breakdown::Pivot {
                    dof: dof.copied().unwrap_or_default(),
                    pivot: f64::NAN,
                    diagonal: lower.diagonal(column),
                });
            }
        }
        Ok(factor)
    }

    /// Contacts see it over a border (C17).
    pub(crate) fn is_bordered(&self) -> bool {
        self.bordered
    }

    /// Number of unknowns, with the rows of the border.
    pub(crate) fn unknowns(&self) -> usize {
        self.symbolic.nrows()
    }

    /// Number of stored entries of L.
    pub(crate) fn entries(&self) -> usize {
        self.values.len()
    }

    /// Number of contact unknowns or rows of the border, the last ones.
    pub(crate) fn contact_unknowns(&self) -> usize {
        self.contact_unknowns
    }

    /// `L_cc`, the lower triangle of the trailing block (C2).
    pub(crate) fn trailing_block(&self) -> Mat<f64> {
        let ordinary = self.unknowns() - self.contact_unknowns;
        let mut block = Mat::zeros(self.contact_unknowns, self.contact_unknowns);
        for index in self.first_contact_supernode()..self.symbolic.n_supernodes() {
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

    /// The supernode that holds the first contact unknown.
    pub(super) fn first_contact_supernode(&self) -> usize {
        let ordinary = self.unknowns() - self.contact_unknowns;
        let ends = self.symbolic.supernode_end();
        ends.partition_point(|&end| end <= ordinary)
    }

    /// The supernodes that hold an ordinary unknown, and perhaps one more.
    pub(super) fn ordinary_supernodes(&self) -> Range<usize> {
        0..(self.first_contact_supernode() + 1).min(self.symbolic.n_supernodes())
    }

    /// Supernode number `index`.
    pub(super) fn supernode(&self, index: usize) -> Supernode<'_> {
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

    /// Refuses a factor whose pivots are round-off: the body can move without force.
    fn check_pivots(&self, lower: &Columns, ordering: &Ordering) -> Result<(), Breakdown> {
        for index in 0..self.symbolic.n_supernodes() {
            let supernode = self.supernode(index);
            // Those of a border are what C is.
            for own in 0..supernode.width_before(ordering.unknowns()) {
                let pivot = supernode.column(own)[own].powi(2);
                let column = supernode.start + own;
                let diagonal = lower.diagonal(column);
                let sound = pivot > SINGULAR * diagonal && pivot.is_finite();
                if !sound {
                    let dof = ordering.dof[column];
                    return Err(Breakdown::Pivot {
                        dof,
                        pivot,
                        diagonal,
                    });
                }
            }
        }
        Ok(())
    }
}

/// One supernode: a dense matrix, its own columns' rows first, then its pattern's.
#[derive(Clone, Copy)]
pub(super) struct Supernode<'a> {
    pub(super) start: usize,
    pub(super) width: usize,
    pub(super) pattern: &'a [usize],
    values: &'a [f64],
}

impl<'a> Supernode<'a> {
    /// Number of rows.
    pub(super) fn height(&self) -> usize {
        self.width + self.pattern.len()
    }

    /// Number of its columns before an unknown; they come first.
    pub(super) fn width_before(&self, unknown: usize) -> usize {
        unknown.saturating_sub(self.start).min(self.width)
    }

    /// Its rows from an unknown on, counted from there: they are the last ones.
    pub(super) fn rows_from(&self, unknown: usize) -> Vec<usize> {
        let own = self.start..self.start + self.width;
        let rows = own.chain(self.pattern.iter().copied());
        rows.filter_map(|row| row.checked_sub(unknown)).collect()
    }

    /// Its first columns, as many as `columns`, in the last rows, as many as `rows`.
    pub(super) fn lowest(&self, rows: usize, columns: usize) -> MatRef<'a, f64> {
        let values = &self.values[self.height() - rows..];
        MatRef::from_column_major_slice_with_stride(values, rows, columns, self.height())
    }

    /// One of its columns.
    pub(super) fn column(&self, own: usize) -> &'a [f64] {
        &self.values[own * self.height()..(own + 1) * self.height()]
    }
}

/// Where L has entries, in supernodes.
fn analyse(upper: &Columns) -> Result<SymbolicSupernodalCholesky<usize>, Breakdown> {
    let pattern = upper.pattern();
    let size = pattern.ncols();
    let mut tree = vec![0_isize; size];
    let mut counts = vec![0_usize; size];
    let scratch = prefactorize_symbolic_cholesky_scratch::<usize>(size, upper.rows.len());
    let scratch = scratch.or(factorize_supernodal_symbolic_cholesky_scratch::<usize>(
        size,
    ));
    let mut memory = MemBuffer::try_new(scratch).map_err(|_| Breakdown::TooLarge)?;
    let tree =
        prefactorize_symbolic_cholesky(&mut tree, &mut counts, pattern, MemStack::new(&mut memory));
    factorize_supernodal_symbolic_cholesky(
        pattern,
        tree,
        &counts,
        MemStack::new(&mut memory),
        Default::default(),
    )
    .map_err(|_| Breakdown::TooLarge)
}

/// Entries of the factor of a supported body, and the multiplications that it takes, each with an addition.
pub(super) fn count(
    stiffness: &CsMat<f64>,
    frames: &Frames,
    ordering: &Ordering,
    border: &[BorderRow],
) -> Result<(usize, f64), Breakdown> {
    let upper = |row: usize, column: usize| row <= column;
    let mut columns = Columns::new(stiffness, frames, ordering, upper);
    columns.surround(ordering, border, upper);
    let symbolic = analyse(&columns)?;
    let operations = (0..symbolic.n_supernodes()).map(|index| {
        let supernode = symbolic.supernode(index);
        let width = symbolic.supernode_end()[index] - supernode.start();
        let rows = (0..width).map(|own| (width - own + supernode.pattern().len()) as f64);
        // The rank-one update of a column touches half of a square.
        rows.map(|rows| 0.5 * rows * rows).sum::<f64>()
    });
    Ok((symbolic.len_val(), operations.sum()))
}

/// Fills in the values of L; some column if its pivot is not positive.
fn eliminate(
    symbolic: &SymbolicSupernodalCholesky<usize>,
    values: &mut [f64],
    lower: &Columns,
) -> Result<Option<usize>, Breakdown> {
    let parallelism = get_global_parallelism();
    let scratch = factorize_supernodal_numeric_llt_scratch::<usize, f64>(
        symbolic,
        parallelism,
        Default::default(),
    );
    let mut memory = MemBuffer::try_new(scratch).map_err(|_| Breakdown::TooLarge)?;
    let result = factorize_supernodal_numeric_llt(
        values,
        SparseColMatRef::new(lower.pattern(), &lower.values),
        Default::default(),
        symbolic,
        parallelism,
        MemStack::new(&mut memory),
        Default::default(),
    );
    Ok(match result {
        Ok(_) => None,
        Err(LltError::NonPositivePivot { index }) => Some(index),
    })
}
