//! Plane cells that run clockwise, as of a surface that was drawn so, turned back.

use std::collections::HashMap;

use super::{Cell, Mesh};

impl Mesh {
    /// Turns plane cells against the clock, and returns how many. Cells that run alike stand or turn
    /// together: where some of them run against the clock and some with it the mesh is folded, and
    /// stays as it is.
    pub(crate) fn turn_clockwise_cells(&mut self) -> usize {
        if self.dimension != 2 || self.cells().all(|cell| !self.runs_clockwise(cell)) {
            return 0;
        }
        let surfaces = self.surfaces();
        let mut clockwise: HashMap<usize, bool> = HashMap::new();
        for (cell, surface) in self.cells().zip(&surfaces) {
            *clockwise.entry(*surface).or_insert(true) &= self.runs_clockwise(cell);
        }
        let turned: Vec<usize> = (0..surfaces.len())
            .filter(|&cell| clockwise[&surfaces[cell]])
            .collect();
        for &index in &turned {
            let cell = self.cell(index);
            let nodes = backwards(cell.nodes, cell.kind.corner_count());
            self.renumber_cell(index, &nodes);
        }
        turned.len()
    }

    /// The polygon of the cell's corners has a negative area.
    fn runs_clockwise(&self, cell: Cell<'_>) -> bool {
        let corners = &cell.nodes[..cell.kind.corner_count()];
        let at = |k: usize| corners.get(k).and_then(|&node| self.nodes.get(node));
        let Some([x, y, _]) = at(0).copied() else {
            return false;
        };
        let arms = (1..corners.len()).filter_map(|k| at(k).map(|p| [p[0] - x, p[1] - y]));
        let arms: Vec<[f64; 2]> = arms.collect();
        let area = arms
            .windows(2)
            .map(|a| a[0][0] * a[1][1] - a[0][1] * a[1][0]);
        area.sum::<f64>() < 0.0
    }

    /// A number per cell: the same for neighbours that run alike, along their common edge in opposite
    /// directions.
    fn surfaces(&self) -> Vec<usize> {
        let mut along: HashMap<[usize; 2], usize> = HashMap::new();
        for (index, cell) in self.cells().enumerate() {
            along.extend(edges(cell).map(|edge| (edge, index)));
        }
        let mut surfaces = vec![usize::MAX; self.cell_count()];
        for start in 0..surfaces.len() {
            let mut reached = vec![start];
            while let Some(cell) = reached.pop() {
                if surfaces[cell] != usize::MAX {
                    continue;
                }
                surfaces[cell] = start;
                let beside = edges(self.cell(cell)).filter_map(|[a, b]| along.get(&[b, a]));
                reached.extend(beside);
            }
        }
        surfaces
    }
}

/// From each corner to the next.
fn edges(cell: Cell<'_>) -> impl Iterator<Item = [usize; 2]> {
    let corners = &cell.nodes[..cell.kind.corner_count()];
    let next = corners.iter().cycle().skip(1);
    corners.iter().zip(next).map(|(a, b)| [*a, *b])
}

/// Nodes of a plane cell the other way round from its first: corners, the nodes between each and
/// the next, the one in the middle.
fn backwards(nodes: &[usize], corners: usize) -> Vec<usize> {
    let (corner, rest) = nodes.split_at(corners);
    let (between, middle) = rest.split_at(rest.len().min(corners));
    let first = corner.iter().take(1);
    let others = corner.iter().skip(1).rev();
    let between = between.iter().rev();
    first
        .chain(others)
        .chain(between)
        .chain(middle)
        .copied()
        .collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::body::tests::samples::PLANE;
    use crate::body::{CellKind, rectangle};

    /// The mesh with every cell from `from` on the other way round.
    fn mirrored(mesh: &Mesh, from: usize) -> Mesh {
        let mut mirrored = Mesh::new(2, mesh.nodes.clone());
        for (index, cell) in mesh.cells().enumerate() {
            match index < from {
                true => mirrored.push_cell(cell.kind, cell.nodes),
                false => {
                    let nodes = backwards(cell.nodes, cell.kind.corner_count());
                    mirrored.push_cell(cell.kind, &nodes);
                }
            }
        }
        mirrored
    }

    #[test]
    fn a_surface_drawn_clockwise_is_turned_and_one_beside_it_stays() {
        for kind in PLANE {
            let lines = [0.0, 1.0, 3.0];
            let mesh = rectangle(&lines, &lines, kind).unwrap();
            let volume =
                |mesh: &Mesh| -> f64 { (0..mesh.cell_count()).map(|cell| mesh.volume(cell)).sum() };
            for from in [0, mesh.cell_count() / 2] {
                let mut clockwise = mirrored(&mesh, from);
                let turned = clockwise.turn_clockwise_cells();
                assert_eq!(turned, mesh.cell_count() - from, "{kind:?}");
                assert!((volume(&clockwise) - 9.0).abs() < 1e-12, "{kind:?}");
            }
            assert_eq!(mesh.clone().turn_clockwise_cells(), 0);
        }
    }

    #[test]
    fn a_cell_that_folds_over_its_neighbours_stays_folded() {
        let lines = [0.0, 1.0, 2.0];
        let mut mesh = rectangle(&lines, &lines, CellKind::Tri3).unwrap();
        // The middle node moved out of the mesh turns some of the triangles around it.
        mesh.nodes[4] = [5.0, 1.0, 0.0];
        let before = mesh.clone();
        assert_eq!(mesh.turn_clockwise_cells(), 0);
        assert_eq!(mesh, before);
    }
}
