//! Rigid motions that the supports leave free.
//!
//! ```text
//! (B7)  u(x) = a + ω × (x − c)      held where a component of u is prescribed
//! ```
//!
//! Each prescribed component, and each direction of a spring, is a row in the six numbers `(a, ω L)`, `L` being the size
//! of the part and `c` its centre; the rows hold the part if they have full rank. The
//! rank is found from these rows, by orthogonalising the largest remainder first, and not
//! from pivots of the stiffness matrix: it does not depend on materials, refinement or units.

use std::collections::HashSet;

use nalgebra::{SVector, Vector3};

use super::tie::{OF_TIE, equations};
use super::{Body, Model, Tie};

/// Lever arms below this fraction of the part's size hold no rotation: in the stiffness
/// matrix its square is all that is left of them.
const SMALLEST_ARM: f64 = 1e-6;

/// `(a, ω L)`.
pub(super) type Motion = SVector<f64, 6>;

/// Nodes of each connected part, by joining the nodes of every cell and tie.
pub(super) fn parts(body: &Body) -> Vec<Vec<usize>> {
    let count = body.mesh.nodes.len();
    let mut parent: Vec<usize> = (0..count).collect();
    let mut join = |first: usize, node: usize| {
        let (one, other) = (root(&mut parent, first), root(&mut parent, node));
        parent[one.max(other)] = one.min(other);
    };
    for cell in body.mesh.cells() {
        let others = cell.nodes[1..].iter();
        others.for_each(|&node| join(cell.nodes[0], node));
    }
    for tie in &body.ties {
        match tie {
            Tie::Rigid(group) => group
                .nodes
                .iter()
                .for_each(|&node| join(group.nodes[0], node)),
            Tie::Pairs(tied) => tied.pairs.iter().for_each(|&[a, b]| join(a, b)),
        }
    }
    let mut parts: Vec<Vec<usize>> = Vec::new();
    let mut part_of_root = vec![usize::MAX; count];
    for node in 0..count {
        let root = root(&mut parent, node);
        if part_of_root[root] == usize::MAX {
            part_of_root[root] = parts.len();
            parts.push(Vec::new());
        }
        parts[part_of_root[root]].push(node);
    }
    parts
}

/// Representative of a node, halving the path to it on the way.
fn root(parent: &mut [usize], mut node: usize) -> usize {
    while parent[node] != node {
        parent[node] = parent[parent[node]];
        node = parent[node];
    }
    node
}

/// A connected part, as a rigid body.
pub(super) struct Part<'a> {
    body: &'a Body,
    pub(super) centre: Vector3<f64>,
    pub(super) size: f64,
}

impl<'a> Part<'a> {
    pub(super) fn new(body: &'a Body, nodes: &[usize]) -> Self {
        let at = |node: &usize| Vector3::from(body.mesh.nodes[*node]);
        let centre = nodes.iter().map(at).sum::<Vector3<f64>>() / nodes.len() as f64;
        let distance = |node| (at(node) - centre).norm();
        let size = nodes.iter().map(distance).fold(f64::MIN_POSITIVE, f64::max);
        Self { body, centre, size }
    }

    /// All motions that no row holds, as a basis: motions along and about the global axes first.
    pub(super) fn free_basis(&self, nodes: &[usize], prescribed: &[Option<f64>]) -> Vec<Motion> {
        let held = self.held(nodes, prescribed);
        let mut all = held.clone();
        // Holding what is free, largest remainder first, appends it to the basis.
        all.hold(&std::array::from_fn::<_, 6, _>(unit));
        all.basis.split_off(held.basis.len())
    }

    /// Displacement of the centre and rotation of a motion.
    pub(super) fn split(&self, motion: Motion) -> (Vector3<f64>, Vector3<f64>) {
        let translation = motion.fixed_rows::<3>(0).into();
        (translation, motion.fixed_rows::<3>(3) / self.size)
    }

