//! What a body must satisfy before it is assembled.

use std::collections::HashSet;

use nalgebra::Vector3;

use super::boundary::Owners;
use super::quadrature::{Point, positions, rule};
use super::{Body, Cell, CellKind, Facet, Load, Mesh};
use crate::error::{Error, check_finite, check_length};

/// Least Jacobian accepted, on the scale where a right-angled cell of any aspect has 1.
const FLAT: f64 = 1e-10;

/// Checks that the body can be assembled: mesh, materials, supports and loads.
///
/// That its supports hold it is a matter of [`free_motion`](super::free_motion()), that they
/// do not contradict each other one of [`prescribed`](super::prescribed()).
///
/// # Errors
///
/// The first thing that is wrong, with its place, value and what is accepted.
pub fn check(body: &Body) -> Result<(), Error> {
    let name = &body.name;
    let expected = body.model.dimension();
    if body.mesh.dimension != expected {
        return Err(Error::WrongDimension {
            place: format!("{name}: mesh"),
            expected,
            found: body.mesh.dimension,
        });
    }
    body.model.validate(&format!("{name}: model"))?;
    for (index, material) in body.materials.iter().enumerate() {
        material.validate(&format!("{name}: materials[{index}]"))?;
    }
    check_nodes(body)?;
    check_cells(body)?;
    check_lone_nodes(body)?;
    check_supports(body)?;
    check_loads(body)
}

fn check_nodes(body: &Body) -> Result<(), Error> {
    for (node, position) in body.mesh.nodes.iter().enumerate() {
        check_vector(body, || format!("{}: node {node}", body.name), position)?;
    }
    Ok(())
}

fn check_cells(body: &Body) -> Result<(), Error> {
    let (mesh, name) = (&body.mesh, &body.name);
    if mesh.cell_count() == 0 {
        return Err(Error::Empty {
            place: format!("{name}: cells"),
        });
    }
    let materials = body.material_of_cell.len();
    check_length(
        &format!("{name}: material_of_cell"),
        mesh.cell_count(),
        materials,
    )?;
    let shapes = CornerPoints::new();
    for (index, cell) in mesh.cells().enumerate() {
        let place = || format!("{name}: cell {index}");
        if cell.kind.dimension() != mesh.dimension {
            return Err(Error::WrongDimension {
                place: format!("{} ({})", place(), cell.kind.name()),
                expected: mesh.dimension,
                found: cell.kind.dimension(),
            });
        }
        if cell.nodes.len() != cell.kind.node_count() {
            return Err(Error::Length {
                place: format!("{} ({})", place(), cell.kind.name()),
                expected: cell.kind.node_count(),
                found: cell.nodes.len(),
            });
        }
        check_indices(place, "node", cell.nodes, mesh.nodes.len())?;
        let material = &body.material_of_cell[index..=index];
        check_indices(place, "material", material, body.materials.len())?;
        let jacobian = shapes.smallest_jacobian(mesh, cell);
        if jacobian <= FLAT {
            return Err(Error::BadCell {
                place: place(),
                centroid: mesh.centroid(index),
                volume: mesh.volume(index),
                dimension: mesh.dimension,
                jacobian,
            });
        }
    }
    Ok(())
}

/// Points where a cell's Jacobian must be positive.
///
/// That of a quadrilateral is linear, so its corners decide; that of a hexahedron is
/// also taken at the quadrature points, where the stiffness needs it.
struct CornerPoints {
    points: [Vec<Point>; CellKind::ALL.len()],
}

impl CornerPoints {
    fn new() -> Self {
        let points = CellKind::ALL.map(|kind| {
            let corners =
                (0..kind.node_count()).map(|node| Point::at(kind, kind.corner(node), 0.0));
            if kind.is_tensor_product() {
                corners.chain(rule(kind).iter().copied()).collect()
            } else {
                rule(kind).to_vec()
            }
        });
        Self { points }
    }

    /// Least `det J / (‖t_1‖ ‖t_2‖ ‖t_3‖)`, 1 at right angles whatever the aspect ratio.
    fn smallest_jacobian(&self, mesh: &Mesh, cell: Cell<'_>) -> f64 {
        let positions = positions(mesh, cell.nodes);
        let normalised = |point: &Point| {
            let [t1, t2, t3] = point.tangents(cell.kind, &positions[..cell.nodes.len()]);
            let unit = |t: Vector3<f64>| t.try_normalize(0.0).unwrap_or_default();
            unit(t1).dot(&unit(t2).cross(&unit(t3)))
        };
        let points = self.points[cell.kind as usize].iter();
        points.map(normalised).fold(1.0, f64::min)
    }
}

