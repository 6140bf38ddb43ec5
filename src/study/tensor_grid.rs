//! Displacements between the nodes of a mesh whose nodes are a product of lines.

use crate::body::{CellKind, Mesh};

/// Positions closer than this part of the extent are one line.
const SAME: f64 = 1e-9;

/// Lines of a mesh of quadrilaterals or hexahedra along the axes, and the nodes where they cross.
#[derive(Clone, Debug)]
pub(super) struct TensorGrid {
    lines: Vec<Vec<f64>>,
    /// Node at `i + n_x (j + n_y k)`.
    nodes: Vec<usize>,
}

impl TensorGrid {
    /// None for meshes of another kind.
    pub(super) fn of(mesh: &Mesh) -> Option<Self> {
        let linear = |kind| matches!(kind, CellKind::Quad4 | CellKind::Hex8);
        if !mesh.cells().all(|cell| linear(cell.kind)) {
            return None;
        }
        let lines: Vec<Vec<f64>> = (0..mesh.dimension).map(|axis| lines(mesh, axis)).collect();
        let count: usize = lines.iter().map(Vec::len).product();
        if count != mesh.nodes.len() {
            return None;
        }
        let mut nodes = vec![usize::MAX; count];
        for (node, position) in mesh.nodes.iter().enumerate() {
            let mut at = 0;
            for (axis, lines) in lines.iter().enumerate().rev() {
                at = at * lines.len() + nearest(lines, position[axis]);
            }
            nodes[at] = node;
        }
        let full = !nodes.contains(&usize::MAX);
        full.then_some(Self { lines, nodes })
    }

    /// Multilinear displacement at a position of the mesh, per axis, from entries
    /// `dimension · node + axis`.
    pub(super) fn displacement(&self, nodal: &[f64], position: [f64; 3]) -> Vec<f64> {
        let axes = self.lines.len();
        let places: Vec<(usize, f64)> = (0..axes)
            .map(|axis| place(&self.lines[axis], position[axis]))
            .collect();
        let mut found = vec![0.0; axes];
        for corner in 0..1_usize << axes {
            let (mut at, mut weight) = (0, 1.0);
            for axis in (0..axes).rev() {
                let (cell, part) = places[axis];
                let upper = corner >> axis & 1;
                at = at * self.lines[axis].len() + cell + upper;
                weight *= if upper == 1 { part } else { 1.0 - part };
            }
            for (axis, u) in found.iter_mut().enumerate() {
                *u += weight * nodal[axes * self.nodes[at] + axis];
            }
        }
        found
    }
}

fn lines(mesh: &Mesh, axis: usize) -> Vec<f64> {
    let mut all: Vec<f64> = mesh.nodes.iter().map(|position| position[axis]).collect();
    all.sort_by(f64::total_cmp);
    let extent = all.last().copied().unwrap_or(0.0) - all.first().copied().unwrap_or(0.0);
    all.dedup_by(|next, kept| (*next - *kept).abs() <= SAME * extent);
    all
}

fn nearest(lines: &[f64], x: f64) -> usize {
    let (cell, part) = place(lines, x);
    if part > 0.5 { cell + 1 } else { cell }
}

/// The cell of a position and the part of it that lies before; the first or last for one beyond.
fn place(lines: &[f64], x: f64) -> (usize, f64) {
    let cells = lines.len().saturating_sub(1);
    let after = lines.partition_point(|line| *line <= x);
    let cell = after.saturating_sub(1).min(cells.saturating_sub(1));
    match lines.get(cell + 1) {
        Some(end) => (
            cell,
            ((x - lines[cell]) / (end - lines[cell])).clamp(0.0, 1.0),
        ),
        None => (cell, 0.0),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::body::{box_mesh, rectangle};

    #[test]
    fn a_bilinear_displacement_is_found_between_the_nodes() {
        let mesh = rectangle(&[0.0, 1.0, 4.0], &[-1.0, 0.0, 0.5], CellKind::Quad4).unwrap();
        let u = |x: f64, y: f64| [1.0 + x - 2.0 * y + 3.0 * x * y, y];
        let nodal: Vec<f64> = mesh.nodes.iter().flat_map(|x| u(x[0], x[1])).collect();
        let grid = TensorGrid::of(&mesh).unwrap();
        for [x, y] in [[0.3, -0.2], [2.5, 0.4], [4.0, 0.5], [0.0, -1.0]] {
            let found = grid.displacement(&nodal, [x, y, 0.0]);
            let expected = u(x, y);
            assert!((found[0] - expected[0]).abs() < 1e-14, "{found:?}");
            assert!((found[1] - expected[1]).abs() < 1e-14, "{found:?}");
        }
    }

    #[test]
    fn a_trilinear_displacement_too() {
        let lines = [0.0, 0.5, 2.0];
        let mesh = box_mesh(&lines, &lines, &lines, CellKind::Hex8).unwrap();
        let nodal: Vec<f64> = mesh
            .nodes
            .iter()
            .flat_map(|[x, y, z]| [x * y * z, *z, *x])
            .collect();
        let found = TensorGrid::of(&mesh)
            .unwrap()
            .displacement(&nodal, [0.25, 1.0, 1.5]);
        assert!((found[0] - 0.375).abs() < 1e-15 && (found[1] - 1.5).abs() < 1e-15);
    }

    #[test]
    fn triangles_and_bent_meshes_are_no_grids() {
        let lines = [0.0, 1.0, 2.0];
        let mut mesh = rectangle(&lines, &lines, CellKind::Quad4).unwrap();
        assert!(TensorGrid::of(&mesh).is_some());
        mesh.nodes[4][1] += 0.1;
        assert!(TensorGrid::of(&mesh).is_none());
        assert!(TensorGrid::of(&rectangle(&lines, &lines, CellKind::Tri3).unwrap()).is_none());
    }
}
