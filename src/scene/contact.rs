//! Contacts: a part of a body's surface, what it may touch, and friction.

use serde::{Deserialize, Serialize};

use super::field::{finite, is_zero};
use super::selection::{norm, vector};
use super::{selection, spelling};
use crate::body::Body;
use crate::contact::{ContactPair, Obstacle, Opposite};
use crate::error::Error;

/// A part of a body's surface that may touch a rigid obstacle or another surface.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, expecting = "a contact")]
pub struct SceneContact {
    /// Group of surface facets; it need only contain the true contact. Of two
    /// surfaces the one carries the contacts that has fewer facets on which the other one ends, this one if
    /// they are equal in that; but never one that is more than a hundred times as stiff.
    pub group: String,
    /// Name of the body; may be left out while there is only one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub body: Option<String>,
    /// The rigid obstacle that the surface may touch; this or `against`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub obstacle: Option<SceneObstacle>,
    /// The other surface that it may touch; this or `obstacle`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub against: Option<SceneSurface>,
    /// Coefficient of friction, `μ ≥ 0`; 0 is frictionless.
    #[cfg_attr(feature = "cli", schemars(range(min = 0)))]
    pub friction: f64,
    /// Gaps are measured between the smooth surfaces that straight facets stand for, as the turns
    /// between these say; `false`: between the facets. Left out, they are rounded.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rounded: Option<bool>,
    /// Length added to all gaps of the contact before loading: clearance if positive, interference if
    /// negative; 0 when left out. Meshes may be drawn touching.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub gap: f64,
}

/// The opposite surface of a contact between two bodies, or across a crack in one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, expecting = "a surface")]
pub struct SceneSurface {
    /// Name of the body; may be left out while there is only one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub body: Option<String>,
    /// Group of surface facets.
    pub group: String,
}

/// A rigid body, which only `steps` can move; vectors have one entry per axis.
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
}

impl SceneContact {
    /// A group of surface facets of the only body, which may touch an obstacle with this friction.
    #[must_use]
    pub fn on(obstacle: SceneObstacle, group: &str, friction: f64) -> Self {
        Self {
            group: group.to_owned(),
            obstacle: Some(obstacle),
            friction,
            ..Self::default()
        }
    }

    /// Surfaces of two bodies, or of one, which may touch each other with this friction; each is
    /// `[body, group]`.
    #[must_use]
    pub fn between(own: [&str; 2], other: [&str; 2], friction: f64) -> Self {
        Self {
            group: own[1].to_owned(),
            body: Some(own[0].to_owned()),
            against: Some(SceneSurface {
                body: Some(other[0].to_owned()),
                group: other[1].to_owned(),
            }),
            friction,
            ..Self::default()
        }
    }

    /// The same for a surface of the body of this name.
    #[must_use]
    pub fn of(mut self, body: &str) -> Self {
        self.body = Some(body.to_owned());
        self
    }

    /// The same with a length added to all gaps before loading: clearance if positive, interference if
    /// negative.
    #[must_use]
    pub fn with_gap(mut self, gap: f64) -> Self {
        self.gap = gap;
        self
    }

    /// The contact in the terms of mechanics.
    pub(super) fn resolve(&self, place: &str, bodies: &[Body]) -> Result<ContactPair, Error> {
        let body = find_body(&format!("{place}.body"), self.body.as_deref(), bodies)?;
        if !(self.friction >= 0.0 && self.friction.is_finite()) {
            return Err(Error::OutOfRange {
                place: format!("{place}.friction"),
                value: self.friction,
                accepted: "0 <= friction < infinity",
            });
        }
        finite(format!("{place}.gap"), self.gap)?;
        let mesh = &bodies[body].mesh;
        let opposite = match (&self.obstacle, &self.against) {
            (Some(obstacle), None) => {
                let place = format!("{place}.obstacle");
                Opposite::Obstacle(obstacle.resolve(&place, mesh.dimension)?)
            }
            (None, Some(surface)) => surface.resolve(&format!("{place}.against"), bodies)?,
            (given, _) => {
                return Err(Error::NotAccepted {
                    place: place.to_owned(),
                    found: match given {
                        Some(_) => "both `obstacle` and `against`".to_owned(),
                        None => "neither `obstacle` nor `against`".to_owned(),
                    },
                    accepted: "one of the two".to_owned(),
                });
            }
        };
        Ok(ContactPair {
            place: place.to_owned(),
            body,
            facets: selection::facets(mesh, &format!("{place}.group"), &self.group)?,
            opposite,
            friction: self.friction,
            rounded: self.rounded.unwrap_or(true),
            gap: self.gap,
        })
    }
}

