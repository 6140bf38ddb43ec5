//! The admissible reactions in equilibrium that are nearest to given ones.
//!
//! ```text
//! min ½ ‖s − t‖²   s.t.  s ∈ K,  Qᵀ s + e = 0         s = Π(t + Q γ),   Qᵀ Π(t + Q γ) + e = 0
//! ```
//!
//! Π projects every block onto its Coulomb cone, so `s` is admissible to the last digit. The equations in γ are
//! the gradient of the convex function `½ ‖Π(t + Q γ)‖² + e·γ`; semismooth Newton with a line
//! search on it (Qi, Sun, SIAM Rev. 49 (2007)) gives the digits that an interior point leaves open.

use faer::linalg::solvers::Solve;
use faer::{Col, Mat, MatRef, Side};

use super::velocity_basis::{norm, product};

/// Newton steps; the start is good, so few are needed.
const STEPS: usize = 40;

/// What is left of the equations when no more is to be gained.
const ENOUGH: f64 = 1e-15;

/// Shortest part of a Newton step that is tried.
const SHORTEST: f64 = 1e-6;

/// Regularisation of the Newton matrix relative to its diagonal, and to the defect.
const PIVOT: f64 = 1e-14;
const DAMPING: f64 = 1e-3;

/// Coulomb's cones, block by block, and the velocities Q.
#[derive(Clone, Copy)]
pub(super) struct Projection<'a> {
    pub(super) q: MatRef<'a, f64>,
    /// First unknown of every block, and their end.
    pub(super) offsets: &'a [usize],
    /// Per block.
    pub(super) friction: &'a [f64],
}

/// The nearest reactions, and what led to them.
#[derive(Clone, Debug)]
pub(super) struct Nearest {
    pub(super) reaction: Vec<f64>,
    pub(super) gamma: Vec<f64>,
    /// `‖Qᵀ s + e‖`.
    pub(super) remainder: f64,
    /// Largest departure from the equations.
    defect: f64,
}

struct State {
    trial: Vec<f64>,
    nearest: Nearest,
    /// Gradient in γ.
    left: Vec<f64>,
    potential: f64,
}

