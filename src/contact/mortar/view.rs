//! A facet's own plane, and how other facets look when they are projected onto it.
//!
//! ```text
//! y = (e_1 · (x − o), e_2 · (x − o)) / a        o: centre, a: size of the facet
//! h = m · (x − o) / a                           m: mean outward normal = e_1 × e_2
//! ```
//!
//! A line of a plane body is a strip along z, as deep as the facet is long, so that
//! plane and solid bodies share one clipping and one quadrature.
//!
//! The bilinear map is inverted in closed form: with `y = a + b ξ + c η + d ξη` and
//! `h = y − a`, `η` solves `h×b + (h×d + b×c) η + (d×c) η² = 0`, of whose roots the one
//! inside the facet has a derivative of the sign of `b×c`.

use nalgebra::Vector3;

use super::polygon::{Point, Polygon, cross};
use crate::body::{Facet, Mesh};

/// The plane of a facet.
pub(super) struct View {
    origin: Vector3<f64>,
    axes: [Vector3<f64>; 2],
    pub(super) normal: Vector3<f64>,
    /// Length that counts as one in the plane, in metre.
    pub(super) size: f64,
    /// What counts as one of area in the plane, in m² (2D: in metre).
    pub(super) unit: f64,
}

impl View {
    /// The plane of a facet; one without area has no directions (zeros), so that nothing in it turns.
    pub(super) fn new(mesh: &Mesh, facet: &Facet) -> Self {
        let corner = |index: usize| Vector3::from(mesh.nodes[facet.nodes[index]]);
        let count = facet.nodes.len();
        let origin = (0..count).map(corner).sum::<Vector3<f64>>() / count as f64;
        // From differences of positions alone: far away, a tilt by round-off would shift the view.
        let normal = match count {
            2 => (corner(1) - corner(0)).cross(&Vector3::z()),
            3 => (corner(1) - corner(0)).cross(&(corner(2) - corner(0))),
            _ => (corner(2) - corner(0)).cross(&(corner(3) - corner(1))),
        };
        let direction = |vector: Vector3<f64>| vector.try_normalize(0.0).unwrap_or_default();
        let normal = direction(normal);
        let along = corner(1) - corner(0);
        let first = direction(along - normal * normal.dot(&along));
        let radius = |index| (corner(index) - origin).norm();
        let size = 2.0 * (0..count).map(radius).fold(0.0, f64::max);
        Self {
            origin,
            axes: [first, normal.cross(&first)],
            normal,
            size,
            unit: if count == 2 { size } else { size * size },
        }
    }

    /// Least and greatest coordinate of a box in space along axis 0, 1 or the normal (2).
    pub(super) fn extent(&self, low: [f64; 3], high: [f64; 3], axis: usize) -> [f64; 2] {
        let direction = match axis {
            2 => self.normal,
            _ => self.axes[axis],
        };
        let (low, high) = (Vector3::from(low), Vector3::from(high));
        let centre = direction.dot(&((low + high) / 2.0 - self.origin));
        let half = direction.abs().dot(&((high - low) / 2.0));
        [(centre - half) / self.size, (centre + half) / self.size]
    }

    /// A facet, projected onto the plane.
    pub(super) fn outline(&self, mesh: &Mesh, facet: &Facet) -> Outline {
        let mut outline = Outline {
            nodes: facet.nodes.len(),
            corners: [Point::zeros(); 4],
            heights: [0.0; 4],
        };
        for (index, node) in facet.nodes.iter().enumerate() {
            let offset = (Vector3::from(mesh.nodes[*node]) - self.origin) / self.size;
            outline.corners[index] = self.axes.map(|axis| axis.dot(&offset)).into();
            outline.heights[index] = self.normal.dot(&offset);
        }
        outline
    }

    /// Where a position is in the plane.
    pub(super) fn coordinates(&self, position: Vector3<f64>) -> Point {
        let offset = (position - self.origin) / self.size;
        self.axes.map(|axis| axis.dot(&offset)).into()
    }

    /// Height of a position above the plane, in metre.
    pub(super) fn height(&self, position: [f64; 3]) -> f64 {
        self.normal.dot(&(Vector3::from(position) - self.origin))
    }

    /// A point given by its coordinates in the plane and along the normal, in metre.
    pub(super) fn position(&self, coordinates: [f64; 3]) -> Vector3<f64> {
        self.origin + self.vector(coordinates) * self.size
    }

    /// A vector given by its coordinates in the plane and along the normal.
    pub(super) fn vector(&self, coordinates: [f64; 3]) -> Vector3<f64> {
        let [x, y, z] = coordinates;
        self.axes[0] * x + self.axes[1] * y + self.normal * z
    }
}

