//! Which facets of the body look at an obstacle, and where the surface goes on.
//!
//! ```text
//! facing    m · n > 0         m: outward normal of the facet, n: direction to the obstacle
//! rim       m' · n > ½        m': outward normal of a neighbour outside the contact pair
//! ```
//!
//! Facets that look away from the obstacle, or along it, take no part: an assumed
//! surface may grow over sides and back without changing the problem.

use std::collections::{HashMap, HashSet};
use std::sync::OnceLock;

use nalgebra::Vector3;

use super::held::Directions;
use super::mirror::Mirrors;
use super::repeated::Seams;
use super::rounding::{Bulges, Turns};
use super::{ContactNode, ContactPair, Obstacle};
use crate::body::{Body, Dependence, Facet, FacetGeometry, Mesh};
use crate::error::Error;

/// Cosine between a facet's normal and the direction to the obstacle, above which it faces it.
const FACING: f64 = 1e-6;

/// Cosine above which a neighbouring facet continues the surface and does not turn a corner.
const SMOOTH: f64 = 0.5;

/// Cosine above which a neighbouring facet goes straight on.
const STRAIGHT_ON: f64 = 0.99;

/// Part of the way to the middle of the next facet beyond which a body goes on.
const BEYOND: f64 = 0.1;

/// The facets of the body's boundary, found by their nodes.
pub(super) struct Boundary<'a> {
    body: &'a Body,
    facets: Vec<Facet>,
    index_of: HashMap<Vec<usize>, usize>,
    turns: OnceLock<Turns>,
}

/// Bodies of a scene with what is known of each.
pub(super) struct Bodies<'a> {
    pub(super) bodies: &'a [Body],
    pub(super) boundaries: &'a [Boundary<'a>],
    /// Prescribed displacement per body and degree of freedom.
    pub(super) prescribed: &'a [Vec<Option<f64>>],
    /// What depends on what, per body.
    pub(super) tied: &'a [Option<Dependence>],
}

impl Bodies<'_> {
    /// Directions along which a node is held.
    pub(super) fn held(&self, body: usize, node: usize) -> Directions {
        let (prescribed, tied) = (&self.prescribed[body], self.tied[body].as_ref());
        let dimension = self.bodies[body].mesh.dimension;
        Directions::of(prescribed, tied, dimension, node)
    }

    /// How far the smooth surface stands off facets of a boundary; it counts in gaps or not.
    pub(super) fn bulges(&self, body: usize, facets: &[Facet], rounded: bool) -> Bulges {
        let (mesh, boundary) = (&self.bodies[body].mesh, &self.boundaries[body]);
        let turns = boundary.turns.get_or_init(|| {
            let held = |node| self.held(body, node);
            let mirrors = Mirrors::new(mesh, &boundary.facets, held);
            let seams = Seams::new(&self.bodies[body]);
            Turns::new(mesh, &boundary.facets, &mirrors, &seams)
        });
        turns.bulges(mesh, facets, rounded)
    }

    /// By how much supports move a node along a direction, in metre; zero where it is free.
    pub(super) fn given_along(&self, body: usize, node: usize, direction: &Vector3<f64>) -> f64 {
        let dimension = self.bodies[body].mesh.dimension;
        let given = |axis: usize| {
            let unknown = dimension * node + axis;
            match &self.tied[body] {
                Some(tied) => tied.stated(unknown),
                None => self.prescribed[body][unknown].unwrap_or(0.0),
            }
        };
        let held = self.held(body, node).hold(direction);
        let along = (0..dimension).map(|axis| direction[axis] * given(axis));
        if held { along.sum() } else { 0.0 }
    }
}

impl<'a> Boundary<'a> {
    pub(super) fn new(body: &'a Body) -> Self {
        let facets = body.mesh.boundary_facets();
        let keyed = facets.iter().enumerate();
        let index_of = keyed.map(|(index, facet)| (key(facet), index)).collect();
        Self {
            body,
            facets,
            index_of,
            turns: OnceLock::new(),
        }
    }

    /// Where some lines of the boundary end, the direction in which the boundary turns away from there, in
    /// metre; none of faces, nor where it goes straight on.
    pub(super) fn flanks(&self, facets: &[Facet]) -> HashMap<usize, Vector3<f64>> {
        let mesh = &self.body.mesh;
        if mesh.dimension != 2 {
            return HashMap::new();
        }
        let mut reached: HashMap<usize, Vec<Vector3<f64>>> = HashMap::new();
        for facet in facets {
            let normal = Vector3::from(mesh.facet_geometry(facet).normal);
            for &node in facet.corners(2) {
                reached.entry(node).or_default().push(normal);
            }
        }
        let within: HashSet<Vec<usize>> = facets.iter().map(key).collect();
        let beyond = self.facets.iter().filter(|at| !within.contains(&key(at)));
        let mut flanks: HashMap<usize, Vector3<f64>> = HashMap::new();
        for facet in beyond {
            let normal = Vector3::from(mesh.facet_geometry(facet).normal);
            for &node in facet.corners(2) {
                let ends_here = match reached.get(&node).map(Vec::as_slice) {
                    Some([last]) => last.dot(&normal) < STRAIGHT_ON,
                    _ => false,
                };
                if !ends_here {
                    continue;
                }
                let from = Vector3::from(mesh.nodes[node]);
                let others = facet.nodes.iter().filter(|other| **other != node);
                let ways = others.map(|&other| Vector3::from(mesh.nodes[other]) - from);
                let nearest = ways.min_by(|a, b| a.norm().total_cmp(&b.norm()));
                flanks.extend(nearest.map(|way| (node, way)));
            }
        }
        flanks
    }

