//! Where a body's mesh comes from: a file, a generator, or the calling code.

use std::path::{Path, PathBuf};
use std::slice::from_ref;

use serde::{Deserialize, Deserializer, Serialize, de};

use super::{read, selection};
use crate::body::{CellKind, Mesh, box_mesh, graded, rectangle};
use crate::error::Error;
use crate::mesh_file;

/// Most nodes of all bodies together: beyond it a slip of the pen would fill the memory.
pub(super) const MOST_NODES: usize = 20_000_000;

/// Where a body's mesh comes from.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "cli", schemars(untagged, deny_unknown_fields))]
#[serde(untagged)]
pub enum MeshSource {
    /// A file of Gmsh (MSH 2.2 or 4.1), VTK (`.vtu`) or Abaqus (`.inp`, of which only the mesh is read).
    File {
        /// Its name, relative to the scene's folder.
        file: PathBuf,
        /// Factor on all positions, such as 0.001 for a mesh in mm; 1 when left out.
        #[cfg_attr(feature = "cli", schemars(default = "one", extend("exclusiveMinimum" = 0)))]
        scale: f64,
        /// Groups of cells that the body is made of, as of one part of an assembly; all cells when left out.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        #[cfg_attr(feature = "cli", schemars(default))]
        groups: Vec<String>,
        /// Group of cells that is cut free from all others, so that it can touch them: nodes that both have
        /// are doubled, and the facets between them become groups `NAME.own` and `NAME.other`.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[cfg_attr(feature = "cli", schemars(default))]
        split: Option<String>,
    },
    /// A rectangle of quadrilaterals or triangles.
    Rectangle {
        /// Its extent and cells.
        rectangle: Rectangle,
    },
    /// A box of hexahedra or tetrahedra.
    Box {
        /// Its extent and cells.
        #[serde(rename = "box")]
        solid: BoxMesh,
    },
    /// A mesh that the calling code built.
    #[serde(skip_serializing)]
    #[cfg_attr(feature = "cli", schemars(skip))]
    Given(Mesh),
}

/// A rectangle. Groups: `left`, `right`, `bottom`, `top`, and `body` for all cells.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, expecting = "an object with x, y and cells")]
pub struct Rectangle {
    /// Smallest and largest x, in the unit of length.
    pub x: [f64; 2],
    /// Smallest and largest y, in the unit of length.
    pub y: [f64; 2],
    /// Number of cells along x and y.
    pub cells: [usize; 2],
    /// Length of the last cell over that of the first, along x and y.
    #[serde(default = "uniform::<2>")]
    pub grading: [f64; 2],
    /// Kind of the cells.
    #[serde(default)]
    pub cell: PlaneCell,
}

/// A box. Groups: `left`, `right` (x), `front`, `back` (y), `bottom`, `top` (z), and `body`
/// for all cells.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, expecting = "an object with x, y, z and cells")]
pub struct BoxMesh {
    /// Smallest and largest x, in the unit of length.
    pub x: [f64; 2],
    /// Smallest and largest y, in the unit of length.
    pub y: [f64; 2],
    /// Smallest and largest z, in the unit of length.
    pub z: [f64; 2],
    /// Number of cells along x, y and z.
    pub cells: [usize; 3],
    /// Length of the last cell over that of the first, along x, y and z.
    #[serde(default = "uniform::<3>")]
    pub grading: [f64; 3],
    /// Kind of the cells.
    #[serde(default)]
    pub cell: SolidCell,
}

/// Cells of a rectangle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum PlaneCell {
    /// Bilinear quadrilaterals.
    #[default]
    Quad4,
    /// Triangles of constant strain.
    Tri3,
    /// Quadratic quadrilaterals of eight nodes.
    Quad8,
    /// Biquadratic quadrilaterals of nine nodes.
    Quad9,
    /// Quadratic triangles.
    Tri6,
}

