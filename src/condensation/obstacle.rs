//! Rigid obstacles: distance and direction to the closest point.

/// A rigid body that does not move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Obstacle {
    /// Half-space behind a plane.
    Plane {
        /// A point of the plane, in metre.
        point: [f64; 3],
        /// Direction out of the obstacle, towards the body; any length but zero.
        normal: [f64; 3],
    },
    /// Circle (2D) or infinite circular cylinder (3D).
    Cylinder {
        /// A point of the axis, in metre.
        center: [f64; 3],
        /// Direction of the axis; `[0, 0, 1]` for a circle in 2D.
        axis: [f64; 3],
        /// Radius, in metre.
        radius: f64,
    },
    /// Sphere (3D).
    Sphere {
        /// Centre, in metre.
        center: [f64; 3],
        /// Radius, in metre.
        radius: f64,
    },
}
