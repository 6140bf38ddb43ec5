//! A group of cells is cut along a plane: the parts on its two sides get nodes of their own.

use std::collections::BTreeSet;

use nalgebra::Vector3;

use super::{Facet, Mesh};
use crate::error::Error;

/// Part of the cells' extent across a cut by which its nodes may lie off its plane.
const IN_PLANE: f64 = 1e-6;

impl Mesh {
    /// Cuts some cells along the plane through a point across an axis, in metre, where their facets lie in it.
    ///
    /// Two groups are added, of the facets in the plane: `NAME.own` of the cells ahead along the axis, which get
    /// nodes of their own, and `NAME.other` of those behind. Every other group follows, as in
    /// [`split`](Self::split). `place` stands for the cut in messages.
    ///
    /// # Errors
    ///
    /// [`Error::NotAccepted`] for a plane that misses the cells or goes through some of them, for other cells at the
    /// cut, which would still hold both parts together, and for a mesh that has one of the groups;
    /// [`Error::Direction`] for an axis without direction.
    pub fn cut(
        &mut self,
        place: &str,
        name: &str,
        cells: &[usize],
        [point, axis]: [[f64; 3]; 2],
    ) -> Result<(), Error> {
        let at = |key: &str| format!("{place}.{key}");
        let Some(along) = Vector3::from(axis).try_normalize(0.0) else {
            return Err(Error::Direction {
                place: at("axis"),
                value: axis,
                accepted: "a direction of any length but zero",
            });
        };
        let height = |x: [f64; 3]| along.dot(&(Vector3::from(x) - Vector3::from(point)));
        let heights = cells.iter().map(|&cell| height(self.centroid(cell)));
        let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), h| {
            (low.min(h), high.max(h))
        });
        if !(low < 0.0 && high > 0.0) {
            return refuse(
                at("point"),
                format!(
                    "a plane that all cells lie on one side of: their centres are {low:e} to {high:e} ahead of it"
                ),
                "a point where the plane across the axis cuts the cells",
            );
        }
        let (ahead, behind): (BTreeSet<usize>, BTreeSet<usize>) = cells
            .iter()
            .partition(|&&cell| height(self.centroid(cell)) > 0.0);
        let shared = self.shared_nodes(&ahead, &behind);
        let size = cells.iter().flat_map(|&cell| self.cell(cell).nodes);
        let size = size.fold(0.0_f64, |most, &node| {
            most.max(height(self.nodes[node]).abs())
        });
        let off = |node: &usize| height(self.nodes[*node]).abs();
        if let Some(node) = shared.iter().find(|node| off(node) > IN_PLANE * size) {
            return refuse(
                at("point"),
                format!(
                    "a plane through cells: node {node} at {:?}, between those ahead and those behind, is {:e} off it",
                    self.nodes[*node],
                    off(node)
                ),
                "a plane that facets of the mesh lie in",
            );
        }
        self.refuse_others(at("group"), cells, &shared)?;
        self.part_from(&at("groups"), name, [&ahead, &behind], &shared)
    }

    /// Centre of some facets, in metre, and the sum of their areas along their normals: the plane that they lie in.
    pub(crate) fn plane_of(&self, facets: &[Facet]) -> [[f64; 3]; 2] {
        let (mut area, mut centre, mut along) = (0.0, [0.0; 3], [0.0; 3]);
        for facet in facets {
            let geometry = self.facet_geometry(facet);
            area += geometry.area;
            for axis in 0..3 {
                let nodes = facet.nodes.iter().zip(geometry.weights);
                centre[axis] += nodes
                    .map(|(&node, w)| w * self.nodes[node][axis])
                    .sum::<f64>();
                along[axis] += geometry.area * geometry.normal[axis];
            }
        }
        [centre.map(|x| x / area), along]
    }

    /// Refuses a cut that is not closed: other cells at its nodes hold the two parts together.
    fn refuse_others(
        &self,
        place: String,
        cells: &[usize],
        shared: &BTreeSet<usize>,
    ) -> Result<(), Error> {
        let own: BTreeSet<usize> = cells.iter().copied().collect();
        let others = (0..self.cell_count()).filter(|cell| !own.contains(cell));
        let mut held = others.filter_map(|cell| {
            let mut nodes = self.cell(cell).nodes.iter();
            Some((cell, nodes.find(|node| shared.contains(node))?))
        });
        match held.next() {
            None => Ok(()),
            Some((cell, node)) => refuse(
                place,
                format!(
                    "cells that the plane does not part from the rest: cell {cell}, which is none of them, holds node {node} \
                     of the cut at {:?}",
                    self.nodes[*node]
                ),
                "a group with all cells around the cut",
            ),
        }
    }
}

