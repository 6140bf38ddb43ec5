//! Springs to the ground: an elastic foundation under a surface, or springs at nodes.

use serde::{Deserialize, Serialize};

use super::field::{finite, is_zero};
use super::{SceneGroup, selection};
use crate::body::{Foundation, Ground, Group, Mesh};
use crate::error::{Error, check_length};

/// Springs that hold a body to the ground, which does not move.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(
    deny_unknown_fields,
    expecting = "an object with group or at, and normal or stiffness"
)]
pub struct SceneFoundation {
    /// Group of surface facets, under which springs are spread, or of points, each with one; this or `at`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub group: Option<SceneGroup>,
    /// Position of a node, in the unit of length; this or `group`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<Vec<f64>>,
    /// Stiffness along the normal of facets `≥ 0`, in force per length and area; 0 when left out.
    #[cfg_attr(feature = "cli", schemars(range(min = 0)))]
    #[serde(default, skip_serializing_if = "is_zero")]
    pub normal: f64,
    /// Stiffness along each axis `≥ 0`: in force per length and area under facets, in force per length at
    /// a node; none when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stiffness: Option<Vec<f64>>,
}

impl SceneFoundation {
    /// Springs along the normal of a group of facets, in force per length and area.
    #[must_use]
    pub fn under(group: &str, normal: f64) -> Self {
        Self {
            group: Some(group.into()),
            normal,
            ..Self::default()
        }
    }

    /// A spring along each axis at a node, in force per length.
    #[must_use]
    pub fn at(position: &[f64], stiffness: &[f64]) -> Self {
        Self {
            at: Some(position.to_vec()),
            stiffness: Some(stiffness.to_vec()),
            ..Self::default()
        }
    }

    /// The springs in the terms of mechanics.
    pub(super) fn resolve(&self, place: String, mesh: &Mesh) -> Result<Foundation, Error> {
        finite(format!("{place}.normal"), self.normal)?;
        negative(format!("{place}.normal"), self.normal)?;
        let mut stiffness = [0.0; 3];
        if let Some(stated) = &self.stiffness {
            let place = format!("{place}.stiffness");
            check_length(&place, mesh.dimension, stated.len())?;
            for (axis, (entry, stated)) in stiffness.iter_mut().zip(stated).enumerate() {
                finite(format!("{place}[{axis}]"), *stated)?;
                negative(format!("{place}[{axis}]"), *stated)?;
                *entry = *stated;
            }
        }
        let on = self.ground(&place, mesh)?;
        if matches!(on, Ground::Nodes(_)) && self.normal != 0.0 {
            return Err(Error::NotAccepted {
                place: format!("{place}.normal"),
                found: self.normal.to_string(),
                accepted: "`stiffness` along the axes, for a node has no normal".to_owned(),
            });
        }
        if self.normal == 0.0 && stiffness == [0.0; 3] {
            return Err(Error::NotAccepted {
                place,
                found: "no stiffness".to_owned(),
                accepted: "`normal` or a component of `stiffness` above 0".to_owned(),
            });
        }
        Ok(Foundation {
            place,
            on,
            stiffness,
            normal: self.normal,
        })
    }

    fn ground(&self, place: &str, mesh: &Mesh) -> Result<Ground, Error> {
        match (&self.group, &self.at) {
            (Some(group), None) => {
                let place = format!("{place}.group");
                match &*selection::group(mesh, &place, group)? {
                    Group::Points(points) => Ok(Ground::Nodes(points.clone())),
                    _ => Ok(Ground::Area(selection::facets(mesh, &place, group)?)),
                }
            }
            (None, Some(at)) => {
                let node = selection::node_at(mesh, &format!("{place}.at"), at)?;
                Ok(Ground::Nodes(vec![node]))
            }
            (group, _) => Err(Error::NotAccepted {
                place: place.to_owned(),
                found: match group {
                    Some(_) => "both `group` and `at`".to_owned(),
                    None => "neither `group` nor `at`".to_owned(),
                },
                accepted: "one of the two".to_owned(),
            }),
        }
    }
}

fn negative(place: String, value: f64) -> Result<(), Error> {
    match value < 0.0 {
        false => Ok(()),
        true => Err(Error::OutOfRange {
            place,
            value,
            accepted: "0 <= stiffness < infinity",
        }),
    }
}
