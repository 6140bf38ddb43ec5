//! Rigid surfaces, shape by shape.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::field::is_zero;
use super::mesh_source::{MOST_NODES, MeshSource};
use super::selection::{norm, vector};
use super::{SceneGroup, read, selection};
use crate::contact::{Obstacle, Outline, Profile, Triangulated};
use crate::error::{Error, check_length};
use crate::mesh_file::stl;

/// A rigid surface; vectors have one entry per axis. As the `obstacle` of a contact only `steps` can move it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum SceneObstacle {
    /// Half-space behind a plane (a line in 2D).
    Plane {
        /// A point of the plane, in the unit of length.
        point: Vec<f64>,
        /// Direction out of the obstacle, towards the body; any length but zero.
        normal: Vec<f64>,
    },
    /// Circle, in 2D.
    Circle {
        /// Centre, in the unit of length.
        center: Vec<f64>,
        /// Radius `> 0`, in the unit of length.
        #[cfg_attr(feature = "cli", schemars(extend("exclusiveMinimum" = 0)))]
        radius: f64,
    },
    /// Infinite circular cylinder, in 3D.
    Cylinder {
        /// A point of the axis, in the unit of length.
        center: Vec<f64>,
        /// Direction of the axis; any length but zero.
        axis: Vec<f64>,
        /// Radius `> 0`, in the unit of length.
        #[cfg_attr(feature = "cli", schemars(extend("exclusiveMinimum" = 0)))]
        radius: f64,
    },
    /// Sphere, in 3D.
    Sphere {
        /// Centre, in the unit of length.
        center: Vec<f64>,
        /// Radius `> 0`, in the unit of length.
        #[cfg_attr(feature = "cli", schemars(extend("exclusiveMinimum" = 0)))]
        radius: f64,
    },
    /// The inside of a circle, in 3D of an infinite circular cylinder.
    Bore {
        /// Centre, or a point of the axis, in the unit of length.
        center: Vec<f64>,
        /// Direction of the axis, in 3D; any length but zero.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        axis: Option<Vec<f64>>,
        /// Radius `> 0`, in the unit of length.
        #[cfg_attr(feature = "cli", schemars(extend("exclusiveMinimum" = 0)))]
        radius: f64,
    },
    /// Ellipsoid along the axes; an ellipse in 2D.
    Ellipsoid {
        /// Centre, in the unit of length.
        center: Vec<f64>,
        /// Radius along each axis `> 0`, in the unit of length.
        radii: Vec<f64>,
    },
    /// Cone; a wedge in 2D.
    Cone {
        /// Its point, in the unit of length.
        apex: Vec<f64>,
        /// Direction of the axis out of the cone, towards the body; any length but zero.
        axis: Vec<f64>,
        /// Half of the angle at the apex, in degrees, between 0 and 90.
        #[cfg_attr(feature = "cli", schemars(extend("exclusiveMinimum" = 0, "exclusiveMaximum" = 90)))]
        half_angle: f64,
    },
    /// Paraboloid; a parabola in 2D.
    Paraboloid {
        /// Its point on the axis, in the unit of length.
        apex: Vec<f64>,
        /// Direction of the axis out of the paraboloid, towards the body; any length but zero.
        axis: Vec<f64>,
        /// Radius of curvature at the apex `> 0`, in the unit of length.
        #[cfg_attr(feature = "cli", schemars(extend("exclusiveMinimum" = 0)))]
        radius: f64,
    },
    /// Flat round punch with walls; a strip in 2D. Nothing touches it beyond its edge.
    Punch {
        /// Centre of the face, in the unit of length.
        center: Vec<f64>,
        /// Direction of the axis out of the face, towards the body; any length but zero.
        axis: Vec<f64>,
        /// Radius, in 2D half of the width, `> 0`, in the unit of length.
        #[cfg_attr(feature = "cli", schemars(extend("exclusiveMinimum" = 0)))]
        radius: f64,
        /// Radius of the rounded edge, from 0 (sharp) to the radius; 0 when left out.
        #[cfg_attr(feature = "cli", schemars(range(min = 0)))]
        #[serde(default, skip_serializing_if = "is_zero")]
        edge: f64,
    },
    /// A curve in 2D, with the body to the left of the way along it; closed if the last point is the first.
    Profile {
        /// Its points in order, in the unit of length.
        #[cfg_attr(feature = "cli", schemars(length(min = 2)))]
        points: Vec<[f64; 2]>,
        /// A smooth curve through the points; straight from point to point when left out.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        smooth: bool,
    },
    /// Triangles in 3D, counterclockwise seen from the body.
    Triangles {
        /// An STL file, ASCII or binary, or with `group` a Gmsh file; relative to the scene's folder.
        file: PathBuf,
        /// Group of surface facets of the Gmsh file; their corners count.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        group: Option<SceneGroup>,
        /// Factor on all positions `> 0`; 1 when left out.
        #[cfg_attr(feature = "cli", schemars(extend("exclusiveMinimum" = 0)))]
        #[serde(default, skip_serializing_if = "Option::is_none")]
        scale: Option<f64>,
    },
}

