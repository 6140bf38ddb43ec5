//! The bodies: displacement and stress.

use super::document::{Cells, Document, Section};
use crate::body::{Mesh, principal, von_mises};
use crate::error::{Error, check_length};
use crate::mesh_file::vtu::vtk_kind;

/// Fields of a body; a field that is empty in all bodies is left out of the file.
///
/// Stresses are `[xx, yy, zz, yz, xz, xy]`, in pascal, strains likewise.
#[derive(Clone, Copy, Debug)]
pub struct BodyFields<'a> {
    /// Nodes and cells.
    pub mesh: &'a Mesh,
    /// Displacement per unknown (`node · dimension + axis`), in metre.
    pub displacement: &'a [f64],
    /// Stress per node.
    pub nodal_stress: &'a [[f64; 6]],
    /// Stress per cell.
    pub cell_stress: &'a [[f64; 6]],
    /// Strain per cell.
    pub cell_strain: &'a [[f64; 6]],
    /// Force of the contacts on the body per unknown, in newton.
    pub contact_force: &'a [f64],
    /// Force of the supports on the body per unknown, in newton.
    pub support_force: &'a [f64],
}

/// A field per unknown of a body.
type OfUnknowns = for<'a> fn(&BodyFields<'a>) -> &'a [f64];

/// Vectors at points.
const VECTORS: [(&str, OfUnknowns); 3] = [
    ("displacement", |body| body.displacement),
    ("contact_force", |body| body.contact_force),
    ("support_force", |body| body.support_force),
];

