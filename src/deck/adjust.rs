//! ADJUST: slave nodes are moved onto the master surface before anything else.
//!
//! ```text
//! p ← p − d n     d = (p − q) · n,  q the point of the master surface nearest to p,  n its normal
//! ```
//!
//! A node is moved where it overlaps, by at most the size of the facet, or is no farther off than the
//! stated distance; its foot must lie on the surface. Middle nodes of the slave surface are nodes like
//! others: on a curved one they may touch where corners do not. Those of edges into the body move with
//! the corners, by half of what the two move.
//!
//! Of a `*TIE` only the slave faces take part whose corners are near; a `*CLEARANCE` stands in place of a
//! distance that is drawn as none.

use std::collections::{BTreeMap, BTreeSet};

use super::pair::{Adjust, Pair};
use super::statement::Notes;
use crate::error::Error;
use crate::mesh_file::abaqus::{Contents, Shape, Side};

type Point = [f64; 3];

/// Largest distance of a foot from the facet, over the size of the facet: round-off, and the wedge
/// between two facets of a curved surface.
const BESIDE: f64 = 1e-3;

/// Distance over the size of the master's facets up to which surfaces are drawn touching.
const TOUCHING: f64 = 1e-6;

/// A flat piece of a facet: a line or a triangle, its outward normal and its size.
struct Piece {
    corners: Vec<Point>,
    normal: Point,
    size: f64,
}

/// Moves the slave nodes of a pair, keeps those of its slave faces that are near, and looks at its clearance.
pub(super) fn settle(
    contents: &mut Contents,
    pair: &mut Pair<'_, '_>,
    notes: &mut Notes,
) -> Result<(), Error> {
    if let Some(tolerance) = pair.tolerance {
        narrow(contents, pair, tolerance, notes)?;
    }
    if pair.adjust != Adjust::No {
        adjust(contents, pair);
    }
    if let Some((_, card)) = pair.clearance {
        let pieces = master_pieces(contents, pair);
        let size = pieces.iter().map(|piece| piece.size).fold(0.0, f64::max);
        let slave = contents.surfaces[&pair.surfaces[0]].iter();
        let nodes = slave.flat_map(|&side| contents.facet(side));
        let far = nodes.map(|node| distance(&pieces, contents.positions[node]));
        let far = far.fold(0.0, f64::max);
        if far > TOUCHING * size {
            return Err(card.error(format!(
                "the surfaces are drawn up to {far:.3e} apart; expected surfaces drawn touching, or ADJUST"
            )));
        }
    }
    Ok(())
}

/// Leaves slave faces out that have a corner beyond a distance.
fn narrow(
    contents: &mut Contents,
    pair: &mut Pair<'_, '_>,
    tolerance: f64,
    notes: &mut Notes,
) -> Result<(), Error> {
    let pieces = master_pieces(contents, pair);
    let [slave, master] = &pair.surfaces;
    let all = &contents.surfaces[slave];
    let reach = tolerance * (1.0 + TOUCHING);
    let near = |side: &&Side| {
        let corners = contents.corners(**side);
        corners
            .iter()
            .all(|&node| distance(&pieces, contents.positions[node]) <= reach)
    };
    let near: BTreeSet<Side> = all.iter().filter(near).copied().collect();
    if near.is_empty() {
        let reason = format!(
            "no face of `{slave}` stands within {tolerance:.3e} of `{master}`; expected a larger `POSITION TOLERANCE`"
        );
        return Err(pair.card.error(reason));
    }
    if near.len() < all.len() {
        let words = format!(
            "{} of {} faces of `{slave}` stand within {tolerance:.3e} of `{master}` and are tied",
            near.len(),
            all.len()
        );
        notes.add(pair.card, &words);
    }
    pair.surfaces[0] = format!("{slave} on {master}");
    contents.surfaces.insert(pair.surfaces[0].clone(), near);
    Ok(())
}

fn master_pieces(contents: &Contents, pair: &Pair<'_, '_>) -> Vec<Piece> {
    let master = contents.surfaces[&pair.surfaces[1]].iter();
    master.flat_map(|&side| pieces(contents, side)).collect()
}

/// Distance of a point from a surface.
fn distance(surface: &[Piece], point: Point) -> f64 {
    let feet = surface.iter().map(|piece| piece.nearest(point));
    let off = feet.map(|foot| length(plus(point, foot, -1.0)));
    off.fold(f64::INFINITY, f64::min)
}

/// Moves the slave nodes of a pair.
fn adjust(contents: &mut Contents, pair: &Pair<'_, '_>) {
    let pieces = master_pieces(contents, pair);
    let slave = contents.surfaces[&pair.surfaces[0]].iter();
    let nodes = slave.flat_map(|&side| contents.facet(side));
    let nodes: BTreeSet<usize> = nodes.collect();
    let mut moves: BTreeMap<usize, Point> = BTreeMap::new();
    for &node in &nodes {
        let reach = match &pair.adjust {
            Adjust::No => continue,
            Adjust::Within(distance) => *distance,
            Adjust::Set(nodes) if nodes.contains(&node) => f64::INFINITY,
            Adjust::Set(_) => continue,
        };
        if let Some(by) = onto(&pieces, contents.positions[node], reach) {
            moves.insert(node, by);
        }
    }
    follow(contents, &nodes, &mut moves);
    for (node, by) in moves {
        let position = &mut contents.positions[node];
        *position = plus(*position, by, 1.0);
    }
}

