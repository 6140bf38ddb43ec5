//! Which sums of given vectors with shares that are not negative come nearest to a vector.
//!
//! ```text
//! min ‖Σ λ_k a_k − b‖²   s.t.  λ ≥ 0
//! ```
//!
//! Lawson & Hanson, Solving Least Squares Problems (1974), ch. 23: the vector that goes furthest along
//! the residual joins those in use; shares that would turn negative leave.

use nalgebra::{DMatrix, DVector, Vector6};

/// Part of the residual along which nothing more is gained.
const ROUNDED: f64 = 1e-12;

/// Vectors that join, at most.
const JOINED: usize = 200;

/// The distance from `sought` to the cone of `vectors`.
pub(super) fn distance(vectors: &[Vector6<f64>], sought: Vector6<f64>) -> f64 {
    let (mut used, mut shares) = (Vec::<usize>::new(), Vec::<f64>::new());
    let mut rest = sought;
    for _ in 0..JOINED {
        let gains = vectors.iter().map(|vector| vector.dot(&rest));
        let best = gains.enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
        let Some((next, gain)) = best else { break };
        if gain <= ROUNDED * sought.norm() || used.contains(&next) {
            break;
        }
        used.push(next);
        shares.push(0.0);
        settle(vectors, sought, &mut used, &mut shares);
        let terms = used.iter().zip(&shares);
        let now = sought
            - terms
                .map(|(&k, share)| vectors[k] * *share)
                .sum::<Vector6<f64>>();
        if now.norm() >= rest.norm() {
            break;
        }
        rest = now;
    }
    rest.norm()
}

/// Least squares over the vectors in use, those with negative shares leaving.
fn settle(
    vectors: &[Vector6<f64>],
    sought: Vector6<f64>,
    used: &mut Vec<usize>,
    shares: &mut Vec<f64>,
) {
    while !used.is_empty() {
        let Some(found) = nearest(vectors, sought, used) else {
            return;
        };
        // As far towards it as all shares stay positive.
        let mut along = 1.0_f64;
        for (share, goal) in shares.iter().zip(found.iter()) {
            if *goal <= 0.0 {
                along = along.min(share / (share - goal));
            }
        }
        for (share, goal) in shares.iter_mut().zip(found.iter()) {
            *share += along * (goal - *share);
        }
        if found.iter().all(|goal| *goal > 0.0) {
            return;
        }
        let kept: Vec<bool> = shares
            .iter()
            .zip(found.iter())
            .map(|(share, goal)| *goal > 0.0 || *share > ROUNDED * sought.norm())
            .collect();
        if kept.iter().all(|kept| *kept) {
            return;
        }
        let mut keep = kept.iter();
        used.retain(|_| keep.next().is_some_and(|kept| *kept));
        let mut keep = kept.iter();
        shares.retain(|_| keep.next().is_some_and(|kept| *kept));
    }
}

/// Least squares without a bound on the shares; none where vectors depend on each other, as more than six do.
///
/// By reflections: nalgebra's singular values lose digits where two are equal, as those of friction of one are.
fn nearest(vectors: &[Vector6<f64>], sought: Vector6<f64>, used: &[usize]) -> Option<DVector<f64>> {
    if used.len() > 6 {
        return None;
    }
    let factors = DMatrix::from_fn(6, used.len(), |row, k| vectors[used[k]][row]).qr();
    let right = factors.q().transpose() * sought;
    let right = DVector::from_column_slice(right.as_slice());
    factors.r().solve_upper_triangular(&right)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn vector(entries: [f64; 3]) -> Vector6<f64> {
        Vector6::new(entries[0], entries[1], entries[2], 0.0, 0.0, 0.0)
    }

    #[test]
    fn inside_a_cone_there_is_no_distance_and_outside_that_to_its_face() {
        let cone = [
            [1.0, 1.0, 1.0],
            [1.0, -1.0, 1.0],
            [-1.0, 1.0, 1.0],
            [-1.0, -1.0, 1.0],
        ];
        let cone = cone.map(vector);
        assert!(distance(&cone, vector([0.3, -0.9, 1.0])) < 1e-12);
        assert!(distance(&cone, vector([1.0, 1.0, 1.0])) < 1e-12);
        // The face x = z: (2, 0, 0) is √2 from (1, 0, 1).
        assert!((distance(&cone, vector([2.0, 0.0, 0.0])) - 2.0_f64.sqrt()).abs() < 1e-12);
        assert!((distance(&cone, vector([0.0, 0.0, -3.0])) - 3.0).abs() < 1e-12);
        assert_eq!(distance(&[], vector([0.0, 4.0, 3.0])), 5.0);
    }

    #[test]
    fn sums_of_rays_are_inside_their_cone_whatever_the_friction() {
        // Two rays at each of many points on a line, positions and directions known to round-off.
        let mut seed = 7_u64;
        let mut noise = move |size: f64| {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            ((seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5) * size
        };
        for _ in 0..400 {
            for mu in [0.3, 1.0, 3.0] {
                let (mut rays, mut sum) = (Vec::new(), Vector6::zeros());
                for k in 0..12 {
                    let arm = f64::from(k) / 5.5 - 1.0 + noise(4e-15);
                    let lean = noise(1e-16);
                    for q in [mu, -mu] {
                        let ray = Vector6::new(q * lean - 1.0, q + lean, 0.0, 0.0, 0.0, arm);
                        sum += ray * (0.55 + noise(1.0));
                        rays.push(ray);
                    }
                }
                let off = distance(&rays, sum) / sum.norm();
                assert!(off < 1e-9, "{mu}: {off:e}");
            }
        }
    }
}
