//! Loads: pressure, traction, body force and point force.

use serde::{Deserialize, Deserializer, Serialize, de};

use super::selection;
use super::selection::vector;
use crate::body::{Load, Mesh};
use crate::error::Error;

/// A given force on a body.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "cli", schemars(untagged, deny_unknown_fields))]
#[serde(untagged)]
pub enum SceneLoad {
    /// Force per area along the inward normal.
    Pressure {
        /// Positive presses, in force per area.
        pressure: f64,
        /// Group of surface facets.
        group: String,
    },
    /// Force per area.
    Traction {
        /// In global axes, one entry per axis, in force per area.
        traction: Vec<f64>,
        /// Group of surface facets.
        group: String,
    },
    /// Force per volume.
    BodyForce {
        /// In global axes, one entry per axis, in force per volume.
        body_force: Vec<f64>,
        /// Group of cells; all cells when left out.
        #[serde(skip_serializing_if = "Option::is_none")]
        group: Option<String>,
    },
    /// Force at a node.
    PointForce {
        /// In global axes, one entry per axis, in the unit of force (plane strain: per unit of depth).
        point_force: Vec<f64>,
        /// Position of the node, in the unit of length.
        at: Vec<f64>,
    },
}

/// The keys of a load in JSON; which of them stand there tells the kind.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a load")]
struct Keys {
    pressure: Option<f64>,
    traction: Option<Vec<f64>>,
    body_force: Option<Vec<f64>>,
    point_force: Option<Vec<f64>>,
    group: Option<String>,
    at: Option<Vec<f64>>,
}

impl<'de> Deserialize<'de> for SceneLoad {
    fn deserialize<D: Deserializer<'de>>(source: D) -> Result<Self, D::Error> {
        let keys = Keys::deserialize(source)?;
        let kinds = (
            keys.pressure,
            keys.traction,
            keys.body_force,
            keys.point_force,
        );
        match (kinds, keys.group, keys.at) {
            ((Some(pressure), None, None, None), Some(group), None) => {
                Ok(Self::Pressure { pressure, group })
            }
            ((None, Some(traction), None, None), Some(group), None) => {
                Ok(Self::Traction { traction, group })
            }
            ((None, None, Some(body_force), None), group, None) => {
                Ok(Self::BodyForce { body_force, group })
            }
            ((None, None, None, Some(point_force)), None, Some(at)) => {
                Ok(Self::PointForce { point_force, at })
            }
            _ => Err(de::Error::custom(
                "expected exactly one of `pressure` with `group`, `traction` with `group`, \
                 `body_force` with or without `group`, and `point_force` with `at`",
            )),
        }
    }
}

impl SceneLoad {
    /// Pressure on a group of facets, in force per area; positive into the body.
    #[must_use]
    pub fn pressure(group: &str, pressure: f64) -> Self {
        Self::Pressure {
            pressure,
            group: group.to_owned(),
        }
    }

    /// Force per area on a group of facets, one entry per axis.
    #[must_use]
    pub fn traction(group: &str, traction: &[f64]) -> Self {
        Self::Traction {
            traction: traction.to_vec(),
            group: group.to_owned(),
        }
    }

    /// Force per volume on all cells, one entry per axis.
    #[must_use]
    pub fn body_force(body_force: &[f64]) -> Self {
        Self::BodyForce {
            body_force: body_force.to_vec(),
            group: None,
        }
    }

    /// The load in the terms of mechanics.
    pub(super) fn resolve(&self, place: &str, mesh: &Mesh) -> Result<Load, Error> {
        let of_group = format!("{place}.group");
        match self {
            Self::Pressure { pressure, group } => {
                if !pressure.is_finite() {
                    return Err(Error::NotFinite {
                        place: format!("{place}.pressure"),
                        value: *pressure,
                    });
                }
                Ok(Load::Pressure {
                    facets: selection::facets(mesh, &of_group, group)?,
                    pressure: *pressure,
                })
            }
            Self::Traction { traction, group } => Ok(Load::Traction {
                traction: vector(&format!("{place}.traction"), traction, mesh.dimension)?,
                facets: selection::facets(mesh, &of_group, group)?,
            }),
            Self::BodyForce { body_force, group } => Ok(Load::BodyForce {
                density: vector(&format!("{place}.body_force"), body_force, mesh.dimension)?,
                cells: match group {
                    None => (0..mesh.cell_count()).collect(),
                    Some(group) => selection::cells(mesh, &of_group, group)?.to_vec(),
                },
            }),
            Self::PointForce { point_force, at } => Ok(Load::PointForce {
                force: vector(&format!("{place}.point_force"), point_force, mesh.dimension)?,
                node: selection::node_at(mesh, &format!("{place}.at"), at)?,
            }),
        }
    }
}
