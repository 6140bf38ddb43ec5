//! Where the contacts of a surface stand: at corners of its facets.
//!
//! ```text
//! (C16)  u_j = Σ_k B_jk v_k        B_jk = ∫ ψ_j N_k dA / w_j,   w_j = ∫ φ_j dA = ∫ ψ_j dA
//!        g_j = ∫ ψ_j g₀ dA / w_j   φ_j: linear on the facets, 1 at corner j
//!        ∫ ψ_i φ_j dA = δ_ij w_j   ψ = D M⁻¹ φ on each facet, M = ∫ φ φᵀ dA, D = diag ∫ φ dA
//! ```
//!
//! g₀ is measured from the smooth surface (C18). As `ψ_j` has two signs its mean may be less than g₀ is
//! anywhere on the facets around the corner: the least of these bounds g_j from below.
//!
//! On linear facets a contact moves with its node and sees the distance from there, `B = 1`. On
//! quadratic ones nodal forces of a uniform pressure vanish or pull at corners, so pressures
//! stand at the corners alone, `Σ_j (t_j / w_j) ψ_j`, while displacements are quadratic: all
//! `w_j` are positive, and a uniform pressure comes out as one. The dual `ψ_j` see the corner's own
//! displacement, and of what is not linear around it a mean: along a straight line of lines,
//! `B = [−1/6, 1/3, 2/3, 1/3, −1/6]`. With `φ_j` in their place the pressure at the rim of Hertz'
//! line contact is off by several times as much.
//! Puso, Laursen & Solberg, Comput. Methods Appl. Mech. Engrg. 197 (2008) 555–566; Popp,
//! Wohlmuth, Gee & Wall, SIAM J. Sci. Comput. 34 (2012) B421–B446.

use std::collections::HashMap;

use nalgebra::{DMatrix, DVector, Vector3};

use super::held::Directions;
use super::lift::{Distances, lifts};
use super::rounding::Bulges;
use crate::body::{Body, Facet, FacetGeometry, FacetPoint};
use crate::error::Error;

/// Weight that is round-off.
const NEGLIGIBLE: f64 = 1e-14;

/// Component of a normal along an axis beyond which the axis takes part in it.
const ALONG: f64 = 1e-8;

/// A contact before it is known what its supports leave it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Footing {
    /// The corner.
    pub(super) node: usize,
    /// The nodes that it moves with, and B (C16).
    pub(super) own: Vec<(usize, f64)>,
    /// `w_j`, in m² (plane bodies: in metre).
    pub(super) area: f64,
    /// `g_j`, in metre.
    pub(super) gap: f64,
    /// `∫ ψ_j b dA / w_j` (C18), in metre.
    pub(super) bulge: f64,
    /// Least g₀ on the facets around, in metre.
    least: f64,
    /// Gap at the corner itself, where facets are quadratic, in metre.
    here: f64,
}

/// The footings on facets with an area, in the order in which these name their corners; `gap` is g₀ in
/// metre at a position, for the contact at a node, and `bulges` are those of the facets.
pub(super) fn footings(
    body: &Body,
    facets: &[(Facet, FacetGeometry)],
    bulges: &Bulges,
    gap: impl Fn(usize, [f64; 3]) -> Result<f64, Error>,
) -> Result<Vec<Footing>, Error> {
    let dimension = body.mesh.dimension;
    let mut gathered = Gathered::default();
    for (index, (facet, geometry)) in facets.iter().enumerate() {
        if !facet.is_quadratic(dimension) {
            for (&node, &weight) in facet.nodes.iter().zip(&geometry.weights) {
                let here = gap(node, body.mesh.nodes[node])?;
                gathered.at(node).add(node, weight, here);
            }
            continue;
        }
        let points = body.mesh.facet_points(facet, body.model);
        let corners = facet.corners(dimension);
        let dual = duals(&points, corners.len());
        for point in &points {
            let area = point.vector.norm();
            let psi = &dual * DVector::from_row_slice(&point.hats);
            let mut hats = [0.0; 4];
            hats[..corners.len()].copy_from_slice(&point.hats);
            let bulge = bulges.height(index, &hats);
            for (&corner, psi) in corners.iter().zip(&psi) {
                let here = gap(corner, point.position.into())? - bulges.taken(bulge);
                let footing = gathered.at(corner);
                footing.bulge += psi * area * bulge;
                footing.least = footing.least.min(here);
                for (&node, shape) in facet.nodes.iter().zip(&point.shape) {
                    footing.add(node, psi * shape * area, here);
                }
            }
        }
        for &corner in corners {
            for &other in corners {
                let there = gap(corner, body.mesh.nodes[other])?;
                let footing = gathered.at(corner);
                footing.least = footing.least.min(there);
                if other == corner {
                    footing.here = there;
                }
            }
        }
    }
    Ok(gathered.close())
}

/// `D M⁻¹` of a facet (C16); one where it has no area, as on an axis.
fn duals(points: &[FacetPoint], corners: usize) -> DMatrix<f64> {
    let mut mass = DMatrix::zeros(corners, corners);
    let mut areas = DVector::zeros(corners);
    for point in points {
        let area = point.vector.norm();
        let hats = DVector::from_row_slice(&point.hats);
        mass += &hats * hats.transpose() * area;
        areas += hats * area;
    }
    let inverse = mass.cholesky().map(|factor| factor.inverse());
    inverse.map_or_else(
        || DMatrix::identity(corners, corners),
        |inverse| DMatrix::from_diagonal(&areas) * inverse,
    )
}

