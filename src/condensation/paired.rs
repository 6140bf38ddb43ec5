//! The contacts of a pair of surfaces, one per node of the first that the other covers.

use std::collections::HashSet;

use super::frame::Stance;
use super::mortar::{self, MortarNode};
use super::surface::PairSurface;
use super::{ContactNode, ContactPair, OppositeNodes};
use crate::body::{Body, Facet};
use crate::error::Error;

/// The second surface of a pair.
pub(super) struct OppositeSurface<'a> {
    /// Index of its body.
    pub(super) body: usize,
    pub(super) facets: &'a [Facet],
}

/// The contacts of a pair of surfaces; bodies and prescribed displacements of the scene.
///
/// # Errors
///
/// What [`mortar::couple`] refuses.
pub(super) fn between_surfaces(
    bodies: &[Body],
    prescribed: &[Vec<Option<f64>>],
    pair: &ContactPair,
    opposite: &OppositeSurface<'_>,
) -> Result<PairSurface, Error> {
    let (own, other) = (&bodies[pair.body], &bodies[opposite.body]);
    let coupled = mortar::couple(
        &own.mesh,
        &pair.facets,
        &other.mesh,
        opposite.facets,
        &pair.place,
    )?;
    let (mut contacts, mut left_out) = (Vec::new(), Vec::new());
    for node in coupled.nodes {
        let held = |body: usize, node: usize| held_axes(bodies, prescribed, body, node);
        let of_node = held(pair.body, node.node);
        // A direction moves if one of the nodes can move along it.
        let mut sides = vec![of_node];
        sides.extend(
            node.opposite
                .iter()
                .map(|&(node, _)| held(opposite.body, node)),
        );
        let moves = |row: &[f64; 3]| {
            sides
                .iter()
                .any(|held| row.iter().zip(held).any(|(d, held)| *d != 0.0 && !held))
        };
        let mut frame = frame(own.mesh.dimension, &node, of_node);
        frame[1..].sort_by_key(|row| !moves(row));
        if !moves(&frame[0]) {
            left_out.push(node.node);
            continue;
        }
        let tangents = frame[1..own.mesh.dimension]
            .iter()
            .filter(|row| moves(row))
            .count();
        contacts.push(ContactNode {
            body: pair.body,
            node: node.node,
            opposite: Some(OppositeNodes {
                body: opposite.body,
                nodes: node.opposite,
            }),
            pair: 0,
            position: own.mesh.nodes[node.node],
            frame,
            tangents: if pair.friction == 0.0 { 0 } else { tangents },
            initial_gap: node.initial_gap,
            area: node.weight * own.model.depth(),
            rim: false,
        });
    }
    let met: HashSet<usize> = contacts
        .iter()
        .map(|contact| contact.node)
        .chain(left_out.iter().copied())
        .collect();
    let covered = |facet: &&Facet| facet.nodes.iter().all(|node| met.contains(node));
    let facets = pair.facets.iter().filter(covered).cloned().collect();
    Ok(PairSurface {
        contacts,
        facets,
        left_out,
    })
}

/// Which axes of a node a support holds; an axis that the body does not have is held.
fn held_axes(
    bodies: &[Body],
    prescribed: &[Vec<Option<f64>>],
    body: usize,
    node: usize,
) -> [bool; 3] {
    let dimension = bodies[body].mesh.dimension;
    let of_node = &prescribed[body][node * dimension..(node + 1) * dimension];
    std::array::from_fn(|axis| of_node.get(axis).is_none_or(Option::is_some))
}

/// Normal and tangents, along the supported axes of the node where these lie across.
fn frame(dimension: usize, node: &MortarNode, held: [bool; 3]) -> [[f64; 3]; 3] {
    let mut supported = held;
    supported[dimension..].fill(false);
    match Stance::new(dimension, node.normal, supported) {
        Stance::Free { frame, .. } => frame,
        Stance::Held | Stance::Askew => match Stance::new(dimension, node.normal, [false; 3]) {
            Stance::Free { frame, .. } => frame,
            // Without supports nothing is held.
            Stance::Held | Stance::Askew => [node.normal, [0.0; 3], [0.0; 3]],
        },
    }
}
