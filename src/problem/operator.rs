//! The condensed operator: compliance G, and stiffness S where it exists.
//!
//! ```text
//! (C2)  S = L Lᵀ      G = S⁻¹ = L⁻ᵀ L⁻¹      L: lower triangular
//! ```

use std::ops::Range;
use std::sync::OnceLock;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt;
use faer::linalg::matmul::matmul;
use faer::linalg::matmul::triangular::{self, BlockStructure};
use faer::linalg::solvers::Llt;
use faer::linalg::triangular_inverse::invert_lower_triangular;
use faer::traits::ComplexField;
use faer::traits::math_utils::one;
use faer::{Accum, ColMut, ColRef, Mat, MatRef, Par, Side, get_global_parallelism};
use rayon::prelude::*;

use super::Compliance;
use crate::error::{Error, check_finite};
use crate::processor::add_column;

/// Largest asymmetry `|G_ij − G_ji|` accepted, relative to the largest entry of G.
const SYMMETRY: f64 = 1e-10;

/// Most negative eigenvalue accepted, relative to the trace of G: what entries rounded to seven
/// digits, as published ones are, can make of a semi-definite G.
const DEFINITE: f64 = 1e-7;

/// Rows of a product that a thread takes at a time.
const ROWS: usize = 512;

/// A pivot below this part of its diagonal entry makes G numerically singular.
const PIVOT: f64 = 1e-10;

/// Shift ε of a singular G, relative to its largest diagonal entry.
const SHIFT: f64 = 1e-6;

/// Compliance of the contact surface, symmetric positive semi-definite, in m/N.
///
/// Rows and columns follow the contacts, normal first in every block. The stiffness
/// `S = G⁻¹` is formed once, when somebody first asks for it.
#[derive(Clone, Debug)]
pub struct Operator {
    compliance: Mat<f64>,
    /// `L_cc` of (C2), from which S comes with the digits that G has lost where bodies are slender.
    factor: Option<Mat<f64>>,
    stiffness: OnceLock<Option<Mat<f64>>>,
    rounded_stiffness: OnceLock<Option<RoundedStiffness>>,
}

/// S in single precision: for corrections of what G itself says.
#[derive(Clone, Debug)]
pub(crate) struct RoundedStiffness {
    /// Inverse of `D⁻¹ G D⁻¹`, whose diagonal is one; both triangles.
    of_scaled: Mat<f32>,
    /// D: roots of the diagonal of G.
    scale: Vec<f64>,
}

impl RoundedStiffness {
    /// Entry of S, in N/m.
    pub(crate) fn entry(&self, row: usize, column: usize) -> f64 {
        f64::from(self.of_scaled[(row, column)]) / (self.scale[row] * self.scale[column])
    }

    /// Adds S w to a force, in newton, for a w in metre of some unknowns. Rows are divided among threads, each of which is
    /// summed up in the order of the unknowns.
    pub(crate) fn add_product(&self, force: &mut [f64], moved: &[(usize, f64)]) {
        let moved = moved.iter().map(|&(at, w)| (at, w / self.scale[at]));
        let moved: Vec<(usize, f64)> = moved.collect();
        let chunks = force.par_chunks_mut(ROWS).enumerate();
        chunks.for_each(|(chunk, force)| {
            let first = chunk * ROWS;
            let mut scaled = vec![0.0; force.len()];
            for &(column, w) in &moved {
                let entries = &self.of_scaled.col_as_slice(column)[first..];
                add_column(&mut scaled, w, entries);
            }
            let scale = &self.scale[first..];
            let pairs = force.iter_mut().zip(scaled.iter().zip(scale));
            pairs.for_each(|(force, (sum, scale))| *force += sum / scale);
        });
    }
}

impl Operator {
    /// Takes a compliance that some other code computed.
    ///
    /// # Errors
    ///
    /// A matrix that is not square, not finite, not symmetric or not positive semi-definite, with
    /// the size of the violation.
    pub fn from_compliance(compliance: Mat<f64>) -> Result<Self, Error> {
        let operator = Self::from_bodies(compliance)?;
        operator.check_definite()?;
        Ok(operator)
    }

