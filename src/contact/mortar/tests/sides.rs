//! Pairs of bodies that the checks of this folder bring together.

#![allow(clippy::unwrap_used)]

use nalgebra::Vector3;

use crate::body::tests::samples::facets;
use crate::body::{CellKind, Facet, Mesh, Model, box_mesh, graded, rectangle};
use crate::contact::mortar::{Mortar, couple};
use crate::error::Error;
use crate::mesh_file::gmsh;

/// One of two bodies that meet: its mesh and its contact face in outward order.
pub(crate) struct Side {
    pub(crate) mesh: Mesh,
    pub(crate) facets: Vec<Facet>,
}

impl Side {
    fn new(mesh: Mesh, face: &str) -> Self {
        let facets = mesh.orient(&facets(&mesh, face)).unwrap();
        Self { mesh, facets }
    }

    /// Moves every node.
    pub(crate) fn moved(mut self, to: impl Fn([f64; 3]) -> [f64; 3]) -> Self {
        for node in &mut self.mesh.nodes {
            *node = to(*node);
        }
        self
    }
}

/// A block of edge one with uneven cells, `counts` along the face and one across it.
pub(crate) fn block(kind: CellKind, count: usize, from: f64, face: &str) -> Side {
    let along = graded(0.0, 1.0, count, 1.7).unwrap();
    let across = [from, from + 1.0];
    let mesh = match kind.dimension() {
        2 => rectangle(&along, &across, kind).unwrap(),
        _ => box_mesh(
            &along,
            &graded(0.0, 1.0, count, 0.8).unwrap(),
            &across,
            kind,
        )
        .unwrap(),
    };
    Side::new(mesh, face)
}

/// An upper block `gap` above a lower one: side 1 and side 2.
pub(crate) fn stack(kinds: [CellKind; 2], counts: [usize; 2], gap: f64) -> [Side; 2] {
    [
        block(kinds[0], counts[0], gap, "bottom"),
        block(kinds[1], counts[1], -1.0, "top"),
    ]
}

pub(crate) fn meet([one, two]: &[Side; 2]) -> Result<Mortar, Error> {
    couple(
        &one.mesh,
        &one.facets,
        &two.mesh,
        &two.facets,
        Model::Solid,
        "contacts[0]",
    )
}

pub(crate) const STACKS: [([CellKind; 2], [usize; 2]); 8] = [
    ([CellKind::Quad4; 2], [7, 5]),
    ([CellKind::Quad4, CellKind::Tri3], [35, 25]),
    ([CellKind::Tri3; 2], [5, 7]),
    ([CellKind::Hex8; 2], [4, 3]),
    ([CellKind::Hex8; 2], [12, 9]),
    ([CellKind::Tet4; 2], [4, 3]),
    ([CellKind::Tet4, CellKind::Hex8], [3, 4]),
    ([CellKind::Hex8, CellKind::Tet4], [4, 7]),
];

/// Worst distance of `Σ_k P_ik x²_k − x_i` from `expected`.
pub(crate) fn worst_gap(mortar: &Mortar, expected: Vector3<f64>) -> f64 {
    let gaps = mortar.nodes.iter();
    gaps.map(|node| (Vector3::from(node.gap_vector) - expected).norm())
        .fold(0.0, f64::max)
}

pub(crate) fn weight(mortar: &Mortar) -> f64 {
    mortar.nodes.iter().map(|node| node.weight).sum()
}

/// Two bodies as one side.
pub(crate) fn join(mut one: Side, other: &Side) -> Side {
    let first = one.mesh.nodes.len();
    one.mesh.nodes.extend(&other.mesh.nodes);
    one.facets.extend(other.facets.iter().map(|facet| Facet {
        nodes: facet.nodes.iter().map(|node| node + first).collect(),
    }));
    one
}

/// The two sides of a shipped mesh's text with the groups `contact` and `master`.
pub(crate) fn shipped(text: &str) -> [Side; 2] {
    let mesh = gmsh::parse(text, "shipped mesh").unwrap();
    ["contact", "master"].map(|side| Side::new(mesh.clone(), side))
}
