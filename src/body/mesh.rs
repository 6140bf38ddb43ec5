//! Nodes, cells and named groups of a body.

use std::collections::BTreeMap;

/// The linear cells, with Gmsh's (and VTK's) order of nodes.
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
}

/// One cell: its kind and its nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cell<'a> {
    /// Shape.
    pub kind: CellKind,
    /// Node numbers in Gmsh's order.
    pub nodes: &'a [usize],
}

/// A piece of surface: 2 nodes (2D), 3 or 4 nodes (3D).
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Facet {
    /// Node numbers, running around the facet.
    pub nodes: Vec<usize>,
}

/// A named part of the mesh.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Group {
    /// Cells of the body's own dimension.
    Cells(Vec<usize>),
    /// Surface facets: lines in 2D, triangles and quadrilaterals in 3D.
    Facets(Vec<Facet>),
    /// Lines in 3D.
    Edges(Vec<[usize; 2]>),
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