    /// What the prescribed components hold.
    fn held(&self, nodes: &[usize], prescribed: &[Option<f64>]) -> Held {
        let mut held = Held::default();
        if self.body.model == Model::Axisymmetric {
            // A ring can only move along its axis without strain.
            held.hold(&[0, 2, 3, 4, 5].map(unit));
        } else if self.body.mesh.dimension == 2 {
            // The plane itself holds the motions that leave it.
            held.hold(&[2, 3, 4].map(unit));
        }
        held.hold(&self.rows(nodes, prescribed));
        held
    }

    /// One row per prescribed component: `u_k = a_k + (ω × r)_k = e_k · a + (r × e_k) · ω` (B7).
    fn rows(&self, nodes: &[usize], prescribed: &[Option<f64>]) -> Vec<Motion> {
        let axes = self.body.mesh.dimension;
        let mut rows = Vec::new();
        for &node in nodes {
            for axis in 0..axes {
                if prescribed[axes * node + axis].is_some() {
                    rows.push(self.row(self.body.mesh.nodes[node], Vector3::ith(axis, 1.0)));
                }
            }
        }
        rows.extend(self.spring_rows(nodes));
        rows.extend(self.tied_rows(nodes));
        rows
    }

    /// One row per equation (B16) between displacements of the part: a rigid group moves as the part does.
    fn tied_rows(&self, nodes: &[usize]) -> Vec<Motion> {
        if !self.body.is_tied() {
            return Vec::new();
        }
        let of_part: HashSet<usize> = nodes.iter().copied().collect();
        let rows = equations(self.body).into_iter().filter_map(|equation| {
            let mut sum = Motion::zeros();
            for (column, a) in equation.terms {
                sum += self.column(column, &of_part)? * a;
            }
            Some(sum)
        });
        rows.collect()
    }

    /// What a column of (B16) is in the six numbers; none if it is of another part.
    fn column(&self, column: usize, of_part: &HashSet<usize>) -> Option<Motion> {
        let (axes, unknowns) = (self.body.mesh.dimension, self.body.unknowns());
        let Some(beyond) = column.checked_sub(unknowns) else {
            let node = column / axes;
            let row = || self.row(self.body.mesh.nodes[node], Vector3::ith(column % axes, 1.0));
            return of_part.contains(&node).then(row);
        };
        let Tie::Rigid(group) = self.body.ties.get(beyond / OF_TIE)? else {
            return None;
        };
        of_part.contains(group.nodes.first()?).then_some(())?;
        Some(match beyond % OF_TIE {
            axis @ 0..3 => self.row(group.reference_point, Vector3::ith(axis, 1.0)),
            turn => unit(turn) * (group.size(self.body) / self.size),
        })
    }

    /// One row per direction that a spring resists at a node of the part.
    fn spring_rows(&self, nodes: &[usize]) -> Vec<Motion> {
        if self.body.foundation.is_empty() {
            return Vec::new();
        }
        let of_part: HashSet<usize> = nodes.iter().copied().collect();
        let springs = self.body.foundation.iter();
        let held = springs.flat_map(|spring| spring.held_directions(self.body));
        let held = held.filter(|(node, _)| of_part.contains(node));
        held.map(|(node, direction)| self.row(self.body.mesh.nodes[node], direction))
            .collect()
    }

    /// The displacement at a position along a direction, in the six numbers.
    fn row(&self, position: [f64; 3], direction: Vector3<f64>) -> Motion {
        let arm = (Vector3::from(position) - self.centre) / self.size;
        let mut row = Motion::zeros();
        row.fixed_rows_mut::<3>(0).copy_from(&direction);
        row.fixed_rows_mut::<3>(3).copy_from(&arm.cross(&direction));
        row
    }
}

fn unit(index: usize) -> Motion {
    Motion::ith(index, 1.0)
}

/// Orthonormal basis of the motions that are held.
#[derive(Clone, Debug, Default)]
struct Held {
    basis: Vec<Motion>,
}