impl Projection<'_> {
    /// The admissible reactions nearest to `target` in equilibrium with `load`, sought from γ on.
    ///
    /// With a softness ε > 0 the equations are `Qᵀ s + e + ε γ = 0`: they then have a solution for every load, and
    /// what is left of it pulls along `−γ`. Without a solution the best that was found is returned.
    pub(super) fn nearest(
        &self,
        target: &[f64],
        load: &[f64],
        softness: f64,
        gamma: Vec<f64>,
    ) -> Nearest {
        let at = |gamma: Vec<f64>| self.state(target, load, softness, gamma);
        let mut state = at(gamma);
        let mut best = state.nearest.clone();
        for _ in 0..STEPS {
            if best.defect <= ENOUGH {
                break;
            }
            let Some(step) = self.newton_step(&state, softness) else {
                break;
            };
            let slope: f64 = step.iter().zip(&state.left).map(|(s, l)| s * l).sum();
            let mut length = 1.0;
            state = loop {
                let gamma = state.nearest.gamma.iter().zip(&step);
                let next = at(gamma.map(|(g, s)| g + length * s).collect());
                let falls = next.potential <= state.potential + 1e-4 * length * slope
                    || next.nearest.defect < 0.9 * state.nearest.defect;
                if falls || length < SHORTEST {
                    break next;
                }
                length *= 0.5;
            };
            if state.nearest.defect < best.defect {
                best = state.nearest.clone();
            }
        }
        best
    }

    fn state(&self, target: &[f64], load: &[f64], softness: f64, gamma: Vec<f64>) -> State {
        let mut trial = product(self.q, &gamma);
        trial.iter_mut().zip(target).for_each(|(m, t)| *m += t);
        let reaction = self.project(&trial);
        let mut left = product(self.q.transpose(), &reaction);
        left.iter_mut().zip(load).for_each(|(l, e)| *l += e);
        let remainder = norm(left.iter().copied());
        left.iter_mut()
            .zip(&gamma)
            .for_each(|(l, g)| *l += softness * g);
        let square = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>();
        let work: f64 = load.iter().zip(&gamma).map(|(e, g)| e * g).sum();
        let potential = 0.5 * square(&reaction) + 0.5 * softness * square(&gamma) + work;
        let defect = norm(left.iter().copied());
        let nearest = Nearest {
            reaction,
            gamma,
            remainder,
            defect,
        };
        State {
            trial,
            nearest,
            left,
            potential,
        }
    }

    fn blocks(&self) -> impl Iterator<Item = (std::ops::Range<usize>, f64)> + '_ {
        let blocks = self.offsets.windows(2).zip(self.friction);
        blocks.map(|(block, mu)| (block[0]..block[1], *mu))
    }

    fn project(&self, trial: &[f64]) -> Vec<f64> {
        let mut nearest = trial.to_vec();
        for (block, mu) in self.blocks() {
            let place = place(&trial[block.clone()], mu);
            let t = &mut nearest[block];
            match place {
                Place::Inside => {}
                Place::Apex => t.fill(0.0),
                Place::Edge {
                    pressure,
                    tangential,
                } => {
                    t[0] = -pressure;
                    let shrink = if tangential > 0.0 {
                        mu * pressure / tangential
                    } else {
                        0.0
                    };
                    t[1..].iter_mut().for_each(|t| *t *= shrink);
                }
            }
        }
        nearest
    }

    /// `−(Qᵀ Π' Q + ε)⁻¹` times the gradient.
    fn newton_step(&self, state: &State, softness: f64) -> Option<Vec<f64>> {
        let rank = self.q.ncols();
        let mut turned = Mat::<f64>::zeros(self.q.nrows(), rank);
        for (block, mu) in self.blocks() {
            let (start, count) = (block.start, block.len());
            let slope = derivative(&state.trial[block], mu);
            for j in 0..rank {
                for (row, slopes) in slope[..count].iter().enumerate() {
                    let terms = (0..count).map(|k| slopes[k] * self.q[(start + k, j)]);
                    turned[(start + row, j)] = terms.sum();
                }
            }
        }
        let mut form = self.q.transpose() * turned;
        let largest = (0..rank).map(|j| form[(j, j)]).fold(0.0, f64::max);
        let shift = softness + PIVOT * largest + DAMPING * state.nearest.defect.min(DAMPING);
        for j in 0..rank {
            form[(j, j)] += shift;
        }
        let factor = form.llt(Side::Lower).ok()?;
        let step = factor.solve(&Col::from_fn(rank, |j| -state.left[j]));
        let step: Vec<f64> = step.iter().copied().collect();
        step.iter().all(|s| s.is_finite()).then_some(step)
    }
}

/// Where a block lies.
enum Place {
    Inside,
    /// The nearest point is the apex.
    Apex,
    /// The nearest point has this normal pressure `p` and lies on the edge.
    Edge {
        pressure: f64,
        tangential: f64,
    },
}

fn place(t: &[f64], mu: f64) -> Place {
    let (pressed, tangential) = (-t[0], norm(t[1..].iter().copied()));
    if tangential <= mu * pressed {
        Place::Inside
    } else if pressed + mu * tangential <= 0.0 {
        Place::Apex
    } else {
        let pressure = (pressed + mu * tangential) / (1.0 + mu * mu);
        Place::Edge {
            pressure,
            tangential,
        }
    }
}

