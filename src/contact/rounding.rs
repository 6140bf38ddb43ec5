//! The smooth surface that straight facets stand for.
//!
//! ```text
//! (C18)  b = 4 s λ_1 λ_2,   s = L/2 tan(κ L/4)     b: from the facet out to the smooth surface
//!        κ: of those at its two ends the smaller one; zero where their signs differ
//!        κ at a node = turn of the facets there / mean of their lengths, positive where convex
//! ```
//!
//! `s` is the sagitta of the arc of curvature κ over a chord that its facets turn by `κ L`.
//! On triangles and quadrilaterals the s of all edges add up (`turning_edges`):
//!
//! ```text
//!        b = Σ 4 s_ij λ_i λ_j                                         triangle
//!        b = (4 s_ab (1−v) + 4 s_cd v) u(1−u) + (4 s_da (1−u) + 4 s_bc u) v(1−v)
//! ```
//!
//! Pressed together, two lines have one curvature: each has lost its share of `κ_1 + κ_2`, as it gives way.
//! Linear displacements move the nodes there and leave the facets straight, so that what counts in a mean gap is
//! the sagitta of the curvature that is left (C23). Between two circles that fit it is all, between two
//! alike ones that flatten each other nothing. Distances before anything is pressed have all of it.
//!
//! ```text
//! (C23)  b' = b_1 + b_2 − Σ_k c_k max(0, κ_1 + κ_2) L_k² ξ_k (1 − ξ_k)/2      c_k: share of the compliance, Σ c_k = 1
//! ```
//!
//! A mesh of straight facets is a polygon in or around the body that it was made for. Two of them that
//! should fit depart from each other by up to the sum of their sagittas, which may be more than
//! what they overlap or approach. Gaps are therefore measured between the smooth surfaces: what facets
//! leave of them is taken off. Where the facets' own turns say that nothing is round, b is exactly zero:
//! on flat faces, beside kinks between them (an arc turns at three nodes on end, at least), on a flat between two fillets, beside a fillet of much shorter facets; and at a corner, from which on a facet goes by its
//! other end, as it does at the end of a surface. Facets whose middle nodes follow the curve are round
//! already.

use std::collections::HashMap;

use nalgebra::Vector3;

use super::mirror::{Mirrors, image};
use super::repeated::Seams;
use super::turn::{CORNER, FLAT, STRAIGHT, UNLIKE, is_straight, smaller, turn};
use super::turning_edges::turning_edges;
use crate::body::{Facet, Mesh};

/// Part of a facet's length by which its middle node may leave the chord.
const ON_CHORD: f64 = 1e-10;

/// How far the smooth surface stands off a facet (C18).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Bulge {
    /// Number of the facet's corners.
    corners: usize,
    /// 4 s of each of its edges in metre, from corner to corner; a line has one.
    edges: [f64; 4],
    /// Of a line: its arc goes on at both ends.
    inner: bool,
}

impl Bulge {
    /// `b` in metre where the functions of the corners have these values.
    fn height(&self, hats: &[f64; 4]) -> f64 {
        let [a, b, c, d] = *hats;
        let [ab, bc, cd, da] = self.edges;
        match self.corners {
            2 => ab * a * b,
            3 => ab * a * b + bc * b * c + cd * c * a,
            _ => {
                let (u, v) = (b + c, c + d);
                let along = (ab * (1.0 - v) + cd * v) * u * (1.0 - u);
                along + (da * (1.0 - u) + bc * u) * v * (1.0 - v)
            }
        }
    }

    /// The largest of `|b|` at its middle and at those of its edges, in metre.
    fn largest(&self) -> f64 {
        let share = 1.0 / self.corners as f64;
        let middle: [f64; 4] = std::array::from_fn(|k| if k < self.corners { share } else { 0.0 });
        let edges = self.edges.iter().map(|round| round / 4.0);
        edges
            .chain([self.height(&middle)])
            .fold(0.0, |largest, b| b.abs().max(largest))
    }
}

/// How far the smooth surface stands off each of some facets (C18).
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Bulges {
    /// Per facet, positive outwards.
    of: Vec<Bulge>,
    /// Gaps are measured from the smooth surface, and not from the facets.
    rounded: bool,
}

impl Bulges {
    /// Facets that stand for nothing but themselves.
    pub(super) fn none(facets: usize) -> Self {
        Self {
            of: vec![Bulge::default(); facets],
            rounded: false,
        }
    }

