//! The contact surface: where its contacts are, and its facets as small pieces between drawn points.

use std::collections::HashMap;

use serde::Serialize;

use super::arc::arcs;
use super::packed::Packed;
use super::skin::Skin;
use crate::body::{Body, Facet, FacetReference};
use crate::report::Contact;

/// Most corners of a facet.
const CORNERS: usize = 4;

/// Where the contacts are; numbers per contact, vectors with three components.
#[derive(Debug, Serialize)]
pub(super) struct DrawnContacts {
    body: Packed,
    node: Packed,
    pair: Packed,
    /// Relative to the scene's origin.
    positions: Packed,
    normals: Packed,
    /// Number of the chain of facets, and distance along it; in 2D only, NaN beside the facets.
    chain: Packed,
    arc: Packed,
}

/// Facets of the contact surface in small pieces: lines in 2D, triangles in 3D.
#[derive(Debug, Default, Serialize)]
pub(super) struct DrawnSurface {
    /// Body, and drawn point of it, of every point of the surface.
    body: Packed,
    point: Packed,
    /// Contacts between which a value at the point is interpolated, and their shares: four per point,
    /// the largest integer where there is none.
    contacts: Packed,
    shares: Packed,
    /// Points of the pieces.
    pieces: Packed,
    /// Facet of every piece, and the contacts at the corners of every facet, four per facet.
    facet: Packed,
    corners: Packed,
}

impl DrawnContacts {
    pub(super) fn new(
        contacts: &[Contact],
        bodies: &[Body],
        facets: &[(usize, Facet)],
        origin: [f64; 3],
    ) -> Self {
        let of = |value: fn(&Contact) -> usize| {
            Packed::integers(contacts.iter().map(move |contact| value(contact) as u32))
        };
        let arcs = match bodies.first().map(|body| body.mesh.dimension) {
            Some(2) => plane_arcs(bodies, facets),
            _ => HashMap::new(),
        };
        let arc = |contact: &Contact| arcs.get(&(contact.body, contact.node)).copied();
        let positions = contacts.iter().flat_map(|contact| {
            let axes = [0, 1, 2].map(|axis| contact.position.get(axis).copied().unwrap_or(0.0));
            [0, 1, 2].map(|axis| axes[axis] - origin[axis])
        });
        let normals = contacts.iter().flat_map(|contact| padded(&contact.normal));
        Self {
            body: of(|contact| contact.body),
            node: of(|contact| contact.node),
            pair: of(|contact| contact.pair),
            positions: Packed::reals(positions),
            normals: Packed::reals(normals),
            chain: Packed::integers(contacts.iter().map(|c| arc(c).map_or(0, |arc| arc.0))),
            arc: Packed::reals(
                contacts
                    .iter()
                    .map(|c| arc(c).map_or(f64::NAN, |arc| arc.1)),
            ),
        }
    }
}

/// A vector of the bodies' dimension with three components.
pub(super) fn padded(vector: &[f64]) -> [f64; 3] {
    [0, 1, 2].map(|axis| vector.get(axis).copied().unwrap_or(0.0))
}

fn plane_arcs(bodies: &[Body], facets: &[(usize, Facet)]) -> HashMap<(usize, usize), (u32, f64)> {
    let ends = facets
        .iter()
        .filter_map(|(body, facet)| match facet.nodes[..] {
            [first, last, ..] => Some((*body, first, last)),
            _ => None,
        });
    let links: Vec<_> = ends.collect();
    let length = |at: usize| {
        let (body, facet) = &facets[at];
        bodies[*body].mesh.facet_geometry(facet).area
    };
    arcs(&links, length, |body, node| bodies[body].mesh.nodes[node])
}

impl DrawnSurface {
    /// Adds the points that it needs to the skins.
    pub(super) fn new(
        contacts: &[Contact],
        skins: &mut [Skin],
        facets: &[(usize, Facet)],
        dimension: usize,
    ) -> Self {
        let mut contact_at = HashMap::new();
        for (index, contact) in contacts.iter().enumerate() {
            contact_at
                .entry((contact.body, contact.node))
                .or_insert(index as u32);
        }
        let (mut body_of, mut point_of, mut of_point, mut shares) =
            (vec![], vec![], vec![], vec![]);
        let (mut pieces, mut facet_of, mut corners_of) = (vec![], vec![], vec![]);
        for (number, (body, facet)) in facets.iter().enumerate() {
            let Some(reference) = FacetReference::of(dimension, facet.nodes.len()) else {
                continue;
            };
            let first = body_of.len() as u32;
            let mut corners = [u32::MAX; CORNERS];
            for (corner, node) in corners.iter_mut().zip(facet.corners(dimension)) {
                *corner = contact_at.get(&(*body, *node)).copied().unwrap_or(u32::MAX);
            }
            let (lattice, places) = skins[*body].lattice(reference, &facet.nodes);
            for (place, &at) in places.into_iter().zip(&lattice.points) {
                body_of.push(*body as u32);
                point_of.push(place);
                of_point.extend(corners);
                let mut hats = reference.hats(at);
                hats.resize(CORNERS, 0.0);
                shares.extend(hats);
            }
            for piece in &lattice.pieces {
                pieces.extend(piece.iter().map(|at| first + at));
                facet_of.push(number as u32);
            }
            corners_of.extend(corners);
        }
        Self {
            body: Packed::integers(body_of),
            point: Packed::integers(point_of),
            contacts: Packed::integers(of_point),
            shares: Packed::reals(shares),
            pieces: Packed::integers(pieces),
            facet: Packed::integers(facet_of),
            corners: Packed::integers(corners_of),
        }
    }
}