    /// The entries of another compliance, by a product per unknown; symmetric whatever round-off the products
    /// have.
    ///
    /// # Errors
    ///
    /// Those of [`from_compliance`](Self::from_compliance).
    pub fn from_products(other: &impl Compliance) -> Result<Self, Error> {
        let size = other.size();
        let mut columns = Mat::zeros(size, size);
        let mut unit = vec![0.0; size];
        for column in 0..size {
            unit[column] = 1.0;
            other.add_product(&unit, columns.col_as_slice_mut(column));
            unit[column] = 0.0;
        }
        let mean = |i, j| 0.5 * (columns[(i, j)] + columns[(j, i)]);
        Self::from_compliance(Mat::from_fn(size, size, mean))
    }

    /// Takes a sum of compliances of bodies, which is as definite as they are.
    pub(crate) fn from_bodies(compliance: Mat<f64>) -> Result<Self, Error> {
        let size = compliance.nrows();
        if compliance.ncols() != size {
            let (expected, found) = (size, compliance.ncols());
            return Err(Error::Length {
                place: "operator columns".into(),
                expected,
                found,
            });
        }
        let mut largest = 0.0_f64;
        for j in 0..size {
            check_finite(&format!("operator column {j}"), compliance.col_as_slice(j))?;
            largest = compliance
                .col_as_slice(j)
                .iter()
                .fold(largest, |m, x| m.max(x.abs()));
        }
        check_symmetric(&compliance, largest)?;
        for j in 0..size {
            if compliance[(j, j)] < 0.0 {
                return Err(Error::OutOfRange {
                    place: format!("operator[{j}][{j}]"),
                    value: compliance[(j, j)],
                    accepted: "a diagonal entry >= 0",
                });
            }
        }
        Ok(Self::of_body(compliance, None))
    }

    /// Refuses a G of negative energy: a reaction `t` with `½ t · G t < 0`.
    ///
    /// A shift by what round-off may cost makes a semi-definite G definite, and only that.
    fn check_definite(&self) -> Result<(), Error> {
        let size = self.size();
        let largest = self.compliance.norm_max();
        if largest == 0.0 {
            return Ok(());
        }
        // Order one, so that no product of two entries overflows or vanishes.
        let mut shifted = Mat::from_fn(size, size, |i, j| self.compliance[(i, j)] / largest);
        let shift = DEFINITE * (0..size).map(|i| shifted[(i, i)]).sum::<f64>();
        for i in 0..size {
            shifted[(i, i)] += shift;
        }
        if shifted.llt(Side::Lower).is_ok() {
            return Ok(());
        }
        let lowest = match shifted.self_adjoint_eigenvalues(Side::Lower) {
            Ok(eigenvalues) => eigenvalues.into_iter().fold(f64::INFINITY, f64::min),
            Err(_) => f64::NAN,
        };
        Err(Error::Indefinite {
            eigenvalue: largest * (lowest - shift),
            largest,
        })
    }

    /// Takes G of a body as its factor gives it, symmetric to the last bit and definite, and `L_cc` of that factor
    /// (C2) if it has one.
    #[must_use]
    pub(crate) fn of_body(compliance: Mat<f64>, factor: Option<Mat<f64>>) -> Self {
        Self {
            compliance,
            factor,
            stiffness: OnceLock::new(),
            rounded_stiffness: OnceLock::new(),
        }
    }

    /// Number of unknowns.
    #[must_use]
    pub fn size(&self) -> usize {
        self.compliance.nrows()
    }

    /// G, in m/N; both triangles are filled.
    #[must_use]
    pub fn compliance(&self) -> &Mat<f64> {
        &self.compliance
    }

    /// S = G⁻¹, in N/m.
    ///
    /// Where G is numerically singular (rigid bodies) this is `(G + ε 1)⁻¹`: good for
    /// corrections of a state whose displacement is taken from G, not for the state itself.
    #[must_use]
    pub fn stiffness(&self) -> Option<&Mat<f64>> {
        self.stiffness
            .get_or_init(|| self.form_stiffness())
            .as_ref()
    }

