//! Rigid obstacles: distance and direction to the closest point.
//!
//! ```text
//! plane      d = (x − p)·m              m: unit normal out of the obstacle
//! round      d = ‖x − c‖ − R            c: centre, or the closest point of the axis
//! bore       d = R − ‖x − c‖            the body is inside
//! direction  n = −∇d                    from the body towards the obstacle
//! ```
//!
//! The distance is negative for a point inside the obstacle; the direction is that of
//! the way in, so that `initial gap = d` along `n` on both sides of the surface. What lies beyond an
//! edge or an end sees no surface to touch.
//!
//! | shape | file |
//! |---|---|
//! | cone, paraboloid, flat punch, around their axis | `cone`, `paraboloid`, `punch`: `turned` |
//! | ellipsoid, ellipse | `ellipsoid` |
//! | polyline or smooth curve in the plane | `profile` |
//! | triangles in space | `triangulated` |

mod cone;
#[cfg(feature = "cli")]
mod drawn;
mod ellipsoid;
mod paraboloid;
mod profile;
mod punch;
mod triangulated;
mod turned;

use std::f64::consts::TAU;
use std::sync::Arc;

use nalgebra::Vector3;

pub use profile::Profile;
pub use triangulated::Triangulated;
pub use turned::Outline;

use crate::error::{Error, check_finite};

/// Sine of the largest angle by which a direction may leave the plane of a 2D body.
const IN_PLANE: f64 = 1e-12;

/// Cosine of the largest turn of an edge that something may touch.
const SHARP: f64 = 0.5;

/// Pieces of a curve that is drawn.
const DRAWN: usize = 96;

/// A rigid surface; it moves where a load history or a rigid body moves it.
#[derive(Clone, Debug, PartialEq)]
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
    /// The inside of a circle (2D), or of an infinite circular cylinder (3D).
    Bore {
        /// A point of the axis, in metre.
        center: [f64; 3],
        /// Direction of the axis; `[0, 0, 1]` for a circle in 2D.
        axis: [f64; 3],
        /// Radius, in metre.
        radius: f64,
    },
    /// Ellipsoid (3D) or ellipse (2D), along the axes.
    Ellipsoid {
        /// Centre, in metre.
        center: [f64; 3],
        /// Radius along each axis, in metre; infinite along z in 2D.
        radii: [f64; 3],
    },
    /// Cone, paraboloid or flat punch; in 2D wedge, parabola or strip.
    Turned {
        /// Point of the surface on the axis, in metre.
        apex: [f64; 3],
        /// Direction of the axis out of the obstacle, towards the body.
        axis: [f64; 3],
        /// What goes around it.
        outline: Outline,
    },
    /// A curve in the plane (2D).
    Profile(Arc<Profile>),
    /// Triangles in space (3D).
    Triangulated(Arc<Triangulated>),
}

/// How an obstacle is seen from a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closest {
    /// Signed distance, in metre; negative inside the obstacle.
    pub distance: f64,
    /// Unit vector towards the obstacle.
    pub direction: [f64; 3],
    /// The closest point is an edge or an end, and the position beyond it: there is nothing to touch.
    pub beyond: bool,
}

impl Closest {
    /// Of a surface to touch.
    fn new(distance: f64, towards: Vector3<f64>) -> Self {
        Self {
            distance,
            // Without negative zeros.
            direction: towards.map(|component| component + 0.0).into(),
            beyond: false,
        }
    }
}

/// An outline from a point of the half-plane (s, z).
#[derive(Clone, Copy, Debug, PartialEq)]
struct Seen {
    distance: f64,
    /// Unit vector towards the surface.
    direction: [f64; 2],
    beyond: bool,
}

