//! The table of cells and facets: a kind is an entry.

use std::sync::LazyLock;

use super::gauss::points;
use super::reference::{Family, Reference};

/// Most nodes of a facet.
pub(crate) const MOST_FACET_NODES: usize = 9;

/// Corners and edge nodes of the hexahedron in Gmsh's order, face nodes, centre.
const HEXAHEDRON: [[f64; 3]; 27] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
    [0.0, -1.0, -1.0],
    [-1.0, 0.0, -1.0],
    [-1.0, -1.0, 0.0],
    [1.0, 0.0, -1.0],
    [1.0, -1.0, 0.0],
    [0.0, 1.0, -1.0],
    [1.0, 1.0, 0.0],
    [-1.0, 1.0, 0.0],
    [0.0, -1.0, 1.0],
    [-1.0, 0.0, 1.0],
    [1.0, 0.0, 1.0],
    [0.0, 1.0, 1.0],
    [0.0, 0.0, -1.0],
    [0.0, -1.0, 0.0],
    [-1.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [0.0, 0.0, 0.0],
];

const QUADRILATERAL: [[f64; 3]; 9] = [
    [-1.0, -1.0, 0.0],
    [1.0, -1.0, 0.0],
    [1.0, 1.0, 0.0],
    [-1.0, 1.0, 0.0],
    [0.0, -1.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [-1.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
];

const TRIANGLE: [[f64; 3]; 6] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.5, 0.0, 0.0],
    [0.5, 0.5, 0.0],
    [0.0, 0.5, 0.0],
];

const TETRAHEDRON: [[f64; 3]; 10] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [0.5, 0.0, 0.0],
    [0.5, 0.5, 0.0],
    [0.0, 0.5, 0.0],
    [0.0, 0.0, 0.5],
    [0.0, 0.5, 0.5],
    [0.5, 0.0, 0.5],
];

/// Corners and edge nodes in Gmsh's order.
const PRISM: [[f64; 3]; 15] = [
    [0.0, 0.0, -1.0],
    [1.0, 0.0, -1.0],
    [0.0, 1.0, -1.0],
    [0.0, 0.0, 1.0],
    [1.0, 0.0, 1.0],
    [0.0, 1.0, 1.0],
    [0.5, 0.0, -1.0],
    [0.0, 0.5, -1.0],
    [0.0, 0.0, 0.0],
    [0.5, 0.5, -1.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.5, 0.0, 1.0],
    [0.0, 0.5, 1.0],
    [0.5, 0.5, 1.0],
];

/// Corners and edge nodes in Gmsh's order.
const PYRAMID: [[f64; 3]; 13] = [
    [-1.0, -1.0, 0.0],
    [1.0, -1.0, 0.0],
    [1.0, 1.0, 0.0],
    [-1.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [0.0, -1.0, 0.0],
    [-1.0, 0.0, 0.0],
    [-0.5, -0.5, 0.5],
    [1.0, 0.0, 0.0],
    [0.5, -0.5, 0.5],
    [0.0, 1.0, 0.0],
    [0.5, 0.5, 0.5],
    [-0.5, 0.5, 0.5],
];

const LINE: [[f64; 3]; 3] = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]];

const QUADRATIC_SIDES: &[&[usize]] = &[&[0, 1, 4], &[1, 2, 5], &[2, 3, 6], &[3, 0, 7]];

static EDGE2: Reference = Reference {
    name: "edge2",
    dimension: 1,
    family: Family::Tensor,
    corners: 2,
    nodes: LINE.split_at(2).0,
    facets: &[],
    rule: LazyLock::new(|| points(&EDGE2)),
};

static EDGE3: Reference = Reference {
    name: "edge3",
    dimension: 1,
    family: Family::Tensor,
    corners: 2,
    nodes: &LINE,
    facets: &[],
    rule: LazyLock::new(|| points(&EDGE3)),
};

static TRI3: Reference = Reference {
    name: "tri3",
    dimension: 2,
    family: Family::Simplex,
    corners: 3,
    nodes: TRIANGLE.split_at(3).0,
    facets: &[&[0, 1], &[1, 2], &[2, 0]],
    rule: LazyLock::new(|| points(&TRI3)),
};