/// Derivative of the projection of one block of up to three entries (symmetric).
///
/// On the edge, with `w = t_T/‖t_T‖` and `a = (−1, μ w)/√(1+μ²)` along the nearest edge ray:
/// `a aᵀ + (μ p/‖t_T‖) (0, I − w wᵀ)`.
fn derivative(t: &[f64], mu: f64) -> [[f64; 3]; 3] {
    let mut slope = [[0.0; 3]; 3];
    match place(t, mu) {
        Place::Apex => {}
        Place::Inside => (0..t.len()).for_each(|k| slope[k][k] = 1.0),
        Place::Edge {
            pressure,
            tangential,
        } => {
            let mut ray = [-1.0, 0.0, 0.0];
            let mut across = 0.0;
            if tangential > 0.0 {
                for (ray, t) in ray[1..].iter_mut().zip(&t[1..]) {
                    *ray = mu * t / tangential;
                }
                across = mu * pressure / tangential;
            }
            for (row, slopes) in slope.iter_mut().enumerate().take(t.len()) {
                for (column, entry) in slopes.iter_mut().enumerate().take(t.len()) {
                    *entry = ray[row] * ray[column] / (1.0 + mu * mu);
                    if row > 0 && column > 0 && tangential > 0.0 {
                        let projector = f64::from(u8::from(row == column))
                            - t[row] * t[column] / (tangential * tangential);
                        *entry += across * projector;
                    }
                }
            }
        }
    }
    slope
}

#[cfg(test)]
mod tests {
    use super::*;
    use faer::mat;

    #[test]
    fn a_reaction_outside_its_cone_goes_to_the_nearest_edge_or_the_apex() {
        let q = Mat::zeros(8, 0);
        let cones = Projection {
            q: q.as_ref(),
            offsets: &[0, 3, 5, 6, 8],
            friction: &[0.5, 1.0, 0.3, 0.0],
        };
        let found = cones.project(&[-10.0, 3.0, 4.0, 0.0, 2.0, 5.0, -3.0, 7.0]);
        // On the edge already; half way between pressure and friction; no tension; a smooth contact.
        assert_eq!(found, [-10.0, 3.0, 4.0, -1.0, 1.0, 0.0, -3.0, 0.0]);
    }

    #[test]
    fn the_derivative_is_the_difference_quotient() {
        for (t, mu) in [
            ([-1.0, 2.0, -1.5], 0.7),
            ([0.5, 2.0, 1.0], 0.9),
            ([-4.0, 1.0, 0.2], 0.5),
        ] {
            let q = Mat::zeros(3, 0);
            let cones = Projection {
                q: q.as_ref(),
                offsets: &[0, 3],
                friction: &[mu],
            };
            let slope = derivative(&t, mu);
            for k in 0..3 {
                let shifted = |h: f64| {
                    let mut t = t;
                    t[k] += h;
                    cones.project(&t)
                };
                let (up, down) = (shifted(1e-6), shifted(-1e-6));
                for row in 0..3 {
                    let quotient = (up[row] - down[row]) / 2e-6;
                    assert!((slope[row][k] - quotient).abs() < 1e-8, "{t:?} {row} {k}");
                }
            }
        }
    }

    #[test]
    fn equilibrium_is_reached_to_the_last_digit_and_the_cones_are_kept() {
        // Two contacts side by side, μ = 0.5, under (x, down) = (0.9, 2): a start that is off by 1e-3.
        let q = mat![[0.0, -1.0], [1.0, 0.0], [0.0, -1.0], [1.0, 0.0]];
        let cones = Projection {
            q: q.as_ref(),
            offsets: &[0, 2, 4],
            friction: &[0.5; 2],
        };
        let found = cones.nearest(
            &[-1.001, -0.5, -0.999, -0.3],
            &[0.9, -2.0],
            0.0,
            vec![0.0; 2],
        );
        let t = &found.reaction;
        assert!(found.remainder < 1e-15, "{found:?}");
        assert!((t[1] + t[3] + 0.9).abs() < 1e-15 && (t[0] + t[2] + 2.0).abs() < 1e-15);
        assert!(t[1].abs() <= -0.5 * t[0] * (1.0 + 1e-15));
    }

    #[test]
    fn where_nothing_holds_the_load_the_rest_of_it_pulls_along_the_failing_motion() {
        // Pulled up by 1 with nothing that pulls down: 1 is left, along the mode that opens.
        let q = mat![[-1.0], [-1.0]];
        let cones = Projection {
            q: q.as_ref(),
            offsets: &[0, 1, 2],
            friction: &[0.5; 2],
        };
        let found = cones.nearest(&[-0.1, 0.0], &[1.0], 0.5, vec![0.0]);
        assert!((found.remainder - 1.0).abs() < 1e-15 && (found.gamma[0] + 2.0).abs() < 1e-14);
    }
}
