//! The contacts of a pair of surfaces, one per node of one side that the other covers.
//!
//! The side that the pair names first carries the contacts, unless it is much stiffer: its
//! own compliance would then drown in that of the other side, `G = G₁ + P G₂ Pᵀ`, and with it
//! all but the patterns of pressure that the other side's mesh can tell apart. Compliance of
//! the softer side is there for every contact, whatever the meshes.
//!
//! Along an axis that supports hold on both sides nothing moves, so a contact has no unknown
//! there; on a symmetry plane its normal lies in the plane, and its weights are those of the node
//! in the whole, as if mirrored facets went on beyond it.

use std::collections::HashSet;

use nalgebra::Vector3;

use super::facing::Bodies;
use super::frame::Stance;
use super::mortar::MortarNode;
use super::pair::{PairSurface, check_pair_body};
use super::{ContactNode, ContactPair, OppositeNodes, mortar};
use crate::body::{Body, Facet, Model};
use crate::error::Error;

/// Ratio of Young's moduli beyond which the softer side carries the contacts: the stiffer one
/// costs two digits of sixteen there, and from ten times that on, if it is the finer one, also
/// sweeps by the dozen.
const MUCH_STIFFER: f64 = 1e2;

/// Weight of the other side's held nodes beyond which it does not move.
const MOSTLY: f64 = 0.5;

/// Part of a normal across the axes along which nothing moves, below which it is held.
const LEANING: f64 = 0.5;

/// One surface of a pair, in outward order.
struct Side {
    body: usize,
    facets: Vec<Facet>,
}

/// The contacts of a pair with the `facets` of body `opposite`.
///
/// # Errors
///
/// A body that does not exist, facets that are not on the boundary or on both sides, and
/// what the mortar coupling refuses.
pub(super) fn between_surfaces(
    scene: &Bodies<'_>,
    pair: &ContactPair,
    opposite: usize,
    facets: &[Facet],
) -> Result<PairSurface, Error> {
    let place = format!("{}.opposite", pair.place);
    check_pair_body(&place, opposite, scene.bodies.len())?;
    let side = |body: usize, facets: &[Facet], place: &str| {
        if facets.is_empty() {
            return Err(Error::Empty {
                place: place.to_owned(),
            });
        }
        let facets = scene.boundaries[body].outward(facets, place)?;
        Ok(Side { body, facets })
    };
    refuse_other_model(scene, pair.body, opposite, &place)?;
    let first = side(pair.body, &pair.facets, &format!("{}.facets", pair.place))?;
    let second = side(opposite, facets, &place)?;
    refuse_common_facets(&first, &second, &place)?;
    let stiffer = softest(scene.bodies, &first) > MUCH_STIFFER * softest(scene.bodies, &second);
    if stiffer {
        contacts(scene, pair, &second, &first, true)
    } else {
        contacts(scene, pair, &first, &second, false)
    }
}

/// A body of revolution meets only bodies of revolution.
fn refuse_other_model(
    scene: &Bodies<'_>,
    first: usize,
    second: usize,
    place: &str,
) -> Result<(), Error> {
    let [first, second] = [first, second].map(|body| &scene.bodies[body]);
    let around = |body: &Body| body.model == Model::Axisymmetric;
    if around(first) == around(second) {
        return Ok(());
    }
    let of = |body: &Body| {
        if around(body) {
            "axisymmetric"
        } else {
            "not axisymmetric"
        }
    };
    Err(Error::NotAccepted {
        place: place.to_owned(),
        found: format!("body `{}`, which is {}", second.name, of(second)),
        accepted: format!("a body that is {} as `{}`", of(first), first.name),
    })
}

fn refuse_common_facets(first: &Side, second: &Side, place: &str) -> Result<(), Error> {
    if first.body != second.body {
        return Ok(());
    }
    let of_first: HashSet<&[usize]> = first.facets.iter().map(|f| &f.nodes[..]).collect();
    let mut facets = second.facets.iter();
    match facets.find(|facet| of_first.contains(&facet.nodes[..])) {
        None => Ok(()),
        Some(facet) => Err(Error::NotAccepted {
            place: place.to_owned(),
            found: format!("the facet with nodes {:?} on both sides", facet.nodes),
            accepted: "two surfaces without a common facet".to_owned(),
        }),
    }
}

