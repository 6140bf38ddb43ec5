//! Projected block Gauss–Seidel on the compliance (NSGS): the prediction, and the baseline.
//!
//! One pass visits every contact and projects its reaction with all others held:
//!
//! ```text
//! (D1)  t_N ← min(0, t_N − (u_N − g₀) / G_NN)
//! (D2)  t_T ← P(t_T − u_T / λ)       P: projection on the disc of radius −μ t_N,
//!                                    λ: largest eigenvalue of the contact's G_TT
//! ```
//!
//! Laws of contact beyond Coulomb's have other radii; a bilateral contact no `min`.
//!
//! Jourdan, Alart, Jean, Comput. Methods Appl. Mech. Eng. 155 (1998) 31–47.

use crate::problem::ContactProblem;
use crate::processor::{dot, widest};

/// The passes over one problem; step lengths are computed once.
#[derive(Debug)]
pub struct GaussSeidel<'a> {
    problem: &'a ContactProblem,
    steps: Vec<Step>,
}

/// Step lengths of a contact, in N/m; zero where the compliance vanishes.
#[derive(Debug)]
struct Step {
    normal: f64,
    tangential: f64,
}

impl<'a> GaussSeidel<'a> {
    /// For all contacts of a problem.
    #[must_use]
    pub fn new(problem: &'a ContactProblem) -> Self {
        let steps = problem.offsets().windows(2).map(|block| {
            let [n, end] = [block[0], block[1]];
            let g = problem.compliance();
            let largest = match end - n {
                1 => 0.0,
                2 => g[(n + 1, n + 1)],
                _ => largest_eigenvalue(g[(n + 1, n + 1)], g[(n + 2, n + 1)], g[(n + 2, n + 2)]),
            };
            Step {
                normal: inverse(g[(n, n)]),
                tangential: inverse(largest),
            }
        });
        Self {
            problem,
            steps: steps.collect(),
        }
    }

    /// One pass; returns the change of the reaction, relative to the reaction.
    pub fn pass(&self, reaction: &mut [f64]) -> f64 {
        let (mut change, mut size) = (0.0, 0.0);
        for contact in 0..self.problem.contacts() {
            let range = self.problem.offsets()[contact]..self.problem.offsets()[contact + 1];
            let mut before = [0.0; 3];
            let before = &mut before[..range.len()];
            before.copy_from_slice(&reaction[range.clone()]);
            self.project(contact, reaction);
            for (new, old) in reaction[range].iter().zip(before) {
                change += (new - *old).powi(2);
                size += new * new;
            }
        }
        if size > 0.0 {
            (change / size).sqrt()
        } else {
            0.0
        }
    }

    /// (D1) then (D2) for one contact.
    fn project(&self, contact: usize, reaction: &mut [f64]) {
        let problem = self.problem;
        let (n, end) = (problem.offsets()[contact], problem.offsets()[contact + 1]);
        let displacement = |unknown: usize, reaction: &[f64]| {
            let column = problem.compliance().col_as_slice(unknown);
            problem.free_displacement()[unknown]
                + widest(
                    #[inline(always)]
                    || dot(column, reaction),
                )
        };
        let step = &self.steps[contact];
        let penetration = displacement(n, reaction) - problem.initial_gap()[contact];
        reaction[n] -= step.normal * penetration;
        if !problem.is_bilateral(contact) {
            reaction[n] = reaction[n].min(0.0);
        }
        let bound = problem.friction_bound(contact, reaction[n]);
        let trial: [f64; 2] = std::array::from_fn(|axis| {
            let unknown = n + 1 + axis;
            if unknown < end && bound > 0.0 {
                reaction[unknown] - step.tangential * displacement(unknown, reaction)
            } else {
                0.0
            }
        });
        let size = trial[0].hypot(trial[1]);
        let shrink = if size > bound { bound / size } else { 1.0 };
        for (unknown, value) in (n + 1..end).zip(trial) {
            reaction[unknown] = shrink * value;
        }
    }
}

fn inverse(compliance: f64) -> f64 {
    if compliance > 0.0 {
        compliance.recip()
    } else {
        0.0
    }
}

/// Of the symmetric matrix `[[a, b], [b, c]]`.
fn largest_eigenvalue(a: f64, b: f64, c: f64) -> f64 {
    0.5 * (a + c) + (0.5 * (a - c)).hypot(b)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use faer::{Mat, mat};

    use super::*;
    use crate::problem::Operator;

    #[test]
    fn a_pass_presses_then_rubs_each_contact() {
        // G = [[1, −1], [−1, 2]], û = (0.25, 0.5), μ = ½: t_N = −¼; then u_T = 0.5 + 0.25, and −u_T/2 is more
        // than the bound of ⅛.
        let operator = Operator::from_compliance(mat![[1.0, -1.0], [-1.0, 2.0]]).unwrap();
        let free = vec![0.25, 0.5];
        let problem = ContactProblem::new(&[1], vec![0.5], vec![0.0], free, operator).unwrap();
        let mut reaction = vec![0.0; 2];
        assert_eq!(GaussSeidel::new(&problem).pass(&mut reaction), 1.0);
        assert_eq!(reaction, [-0.25, -0.125]);
    }

    #[test]
    fn friction_in_space_is_brought_back_to_its_disc() {
        // G = 1, û = (1, 3, 4), μ = 1: t_N = −1, and (−3, −4) is five times what the disc holds.
        let operator = Operator::from_compliance(Mat::identity(3, 3)).unwrap();
        let free = vec![1.0, 3.0, 4.0];
        let problem = ContactProblem::new(&[2], vec![1.0], vec![0.0], free, operator).unwrap();
        let mut reaction = vec![0.0; 3];
        GaussSeidel::new(&problem).pass(&mut reaction);
        for (found, expected) in reaction.iter().zip([-1.0, -0.6, -0.8]) {
            assert!((found - expected).abs() < 1e-15, "{reaction:?}");
        }
    }

    #[test]
    fn a_contact_sees_what_the_one_before_it_became() {
        // Smooth, G = [[2, 1], [1, 2]], û = (3, 3): −3/2, then −(3 − 3/2)/2; in the end −1 both.
        let operator = Operator::from_compliance(mat![[2.0, 1.0], [1.0, 2.0]]).unwrap();
        let (zero, free) = (vec![0.0; 2], vec![3.0; 2]);
        let problem = ContactProblem::new(&[0, 0], zero.clone(), zero, free, operator).unwrap();
        let (passes, mut reaction) = (GaussSeidel::new(&problem), vec![0.0; 2]);
        passes.pass(&mut reaction);
        assert_eq!(reaction, [-1.5, -0.75]);
        // The error falls to a quarter per pass.
        let change = (0..24).map(|_| passes.pass(&mut reaction)).last();
        assert!(change.unwrap() < 1e-13 && (reaction[0] + 1.0).abs() < 1e-13);
    }
}