#[derive(Default)]
struct Gathered {
    footings: Vec<Footing>,
    place_of_node: HashMap<usize, usize>,
}

impl Gathered {
    /// The footings with an area, their gaps bounded from below; on linear facets gaps are no means.
    fn close(self) -> Vec<Footing> {
        let mut closed: Vec<Footing> = self.footings.into_iter().map(Footing::close).collect();
        let distances = closed
            .iter()
            .map(|footing| match footing.least.is_finite() {
                true => Distances {
                    mean: footing.gap,
                    least: footing.least,
                    here: footing.here,
                },
                false => Distances::plain(footing.gap),
            });
        let distances: Vec<Distances> = distances.collect();
        let size = closed.iter().map(|footing| footing.area).sum();
        for (footing, lift) in closed.iter_mut().zip(lifts(&distances, size)) {
            footing.gap += lift;
        }
        closed.retain(|footing| footing.area > 0.0);
        closed
    }

    fn at(&mut self, node: usize) -> &mut Footing {
        let place = *(self.place_of_node.entry(node)).or_insert(self.footings.len());
        if place == self.footings.len() {
            self.footings.push(Footing {
                node,
                own: Vec::new(),
                area: 0.0,
                gap: 0.0,
                bulge: 0.0,
                least: f64::INFINITY,
                here: f64::INFINITY,
            });
        }
        &mut self.footings[place]
    }
}

impl Footing {
    fn add(&mut self, node: usize, weight: f64, gap: f64) {
        match self.own.iter_mut().find(|(known, _)| *known == node) {
            Some((_, sum)) => *sum += weight,
            None => self.own.push((node, weight)),
        }
        self.area += weight;
        self.gap += weight * gap;
    }

    /// From integrals to means.
    fn close(mut self) -> Self {
        let area = self.area;
        self.own
            .retain(|(_, weight)| weight.abs() > NEGLIGIBLE * area);
        for (_, weight) in &mut self.own {
            *weight /= area;
        }
        self.bulge /= area;
        self.gap /= area;
        self
    }
}

/// Directions along which supports hold a contact with the given normal: across it those that hold its
/// corner, as on a symmetry plane, along it those that hold all its nodes.
pub(super) fn held_directions(
    node: usize,
    own: &[(usize, f64)],
    normal: Vector3<f64>,
    held: impl Fn(usize) -> Directions,
) -> Directions {
    let Directions(mut directions) = held(node).led_by(normal);
    directions.retain(|direction| {
        let across = normal.dot(direction).abs() < ALONG;
        across || own.iter().all(|&(other, _)| held(other).hold(direction))
    });
    Directions(directions)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::body::tests::samples::{block, body, facets};
    use crate::body::{CellKind, Model, rectangle};

    fn on_bottom(body: &Body, gap: impl Fn([f64; 3]) -> f64) -> Vec<Footing> {
        let facets = facets(&body.mesh, "bottom");
        let facets: Vec<_> = facets
            .into_iter()
            .map(|facet| {
                let geometry = body.facet_geometry(&facet);
                (facet, geometry)
            })
            .collect();
        let bulges = Bulges::none(facets.len());
        footings(body, &facets, &bulges, |_, position| Ok(gap(position))).unwrap()
    }

    #[test]
    fn a_corner_of_equal_lines_moves_with_its_neighbours_as_stated() {
        let mesh = rectangle(&[0.0, 2.0, 4.0], &[0.0, 1.0], CellKind::Quad9).unwrap();
        let body = body(mesh, Model::PlaneStrain, 0.3);
        let footings = on_bottom(&body, |_| 0.0);
        let middle = footings
            .iter()
            .find(|f| body.mesh.nodes[f.node][0] == 2.0)
            .unwrap();
        assert!((middle.area - 2.0).abs() < 1e-15);
        for (node, weight) in &middle.own {
            let expected = match body.mesh.nodes[*node][0] {
                2.0 => 2.0 / 3.0,
                1.0 | 3.0 => 1.0 / 3.0,
                _ => -1.0 / 6.0,
            };
            assert!((weight - expected).abs() < 1e-15, "{middle:?}");
        }
    }

    #[test]
    fn weights_are_positive_and_means_reproduce_what_is_linear() {
        // Σ_k B_jk (1, x) = (1, x_j) and g_j = g₀(x_j) for a linear g₀, whatever the cells.
        for kind in CellKind::all() {
            let body = block(kind);
            let gap = |[x, y, _]: [f64; 3]| 3.0 - 2.0 * x + 5.0 * y;
            let found = on_bottom(&body, gap);
            let total: f64 = found.iter().map(|footing| footing.area).sum();
            assert!((total - 2.0).abs() < 1e-14);
            for footing in found {
                let here = body.mesh.nodes[footing.node];
                assert!(footing.area > 0.0 && (footing.gap - gap(here)).abs() < 1e-13);
                let sum: f64 = footing.own.iter().map(|(_, weight)| weight).sum();
                assert!((sum - 1.0).abs() < 1e-14);
                for (axis, here) in here.into_iter().enumerate() {
                    let terms = footing.own.iter();
                    let mean: f64 = terms.map(|(k, b)| b * body.mesh.nodes[*k][axis]).sum();
                    assert!((mean - here).abs() < 1e-13, "{kind:?} {footing:?}");
                }
            }
        }
    }
}
