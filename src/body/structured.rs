//! Structured meshes of rectangles and boxes.
//!
//! Their groups: facets `left` and `right` (least and greatest x), `bottom` and `top`
//! (y in 2D, z in 3D), in 3D also `front` and `back` (y), and the cells, `body`.
//!
//! Quadratic cells have straight sides, with their nodes half way.
//!
//! Simplices cut every quadrilateral along the same diagonal and every hexahedron into
//! the same six tetrahedra (Kuhn): that conforms for any counts, and all nodes inside a
//! face carry the same area. Alternating diagonals would give neighbours the shares 2:1,
//! and a uniform contact pressure would come out as uneven nodal forces.

use super::{CellKind, Group, Mesh};
use crate::error::{Error, check_finite};

/// Most cells that a generator makes; beyond this the input is taken for a slip of the pen.
const MOST_CELLS: usize = 50_000_000;

/// Sides of a box.
const SIDES: [(&str, &str); 3] = [("left", "right"), ("front", "back"), ("bottom", "top")];

/// The two triangles of a quadrilateral.
const TRIANGLES: [&[usize]; 2] = [&[0, 1, 2], &[0, 2, 3]];

/// The two prisms of a hexahedron.
const PRISMS: [&[usize]; 2] = [&[0, 1, 2, 4, 5, 6], &[0, 2, 3, 4, 6, 7]];

/// The six pyramids of a hexahedron, on its faces and with the apex in its middle.
const PYRAMIDS: [&[usize]; 6] = [
    &[0, 1, 2, 3, 26],
    &[4, 7, 6, 5, 26],
    &[0, 4, 5, 1, 26],
    &[1, 5, 6, 2, 26],
    &[2, 6, 7, 3, 26],
    &[3, 7, 4, 0, 26],
];

/// The six tetrahedra of a hexahedron, one per path from node 0 to node 6 along its edges.
const KUHN: [&[usize]; 6] = [
    &[0, 1, 2, 6],
    &[0, 5, 1, 6],
    &[0, 2, 3, 6],
    &[0, 3, 7, 6],
    &[0, 4, 5, 6],
    &[0, 7, 4, 6],
];

/// Coordinates of `count` cells between `start` and `end`, in metre, whose sizes grow
/// geometrically; `grading` is the size of the last cell over that of the first, 1 for equal cells.
///
/// # Errors
///
/// A bound that is not finite, `end <= start`, no cell or too many, a grading that is
/// not positive or so uneven that a cell has no size left.
pub fn graded(start: f64, end: f64, count: usize, grading: f64) -> Result<Vec<f64>, Error> {
    check_finite("start, end", &[start, end])?;
    let refuse = |place: &str, value, accepted| {
        let place = place.to_owned();
        Err(Error::OutOfRange {
            place,
            value,
            accepted,
        })
    };
    if end <= start {
        return refuse("end", end, "end > start");
    }
    if count == 0 || count > MOST_CELLS {
        return refuse("count", count as f64, "1 <= count <= 5e7");
    }
    if !(grading > 0.0 && grading.is_finite()) {
        return refuse("grading", grading, "grading > 0, finite");
    }
    let coordinates = geometric(start, end, count, grading);
    if coordinates.is_sorted_by(|a, b| a < b) {
        return Ok(coordinates);
    }
    refuse(
        "grading",
        grading,
        "a grading that leaves every cell a size",
    )
}

/// (x_i − start) / (end − start) = (qⁱ − 1) / (qⁿ − 1) with qⁿ⁻¹ the grading; i/n when q = 1.
fn geometric(start: f64, end: f64, count: usize, grading: f64) -> Vec<f64> {
    let growth = grading.ln() / (count.max(2) - 1) as f64;
    let fraction = |i: usize| {
        if count == 1 || growth == 0.0 {
            i as f64 / count as f64
        } else {
            // exp_m1 keeps the digits of q close to one.
            (growth * i as f64).exp_m1() / (growth * count as f64).exp_m1()
        }
    };
    let inner = (1..count).map(|i| start + (end - start) * fraction(i));
    std::iter::once(start).chain(inner).chain([end]).collect()
}

