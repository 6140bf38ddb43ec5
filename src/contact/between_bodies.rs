//! The contacts of a pair of surfaces, one per node of one side that the other covers;
//! `carrying_side` says which side.
//!
//! Along an axis that supports hold on both sides nothing moves, so a contact has no unknown
//! there; on a symmetry plane its normal lies in the plane, and its weights are those of the node
//! in the whole, as if mirrored facets went on beyond it.

use std::collections::HashSet;

use nalgebra::Vector3;

use super::carrying_side::{carrying, softest};
use super::facing::Bodies;
use super::frame::Stance;
use super::held::Directions;
use super::mortar::{self, Coverage, MortarNode, Surface};
use super::pair::{Coupling, PairSurface, check_pair_body};
use super::repeated;
use super::{ContactNode, ContactPair, OppositeNodes};
use crate::body::{Body, Facet, Model};
use crate::error::Error;

/// Weight of the other side's held nodes beyond which it does not move.
const MOSTLY: f64 = 0.5;

/// Part of a normal across the axes along which nothing moves, below which it is held.
const LEANING: f64 = 0.5;

/// Motions that cancel to this part of their size do.
const ROUNDED: f64 = 1e-12;

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
    let young = [&first, &second].map(|side| softest(&scene.bodies[side.body], &side.facets));
    let of = |side, place: &str, young: f64| -> Result<Surface<'_>, Error> {
        Ok(surface(scene, pair, side, place)?.giving_way(young.recip()))
    };
    let surfaces = [
        of(&first, &format!("{}.facets", pair.place), young[0])?,
        of(&second, &place, young[1])?,
    ];
    let [one, two] = &surfaces;
    match carrying([one, two], young, &pair.place)? {
        (coverage, false) => contacts(scene, pair, &coverage, [&first, &second], false),
        (coverage, true) => contacts(scene, pair, &coverage, [&second, &first], true),
    }
}

/// The surface of a side, with what its facets stand for and where the body goes on.
fn surface<'a>(
    scene: &Bodies<'a>,
    pair: &ContactPair,
    side: &'a Side,
    place: &str,
) -> Result<Surface<'a>, Error> {
    let boundary = &scene.boundaries[side.body];
    let bulges = scene.bulges(side.body, &side.facets, pair.rounded);
    let surface = Surface::new(&scene.bodies[side.body].mesh, &side.facets, place)?;
    Ok(surface.with(bulges, boundary.flanks(&side.facets)))
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

/// The contacts on the side whose coverage is given: that of the pair's `second` surface or of its first.
fn contacts(
    scene: &Bodies<'_>,
    pair: &ContactPair,
    coverage: &Coverage<'_>,
    [own, other]: [&Side; 2],
    second: bool,
) -> Result<PairSurface, Error> {
    let (body, across) = (&scene.bodies[own.body], &scene.bodies[other.body]);
    let dimension = body.mesh.dimension;
    let mut coupled = mortar::average(coverage, body.model, &pair.place)?;
    let mut stances = Vec::with_capacity(coupled.nodes.len());
    for node in &mut coupled.nodes {
        let still = still_directions(scene, own.body, other.body, node);
        let normal = across_directions(node.normal, &still);
        node.look_along(
            normal.unwrap_or(node.normal),
            &still,
            &body.mesh,
            &across.mesh,
        );
        stances.push(match normal {
            Some(_) => Stance::new(dimension, node.normal, &still),
            None => Stance::Held,
        });
    }
    coupled.lift();
    let (mut contacts, mut left_out) = (Vec::new(), Vec::new());
    for (node, stance) in coupled.nodes.into_iter().zip(stances) {
        let Stance::Free { frame, kept } = stance else {
            left_out.push(node.node);
            continue;
        };
        let position = match node.moved {
            true => node.centre(&body.mesh).into(),
            false => body.mesh.nodes[node.node],
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
            position,
            frame,
            tangents: if pair.law.is_smooth(pair.friction) {
                0
            } else {
                kept
            },
            initial_gap: node.initial_gap,
            // Plates of unlike thickness meet over the thinner one.
            area: node.weight * body.model.depth().min(across.model.depth()),
            bulge: node.bulge,
            second,
            rim: false,
        });
    }
    let mut contacts = repeated::join(contacts, scene.bodies);
    scene.boundaries[own.body].mark_rims(&mut contacts, &own.facets, Some(&across.mesh));
    let [met, met_across] = coverage.met();
    let (rounded, largest_bulge) = coverage.rounded([&met, &met_across]);
    Ok(PairSurface {
        coupling: Coupling {
            body: own.body,
            second,
            rounded,
            largest_bulge,
        },
        facets: met.iter().map(|&facet| own.facets[facet].clone()).collect(),
        contacts,
        left_out,
    })
}

