//! The elements of decks that are read: their cells, the order of their nodes, their faces.
//!
//! ```text
//! C3D4 C3D5 C3D6 C3D8 C3D10 C3D15 C3D20      solids
//! CPE, CPS, CAX 3 4 6 8                      plane strain, plane stress, axisymmetric (x = r, y = z)
//! ```
//!
//! Letters behind the name (R, H, M, S) choose how the element is integrated and against what it
//! locks, which is the solver's own matter; I gives those of four and eight corners incompatible modes.

use crate::body::CellKind;
use crate::mesh_file::elements::Shape;

/// How strain and stress live in an element.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Space {
    /// 3D.
    Solid,
    /// No strain out of the plane.
    PlaneStrain,
    /// No stress out of the plane.
    PlaneStress,
    /// A ring around the y axis.
    Axisymmetric,
}

/// A kind of element.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ElementKind {
    /// What it becomes.
    pub(crate) shape: Shape,
    /// Number of nodes.
    pub(super) nodes: usize,
    /// Where it lives.
    pub(crate) space: Space,
    /// Whether it has incompatible modes, to bend.
    pub(crate) bends: bool,
}

/// The deck's position of every node of the cell, where the two orders differ.
const HEX20: [usize; 20] = [
    0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 16, 9, 17, 10, 18, 19, 12, 15, 13, 14,
];
const PRISM15: [usize; 15] = [0, 1, 2, 3, 4, 5, 6, 8, 12, 7, 13, 14, 9, 11, 10];
const TET10: [usize; 10] = [0, 1, 2, 3, 4, 5, 6, 7, 9, 8];

/// Corners of the faces S1, S2, …
const TETRAHEDRON: [&[usize]; 4] = [&[0, 1, 2], &[0, 3, 1], &[1, 3, 2], &[2, 3, 0]];
const HEXAHEDRON: [&[usize]; 6] = [
    &[0, 1, 2, 3],
    &[4, 7, 6, 5],
    &[0, 4, 5, 1],
    &[1, 5, 6, 2],
    &[2, 6, 7, 3],
    &[3, 7, 4, 0],
];
const PRISM: [&[usize]; 5] = [
    &[0, 1, 2],
    &[3, 5, 4],
    &[0, 3, 4, 1],
    &[1, 4, 5, 2],
    &[2, 5, 3, 0],
];
const PYRAMID: [&[usize]; 5] = [
    &[0, 1, 2, 3],
    &[0, 4, 1],
    &[1, 4, 2],
    &[2, 4, 3],
    &[3, 4, 0],
];
const TRIANGLE: [&[usize]; 3] = [&[0, 1], &[1, 2], &[2, 0]];
const QUADRILATERAL: [&[usize]; 4] = [&[0, 1], &[1, 2], &[2, 3], &[3, 0]];

/// Beginnings of names that are refused, and what they are.
const REFUSED: [(&str, &str); 17] = [
    ("SPRING", "a spring"),
    ("SC", "a continuum shell"),
    ("S", "a shell"),
    ("B", "a beam"),
    ("T", "a truss"),
    ("M3D", "a membrane"),
    ("MASS", "a point mass"),
    ("ROTARY", "a rotary inertia"),
    ("GAP", "a gap element"),
    ("R", "a rigid element"),
    ("DASHPOT", "a dashpot"),
    ("DCOUP", "a distributing coupling"),
    ("CONN", "a connector"),
    ("COH", "a cohesive element"),
    ("DC", "a heat transfer element"),
    ("CGAX", "a ring that twists"),
    ("U", "a user's element"),
];

