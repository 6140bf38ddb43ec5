//! Rigid bodies: surfaces that move as a whole, held, moved or free under a force.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::SceneObstacle;
use super::selection::vector;
use crate::body::{Body, Model};
use crate::contact::{Component, Obstacle, RigidBody};
use crate::error::{Error, check_length};

/// A body without compliance. Every component of its motion is given (held, if 0) or free under a given force
/// or moment; `steps` and `cases` put factors on each, under its place, such as `rigid_bodies[0].force[1]`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, expecting = "a rigid body")]
pub struct SceneRigidBody {
    /// Name of its own, by which contacts and reports name it.
    pub name: String,
    /// Its surfaces where the scene puts them.
    #[cfg_attr(feature = "cli", schemars(length(min = 1)))]
    pub surfaces: Vec<SceneObstacle>,
    /// Point that displacements, forces and moments are stated of, in the unit of length; may be left out where
    /// there is neither `rotation` nor `moment`: then it is the origin.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reference: Option<Vec<f64>>,
    /// Displacement, one entry per axis, in the unit of length; `null` leaves the component free. Left out, it is held.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub displacement: Option<Vec<Option<f64>>>,
    /// Force on free components, one entry per axis: of the whole circumference beside axisymmetric bodies, per unit
    /// of depth in plane strain.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub force: Option<Vec<f64>>,
    /// Small rotation about the reference point, in radian, one entry per axis, in 2D a single one; `null` leaves it
    /// free. Left out, it is held.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotation: Option<Vec<Option<f64>>>,
    /// Moment about the reference point on free rotations, as many entries as `rotation`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub moment: Option<Vec<f64>>,
}

/// A rigid body in the terms of mechanics, with its surfaces.
pub(super) struct Resolved {
    pub(super) body: RigidBody,
    pub(super) surfaces: Vec<Obstacle>,
}

impl SceneRigidBody {
    /// A rigid body of one surface that is held.
    #[must_use]
    pub fn new(name: &str, surface: SceneObstacle) -> Self {
        Self {
            name: name.to_owned(),
            surfaces: vec![surface],
            ..Self::default()
        }
    }

    /// The rigid body beside these bodies, which live in one space.
    pub(super) fn resolve(
        &self,
        place: &str,
        folder: &Path,
        bodies: &[Body],
    ) -> Result<Resolved, Error> {
        let dimension = bodies.first().map_or(3, |body| body.mesh.dimension);
        let mut surfaces = Vec::with_capacity(self.surfaces.len());
        for (at, surface) in self.surfaces.iter().enumerate() {
            surfaces.push(surface.resolve(
                &format!("{place}.surfaces[{at}]"),
                folder,
                dimension,
            )?);
        }
        if surfaces.is_empty() {
            let place = format!("{place}.surfaces");
            return Err(Error::Empty { place });
        }
        let moves = Moves {
            place,
            keys: ["displacement", "force"],
            axes: dimension,
        };
        let mut components = [Component::Given(0.0); 6];
        let translations = moves.components(self.displacement.as_deref(), self.force.as_deref())?;
        components[..dimension].copy_from_slice(&translations);
        let turns = Moves {
            keys: ["rotation", "moment"],
            axes: if dimension == 2 { 1 } else { 3 },
            ..moves
        };
        let rotations = turns.components(self.rotation.as_deref(), self.moment.as_deref())?;
        components[6 - turns.axes..].copy_from_slice(&rotations);
        let body = RigidBody {
            place: place.to_owned(),
            name: self.name.clone(),
            reference: self.reference_point(place, dimension)?,
            components,
            pairs: Vec::new(),
            cut: None,
        };
        if bodies.iter().any(|body| body.model == Model::Axisymmetric) {
            along_the_axis(&body)?;
        }
        Ok(Resolved { body, surfaces })
    }

    fn reference_point(&self, place: &str, dimension: usize) -> Result<[f64; 3], Error> {
        let place = format!("{place}.reference");
        match &self.reference {
            Some(point) => vector(&place, point, dimension),
            None if self.rotation.is_none() && self.moment.is_none() => Ok([0.0; 3]),
            None => Err(Error::NotAccepted {
                place,
                found: "no point".to_owned(),
                accepted: "the point that `rotation` and `moment` are about".to_owned(),
            }),
        }
    }
}

impl Resolved {
    /// The surface of this number, which may be left out while there is only one, for the contact at a place.
    pub(super) fn surface(&self, place: &str, number: Option<usize>) -> Result<Obstacle, Error> {
        let place = format!("{place}.surface");
        match (number, self.surfaces.as_slice()) {
            (None, [only]) => Ok(only.clone()),
            (None, several) => Err(Error::NotAccepted {
                place,
                found: "no number".to_owned(),
                accepted: format!(
                    "a number below {}, of a surface of `{}`",
                    several.len(),
                    self.body.name
                ),
            }),
            (Some(index), surfaces) => surfaces.get(index).cloned().ok_or(Error::UnknownIndex {
                place,
                what: "surface",
                index,
                count: surfaces.len(),
            }),
        }
    }
}

/// Displacements and forces, or rotations and moments.
#[derive(Clone, Copy)]
struct Moves<'a> {
    place: &'a str,
    keys: [&'static str; 2],
    axes: usize,
}

impl Moves<'_> {
    fn components(
        self,
        motion: Option<&[Option<f64>]>,
        force: Option<&[f64]>,
    ) -> Result<Vec<Component>, Error> {
        let [of_motion, of_force] = self.keys.map(|key| format!("{}.{key}", self.place));
        let mut components = vec![Component::Given(0.0); self.axes];
        if let Some(motion) = motion {
            check_length(&of_motion, self.axes, motion.len())?;
            for (component, stated) in components.iter_mut().zip(motion) {
                *component = stated.map_or(Component::Free(0.0), Component::Given);
            }
        }
        if let Some(force) = force {
            check_length(&of_force, self.axes, force.len())?;
            for (at, (component, &stated)) in components.iter_mut().zip(force).enumerate() {
                match component {
                    Component::Free(force) => *force = stated,
                    Component::Given(_) if stated == 0.0 => {}
                    Component::Given(_) => {
                        return Err(Error::NotAccepted {
                            place: format!("{of_force}[{at}]"),
                            found: format!("{stated} on a component that is given"),
                            accepted: format!(
                                "0, or `null` in {of_motion}[{at}], which leaves it free"
                            ),
                        });
                    }
                }
            }
        }
        for (at, component) in components.iter().enumerate() {
            let (Component::Given(value) | Component::Free(value)) = *component;
            let key = match component {
                Component::Given(_) => &of_motion,
                Component::Free(_) => &of_force,
            };
            super::field::finite(format!("{key}[{at}]"), value)?;
        }
        Ok(components)
    }
}

/// Beside axisymmetric bodies, only the axis is left.
fn along_the_axis(body: &RigidBody) -> Result<(), Error> {
    let refused = [0, 5]
        .into_iter()
        .find(|&k| body.components[k] != Component::Given(0.0));
    let Some(component) = refused else {
        return Ok(());
    };
    let (key, found, accepted) = match component {
        0 => (
            "displacement",
            "a motion across the axis",
            "0: a ring does not move across its axis",
        ),
        _ => (
            "rotation",
            "a rotation",
            "0: axisymmetric bodies neither tilt nor bear torsion; use a solid",
        ),
    };
    Err(Error::NotAccepted {
        place: format!("{}.{key}[0]", body.place),
        found: found.to_owned(),
        accepted: accepted.to_owned(),
    })
}