/// How a point moves onto the surface, if it does.
fn onto(pieces: &[Piece], point: Point, reach: f64) -> Option<Point> {
    let feet = pieces
        .iter()
        .map(|piece| (piece, plus(point, piece.nearest(point), -1.0)));
    let (piece, off) = feet.min_by(|a, b| length(a.1).total_cmp(&length(b.1)))?;
    let distance = dot(off, piece.normal);
    let beside = length(plus(off, piece.normal, -distance));
    let on_surface = beside <= BESIDE * piece.size + 0.5 * distance.abs();
    let moved = on_surface && distance <= reach && distance >= -piece.size;
    moved.then(|| piece.normal.map(|n| -distance * n))
}

/// Adds the middle nodes beside the slave surface of all cells whose corners move.
fn follow(contents: &Contents, slave: &BTreeSet<usize>, moves: &mut BTreeMap<usize, Point>) {
    let mut middles = BTreeMap::new();
    for element in &contents.elements {
        let Shape::Cell(kind) = element.kind.shape else {
            continue;
        };
        if !element.nodes.iter().any(|node| moves.contains_key(node)) {
            continue;
        }
        let corners = 0..kind.corner_count();
        let middles_of_cell = kind.corner_count()..kind.node_count();
        for at in middles_of_cell.filter(|&at| !slave.contains(&element.nodes[at])) {
            let middle = kind.position(at);
            let ends = corners.clone().flat_map(|a| (0..a).map(move |b| (a, b)));
            let between = |&(a, b): &(usize, usize)| {
                let (a, b) = (kind.position(a), kind.position(b));
                (0..3).all(|axis| 0.5 * (a[axis] + b[axis]) == middle[axis])
            };
            // Opposite corners of a face share its centre, where these cells have no node.
            if let Some((a, b)) = ends.clone().find(between) {
                let by = |corner: usize| moves.get(&element.nodes[corner]).copied();
                let (a, b) = (by(a).unwrap_or_default(), by(b).unwrap_or_default());
                middles.insert(element.nodes[at], plus(a, b, 1.0).map(|x| 0.5 * x));
            }
        }
    }
    moves.extend(middles);
}

/// The pieces of a facet, its middle nodes among their corners.
fn pieces(contents: &Contents, side: Side) -> Vec<Piece> {
    let nodes = contents.facet(side);
    let solid = contents.elements[side.0].kind.shape.dimension() == 3;
    let cuts: &[&[usize]] = match (solid, nodes.len()) {
        (false, 2) => &[&[0, 1]],
        (false, _) => &[&[0, 2], &[2, 1]],
        (true, 3) => &[&[0, 1, 2]],
        (true, 4) => &[&[0, 1, 2], &[0, 2, 3]],
        (true, 6) => &[&[0, 3, 5], &[3, 1, 4], &[5, 4, 2], &[3, 4, 5]],
        (true, _) => &[
            &[0, 4, 7],
            &[4, 1, 5],
            &[5, 2, 6],
            &[6, 3, 7],
            &[4, 5, 6],
            &[4, 6, 7],
        ],
    };
    let piece = |cut: &&[usize]| {
        let corners: Vec<Point> = cut
            .iter()
            .map(|&at| contents.positions[nodes[at]])
            .collect();
        let a = plus(corners[1], corners[0], -1.0);
        let normal = match corners.get(2) {
            None => [a[1], -a[0], 0.0],
            Some(&third) => cross(a, plus(third, corners[0], -1.0)),
        };
        let area = length(normal);
        Piece {
            corners,
            normal: normal.map(|n| n / area),
            size: length(a),
        }
    };
    cuts.iter().map(piece).collect()
}

impl Piece {
    /// The point of the piece that is nearest to a point.
    fn nearest(&self, point: Point) -> Point {
        let ends = |a: usize, b: usize| (self.corners[a], self.corners[b]);
        if let [_, _, _] = self.corners[..] {
            let off = dot(plus(point, self.corners[0], -1.0), self.normal);
            let foot = plus(point, self.normal, -off);
            let inside = [(0, 1), (1, 2), (2, 0)].into_iter().all(|(a, b)| {
                let (a, b) = ends(a, b);
                dot(cross(plus(b, a, -1.0), plus(foot, a, -1.0)), self.normal) >= 0.0
            });
            if inside {
                return foot;
            }
        }
        let count = self.corners.len();
        let edges = (0..count).map(|a| ends(a, (a + 1) % count));
        let feet = edges.map(|(a, b)| {
            let along = plus(b, a, -1.0);
            let part = dot(plus(point, a, -1.0), along) / dot(along, along);
            plus(a, along, part.clamp(0.0, 1.0))
        });
        let far = |foot: &Point| length(plus(*foot, point, -1.0));
        let nearest = feet.min_by(|a, b| far(a).total_cmp(&far(b)));
        nearest.unwrap_or(self.corners[0])
    }
}

fn plus(a: Point, b: Point, factor: f64) -> Point {
    [0, 1, 2].map(|axis| a[axis] + factor * b[axis])
}

fn dot(a: Point, b: Point) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn length(a: Point) -> f64 {
    dot(a, a).sqrt()
}

fn cross(a: Point, b: Point) -> Point {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}
