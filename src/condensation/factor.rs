//! The sparse Cholesky factor of the supported body, and what is asked of it.
//!
//! ```text
//!            ordinary  contact
//!          [  L_oo       0   ]
//! P K' Pᵀ = L Lᵀ,   L =  [  L_co     L_cc  ]        S = L_cc L_ccᵀ  (C2)
//! ```
//!
//! Or in single precision, of the matrix whose diagonal is about one (C32): half the memory, and seven digits that
//! (C24) makes whole.
//!
//! ```text
//! (C32)  D P K' Pᵀ D = L̂ L̂ᵀ,   L = D⁻¹ L̂      D: powers of two, D_i² K'_ii in [1/2, 2]
//! ```

use std::ops::Range;
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
use faer::{Mat, get_global_parallelism};

use super::columns::{Columns, Matrix, Skeleton};
use super::ordering::Ordering;
use super::supernodes::{Lower, Number};
use crate::problem::inverse_of_product;

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

/// What the entries of a factor are stored in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Precision {
    /// Eight bytes.
    #[default]
    Double,
    /// Four bytes (C32).
    Single,
}

impl Precision {
    /// Of an entry.
    pub(crate) const fn bytes(self) -> usize {
        match self {
            Self::Double => 8,
            Self::Single => 4,
        }
    }
}

/// `P K' Pᵀ = L Lᵀ`, contact unknowns last; or bordered by what contacts see of it (C17).
#[derive(Debug)]
pub(crate) struct Factor {
    symbolic: SymbolicSupernodalCholesky<usize>,
    entries: Entries,
    contact_unknowns: usize,
    bordered: bool,
    /// Wall time of the numeric factorisation alone, in second.
    pub(crate) numeric_seconds: f64,
}

/// Entries of L, or of L̂ with D (C32).
#[derive(Debug)]
enum Entries {
    Double(Vec<f64>),
    Single(Vec<f32>, Vec<f64>),
}

/// Does the same with a factor of either kind.
macro_rules! with_lower {
    ($factor:expr, $lower:ident => $do:expr) => {
        match &$factor.entries {
            Entries::Double(values) => {
                let $lower = $factor.lower(values);
                $do
            }
            Entries::Single(values, _) => {
                let $lower = $factor.lower(values);
                $do
            }
        }
    };
}

impl Factor {
    /// Factorises the stiffness of the supported body, with a border where that has rows.
    pub(crate) fn new(
        matrix: &Matrix<'_>,
        axes: usize,
        precision: Precision,
    ) -> Result<Self, Breakdown> {
        let symbolic = analyse(&Skeleton::new(matrix, axes))?;
        let start = Instant::now();
        let entries = match precision {
            Precision::Double => Entries::Double(eliminate(&symbolic, matrix, None)?),
            Precision::Single => {
                let scale = unit_scale(&matrix.diagonal());
                Entries::Single(eliminate(&symbolic, matrix, Some(&scale))?, scale)
            }
        };
        Ok(Self {
            symbolic,
            entries,
            contact_unknowns: matrix.ordering.contact_unknowns + matrix.border.len(),
            bordered: !matrix.border.is_empty(),
            numeric_seconds: start.elapsed().as_secs_f64(),
        })
    }

    fn lower<'a, T>(&'a self, values: &'a [T]) -> Lower<'a, T> {
        Lower {
            symbolic: &self.symbolic,
            values,
            contact_unknowns: self.contact_unknowns,
        }
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
        self.symbolic.len_val()
    }

    /// What they are stored in.
    pub(crate) fn precision(&self) -> Precision {
        match self.entries {
            Entries::Double(_) => Precision::Double,
            Entries::Single(..) => Precision::Single,
        }
    }

    /// Number of contact unknowns or rows of the border, the last ones.
    pub(crate) fn contact_unknowns(&self) -> usize {
        self.contact_unknowns
    }

    /// G of the contact unknowns, `S⁻¹` (C2) or `W Wᵀ` (C17), in m/N; both triangles are filled.
    pub(crate) fn compliance(&self) -> Mat<f64> {
        if self.bordered {
            return with_lower!(self, lower => lower.border_compliance());
        }
        match &self.entries {
            Entries::Double(values) => inverse_of_product(self.lower(values).trailing_block()),
            Entries::Single(values, scale) => {
                let of_scaled = inverse_of_product(self.lower(values).trailing_block());
                let scale = &scale[self.unknowns() - self.contact_unknowns..];
                let entry = |i, j| scale[i] * scale[j] * f64::from(of_scaled[(i, j)]);
                Mat::from_fn(scale.len(), scale.len(), entry)
            }
        }
    }

    /// `L_cc` of (C2), of a factor in double precision.
    pub(crate) fn trailing_block(&self) -> Option<Mat<f64>> {
        match &self.entries {
            Entries::Double(values) if !self.bordered => Some(self.lower(values).trailing_block()),
            _ => None,
        }
    }

