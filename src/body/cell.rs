//! The reference cells: nodes, facets and shape functions.
//!
//! ```text
//! Tri3, Tet4    N_0 = 1 − Σ ξ_j,   N_j = ξ_(j−1)              on  ξ_j ≥ 0, Σ ξ_j ≤ 1
//! Quad4, Hex8   N_a = Π_j ½ (1 + c_aj ξ_j)                    on  −1 ≤ ξ_j ≤ 1, corners c_a
//! ```
//!
//! Nodes are numbered as in Gmsh and VTK. Hughes, The Finite Element Method (1987), ch. 3.

use super::CellKind;

/// Most nodes that a cell has.
pub(crate) const MOST_NODES: usize = 8;

/// Corners of the hexahedron; the first four, without ζ, are those of the quadrilateral.
const CORNERS: [[f64; 3]; MOST_NODES] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
];

impl CellKind {
    /// All kinds.
    pub const ALL: [Self; 4] = [Self::Tri3, Self::Quad4, Self::Tet4, Self::Hex8];

    /// Name, as in messages.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Tri3 => "tri3",
            Self::Quad4 => "quad4",
            Self::Tet4 => "tet4",
            Self::Hex8 => "hex8",
        }
    }

    /// Number of nodes.
    #[must_use]
    pub const fn node_count(self) -> usize {
        match self {
            Self::Tri3 => 3,
            Self::Quad4 | Self::Tet4 => 4,
            Self::Hex8 => 8,
        }
    }

    /// 2 or 3.
    #[must_use]
    pub const fn dimension(self) -> usize {
        match self {
            Self::Tri3 | Self::Quad4 => 2,
            Self::Tet4 | Self::Hex8 => 3,
        }
    }

    /// Local nodes of each facet, in outward order: walking along a line of a plane
    /// cell the outside is on the right; around a face the right-hand rule points out.
    #[must_use]
    pub const fn facets(self) -> &'static [&'static [usize]] {
        match self {
            Self::Tri3 => &[&[0, 1], &[1, 2], &[2, 0]],
            Self::Quad4 => &[&[0, 1], &[1, 2], &[2, 3], &[3, 0]],
            Self::Tet4 => &[&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[0, 3, 2]],
            Self::Hex8 => &[
                &[0, 3, 2, 1],
                &[4, 5, 6, 7],
                &[0, 1, 5, 4],
                &[1, 2, 6, 5],
                &[2, 3, 7, 6],
                &[3, 0, 4, 7],
            ],
        }
    }

    /// Whether straining varies within the cell (the tensor-product kinds).
    pub(crate) const fn is_tensor_product(self) -> bool {
        matches!(self, Self::Quad4 | Self::Hex8)
    }

    /// Reference position of a local node.
    #[must_use]
    pub fn corner(self, node: usize) -> [f64; 3] {
        if self.is_tensor_product() {
            let [x, y, z] = CORNERS[node];
            return [x, y, if self.dimension() == 3 { z } else { 0.0 }];
        }
        std::array::from_fn(|axis| if node == axis + 1 { 1.0 } else { 0.0 })
    }

    /// Reference position of the centre.
    #[must_use]
    pub fn centre(self) -> [f64; 3] {
        match self {
            Self::Tri3 => [1.0 / 3.0, 1.0 / 3.0, 0.0],
            Self::Tet4 => [0.25; 3],
            Self::Quad4 | Self::Hex8 => [0.0; 3],
        }
    }

    /// Values `N_a` of the shape functions; entries past the last node are zero.
    #[must_use]
    pub fn shape(self, at: [f64; 3]) -> [f64; MOST_NODES] {
        let mut shape = [0.0; MOST_NODES];
        let axes = self.dimension();
        if self.is_tensor_product() {
            for (value, corner) in shape.iter_mut().zip(CORNERS).take(self.node_count()) {
                *value = (0..axes).map(|j| factor(corner[j], at[j])).product();
            }
        } else {
            shape[0] = 1.0 - at[..axes].iter().sum::<f64>();
            shape[1..=axes].copy_from_slice(&at[..axes]);
        }
        shape
    }

    /// Derivatives `∂N_a/∂ξ_j` of the shape functions; entries past the last node or axis are zero.
    #[must_use]
    pub fn shape_derivatives(self, at: [f64; 3]) -> [[f64; 3]; MOST_NODES] {
        let mut derivatives = [[0.0; 3]; MOST_NODES];
        let axes = self.dimension();
        if self.is_tensor_product() {
            for (row, corner) in derivatives.iter_mut().zip(CORNERS).take(self.node_count()) {
                for (j, entry) in row.iter_mut().enumerate().take(axes) {
                    let others = (0..axes).filter(|&k| k != j);
                    let product: f64 = others.map(|k| factor(corner[k], at[k])).product();
                    *entry = 0.5 * corner[j] * product;
                }
            }
        } else {
            for axis in 0..axes {
                derivatives[0][axis] = -1.0;
                derivatives[axis + 1][axis] = 1.0;
            }
        }
        derivatives
    }
}

