//! Rows of points of an obstacle's surface in space, for pictures.

use std::f64::consts::{PI, TAU};

use nalgebra::Vector3;

use super::Obstacle;

/// Pieces around an axis, and from pole to pole.
const AROUND: usize = 48;

impl Obstacle {
    /// Rows of equally many points of a curved surface around `middle`, as far as `reach`, in metre; none of planes,
    /// spheres, cylinders and triangles, which are drawn as what they are, and of curves in the plane.
    #[must_use]
    pub(crate) fn rows(&self, middle: [f64; 3], reach: f64) -> Vec<Vec<[f64; 3]>> {
        match self {
            Self::Bore {
                center,
                axis,
                radius,
            } => {
                let (center, axis) = (Vector3::from(*center), unit(*axis));
                let along = axis.dot(&(Vector3::from(middle) - center));
                let ends = [along - reach, along + reach].map(|z| [*radius, z]);
                turned(center, axis, &ends)
            }
            Self::Turned {
                apex,
                axis,
                outline,
            } => turned(Vector3::from(*apex), unit(*axis), &outline.half(reach)),
            Self::Ellipsoid { center, radii } if radii[2].is_finite() => {
                let row = |k: usize| {
                    let (across, z) = (PI * k as f64 / (AROUND / 2) as f64).sin_cos();
                    circle().map(move |[x, y]| {
                        let on = [across * x, across * y, z];
                        [0, 1, 2].map(|axis| center[axis] + radii[axis] * on[axis])
                    })
                };
                (0..=AROUND / 2).map(|k| row(k).collect()).collect()
            }
            _ => Vec::new(),
        }
    }
}

/// Points (s, z) turned about an axis through a point.
fn turned(center: Vector3<f64>, axis: Vector3<f64>, half: &[[f64; 2]]) -> Vec<Vec<[f64; 3]>> {
    let mut least = Vector3::zeros();
    least[axis.abs().imin()] = 1.0;
    let first = axis.cross(&least).normalize();
    let second = axis.cross(&first);
    let row = |&[s, z]: &[f64; 2]| {
        let at = circle().map(|[x, y]| center + axis * z + (first * x + second * y) * s);
        at.map(Into::into).collect()
    };
    half.iter().map(row).collect()
}

/// A unit circle, its first point again at the end.
fn circle() -> impl Iterator<Item = [f64; 2]> {
    let angles = (0..=AROUND).map(|k| TAU * k as f64 / AROUND as f64);
    angles.map(|angle| [angle.cos(), angle.sin()])
}

/// Scaled first: an axis may be given by the tiniest numbers.
fn unit(axis: [f64; 3]) -> Vector3<f64> {
    let axis = Vector3::from(axis);
    (axis / axis.amax()).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::Outline;

    #[test]
    fn every_point_of_the_rows_is_on_the_surface() {
        let axis = [1.0, -2.0, 0.5];
        let apex = [0.3, 0.1, -0.2];
        let turned = [
            Outline::Cone { half_angle: 1.2 },
            Outline::Paraboloid { radius: 0.7 },
            Outline::Punch {
                radius: 0.8,
                edge: 0.2,
            },
        ];
        let mut shapes: Vec<Obstacle> = turned
            .map(|outline| Obstacle::Turned {
                apex,
                axis,
                outline,
            })
            .to_vec();
        shapes.push(Obstacle::Bore {
            center: apex,
            axis,
            radius: 1.5,
        });
        shapes.push(Obstacle::Ellipsoid {
            center: apex,
            radii: [0.5, 1.0, 2.0],
        });
        for shape in shapes {
            let rows = shape.rows([0.0; 3], 2.0);
            assert!(rows.iter().all(|row| row.len() == AROUND + 1));
            let mut seen = 0;
            for point in rows.iter().flatten() {
                let Ok(closest) = shape.closest("", *point) else {
                    continue;
                };
                seen += 1;
                assert!(closest.distance.abs() < 1e-9, "{shape:?} {point:?}");
            }
            assert!(seen > AROUND, "{shape:?}");
        }
        let plane = Obstacle::Plane {
            point: apex,
            normal: axis,
        };
        assert!(plane.rows([0.0; 3], 2.0).is_empty());
    }
}
