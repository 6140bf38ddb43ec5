//! Rigid obstacles: distance and direction to the closest point.
//!
//! ```text
//! plane      d = (x − p)·m              m: unit normal out of the obstacle
//! round      d = ‖x − c‖ − R            c: centre, or the closest point of the axis
//! direction  n = −∇d                    from the body towards the obstacle
//! ```
//!
//! The distance is negative for a point inside the obstacle; the direction is that of
//! the way in, so that `initial gap = d` along `n` on both sides of the surface.

use nalgebra::Vector3;

use crate::error::{Error, check_finite};

/// Sine of the largest angle by which a direction may leave the plane of a 2D body.
const IN_PLANE: f64 = 1e-12;

/// A rigid body; it moves only where a load history moves it.
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

/// How an obstacle is seen from a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closest {
    /// Signed distance, in metre; negative inside the obstacle.
    pub distance: f64,
    /// Unit vector towards the obstacle.
    pub direction: [f64; 3],
}

impl Obstacle {
    /// Refuses an obstacle that has no surface, or that is not at home in `dimension`.
    ///
    /// `place` names the contact pair in messages.
    ///
    /// # Errors
    ///
    /// A NaN or infinity, a zero normal or axis, a radius that is not positive; in 2D a
    /// sphere, a plane that is not upright, a cylinder whose axis is not along z.
    pub fn check(&self, place: &str, dimension: usize) -> Result<(), Error> {
        let at = |field: &str| format!("{place}.obstacle.{field}");
        match self {
            Self::Plane { point, normal } => {
                check_finite(&at("point"), point)?;
                let unit = unit(at("normal"), normal)?;
                if dimension == 2 && unit.z.abs() > IN_PLANE {
                    return Err(Error::Direction {
                        place: at("normal"),
                        value: *normal,
                        accepted: "a normal in the plane z = 0 of the body",
                    });
                }
            }
            Self::Cylinder {
                center,
                axis,
                radius,
            } => {
                check_finite(&at("center"), center)?;
                check_radius(at("radius"), *radius)?;
                let unit = unit(at("axis"), axis)?;
                if dimension == 2 && unit.x.hypot(unit.y) > IN_PLANE {
                    return Err(Error::Direction {
                        place: at("axis"),
                        value: *axis,
                        accepted: "an axis along z for a 2D body",
                    });
                }
            }
            Self::Sphere { center, radius } => {
                check_finite(&at("center"), center)?;
                check_radius(at("radius"), *radius)?;
                if dimension == 2 {
                    return Err(Error::ObstacleDimension {
                        place: format!("{place}.obstacle"),
                    });
                }
            }
        }
        Ok(())
    }

    /// Signed distance and direction from `position` to the closest point of the surface.
    ///
    /// # Errors
    ///
    /// A zero normal or axis; a position on the axis or at the centre.
    pub fn closest(&self, place: &str, position: [f64; 3]) -> Result<Closest, Error> {
        let x = Vector3::from(position);
        let at = |field: &str| format!("{place}.obstacle.{field}");
        let (outward, radius) = match self {
            Self::Plane { point, normal } => {
                let normal = unit(at("normal"), normal)?;
                return Ok(Closest {
                    distance: (x - Vector3::from(*point)).dot(&normal),
                    direction: opposite(normal),
                });
            }
            Self::Cylinder {
                center,
                axis,
                radius,
            } => {
                let axis = unit(at("axis"), axis)?;
                let arm = x - Vector3::from(*center);
                (arm - axis * axis.dot(&arm), radius)
            }
            Self::Sphere { center, radius } => (x - Vector3::from(*center), radius),
        };
        // Closer to the axis than round-off of the coordinates, the direction is noise.
        let length = outward.norm();
        if length <= 1e-12 * radius.max(x.amax()) {
            return Err(Error::NoClosestPoint {
                place: place.to_owned(),
                position,
            });
        }
        Ok(Closest {
            distance: length - radius,
            direction: opposite(outward / length),
        })
    }
}

/// `−v`, without negative zeros.
fn opposite(v: Vector3<f64>) -> [f64; 3] {
    v.map(|component| 0.0 - component).into()
}

/// The unit vector along `v`; exact where `v` lies along an axis.
fn unit(place: String, v: &[f64; 3]) -> Result<Vector3<f64>, Error> {
    check_finite(&place, v)?;
    let vector = Vector3::from(*v);
    // Scaled first, so that the square of a tiny or huge length is a number.
    let largest = vector.amax();
    if largest == 0.0 {
        return Err(Error::Direction {
            place,
            value: *v,
            accepted: "a vector that is not zero",
        });
    }
    Ok((vector / largest).normalize())
}

