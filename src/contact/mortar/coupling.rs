//! The coupling of two sides: patch by patch, then contact by contact.

use std::collections::HashMap;

use nalgebra::Vector3;

use super::super::held::Directions;
use super::super::lift::{Distances, lifts};
use super::alignment::{align, follow, is_across};
use super::check::Surface;
#[cfg(test)]
use super::check::check_dimensions;
use super::coverage::Coverage;
use super::join::join;
use super::patch::{Patch, Stand};
use super::projection::{Projection, nearer};
use super::tiling;
use super::trim::{Strip, strips};
use super::{Mortar, MortarNode};
#[cfg(test)]
use crate::body::Facet;
use crate::body::{Mesh, Model};
use crate::error::{Error, check_finite};

/// Part of its farthest coordinate that any node counts as away, so that round-off of coordinates is none of a
/// gap's direction.
const COORDINATE: f64 = 1e-5;

/// Covered share of a node's tributary area below which the node is no contact.
const VANISHING: f64 = 1e-12;

/// Weight that is round-off.
const NEGLIGIBLE: f64 = 4.0 * f64::EPSILON;

/// Couples the nodes of side 1 to side 2; facets in outward order
/// ([`Mesh::orient`]), each listed once; `model` is that of the bodies, whose areas go around the
/// axis if they are axisymmetric; `place` names the contact pair in messages.
///
/// The two sides may be faces of one mesh. In front there is no limit to the distance;
/// overlap counts as an interference fit down to a twentieth of the diagonal of the
/// smaller side. Facets stand for themselves: nothing is rounded.
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
    check_dimensions(mesh1, mesh2, place)?;
    let side1 = Surface::new(mesh1, facets1, &format!("{place}.facets"))?;
    let side2 = Surface::new(mesh2, facets2, &format!("{place}.opposite"))?;
    let mut mortar = average(&Coverage::new(&side1, &side2, place)?, model, place)?;
    for node in &mut mortar.nodes {
        node.look_along(node.normal, &Directions::default(), mesh1, mesh2);
    }
    mortar.lift();
    Ok(mortar)
}

/// The same up to (C9): weights and mean normals, but no gaps. What supports hold may still turn
/// a normal ([`MortarNode::look_along`]).
pub(in crate::contact) fn average(
    coverage: &Coverage<'_>,
    model: Model,
    place: &str,
) -> Result<Mortar, Error> {
    let (one, two) = (coverage.one, coverage.two);
    let mut gathered = Gathered::default();
    let patches = patches(coverage);
    for patch in &patches {
        if let Some(projection) = Projection::new(coverage, patch, model) {
            gathered.add(patch, &projection);
        }
    }
    let support = support(one, model);
    let same_mesh = std::ptr::eq(one.mesh, two.mesh);
    let mut mortar = Mortar::default();
    for share in gathered.shares {
        let support = support.get(&share.stand.node).copied().unwrap_or_default();
        let node = share.contact(support, place)?.map(|node| MortarNode {
            taken: one.bulges.taken(node.taken),
            ..node
        });
        // A node that both faces share, as at the tip of a crack, has nothing to touch.
        let itself = |node: &MortarNode| {
            let mut others = node.opposite.iter().filter(|entry| entry.0 != node.node);
            same_mesh && others.all(|(_, weight)| weight.abs() < NEGLIGIBLE.sqrt())
        };
        if let Some(node) = node.filter(|node| !itself(node)) {
            mortar.nodes.push(node);
        }
    }
    if mortar.nodes.is_empty() {
        return Err(Error::NothingFacesOpposite {
            place: place.to_owned(),
            facets: one.facets.len(),
            opposite: two.facets.len(),
            averted: coverage.averted,
        });
    }
    Ok(mortar)
}

/// The facets that are covered at all, with the functions of their contacts.
fn patches(coverage: &Coverage<'_>) -> Vec<Patch> {
    if coverage.one.mesh.dimension == 2 {
        let strips = join(strips(coverage), coverage.one);
        return strips.iter().map(Strip::patch).collect();
    }
    tiling::patches(coverage)
}