static TRI6: Reference = Reference {
    name: "tri6",
    dimension: 2,
    family: Family::Simplex,
    corners: 3,
    nodes: &TRIANGLE,
    facets: &[&[0, 1, 3], &[1, 2, 4], &[2, 0, 5]],
    rule: LazyLock::new(|| points(&TRI6)),
};

static QUAD4: Reference = Reference {
    name: "quad4",
    dimension: 2,
    family: Family::Tensor,
    corners: 4,
    nodes: QUADRILATERAL.split_at(4).0,
    facets: &[&[0, 1], &[1, 2], &[2, 3], &[3, 0]],
    rule: LazyLock::new(|| points(&QUAD4)),
};

static QUAD8: Reference = Reference {
    name: "quad8",
    dimension: 2,
    family: Family::Serendipity,
    corners: 4,
    nodes: QUADRILATERAL.split_at(8).0,
    facets: QUADRATIC_SIDES,
    rule: LazyLock::new(|| points(&QUAD8)),
};

static QUAD9: Reference = Reference {
    name: "quad9",
    dimension: 2,
    family: Family::Tensor,
    corners: 4,
    nodes: &QUADRILATERAL,
    facets: QUADRATIC_SIDES,
    rule: LazyLock::new(|| points(&QUAD9)),
};

static TET4: Reference = Reference {
    name: "tet4",
    dimension: 3,
    family: Family::Simplex,
    corners: 4,
    nodes: TETRAHEDRON.split_at(4).0,
    facets: &[&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[0, 3, 2]],
    rule: LazyLock::new(|| points(&TET4)),
};

static TET10: Reference = Reference {
    name: "tet10",
    dimension: 3,
    family: Family::Simplex,
    corners: 4,
    nodes: &TETRAHEDRON,
    facets: &[
        &[0, 2, 1, 6, 5, 4],
        &[0, 1, 3, 4, 9, 7],
        &[1, 2, 3, 5, 8, 9],
        &[0, 3, 2, 7, 8, 6],
    ],
    rule: LazyLock::new(|| points(&TET10)),
};

static HEX8: Reference = Reference {
    name: "hex8",
    dimension: 3,
    family: Family::Tensor,
    corners: 8,
    nodes: HEXAHEDRON.split_at(8).0,
    facets: &[
        &[0, 3, 2, 1],
        &[4, 5, 6, 7],
        &[0, 1, 5, 4],
        &[1, 2, 6, 5],
        &[2, 3, 7, 6],
        &[3, 0, 4, 7],
    ],
    rule: LazyLock::new(|| points(&HEX8)),
};

static HEX20: Reference = Reference {
    name: "hex20",
    dimension: 3,
    family: Family::Serendipity,
    corners: 8,
    nodes: HEXAHEDRON.split_at(20).0,
    facets: &[
        &[0, 3, 2, 1, 9, 13, 11, 8],
        &[4, 5, 6, 7, 16, 18, 19, 17],
        &[0, 1, 5, 4, 8, 12, 16, 10],
        &[1, 2, 6, 5, 11, 14, 18, 12],
        &[2, 3, 7, 6, 13, 15, 19, 14],
        &[3, 0, 4, 7, 9, 10, 17, 15],
    ],
    rule: LazyLock::new(|| points(&HEX20)),
};

static HEX27: Reference = Reference {
    name: "hex27",
    dimension: 3,
    family: Family::Tensor,
    corners: 8,
    nodes: &HEXAHEDRON,
    facets: &[
        &[0, 3, 2, 1, 9, 13, 11, 8, 20],
        &[4, 5, 6, 7, 16, 18, 19, 17, 25],
        &[0, 1, 5, 4, 8, 12, 16, 10, 21],
        &[1, 2, 6, 5, 11, 14, 18, 12, 23],
        &[2, 3, 7, 6, 13, 15, 19, 14, 24],
        &[3, 0, 4, 7, 9, 10, 17, 15, 22],
    ],
    rule: LazyLock::new(|| points(&HEX27)),
};

static PRISM6: Reference = Reference {
    name: "prism6",
    dimension: 3,
    family: Family::Prism,
    corners: 6,
    nodes: PRISM.split_at(6).0,
    facets: &[
        &[0, 2, 1],
        &[3, 4, 5],
        &[0, 1, 4, 3],
        &[1, 2, 5, 4],
        &[2, 0, 3, 5],
    ],
    rule: LazyLock::new(|| points(&PRISM6)),
};