/// Cells of a box.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum SolidCell {
    /// Trilinear hexahedra.
    #[default]
    Hex8,
    /// Tetrahedra of constant strain.
    Tet4,
    /// Quadratic hexahedra of twenty nodes.
    Hex20,
    /// Triquadratic hexahedra of 27 nodes.
    Hex27,
    /// Quadratic tetrahedra.
    Tet10,
    /// Linear prisms, two per block along z.
    Prism6,
    /// Quadratic prisms.
    Prism15,
    /// Linear pyramids, six per block.
    Pyramid5,
    /// Quadratic pyramids.
    Pyramid13,
}

impl From<Mesh> for MeshSource {
    fn from(mesh: Mesh) -> Self {
        Self::Given(mesh)
    }
}

impl From<Rectangle> for MeshSource {
    fn from(rectangle: Rectangle) -> Self {
        Self::Rectangle { rectangle }
    }
}

impl From<BoxMesh> for MeshSource {
    fn from(solid: BoxMesh) -> Self {
        Self::Box { solid }
    }
}

fn one() -> f64 {
    1.0
}

fn uniform<const AXES: usize>() -> [f64; AXES] {
    [1.0; AXES]
}

/// The keys of a mesh in JSON; which of them stand there tells the source.
#[derive(Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "an object with file, rectangle or box"
)]
struct Keys {
    file: Option<PathBuf>,
    scale: Option<f64>,
    groups: Option<Vec<String>>,
    split: Option<String>,
    rectangle: Option<Rectangle>,
    r#box: Option<BoxMesh>,
}

impl<'de> Deserialize<'de> for MeshSource {
    fn deserialize<D: Deserializer<'de>>(source: D) -> Result<Self, D::Error> {
        let keys = Keys::deserialize(source)?;
        let of_file = keys.scale.is_some() || keys.groups.is_some() || keys.split.is_some();
        match (keys.file, of_file, keys.rectangle, keys.r#box) {
            (Some(_), ..) if keys.groups.as_ref().is_some_and(Vec::is_empty) => Err(
                de::Error::custom("expected at least one group of cells in `groups`"),
            ),
            (Some(file), _, None, None) => Ok(Self::File {
                file,
                scale: keys.scale.unwrap_or(one()),
                groups: keys.groups.unwrap_or_default(),
                split: keys.split,
            }),
            (None, false, Some(rectangle), None) => Ok(Self::Rectangle { rectangle }),
            (None, false, None, Some(solid)) => Ok(Self::Box { solid }),
            _ => Err(de::Error::custom(
                "expected exactly one of `file` (with or without `scale`, `groups` and `split`), `rectangle` and `box`",
            )),
        }
    }
}

impl MeshSource {
    /// Reads, generates or copies the mesh, of at most `room` nodes; files are relative to `folder`.
    pub(super) fn mesh(&self, place: &str, folder: &Path, room: usize) -> Result<Mesh, Error> {
        match self {
            Self::File {
                file,
                scale,
                groups,
                split,
            } => {
                let mut mesh = from_file(place, &folder.join(file), *scale)?;
                if !groups.is_empty() {
                    mesh = part(&mesh, &format!("{place}.groups"), groups)?;
                }
                if let Some(group) = split {
                    mesh.split(group).map_err(|error| error.within(place))?;
                }
                let place = || format!("{place}.file");
                check_room(
                    place,
                    mesh.nodes.len().to_string(),
                    mesh.nodes.len() <= room,
                )?;
                Ok(mesh)
            }
            Self::Rectangle { rectangle: shape } => {
                let place = format!("{place}.rectangle");
                let kind = match shape.cell {
                    PlaneCell::Quad4 => CellKind::Quad4,
                    PlaneCell::Tri3 => CellKind::Tri3,
                    PlaneCell::Quad8 => CellKind::Quad8,
                    PlaneCell::Quad9 => CellKind::Quad9,
                    PlaneCell::Tri6 => CellKind::Tri6,
                };
                let axes = [("x", shape.x), ("y", shape.y)];
                let [xs, ys] = coordinates(&place, axes, shape.cells, shape.grading, room)?;
                rectangle(&xs, &ys, kind).map_err(|error| error.within(place))
            }
            Self::Box { solid: shape } => {
                let place = format!("{place}.box");
                let kind = match shape.cell {
                    SolidCell::Hex8 => CellKind::Hex8,
                    SolidCell::Tet4 => CellKind::Tet4,
                    SolidCell::Hex20 => CellKind::Hex20,
                    SolidCell::Hex27 => CellKind::Hex27,
                    SolidCell::Tet10 => CellKind::Tet10,
                    SolidCell::Prism6 => CellKind::Prism6,
                    SolidCell::Prism15 => CellKind::Prism15,
                    SolidCell::Pyramid5 => CellKind::Pyramid5,
                    SolidCell::Pyramid13 => CellKind::Pyramid13,
                };
                let axes = [("x", shape.x), ("y", shape.y), ("z", shape.z)];
                let [xs, ys, zs] = coordinates(&place, axes, shape.cells, shape.grading, room)?;
                box_mesh(&xs, &ys, &zs, kind).map_err(|error| error.within(place))
            }
            Self::Given(mesh) => {
                check_given(place, mesh)?;
                Ok(mesh.clone())
            }
        }
    }
}

