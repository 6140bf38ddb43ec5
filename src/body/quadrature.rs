//! Gauss quadrature over a cell, and gradients in space.
//!
//! ```text
//! ∫ f dV ≈ Σ_q f(x_q) w_q det J_q,     J = [t_1 t_2 t_3],   t_j = Σ_a x_a ∂N_a/∂ξ_j
//! ∇N_a = Σ_j r_j ∂N_a/∂ξ_j,            r_1 = t_2 × t_3 / det J  (and cyclic)
//! ```
//!
//! The tangents `t_j` and their reciprocal basis `r_j` serve plane cells as well: there
//! `t_3` is the unit vector out of the plane. Two Gauss points per axis integrate the
//! volume, `∫ N_a dV` and `∫ ∇N_a dV` of every cell exactly, warped hexahedra included.

use std::sync::LazyLock;

use nalgebra::Vector3;

use super::cell::MOST_NODES;
use super::{Cell, CellKind, Mesh};

/// A quadrature point of the reference cell.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Point {
    /// Weight `w_q`.
    pub(crate) weight: f64,
    /// Values `N_a`.
    pub(crate) shape: [f64; MOST_NODES],
    /// Derivatives `∂N_a/∂ξ_j`.
    pub(crate) derivatives: [[f64; 3]; MOST_NODES],
}

/// A quadrature point in space.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Mapped {
    /// Gradients `∇N_a`, in 1/m.
    pub(crate) gradients: [Vector3<f64>; MOST_NODES],
    /// Volume `w_q det J_q` that the point stands for, in m³ (2D: m²).
    pub(crate) volume: f64,
}

impl Point {
    /// The shape functions of `kind` at a reference position.
    pub(crate) fn at(kind: CellKind, position: [f64; 3], weight: f64) -> Self {
        Self {
            weight,
            shape: kind.shape(position),
            derivatives: kind.shape_derivatives(position),
        }
    }

    /// Tangents `t_j` of the cell whose nodes are at `nodes`.
    pub(crate) fn tangents(&self, kind: CellKind, nodes: &[Vector3<f64>]) -> [Vector3<f64>; 3] {
        let mut tangents = [Vector3::zeros(); 3];
        for (x, row) in nodes.iter().zip(&self.derivatives) {
            for (tangent, derivative) in tangents.iter_mut().zip(row) {
                *tangent += x * *derivative;
            }
        }
        if kind.dimension() == 2 {
            tangents[2] = Vector3::z();
        }
        tangents
    }

    /// Gradients and volume in space.
    #[inline]
    pub(crate) fn map(&self, kind: CellKind, nodes: &[Vector3<f64>]) -> Mapped {
        let [t1, t2, t3] = self.tangents(kind, nodes);
        let det = t1.dot(&t2.cross(&t3));
        let reciprocal = [
            t2.cross(&t3) / det,
            t3.cross(&t1) / det,
            t1.cross(&t2) / det,
        ];
        let mut gradients = [Vector3::zeros(); MOST_NODES];
        for (gradient, [d1, d2, d3]) in gradients.iter_mut().zip(self.derivatives).take(nodes.len())
        {
            *gradient = reciprocal[0] * d1 + reciprocal[1] * d2 + reciprocal[2] * d3;
        }
        Mapped {
            gradients,
            volume: self.weight * det,
        }
    }
}

/// The quadrature rule of a cell: one point in simplices, where the strain is constant,
/// and two Gauss points per axis in quadrilaterals and hexahedra.
pub(crate) fn rule(kind: CellKind) -> &'static [Point] {
    static TRI3: LazyLock<Vec<Point>> = LazyLock::new(|| simplex(CellKind::Tri3, 0.5));
    static QUAD4: LazyLock<Vec<Point>> = LazyLock::new(|| gauss(CellKind::Quad4));
    static TET4: LazyLock<Vec<Point>> = LazyLock::new(|| simplex(CellKind::Tet4, 1.0 / 6.0));
    static HEX8: LazyLock<Vec<Point>> = LazyLock::new(|| gauss(CellKind::Hex8));
    match kind {
        CellKind::Tri3 => &TRI3,
        CellKind::Quad4 => &QUAD4,
        CellKind::Tet4 => &TET4,
        CellKind::Hex8 => &HEX8,
    }
}

fn simplex(kind: CellKind, volume: f64) -> Vec<Point> {
    vec![Point::at(kind, kind.centre(), volume)]
}

fn gauss(kind: CellKind) -> Vec<Point> {
    let scale = 1.0 / 3.0_f64.sqrt();
    let corners = (0..kind.node_count()).map(|node| kind.corner(node));
    corners
        .map(|corner| Point::at(kind, corner.map(|x| x * scale), 1.0))
        .collect()
}