    /// `x ← L⁻¹ x`.
    pub(crate) fn forward(&self, x: &mut [f64]) {
        self.scale(0..x.len(), x);
        with_lower!(self, lower => lower.forward_over(lower.all(), self.unknowns(), x));
    }

    /// `x_o ← L⁻¹ x_o`, `x_c ← x_c − W x_o` with the border W (C17).
    pub(crate) fn forward_before_contact(&self, x: &mut [f64]) {
        with_lower!(self, lower => lower.forward_over(lower.of_ordinary(), lower.ordinary(), x));
    }

    /// `x ← L⁻¹ x` for an `x` that vanishes before the contact unknowns.
    pub(crate) fn forward_on_contact(&self, x: &mut [f64]) {
        self.scale(self.unknowns() - self.contact_unknowns..x.len(), x);
        with_lower!(self, lower => lower.forward_over(lower.of_contacts(), self.unknowns(), x));
    }

    /// `x ← L⁻ᵀ x`.
    pub(crate) fn backward(&self, x: &mut [f64]) {
        with_lower!(self, lower => lower.backward_over(lower.all(), self.unknowns(), x));
        self.scale(0..x.len(), x);
    }

    /// `x_o ← L⁻ᵀ (x_o − Wᵀ x_c)` with the border W (C17).
    pub(crate) fn backward_before_contact(&self, x: &mut [f64]) {
        with_lower!(self, lower => lower.backward_over(lower.of_ordinary(), lower.ordinary(), x));
    }

    /// The contact part of `L⁻ᵀ x`, which is `L_cc⁻ᵀ x_c`; `x` is overwritten.
    pub(crate) fn backward_on_contact<'x>(&self, x: &'x mut [f64]) -> &'x [f64] {
        with_lower!(self, lower => lower.backward_over(lower.of_contacts(), self.unknowns(), x));
        let ordinary = self.unknowns() - self.contact_unknowns;
        self.scale(ordinary..x.len(), x);
        &x[ordinary..]
    }

    /// `x ← D x` at some positions (C32).
    fn scale(&self, at: Range<usize>, x: &mut [f64]) {
        if let Entries::Single(_, scale) = &self.entries {
            let pairs = x[at.clone()].iter_mut().zip(&scale[at]);
            pairs.for_each(|(x, d)| *x *= d);
        }
    }
}

/// D of (C32).
fn unit_scale(diagonal: &[f64]) -> Vec<f64> {
    let of_one = |&entry: &f64| match entry > 0.0 && entry.is_finite() {
        true => (-0.5 * entry.log2()).round().exp2(),
        false => 1.0,
    };
    diagonal.iter().map(of_one).collect()
}