/// One factor `½ (1 + c ξ)` of a tensor-product shape function.
fn factor(corner: f64, at: f64) -> f64 {
    0.5 * (1.0 + corner * at)
}

#[cfg(test)]
mod tests {
    use super::*;

    const INSIDE: [f64; 3] = [0.21, 0.13, 0.37];

    #[test]
    fn a_shape_function_is_one_at_its_node_and_zero_at_the_others() {
        for kind in CellKind::ALL {
            for node in 0..kind.node_count() {
                let mut expected = [0.0; MOST_NODES];
                expected[node] = 1.0;
                assert_eq!(kind.shape(kind.corner(node)), expected);
            }
        }
    }

    #[test]
    fn shape_functions_sum_to_one_and_reproduce_the_position() {
        for kind in CellKind::ALL {
            let shape = kind.shape(INSIDE);
            assert!((shape.iter().sum::<f64>() - 1.0).abs() < 1e-15);
            for (axis, expected) in INSIDE.into_iter().enumerate().take(kind.dimension()) {
                let nodes = 0..kind.node_count();
                let found: f64 = nodes.map(|a| shape[a] * kind.corner(a)[axis]).sum();
                assert!((found - expected).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn derivatives_agree_with_central_differences() {
        // N is linear along each axis, so the difference quotient is exact to round-off.
        for kind in CellKind::ALL {
            let derivatives = kind.shape_derivatives(INSIDE);
            for axis in 0..kind.dimension() {
                let (mut ahead, mut behind) = (INSIDE, INSIDE);
                ahead[axis] += 0.125;
                behind[axis] -= 0.125;
                let (ahead, behind) = (kind.shape(ahead), kind.shape(behind));
                for node in 0..kind.node_count() {
                    let quotient = (ahead[node] - behind[node]) / 0.25;
                    assert!((derivatives[node][axis] - quotient).abs() < 1e-14);
                }
            }
        }
    }

    #[test]
    fn every_facet_edge_is_walked_once_in_each_direction() {
        // Neighbouring faces of a consistently oriented closed surface share their edges
        // in opposite directions; in 2D the lines form one closed walk.
        for kind in CellKind::ALL {
            let mut edges = Vec::new();
            for facet in kind.facets() {
                let count = facet.len();
                if kind.dimension() == 2 {
                    edges.push((facet[0], facet[1]));
                } else {
                    edges.extend((0..count).map(|i| (facet[i], facet[(i + 1) % count])));
                }
            }
            let ends: Vec<_> = edges.iter().map(|edge| edge.1).collect();
            for (from, to) in &edges {
                if kind.dimension() == 2 {
                    assert_eq!(ends.iter().filter(|end| *end == from).count(), 1);
                } else {
                    assert_eq!(
                        edges.iter().filter(|edge| **edge == (*to, *from)).count(),
                        1
                    );
                }
            }
        }
    }
}