/// Beginnings of the names of elements that describe lines and surfaces where only geometry counts, and
/// their number of nodes.
const GEOMETRY: [(&str, Shape, usize); 24] = [
    ("T2D2", Shape::Line, 2),
    ("T3D2", Shape::Line, 2),
    ("B21", Shape::Line, 2),
    ("B31", Shape::Line, 2),
    ("T2D3", Shape::Line, 3),
    ("T3D3", Shape::Line, 3),
    ("B22", Shape::Line, 3),
    ("B32", Shape::Line, 3),
    ("STRI65", Shape::Cell(CellKind::Tri6), 6),
    ("STRI3", Shape::Cell(CellKind::Tri3), 3),
    ("R3D3", Shape::Cell(CellKind::Tri3), 3),
    ("R3D4", Shape::Cell(CellKind::Quad4), 4),
    ("M3D3", Shape::Cell(CellKind::Tri3), 3),
    ("M3D4", Shape::Cell(CellKind::Quad4), 4),
    ("M3D6", Shape::Cell(CellKind::Tri6), 6),
    ("M3D8", Shape::Cell(CellKind::Quad8), 8),
    ("SFM3D3", Shape::Cell(CellKind::Tri3), 3),
    ("SFM3D4", Shape::Cell(CellKind::Quad4), 4),
    ("SFM3D6", Shape::Cell(CellKind::Tri6), 6),
    ("SFM3D8", Shape::Cell(CellKind::Quad8), 8),
    ("S3", Shape::Cell(CellKind::Tri3), 3),
    ("S4", Shape::Cell(CellKind::Quad4), 4),
    ("S6", Shape::Cell(CellKind::Tri6), 6),
    ("S8", Shape::Cell(CellKind::Quad8), 8),
];

impl ElementKind {
    /// The kind of a name in capitals, or why it is not read.
    pub(crate) fn new(name: &str) -> Result<Self, String> {
        let (space, rest) = [
            ("C3D", Space::Solid),
            ("CPE", Space::PlaneStrain),
            ("CPS", Space::PlaneStress),
            ("CAX", Space::Axisymmetric),
        ]
        .into_iter()
        .find_map(|(start, space)| Some((space, name.strip_prefix(start)?)))
        .ok_or_else(|| refusal(name))?;
        let digits = rest.len() - rest.trim_start_matches(|c: char| c.is_ascii_digit()).len();
        let (nodes, letters) = rest.split_at(digits);
        let cell = match (space, nodes) {
            (Space::Solid, "4") => CellKind::Tet4,
            (Space::Solid, "5") => CellKind::Pyramid5,
            (Space::Solid, "6") => CellKind::Prism6,
            (Space::Solid, "15") => CellKind::Prism15,
            (Space::Solid, "8") => CellKind::Hex8,
            (Space::Solid, "10") => CellKind::Tet10,
            (Space::Solid, "20") => CellKind::Hex20,
            (Space::Solid, _) => return Err(refusal(name)),
            (_, "3") => CellKind::Tri3,
            (_, "4") => CellKind::Quad4,
            (_, "6") => CellKind::Tri6,
            (_, "8") => CellKind::Quad8,
            _ => return Err(refusal(name)),
        };
        match letters.chars().all(|letter| "RIHMS".contains(letter)) {
            true => Ok(Self {
                shape: Shape::Cell(cell),
                nodes: cell.node_count(),
                space,
                bends: letters.contains('I') && matches!(cell, CellKind::Hex8 | CellKind::Quad4),
            }),
            false => Err(refusal(name)),
        }
    }

    /// The kind of a name in capitals where nothing but geometry counts: trusses, beams, shells and
    /// membranes describe lines and surfaces, whatever letters follow.
    pub(super) fn of_geometry(name: &str) -> Result<Self, String> {
        let lower = GEOMETRY.iter().find(|(start, ..)| name.starts_with(start));
        match lower {
            Some(&(_, shape, nodes)) => Ok(Self {
                shape,
                nodes,
                space: Space::Solid,
                bends: false,
            }),
            None => Ok(Self {
                space: Space::Solid,
                ..Self::new(name.trim_end_matches(|c: char| c.is_ascii_alphabetic()))?
            }),
        }
    }

    /// Turns the nodes of an element into the order of its cell.
    pub(super) fn cell_nodes(self, nodes: &[usize]) -> Vec<usize> {
        let reordered = |order: &[usize]| order.iter().map(|&at| nodes[at]).collect();
        match self.shape {
            Shape::Cell(CellKind::Hex20) => reordered(&HEX20),
            Shape::Cell(CellKind::Tet10) => reordered(&TET10),
            Shape::Cell(CellKind::Prism15) => reordered(&PRISM15),
            _ => nodes.to_vec(),
        }
    }