/// Directions along which supports hold the contact and most of what it meets; at the corner of a quadratic
/// facet, across its normal any of it, as on a symmetry plane, where means reach inward.
fn still_directions(scene: &Bodies<'_>, own: usize, other: usize, node: &MortarNode) -> Directions {
    let dimension = scene.bodies[own].mesh.dimension;
    let (normal, corner) = (Vector3::from(node.normal), scene.held(own, node.node));
    let own_nodes = node.own.iter().map(|(near, _)| scene.held(own, *near));
    let near: Vec<Directions> = own_nodes.collect();
    let met: Vec<(Directions, f64)> = node
        .met()
        .map(|(across, weight)| (scene.held(other, across), weight))
        .collect();
    let oblique = std::iter::once(&corner).chain(&near);
    let oblique = oblique.clone().find(|held| !held.are_axes());
    let axes: Directions = [true, true, dimension == 3].into();
    let Directions(mut candidates) = match oblique {
        Some(held) => held.clone().led_by(normal),
        // Of a corner that is held along several axes all between them are as good.
        None if corner.0.len() > 1 => corner.clone().led_by(normal).and_across(axes),
        None => axes,
    };
    candidates.retain(|direction| {
        if normal.dot(direction).abs() < LEANING
            && drawn_apart(scene, [own, other], node, direction)
        {
            return false;
        }
        let at_corner = corner.hold(direction);
        let mut still = met.iter().filter(|(held, _)| held.hold(direction));
        // What has moved along a line has left the plane that holds its corner, but not along a face.
        let beside = node.own.len() > 1 && (dimension == 3 || !node.moved);
        if at_corner && beside && normal.dot(direction).abs() < LEANING {
            return still.next().is_some();
        }
        (at_corner || node.moved)
            && near.iter().all(|held| held.hold(direction))
            && still.map(|(_, weight)| weight).sum::<f64>() > MOSTLY
    });
    Directions(candidates)
}

/// Whether supports move a corner and what it meets against each other along a direction, along which friction then acts.
fn drawn_apart(
    scene: &Bodies<'_>,
    [own, other]: [usize; 2],
    node: &MortarNode,
    direction: &Vector3<f64>,
) -> bool {
    let met = node.met().map(|(across, weight)| (across, weight.abs()));
    let held = met.filter(|(across, _)| scene.held(other, *across).hold(direction));
    let given = held.map(|(across, weight)| (scene.given_along(other, across, direction), weight));
    let (sum, weights) = given.fold((0.0, 0.0), |(sum, all), (u, weight)| {
        (sum + weight * u, all + weight)
    });
    if weights == 0.0 || !scene.held(own, node.node).hold(direction) {
        return false;
    }
    let (corner, across) = (scene.given_along(own, node.node, direction), sum / weights);
    (corner - across).abs() > ROUNDED * corner.abs().max(across.abs())
}

/// The direction without its components along some others; none if little is left.
fn across_directions(direction: [f64; 3], still: &Directions) -> Option<[f64; 3]> {
    let kept = still.across(direction.into());
    if kept == Vector3::from(direction) {
        return Some(direction);
    }
    let kept = kept.try_normalize(LEANING)?;
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
        let pair = ContactPair::new(
            "contacts[0]",
            0,
            facets(&upper.mesh, "bottom"),
            Opposite::Surface {
                body: 1,
                facets: facets(&lower.mesh, "top"),
            },
            0.3,
        );
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
