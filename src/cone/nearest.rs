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

/// What is left of the load when no more is to be gained.
const ENOUGH: f64 = 1e-15;

/// Replaces `reaction` by the nearest admissible one in equilibrium with `load` and returns `‖Qᵀ s + e‖`.
///
/// Blocks begin at `offsets` (their end appended), normal first; `friction` per contact. If the equations
/// have no solution, the reaction is the best that was found.
pub(super) fn nearest_in_equilibrium(
    q: MatRef<'_, f64>,
    offsets: &[usize],
    friction: &[f64],
    load: &[f64],
    reaction: &mut [f64],
) -> f64 {
    let start = reaction.to_vec();
    let cones = Cones { offsets, friction };
    let at = |gamma: &[f64]| {
        let moved = product(q, gamma);
        let trial: Vec<f64> = start.iter().zip(moved).map(|(t, m)| t + m).collect();
        let nearest = cones.project(&trial);
        let answer = product(q.transpose(), &nearest);
        let left: Vec<f64> = answer.iter().zip(load).map(|(a, e)| a + e).collect();
        let work: f64 = load.iter().zip(gamma).map(|(e, g)| e * g).sum();
        let potential = 0.5 * nearest.iter().map(|t| t * t).sum::<f64>() + work;
        State {
            trial,
            nearest,
            left,
            potential,
        }
    };
    let mut gamma = vec![0.0; load.len()];
    let mut state = at(&gamma);
    let mut best = norm(state.left.iter().copied());
    reaction.copy_from_slice(&state.nearest);
    for _ in 0..STEPS {
        let size = norm(state.left.iter().copied());
        if best <= ENOUGH {
            break;
        }
        let Some(step) = cones.newton_step(q, &state, size) else {
            break;
        };
        let slope: f64 = step.iter().zip(&state.left).map(|(s, l)| s * l).sum();
        let mut length = 1.0;
        let next = loop {
            let trial: Vec<f64> = gamma
                .iter()
                .zip(&step)
                .map(|(g, s)| g + length * s)
                .collect();
            let next = at(&trial);
            let falls = next.potential <= state.potential + 1e-4 * length * slope
                || norm(next.left.iter().copied()) < 0.9 * size;
            if falls || length < 1e-6 {
                gamma = trial;
                break next;
            }
            length *= 0.5;
        };
        state = next;
        let size = norm(state.left.iter().copied());
        if size < best {
            best = size;
            reaction.copy_from_slice(&state.nearest);
        }
    }
    best
}

struct State {
    trial: Vec<f64>,
    nearest: Vec<f64>,
    left: Vec<f64>,
    potential: f64,
}

/// Coulomb's cones, block by block.
struct Cones<'a> {
    offsets: &'a [usize],
    friction: &'a [f64],
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

impl Cones<'_> {
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

    /// `−(Qᵀ Π' Q + ε)⁻¹ (Qᵀ s + e)`.
    fn newton_step(&self, q: MatRef<'_, f64>, state: &State, size: f64) -> Option<Vec<f64>> {
        let rank = q.ncols();
        let mut turned = Mat::<f64>::zeros(q.nrows(), rank);
        for (block, mu) in self.blocks() {
            let (start, count) = (block.start, block.len());
            let slope = derivative(&state.trial[block], mu);
            for j in 0..rank {
                for (row, slopes) in slope[..count].iter().enumerate() {
                    turned[(start + row, j)] =
                        (0..count).map(|k| slopes[k] * q[(start + k, j)]).sum();
                }
            }
        }
        let mut form = q.transpose() * turned;
        let largest = (0..rank).map(|j| form[(j, j)]).fold(0.0, f64::max);
        for j in 0..rank {
            form[(j, j)] += 1e-14 * largest + size.min(1e-3) * 1e-3;
        }
        let factor = form.llt(Side::Lower).ok()?;
        let step = factor.solve(&Col::from_fn(rank, |j| -state.left[j]));
        let step: Vec<f64> = step.iter().copied().collect();
        step.iter().all(|s| s.is_finite()).then_some(step)
    }
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
        let cones = Cones {
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
            let cones = Cones {
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
        let mut reaction = [-1.001, -0.5, -0.999, -0.3];
        let left = nearest_in_equilibrium(
            q.as_ref(),
            &[0, 2, 4],
            &[0.5; 2],
            &[0.9, -2.0],
            &mut reaction,
        );
        assert!(left < 1e-15, "{left:e}");
        assert!((reaction[1] + reaction[3] + 0.9).abs() < 1e-15);
        assert!((reaction[0] + reaction[2] + 2.0).abs() < 1e-15);
        assert!(reaction[1].abs() <= -0.5 * reaction[0] * (1.0 + 1e-15));
    }

    #[test]
    fn where_nothing_holds_the_load_the_rest_of_it_is_returned() {
        // Pulled up by 1 with nothing that pulls down.
        let q = mat![[-1.0], [-1.0]];
        let mut reaction = [-0.1, 0.0];
        let left = nearest_in_equilibrium(q.as_ref(), &[0, 1, 2], &[0.5; 2], &[1.0], &mut reaction);
        assert!((left - 1.0).abs() < 1e-9, "{left}");
    }
}
