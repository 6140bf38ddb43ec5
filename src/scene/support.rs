//! Supports: nodes whose displacement is given, component by component.

use serde::{Deserialize, Deserializer, Serialize, de};

use super::field::SceneTurn;
use super::selection;
use crate::body::{Mesh, Model, Support};
use crate::error::{Error, check_length};

/// Nodes whose displacement is given; `null` leaves a component free.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "cli", schemars(untagged, deny_unknown_fields))]
#[serde(untagged)]
pub enum SceneSupport {
    /// All nodes of a group.
    Group {
        /// Group of cells, facets, edges or points.
        group: String,
        /// One entry per axis, in the unit of length; `null` leaves the component free.
        displacement: Vec<Option<f64>>,
    },
    /// All nodes of a group, which moves as a rigid body: by `displacement`, and turned about an axis.
    Turned {
        /// Group of cells, facets, edges or points.
        group: String,
        /// One entry per axis, in the unit of length; `null` leaves the component free.
        displacement: Vec<Option<f64>>,
        /// A small rotation, of the components that `displacement` gives.
        turn: SceneTurn,
    },
    /// One node.
    At {
        /// Position of the node, in the unit of length.
        at: Vec<f64>,
        /// One entry per axis, in the unit of length; `null` leaves the component free.
        displacement: Vec<Option<f64>>,
    },
}

/// The keys of a support in JSON.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a support")]
struct Keys {
    group: Option<String>,
    at: Option<Vec<f64>>,
    displacement: Vec<Option<f64>>,
    turn: Option<SceneTurn>,
}

impl<'de> Deserialize<'de> for SceneSupport {
    fn deserialize<D: Deserializer<'de>>(source: D) -> Result<Self, D::Error> {
        let keys = Keys::deserialize(source)?;
        let displacement = keys.displacement;
        match (keys.group, keys.at, keys.turn) {
            (Some(group), None, None) => Ok(Self::Group {
                group,
                displacement,
            }),
            (Some(group), None, Some(turn)) => Ok(Self::Turned {
                group,
                displacement,
                turn,
            }),
            (None, Some(at), None) => Ok(Self::At { at, displacement }),
            (_, _, None) => Err(de::Error::custom(
                "expected exactly one of `group` and `at`, beside `displacement`",
            )),
            (_, _, Some(_)) => Err(de::Error::custom(
                "expected `group` and `displacement` beside `turn`",
            )),
        }
    }
}

impl SceneSupport {
    /// Displacement of the nodes of a group, one entry per axis, in the unit of length; `None` leaves it free.
    #[must_use]
    pub fn of(group: &str, displacement: &[Option<f64>]) -> Self {
        Self::Group {
            group: group.to_owned(),
            displacement: displacement.to_vec(),
        }
    }

    /// A rigid motion of a group: a displacement, one entry per axis, and a small rotation of the components
    /// that it gives.
    #[must_use]
    pub fn turned(group: &str, displacement: &[Option<f64>], turn: SceneTurn) -> Self {
        Self::Turned {
            group: group.to_owned(),
            displacement: displacement.to_vec(),
            turn,
        }
    }

    /// The support in the terms of mechanics.
    pub(super) fn resolve(
        &self,
        place: String,
        mesh: &Mesh,
        model: Model,
    ) -> Result<Support, Error> {
        let (nodes, stated) = match self {
            Self::Group {
                group,
                displacement,
            }
            | Self::Turned {
                group,
                displacement,
                ..
            } => {
                let place = format!("{place}.group");
                (selection::nodes(mesh, &place, group)?, displacement)
            }
            Self::At { at, displacement } => {
                let place = format!("{place}.at");
                (vec![selection::node_at(mesh, &place, at)?], displacement)
            }
        };
        let at = format!("{place}.displacement");
        check_length(&at, mesh.dimension, stated.len())?;
        let mut displacement = [None; 3];
        displacement[..stated.len()].copy_from_slice(stated);
        for (axis, component) in displacement.iter().enumerate() {
            match component {
                Some(value) if !value.is_finite() => {
                    return Err(Error::NotFinite {
                        place: format!("{at}[{axis}]"),
                        value: *value,
                    });
                }
                _ => {}
            }
        }
        if displacement.iter().all(Option::is_none) {
            return Err(Error::NotAccepted {
                place: at,
                found: "null in every component".to_owned(),
                accepted: "at least one number".to_owned(),
            });
        }
        let offsets = match self {
            Self::Turned { turn, .. } => {
                let place = format!("{place}.turn");
                if model == Model::Axisymmetric {
                    return Err(Error::NotAccepted {
                        place,
                        found: "a rotation".to_owned(),
                        accepted: "none, for an axisymmetric body turns about no axis".to_owned(),
                    });
                }
                let positions = nodes.iter().map(|node| mesh.nodes[*node]);
                turn.resolve(&place, mesh.dimension, positions)?
            }
            _ => Vec::new(),
        };
        Ok(Support {
            place,
            nodes,
            displacement,
            offsets,
        })
    }
}