/// A rectangle with cells between the given coordinates, in metre.
///
/// # Errors
///
/// Coordinates that are not finite, not increasing or fewer than two; a kind that is not plane;
/// too many cells.
pub fn rectangle(xs: &[f64], ys: &[f64], kind: CellKind) -> Result<Mesh, Error> {
    if kind.dimension() != 2 {
        return Err(wrong_dimension(kind, 2));
    }
    check_axes(&[("x", xs), ("y", ys)])?;
    let axes = [xs, ys, &[0.0]];
    let mut mesh = cells(axes, &vec![kind; blocks(axes).count()]);
    name_groups(&mut mesh, &[("left", "right"), ("bottom", "top")]);
    Ok(mesh)
}

/// A box with cells between the given coordinates, in metre.
///
/// # Errors
///
/// Coordinates that are not finite, not increasing or fewer than two; a kind that is not solid;
/// too many cells.
pub fn box_mesh(xs: &[f64], ys: &[f64], zs: &[f64], kind: CellKind) -> Result<Mesh, Error> {
    mixed_box(xs, ys, zs, |_| kind)
}

/// A box whose blocks, numbered along x, y and z, are cut into cells of different kinds, all linear or all
/// quadratic. Prisms have triangles above and below, pyramids none on the surface of their block.
///
/// # Errors
///
/// As of [`box_mesh`]. Faces that do not fit are a matter of the body on the mesh.
pub fn mixed_box(
    xs: &[f64],
    ys: &[f64],
    zs: &[f64],
    kind: impl Fn([usize; 3]) -> CellKind,
) -> Result<Mesh, Error> {
    check_axes(&[("x", xs), ("y", ys), ("z", zs)])?;
    let axes = [xs, ys, zs];
    let of_blocks: Vec<CellKind> = blocks(axes).map(kind).collect();
    if let Some(plane) = of_blocks.iter().find(|kind| kind.dimension() != 3) {
        return Err(wrong_dimension(*plane, 3));
    }
    let mut mesh = cells(axes, &of_blocks);
    name_groups(&mut mesh, &SIDES);
    Ok(mesh)
}

/// The blocks between grid lines, x fastest; an axis of one line has one.
fn blocks(axes: [&[f64]; 3]) -> impl Iterator<Item = [usize; 3]> {
    let [nx, ny, nz] = axes.map(|axis| (axis.len() - 1).max(1));
    let row = move |j, k| (0..nx).map(move |i| [i, j, k]);
    (0..nz).flat_map(move |k| (0..ny).flat_map(move |j| row(j, k)))
}

/// The cells of blocks of one kind each.
fn cells(axes: [&[f64]; 3], of_blocks: &[CellKind]) -> Mesh {
    let lattice = Lattice::new(axes, of_blocks);
    let dimension = of_blocks.first().map_or(3, |kind| kind.dimension());
    let mut mesh = Mesh::new(dimension, lattice.positions());
    for (block, &kind) in blocks(axes).zip(of_blocks) {
        for corners in parts(kind) {
            mesh.push_cell(kind, &lattice.cell(block, kind, corners));
        }
    }
    mesh.drop_lone_nodes();
    mesh
}

/// Corners of the cells that share a quadrilateral or hexahedron, among its nodes.
fn parts(kind: CellKind) -> &'static [&'static [usize]] {
    match kind.linear() {
        CellKind::Tri3 => &TRIANGLES,
        CellKind::Tet4 => &KUHN,
        CellKind::Prism6 => &PRISMS,
        CellKind::Pyramid5 => &PYRAMIDS,
        CellKind::Quad4 => &[&[0, 1, 2, 3]],
        _ => &[&[0, 1, 2, 3, 4, 5, 6, 7]],
    }
}

/// The points where nodes may stand: those of the grid, for quadratic cells and for pyramids also half way.
struct Lattice {
    lines: [Vec<f64>; 3],
    /// Steps of the lattice per cell.
    steps: usize,
}

