//! The largest displacement, stress, strain and rotation of a body, each with its place.
//!
//! ```text
//! (B10)  ε = ½ (H + Hᵀ),   ω = ½ (H − Hᵀ),   H = ∂u/∂x at the centre of a cell
//!        strain    largest |eigenvalue| of ε      rotation   ‖axial vector of ω‖, in radian
//! ```
//!
//! The theory neglects the squares of both beside themselves.

use nalgebra::{Matrix3, Vector3};

use super::Body;
use super::stress::{for_each_cell, von_mises};

/// A size and where it is: a node or a cell of the mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Extreme {
    /// Its size.
    pub value: f64,
    /// Node or cell.
    pub place: usize,
}

/// What (B10) finds in a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Extremes {
    /// Length of a displacement, in metre, and its node.
    pub displacement: Extreme,
    /// Von Mises stress at the centre of a cell, in pascal.
    pub von_mises: Extreme,
    /// Principal strain, by size.
    pub strain: Extreme,
    /// Rotation of a cell, in radian.
    pub rotation: Extreme,
}

impl Extreme {
    fn raise(&mut self, value: f64, place: usize) {
        if value > self.value {
            *self = Self { value, place };
        }
    }
}

/// The extremes of a displacement, in metre, entry `dimension · node + axis`.
#[must_use]
pub(crate) fn extremes(body: &Body, displacement: &[f64]) -> Extremes {
    let mut found = Extremes::default();
    let of_nodes = displacement.chunks(body.mesh.dimension.max(1));
    for (node, u) in of_nodes.enumerate() {
        let length = u.iter().fold(0.0, |size: f64, u| size.hypot(*u));
        found.displacement.raise(length, node);
    }
    for_each_cell(body, displacement, |cell, gradient, stress| {
        found.von_mises.raise(von_mises(stress), cell);
        let strain = (gradient + gradient.transpose()) / 2.0;
        // No eigenvalue is beyond the norm, which is cheap.
        if strain.norm() > found.strain.value {
            found
                .strain
                .raise(strain.symmetric_eigenvalues().amax(), cell);
        }
        found.rotation.raise(rotation(gradient), cell);
    });
    found
}

fn rotation(h: &Matrix3<f64>) -> f64 {
    let axial = Vector3::new(
        h[(2, 1)] - h[(1, 2)],
        h[(0, 2)] - h[(2, 0)],
        h[(1, 0)] - h[(0, 1)],
    );
    axial.norm() / 2.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::CellKind;
    use crate::body::tests::samples::distorted;

    #[test]
    fn stretch_and_turn_of_a_linear_displacement_are_found_in_every_kind_of_cell() {
        // u = (0.03 x − 0.2 y, 0.2 x − 0.05 y): ε = diag(0.03, −0.05), ω about z by 0.2.
        for kind in CellKind::all() {
            let body = distorted(kind);
            let axes = kind.dimension();
            let at = |x: &[f64; 3]| [0.03 * x[0] - 0.2 * x[1], 0.2 * x[0] - 0.05 * x[1], 0.0];
            let u = body.mesh.nodes.iter().map(at);
            let u: Vec<f64> = u.flat_map(|u| u.into_iter().take(axes)).collect();
            let found = extremes(&body, &u);
            assert!((found.strain.value - 0.05).abs() < 1e-12, "{kind:?}");
            assert!((found.rotation.value - 0.2).abs() < 1e-12, "{kind:?}");
            let lengths = body.mesh.nodes.iter().map(|x| {
                let [u, v, _] = at(x);
                u.hypot(v)
            });
            let longest = lengths.fold(0.0, f64::max);
            assert!((found.displacement.value - longest).abs() < 1e-15);
        }
    }
}
