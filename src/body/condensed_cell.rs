//! Incompatible modes, condensed within their cell (B15).

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::Body;
use super::element::Element;

/// A cell with its modes condensed (B15), per metre of depth.
pub(super) struct Condensed {
    /// K of the nodes, rows `dimension · node + axis`.
    pub(super) stiffness: DMatrix<f64>,
    /// K_αu.
    coupling: DMatrix<f64>,
    factor: Cholesky<f64, Dyn>,
}

impl Condensed {
    /// That of a cell; none if it has no modes.
    pub(super) fn of(body: &Body, index: usize) -> Option<Self> {
        let cell = body.mesh.cell(index);
        if !body.has_modes(cell.kind) {
            return None;
        }
        let axes = body.mesh.dimension;
        let (nodes, all) = (axes * cell.nodes.len(), cell.nodes.len() + axes);
        let element = Element::new(body, index);
        let mut whole = DMatrix::zeros(axes * all, axes * all);
        for a in 0..all {
            for b in 0..=a {
                let block = element.block(a, b);
                for (i, j) in (0..axes).flat_map(|i| (0..axes).map(move |j| (i, j))) {
                    whole[(axes * a + i, axes * b + j)] = block[(i, j)];
                    whole[(axes * b + j, axes * a + i)] = block[(i, j)];
                }
            }
        }
        let own = axes * axes;
        let factor = whole
            .view((nodes, nodes), (own, own))
            .into_owned()
            .cholesky()?;
        let coupling = whole.view((nodes, 0), (own, nodes)).into_owned();
        let stiffness =
            whole.view((0, 0), (nodes, nodes)) - coupling.transpose() * factor.solve(&coupling);
        Some(Self {
            stiffness,
            coupling,
            factor,
        })
    }

    /// f of the nodes from forces on the nodes and then on the modes.
    pub(super) fn forces(&self, forces: &[f64]) -> DVector<f64> {
        let (nodes, own) = forces.split_at(self.stiffness.nrows());
        let own = self.factor.solve(&DVector::from_column_slice(own));
        DVector::from_column_slice(nodes) - self.coupling.transpose() * own
    }

    /// α of a displacement of the nodes, and of forces on the nodes and then on the modes.
    pub(super) fn amplitudes(&self, displacement: &DVector<f64>, forces: &[f64]) -> DVector<f64> {
        let own = DVector::from_column_slice(&forces[self.stiffness.nrows()..]);
        self.factor.solve(&(own - &self.coupling * displacement))
    }
}
