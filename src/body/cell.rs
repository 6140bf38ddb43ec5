//! The kinds of cells: what each is called, and where its nodes and facets are.

use super::CellKind;
use super::reference::Family;

impl CellKind {
    /// The kinds with nodes at the corners only.
    pub const LINEAR: [Self; 6] = [
        Self::Tri3,
        Self::Quad4,
        Self::Tet4,
        Self::Hex8,
        Self::Prism6,
        Self::Pyramid5,
    ];

    /// The kinds with nodes on their edges, some also on their faces and in the middle.
    pub const QUADRATIC: [Self; 8] = [
        Self::Tri6,
        Self::Quad8,
        Self::Quad9,
        Self::Tet10,
        Self::Hex20,
        Self::Hex27,
        Self::Prism15,
        Self::Pyramid13,
    ];

    /// All kinds.
    pub fn all() -> impl Iterator<Item = Self> {
        Self::LINEAR.into_iter().chain(Self::QUADRATIC)
    }

    /// Name, as in messages.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.reference().name
    }

    /// Number of nodes.
    #[must_use]
    pub fn node_count(self) -> usize {
        self.reference().nodes.len()
    }

    /// Number of corners, whose nodes come first.
    #[must_use]
    pub fn corner_count(self) -> usize {
        self.reference().corners
    }

    /// Whether its nodes are its corners.
    #[must_use]
    pub fn is_linear(self) -> bool {
        self.reference().is_linear()
    }

    /// The kind with the corners alone.
    pub(crate) fn linear(self) -> Self {
        match (self.reference().family, self.dimension()) {
            (Family::Simplex, 2) => Self::Tri3,
            (Family::Simplex, _) => Self::Tet4,
            (Family::Prism, _) => Self::Prism6,
            (Family::Pyramid, _) => Self::Pyramid5,
            (_, 2) => Self::Quad4,
            _ => Self::Hex8,
        }
    }

    /// 2 or 3.
    #[must_use]
    pub fn dimension(self) -> usize {
        self.reference().dimension
    }

    /// Local nodes of each facet, in outward order: walking along a line of a plane
    /// cell the outside is on the right; around a face the right-hand rule points out.
    /// Corners come first, then the nodes between each corner and the next, then the middle.
    #[must_use]
    pub fn facets(self) -> &'static [&'static [usize]] {
        self.reference().facets
    }

    /// Whether it is a quadrilateral or a hexahedron.
    pub(crate) fn is_tensor_product(self) -> bool {
        matches!(
            self.reference().family,
            Family::Tensor | Family::Serendipity
        )
    }

    /// Whether strain is the same all over it, but for that around the axis of rings.
    pub(crate) fn has_constant_strain(self) -> bool {
        self.is_linear() && self.reference().family == Family::Simplex
    }

    /// Reference position of a local node.
    #[must_use]
    pub fn position(self, node: usize) -> [f64; 3] {
        self.reference().nodes[node]
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::body::kinds::{facet_reference, linear_facet};

    const INSIDE: [f64; 3] = [0.21, 0.13, 0.37];

    #[test]
    fn a_shape_function_is_one_at_its_node_and_zero_at_the_others() {
        for kind in CellKind::all() {
            for node in 0..kind.node_count() {
                let mut expected = vec![0.0; kind.node_count()];
                expected[node] = 1.0;
                assert_eq!(kind.reference().shape(kind.position(node)), expected);
            }
        }
    }

    #[test]
    fn shape_functions_sum_to_one_and_reproduce_the_position() {
        for kind in CellKind::all() {
            let shape = kind.reference().shape(INSIDE);
            assert!((shape.iter().sum::<f64>() - 1.0).abs() < 1e-15);
            for (axis, expected) in INSIDE.into_iter().enumerate().take(kind.dimension()) {
                let nodes = 0..kind.node_count();
                let found: f64 = nodes.map(|a| shape[a] * kind.position(a)[axis]).sum();
                assert!((found - expected).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn derivatives_agree_with_central_differences() {
        // N is quadratic at most along each axis, so the difference quotient is exact to round-off; that of
        // a pyramid is rational, and the third derivative (of order 10) times h²/6 is left.
        for kind in CellKind::all() {
            let derivatives = kind.reference().shape_derivatives(INSIDE);
            let (step, accepted) = match kind.reference().family {
                Family::Pyramid => (1.0 / 8192.0, 1e-6),
                _ => (0.125, 1e-14),
            };
            for axis in 0..kind.dimension() {
                let (mut ahead, mut behind) = (INSIDE, INSIDE);
                ahead[axis] += step;
                behind[axis] -= step;
                let shape = |at| kind.reference().shape(at);
                let (ahead, behind) = (shape(ahead), shape(behind));
                for node in 0..kind.node_count() {
                    let quotient = (ahead[node] - behind[node]) / (2.0 * step);
                    assert!((derivatives[node][axis] - quotient).abs() < accepted);
                }
            }
        }
    }

    /// Number of corners of a facet.
    fn corners(kind: CellKind, facet: &[usize]) -> usize {
        facet_reference(kind.dimension(), facet.len()).map_or(0, |facet| facet.corners)
    }

    #[test]
    fn nodes_of_a_facet_are_where_the_facets_own_table_has_them() {
        for kind in CellKind::all() {
            for nodes in kind.facets() {
                let facet = facet_reference(kind.dimension(), nodes.len()).unwrap();
                for (node, at) in nodes.iter().zip(facet.nodes) {
                    let corners = linear_facet(facet).shape(*at);
                    for axis in 0..3 {
                        let terms = nodes.iter().zip(&corners);
                        let expected: f64 = terms
                            .map(|(corner, n)| n * kind.position(*corner)[axis])
                            .sum();
                        assert_eq!(kind.position(*node)[axis], expected, "{kind:?} {node}");
                    }
                }
            }
        }
    }

    #[test]
    fn every_facet_edge_is_walked_once_in_each_direction() {
        // Neighbouring faces of a consistently oriented closed surface share their edges
        // in opposite directions; in 2D the lines form one closed walk.
        for kind in CellKind::all() {
            let mut edges = Vec::new();
            for facet in kind.facets() {
                let facet = &facet[..corners(kind, facet)];
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