    /// S in single precision; none where that does not invert G.
    pub(crate) fn rounded_stiffness(&self) -> Option<&RoundedStiffness> {
        let form = || self.form_rounded_stiffness();
        self.rounded_stiffness.get_or_init(form).as_ref()
    }

    fn form_rounded_stiffness(&self) -> Option<RoundedStiffness> {
        let (size, g) = (self.size(), &self.compliance);
        let scale: Vec<f64> = (0..size).map(|i| g[(i, i)].sqrt()).collect();
        let entry = |i: usize, j: usize| (g[(i, j)] / (scale[i] * scale[j])) as f32;
        let mut lower = Mat::from_fn(size, size, |i, j| if i >= j { entry(i, j) } else { 0.0 });
        let room = llt::factor::cholesky_in_place_scratch::<f32>(
            size,
            get_global_parallelism(),
            Default::default(),
        );
        let factored = llt::factor::cholesky_in_place(
            lower.as_mut(),
            Default::default(),
            get_global_parallelism(),
            MemStack::new(&mut MemBuffer::new(room)),
            Default::default(),
        );
        factored.ok()?;
        let of_scaled = inverse_of_product(lower);
        Some(RoundedStiffness { of_scaled, scale })
    }

    fn form_stiffness(&self) -> Option<Mat<f64>> {
        if let Some(factor) = &self.factor {
            return Some(symmetric_product(
                (factor.as_ref(), BlockStructure::TriangularLower),
                (factor.transpose(), BlockStructure::TriangularUpper),
            ));
        }
        let cholesky = self.cholesky()?;
        Some(inverse_of_product(cholesky.L().to_owned()))
    }

    /// Factor of G, or of `G + ε 1` where G is numerically singular.
    fn cholesky(&self) -> Option<Llt<f64>> {
        let diagonal = |i: usize| self.compliance[(i, i)];
        if let Ok(cholesky) = self.compliance.llt(Side::Lower) {
            let lower = cholesky.L();
            if (0..self.size()).all(|i| lower[(i, i)].powi(2) > PIVOT * diagonal(i)) {
                return Some(cholesky);
            }
        }
        let mut shifted = self.compliance.clone();
        let shift = SHIFT * (0..self.size()).map(diagonal).fold(0.0, f64::max);
        for i in 0..self.size() {
            shifted[(i, i)] += shift;
        }
        shifted.llt(Side::Lower).ok()
    }
}

impl Compliance for Operator {
    fn size(&self) -> usize {
        self.compliance().nrows()
    }

    fn add_product(&self, force: &[f64], displacement: &mut [f64]) {
        matmul(
            ColMut::from_slice_mut(displacement),
            Accum::Add,
            self.compliance(),
            ColRef::from_slice(force),
            1.0,
            Par::Seq,
        );
    }

    fn diagonal_block(&self, block: Range<usize>) -> [[f64; 3]; 3] {
        let mut entries = [[0.0; 3]; 3];
        for (a, row) in block.clone().enumerate() {
            for (b, column) in block.clone().enumerate() {
                entries[a][b] = self.compliance()[(row, column)];
            }
        }
        entries
    }

    fn precondition(&self, on: &[usize], residual: &[f64]) -> Vec<f64> {
        let own = on.iter().map(|&at| self.compliance()[(at, at)]);
        let pairs = own.zip(residual);
        pairs
            .map(|(own, r)| if own > 0.0 { r / own } else { 0.0 })
            .collect()
    }

    fn apply_block(&self, to: &[usize], of: &[usize], force: &[f64]) -> Vec<f64> {
        let mut moved = vec![0.0; to.len()];
        for (&column, t) in of.iter().zip(force) {
            let column = self.compliance().col_as_slice(column);
            to.iter()
                .zip(&mut moved)
                .for_each(|(&row, u)| *u += column[row] * t);
        }
        moved
    }
}