    /// What is taken off a gap where facets leave `bulge` of it, in metre.
    pub(super) fn taken(&self, bulge: f64) -> f64 {
        if self.rounded { bulge } else { 0.0 }
    }

    /// `b` in metre at a point of a facet, where the functions of its corners have these values.
    pub(super) fn height(&self, facet: usize, hats: &[f64; 4]) -> f64 {
        self.of[facet].height(hats)
    }

    /// Whether the smooth surface stands off a facet.
    pub(super) fn is_round(&self, facet: usize) -> bool {
        self.of[facet].edges.iter().any(|round| *round != 0.0)
    }

    /// κ in 1/m of the arc that a line of a length in metre stands for (C18); zero where the arc ends: what its last line
    /// loses to (C23) its neighbour on a flat would not.
    pub(super) fn curvature(&self, facet: usize, length: f64) -> f64 {
        let of_line = &self.of[facet];
        match of_line.inner {
            true => 2.0 * of_line.edges[0] / (length * length),
            false => 0.0,
        }
    }

    /// Number of those of some facets that are rounded, and the largest `|b|` in metre.
    pub(super) fn rounded(&self, facets: &[usize]) -> (usize, f64) {
        let sagittas = facets
            .iter()
            .map(|&facet| self.taken(self.of[facet].largest()));
        let round = sagittas.filter(|sagitta| *sagitta > 0.0);
        round.fold((0, 0.0), |(count, largest), s| (count + 1, s.max(largest)))
    }
}

/// How the surface of a body turns at its nodes.
#[derive(Clone, Debug, Default)]
pub(super) struct Turns {
    /// κ in 1/m; none at corners.
    curvature: HashMap<usize, Curvature>,
    /// Of a solid: 4 s in metre of the edges that turn.
    edges: HashMap<[usize; 2], f64>,
}

/// How a surface turns at a node.
#[derive(Clone, Copy, Debug)]
struct Curvature {
    /// κ in 1/m.
    value: f64,
    /// Length of the shorter one of the facets there, in metre.
    shorter: f64,
    /// Nodes at the other ends of the facets there.
    beside: [usize; 2],
}

impl Curvature {
    /// The node behind this one, as seen from one of those beside it.
    fn behind(&self, from: usize) -> usize {
        let [one, other] = self.beside;
        if one == from { other } else { one }
    }
}

impl Turns {
    /// Of the facets of a whole boundary in outward order, which go on behind planes of symmetry and, in the plane, beyond seams.
    pub(super) fn new(mesh: &Mesh, boundary: &[Facet], mirrors: &Mirrors, seams: &Seams) -> Self {
        let curvature = match mesh.dimension {
            2 => curvatures(mesh, boundary, (mirrors, seams)),
            _ => HashMap::new(),
        };
        let edges = match mesh.dimension {
            2 => HashMap::new(),
            _ => turning_edges(mesh, boundary, mirrors),
        };
        Self { curvature, edges }
    }

    /// The bulges of facets of this boundary, which count in gaps or not.
    pub(super) fn bulges(&self, mesh: &Mesh, facets: &[Facet], rounded: bool) -> Bulges {
        Bulges {
            of: facets.iter().map(|facet| self.bulge(mesh, facet)).collect(),
            rounded,
        }
    }

    fn bulge(&self, mesh: &Mesh, facet: &Facet) -> Bulge {
        let corners = facet.corners(mesh.dimension);
        let (mut edges, mut inner) = ([0.0; 4], false);
        if let [start, end] = corners {
            let (sagitta, goes_on) = self.sagitta(mesh, facet, [*start, *end]);
            (edges[0], inner) = (4.0 * sagitta, goes_on);
        } else if !self.edges.is_empty() && is_straight(mesh, facet) {
            let next = corners.iter().cycle().skip(1);
            for (edge, (from, to)) in edges.iter_mut().zip(corners.iter().zip(next)) {
                *edge = self.edges.get(&[*from, *to]).copied().unwrap_or(0.0);
            }
        }
        Bulge {
            corners: corners.len(),
            edges,
            inner,
        }
    }

