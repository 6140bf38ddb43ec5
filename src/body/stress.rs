//! Stress in the cells and at the nodes, for reports.
//!
//! ```text
//! σ = λ θ I + 2 μ ε(u)      ε at the centre of the cell, θ the dilatation that its energy holds
//! ```
//!
//! In nearly incompressible cells θ is the mean of (B4) or (B5): with `tr ε` in its
//! place the pressure would be noise times λ.

use nalgebra::{Matrix3, Vector3};

use super::dilatation::{Dilatation, Patches, mean_gradients};
use super::quadrature::{Point, mapped, positions, rule};
use super::{Body, Cell};

/// Stress at the centre of each cell, in pascal, in the order xx, yy, zz, yz, xz, xy.
///
/// `displacement` in metre, entry `dimension · node + axis`.
#[must_use]
pub fn cell_stress(body: &Body, displacement: &[f64]) -> Vec<[f64; 6]> {
    let field = Field { body, displacement };
    let patches = Patches::new(body);
    let around_nodes: Vec<f64> = patches
        .iter()
        .map(|patch| field.divergence(patch.nodes, patch.gradients))
        .collect();

    let cells = body.mesh.cells().zip(&body.material_of_cell);
    cells
        .map(|(cell, &index)| {
            let material = &body.materials[index];
            let gradient = field.gradient_at_centre(cell);
            let theta = match Dilatation::of(cell.kind, body.model, material) {
                Dilatation::Pointwise => gradient.trace(),
                Dilatation::CellMean => field.mean_dilatation(cell),
                Dilatation::NodeMean => {
                    let around = cell
                        .nodes
                        .iter()
                        .filter_map(|node| patches.find(index, *node));
                    around.map(|patch| around_nodes[patch]).sum::<f64>() / cell.nodes.len() as f64
                }
            };
            let strain = (gradient + gradient.transpose()) / 2.0;
            let [xx, yy, zz] = [strain[(0, 0)], strain[(1, 1)], strain[(2, 2)]];
            let [yz, xz, xy] = [strain[(1, 2)], strain[(0, 2)], strain[(0, 1)]];
            let lame = material.lame(body.model);
            lame.stress(body.model, [xx, yy, zz, yz, xz, xy], theta)
        })
        .collect()
}

/// Stress at the nodes: the mean of the cells around each, weighted by their volume, in pascal.
///
/// `cell_stress` as from [`cell_stress`].
#[must_use]
pub fn nodal_stress(body: &Body, cell_stress: &[[f64; 6]]) -> Vec<[f64; 6]> {
    let mut sums = vec![([0.0; 6], 0.0); body.mesh.nodes.len()];
    for (index, stress) in cell_stress.iter().enumerate() {
        let volume = body.mesh.volume(index);
        for node in body.mesh.cell(index).nodes {
            let (sum, weight) = &mut sums[*node];
            for (total, component) in sum.iter_mut().zip(stress) {
                *total += volume * component;
            }
            *weight += volume;
        }
    }
    let mean = |(sum, weight): ([f64; 6], f64)| sum.map(|total| total / weight);
    sums.into_iter().map(mean).collect()
}

/// Von Mises' equivalent stress `√(3/2 s : s)`, in pascal, of a stress in the order
/// xx, yy, zz, yz, xz, xy.
#[must_use]
pub fn von_mises([xx, yy, zz, yz, xz, xy]: [f64; 6]) -> f64 {
    let differences = (xx - yy).powi(2) + (yy - zz).powi(2) + (zz - xx).powi(2);
    (0.5 * differences + 3.0 * (yz * yz + xz * xz + xy * xy)).sqrt()
}

/// A displacement of a body's nodes.
struct Field<'a> {
    body: &'a Body,
    displacement: &'a [f64],
}

