//! Which ways supports hold the nodes of contact sides.
//!
//! On a plane of symmetry half of a body is there. Facets lean out of the plane, and forces meet beside it; the
//! mirror images lean back, and the supports stand for them.

use std::collections::HashMap;

use nalgebra::Vector3;

use super::meeting::Meeting;
use crate::body::{Body, dependence, prescribed};
use crate::contact::ContactNode;
use crate::error::Error;

/// Part of a direction that may be free where it counts as held.
const ROUNDED: f64 = 1e-6;

/// Unit vectors along which displacements are given, by body and node; for nodes where there are any.
#[derive(Clone, Debug, Default)]
pub(super) struct Supported(HashMap<(usize, usize), Vec<Vector3<f64>>>);

impl Supported {
    /// At the nodes of contact sides.
    ///
    /// # Errors
    ///
    /// Supports that contradict each other.
    pub(super) fn new(bodies: &[Body], meetings: &[Meeting]) -> Result<Self, Error> {
        let mut held = HashMap::new();
        for (index, body) in bodies.iter().enumerate() {
            let skins = meetings.iter().flat_map(|meeting| &meeting.skins);
            let skins: Vec<_> = skins.filter(|skin| skin.body == index).collect();
            if skins.is_empty() {
                continue;
            }
            let (given, tied) = (prescribed(body)?, dependence(body)?);
            let axes = body.mesh.dimension;
            for &node in skins.iter().flat_map(|skin| skin.of_node.keys()) {
                let ways = match &tied {
                    Some(tied) => tied.held_directions(node),
                    None => {
                        let axes_held =
                            (0..axes).filter(|axis| given[node * axes + axis].is_some());
                        axes_held.map(|axis| Vector3::ith(axis, 1.0)).collect()
                    }
                };
                if !ways.is_empty() {
                    held.insert((index, node), ways);
                }
            }
        }
        Ok(Self(held))
    }

    /// Orthonormal; none where the node is free.
    pub(super) fn at(&self, body: usize, node: usize) -> &[Vector3<f64>] {
        self.0.get(&(body, node)).map_or(&[], Vec::as_slice)
    }

    /// Along which a contact's node and one that it meets are both held; orthonormal.
    pub(super) fn still(&self, contact: &ContactNode) -> Vec<Vector3<f64>> {
        let own = self.at(contact.body, contact.node);
        let met = contact.opposite.iter().flat_map(|side| {
            let nodes = side.nodes.iter();
            nodes.map(|(node, _)| self.at(side.body, *node))
        });
        let mut still: Vec<Vector3<f64>> = Vec::new();
        for met in met.filter(|met| !met.is_empty() && !own.is_empty()) {
            for way in own.iter().chain(met) {
                let both = across(*way, own).norm() < ROUNDED && across(*way, met).norm() < ROUNDED;
                still.extend(across(*way, &still).try_normalize(ROUNDED).filter(|_| both));
            }
        }
        still
    }
}

/// What of a vector is across orthonormal directions.
pub(super) fn across(vector: Vector3<f64>, ways: &[Vector3<f64>]) -> Vector3<f64> {
    ways.iter()
        .fold(vector, |rest, way| rest - way * way.dot(&vector))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::contact::OppositeNodes;

    #[test]
    fn still_is_what_both_sides_hold() {
        let [x, y] = [0, 1].map(|axis| Vector3::ith(axis, 1.0));
        let slanted = (x + y).normalize();
        let mut held = Supported::default();
        held.0.insert((0, 7), vec![slanted, (x - y).normalize()]);
        held.0.insert((1, 3), vec![y]);
        let (_, mut surface, _) = crate::kkt::tests::samples::lid_on_box(0.0);
        let mut contact = surface.nodes.remove(0);
        (contact.body, contact.node) = (0, 7);
        contact.opposite = Some(OppositeNodes {
            body: 1,
            nodes: vec![(2, 0.5), (3, 0.5)],
        });
        assert_eq!(held.still(&contact), [y]);
        // Free on the other side, it is still along nothing.
        held.0.remove(&(1, 3));
        assert!(held.still(&contact).is_empty());
        assert!((across(x, &[slanted]) - (x - y) / 2.0).norm() < 1e-15);
    }
}
