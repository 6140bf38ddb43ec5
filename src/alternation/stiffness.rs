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

use crate::problem::{ContactProblem, Floating};

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

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::problem::Operator;
    use faer::mat;

    /// Two smooth contacts of compliance ½ and ¼ m/N under a rigid lid that sinks by α and
    /// tilts by β: u = G t + (α + β, α − β). It carries 6 N and 2 N on the modes.
    fn lid() -> ContactProblem {
        let operator = Operator::from_compliance(mat![[0.5, 0.0], [0.0, 0.25]]).unwrap();
        let problem =
            ContactProblem::new(&[0, 0], vec![0.0; 2], vec![0.0; 2], vec![0.0; 2], operator);
        let modes = mat![[1.0, 1.0], [1.0, -1.0]];
        let floating = Floating::new(modes, vec![6.0, 2.0]).unwrap();
        problem.unwrap().float(floating).unwrap()
    }

    #[test]
    fn a_rigid_motion_meets_no_stiffness() {
        let problem = lid();
        let stiffness = Stiffness::new(&problem).unwrap();
        // As many modes as contacts: statics alone decides, and nothing of S = (2, 4) is left.
        assert!(stiffness.matrix.norm_max() < 1e-14);
    }

    #[test]
    fn a_reaction_is_corrected_into_equilibrium() {
        // t_1 + t_2 + 6 = 0 and t_1 − t_2 + 2 = 0.
        let problem = lid();
        let stiffness = Stiffness::new(&problem).unwrap();
        let found = stiffness.balanced(&[-1.0, 5.0]);
        assert!(
            (found[0] + 4.0).abs() < 1e-14 && (found[1] + 2.0).abs() < 1e-14,
            "{found:?}"
        );
    }

    #[test]
    fn the_lid_follows_its_contacts() {
        // From t in equilibrium, u stays closed: δu = −G t = (2, ½) is all rigid, α + β = 2, α − β = ½.
        let problem = lid();
        let stiffness = Stiffness::new(&problem).unwrap();
        let moved = stiffness.motion(&[2.0, 0.5], &[-4.0, -2.0]);
        assert!(
            (moved[0] - 1.25).abs() < 1e-14 && (moved[1] - 0.75).abs() < 1e-14,
            "{moved:?}"
        );
    }

    #[test]
    fn a_motion_that_no_contact_feels_stays_at_rest() {
        let operator = Operator::from_compliance(mat![[0.5]]).unwrap();
        let problem = ContactProblem::new(&[0], vec![0.0], vec![0.0], vec![0.0], operator).unwrap();
        let floating = Floating::new(mat![[1.0, 0.0]], vec![3.0, 0.0]).unwrap();
        let problem = problem.float(floating).unwrap();
        let moved = Stiffness::new(&problem).unwrap().motion(&[1.0], &[-3.0]);
        assert_eq!(moved, [1.0, 0.0]);
    }
}
