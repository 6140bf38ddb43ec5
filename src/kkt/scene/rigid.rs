//! How far a rigid obstacle is from a point, and where it lies.
//!
//! ```text
//! plane      (x − p) · m                 m: unit normal out of the obstacle
//! round      ‖x − c‖ − R                 c: centre, or the nearest point of the axis; of a bore R − ‖x − c‖
//! curve      (x − P(t)) · m              P(t): the point where (x − P) · P' changes sign, nearest of all
//! triangles                              `triangles`
//! ```
//!
//! Around an axis a curve is looked at in the half-plane through the point. Beyond an end, and beyond an edge that
//! turns by more than 60°, there is nothing.

use std::f64::consts::FRAC_PI_2;

use nalgebra::{Vector2, Vector3};

use super::triangles::Triangles;
use crate::contact::{Obstacle, Outline};

/// Places that are looked at along a curve, per piece of it.
const LOOKS: usize = 64;

/// Halvings of the way between two of them.
const HALVINGS: usize = 60;

/// Part of a curve's range over which its direction is taken,
const STEP: f64 = 1e-7;

/// and across which a normal may miss the point: sine of the angle, and part of the range.
const ASIDE: [f64; 2] = [1e-6, 1e-9];

/// Distance from an axis that is round-off, as a part of the coordinates.
const AT_AXIS: f64 = 1e-12;

/// Cosine of the largest turn of an edge that something may touch.
const SHARP: f64 = 0.5;

/// An obstacle, prepared to be looked at from many points.
#[derive(Debug)]
pub(super) struct Sight<'a> {
    obstacle: &'a Obstacle,
    triangles: Option<Triangles>,
}

/// Signed distance in metre, negative inside, and the unit vector towards the obstacle; none where there is nothing.
type Seen = Option<(f64, Vector3<f64>)>;

impl<'a> Sight<'a> {
    pub(super) fn new(obstacle: &'a Obstacle) -> Self {
        let triangles = match obstacle {
            Obstacle::Triangulated(surface) => Some(Triangles::new(surface)),
            _ => None,
        };
        Self {
            obstacle,
            triangles,
        }
    }

    /// None where the obstacle has no direction, or nothing to touch.
    pub(super) fn see(&self, x: Vector3<f64>) -> Seen {
        let (away, radius) = match self.obstacle {
            Obstacle::Plane { point, normal } => {
                let out = unit(*normal)?;
                return Some(((x - Vector3::from(*point)).dot(&out), -out));
            }
            Obstacle::Ellipsoid { center, radii } => {
                return ellipsoid(*radii, x - Vector3::from(*center));
            }
            Obstacle::Turned {
                apex,
                axis,
                outline,
            } => return turned(Vector3::from(*apex), unit(*axis)?, *outline, x),
            Obstacle::Profile(profile) => {
                let curve = Curve {
                    range: [0.0, profile.pieces() as f64],
                    looks: profile.pieces() * LOOKS,
                    open: true,
                    at: |t: f64| Vector2::from(profile.point(t)),
                    corner: f64::round,
                };
                let (distance, towards) = curve.see(Vector2::new(x.x, x.y))?;
                return Some((distance, Vector3::new(towards.x, towards.y, 0.0)));
            }
            Obstacle::Triangulated(_) => return self.triangles.as_ref()?.see(x),
            Obstacle::Sphere { center, radius } => (x - Vector3::from(*center), *radius),
            Obstacle::Cylinder {
                center,
                axis,
                radius,
            }
            | Obstacle::Bore {
                center,
                axis,
                radius,
            } => {
                let (axis, arm) = (unit(*axis)?, x - Vector3::from(*center));
                (arm - axis * arm.dot(&axis), *radius)
            }
        };
        let out = away.try_normalize(0.0)?;
        match self.obstacle {
            Obstacle::Bore { .. } => Some((radius - away.norm(), out)),
            _ => Some((away.norm() - radius, -out)),
        }
    }
}

/// Scaled first: a direction may be given by the tiniest numbers.
fn unit(vector: [f64; 3]) -> Option<Vector3<f64>> {
    let vector = Vector3::from(vector);
    (vector / vector.amax()).try_normalize(0.0)
}

/// A curve with the obstacle to its right.
struct Curve<F, C> {
    range: [f64; 2],
    looks: usize,
    /// It ends in nothing, and so do sharp edges.
    open: bool,
    at: F,
    /// The parameter near another one at which it may turn.
    corner: C,
}

