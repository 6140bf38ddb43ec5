//! Nodes, cells and named groups of a body.

use std::collections::BTreeMap;

use super::kinds::{CellKind, facet_reference};

/// One cell: its kind and its nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cell<'a> {
    /// Shape.
    pub kind: CellKind,
    /// Node numbers in Gmsh's order.
    pub nodes: &'a [usize],
}

/// A piece of surface: 2 or 3 nodes (2D); 3, 4, 6, 8 or 9 nodes (3D).
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Facet {
    /// Node numbers: the corners, running around the facet; on quadratic ones then the nodes
    /// between each corner and the next, then the one in the middle.
    pub nodes: Vec<usize>,
}

impl Facet {
    /// The corners of a facet of a mesh of dimension 2 or 3; none if there is no such facet.
    #[must_use]
    pub fn corners(&self, dimension: usize) -> &[usize] {
        let count = facet_reference(dimension, self.nodes.len()).map_or(0, |facet| facet.corners);
        &self.nodes[..count]
    }

    /// Whether a facet of a mesh of dimension 2 or 3 has nodes beside its corners.
    #[must_use]
    pub fn is_quadratic(&self, dimension: usize) -> bool {
        self.corners(dimension).len() < self.nodes.len()
    }
}

/// A named part of the mesh.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Group {
    /// Cells of the body's own dimension.
    Cells(Vec<usize>),
    /// Surface facets: lines in 2D, triangles and quadrilaterals in 3D.
    Facets(Vec<Facet>),
    /// Lines in 3D: their ends, then the node between them if there is one.
    Edges(Vec<Vec<usize>>),
    /// Single nodes.
    Points(Vec<usize>),
}

/// Nodes, cells and named groups; positions in metre, `z = 0` in 2D.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// 2 or 3.
    pub dimension: usize,
    /// Node positions, in metre.
    pub nodes: Vec<[f64; 3]>,
    /// Named groups.
    pub groups: BTreeMap<String, Group>,
    kinds: Vec<CellKind>,
    offsets: Vec<usize>,
    connectivity: Vec<usize>,
}

impl Mesh {
    /// A mesh of dimension 2 or 3 with nodes and no cell yet.
    #[must_use]
    pub fn new(dimension: usize, nodes: Vec<[f64; 3]>) -> Self {
        Self {
            dimension,
            nodes,
            ..Self::default()
        }
    }

    /// Appends a cell; `nodes` has the kind's count of nodes.
    pub fn push_cell(&mut self, kind: CellKind, nodes: &[usize]) {
        if self.offsets.is_empty() {
            self.offsets.push(0);
        }
        self.kinds.push(kind);
        self.connectivity.extend_from_slice(nodes);
        self.offsets.push(self.connectivity.len());
    }

    /// Drops the nodes that no cell has; there are no groups yet.
    pub(super) fn drop_lone_nodes(&mut self) {
        let mut number = vec![usize::MAX; self.nodes.len()];
        for node in &self.connectivity {
            number[*node] = 0;
        }
        let mut kept = Vec::with_capacity(self.nodes.len());
        for (number, position) in number.iter_mut().zip(&self.nodes) {
            if *number == 0 {
                *number = kept.len();
                kept.push(*position);
            }
        }
        if kept.len() < self.nodes.len() {
            self.nodes = kept;
            for node in &mut self.connectivity {
                *node = number[*node];
            }
        }
    }

    /// Number of cells.
    #[must_use]
    pub fn cell_count(&self) -> usize {
        self.kinds.len()
    }

    /// Cell number `index`.
    #[must_use]
    pub fn cell(&self, index: usize) -> Cell<'_> {
        let range = self.offsets[index]..self.offsets[index + 1];
        Cell {
            kind: self.kinds[index],
            nodes: &self.connectivity[range],
        }
    }

    /// All cells in order.
    pub fn cells(&self) -> impl Iterator<Item = Cell<'_>> {
        (0..self.cell_count()).map(|index| self.cell(index))
    }
}