impl SceneSurface {
    fn resolve(&self, place: &str, bodies: &[Body]) -> Result<Opposite, Error> {
        let body = find_body(&format!("{place}.body"), self.body.as_deref(), bodies)?;
        let mesh = &bodies[body].mesh;
        let facets = selection::facets(mesh, &format!("{place}.group"), &self.group)?;
        Ok(Opposite::Surface { body, facets })
    }
}

/// Index of a body by its name, which may be left out while there is only one.
fn find_body(place: &str, name: Option<&str>, bodies: &[Body]) -> Result<usize, Error> {
    let known = || bodies.iter().map(|body| body.name.as_str());
    match (name, bodies) {
        (None, [_]) => Ok(0),
        (None, _) => Err(Error::NotAccepted {
            place: place.to_owned(),
            found: "no name".to_owned(),
            accepted: format!(
                "the name of one of the bodies: {}",
                known().collect::<Vec<_>>().join(", ")
            ),
        }),
        (Some(name), _) => {
            known()
                .position(|known| known == name)
                .ok_or_else(|| Error::UnknownName {
                    place: place.to_owned(),
                    what: "body",
                    nearest: spelling::nearest(name, known()).map(str::to_owned),
                    name: name.to_owned(),
                    known: known().map(str::to_owned).collect(),
                })
        }
    }
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

    fn resolve(&self, place: &str, dimension: usize) -> Result<Obstacle, Error> {
        let (kind, lives_in) = match self {
            Self::Plane { .. } => ("plane", dimension),
            Self::Circle { .. } => ("circle", 2),
            Self::Cylinder { .. } => ("cylinder", 3),
            Self::Sphere { .. } => ("sphere", 3),
        };
        if lives_in != dimension {
            return Err(Error::NotAccepted {
                place: place.to_owned(),
                found: format!("a {kind}"),
                accepted: match dimension {
                    2 => "plane or circle for a body in 2D".to_owned(),
                    _ => "plane, cylinder or sphere for a body in 3D".to_owned(),
                },
            });
        }
        let at = |field: &str| format!("{place}.{kind}.{field}");
        let point = |field, values: &[f64]| vector(&at(field), values, dimension);
        Ok(match self {
            Self::Plane { point: on, normal } => Obstacle::Plane {
                point: point("point", on)?,
                normal: direction(&at("normal"), normal, dimension)?,
            },
            Self::Circle { center, radius } => Obstacle::Cylinder {
                center: point("center", center)?,
                axis: [0.0, 0.0, 1.0],
                radius: positive(at("radius"), *radius)?,
            },
            Self::Cylinder {
                center,
                axis,
                radius,
            } => Obstacle::Cylinder {
                center: point("center", center)?,
                axis: direction(&at("axis"), axis, dimension)?,
                radius: positive(at("radius"), *radius)?,
            },
            Self::Sphere { center, radius } => Obstacle::Sphere {
                center: point("center", center)?,
                radius: positive(at("radius"), *radius)?,
            },
        })
    }
}

fn positive(place: String, radius: f64) -> Result<f64, Error> {
    if radius > 0.0 && radius.is_finite() {
        return Ok(radius);
    }
    Err(Error::OutOfRange {
        place,
        value: radius,
        accepted: "0 < radius < infinity",
    })
}

fn direction(place: &str, values: &[f64], dimension: usize) -> Result<[f64; 3], Error> {
    let direction = vector(place, values, dimension)?;
    if norm(direction) > 0.0 {
        return Ok(direction);
    }
    Err(Error::NotAccepted {
        place: place.to_owned(),
        found: format!("{values:?}"),
        accepted: "a direction of any length but zero".to_owned(),
    })
}