    /// The sagitta of a line in metre, and whether its arc goes on at both ends.
    fn sagitta(&self, mesh: &Mesh, facet: &Facet, [start, end]: [usize; 2]) -> (f64, bool) {
        let chord = span(mesh, start, end);
        let on_chord = |node: &usize| {
            let off = chord.cross(&span(mesh, start, *node)).norm() / chord.norm();
            off <= ON_CHORD * chord.norm()
        };
        if !facet.nodes.iter().all(on_chord) {
            return (0.0, false);
        }
        let ends = [(start, end), (end, start)].map(|(node, other)| {
            let found = self.curvature.get(&node)?;
            let alike = chord.norm() <= UNLIKE * found.shorter;
            let behind = self.curvature.get(&found.behind(other));
            let behind = behind.map_or(0.0, |of| of.value);
            Some([if alike { found.value } else { 0.0 }, behind])
        });
        let own = ends.map(|end| end.map(|[own, _]| own));
        let most = own
            .iter()
            .flatten()
            .fold(0.0_f64, |most, own| most.max(own.abs()));
        let flat = |end: &Option<[f64; 2]>| {
            end.is_none_or(|[own, behind]| own.abs() < FLAT * behind.abs())
        };
        let goes_on = |end: &Option<[f64; 2]>| {
            end.is_some_and(|[own, behind]| own * behind > 0.0 && behind.abs() >= FLAT * most)
        };
        if ends.iter().all(flat) {
            return (0.0, false);
        }
        let sagitta = 0.5 * chord.norm() * (0.25 * smaller(own) * chord.norm()).tan();
        (sagitta, ends.iter().all(goes_on))
    }
}

/// κ of the nodes of a boundary of lines; none at corners, zero at kinks: an arc turns at three nodes on end, at least.
fn curvatures(
    mesh: &Mesh,
    boundary: &[Facet],
    (mirrors, seams): (&Mirrors, &Seams),
) -> HashMap<usize, Curvature> {
    let mut found: HashMap<usize, Curvature> = HashMap::new();
    let joints: HashMap<usize, [usize; 2]> = joints(mesh, boundary).collect();
    for (&node, &ends) in &joints {
        let mut lines = [span(mesh, ends[0], node), span(mesh, node, ends[1])];
        let planes = lines.map(|line| {
            let across = line.cross(&Vector3::z()).try_normalize(0.0)?;
            mirrors.of_surface(node, across).pop()
        });
        // Of two lines one may be a plane of symmetry: then the other's image stands for it.
        let seen = match planes {
            [Some(plane), None] => Some((0, plane)),
            [None, Some(plane)] => Some((1, plane)),
            _ => None,
        };
        let mut ends = ends;
        if let Some((real, plane)) = seen {
            lines[1 - real] = -image(lines[real], &plane);
            ends[1 - real] = ends[real];
        }
        for side in 0..2 {
            // Beyond a seam the line at the node's image stands for it.
            let Some(image) = seams.beyond(node, joints[&node][side]) else {
                continue;
            };
            let Some(end) = joints.get(&image.node).map(|ends| ends[side]) else {
                continue;
            };
            let line = span(mesh, image.node, end);
            lines[side] = image.turn * if side == 0 { -line } else { line };
            ends[side] = end;
        }
        let turn = turn(lines[0], lines[1]);
        if turn.abs() < CORNER {
            let turn = if turn.abs() < STRAIGHT { 0.0 } else { turn };
            let [before, after] = lines.map(|line| line.norm());
            let value = 2.0 * turn / (before + after);
            let of_node = Curvature {
                value,
                shorter: before.min(after),
                beside: ends,
            };
            found.insert(node, of_node);
        }
    }
    let turns = |node: usize| found.get(&node).map_or(0.0, |of| of.value);
    let alone = |(node, of): (&usize, &Curvature)| {
        let alike = |other: Option<usize>| other.is_some_and(|at| turns(at) * of.value > 0.0);
        let near = of.beside.map(|end| alike(Some(end)));
        let on = |end: usize| found.get(&end).map(|of_end| of_end.behind(*node));
        let far = [0, 1].map(|k| near[k] && alike(on(of.beside[k])));
        let kink = !(near == [true; 2] || far.contains(&true));
        kink.then_some(*node)
    };
    let kinks: Vec<usize> = found.iter().filter_map(alone).collect();
    for node in kinks {
        found.entry(node).and_modify(|of| of.value = 0.0);
    }
    found
}

/// The nodes where one line ends and one begins, with the other ends of both.
fn joints(mesh: &Mesh, boundary: &[Facet]) -> impl Iterator<Item = (usize, [usize; 2])> {
    let mut lines: HashMap<usize, [Vec<usize>; 2]> = HashMap::new();
    for facet in boundary {
        if let [start, end] = facet.corners(mesh.dimension) {
            lines.entry(*end).or_default()[0].push(*start);
            lines.entry(*start).or_default()[1].push(*end);
        }
    }
    lines.into_iter().filter_map(|(node, lines)| match lines {
        [before, after] if before.len() == 1 && after.len() == 1 => {
            Some((node, [before[0], after[0]]))
        }
        _ => None,
    })
}

