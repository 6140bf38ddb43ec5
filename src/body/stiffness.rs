//! The stiffness matrix.
//!
//! ```text
//! (B3)  K_ab = λ A_ab + μ (A_abᵀ + tr A_ab I),      A_ab = ∫ ∇N_a ∇N_bᵀ dV
//! ```
//!
//! per pair of nodes, from `∫ λ div u div v + 2 μ ε(u) : ε(v) dV`. Nearly incompressible
//! cells put a mean in place of `λ A_ab` ((B4), (B5)).

use nalgebra::{Matrix3, Vector3};

use super::Body;
use super::cell::MOST_NODES;
use super::dilatation::{Dilatation, Patches};
use super::material::Lame;
use super::quadrature::{Mapped, positions, rule};
use super::sparsity::BlockMatrix;

/// Stiffness matrix of the body without supports, in N/m: symmetric, both triangles, rows
/// `dimension · node + axis` with ascending columns.
///
/// The body has passed [`check`](super::check).
#[must_use]
pub fn stiffness(body: &Body) -> sprs::CsMat<f64> {
    let mesh = &body.mesh;
    let patches = Patches::new(body);
    let lists = (0..mesh.cell_count()).map(|cell| mesh.cell(cell).nodes);
    let lists = lists.chain(patches.iter().map(|patch| patch.nodes));
    let mut matrix = BlockMatrix::new(mesh.dimension, mesh.nodes.len(), lists);
    for cell in 0..mesh.cell_count() {
        add_cell(body, cell, &mut matrix);
    }
    let depth = body.model.depth();
    for patch in patches.iter() {
        for (a, (row, b_a)) in patch.nodes.iter().zip(patch.gradients).enumerate() {
            for (column, b_b) in patch.nodes.iter().zip(patch.gradients).take(a + 1) {
                matrix.add(
                    *row,
                    *column,
                    &(b_a * b_b.transpose() * (depth * patch.stiffness)),
                );
            }
        }
    }
    matrix.into_rows()
}

/// Adds (B3) of one cell, with (B4) where its dilatation is the cell's mean.
fn add_cell(body: &Body, index: usize, matrix: &mut BlockMatrix) {
    let cell = body.mesh.cell(index);
    let material = &body.materials[body.material_of_cell[index]];
    let Lame { lambda, shear } = material.lame(body.model);
    let dilatation = Dilatation::of(cell.kind, body.model, material);
    let depth = body.model.depth();

    let count = cell.nodes.len();
    let positions = positions(&body.mesh, cell.nodes);
    let mut points = [Mapped::default(); MOST_NODES];
    let points = &mut points[..rule(cell.kind).len()];
    for (mapped, point) in points.iter_mut().zip(rule(cell.kind)) {
        *mapped = point.map(cell.kind, &positions[..count]);
    }
    let (volume, mean) = mean_gradients(points);

    for a in 0..count {
        for b in 0..=a {
            let product = gradient_product(points, a, b);
            let shear_part =
                (product.transpose() + Matrix3::from_diagonal_element(product.trace())) * shear;
            let volume_part = match dilatation {
                Dilatation::Pointwise => product * lambda,
                Dilatation::CellMean => mean[a] * mean[b].transpose() * (lambda * volume),
                Dilatation::NodeMean => Matrix3::zeros(),
            };
            matrix.add(
                cell.nodes[a],
                cell.nodes[b],
                &((shear_part + volume_part) * depth),
            );
        }
    }
}

/// Volume of a cell and `ḡ_a = (1/V) ∫ ∇N_a dV` (B4).
pub(crate) fn mean_gradients(points: &[Mapped]) -> (f64, [Vector3<f64>; MOST_NODES]) {
    let volume: f64 = points.iter().map(|point| point.volume).sum();
    let mut mean = [Vector3::zeros(); MOST_NODES];
    for point in points {
        for (sum, gradient) in mean.iter_mut().zip(&point.gradients) {
            *sum += gradient * (point.volume / volume);
        }
    }
    (volume, mean)
}

/// `A_ab = ∫ ∇N_a ∇N_bᵀ dV` (B3).
#[inline]
fn gradient_product(points: &[Mapped], a: usize, b: usize) -> Matrix3<f64> {
    let mut product = Matrix3::zeros();
    for point in points {
        product += point.gradients[a] * point.gradients[b].transpose() * point.volume;
    }
    product
}
