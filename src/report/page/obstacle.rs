//! Rigid obstacles, as the page draws them.

use serde::Serialize;

use crate::contact::Obstacle;

/// A rigid obstacle relative to the scene's origin.
#[derive(Debug, Serialize)]
#[serde(rename_all = "snake_case", untagged)]
pub(super) enum DrawnObstacle {
    /// A plane by its normal, a sphere or circle by its radius, a cylinder by both.
    Shape {
        /// A point of the plane, or the centre.
        point: [f64; 3],
        #[serde(skip_serializing_if = "Option::is_none")]
        direction: Option<[f64; 3]>,
        #[serde(skip_serializing_if = "Option::is_none")]
        radius: Option<f64>,
    },
    /// A curved surface by rows of its points; a line in the plane is a single row.
    Rows { rows: Vec<Vec<[f32; 3]>> },
    /// Triangles by their corners.
    Triangles {
        points: Vec<[f32; 3]>,
        triangles: Vec<[usize; 3]>,
    },
}

impl DrawnObstacle {
    /// As much of it as is near bodies around the origin that reach so far, in metre.
    pub(super) fn new(
        obstacle: &Obstacle,
        (dimension, origin, reach): (usize, [f64; 3], f64),
    ) -> Self {
        let relative = |point: [f64; 3]| [0, 1, 2].map(|axis| point[axis] - origin[axis]);
        let single = |point| relative(point).map(|x| x as f32);
        match obstacle {
            Obstacle::Plane { point, normal } => Self::Shape {
                point: relative(*point),
                direction: Some(*normal),
                radius: None,
            },
            Obstacle::Cylinder {
                center,
                axis,
                radius,
            } => Self::Shape {
                point: relative(*center),
                direction: Some(*axis),
                radius: Some(*radius),
            },
            Obstacle::Sphere { center, radius } => Self::Shape {
                point: relative(*center),
                direction: None,
                radius: Some(*radius),
            },
            Obstacle::Triangulated(surface) => Self::Triangles {
                points: surface.points().map(single).collect(),
                triangles: surface.triangles().to_vec(),
            },
            _ if dimension == 2 => {
                let line = obstacle.section(reach).into_iter();
                let line = line.map(|[x, y]| single([x, y, 0.0]));
                Self::Rows {
                    rows: vec![line.collect()],
                }
            }
            curved => {
                let rows = curved.rows(origin, reach).into_iter();
                Self::Rows {
                    rows: rows
                        .map(|row| row.into_iter().map(single).collect())
                        .collect(),
                }
            }
        }
    }
}
