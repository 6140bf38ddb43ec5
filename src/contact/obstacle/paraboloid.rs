//! A paraboloid, in the plane a parabola.
//!
//! ```text
//! surface   z = −σ²/2R
//! foot      σ³/2R² + σ (1 + z/R) = s       one root outside; the largest is the nearest inside
//! ```

use super::Seen;

/// Steps of Newton's method at most; it closes in from above.
const STEPS: usize = 100;

/// Seen from a distance `s ≥ 0` from the axis, at a height `z` before the apex.
pub(super) fn see(radius: f64, s: f64, z: f64) -> Seen {
    let (s, z) = (s / radius, z / radius);
    let slope = 1.0 + z;
    // Above the largest root: where each term alone is large enough.
    let mut foot = s + (2.0 * s).cbrt() + (2.0 * (-slope).max(0.0)).sqrt();
    for _ in 0..STEPS {
        let derivative = 1.5 * foot * foot + slope;
        let next = foot - (0.5 * foot.powi(3) + slope * foot - s) / derivative;
        if derivative <= 0.0 || next >= foot {
            break;
        }
        foot = next.max(0.0);
    }
    let size = foot.hypot(1.0);
    let outward = [foot / size, 1.0 / size];
    let distance = (s - foot) * outward[0] + (z + 0.5 * foot * foot) * outward[1];
    Seen::at(distance * radius, outward.map(|x| -x))
}