/// Least Young's modulus at a surface, in pascal.
fn softest(bodies: &[Body], side: &Side) -> f64 {
    let body = &bodies[side.body];
    let mut on_surface = vec![false; body.mesh.nodes.len()];
    for &node in side.facets.iter().flat_map(|facet| &facet.nodes) {
        on_surface[node] = true;
    }
    let cells = body.mesh.cells().zip(&body.material_of_cell);
    let at_surface = cells.filter(|(cell, _)| cell.nodes.iter().any(|node| on_surface[*node]));
    at_surface
        .map(|(_, material)| body.materials[*material].young)
        .fold(f64::INFINITY, f64::min)
}

/// The contacts at the nodes of `own`, which is the pair's `second` surface or its first.
fn contacts(
    scene: &Bodies<'_>,
    pair: &ContactPair,
    own: &Side,
    other: &Side,
    second: bool,
) -> Result<PairSurface, Error> {
    let (body, across) = (&scene.bodies[own.body], &scene.bodies[other.body]);
    let dimension = body.mesh.dimension;
    let coupled = mortar::average(
        &body.mesh,
        &own.facets,
        &across.mesh,
        &other.facets,
        body.model,
        &pair.place,
    )?;
    let (mut contacts, mut left_out) = (Vec::new(), Vec::new());
    for mut node in coupled.nodes {
        let still = still_axes(scene, own.body, other.body, &node);
        let Some(normal) = across_axes(node.normal, still) else {
            left_out.push(node.node);
            continue;
        };
        node.look_along(normal, still, &body.mesh, &across.mesh);
        let Stance::Free { frame, kept } = Stance::new(dimension, normal, still) else {
            left_out.push(node.node);
            continue;
        };
        contacts.push(ContactNode {
            body: own.body,
            node: node.node,
            own: node.own,
            opposite: Some(OppositeNodes {
                body: other.body,
                nodes: node.opposite,
            }),
            pair: 0,
            position: body.mesh.nodes[node.node],
            frame,
            tangents: if pair.friction == 0.0 { 0 } else { kept },
            initial_gap: node.initial_gap,
            area: node.weight * body.model.depth(),
            second,
            rim: false,
        });
    }
    scene.boundaries[own.body].mark_rims(&mut contacts, &own.facets, Some(&across.mesh));
    let met = contacts.iter().map(|contact| contact.node);
    let met: HashSet<usize> = met.chain(left_out.iter().copied()).collect();
    let covered = |facet: &&Facet| {
        let corners = facet.corners(dimension);
        corners.iter().all(|node| met.contains(node))
    };
    Ok(PairSurface {
        body: own.body,
        facets: own.facets.iter().filter(covered).cloned().collect(),
        contacts,
        left_out,
    })
}

/// Axes along which supports hold the node and most of what it meets; across the normal of a
/// quadratic facet any of it, as on a symmetry plane, where means reach inward.
fn still_axes(scene: &Bodies<'_>, own: usize, other: usize, node: &MortarNode) -> [bool; 3] {
    let dimension = scene.bodies[own].mesh.dimension;
    let held = |body: usize, node: usize, axis: usize| {
        scene.prescribed[body][node * dimension + axis].is_some()
    };
    std::array::from_fn(|axis| {
        axis < dimension && held(own, node.node, axis) && {
            let opposite = node.opposite.iter();
            let mut still = opposite.filter(|(across, _)| held(other, *across, axis));
            if node.own.len() > 1 && node.normal[axis].abs() < LEANING {
                return still.next().is_some();
            }
            node.own.iter().all(|(near, _)| held(own, *near, axis))
                && still.map(|(_, weight)| weight).sum::<f64>() > MOSTLY
        }
    })
}

