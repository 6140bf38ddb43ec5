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
//! turns as it does at its other end. At a plane of symmetry the surface goes on as its mirror image. An edge is of an arc
//! where the surface turns alike at three nodes on end; else these are kinks between faces.
//! Normals: Max, J. Graphics Tools 4 (1999) 1–6.

use std::collections::HashMap;

use nalgebra::Vector3;

use super::mirror::{Mirrors, image, lies_in};
use super::turn::{CORNER, FLAT, STRAIGHT, UNLIKE, smaller};
use crate::body::{Facet, Mesh};

/// Cosine from which on an edge goes on behind another one.
const BEHIND: f64 = 0.5;

/// A facet at one of its corners.
struct Wedge {
    facet: usize,
    corner: usize,
    /// Corners of the facet before and after this one.
    before: usize,
    after: usize,
}

/// Half turn in radian at one end of an edge.
#[derive(Clone, Copy, Default)]
struct End {
    half_turn: f64,
    /// The normal is one-sided.
    open: bool,
    /// It is, and nothing goes on behind the edge.
    last: bool,
}

/// Facets around a node that go on from one to the next without a corner.
struct Fan<'a> {
    node: usize,
    wedges: Vec<&'a Wedge>,
    normal: Vector3<f64>,
    /// It does not go all around the node.
    open: bool,
    /// Planes of symmetry behind which it goes on.
    mirrors: Vec<Vector3<f64>>,
}

/// Facets of a boundary in outward order.
struct Faces<'a> {
    mesh: &'a Mesh,
    corners: Vec<&'a [usize]>,
    normals: Vec<Vector3<f64>>,
}

/// `4 s` in metre per edge, from corner to corner in the order of its facet; those that turn.
pub(super) fn turning_edges(
    mesh: &Mesh,
    boundary: &[Facet],
    mirrors: &Mirrors,
) -> HashMap<[usize; 2], f64> {
    let faces = Faces::new(mesh, boundary);
    let known = faces.half_turns(mirrors);
    let mut around: HashMap<usize, Vec<Neighbour>> = HashMap::new();
    for ([from, to], half_turns) in &known {
        around.entry(*from).or_default().push((*to, half_turns[1]));
        around.entry(*to).or_default().push((*from, half_turns[0]));
    }
    let mut turning = HashMap::new();
    for (edge, half_turns) in known {
        let half_turn = smaller(half_turns);
        if half_turn != 0.0 && faces.is_of_an_arc(edge, half_turns, &around, mirrors) {
            let length = faces.edge(edge[0], edge[1]).norm();
            turning.insert(edge, length * 2.0 * (half_turn / 2.0).tan());
        }
    }
    turning
}

/// A node at the other end of an edge, with the half turn there if it is known.
type Neighbour = (usize, Option<f64>);

