//! Gauss quadrature over a cell, and gradients in space.
//!
//! ```text
//! ∫ f dV ≈ Σ_q f(x_q) w_q det J_q,     J = [t_1 t_2 t_3],   t_j = Σ_a x_a ∂N_a/∂ξ_j
//! ∇N_a = Σ_j r_j ∂N_a/∂ξ_j,            r_1 = t_2 × t_3 / det J  (and cyclic)
//! div (N_a u_a) = d_a · u_a,           d_a = ∇N_a, and on rings + (N_a/r) e_r      (B10)
//! ```
//!
//! The tangents `t_j` and their reciprocal basis `r_j` serve plane cells as well: there
//! `t_3` is the unit vector out of the plane. Rings, the cells of axisymmetric bodies,
//! have `2πr` times the area of their section for a volume.

use std::f64::consts::{FRAC_1_SQRT_2, PI};
use std::sync::LazyLock;

use nalgebra::{Matrix6x3, Vector3};

use super::gauss::three_in_triangle;
use super::reference::Point;
use super::{CellKind, Mesh, Model};

/// A quadrature point in space.
#[derive(Clone, Debug)]
pub(crate) struct Mapped {
    /// Gradients `∇N_a`, in 1/m.
    pub(crate) gradients: Vec<Vector3<f64>>,
    /// `N_a/r` on rings, in 1/m; none elsewhere.
    pub(crate) hoop: Vec<f64>,
    /// Volume `w_q det J_q` that the point stands for, in m³ (plane bodies: m²).
    pub(crate) volume: f64,
}

impl Point {
    /// Tangents `t_j` of the cell of `dimension` 2 or 3 whose nodes are at `nodes`.
    pub(crate) fn tangents(&self, dimension: usize, nodes: &[Vector3<f64>]) -> [Vector3<f64>; 3] {
        let mut tangents = [Vector3::zeros(); 3];
        for (x, row) in nodes.iter().zip(&self.derivatives) {
            for (tangent, derivative) in tangents.iter_mut().zip(row) {
                *tangent += x * *derivative;
            }
        }
        if dimension == 2 {
            tangents[2] = Vector3::z();
        }
        tangents
    }

    /// Where it is in space.
    pub(crate) fn in_space(&self, nodes: &[Vector3<f64>]) -> Vector3<f64> {
        let terms = nodes.iter().zip(&self.shape);
        terms.map(|(x, shape)| x * *shape).sum()
    }

    /// Gradients and volume in space.
    #[inline]
    pub(crate) fn map(&self, model: Model, nodes: &[Vector3<f64>]) -> Mapped {
        let [t1, t2, t3] = self.tangents(model.dimension(), nodes);
        let det = t1.dot(&t2.cross(&t3));
        let reciprocal = [
            t2.cross(&t3) / det,
            t3.cross(&t1) / det,
            t1.cross(&t2) / det,
        ];
        let derivatives = self.derivatives.iter();
        let gradients = derivatives
            .map(|[d1, d2, d3]| reciprocal[0] * *d1 + reciprocal[1] * *d2 + reciprocal[2] * *d3);
        let mut mapped = Mapped {
            gradients: gradients.collect(),
            hoop: Vec::new(),
            volume: self.weight * det,
        };
        if model == Model::Axisymmetric {
            let radius = self.in_space(nodes).x;
            mapped.hoop = self.shape.iter().map(|shape| shape / radius).collect();
            mapped.volume *= 2.0 * PI * radius;
        }
        mapped
    }
}

impl Mapped {
    /// `d_a` of (B10), in 1/m.
    #[inline]
    pub(crate) fn divergence(&self, a: usize) -> Vector3<f64> {
        match self.hoop.get(a) {
            None => self.gradients[a],
            Some(hoop) => self.gradients[a] + Vector3::x() * *hoop,
        }
    }

    /// `B_a`: strain of a displacement of node a, in Mandel's form.
    pub(crate) fn strain(&self, a: usize) -> Matrix6x3<f64> {
        let [x, y, z] = self.gradients[a].into();
        let [p, q, r] = [x, y, z].map(|slope| slope * FRAC_1_SQRT_2);
        let mut strain = Matrix6x3::zeros();
        for (at, slope) in [
            ((0, 0), x),
            ((1, 1), y),
            ((2, 2), z),
            ((3, 1), r),
            ((3, 2), q),
            ((4, 0), r),
            ((4, 2), p),
            ((5, 0), q),
            ((5, 1), p),
        ] {
            strain[at] = slope;
        }
        strain[(2, 0)] = self.hoop.get(a).copied().unwrap_or(0.0);
        strain
    }
}