impl Seen {
    fn at(distance: f64, direction: [f64; 2]) -> Self {
        Self {
            distance,
            direction,
            beyond: false,
        }
    }
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
        // Directions that 2D bodies do not have: out of their plane, or in it.
        let out = |unit: Vector3<f64>| unit.z.abs();
        let within = |unit: Vector3<f64>| unit.x.hypot(unit.y);
        let direct = |field, value: &[f64; 3], off: &dyn Fn(Vector3<f64>) -> f64, accepted| {
            let place = at(field);
            let unit = unit(place.clone(), value)?;
            match dimension == 2 && off(unit) > IN_PLANE {
                false => Ok(()),
                true => Err(Error::Direction {
                    place,
                    value: *value,
                    accepted,
                }),
            }
        };
        match self {
            Self::Plane { point, normal } => {
                check_finite(&at("point"), point)?;
                direct(
                    "normal",
                    normal,
                    &out,
                    "a normal in the plane z = 0 of the body",
                )
            }
            Self::Cylinder {
                center,
                axis,
                radius,
            }
            | Self::Bore {
                center,
                axis,
                radius,
            } => {
                check_finite(&at("center"), center)?;
                check_radius(at("radius"), *radius)?;
                direct("axis", axis, &within, "an axis along z for a 2D body")
            }
            Self::Sphere { center, radius } => {
                check_finite(&at("center"), center)?;
                check_radius(at("radius"), *radius)?;
                check_dimension(place, dimension, 3)
            }
            Self::Ellipsoid { center, radii } => {
                check_finite(&at("center"), center)?;
                let mut radii = radii[..dimension].iter();
                radii.try_for_each(|radius| check_radius(at("radii"), *radius))
            }
            Self::Turned {
                apex,
                axis,
                outline,
            } => {
                check_finite(&at("apex"), apex)?;
                direct("axis", axis, &out, "an axis in the plane z = 0 of the body")?;
                outline.check(&at(outline.key()))
            }
            Self::Profile(_) => check_dimension(place, dimension, 2),
            Self::Triangulated(_) => check_dimension(place, dimension, 3),
        }
    }

    /// Refuses what does not go around the axis of axisymmetric bodies.
    pub(super) fn check_around(&self, place: &str) -> Result<(), Error> {
        let on_axis = |field: &str, value: f64, accepted: &'static str| match value {
            0.0 => Ok(()),
            value => Err(Error::OutOfRange {
                place: format!("{place}.obstacle.{field}"),
                value,
                accepted,
            }),
        };
        match self {
            Self::Plane { .. } | Self::Sphere { .. } | Self::Triangulated(_) => Ok(()),
            Self::Cylinder { center, .. }
            | Self::Bore { center, .. }
            | Self::Ellipsoid { center, .. } => on_axis(
                "center[0]",
                center[0],
                "0: beside an axisymmetric body a circle is a ball on the axis",
            ),
            Self::Turned { apex, axis, .. } => {
                on_axis("apex[0]", apex[0], "0: it goes around the axis")?;
                on_axis("axis[0]", axis[0], "0: it goes around the axis")
            }
            Self::Profile(profile) => on_axis(
                "profile.points",
                profile.least_x().min(0.0),
                "points with x ≥ 0: beside an axisymmetric body x is the radius",
            ),
        }
    }

    /// Signed distance and direction from `position` to the closest point of the surface.
    ///
    /// # Errors
    ///
    /// A zero normal or axis; a position on the axis or at the centre.
    pub fn closest(&self, place: &str, position: [f64; 3]) -> Result<Closest, Error> {
        let x = Vector3::from(position);
        let at = |field: &str| format!("{place}.obstacle.{field}");
        let nowhere = || Error::NoClosestPoint {
            place: place.to_owned(),
            position,
        };
        let (outward, radius) = match self {
            Self::Plane { point, normal } => {
                let normal = unit(at("normal"), normal)?;
                let distance = (x - Vector3::from(*point)).dot(&normal);
                return Ok(Closest::new(distance, -normal));
            }
            Self::Ellipsoid { center, radii } => {
                return ellipsoid::closest(*radii, x - Vector3::from(*center)).ok_or_else(nowhere);
            }
            Self::Turned {
                apex,
                axis,
                outline,
            } => return Ok(outline.closest(Vector3::from(*apex), unit(at("axis"), axis)?, x)),
            Self::Profile(profile) => return Ok(profile.closest(position)),
            Self::Triangulated(surface) => return Ok(surface.closest(position)),
            Self::Cylinder {
                center,
                axis,
                radius,
            }
            | Self::Bore {
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
            return Err(nowhere());
        }
        let out = outward / length;
        Ok(match self {
            Self::Bore { .. } => Closest::new(radius - length, out),
            _ => Closest::new(length - radius, -out),
        })
    }

    /// Points of the curve that bounds it in the plane, as far as `far` from its axis, in metre; none of a plane, and
    /// of what lives in space.
    #[must_use]
    pub(crate) fn section(&self, far: f64) -> Vec<[f64; 2]> {
        let around = |center: &[f64; 3], radii: [f64; 2]| {
            let angles = (0..=DRAWN).map(|k| TAU * k as f64 / DRAWN as f64);
            let at = |angle: f64| {
                [
                    center[0] + radii[0] * angle.cos(),
                    center[1] + radii[1] * angle.sin(),
                ]
            };
            angles.map(at).collect()
        };
        match self {
            Self::Cylinder { center, radius, .. }
            | Self::Bore { center, radius, .. }
            | Self::Sphere { center, radius } => around(center, [*radius; 2]),
            Self::Ellipsoid { center, radii } => around(center, [radii[0], radii[1]]),
            Self::Profile(profile) => profile.outline(),
            Self::Turned {
                apex,
                axis,
                outline,
            } => {
                let length = axis[0].hypot(axis[1]);
                let [a_x, a_y] = [axis[0] / length, axis[1] / length];
                let at =
                    |[s, z]: [f64; 2]| [apex[0] + z * a_x - s * a_y, apex[1] + z * a_y + s * a_x];
                let half = outline.half(far);
                let mirrored = half.iter().rev().map(|&[s, z]| [-s, z]);
                mirrored.chain(half.iter().copied()).map(at).collect()
            }
            Self::Plane { .. } | Self::Triangulated(_) => Vec::new(),
        }
    }

    /// Radius of its tightest curve, in metre; none where it has no one.
    #[must_use]
    pub(crate) fn least_radius(&self) -> Option<f64> {
        match self {
            Self::Cylinder { radius, .. }
            | Self::Sphere { radius, .. }
            | Self::Bore { radius, .. } => Some(*radius),
            Self::Ellipsoid { radii, .. } => {
                let finite = || radii.iter().copied().filter(|radius| radius.is_finite());
                let (least, most) = (
                    finite().fold(f64::INFINITY, f64::min),
                    finite().fold(0.0, f64::max),
                );
                Some(least * least / most)
            }
            Self::Turned {
                outline: Outline::Paraboloid { radius },
                ..
            } => Some(*radius),
            Self::Plane { .. } | Self::Turned { .. } | Self::Profile(_) | Self::Triangulated(_) => {
                None
            }
        }
    }
}

/// Refuses a shape that lives in another space.
fn check_dimension(place: &str, dimension: usize, lives_in: usize) -> Result<(), Error> {
    match dimension == lives_in {
        true => Ok(()),
        false => Err(Error::ObstacleDimension {
            place: format!("{place}.obstacle"),
        }),
    }
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