impl SceneObstacle {
    /// The half-space behind a plane through a point, in the unit of length; `normal` points to the body.
    #[must_use]
    pub fn plane(point: &[f64], normal: &[f64]) -> Self {
        Self::Plane {
            point: point.to_vec(),
            normal: normal.to_vec(),
        }
    }

    /// The shape's key, and the dimension that it lives in; none if in both.
    fn kind(&self) -> (&'static str, Option<usize>) {
        match self {
            Self::Plane { .. } => ("plane", None),
            Self::Circle { .. } => ("circle", Some(2)),
            Self::Cylinder { .. } => ("cylinder", Some(3)),
            Self::Sphere { .. } => ("sphere", Some(3)),
            Self::Bore { .. } => ("bore", None),
            Self::Ellipsoid { .. } => ("ellipsoid", None),
            Self::Cone { .. } => ("cone", None),
            Self::Paraboloid { .. } => ("paraboloid", None),
            Self::Punch { .. } => ("punch", None),
            Self::Profile { .. } => ("profile", Some(2)),
            Self::Triangles { .. } => ("triangles", Some(3)),
        }
    }

    /// The shape in the terms of mechanics; files are relative to `folder`.
    pub(super) fn resolve(
        &self,
        place: &str,
        folder: &Path,
        dimension: usize,
    ) -> Result<Obstacle, Error> {
        let (kind, lives_in) = self.kind();
        if lives_in.is_some_and(|lives_in| lives_in != dimension) {
            return Err(elsewhere(place, kind, dimension));
        }
        let shape = Shape {
            place: format!("{place}.{kind}"),
            dimension,
        };
        match self {
            Self::Plane { point, normal } => shape.plane(point, normal),
            Self::Circle { center, radius } => shape.circle(center, *radius),
            Self::Cylinder {
                center,
                axis,
                radius,
            } => shape.cylinder(center, axis, *radius),
            Self::Sphere { center, radius } => shape.sphere(center, *radius),
            Self::Bore {
                center,
                axis,
                radius,
            } => shape.bore(center, axis.as_deref(), *radius),
            Self::Ellipsoid { center, radii } => shape.ellipsoid(center, radii),
            Self::Cone {
                apex,
                axis,
                half_angle,
            } => shape.cone(apex, axis, *half_angle),
            Self::Paraboloid { apex, axis, radius } => shape.paraboloid(apex, axis, *radius),
            Self::Punch {
                center,
                axis,
                radius,
                edge,
            } => shape.punch(center, axis, [*radius, *edge]),
            Self::Profile { points, smooth } => shape.profile(points, *smooth),
            Self::Triangles { file, group, scale } => {
                shape.triangles([folder, file], group.as_ref(), *scale)
            }
        }
    }
}

