//! VTU files: unstructured grids as ParaView, meshio and their kin write them.
//!
//! ```text
//! VTKFile → UnstructuredGrid → Piece → Points, Cells, PointData, CellData   (AppendedData behind them)
//! ```
//!
//! Numbers may be ASCII, base64 inline, or appended, raw or in base64; plain or compressed by zlib. Cells
//! of the highest dimension are the cells of the mesh; those below them describe its surface. Whole
//! numbers per cell or point are its groups:
//!
//! | array | groups |
//! |---|---|
//! | `gmsh:physical` | `5` for the number 5; none for 0 |
//! | `left-right`, numbers −1, 0, 1, as meshio joins the names of sets | `left` for 0, `right` for 1; none for −1 |
//! | `left`, numbers −1 and 0 | `left` for 0 |
//! | `material` | `material:2` for the number 2 |
//!
//! A name used in several dimensions gets the dimension appended, as from Gmsh. Arrays that only number
//! things (more than 1000 values, or a name of VTK's or Gmsh's own) make no groups. Format: VTK's file
//! formats, "XML file formats".

mod arrays;
mod cells;
mod sets;

use roxmltree::{Document, Node};

use super::assemble;
use super::elements::{Gathered, Listed, Shape};
use crate::body::Mesh;
use crate::error::Error;
use arrays::{Arrays, Values};
pub(crate) use cells::vtk_kind;

/// Reads a mesh; `name` stands for the file in messages.
///
/// # Errors
///
/// [`Error::Mesh`] with the line: broken XML, another kind of data than an unstructured grid, several
/// pieces, a compressor other than zlib, arrays that are cut off or of another length than announced, a
/// cell that is neither linear nor quadratic, a node that is not there, no cell at all.
pub fn parse(bytes: &[u8], name: &str) -> Result<Mesh, Error> {
    let (text, appended) = arrays::split(bytes, name)?;
    let document = Document::parse(&text).map_err(|error| Error::Mesh {
        file: name.to_owned(),
        line: error.pos().row as usize,
        reason: format!("no XML as of a VTU file: {error}"),
    })?;
    let grid = Grid {
        name,
        root: document.root_element(),
        appended,
    };
    grid.mesh()
}

/// Shapes of the cells, where the nodes of each end, and all nodes.
struct Cells {
    shapes: Vec<Shape>,
    ends: Vec<usize>,
    nodes: Vec<usize>,
}

/// A file as a tree, and the bytes behind it.
struct Grid<'a> {
    name: &'a str,
    root: Node<'a, 'a>,
    appended: Option<arrays::Appended<'a>>,
}

impl<'a> Grid<'a> {
    fn error(&self, node: Node<'_, '_>, reason: impl Into<String>) -> Error {
        let at = node.document().text_pos_at(node.range().start);
        Error::Mesh {
            file: self.name.to_owned(),
            line: at.row as usize,
            reason: reason.into(),
        }
    }

    fn child(&self, node: Node<'a, 'a>, tag: &str) -> Result<Node<'a, 'a>, Error> {
        let mut found = node.children().filter(|child| child.has_tag_name(tag));
        match (found.next(), found.next()) {
            (Some(child), None) => Ok(child),
            (None, _) => Err(self.error(node, format!("expected `<{tag}>` inside"))),
            (_, Some(second)) => Err(self.error(
                second,
                format!(
                    "a second `<{tag}>`; expected one (in ParaView: merge blocks and clean to grid)"
                ),
            )),
        }
    }

    fn count(&self, node: Node<'_, '_>, key: &str) -> Result<usize, Error> {
        let stated = node.attribute(key).unwrap_or_default();
        let number = stated.trim().parse().ok();
        number
            .filter(|&number| number < u32::MAX as usize)
            .ok_or_else(|| {
                self.error(
                    node,
                    format!(
                        "`{key}` is `{}`; expected a whole number",
                        arrays::quote(stated)
                    ),
                )
            })
    }

    fn mesh(&self) -> Result<Mesh, Error> {
        let kind = self.root.attribute("type").unwrap_or("nothing");
        if !self.root.has_tag_name("VTKFile") || kind != "UnstructuredGrid" {
            return Err(self.error(
                self.root,
                format!(
                    "`<{}>` of type {}; expected `<VTKFile>` of type UnstructuredGrid",
                    self.root.tag_name().name(),
                    arrays::quote(kind)
                ),
            ));
        }
        let arrays = Arrays::new(self)?;
        let piece = self.child(self.child(self.root, "UnstructuredGrid")?, "Piece")?;
        let points = self.count(piece, "NumberOfPoints")?;
        let cells = self.count(piece, "NumberOfCells")?;
        let positions = self.positions(&arrays, piece, points)?;
        let listed = self.child(piece, "Cells")?;
        let Cells {
            shapes,
            ends,
            nodes,
        } = self.cells(&arrays, listed, cells, points)?;
        let mut gathered = Gathered::default();
        let of_cells = self.sets(&arrays, piece, "CellData", cells, &mut gathered)?;
        let of_points = self.sets(&arrays, piece, "PointData", points, &mut gathered)?;
        let mut start = 0;
        for (at, (shape, end)) in shapes.into_iter().zip(ends).enumerate() {
            let ordered = cells::mesh_nodes(shape, &nodes[start..end]);
            gathered.push(at, shape, &ordered, sets::of_entry(&of_cells, at));
            start = end;
        }
        for point in 0..points {
            let sets = sets::of_entry(&of_points, point);
            if !sets.is_empty() {
                gathered.push(point, Shape::Point, &[point], sets);
            }
        }
        let places = Listed {
            file: self.name,
            line: listed.document().text_pos_at(listed.range().start).row as usize,
            what: "cell",
        };
        assemble::mesh(&gathered.contents(&positions, &places)?, false, &places)
    }