/// A facet in the plane of another one.
#[derive(Clone, Copy)]
pub(super) struct Outline {
    nodes: usize,
    corners: [Point; 4],
    heights: [f64; 4],
}

impl Outline {
    /// Its corners in the plane.
    pub(super) fn corners(&self) -> &[Point] {
        &self.corners[..self.nodes]
    }

    /// The point of the plane where its shape functions have given values.
    pub(super) fn at(&self, shape: &[f64; 4]) -> Point {
        let terms = self.corners.iter().zip(shape);
        terms.map(|(corner, value)| corner * *value).sum()
    }

    /// The area it covers, counter-clockwise.
    pub(super) fn polygon(&self) -> Polygon {
        if self.nodes == 2 {
            let ends = [self.corners[0].x, self.corners[1].x];
            let [left, right] = [ends[0].min(ends[1]), ends[0].max(ends[1])];
            return [(left, 0.0), (right, 0.0), (right, 1.0), (left, 1.0)]
                .map(|(x, y)| Point::new(x, y))
                .to_vec();
        }
        let mut polygon = self.corners[..self.nodes].to_vec();
        if super::polygon::area(&polygon) < 0.0 {
            polygon.reverse();
        }
        polygon
    }

    /// Least sine-like turn at a corner, relative to the facet's size squared and positive
    /// when all corners turn the way of `orientation`, 1 or −1; a line has its length.
    pub(super) fn least_turn(&self, orientation: f64) -> f64 {
        let corner = |index: usize| self.corners[index % self.nodes];
        if self.nodes == 2 {
            return orientation * (corner(1).x - corner(0).x);
        }
        let turn = |index| {
            let (here, next) = (corner(index + 1), corner(index + 2));
            orientation * cross(here - corner(index), next - here)
        };
        (0..self.nodes).map(turn).fold(f64::INFINITY, f64::min)
    }

    /// Values of the facet's shape functions at a point of the plane.
    pub(super) fn shape(&self, at: Point) -> [f64; 4] {
        let [a, b, c, _] = self.corners;
        match self.nodes {
            2 => {
                let along = (at.x - a.x) / (b.x - a.x);
                [1.0 - along, along, 0.0, 0.0]
            }
            3 => {
                let twice = cross(b - a, c - a);
                let second = cross(at - a, c - a) / twice;
                let third = cross(b - a, at - a) / twice;
                [1.0 - second - third, second, third, 0.0]
            }
            _ => {
                let [xi, eta] = self.reference(at);
                let factors = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
                factors.map(|(x, y)| (1.0 + x * xi) * (1.0 + y * eta) / 4.0)
            }
        }
    }

    /// Coordinates of a point at some height; those of a line stay in the plane body.
    pub(super) fn within(&self, at: Point, height: f64) -> [f64; 3] {
        match self.nodes {
            2 => [at.x, 0.0, height],
            _ => [at.x, at.y, height],
        }
    }

    /// Height above the plane, where the facet lies over a point of it.
    pub(super) fn height(&self, shape: &[f64; 4]) -> f64 {
        self.heights.iter().zip(shape).map(|(h, n)| h * n).sum()
    }

    /// The facet's area vector over a unit of the plane, in the plane's axes: `(−∇h, 1)`.
    pub(super) fn area_vector(&self, at: Point) -> [f64; 3] {
        if self.nodes < 4 {
            return [0.0, 0.0, 1.0];
        }
        let [xi, eta] = self.reference(at);
        let [_, b, c, d] = bilinear(self.corners);
        let [_, rise_b, rise_c, rise_d] = bilinear(self.heights.map(|h| Point::new(h, 0.0)));
        let (t1, t2) = (b + d * eta, c + d * xi);
        let (rise_1, rise_2) = (rise_b.x + rise_d.x * eta, rise_c.x + rise_d.x * xi);
        let normal = cross(t1, t2);
        [
            (t1.y * rise_2 - rise_1 * t2.y) / normal,
            (rise_1 * t2.x - t1.x * rise_2) / normal,
            1.0,
        ]
    }

    /// How far the Jacobian varies over the facet, of its mean: 0 for a parallelogram,
    /// 1 where a quadrilateral folds.
    pub(super) fn distortion(&self) -> f64 {
        if self.nodes < 4 {
            return 0.0;
        }
        let [_, b, c, d] = bilinear(self.corners);
        (cross(b, d).abs() + cross(d, c).abs()) / cross(b, c).abs()
    }

