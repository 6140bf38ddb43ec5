//! Supports: nodes whose displacement is given, component by component.

use serde::{Deserialize, Deserializer, Serialize, de};

use super::field::{SceneTurn, finite};
use super::local_axes::{self, SceneAxis};
use super::{SceneGroup, selection};
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
        group: SceneGroup,
        /// One entry per axis, in the unit of length; `null` leaves the component free.
        displacement: Vec<Option<f64>>,
    },
    /// All nodes of a group, which moves as a rigid body: by `displacement`, and turned about an axis.
    Turned {
        /// Group of cells, facets, edges or points.
        group: SceneGroup,
        /// One entry per axis, in the unit of length; `null` leaves the component free.
        displacement: Vec<Option<f64>>,
        /// A small rotation, of the components that `displacement` gives.
        turn: SceneTurn,
    },
    /// All nodes of a group of facets, along its outward normal, as on an inclined plane of symmetry: at each
    /// node the mean of the facets around it, by area. Across it they are free.
    Normal {
        /// Group of surface facets.
        group: SceneGroup,
        /// Displacement outward, in the unit of length.
        normal: f64,
    },
    /// All nodes of a group, in cylindrical axes.
    Around {
        /// Group of cells, facets, edges or points.
        group: SceneGroup,
        /// The axis; no node of the group is on it.
        axis: SceneAxis,
        /// Radial, around and, in 3D, along the axis, in the unit of length; `null` leaves the component free.
        displacement: Vec<Option<f64>>,
    },
    /// Nodes along a direction; across it they are free.
    Along {
        /// Group of cells, facets, edges or points; this or `at`.
        #[serde(skip_serializing_if = "Option::is_none")]
        group: Option<SceneGroup>,
        /// Position of a node, in the unit of length; this or `group`.
        #[serde(skip_serializing_if = "Option::is_none")]
        at: Option<Vec<f64>>,
        /// The direction, of any length but zero.
        direction: Vec<f64>,
        /// A single entry, in the unit of length.
        displacement: Vec<Option<f64>>,
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
    group: Option<SceneGroup>,
    at: Option<Vec<f64>>,
    displacement: Option<Vec<Option<f64>>>,
    turn: Option<SceneTurn>,
    normal: Option<f64>,
    axis: Option<SceneAxis>,
    direction: Option<Vec<f64>>,
}

/// What the keys of a support may be.
const ACCEPTED: &str = "expected `displacement` with exactly one of `group` and `at`, and beside `group` perhaps \
    `turn` or `axis`, beside either `direction`; or `group` with `normal`";

impl<'de> Deserialize<'de> for SceneSupport {
    fn deserialize<D: Deserializer<'de>>(source: D) -> Result<Self, D::Error> {
        let keys = Keys::deserialize(source)?;
        keys.support().ok_or_else(|| de::Error::custom(ACCEPTED))
    }
}

impl Keys {
    /// The support; none if its keys do not belong together.
    fn support(self) -> Option<SceneSupport> {
        let local = (self.turn, self.normal, self.axis, self.direction);
        let (group, at) = (self.group, self.at);
        let Some(displacement) = self.displacement else {
            return match (group, at, local) {
                (Some(group), None, (None, Some(normal), None, None)) => {
                    Some(SceneSupport::Normal { group, normal })
                }
                _ => None,
            };
        };
        match (group, at, local) {
            (Some(group), None, (None, None, None, None)) => Some(SceneSupport::Group {
                group,
                displacement,
            }),
            (None, Some(at), (None, None, None, None)) => {
                Some(SceneSupport::At { at, displacement })
            }
            (Some(group), None, (Some(turn), None, None, None)) => Some(SceneSupport::Turned {
                group,
                displacement,
                turn,
            }),
            (Some(group), None, (None, None, Some(axis), None)) => Some(SceneSupport::Around {
                group,
                axis,
                displacement,
            }),
            (group, at, (None, None, None, Some(direction))) if group.is_some() != at.is_some() => {
                Some(SceneSupport::Along {
                    group,
                    at,
                    direction,
                    displacement,
                })
            }
            _ => None,
        }
    }
}

impl SceneSupport {
    /// Displacement of the nodes of a group, one entry per axis, in the unit of length; `None` leaves it free.
    #[must_use]
    pub fn of(group: &str, displacement: &[Option<f64>]) -> Self {
        Self::Group {
            group: group.into(),
            displacement: displacement.to_vec(),
        }
    }

