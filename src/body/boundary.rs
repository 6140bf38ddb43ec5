//! The surface of a mesh: facets that belong to exactly one cell.

use std::collections::{HashMap, HashSet};

use super::kinds::MOST_FACET_NODES;
use super::{Cell, Facet, Mesh};
use crate::error::Error;

/// Nodes of a facet in ascending order, the same for all its owners; free places stand last.
type Key = [usize; MOST_FACET_NODES];

/// The cells that own given facets.
pub(crate) struct Owners<'a> {
    mesh: &'a Mesh,
    /// Number of owners, and the last one's (cell, local facet).
    sides: HashMap<Key, (usize, (usize, usize))>,
}

impl<'a> Owners<'a> {
    /// Looks for the owners of all `facets` in one pass over the cells.
    pub(crate) fn new<'b>(mesh: &'a Mesh, facets: impl Iterator<Item = &'b Facet>) -> Self {
        let unowned = |facet: &Facet| (key(&facet.nodes), (0, (0, 0)));
        let mut sides: HashMap<Key, _> = facets.map(unowned).collect();
        if !sides.is_empty() {
            for (index, cell) in mesh.cells().enumerate() {
                for local in 0..cell.kind.facets().len() {
                    if let Some((count, side)) = sides.get_mut(&key_of(cell, local)) {
                        *count += 1;
                        *side = (index, local);
                    }
                }
            }
        }
        Self { mesh, sides }
    }

    /// One of the facets in outward order; `place` names it if it is not on the surface.
    pub(crate) fn outward(
        &self,
        facet: &Facet,
        place: impl Fn() -> String,
    ) -> Result<Facet, Error> {
        let cells = match self.sides.get(&key(&facet.nodes)) {
            Some((1, (cell, local))) => {
                let side = side_of(self.mesh.cell(*cell), *local);
                if side.nodes.len() == facet.nodes.len() {
                    return Ok(side);
                }
                0
            }
            found => found.map_or(0, |side| side.0),
        };
        Err(Error::FacetOwners {
            place: place(),
            nodes: facet.nodes.clone(),
            cells,
        })
    }
}

impl Mesh {
    /// Facets that belong to exactly one cell, in outward order, cell by cell.
    #[must_use]
    pub fn boundary_facets(&self) -> Vec<Facet> {
        let (offsets, sides) = self.sides_by_smallest_node();
        let mut outer = Vec::new();
        let mut keyed = Vec::new();
        for range in offsets.windows(2) {
            let of_node = sides[range[0]..range[1]].iter();
            keyed.clear();
            keyed.extend(of_node.map(|&side| (key_of(self.cell(side.0), side.1), side)));
            // Sorted, because one node may be in most of the cells.
            keyed.sort_unstable();
            for owned in keyed.chunk_by(|a, b| a.0 == b.0) {
                if let [(_, side)] = owned {
                    outer.push(*side);
                }
            }
        }
        outer.sort_unstable();
        outer
            .into_iter()
            .map(|(cell, local)| side_of(self.cell(cell), local))
            .collect()
    }

    /// The given surface facets in outward order; a facet that is listed twice is returned once.
    ///
    /// # Errors
    ///
    /// [`Error::FacetOwners`] for a facet that is no facet of any cell, or that lies
    /// inside the body between two cells.
    pub fn orient(&self, facets: &[Facet]) -> Result<Vec<Facet>, Error> {
        let owners = Owners::new(self, facets.iter());
        let mut listed = HashSet::new();
        let mut oriented = Vec::with_capacity(facets.len());
        for (index, facet) in facets.iter().enumerate() {
            let side = owners.outward(facet, || format!("facets[{index}]"))?;
            if listed.insert(key(&facet.nodes)) {
                oriented.push(side);
            }
        }
        Ok(oriented)
    }

    /// Every (cell, local facet), sorted into one bucket per smallest node: facets that
    /// coincide share a bucket.
    fn sides_by_smallest_node(&self) -> (Vec<usize>, Vec<(usize, usize)>) {
        let mut offsets = vec![0; self.nodes.len() + 1];
        for cell in self.cells() {
            for local in 0..cell.kind.facets().len() {
                offsets[key_of(cell, local)[0] + 1] += 1;
            }
        }
        for node in 0..self.nodes.len() {
            offsets[node + 1] += offsets[node];
        }
        let mut next = offsets.clone();
        let mut sides = vec![(0, 0); offsets[self.nodes.len()]];
        for (index, cell) in self.cells().enumerate() {
            for local in 0..cell.kind.facets().len() {
                let place = &mut next[key_of(cell, local)[0]];
                sides[*place] = (index, local);
                *place += 1;
            }
        }
        (offsets, sides)
    }
}