    fn positions(
        &self,
        arrays: &Arrays<'_>,
        piece: Node<'a, 'a>,
        points: usize,
    ) -> Result<Vec<[f64; 3]>, Error> {
        let array = self.child(self.child(piece, "Points")?, "DataArray")?;
        let values = arrays.read(self, array, 3 * points)?.reals();
        let broken = values.iter().position(|value| !value.is_finite());
        if values.len() != 3 * points || broken.is_some() {
            let found = match broken {
                Some(at) => format!("point {} at {}", at / 3, values[at]),
                None => format!("{} coordinates", values.len()),
            };
            let expected = format!("expected {} finite ones", 3 * points);
            return Err(self.error(array, format!("{found}; {expected}")));
        }
        let (positions, _) = values.as_chunks::<3>();
        Ok(positions.to_vec())
    }

    fn cells(
        &self,
        arrays: &Arrays<'_>,
        listed: Node<'a, 'a>,
        cells: usize,
        points: usize,
    ) -> Result<Cells, Error> {
        let array = |name: &str, most: usize| {
            let mut found = listed.children();
            let found = found.find(|child| child.attribute("Name") == Some(name));
            let found = found.ok_or_else(|| {
                self.error(
                    listed,
                    format!("expected a `<DataArray>` named `{name}` inside"),
                )
            })?;
            Ok::<_, Error>((found, self.indices(arrays, found, most)?))
        };
        let (kinds_at, kinds) = array("types", cells)?;
        let (ends_at, ends) = array("offsets", cells)?;
        let (nodes_at, nodes) = array("connectivity", 64 * cells)?;
        for (at, found) in [(kinds_at, kinds.len()), (ends_at, ends.len())] {
            if found != cells {
                return Err(self.error(at, format!("{found} numbers; expected {cells}")));
            }
        }
        if let Some(&missing) = nodes.iter().find(|&&node| node >= points) {
            return Err(self.error(nodes_at, format!("point {missing} of {points}")));
        }
        let (mut start, mut shapes) = (0_usize, Vec::with_capacity(cells));
        for (at, (&kind, &end)) in kinds.iter().zip(&ends).enumerate() {
            let (shape, count) = cells::shape(kind)
                .map_err(|reason| self.error(kinds_at, format!("cell {at}: {reason}")))?;
            if start.checked_add(count) != Some(end) || end > nodes.len() {
                return Err(self.error(
                    ends_at,
                    format!("cell {at} of kind {kind} ends at node {end}; expected {count} nodes from {start}"),
                ));
            }
            start = end;
            shapes.push(shape);
        }
        Ok(Cells {
            shapes,
            ends,
            nodes,
        })
    }

    fn indices(
        &self,
        arrays: &Arrays<'_>,
        array: Node<'_, '_>,
        most: usize,
    ) -> Result<Vec<usize>, Error> {
        let Values::Whole(values) = arrays.read(self, array, most)? else {
            return Err(self.error(array, "real numbers; expected whole ones"));
        };
        let wrong = values.iter().find(|value| **value < 0);
        match wrong {
            Some(value) => Err(self.error(array, format!("{value}; expected no number below 0"))),
            None => Ok(values.into_iter().map(|value| value as usize).collect()),
        }
    }

    /// The sets that whole numbers per entry make.
    fn sets(
        &self,
        arrays: &Arrays<'_>,
        piece: Node<'a, 'a>,
        tag: &str,
        entries: usize,
        gathered: &mut Gathered,
    ) -> Result<Vec<sets::Numbered>, Error> {
        let mut found = Vec::new();
        let section = piece.children().filter(|child| child.has_tag_name(tag));
        for array in section.flat_map(|section| section.children()) {
            let name = array.attribute("Name").unwrap_or_default();
            if !sets::may_group(name) || !arrays::is_whole(array) {
                continue;
            }
            let Values::Whole(values) = arrays.read(self, array, entries)? else {
                continue;
            };
            if values.len() != entries {
                let reason = format!("`{name}`: {} numbers; expected {entries}", values.len());
                return Err(self.error(array, reason));
            }
            found.extend(sets::numbered(name, values, |name| gathered.set(name)));
        }
        Ok(found)
    }
}