/// Refuses a matrix that is further from its transpose than [`SYMMETRY`] allows, with its worst pair.
fn check_symmetric(compliance: &Mat<f64>, largest: f64) -> Result<(), Error> {
    let (mut violation, mut row, mut column) = (0.0, 0, 0);
    for j in 0..compliance.ncols() {
        for i in j + 1..compliance.nrows() {
            let found = (compliance[(i, j)] - compliance[(j, i)]).abs();
            if found > violation {
                (violation, row, column) = (found, i, j);
            }
        }
    }
    if violation <= SYMMETRY * largest {
        return Ok(());
    }
    Err(Error::NotSymmetric {
        row,
        column,
        violation,
        largest,
    })
}

/// `(L Lᵀ)⁻¹ = L⁻ᵀ L⁻¹` (C2), both triangles; the upper triangle of L is not read.
pub(crate) fn inverse_of_product<T: ComplexField + Copy>(lower: Mat<T>) -> Mat<T> {
    let size = lower.nrows();
    let mut inverse = Mat::zeros(size, size);
    invert_lower_triangular(inverse.as_mut(), lower.as_ref(), get_global_parallelism());
    drop(lower);
    symmetric_product(
        (inverse.transpose(), BlockStructure::TriangularUpper),
        (inverse.as_ref(), BlockStructure::TriangularLower),
    )
}

