//! The body: displacement and stress.

use super::document::{Cells, Document, Section};
use crate::body::{CellKind, Mesh};
use crate::error::{Error, check_length};

/// Fields of a body; an empty field is left out of the file.
///
/// Stresses are `[xx, yy, zz, yz, xz, xy]`, in pascal.
#[derive(Clone, Copy, Debug)]
pub struct BodyFields<'a> {
    /// Nodes and cells.
    pub mesh: &'a Mesh,
    /// Displacement per unknown (`node · dimension + axis`), in metre.
    pub displacement: &'a [f64],
    /// Stress per node.
    pub nodal_stress: &'a [[f64; 6]],
    /// Von Mises stress per node, in pascal.
    pub nodal_von_mises: &'a [f64],
    /// Stress per cell.
    pub cell_stress: &'a [[f64; 6]],
    /// Von Mises stress per cell, in pascal.
    pub cell_von_mises: &'a [f64],
}

/// The body as a VTU document: `displacement`, `stress`, `von_mises` at points, the
/// latter two also at cells.
///
/// # Errors
///
/// [`Error::Length`] for a field that is neither empty nor of the mesh's length.
pub fn body_vtu(fields: &BodyFields<'_>) -> Result<String, Error> {
    let mesh = fields.mesh;
    let (nodes, count) = (mesh.nodes.len(), mesh.cell_count());
    check_field(
        "displacement",
        nodes * mesh.dimension,
        fields.displacement.len(),
    )?;
    check_field("nodal_stress", nodes, fields.nodal_stress.len())?;
    check_field("nodal_von_mises", nodes, fields.nodal_von_mises.len())?;
    check_field("cell_stress", count, fields.cell_stress.len())?;
    check_field("cell_von_mises", count, fields.cell_von_mises.len())?;

    let mut cells = Cells::default();
    for cell in mesh.cells() {
        cells.push(vtk_kind(cell.kind), cell.nodes.iter().copied());
    }
    let mut document = Document::new(nodes, &cells);
    document.section(Section::Points, |document| {
        if !fields.displacement.is_empty() {
            let vectors = fields.displacement.chunks(mesh.dimension).flat_map(padded);
            document.reals("displacement", 3, vectors);
        }
        stress(document, fields.nodal_stress, fields.nodal_von_mises);
    });
    document.section(Section::Cells, |document| {
        stress(document, fields.cell_stress, fields.cell_von_mises);
    });
    Ok(document.finish(mesh.nodes.iter().copied(), &cells))
}

/// A vector of the body's dimension with three components.
pub(super) fn padded(vector: &[f64]) -> [f64; 3] {
    [0, 1, 2].map(|axis| vector.get(axis).copied().unwrap_or(0.0))
}

fn stress(document: &mut Document, tensors: &[[f64; 6]], von_mises: &[f64]) {
    if !tensors.is_empty() {
        let reordered = tensors
            .iter()
            .flat_map(|&[xx, yy, zz, yz, xz, xy]| [xx, yy, zz, xy, yz, xz]);
        document.reals("stress", 6, reordered);
    }
    if !von_mises.is_empty() {
        document.reals("von_mises", 1, von_mises.iter().copied());
    }
}

fn check_field(place: &str, expected: usize, found: usize) -> Result<(), Error> {
    if found == 0 {
        Ok(())
    } else {
        check_length(place, expected, found)
    }
}

/// VTK's number of a cell; its order of nodes is the mesh's own.
fn vtk_kind(kind: CellKind) -> u8 {
    match kind {
        CellKind::Tri3 => 5,
        CellKind::Quad4 => 9,
        CellKind::Tet4 => 10,
        CellKind::Hex8 => 12,
    }
}
