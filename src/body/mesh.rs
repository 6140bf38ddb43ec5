//! Nodes, cells and named groups of a body.

use std::collections::BTreeMap;

use super::kinds::{CellKind, facet_reference};
use crate::error::{Error, check_finite};

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

impl Group {
    /// Whether it has no members.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        match self {
            Self::Cells(members) | Self::Points(members) => members.is_empty(),
            Self::Facets(members) => members.is_empty(),
            Self::Edges(members) => members.is_empty(),
        }
    }

    /// Adds the members of a group of the same kind; false if it is of another.
    pub(crate) fn append(&mut self, other: &Self) -> bool {
        match (self, other) {
            (Self::Cells(own), Self::Cells(other)) | (Self::Points(own), Self::Points(other)) => {
                own.extend(other)
            }
            (Self::Facets(own), Self::Facets(other)) => own.extend_from_slice(other),
            (Self::Edges(own), Self::Edges(other)) => own.extend_from_slice(other),
            _ => return false,
        }
        true
    }
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

    /// A mesh of one kind of cell from flat arrays, as other programs hold them.
    ///
    /// - `positions`: in metre, one number per axis of the kind's dimension, node after node;
    /// - `cells`: node numbers from 0 in Gmsh's order, cell after cell.
    ///
    /// # Errors
    ///
    /// Arrays that are not whole nodes or whole cells, a position that is not finite, a node that is
    /// not there.
    pub fn from_arrays(kind: CellKind, positions: &[f64], cells: &[usize]) -> Result<Self, Error> {
        let (dimension, count) = (kind.dimension(), kind.node_count());
        check_whole("positions", positions.len(), dimension)?;
        check_whole("cells", cells.len(), count)?;
        check_finite("positions", positions)?;
        let nodes = positions.chunks_exact(dimension).map(|stated| {
            let mut position = [0.0; 3];
            position[..dimension].copy_from_slice(stated);
            position
        });
        let mut mesh = Self::new(dimension, nodes.collect());
        let known = mesh.nodes.len();
        if let Some(at) = cells.iter().position(|&node| node >= known) {
            return Err(Error::UnknownIndex {
                place: format!("cells[{at}]"),
                what: "node",
                index: cells[at],
                count: known,
            });
        }
        for nodes in cells.chunks_exact(count) {
            mesh.push_cell(kind, nodes);
        }
        Ok(mesh)
    }

    /// Names the part of the surface whose nodes all lie where `inside` says, for supports, loads and
    /// contacts.
    ///
    /// # Errors
    ///
    /// [`Error::Empty`] if there is no such facet.
    pub fn with_surface(
        mut self,
        name: &str,
        inside: impl Fn([f64; 3]) -> bool,
    ) -> Result<Self, Error> {
        let mut facets = self.boundary_facets();
        facets.retain(|facet| facet.nodes.iter().all(|&node| inside(self.nodes[node])));
        if facets.is_empty() {
            return Err(Error::Empty {
                place: format!("surface `{name}`"),
            });
        }
        self.groups.insert(name.to_owned(), Group::Facets(facets));
        Ok(self)
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

    /// Gives a cell other nodes, as many as it has.
    pub(super) fn renumber_cell(&mut self, index: usize, nodes: &[usize]) {
        let range = self.offsets[index]..self.offsets[index + 1];
        self.connectivity[range].copy_from_slice(nodes);
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

/// Refuses an array that ends within a node or a cell.
fn check_whole(place: &str, found: usize, of: usize) -> Result<(), Error> {
    if found.is_multiple_of(of) {
        return Ok(());
    }
    Err(Error::NotAccepted {
        place: place.to_owned(),
        found: format!("{found} entries"),
        accepted: format!("a multiple of {of}"),
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn arrays_become_a_mesh_with_named_surfaces() {
        // Two unit squares side by side.
        let positions = [0.0, 0.0, 1.0, 0.0, 2.0, 0.0, 0.0, 1.0, 1.0, 1.0, 2.0, 1.0];
        let cells = [0, 1, 4, 3, 1, 2, 5, 4];
        let mesh = Mesh::from_arrays(CellKind::Quad4, &positions, &cells).unwrap();
        assert_eq!((mesh.dimension, mesh.cell_count()), (2, 2));
        let mesh = mesh.with_surface("bottom", |[_, y, _]| y == 0.0).unwrap();
        let Group::Facets(facets) = &mesh.groups["bottom"] else {
            unreachable!("a group of facets");
        };
        assert_eq!(facets.len(), 2);
        assert!(mesh.with_surface("inside", |[x, ..]| x == 1.0).is_err());
    }

    #[test]
    fn arrays_that_are_no_mesh_are_refused_with_their_place() {
        let say = |positions: &[f64], cells: &[usize]| {
            let refused = Mesh::from_arrays(CellKind::Tri3, positions, cells);
            refused.unwrap_err().to_string()
        };
        let corners = [0.0, 0.0, 1.0, 0.0, 0.0, 1.0];
        assert!(say(&corners[..5], &[0, 1, 2]).contains("positions: 5 entries"));
        assert!(say(&corners, &[0, 1]).contains("cells: 2 entries"));
        assert!(say(&corners, &[0, 1, 3]).contains("cells[2]"));
        assert!(say(&[f64::NAN; 6], &[0, 1, 2]).contains("positions"));
    }
}
