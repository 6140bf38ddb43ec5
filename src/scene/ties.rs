//! Displacements that depend on each other: rigid groups, and faces that repeat.

use nalgebra::{Rotation3, Unit, Vector3};
use serde::{Deserialize, Serialize};

use super::SceneGroup;
use super::bolt::Cuts;
use super::field::{finite, line};
use super::load::wrench;
use super::local_axes::SceneAxis;
use super::selection::{self, AT_NODE};
use crate::body::{Load, Mesh, Model, RigidGroup, Tie, TiedPairs};
use crate::error::{Error, check_length};

/// A group that moves as a rigid body, coupled to a reference point that is held, moved or loaded.
///
/// A table of `steps` under its place and `.motion` multiplies displacement and rotation, one under `.load`
/// force and moment.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(
    deny_unknown_fields,
    expecting = "an object with group, reference_point, and displacement, rotation, force or moment"
)]
pub struct SceneRigidGroup {
    /// Group of cells, facets, edges or points; its nodes do not all lie on a line.
    pub group: SceneGroup,
    /// The reference point, in the unit of length.
    pub reference_point: Vec<f64>,
    /// Displacement of the reference point, one entry per axis, in the unit of length; `null` leaves it free, as
    /// does leaving it out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub displacement: Option<Vec<Option<f64>>>,
    /// Small rotation in radian, in 3D about each axis, in 2D a single entry; `null` leaves it free, as does
    /// leaving it out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotation: Option<Vec<Option<f64>>>,
    /// Force at the reference point (plane strain: per unit of depth).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub force: Option<Vec<f64>>,
    /// Moment, in 2D a single entry.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub moment: Option<Vec<f64>>,
}

/// Faces of a body that repeats: one moves as the other, turned if it repeats around an axis.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(
    deny_unknown_fields,
    expecting = "an object with from, onto, and translation or axis and angle"
)]
pub struct ScenePeriodic {
    /// Group of the nodes that are mapped.
    pub from: SceneGroup,
    /// Group of the nodes that they are mapped onto, one onto one.
    pub onto: SceneGroup,
    /// What maps them, in the unit of length; this, or `axis` and `angle`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub translation: Option<Vec<f64>>,
    /// The axis about which they are turned.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axis: Option<SceneAxis>,
    /// By what angle, in radian.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub angle: Option<f64>,
}

impl SceneRigidGroup {
    /// A group without support or load.
    #[must_use]
    pub fn new(group: &str, reference_point: &[f64]) -> Self {
        Self {
            group: group.into(),
            reference_point: reference_point.to_vec(),
            ..Self::default()
        }
    }

    /// The tie, and the load at its reference point if there is any.
    pub(super) fn resolve(
        &self,
        place: &str,
        mesh: &Mesh,
        model: Model,
    ) -> Result<(Tie, Option<Load>), Error> {
        let turns = if mesh.dimension == 2 { 1 } else { 3 };
        let nodes = selection::nodes(mesh, &format!("{place}.group"), &self.group)?;
        let at = format!("{place}.reference_point");
        let reference_point = selection::vector(&at, &self.reference_point, mesh.dimension)?;
        let moves = format!("{place}.displacement");
        let displacement = components(&moves, self.displacement.as_deref(), mesh.dimension)?;
        let mut rotation = components(
            &format!("{place}.rotation"),
            self.rotation.as_deref(),
            turns,
        )?;
        rotation.rotate_right(3 - turns);
        if model == Model::Axisymmetric && (displacement[0].is_some() || rotation != [None; 3]) {
            return Err(Error::NotAccepted {
                place: place.to_owned(),
                found: "a radial displacement or a rotation".to_owned(),
                accepted: "null there, for a ring moves along its axis alone without strain"
                    .to_owned(),
            });
        }
        let on = Some(self.reference_point.as_slice());
        let wrench = wrench(
            place,
            [self.force.as_deref(), self.moment.as_deref(), on],
            model,
        )?;
        let loaded = self.force.is_some() || self.moment.is_some();
        let load = loaded.then(|| Load::AtReference {
            place: place.to_owned(),
            nodes: nodes.clone(),
            wrench,
        });
        let group = RigidGroup {
            place: place.to_owned(),
            nodes,
            reference_point,
            displacement,
            rotation,
        };
        Ok((Tie::Rigid(group), load))
    }
}

/// Given components; free ones where nothing is stated.
fn components(
    place: &str,
    stated: Option<&[Option<f64>]>,
    count: usize,
) -> Result<[Option<f64>; 3], Error> {
    let mut components = [None; 3];
    if let Some(stated) = stated {
        check_length(place, count, stated.len())?;
        for (axis, (component, stated)) in components.iter_mut().zip(stated).enumerate() {
            stated.map_or(Ok(()), |value| finite(format!("{place}[{axis}]"), value))?;
            *component = *stated;
        }
    }
    Ok(components)
}

impl ScenePeriodic {
    /// Faces that a translation maps onto each other.
    #[must_use]
    pub fn translated(from: &str, onto: &str, translation: &[f64]) -> Self {
        Self {
            from: from.into(),
            onto: onto.into(),
            translation: Some(translation.to_vec()),
            ..Self::default()
        }
    }

    /// Faces that a rotation maps onto each other, by an angle in radian.
    #[must_use]
    pub fn turned(from: &str, onto: &str, axis: SceneAxis, angle: f64) -> Self {
        Self {
            from: from.into(),
            onto: onto.into(),
            axis: Some(axis),
            angle: Some(angle),
            translation: None,
        }
    }