impl Lattice {
    fn new(axes: [&[f64]; 3], kinds: &[CellKind]) -> Self {
        let halved = |axis: &[f64]| {
            let pairs = axis.windows(2);
            let inner = pairs.flat_map(|pair| [(pair[0] + pair[1]) / 2.0, pair[1]]);
            axis.first().copied().into_iter().chain(inner).collect()
        };
        let any = |is: fn(&CellKind) -> bool| u32::from(kinds.iter().any(is));
        let halvings =
            any(|kind| !kind.is_linear()) + any(|kind| kind.linear() == CellKind::Pyramid5);
        let mut lines = axes.map(<[f64]>::to_vec);
        for _ in 0..halvings {
            lines = lines.map(|axis| halved(&axis));
        }
        Self {
            lines,
            steps: 1 << halvings,
        }
    }

    fn positions(&self) -> Vec<[f64; 3]> {
        let [xs, ys, zs] = &self.lines;
        let row = |y: f64, z: f64| xs.iter().map(move |x| [*x, y, z]);
        let layer = |z: f64| ys.iter().flat_map(move |y| row(*y, z));
        zs.iter().flat_map(|z| layer(*z)).collect()
    }

    /// Lattice points of a cell's nodes; `corners` are its own among the nodes of its block.
    fn cell(&self, block: [usize; 3], kind: CellKind, corners: &[usize]) -> Vec<usize> {
        let linear = kind.linear().reference();
        let within = |node: usize| {
            let mut within = [0.0; 3];
            for (shape, corner) in linear.shape(kind.position(node)).iter().zip(corners) {
                let corner = CellKind::Hex27.position(*corner);
                for (along, c) in within.iter_mut().zip(corner) {
                    *along += shape * (c + 1.0) / 2.0;
                }
            }
            within
        };
        let [row, column, _] = self.lines.each_ref().map(Vec::len);
        let number = |node: usize| {
            let within = within(node);
            // In the plane the third coordinate of a block means nothing.
            let [i, j, k] = std::array::from_fn(|axis| match axis < kind.dimension() {
                true => self.steps * block[axis] + (within[axis] * self.steps as f64) as usize,
                false => 0,
            });
            (k * column + j) * row + i
        };
        (0..kind.node_count()).map(number).collect()
    }
}

fn wrong_dimension(kind: CellKind, expected: usize) -> Error {
    Error::WrongDimension {
        place: format!("cell kind {}", kind.name()),
        expected,
        found: kind.dimension(),
    }
}

fn check_axes(axes: &[(&str, &[f64])]) -> Result<(), Error> {
    let mut cells = 1_usize;
    for (axis, coordinates) in axes {
        check_finite(axis, coordinates)?;
        if coordinates.len() < 2 {
            return Err(Error::OutOfRange {
                place: format!("count of {axis} coordinates"),
                value: coordinates.len() as f64,
                accepted: "at least 2",
            });
        }
        if let Some(at) = coordinates.windows(2).position(|pair| pair[1] <= pair[0]) {
            return Err(Error::OutOfRange {
                place: format!("{axis}[{}]", at + 1),
                value: coordinates[at + 1],
                accepted: "greater than the coordinate before it",
            });
        }
        cells = cells.saturating_mul(coordinates.len() - 1);
    }
    if cells > MOST_CELLS {
        return Err(Error::OutOfRange {
            place: "count of cells".to_owned(),
            value: cells as f64,
            accepted: "at most 5e7",
        });
    }
    Ok(())
}