/// Tributary areas of the corners of a side, in m² (2D: metre).
fn support(surface: &Surface<'_>, model: Model) -> HashMap<usize, f64> {
    let mut support = HashMap::new();
    for (index, facet) in surface.facets.iter().enumerate() {
        let corners = surface.corners_of(index);
        if model != Model::Axisymmetric && surface.is_linear(index) {
            let geometry = surface.mesh.facet_geometry(facet);
            for (node, weight) in corners.iter().zip(geometry.weights) {
                *support.entry(*node).or_default() += weight;
            }
            continue;
        }
        for point in surface.mesh.facet_points(facet, model) {
            let area = point.vector.norm();
            for (node, hat) in corners.iter().zip(point.hats) {
                *support.entry(*node).or_default() += hat * area;
            }
        }
    }
    support
}

/// Sums over the patches around each contact, in the order in which these name the contacts.
#[derive(Default)]
struct Gathered {
    shares: Vec<Share>,
    place_of_stand: HashMap<Stand, usize>,
}

struct Share {
    stand: Stand,
    /// `D_i`, in m² (2D: metre).
    weight: f64,
    /// `∫ φ_i (n − n²) dA`, in m² (2D: metre).
    vector: Vector3<f64>,
    /// `∫ ψ_i N_k dA` per node of side 1, unsorted, in m² (2D: metre).
    own: Vec<(usize, f64)>,
    /// `D_ei P_eik` per node of side 2, unsorted, in m² (2D: metre).
    opposite: Vec<(usize, f64)>,
    /// `∫ ψ_i b dA`, in m³ (2D: m²).
    bulge: f64,
    /// `∫ ψ_i b' dA` (C23), in m³ (2D: m²).
    pressed: f64,
    /// `∫ ψ_i γ dA`, in m³ (2D: m²), and the least γ in metre (C20).
    distance: f64,
    least: f64,
    /// Largest value of its function at the ends of parts, and γ there, in metre.
    here: [f64; 2],
}

impl Gathered {
    fn of(&mut self, stand: Stand) -> &mut Share {
        let place = *(self.place_of_stand.entry(stand)).or_insert(self.shares.len());
        if place == self.shares.len() {
            self.shares.push(Share {
                stand,
                weight: 0.0,
                vector: Vector3::zeros(),
                own: Vec::new(),
                opposite: Vec::new(),
                bulge: 0.0,
                pressed: 0.0,
                distance: 0.0,
                least: f64::INFINITY,
                here: [0.0; 2],
            });
        }
        &mut self.shares[place]
    }

    /// Adds the share of one patch to each of its contacts.
    fn add(&mut self, patch: &Patch, projection: &Projection) {
        for (local, &stand) in patch.stands.iter().enumerate() {
            let share = self.of(stand);
            share.weight += projection.areas[local];
            share.vector += projection.vectors[local];
            share.bulge += projection.bulges[local];
            share.pressed += projection.pressed[local];
            share.distance += projection.distances[local];
            share.least = share.least.min(projection.least);
            nearer(&mut share.here, projection.here[local]);
            let entry = |(node, column): &(usize, [f64; 4])| (*node, column[local]);
            let own = projection.own.iter().map(entry);
            share.own.extend(own.filter(|(_, weight)| *weight != 0.0));
            share.opposite.extend(projection.columns.iter().map(entry));
        }
    }
}

impl Mortar {
    /// Bounds the gaps of all contacts from below (C20).
    pub(in crate::contact) fn lift(&mut self) {
        let distances: Vec<Distances> = self.nodes.iter().map(|node| node.distances).collect();
        let size = self.nodes.iter().map(|node| node.weight).sum();
        let lifts = lifts(&distances, size);
        for (node, lift) in self.nodes.iter_mut().zip(lifts) {
            node.initial_gap += lift;
        }
    }
}

impl MortarNode {
    /// Makes a unit vector the normal: the weights follow (C10), and the gap. Where they would have to
    /// change much, the normal follows as well. Across it, directions may be `still`: nothing moves along them.
    pub(in crate::contact) fn look_along(
        &mut self,
        normal: [f64; 3],
        still: &Directions,
        mesh1: &Mesh,
        mesh2: &Mesh,
    ) {
        let (x, normal) = (self.centre(mesh1), Vector3::from(normal));
        let all = self.opposite.clone();
        clear(&mut self.opposite);
        // Nodes that it does not meet help where the others are too few, as at the end of a body.
        let (mut gap, mut size) = self.aligned(x, normal, still, mesh2);
        if is_across(normal, gap, size, still) {
            self.opposite = all;
            (gap, size) = self.aligned(x, normal, still, mesh2);
        }
        let normal = follow(normal, gap, size, still);
        self.normal = normal.into();
        self.gap_vector = gap.into();
        self.initial_gap = gap.dot(&normal) - self.taken;
    }