    /// A rigid motion of a group: a displacement, one entry per axis, and a small rotation of the components
    /// that it gives.
    #[must_use]
    pub fn turned(group: &str, displacement: &[Option<f64>], turn: SceneTurn) -> Self {
        Self::Turned {
            group: group.into(),
            displacement: displacement.to_vec(),
            turn,
        }
    }

    /// Displacement of a group of facets along its outward normal, in the unit of length.
    #[must_use]
    pub fn normal(group: &str, normal: f64) -> Self {
        Self::Normal {
            group: group.into(),
            normal,
        }
    }

    /// Displacement of a group in cylindrical axes: radial, around and, in 3D, along.
    #[must_use]
    pub fn around(group: &str, axis: SceneAxis, displacement: &[Option<f64>]) -> Self {
        Self::Around {
            group: group.into(),
            axis,
            displacement: displacement.to_vec(),
        }
    }

    /// Displacement of a group along a direction, in the unit of length.
    #[must_use]
    pub fn along(group: &str, direction: &[f64], displacement: f64) -> Self {
        Self::Along {
            group: Some(group.into()),
            at: None,
            direction: direction.to_vec(),
            displacement: vec![Some(displacement)],
        }
    }

    /// The support in the terms of mechanics.
    pub(super) fn resolve(
        &self,
        place: String,
        mesh: &Mesh,
        model: Model,
    ) -> Result<Support, Error> {
        if let Self::Normal { group, normal } = self {
            finite(format!("{place}.normal"), *normal)?;
            let (nodes, axes) = local_axes::normals(&format!("{place}.group"), group, mesh)?;
            return Ok(Support {
                place,
                nodes,
                displacement: [Some(*normal), None, None],
                offsets: Vec::new(),
                axes,
            });
        }
        let nodes = self.nodes(&place, mesh)?;
        let positions = nodes.iter().map(|node| mesh.nodes[*node]);
        let (mut offsets, mut axes) = (Vec::new(), Vec::new());
        match self {
            Self::Turned { turn, .. } => {
                let place = format!("{place}.turn");
                if model == Model::Axisymmetric {
                    return Err(Error::NotAccepted {
                        place,
                        found: "a rotation".to_owned(),
                        accepted: "none, for an axisymmetric body turns about no axis".to_owned(),
                    });
                }
                offsets = turn.resolve(&place, mesh.dimension, positions)?;
            }
            Self::Around { axis, .. } => {
                axes = axis.around(&format!("{place}.axis"), (mesh, model), &nodes)?;
            }
            Self::Along { direction, .. } => {
                let place = format!("{place}.direction");
                axes = local_axes::from_direction(&place, direction, mesh, nodes.len())?;
            }
            _ => {}
        }
        Ok(Support {
            displacement: self.components(&place, mesh.dimension)?,
            place,
            nodes,
            offsets,
            axes,
        })
    }

    /// The supported nodes.
    fn nodes(&self, place: &str, mesh: &Mesh) -> Result<Vec<usize>, Error> {
        match self {
            Self::At { at, .. } | Self::Along { at: Some(at), .. } => {
                let node = selection::node_at(mesh, &format!("{place}.at"), at)?;
                Ok(vec![node])
            }
            Self::Group { group, .. }
            | Self::Turned { group, .. }
            | Self::Normal { group, .. }
            | Self::Around { group, .. }
            | Self::Along {
                group: Some(group), ..
            } => selection::nodes(mesh, &format!("{place}.group"), group),
            Self::Along { .. } => Err(Error::Empty {
                place: format!("{place}.group"),
            }),
        }
    }

    /// The given components.
    fn components(&self, place: &str, dimension: usize) -> Result<[Option<f64>; 3], Error> {
        let (stated, count) = match self {
            Self::Normal { .. } => (&[][..], 1),
            Self::Along { displacement, .. } => (displacement.as_slice(), 1),
            Self::Group { displacement, .. }
            | Self::Turned { displacement, .. }
            | Self::Around { displacement, .. }
            | Self::At { displacement, .. } => (displacement.as_slice(), dimension),
        };
        let at = format!("{place}.displacement");
        check_length(&at, count, stated.len())?;
        let mut displacement = [None; 3];
        displacement[..count].copy_from_slice(stated);
        for (axis, component) in displacement.iter().enumerate() {
            component.map_or(Ok(()), |value| finite(format!("{at}[{axis}]"), value))?;
        }
        if displacement.iter().all(Option::is_none) {
            return Err(Error::NotAccepted {
                place: at,
                found: "null in every component".to_owned(),
                accepted: "at least one number".to_owned(),
            });
        }
        Ok(displacement)
    }
}
