//! The stiffness that corrections see, freed of the rigid motions of floating bodies.
//!
//! With `u = û + G t + R α` (C3) and `S = G⁻¹`, a change of the displacement that keeps
//! the bodies in equilibrium changes reaction and rigid motion by
//!
//! ```text
//! (D5)  δt = S' δu − S R M⁻¹ (Rᵀ t + e),     S' = S − S R M⁻¹ Rᵀ S,   M = Rᵀ S R
//!       δα = M⁻¹ (Rᵀ S δu + Rᵀ t + e)
//! ```
//!
//! S' is the stiffness of the floating bodies themselves, however G was grounded. A motion
//! that no contact feels has no part in M and stays at rest.

use std::borrow::Cow;

use faer::{Col, ColRef, Mat, Side};

use crate::condensation::{ContactProblem, Floating};

/// An eigenvalue of M below this part of the largest belongs to a motion that no contact feels.
const FELT: f64 = 1e-12;

/// S' and what (D5) needs beside it.
pub(super) struct Stiffness<'a> {
    /// S' in N/m; S where every body is held.
    pub(super) matrix: Cow<'a, Mat<f64>>,
    rigid: Option<Rigid<'a>>,
}

/// The rigid motions in (D5).
struct Rigid<'a> {
    floating: &'a Floating,
    /// `S R M⁻¹`, unknowns × modes.
    lift: Mat<f64>,
    /// `M⁻¹`.
    inverse: Mat<f64>,
}

impl<'a> Stiffness<'a> {
    /// `None` where the compliance has no inverse.
    pub(super) fn new(problem: &'a ContactProblem) -> Option<Self> {
        let grounded = problem.operator().stiffness()?;
        let Some(floating) = problem.floating() else {
            return Some(Self {
                matrix: Cow::Borrowed(grounded),
                rigid: None,
            });
        };
        let moved = grounded * floating.modes();
        let inverse = pseudo_inverse(&(floating.modes().transpose() * &moved))?;
        let lift = &moved * &inverse;
        let matrix = Cow::Owned(grounded - &lift * moved.transpose());
        let rigid = Some(Rigid {
            floating,
            lift,
            inverse,
        });
        Some(Self { matrix, rigid })
    }

    /// `t − S R M⁻¹ (Rᵀ t + e)`: the reaction, corrected into equilibrium.
    pub(super) fn balanced(&self, reaction: &[f64]) -> Vec<f64> {
        let Some(rigid) = &self.rigid else {
            return reaction.to_vec();
        };
        let correction = &rigid.lift * rigid.remainder(reaction);
        let pairs = reaction.iter().zip(correction.iter());
        pairs.map(|(t, c)| t - c).collect()
    }

    /// δα of (D5) for a change of the displacement from `reaction`; empty if nothing floats.
    pub(super) fn motion(&self, change: &[f64], reaction: &[f64]) -> Vec<f64> {
        let Some(rigid) = &self.rigid else {
            return Vec::new();
        };
        let motion = rigid.lift.transpose() * ColRef::from_slice(change)
            + &rigid.inverse * rigid.remainder(reaction);
        motion.iter().copied().collect()
    }
}

impl Rigid<'_> {
    /// `Rᵀ t + e`, in newton.
    fn remainder(&self, reaction: &[f64]) -> Col<f64> {
        self.floating.modes().transpose() * ColRef::from_slice(reaction)
            + ColRef::from_slice(self.floating.load())
    }
}

/// Inverse of a symmetric matrix on the directions in which it is not zero.
fn pseudo_inverse(matrix: &Mat<f64>) -> Option<Mat<f64>> {
    let eigen = matrix.self_adjoint_eigen(Side::Lower).ok()?;
    let (values, vectors) = (eigen.S().column_vector(), eigen.U());
    let largest = values.iter().copied().fold(0.0, f64::max);
    let mut inverse = Mat::zeros(matrix.nrows(), matrix.ncols());
    for (k, vector) in vectors.col_iter().enumerate() {
        if values[k] > FELT * largest {
            inverse += vector * vector.transpose() * faer::Scale(values[k].recip());
        }
    }
    Some(inverse)
}