static PRISM15: Reference = Reference {
    name: "prism15",
    dimension: 3,
    family: Family::Prism,
    corners: 6,
    nodes: &PRISM,
    facets: &[
        &[0, 2, 1, 7, 9, 6],
        &[3, 4, 5, 12, 14, 13],
        &[0, 1, 4, 3, 6, 10, 12, 8],
        &[1, 2, 5, 4, 9, 11, 14, 10],
        &[2, 0, 3, 5, 7, 8, 13, 11],
    ],
    rule: LazyLock::new(|| points(&PRISM15)),
};

static PYRAMID5: Reference = Reference {
    name: "pyramid5",
    dimension: 3,
    family: Family::Pyramid,
    corners: 5,
    nodes: PYRAMID.split_at(5).0,
    facets: &[
        &[0, 3, 2, 1],
        &[0, 1, 4],
        &[1, 2, 4],
        &[2, 3, 4],
        &[3, 0, 4],
    ],
    rule: LazyLock::new(|| points(&PYRAMID5)),
};

static PYRAMID13: Reference = Reference {
    name: "pyramid13",
    dimension: 3,
    family: Family::Pyramid,
    corners: 5,
    nodes: &PYRAMID,
    facets: &[
        &[0, 3, 2, 1, 6, 10, 8, 5],
        &[0, 1, 4, 5, 9, 7],
        &[1, 2, 4, 8, 11, 9],
        &[2, 3, 4, 10, 12, 11],
        &[3, 0, 4, 6, 7, 12],
    ],
    rule: LazyLock::new(|| points(&PYRAMID13)),
};

/// Facets of plane and of solid cells.
static FACETS: [&[&Reference]; 2] = [&[&EDGE2, &EDGE3], &[&TRI3, &QUAD4, &TRI6, &QUAD8, &QUAD9]];

/// The cells, with Gmsh's order of nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CellKind {
    /// Triangle of constant strain.
    Tri3,
    /// Bilinear quadrilateral.
    Quad4,
    /// Tetrahedron of constant strain.
    Tet4,
    /// Trilinear hexahedron.
    Hex8,
    /// Quadratic triangle.
    Tri6,
    /// Quadratic quadrilateral without a middle node.
    Quad8,
    /// Biquadratic quadrilateral.
    Quad9,
    /// Quadratic tetrahedron.
    Tet10,
    /// Quadratic hexahedron with nodes at corners and on edges.
    Hex20,
    /// Triquadratic hexahedron.
    Hex27,
    /// Linear prism on a triangle.
    Prism6,
    /// Quadratic prism with nodes at corners and on edges.
    Prism15,
    /// Linear pyramid on a quadrilateral.
    Pyramid5,
    /// Quadratic pyramid with nodes at corners and on edges.
    Pyramid13,
}

impl CellKind {
    /// The entry of the kind.
    pub(crate) fn reference(self) -> &'static Reference {
        match self {
            Self::Tri3 => &TRI3,
            Self::Quad4 => &QUAD4,
            Self::Tet4 => &TET4,
            Self::Hex8 => &HEX8,
            Self::Tri6 => &TRI6,
            Self::Quad8 => &QUAD8,
            Self::Quad9 => &QUAD9,
            Self::Tet10 => &TET10,
            Self::Hex20 => &HEX20,
            Self::Hex27 => &HEX27,
            Self::Prism6 => &PRISM6,
            Self::Prism15 => &PRISM15,
            Self::Pyramid5 => &PYRAMID5,
            Self::Pyramid13 => &PYRAMID13,
        }
    }
}

/// The facet of so many nodes of a mesh of dimension 2 or 3.
pub(crate) fn facet_reference(dimension: usize, nodes: usize) -> Option<&'static Reference> {
    let facets = FACETS.get(dimension.checked_sub(2)?)?.iter().copied();
    facets.into_iter().find(|facet| facet.nodes.len() == nodes)
}

/// The linear facet on the same corners.
pub(crate) fn linear_facet(facet: &Reference) -> &'static Reference {
    match (facet.dimension, facet.corners) {
        (1, _) => &EDGE2,
        (_, 3) => &TRI3,
        _ => &QUAD4,
    }
}
