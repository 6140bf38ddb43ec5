//! A given force and moment on a part of the surface, spread as tractions.
//!
//! ```text
//! t(x) = F/A + b × (x − c),     J b = M + (x₀ − c) × F
//! A = ∫ dA,   c = ∫ x dA / A,   J = ∫ (|r|² I − r rᵀ) dA,   r = x − c
//! ```
//!
//! F acts at x₀. Of all tractions with this resultant these have the least `∫ t² dA`; the part is free to
//! deform. A moment is the same about every point, so that of a torque needs no axis.

use nalgebra::{Matrix3, Vector3};

use super::affine::fine_points;
use super::load::NodalForces;
use super::{Body, Facet, Model};

/// A force and a moment.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wrench {
    /// Force, in newton (plane strain: per metre of depth; axisymmetric: on the whole circumference).
    pub force: [f64; 3],
    /// Moment, in newton metre; in 2D about z.
    pub moment: [f64; 3],
    /// Where the force acts, in metre; at the centre of the area if there is none.
    pub at: Option<[f64; 3]>,
}

impl Wrench {
    /// The force and the moment times a factor.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        Self {
            force: self.force.map(|f| factor * f),
            moment: self.moment.map(|m| factor * m),
            at: self.at,
        }
    }
}

impl NodalForces<'_> {
    pub(super) fn add_spread(&mut self, facets: &[Facet], wrench: &Wrench) {
        let Some(spread) = spread_on(self.body, facets, wrench) else {
            return;
        };
        for facet in facets {
            for point in fine_points(self.body, facet) {
                let traction = spread.traction(point.position);
                for (node, shape) in facet.nodes.iter().zip(&point.shape) {
                    self.add(*node, traction.into(), shape * point.vector.norm());
                }
            }
        }
    }
}

impl NodalForces<'_> {
    /// Nodes that move as a rigid body share a wrench as if each had the same area.
    pub(super) fn add_at_reference(&mut self, nodes: &[usize], wrench: &Wrench) {
        let places = &self.body.mesh.nodes;
        let positions = nodes.iter().map(|&node| Vector3::from(places[node]));
        let shares = positions.map(|position| (position, 1.0));
        if let Some(spread) = Spread::new(shares, wrench, self.body.model) {
            for &node in nodes {
                self.add(node, spread.traction(places[node].into()).into(), 1.0);
            }
        }
    }
}

/// The tractions of a wrench on facets of a body; none if these have no area.
pub(super) fn spread_on(body: &Body, facets: &[Facet], wrench: &Wrench) -> Option<Spread> {
    let points = facets.iter().flat_map(|facet| fine_points(body, facet));
    let areas: Vec<_> = points
        .map(|point| (point.position, point.vector.norm()))
        .collect();
    Spread::new(areas.iter().copied(), wrench, body.model)
}

/// Tractions as an affine function of position.
pub(super) struct Spread {
    centre: Vector3<f64>,
    mean: Vector3<f64>,
    turning: Vector3<f64>,
}

impl Spread {
    /// Over positions and their areas; none if there is no area.
    fn new(
        shares: impl Iterator<Item = (Vector3<f64>, f64)> + Clone,
        wrench: &Wrench,
        model: Model,
    ) -> Option<Self> {
        let area: f64 = shares.clone().map(|(_, area)| area).sum();
        if area <= 0.0 {
            return None;
        }
        let centre = shares
            .clone()
            .map(|(x, area)| x * area)
            .sum::<Vector3<f64>>()
            / area;
        let force = Vector3::from(wrench.force);
        let arm = wrench
            .at
            .map_or(Vector3::zeros(), |at| Vector3::from(at) - centre);
        let moment = Vector3::from(wrench.moment) + arm.cross(&force);
        let inertia: Matrix3<f64> = shares
            .map(|(x, area)| {
                let r = x - centre;
                (Matrix3::identity() * r.norm_squared() - r * r.transpose()) * area
            })
            .sum();
        let turning = match model {
            // A ring's tractions along the axis have no moment, and no other force.
            Model::Axisymmetric => Vector3::zeros(),
            Model::PlaneStrain | Model::PlaneStress { .. } => {
                Vector3::z() * (moment.z / inertia[(2, 2)])
            }
            Model::Solid => inertia.try_inverse()? * moment,
        };
        Some(Self {
            centre,
            mean: force / area,
            turning,
        })
    }

    pub(super) fn traction(&self, position: Vector3<f64>) -> Vector3<f64> {
        self.mean + self.turning.cross(&(position - self.centre))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::tests::samples::{block, facets};
    use crate::body::{CellKind, Load, load_vector};

    #[test]
    fn the_nodes_carry_the_force_at_its_point_and_the_moment() {
        // Even of a single facet, and of one that is not centred.
        for kind in CellKind::all() {
            for count in [1, usize::MAX] {
                let mut body = block(kind);
                let axes = kind.dimension();
                let mut facets = facets(&body.mesh, "right");
                facets.truncate(count);
                let mut wrench = Wrench {
                    force: [1.0, -2.0, 3.0],
                    moment: [5.0, -7.0, 11.0],
                    at: Some([0.5, 2.0, -1.0]),
                };
                if axes == 2 {
                    wrench.force[2] = 0.0;
                    wrench.moment = [0.0, 0.0, 11.0];
                    wrench.at = Some([0.5, 2.0, 0.0]);
                }
                body.loads = vec![Load::Spread { facets, wrench }];
                let forces = load_vector(&body);
                let (mut sum, mut moment) = (Vector3::zeros(), Vector3::zeros());
                for (f, x) in forces.chunks(axes).zip(&body.mesh.nodes) {
                    let f = Vector3::from_fn(|k, _| f.get(k).copied().unwrap_or(0.0));
                    sum += f;
                    moment += Vector3::from(*x).cross(&f);
                }
                let force = Vector3::from(wrench.force);
                let expected = Vector3::from(wrench.moment)
                    + Vector3::from([0.5, 2.0, if axes == 2 { 0.0 } else { -1.0 }]).cross(&force);
                assert!((sum - force).norm() < 1e-12, "{kind:?} {sum}");
                assert!((moment - expected).norm() < 1e-11, "{kind:?} {moment}");
            }
        }
    }
}
