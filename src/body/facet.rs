//! Geometry of a facet: area, normal, and what each node carries of it.
//!
//! ```text
//! ∫ N_i dA        tributary area of node i
//! ∫ N_i n dA      the same with the unit normal under the integral
//! ∫ φ_j dA        that of corner j alone: φ_j is linear on the facet
//! ```
//!
//! Lines and triangles are flat, so every node carries an equal share. On a bilinear
//! quadrilateral `n dA = t_1 × t_2 dξ dη` is a polynomial, which 2 × 2 Gauss points
//! integrate exactly, warped or not. A quadratic triangle's corners carry nothing, those of
//! a quadrilateral of eight nodes less than nothing: contact takes `φ_j` there.
//!
//! A facet of an axisymmetric body goes once around the axis: `dA = 2πr ds`.

use std::f64::consts::PI;
use std::sync::LazyLock;

use nalgebra::Vector3;

use super::gauss::three_in_triangle;
use super::kinds::{MOST_FACET_NODES, facet_reference, linear_facet};
use super::quadrature::positions;
use super::reference::{Family, Point, Reference};
use super::{Body, CellKind, Facet, Mesh, Model};

/// Area, normal and nodal shares of a facet; entries past its last node are zero.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FacetGeometry {
    /// Area, in m² (plane bodies: length, in metre).
    pub area: f64,
    /// Unit normal, the mean over the facet; outward if the facet's nodes run in outward order.
    pub normal: [f64; 3],
    /// `∫ N_i dA` per node, in m² (plane bodies: in metre).
    pub weights: [f64; MOST_FACET_NODES],
    /// `∫ N_i n dA` per node, in m² (plane bodies: in metre).
    pub vectors: [[f64; 3]; MOST_FACET_NODES],
}

/// A quadrature point of a facet in space.
#[derive(Clone, Debug)]
pub(crate) struct FacetPoint {
    /// Where it is, in metre.
    pub(crate) position: Vector3<f64>,
    /// `n dA`, in m² (plane bodies: in metre).
    pub(crate) vector: Vector3<f64>,
    /// Values `N_i` at the nodes.
    pub(crate) shape: Vec<f64>,
    /// Values `φ_j` at the corners.
    pub(crate) hats: Vec<f64>,
}

/// The reference facet of so many nodes.
#[derive(Clone, Copy)]
pub(crate) struct FacetReference(&'static Reference);

impl std::fmt::Debug for FacetReference {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str(self.0.name)
    }
}

impl FacetReference {
    /// That of a mesh of dimension 2 or 3; none if there is no such facet.
    pub(crate) fn of(dimension: usize, nodes: usize) -> Option<Self> {
        facet_reference(dimension, nodes).map(Self)
    }

    /// Positions of its nodes, corners first.
    pub(crate) fn nodes(self) -> &'static [[f64; 3]] {
        self.0.nodes
    }

    /// Number of corners.
    pub(crate) fn corners(self) -> usize {
        self.0.corners
    }

    /// Values `N_i` at the nodes.
    pub(crate) fn shape(self, at: [f64; 3]) -> Vec<f64> {
        self.0.shape(at)
    }

    /// Derivatives of `N_i` along the axes of the reference facet; those along further axes are zero.
    pub(crate) fn slopes(self, at: [f64; 3]) -> Vec<[f64; 3]> {
        self.0.shape_derivatives(at)
    }

    /// Whether its positions are barycentric, as in a triangle.
    pub(crate) fn is_simplex(self) -> bool {
        self.0.family == Family::Simplex
    }

    /// Position of its centre.
    pub(crate) fn centre(self) -> [f64; 3] {
        self.0.centre()
    }

    /// Values `φ_j` at the corners.
    pub(crate) fn hats(self, at: [f64; 3]) -> Vec<f64> {
        linear_facet(self.0).shape(at)
    }
}

impl Mesh {
    /// Geometry of a facet of this mesh, as that of a plane or solid body; zero if there is no
    /// facet of so many nodes.
    #[must_use]
    pub fn facet_geometry(&self, facet: &Facet) -> FacetGeometry {
        let x = positions(self, &facet.nodes);
        match (self.dimension, x.as_slice()) {
            // The outside of a plane body is on the right of its lines.
            (2, [a, b]) => flat((b - a).cross(&Vector3::z()), 2),
            (3, [a, b, c]) => flat((b - a).cross(&(c - a)) / 2.0, 3),
            _ => integrated(self, facet, &x, |_| 1.0),
        }
    }

