//! Given forces, as work-equivalent nodal forces.
//!
//! ```text
//! (B6)  f_a = ∫ N_a b dV + ∫ N_a p dA + P_a,      p = −q n for a pressure q
//! ```
//!
//! A plane-stress body is as deep as its thickness, which multiplies the integrals;
//! forces at nodes are taken as they are. Integrals over an axisymmetric body go once around
//! its axis (`dA = 2πr ds`), so that all forces are those of the whole ring; a force at a node is
//! that of the ring through it.

use super::modes::mapped;
use super::quadrature::rule;
use super::{Body, Facet, Load};

/// Nodal forces of the body's loads, in newton (plane strain: per metre of depth), entry
/// `dimension · node + axis`.
///
/// Facets run in outward order ([`Mesh::orient`](super::Mesh::orient)) and the body has
/// passed [`check`](super::check()).
#[must_use]
pub(crate) fn load_vector(body: &Body) -> Vec<f64> {
    nodal_forces(body, &body.loads)
}

/// The same of some loads on a body, such as one of its own alone.
#[must_use]
pub(crate) fn nodal_forces(body: &Body, loads: &[Load]) -> Vec<f64> {
    let mut forces = NodalForces {
        body,
        values: vec![0.0; body.mesh.dimension * body.mesh.nodes.len()],
    };
    for load in loads {
        match load {
            Load::Pressure { facets, pressure } => forces.add_pressure(facets, *pressure),
            Load::Traction { facets, traction } => forces.add_traction(facets, *traction),
            Load::BodyForce { cells, density } => forces.add_body_force(cells, *density),
            Load::PointForce { node, force } => forces.add(*node, *force, 1.0),
            Load::VaryingPressure { facets, pressure } => {
                forces.add_varying_pressure(facets, pressure);
            }
            Load::VaryingTraction { facets, traction } => {
                forces.add_varying_traction(facets, traction);
            }
            Load::Spread { facets, wrench } => forces.add_spread(facets, wrench),
            Load::AtReference { nodes, wrench, .. } => forces.add_at_reference(nodes, wrench),
            Load::Gravity {
                cells,
                acceleration,
            } => forces.add_gravity(cells, *acceleration),
            Load::Centrifugal {
                cells,
                axis,
                speed_squared,
            } => forces.add_centrifugal(cells, axis, *speed_squared),
            // Of all of them together, below.
            Load::Temperature { .. } | Load::InitialStress { .. } => {}
        }
    }
    forces.add_prestress(loads);
    forces.values
}

impl Load {
    /// The load times a factor; of a spin the forces, not the velocity.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let mut scaled = self.clone();
        match &mut scaled {
            Self::Pressure { pressure, .. } => *pressure *= factor,
            Self::Traction { traction: v, .. }
            | Self::BodyForce { density: v, .. }
            | Self::PointForce { force: v, .. }
            | Self::Gravity {
                acceleration: v, ..
            } => v.iter_mut().for_each(|v| *v *= factor),
            Self::VaryingPressure { pressure, .. } => *pressure = pressure.scaled(factor),
            Self::VaryingTraction { traction, .. } => {
                *traction = traction.map(|component| component.scaled(factor));
            }
            Self::Spread { wrench, .. } | Self::AtReference { wrench, .. } => {
                *wrench = wrench.scaled(factor);
            }
            Self::Centrifugal { speed_squared, .. } => *speed_squared *= factor,
            Self::Temperature { rise, .. } => rise.iter_mut().for_each(|t| *t *= factor),
            Self::InitialStress { stress, .. } => stress.iter_mut().for_each(|s| *s *= factor),
        }
        scaled
    }
}

pub(super) struct NodalForces<'a> {
    pub(super) body: &'a Body,
    values: Vec<f64>,
}

