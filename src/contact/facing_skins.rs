//! Where the skins of bodies face each other within a distance.
//!
//! ```text
//! facets f, g with  n_f · n_g < −½,   |(c_g − c_f) · m| ≤ d,  m ∥ n_f − n_g,   boxes that overlap across m
//! ```
//!
//! The two sides of a wall do not face each other. Of one skin, facets that face each
//! other are put on two sides so that neighbours are on the same one. What lies over each other by no more than bodies are
//! in each other is a part of their overlap, and no face. Of two skins, facets that face the other one are
//! put together as far as they run on without a corner.
//!
//! c and n: centre and outward normal of a facet. Facets lie in a grid of boxes as large as the largest of them, so that each is
//! compared with its neighbours only.

use std::cell::OnceCell;
use std::collections::{BTreeMap, BTreeSet, HashMap};

use nalgebra::Vector3;

use super::mortar::Overlaps;
use crate::body::{Body, Facet};

/// Cosine between outward normals below which facets face each other: within 60 degrees.
const OPPOSED: f64 = -0.5;

/// Component of the direction across beyond which facets may be apart along an axis.
const LEANING: f64 = 0.5;

/// Part of a wall from which a face as deep behind another one is its far side: facets are compared by their middles.
const WALL: f64 = 0.5;

/// Faces lie over each other by more than so many times what they are in each other.
const WIDE: f64 = 2.0;

/// Part of a facet by which two must overlap.
const ROUND_OFF: f64 = 1e-6;

/// Two facets that face each other.
struct Facing {
    sides: [usize; 2],
    across: Vector3<f64>,
    /// How far they are in each other, in metre.
    depth: f64,
}

/// A facet of a skin.
struct Side {
    facet: Facet,
    centre: Vector3<f64>,
    normal: Vector3<f64>,
    low: Vector3<f64>,
    high: Vector3<f64>,
    dimension: usize,
    /// How far the body reaches behind its middle, in metre, once that was asked.
    wall: OnceCell<f64>,
}

/// The facets of two bodies that face one of the other within a distance, in metre, body by body: together those that run
/// on without a corner on either; none where nothing does.
pub(crate) fn facing_skins(bodies: [&Body; 2], distance: f64) -> Vec<[Vec<Facet>; 2]> {
    let [first, second] = bodies.map(|body| skin(body, body.mesh.boundary_facets()));
    let overlaps = Overlaps::new(&bodies[0].mesh, &bodies[1].mesh);
    let mut pairs = facing(&first, &second, distance, &overlaps);
    let own = first.len();
    pairs.iter_mut().for_each(|pair| pair.sides[1] += own);
    let sides: Vec<Side> = first.into_iter().chain(second).collect();
    // A facet of one body only ever faces one of the other.
    let parts = parts(&sides, &pairs, |side| side >= own).unwrap_or_default();
    let faces = parts
        .into_iter()
        .filter(|part| are_wide(part, &sides, &pairs));
    faces
        .map(|part| part.map(|side| facets(&sides, side)))
        .collect()
}

/// Those of a body's `facets`, running outward, that face another one of them within a distance, in metre, on two
/// sides; none of either where nothing does, nothing where they do not come apart into two sides.
pub(crate) fn facing_itself(
    body: &Body,
    facets_of_skin: Vec<Facet>,
    distance: f64,
) -> Option<[Vec<Facet>; 2]> {
    let sides = skin(body, facets_of_skin);
    let overlaps = Overlaps::new(&body.mesh, &body.mesh);
    let mut pairs = facing(&sides, &sides, distance, &overlaps);
    pairs.retain(|pair| pair.sides[0] < pair.sides[1]);
    let mut found = [Vec::new(), Vec::new()];
    for part in parts(&sides, &pairs, |_| false)? {
        for (all, side) in found.iter_mut().zip(part) {
            all.extend(facets(&sides, side));
        }
    }
    Some(found)
}

fn facets(sides: &[Side], numbers: Vec<usize>) -> Vec<Facet> {
    let facets = numbers.into_iter().map(|at| sides[at].facet.clone());
    facets.collect()
}