/// A shape that lives in another space.
fn elsewhere(place: &str, kind: &str, dimension: usize) -> Error {
    let accepted = match dimension {
        2 => "plane, circle, bore, ellipsoid, cone, paraboloid, punch or profile for a body in 2D",
        _ => {
            "plane, cylinder, sphere, bore, ellipsoid, cone, paraboloid, punch or triangles for a body in 3D"
        }
    };
    Error::NotAccepted {
        place: place.to_owned(),
        found: format!("a {kind}"),
        accepted: accepted.to_owned(),
    }
}

/// Where a shape is stated, and the axes that it has.
struct Shape {
    place: String,
    dimension: usize,
}

impl Shape {
    fn at(&self, field: &str) -> String {
        format!("{}.{field}", self.place)
    }

    fn point(&self, field: &str, values: &[f64]) -> Result<[f64; 3], Error> {
        vector(&self.at(field), values, self.dimension)
    }

    fn direction(&self, field: &str, values: &[f64]) -> Result<[f64; 3], Error> {
        let place = self.at(field);
        let direction = vector(&place, values, self.dimension)?;
        if norm(direction) > 0.0 {
            return Ok(direction);
        }
        Err(Error::NotAccepted {
            place,
            found: format!("{values:?}"),
            accepted: "a direction of any length but zero".to_owned(),
        })
    }

    fn radius(&self, radius: f64) -> Result<f64, Error> {
        positive(self.at("radius"), radius, "0 < radius < infinity")
    }

    fn plane(&self, point: &[f64], normal: &[f64]) -> Result<Obstacle, Error> {
        Ok(Obstacle::Plane {
            point: self.point("point", point)?,
            normal: self.direction("normal", normal)?,
        })
    }

    fn circle(&self, center: &[f64], radius: f64) -> Result<Obstacle, Error> {
        Ok(Obstacle::Cylinder {
            center: self.point("center", center)?,
            axis: [0.0, 0.0, 1.0],
            radius: self.radius(radius)?,
        })
    }

    fn cylinder(&self, center: &[f64], axis: &[f64], radius: f64) -> Result<Obstacle, Error> {
        Ok(Obstacle::Cylinder {
            center: self.point("center", center)?,
            axis: self.direction("axis", axis)?,
            radius: self.radius(radius)?,
        })
    }

    fn sphere(&self, center: &[f64], radius: f64) -> Result<Obstacle, Error> {
        Ok(Obstacle::Sphere {
            center: self.point("center", center)?,
            radius: self.radius(radius)?,
        })
    }

    fn bore(&self, center: &[f64], axis: Option<&[f64]>, radius: f64) -> Result<Obstacle, Error> {
        Ok(Obstacle::Bore {
            center: self.point("center", center)?,
            axis: match (axis, self.dimension) {
                (None, 2) => [0.0, 0.0, 1.0],
                (Some(axis), 3) => self.direction("axis", axis)?,
                (stated, _) => {
                    return Err(Error::NotAccepted {
                        place: self.at("axis"),
                        found: if stated.is_some() {
                            "an axis"
                        } else {
                            "no axis"
                        }
                        .to_owned(),
                        accepted: "an axis for a body in 3D, none in 2D".to_owned(),
                    });
                }
            },
            radius: self.radius(radius)?,
        })
    }

    /// Infinite along z in 2D.
    fn ellipsoid(&self, center: &[f64], stated: &[f64]) -> Result<Obstacle, Error> {
        let place = self.at("radii");
        check_length(&place, self.dimension, stated.len())?;
        let mut radii = [f64::INFINITY; 3];
        for (at, (radius, &stated)) in radii.iter_mut().zip(stated).enumerate() {
            *radius = positive(format!("{place}[{at}]"), stated, "0 < radius < infinity")?;
        }
        Ok(Obstacle::Ellipsoid {
            center: self.point("center", center)?,
            radii,
        })
    }

