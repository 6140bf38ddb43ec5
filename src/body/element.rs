//! The blocks of a cell's stiffness (B3), with (B4), (B11) and (B14).

use nalgebra::{Matrix3, Matrix6, Vector3};

use super::dilatation::{Dilatation, mean_gradients};
use super::material::Lame;
use super::modes::mapped;
use super::quadrature::{Mapped, positions, rule};
use super::{Body, Cell, Material, Model};

/// What the blocks of a cell are made of.
pub(super) struct Element {
    points: Vec<Mapped>,
    law: Law,
    dilatation: Dilatation,
    /// Volume and `ḡ_a` (B4).
    mean: (f64, Vec<Vector3<f64>>),
    ring: bool,
}

/// Constants of a cell.
enum Law {
    Isotropic(Lame),
    /// λ̂, and R per point (B14).
    Oriented(f64, Vec<Matrix6<f64>>),
}

impl Element {
    pub(super) fn new(body: &Body, index: usize) -> Self {
        let cell = body.mesh.cell(index);
        let material = &body.materials[body.material_of_cell[index]];
        let points = mapped(body, cell);
        Self {
            law: Law::of(body, cell, material),
            dilatation: Dilatation::of(body, cell.kind, material),
            mean: mean_gradients(&points),
            ring: body.model == Model::Axisymmetric,
            points,
        }
    }

    /// K_ab for one metre of depth.
    pub(super) fn block(&self, a: usize, b: usize) -> Matrix3<f64> {
        let (volume, mean) = &self.mean;
        let product = gradient_product(&self.points, a, b);
        let (lambda, rest) = match &self.law {
            Law::Isotropic(Lame { lambda, shear }) => {
                let mut rest = (product.transpose()
                    + Matrix3::from_diagonal_element(product.trace()))
                    * *shear;
                rest[(0, 0)] += 2.0 * shear * hoop_product(&self.points, a, b);
                (*lambda, rest)
            }
            Law::Oriented(lambda, rests) => (*lambda, strain_product(&self.points, rests, a, b)),
        };
        rest + match self.dilatation {
            Dilatation::Pointwise if self.ring => divergence_product(&self.points, a, b) * lambda,
            Dilatation::Pointwise => product * lambda,
            Dilatation::CellMean => mean[a] * mean[b].transpose() * (lambda * volume),
            Dilatation::NodeMean => Matrix3::zeros(),
        }
    }
}

impl Law {
    fn of(body: &Body, cell: Cell<'_>, material: &Material) -> Self {
        let Some(constants) = &material.orthotropic else {
            return Self::Isotropic(material.lame(body.model));
        };
        let nodes = positions(&body.mesh, cell.nodes);
        let rests = rule(cell.kind, body.model).iter();
        let rests = rests.map(|point| constants.split(body.model, point.in_space(&nodes)).1);
        let rests = rests.collect();
        Self::Oriented(constants.split(body.model, nodes[0]).0, rests)
    }
}

/// `∫ B_aᵀ R B_b dV` (B14), symmetric to the last bit where a = b.
fn strain_product(points: &[Mapped], rests: &[Matrix6<f64>], a: usize, b: usize) -> Matrix3<f64> {
    let terms = points.iter().zip(rests);
    let product = |(point, rest): (&Mapped, &Matrix6<f64>)| {
        point.strain(a).transpose() * (rest * point.strain(b)) * point.volume
    };
    let sum: Matrix3<f64> = terms.map(product).sum();
    match a == b {
        true => (sum + sum.transpose()) / 2.0,
        false => sum,
    }
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

/// `∫ d_a d_bᵀ dV` (B11).
fn divergence_product(points: &[Mapped], a: usize, b: usize) -> Matrix3<f64> {
    let product =
        |point: &Mapped| point.divergence(a) * point.divergence(b).transpose() * point.volume;
    points.iter().map(product).sum()
}

/// `∫ N_a N_b / r² dV` (B11), zero but for rings.
fn hoop_product(points: &[Mapped], a: usize, b: usize) -> f64 {
    let product = |point: &Mapped| match point.hoop.as_slice() {
        [] => 0.0,
        hoop => hoop[a] * hoop[b] * point.volume,
    };
    points.iter().map(product).sum()
}