/// Facets by number on two sides, ascending, part by part: those of a pair are on different sides of a part, and those
/// that share a node and run on without a corner on one. Nothing where that contradicts itself. `of_second`: whether a
/// facet is of the second of two meshes.
fn parts(
    sides: &[Side],
    pairs: &[Facing],
    of_second: impl Fn(usize) -> bool,
) -> Option<Vec<[Vec<usize>; 2]>> {
    let faced: BTreeSet<usize> = pairs.iter().flat_map(|pair| pair.sides).collect();
    let mut links: BTreeMap<usize, Vec<(usize, bool)>> = BTreeMap::new();
    let mut link = |a: usize, b: usize, turns: bool| {
        links.entry(a).or_default().push((b, turns));
        links.entry(b).or_default().push((a, turns));
    };
    pairs
        .iter()
        .for_each(|pair| link(pair.sides[0], pair.sides[1], true));
    let mut at_node: HashMap<(bool, usize), Vec<usize>> = HashMap::new();
    for &facet in &faced {
        for node in &sides[facet].facet.nodes {
            let others = at_node.entry((of_second(facet), *node)).or_default();
            let along = |other: &&usize| sides[**other].normal.dot(&sides[facet].normal) > -OPPOSED;
            others
                .iter()
                .filter(along)
                .for_each(|&other| link(other, facet, false));
            others.push(facet);
        }
    }
    let mut side_of = BTreeMap::new();
    let mut parts = Vec::new();
    for &start in &faced {
        let mut part = [Vec::new(), Vec::new()];
        let mut open = match side_of.contains_key(&start) {
            true => continue,
            false => vec![(start, false)],
        };
        while let Some((at, second)) = open.pop() {
            match side_of.insert(at, second) {
                Some(before) if before != second => return None,
                Some(_) => {}
                None => {
                    part[usize::from(second)].push(at);
                    let next = links.get(&at).into_iter().flatten();
                    open.extend(next.map(|&(next, turns)| (next, second != turns)));
                }
            }
        }
        part.iter_mut().for_each(|side| side.sort_unstable());
        parts.push(part);
    }
    Some(parts)
}

/// Whether the two sides of a part lie over each other by more than a part of their overlap.
fn are_wide([one, other]: &[Vec<usize>; 2], sides: &[Side], pairs: &[Facing]) -> bool {
    let of_part = pairs
        .iter()
        .filter(|pair| one.binary_search(&pair.sides[0]).is_ok());
    let Some(deepest) = of_part.max_by(|a, b| a.depth.total_cmp(&b.depth)) else {
        return true;
    };
    let [one, other] = [one, other].map(|numbers| {
        let nothing = [f64::INFINITY, f64::NEG_INFINITY].map(Vector3::repeat);
        numbers.iter().fold(nothing, |[low, high], &at| {
            [low.inf(&sides[at].low), high.sup(&sides[at].high)]
        })
    });
    let over = one[1].inf(&other[1]) - one[0].sup(&other[0]);
    let dimension = sides[deepest.sides[0]].dimension;
    let mut beside = (0..dimension).filter(|axis| deepest.across[*axis].abs() <= LEANING);
    deepest.depth == 0.0 || beside.all(|axis| over[axis] > WIDE * deepest.depth)
}

/// Pairs of facets that face each other within a distance, in metre.
fn facing(first: &[Side], second: &[Side], distance: f64, overlaps: &Overlaps<'_>) -> Vec<Facing> {
    let extent = |side: &Side| (side.high - side.low).amax();
    let extents = first.iter().chain(second).map(extent);
    let largest = extents.fold(distance, f64::max);
    let key = |at: Vector3<f64>| -> [i64; 3] { (at / largest).map(|x| x.floor() as i64).into() };
    let mut grid: HashMap<[i64; 3], Vec<usize>> = HashMap::new();
    for (at, side) in second.iter().enumerate() {
        grid.entry(key(side.centre)).or_default().push(at);
    }
    let mut pairs = Vec::new();
    for (own, side) in first.iter().enumerate() {
        let near = around(key(side.centre)).filter_map(|key| grid.get(&key));
        pairs.extend(near.flatten().filter_map(|&other| {
            let (across, gap) = side.faces(&second[other], distance, overlaps)?;
            Some(Facing {
                sides: [own, other],
                across,
                depth: (-gap).max(0.0),
            })
        }));
    }
    pairs
}

