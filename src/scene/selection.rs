//! From the names and positions of a scene to nodes, facets and cells of the mesh.

use std::borrow::Cow;
use std::slice::from_ref;

use super::spelling;
use crate::body::{Facet, Group, Mesh};
use crate::error::{Error, check_finite, check_length};

/// Farthest that a node may lie from the position that selects it, relative to the mesh's size.
pub(super) const AT_NODE: f64 = 1e-6;

/// What a mesh without groups needs.
const NO_GROUPS: &str = "a mesh with named groups of facets and cells (in Gmsh physical groups, such as `Physical \
    Surface(\"contact\") = {3};` for a face of a solid, and one for its volume; then mesh it again)";

/// The group of this name, or one of all members of several; it must not be empty.
pub(super) fn group<'a>(
    mesh: &'a Mesh,
    place: &str,
    names: &[String],
) -> Result<Cow<'a, Group>, Error> {
    match names {
        [one] => named(mesh, place, one).map(Cow::Borrowed),
        several => union(mesh, place, several).map(Cow::Owned),
    }
}

/// The group of this name, which must not be empty.
fn named<'a>(mesh: &'a Mesh, place: &str, name: &str) -> Result<&'a Group, Error> {
    let Some(group) = mesh.groups.get(name) else {
        if mesh.groups.is_empty() {
            return Err(Error::NotAccepted {
                place: place.to_owned(),
                found: format!("group `{name}` of a mesh without groups"),
                accepted: NO_GROUPS.to_owned(),
            });
        }
        let known = mesh.groups.keys();
        return Err(Error::UnknownName {
            place: place.to_owned(),
            what: "group",
            name: name.to_owned(),
            nearest: spelling::nearest(name, known.clone().map(String::as_str)).map(str::to_owned),
            known: known.cloned().collect(),
        });
    };
    if group.is_empty() {
        return Err(Error::Empty {
            place: format!("{place}: group `{name}`"),
        });
    }
    Ok(group)
}

fn kind_of(mesh: &Mesh, group: &Group) -> &'static str {
    match group {
        Group::Cells(_) => "cells",
        Group::Facets(_) if mesh.dimension == 2 => "surface facets (lines)",
        Group::Facets(_) => "surface facets",
        Group::Edges(_) => "edges (lines in 3D)",
        Group::Points(_) => "points",
    }
}

fn wrong_kind(mesh: &Mesh, place: &str, names: &[String], group: &Group, accepted: &str) -> Error {
    let found = kind_of(mesh, group);
    Error::NotAccepted {
        place: place.to_owned(),
        found: format!("group {} of {found}", quoted(names)),
        accepted: format!("a group of {accepted}"),
    }
}

/// A group of the members of several, each once, all of one kind.
pub(super) fn union(mesh: &Mesh, place: &str, names: &[String]) -> Result<Group, Error> {
    let mut union: Option<Group> = None;
    for (at, name) in names.iter().enumerate() {
        let place = format!("{place}[{at}]");
        let found = named(mesh, &place, name)?;
        let Some(so_far) = &mut union else {
            union = Some(found.clone());
            continue;
        };
        if !so_far.append(found) {
            let accepted = kind_of(mesh, so_far);
            return Err(wrong_kind(mesh, &place, from_ref(name), found, accepted));
        }
    }
    let mut union = union.ok_or_else(|| Error::Empty {
        place: place.to_owned(),
    })?;
    if let Group::Cells(members) | Group::Points(members) = &mut union {
        members.sort_unstable();
        members.dedup();
    }
    Ok(union)
}

/// Cells of a group.
pub(super) fn cells(mesh: &Mesh, place: &str, names: &[String]) -> Result<Vec<usize>, Error> {
    match group(mesh, place, names)?.into_owned() {
        Group::Cells(cells) => Ok(cells),
        other => Err(wrong_kind(mesh, place, names, &other, "cells")),
    }
}

