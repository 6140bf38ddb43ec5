//! Rigid motions that the supports leave free.
//!
//! ```text
//! (B7)  u(x) = a + ω × (x − c)      held where a component of u is prescribed
//! ```
//!
//! Each prescribed component is a row in the six numbers `(a, ω L)`, `L` being the size
//! of the part and `c` its centre; the rows hold the part if they have full rank. The
//! rank is found from these rows, by orthogonalising the largest remainder first, and not
//! from pivots of the stiffness matrix: it does not depend on materials, refinement or units.

use std::fmt;

use nalgebra::{SVector, Vector3};

use super::Body;

/// Lever arms below this fraction of the part's size hold no rotation: in the stiffness
/// matrix its square is all that is left of them.
const SMALLEST_ARM: f64 = 1e-6;

/// `(a, ω L)`.
pub(super) type Motion = SVector<f64, 6>;

/// A rigid motion of a body, or of one of its unconnected parts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidMotion {
    /// Unit vector along the translation, or along the axis of rotation.
    pub direction: [f64; 3],
    /// A point of the axis of rotation, in metre; `None` for a translation.
    pub through: Option<[f64; 3]>,
    /// Advance along the axis, in metre per radian; zero for a pure rotation.
    pub pitch: f64,
    /// Centre of the moving part, in metre, if the body has more than one.
    pub part: Option<[f64; 3]>,
}

/// A rigid motion that the prescribed components (as from
/// [`prescribed`](super::prescribed())) leave free, if there is one.
///
/// Every part of the mesh that shares no node with the rest has to be held on its own. A
/// part counts as one rigid body, also where a single node joins two pieces like a hinge.
/// The body has passed [`check`](super::check()).
#[must_use]
pub fn free_motion(body: &Body, prescribed: &[Option<f64>]) -> Option<RigidMotion> {
    let parts = parts(body);
    let several = parts.len() > 1;
    parts.iter().find_map(|nodes| {
        let part = Part::new(body, nodes);
        let motion = part.free_motion(nodes, prescribed)?;
        Some(part.describe(motion, several))
    })
}