fn span(mesh: &Mesh, from: usize, to: usize) -> Vector3<f64> {
    Vector3::from(mesh.nodes[to]) - Vector3::from(mesh.nodes[from])
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// Bulges of the lines through points, which go round the body against the clock.
    fn lines(points: &[[f64; 2]]) -> Bulges {
        let nodes = points.iter().map(|[x, y]| [*x, *y, 0.0]);
        let mesh = Mesh::new(2, nodes.collect());
        let lines: Vec<Facet> = (0..points.len())
            .map(|k| Facet {
                nodes: vec![k, (k + 1) % points.len()],
            })
            .collect();
        Turns::new(&mesh, &lines, &Mirrors::default(), &Seams::default())
            .bulges(&mesh, &lines, true)
    }

    /// Their sagittas, positive outwards.
    fn bulges(points: &[[f64; 2]]) -> Vec<f64> {
        let of = lines(points).of;
        of.iter().map(|bulge| bulge.edges[0] / 4.0).collect()
    }

    #[test]
    fn facets_of_a_circle_stand_off_it_by_their_sagitta() {
        for facets in [16, 48] {
            let half = std::f64::consts::PI / f64::from(facets);
            let at = |k: i32| {
                [
                    (2.0 * half * f64::from(k)).cos(),
                    (2.0 * half * f64::from(k)).sin(),
                ]
            };
            let points: Vec<[f64; 2]> = (0..facets).map(at).collect();
            for s in bulges(&points) {
                assert!((s - (1.0 - half.cos())).abs() < 1e-14, "{s}");
            }
            let curvature = lines(&points).curvature(3, 2.0 * half.sin());
            assert!(
                (curvature - 2.0 / (1.0 + half.cos())).abs() < 1e-12,
                "{curvature}"
            );
            // From inside the same circle is a bore.
            let bore: Vec<[f64; 2]> = points.into_iter().rev().collect();
            assert!(bulges(&bore).iter().all(|s| *s < 0.0));
        }
    }

    #[test]
    fn flat_faces_corners_and_kinks_between_flat_faces_stay() {
        let square = [
            [0.0, 0.0],
            [1.0, 0.0],
            [2.0, 0.0],
            [2.0, 2.0],
            [1.0, 2.0],
            [0.0, 2.0],
        ];
        assert!(bulges(&square).iter().all(|s| *s == 0.0));
        // A roof of 0.2 rad on it, its sides of one line or of two; a flat between two chamfers.
        let tent = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 2.1], [0.0, 2.0]];
        assert!(bulges(&tent).iter().all(|s| *s == 0.0));
        let foot = [
            [0.0, 0.1],
            [0.5, 0.0],
            [1.5, 0.0],
            [2.0, 0.1],
            [2.0, 1.0],
            [0.0, 1.0],
        ];
        assert!(bulges(&foot).iter().all(|s| *s == 0.0));
        let roof = [
            [0.0, 0.0],
            [2.0, 0.0],
            [2.0, 2.0],
            [1.5, 2.05],
            [1.0, 2.1],
            [0.5, 2.05],
            [0.0, 2.0],
        ];
        assert!(bulges(&roof).iter().all(|s| *s == 0.0));
    }

    #[test]
    fn an_arc_goes_on_to_a_corner_and_ends_where_it_becomes_straight() {
        // Half a disc on its diameter, then a bar with round ends.
        let half = std::f64::consts::PI / 24.0;
        let arc = |k: i32| [(half * f64::from(k)).cos(), (half * f64::from(k)).sin()];
        let disc: Vec<[f64; 2]> = (0..=24).map(arc).collect();
        let found = bulges(&disc);
        assert!(
            found[..24]
                .iter()
                .all(|s| (s - found[12]).abs() < 1e-15 && *s > 0.0)
        );
        assert_eq!(found[24], 0.0);
        let mut bar = disc;
        bar.insert(0, [1.0, -1.0]);
        bar.push([-1.0, -1.0]);
        let found = bulges(&bar);
        // The straight side is one long facet; the arc's first one turns half as much where it begins.
        assert!(found[0] == 0.0 && found[1] > 0.0 && found[1] < found[12]);
    }
}