/// The direction without its components along some axes; none if little is left.
fn across_axes(direction: [f64; 3], axes: [bool; 3]) -> Option<[f64; 3]> {
    let kept: [f64; 3] = std::array::from_fn(|i| if axes[i] { 0.0 } else { direction[i] });
    if kept == direction {
        return Some(direction);
    }
    let kept = Vector3::from(kept).try_normalize(LEANING)?;
    Some(kept.into())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::body::tests::samples::{block, facets, hold};
    use crate::body::{CellKind, prescribed};
    use crate::contact::{ContactSurface, Opposite};

    /// Two sample blocks, the second one shifted down to lie below the first, named first.
    fn stack(kind: CellKind) -> (Vec<Body>, ContactPair) {
        let (upper, mut lower) = (block(kind), block(kind));
        let up = kind.dimension() - 1;
        let heights = lower.mesh.nodes.iter().map(|at| at[up]);
        let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), z| {
            (low.min(z), high.max(z))
        });
        for at in &mut lower.mesh.nodes {
            at[up] -= high - low;
        }
        let pair = ContactPair {
            place: "contacts[0]".to_owned(),
            body: 0,
            facets: facets(&upper.mesh, "bottom"),
            opposite: Opposite::Surface {
                body: 1,
                facets: facets(&lower.mesh, "top"),
            },
            friction: 0.3,
        };
        (vec![upper, lower], pair)
    }

    fn find(bodies: &[Body], pair: &ContactPair) -> ContactSurface {
        let prescribed: Vec<_> = bodies.iter().map(|b| prescribed(b).unwrap()).collect();
        ContactSurface::new(bodies, std::slice::from_ref(pair), &prescribed).unwrap()
    }

    #[test]
    fn the_side_named_first_carries_the_contacts_unless_it_is_much_stiffer() {
        for kind in CellKind::LINEAR {
            let (mut bodies, pair) = stack(kind);
            let young = bodies[1].materials[0].young;
            for (ratio, carrier) in [(1e-9, 0), (99.0, 0), (101.0, 1)] {
                bodies[0].materials[0].young = ratio * young;
                let surface = find(&bodies, &pair);
                assert!(surface.nodes.iter().all(|contact| contact.body == carrier));
                assert!(surface.facets.iter().all(|(body, _)| *body == carrier));
                let normal = if carrier == 0 { -1.0 } else { 1.0 };
                let up = kind.dimension() - 1;
                assert!(surface.nodes.iter().all(|c| c.frame[0][up] == normal));
            }
        }
    }

    #[test]
    fn a_tangent_is_held_only_where_supports_hold_both_sides() {
        for kind in CellKind::LINEAR {
            let (mut bodies, pair) = stack(kind);
            let left = bodies[0].mesh.nodes.iter().map(|at| at[0]);
            let left = left.fold(f64::INFINITY, f64::min);
            let kept = |bodies: &[Body]| -> Vec<usize> {
                let nodes = find(bodies, &pair).nodes.into_iter();
                let nodes = nodes.filter(|contact| contact.position[0] == left);
                nodes.map(|contact| contact.tangents).collect()
            };
            let all = kind.dimension() - 1;
            hold(&mut bodies[0], "left", 0);
            assert!(kept(&bodies).iter().all(|tangents| *tangents == all));
            hold(&mut bodies[1], "left", 0);
            assert!(kept(&bodies).iter().all(|tangents| *tangents == all - 1));
        }
    }

    #[test]
    fn at_a_symmetry_plane_the_normal_lies_in_it() {
        // Both faces rise to the right: at the left end a facet's normal leans out of the plane.
        for kind in CellKind::LINEAR {
            let (mut bodies, pair) = stack(kind);
            let up = kind.dimension() - 1;
            for body in &mut bodies {
                for at in &mut body.mesh.nodes {
                    at[up] += 0.1 * at[0];
                }
                hold(body, "left", 0);
            }
            for contact in find(&bodies, &pair).nodes {
                let leaning = contact.frame[0][0];
                let on_plane = bodies[0]
                    .mesh
                    .nodes
                    .iter()
                    .all(|at| at[0] >= contact.position[0]);
                assert_eq!(leaning == 0.0, on_plane, "{kind:?} {contact:?}");
                assert!(contact.initial_gap.abs() < 1e-14);
            }
        }
    }

    #[test]
    fn a_contact_that_nothing_can_move_is_left_out() {
        for kind in CellKind::LINEAR {
            let (mut bodies, pair) = stack(kind);
            for body in &mut bodies {
                (0..kind.dimension()).for_each(|axis| hold(body, "left", axis));
            }
            let surface = find(&bodies, &pair);
            assert!(!surface.left_out.is_empty());
            for (body, node) in &surface.left_out {
                let own = surface.nodes.iter().filter(|contact| contact.body == *body);
                assert!(own.clone().all(|contact| contact.node != *node));
            }
        }
    }
}