    /// Corners of the face of a number, from 1.
    pub(super) fn face(self, number: usize) -> Option<&'static [usize]> {
        let Shape::Cell(kind) = self.shape else {
            return None;
        };
        let faces: &[&[usize]] = match kind {
            CellKind::Tet4 | CellKind::Tet10 => &TETRAHEDRON,
            CellKind::Hex8 | CellKind::Hex20 => &HEXAHEDRON,
            CellKind::Prism6 | CellKind::Prism15 => &PRISM,
            CellKind::Pyramid5 => &PYRAMID,
            CellKind::Tri3 | CellKind::Tri6 => &TRIANGLE,
            _ => &QUADRILATERAL,
        };
        faces.get(number.checked_sub(1)?).copied()
    }

    /// The cell's facet on the face of a number, from 1.
    pub(crate) fn facet(self, number: usize) -> Option<&'static [usize]> {
        let (corners, Shape::Cell(kind)) = (self.face(number)?, self.shape) else {
            return None;
        };
        let mut facets = kind.facets().iter().copied();
        facets.find(|facet| corners.iter().all(|corner| facet.contains(corner)))
    }

    /// Number of faces.
    pub(super) fn faces(self) -> usize {
        match self.shape {
            Shape::Cell(kind) => kind.facets().len(),
            _ => 0,
        }
    }
}

fn refusal(name: &str) -> String {
    let known = REFUSED.iter().find(|(start, _)| name.starts_with(start));
    let what = known.map_or(String::new(), |(_, what)| format!(", {what},"));
    format!(
        "`TYPE={}`{what} is not read; accepted: C3D4, C3D5, C3D6, C3D8, C3D10, C3D15, C3D20, and \
         CPE, CPS, CAX of 3, 4, 6 or 8 nodes",
        super::card::quote(name)
    )
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn every_face_is_a_facet_of_the_cell_and_no_two_are_the_same() {
        for name in [
            "C3D4", "C3D10T", "C3D10M", "C3D8I", "C3D20RH", "CPE3", "CPS6", "CAX8R", "C3D5",
            "C3D6", "C3D15",
        ] {
            let Ok(kind) = ElementKind::new(name) else {
                assert_eq!(name, "C3D10T");
                continue;
            };
            let facets = (1..=kind.faces()).map(|number| kind.facet(number).unwrap());
            let facets: std::collections::BTreeSet<_> = facets.collect();
            assert_eq!(facets.len(), kind.faces(), "{name}");
            assert!(kind.facet(0).is_none() && kind.facet(kind.faces() + 1).is_none());
        }
    }

    #[test]
    fn middle_nodes_stand_between_the_corners_of_the_deck_s_edges() {
        // C3D20: 9 to 12 go around the bottom, 13 to 16 around the top, 17 to 20 up. C3D10: 5, 6, 7
        // around the first face, then up from its corners 1, 2, 3. C3D15 as C3D20.
        let ring = |from: usize| (0..4).map(move |i| (from + i, from + (i + 1) % 4));
        let uprights = (0..4).map(|i| (i, i + 4));
        let hexahedron: Vec<_> = ring(0).chain(ring(4)).chain(uprights).collect();
        let tetrahedron = vec![(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)];
        let ring = |from: usize| (0..3).map(move |i| (from + i, from + (i + 1) % 3));
        let prism: Vec<_> = ring(0)
            .chain(ring(3))
            .chain((0..3).map(|i| (i, i + 3)))
            .collect();
        for (name, edges) in [
            ("C3D20", hexahedron),
            ("C3D10", tetrahedron),
            ("C3D15", prism),
        ] {
            let kind = ElementKind::new(name).unwrap();
            let (Shape::Cell(cell), count) = (kind.shape, kind.nodes) else {
                unreachable!()
            };
            let deck = kind.cell_nodes(&(0..count).collect::<Vec<_>>());
            for (at, &place) in deck.iter().enumerate().skip(cell.corner_count()) {
                let (a, b) = edges[place - cell.corner_count()];
                let (a, b) = (cell.position(a), cell.position(b));
                let middle = [0, 1, 2].map(|axis| 0.5 * (a[axis] + b[axis]));
                assert_eq!(cell.position(at), middle, "{name} {at}");
            }
        }
    }

    #[test]
    fn what_is_not_read_is_refused_by_what_it_is() {
        for (name, said) in [
            ("S8R", "a shell"),
            ("SPRINGA", "a spring"),
            ("B32R", "a beam"),
            ("C3D8T", "`TYPE=C3D8T` is not read"),
            ("", "`TYPE=`"),
        ] {
            let reason = ElementKind::new(name).unwrap_err();
            assert!(reason.contains(said), "{reason}");
        }
    }
}
