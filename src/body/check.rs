//! What a body must satisfy before it is assembled.

use std::collections::{HashMap, HashSet};

use nalgebra::Vector3;

use super::applied::{check_loads, check_supports};
use super::entries::{check_indices, check_vector};
use super::quadrature::positions;
use super::reference::Point;
use super::{Axis, Body, Cell, CellKind, Facet, Formulation, Mesh};
use crate::error::{Error, check_length};

/// Least Jacobian accepted, on the scale where a right-angled cell of any aspect has 1.
const FLAT: f64 = 1e-10;

/// Checks that the body can be assembled: mesh, materials, supports and loads.
///
/// What its supports leave free is a matter of [`free_modes`](super::free_modes()), that they
/// do not contradict each other one of [`prescribed`](super::prescribed()).
///
/// # Errors
///
/// The first thing that is wrong, with its place, value and what is accepted.
pub(crate) fn check(body: &Body) -> Result<(), Error> {
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
        let place = format!("{name}: materials[{index}]");
        material.validate(&place)?;
        if let Some(constants) = &material.orthotropic {
            constants.check_plane(&place, body.model)?;
        }
    }
    check_formulation(body)?;
    check_nodes(body)?;
    check_cells(body)?;
    check_neighbours(body)?;
    check_split_faces(body)?;
    check_lone_nodes(body)?;
    check_supports(body)?;
    check_loads(body)
}

fn check_formulation(body: &Body) -> Result<(), Error> {
    let mut cells = body.mesh.cells();
    if body.formulation == Formulation::Standard || cells.any(|cell| body.has_modes(cell.kind)) {
        return Ok(());
    }
    Err(Error::NotAccepted {
        place: format!("{}: formulation", body.name),
        found: "incompatible modes on a mesh without cells of four or eight nodes that have them"
            .to_owned(),
        accepted: "them on a mesh with quad4 or hex8; quadratic cells bend without them".to_owned(),
    })
}