    /// Facets of the boundary in outward order, each once.
    pub(super) fn outward(&self, facets: &[Facet], place: &str) -> Result<Vec<Facet>, Error> {
        let mut seen = HashSet::new();
        let mut outward = Vec::with_capacity(facets.len());
        for (at, facet) in facets.iter().enumerate() {
            let Some(&index) = self.index_of.get(&key(facet)) else {
                return Err(self.refuse(facet, format!("{place}[{at}]")));
            };
            if seen.insert(index) {
                outward.push(self.facets[index].clone());
            }
        }
        Ok(outward)
    }

    /// The facets of a pair that face its obstacle, each once.
    pub(super) fn facing(
        &self,
        pair: &ContactPair,
        obstacle: &Obstacle,
    ) -> Result<Vec<(Facet, FacetGeometry)>, Error> {
        let mut facing = Vec::new();
        for facet in self.outward(&pair.facets, &format!("{}.facets", pair.place))? {
            let geometry = self.body.facet_geometry(&facet);
            let seen_from = obstacle.closest(&pair.place, self.centre(&facet))?;
            if !seen_from.beyond && cosine(geometry.normal, seen_from.direction) > FACING {
                facing.push((facet, geometry));
            }
        }
        if facing.is_empty() {
            return Err(Error::NothingFacesObstacle {
                place: pair.place.clone(),
                facets: pair.facets.len(),
            });
        }
        Ok(facing)
    }

    /// Why a facet is not one of the boundary.
    fn refuse(&self, facet: &Facet, place: String) -> Error {
        let cells = match self.body.mesh.orient(std::slice::from_ref(facet)) {
            Err(Error::FacetOwners { cells, .. }) => cells,
            _ => 0,
        };
        Error::FacetOwners {
            place,
            nodes: facet.nodes.clone(),
            cells,
        }
    }

    /// Mean of the nodes, in metre.
    fn centre(&self, facet: &Facet) -> [f64; 3] {
        let nodes = facet.nodes.iter();
        let sum: Vector3<f64> = nodes
            .map(|&node| Vector3::from(self.body.mesh.nodes[node]))
            .sum();
        (sum / facet.nodes.len() as f64).into()
    }

    /// Marks contacts of a pair where a boundary facet outside it goes on in the same direction, and
    /// the `other` body goes on along it, if it is no obstacle.
    pub(super) fn mark_rims(
        &self,
        contacts: &mut [ContactNode],
        of_pair: &[Facet],
        other: Option<&Mesh>,
    ) {
        let within: HashSet<Vec<usize>> = of_pair.iter().map(key).collect();
        let numbered = contacts.iter().enumerate();
        let contact_of_node: HashMap<usize, usize> = numbered
            .map(|(index, contact)| (contact.node, index))
            .collect();
        for facet in self
            .facets
            .iter()
            .filter(|facet| !within.contains(&key(facet)))
        {
            for contact in facet
                .nodes
                .iter()
                .filter_map(|node| contact_of_node.get(node))
            {
                let contact = &mut contacts[*contact];
                let normal = self.body.facet_geometry(facet).normal;
                contact.rim |= cosine(normal, contact.frame[0]) > SMOOTH
                    && other.is_none_or(|other| goes_on(other, contact, self.centre(facet)));
            }
        }
    }
}

/// A body that a contact faces reaches beyond it, on the way along the surface to `beyond`.
fn goes_on(other: &Mesh, contact: &ContactNode, beyond: [f64; 3]) -> bool {
    let (at, normal) = (
        Vector3::from(contact.position),
        Vector3::from(contact.frame[0]),
    );
    let way = Vector3::from(beyond) - at;
    let way = way - normal * normal.dot(&way);
    let mut nodes = other.nodes.iter().map(|node| Vector3::from(*node) - at);
    nodes.any(|node| {
        let near = (node.dot(&normal) - contact.initial_gap).abs() < way.norm();
        near && node.dot(&way) > BEYOND * way.norm_squared()
    })
}

/// The nodes of a facet in ascending order, the same from both sides.
pub(crate) fn key(facet: &Facet) -> Vec<usize> {
    let mut nodes = facet.nodes.clone();
    nodes.sort_unstable();
    nodes
}

fn cosine(a: [f64; 3], b: [f64; 3]) -> f64 {
    Vector3::from(a).dot(&Vector3::from(b))
}