impl Field<'_> {
    fn at(&self, node: usize) -> Vector3<f64> {
        let axes = self.body.mesh.dimension;
        let entries = &self.displacement[axes * node..axes * (node + 1)];
        Vector3::from_fn(|axis, _| entries.get(axis).copied().unwrap_or(0.0))
    }

    /// `Σ_a g_a · u_a`.
    fn divergence(&self, nodes: &[usize], gradients: &[Vector3<f64>]) -> f64 {
        let terms = nodes.iter().zip(gradients);
        terms
            .map(|(node, gradient)| gradient.dot(&self.at(*node)))
            .sum()
    }

    /// `∂u_i/∂x_j` at the centre of a cell.
    fn gradient_at_centre(&self, cell: Cell<'_>) -> Matrix3<f64> {
        let positions = positions(&self.body.mesh, cell.nodes);
        let centre = Point::at(cell.kind, cell.kind.centre(), 1.0);
        let mapped = centre.map(cell.kind, &positions[..cell.nodes.len()]);
        let terms = cell.nodes.iter().zip(mapped.gradients);
        terms
            .map(|(node, gradient)| self.at(*node) * gradient.transpose())
            .sum()
    }

    /// Mean of the divergence over a cell (B4).
    fn mean_dilatation(&self, cell: Cell<'_>) -> f64 {
        let points = mapped(&self.body.mesh, cell);
        let (_, mean) = mean_gradients(&points[..rule(cell.kind).len()]);
        self.divergence(cell.nodes, &mean)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::samples::distorted;
    use crate::body::{CellKind, Model};

    /// Nodal values of `u = H x`.
    fn linear(body: &Body, h: Matrix3<f64>) -> Vec<f64> {
        let axes = body.mesh.dimension;
        let at = |x: &[f64; 3]| {
            (h * Vector3::from(*x))
                .iter()
                .take(axes)
                .copied()
                .collect::<Vec<_>>()
        };
        body.mesh.nodes.iter().flat_map(at).collect()
    }

    fn assert_stress(found: &[[f64; 6]], expected: [f64; 6], tolerance: f64) {
        for stress in found {
            for (component, expected) in stress.iter().zip(expected) {
                assert!(
                    (component - expected).abs() < tolerance,
                    "{stress:?} {expected:?}"
                );
            }
        }
    }

    #[test]
    fn a_linear_displacement_has_one_stress_in_all_cells_and_nodes() {
        // ν = 1/4, E = 10: λ = μ = 4. u = (x + 2y, 3y): ε_xx = 1, ε_yy = 3, ε_xy = 1, θ = 4;
        // σ = (16 + 8, 16 + 24, 16, 0, 0, 8) in plane strain and 3D.
        let h = Matrix3::new(1.0, 2.0, 0.0, 0.0, 3.0, 0.0, 0.0, 0.0, 0.0);
        for kind in CellKind::ALL {
            let mut body = distorted(kind);
            body.materials[0].poisson = 0.25;
            let cells = cell_stress(&body, &linear(&body, h));
            assert_stress(&cells, [24.0, 40.0, 16.0, 0.0, 0.0, 8.0], 1e-12);
            let nodes = nodal_stress(&body, &cells);
            assert_stress(&nodes, [24.0, 40.0, 16.0, 0.0, 0.0, 8.0], 1e-12);
        }
    }

    #[test]
    fn a_plate_has_no_stress_through_its_thickness() {
        // λ = 8/3, μ = 4: σ_xx = 32/3 + 8, σ_yy = 32/3 + 24, σ_xy = 8.
        let h = Matrix3::new(1.0, 2.0, 0.0, 0.0, 3.0, 0.0, 0.0, 0.0, 0.0);
        for kind in [CellKind::Tri3, CellKind::Quad4] {
            let mut body = distorted(kind);
            body.materials[0].poisson = 0.25;
            body.model = Model::PlaneStress { thickness: 0.3 };
            let found = cell_stress(&body, &linear(&body, h));
            let expected = [32.0 / 3.0 + 8.0, 32.0 / 3.0 + 24.0, 0.0, 0.0, 0.0, 8.0];
            assert_stress(&found, expected, 1e-12);
        }
    }

    #[test]
    fn averaged_dilatations_keep_the_stress_of_a_linear_displacement() {
        // ν = 0.4999: λ = E ν/((1+ν)(1−2ν)), μ = E/(2(1+ν)); the shape of σ as above.
        let h = Matrix3::new(1.0, 2.0, 0.0, 0.0, 3.0, 0.0, 0.0, 0.0, 0.0);
        let (lambda, mu) = (10.0 * 0.4999 / (1.4999 * 0.0002), 10.0 / 2.9998);
        let p = 4.0 * lambda;
        for kind in CellKind::ALL {
            let mut body = distorted(kind);
            body.materials[0].poisson = 0.4999;
            let found = cell_stress(&body, &linear(&body, h));
            let expected = [p + 2.0 * mu, p + 6.0 * mu, p, 0.0, 0.0, 2.0 * mu];
            assert_stress(&found, expected, 1e-13 * p * 10.0);
        }
    }

    #[test]
    fn von_mises_of_tension_is_the_tension_and_of_shear_root_three_times_it() {
        assert_eq!(von_mises([5.0, 0.0, 0.0, 0.0, 0.0, 0.0]), 5.0);
        assert_eq!(von_mises([7.0, 7.0, 7.0, 0.0, 0.0, 0.0]), 0.0);
        assert!((von_mises([0.0, 0.0, 0.0, 0.0, 0.0, 2.0]) - 2.0 * 3.0_f64.sqrt()).abs() < 1e-15);
    }
}