impl Held {
    /// Holds more rows: the (first) one with the largest remainder joins the basis, until none is left.
    fn hold(&mut self, rows: &[Motion]) {
        while self.basis.len() < 6 {
            let remainders = rows.iter().rev().map(|row| self.remainder(*row));
            let largest = remainders.max_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()));
            match largest {
                Some(row) if row.norm() > SMALLEST_ARM => self.basis.push(row.normalize()),
                _ => break,
            }
        }
    }

    /// What no held motion accounts for.
    fn remainder(&self, motion: Motion) -> Motion {
        // Projecting twice keeps it orthogonal to round-off even when little remains.
        (0..2).fold(motion, |left, _| {
            self.basis
                .iter()
                .fold(left, |left, held| left - held * held.dot(&left))
        })
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use crate::body::tests::samples::{block, body, support};
    use crate::body::{Body, CellKind, Mesh, Model, RigidMode, free_modes, prescribed};

    fn modes(body: &Body) -> Vec<RigidMode> {
        free_modes(body, &prescribed(body).unwrap()).modes
    }

    /// The one free motion of a body, which turns it about a line through both points.
    fn assert_turns_about(body: &Body, points: [[f64; 3]; 2]) {
        let found = modes(body);
        assert_eq!(found.len(), 1, "{found:?}");
        // A few ε of arms up to 6.
        for point in points {
            assert!(
                found[0].displacement(point).iter().all(|u| u.abs() < 1e-14),
                "{found:?}"
            );
        }
    }

    /// One hexahedron of edge 2 between −1 and 1.
    fn cube() -> Body {
        let kind = CellKind::Hex8;
        let nodes = (0..8).map(|node| kind.position(node)).collect();
        let mut mesh = Mesh::new(3, nodes);
        mesh.push_cell(kind, &[0, 1, 2, 3, 4, 5, 6, 7]);
        body(mesh, Model::Solid, 0.3)
    }

    #[test]
    fn every_support_takes_a_motion_until_none_is_left() {
        let mut body = cube();
        assert_eq!(modes(&body).len(), 6);
        body.supports = vec![support(&[0, 1, 2, 3], &[2])];
        assert_eq!(modes(&body).len(), 3);
        body.supports.push(support(&[0], &[0, 1]));
        // Pinned at corner (−1, −1, −1) and kept level: it turns about the vertical there.
        assert_turns_about(&body, [[-1.0, -1.0, -1.0], [-1.0, -1.0, 5.0]]);
        body.supports.push(support(&[1], &[1]));
        assert!(modes(&body).is_empty());
    }

    #[test]
    fn two_pinned_nodes_are_a_hinge_about_their_line() {
        // Nodes 0 and 2 at (∓1, ∓1, −1).
        let mut body = cube();
        body.supports = vec![support(&[0, 2], &[0, 1, 2])];
        assert_turns_about(&body, [[-1.0, -1.0, -1.0], [1.0, 1.0, -1.0]]);
    }

    #[test]
    fn three_components_whose_lines_of_action_meet_leave_a_rotation() {
        // Plane body held at (0, 0) along x and at (2, 0) along x and y: all lines pass (2, 0).
        let mut body = block(CellKind::Quad4);
        body.supports = vec![support(&[0], &[0]), support(&[4], &[0, 1])];
        assert_turns_about(&body, [[2.0, 0.0, 0.0], [2.0, 0.0, 1.0]]);
        body.supports = vec![support(&[0], &[1]), support(&[4], &[0, 1])];
        assert!(modes(&body).is_empty());
    }

    #[test]
    fn size_and_place_of_the_body_do_not_matter() {
        for size in [1e-9, 1e9] {
            let mut body = cube();
            for x in body.mesh.nodes.iter_mut().flatten() {
                *x = size * (*x + 1000.0);
            }
            body.supports = vec![support(&[0, 1, 2, 3], &[2]), support(&[0], &[0, 1])];
            assert_eq!(modes(&body).len(), 1);
            body.supports.push(support(&[1], &[1]));
            assert!(modes(&body).is_empty());
        }
    }
}
