//! Elements whose corners are not all different: the simpler cells that they are.
//!
//! ```text
//! quadrilateral, two neighbours one          triangle
//! hexahedron, a face folded to an edge       wedge            4----------3=3'        1, 2, 3, 3, 5, 6, 7, 7
//! hexahedron, wedge, a face shrunk to a point                 pyramid, tetrahedron
//! ```
//!
//! The faces of the cell are those of the element without repeated corners; all run around alike.

use std::collections::BTreeSet;

use super::element::ElementKind;
use crate::body::CellKind;
use crate::mesh_file::elements::Shape;

/// The cell that an element with some nodes twice is.
pub(super) struct Collapsed {
    pub(super) kind: ElementKind,
    pub(super) nodes: Vec<usize>,
    /// The cell's face, from 1, that each face of the element is; none for one without area.
    pub(super) faces: Vec<Option<usize>>,
}

impl Collapsed {
    /// None where there is no such cell, and of quadratic elements.
    pub(super) fn new(kind: ElementKind, nodes: &[usize]) -> Option<Self> {
        let Shape::Cell(cell) = kind.shape else {
            return None;
        };
        if cell.corner_count() < nodes.len() {
            return None;
        }
        let face = |number: usize| {
            let corners = kind.face(number).unwrap_or_default().iter();
            without_repeats(corners.map(|&at| nodes[at]).collect())
        };
        let cycles: Vec<Vec<usize>> = (1..=kind.faces()).map(face).collect();
        let (cell, nodes) = match cell.dimension() {
            2 => Some((CellKind::Tri3, without_repeats(nodes.to_vec()))),
            _ => solid(&cycles),
        }?;
        let different: BTreeSet<&usize> = nodes.iter().collect();
        if nodes.len() != cell.node_count() || different.len() != nodes.len() {
            return None;
        }
        let kind = ElementKind {
            shape: Shape::Cell(cell),
            nodes: cell.node_count(),
            bends: false,
            ..kind
        };
        let same = |cycle: &Vec<usize>| {
            let around: BTreeSet<usize> = cycle.iter().copied().collect();
            (1..=kind.faces()).find(|&number| {
                let corners = kind.face(number).unwrap_or_default();
                around == corners.iter().map(|&at| nodes[at]).collect()
            })
        };
        let faces = cycles.iter().map(same).collect();
        Some(Self { kind, nodes, faces })
    }
}

/// A cycle of nodes without those that repeat the one before.
fn without_repeats(mut cycle: Vec<usize>) -> Vec<usize> {
    cycle.dedup();
    while cycle.len() > 1 && cycle.first() == cycle.last() {
        cycle.pop();
    }
    cycle
}

/// The cell with these faces: one of them first, then what lies across.
fn solid(cycles: &[Vec<usize>]) -> Option<(CellKind, Vec<usize>)> {
    let of = |corners: usize| cycles.iter().filter(move |cycle| cycle.len() == corners);
    let all: BTreeSet<usize> = cycles.iter().flatten().copied().collect();
    let (kind, base) = match (all.len(), of(3).count(), of(4).count()) {
        (4, 4, 0) => (CellKind::Tet4, of(3).next()?),
        (5, 4, 1) => (CellKind::Pyramid5, of(4).next()?),
        (6, 2, 3) => (CellKind::Prism6, of(3).next()?),
        _ => return None,
    };
    let across = |node: usize| {
        let beside = of(4).filter_map(move |cycle| {
            let at = cycle.iter().position(|other| *other == node)?;
            Some([cycle[(at + 1) % 4], cycle[(at + 3) % 4]])
        });
        let mut beside = beside.flatten();
        beside.find(|other| !base.contains(other))
    };
    let top: Vec<usize> = match kind {
        CellKind::Prism6 => base.iter().map(|&n| across(n)).collect::<Option<_>>()?,
        _ => all.into_iter().filter(|n| !base.contains(n)).collect(),
    };
    Some((kind, base.iter().copied().chain(top).collect()))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn cell(name: &str, nodes: &[usize]) -> Option<(CellKind, Vec<usize>, Vec<Option<usize>>)> {
        let kind = ElementKind::new(name).unwrap();
        let Collapsed { kind, nodes, faces } = Collapsed::new(kind, nodes)?;
        match kind.shape {
            Shape::Cell(cell) => Some((cell, nodes, faces)),
            _ => None,
        }
    }

    #[test]
    fn what_an_element_collapses_to_is_the_cell_of_its_different_corners() {
        let face = |numbers: [usize; 6]| numbers.map(|n| (n > 0).then_some(n)).to_vec();
        // Corners 3 and 4, 7 and 8 are one: S5 has no area, S4 and S6 meet in the edge from 3 to 7.
        let (kind, nodes, faces) = cell("C3D8", &[1, 2, 3, 3, 5, 6, 7, 7]).unwrap();
        assert_eq!((kind, nodes), (CellKind::Prism6, vec![1, 2, 3, 5, 6, 7]));
        assert_eq!(faces, face([1, 2, 3, 4, 0, 5]));
        let (kind, nodes, faces) = cell("C3D8", &[1, 2, 3, 4, 5, 5, 5, 5]).unwrap();
        assert_eq!((kind, nodes), (CellKind::Pyramid5, vec![1, 2, 3, 4, 5]));
        assert_eq!(faces, face([1, 0, 2, 3, 4, 5]));
        let (kind, nodes, faces) = cell("C3D8R", &[1, 2, 3, 3, 5, 5, 5, 5]).unwrap();
        assert_eq!((kind, nodes), (CellKind::Tet4, vec![1, 2, 3, 5]));
        assert_eq!(faces, face([1, 0, 2, 3, 0, 4]));
        let (kind, nodes, _) = cell("C3D6", &[1, 2, 3, 5, 5, 5]).unwrap();
        assert_eq!((kind, nodes), (CellKind::Tet4, vec![1, 2, 3, 5]));
        let (kind, nodes, faces) = cell("CPS4", &[1, 2, 3, 1]).unwrap();
        assert_eq!((kind, nodes), (CellKind::Tri3, vec![1, 2, 3]));
        assert_eq!(faces, [Some(1), Some(2), Some(3), None]);
    }

    #[test]
    fn what_is_no_simpler_cell_has_none() {
        // One edge, two edges across from each other, opposite corners, a triangle, middle nodes.
        assert!(cell("C3D8", &[1, 2, 3, 3, 5, 6, 7, 8]).is_none());
        assert!(cell("C3D8", &[1, 1, 3, 4, 5, 6, 7, 7]).is_none());
        assert!(cell("CPE4", &[1, 2, 1, 4]).is_none());
        assert!(cell("CPE3", &[1, 2, 2]).is_none());
        assert!(cell("CPE8", &[1, 2, 3, 3, 5, 6, 3, 8]).is_none());
    }
}