    /// The pairs of nodes; those at the cuts of bolts lie on each other, and move with the side that they belong to.
    pub(super) fn resolve(
        &self,
        place: &str,
        mesh: &Mesh,
        model: Model,
        cuts: &Cuts,
    ) -> Result<Tie, Error> {
        if model == Model::Axisymmetric {
            return Err(Error::NotAccepted {
                place: place.to_owned(),
                found: "faces that repeat".to_owned(),
                accepted: "none on an axisymmetric body".to_owned(),
            });
        }
        let mapping = self.mapping(place, mesh)?;
        let from = selection::nodes(mesh, &format!("{place}.from"), &self.from)?;
        let onto = selection::nodes(mesh, &format!("{place}.onto"), &self.onto)?;
        let pairs = match_nodes(place, mesh, [&from, &onto], (mapping, cuts))?;
        Ok(Tie::Pairs(TiedPairs {
            place: place.to_owned(),
            pairs,
            rotation: std::array::from_fn(|i| std::array::from_fn(|j| mapping.0[(i, j)])),
        }))
    }

    /// `x ↦ R x + shift`.
    fn mapping(&self, place: &str, mesh: &Mesh) -> Result<(Rotation3<f64>, Vector3<f64>), Error> {
        match (&self.translation, &self.axis, self.angle) {
            (Some(translation), None, None) => {
                let place = format!("{place}.translation");
                let shift = selection::vector(&place, translation, mesh.dimension)?;
                Ok((Rotation3::identity(), shift.into()))
            }
            (None, Some(axis), Some(angle)) => {
                finite(format!("{place}.angle"), angle)?;
                let place = format!("{place}.axis");
                let line = line(
                    &place,
                    &axis.point,
                    axis.direction.as_deref(),
                    mesh.dimension,
                )?;
                let along = Unit::new_normalize(Vector3::from(line.direction));
                let rotation = Rotation3::from_axis_angle(&along, angle);
                let centre = Vector3::from(line.point);
                Ok((rotation, centre - rotation * centre))
            }
            _ => Err(Error::NotAccepted {
                place: place.to_owned(),
                found: "other keys beside `from` and `onto`".to_owned(),
                accepted: "`translation`, or `axis` with `angle`".to_owned(),
            }),
        }
    }
}

/// Every node of the first list with that of the second onto which it is mapped.
fn match_nodes(
    place: &str,
    mesh: &Mesh,
    [from, onto]: [&[usize]; 2],
    ((rotation, shift), cuts): ((Rotation3<f64>, Vector3<f64>), &Cuts),
) -> Result<Vec<[usize; 2]>, Error> {
    check_alike(place, [from, onto], cuts)?;
    let tolerance = AT_NODE * selection::size(mesh);
    let at = |node: usize| Vector3::from(mesh.nodes[node]);
    let same_side = |node: usize, other: usize| match (cuts.get(&node), cuts.get(&other)) {
        (Some((out, _)), Some((other, _))) => (rotation * out).dot(other) > 0.0,
        (own, other) => own.is_none() && other.is_none(),
    };
    let mut sorted = onto.to_vec();
    sorted.sort_by(|&a, &b| at(a).x.total_cmp(&at(b).x));
    let mut taken = vec![false; sorted.len()];
    let mut pairs = Vec::with_capacity(from.len());
    for &node in from {
        let image = rotation * at(node) + shift;
        let start = sorted.partition_point(|&other| at(other).x < image.x - tolerance);
        let near = sorted[start..]
            .iter()
            .take_while(|&&other| at(other).x <= image.x + tolerance);
        let distance = |other: usize| (at(other) - image).norm();
        let near = near
            .enumerate()
            .filter(|(_, other)| distance(**other) <= tolerance && same_side(node, **other));
        let near = near.map(|(k, &other)| (start + k, other));
        let nearest = near.min_by(|a, b| distance(a.1).total_cmp(&distance(b.1)));
        match nearest {
            Some((k, other)) if !std::mem::replace(&mut taken[k], true) => {
                pairs.push([node, other]);
            }
            _ => {
                let least = onto.iter().map(|&other| distance(other));
                let least = least.fold(f64::INFINITY, f64::min);
                let on_bolt = cuts.get(&node).map(|(_, bolt)| bolt.as_str());
                let found = unmatched((node, mesh.nodes[node]), image, least, on_bolt);
                return Err(Error::NotAccepted {
                    place: place.to_owned(),
                    found,
                    accepted: format!("nodes that match to {tolerance:e}"),
                });
            }
        }
    }
    Ok(pairs)
}

/// Refuses faces of other numbers of nodes.
fn check_alike(place: &str, [from, onto]: [&[usize]; 2], cuts: &Cuts) -> Result<(), Error> {
    if from.len() == onto.len() {
        return Ok(());
    }
    let mut cut = from.iter().chain(onto).filter_map(|node| cuts.get(node));
    let by = cut.next().map_or(String::new(), |(_, bolt)| {
        format!(", those at the cut of {bolt} twice")
    });
    Err(Error::NotAccepted {
        place: place.to_owned(),
        found: format!(
            "{} nodes and {} to map them onto{by}",
            from.len(),
            onto.len()
        ),
        accepted: "two faces that are meshed, and cut by bolts, alike".to_owned(),
    })
}

/// What is said of a node that no node of the other face, or none of its own, answers.
fn unmatched(
    (node, at): (usize, [f64; 3]),
    image: Vector3<f64>,
    least: f64,
    on_bolt: Option<&str>,
) -> String {
    let (by, or) = match on_bolt {
        Some(bolt) => (
            format!(" at the cut of {bolt}"),
            ", or lies on the other side of a cut",
        ),
        None => (String::new(), ""),
    };
    format!(
        "node {node}{by} at {at:?}, mapped to {:?}, where the nearest node of the other face is {least:e} away, or has \
         its partner{or}",
        <[f64; 3]>::from(image)
    )
}
