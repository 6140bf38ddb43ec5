//! Meshes from arrays.

use std::fs;
use std::path::PathBuf;

use dpana::body::{self, CellKind, Facet, Group};
use dpana::mesh_file::gmsh;
use numpy::{AllowTypeChange, PyArray1, PyArray2, PyArrayLike1};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::arrays::{Numbers, Rows, indices, numbers, rows};
use super::error::{Error, refused};

/// Nodes, cells and named groups of a body.
///
/// Mesh(points, cells): `points` is (nodes, d) in the unit of length, d = 2 or 3; `cells` maps kinds
/// to node numbers from 0, (cells, nodes per cell) in Gmsh's order. Kinds: tri3, quad4, tri6, quad8,
/// quad9 in 2D, tet4, hex8, tet10, hex20, hex27, prism6,
/// prism15, pyramid5, pyramid13 in 3D. Nodes that no cell has are refused.
#[pyclass(module = "dpana", frozen, from_py_object)]
#[derive(Clone)]
pub(super) struct Mesh(pub(super) body::Mesh);

#[pymethods]
impl Mesh {
    #[new]
    fn new(points: Rows<'_>, cells: &Bound<'_, PyDict>) -> PyResult<Self> {
        let points = points.as_array();
        let dimension = points.ncols();
        if !(2..=3).contains(&dimension) {
            return Err(Error::new_err(format!(
                "points: {dimension} columns are not accepted; expected 2 or 3"
            )));
        }
        let nodes = points.outer_iter().map(|row| {
            let mut position = [0.0; 3];
            position
                .iter_mut()
                .zip(row)
                .for_each(|(x, &stated)| *x = stated);
            position
        });
        let mut mesh = body::Mesh::new(dimension, nodes.collect());
        for (name, of_kind) in cells {
            let name: String = name.extract()?;
            let of_kind: Rows<'_> = of_kind.extract()?;
            push_cells(&mut mesh, kind(&name, dimension)?, of_kind)?;
        }
        Ok(Self(mesh))
    }

    /// Reads a Gmsh file, MSH 2.2 or 4.1, ASCII or binary.
    #[staticmethod]
    fn read(path: PathBuf) -> PyResult<Self> {
        let file = path.display().to_string();
        let bytes = fs::read(&path).map_err(|reason| dpana::Error::Unreadable {
            place: "mesh".to_owned(),
            file: file.clone(),
            reason: reason.to_string(),
        });
        let mesh = bytes.and_then(|bytes| gmsh::parse(bytes, &file));
        mesh.map(Self).map_err(refused)
    }

    /// The mesh as the text of a Gmsh file (MSH 4.1).
    fn to_msh(&self) -> String {
        gmsh::to_text(&self.0)
    }