    /// Reference position of the quadrilateral's point above a point of the plane.
    fn reference(&self, at: Point) -> [f64; 2] {
        let [a, b, c, d] = bilinear(self.corners);
        let offset = at - a;
        let orientation = cross(b, c).signum();
        let k0 = orientation * cross(offset, b);
        let k1 = orientation * (cross(offset, d) + cross(b, c));
        let k2 = orientation * cross(d, c);
        let root = (k1 * k1 - 4.0 * k0 * k2).max(0.0).sqrt();
        // Two forms of one root: the first has no cancellation when k1 > 0, nor a division by k2 = 0.
        let eta = if k1 >= 0.0 {
            -2.0 * k0 / (k1 + root)
        } else {
            (root - k1) / (2.0 * k2)
        };
        let along = b + d * eta;
        [(offset - c * eta).dot(&along) / along.norm_squared(), eta]
    }
}

/// Coefficients of `1, ξ, η, ξη`.
fn bilinear(corners: [Point; 4]) -> [Point; 4] {
    let [p, q, r, s] = corners.map(|corner| corner / 4.0);
    [p + q + r + s, q + r - p - s, r + s - p - q, p + r - q - s]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outline(corners: &[[f64; 3]]) -> (View, Outline) {
        let mesh = Mesh::new(if corners.len() == 2 { 2 } else { 3 }, corners.to_vec());
        let facet = Facet {
            nodes: (0..corners.len()).collect(),
        };
        let view = View::new(&mesh, &facet);
        let outline = view.outline(&mesh, &facet);
        (view, outline)
    }

    /// A quadrilateral that is no parallelogram and not plane.
    const WARPED: [[f64; 3]; 4] = [
        [0.0, 0.0, 0.1],
        [1.0, 0.2, 0.0],
        [1.6, 1.5, 0.2],
        [-0.2, 1.0, 0.0],
    ];

    #[test]
    fn shape_functions_reproduce_the_point_they_are_asked_for() {
        for corners in [&WARPED[..], &WARPED[..3]] {
            let (_, outline) = outline(corners);
            for step in 0..9 {
                let share = [0.1 * f64::from(step), 0.9 - 0.1 * f64::from(step)];
                let [a, b, c, _] = outline.corners;
                let at = a + ((b - a) * share[0] + (c - a) * share[1]) * 0.7;
                let shape = outline.shape(at);
                let terms = outline.corners.iter().zip(shape);
                let found: Point = terms.map(|(corner, value)| corner * value).sum();
                assert!((found - at).norm() < 1e-15, "{step} {found}");
                assert!((shape.iter().sum::<f64>() - 1.0).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn a_facet_seen_from_the_other_side_turns_clockwise() {
        let (view, own) = outline(&WARPED);
        let mesh = Mesh::new(3, WARPED.to_vec());
        let nodes = vec![0, 3, 2, 1];
        let back = view.outline(&mesh, &Facet { nodes });
        assert!(own.least_turn(1.0) > 0.1 && back.least_turn(-1.0) > 0.1);
        assert!(own.least_turn(-1.0) < 0.0 && back.least_turn(1.0) < 0.0);
        // Distorted alike, and with the same shape functions in another order.
        assert!((own.distortion() - back.distortion()).abs() < 1e-15);
        let at = Point::new(0.1, -0.05);
        let ([a, b, c, d], [p, s, r, q]) = (own.shape(at), back.shape(at));
        let differences = [a - p, b - q, c - r, d - s];
        assert!(
            differences
                .iter()
                .all(|difference| difference.abs() < 1e-15)
        );
    }

    #[test]
    fn area_vectors_of_a_warped_facet_add_up_to_that_of_its_rim() {
        // ∫ (−∇h, 1) over the plane is the facet's area vector: its mean normal is the plane's.
        let (view, outline) = outline(&WARPED);
        let (mut vector, mut area) = (Vector3::zeros(), 0.0);
        super::super::quadrature::integrate(&outline.polygon(), 12, |at, share| {
            vector += view.vector(outline.area_vector(at)) * (share * view.unit);
            area += share * view.unit;
        });
        // The map of a warped facet is no polynomial: twelve points leave 1e-9 of its warp.
        assert!((vector - view.normal * area).norm() < 1e-9, "{vector}");
        let [a, b, c, d] = WARPED.map(Vector3::from);
        assert!((vector - (c - a).cross(&(d - b)) / 2.0).norm() < 1e-9);
    }

    #[test]
    fn a_facet_without_area_turns_nowhere() {
        // A rectangle whose nodes run crosswise: its diagonals are parallel.
        let crossed = [[0.0; 3], [1.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let flat = [[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]];
        for corners in [&crossed[..], &flat[..]] {
            let (_, outline) = outline(corners);
            assert!(outline.least_turn(1.0) <= 0.0);
        }
    }
}
