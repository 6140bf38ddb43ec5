//! A cone, in the plane a wedge: the flank runs from the apex away from the axis.
//!
//! ```text
//! flank   z = −s cot α        α: half of the angle at the apex
//! d       s cos α + z sin α   beside the flank; ‖(s, z)‖ before the apex
//! ```

use super::Seen;

/// Seen from a distance `s ≥ 0` from the axis, at a height `z` before the apex.
pub(super) fn see(half_angle: f64, s: f64, z: f64) -> Seen {
    let (sin, cos) = half_angle.sin_cos();
    let from_apex = s.hypot(z);
    if s * sin - z * cos <= 0.0 && from_apex > 0.0 {
        return Seen::at(from_apex, [-s / from_apex, -z / from_apex]);
    }
    Seen::at(s * cos + z * sin, [-cos, -sin])
}
