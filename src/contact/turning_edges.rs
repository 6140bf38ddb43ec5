//! How the surface of a solid turns along the edges of its facets.
//!
//! ```text
//! (C22)  n_i ∥ Σ_f (e × e') / (|e|² |e'|²)      over the facets around node i; e, e': their edges there
//!        sin θ_ij = n_i · (x_i − x_j) / L        half the turn from node i to node j, positive where convex
//!        4 s = 2 L tan(θ/2)                      θ: the smaller of both ends; zero where their signs differ
//! ```
//!
//! The normal is exact for nodes on a sphere, whatever the facets, and s is the exact sagitta of a circle
//! over its chord. Facets that meet at more than the angle of a corner have normals of
//! their own. At such an edge, and where the surface ends, a normal is one-sided; from there an edge
//! turns as it does at its other end.
//! Normals: Max, J. Graphics Tools 4 (1999) 1–6.

use std::collections::HashMap;

use nalgebra::Vector3;

use super::turn::{CORNER, STRAIGHT, UNLIKE, smaller};
use crate::body::{Facet, Mesh};

/// A facet at one of its corners.
struct Wedge {
    facet: usize,
    corner: usize,
    /// Corners of the facet before and after this one.
    before: usize,
    after: usize,
}

/// Half turn in radian at one end of an edge; `open` where the normal is one-sided.
#[derive(Clone, Copy, Default)]
struct End {
    half_turn: f64,
    open: bool,
}

/// Facets of a boundary in outward order.
struct Faces<'a> {
    mesh: &'a Mesh,
    corners: Vec<&'a [usize]>,
    normals: Vec<Vector3<f64>>,
}

/// `4 s` in metre per edge, from corner to corner in the order of its facet; those that turn.
pub(super) fn turning_edges(mesh: &Mesh, boundary: &[Facet]) -> HashMap<[usize; 2], f64> {
    let faces = Faces::new(mesh, boundary);
    let corners: usize = faces.corners.iter().map(|corners| corners.len()).sum();
    let mut ends = vec![[[End::default(); 2]; 4]; faces.corners.len()];
    for (node, wedges) in faces.wedges() {
        for (fan, open) in faces.fans(&wedges) {
            let normal = faces.normal(node, &fan);
            for wedge in &fan {
                let end = |other: usize| {
                    let half_turn = faces.half_turn(normal, node, other);
                    let goes_on = open || faces.goes_on(node, other, &fan);
                    End {
                        half_turn: if goes_on { half_turn } else { 0.0 },
                        open,
                    }
                };
                let last = faces.corners[wedge.facet].len() - 1;
                let edge_before = wedge.corner.checked_sub(1).unwrap_or(last);
                ends[wedge.facet][wedge.corner][0] = end(wedge.after);
                ends[wedge.facet][edge_before][1] = end(wedge.before);
            }
        }
    }
    let mut turning = HashMap::with_capacity(corners);
    for (corners, ends) in faces.corners.iter().zip(&ends) {
        for (at, ends) in ends.iter().enumerate().take(corners.len()) {
            let edge = [corners[at], corners[(at + 1) % corners.len()]];
            let round = faces.edge(edge[0], edge[1]).norm() * 2.0 * (half_turn(*ends) / 2.0).tan();
            if round != 0.0 {
                turning.insert(edge, round);
            }
        }
    }
    turning
}

/// Half the turn of an edge, from those at its ends.
fn half_turn(ends: [End; 2]) -> f64 {
    let one_sided = ends[0].open != ends[1].open;
    smaller(ends.map(|end| {
        let known = !(one_sided && end.open);
        let turns = end.half_turn.abs() >= STRAIGHT / 2.0;
        known.then_some(if turns { end.half_turn } else { 0.0 })
    }))
}

impl<'a> Faces<'a> {
    fn new(mesh: &'a Mesh, boundary: &'a [Facet]) -> Self {
        let corners = boundary.iter().map(|facet| facet.corners(mesh.dimension));
        let mut faces = Self {
            mesh,
            corners: corners.collect(),
            normals: Vec::new(),
        };
        let normal = |corners: &&[usize]| match **corners {
            [a, b, c] => faces.edge(a, b).cross(&faces.edge(a, c)),
            [a, b, c, d] => faces.edge(a, c).cross(&faces.edge(b, d)),
            _ => Vector3::zeros(),
        };
        let normals = faces.corners.iter().map(normal);
        let normals = normals.map(|normal| normal.try_normalize(0.0).unwrap_or_default());
        faces.normals = normals.collect();
        faces
    }

    fn edge(&self, from: usize, to: usize) -> Vector3<f64> {
        Vector3::from(self.mesh.nodes[to]) - Vector3::from(self.mesh.nodes[from])
    }

    /// The facets around each node.
    fn wedges(&self) -> HashMap<usize, Vec<Wedge>> {
        let mut wedges: HashMap<usize, Vec<Wedge>> = HashMap::new();
        for (facet, corners) in self.corners.iter().enumerate() {
            let count = corners.len();
            for (corner, node) in corners.iter().enumerate() {
                wedges.entry(*node).or_default().push(Wedge {
                    facet,
                    corner,
                    before: corners[(corner + count - 1) % count],
                    after: corners[(corner + 1) % count],
                });
            }
        }
        wedges
    }