/// Facets of a group, running outward.
pub(super) fn facets(mesh: &Mesh, place: &str, names: &[String]) -> Result<Vec<Facet>, Error> {
    match &*group(mesh, place, names)? {
        Group::Facets(facets) => mesh
            .orient(facets)
            .map_err(|error| error.within(format_args!("{place}: group {}", quoted(names)))),
        other => Err(wrong_kind(mesh, place, names, other, "surface facets")),
    }
}

/// Nodes of a group of any kind, each once, in increasing order.
pub(super) fn nodes(mesh: &Mesh, place: &str, names: &[String]) -> Result<Vec<usize>, Error> {
    let mut nodes: Vec<usize> = match &*group(mesh, place, names)? {
        Group::Cells(cells) => {
            let mut nodes = Vec::new();
            for &cell in cells {
                check_cell(mesh, place, cell)?;
                nodes.extend_from_slice(mesh.cell(cell).nodes);
            }
            nodes
        }
        Group::Facets(facets) => facets
            .iter()
            .flat_map(|facet| facet.nodes.clone())
            .collect(),
        Group::Edges(edges) => edges.iter().flatten().copied().collect(),
        Group::Points(points) => points.clone(),
    };
    nodes.sort_unstable();
    nodes.dedup();
    Ok(nodes)
}

/// Names as they stand in messages.
fn quoted(names: &[String]) -> String {
    let names: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    names.join(", ")
}

/// Refuses the number of a cell that the mesh does not hold.
pub(super) fn check_cell(mesh: &Mesh, place: &str, cell: usize) -> Result<(), Error> {
    if cell < mesh.cell_count() {
        return Ok(());
    }
    Err(Error::UnknownIndex {
        place: place.to_owned(),
        what: "cell",
        index: cell,
        count: mesh.cell_count(),
    })
}

/// The one node at a position.
pub(super) fn node_at(mesh: &Mesh, place: &str, position: &[f64]) -> Result<usize, Error> {
    let position = vector(place, position, mesh.dimension)?;
    let distance = |node: &[f64; 3]| norm([0, 1, 2].map(|axis| node[axis] - position[axis]));
    let tolerance = AT_NODE * size(mesh);
    let distances = mesh.nodes.iter().map(distance).enumerate();
    let nearest = distances.clone().min_by(|a, b| a.1.total_cmp(&b.1));
    let Some((node, nearest)) = nearest else {
        return Err(Error::Empty {
            place: format!("{place}: nodes of the mesh"),
        });
    };
    if nearest.is_nan() || nearest > tolerance {
        return Err(Error::NoNodeAt {
            place: place.to_owned(),
            position,
            node,
            found: mesh.nodes[node],
            distance: nearest,
            tolerance,
        });
    }
    let here = distances.filter(|&(_, distance)| distance <= tolerance);
    let here: Vec<usize> = here.map(|(node, _)| node).collect();
    if here.len() > 1 {
        return Err(Error::NotAccepted {
            place: place.to_owned(),
            found: format!("position {position:?} of nodes {here:?}"),
            accepted: "the position of a single node".to_owned(),
        });
    }
    Ok(node)
}

/// Diagonal of the box around all nodes, in metre.
pub(super) fn size(mesh: &Mesh) -> f64 {
    norm([0, 1, 2].map(|axis| {
        let along = mesh.nodes.iter().map(|node| node[axis]);
        along.clone().fold(f64::NEG_INFINITY, f64::max) - along.fold(f64::INFINITY, f64::min)
    }))
}

/// Length of a vector, safe from overflow.
pub(super) fn norm([x, y, z]: [f64; 3]) -> f64 {
    x.hypot(y).hypot(z)
}

/// A finite vector of the body's dimension; the third component is 0 in 2D.
pub(super) fn vector(place: &str, values: &[f64], dimension: usize) -> Result<[f64; 3], Error> {
    check_length(place, dimension, values.len())?;
    check_finite(place, values)?;
    let mut vector = [0.0; 3];
    vector[..dimension].copy_from_slice(values);
    Ok(vector)
}
