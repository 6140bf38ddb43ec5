//! Shape functions of a reference cell, from where its nodes are.
//!
//! ```text
//! simplex       λ_0 = 1 − Σ ξ_j, λ_j = ξ_j       on  ξ_j ≥ 0, Σ ξ_j ≤ 1
//!               linear     N_a = λ_a
//!               quadratic  λ_i (2 λ_i − 1) at corners,  4 λ_i λ_j between two of them
//! tensor        N_a = Π_j ℓ(c_aj, ξ_j)           on  −1 ≤ ξ_j ≤ 1, node a at c_a
//!               linear     ℓ = ½ (1 + c ξ)
//!               quadratic  ℓ = ½ c ξ (1 + c ξ),  1 − ξ² where c = 0
//! serendipity   Π_j ½ (1 + c_j ξ_j) (Σ c_j ξ_j − d + 1) at corners of d axes,
//!               (1 − ξ_k²) Π_(j≠k) ½ (1 + c_j ξ_j) between two of them, along axis k
//! ```
//!
//! Prisms and pyramids have files of their own. Hughes, The Finite Element Method (1987), ch. 3; Zienkiewicz & Taylor, The Finite
//! Element Method 1 (2000), ch. 8.

use std::sync::LazyLock;

use super::{prism, pyramid};

/// How shape functions follow from the nodes' positions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Family {
    /// Triangles and tetrahedra.
    Simplex,
    /// Lines, quadrilaterals and hexahedra.
    Tensor,
    /// The same with nodes at corners and on edges only.
    Serendipity,
    /// Triangles between two heights.
    Prism,
    /// A square under an apex.
    Pyramid,
}

/// Corners of the base of a pyramid.
const PYRAMID_SIDES: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];

/// A reference cell or facet; nodes as in Gmsh, corners first.
pub(crate) struct Reference {
    /// Name, as in messages.
    pub(crate) name: &'static str,
    pub(crate) dimension: usize,
    pub(crate) family: Family,
    /// Number of corners.
    pub(crate) corners: usize,
    /// Positions of the nodes.
    pub(crate) nodes: &'static [[f64; 3]],
    /// Local nodes of each facet: corners in outward order, then the nodes between each
    /// and the next one, then the one in the middle.
    pub(crate) facets: &'static [&'static [usize]],
    /// The rule of its integrals.
    pub(crate) rule: LazyLock<Vec<Point>>,
}

/// A quadrature point of the reference cell.
#[derive(Clone, Debug)]
pub(crate) struct Point {
    /// Weight `w_q`.
    pub(crate) weight: f64,
    /// Where it is.
    pub(crate) position: [f64; 3],
    /// Values `N_a`.
    pub(crate) shape: Vec<f64>,
    /// Derivatives `∂N_a/∂ξ_j`.
    pub(crate) derivatives: Vec<[f64; 3]>,
}

impl Point {
    /// The shape functions of a cell at a reference position.
    pub(crate) fn at(cell: &Reference, position: [f64; 3], weight: f64) -> Self {
        Self {
            weight,
            position,
            shape: cell.shape(position),
            derivatives: cell.shape_derivatives(position),
        }
    }
}

impl Reference {
    /// Whether the nodes are the corners.
    pub(crate) const fn is_linear(&self) -> bool {
        self.nodes.len() == self.corners
    }

    /// Position of the centre.
    pub(crate) fn centre(&self) -> [f64; 3] {
        let share = 1.0 / (self.dimension as f64 + 1.0);
        match self.family {
            Family::Simplex => {
                std::array::from_fn(|axis| if axis < self.dimension { share } else { 0.0 })
            }
            Family::Tensor | Family::Serendipity => [0.0; 3],
            Family::Prism => [1.0 / 3.0, 1.0 / 3.0, 0.0],
            Family::Pyramid => [0.0, 0.0, 0.25],
        }
    }

    /// A node's position; four next to the apex of a pyramid, where derivatives depend on the way there.
    pub(crate) fn ways_to(&self, node: [f64; 3]) -> Vec<[f64; 3]> {
        const BESIDE: f64 = 1.0 / 1_048_576.0;
        if self.family != Family::Pyramid || node[2] < 1.0 {
            return vec![node];
        }
        let ways = PYRAMID_SIDES.iter();
        ways.map(|[a, b]| [a * BESIDE, b * BESIDE, 1.0 - BESIDE])
            .collect()
    }

    /// Values of the functions that carry what is known at the points that are the corners, drawn towards the
    /// centre, on to all of the cell: the shape functions, of pyramids without what is not linear in them.
    pub(crate) fn extrapolation(&self, at: [f64; 3]) -> Vec<f64> {
        if self.family != Family::Pyramid {
            return self.shape(at);
        }
        let [x, y, z] = at;
        let base = PYRAMID_SIDES
            .iter()
            .map(|[a, b]| 0.25 * (1.0 - z + a * x + b * y));
        base.chain([z]).collect()
    }

