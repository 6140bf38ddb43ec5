//! Forces on mass: weight, and that of a body that spins steadily, seen from the body.
//!
//! ```text
//! b = ρ g,      b = ρ ω² a        a: from the axis to the point, across the axis
//! ```

use super::Line;
use super::load::NodalForces;
use super::modes::mapped;
use super::quadrature::{positions, rule};

impl NodalForces<'_> {
    pub(super) fn add_gravity(&mut self, cells: &[usize], acceleration: [f64; 3]) {
        for &cell in cells {
            self.add_on_mass(cell, |_| acceleration);
        }
    }

    pub(super) fn add_centrifugal(&mut self, cells: &[usize], axis: &Line, speed_squared: f64) {
        for &cell in cells {
            self.add_on_mass(cell, |position| {
                axis.arm(position).map(|arm| speed_squared * arm)
            });
        }
    }

    /// `∫ N_a ρ a dV` of one cell, the acceleration being a function of position.
    fn add_on_mass(&mut self, cell: usize, acceleration: impl Fn([f64; 3]) -> [f64; 3]) {
        let density = self.body.materials[self.body.material_of_cell[cell]].density;
        if density == 0.0 {
            return;
        }
        let cell = self.body.mesh.cell(cell);
        let nodes = positions(&self.body.mesh, cell.nodes);
        let points = mapped(self.body, cell);
        for (point, reference) in points.iter().zip(rule(cell.kind, self.body.model)) {
            let acceleration = acceleration(reference.in_space(&nodes).into());
            let mass = density * point.volume * self.body.model.depth();
            for (node, shape) in cell.nodes.iter().zip(&reference.shape) {
                self.add(*node, acceleration, shape * mass);
            }
        }
    }
}
