//! The stress of a cell that holds its given forces and tractions exactly, and is closest to another.
//!
//! ```text
//! minimise ∫_K (σ̂ − σ) : C⁻¹ : (σ̂ − σ) dA     σ̂ symmetric, of degree n in the triangles between the edges
//!                                                and a point inside (Johnson, Mercier, Numer. Math. 30 (1978) 103–116)
//! subject to    σ̂ n = t on edges,   [σ̂ n] = 0 between triangles,   div σ̂ + b = 0
//! rings         S = r σ̂ has degree n and vanishes on the axis;   ∂_r S_rr + ∂_z S_rz + r b_r = σ̂_θθ
//! ```
//!
//! Every condition is one between coefficients, so that it holds at all points; the last one is no condition but
//! what the stress around the axis is.

use nalgebra::{DMatrix, DVector, Vector2};

use super::bernstein::{Bernstein, in_triangle};
use super::field::Field;
use super::given::Given;
use super::least::{Least, Outer};
use super::tractions::Tractions;
use crate::body::Model;

/// Conditions hold to this part of what they ask: rounding.
const HELD: f64 = 1e-10;

/// One triangle of a cell: an edge and the point inside.
struct Part {
    vertices: [Vector2<f64>; 3],
    /// `∇λ_l`.
    slopes: [Vector2<f64>; 3],
    area: f64,
}

impl Part {
    fn new(vertices: [Vector2<f64>; 3]) -> Self {
        let [a, b, c] = vertices;
        let twice = (b - a).perp(&(c - a));
        let slope = |from: Vector2<f64>, to: Vector2<f64>| {
            let along = to - from;
            Vector2::new(-along.y, along.x) / twice
        };
        Self {
            vertices,
            slopes: [slope(b, c), slope(c, a), slope(a, b)],
            area: 0.5 * twice,
        }
    }

    fn place(&self, lambda: [f64; 3]) -> Vector2<f64> {
        (0..3).map(|l| self.vertices[l] * lambda[l]).sum()
    }
}

/// Conditions `A c = d` on the coefficients of all triangles.
struct Conditions {
    rows: Vec<(Vec<(usize, f64)>, f64)>,
    /// Which rows hold tractions: row, coefficient along the edge, component; edge by edge.
    outer: Vec<(usize, usize, usize)>,
}

impl Conditions {
    /// Of rows of one size, and their sizes before.
    fn matrix(&self, unknowns: usize) -> (DMatrix<f64>, DVector<f64>, Vec<f64>) {
        let mut matrix = DMatrix::zeros(self.rows.len(), unknowns);
        let mut right = DVector::zeros(self.rows.len());
        let mut sizes = Vec::with_capacity(self.rows.len());
        for (row, (terms, value)) in self.rows.iter().enumerate() {
            let size = terms.iter().map(|(_, by)| by * by).sum::<f64>().sqrt();
            for (at, by) in terms {
                matrix[(row, *at)] += by / size;
            }
            right[row] = value / size;
            sizes.push(size);
        }
        (matrix, right, sizes)
    }
}

/// One cell.
pub(super) struct Local<'a> {
    field: &'a Field<'a>,
    given: &'a Given<'a>,
    index: usize,
    shapes: &'a Bernstein,
    lower: &'a Bernstein,
    parts: Vec<Part>,
}

impl<'a> Local<'a> {
    pub(super) fn new(
        field: &'a Field<'a>,
        given: &'a Given<'a>,
        index: usize,
        [shapes, lower]: &'a [Bernstein; 2],
    ) -> Self {
        let corners = field.corners(index);
        let middle = middle(&corners);
        let edges = corners.iter().zip(corners.iter().cycle().skip(1));
        let parts = edges.map(|(a, b)| Part::new([*a, *b, middle]));
        Self {
            field,
            given,
            index,
            shapes,
            lower,
            parts: parts.collect(),
        }
    }

    /// `∫ (σ̂ − σ) : C⁻¹ : (σ̂ − σ) dA`; none where the conditions contradict each other.
    pub(super) fn error(&self, tractions: &Tractions<'_>) -> Option<f64> {
        let system = self.system(tractions)?;
        let coefficients = system.closest();
        let off = (&system.matrix * &coefficients - &system.right).amax();
        let size = coefficients.amax().max(system.right.amax());
        (off <= HELD * size).then(|| self.distance(&coefficients))
    }

