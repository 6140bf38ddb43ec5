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

use std::time::Instant;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltError;
use faer::sparse::linalg::cholesky::simplicial::{
    prefactorize_symbolic_cholesky, prefactorize_symbolic_cholesky_scratch,
};
use faer::sparse::linalg::cholesky::supernodal::{
    SymbolicSupernodalCholesky, factorize_supernodal_numeric_llt,
    factorize_supernodal_numeric_llt_scratch, factorize_supernodal_symbolic_cholesky,
    factorize_supernodal_symbolic_cholesky_scratch,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Mat, get_global_parallelism};
use sprs::CsMat;

use super::frames::Frames;
use super::ordering::{HELD, Ordering};

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

/// `P K' Pᵀ = L Lᵀ`, contact unknowns last.
#[derive(Debug)]
pub(crate) struct Factor {
    pub(super) symbolic: SymbolicSupernodalCholesky<usize>,
    pub(super) values: Vec<f64>,
    contact_unknowns: usize,
    /// Wall time of the numeric factorisation alone, in second.
    pub(crate) numeric_seconds: f64,
}

impl Factor {
    /// Factorises the stiffness of the supported body.
    pub(crate) fn new(
        stiffness: &CsMat<f64>,
        frames: &Frames,
        ordering: &Ordering,
    ) -> Result<Self, Breakdown> {
        let symbolic = analyse(stiffness, frames, ordering)?;
        let lower = Columns::new(stiffness, frames, ordering, |row, column| row >= column);
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
            contact_unknowns: ordering.contact_unknowns,
            numeric_seconds: start.elapsed().as_secs_f64(),
        };
        match result? {
            None => factor.check_pivots(&lower, ordering)?,
            Some(column) => {
                return Err(Breakdown::Pivot {
                    dof: ordering.dof[column],
                    pivot: f64::NAN,
                    diagonal: lower.diagonal(column),
                });
            }
        }
        Ok(factor)
    }

    /// Number of unknowns.
    pub(crate) fn unknowns(&self) -> usize {
        self.symbolic.nrows()
    }

    /// Number of stored entries of L.
    pub(crate) fn entries(&self) -> usize {
        self.values.len()
    }

    /// Number of contact unknowns, the last ones.
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
            for own in 0..supernode.width {
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

    /// One of its columns.
    pub(super) fn column(&self, own: usize) -> &'a [f64] {
        &self.values[own * self.height()..(own + 1) * self.height()]
    }
}

/// Part of `P K' Pᵀ` by columns; rows unsorted, repeated entries add up.
struct Columns {
    starts: Vec<usize>,
    rows: Vec<usize>,
    values: Vec<f64>,
}

impl Columns {
    /// The entries with `keep(row, column)`.
    fn new(
        stiffness: &CsMat<f64>,
        frames: &Frames,
        ordering: &Ordering,
        keep: impl Fn(usize, usize) -> bool,
    ) -> Self {
        let guess = (stiffness.nnz() + stiffness.rows()) / 2;
        let mut columns = Self {
            starts: vec![0],
            rows: Vec::with_capacity(guess),
            values: Vec::with_capacity(guess),
        };
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

    fn pattern(&self) -> SymbolicSparseColMatRef<'_, usize> {
        let size = self.starts.len() - 1;
        SymbolicSparseColMatRef::new_unsorted_checked(size, size, &self.starts, None, &self.rows)
    }

    fn diagonal(&self, column: usize) -> f64 {
        (self.starts[column]..self.starts[column + 1])
            .filter(|&entry| self.rows[entry] == column)
            .map(|entry| self.values[entry])
            .sum()
    }
}

/// Where L has entries, in supernodes.
fn analyse(
    stiffness: &CsMat<f64>,
    frames: &Frames,
    ordering: &Ordering,
) -> Result<SymbolicSupernodalCholesky<usize>, Breakdown> {
    let upper = Columns::new(stiffness, frames, ordering, |row, column| row <= column);
    let pattern = upper.pattern();
    let size = ordering.unknowns();
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
