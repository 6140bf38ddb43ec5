//! Incompatible modes of four-node quadrilaterals and eight-node hexahedra, so that they bend as beams do.
//!
//! ```text
//! u = Σ N_a u_a + Σ M_j α_j,   M_j = 1 − ξ_j²
//! ∇M_j = (det J₀/det J) J₀⁻ᵀ ∂M_j/∂ξ − its mean over the cell                     J₀: that at the centre
//! (B15)  K = K_uu − K_uα K_αα⁻¹ K_αu,   f = f_u − K_uα K_αα⁻¹ f_α,   α = K_αα⁻¹ (f_α − K_αu u)
//! ```
//!
//! A plain cell that is bent has to shear; the modes are what it lacks. They belong to the cell alone and are condensed
//! within it. As their strain has no mean, a uniform stress does no work on them and the patch test is passed
//! for any shape of cell; in rings that holds of `M_j/r`, the strain around the axis, as well. f_α is that of
//! heat and initial stress (B12). Nearly incompressible cells with modes see their dilatation at every point: the modes
//! give it room, in 3D all but that of the motion ξηζ, and a mean would let them bend too much.
//!
//! Wilson, Taylor, Doherty & Ghaboussi, in Numerical and Computer Methods in Structural Mechanics (1973);
//! Taylor, Beresford & Wilson, Int. J. Numer. Meth. Engng 10 (1976) 1211–1219.

use nalgebra::Vector3;

use super::quadrature::{Mapped, positions, rule};
use super::reference::Point;
use super::{Body, Cell, CellKind, Formulation, Model};

/// The modes of a cell.
pub(super) struct Modes {
    /// Reciprocal basis at the centre, times `det J₀`.
    cofactors: Vec<Vector3<f64>>,
    nodes: Vec<Vector3<f64>>,
    model: Model,
    /// Mean gradient, and mean of `M_j/r`.
    means: Vec<(Vector3<f64>, f64)>,
}

impl Body {
    /// Whether cells of a kind have modes.
    pub(super) fn has_modes(&self, kind: CellKind) -> bool {
        self.formulation == Formulation::IncompatibleModes
            && matches!(kind, CellKind::Quad4 | CellKind::Hex8)
    }
}

impl Modes {
    /// Those of a cell; none if it has none.
    pub(super) fn of(body: &Body, cell: Cell<'_>) -> Option<Self> {
        if !body.has_modes(cell.kind) {
            return None;
        }
        let nodes = positions(&body.mesh, cell.nodes);
        let axes = cell.kind.dimension();
        let [t1, t2, t3] = Point::at(cell.kind.reference(), [0.0; 3], 1.0).tangents(axes, &nodes);
        let cofactors = [t2.cross(&t3), t3.cross(&t1), t1.cross(&t2)];
        let mut modes = Self {
            cofactors: cofactors[..axes].to_vec(),
            nodes,
            model: body.model,
            means: vec![(Vector3::zeros(), 0.0); axes],
        };
        let mut means = modes.means.clone();
        let mut volume = 0.0;
        for point in rule(cell.kind, body.model) {
            let weight = point.map(body.model, &modes.nodes).volume;
            volume += weight;
            for (j, mean) in means.iter_mut().enumerate() {
                let (gradient, around) = modes.raw(j, point);
                mean.0 += gradient * weight;
                mean.1 += around * weight;
            }
        }
        modes.means = means
            .into_iter()
            .map(|(sum, around)| (sum / volume, around / volume))
            .collect();
        Some(modes)
    }

    /// Gradient of a mode and its `M_j/r`, means and all.
    fn raw(&self, j: usize, point: &Point) -> (Vector3<f64>, f64) {
        let [t1, t2, t3] = point.tangents(self.model.dimension(), &self.nodes);
        let xi = point.position[j];
        let gradient = self.cofactors[j] * (-2.0 * xi / t1.dot(&t2.cross(&t3)));
        let around = match self.model {
            Model::Axisymmetric => (1.0 - xi * xi) / point.in_space(&self.nodes).x,
            _ => 0.0,
        };
        (gradient, around)
    }

    /// Puts the modes behind the nodes of a point.
    pub(super) fn append(&self, point: &Point, mapped: &mut Mapped) {
        for (j, mean) in self.means.iter().enumerate() {
            let (gradient, around) = self.raw(j, point);
            mapped.gradients.push(gradient - mean.0);
            if !mapped.hoop.is_empty() {
                mapped.hoop.push(around - mean.1);
            }
        }
    }
}

impl Point {
    /// The same, with the modes of a cell that has them behind its nodes.
    pub(super) fn map_with(
        &self,
        model: Model,
        nodes: &[Vector3<f64>],
        modes: Option<&Modes>,
    ) -> Mapped {
        let mut mapped = self.map(model, nodes);
        if let Some(modes) = modes {
            modes.append(self, &mut mapped);
        }
        mapped
    }
}

/// A cell's quadrature points in space; incompatible modes (B15) come behind the nodes.
pub(crate) fn mapped(body: &Body, cell: Cell<'_>) -> Vec<Mapped> {
    let positions = positions(&body.mesh, cell.nodes);
    let modes = Modes::of(body, cell);
    let points = rule(cell.kind, body.model).iter();
    points
        .map(|point| point.map_with(body.model, &positions, modes.as_ref()))
        .collect()
}