    /// Values `N_a` of the shape functions.
    pub(crate) fn shape(&self, at: [f64; 3]) -> Vec<f64> {
        let nodes = self.nodes.iter();
        match self.family {
            Family::Simplex => {
                let lambda = self.barycentric(at);
                let value = |node: &[f64; 3]| match self.between(*node) {
                    (i, _) if self.is_linear() => lambda[i],
                    (i, j) if i == j => lambda[i] * (2.0 * lambda[i] - 1.0),
                    (i, j) => 4.0 * lambda[i] * lambda[j],
                };
                nodes.map(value).collect()
            }
            Family::Tensor | Family::Serendipity => nodes
                .map(|node| {
                    let factors = (0..self.dimension).map(|j| self.factor(node, j, at[j]).0);
                    factors.product::<f64>() * self.edge_correction(node, at)
                })
                .collect(),
            Family::Prism | Family::Pyramid => nodes.map(|node| self.tapered(node, at).0).collect(),
        }
    }

    /// Derivatives `∂N_a/∂ξ_j` of the shape functions; those along further axes are zero.
    pub(crate) fn shape_derivatives(&self, at: [f64; 3]) -> Vec<[f64; 3]> {
        let nodes = self.nodes.iter();
        let along = |derivative: &dyn Fn(usize) -> f64| {
            std::array::from_fn(|j| {
                if j < self.dimension {
                    derivative(j)
                } else {
                    0.0
                }
            })
        };
        match self.family {
            Family::Simplex => {
                let lambda = self.barycentric(at);
                let slope = |i: usize, j: usize| match i {
                    0 => -1.0,
                    _ => f64::from(u8::from(i == j + 1)),
                };
                nodes
                    .map(|node| match self.between(*node) {
                        (a, _) if self.is_linear() => along(&|j| slope(a, j)),
                        (a, b) if a == b => along(&|j| (4.0 * lambda[a] - 1.0) * slope(a, j)),
                        (a, b) => {
                            along(&|j| 4.0 * (lambda[a] * slope(b, j) + lambda[b] * slope(a, j)))
                        }
                    })
                    .collect()
            }
            Family::Tensor | Family::Serendipity => nodes
                .map(|node| {
                    along(&|j| {
                        let others = (0..self.dimension).filter(|&k| k != j);
                        let others = others.map(|k| self.factor(node, k, at[k]).0);
                        let product: f64 = others.product();
                        let (value, slope) = self.factor(node, j, at[j]);
                        let plain = slope * product * self.edge_correction(node, at);
                        if self.is_corrected(node) {
                            plain + value * product * node[j]
                        } else {
                            plain
                        }
                    })
                })
                .collect(),
            Family::Prism | Family::Pyramid => nodes.map(|node| self.tapered(node, at).1).collect(),
        }
    }

    /// Value and derivatives of the shape function of a node of a prism or pyramid.
    fn tapered(&self, node: &[f64; 3], at: [f64; 3]) -> (f64, [f64; 3]) {
        match self.family {
            Family::Pyramid => pyramid::shape(self.is_linear(), node, at),
            _ => {
                let place = (self.between(*node), node[2]);
                prism::shape(self.is_linear(), place, self.barycentric(at), at[2])
            }
        }
    }

    fn barycentric(&self, at: [f64; 3]) -> [f64; 4] {
        let axes = match self.family {
            Family::Prism => 2,
            _ => self.dimension,
        };
        let mut lambda = [0.0; 4];
        lambda[0] = 1.0 - at[..axes].iter().sum::<f64>();
        lambda[1..=axes].copy_from_slice(&at[..axes]);
        lambda
    }

    /// The two corners of a simplex, or of a prism's triangle, that a node is between; twice the same at a corner.
    fn between(&self, node: [f64; 3]) -> (usize, usize) {
        let lambda = self.barycentric(node);
        let first = lambda.iter().position(|share| *share > 0.0);
        let last = lambda.iter().rposition(|share| *share > 0.0);
        (first.unwrap_or_default(), last.unwrap_or_default())
    }

    /// `ℓ(c_j, ξ_j)` and its slope.
    fn factor(&self, node: &[f64; 3], axis: usize, at: f64) -> (f64, f64) {
        let c = node[axis];
        if c == 0.0 {
            (1.0 - at * at, -2.0 * at)
        } else if self.is_linear() || self.family == Family::Serendipity {
            (0.5 * (1.0 + c * at), 0.5 * c)
        } else {
            (0.5 * c * at * (1.0 + c * at), 0.5 * c + at)
        }
    }

    /// The last factor of a serendipity corner, which vanishes on the nodes around it; 1 elsewhere.
    fn edge_correction(&self, node: &[f64; 3], at: [f64; 3]) -> f64 {
        if !self.is_corrected(node) {
            return 1.0;
        }
        let sum: f64 = (0..self.dimension).map(|j| node[j] * at[j]).sum();
        sum - self.dimension as f64 + 1.0
    }

    fn is_corrected(&self, node: &[f64; 3]) -> bool {
        self.family == Family::Serendipity && node[..self.dimension].iter().all(|c| *c != 0.0)
    }
}
