//! Pressures and tractions that vary with position, as that of water does with depth.
//!
//! ```text
//! p(x) = p₀ + g · x,     f_a = ∫ N_a p dA        (B6)
//! ```

use super::load::NodalForces;
use super::{Body, Facet};

/// A value that is an affine function of position.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Affine {
    /// Value at the origin, in the unit of the quantity.
    pub value: f64,
    /// Change per metre along each axis, in that unit over metre.
    pub gradient: [f64; 3],
}

impl Affine {
    /// The value at a position, in metre.
    #[must_use]
    pub fn at(&self, position: [f64; 3]) -> f64 {
        let along = self.gradient.iter().zip(position);
        along.fold(self.value, |sum, (slope, x)| sum + slope * x)
    }

    /// The function times a factor.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        Self {
            value: factor * self.value,
            gradient: self.gradient.map(|slope| factor * slope),
        }
    }
}

impl NodalForces<'_> {
    pub(super) fn add_varying_pressure(&mut self, facets: &[Facet], pressure: &Affine) {
        let depth = self.body.model.depth();
        for facet in facets {
            for point in fine_points(self.body, facet) {
                let part = -pressure.at(point.position.into()) * depth;
                for (node, shape) in facet.nodes.iter().zip(&point.shape) {
                    self.add(*node, point.vector.into(), part * shape);
                }
            }
        }
    }

    pub(super) fn add_varying_traction(&mut self, facets: &[Facet], traction: &[Affine; 3]) {
        let depth = self.body.model.depth();
        for facet in facets {
            for point in fine_points(self.body, facet) {
                let traction = traction.map(|component| component.at(point.position.into()));
                let area = point.vector.norm() * depth;
                for (node, shape) in facet.nodes.iter().zip(&point.shape) {
                    self.add(*node, traction, shape * area);
                }
            }
        }
    }
}

/// Points of a facet of a body that integrate a product of two linear functions.
pub(super) fn fine_points(body: &Body, facet: &Facet) -> Vec<super::FacetPoint> {
    body.mesh.fine_facet_points(facet, body.model)
}
