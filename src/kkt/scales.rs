//! What a residual is compared with: steps and load scales, computed once per problem.
//!
//! ```text
//! (K2)  w = û, plus −g₀ at contacts that interfere before loading (g₀ < 0) or never part
//!       f = (w·w / w·G w) w          load force: the best multiple of w against w itself
//! ```
//!
//! `f` is the force it takes to undo the free displacement, as one steepest-descent
//! step sees it. It is what a residual may be small against where the reaction itself
//! vanishes. Local stiffnesses times `û` would not do: a softly held body moves far
//! under a small load, and its contacts are stiff. Nor may `f` know `g₀ > 0`: contacts
//! far from the obstacle do not make the load any larger.

use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, MatMut, MatRef, Par};

use super::natural_map::{Step, largest, largest_block, norm};
use crate::problem::ContactProblem;

/// Smallest reaction that residuals are relative to, as a part of the load force. With
/// less, the round-off of `û` alone would keep a just grazing contact from passing.
const FLOOR: f64 = 1e-3;

/// The scales of one problem; all are zero when nothing acts.
#[derive(Clone, Debug)]
pub(super) struct Scales {
    /// Steps of (K1), per contact.
    pub(super) steps: Vec<Step>,
    /// `‖f‖₂` times the floor, in newton.
    pub(super) force_norm: f64,
    /// Largest `‖f_i‖` of a contact times the floor, in newton.
    pub(super) force: f64,
    /// Largest `‖w_i‖` of a contact, in metre.
    pub(super) length: f64,
    /// `‖ρ w‖₂`, in newton: what the terms of `u` are worth in (K1), however they cancel.
    pub(super) terms: f64,
}

impl Scales {
    pub(super) fn new(problem: &ContactProblem) -> Self {
        let steps = steps(problem);
        let undone = undone_displacement(problem);
        let local = local_force(problem.offsets(), &undone, &steps);
        let mut load = load_force(problem, &undone, &local);
        // What glue bears is there without any load.
        for (&normal, law) in problem
            .normals()
            .iter()
            .zip(problem.laws().unwrap_or_default())
        {
            load[normal] = load[normal].abs().max(law.tension);
        }
        Self {
            terms: norm(&local),
            steps,
            force_norm: FLOOR * norm(&load),
            force: FLOOR * largest_block(problem.offsets(), &load),
            length: largest_block(problem.offsets(), &undone),
        }
    }
}

/// `G t`, in metre: one pass over G, on one thread, as several would add up in their own order.
pub(super) fn compliance_product(compliance: &Mat<f64>, reaction: &[f64]) -> Vec<f64> {
    let mut product = vec![0.0; reaction.len()];
    matmul(
        MatMut::from_column_major_slice_mut(&mut product, reaction.len(), 1),
        Accum::Replace,
        compliance,
        MatRef::from_column_major_slice(reaction, reaction.len(), 1),
        1.0,
        Par::Seq,
    );
    product
}

/// Steps `ρ_N = 1/G_NN` and `ρ_T = 2/tr G_TT` (one tangent: `1/G_TT`) per contact.
///
/// A contact that its own reaction does not move (a zero on the diagonal, up to the
/// round-off of the largest entry) takes the largest step of the others: (K1) holds
/// with every positive step.
fn steps(problem: &ContactProblem) -> Vec<Step> {
    let diagonal = problem.compliance().diagonal().column_vector();
    let most = (0..problem.unknowns()).fold(0.0_f64, |most, k| most.max(diagonal[k]));
    let step = |mean: f64| (mean > f64::EPSILON * most).then(|| 1.0 / mean);
    let own: Vec<[Option<f64>; 2]> = problem
        .offsets()
        .windows(2)
        .map(|ends| {
            let tangents = ends[1] - ends[0] - 1;
            let trace: f64 = (ends[0] + 1..ends[1]).map(|k| diagonal[k]).sum();
            [diagonal[ends[0]], trace / tangents as f64].map(step)
        })
        .collect();
    let widest = own.iter().flatten().flatten().copied().fold(0.0, f64::max);
    let widest = if widest > 0.0 { widest } else { 1.0 };
    own.into_iter()
        .map(|[normal, tangential]| Step {
            normal: normal.unwrap_or(widest),
            tangential: tangential.unwrap_or(widest),
        })
        .collect()
}

/// `w` of (K2), in metre.
fn undone_displacement(problem: &ContactProblem) -> Vec<f64> {
    let mut undone = problem.free_displacement().to_vec();
    let laws = problem.laws();
    for (contact, (&normal, gap)) in problem
        .normals()
        .iter()
        .zip(problem.initial_gap())
        .enumerate()
    {
        let bilateral = laws.is_some_and(|laws| laws[contact].bilateral);
        undone[normal] -= if bilateral { *gap } else { gap.min(0.0) };
    }
    undone
}