/// A cell's quadrature points in space; those past the end of its [`rule`] are zero.
pub(crate) fn mapped(mesh: &Mesh, cell: Cell<'_>) -> [Mapped; MOST_NODES] {
    let positions = positions(mesh, cell.nodes);
    let mut points = [Mapped::default(); MOST_NODES];
    for (mapped, point) in points.iter_mut().zip(rule(cell.kind)) {
        *mapped = point.map(cell.kind, &positions[..cell.nodes.len()]);
    }
    points
}

/// Positions of a cell's nodes, in metre; entries past the last node are zero.
pub(crate) fn positions(mesh: &Mesh, nodes: &[usize]) -> [Vector3<f64>; MOST_NODES] {
    let mut positions = [Vector3::zeros(); MOST_NODES];
    for (position, node) in positions.iter_mut().zip(nodes) {
        *position = mesh.nodes[*node].into();
    }
    positions
}

impl Mesh {
    /// Signed volume of a cell, in m³ (2D: area in m²); negative when it is inside out.
    #[must_use]
    pub fn volume(&self, cell: usize) -> f64 {
        let cell = self.cell(cell);
        let positions = positions(self, cell.nodes);
        let positions = &positions[..cell.nodes.len()];
        let points = rule(cell.kind).iter();
        points
            .map(|point| {
                let [t1, t2, t3] = point.tangents(cell.kind, positions);
                point.weight * t1.dot(&t2.cross(&t3))
            })
            .sum()
    }

    /// Mean position of a cell's nodes, in metre.
    #[must_use]
    pub fn centroid(&self, cell: usize) -> [f64; 3] {
        let nodes = self.cell(cell).nodes;
        let sum: Vector3<f64> = nodes
            .iter()
            .map(|node| Vector3::from(self.nodes[*node]))
            .sum();
        (sum / nodes.len() as f64).into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cell whose nodes are those of the reference cell, moved by a fixed wave.
    fn distorted(kind: CellKind) -> Mesh {
        let nodes = (0..kind.node_count()).map(|node| {
            let [x, y, z] = kind.corner(node);
            let wave = |phase: f64| 0.1 * (1.3 * x + 2.1 * y + 0.7 * z + phase).sin();
            let depth = if kind.dimension() == 3 { 1.0 } else { 0.0 };
            [x + wave(0.0), y + wave(1.0), depth * (z + wave(2.0))]
        });
        let mut mesh = Mesh::new(kind.dimension(), nodes.collect());
        mesh.push_cell(kind, &(0..kind.node_count()).collect::<Vec<_>>());
        mesh
    }

    #[test]
    fn volumes_of_the_reference_cells_are_exact() {
        let expected = [0.5, 4.0, 1.0 / 6.0, 8.0];
        for (kind, expected) in CellKind::ALL.into_iter().zip(expected) {
            let nodes = (0..kind.node_count())
                .map(|node| kind.corner(node))
                .collect();
            let mut mesh = Mesh::new(kind.dimension(), nodes);
            mesh.push_cell(kind, &(0..kind.node_count()).collect::<Vec<_>>());
            assert!((mesh.volume(0) - expected).abs() < 1e-14);
        }
    }

    #[test]
    fn gradients_are_exact_for_a_linear_field_on_a_distorted_cell() {
        let field = Vector3::new(3.0, -2.0, 5.0);
        for kind in CellKind::ALL {
            let mesh = distorted(kind);
            let nodes = positions(&mesh, mesh.cell(0).nodes);
            for point in rule(kind) {
                let mapped = point.map(kind, &nodes[..kind.node_count()]);
                let terms = mapped.gradients.iter().zip(&nodes);
                let gradient: Vector3<f64> = terms.map(|(g, x)| g * field.dot(x)).sum();
                for axis in 0..kind.dimension() {
                    assert!((gradient[axis] - field[axis]).abs() < 1e-13);
                }
            }
        }
    }

    #[test]
    fn the_integral_of_a_gradient_is_the_integral_of_the_normal_over_the_surface() {
        // Divergence theorem ∫ ∇N_a dV = ∫ N_a n dA; Σ_a x_a·(…) = dimension × volume.
        for kind in CellKind::ALL {
            let mesh = distorted(kind);
            let nodes = positions(&mesh, mesh.cell(0).nodes);
            let mut integral = [Vector3::zeros(); MOST_NODES];
            for point in rule(kind) {
                let mapped = point.map(kind, &nodes[..kind.node_count()]);
                for (sum, gradient) in integral.iter_mut().zip(&mapped.gradients) {
                    *sum += gradient * mapped.volume;
                }
            }
            for facet in kind.facets() {
                let facet = crate::body::Facet {
                    nodes: facet.to_vec(),
                };
                let surface = mesh.facet_geometry(&facet);
                for (node, vector) in facet.nodes.iter().zip(surface.vectors) {
                    integral[*node] -= Vector3::from(vector);
                }
            }
            assert!(integral.iter().all(|left| left.norm() < 1e-14));
        }
    }
}