/// Keys of the boxes around one, up to two away: as far as half of two facets and a distance reach.
fn around([x, y, z]: [i64; 3]) -> impl Iterator<Item = [i64; 3]> {
    let line = |x: i64| x.saturating_sub(2)..=x.saturating_add(2);
    line(x).flat_map(move |x| line(y).flat_map(move |y| line(z).map(move |z| [x, y, z])))
}

fn skin(body: &Body, facets: Vec<Facet>) -> Vec<Side> {
    let side = |facet: Facet| {
        let nodes = || {
            facet
                .nodes
                .iter()
                .map(|node| Vector3::from(body.mesh.nodes[*node]))
        };
        let corners = facet.corners(body.mesh.dimension).len();
        let start = nodes().next().unwrap_or_default();
        Side {
            centre: nodes().take(corners).sum::<Vector3<f64>>() / corners.max(1) as f64,
            normal: body.mesh.facet_geometry(&facet).normal.into(),
            low: nodes().fold(start, |low, x| low.inf(&x)),
            high: nodes().fold(start, |high, x| high.sup(&x)),
            dimension: body.mesh.dimension,
            wall: OnceCell::new(),
            facet,
        }
    };
    facets.into_iter().map(side).collect()
}

impl Side {
    /// The direction across which it faces another one within a distance, and the gap along that, in metre.
    fn faces(
        &self,
        other: &Self,
        distance: f64,
        overlaps: &Overlaps<'_>,
    ) -> Option<(Vector3<f64>, f64)> {
        if self.normal.dot(&other.normal) >= OPPOSED {
            return None;
        }
        let across = (self.normal - other.normal).normalize();
        let gap = across.dot(&(other.centre - self.centre));
        let far_side = || {
            let deep = -gap > ROUND_OFF * (self.high - self.low).amax();
            let walls = || self.wall(0, overlaps).max(other.wall(1, overlaps));
            deep && -gap >= WALL * walls()
        };
        let face = gap.abs() <= distance && self.covers(other, across, gap) && !far_side();
        face.then_some((across, gap))
    }

    /// How far the body reaches behind the facet, in metre; `side`: 0 for the first body, 1 for the second.
    fn wall(&self, side: usize, overlaps: &Overlaps<'_>) -> f64 {
        let behind = || overlaps.reach(side, self.centre, -self.normal);
        *self.wall.get_or_init(behind)
    }

