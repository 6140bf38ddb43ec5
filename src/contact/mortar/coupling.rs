//! The coupling of two sides: facet by facet, then node by node.

use std::collections::HashMap;

use nalgebra::Vector3;

use super::alignment::align;
use super::check::Surface;
use super::cover::Opposite;
use super::overlap::Overlaps;
use super::projection::Projection;
use super::search::Bounds;
use super::view::View;
use super::{Mortar, MortarNode};
use crate::body::{Facet, Mesh, Model};
use crate::error::Error;

/// Covered share of a node's tributary area below which the node is no contact.
const VANISHING: f64 = 1e-12;

/// Interference that is believed, of the diagonal of the smaller side: more is no fit, and beyond
/// small displacements.
const INTERFERENCE: f64 = 0.05;

/// Part of a limit that is round-off of the coordinates: what is stated to be just within it is.
const WITHIN: f64 = 1.0 + 1e-9;

/// Weight that is round-off.
const NEGLIGIBLE: f64 = 4.0 * f64::EPSILON;

/// Couples the nodes of side 1 to side 2; facets in outward order
/// ([`Mesh::orient`]), each listed once; `model` is that of the bodies, whose areas go around the
/// axis if they are axisymmetric; `place` names the contact pair in messages.
///
/// The two sides may be faces of one mesh. In front there is no limit to the distance;
/// overlap counts as an interference fit down to a twentieth of the diagonal of the
/// smaller side.
///
/// # Errors
///
/// Meshes of different dimension, what is no facet (a wrong number of nodes, a node that
/// does not exist, no area, a fold), bodies that overlap deeper, and sides of which no part
/// faces the other.
#[cfg(test)]
pub(in crate::contact) fn couple(
    mesh1: &Mesh,
    facets1: &[Facet],
    mesh2: &Mesh,
    facets2: &[Facet],
    model: Model,
    place: &str,
) -> Result<Mortar, Error> {
    let mut mortar = average(mesh1, facets1, mesh2, facets2, model, place)?;
    for node in &mut mortar.nodes {
        node.look_along(node.normal, [false; 3], mesh1, mesh2);
    }
    Ok(mortar)
}

/// The same up to (C9): weights and mean normals, but no gaps. What supports hold may still turn
/// a normal ([`MortarNode::look_along`]).
pub(in crate::contact) fn average(
    mesh1: &Mesh,
    facets1: &[Facet],
    mesh2: &Mesh,
    facets2: &[Facet],
    model: Model,
    place: &str,
) -> Result<Mortar, Error> {
    if mesh1.dimension != mesh2.dimension {
        return Err(Error::WrongDimension {
            place: format!("{place}.opposite"),
            expected: mesh1.dimension,
            found: mesh2.dimension,
        });
    }
    let side1 = Surface::new(mesh1, facets1, &format!("{place}.facets"))?;
    let side2 = Surface::new(mesh2, facets2, &format!("{place}.opposite"))?;
    let extents = [(mesh1, facets1), (mesh2, facets2)]
        .map(|(mesh, facets)| Bounds::around(mesh, facets.iter()).diagonal());
    let depth = WITHIN * INTERFERENCE * extents[0].min(extents[1]);
    let reach = extents[0].max(extents[1]);
    let opposite = Opposite::new(mesh2, &side2.facets, &side2.geometries, [depth, reach]);
    let overlaps = Overlaps::new(mesh1, mesh2);
    let mut gathered = Gathered::default();
    let mut averted = 0;
    for piece in &side1.pieces {
        let view = View::new(mesh1, &piece.corners);
        let outline = view.outline(mesh1, &piece.corners);
        let cover = opposite.cover(&view, &outline);
        averted += cover.averted;
        if let Some(span) = cover.behind.filter(|span| overlaps.encloses(span)) {
            return Err(Error::Overlap {
                place: place.to_owned(),
                position: span.from.into(),
                overlap: span.length(),
                allowed: depth / WITHIN,
            });
        }
        let pieces2 = &side2.pieces;
        let projection = Projection::new(&view, &outline, piece, &cover.parts, pieces2, model);
        gathered.add(piece.facet.corners(mesh1.dimension), &projection);
    }
    for facet in facets1 {
        gathered.support(mesh1, facet, model);
    }
    let same_mesh = std::ptr::eq(mesh1, mesh2);
    let mut mortar = Mortar::default();
    for share in gathered.shares {
        let node = share.contact(place)?;
        // A node that both faces share, as at the tip of a crack, has nothing to touch.
        let itself = |node: &MortarNode| {
            let mut others = node.opposite.iter().filter(|entry| entry.0 != node.node);
            same_mesh && others.all(|(_, weight)| weight.abs() < NEGLIGIBLE.sqrt())
        };
        mortar.nodes.extend(node.filter(|node| !itself(node)));
    }
    if mortar.nodes.is_empty() {
        return Err(Error::NothingFacesOpposite {
            place: place.to_owned(),
            facets: facets1.len(),
            opposite: facets2.len(),
            averted,
        });
    }
    Ok(mortar)
}

