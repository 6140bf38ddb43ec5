//! Stress in the cells and at the nodes, for reports.
//!
//! ```text
//! σ = λ θ I + 2 μ ε(u)      ε at the centre of the cell, θ the dilatation that its energy holds
//! ```
//!
//! In nearly incompressible cells θ is the mean of (B4) or (B5): with `tr ε` in its
//! place the pressure would be noise times λ.

use nalgebra::{Matrix3, Vector3};

use super::dilatation::{Dilatation, Patches};
use super::quadrature::{Point, positions};
use super::{Body, Cell};

/// Stress at the centre of each cell, in pascal, in the order xx, yy, zz, yz, xz, xy.
///
/// `displacement` in metre, entry `dimension · node + axis`.
#[must_use]
pub fn cell_stress(body: &Body, displacement: &[f64]) -> Vec<[f64; 6]> {
    let axes = body.mesh.dimension;
    let at = |node: usize| {
        let mut vector = Vector3::zeros();
        for (entry, value) in vector.iter_mut().zip(&displacement[axes * node..axes * (node + 1)]) {
            *entry = *value;
        }
        vector
    };
    let patches = Patches::new(body);
    let around_nodes: Vec<f64> = patches
        .iter()
        .map(|patch| {
            let terms = patch.nodes.iter().zip(patch.gradients);
            terms.map(|(node, b)| b.dot(&at(*node))).sum()
        })
        .collect();

    let cells = body.mesh.cells().zip(&body.material_of_cell);
    cells
        .map(|(cell, &index)| {
            let material = &body.materials[index];
            let gradient = centre_gradient(body, cell, &at);
            let theta = match Dilatation::of(cell.kind, body.model, material) {
                Dilatation::Pointwise => gradient.trace(),
                Dilatation::CellMean => mean_dilatation(body, cell, &at),
                Dilatation::NodeMean => {
                    let patch = |node: &usize| patches.find(index, *node);
                    let found = cell.nodes.iter().filter_map(patch);
                    found.map(|patch| around_nodes[patch]).sum::<f64>() / cell.nodes.len() as f64
                }
            };
            let lame = material.lame(body.model);
            lame.stress(body.model, strain(&gradient), theta)
        })
        .collect()
}