/// Product of a triangular matrix and its transpose, half computed and half mirrored.
fn symmetric_product<T: ComplexField + Copy>(
    (left, of_left): (MatRef<'_, T>, BlockStructure),
    (right, of_right): (MatRef<'_, T>, BlockStructure),
) -> Mat<T> {
    let size = left.nrows();
    let mut product = Mat::zeros(size, size);
    triangular::matmul(
        product.as_mut(),
        BlockStructure::TriangularLower,
        Accum::Replace,
        left,
        of_left,
        right,
        of_right,
        one::<T>(),
        get_global_parallelism(),
    );
    for j in 0..size {
        for i in 0..j {
            product[(i, j)] = product[(j, i)];
        }
    }
    product
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use faer::mat;

    #[test]
    fn compliance_and_stiffness_of_a_factor_are_inverse() {
        let factor = mat![[2.0, 9.0, 9.0], [1.0, 3.0, 9.0], [-1.0, 0.5, 1.5]];
        let operator = Operator::of_body(inverse_of_product(factor.clone()), Some(factor));
        let product = operator.compliance() * operator.stiffness().unwrap();
        assert!((product - Mat::<f64>::identity(3, 3)).norm_max() < 1e-14);
        // S = L Lᵀ: row 2 of L is (1, 3, 0), so S_11 = 10.
        assert!((operator.stiffness().unwrap()[(1, 1)] - 10.0).abs() < 1e-14);
    }

    #[test]
    fn in_single_precision_the_stiffness_has_seven_digits_whatever_the_units() {
        // S = [[1, −1], [−1, 2]] of G = [[2, 1], [1, 1]], in units of 1e-12 m/N and 1e-6 as much per root.
        let [a, b] = [1e-6, 1e-9];
        let g = mat![[2.0 * a * a, a * b], [a * b, b * b]];
        let operator = Operator::from_compliance(g).unwrap();
        let stiffness = operator.rounded_stiffness().unwrap();
        let mut force = vec![0.0; 2];
        stiffness.add_product(&mut force, &[(0, 3.0 * a), (1, b)]);
        for (found, expected) in force.iter().zip([2.0 / a, -1.0 / b]) {
            assert!((found / expected - 1.0).abs() < 1e-6, "{force:?}");
        }
        assert!((stiffness.entry(1, 1) * b * b - 2.0).abs() < 1e-6);
        let singular = Operator::from_compliance(mat![[1.0, 1.0], [1.0, 1.0]]).unwrap();
        assert!(singular.rounded_stiffness().is_none());
    }

    #[test]
    fn stiffness_of_a_bare_compliance_is_its_inverse() {
        let operator = Operator::from_compliance(mat![[2.0, 1.0], [1.0, 1.0]]).unwrap();
        let expected = mat![[1.0, -1.0], [-1.0, 2.0]];
        assert!((operator.stiffness().unwrap() - expected).norm_max() < 1e-14);
    }

    #[test]
    fn a_singular_compliance_has_the_stiffness_of_a_shifted_one() {
        let operator = Operator::from_compliance(mat![[2.0, 0.0], [0.0, 0.0]]).unwrap();
        let stiffness = operator.stiffness().unwrap();
        // 1/(2 + 2e-6) and 1/2e-6.
        assert!((stiffness[(0, 0)] - 0.499_999_5).abs() < 1e-12);
        assert!((stiffness[(1, 1)] - 5e5).abs() < 1e-9);
    }

    #[test]
    fn an_indefinite_compliance_is_refused_with_its_negative_eigenvalue() {
        // Eigenvalues 1 − 2 and 1 + 2, in any unit.
        for unit in [1.0, 1e-300, 1e300] {
            let found = Operator::from_compliance(mat![[1.0, 2.0], [2.0, 1.0]] * faer::Scale(unit));
            let Err(Error::Indefinite {
                eigenvalue,
                largest,
            }) = found
            else {
                unreachable!("{found:?}")
            };
            assert!((eigenvalue / unit + 1.0).abs() < 1e-14 && largest == 2.0 * unit);
        }
    }

    #[test]
    fn a_compliance_that_is_semi_definite_up_to_round_off_is_accepted() {
        // Rank one; 1e-7 below it is within what rounded entries may be off, 1e-5 is not.
        let of = |below: f64| mat![[1.0, 1.0], [1.0, 1.0 - below]];
        assert!(Operator::from_compliance(of(0.0)).is_ok());
        assert!(Operator::from_compliance(of(1e-7)).is_ok());
        assert!(Operator::from_compliance(of(1e-5)).is_err());
        assert!(Operator::from_compliance(Mat::zeros(3, 3)).is_ok());
    }

    #[test]
    fn an_asymmetric_compliance_is_refused_with_its_worst_pair() {
        let of = |worst: f64| mat![[4.0, 0.5, 1.0], [0.25, 4.0, 1.0], [1.0 + worst, 1.0, 4.0]];
        let found = Operator::from_compliance(of(1.0)).unwrap_err();
        let expected = Error::NotSymmetric {
            row: 2,
            column: 0,
            violation: 1.0,
            largest: 4.0,
        };
        assert_eq!(found, expected);
        // 1 of 4, and what may be done about it.
        let said = found.to_string();
        for part in [
            "by 2.5e-1 of",
            "operator[2][0]",
            "at most 1e-10",
            "symmetrised",
        ] {
            assert!(said.contains(part), "{said}");
        }
    }

    #[test]
    fn a_matrix_offers_what_every_compliance_does() {
        let g = mat![[4.0, 1.0, 2.0], [1.0, 3.0, 0.5], [2.0, 0.5, 5.0]];
        let operator = Operator::from_compliance(g).unwrap();
        // Rows of G times (1, 2, −1).
        assert_eq!(operator.apply(&[1.0, 2.0, -1.0]), [4.0, 6.5, -2.0]);
        let mut moved = vec![1.0; 3];
        operator.add_product(&[1.0, 2.0, -1.0], &mut moved);
        assert_eq!(moved, [5.0, 7.5, -1.0]);
        assert_eq!(operator.apply_block(&[0, 2], &[1], &[2.0]), [2.0, 1.0]);
        let own = operator.diagonal_block(1..3);
        assert_eq!(own, [[3.0, 0.5, 0.0], [0.5, 5.0, 0.0], [0.0; 3]]);
        assert_eq!(operator.precondition(&[0, 2], &[2.0, 10.0]), [0.5, 2.0]);
        assert_eq!(
            Operator::from_products(&operator).unwrap().compliance(),
            operator.compliance()
        );
    }
}
