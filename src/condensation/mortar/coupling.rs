//! The coupling of two sides: facet by facet, then node by node.

use std::collections::HashMap;

use nalgebra::Vector3;

use super::alignment::align;
use super::check::geometries;
use super::cover::Opposite;
use super::projection::Projection;
use super::search::Bounds;
use super::view::View;
use super::{Mortar, MortarNode};
use crate::body::{Facet, Mesh};
use crate::error::Error;

/// Covered share of a node's tributary area below which the node is no contact.
const VANISHING: f64 = 1e-12;

/// Weight that is round-off.
const NEGLIGIBLE: f64 = 4.0 * f64::EPSILON;

/// Couples the nodes of side 1 to side 2; facets in outward order
/// ([`Mesh::orient`]), each listed once; `place` names the contact pair in messages.
///
/// The two sides may be faces of one mesh. Overlap is found down to half the diagonal
/// of side 1; in front there is no limit.
///
/// # Errors
///
/// Meshes of different dimension, what is no facet (a wrong number of nodes, a node that
/// does not exist, no area, a fold), and sides of which no part faces the other.
pub fn couple(
    mesh1: &Mesh,
    facets1: &[Facet],
    mesh2: &Mesh,
    facets2: &[Facet],
    place: &str,
) -> Result<Mortar, Error> {
    if mesh1.dimension != mesh2.dimension {
        return Err(Error::WrongDimension {
            place: format!("{place}.opposite"),
            expected: mesh1.dimension,
            found: mesh2.dimension,
        });
    }
    let geometries1 = geometries(mesh1, facets1, &format!("{place}.facets"))?;
    let geometries2 = geometries(mesh2, facets2, &format!("{place}.opposite"))?;
    let depth = Bounds::around(mesh1, facets1.iter()).diagonal() / 2.0;
    let opposite = Opposite::new(mesh2, facets2, &geometries2, depth);
    let mut gathered = Gathered::default();
    let mut averted = 0;
    for (facet, geometry) in facets1.iter().zip(&geometries1) {
        let view = View::new(mesh1, facet);
        let outline = view.outline(mesh1, facet);
        let (parts, turned) = opposite.parts(&view, &outline);
        averted += turned;
        let projection = Projection::new(&view, &outline, facet.nodes.len(), &parts, facets2);
        gathered.add(facet, &geometry.weights, &projection);
    }
    let same_mesh = std::ptr::eq(mesh1, mesh2);
    let mut mortar = Mortar::default();
    for share in gathered.shares {
        let node = share.contact(mesh1, mesh2, place)?;
        // A node that both faces share, as at the tip of a crack, has nothing to touch.
        let itself = |node: &MortarNode| same_mesh && node.opposite == [(node.node, 1.0)];
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
    /// `D_ei P_eik` per node of side 2, unsorted, in m² (2D: metre).
    opposite: Vec<(usize, f64)>,
}

impl Gathered {
    fn add(&mut self, facet: &Facet, weights: &[f64; 4], projection: &Projection) {
        for (local, &node) in facet.nodes.iter().enumerate() {
            let place = *self.place_of_node.entry(node).or_insert(self.shares.len());
            if place == self.shares.len() {
                self.shares.push(Share {
                    node,
                    ..Share::default()
                });
            }
            let share = &mut self.shares[place];
            let area = projection.areas[local];
            share.support += weights[local];
            share.weight += area;
            share.vector += projection.vectors[local];
            let columns = projection.columns.iter();
            let entries = columns.map(|(across, column)| (*across, area * column[local]));
            share.opposite.extend(entries);
        }
    }
}

impl Share {
    /// The contact of the node (C9); none if nothing covers it.
    fn contact(
        mut self,
        mesh1: &Mesh,
        mesh2: &Mesh,
        place: &str,
    ) -> Result<Option<MortarNode>, Error> {
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
        let position = mesh1.nodes[self.node];
        self.sum_up();
        align(
            &mut self.opposite,
            &mesh2.nodes,
            position,
            normal,
            mesh1.dimension,
        );
        let x = Vector3::from(position);
        let terms = self.opposite.iter();
        let gap_vector: Vector3<f64> = terms
            .map(|(k, weight)| (Vector3::from(mesh2.nodes[*k]) - x) * *weight)
            .sum();
        Ok(Some(MortarNode {
            node: self.node,
            weight: self.weight,
            normal: normal.into(),
            opposite: self.opposite,
            gap_vector: gap_vector.into(),
            initial_gap: gap_vector.dot(&normal),
            covered: (self.weight / self.support).min(1.0),
        }))
    }

    /// Weights per node of side 2 that sum to one, without those that are round-off.
    fn sum_up(&mut self) {
        self.opposite.sort_by_key(|entry| entry.0);
        self.opposite.dedup_by(|next, kept| {
            let same = next.0 == kept.0;
            kept.1 += if same { next.1 } else { 0.0 };
            same
        });
        let total: f64 = self.opposite.iter().map(|entry| entry.1).sum();
        self.opposite
            .retain(|entry| entry.1.abs() > NEGLIGIBLE * total);
        let total: f64 = self.opposite.iter().map(|entry| entry.1).sum();
        for entry in &mut self.opposite {
            entry.1 /= total;
        }
    }
}