    /// The quadrature points of a facet of a body of this mesh.
    pub(crate) fn facet_points(&self, facet: &Facet, model: Model) -> Vec<FacetPoint> {
        let x = positions(self, &facet.nodes);
        points(self, facet, &x, around(model))
    }

    /// The same, enough of them for a product of two linear functions.
    pub(crate) fn fine_facet_points(&self, facet: &Facet, model: Model) -> Vec<FacetPoint> {
        static THREE: LazyLock<Vec<Point>> = LazyLock::new(|| {
            let point = |(at, weight)| Point::at(CellKind::Tri3.reference(), at, weight);
            three_in_triangle().map(point).into()
        });
        if self.dimension == 2 || facet.nodes.len() != 3 {
            return self.facet_points(facet, model);
        }
        let x = positions(self, &facet.nodes);
        match facet_reference(self.dimension, facet.nodes.len()) {
            Some(reference) => at_points(reference, &THREE, &x, around(model)),
            None => Vec::new(),
        }
    }
}

impl Body {
    /// Geometry of a facet of the mesh, once around the axis if the body is axisymmetric.
    #[must_use]
    pub fn facet_geometry(&self, facet: &Facet) -> FacetGeometry {
        match self.model {
            Model::Axisymmetric => {
                let x = positions(&self.mesh, &facet.nodes);
                integrated(&self.mesh, facet, &x, around(self.model))
            }
            _ => self.mesh.facet_geometry(facet),
        }
    }
}

/// Length around the axis at a position, in metre; one where there is no axis.
pub(crate) fn around(model: Model) -> impl Fn(Vector3<f64>) -> f64 {
    move |x| match model {
        Model::Axisymmetric => 2.0 * PI * x.x,
        _ => 1.0,
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

fn integrated(
    mesh: &Mesh,
    facet: &Facet,
    x: &[Vector3<f64>],
    length: impl Fn(Vector3<f64>) -> f64,
) -> FacetGeometry {
    let mut geometry = FacetGeometry::default();
    let mut vectors = [Vector3::zeros(); MOST_FACET_NODES];
    for point in points(mesh, facet, x, &length) {
        let area = point.vector.norm();
        geometry.area += area;
        let shares = geometry.weights.iter_mut().zip(&mut vectors);
        for ((weight, vector), shape) in shares.zip(point.shape) {
            *weight += shape * area;
            *vector += point.vector * shape;
        }
    }
    geometry.normal = direction(vectors.iter().sum());
    if geometry.area == 0.0 {
        // On the axis a facet has no area, but still looks somewhere.
        geometry.normal = direction(
            points(mesh, facet, x, |_| 1.0)
                .iter()
                .map(|p| p.vector)
                .sum(),
        );
    }
    geometry.vectors = vectors.map(Into::into);
    geometry
}

fn points(
    mesh: &Mesh,
    facet: &Facet,
    x: &[Vector3<f64>],
    length: impl Fn(Vector3<f64>) -> f64,
) -> Vec<FacetPoint> {
    let Some(reference) = facet_reference(mesh.dimension, facet.nodes.len()) else {
        return Vec::new();
    };
    at_points(reference, &reference.rule, x, length)
}

fn at_points(
    reference: &'static Reference,
    rule: &[Point],
    x: &[Vector3<f64>],
    length: impl Fn(Vector3<f64>) -> f64,
) -> Vec<FacetPoint> {
    let linear = linear_facet(reference);
    let points = rule.iter();
    points
        .map(|point| {
            let [t1, t2, _] = point.tangents(reference.dimension, x);
            let normal = match reference.dimension {
                1 => t1.cross(&Vector3::z()),
                _ => t1.cross(&t2),
            };
            let position = point.in_space(x);
            FacetPoint {
                position,
                vector: normal * (point.weight * length(position)),
                shape: point.shape.clone(),
                hats: linear.shape(point.position),
            }
        })
        .collect()
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
        assert_eq!(found.weights[..3], [2.5, 2.5, 0.0]);
        assert_eq!(found.vectors[0], [2.0, -1.5, 0.0]);
    }

    #[test]
    fn each_node_of_a_triangle_carries_a_third() {
        let found = geometry(&[[0.0; 3], [3.0, 0.0, 0.0], [0.0, 4.0, 0.0]]);
        assert_eq!((found.area, found.normal), (6.0, [0.0, 0.0, 1.0]));
        assert_eq!(found.weights[..4], [2.0, 2.0, 2.0, 0.0]);
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