/// The half turns of an edge at its ends, where they are known.
fn half_turns(ends: [End; 2]) -> [Option<f64>; 2] {
    let one_sided = ends[0].open != ends[1].open;
    ends.map(|end| {
        let known = !(end.last || one_sided && end.open);
        let turns = end.half_turn.abs() >= STRAIGHT / 2.0;
        known.then_some(if turns { end.half_turn } else { 0.0 })
    })
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

    /// The edges of every facet with the half turns at their ends, where they are known.
    fn half_turns(&self, mirrors: &Mirrors) -> Vec<([usize; 2], [Option<f64>; 2])> {
        let mut ends = vec![[[End::default(); 2]; 4]; self.corners.len()];
        for (node, wedges) in self.wedges() {
            for (wedges, open) in self.fans(&wedges) {
                let fan = self.fan(node, wedges, open, mirrors);
                for wedge in &fan.wedges {
                    let last = self.corners[wedge.facet].len() - 1;
                    let edge_before = wedge.corner.checked_sub(1).unwrap_or(last);
                    ends[wedge.facet][wedge.corner][0] = self.end(&fan, wedge.after);
                    ends[wedge.facet][edge_before][1] = self.end(&fan, wedge.before);
                }
            }
        }
        let of_facets = self.corners.iter().zip(ends);
        let edges = of_facets.flat_map(|(corners, ends)| {
            let next = corners.iter().cycle().skip(1);
            let edges = corners.iter().zip(next).zip(ends);
            edges.map(|((from, to), ends)| ([*from, *to], half_turns(ends)))
        });
        edges.collect()
    }

    /// An edge's end at the node of a fan.
    fn end(&self, fan: &Fan<'_>, other: usize) -> End {
        let goes_on = self.goes_on(other, fan);
        End {
            half_turn: match goes_on {
                true => self.half_turn(fan.normal, fan.node, other),
                false => 0.0,
            },
            open: fan.open,
            last: fan.open && !goes_on,
        }
    }

    /// Whether the surface turns alike at three nodes on end along an edge: else these are kinks between faces.
    fn is_of_an_arc(
        &self,
        [from, to]: [usize; 2],
        half_turns: [Option<f64>; 2],
        around: &HashMap<usize, Vec<Neighbour>>,
        mirrors: &Mirrors,
    ) -> bool {
        let length = self.edge(from, to).norm();
        let behind = |at: usize, away: usize, turn: f64| {
            let neighbours = around.get(&at).into_iter().flatten();
            let alike = neighbours.filter_map(move |(other, far)| Some((*other, (*far)?)));
            let alike = alike.filter(move |(other, far)| {
                far * turn > 0.0 && self.is_behind(*other, at, away, mirrors)
            });
            alike.map(move |(other, far)| (other, (far / self.edge(at, other).norm()).abs()))
        };
        let two_behind = |at: usize, away: usize, turn: f64| {
            behind(at, away, turn).any(|(next, _)| behind(next, at, turn).next().is_some())
        };
        // Flatter than what is behind by more than an arc is.
        let flat = |at: usize, away: usize, turn: f64| {
            behind(at, away, turn).any(|(_, most)| turn.abs() / length < FLAT * most)
        };
        match half_turns {
            [Some(a), Some(b)] => {
                let mut third = behind(from, to, a).chain(behind(to, from, b));
                a * b > 0.0 && third.next().is_some() && !(flat(from, to, a) && flat(to, from, b))
            }
            [Some(turn), None] => two_behind(from, to, turn) && !flat(from, to, turn),
            [None, Some(turn)] => two_behind(to, from, turn) && !flat(to, from, turn),
            [None, None] => false,
        }
    }

    /// Whether a node, or its image, is behind another one as seen from a third.
    fn is_behind(&self, node: usize, at: usize, away: usize, mirrors: &Mirrors) -> bool {
        let (edge, way) = (self.edge(at, away), self.edge(at, node));
        let images = mirrors.at(at).iter().map(|plane| image(way, plane));
        let least = BEHIND * edge.norm() * way.norm();
        images.chain([way]).any(|way| -way.dot(&edge) > least)
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

    /// A fan with its normal, which lies in the planes of symmetry behind which it goes on.
    fn fan<'w>(
        &self,
        node: usize,
        wedges: Vec<&'w Wedge>,
        open: bool,
        mirrors: &Mirrors,
    ) -> Fan<'w> {
        let normal = self.normal(node, &wedges);
        let mirrors = mirrors.of_surface(node, normal);
        let across = mirrors
            .iter()
            .fold(normal, |normal, plane| normal - plane * plane.dot(&normal));
        let loose = [
            wedges.first().map(|w| w.after),
            wedges.last().map(|w| w.before),
        ];
        let ends = loose.into_iter().flatten().any(|other| {
            let edge = self.edge(node, other);
            !mirrors.iter().any(|plane| lies_in(edge, plane))
        });
        Fan {
            node,
            normal: across.try_normalize(0.0).unwrap_or_default(),
            open: open && ends,
            wedges,
            mirrors,
        }
    }

    /// Whether the facets of a fan go on behind its node for a part of an edge to another one: a long edge
    /// beside short facets is a flat that goes over into a fillet.
    fn goes_on(&self, other: usize, fan: &Fan<'_>) -> bool {
        let edge = self.edge(fan.node, other);
        let behind = fan.wedges.iter().map(|wedge| {
            let ends = [wedge.after, wedge.before];
            let mut ways = ends.map(|end| self.edge(fan.node, end)).to_vec();
            for plane in &fan.mirrors {
                let images: Vec<_> = ways.iter().map(|way| image(*way, plane)).collect();
                ways.extend(images);
            }
            ways.iter().map(|way| -way.dot(&edge)).fold(0.0, f64::max)
        });
        edge.norm_squared() <= UNLIKE * behind.fold(0.0, f64::max)
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
    use crate::contact::held::Directions;

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
        let turning = turning_edges(&mesh, &mesh.boundary_facets(), &Mirrors::default());
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
            assert!(edges(kind, kinked).1.is_empty(), "{kind:?}");
            // With sides of a single facet.
            let mut tent =
                box_mesh(&[-1.0, 0.0, 1.0], &[0.0, 1.0, 2.0], &[0.0, 1.0], kind).unwrap();
            for node in &mut tent.nodes {
                node[2] -= 0.25 * node[0].abs();
            }
            let facets = tent.boundary_facets();
            assert!(
                turning_edges(&tent, &facets, &Mirrors::default()).is_empty(),
                "{kind:?}"
            );
        }
    }

    #[test]
    fn a_quarter_of_a_dome_between_planes_of_symmetry_turns_as_the_whole() {
        for kind in KINDS {
            let dome = |[x, y, z]: [f64; 3]| [x, y, z + 0.05 * (x * x + y * y)];
            let part = |from: f64| {
                let steps = [-1.0, -0.3, 0.0, 0.3, 1.0];
                let along: Vec<f64> = steps.into_iter().filter(|x| *x >= from).collect();
                let mut mesh = box_mesh(&along, &along, &[-1.0, 0.0], kind).unwrap();
                for node in &mut mesh.nodes {
                    *node = dome(*node);
                }
                let facets = mesh.boundary_facets();
                let held = |node: usize| {
                    let at = mesh.nodes[node];
                    Directions::from([at[0] == from, at[1] == from, false])
                };
                let mirrors = match from {
                    0.0 => Mirrors::new(&mesh, &facets, held),
                    _ => Mirrors::default(),
                };
                let turning = turning_edges(&mesh, &facets, &mirrors);
                let x = |node: usize| mesh.nodes[node].map(|x| (x * 1e6).round() as i64);
                let named = turning
                    .into_iter()
                    .map(|(edge, round)| (edge.map(x), round));
                named.collect::<HashMap<_, _>>()
            };
            let (quarter, whole) = (part(0.0), part(-1.0));
            let mut compared = 0;
            for (edge, round) in &quarter {
                // Diagonals of tetrahedra are not those of the image.
                let Some(other) = whole.get(edge) else {
                    continue;
                };
                if kind == CellKind::Hex8 {
                    assert!((round - other).abs() < 1e-14, "{edge:?} {round} {other}");
                }
                compared += 1;
            }
            assert!(compared >= 12, "{kind:?} {compared}");
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
