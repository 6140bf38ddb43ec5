//! Parts of a mesh: some of its cells, as a mesh of their own.

use std::collections::HashSet;

use super::boundary::{key, key_of};
use super::{Facet, Group, Mesh};

impl Mesh {
    /// The given cells with their nodes and with what belongs to them of every group; groups of which nothing does
    /// are left out. Numbers that are no cells are passed over, a cell that comes twice counts once.
    #[must_use]
    pub fn part(&self, cells: &[usize]) -> Self {
        let mut kept: Vec<usize> = cells
            .iter()
            .copied()
            .filter(|cell| *cell < self.cell_count())
            .collect();
        kept.sort_unstable();
        kept.dedup();
        let mut number = vec![None; self.nodes.len()];
        let mut part = Self::new(self.dimension, Vec::new());
        let mut sides = HashSet::new();
        for &index in &kept {
            let cell = self.cell(index);
            let nodes = cell.nodes.iter().map(|&node| {
                *number[node].get_or_insert_with(|| {
                    part.nodes.push(self.nodes[node]);
                    part.nodes.len() - 1
                })
            });
            let nodes: Vec<usize> = nodes.collect();
            part.push_cell(cell.kind, &nodes);
            sides.extend((0..cell.kind.facets().len()).map(|local| key_of(cell, local)));
        }
        let renumbered = |nodes: &[usize]| {
            nodes
                .iter()
                .map(|&node| number[node])
                .collect::<Option<Vec<_>>>()
        };
        let has = |facet: &&Facet| sides.contains(&key(&facet.nodes));
        for (name, group) in &self.groups {
            let own = match group {
                Group::Cells(cells) => Group::Cells(
                    cells
                        .iter()
                        .filter_map(|cell| kept.binary_search(cell).ok())
                        .collect(),
                ),
                Group::Facets(facets) => {
                    let nodes = facets
                        .iter()
                        .filter(has)
                        .filter_map(|facet| renumbered(&facet.nodes));
                    Group::Facets(nodes.map(|nodes| Facet { nodes }).collect())
                }
                Group::Edges(edges) => {
                    Group::Edges(edges.iter().filter_map(|edge| renumbered(edge)).collect())
                }
                Group::Points(points) => {
                    Group::Points(points.iter().filter_map(|point| number[*point]).collect())
                }
            };
            if !own.is_empty() {
                part.groups.insert(name.clone(), own);
            }
        }
        part
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::body::{CellKind, rectangle};

    #[test]
    fn a_part_has_its_cells_nodes_and_its_share_of_every_group() {
        // Three squares in a row; the last two. Of `bottom` two facets are theirs, of `left` none.
        let mut mesh = rectangle(&[0.0, 1.0, 2.0, 3.0], &[0.0, 1.0], CellKind::Quad4).unwrap();
        let seam = Facet { nodes: vec![1, 5] };
        mesh.groups.insert("seam".into(), Group::Facets(vec![seam]));
        mesh.groups.insert("ends".into(), Group::Points(vec![0, 3]));
        let part = mesh.part(&[2, 1, 2, 99]);
        assert_eq!((part.cell_count(), part.nodes.len()), (2, 6));
        assert_eq!(part.groups["body"], Group::Cells(vec![0, 1]));
        assert!(!part.groups.contains_key("left"));
        let Group::Facets(bottom) = &part.groups["bottom"] else {
            unreachable!()
        };
        assert_eq!(bottom.len(), 2);
        // The seam between the squares is now on the surface.
        let Group::Facets(seam) = &part.groups["seam"] else {
            unreachable!()
        };
        assert!(part.orient(seam).is_ok());
        let Group::Points(ends) = &part.groups["ends"] else {
            unreachable!()
        };
        assert_eq!(part.nodes[ends[0]], [3.0, 0.0, 0.0]);
        assert!((part.volume(0) - 1.0).abs() < 1e-15);
    }
}