fn check_lone_nodes(body: &Body) -> Result<(), Error> {
    let mut used = vec![false; body.mesh.nodes.len()];
    for cell in body.mesh.cells() {
        for node in cell.nodes {
            used[*node] = true;
        }
    }
    match used.iter().position(|used| !used) {
        None => Ok(()),
        Some(node) => Err(Error::LoneNode {
            place: format!("{}: node {node}", body.name),
            position: body.mesh.nodes[node],
        }),
    }
}

fn check_supports(body: &Body) -> Result<(), Error> {
    for support in &body.supports {
        let place = || support.place.clone();
        check_not_empty(place, support.nodes.len())?;
        check_indices(place, "node", &support.nodes, body.mesh.nodes.len())?;
        let values = support.displacement.map(|value| value.unwrap_or(0.0));
        check_vector(body, || format!("{}.displacement", support.place), &values)?;
    }
    Ok(())
}

fn check_loads(body: &Body) -> Result<(), Error> {
    let listed = body.loads.iter().flat_map(|load| match load {
        Load::Pressure { facets, .. } | Load::Traction { facets, .. } => facets.as_slice(),
        Load::BodyForce { .. } | Load::PointForce { .. } => &[],
    });
    let owners = Owners::new(&body.mesh, listed);
    for (index, load) in body.loads.iter().enumerate() {
        let place = || format!("{}: loads[{index}]", body.name);
        match load {
            Load::Pressure { facets, pressure } => {
                check_finite(&format!("{}.pressure", place()), &[*pressure])?;
                check_facets(place, facets, &owners)?;
            }
            Load::Traction { facets, traction } => {
                check_vector(body, || format!("{}.traction", place()), traction)?;
                check_facets(place, facets, &owners)?;
            }
            Load::BodyForce { cells, density } => {
                check_vector(body, || format!("{}.density", place()), density)?;
                check_not_empty(place, cells.len())?;
                check_indices(place, "cell", cells, body.mesh.cell_count())?;
                check_once(place, "cell", cells.iter().map(|cell| vec![*cell]))?;
            }
            Load::PointForce { node, force } => {
                check_vector(body, || format!("{}.force", place()), force)?;
                check_indices(place, "node", &[*node], body.mesh.nodes.len())?;
            }
        }
    }
    Ok(())
}

fn check_facets(
    place: impl Fn() -> String,
    facets: &[Facet],
    owners: &Owners<'_>,
) -> Result<(), Error> {
    check_not_empty(&place, facets.len())?;
    for (index, facet) in facets.iter().enumerate() {
        let place = || format!("{}.facets[{index}]", place());
        let outward = owners.outward(facet, place)?;
        if !same_cycle(&facet.nodes, &outward.nodes) {
            return Err(Error::FacetInward {
                place: place(),
                nodes: facet.nodes.clone(),
            });
        }
    }
    let sorted = facets.iter().map(|facet| {
        let mut nodes = facet.nodes.clone();
        nodes.sort_unstable();
        nodes
    });
    check_once(place, "facet", sorted)
}

/// Whether two walks around a facet differ only in where they start; two ends of a line do not.
fn same_cycle(one: &[usize], other: &[usize]) -> bool {
    if one.len() == 2 {
        return one == other;
    }
    (0..other.len()).any(|start| {
        let turned = other[start..].iter().chain(&other[..start]);
        one.iter().eq(turned)
    })
}

/// Refuses a component out of the plane of a plane body, and one that is not finite.
fn check_vector(
    body: &Body,
    place: impl Fn() -> String,
    components: &[f64; 3],
) -> Result<(), Error> {
    if components.iter().any(|x| !x.is_finite()) {
        return check_finite(&place(), components);
    }
    if body.mesh.dimension == 2 && components[2] != 0.0 {
        return Err(Error::OutOfRange {
            place: format!("{}[2]", place()),
            value: components[2],
            accepted: "0, for the body is plane",
        });
    }
    Ok(())
}

fn check_not_empty(place: impl Fn() -> String, length: usize) -> Result<(), Error> {
    if length > 0 {
        return Ok(());
    }
    Err(Error::Empty { place: place() })
}

fn check_indices(
    place: impl Fn() -> String,
    what: &'static str,
    indices: &[usize],
    count: usize,
) -> Result<(), Error> {
    match indices.iter().find(|index| **index >= count) {
        None => Ok(()),
        Some(index) => Err(Error::UnknownIndex {
            place: place(),
            what,
            index: *index,
            count,
        }),
    }
}

fn check_once(
    place: impl Fn() -> String,
    what: &'static str,
    mut entries: impl Iterator<Item = Vec<usize>>,
) -> Result<(), Error> {
    let mut seen = HashSet::new();
    match entries.find(|entry| !seen.insert(entry.clone())) {
        None => Ok(()),
        Some(index) => Err(Error::Repeated {
            place: place(),
            what,
            index,
        }),
    }
}
