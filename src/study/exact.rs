//! Half-steps to the last digit, for study: Newton on the natural map of one half-step alone.
//!
//! ```text
//! (M5)  s = P(s − ρ u),   u = û + G t − (g₀, 0),      s: t_N or t_T, the other held
//!       P: projection on s ≤ 0 in (H1), on the disc of radius −μ t_N in (H2)
//! ```
//!
//! An interior-point method leaves the natural map at about the root of its tolerance. From there
//! (M5) takes a few steps; they are kept as long as its residual falls.

use std::ops::Range;

use faer::linalg::solvers::Solve;
use faer::{Col, Mat};

use crate::problem::ContactProblem;

/// Newton steps at most.
const STEPS: usize = 20;

/// c ‖slip‖ in bounds at most: friction that is no bound yet then slips, friction that drives the slip sticks.
pub(super) const BETWEEN: f64 = 1.5;

/// Solves (H1) from a reaction near its solution.
pub(super) fn normal(problem: &ContactProblem, reaction: &mut [f64]) {
    let blocks = problem
        .offsets()
        .windows(2)
        .map(|ends| ends[0]..ends[0] + 1);
    let blocks: Vec<Range<usize>> = blocks.collect();
    newton(problem, reaction, &blocks, |_, point| pressed(point));
}

/// Solves (H2) from a reaction near its solution.
pub(super) fn friction(problem: &ContactProblem, reaction: &mut [f64]) {
    let blocks = problem
        .offsets()
        .windows(2)
        .map(|ends| ends[0] + 1..ends[1]);
    let blocks: Vec<Range<usize>> = blocks.collect();
    let normals = problem.offsets().iter().zip(problem.friction());
    let bounds: Vec<f64> = normals.map(|(&n, mu)| -mu * reaction[n].min(0.0)).collect();
    newton(problem, reaction, &blocks, |contact, point| {
        disc(point, bounds[contact])
    });
}

/// The nearest point of a plane and its slope, in the first axes of a contact's normal or tangents.
pub(super) type Projected = ([f64; 2], [[f64; 2]; 2]);

/// P on `s ≤ 0`.
pub(super) fn pressed(point: [f64; 2]) -> Projected {
    if point[0] < 0.0 {
        (point, [[1.0, 0.0], [0.0, 0.0]])
    } else {
        ([0.0; 2], [[0.0; 2]; 2])
    }
}

/// P on a disc.
pub(super) fn disc(point: [f64; 2], bound: f64) -> Projected {
    let size = point[0].hypot(point[1]);
    if size <= bound {
        return (point, [[1.0, 0.0], [0.0, 1.0]]);
    }
    let direction = point.map(|p| p / size);
    let across = |i: usize, j: usize| {
        let unit = if i == j { 1.0 } else { 0.0 };
        bound / size * (unit - direction[i] * direction[j])
    };
    let slope = [[across(0, 0), across(0, 1)], [across(1, 0), across(1, 1)]];
    (direction.map(|d| bound * d), slope)
}

/// Newton on (M5) for the unknowns of the blocks; `project` gives P and its slope at a point, in a
/// plane of which a block of one unknown uses the first axis.
fn newton(
    problem: &ContactProblem,
    reaction: &mut [f64],
    blocks: &[Range<usize>],
    project: impl Fn(usize, [f64; 2]) -> Projected,
) {
    let mut trial = reaction.to_vec();
    let mut least = f64::INFINITY;
    for _ in 0..STEPS {
        let system = System::new(problem, &trial, blocks, &project);
        let residual = system.residual.norm_l2();
        if residual.is_nan() || residual >= least {
            return;
        }
        reaction.copy_from_slice(&trial);
        least = residual;
        let change = system.slope.partial_piv_lu().solve(&system.residual);
        for (&unknown, change) in system.unknowns.iter().zip(change.iter()) {
            trial[unknown] -= change;
        }
    }
}

/// `s − P(s − ρ u)` and its slope.
struct System {
    unknowns: Vec<usize>,
    residual: Col<f64>,
    slope: Mat<f64>,
}

