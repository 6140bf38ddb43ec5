//! Geometry of a facet: area, normal, and what each node carries of it.
//!
//! ```text
//! ∫ N_i dA        tributary area of node i
//! ∫ N_i n dA      the same with the unit normal under the integral
//! ```
//!
//! Lines and triangles are flat, so every node carries an equal share. On a bilinear
//! quadrilateral `n dA = t_1 × t_2 dξ dη` is a polynomial, which 2 × 2 Gauss points
//! integrate exactly, warped or not.

use nalgebra::Vector3;

use super::cell::MOST_NODES;
use super::quadrature::{positions, rule};
use super::{CellKind, Facet, Mesh};

/// Area, normal and nodal shares of a facet; entries past its last node are zero.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FacetGeometry {
    /// Area, in m² (2D: length, in metre).
    pub area: f64,
    /// Unit normal, the mean over the facet; outward if the facet's nodes run in outward order.
    pub normal: [f64; 3],
    /// `∫ N_i dA` per node, in m² (2D: in metre).
    pub weights: [f64; 4],
    /// `∫ N_i n dA` per node, in m² (2D: in metre).
    pub vectors: [[f64; 3]; 4],
}

impl Mesh {
    /// Geometry of a facet with 2, 3 or 4 nodes of this mesh.
    #[must_use]
    pub fn facet_geometry(&self, facet: &Facet) -> FacetGeometry {
        let x = positions(self, &facet.nodes);
        match facet.nodes.len() {
            // The outside of a plane body is on the right of its lines.
            2 => flat((x[1] - x[0]).cross(&Vector3::z()), 2),
            3 => flat((x[1] - x[0]).cross(&(x[2] - x[0])) / 2.0, 3),
            _ => bilinear(&x),
        }
    }
}

/// A facet with one normal: `area_vector = n A`, shared equally by its nodes.
fn flat(area_vector: Vector3<f64>, nodes: usize) -> FacetGeometry {
    let area = area_vector.norm();
    let mut geometry = FacetGeometry {
        area,
        normal: direction(area_vector),
        ..FacetGeometry::default()
    };
    for node in 0..nodes {
        geometry.weights[node] = area / nodes as f64;
        geometry.vectors[node] = (area_vector / nodes as f64).into();
    }
    geometry
}

fn bilinear(x: &[Vector3<f64>; MOST_NODES]) -> FacetGeometry {
    let mut geometry = FacetGeometry::default();
    let mut vectors = [Vector3::zeros(); 4];
    for point in rule(CellKind::Quad4) {
        let [mut t1, mut t2] = [Vector3::zeros(); 2];
        for (position, derivative) in x.iter().zip(point.derivatives).take(4) {
            t1 += position * derivative[0];
            t2 += position * derivative[1];
        }
        let area_vector = t1.cross(&t2) * point.weight;
        let area = area_vector.norm();
        geometry.area += area;
        let shares = geometry.weights.iter_mut().zip(&mut vectors);
        for ((weight, vector), shape) in shares.zip(point.shape) {
            *weight += shape * area;
            *vector += area_vector * shape;
        }
    }
    geometry.normal = direction(vectors.iter().sum());
    geometry.vectors = vectors.map(Into::into);
    geometry
}

/// Unit vector, or zero for a facet without area.
fn direction(vector: Vector3<f64>) -> [f64; 3] {
    vector.try_normalize(0.0).unwrap_or_default().into()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn geometry(nodes: &[[f64; 3]]) -> FacetGeometry {
        let dimension = if nodes.len() == 2 { 2 } else { 3 };
        let facet = Facet {
            nodes: (0..nodes.len()).collect(),
        };
        Mesh::new(dimension, nodes.to_vec()).facet_geometry(&facet)
    }

    #[test]
    fn the_outside_is_on_the_right_of_a_line() {
        // From (0, 0) to (3, 4): length 5, right-hand normal (4, −3)/5.
        let found = geometry(&[[0.0; 3], [3.0, 4.0, 0.0]]);
        assert_eq!((found.area, found.normal), (5.0, [0.8, -0.6, 0.0]));
        assert_eq!(found.weights, [2.5, 2.5, 0.0, 0.0]);
        assert_eq!(found.vectors[0], [2.0, -1.5, 0.0]);
    }

    #[test]
    fn each_node_of_a_triangle_carries_a_third() {
        let found = geometry(&[[0.0; 3], [3.0, 0.0, 0.0], [0.0, 4.0, 0.0]]);
        assert_eq!((found.area, found.normal), (6.0, [0.0, 0.0, 1.0]));
        assert_eq!(found.weights, [2.0, 2.0, 2.0, 0.0]);
    }

    #[test]
    fn nodes_of_a_trapezium_carry_unequal_shares() {
        // Width 2 − y over 0 ≤ y ≤ 1 after mapping: x = ξ(2 − η), y = η, dA = (2 − η) dξ dη.
        // ∫ (1−ξ)(1−η)(2−η) dξ dη = ½ · (2 − 3/2 + 1/3) = 5/12, with η in place of 1−η: ½ (1 − 1/3) = 1/3.
        let corners = [[0.0; 3], [2.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let found = geometry(&corners);
        let expected = [5.0 / 12.0, 5.0 / 12.0, 1.0 / 3.0, 1.0 / 3.0];
        for (weight, expected) in found.weights.iter().zip(expected) {
            assert!((weight - expected).abs() < 1e-15);
        }
        assert!((found.area - 1.5).abs() < 1e-15);
    }

    #[test]
    fn a_warped_quadrilateral_has_the_area_vector_of_its_rim() {
        // ∫ n dA = ½ Σ x_i × x_{i+1} depends on the rim alone (Stokes): ½ d_1 × d_2 of the diagonals.
        let corners = [[0.0; 3], [1.0, 0.0, 0.2], [1.1, 1.0, 0.0], [0.0, 0.9, 0.3]];
        let found = geometry(&corners);
        let sum: Vector3<f64> = found.vectors.iter().map(|v| Vector3::from(*v)).sum();
        let [a, b, c, d] = corners.map(Vector3::from);
        assert!((sum - (c - a).cross(&(d - b)) / 2.0).norm() < 1e-15);
    }
}