    /// The mesh with a group of surface facets: those of which all nodes are in `where`, a mask
    /// (nodes,) or a function that makes it of `points`.
    fn with_surface(&self, name: &str, r#where: &Bound<'_, PyAny>) -> PyResult<Self> {
        let py = r#where.py();
        let mask = match r#where.is_callable() {
            true => r#where.call1((self.points(py)?,))?,
            false => r#where.clone(),
        };
        let mask: PyArrayLike1<'_, bool, AllowTypeChange> = mask.extract()?;
        let mask: Vec<bool> = mask.as_array().iter().copied().collect();
        if mask.len() != self.0.nodes.len() {
            return Err(Error::new_err(format!(
                "where: expected {} entries, found {}",
                self.0.nodes.len(),
                mask.len()
            )));
        }
        let mut facets = self.0.boundary_facets();
        facets.retain(|facet| facet.nodes.iter().all(|&node| mask[node]));
        if facets.is_empty() {
            return Err(Error::new_err(format!(
                "where: no facet of the surface has all its nodes in `{name}`; expected one or more"
            )));
        }
        Ok(self.with(name, Group::Facets(facets)))
    }

    /// The mesh with a group of surface facets by their nodes, (facets, nodes per facet); more are
    /// added to those that it has.
    fn with_facets(&self, name: &str, nodes: Rows<'_>) -> PyResult<Self> {
        let mut facets = match self.0.groups.get(name) {
            Some(Group::Facets(facets)) => facets.clone(),
            _ => Vec::new(),
        };
        for row in nodes.as_array().outer_iter() {
            let nodes = self.nodes_of(&format!("group `{name}`"), row.iter())?;
            facets.push(Facet { nodes });
        }
        Ok(self.with(name, Group::Facets(facets)))
    }

    /// The mesh with a group of cells by their numbers, for materials and body forces.
    fn with_cells(&self, name: &str, cells: Numbers<'_>) -> PyResult<Self> {
        let place = format!("group `{name}`");
        let cells = indices(&place, numbers(&cells).iter())?;
        check_below(&place, "cell", &cells, self.0.cell_count())?;
        Ok(self.with(name, Group::Cells(cells)))
    }

    /// The mesh with a group of nodes by their numbers, for supports.
    fn with_nodes(&self, name: &str, nodes: Numbers<'_>) -> PyResult<Self> {
        let nodes = self.nodes_of(&format!("group `{name}`"), numbers(&nodes).iter())?;
        Ok(self.with(name, Group::Points(nodes)))
    }

    /// Positions of the nodes, (nodes, d), in the unit of length.
    #[getter]
    fn points<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let dimension = self.0.dimension;
        let positions = self.0.nodes.iter().flat_map(|x| x[..dimension].to_vec());
        rows(py, positions, dimension)
    }

    /// Node numbers per kind of cell, (cells, nodes per cell), in Gmsh's order.
    #[getter]
    fn cells<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let of_kinds = PyDict::new(py);
        for kind in CellKind::all() {
            let cells = self.0.cells().filter(|cell| cell.kind == kind);
            let nodes: Vec<i64> = cells
                .flat_map(|cell| cell.nodes.iter().map(|&node| node as i64))
                .collect();
            if !nodes.is_empty() {
                of_kinds.set_item(kind.name(), rows(py, nodes, kind.node_count())?)?;
            }
        }
        Ok(of_kinds)
    }

    /// Names of the groups, with what each is of: `cells`, `facets`, `edges` or `nodes`.
    #[getter]
    fn groups(&self) -> Vec<(String, &'static str)> {
        let word = |group: &Group| match group {
            Group::Cells(_) => "cells",
            Group::Facets(_) => "facets",
            Group::Edges(_) => "edges",
            Group::Points(_) => "nodes",
        };
        let groups = self.0.groups.iter();
        groups
            .map(|(name, group)| (name.clone(), word(group)))
            .collect()
    }

    /// Nodes of a group, each once, in increasing order.
    fn group_nodes<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyArray1<i64>>> {
        let mut nodes: Vec<usize> = match self.0.groups.get(name) {
            None => return Err(Error::new_err(format!("group `{name}` is not in the mesh"))),
            Some(Group::Cells(cells)) => {
                let cells = cells.iter().map(|&cell| self.0.cell(cell));
                cells.flat_map(|cell| cell.nodes.to_vec()).collect()
            }
            Some(Group::Facets(facets)) => facets.iter().flat_map(|f| f.nodes.clone()).collect(),
            Some(Group::Edges(edges)) => edges.iter().flatten().copied().collect(),
            Some(Group::Points(points)) => points.clone(),
        };
        nodes.sort_unstable();
        nodes.dedup();
        Ok(PyArray1::from_iter(
            py,
            nodes.into_iter().map(|node| node as i64),
        ))
    }

    fn __repr__(&self) -> String {
        format!(
            "dpana.Mesh({}D, {} nodes, {} cells, groups: {})",
            self.0.dimension,
            self.0.nodes.len(),
            self.0.cell_count(),
            self.0.groups.keys().cloned().collect::<Vec<_>>().join(", ")
        )
    }
}

impl Mesh {
    fn with(&self, name: &str, group: Group) -> Self {
        let mut mesh = self.0.clone();
        mesh.groups.insert(name.to_owned(), group);
        Self(mesh)
    }

    fn nodes_of<'a>(
        &self,
        place: &str,
        stated: impl Iterator<Item = &'a f64>,
    ) -> PyResult<Vec<usize>> {
        let nodes = indices(place, stated)?;
        check_below(place, "node", &nodes, self.0.nodes.len())?;
        Ok(nodes)
    }
}

fn check_below(place: &str, what: &str, numbers: &[usize], count: usize) -> PyResult<()> {
    match numbers.iter().find(|&&number| number >= count) {
        None => Ok(()),
        Some(number) => Err(Error::new_err(format!(
            "{place}: {what} {number} is not accepted; expected numbers below {count}, from 0"
        ))),
    }
}

fn push_cells(mesh: &mut body::Mesh, kind: CellKind, cells: Rows<'_>) -> PyResult<()> {
    let (place, cells) = (format!("cells[\"{}\"]", kind.name()), cells.as_array());
    if cells.ncols() != kind.node_count() {
        return Err(Error::new_err(format!(
            "{place}: {} columns are not accepted; expected {}",
            cells.ncols(),
            kind.node_count()
        )));
    }
    let nodes = indices(&place, cells.iter())?;
    check_below(&place, "node", &nodes, mesh.nodes.len())?;
    for cell in nodes.chunks_exact(kind.node_count()) {
        mesh.push_cell(kind, cell);
    }
    Ok(())
}

fn kind(name: &str, dimension: usize) -> PyResult<CellKind> {
    let known: Vec<CellKind> = CellKind::all()
        .filter(|kind| kind.dimension() == dimension)
        .collect();
    let found = known.iter().copied().find(|kind| kind.name() == name);
    found.ok_or_else(|| {
        let names: Vec<&str> = known.iter().map(|kind| kind.name()).collect();
        Error::new_err(format!(
            "cells: `{name}` is not accepted for points in {dimension}D; expected {}",
            names.join(", ")
        ))
    })
}