    /// Facets around a node that go on from one to the next without a corner, and whether they end.
    fn fans<'w>(&self, wedges: &'w [Wedge]) -> Vec<(Vec<&'w Wedge>, bool)> {
        let follows = |at: usize| {
            let mut next = wedges
                .iter()
                .enumerate()
                .filter(|(_, w)| w.after == wedges[at].before);
            let (index, found) = next.next()?;
            let cosine = self.normals[found.facet].dot(&self.normals[wedges[at].facet]);
            (next.next().is_none() && cosine > CORNER.cos()).then_some(index)
        };
        let next: Vec<Option<usize>> = (0..wedges.len()).map(follows).collect();
        let first = |at: &usize| !next.contains(&Some(*at));
        let mut seen = vec![false; wedges.len()];
        let mut fans = Vec::new();
        // Those that start somewhere, and then those that go all around.
        let starts = (0..wedges.len()).filter(first).chain(0..wedges.len());
        for start in starts.collect::<Vec<_>>() {
            let mut fan = Vec::new();
            let mut at = Some(start).filter(|at| !seen[*at]);
            while let Some(here) = at {
                seen[here] = true;
                fan.push(&wedges[here]);
                at = next[here].filter(|next| !seen[*next]);
            }
            if !fan.is_empty() {
                fans.push((fan, first(&start)));
            }
        }
        fans
    }

    /// The normal at a node of the facets of a fan (C22).
    fn normal(&self, node: usize, fan: &[&Wedge]) -> Vector3<f64> {
        let terms = fan.iter().map(|wedge| {
            let [after, before] = [wedge.after, wedge.before].map(|other| self.edge(node, other));
            after.cross(&before) / (after.norm_squared() * before.norm_squared())
        });
        let sum: Vector3<f64> = terms.sum();
        sum.try_normalize(0.0).unwrap_or_default()
    }

    /// Whether the facets of a fan go on behind a node for a part of an edge to another one: a long edge
    /// beside short facets is a flat that goes over into a fillet.
    fn goes_on(&self, node: usize, other: usize, fan: &[&Wedge]) -> bool {
        let edge = self.edge(node, other);
        let behind = |wedge: &&Wedge| -self.edge(node, wedge.after).dot(&edge);
        let most = fan.iter().map(behind).fold(0.0, f64::max);
        edge.norm_squared() <= UNLIKE * most
    }

    fn half_turn(&self, normal: Vector3<f64>, node: usize, other: usize) -> f64 {
        let edge = self.edge(other, node);
        (normal.dot(&edge) / edge.norm()).clamp(-1.0, 1.0).asin()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::body::{CellKind, box_mesh, graded};

    /// `4 s` of the edges of a block's boundary after a move of its nodes.
    fn edges(
        kind: CellKind,
        to: impl Fn([f64; 3]) -> [f64; 3],
    ) -> (Mesh, HashMap<[usize; 2], f64>) {
        let along = graded(-1.0, 1.0, 6, 1.4).unwrap();
        let mut mesh = box_mesh(&along, &along, &along, kind).unwrap();
        for node in &mut mesh.nodes {
            *node = to(*node);
        }
        let turning = turning_edges(&mesh, &mesh.boundary_facets());
        (mesh, turning)
    }

    const KINDS: [CellKind; 2] = [CellKind::Hex8, CellKind::Tet4];

    #[test]
    fn a_ball_has_the_sagittas_of_its_great_circles() {
        // A cube blown up to the ball of radius 2: an edge of length L has s = 2 − √(4 − L²/4).
        for kind in KINDS {
            let blow = |x: [f64; 3]| {
                let size = x.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
                (Vector3::from(x).normalize() * 2.0 * size.max(1e-3)).into()
            };
            let (mesh, turning) = edges(kind, blow);
            assert!(turning.len() > 600);
            for ([from, to], round) in turning {
                let [from, to] = [from, to].map(|node| Vector3::from(mesh.nodes[node]));
                let length = (to - from).norm();
                let sagitta = 2.0 - (4.0 - length * length / 4.0).sqrt();
                assert!((round / 4.0 - sagitta).abs() < 1e-13, "{kind:?} {length}");
            }
        }
    }

    #[test]
    fn flat_faces_corners_and_a_kink_are_not_round() {
        for kind in KINDS {
            assert!(edges(kind, |x| x).1.is_empty(), "{kind:?}");
            let kink = graded(-1.0, 1.0, 6, 1.4).unwrap()[3];
            let kinked = |[x, y, z]: [f64; 3]| [x, y, z + 0.1 * (x - kink).abs()];
            // Where a kink runs out at the end of a face it looks like the beginning of an arc.
            let (mesh, turning) = edges(kind, kinked);
            let inside = |node: &usize| mesh.nodes[*node][1].abs() < 1.0;
            assert!(
                !turning.keys().any(|edge| edge.iter().all(inside)),
                "{kind:?}"
            );
        }
    }

    #[test]
    fn of_a_barrel_the_arcs_are_round_and_the_lines_are_not() {
        // Bent about the y axis through z = −4: the top has the radius 5, the bottom is hollow with 3.
        for kind in KINDS {
            let bend = |[x, y, z]: [f64; 3]| {
                let (angle, r) = (x / 4.0, 4.0 + z);
                [r * angle.sin(), y, r * angle.cos()]
            };
            let (mesh, turning) = edges(kind, bend);
            let mut arcs = 0;
            for ([from, to], round) in turning {
                let [from, to] = [from, to].map(|node| Vector3::from(mesh.nodes[node]));
                let across = Vector3::new(to.x - from.x, 0.0, to.z - from.z).norm();
                let r = from.x.hypot(from.z);
                let sagitta = r - (r * r - across * across / 4.0).sqrt();
                let sign = if r > 4.0 { 1.0 } else { -1.0 };
                if (from.y - to.y).abs() < 1e-12 {
                    // Graded facets turn unlike at both ends: the smaller counts.
                    assert!(
                        sign * round > 0.5 * 4.0 * sagitta && sign * round < 4.0 * sagitta * 1.001
                    );
                    arcs += 1;
                }
                assert!(across > 1e-3, "{kind:?}");
            }
            assert!(arcs >= 2 * 7 * 6);
        }
    }
}
