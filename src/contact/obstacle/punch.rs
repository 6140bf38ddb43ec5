//! A flat punch: a disc, in the plane a strip, with walls behind its edge, which may be rounded.
//!
//! ```text
//! face    z = 0,  s ≤ c             c = a − e: end of the flat face, e: radius of the edge
//! edge    ‖(s − c, z + e)‖ = e
//! wall    s = a,  z < −e
//! ```
//!
//! Nothing touches the punch beyond its edge: what lies before its face, but further from the axis than its
//! walls, sees nothing of it.

use super::Seen;

/// Part of the radius that is round-off at the edge.
const ROUNDED: f64 = 1e-9;

/// Seen from a distance `s ≥ 0` from the axis, at a height `z` before the face.
pub(super) fn see(radius: f64, edge: f64, s: f64, z: f64) -> Seen {
    let flat = radius - edge;
    let behind = z < -edge;
    let wall = s - radius;
    if s <= flat * (1.0 + ROUNDED) || (edge == 0.0 && wall <= ROUNDED * radius) {
        return match behind && wall > z {
            true => Seen::at(wall, [-1.0, 0.0]),
            false => Seen::at(z, [0.0, -1.0]),
        };
    }
    if behind {
        return Seen::at(wall, [-1.0, 0.0]);
    }
    let (across, along) = (s - flat, z + edge);
    let length = across.hypot(along);
    Seen {
        beyond: wall > ROUNDED * radius,
        ..Seen::at(length - edge, [-across / length, -along / length])
    }
}