    /// Q and p of the least of that as a function of the moments of its edges, ½ mᵀ Q m − p · m.
    pub(super) fn energy(&self, tractions: &Tractions<'_>) -> Option<(DMatrix<f64>, DVector<f64>)> {
        let system = self.system(tractions)?;
        let edges = &tractions.edges.of_cell[self.index];
        let mut asked = DMatrix::zeros(system.right.len(), 4 * edges.len());
        let mut moments = DVector::zeros(4 * edges.len());
        let per_part = system.outer.len() / edges.len();
        for (at, (edge, sign)) in edges.iter().enumerate() {
            let units = tractions.units(*edge, self.shapes.degree);
            for (end, unit) in units.iter().enumerate() {
                for k in 0..2 {
                    let column = 4 * at + 2 * end + k;
                    moments[column] = tractions.moments[*edge][end][k];
                    let rows = &system.outer[per_part * at..per_part * (at + 1)];
                    for outer in rows.iter().filter(|outer| outer.axis == k) {
                        asked[(outer.row, column)] = sign * unit[outer.along] / outer.size;
                    }
                }
            }
        }
        let (quadratic, slope) = system.along(&asked);
        let pull = &quadratic * moments - slope;
        Some((quadratic, pull))
    }

    fn system(&self, tractions: &Tractions<'_>) -> Option<Least> {
        let conditions = self.conditions(tractions);
        let (matrix, right, sizes) = conditions.matrix(self.unknowns());
        let outer = conditions.outer.iter();
        let outer = outer.map(|&(row, along, axis)| Outer {
            row,
            along,
            axis,
            size: sizes[row],
        });
        let (weights, pull) = self.squares();
        Least::new(&weights, pull, matrix, right, outer.collect())
    }

    fn unknowns(&self) -> usize {
        3 * self.shapes.len() * self.parts.len()
    }

    fn at(&self, part: usize, component: usize, alpha: usize) -> usize {
        (3 * part + component) * self.shapes.len() + alpha
    }

    fn is_ring(&self) -> bool {
        self.field.body.model == Model::Axisymmetric
    }

    fn conditions(&self, tractions: &Tractions<'_>) -> Conditions {
        let mut conditions = Conditions {
            rows: Vec::new(),
            outer: Vec::new(),
        };
        let edges = &tractions.edges.of_cell[self.index];
        let (degree, count) = (self.shapes.degree, self.parts.len());
        for (part, (edge, sign)) in edges.iter().enumerate() {
            let normal = tractions.edges.all[*edge].normal * *sign;
            let asked = tractions.weighted(*edge, degree);
            let next = (part + 1) % count;
            let [_, b, middle] = self.parts[part].vertices;
            let across = Vector2::new(middle.y - b.y, b.x - middle.x).normalize();
            for j in 0..=degree {
                let outside = self.shapes.at([degree - j, j, 0]);
                let here = self.shapes.at([0, degree - j, j]);
                let there = self.shapes.at([degree - j, 0, j]);
                let along = if *sign > 0.0 { j } else { degree - j };
                for (k, asked) in asked.iter().enumerate() {
                    let value = sign * asked[along];
                    let held = self.pull(part, outside, k, normal);
                    conditions.outer.push((conditions.rows.len(), along, k));
                    conditions.rows.push((held.to_vec(), value));
                    let [near, far] = [(part, here, 1.0), (next, there, -1.0)]
                        .map(|(part, at, by)| self.pull(part, at, k, across * by));
                    conditions.rows.push(([near, far].concat(), 0.0));
                }
            }
            self.hold_inside(part, &mut conditions);
        }
        conditions
    }

    /// Component k of `S n` by a coefficient.
    fn pull(&self, part: usize, alpha: usize, k: usize, normal: Vector2<f64>) -> [(usize, f64); 2] {
        let components = if k == 0 { [0, 2] } else { [2, 1] };
        [0, 1].map(|l| (self.at(part, components[l], alpha), normal[l]))
    }

    /// Component k of `div S`: per `β` of the lower degree the terms of coefficients.
    fn divergence(&self, part: usize, beta: [usize; 3], k: usize) -> Vec<(usize, f64)> {
        let components = if k == 0 { [0, 2] } else { [2, 1] };
        let slopes = self.parts[part].slopes;
        let terms = [0, 1].map(|l| {
            let of = self.shapes.slope(beta, slopes.map(|slope| slope[l]));
            of.map(|(alpha, by)| (self.at(part, components[l], alpha), by))
        });
        terms.concat()
    }