/// Nodes of each connected part, by joining the nodes of every cell.
pub(super) fn parts(body: &Body) -> Vec<Vec<usize>> {
    let count = body.mesh.nodes.len();
    let mut parent: Vec<usize> = (0..count).collect();
    for cell in body.mesh.cells() {
        for &node in &cell.nodes[1..] {
            let (one, other) = (root(&mut parent, cell.nodes[0]), root(&mut parent, node));
            parent[one.max(other)] = one.min(other);
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

    /// A motion that no row holds; a translation or a rotation about a global axis if there is one.
    fn free_motion(&self, nodes: &[usize], prescribed: &[Option<f64>]) -> Option<Motion> {
        let held = self.held(nodes, prescribed);
        held.free()?;
        // Holding all but one translation, or all but one rotation, leaves that one or nothing.
        const OTHERS: [&[usize]; 6] = [
            &[1, 2, 3, 4, 5],
            &[0, 2, 3, 4, 5],
            &[0, 1, 3, 4, 5],
            &[3, 4],
            &[4, 5],
            &[3, 5],
        ];
        let along_an_axis = OTHERS.iter().find_map(|others| {
            let mut candidate = held.clone();
            candidate.hold(&others.iter().map(|index| unit(*index)).collect::<Vec<_>>());
            candidate.free()
        });
        along_an_axis.or_else(|| held.free())
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
        if self.body.mesh.dimension == 2 {
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
            let arm = (Vector3::from(self.body.mesh.nodes[node]) - self.centre) / self.size;
            for axis in 0..axes {
                if prescribed[axes * node + axis].is_some() {
                    let direction = Vector3::ith(axis, 1.0);
                    let moment = arm.cross(&direction);
                    let mut row = Motion::zeros();
                    row.fixed_rows_mut::<3>(0).copy_from(&direction);
                    row.fixed_rows_mut::<3>(3).copy_from(&moment);
                    rows.push(row);
                }
            }
        }
        rows
    }

    fn describe(&self, motion: Motion, several: bool) -> RigidMotion {
        let (translation, rotation) = self.split(motion);
        let part = several.then(|| self.centre.into());
        if rotation.norm() * self.size < SMALLEST_ARM {
            return RigidMotion {
                direction: upward(translation.normalize()).into(),
                through: None,
                pitch: 0.0,
                part,
            };
        }
        let arm = rotation.cross(&translation) / rotation.norm_squared();
        let pitch = translation.dot(&rotation) / rotation.norm_squared();
        let noise = SMALLEST_ARM * self.size;
        let through = (self.centre + arm).map(|x| if x.abs() < noise { 0.0 } else { x });
        RigidMotion {
            direction: upward(rotation.normalize()).into(),
            through: Some(through.into()),
            pitch: if pitch.abs() < noise { 0.0 } else { pitch },
            part,
        }
    }
}

/// Of a direction and its opposite, the one whose largest component is positive.
fn upward(direction: Vector3<f64>) -> Vector3<f64> {
    if direction[direction.iamax()] < 0.0 {
        -direction
    } else {
        direction
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

    /// A unit motion that is not held, if there is one.
    fn free(&self) -> Option<Motion> {
        if self.basis.len() == 6 {
            return None;
        }
        let candidates = (0..6).map(|index| self.remainder(unit(index)));
        let largest = candidates.max_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()))?;
        largest.try_normalize(SMALLEST_ARM)
    }
}

impl fmt::Display for RigidMotion {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z] = self.direction;
        let named = [("x", x), ("y", y), ("z", z)];
        let axis = match named.iter().find(|(_, share)| *share > 1.0 - SMALLEST_ARM) {
            Some((name, _)) => (*name).to_owned(),
            None => format!("({x:.4}, {y:.4}, {z:.4})"),
        };
        match self.through {
            None => write!(out, "translation along {axis}")?,
            Some([x, y, z]) => {
                write!(
                    out,
                    "rotation about {axis} through ({x:.6}, {y:.6}, {z:.6}) m"
                )?;
            }
        }
        if self.pitch != 0.0 {
            write!(out, ", advancing {:.6} m per radian", self.pitch)?;
        }
        match self.part {
            Some([x, y, z]) => write!(out, ", of the part around ({x:.6}, {y:.6}, {z:.6}) m"),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::body::samples::{block, body};
    use crate::body::{CellKind, Mesh, Model, Support, prescribed};

    fn support(nodes: &[usize], axes: &[usize]) -> Support {
        let mut displacement = [None; 3];
        for axis in axes {
            displacement[*axis] = Some(0.0);
        }
        Support {
            place: "support".to_owned(),
            nodes: nodes.to_vec(),
            displacement,
        }
    }

    fn sentence(body: &Body) -> Option<String> {
        let motion = free_motion(body, &prescribed(body).unwrap());
        motion.map(|motion| motion.to_string())
    }

    /// One hexahedron of edge 2 between −1 and 1.
    fn cube() -> Body {
        let kind = CellKind::Hex8;
        let nodes = (0..8).map(|node| kind.corner(node)).collect();
        let mut mesh = Mesh::new(3, nodes);
        mesh.push_cell(kind, &[0, 1, 2, 3, 4, 5, 6, 7]);
        body(mesh, Model::Solid, 0.3)
    }

    #[test]
    fn a_body_without_supports_translates() {
        assert_eq!(sentence(&cube()).unwrap(), "translation along x");
    }

    #[test]
    fn rollers_on_one_face_leave_the_plane_free() {
        let mut body = cube();
        body.supports = vec![support(&[0, 1, 2, 3], &[2])];
        assert_eq!(sentence(&body).unwrap(), "translation along x");
        body.supports.push(support(&[0], &[0]));
        assert_eq!(sentence(&body).unwrap(), "translation along y");
        body.supports.push(support(&[0], &[1]));
        // Pinned at corner (−1, −1, −1) and kept level: it turns about the vertical there.
        assert_eq!(
            sentence(&body).unwrap(),
            "rotation about z through (-1.000000, -1.000000, 0.000000) m"
        );
        body.supports.push(support(&[1], &[1]));
        assert_eq!(sentence(&body), None);
    }

    #[test]
    fn two_pinned_nodes_are_a_hinge_about_their_line() {
        // Nodes 0 and 2 at (∓1, ∓1, −1): the line along (1, 1, 0)/√2.
        let mut body = cube();
        body.supports = vec![support(&[0, 2], &[0, 1, 2])];
        let motion = free_motion(&body, &prescribed(&body).unwrap()).unwrap();
        let half = 0.5_f64.sqrt();
        let close = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12);
        assert!(close(motion.direction, [half, half, 0.0]), "{motion}");
        assert!(close(motion.through.unwrap(), [0.0, 0.0, -1.0]) && motion.pitch == 0.0);
    }

    #[test]
    fn three_components_whose_lines_of_action_meet_leave_a_rotation() {
        // Plane body held at (0, 0) along x and at (2, 0) along x and y: all lines pass (2, 0).
        let mut body = block(CellKind::Quad4);
        body.supports = vec![support(&[0], &[0]), support(&[4], &[0, 1])];
        assert_eq!(
            sentence(&body).unwrap(),
            "rotation about z through (2.000000, 0.000000, 0.000000) m"
        );
        body.supports = vec![support(&[0], &[1]), support(&[4], &[0, 1])];
        assert_eq!(sentence(&body), None);
    }

    #[test]
    fn every_part_has_to_be_held() {
        let mut body = block(CellKind::Tri3);
        let first = body.mesh.nodes.len();
        for x in [[5.0, 5.0, 0.0], [6.0, 5.0, 0.0], [5.0, 8.0, 0.0]] {
            body.mesh.nodes.push(x);
        }
        body.mesh
            .push_cell(CellKind::Tri3, &[first, first + 1, first + 2]);
        body.supports = vec![support(&[0, 4], &[0, 1]), support(&[first], &[0, 1])];
        assert_eq!(
            sentence(&body).unwrap(),
            "rotation about z through (5.000000, 5.000000, 0.000000) m, \
             of the part around (5.333333, 6.000000, 0.000000) m"
        );
        body.supports.push(support(&[first + 1], &[1]));
        assert_eq!(sentence(&body), None);
    }

    #[test]
    fn size_and_place_of_the_body_do_not_matter() {
        for size in [1e-9, 1e9] {
            let mut body = cube();
            for x in body.mesh.nodes.iter_mut().flatten() {
                *x = size * (*x + 1000.0);
            }
            body.supports = vec![support(&[0, 1, 2, 3], &[2]), support(&[0], &[0, 1])];
            assert!(sentence(&body).unwrap().starts_with("rotation about z"));
            body.supports.push(support(&[1], &[1]));
            assert_eq!(sentence(&body), None);
        }
    }
}
