//! VTK's numbers of cells, and the order of their nodes.

use crate::body::CellKind;
use crate::mesh_file::elements::Shape;

/// VTK's number of a cell, and the mesh's local nodes at the end of VTK's order where it is another.
pub(crate) fn vtk_kind(kind: CellKind) -> (u8, &'static [usize]) {
    const EDGES_THEN_FACES: [usize; 19] = [
        8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15, 22, 23, 21, 24, 20, 25, 26,
    ];
    match kind {
        CellKind::Tri3 => (5, &[]),
        CellKind::Quad4 => (9, &[]),
        CellKind::Tet4 => (10, &[]),
        CellKind::Hex8 => (12, &[]),
        CellKind::Tri6 => (22, &[]),
        CellKind::Quad8 => (23, &[]),
        CellKind::Quad9 => (28, &[]),
        CellKind::Tet10 => (24, &[9, 8]),
        CellKind::Hex20 => (25, EDGES_THEN_FACES.split_at(12).0),
        CellKind::Hex27 => (29, &EDGES_THEN_FACES),
        // The format's first triangle looks out of the cell.
        CellKind::Prism6 => (13, &[0, 2, 1, 3, 5, 4]),
        CellKind::Prism15 => (26, &[0, 2, 1, 3, 5, 4, 7, 9, 6, 13, 14, 12, 8, 11, 10]),
        CellKind::Pyramid5 => (14, &[]),
        CellKind::Pyramid13 => (27, &[5, 8, 10, 6, 7, 9, 11, 12]),
    }
}

/// Shape and number of nodes of VTK's number of a cell.
pub(super) fn shape(number: usize) -> Result<(Shape, usize), String> {
    if let Some(kind) = CellKind::all().find(|kind| usize::from(vtk_kind(*kind).0) == number) {
        return Ok((Shape::Cell(kind), kind.node_count()));
    }
    let name = match number {
        1 => return Ok((Shape::Point, 1)),
        3 => return Ok((Shape::Line, 2)),
        21 => return Ok((Shape::Line, 3)),
        2 | 4 | 6 => "several in one",
        7 => "a polygon",
        8 | 11 => "a pixel or voxel",
        42 => "a polyhedron",
        68.. => "of Lagrange or Bézier kind",
        _ => "of another shape or order",
    };
    Err(format!(
        "kind {number} ({name}) is not read; expected points (1), lines (3, 21), triangles (5, 22), \
         quadrilaterals (9, 23, 28), tetrahedra (10, 24), hexahedra (12, 25, 29), prisms (13, 26) or \
         pyramids (14, 27)"
    ))
}

/// Nodes of a cell in the mesh's order.
pub(super) fn mesh_nodes(shape: Shape, nodes: &[usize]) -> Vec<usize> {
    let mut ordered = nodes.to_vec();
    if let Shape::Cell(kind) = shape {
        let (_, moved) = vtk_kind(kind);
        let (_, last) = nodes.split_at(nodes.len() - moved.len());
        for (&at, &node) in moved.iter().zip(last) {
            ordered[at] = node;
        }
    }
    ordered
}
