//! Panagiotopoulos' alternation on displacements: Signorini's problem under given friction, then Tresca's under given
//! pressure.
//!
//! ```text
//! (M10)  min ½ (v − a)·S (v − a)                    s.t.  v ≤ g₀      v: normals,    S = G_NN⁻¹,  a = û_N + G_NT t_T
//! (M11)  min ½ (v − a)·S (v − a) + Σ −μ t_N,i ‖v_i‖                   v: tangents,   S = G_TT⁻¹,  a = û_T + G_TN t_N
//!        t = S (v − a)
//! ```
//!
//! What is not of the half-step is free in it, and is eliminated: S is the stiffness of the contact surface whose other
//! displacements follow. (M10) and (M11) are the dual programs of (H1) and (H2), so that its iterates are those of the plain sweeps,
//! and so is its rate. Each is solved by semi-smooth Newton steps from the displacement before, `t = P(t − c v)`: an active set
//! on displacements. Panagiotopoulos, Ing.-Arch. 44 (1975) 421–432; Hintermüller, Ito, Kunisch, SIAM J. Optim. 13 (2002)
//! 865–888.

use std::ops::Range;

use faer::linalg::solvers::{DenseSolveCore, Solve};
use faer::{Col, Mat, Side};

use super::exact::{BETWEEN, Projected, disc, pressed};
use crate::problem::ContactProblem;

/// Newton steps of a half-step at most.
const STEPS: usize = 50;

/// A residual below this part of the reactions is solved; one that is above is given up where it does not fall.
const SOLVED: f64 = 1e-14;
const NEARLY: f64 = 1e-9;

/// Both half-steps of a problem.
pub(super) struct Primal {
    normal: Program,
    friction: Program,
}

impl Primal {
    /// None where G is singular: rigid bodies have no such stiffness.
    pub(super) fn new(problem: &ContactProblem) -> Option<Self> {
        let normals = problem.blocks().map(|block| block.start..block.start + 1);
        let tangents = problem.blocks().map(|block| block.start + 1..block.end);
        Some(Self {
            normal: Program::new(problem, normals.collect())?,
            friction: Program::new(problem, tangents.collect())?,
        })
    }

    /// One alternation from a reaction; says how many Newton steps it took, or nothing where they lead nowhere.
    pub(super) fn alternate(
        &mut self,
        problem: &ContactProblem,
        reaction: &mut [f64],
    ) -> Option<usize> {
        let none = vec![0.0; problem.contacts()];
        let given = (problem.initial_gap(), &none[..]);
        let pressing = |_: usize, point: [f64; 2]| pressed(point);
        let normal = self.normal.minimise(problem, reaction, given, pressing)?;
        let normals = problem.normals().iter().zip(problem.friction());
        let bounds = normals.map(|(&n, mu)| -mu * reaction[n].min(0.0));
        let bounds: Vec<f64> = bounds.collect();
        let given = (&none[..], &bounds[..]);
        let rubbing = |contact: usize, point: [f64; 2]| disc(point, bounds[contact]);
        let friction = self.friction.minimise(problem, reaction, given, rubbing)?;
        Some(normal + friction)
    }
}

/// (M10) or (M11).
struct Program {
    blocks: Vec<Range<usize>>,
    unknowns: Vec<usize>,
    /// S, in N/m.
    stiffness: Mat<f64>,
    /// c, in N/m per contact.
    scale: Vec<f64>,
    /// v − g₀ of the last half-step, in metre.
    moved: Option<Col<f64>>,
}

impl Program {
    fn new(problem: &ContactProblem, blocks: Vec<Range<usize>>) -> Option<Self> {
        let unknowns: Vec<usize> = blocks.iter().cloned().flatten().collect();
        let (g, size) = (problem.compliance(), unknowns.len());
        let own = Mat::from_fn(size, size, |i, j| g[(unknowns[i], unknowns[j])]);
        let stiffness = own.llt(Side::Lower).ok()?.inverse();
        let mut first = 0;
        let scale = blocks.iter().map(|block| {
            let own = first..first + block.len();
            first = own.end;
            own.map(|i| stiffness[(i, i)]).fold(0.0, f64::max)
        });
        let scale = scale.collect();
        Some(Self {
            blocks,
            unknowns,
            stiffness,
            scale,
            moved: None,
        })
    }

