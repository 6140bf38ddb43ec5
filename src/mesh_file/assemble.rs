//! From the file's elements to cells, groups and the nodes they use.

use std::collections::{BTreeMap, HashMap};

use super::elements::{Contents, Element, MOST_NODES, Nodes, Places, Shape};
use crate::body::{Facet, Group, Mesh};
use crate::error::Error;

/// Largest distance from the plane `z = constant`, relative to the size of a plane mesh.
const FLAT: f64 = 1e-10;

/// What to do about a file that holds only the boundary of a body.
const MESH_IT: &str = "for a solid mesh its volume (`gmsh -3`), for a plane body its surface (`gmsh -2`), and put that \
    in a physical group if there are any, as Gmsh then leaves out all else";

/// Node of the file that the mesh does not hold.
const DROPPED: usize = usize::MAX;

/// Builds the mesh.
///
/// `repeats`: whether an element is repeated for each of its groups.
pub(super) fn mesh(
    contents: &Contents,
    repeats: bool,
    places: &impl Places,
) -> Result<Mesh, Error> {
    let missing = |section| places.fault(None, format!("the file ends; expected `${section}`"));
    let nodes = contents.nodes.as_ref().ok_or_else(|| missing("Nodes"))?;
    let elements = contents.elements.as_deref();
    let elements = elements.ok_or_else(|| missing("Elements"))?;
    let dimension = elements.iter().map(|e| e.shape.dimension()).max();
    let Some(dimension @ 2..=3) = dimension else {
        return Err(places.fault(
            None,
            format!(
                "no cell: expected triangles, quadrilaterals, tetrahedra or hexahedra; {MESH_IT}"
            ),
        ));
    };
    let new_index = number_nodes(contents, nodes, elements, dimension);
    let mut mesh = Mesh::new(dimension.into(), kept_positions(nodes, &new_index));
    if dimension == 2 {
        flatten(&mut mesh, nodes, &new_index, places)?;
    }
    let cells = push_cells(&mut mesh, elements, &new_index, repeats, places)?;
    let by_key = collect_groups(contents, elements, &cells, &new_index, dimension);
    mesh.groups = name_groups(contents, by_key, places)?;
    Ok(mesh)
}

/// Physical groups of an element.
fn groups<'a>(contents: &'a Contents, element: &Element) -> &'a [u32] {
    let key = (element.shape.dimension(), element.entity);
    contents
        .groups_of_entity
        .get(&key)
        .map_or(&[], Vec::as_slice)
}

/// New number per node of the file: nodes that no cell and no group uses are dropped, as
/// Gmsh writes the centres of circles and other construction points too.
fn number_nodes(
    contents: &Contents,
    nodes: &Nodes,
    elements: &[Element],
    dimension: u8,
) -> Vec<usize> {
    let mut index = vec![DROPPED; nodes.tags().len()];
    for element in elements {
        if element.shape.dimension() == dimension || !groups(contents, element).is_empty() {
            element.nodes().for_each(|node| index[node] = 0);
        }
    }
    let kept = index.iter_mut().filter(|new| **new != DROPPED);
    kept.enumerate().for_each(|(number, new)| *new = number);
    index
}

fn kept_positions(nodes: &Nodes, new_index: &[usize]) -> Vec<[f64; 3]> {
    let listed = nodes.positions().iter().zip(new_index);
    let kept = listed.filter(|&(_, &new)| new != DROPPED);
    kept.map(|(&position, _)| position).collect()
}

/// Puts a plane mesh at `z = 0` and refuses one that does not lie in `z = constant`.
fn flatten(
    mesh: &mut Mesh,
    nodes: &Nodes,
    new_index: &[usize],
    places: &impl Places,
) -> Result<(), Error> {
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for position in &mesh.nodes {
        for axis in 0..2 {
            low[axis] = low[axis].min(position[axis]);
            high[axis] = high[axis].max(position[axis]);
        }
    }
    let size = (high[0] - low[0]).hypot(high[1] - low[1]);
    let height = mesh.nodes.first().map_or(0.0, |position| position[2]);
    for (new, position) in mesh.nodes.iter_mut().enumerate() {
        if (position[2] - height).abs() > FLAT * size {
            let old = new_index.iter().position(|&index| index == new);
            let tag = old.map_or(0, |old| nodes.tags()[old]);
            return Err(places.fault(
                None,
                format!(
                    "node {tag} of a plane mesh lies at z = {}; expected z = {height} as for the \
                 other nodes, or the cells of a solid; {MESH_IT}",
                    position[2]
                ),
            ));
        }
        position[2] = 0.0;
    }
    Ok(())
}

