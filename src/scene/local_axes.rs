//! Axes of a support other than the global ones.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::field::line;
use super::{SceneGroup, selection};
use crate::body::{Mesh, Model};
use crate::error::Error;

/// Components of a direction that are round-off.
const ROUND_OFF: f64 = 1e-12;

/// Part of the mesh's size within which a node is on an axis.
const ON_AXIS: f64 = 1e-9;

/// Orthonormal rows per node.
pub(super) type Axes = Vec<[[f64; 3]; 3]>;

/// An axis.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(
    deny_unknown_fields,
    expecting = "an object with point and in 3D direction"
)]
pub struct SceneAxis {
    /// A point of the axis, in the unit of length.
    pub point: Vec<f64>,
    /// Its direction in 3D, of any length but zero; in 2D it is that out of the plane.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub direction: Option<Vec<f64>>,
}

impl SceneAxis {
    /// Radial, around and, in 3D, along the axis, per node.
    pub(super) fn around(
        &self,
        place: &str,
        (mesh, model): (&Mesh, Model),
        nodes: &[usize],
    ) -> Result<Axes, Error> {
        if model == Model::Axisymmetric {
            return Err(Error::NotAccepted {
                place: place.to_owned(),
                found: "an axis".to_owned(),
                accepted: "none, for an axisymmetric body has its own".to_owned(),
            });
        }
        let axis = line(
            place,
            &self.point,
            self.direction.as_deref(),
            mesh.dimension,
        )?;
        let along = Vector3::from(axis.direction).normalize();
        let least = ON_AXIS * selection::size(mesh);
        let rows = nodes.iter().map(|&node| {
            let arm = Vector3::from(mesh.nodes[node]) - Vector3::from(axis.point);
            let across = arm - along * along.dot(&arm);
            match across.try_normalize(least) {
                Some(radial) => {
                    let radial = clean(radial);
                    Ok([radial, along.cross(&radial), along].map(Into::into))
                }
                None => Err(Error::NotAccepted {
                    place: place.to_owned(),
                    found: format!("node {node} at {:?} on the axis", mesh.nodes[node]),
                    accepted: "nodes away from the axis, where it is told what is radial"
                        .to_owned(),
                }),
            }
        });
        rows.collect()
    }
}

/// Axes of which the first is a direction, in metre of any length but zero.
pub(super) fn from_direction(
    place: &str,
    direction: &[f64],
    mesh: &Mesh,
    nodes: usize,
) -> Result<Axes, Error> {
    let stated = selection::vector(place, direction, mesh.dimension)?;
    match Vector3::from(stated).try_normalize(0.0) {
        Some(first) => Ok(vec![with_first(clean(first)); nodes]),
        None => Err(Error::NotAccepted {
            place: place.to_owned(),
            found: format!("{direction:?}"),
            accepted: "a direction of any length but zero".to_owned(),
        }),
    }
}

/// Nodes of a group of facets, and axes of which the first is the outward normal: the mean of the facets
/// around, by area.
pub(super) fn normals(
    place: &str,
    group: &SceneGroup,
    mesh: &Mesh,
) -> Result<(Vec<usize>, Axes), Error> {
    let nodes = selection::nodes(mesh, place, group)?;
    let mut sums = vec![Vector3::zeros(); nodes.len()];
    for facet in selection::facets(mesh, place, group)? {
        let geometry = mesh.facet_geometry(&facet);
        let vector = Vector3::from(geometry.normal) * geometry.area;
        for node in &facet.nodes {
            if let Ok(at) = nodes.binary_search(node) {
                sums[at] += vector;
            }
        }
    }
    let axes = nodes
        .iter()
        .zip(sums)
        .map(|(&node, sum)| match sum.try_normalize(0.0) {
            Some(normal) => Ok(with_first(clean(normal))),
            None => Err(Error::NotAccepted {
                place: place.to_owned(),
                found: format!(
                    "node {node} at {:?} with facets that look against each other",
                    mesh.nodes[node]
                ),
                accepted: "facets with a normal in common".to_owned(),
            }),
        });
    let axes = axes.collect::<Result<_, _>>()?;
    Ok((nodes, axes))
}

/// A unit vector without round-off beside the global axes.
fn clean(direction: Vector3<f64>) -> Vector3<f64> {
    direction
        .map(|d| if d.abs() < ROUND_OFF { 0.0 } else { d })
        .normalize()
}

fn with_first(first: Vector3<f64>) -> [[f64; 3]; 3] {
    let mut least = Vector3::zeros();
    least[first.abs().imin()] = 1.0;
    let second = first.cross(&least).normalize();
    [first, second, first.cross(&second)].map(Into::into)
}
