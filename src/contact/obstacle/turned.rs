//! Surfaces that go around an axis, in the plane to both sides of it.
//!
//! ```text
//! x = p + z m + s e        p: apex, m: axis out of the obstacle, e: away from the axis, s ≥ 0
//! ```

use std::f64::consts::FRAC_PI_2;

use nalgebra::Vector3;

use super::{Closest, Seen, cone, paraboloid, punch};
use crate::error::Error;

/// Distance from the axis below which the direction away from it is noise, relative to the coordinates.
const ON_AXIS: f64 = 1e-12;

/// What goes around the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outline {
    /// Cone or wedge.
    Cone {
        /// Half of the angle at the apex, in radian, between 0 and π/2.
        half_angle: f64,
    },
    /// Paraboloid or parabola.
    Paraboloid {
        /// Radius of curvature at the apex, in metre.
        radius: f64,
    },
    /// Flat punch.
    Punch {
        /// Radius, in the plane half of the width, in metre.
        radius: f64,
        /// Radius of the rounded edge, from 0 to the radius, in metre.
        edge: f64,
    },
}

impl Outline {
    /// The key of a scene.
    pub(super) fn key(self) -> &'static str {
        match self {
            Self::Cone { .. } => "cone",
            Self::Paraboloid { .. } => "paraboloid",
            Self::Punch { .. } => "punch",
        }
    }

    /// Refuses an outline that bounds nothing.
    pub(crate) fn check(self, place: &str) -> Result<(), Error> {
        let within = |key: &str, value: f64, fits: bool, accepted| match fits {
            true => Ok(()),
            false => Err(Error::OutOfRange {
                place: format!("{place}.{key}"),
                value,
                accepted,
            }),
        };
        let radius_fits = |radius: f64| radius > 0.0 && radius.is_finite();
        match self {
            Self::Cone { half_angle } => within(
                "half_angle",
                half_angle.to_degrees(),
                half_angle > 0.0 && half_angle < FRAC_PI_2,
                "0 < half_angle < 90, in degrees",
            ),
            Self::Paraboloid { radius } => within(
                "radius",
                radius,
                radius_fits(radius),
                "0 < radius < infinity",
            ),
            Self::Punch { radius, edge } => {
                within(
                    "radius",
                    radius,
                    radius_fits(radius),
                    "0 < radius < infinity",
                )?;
                within(
                    "edge",
                    edge,
                    (0.0..=radius).contains(&edge),
                    "0 <= edge <= radius",
                )
            }
        }
    }

    fn see(self, s: f64, z: f64) -> Seen {
        match self {
            Self::Cone { half_angle } => cone::see(half_angle, s, z),
            Self::Paraboloid { radius } => paraboloid::see(radius, s, z),
            Self::Punch { radius, edge } => punch::see(radius, edge, s, z),
        }
    }

    /// Points (s, z) of it from the axis on, as far as `far`.
    pub(super) fn half(self, far: f64) -> Vec<[f64; 2]> {
        let steps = (0..=super::DRAWN / 2).map(|k| 2.0 * k as f64 / super::DRAWN as f64);
        match self {
            Self::Cone { half_angle } => vec![[0.0, 0.0], [far, -far / half_angle.tan()]],
            Self::Paraboloid { radius } => {
                let end = far.min((2.0 * radius * far).sqrt());
                steps
                    .map(|k| [k * end, -(k * end).powi(2) / (2.0 * radius)])
                    .collect()
            }
            Self::Punch { radius, edge } => {
                let arc = steps.map(|k| (k * FRAC_PI_2).sin_cos());
                let arc = arc.map(|(sin, cos)| [radius - edge + edge * sin, edge * cos - edge]);
                let ends = ([[0.0, 0.0]], [[radius, -far.max(2.0 * edge)]]);
                ends.0.into_iter().chain(arc).chain(ends.1).collect()
            }
        }
    }

    /// The surface turned about the unit vector `axis` through `apex`, from `x`. On the axis it is met
    /// along it.
    pub(super) fn closest(
        self,
        apex: Vector3<f64>,
        axis: Vector3<f64>,
        x: Vector3<f64>,
    ) -> Closest {
        let arm = x - apex;
        let z = arm.dot(&axis);
        let across = arm - axis * z;
        let s = across.norm();
        if s <= ON_AXIS * x.amax().max(apex.amax()) {
            return Closest::new(z, -axis);
        }
        let seen = self.see(s, z);
        let [aside, along] = seen.direction;
        Closest {
            beyond: seen.beyond,
            ..Closest::new(seen.distance, across * (aside / s) + axis * along)
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    const SHAPES: [Outline; 4] = [
        Outline::Cone { half_angle: 1.3 },
        Outline::Paraboloid { radius: 0.7 },
        Outline::Punch {
            radius: 0.8,
            edge: 0.0,
        },
        Outline::Punch {
            radius: 0.8,
            edge: 0.2,
        },
    ];

    fn see(shape: Outline, [x, y, z]: [f64; 3]) -> Closest {
        shape.closest(Vector3::zeros(), Vector3::z(), Vector3::new(x, y, z))
    }

    /// Heights of the surfaces of `SHAPES` at a distance from the axis; none beside a punch.
    fn height(shape: Outline, s: f64) -> Option<f64> {
        match shape {
            Outline::Cone { half_angle } => Some(-s / half_angle.tan()),
            Outline::Paraboloid { radius } => Some(-s * s / (2.0 * radius)),
            Outline::Punch { radius, edge } => (s <= radius).then(|| {
                let across = (s - radius + edge).max(0.0);
                (edge * edge - across * across).max(0.0).sqrt() - edge
            }),
        }
    }

    #[test]
    fn the_foot_is_on_the_surface_and_the_way_there_is_along_its_normal() {
        for shape in SHAPES {
            for k in 0..40 {
                let (s, z) = (0.03 + 0.02 * f64::from(k), 0.01 * f64::from(k % 7));
                // In a direction that is none of the axes: (0.6, 0.8).
                let x = [0.6 * s, 0.8 * s, z];
                let seen = see(shape, x);
                if seen.beyond {
                    continue;
                }
                let foot = [0, 1, 2].map(|k| x[k] + seen.distance * seen.direction[k]);
                let at = foot[0].hypot(foot[1]);
                assert!(
                    (foot[2] - height(shape, at).unwrap()).abs() < 1e-12,
                    "{shape:?} {s} {z}"
                );
                // No neighbour on the surface is nearer.
                for other in [at - 1e-4, at + 1e-4] {
                    let Some(h) = height(shape, other) else {
                        continue;
                    };
                    assert!(
                        (s - other).hypot(z - h) > seen.distance.abs() - 1e-12,
                        "{shape:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn inside_distances_are_negative_and_directions_lead_in() {
        for shape in SHAPES {
            let seen = see(shape, [0.1, 0.0, -0.1]);
            let [_, _, along] = seen.direction;
            assert!(seen.distance < 0.0 && along < -0.5, "{shape:?} {seen:?}");
        }
    }

    #[test]
    fn beyond_the_edge_of_a_punch_nothing_touches_it_but_walls_do() {
        for edge in [0.0, 0.2] {
            let punch = Outline::Punch { radius: 0.8, edge };
            assert!(!see(punch, [0.8, 0.0, 0.1]).beyond);
            assert!(see(punch, [0.81, 0.0, 0.1]).beyond && see(punch, [2.0, 0.0, 0.0]).beyond);
            let wall = see(punch, [1.0, 0.0, -0.5]);
            assert!(!wall.beyond && (wall.distance - 0.2).abs() < 1e-15);
            assert_eq!(wall.direction, [-1.0, 0.0, 0.0]);
        }
        // The very edge belongs to the face.
        let seen = see(
            Outline::Punch {
                radius: 0.8,
                edge: 0.0,
            },
            [0.8, 0.0, 0.0],
        );
        assert_eq!((seen.distance, seen.direction), (0.0, [0.0, 0.0, -1.0]));
    }

    #[test]
    fn an_apex_is_met_along_the_axis() {
        for shape in SHAPES {
            let seen = see(shape, [0.0, 0.0, 0.25]);
            assert_eq!((seen.distance, seen.direction), (0.25, [0.0, 0.0, -1.0]));
            let seen = see(shape, [0.0, 0.0, 0.0]);
            assert_eq!((seen.distance, seen.direction), (0.0, [0.0, 0.0, -1.0]));
        }
    }
}