/// Where L has entries, in supernodes.
fn analyse(upper: &Skeleton) -> Result<SymbolicSupernodalCholesky<usize>, Breakdown> {
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
pub(super) fn count(matrix: &Matrix<'_>, axes: usize) -> Result<(usize, f64), Breakdown> {
    let symbolic = analyse(&Skeleton::new(matrix, axes))?;
    let operations = (0..symbolic.n_supernodes()).map(|index| {
        let supernode = symbolic.supernode(index);
        let width = symbolic.supernode_end()[index] - supernode.start();
        let rows = (0..width).map(|own| (width - own + supernode.pattern().len()) as f64);
        // The rank-one update of a column touches half of a square.
        rows.map(|rows| 0.5 * rows * rows).sum::<f64>()
    });
    Ok((symbolic.len_val(), operations.sum()))
}

/// The values of L, or of L̂ with the factors D.
fn eliminate<T: Number>(
    symbolic: &SymbolicSupernodalCholesky<usize>,
    matrix: &Matrix<'_>,
    scale: Option<&[f64]>,
) -> Result<Vec<T>, Breakdown> {
    let lower = Columns::new(matrix, scale);
    // Asked for first, because `vec!` ends the program where there is no memory.
    Vec::<T>::new()
        .try_reserve_exact(symbolic.len_val())
        .map_err(|_| Breakdown::TooLarge)?;
    let mut values = vec![T::nearest(0.0); symbolic.len_val()];
    let parallelism = get_global_parallelism();
    let scratch = factorize_supernodal_numeric_llt_scratch::<usize, T>(
        symbolic,
        parallelism,
        Default::default(),
    );
    let mut memory = MemBuffer::try_new(scratch).map_err(|_| Breakdown::TooLarge)?;
    let result = factorize_supernodal_numeric_llt(
        &mut values,
        lower.as_matrix(),
        Default::default(),
        symbolic,
        parallelism,
        MemStack::new(&mut memory),
        Default::default(),
    );
    let unit = |column: usize| scale.map_or(1.0, |scale| scale[column].powi(-2));
    if let Err(LltError::NonPositivePivot { index }) = result {
        // In the border it is an overflow of all that came before.
        let dof = matrix
            .ordering
            .dof
            .get(index)
            .or(matrix.ordering.dof.last());
        return Err(Breakdown::Pivot {
            dof: dof.copied().unwrap_or_default(),
            pivot: f64::NAN,
            diagonal: unit(index) * lower.diagonal(index),
        });
    }
    let factor = Lower {
        symbolic,
        values: &values,
        contact_unknowns: 0,
    };
    check_pivots(&factor, &lower, (matrix.ordering, unit))?;
    Ok(values)
}

/// Refuses a factor whose pivots are round-off: the body can move without force, or single precision cannot tell.
fn check_pivots<T: Number>(
    factor: &Lower<'_, T>,
    lower: &Columns<T>,
    (ordering, unit): (&Ordering, impl Fn(usize) -> f64),
) -> Result<(), Breakdown> {
    for index in factor.all() {
        let supernode = factor.supernode(index);
        // Those of a border are what C is.
        for own in 0..supernode.width_before(ordering.unknowns()) {
            let entry: f64 = supernode.column(own)[own].into();
            let pivot = entry.powi(2);
            let column = supernode.start + own;
            let diagonal = lower.diagonal(column);
            let sound = pivot > T::SINGULAR * diagonal && pivot.is_finite();
            if !sound {
                return Err(Breakdown::Pivot {
                    dof: ordering.dof[column],
                    pivot: unit(column) * pivot,
                    diagonal: unit(column) * diagonal,
                });
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::condensation::local_axes::Frames;
    use crate::condensation::ordering::Role;
    use crate::condensation::tests::lattice::Lattice;

    /// Factors of a lattice in a unit, held at its bottom, with its top for contacts.
    fn factors(unit: f64) -> [Factor; 2] {
        let lattice = Lattice::new([5, 4, 3]);
        let stiffness = lattice.stiffness().map(|k| unit * k);
        let height = |dof: usize| lattice.position(dof / 3)[2];
        let role = |dof| match height(dof) {
            0.0 => Role::Held,
            3.0 => Role::Contact,
            _ => Role::Ordinary,
        };
        let roles: Vec<Role> = (0..3 * lattice.nodes()).map(role).collect();
        let contact = (0..roles.len()).filter(|&dof| roles[dof] == Role::Contact);
        let contact: Vec<usize> = contact.collect();
        let ordering = Ordering::new(&stiffness, (&[], 3), &roles, &contact).unwrap();
        let matrix = Matrix {
            stiffness: &stiffness,
            frames: &Frames::new(3, lattice.nodes(), &[]),
            ordering: &ordering,
            border: &[],
        };
        [Precision::Double, Precision::Single]
            .map(|precision| Factor::new(&matrix, 3, precision).unwrap())
    }

    fn assert_seven_digits(found: &[f64], expected: &[f64]) {
        let largest = expected.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let pairs = found.iter().zip(expected);
        let off = pairs.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
        assert!(off < 1e-5 * largest && off > 0.0, "{off:e} of {largest:e}");
    }

    #[test]
    fn single_precision_has_seven_digits_whatever_the_unit() {
        // Beyond what four bytes can hold, but for the scale (C32).
        for unit in [1e-60, 1.0, 1e60] {
            let factors = factors(unit);
            let [double, single] = factors.each_ref();
            let solved = [double, single].map(|factor| {
                let mut x: Vec<f64> = (0..factor.unknowns()).map(|k| (k as f64).sin()).collect();
                factor.forward(&mut x);
                factor.backward(&mut x);
                x
            });
            assert_seven_digits(&solved[1], &solved[0]);
            let on_contact = [double, single].map(|factor| {
                let ordinary = factor.unknowns() - factor.contact_unknowns();
                let mut x = vec![0.0; factor.unknowns()];
                x[ordinary..].fill(1.0);
                factor.forward_on_contact(&mut x);
                factor.backward_on_contact(&mut x).to_vec()
            });
            assert_seven_digits(&on_contact[1], &on_contact[0]);
            let [expected, found] = [double, single].map(Factor::compliance);
            assert_seven_digits(found.col_as_slice(7), expected.col_as_slice(7));
            // Forces on contacts alone move them by G.
            let rows = expected.row_iter().map(|row| row.iter().sum::<f64>());
            let moved: Vec<f64> = rows.collect();
            let largest = moved.iter().fold(0.0_f64, |most, u| most.max(u.abs()));
            let pairs = moved.iter().zip(&on_contact[0]);
            assert!(pairs.fold(0.0, |most: f64, (a, b)| most.max((a - b).abs())) < 1e-12 * largest);
        }
    }

    #[test]
    fn half_the_bytes() {
        let [double, single] = factors(1.0);
        assert_eq!(double.entries(), single.entries());
        let bytes = [double, single].map(|factor| factor.precision().bytes());
        assert_eq!(bytes, [8, 4]);
    }
}