    /// Equilibrium within a triangle; nothing on the axis.
    fn hold_inside(&self, part: usize, conditions: &mut Conditions) {
        let own = &self.parts[part];
        let first = usize::from(self.is_ring());
        for beta in &self.lower.indices {
            // Affine functions have their values for coefficients.
            let degree = self.lower.degree as f64;
            let place = own.place(beta.map(|b| b as f64 / degree));
            let force = self.given.volume_force(self.index, place) * self.field.weight(place);
            for k in first..2 {
                let terms = self.divergence(part, *beta, k);
                conditions.rows.push((terms, -force[k]));
            }
        }
        if !self.is_ring() {
            return;
        }
        for (alpha, index) in self.shapes.indices.iter().enumerate() {
            let on_axis = (0..3).all(|l| index[l] == 0 || own.vertices[l].x == 0.0);
            for component in 0..if on_axis { 3 } else { 0 } {
                let term = (self.at(part, component, alpha), 1.0);
                conditions.rows.push((vec![term], 0.0));
            }
        }
    }

    /// σ̂ at a point of a triangle: `rows · coefficients + given`, coefficients of that triangle alone.
    fn rows(&self, part: usize, lambda: [f64; 3]) -> (DMatrix<f64>, DVector<f64>) {
        let (count, place) = (self.shapes.len(), self.parts[part].place(lambda));
        let mut rows = DMatrix::zeros(self.field.count(), 3 * count);
        let mut given = DVector::zeros(self.field.count());
        let weight = self.field.weight(place);
        for (alpha, value) in self.shapes.values(lambda).iter().enumerate() {
            (0..3).for_each(|k| rows[(k, k * count + alpha)] = value / weight);
        }
        if self.is_ring() {
            let first = self.at(part, 0, 0);
            for (beta, value) in self.lower.indices.iter().zip(self.lower.values(lambda)) {
                for (at, by) in self.divergence(part, *beta, 0) {
                    rows[(3, at - first)] += by * value;
                }
            }
            given[3] = weight * self.given.volume_force(self.index, place).x;
        }
        (rows, given)
    }

    /// Shows every point of a triangle with its weighted area, σ, C⁻¹ and what σ̂ is made of.
    fn each_point(
        &self,
        part: usize,
        mut each: impl FnMut(f64, DVector<f64>, DMatrix<f64>, DMatrix<f64>),
    ) {
        for (lambda, share) in in_triangle() {
            let place = self.parts[part].place(lambda);
            let area = share * self.parts[part].area * self.field.weight(place);
            let (rows, given) = self.rows(part, lambda);
            let inside = self.field.inside(self.index, place);
            let left = self.field.stress(self.index, inside) - given;
            each(area, left, self.field.compliance(self.index, place), rows);
        }
    }

    /// Matrix and right side of the squares, one block per triangle.
    fn squares(&self) -> (Vec<DMatrix<f64>>, DVector<f64>) {
        let count = 3 * self.shapes.len();
        let mut pull = DVector::zeros(self.unknowns());
        let blocks = (0..self.parts.len()).map(|part| {
            let mut block = DMatrix::zeros(count, count);
            self.each_point(part, |area, left, compliance, rows| {
                let strains = compliance * &rows * area;
                pull.rows_mut(count * part, count)
                    .gemv_tr(1.0, &strains, &left, 1.0);
                block.gemm_tr(1.0, &rows, &strains, 1.0);
            });
            block
        });
        (blocks.collect(), pull)
    }

    fn distance(&self, coefficients: &DVector<f64>) -> f64 {
        let count = 3 * self.shapes.len();
        let mut sum = 0.0;
        for part in 0..self.parts.len() {
            let own = coefficients.rows(count * part, count);
            self.each_point(part, |area, left, compliance, rows| {
                let off = rows * own - left;
                sum += area * off.dot(&(compliance * &off));
            });
        }
        sum
    }
}

/// The crossing of a quadrilateral's diagonals, or the centre of a triangle.
fn middle(corners: &[Vector2<f64>]) -> Vector2<f64> {
    match corners {
        [a, b, c, d] => {
            let (one, other) = (c - a, d - b);
            a + one * ((b - a).perp(&other) / one.perp(&other))
        }
        _ => corners.iter().sum::<Vector2<f64>>() / corners.len() as f64,
    }
}
