//! Springs that hold a body to the ground: per area of its surface, or at nodes.
//!
//! ```text
//! (B13)  K_ab += ∫ N_a N_b k dA,     k = diag(k_x, k_y, k_z) + k_n n nᵀ        per area
//!        K_aa += k                                                              at a node
//! ```
//!
//! The ground does not move. Springs hold the rigid motions that they resist.

use nalgebra::{Matrix3, Vector3};

use super::affine::fine_points;
use super::entries::check_indices;
use super::sparsity::BlockMatrix;
use super::{Body, Facet};
use crate::error::Error;

/// Springs to the ground.
#[derive(Clone, Debug, PartialEq)]
pub struct Foundation {
    /// Where the scene says so, for messages, such as `bodies[0].foundation[1]`.
    pub place: String,
    /// Where they stand.
    pub on: Ground,
    /// Stiffness per global axis, in N/m³ on an area and in N/m at a node, never negative.
    pub stiffness: [f64; 3],
    /// Stiffness along the normal of an area, in N/m³, never negative.
    pub normal: f64,
}

/// Where springs stand.
#[derive(Clone, Debug, PartialEq)]
pub enum Ground {
    /// Under facets.
    Area(Vec<Facet>),
    /// At nodes, each of which has the whole stiffness.
    Nodes(Vec<usize>),
}

impl Foundation {
    /// k where the normal is `normal`.
    fn stiffness(&self, normal: Vector3<f64>) -> Matrix3<f64> {
        let axes = Matrix3::from_diagonal(&self.stiffness.into());
        axes + normal * normal.transpose() * self.normal
    }

    pub(super) fn check(&self, body: &Body) -> Result<(), Error> {
        let given = self.stiffness.iter().chain([&self.normal]);
        if let Some(&value) = given.clone().find(|k| !(**k >= 0.0 && k.is_finite())) {
            return Err(Error::OutOfRange {
                place: self.place.clone(),
                value,
                accepted: "0 <= stiffness < infinity",
            });
        }
        if let Ground::Nodes(nodes) = &self.on {
            check_indices(|| self.place.clone(), "node", nodes, body.mesh.nodes.len())?;
        }
        Ok(())
    }

    /// Every pair of nodes of a spring, with the block that it adds to the stiffness, in N/m.
    fn for_each_block(&self, body: &Body, mut each: impl FnMut(usize, usize, &Matrix3<f64>)) {
        match &self.on {
            Ground::Nodes(nodes) => {
                let stiffness = self.stiffness(Vector3::zeros());
                nodes.iter().for_each(|&node| each(node, node, &stiffness));
            }
            Ground::Area(facets) => {
                for facet in facets {
                    for point in fine_points(body, facet) {
                        let area = point.vector.norm();
                        let normal = point.vector.try_normalize(0.0).unwrap_or_default();
                        let stiffness = self.stiffness(normal) * (area * body.model.depth());
                        for (i, (a, n_a)) in facet.nodes.iter().zip(&point.shape).enumerate() {
                            for (b, n_b) in facet.nodes.iter().zip(&point.shape).take(i + 1) {
                                each(*a, *b, &(stiffness * (n_a * n_b)));
                            }
                        }
                    }
                }
            }
        }
    }

    /// Lists of nodes that a spring joins.
    pub(super) fn joined(&self) -> impl Iterator<Item = &[usize]> + Clone {
        let (nodes, facets) = match &self.on {
            Ground::Nodes(nodes) => (nodes.as_slice(), [].as_slice()),
            Ground::Area(facets) => ([].as_slice(), facets.as_slice()),
        };
        nodes
            .chunks(1)
            .chain(facets.iter().map(|facet| facet.nodes.as_slice()))
    }

    /// Every node with a direction that a spring resists there.
    pub(super) fn held_directions(&self, body: &Body) -> Vec<(usize, Vector3<f64>)> {
        let mut held = Vec::new();
        let nodes: Vec<(usize, Vector3<f64>)> = match &self.on {
            Ground::Nodes(nodes) => nodes.iter().map(|node| (*node, Vector3::zeros())).collect(),
            Ground::Area(facets) => facets
                .iter()
                .flat_map(|facet| {
                    let normal = Vector3::from(body.facet_geometry(facet).normal);
                    facet.nodes.iter().map(move |node| (*node, normal))
                })
                .collect(),
        };
        for (node, normal) in nodes {
            for axis in (0..body.mesh.dimension).filter(|axis| self.stiffness[*axis] > 0.0) {
                held.push((node, Vector3::ith(axis, 1.0)));
            }
            if self.normal > 0.0 && normal != Vector3::zeros() {
                held.push((node, normal));
            }
        }
        held
    }
}

/// Adds (B13) of all springs of a body.
pub(super) fn add_foundation(body: &Body, matrix: &mut BlockMatrix) {
    for foundation in &body.foundation {
        foundation.for_each_block(body, |a, b, block| matrix.add(a, b, block));
    }
}

/// Forces of the springs on a body that is displaced, in newton, entry `dimension · node + axis`; none
/// at all if it has no springs.
#[must_use]
pub(crate) fn foundation_forces(body: &Body, displacement: &[f64]) -> Option<Vec<f64>> {
    if body.foundation.is_empty() {
        return None;
    }
    let axes = body.mesh.dimension;
    let mut forces = vec![0.0; displacement.len()];
    let mut push = |of: usize, by: usize, block: &Matrix3<f64>| {
        for row in 0..axes {
            for column in 0..axes {
                forces[axes * of + row] -= block[(row, column)] * displacement[axes * by + column];
            }
        }
    };
    for foundation in &body.foundation {
        foundation.for_each_block(body, |a, b, block| {
            push(a, b, block);
            if a != b {
                push(b, a, block);
            }
        });
    }
    Some(forces)
}