/// Sums over the facets around each node, in the order in which facets name the nodes.
#[derive(Default)]
struct Gathered {
    shares: Vec<Share>,
    place_of_node: HashMap<usize, usize>,
}

#[derive(Default)]
struct Share {
    node: usize,
    /// Whole tributary area and its covered part `D_i`, in m² (2D: metre).
    support: f64,
    weight: f64,
    /// `∫ N_i n dA`, in m² (2D: metre).
    vector: Vector3<f64>,
    /// `D_ei`, or `∫ ψ_i N_k dA` per node of side 1, unsorted, in m² (2D: metre).
    own: Vec<(usize, f64)>,
    /// `D_ei P_eik` per node of side 2, unsorted, in m² (2D: metre).
    opposite: Vec<(usize, f64)>,
}

impl Gathered {
    fn of(&mut self, node: usize) -> &mut Share {
        let place = *self.place_of_node.entry(node).or_insert(self.shares.len());
        if place == self.shares.len() {
            self.shares.push(Share {
                node,
                ..Share::default()
            });
        }
        &mut self.shares[place]
    }

    /// Adds the share of one piece, at the corners of its facet.
    fn add(&mut self, corners: &[usize], projection: &Projection) {
        for (local, &node) in corners.iter().enumerate() {
            let share = self.of(node);
            share.weight += projection.areas[local];
            share.vector += projection.vectors[local];
            let entry = |(node, column): &(usize, [f64; 4])| (*node, column[local]);
            let own = projection.own.iter().map(entry);
            share.own.extend(own.filter(|(_, weight)| *weight != 0.0));
            share.opposite.extend(projection.columns.iter().map(entry));
        }
    }

    /// Adds the whole areas of the corners of a facet.
    fn support(&mut self, mesh: &Mesh, facet: &Facet, model: Model) {
        let corners = facet.corners(mesh.dimension);
        if model != Model::Axisymmetric && corners.len() == facet.nodes.len() {
            let geometry = mesh.facet_geometry(facet);
            for (node, weight) in corners.iter().zip(geometry.weights) {
                self.of(*node).support += weight;
            }
            return;
        }
        for point in mesh.facet_points(facet, model) {
            let area = point.vector.norm();
            for (node, hat) in corners.iter().zip(point.hats) {
                self.of(*node).support += hat * area;
            }
        }
    }
}

impl MortarNode {
    /// Makes a unit vector the normal: the weights follow (C10), and the gap. Across it, axes may
    /// be `still`: nothing moves along them.
    pub(in crate::contact) fn look_along(
        &mut self,
        normal: [f64; 3],
        still: [bool; 3],
        mesh1: &Mesh,
        mesh2: &Mesh,
    ) {
        let terms = self.own.iter();
        let centre: Vector3<f64> = terms
            .map(|(k, weight)| Vector3::from(mesh1.nodes[*k]) * *weight)
            .sum();
        let direction = Vector3::from(normal);
        let weights = &mut self.opposite;
        align(weights, &mesh2.nodes, centre.into(), direction, still);
        let x = centre;
        let terms = self.opposite.iter();
        let gap_vector: Vector3<f64> = terms
            .map(|(k, weight)| (Vector3::from(mesh2.nodes[*k]) - x) * *weight)
            .sum();
        self.normal = normal;
        self.gap_vector = gap_vector.into();
        self.initial_gap = gap_vector.dot(&direction);
    }
}

impl Share {
    /// The contact of the node (C9); none if nothing covers it.
    fn contact(self, place: &str) -> Result<Option<MortarNode>, Error> {
        if self.weight <= VANISHING * self.support {
            return Ok(None);
        }
        let Some(normal) = self.vector.try_normalize(VANISHING * self.weight) else {
            return Err(Error::Direction {
                place: format!("{place}: node {}", self.node),
                value: self.vector.into(),
                accepted: "facets around a node that do not look opposite ways",
            });
        };
        Ok(Some(MortarNode {
            node: self.node,
            own: means(self.own),
            weight: self.weight,
            normal: normal.into(),
            opposite: means(self.opposite),
            gap_vector: [0.0; 3],
            initial_gap: 0.0,
            covered: (self.weight / self.support).min(1.0),
        }))
    }
}

/// Weights per node that sum to one, ascending, without those that are round-off, from shares.
fn means(mut shares: Vec<(usize, f64)>) -> Vec<(usize, f64)> {
    shares.sort_by_key(|entry| entry.0);
    shares.dedup_by(|next, kept| {
        let same = next.0 == kept.0;
        kept.1 += if same { next.1 } else { 0.0 };
        same
    });
    let total: f64 = shares.iter().map(|entry| entry.1).sum();
    shares.retain(|entry| entry.1.abs() > NEGLIGIBLE * total);
    let total: f64 = shares.iter().map(|entry| entry.1).sum();
    for entry in &mut shares {
        entry.1 /= total;
    }
    shares
}
