//! How far a rigid obstacle is from a point, and where it lies.
//!
//! ```text
//! plane    (x − p) · m                 m: unit normal out of the obstacle
//! round    ‖x − c‖ − R                 c: centre, or the nearest point of the axis
//! ```

use nalgebra::Vector3;

use crate::contact::Obstacle;

/// Signed distance in metre, negative inside, and the unit vector towards the obstacle; none where
/// that has no direction.
pub(super) fn see(obstacle: &Obstacle, x: Vector3<f64>) -> Option<(f64, Vector3<f64>)> {
    let (away, radius) = match *obstacle {
        Obstacle::Plane { point, normal } => {
            let out = unit(normal)?;
            return Some(((x - Vector3::from(point)).dot(&out), -out));
        }
        Obstacle::Sphere { center, radius } => (x - Vector3::from(center), radius),
        Obstacle::Cylinder {
            center,
            axis,
            radius,
        } => {
            let (axis, arm) = (unit(axis)?, x - Vector3::from(center));
            (arm - axis * arm.dot(&axis), radius)
        }
    };
    let out = away.try_normalize(0.0)?;
    Some((away.norm() - radius, -out))
}

/// Scaled first: a direction may be given by the tiniest numbers.
fn unit(vector: [f64; 3]) -> Option<Vector3<f64>> {
    let vector = Vector3::from(vector);
    (vector / vector.amax()).try_normalize(0.0)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn distances_are_negative_inside_and_directions_lead_in() {
        let ball = Obstacle::Sphere {
            center: [0.0, 0.0, 2.0],
            radius: 2.0,
        };
        let tube = Obstacle::Cylinder {
            center: [0.0, 5.0, 2.0],
            axis: [0.0, 3.0, 0.0],
            radius: 2.0,
        };
        for obstacle in [ball, tube] {
            let (distance, towards) = see(&obstacle, Vector3::new(0.0, 0.0, 5.0)).unwrap();
            assert_eq!((distance, towards.z), (1.0, -1.0));
            assert_eq!(see(&obstacle, Vector3::new(0.0, 0.0, 1.0)).unwrap().0, -1.0);
        }
        let plane = Obstacle::Plane {
            point: [0.0, -1.0, 0.0],
            normal: [0.0, 1e-200, 0.0],
        };
        let (distance, towards) = see(&plane, Vector3::new(9.0, 1.0, 0.0)).unwrap();
        assert_eq!((distance, towards.y), (2.0, -1.0));
    }
}