    /// Replaces its part of the reaction; says how many Newton steps that took, or nothing where they lead nowhere.
    fn minimise(
        &mut self,
        problem: &ContactProblem,
        reaction: &mut [f64],
        (gap, bounds): (&[f64], &[f64]),
        project: impl Fn(usize, [f64; 2]) -> Projected,
    ) -> Option<usize> {
        for &unknown in &self.unknowns {
            reaction[unknown] = 0.0;
        }
        let moved = problem.displacement(reaction);
        let size = self.unknowns.len();
        let mut away = Col::zeros(size);
        let mut row = 0;
        for (block, gap) in self.blocks.iter().zip(gap) {
            for unknown in block.clone() {
                away[row] = moved[unknown] - gap;
                row += 1;
            }
        }
        let mut v = self.moved.take().unwrap_or_else(|| away.clone());
        let mut best = (f64::INFINITY, v.clone(), Col::zeros(size));
        let mut steps = 0;
        loop {
            let force = &self.stiffness * (&v - &away);
            let (residual, projected, slope) = self.linearised(&v, &force, bounds, &project);
            let (left, scale) = (residual.norm_max(), projected.norm_max());
            let fell = left < best.0;
            if fell {
                best = (left, v.clone(), projected);
            }
            if left <= SOLVED * scale || steps == STEPS || !fell && best.0 <= NEARLY * scale {
                let solved = best.0 <= NEARLY * scale || scale == 0.0;
                for (&unknown, t) in self.unknowns.iter().zip(best.2.iter()) {
                    reaction[unknown] = *t;
                }
                self.moved = Some(best.1);
                return solved.then_some(steps);
            }
            v -= slope.partial_piv_lu().solve(&residual);
            steps += 1;
        }
    }

    /// `t − P(t − c v)`, P and the slope over v.
    fn linearised(
        &self,
        v: &Col<f64>,
        force: &Col<f64>,
        bounds: &[f64],
        project: &impl Fn(usize, [f64; 2]) -> Projected,
    ) -> (Col<f64>, Col<f64>, Mat<f64>) {
        let size = v.nrows();
        let (mut residual, mut nearest) = (Col::zeros(size), Col::zeros(size));
        let mut slope = self.stiffness.clone();
        let mut first = 0;
        for (contact, (block, c)) in self.blocks.iter().zip(&self.scale).enumerate() {
            let rows = first..first + block.len();
            let moved = rows.clone().fold(0.0, |s: f64, i| s.hypot(v[i]));
            let most = match bounds[contact] > 0.0 && moved > 0.0 {
                true => BETWEEN * bounds[contact] / moved,
                false => f64::INFINITY,
            };
            let c = &c.min(most);
            let mut point = [0.0; 2];
            for (p, i) in point.iter_mut().zip(rows.clone()) {
                *p = force[i] - c * v[i];
            }
            let (projected, of_point) = project(contact, point);
            for (i, row) in rows.clone().enumerate() {
                nearest[row] = projected[i];
                residual[row] = force[row] - projected[i];
            }
            for column in 0..size {
                let s = [0, 1].map(|k| {
                    if k < block.len() {
                        self.stiffness[(first + k, column)]
                    } else {
                        0.0
                    }
                });
                for (i, row) in rows.clone().enumerate() {
                    for (k, other) in rows.clone().enumerate() {
                        let own = if other == column { *c } else { 0.0 };
                        slope[(row, column)] -= of_point[i][k] * (s[k] - own);
                    }
                }
            }
            first = rows.end;
        }
        (residual, nearest, slope)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use faer::mat;

    use super::super::Variant;
    use crate::alternation::{Settings, Status};
    use crate::problem::{ContactProblem, Operator};

    #[test]
    fn its_iterates_are_those_of_the_plain_sweeps() {
        // Three contacts that couple normal and tangential, one open, one slipping.
        let g = mat![
            [2.0, 0.4, 0.6, 0.1, 0.2, 0.0],
            [0.4, 2.0, -0.1, 0.5, 0.0, 0.2],
            [0.6, -0.1, 2.0, 0.4, 0.6, 0.1],
            [0.1, 0.5, 0.4, 2.0, -0.1, 0.5],
            [0.2, 0.0, 0.6, -0.1, 2.0, 0.4],
            [0.0, 0.2, 0.1, 0.5, 0.4, 2.0]
        ];
        let operator = Operator::from_compliance(g).unwrap();
        let free = vec![3.0, 2.0, 2.0, 0.2, -1.0, 1.0];
        let problem =
            ContactProblem::new(&[1; 3], vec![0.5; 3], vec![0.0; 3], free, operator).unwrap();
        for max_sweeps in 1..4 {
            let settings = Settings {
                max_sweeps,
                ..Settings::default()
            };
            let [primal, dual] = [Variant::Panagiotopoulos, Variant::PLAIN]
                .map(|variant| variant.solve(&problem, &settings).unwrap().reaction);
            for (a, b) in primal.iter().zip(&dual) {
                assert!((a - b).abs() < 1e-12, "{primal:?} {dual:?}");
            }
        }
        let found = Variant::Panagiotopoulos
            .solve(&problem, &Settings::default())
            .unwrap();
        assert_eq!(found.status, Status::Certified);
        assert!(found.reaction[4] == 0.0 && found.reaction[0] < 0.0);
    }
}