/// The quadrature rule of a cell within a model.
///
/// One point of a linear triangle will do where strain is constant, which it is not in a ring.
pub(crate) fn rule(kind: CellKind, model: Model) -> &'static [Point] {
    static RING: LazyLock<Vec<Point>> = LazyLock::new(|| {
        let point = |(at, weight)| Point::at(CellKind::Tri3.reference(), at, weight);
        three_in_triangle().map(point).into()
    });
    match (kind, model) {
        (CellKind::Tri3, Model::Axisymmetric) => &RING,
        _ => &kind.reference().rule,
    }
}

/// Positions of nodes, in metre.
pub(crate) fn positions(mesh: &Mesh, nodes: &[usize]) -> Vec<Vector3<f64>> {
    let positions = nodes.iter().map(|node| mesh.nodes[*node].into());
    positions.collect()
}

impl Mesh {
    /// Signed volume of a cell, in m³ (2D: area in m², also of the section of a ring); negative
    /// when it is inside out.
    #[must_use]
    pub fn volume(&self, cell: usize) -> f64 {
        let cell = self.cell(cell);
        let positions = positions(self, cell.nodes);
        let points = cell.kind.reference().rule.iter();
        points
            .map(|point| {
                let [t1, t2, t3] = point.tangents(cell.kind.dimension(), &positions);
                point.weight * t1.dot(&t2.cross(&t3))
            })
            .sum()
    }

    /// Where a reference position of a cell is, in metre.
    pub(super) fn in_space(&self, cell: usize, at: [f64; 3]) -> Vector3<f64> {
        let cell = self.cell(cell);
        let nodes = cell.nodes.iter().zip(cell.kind.reference().shape(at));
        nodes
            .map(|(node, shape)| Vector3::from(self.nodes[*node]) * shape)
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
            let [x, y, z] = kind.position(node);
            let wave = |phase: f64| 0.1 * (1.3 * x + 2.1 * y + 0.7 * z + phase).sin();
            let depth = if kind.dimension() == 3 { 1.0 } else { 0.0 };
            [x + wave(0.0), y + wave(1.0), depth * (z + wave(2.0))]
        });
        let mut mesh = Mesh::new(kind.dimension(), nodes.collect());
        mesh.push_cell(kind, &(0..kind.node_count()).collect::<Vec<_>>());
        mesh
    }

    fn model(kind: CellKind) -> Model {
        match kind.dimension() {
            2 => Model::PlaneStrain,
            _ => Model::Solid,
        }
    }

    #[test]
    fn volumes_of_the_reference_cells_are_exact() {
        let (sixth, half) = (1.0 / 6.0, 0.5);
        let third = 4.0 / 3.0;
        let expected = [
            half, 4.0, sixth, 8.0, 1.0, third, half, 4.0, 4.0, sixth, 8.0, 8.0, 1.0, third,
        ];
        for (kind, expected) in CellKind::all().zip(expected) {
            let nodes = (0..kind.node_count())
                .map(|node| kind.position(node))
                .collect();
            let mut mesh = Mesh::new(kind.dimension(), nodes);
            mesh.push_cell(kind, &(0..kind.node_count()).collect::<Vec<_>>());
            assert!((mesh.volume(0) - expected).abs() < 1e-14);
        }
    }

    #[test]
    fn gradients_are_exact_for_a_linear_field_on_a_distorted_cell() {
        let field = Vector3::new(3.0, -2.0, 5.0);
        for kind in CellKind::all() {
            let mesh = distorted(kind);
            let nodes = positions(&mesh, mesh.cell(0).nodes);
            for point in rule(kind, model(kind)) {
                let mapped = point.map(model(kind), &nodes);
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
        // Divergence theorem ∫ ∇N_a dV = ∫ N_a n dA; Σ_a x_a·(…) = dimension × volume. A curved
        // tetrahedron has integrands of degree 3, one more than its points integrate.
        for kind in CellKind::all().filter(|kind| *kind != CellKind::Tet10) {
            let mesh = distorted(kind);
            let nodes = positions(&mesh, mesh.cell(0).nodes);
            let mut integral = vec![Vector3::zeros(); kind.node_count()];
            for point in rule(kind, model(kind)) {
                let mapped = point.map(model(kind), &nodes);
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
