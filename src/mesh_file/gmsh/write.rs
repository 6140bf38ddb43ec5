//! Writer of Gmsh meshes: MSH 2.2, ASCII.
//!
//! An element stands once per group that it belongs to, as the format has it. Numbers are written with
//! all their digits, so that a mesh that is read again is the same to the last bit.

use std::fmt::Write;

use super::super::elements::Shape;
use crate::body::{CellKind, Group, Mesh};

/// Gmsh's numbers of cells and facets.
const NUMBERS: [u32; 14] = [2, 3, 4, 5, 6, 7, 9, 10, 11, 12, 16, 17, 18, 19];

/// The mesh as text; groups keep their names, a quotation mark in one becomes an apostrophe.
#[must_use]
pub fn to_text(mesh: &Mesh) -> String {
    let mut elements = Vec::new();
    let mut names = Vec::new();
    let mut grouped = vec![false; mesh.cell_count()];
    for (tag, (name, group)) in (1..).zip(&mesh.groups) {
        let dimension = match group {
            Group::Cells(cells) => {
                cells.iter().for_each(|&cell| grouped[cell] = true);
                mesh.dimension
            }
            Group::Facets(_) => mesh.dimension - 1,
            Group::Edges(_) => 1,
            Group::Points(_) => 0,
        };
        names.push(format!("{dimension} {tag} \"{}\"", name.replace('"', "'")));
        elements.extend(members(mesh, group).map(|(number, nodes)| (number, tag, nodes)));
    }
    let alone = (0..mesh.cell_count()).filter(|&cell| !grouped[cell]);
    let alone = Group::Cells(alone.collect());
    elements.extend(members(mesh, &alone).map(|(number, nodes)| (number, 0, nodes)));

    let mut text = String::from("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n");
    section(&mut text, "PhysicalNames", names.len(), names.into_iter());
    let nodes = (1..).zip(&mesh.nodes);
    section(
        &mut text,
        "Nodes",
        mesh.nodes.len(),
        nodes.map(|(number, [x, y, z])| format!("{number} {x} {y} {z}")),
    );
    let count = elements.len();
    let rows = (1..).zip(elements).map(|(at, (number, tag, nodes))| {
        let nodes = nodes
            .iter()
            .fold(String::new(), |row, node| format!("{row} {}", node + 1));
        format!("{at} {number} 2 {tag} 1{nodes}")
    });
    section(&mut text, "Elements", count, rows);
    text
}

/// The members of a group: number of the element type, nodes.
fn members<'a>(
    mesh: &'a Mesh,
    group: &'a Group,
) -> Box<dyn Iterator<Item = (u32, &'a [usize])> + 'a> {
    let solid = mesh.dimension == 3;
    match group {
        Group::Cells(cells) => Box::new(cells.iter().map(|&cell| {
            let cell = mesh.cell(cell);
            (number(cell.kind), cell.nodes)
        })),
        Group::Facets(facets) => Box::new(facets.iter().map(move |facet| {
            let number = match (solid, facet.nodes.len()) {
                (true, 3) => number(CellKind::Tri3),
                (true, 4) => number(CellKind::Quad4),
                (true, 6) => number(CellKind::Tri6),
                (true, 8) => number(CellKind::Quad8),
                (true, _) => number(CellKind::Quad9),
                (false, nodes) => line(nodes),
            };
            (number, facet.nodes.as_slice())
        })),
        Group::Edges(edges) => {
            Box::new(edges.iter().map(|edge| (line(edge.len()), edge.as_slice())))
        }
        Group::Points(points) => Box::new(points.chunks(1).map(|point| (15, point))),
    }
}

/// Gmsh's number of a cell.
fn number(kind: CellKind) -> u32 {
    let is_kind = |number: &u32| matches!(Shape::from_type(*number), Ok((Shape::Cell(found), _)) if found == kind);
    NUMBERS.into_iter().find(is_kind).unwrap_or_default()
}

/// Gmsh's number of a line of two or three nodes.
fn line(nodes: usize) -> u32 {
    if nodes == 2 { 1 } else { 8 }
}

fn section(text: &mut String, name: &str, count: usize, rows: impl Iterator<Item = String>) {
    // Writing to a string does not fail.
    let _ = writeln!(text, "${name}\n{count}");
    for row in rows {
        text.push_str(&row);
        text.push('\n');
    }
    let _ = writeln!(text, "$End{name}");
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::parse;
    use super::*;
    use crate::body::{Facet, box_mesh, rectangle};

    #[test]
    fn a_mesh_of_any_cells_is_read_again_as_it_was() {
        let lines = [0.1, 0.7, 1.0 / 3.0 + 1.0];
        for kind in CellKind::all() {
            let mut mesh = match kind.dimension() {
                2 => rectangle(&lines, &lines, kind),
                _ => box_mesh(&lines, &lines, &lines, kind),
            }
            .unwrap();
            let last = mesh.cell_count() - 1;
            mesh.groups
                .insert("a \u{e4}".into(), Group::Cells(vec![last]));
            mesh.groups
                .insert("points".into(), Group::Points(vec![0, 2]));
            let read = parse(to_text(&mesh), "part.msh").unwrap();
            assert_eq!(read.nodes, mesh.nodes, "{kind:?}");
            assert_eq!(read.groups.len(), mesh.groups.len());
            let cells = |mesh: &Mesh| -> Vec<_> {
                let mut cells: Vec<_> = mesh.cells().map(|cell| cell.nodes.to_vec()).collect();
                cells.sort();
                cells
            };
            assert_eq!(cells(&read), cells(&mesh), "{kind:?}");
            for (name, group) in &mesh.groups {
                let facets = |group: &Group| match group {
                    Group::Facets(facets) => facets.clone(),
                    _ => Vec::<Facet>::new(),
                };
                assert_eq!(facets(&read.groups[name]), facets(group), "{kind:?} {name}");
            }
            assert_eq!(read.groups["points"], mesh.groups["points"]);
        }
    }
}