impl NodalForces<'_> {
    fn add_pressure(&mut self, facets: &[Facet], pressure: f64) {
        let depth = self.body.model.depth();
        for facet in facets {
            let geometry = self.body.facet_geometry(facet);
            for (node, vector) in facet.nodes.iter().zip(geometry.vectors) {
                self.add(*node, vector, -pressure * depth);
            }
        }
    }

    fn add_traction(&mut self, facets: &[Facet], traction: [f64; 3]) {
        let depth = self.body.model.depth();
        for facet in facets {
            let geometry = self.body.facet_geometry(facet);
            for (node, weight) in facet.nodes.iter().zip(geometry.weights) {
                self.add(*node, traction, weight * depth);
            }
        }
    }

    fn add_body_force(&mut self, cells: &[usize], density: [f64; 3]) {
        let depth = self.body.model.depth();
        for cell in cells {
            let cell = self.body.mesh.cell(*cell);
            let points = mapped(self.body, cell);
            for (point, reference) in points.iter().zip(rule(cell.kind, self.body.model)) {
                for (node, shape) in cell.nodes.iter().zip(&reference.shape) {
                    self.add(*node, density, shape * point.volume * depth);
                }
            }
        }
    }

    pub(super) fn add(&mut self, node: usize, force: [f64; 3], factor: f64) {
        let axes = self.body.mesh.dimension;
        let entries = &mut self.values[axes * node..axes * (node + 1)];
        for (entry, component) in entries.iter_mut().zip(force) {
            *entry += component * factor;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::tests::samples::{block, facets};
    use crate::body::{CellKind, Model};

    /// Resultant of the nodal forces.
    fn resultant(body: &Body) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for entries in load_vector(body).chunks(body.mesh.dimension) {
            for (total, entry) in sum.iter_mut().zip(entries) {
                *total += entry;
            }
        }
        sum
    }

    fn assert_close(found: [f64; 3], expected: [f64; 3]) {
        let close = |(a, b): (f64, f64)| (a - b).abs() < 1e-12;
        assert!(found.into_iter().zip(expected).all(close), "{found:?}");
    }

    #[test]
    fn a_pressure_pushes_inward_with_pressure_times_area() {
        // Block of 2 × 1 (× 1): the top has area 2 and is pressed down; a plate of 0.5 m carries half.
        for kind in CellKind::all() {
            let mut body = block(kind);
            let facets = facets(&body.mesh, "top");
            body.loads = vec![Load::Pressure {
                facets,
                pressure: 3.0,
            }];
            let mut expected = [0.0; 3];
            expected[body.mesh.dimension - 1] = -6.0;
            assert_close(resultant(&body), expected);
            if kind.dimension() == 2 {
                body.model = Model::PlaneStress { thickness: 0.5 };
                assert_close(resultant(&body), [0.0, -3.0, 0.0]);
            }
        }
    }

    #[test]
    fn a_pressure_all_around_is_in_equilibrium() {
        for kind in CellKind::all() {
            let mut body = block(kind);
            let facets = body.mesh.boundary_facets();
            body.loads = vec![Load::Pressure {
                facets,
                pressure: 3.0,
            }];
            assert_close(resultant(&body), [0.0; 3]);
        }
    }

    #[test]
    fn tractions_and_body_forces_carry_area_and_volume() {
        // Right side of area 1, volume 2, and one force of (1, 1, 1).
        for kind in CellKind::all() {
            let mut body = block(kind);
            let (facets, cells) = (facets(&body.mesh, "right"), 0..body.mesh.cell_count());
            body.loads = vec![
                Load::Traction {
                    facets,
                    traction: [1.0, 2.0, 4.0],
                },
                Load::BodyForce {
                    cells: cells.collect(),
                    density: [10.0, 20.0, 40.0],
                },
                Load::PointForce {
                    node: 2,
                    force: [1.0; 3],
                },
            ];
            let mut expected = [22.0, 43.0, 85.0];
            if kind.dimension() == 2 {
                expected[2] = 0.0;
            }
            assert_close(resultant(&body), expected);
        }
    }

    #[test]
    fn a_plate_multiplies_area_and_volume_by_its_thickness_but_no_point_force() {
        let mut body = block(CellKind::Quad4);
        body.model = Model::PlaneStress { thickness: 0.5 };
        let (facets, cells) = (facets(&body.mesh, "right"), 0..body.mesh.cell_count());
        body.loads = vec![
            Load::Traction {
                facets,
                traction: [1.0, 2.0, 0.0],
            },
            Load::BodyForce {
                cells: cells.collect(),
                density: [10.0, 20.0, 0.0],
            },
            Load::PointForce {
                node: 2,
                force: [1.0, 1.0, 0.0],
            },
        ];
        assert_close(resultant(&body), [11.5, 22.0, 0.0]);
    }
}