    fn turned(&self, apex: [f64; 3], axis: &[f64], outline: Outline) -> Result<Obstacle, Error> {
        outline.check(&self.place)?;
        let axis = self.direction("axis", axis)?;
        Ok(Obstacle::Turned {
            apex,
            axis,
            outline,
        })
    }

    fn cone(&self, apex: &[f64], axis: &[f64], degrees: f64) -> Result<Obstacle, Error> {
        let half_angle = degrees.to_radians();
        self.turned(
            self.point("apex", apex)?,
            axis,
            Outline::Cone { half_angle },
        )
    }

    fn paraboloid(&self, apex: &[f64], axis: &[f64], radius: f64) -> Result<Obstacle, Error> {
        self.turned(
            self.point("apex", apex)?,
            axis,
            Outline::Paraboloid { radius },
        )
    }

    fn punch(
        &self,
        center: &[f64],
        axis: &[f64],
        [radius, edge]: [f64; 2],
    ) -> Result<Obstacle, Error> {
        self.turned(
            self.point("center", center)?,
            axis,
            Outline::Punch { radius, edge },
        )
    }

    fn profile(&self, points: &[[f64; 2]], smooth: bool) -> Result<Obstacle, Error> {
        let profile = Profile::new(&self.at("points"), points, smooth)?;
        Ok(Obstacle::Profile(Arc::new(profile)))
    }

    fn triangles(
        &self,
        [folder, file]: [&Path; 2],
        group: Option<&SceneGroup>,
        scale: Option<f64>,
    ) -> Result<Obstacle, Error> {
        let scale = positive(
            self.at("scale"),
            scale.unwrap_or(1.0),
            "0 < scale < infinity",
        )?;
        let surface = match group {
            Some(group) => self.of_mesh([folder, file], group, scale)?,
            None => self.of_stl([folder, file], scale)?,
        };
        Ok(Obstacle::Triangulated(Arc::new(surface)))
    }

    /// Triangles of an STL file.
    fn of_stl(&self, [folder, file]: [&Path; 2], scale: f64) -> Result<Triangulated, Error> {
        let place = self.at("file");
        let bytes = read(&place, &folder.join(file))?;
        let corners = stl::corners(&format!("{place} `{}`", file.display()), &bytes)?;
        let points: Vec<[f64; 3]> = corners.iter().map(|x| x.map(|x| x * scale)).collect();
        let triangles = (0..points.len() / 3).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]);
        Triangulated::new(&place, &points, &triangles.collect::<Vec<_>>())
    }

    /// Triangles of a group of facets of a mesh file.
    fn of_mesh(
        &self,
        [folder, file]: [&Path; 2],
        group: &SceneGroup,
        scale: f64,
    ) -> Result<Triangulated, Error> {
        let source = MeshSource::File {
            file: file.to_owned(),
            scale,
            groups: Vec::new(),
            split: None,
        };
        let mesh = source.mesh(&self.place, folder, MOST_NODES)?;
        if mesh.dimension != 3 {
            return Err(Error::NotAccepted {
                place: self.at("file"),
                found: "a mesh in 2D".to_owned(),
                accepted: "a mesh in 3D, with a group of its surface".to_owned(),
            });
        }
        let place = self.at("group");
        let facets = selection::facets(&mesh, &place, group)?;
        let triangles = facets.iter().flat_map(|facet| {
            let corners = facet.corners(3).to_vec();
            (2..corners.len()).map(move |k| [corners[0], corners[k - 1], corners[k]])
        });
        Triangulated::new(&place, &mesh.nodes, &triangles.collect::<Vec<_>>())
    }
}

fn positive(place: String, value: f64, accepted: &'static str) -> Result<f64, Error> {
    if value > 0.0 && value.is_finite() {
        return Ok(value);
    }
    Err(Error::OutOfRange {
        place,
        value,
        accepted,
    })
}
