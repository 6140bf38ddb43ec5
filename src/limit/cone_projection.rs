//! The nearest admissible reactions, contact by contact, and how they change with what they are near to.
//!
//! ```text
//! Π(t) = nearest point of K       K = { t_N ≤ 0, ‖t_T‖ ≤ −μ t_N } per contact
//! ```

use std::ops::Range;

use faer::{Mat, MatRef};

use crate::problem::velocity_basis::norm;

/// Coulomb's cones, block by block.
#[derive(Clone, Copy)]
pub(super) struct CoulombCones<'a> {
    /// First unknown of every block, and their end.
    pub(super) offsets: &'a [usize],
    /// Per block.
    pub(super) friction: &'a [f64],
}

impl CoulombCones<'_> {
    fn blocks(&self) -> impl Iterator<Item = (Range<usize>, f64)> + '_ {
        let blocks = self.offsets.windows(2).zip(self.friction);
        blocks.map(|(block, mu)| (block[0]..block[1], *mu))
    }

    /// `Π(t)`.
    pub(super) fn project(&self, mut t: Vec<f64>) -> Vec<f64> {
        for (block, mu) in self.blocks() {
            let t = &mut t[block];
            match Place::of(t, mu) {
                Place::Inside => {}
                Place::Apex => t.fill(0.0),
                Place::Edge {
                    pressed,
                    tangential,
                } => {
                    t[0] = -pressed;
                    t[1..]
                        .iter_mut()
                        .for_each(|t| *t *= mu * pressed / tangential);
                }
            }
        }
        t
    }

    /// `Π'(t) Q`.
    pub(super) fn derivative(&self, t: &[f64], q: MatRef<'_, f64>) -> Mat<f64> {
        let mut turned = Mat::zeros(q.nrows(), q.ncols());
        for (block, mu) in self.blocks() {
            let slope = block_derivative(&t[block.clone()], mu);
            for j in 0..q.ncols() {
                for (row, slopes) in block.clone().zip(&slope) {
                    let terms = block
                        .clone()
                        .zip(slopes)
                        .map(|(k, slope)| slope * q[(k, j)]);
                    turned[(row, j)] = terms.sum();
                }
            }
        }
        turned
    }

    /// Largest `v_N + μ ‖v_T‖` of velocities `v`, or zero: what keeps a motion from being free of resistance.
    pub(super) fn resistance(&self, velocity: &[f64]) -> f64 {
        let each = self.blocks().map(|(block, mu)| {
            velocity[block.start] + mu * slip(&velocity[block.start + 1..block.end])
        });
        each.fold(0.0, f64::max)
    }
}

/// `‖v_T‖` of a tangential block.
pub(super) fn slip(tangential: &[f64]) -> f64 {
    norm(tangential.iter().copied())
}

/// Where a block lies.
enum Place {
    Inside,
    /// The nearest point is the apex.
    Apex,
    /// The nearest point lies on the edge and is pressed this much.
    Edge {
        pressed: f64,
        tangential: f64,
    },
}

impl Place {
    fn of(t: &[f64], mu: f64) -> Self {
        let (pressed, tangential) = (-t[0], slip(&t[1..]));
        // Without friction `0 ≤ μ p` also holds in tension.
        if pressed >= 0.0 && tangential <= mu * pressed {
            Self::Inside
        } else if pressed + mu * tangential <= 0.0 {
            Self::Apex
        } else {
            Self::Edge {
                pressed: (pressed + mu * tangential) / (1.0 + mu * mu),
                tangential,
            }
        }
    }
}

/// Derivative of the projection of one block of up to three entries (symmetric).
///
/// On the edge, with `w = t_T/‖t_T‖`, pressed by p, and `a = (−1, μ w)/√(1+μ²)` along the nearest edge ray:
/// `a aᵀ + (μ p/‖t_T‖) (0, I − w wᵀ)`.
fn block_derivative(t: &[f64], mu: f64) -> [[f64; 3]; 3] {
    let mut slope = [[0.0; 3]; 3];
    match Place::of(t, mu) {
        Place::Apex => {}
        Place::Inside => (0..3).for_each(|k| slope[k][k] = 1.0),
        Place::Edge {
            pressed,
            tangential,
        } => {
            let mut w = [0.0; 3];
            w[1..]
                .iter_mut()
                .zip(&t[1..])
                .for_each(|(w, t)| *w = t / tangential);
            let ray = [-1.0, mu * w[1], mu * w[2]];
            let across = mu * pressed / tangential;
            for (row, slopes) in slope.iter_mut().enumerate() {
                for (column, entry) in slopes.iter_mut().enumerate() {
                    *entry = ray[row] * ray[column] / (1.0 + mu * mu);
                    if row > 0 && column > 0 {
                        let same = f64::from(u8::from(row == column));
                        *entry += across * (same - w[row] * w[column]);
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

    #[test]
    fn a_reaction_outside_its_cone_goes_to_the_nearest_edge_or_the_apex() {
        let cones = CoulombCones {
            offsets: &[0, 3, 5, 6, 8, 9],
            friction: &[0.5, 1.0, 0.3, 0.0, 0.0],
        };
        let found = cones.project(vec![-10.0, 3.0, 4.0, 0.0, 2.0, 5.0, -3.0, 7.0, 1.0]);
        // On the edge already; half way between pressure and friction; no tension; a smooth contact;
        // no tension at a smooth contact without tangents.
        assert_eq!(found, [-10.0, 3.0, 4.0, -1.0, 1.0, 0.0, -3.0, 0.0, 0.0]);
    }

    #[test]
    fn the_derivative_is_the_difference_quotient() {
        let identity = Mat::<f64>::identity(3, 3);
        for (t, mu) in [
            ([-1.0, 2.0, -1.5], 0.7),
            ([0.5, 2.0, 1.0], 0.9),
            ([-4.0, 1.0, 0.2], 0.5),
            ([-4.0, 1.0, 0.2], 0.0),
            ([4.0, 1.0, 0.2], 0.5),
        ] {
            let (offsets, friction) = ([0, 3], [mu]);
            let cones = CoulombCones {
                offsets: &offsets,
                friction: &friction,
            };
            let slope = cones.derivative(&t, identity.as_ref());
            for k in 0..3 {
                let shifted = |h: f64| {
                    let mut t = t.to_vec();
                    t[k] += h;
                    cones.project(t)
                };
                // Rounding leaves ε · 4/1e-6 = 1e-9 of the quotient, the third derivative 1e-12.
                let (up, down) = (shifted(1e-6), shifted(-1e-6));
                for row in 0..3 {
                    let quotient = (up[row] - down[row]) / 2e-6;
                    assert!((slope[(row, k)] - quotient).abs() < 1e-8, "{t:?} {row} {k}");
                }
            }
        }
    }
}