fn check_nodes(body: &Body) -> Result<(), Error> {
    let axis = Axis::of(body);
    for (node, position) in body.mesh.nodes.iter().enumerate() {
        let place = || format!("{}: node {node}", body.name);
        check_vector(body, place, position)?;
        if position[0] < 0.0 && axis.is_some_and(|axis| !axis.holds(*position)) {
            return Err(Error::OutOfRange {
                place: format!("{}[0]", place()),
                value: position[0],
                accepted: "a radius x >= 0, for the body is axisymmetric",
            });
        }
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
/// That of a bilinear quadrilateral is linear, so its corners decide; that of hexahedra and
/// quadratic cells is also taken at the quadrature points, where the stiffness needs it.
struct CornerPoints {
    points: Vec<(CellKind, Vec<Point>)>,
}

impl CornerPoints {
    fn new() -> Self {
        let points = CellKind::all().map(|kind| {
            let cell = kind.reference();
            let nodes = cell.nodes.iter().flat_map(|at| cell.ways_to(*at));
            let nodes = nodes.map(|at| Point::at(cell, at, 0.0));
            let nodes = nodes.take(if kind.has_constant_strain() {
                0
            } else {
                usize::MAX
            });
            (kind, nodes.chain(cell.rule.iter().cloned()).collect())
        });
        Self {
            points: points.collect(),
        }
    }

    /// Least `det J / (‖t_1‖ ‖t_2‖ ‖t_3‖)`, 1 at right angles whatever the aspect ratio.
    fn smallest_jacobian(&self, mesh: &Mesh, cell: Cell<'_>) -> f64 {
        let positions = positions(mesh, cell.nodes);
        let normalised = |point: &Point| {
            let [t1, t2, t3] = point.tangents(mesh.dimension, &positions);
            let unit = |t: Vector3<f64>| t.try_normalize(0.0).unwrap_or_default();
            unit(t1).dot(&unit(t2).cross(&unit(t3)))
        };
        let of_kind = self.points.iter().filter(|(kind, _)| *kind == cell.kind);
        let points = of_kind.flat_map(|(_, points)| points);
        points.map(normalised).fold(1.0, f64::min)
    }
}

/// Cells whose corners meet must also share the nodes between them.
fn check_neighbours(body: &Body) -> Result<(), Error> {
    let mesh = &body.mesh;
    if mesh.cells().all(|cell| cell.kind.is_linear()) {
        return Ok(());
    }
    let mut met = HashMap::new();
    for facet in mesh.boundary_facets() {
        let mut corners = facet.corners(mesh.dimension).to_vec();
        corners.sort_unstable();
        let order = facet.is_quadratic(mesh.dimension);
        let nodes = format!("{:?}", facet.nodes);
        if let Some((before, quadratic)) = met.insert(corners, (nodes.clone(), order)) {
            let kinds = if quadratic == order {
                ""
            } else {
                ", one linear and one quadratic"
            };
            return Err(Error::NotAccepted {
                place: format!("{}: cells", body.name),
                found: format!("neighbours with the facets {before} and {nodes}{kinds}"),
                accepted: "neighbours that share all nodes of their facet".to_owned(),
            });
        }
    }
    Ok(())
}

/// A quadrilateral between cells must not be two triangles on its other side.
fn check_split_faces(body: &Body) -> Result<(), Error> {
    let mesh = &body.mesh;
    // Tetrahedra have triangles alone, hexahedra none.
    let all = |corners: usize| mesh.cells().all(|cell| cell.kind.corner_count() == corners);
    if mesh.dimension == 2 || all(4) || all(8) {
        return Ok(());
    }
    let facets = mesh.boundary_facets();
    let corners = |facet: &Facet| {
        let mut corners = facet.corners(3).to_vec();
        corners.sort_unstable();
        corners
    };
    let three: HashSet<Vec<usize>> = facets
        .iter()
        .map(corners)
        .filter(|c| c.len() == 3)
        .collect();
    for facet in facets.iter().map(corners).filter(|c| c.len() == 4) {
        for left_out in 0..4 {
            let mut part = facet.clone();
            part.remove(left_out);
            if three.contains(&part) {
                return Err(Error::NotAccepted {
                    place: format!("{}: cells", body.name),
                    found: format!("a face with the corners {facet:?} beside one with {part:?}"),
                    accepted: "neighbours that share all nodes of their facet: a pyramid goes between a quadrilateral \
                               and triangles"
                        .to_owned(),
                });
            }
        }
    }
    Ok(())
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::tests::samples::{assert_says, complaint, facets};
    use crate::body::{Load, Material, Model, Support};

    #[test]
    fn a_sound_body_passes() {
        for kind in CellKind::all() {
            let sound = |body: &mut Body| {
                let facets = facets(&body.mesh, "top");
                body.loads = vec![Load::Pressure {
                    facets,
                    pressure: 1.0,
                }];
            };
            assert_eq!(complaint(kind, sound), "");
        }
    }

    #[test]
    fn a_cell_turned_inside_out_is_named_with_its_place_and_volume() {
        // Mirrored at x = 0 every cell is inside out, and the first is named.
        for kind in CellKind::all() {
            let mirror = |body: &mut Body| body.mesh.nodes.iter_mut().for_each(|x| x[0] = -x[0]);
            assert_says(kind, mirror, &["block: cell 0 at (-", "signed volume -"]);
        }
    }

    #[test]
    fn a_flat_cell_is_refused_whatever_its_aspect() {
        for kind in CellKind::all() {
            let axis = kind.dimension() - 1;
            let flatten = |body: &mut Body| body.mesh.nodes.iter_mut().for_each(|x| x[axis] = 0.0);
            assert_says(kind, flatten, &["cell 0 at", "flat"]);
            let thin = |body: &mut Body| body.mesh.nodes.iter_mut().for_each(|x| x[axis] *= 1e-9);
            assert_eq!(complaint(kind, thin), "");
        }
    }

    #[test]
    fn a_quadrilateral_with_a_reentrant_corner_is_folded_though_its_volume_is_positive() {
        // Corner (1, 1) of the unit square moved to (0.4, 0.4): area 0.4, corner angle above 180°.
        let fold = |body: &mut Body| {
            let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.4, 0.4, 0.0], [0.0, 1.0, 0.0]];
            body.mesh = Mesh::new(2, corners.to_vec());
            body.mesh.push_cell(CellKind::Quad4, &[0, 1, 2, 3]);
            body.material_of_cell = vec![0];
        };
        assert_says(
            CellKind::Quad4,
            fold,
            &["cell 0", "folded", "signed volume 4e-1"],
        );
    }

    #[test]
    fn a_quadratic_cell_beside_a_linear_one_is_refused() {
        // Two squares with the side x = 1 in common, of which one has a node in its middle.
        let beside = |body: &mut Body| {
            let edge = |kind: CellKind, x: f64| {
                let nodes = kind.reference().nodes.iter();
                nodes.map(move |at| [x + at[0] / 2.0, at[1] / 2.0, 0.0])
            };
            let mut nodes: Vec<[f64; 3]> = edge(CellKind::Quad8, 0.5).collect();
            nodes.extend([[2.0, -0.5, 0.0], [2.0, 0.5, 0.0]]);
            body.mesh = Mesh::new(2, nodes);
            body.mesh
                .push_cell(CellKind::Quad8, &[0, 1, 2, 3, 4, 5, 6, 7]);
            body.mesh.push_cell(CellKind::Quad4, &[1, 8, 9, 2]);
            body.material_of_cell = vec![0; 2];
        };
        assert_says(CellKind::Quad4, beside, &["neighbours", "one linear"]);
    }

    #[test]
    fn a_face_of_a_prism_beside_that_of_a_hexahedron_must_have_its_corners() {
        let above = |kinds: [CellKind; 2]| {
            move |body: &mut Body| {
                let line = [0.0, 1.0];
                let kind = |[_, _, k]: [usize; 3]| kinds[k];
                body.mesh = crate::body::mixed_box(&line, &line, &[0.0, 1.0, 2.0], kind)
                    .unwrap_or_default();
                body.material_of_cell = vec![0; body.mesh.cell_count()];
            }
        };
        let [hexahedra, prisms] = [CellKind::Hex8, CellKind::Prism6];
        assert_says(
            CellKind::Hex8,
            above([hexahedra, prisms]),
            &["a face with the corners", "pyramid"],
        );
        assert_says(
            CellKind::Hex8,
            above([prisms, CellKind::Pyramid5]),
            &["pyramid"],
        );
        for sound in [
            [hexahedra, CellKind::Pyramid5],
            [prisms, CellKind::Tet4],
            [prisms; 2],
        ] {
            assert_eq!(complaint(CellKind::Hex8, above(sound)), "");
        }
    }

    #[test]
    fn the_apex_of_a_pyramid_may_not_be_folded() {
        // The node half way up moved to three quarters and beyond: the Jacobian at the apex vanishes and turns.
        let shift = |to: f64| {
            move |body: &mut Body| {
                let nodes = CellKind::Pyramid13.reference().nodes.to_vec();
                body.mesh = Mesh::new(3, nodes);
                body.mesh.nodes[7] = [to - 1.0, to - 1.0, to];
                body.mesh
                    .push_cell(CellKind::Pyramid13, &(0..13).collect::<Vec<_>>());
                body.material_of_cell = vec![0];
            }
        };
        assert_eq!(complaint(CellKind::Hex8, shift(0.6)), "");
        assert_says(CellKind::Hex8, shift(0.8), &["cell 0", "folded"]);
    }

    #[test]
    fn a_node_between_corners_that_folds_its_cell_is_refused() {
        // Moved from the middle of a side to beyond its end.
        let shift = |body: &mut Body| {
            let cell = body.mesh.cell(0).nodes.to_vec();
            let end = body.mesh.nodes[cell[1]];
            body.mesh.nodes[cell[4]] = [end[0] + 0.1, end[1], 0.0];
        };
        assert_says(CellKind::Quad9, shift, &["cell 0", "folded"]);
    }

    #[test]
    fn numbers_that_are_not_numbers_are_found_everywhere() {
        let kind = CellKind::Hex8;
        assert_says(
            kind,
            |b| b.mesh.nodes[3][1] = f64::NAN,
            &["block: node 3[1]", "NaN"],
        );
        assert_says(
            kind,
            |b| b.materials[0].young = f64::NAN,
            &["materials[0].young"],
        );
        let support = Support::new("supports[0]", vec![0], [None, Some(f64::INFINITY), None]);
        assert_says(
            kind,
            |b| b.supports = vec![support.clone()],
            &["supports[0].displacement[1]", "inf"],
        );
        let force = [0.0, 0.0, f64::NAN];
        let load = Load::PointForce { node: 0, force };
        assert_says(
            kind,
            |b| b.loads = vec![load.clone()],
            &["loads[0].force[2]", "NaN"],
        );
    }

    #[test]
    fn nodes_cells_and_materials_that_do_not_exist_are_named() {
        let kind = CellKind::Quad4;
        let exists = "does not exist";
        assert_says(
            kind,
            |b| b.material_of_cell[2] = 7,
            &["cell 2", "material 7", exists],
        );
        assert_says(
            kind,
            |b| b.mesh.push_cell(CellKind::Tri3, &[0, 1, 99]),
            &["material_of_cell"],
        );
        let cell = |b: &mut Body| {
            b.mesh.push_cell(CellKind::Tri3, &[0, 1, 99]);
            b.material_of_cell.push(0);
        };
        assert_says(kind, cell, &["cell 8", "node 99", exists, "less than 15"]);
        let force = Load::PointForce {
            node: 99,
            force: [1.0, 0.0, 0.0],
        };
        assert_says(
            kind,
            |b| b.loads = vec![force.clone()],
            &["loads[0]", "node 99", exists],
        );
        let weight = Load::BodyForce {
            cells: vec![8],
            density: [1.0, 0.0, 0.0],
        };
        assert_says(
            kind,
            |b| b.loads = vec![weight.clone()],
            &["loads[0]", "cell 8", exists],
        );
    }

    #[test]
    fn cells_must_fit_their_kind_and_the_dimension() {
        let push = |b: &mut Body, kind, nodes: &[usize]| {
            b.mesh.push_cell(kind, nodes);
            b.material_of_cell.push(0);
        };
        let short = |b: &mut Body| push(b, CellKind::Quad4, &[0, 1, 2]);
        assert_says(
            CellKind::Quad4,
            short,
            &["cell 8 (quad4)", "expected 4", "found 3"],
        );
        let solid = |b: &mut Body| push(b, CellKind::Tet4, &[0, 1, 5, 6]);
        assert_says(
            CellKind::Quad4,
            solid,
            &["cell 8 (tet4)", "dimension 3", "expected 2"],
        );
        assert_says(
            CellKind::Quad4,
            |b| b.model = Model::Solid,
            &["mesh", "expected 3"],
        );
        assert_says(
            CellKind::Quad4,
            |b| b.mesh = Mesh::new(2, vec![]),
            &["cells: empty"],
        );
        assert_says(
            CellKind::Quad4,
            |b| b.mesh.nodes[4][2] = 0.1,
            &["node 4[2]", "plane"],
        );
    }

    #[test]
    fn a_node_of_no_cell_is_named_with_its_position() {
        let add = |b: &mut Body| b.mesh.nodes.push([7.0, 8.0, 0.0]);
        assert_says(
            CellKind::Tri3,
            add,
            &["block: node 15", "7.0", "8.0", "belongs to no cell"],
        );
    }

    #[test]
    fn impossible_materials_are_refused_by_name() {
        let set = |poisson| move |b: &mut Body| b.materials[0] = Material::new(1.0, poisson);
        assert_says(
            CellKind::Tri3,
            set(0.5),
            &["block: materials[0].poisson: 0.5", "< 0.5"],
        );
        let plate = |b: &mut Body| b.model = Model::PlaneStress { thickness: 0.0 };
        assert_says(CellKind::Tri3, plate, &["model.thickness"]);
    }
}