    /// Whether the two lie over each other, seen `across`, and do not only touch at an edge.
    fn covers(&self, other: &Self, across: Vector3<f64>, gap: f64) -> bool {
        let moved = across * gap;
        let apart = (self.low - (other.high - moved)).sup(&(other.low - moved - self.high));
        let size = (self.high - self.low)
            .amax()
            .max((other.high - other.low).amax());
        let axes = apart.iter().zip(&across).take(self.dimension);
        let over = |(apart, along): (&f64, &f64)| match along.abs() > LEANING {
            true => *apart <= size,
            false => *apart <= -ROUND_OFF * size,
        };
        axes.into_iter().all(over)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::body::tests::samples;
    use crate::body::{CellKind, Model, box_mesh};

    fn block(low: [f64; 3], high: [f64; 3], cells: usize) -> Body {
        let line = |k: usize| crate::body::graded(low[k], high[k], cells, 1.0).unwrap();
        let mesh = box_mesh(&line(0), &line(1), &line(2), CellKind::Hex8).unwrap();
        samples::body(mesh, Model::Solid, 0.3)
    }

    #[test]
    fn only_the_facets_over_each_other_face_each_other() {
        // A unit cube of 4³ cells, 0.01 above the middle of a plate of 3 × 3 m with cells of 0.25 m.
        let cube = block([1.0, 1.0, 0.01], [2.0, 2.0, 1.01], 4);
        let plate = block([0.0, 0.0, -0.5], [3.0, 3.0, 0.0], 12);
        let found = facing_skins([&cube, &plate], 0.02);
        let [[under, above]] = &found[..] else {
            unreachable!("{found:?}")
        };
        assert_eq!(under.len(), 16);
        // 4 × 4 under the cube; those around it only touch it at an edge.
        assert_eq!(above.len(), 16);
        let swapped = &facing_skins([&plate, &cube], 0.02)[0];
        assert_eq!([swapped[1].len(), swapped[0].len()], [16, 16]);
        assert!(facing_skins([&cube, &plate], 0.005).is_empty());
    }

    #[test]
    fn a_slit_is_told_apart_into_its_two_sides_and_a_gap_too_wide_is_none() {
        // A unit square with a slit 0.01 wide and half as deep, from the right.
        let ys = [0.0, 0.2, 0.495, 0.505, 0.8, 1.0];
        let xs = crate::body::graded(0.0, 1.0, 10, 1.0).unwrap();
        let whole = crate::body::rectangle(&xs, &ys, CellKind::Quad4).unwrap();
        let solid: Vec<usize> = (0..50).filter(|cell| !(25..30).contains(cell)).collect();
        let body = samples::body(whole.part(&solid), Model::PlaneStrain, 0.3);
        let found = |distance| {
            let [one, two] = facing_itself(&body, body.mesh.boundary_facets(), distance).unwrap();
            let height = |facet: &Facet| body.mesh.nodes[facet.nodes[0]][1];
            assert!(one.iter().all(|facet| height(facet) == height(&one[0])));
            assert!(two.iter().all(|facet| height(facet) != height(&one[0])));
            [one.len(), two.len()]
        };
        assert_eq!(found(0.02), [5, 5]);
        assert_eq!(found(0.005), [0, 0]);
    }

    #[test]
    fn the_far_sides_of_thick_bodies_do_not_face_each_other() {
        // Side by side: the facets at x = 1 and x = 1.01, none at x = 0 and 2.01, nor above and below.
        let [left, right] = [0.0, 1.01].map(|x| block([x, 0.0, 0.0], [x + 1.0, 1.0, 1.0], 2));
        let found = facing_skins([&left, &right], 0.1);
        assert_eq!(lengths(&found), [[4, 4]]);
    }

    #[test]
    fn faces_on_both_sides_of_a_corner_are_apart_and_the_far_sides_of_thin_plates_are_in_nothing() {
        // An L of 3 × 3 × 3 cells with a cube in its corner, which meets both of its faces.
        let line = [0.0, 1.0, 2.0, 3.0];
        let whole = box_mesh(&line, &line, &line, CellKind::Hex8).unwrap();
        let solid: Vec<usize> = (0..27)
            .filter(|cell| cell % 3 == 0 || cell / 9 == 0)
            .collect();
        let corner = samples::body(whole.part(&solid), Model::Solid, 0.3);
        let cube = block([1.0, 0.0, 1.0], [2.0, 3.0, 2.0], 1);
        let found = facing_skins([&corner, &cube], 0.1);
        assert_eq!(lengths(&found), [[3, 1], [3, 1]]);
        // Two plates, as thin as a tenth of their distance allows: the outer faces are 0.1 behind each other.
        let [low, high] = [0.0, 0.05].map(|z| block([0.0, 0.0, z], [1.0, 1.0, z + 0.05], 2));
        assert_eq!(lengths(&facing_skins([&low, &high], 0.3)), [[4, 4]]);
        assert_eq!(
            facing_itself(&low, low.mesh.boundary_facets(), 0.3),
            Some([vec![], vec![]])
        );
        // What butts against a block, and a little into it, lies over its upper and lower faces by no more than that; so do
        // blocks that meet at an edge.
        let strip = block([0.998, 0.0, 0.02], [2.0, 1.0, 0.04], 1);
        assert_eq!(lengths(&facing_skins([&low, &strip], 0.3)), [[4, 1]]);
        let beside = block([0.999, 0.0, 0.049], [2.0, 1.0, 0.1], 1);
        assert!(facing_skins([&low, &beside], 0.02).is_empty());
        // One in the other by a fifth of its wall touches it.
        let deeper = block([0.0, 0.0, 0.04], [1.0, 1.0, 0.09], 2);
        assert_eq!(lengths(&facing_skins([&low, &deeper], 0.3)), [[4, 4]]);
    }

    fn lengths(parts: &[[Vec<Facet>; 2]]) -> Vec<[usize; 2]> {
        let lengths = parts.iter().map(|part| part.each_ref().map(Vec::len));
        lengths.collect()
    }
}