/// All bodies as one VTU document, one after the other, with the arrays of the table in [`vtu`](super).
///
/// # Errors
///
/// [`Error::Length`] for a field that is not of the mesh's length, unless it is empty in
/// all bodies.
pub fn body_vtu(bodies: &[BodyFields<'_>]) -> Result<String, Error> {
    let mut vectors = Vec::new();
    for (name, values) in VECTORS {
        let found = has_field(bodies, name, |body| {
            let unknowns = body.mesh.nodes.len() * body.mesh.dimension;
            (unknowns, values(body).len())
        })?;
        vectors.extend(found.then_some((name, values)));
    }
    let stressed_nodes = has_field(bodies, "nodal_stress", |body| {
        (body.mesh.nodes.len(), body.nodal_stress.len())
    })?;
    let stressed_cells = has_field(bodies, "cell_stress", |body| {
        (body.mesh.cell_count(), body.cell_stress.len())
    })?;

    let strained = has_field(bodies, "cell_strain", |body| {
        (body.mesh.cell_count(), body.cell_strain.len())
    })?;

    let (nodes, cells) = joined(bodies);
    let mut document = Document::new(nodes, &cells);
    document.section(Section::Points, |document| {
        for (name, values) in vectors {
            let vectors = bodies.iter().flat_map(|body| {
                let of_nodes = values(body).chunks(body.mesh.dimension);
                of_nodes.flat_map(padded)
            });
            document.reals(name, 3, vectors);
        }
        if stressed_nodes {
            stress(document, bodies, |body| body.nodal_stress);
        }
        document.integers("body", indices(bodies, |mesh| mesh.nodes.len()));
    });
    document.section(Section::Cells, |document| {
        if stressed_cells {
            stress(document, bodies, |body| body.cell_stress);
        }
        if strained {
            let all = bodies.iter().flat_map(|body| body.cell_strain);
            document.reals("strain", 6, all.flat_map(reordered));
        }
        document.integers("body", indices(bodies, Mesh::cell_count));
    });
    let points = bodies.iter().flat_map(|body| &body.mesh.nodes);
    Ok(document.finish(points.copied(), &cells))
}

/// A vector of the body's dimension with three components.
pub(super) fn padded(vector: &[f64]) -> [f64; 3] {
    [0, 1, 2].map(|axis| vector.get(axis).copied().unwrap_or(0.0))
}

/// Number of points, and the cells of all bodies between them.
fn joined(bodies: &[BodyFields<'_>]) -> (usize, Cells) {
    let (mut first, mut cells) = (0, Cells::default());
    for body in bodies {
        for cell in body.mesh.cells() {
            let (number, moved) = vtk_kind(cell.kind);
            let kept = 0..cell.nodes.len() - moved.len();
            let order = kept.chain(moved.iter().copied());
            cells.push(number, order.map(|local| first + cell.nodes[local]));
        }
        first += body.mesh.nodes.len();
    }
    (first, cells)
}

/// VTK's order of a tensor.
fn reordered(&[xx, yy, zz, yz, xz, xy]: &[f64; 6]) -> [f64; 6] {
    [xx, yy, zz, xy, yz, xz]
}

fn stress<'a>(
    document: &mut Document,
    bodies: &[BodyFields<'a>],
    tensors: fn(&BodyFields<'a>) -> &'a [[f64; 6]],
) {
    let all = || bodies.iter().flat_map(tensors).copied();
    document.reals("stress", 6, all().flat_map(|tensor| reordered(&tensor)));
    document.reals("von_mises", 1, all().map(von_mises));
    document.reals("principal_stress", 3, all().flat_map(principal));
}

/// The index of each body, as often as it has entries.
fn indices(bodies: &[BodyFields<'_>], entries: fn(&Mesh) -> usize) -> impl Iterator<Item = i32> {
    let bodies = bodies.iter().enumerate();
    bodies.flat_map(move |(index, body)| std::iter::repeat_n(index as i32, entries(body.mesh)))
}

/// Whether any body has a field, given its expected and found length; then all must.
fn has_field<'a>(
    bodies: &[BodyFields<'a>],
    field: &str,
    lengths: impl Fn(&BodyFields<'a>) -> (usize, usize),
) -> Result<bool, Error> {
    let present = bodies.iter().any(|body| lengths(body).1 > 0);
    for (index, body) in bodies.iter().enumerate().filter(|_| present) {
        let (expected, found) = lengths(body);
        check_length(&format!("bodies[{index}].{field}"), expected, found)?;
    }
    Ok(present)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::CellKind;

    /// Nodes between which those of a quadratic cell stand, in VTK's order after the corners: the
    /// edges, then the corners of faces (VTK, vtkCellType and its cells' documentation).
    const TETRAHEDRON: [&[usize]; 6] = [&[0, 1], &[1, 2], &[2, 0], &[0, 3], &[1, 3], &[2, 3]];
    const PRISM: [&[usize]; 9] = [
        &[0, 1],
        &[1, 2],
        &[2, 0],
        &[3, 4],
        &[4, 5],
        &[5, 3],
        &[0, 3],
        &[1, 4],
        &[2, 5],
    ];
    const PYRAMID: [&[usize]; 8] = [
        &[0, 1],
        &[1, 2],
        &[2, 3],
        &[3, 0],
        &[0, 4],
        &[1, 4],
        &[2, 4],
        &[3, 4],
    ];
    const HEXAHEDRON: [&[usize]; 18] = [
        &[0, 1],
        &[1, 2],
        &[2, 3],
        &[3, 0],
        &[4, 5],
        &[5, 6],
        &[6, 7],
        &[7, 4],
        &[0, 4],
        &[1, 5],
        &[2, 6],
        &[3, 7],
        &[0, 3, 4, 7],
        &[1, 2, 5, 6],
        &[0, 1, 4, 5],
        &[2, 3, 6, 7],
        &[0, 1, 2, 3],
        &[4, 5, 6, 7],
    ];

    #[test]
    fn nodes_between_corners_stand_in_the_order_of_the_format() {
        for (kind, between) in [
            (CellKind::Tet10, &TETRAHEDRON[..]),
            (CellKind::Hex20, &HEXAHEDRON[..12]),
            (CellKind::Hex27, &HEXAHEDRON[..]),
            (CellKind::Prism15, &PRISM[..]),
            (CellKind::Pyramid13, &PYRAMID[..]),
        ] {
            let (_, moved) = vtk_kind(kind);
            let order: Vec<usize> = (0..kind.node_count() - moved.len())
                .chain(moved.iter().copied())
                .collect();
            for (place, corners) in (kind.corner_count()..).zip(between) {
                let found = kind.position(order[place]);
                for (axis, found) in found.into_iter().enumerate() {
                    let sum: f64 = corners.iter().map(|c| kind.position(order[*c])[axis]).sum();
                    assert_eq!(found, sum / corners.len() as f64, "{kind:?} {place}");
                }
            }
        }
    }
}