fn check_radius(place: String, radius: f64) -> Result<(), Error> {
    if radius > 0.0 && radius.is_finite() {
        return Ok(());
    }
    Err(Error::OutOfRange {
        place,
        value: radius,
        accepted: "radius > 0",
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn see(obstacle: Obstacle, position: [f64; 3]) -> Closest {
        obstacle.check("contacts[0]", 3).unwrap();
        obstacle.closest("contacts[0]", position).unwrap()
    }

    #[test]
    fn the_distance_to_a_tilted_plane_is_along_its_normal() {
        // Unit normal (0.6, 0.8, 0), so d = 0.6·3 + 0.8·4 = 5, whatever the length given.
        let plane = Obstacle::Plane {
            point: [0.0, 0.0, 7.0],
            normal: [3e-200, 4e-200, 0.0],
        };
        let seen = see(plane, [3.0, 4.0, 0.0]);
        assert!((seen.distance - 5.0).abs() < 1e-15);
        assert!((seen.direction[0] + 0.6).abs() + (seen.direction[1] + 0.8).abs() < 1e-15);
    }

    #[test]
    fn a_horizontal_plane_is_exactly_below() {
        let plane = Obstacle::Plane {
            point: [9.0, 1.0, 9.0],
            normal: [0.0, 7.0, 0.0],
        };
        let seen = see(plane, [0.3, 0.5, 0.0]);
        assert_eq!((seen.distance, seen.direction), (-0.5, [0.0, -1.0, 0.0]));
    }

    #[test]
    fn the_axis_of_a_cylinder_does_not_count_in_the_distance() {
        // Distance from the axis 5 (3-4-5 triangle), radius 2.
        let cylinder = Obstacle::Cylinder {
            center: [1.0, 1.0, -8.0],
            axis: [0.0, 0.0, -2.0],
            radius: 2.0,
        };
        let seen = see(cylinder, [4.0, 5.0, 30.0]);
        assert!((seen.distance - 3.0).abs() < 1e-14);
        assert!((seen.direction[0] + 0.6).abs() + (seen.direction[1] + 0.8).abs() < 1e-15);
        assert_eq!(seen.direction[2], 0.0);
    }

    #[test]
    fn inside_a_sphere_the_distance_is_negative_and_the_direction_is_inward() {
        let sphere = Obstacle::Sphere {
            center: [0.0, 0.0, -10.0],
            radius: 10.0,
        };
        let seen = see(sphere, [0.0, 0.0, -0.25]);
        assert_eq!((seen.distance, seen.direction), (-0.25, [0.0, 0.0, -1.0]));
    }

    #[test]
    fn on_the_axis_no_point_is_closest() {
        let cylinder = Obstacle::Cylinder {
            center: [1.0, 2.0, 0.0],
            axis: [0.0, 0.0, 1.0],
            radius: 1.0,
        };
        let position = [1.0, 2.0, 5.0];
        let place = "contacts[0]".to_owned();
        assert_eq!(
            cylinder.closest("contacts[0]", position),
            Err(Error::NoClosestPoint { place, position })
        );
    }

    #[test]
    fn obstacles_without_a_surface_are_refused_with_the_value() {
        let (point, center) = ([0.0; 3], [0.0; 3]);
        let axis = [0.0, 0.0, 1.0];
        let flawed = [
            (
                Obstacle::Plane {
                    point,
                    normal: [0.0; 3],
                },
                3,
            ),
            (
                Obstacle::Plane {
                    point,
                    normal: [0.0, f64::NAN, 1.0],
                },
                3,
            ),
            (
                Obstacle::Plane {
                    point,
                    normal: [0.0, 1.0, 1.0],
                },
                2,
            ),
            (
                Obstacle::Cylinder {
                    center,
                    axis,
                    radius: 0.0,
                },
                3,
            ),
            (
                Obstacle::Cylinder {
                    center,
                    axis: [0.0, 1.0, 1.0],
                    radius: 1.0,
                },
                2,
            ),
            (
                Obstacle::Sphere {
                    center,
                    radius: -1.0,
                },
                3,
            ),
            (
                Obstacle::Sphere {
                    center,
                    radius: f64::INFINITY,
                },
                3,
            ),
            (
                Obstacle::Sphere {
                    center,
                    radius: 1.0,
                },
                2,
            ),
        ];
        for (obstacle, dimension) in flawed {
            let found = obstacle.check("contacts[4]", dimension).unwrap_err();
            assert!(
                found.to_string().starts_with("contacts[4].obstacle"),
                "{found}"
            );
        }
    }
}
