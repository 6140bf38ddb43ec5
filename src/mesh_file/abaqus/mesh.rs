//! One mesh of all that a deck states of nodes and elements, whatever it says beside that.
//!
//! Sets of elements become groups of cells, or of facets where the elements lie on the surface of others
//! (shells, membranes, plane elements of a solid mesh, trusses and beams); surfaces become groups of
//! facets, sets of nodes groups of points. Names are in capitals, as case counts nowhere in a deck; one used
//! in several dimensions gets the dimension appended (`BASE.2d`), as from Gmsh.

use super::card::cards;
use super::contents::Contents;
use super::element::ElementKind;
use super::instance::flatten;
use super::lines::{Reader, Source};
use crate::body::{CellKind, Mesh};
use crate::error::Error;
use crate::mesh_file::assemble;
use crate::mesh_file::elements::{Gathered, Listed, Shape};

/// Keywords that make or move nodes and elements, and are not read.
const MAKERS: [&str; 8] = [
    "NGEN", "NFILL", "NCOPY", "NMAP", "ELGEN", "ELCOPY", "SYSTEM", "SUBMODEL",
];

/// Reads a mesh; `name` stands for the file in messages, `read` gives the bytes of one that it includes.
///
/// # Errors
///
/// [`Error::Mesh`] with file, line and keyword: data that is no data, an element that is neither linear
/// nor quadratic, a keyword that makes nodes or elements out of others, no cell at all.
pub(crate) fn parse(bytes: &[u8], name: &str, read: &Reader<'_>) -> Result<Mesh, Error> {
    let source = Source::new(bytes, name, read)?;
    let cards = cards(&source)?;
    if let Some(card) = cards
        .iter()
        .find(|card| MAKERS.contains(&card.name.as_str()))
    {
        let reason = "is not read; expected every node and element on a line of its own";
        return Err(card.error(reason));
    }
    let contents = Contents::new(&flatten(&cards)?, ElementKind::of_geometry)?;
    let places = Listed {
        file: name,
        line: cards.last().map_or(1, |card| card.line.number),
        what: "element",
    };
    let gathered = gather(&contents);
    assemble::mesh(
        &gathered.contents(&contents.positions, &places)?,
        false,
        &places,
    )
}

fn gather(contents: &Contents) -> Gathered {
    let mut gathered = Gathered::default();
    let mut sets_of = vec![Vec::new(); contents.elements.len()];
    for (name, members) in contents.cells.sets() {
        let set = gathered.set(name);
        members.iter().for_each(|&member| sets_of[member].push(set));
    }
    for (element, sets) in contents.elements.iter().zip(sets_of) {
        let nodes = match element.kind.shape {
            Shape::Line => ends_first(&contents.positions, element.nodes.clone()),
            _ => element.nodes.clone(),
        };
        gathered.push(element.label as usize, element.kind.shape, &nodes, sets);
    }
    for (name, sides) in &contents.surfaces {
        let set = gathered.set(name);
        for &side in sides {
            let nodes = contents.facet(side);
            let solid = contents.elements[side.0].kind.shape.dimension() == 3;
            let shape = match (solid, nodes.len()) {
                (false, _) => Shape::Line,
                (true, 3) => Shape::Cell(CellKind::Tri3),
                (true, 4) => Shape::Cell(CellKind::Quad4),
                (true, 6) => Shape::Cell(CellKind::Tri6),
                (true, _) => Shape::Cell(CellKind::Quad8),
            };
            gathered.push(0, shape, &nodes, vec![set]);
        }
    }
    for (name, members) in contents.nodes.sets() {
        let set = gathered.set(name);
        for &node in members {
            gathered.push(0, Shape::Point, &[node], vec![set]);
        }
    }
    gathered
}

/// The nodes of a line with the middle one last: the ends are farthest from each other.
///
/// Trusses and beams of three nodes have it last or between their ends, by program and element.
fn ends_first(positions: &[[f64; 3]], mut nodes: Vec<usize>) -> Vec<usize> {
    let apart = |a: usize, b: usize| {
        let (a, b) = (positions[a], positions[b]);
        (0..3).fold(0.0_f64, |sum, axis| sum.hypot(a[axis] - b[axis]))
    };
    if let [a, b, c] = nodes[..]
        && apart(a, c) > apart(a, b)
    {
        nodes = vec![a, c, b];
    }
    nodes
}