/// What the local stiffnesses alone would make of `w`, in newton.
pub(super) fn local_force(offsets: &[usize], undone: &[f64], steps: &[Step]) -> Vec<f64> {
    let mut local = undone.to_vec();
    for (ends, step) in offsets.windows(2).zip(steps) {
        local[ends[0]] *= step.normal;
        local[ends[0] + 1..ends[1]]
            .iter_mut()
            .for_each(|w| *w *= step.tangential);
    }
    local
}

/// `f` of (K2), in newton; at most the local force of `w`, because a `w` that G hardly answers to
/// (singular G) has no bounded multiple.
fn load_force(problem: &ContactProblem, undone: &[f64], local: &[f64]) -> Vec<f64> {
    let length = largest(undone);
    if length == 0.0 {
        return vec![0.0; undone.len()];
    }
    let unit: Vec<f64> = undone.iter().map(|w| w / length).collect();
    let answer = compliance_product(problem.compliance(), &unit);
    let stiffness = dot(&unit, &unit) / dot(&unit, &answer);
    let global: Vec<f64> = undone.iter().map(|w| stiffness * w).collect();
    if stiffness > 0.0 && norm(&global) < norm(local) {
        global
    } else {
        local.to_vec()
    }
}

pub(super) fn dot(left: &[f64], right: &[f64]) -> f64 {
    left.iter().zip(right).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use faer::mat;

    use super::*;
    use crate::problem::Operator;

    fn problem(
        tangents: &[usize],
        gaps: &[f64],
        free: &[f64],
        compliance: Mat<f64>,
    ) -> ContactProblem {
        let operator = Operator::from_compliance(compliance).unwrap();
        let friction = vec![0.5; tangents.len()];
        ContactProblem::new(tangents, friction, gaps.to_vec(), free.to_vec(), operator).unwrap()
    }

    #[test]
    fn steps_are_the_local_stiffnesses() {
        let compliance = Mat::from_fn(
            4,
            4,
            |i, j| if i == j { [0.5, 1.0, 3.0, 4.0][i] } else { 0.0 },
        );
        let found = Scales::new(&problem(&[2, 0], &[0.0; 2], &[0.0; 4], compliance)).steps;
        // ρ_N = 1/0.5, ρ_T = 2/(1 + 3); the second contact has no tangent and takes the largest, 2.
        assert_eq!(
            found[0],
            Step {
                normal: 2.0,
                tangential: 0.5
            }
        );
        assert_eq!((found[1].normal, found[1].tangential), (0.25, 2.0));
    }

    #[test]
    fn an_unmovable_contact_takes_the_step_of_the_stiffest() {
        let compliance = mat![[0.5, 0.0, 0.0], [0.0, 0.25, 0.0], [0.0, 0.0, 1e-20]];
        let found = Scales::new(&problem(&[0, 0, 0], &[0.0; 3], &[1.0; 3], compliance)).steps;
        assert_eq!(
            found.iter().map(|s| s.normal).collect::<Vec<_>>(),
            [2.0, 4.0, 4.0]
        );
        let rigid = Scales::new(&problem(&[1], &[0.0], &[1.0, 0.0], Mat::zeros(2, 2)));
        assert!(rigid.steps[0].normal > 0.0 && rigid.force.is_finite());
    }

    #[test]
    fn the_load_force_of_a_softly_held_body_is_its_load_and_not_its_stiff_contacts() {
        // Two contacts of stiffness 1 N/m on a body held by k = 1e-6 N/m, pushed by 2 N:
        // û = 2/k, G = 1/k + I. Load force: (2 û²/(4 û²/k + 2 û²)) û ≈ 1 N each, not û = 2e6 N.
        let soft = 1e6;
        let compliance = mat![[soft + 1.0, soft], [soft, soft + 1.0]];
        let scales = Scales::new(&problem(&[0, 0], &[0.0; 2], &[2.0 * soft; 2], compliance));
        // But for k/2 beside one.
        assert!((scales.force / FLOOR - 1.0).abs() < 1e-6);
        assert!((scales.force_norm / FLOOR - 2.0_f64.sqrt()).abs() < 1e-6);
    }

    #[test]
    fn a_far_contact_does_not_enlarge_the_load_and_interference_is_a_load() {
        let far = Scales::new(&problem(
            &[0, 0],
            &[0.0, 1e9],
            &[1.0, 0.0],
            Mat::identity(2, 2),
        ));
        assert_eq!((far.force, far.length), (FLOOR, 1.0));
        let fit = Scales::new(&problem(
            &[0, 0],
            &[-2.0, 1e9],
            &[0.0; 2],
            Mat::identity(2, 2),
        ));
        assert_eq!((fit.force, fit.length), (2.0 * FLOOR, 2.0));
    }

    #[test]
    fn a_displacement_that_a_singular_operator_does_not_answer_gives_a_bounded_load() {
        // G (1, −1) = 0: the quotient has no bound, the local stiffnesses have.
        let compliance = mat![[1.0, 1.0], [1.0, 1.0]];
        let scales = Scales::new(&problem(&[0, 0], &[0.0; 2], &[1.0, -1.0], compliance));
        assert_eq!(scales.force, FLOOR);
    }
}