/// A facet of a cell, in outward order.
fn side_of(cell: Cell<'_>, local: usize) -> Facet {
    let nodes = cell.kind.facets()[local]
        .iter()
        .map(|node| cell.nodes[*node]);
    Facet {
        nodes: nodes.collect(),
    }
}

pub(super) fn key_of(cell: Cell<'_>, local: usize) -> Key {
    let nodes = cell.kind.facets()[local].iter();
    sorted(nodes.map(|node| cell.nodes[*node]))
}

pub(super) fn key(nodes: &[usize]) -> Key {
    sorted(nodes.iter().copied())
}

fn sorted(nodes: impl Iterator<Item = usize>) -> Key {
    let mut key = [usize::MAX; MOST_FACET_NODES];
    let mut count = 0;
    for (entry, node) in key.iter_mut().zip(nodes) {
        *entry = node;
        count += 1;
    }
    key[..count].sort_unstable();
    key
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use nalgebra::Vector3;

    use super::*;
    use crate::body::{CellKind, box_mesh, rectangle};

    const UNEVEN: [f64; 4] = [0.0, 0.5, 1.2, 2.0];

    fn meshes() -> [Mesh; 4] {
        [
            rectangle(&UNEVEN, &UNEVEN, CellKind::Tri3).unwrap(),
            rectangle(&UNEVEN, &UNEVEN, CellKind::Quad4).unwrap(),
            box_mesh(&UNEVEN, &UNEVEN, &UNEVEN, CellKind::Tet4).unwrap(),
            box_mesh(&UNEVEN, &UNEVEN, &UNEVEN, CellKind::Hex8).unwrap(),
        ]
    }

    #[test]
    fn the_boundary_of_a_box_is_closed_and_points_outward() {
        // Box of edge 2: area 8 (2D) or 24, ∫ n dA = 0, ∫ x·n dA = dimension × volume.
        for mesh in meshes() {
            let (mut area, mut closure, mut moment) = (0.0, Vector3::zeros(), 0.0);
            for facet in mesh.boundary_facets() {
                let geometry = mesh.facet_geometry(&facet);
                area += geometry.area;
                for (node, vector) in facet.nodes.iter().zip(geometry.vectors) {
                    closure += Vector3::from(vector);
                    moment += Vector3::from(mesh.nodes[*node]).dot(&Vector3::from(vector));
                }
            }
            let (expected, volume) = if mesh.dimension == 2 {
                (8.0, 4.0)
            } else {
                (24.0, 8.0)
            };
            assert!((area - expected).abs() < 1e-13 && closure.norm() < 1e-13);
            assert!((moment - mesh.dimension as f64 * volume).abs() < 1e-13);
        }
    }

    #[test]
    fn a_facet_given_backwards_is_turned_and_a_repeated_one_is_kept_once() {
        for mesh in meshes() {
            let outward = mesh.boundary_facets();
            let mut given = outward.clone();
            for facet in &mut given {
                facet.nodes.reverse();
            }
            given.push(given[0].clone());
            assert_eq!(mesh.orient(&given).unwrap(), outward);
        }
    }

    #[test]
    fn a_facet_between_two_cells_is_no_surface() {
        let mesh = rectangle(&UNEVEN, &UNEVEN, CellKind::Quad4).unwrap();
        let found = mesh.orient(&[Facet { nodes: vec![5, 6] }]);
        let expected = Error::FacetOwners {
            place: "facets[0]".to_owned(),
            nodes: vec![5, 6],
            cells: 2,
        };
        assert_eq!(found, Err(expected));
    }

    #[test]
    fn a_facet_of_no_cell_is_refused_even_with_nodes_that_do_not_exist() {
        let mesh = rectangle(&UNEVEN, &UNEVEN, CellKind::Quad4).unwrap();
        for nodes in [
            vec![0, 5],
            vec![0, 999],
            vec![0],
            vec![],
            vec![0, 1, 2, 3, 4],
        ] {
            assert!(mesh.orient(&[Facet { nodes }]).is_err());
        }
    }
}
