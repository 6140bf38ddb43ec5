//! An ellipsoid along the axes; in the plane an ellipse, whose third radius is infinite.
//!
//! ```text
//! foot   x_i = a_i² p_i / (a_i² + t),    Σ (a_i p_i / (a_i² + t))² = 1        t > −min a_i²
//! ```
//!
//! The sum falls with t and is convex: Newton's method closes in from below. (Eberly, Distance from a point
//! to an ellipse, an ellipsoid, or a hyperellipsoid, 2011.)

use nalgebra::Vector3;

use super::Closest;

const STEPS: usize = 200;

/// The ellipsoid around zero, from `p`; none from near its middle, where several points are as near.
pub(super) fn closest(radii: [f64; 3], p: Vector3<f64>) -> Option<Closest> {
    let axes: Vec<usize> = (0..3).filter(|&k| radii[k].is_finite()).collect();
    // Seen in units of the largest radius.
    let unit = axes.iter().fold(0.0, |most: f64, &k| most.max(radii[k]));
    let (a, q) = (radii.map(|a| a / unit), p / unit);
    let start = axes.iter().map(|&k| a[k] * q[k].abs() - a[k] * a[k]);
    let mut t = start.fold(f64::NEG_INFINITY, f64::max);
    let least = axes
        .iter()
        .map(|&k| -a[k] * a[k])
        .fold(f64::NEG_INFINITY, f64::max);
    for _ in 0..STEPS {
        let (mut sum, mut slope) = (-1.0, 0.0);
        for &k in &axes {
            let term = a[k] * q[k] / (a[k] * a[k] + t);
            sum += term * term;
            slope -= 2.0 * term * term / (a[k] * a[k] + t);
        }
        let next = t - sum / slope;
        if next <= t || next.is_nan() {
            break;
        }
        t = next;
    }
    if !t.is_finite() || t <= least {
        return None;
    }
    let (mut foot, mut outward) = (q, Vector3::zeros());
    for &k in &axes {
        foot[k] = a[k] * a[k] * q[k] / (a[k] * a[k] + t);
        outward[k] = q[k] / (a[k] * a[k] + t);
    }
    let outward = outward.try_normalize(0.0)?;
    Some(Closest::new((q - foot).dot(&outward) * unit, -outward))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_ball_is_an_ellipsoid_of_equal_radii() {
        for p in [[3.0, 4.0, 0.0], [0.0, 0.0, 0.5], [0.3, 0.4, 1.2]] {
            let p = Vector3::from(p);
            let seen = closest([2.0; 3], p).unwrap();
            assert!((seen.distance - (p.norm() - 2.0)).abs() < 1e-14);
            assert!((Vector3::from(seen.direction) + p.normalize()).norm() < 1e-14);
        }
        assert_eq!(closest([2.0; 3], Vector3::zeros()), None);
    }

    #[test]
    fn going_out_along_the_normal_leads_back_to_the_same_point() {
        let radii = [3.0, 2.0, 0.5];
        for (theta, phi) in [(0.3_f64, 0.2_f64), (1.2, 2.0), (2.5, 4.0)] {
            let on = [
                theta.sin() * phi.cos(),
                theta.sin() * phi.sin(),
                theta.cos(),
            ];
            let x = Vector3::from([0, 1, 2].map(|k| radii[k] * on[k]));
            let out = Vector3::from([0, 1, 2].map(|k| on[k] / radii[k])).normalize();
            for distance in [1.7, 0.1, 0.0, -0.02] {
                let seen = closest(radii, x + out * distance).unwrap();
                assert!(
                    (seen.distance - distance).abs() < 1e-12,
                    "{distance} {seen:?}"
                );
                assert!((Vector3::from(seen.direction) + out).norm() < 1e-11);
            }
        }
    }

    #[test]
    fn an_ellipse_does_not_see_the_third_axis() {
        let seen = closest([3.0, 2.0, f64::INFINITY], Vector3::new(0.0, 5.0, 9.0)).unwrap();
        assert_eq!((seen.distance, seen.direction), (3.0, [0.0, -1.0, 0.0]));
    }
}
