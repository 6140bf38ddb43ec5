//! What the alternation does to a small disturbance of a solved state, and from which friction on it grows.
//!
//! ```text
//! (T1)  δt_N → friction half-step → δt_T → normal half-step → δt_N'     on the sets of the state
//!
//!       slip   δt_T = −μ d δt_N + τ e,  e·δu_T + (‖u_T‖ / −μ t_N) τ = 0      d = t_T/‖t_T‖,  e ⊥ d (3D)
//!       stick  δu_T = 0
//!       normal δu_N = 0 where pressed
//! ```
//!
//! The factor is how much longer `δt_N` gets per sweep after many, its spectral radius. It grows with
//! μ, about linearly, through the slipping contacts alone; the friction at which it reaches one is
//! that of the same sets, which other friction would change: an estimate.

use faer::linalg::solvers::{Llt, Solve};
use faer::{Col, Mat, Side};

use crate::alternation::{Outcome, times};
use crate::kkt::ContactStatus;
use crate::problem::ContactProblem;

/// Sweeps of the disturbance before its growth counts, and those over which it is averaged.
const SWEEPS: (usize, usize) = (20, 30);

/// The largest multiple of the friction at which the factor is asked for, and halvings of the
/// interval (in the logarithm) in which it passes one.
const MULTIPLE: f64 = 1024.0;
const HALVINGS: usize = 12;

/// How fast the plain alternation converges near a state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contraction {
    /// Factor per sweep on a small disturbance; below one it shrinks.
    pub factor: f64,
    /// Multiple of the friction coefficients at which the factor would be one; none if it stays on
    /// its side of one from nearly no friction up to a thousand times as much.
    pub critical: Option<f64>,
}

/// Estimates (T1) at a solved state; none where nothing is pressed and rough, or where G does not tell the
/// contacts apart, or between bodies that float, which have no alternation, or under other laws than Coulomb's.
#[must_use]
pub fn contraction(problem: &ContactProblem, outcome: &Outcome) -> Option<Contraction> {
    if problem.floating().is_some() || problem.laws().is_some() {
        return None;
    }
    let map = Disturbance::new(problem, outcome)?;
    let factor = map.factor(1.0);
    let above = factor >= 1.0;
    let beyond = |multiple: f64| (map.factor(multiple) >= 1.0) != above;
    let side = if above { 1.0 / MULTIPLE } else { MULTIPLE };
    let critical = (!map.slipping.is_empty() && beyond(side)).then(|| {
        let (mut near, mut far) = (0.0, f64::ln(side));
        for _ in 0..HALVINGS {
            let middle = 0.5 * (near + far);
            if beyond(middle.exp()) {
                far = middle;
            } else {
                near = middle;
            }
        }
        f64::exp(0.5 * (near + far))
    });
    Some(Contraction { factor, critical })
}

/// A direction of friction that the friction half-step finds by itself.
struct Direction {
    /// First tangential unknown.
    unknown: usize,
    along: Vec<f64>,
    /// Own compliance beside that of G, in m/N.
    extra: f64,
}

/// The maps of (T1).
struct Disturbance<'a> {
    problem: &'a ContactProblem,
    /// Normal unknowns of pressed contacts.
    pressed: Vec<usize>,
    /// Place in `pressed`, first tangential unknown and `μ d` of slipping contacts.
    slipping: Vec<(usize, usize, Vec<f64>)>,
    directions: Vec<Direction>,
    normal: Llt<f64>,
    tangential: Option<Llt<f64>>,
}

impl<'a> Disturbance<'a> {
    fn new(problem: &'a ContactProblem, outcome: &Outcome) -> Option<Self> {
        let (mut pressed, mut slipping, mut directions) = (Vec::new(), Vec::new(), Vec::new());
        for (contact, status) in outcome.verdict.status.iter().enumerate() {
            let (n, end) = (problem.offsets()[contact], problem.offsets()[contact + 1]);
            if *status == ContactStatus::Open {
                continue;
            }
            pressed.push(n);
            let mu = problem.friction()[contact];
            if mu == 0.0 || end == n + 1 {
                continue;
            }
            let unknown = n + 1;
            if *status == ContactStatus::Stick {
                directions.extend((0..end - unknown).map(|axis| Direction {
                    unknown,
                    along: unit(end - unknown, axis),
                    extra: 0.0,
                }));
                continue;
            }
            let friction = &outcome.reaction[unknown..end];
            let size = length(friction);
            if size == 0.0 {
                continue;
            }
            let d: Vec<f64> = friction.iter().map(|t| t / size).collect();
            if let [x, y] = d[..] {
                directions.push(Direction {
                    unknown,
                    along: vec![-y, x],
                    extra: length(&outcome.verdict.displacement[unknown..end]) / size,
                });
            }
            let driven = d.iter().map(|d| mu * d).collect();
            slipping.push((pressed.len() - 1, unknown, driven));
        }
        if directions.is_empty() && slipping.is_empty() {
            return None;
        }
        let g = problem.compliance();
        let of_normals = |i: usize, j: usize| g[(pressed[i], pressed[j])];
        let normal = Mat::from_fn(pressed.len(), pressed.len(), of_normals);
        let of_directions = |i: usize, j: usize| {
            let (a, b): (&Direction, &Direction) = (&directions[i], &directions[j]);
            let mut sum = if i == j { a.extra } else { 0.0 };
            for (k, x) in a.along.iter().enumerate() {
                for (l, y) in b.along.iter().enumerate() {
                    sum += x * g[(a.unknown + k, b.unknown + l)] * y;
                }
            }
            sum
        };
        let tangential = Mat::from_fn(directions.len(), directions.len(), of_directions);
        Some(Self {
            problem,
            normal: normal.llt(Side::Lower).ok()?,
            tangential: match directions.len() {
                0 => None,
                _ => Some(tangential.llt(Side::Lower).ok()?),
            },
            pressed,
            slipping,
            directions,
        })
    }

