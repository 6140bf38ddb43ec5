//! Planes of symmetry: flat faces that supports hold across themselves, behind which a surface goes on as its mirror image.

use std::collections::HashMap;

use nalgebra::Vector3;

use super::held::Directions;
use super::turn::CORNER;
use crate::body::{Facet, Mesh};

/// Sine of the angle between directions up to which they are one.
const ONE: f64 = 1e-6;

/// Unit normals of the planes of symmetry through nodes.
#[derive(Clone, Debug, Default)]
pub(super) struct Mirrors(HashMap<usize, Vec<Vector3<f64>>>);

impl Mirrors {
    /// Those of a whole boundary in outward order, whose nodes are `held` along some directions.
    pub(super) fn new(mesh: &Mesh, boundary: &[Facet], held: impl Fn(usize) -> Directions) -> Self {
        let mut mirrors = Self::default();
        for facet in boundary {
            let Some(normal) = normal(mesh, facet) else {
                continue;
            };
            if facet.nodes.iter().all(|&node| held(node).hold(&normal)) {
                for &node in facet.corners(mesh.dimension) {
                    let known = mirrors.0.entry(node).or_default();
                    if known.iter().all(|other| other.cross(&normal).norm() > ONE) {
                        known.push(normal);
                    }
                }
            }
        }
        mirrors
    }

    /// Those through a node.
    pub(super) fn at(&self, node: usize) -> &[Vector3<f64>] {
        self.0.get(&node).map_or(&[], Vec::as_slice)
    }

    /// Of the planes through a node those behind which a surface of this unit normal goes on without a corner.
    pub(super) fn of_surface(&self, node: usize, normal: Vector3<f64>) -> Vec<Vector3<f64>> {
        let meets = self
            .at(node)
            .iter()
            .filter(|plane| plane.dot(&normal).abs() < (CORNER / 2.0).sin());
        meets.copied().collect()
    }
}

/// What is seen of a vector in a mirror.
pub(super) fn image(vector: Vector3<f64>, plane: &Vector3<f64>) -> Vector3<f64> {
    vector - plane * (2.0 * plane.dot(&vector))
}

/// Whether a vector lies in a plane.
pub(super) fn lies_in(vector: Vector3<f64>, plane: &Vector3<f64>) -> bool {
    plane.dot(&vector).abs() <= ONE * vector.norm()
}

/// Unit normal of a facet, by its corners.
fn normal(mesh: &Mesh, facet: &Facet) -> Option<Vector3<f64>> {
    let x = |node: usize| Vector3::from(mesh.nodes[node]);
    let across = match *facet.corners(mesh.dimension) {
        [a, b] => (x(b) - x(a)).cross(&Vector3::z()),
        [a, b, c] => (x(b) - x(a)).cross(&(x(c) - x(a))),
        [a, b, c, d] => (x(c) - x(a)).cross(&(x(d) - x(b))),
        _ => return None,
    };
    across.try_normalize(0.0)
}