    /// Lets the weights of the nodes that it meets follow a normal (C10): the gap vector then, and the distance of
    /// the farthest node, in metre.
    fn aligned(
        &mut self,
        x: Vector3<f64>,
        normal: Vector3<f64>,
        still: &Directions,
        mesh2: &Mesh,
    ) -> (Vector3<f64>, f64) {
        align(&mut self.opposite, &mesh2.nodes, x.into(), normal, still);
        clear(&mut self.opposite);
        let (mut gap, mut size) = (Vector3::zeros(), COORDINATE * x.amax());
        for (k, weight) in &self.opposite {
            let away = Vector3::from(mesh2.nodes[*k]) - x;
            gap += away * *weight;
            size = size.max(away.norm());
        }
        (gap, size)
    }

    /// Nodes of side 2 that it meets, before the weights follow a normal.
    pub(in crate::contact) fn met(&self) -> impl Iterator<Item = (usize, f64)> {
        let opposite = self.opposite.iter().copied();
        opposite.filter(|(_, weight)| weight.abs() > NEGLIGIBLE)
    }

    /// The mean of its own nodes, in metre.
    pub(in crate::contact) fn centre(&self, mesh1: &Mesh) -> Vector3<f64> {
        let terms = self.own.iter();
        terms
            .map(|(k, weight)| Vector3::from(mesh1.nodes[*k]) * *weight)
            .sum()
    }
}

impl Share {
    /// The contact (C9) at a node of so large a tributary area; none if nothing covers it.
    /// γ in the mean, the least one, and where the contact stands.
    fn distances(&self) -> Distances {
        let mean = self.distance / self.weight;
        let [function, here] = self.here;
        Distances {
            mean,
            least: self.least,
            here: if function > 0.0 { here } else { mean },
        }
    }

    fn contact(self, support: f64, place: &str) -> Result<Option<MortarNode>, Error> {
        if self.weight <= VANISHING * support {
            return Ok(None);
        }
        let place = format!("{place}: node {}", self.stand.node);
        let Some(normal) = self.vector.try_normalize(VANISHING * self.weight) else {
            return Err(Error::Direction {
                place,
                value: self.vector.into(),
                accepted: "facets around a node that do not look opposite ways",
            });
        };
        let distances = self.distances();
        let mut own = means(self.own, &place)?;
        clear(&mut own);
        let node = MortarNode {
            node: self.stand.node,
            moved: self.stand.moved.is_some(),
            own,
            weight: self.weight,
            normal: normal.into(),
            opposite: means(self.opposite, &place)?,
            bulge: self.bulge / self.weight,
            taken: self.pressed / self.weight,
            distances,
            gap_vector: [0.0; 3],
            initial_gap: 0.0,
            covered: (self.weight / support).min(1.0),
        };
        Ok(Some(node).filter(|node| !node.own.is_empty() && !node.opposite.is_empty()))
    }
}

/// Weights per node that sum to one, ascending, from shares.
fn means(mut shares: Vec<(usize, f64)>, place: &str) -> Result<Vec<(usize, f64)>, Error> {
    shares.sort_by_key(|entry| entry.0);
    shares.dedup_by(|next, kept| {
        let same = next.0 == kept.0;
        kept.1 += if same { next.1 } else { 0.0 };
        same
    });
    scale(&mut shares);
    let weights: Vec<f64> = shares.iter().map(|entry| entry.1).collect();
    check_finite(&format!("{place}: mortar weights"), &weights)?;
    Ok(shares)
}

/// Takes out the weights that are round-off.
fn clear(weights: &mut Vec<(usize, f64)>) {
    weights.retain(|entry| entry.1.abs() > NEGLIGIBLE);
    scale(weights);
}

fn scale(weights: &mut [(usize, f64)]) {
    let total: f64 = weights.iter().map(|entry| entry.1).sum();
    for entry in weights {
        entry.1 /= total;
    }
}