/// Refuses a mesh on which facets and vectors could not even be looked up.
fn check_given(place: &str, mesh: &Mesh) -> Result<(), Error> {
    if !(2..=3).contains(&mesh.dimension) {
        return Err(Error::OutOfRange {
            place: format!("{place}.dimension"),
            value: mesh.dimension as f64,
            accepted: "2 or 3",
        });
    }
    for (at, cell) in mesh.cells().enumerate() {
        let (expected, found) = (cell.kind.node_count(), cell.nodes.len());
        if expected != found {
            return Err(Error::Length {
                place: format!("{place}: cell {at}"),
                expected,
                found,
            });
        }
    }
    Ok(())
}

/// The cells of some groups.
fn part(mesh: &Mesh, place: &str, groups: &[String]) -> Result<Mesh, Error> {
    let mut cells = Vec::new();
    for (at, group) in groups.iter().enumerate() {
        let place = format!("{place}[{at}]");
        cells.extend(selection::cells(mesh, &place, from_ref(group))?);
    }
    Ok(mesh.part(&cells))
}

fn from_file(place: &str, path: &Path, scale: f64) -> Result<Mesh, Error> {
    if !(scale > 0.0 && scale.is_finite()) {
        return Err(Error::OutOfRange {
            place: format!("{place}.scale"),
            value: scale,
            accepted: "0 < scale < infinity",
        });
    }
    let place = format!("{place}.file");
    let bytes = read(&place, path)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let include = |name: &str| read("*INCLUDE", &folder.join(name));
    let mut mesh = mesh_file::parse(&bytes, &path.display().to_string(), &include)
        .map_err(|error| error.within(place))?;
    for position in &mut mesh.nodes {
        *position = position.map(|coordinate| coordinate * scale);
    }
    Ok(mesh)
}

/// Refuses a mesh that has no room beside those of the bodies before it.
fn check_room(place: impl Fn() -> String, found: String, fits: bool) -> Result<(), Error> {
    match fits {
        true => Ok(()),
        false => Err(Error::NotAccepted {
            place: place(),
            found,
            accepted: format!("at most {MOST_NODES} nodes in all bodies together"),
        }),
    }
}

/// Positions of the grid lines along each axis.
fn coordinates<const AXES: usize>(
    place: &str,
    axes: [(&str, [f64; 2]); AXES],
    cells: [usize; AXES],
    grading: [f64; AXES],
    room: usize,
) -> Result<[Vec<f64>; AXES], Error> {
    let nodes = cells.iter().try_fold(1_usize, |nodes, &count| {
        nodes.checked_mul(count.checked_add(1)?)
    });
    check_room(
        || format!("{place}.cells"),
        format!("{cells:?}"),
        nodes.is_some_and(|nodes| nodes <= room),
    )?;
    let mut lines = std::array::from_fn(|_| Vec::new());
    for (at, (axis, [start, end])) in axes.into_iter().enumerate() {
        lines[at] = graded(start, end, cells[at], grading[at])
            .map_err(|error| error.within(format_args!("{place}, axis {axis}")))?;
    }
    Ok(lines)
}