/// Names the sides axis by axis, (least, greatest), and the cells.
///
/// Generated coordinates are copied, never computed, so a side is found by equality.
fn name_groups(mesh: &mut Mesh, sides: &[(&str, &str)]) {
    let boundary = mesh.boundary_facets();
    for (axis, (least, greatest)) in sides.iter().enumerate() {
        let at = |node: usize| mesh.nodes[node][axis];
        let last = mesh.nodes.len() - 1;
        let (start, end) = (at(0), at(last));
        let on = |bound: f64| {
            let touching = boundary
                .iter()
                .filter(|facet| facet.nodes.iter().all(|node| at(*node) == bound));
            Group::Facets(touching.cloned().collect())
        };
        let groups = [
            ((*least).to_owned(), on(start)),
            ((*greatest).to_owned(), on(end)),
        ];
        mesh.groups.extend(groups);
    }
    let cells = (0..mesh.cell_count()).collect();
    mesh.groups.insert("body".to_owned(), Group::Cells(cells));
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    fn facets<'a>(mesh: &'a Mesh, name: &str) -> &'a [crate::body::Facet] {
        match &mesh.groups[name] {
            Group::Facets(facets) => facets,
            other => unreachable!("{other:?}"),
        }
    }

    #[test]
    fn equal_cells_divide_the_interval_and_its_ends_are_exact() {
        assert_eq!(graded(1.0, 3.0, 4, 1.0).unwrap(), [1.0, 1.5, 2.0, 2.5, 3.0]);
    }

    #[test]
    fn the_last_cell_over_the_first_is_the_grading() {
        // Three cells, grading 4: sizes 1 : 2 : 4, so 7 splits into 1, 2, 4.
        let found = graded(0.0, 7.0, 3, 4.0).unwrap();
        for (x, expected) in found.iter().zip([0.0, 1.0, 3.0, 7.0]) {
            assert!((x - expected).abs() < 1e-14);
        }
    }

    #[test]
    fn intervals_without_cells_or_length_are_refused() {
        assert!(graded(0.0, 1.0, 0, 1.0).is_err());
        assert!(graded(0.0, 1.0, usize::MAX, 1.0).is_err());
        assert!(graded(1.0, 1.0, 3, 1.0).is_err());
        assert!(graded(0.0, f64::NAN, 3, 1.0).is_err());
        assert!(graded(0.0, 1.0, 3, -1.0).is_err());
        assert!(graded(1.0, 2.0, 3, 1e60).is_err());
    }

    #[test]
    fn coordinates_must_increase_and_fit_the_kind() {
        let xs = [0.0, 1.0];
        assert!(rectangle(&[0.0, 0.0], &xs, CellKind::Quad4).is_err());
        assert!(rectangle(&[0.0], &xs, CellKind::Quad4).is_err());
        assert!(rectangle(&xs, &[0.0, f64::INFINITY], CellKind::Quad4).is_err());
        assert!(rectangle(&xs, &xs, CellKind::Hex8).is_err());
        assert!(box_mesh(&xs, &xs, &xs, CellKind::Tri3).is_err());
    }

    #[test]
    fn cells_fill_the_box_and_sides_have_their_area_and_direction() {
        let (xs, ys, zs) = ([0.0, 1.0, 3.0], [0.0, 2.0], [-1.0, 0.0, 4.0]);
        for kind in CellKind::all() {
            let solid = kind.dimension() == 3;
            let mesh = if solid {
                box_mesh(&xs, &ys, &zs, kind).unwrap()
            } else {
                rectangle(&xs, &zs, kind).unwrap()
            };
            let volumes = (0..mesh.cell_count()).map(|cell| mesh.volume(cell));
            assert!(volumes.clone().all(|volume| volume > 0.0));
            let expected = if solid { 30.0 } else { 15.0 };
            assert!((volumes.sum::<f64>() - expected).abs() < 1e-12);

            // Areas: left, right 5 × 2 (2D 5), bottom, top 3 × 2 (2D 3), front, back 3 × 5.
            let depth = if solid { 2.0 } else { 1.0 };
            let up = if solid { 2 } else { 1 };
            let mut sides = vec![
                ("left", 0, -1.0, 5.0 * depth),
                ("right", 0, 1.0, 5.0 * depth),
            ];
            sides.extend([
                ("bottom", up, -1.0, 3.0 * depth),
                ("top", up, 1.0, 3.0 * depth),
            ]);
            if solid {
                sides.extend([("front", 1, -1.0, 15.0), ("back", 1, 1.0, 15.0)]);
            }
            for (name, axis, sign, area) in sides {
                let geometries = facets(&mesh, name).iter().map(|f| mesh.facet_geometry(f));
                assert!((geometries.clone().map(|g| g.area).sum::<f64>() - area).abs() < 1e-12);
                assert!(
                    geometries
                        .into_iter()
                        .all(|g| (g.normal[axis] - sign).abs() < 1e-15)
                );
            }
            assert_eq!(
                mesh.groups["body"],
                Group::Cells((0..mesh.cell_count()).collect())
            );
        }
    }
}