/// Appends the cells and returns the cell of every element of the mesh's dimension.
///
/// MSH 2.2 repeats an element for each of its physical groups: that is one cell, as two
/// would be twice as stiff.
fn push_cells(
    mesh: &mut Mesh,
    elements: &[Element],
    new_index: &[usize],
    repeats: bool,
    places: &impl Places,
) -> Result<Vec<usize>, Error> {
    let mut first_by_corners: HashMap<[u32; 8], (usize, &Element)> = HashMap::new();
    let mut cells = Vec::new();
    for element in elements {
        let Shape::Cell(kind) = element.shape else {
            continue;
        };
        if usize::from(element.shape.dimension()) != mesh.dimension {
            continue;
        }
        let mut key = [u32::MAX; 8];
        let corners = &element.slots[..kind.corner_count()];
        key[..corners.len()].copy_from_slice(corners);
        key.sort_unstable();
        let new = (mesh.cell_count(), element);
        let &mut (cell, first) = first_by_corners.entry(key).or_insert(new);
        if cell == mesh.cell_count() {
            let mut nodes = [0; MOST_NODES];
            for (slot, node) in nodes.iter_mut().zip(element.nodes()) {
                *slot = new_index[node];
            }
            mesh.push_cell(kind, &nodes[..element.count]);
        } else if !repeats || first.entity == element.entity {
            return Err(places.fault(
                Some(element.place),
                format!(
                    "the element repeats the cell of {}",
                    places.name_of(first.place)
                ),
            ));
        }
        cells.push(cell);
    }
    Ok(cells)
}

/// Groups by dimension and number; `cells` holds the cell of every element of the mesh's dimension.
fn collect_groups(
    contents: &Contents,
    elements: &[Element],
    cells: &[usize],
    new_index: &[usize],
    dimension: u8,
) -> BTreeMap<(u8, u32), Group> {
    let empty = |of: u8| match dimension - of {
        0 => Group::Cells(Vec::new()),
        1 => Group::Facets(Vec::new()),
        _ if of == 1 => Group::Edges(Vec::new()),
        _ => Group::Points(Vec::new()),
    };
    let named = contents.names.keys().filter(|(of, _)| *of <= dimension);
    let mut by_key: BTreeMap<(u8, u32), Group> = named
        .map(|&(of, number)| ((of, number), empty(of)))
        .collect();
    let mut next_cell = cells.iter();
    for element in elements {
        let of = element.shape.dimension();
        let cell = if of == dimension {
            next_cell.next()
        } else {
            None
        };
        for &number in groups(contents, element) {
            match by_key.entry((of, number)).or_insert_with(|| empty(of)) {
                Group::Cells(members) => members.extend(cell),
                Group::Facets(members) => members.push(Facet {
                    nodes: element.nodes().map(|node| new_index[node]).collect(),
                }),
                Group::Edges(members) => {
                    members.push(element.nodes().map(|node| new_index[node]).collect());
                }
                Group::Points(members) => {
                    members.extend(element.nodes().map(|node| new_index[node]));
                }
            }
        }
    }
    by_key
}

/// Names the groups; a name that stands for several dimensions gets the dimension appended.
fn name_groups(
    contents: &Contents,
    by_key: BTreeMap<(u8, u32), Group>,
    places: &impl Places,
) -> Result<BTreeMap<String, Group>, Error> {
    let name = |key: &(u8, u32)| match contents.names.get(key) {
        Some(name) => name.clone(),
        None => key.1.to_string(),
    };
    let mut dimensions: HashMap<String, Vec<u8>> = HashMap::new();
    for key in by_key.keys() {
        let of = dimensions.entry(name(key)).or_default();
        if !of.contains(&key.0) {
            of.push(key.0);
        }
    }
    let mut named = BTreeMap::new();
    for (key, group) in by_key {
        let mut name = name(&key);
        if dimensions[&name].len() > 1 {
            name = format!("{name}.{}d", key.0);
        }
        match (named.get_mut(&name), group) {
            (None, group) => {
                named.insert(name, group);
            }
            // Two numbers of one dimension under the same name are one group.
            (Some(Group::Cells(members)), Group::Cells(more)) => members.extend(more),
            (Some(Group::Facets(members)), Group::Facets(more)) => members.extend(more),
            (Some(Group::Edges(members)), Group::Edges(more)) => members.extend(more),
            (Some(Group::Points(members)), Group::Points(more)) => members.extend(more),
            _ => {
                return Err(places.fault(
                    None,
                    format!("physical groups of different dimensions are both named `{name}`"),
                ));
            }
        }
    }
    Ok(named)
}