impl System {
    fn new(
        problem: &ContactProblem,
        reaction: &[f64],
        blocks: &[Range<usize>],
        project: impl Fn(usize, [f64; 2]) -> Projected,
    ) -> Self {
        let g = problem.compliance();
        let mut displacement = problem.displacement(reaction);
        for (n, gap) in problem.offsets().iter().zip(problem.initial_gap()) {
            displacement[*n] -= gap;
        }
        let unknowns: Vec<usize> = blocks.iter().cloned().flatten().collect();
        let (mut residual, mut row) = (Col::zeros(unknowns.len()), 0);
        let mut slope = Mat::identity(unknowns.len(), unknowns.len());
        for (contact, block) in blocks.iter().enumerate() {
            let largest = block.clone().map(|u| g[(u, u)]).fold(0.0, f64::max);
            let step = if largest > 0.0 { largest.recip() } else { 0.0 };
            let mut point = [0.0; 2];
            for (p, u) in point.iter_mut().zip(block.clone()) {
                *p = reaction[u] - step * displacement[u];
            }
            let (projected, of_point) = project(contact, point);
            for (i, u) in block.clone().enumerate() {
                residual[row + i] = reaction[u] - projected[i];
                for (column, &other) in unknowns.iter().enumerate() {
                    for (k, v) in block.clone().enumerate() {
                        let own = if v == other { 1.0 } else { 0.0 };
                        slope[(row + i, column)] -= of_point[i][k] * (own - step * g[(v, other)]);
                    }
                }
            }
            row += block.len();
        }
        Self {
            unknowns,
            residual,
            slope,
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use faer::mat;

    use super::*;
    use crate::problem::Operator;

    /// Two contacts of one tangent each, G of order one, μ = 1/2.
    fn problem(free: [f64; 4]) -> ContactProblem {
        let g = mat![
            [2.0, 0.5, 1.0, 0.0],
            [0.5, 2.0, 0.0, 1.0],
            [1.0, 0.0, 2.0, 0.5],
            [0.0, 1.0, 0.5, 2.0]
        ];
        let operator = Operator::from_compliance(g).unwrap();
        ContactProblem::new(&[1, 1], vec![0.5; 2], vec![0.0; 2], free.to_vec(), operator).unwrap()
    }

    #[test]
    fn a_normal_half_step_closes_what_is_pressed_and_frees_what_is_pulled() {
        // With t_T = 0: 2 t_1 + 4 = 0 closes the first, and the second is at −2 + 1 < 0: open.
        let mut reaction = vec![-1.9, 0.0, -0.1, 0.0];
        normal(&problem([4.0, 0.0, 1.0, 0.0]), &mut reaction);
        assert!(
            (reaction[0] + 2.0).abs() < 1e-15 && reaction[2].abs() < 1e-15,
            "{reaction:?}"
        );
    }

    #[test]
    fn a_friction_half_step_holds_one_contact_and_lets_the_other_slide() {
        // t_N = −4 and −4: bounds 2. û_T + G_TN t_N = (8, −1) − (2, 2) = (6, −3): the first slides
        // with t = −2, the second sticks: −3 − 2 + 2 t = 0.
        let mut reaction = vec![-4.0, -1.8, -4.0, 1.9];
        friction(&problem([0.0, 8.0, 0.0, -1.0]), &mut reaction);
        assert!((reaction[1] + 2.0).abs() < 1e-15, "{reaction:?}");
        // It would take 5/2 of friction, which is more than the bound: it slides as well.
        assert!((reaction[3] - 2.0).abs() < 1e-15, "{reaction:?}");
        let mut reaction = vec![-4.0, -1.8, -4.0, 1.9];
        friction(&problem([0.0, 8.0, 0.0, 1.0]), &mut reaction);
        // −1 − 2 + 2 t = 0.
        assert!((reaction[3] - 1.5).abs() < 1e-15, "{reaction:?}");
    }
}