impl<F: Fn(f64) -> Vector2<f64>, C: Fn(f64) -> f64> Curve<F, C> {
    fn see(&self, x: Vector2<f64>) -> Option<(f64, Vector2<f64>)> {
        let [low, high] = self.range;
        let place = |k: usize| low + (high - low) * k as f64 / self.looks as f64;
        let square = |k: &usize| ((self.at)(place(*k)) - x).norm_squared();
        let best = (0..=self.looks).min_by(|a, b| square(a).total_cmp(&square(b)))?;
        let around = [best.saturating_sub(1), (best + 1).min(self.looks)].map(place);
        let size = STEP * (high - low);
        let refined = self.refined(around, x);
        let corner = (self.corner)(refined);
        let squares = [refined, corner].map(|t| (x - (self.at)(t)).norm_squared());
        let at = match (corner - refined).abs() <= 4.0 * size && squares[1] <= squares[0] {
            true => corner,
            false => refined,
        };
        let foot = (self.at)(at);
        let apart = x - foot;
        let length = apart.norm();
        let sides = [
            (at - 2.0 * size).max(low + size),
            (at + 2.0 * size).min(high - size),
        ];
        let normals = sides.map(|t| self.normal(t, size));
        // Of the normals before and behind, the one that points best at x; where x is, the first.
        let aside = normals.map(|normal| normal.perp(&apart).abs());
        let extent = [low, 0.5 * (low + high)].map(|t| ((self.at)(t) - foot).norm());
        let rounded = ASIDE[0] * length + ASIDE[1] * extent[0].max(extent[1]);
        if let Some(k) = (0..2).find(|&k| aside[k] <= rounded) {
            return Some((apart.dot(&normals[k]), -normals[k]));
        }
        let outside = apart.dot(&(normals[0] + normals[1])) >= 0.0;
        let ended = [low, high].iter().any(|end| (at - end).abs() <= 4.0 * size);
        let closed = (self.at)(low) == (self.at)(high);
        let sharp = normals[0].dot(&normals[1]) < SHARP;
        if self.open && ((ended && !closed) || (outside && sharp)) {
            return None;
        }
        let sign = if outside { 1.0 } else { -1.0 };
        Some((sign * length, -apart * (sign / length)))
    }

    /// Where x stops being ahead.
    fn refined(&self, [mut low, mut high]: [f64; 2], x: Vector2<f64>) -> f64 {
        let [first, last] = self.range;
        let size = STEP * (last - first);
        let ahead = |t: f64| {
            let [a, b] = [t - size, t + size].map(|t| (self.at)(t.clamp(first, last)));
            (x - (self.at)(t)).dot(&(b - a)) > 0.0
        };
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            match ahead(middle) {
                true => low = middle,
                false => high = middle,
            }
        }
        0.5 * (low + high)
    }

    /// To the left.
    fn normal(&self, t: f64, size: f64) -> Vector2<f64> {
        let along = (self.at)(t + size) - (self.at)(t - size);
        Vector2::new(-along.y, along.x).normalize()
    }
}

/// In the half-plane through the point, and its mirror image: away from the axis, and along it.
fn turned(apex: Vector3<f64>, axis: Vector3<f64>, outline: Outline, x: Vector3<f64>) -> Seen {
    let arm = x - apex;
    let z = arm.dot(&axis);
    let across = arm - axis * z;
    let s = across.norm();
    if s <= AT_AXIS * x.amax().max(apex.amax()) {
        return Some((z, -axis));
    }
    let far = 2.0 * arm.norm();
    let last = match outline {
        Outline::Cone { .. } | Outline::Paraboloid { .. } => far,
        Outline::Punch { radius, edge } => {
            if s > radius * (1.0 + ASIDE[1]) && z >= -edge {
                return None;
            }
            2.0 * radius + far
        }
    };
    let curve = Curve {
        range: [-last, last],
        looks: 4 * LOOKS,
        open: false,
        at: |t: f64| {
            let half = half(outline, t.abs());
            Vector2::new(half.x * t.signum(), half.y)
        },
        corner: |t: f64| match outline {
            Outline::Punch { radius, edge } if t.abs() > 0.5 * (radius - edge) => {
                let ends = [radius - edge, radius - edge + FRAC_PI_2 * edge];
                let nearer = (t.abs() - ends[0]).abs() > (t.abs() - ends[1]).abs();
                ends[usize::from(nearer)] * t.signum()
            }
            _ => 0.0,
        },
    };
    let (distance, towards) = curve.see(Vector2::new(s, z))?;
    Some((distance, across * (towards.x / s) + axis * towards.y))
}

/// A point of the outline, from the apex on.
fn half(outline: Outline, t: f64) -> Vector2<f64> {
    match outline {
        Outline::Cone { half_angle } => Vector2::new(half_angle.sin(), -half_angle.cos()) * t,
        Outline::Paraboloid { radius } => Vector2::new(t, -t * t / (2.0 * radius)),
        Outline::Punch { radius, edge } => {
            let face = radius - edge;
            let round = FRAC_PI_2 * edge;
            if t <= face {
                Vector2::new(t, 0.0)
            } else if t <= face + round {
                let (sin, cos) = ((t - face) / edge).sin_cos();
                Vector2::new(face + edge * sin, edge * cos - edge)
            } else {
                Vector2::new(radius, face + round - edge - t)
            }
        }
    }
}