    /// Spectral radius, with the friction of slipping contacts multiplied.
    fn factor(&self, multiple: f64) -> f64 {
        let mut disturbance = Col::from_fn(self.pressed.len(), |k| 1.0 + (2.4 * k as f64).sin());
        let (before, counted) = SWEEPS;
        let mut growth = 0.0;
        for sweep in 0..before + counted {
            let next = self.sweep(&disturbance, multiple);
            let ratio = next.norm_l2() / disturbance.norm_l2();
            if ratio == 0.0 || !ratio.is_finite() {
                return 0.0;
            }
            if sweep >= before {
                growth += ratio.ln();
            }
            disturbance = next * faer::Scale((ratio * disturbance.norm_l2()).recip());
        }
        f64::exp(growth / counted as f64)
    }

    fn sweep(&self, normal: &Col<f64>, multiple: f64) -> Col<f64> {
        let mut reaction = Col::zeros(self.problem.unknowns());
        for (k, &n) in self.pressed.iter().enumerate() {
            reaction[n] = normal[k];
        }
        let mut friction = Col::zeros(self.problem.unknowns());
        for (k, unknown, driven) in &self.slipping {
            for (axis, d) in driven.iter().enumerate() {
                friction[unknown + axis] = -multiple * d * normal[*k];
                reaction[unknown + axis] = friction[unknown + axis];
            }
        }
        let g = self.problem.compliance();
        if let Some(tangential) = &self.tangential {
            let moved = times(g, &reaction);
            let found = tangential.solve(Col::from_fn(self.directions.len(), |k| {
                let direction = &self.directions[k];
                let along = direction.along.iter().enumerate();
                -along
                    .map(|(axis, e)| e * moved[direction.unknown + axis])
                    .sum::<f64>()
            }));
            for (direction, amount) in self.directions.iter().zip(found.iter()) {
                for (axis, e) in direction.along.iter().enumerate() {
                    friction[direction.unknown + axis] += e * amount;
                }
            }
        }
        let moved = times(g, &friction);
        let right = Col::from_fn(self.pressed.len(), |k| -moved[self.pressed[k]]);
        self.normal.solve(&right)
    }
}

fn unit(size: usize, axis: usize) -> Vec<f64> {
    (0..size)
        .map(|k| if k == axis { 1.0 } else { 0.0 })
        .collect()
}

fn length(vector: &[f64]) -> f64 {
    vector.iter().fold(0.0_f64, |length, x| length.hypot(*x))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use faer::mat;

    use super::*;
    use crate::alternation::{Settings, solve};
    use crate::problem::Operator;

    #[test]
    fn a_contact_that_sticks_gives_back_the_square_of_its_coupling() {
        // Stuck: δt_T = −(G_TN/G_TT) δt_N, δt_N' = −(G_NT/G_NN) δt_T: (½/1) (½/2) of G = [[1, ½], [½, 2]].
        let operator = Operator::from_compliance(mat![[1.0, 0.5], [0.5, 2.0]]).unwrap();
        let free = vec![1.0, 0.5];
        let problem = ContactProblem::new(&[1], vec![0.5], vec![0.0], free, operator).unwrap();
        let outcome = solve(&problem, &Settings::default()).unwrap();
        let found = contraction(&problem, &outcome).unwrap();
        assert!((found.factor - 0.125).abs() < 1e-12, "{found:?}");
        // What sticks does not see how much friction there is.
        assert_eq!(found.critical, None);
    }

    #[test]
    fn a_contact_that_slips_gives_back_its_friction_times_its_coupling() {
        // Slipping: δt_T = μ δt_N, δt_N' = −(G_NT/G_NN) δt_T: 0.2 · ½ of G = [[1, ½], [½, 2]]; t_N = −1/1.1.
        let operator = Operator::from_compliance(mat![[1.0, 0.5], [0.5, 2.0]]).unwrap();
        let free = vec![1.0, 3.0];
        let problem = ContactProblem::new(&[1], vec![0.2], vec![0.0], free, operator).unwrap();
        let outcome = solve(&problem, &Settings::default()).unwrap();
        assert!((outcome.reaction[0] + 1.0 / 1.1).abs() < 1e-12);
        let found = contraction(&problem, &outcome).unwrap();
        assert!((found.factor - 0.1).abs() < 1e-12, "{found:?}");
        // Ten times the friction, halved to ln 1024 / 2¹³ of it.
        assert!(
            (found.critical.unwrap() / 10.0 - 1.0).abs() < 1e-3,
            "{found:?}"
        );
    }
}