fn refuse(place: String, found: String, accepted: &str) -> Result<(), Error> {
    Err(Error::NotAccepted {
        place,
        found,
        accepted: accepted.to_owned(),
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::body::{CellKind, Facet, Group, box_mesh, graded, rectangle};

    /// A unit cube of 2 × 2 × 4 cells.
    fn cube() -> Mesh {
        let line = |cells| graded(0.0, 1.0, cells, 1.0).unwrap();
        box_mesh(&line(2), &line(2), &line(4), CellKind::Hex8).unwrap()
    }

    fn facets<'a>(mesh: &'a Mesh, name: &str) -> &'a [Facet] {
        match &mesh.groups[name] {
            Group::Facets(facets) => facets,
            _ => unreachable!(),
        }
    }

    #[test]
    fn both_sides_of_a_cut_lie_in_its_plane_on_nodes_of_their_own() {
        let (mut mesh, all) = (cube(), (0..16).collect::<Vec<_>>());
        let before = mesh.nodes.len();
        mesh.cut(
            "bolts[0]",
            "bolt",
            &all,
            [[9.0, 9.0, 0.75], [0.0, 0.0, -2.0]],
        )
        .unwrap();
        assert_eq!(mesh.nodes.len(), before + 9);
        let [own, other] = ["bolt.own", "bolt.other"].map(|name| facets(&mesh, name).to_vec());
        assert_eq!((own.len(), other.len()), (4, 4));
        for (own, other) in own.iter().zip(&other) {
            let normal = |facet| mesh.facet_geometry(facet).normal[2];
            // Ahead is below: its side of the cut looks up.
            assert_eq!((normal(own), normal(other)), (1.0, -1.0));
            assert!(own.nodes.iter().all(|node| *node >= before));
            assert!(other.nodes.iter().all(|node| mesh.nodes[*node][2] == 0.75));
        }
    }

    #[test]
    fn what_cannot_be_cut_says_why() {
        let all: Vec<usize> = (0..16).collect();
        let said = |cells: &[usize], point: [f64; 3], axis: [f64; 3]| {
            cube()
                .cut("bolts[0]", "bolt", cells, [point, axis])
                .unwrap_err()
                .to_string()
        };
        let up = [0.0, 0.0, 1.0];
        assert!(said(&all, [0.0, 0.0, 1.5], up).contains("one side"));
        assert!(said(&all, [0.0, 0.0, 0.3], up).contains("off it"));
        assert!(said(&all, [0.0, 0.0, 0.5], [0.0; 3]).contains("direction"));
        assert!(said(&all, [f64::NAN, 0.0, 0.5], up).contains("one side"));
        // A column of the cube: its neighbours hold it.
        let column: Vec<usize> = all.iter().copied().filter(|cell| cell % 4 == 0).collect();
        assert!(said(&column, [0.0, 0.0, 0.5], up).contains("none of them"));
        let mut twice = cube();
        let plane = [[0.0, 0.0, 0.5], up];
        twice.cut("bolts[0]", "bolt", &all, plane).unwrap();
        assert!(twice.cut("bolts[0]", "bolt", &all, plane).is_err());
    }

    #[test]
    fn quadratic_cells_part_with_the_nodes_between() {
        let line = graded(0.0, 1.0, 2, 1.0).unwrap();
        let mut mesh = rectangle(&line, &line, CellKind::Quad8).unwrap();
        let before = mesh.nodes.len();
        mesh.cut(
            "bolts[0]",
            "bolt",
            &[0, 1, 2, 3],
            [[0.5, 0.5, 0.0], [1.0, 0.0, 0.0]],
        )
        .unwrap();
        assert_eq!(mesh.nodes.len(), before + 5);
        assert_eq!(facets(&mesh, "bolt.own").len(), 2);
    }
}