/// Around zero; in the plane an ellipse. The share of every axis in a multiplier is found by halving.
fn ellipsoid(radii: [f64; 3], p: Vector3<f64>) -> Seen {
    let axes: Vec<usize> = (0..3).filter(|&k| radii[k].is_finite()).collect();
    let least = axes.iter().map(|&k| radii[k]).fold(f64::INFINITY, f64::min);
    let most = axes.iter().map(|&k| radii[k]).fold(0.0, f64::max);
    let excess = |t: f64| {
        let terms = axes
            .iter()
            .map(|&k| radii[k] * p[k] / (radii[k] * radii[k] + t));
        terms.map(|term| term * term).sum::<f64>() - 1.0
    };
    let [mut low, mut high] = [-least * least, most * p.norm()];
    for _ in 0..4 * HALVINGS {
        let middle = 0.5 * (low + high);
        match excess(middle) > 0.0 {
            true => low = middle,
            false => high = middle,
        }
    }
    let mut out = Vector3::zeros();
    let mut foot = p;
    for &k in &axes {
        out[k] = p[k] / (radii[k] * radii[k] + high);
        foot[k] = radii[k] * radii[k] * out[k];
    }
    let out = out.try_normalize(0.0)?;
    Some(((p - foot).dot(&out), -out))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use std::sync::Arc;

    use super::*;
    use crate::contact::{Profile, Triangulated};

    fn see(obstacle: &Obstacle, x: Vector3<f64>) -> Seen {
        Sight::new(obstacle).see(x)
    }

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

    /// Shapes in space, and in the plane.
    fn shapes() -> Vec<(usize, Obstacle)> {
        let outlines = [
            Outline::Cone { half_angle: 1.4 },
            Outline::Paraboloid { radius: 0.9 },
            Outline::Punch {
                radius: 0.7,
                edge: 0.0,
            },
            Outline::Punch {
                radius: 0.7,
                edge: 0.3,
            },
        ];
        let turned = outlines.into_iter().flat_map(|outline| {
            let of = |axis: [f64; 3]| Obstacle::Turned {
                apex: [0.1, -0.2, 0.0],
                axis,
                outline,
            };
            [(3, of([1.0, 2.0, -0.5])), (2, of([0.3, -1.0, 0.0]))]
        });
        let points = [[-1.0, -0.4], [-0.3, 0.1], [0.4, 0.0], [1.1, -0.6]];
        let profile =
            |smooth| Obstacle::Profile(Arc::new(Profile::new("", &points, smooth).unwrap()));
        let corners = [
            [1.0, 0.1, 0.0],
            [-0.8, 0.9, 0.1],
            [-0.9, -0.8, 0.0],
            [0.9, -1.0, -0.1],
            [0.0, 0.0, 0.4],
        ];
        let triangles = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]];
        let tent = Triangulated::new("", &corners, &triangles).unwrap();
        let radii = [0.9, 0.5, f64::INFINITY];
        let mut shapes: Vec<(usize, Obstacle)> = turned.collect();
        shapes.extend([
            (
                3,
                Obstacle::Ellipsoid {
                    center: [0.1; 3],
                    radii: [0.9, 0.5, 1.3],
                },
            ),
            (
                2,
                Obstacle::Ellipsoid {
                    center: [0.1, 0.0, 0.0],
                    radii,
                },
            ),
            (
                3,
                Obstacle::Bore {
                    center: [0.1; 3],
                    axis: [1.0, 0.0, 1.0],
                    radius: 2.0,
                },
            ),
            (2, profile(false)),
            (2, profile(true)),
            (3, Obstacle::Triangulated(Arc::new(tent))),
        ]);
        shapes
    }

    #[test]
    fn every_shape_is_seen_as_the_contacts_see_it() {
        for (dimension, obstacle) in shapes() {
            let sight = Sight::new(&obstacle);
            let mut met = 0;
            for k in 0..400 {
                let k = f64::from(k);
                let z = if dimension == 3 { (1.3 * k).sin() } else { 0.0 };
                let x = Vector3::new((0.7 * k).cos(), (2.1 * k).sin(), z) * (0.4 + 0.002 * k);
                let Ok(expected) = obstacle.closest("", x.into()) else {
                    // From the middle of an ellipse several points are as near.
                    continue;
                };
                match sight.see(x) {
                    // Deep inside several points may be as near.
                    Some(_) if expected.distance < -0.05 => {}
                    Some((distance, towards)) if !expected.beyond => {
                        met += 1;
                        assert!(
                            (distance - expected.distance).abs() < 1e-9,
                            "{obstacle:?} {x:?} {distance} {expected:?}"
                        );
                        // At a corner itself there are two normals.
                        let turned = (towards - Vector3::from(expected.direction)).norm();
                        assert!(
                            turned < 1e-5 || expected.distance == 0.0,
                            "{obstacle:?} {x:?} {towards:?} {expected:?}"
                        );
                    }
                    seen => assert!(
                        expected.beyond || expected.distance < -0.05,
                        "{obstacle:?} {x:?} {seen:?}"
                    ),
                }
            }
            assert!(met > 50, "{obstacle:?} {met}");
        }
    }
}
