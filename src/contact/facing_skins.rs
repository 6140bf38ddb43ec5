//! Where the skins of bodies face each other within a distance.
//!
//! ```text
//! facets f, g with  n_f · n_g < −½,   |(c_g − c_f) · m| ≤ d,  m ∥ n_f − n_g,   boxes that overlap across m
//! ```
//!
//! Of one skin, facets that share a node do not face each other, and those that face each other are put on two sides so
//! that neighbours are on the same one.
//!
//! c and n: centre and outward normal of a facet. Facets lie in a grid of boxes as large as the largest of them, so that each is
//! compared with its neighbours only.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use nalgebra::Vector3;

use crate::body::{Body, Facet};

/// Cosine between outward normals below which facets face each other: within 60 degrees.
const OPPOSED: f64 = -0.5;

/// Component of the direction across beyond which facets may be apart along an axis.
const LEANING: f64 = 0.5;

/// Part of a facet by which two must overlap.
const ROUND_OFF: f64 = 1e-6;

/// A facet of a skin.
struct Side {
    facet: Facet,
    centre: Vector3<f64>,
    normal: Vector3<f64>,
    low: Vector3<f64>,
    high: Vector3<f64>,
    dimension: usize,
}

/// The facets of two bodies that face one of the other within a distance, in metre, body by body; none of either
/// where nothing does.
pub(crate) fn facing_skins(bodies: [&Body; 2], distance: f64) -> [Vec<Facet>; 2] {
    let [first, second] = bodies.map(|body| skin(body, body.mesh.boundary_facets()));
    let pairs = facing(&first, &second, distance);
    let of = |side: &[Side], at: fn(&[usize; 2]) -> usize| {
        let faced: BTreeSet<usize> = pairs.iter().map(at).collect();
        faced.into_iter().map(|at| side[at].facet.clone()).collect()
    };
    [of(&first, |pair| pair[0]), of(&second, |pair| pair[1])]
}

/// Those of a body's `facets`, running outward, that face another one of them within a distance, in metre, on two
/// sides; none of either where nothing does, nothing where they do not come apart into two sides.
pub(crate) fn facing_itself(
    body: &Body,
    facets: Vec<Facet>,
    distance: f64,
) -> Option<[Vec<Facet>; 2]> {
    let sides = skin(body, facets);
    let mut pairs = facing(&sides, &sides, distance);
    pairs.retain(|&[a, b]| a < b && !sides[a].neighbours(&sides[b]));
    let faced: BTreeSet<usize> = pairs.iter().flatten().copied().collect();
    let mut links: BTreeMap<usize, Vec<(usize, bool)>> = BTreeMap::new();
    let mut link = |a: usize, b: usize, turns: bool| {
        links.entry(a).or_default().push((b, turns));
        links.entry(b).or_default().push((a, turns));
    };
    pairs.iter().for_each(|&[a, b]| link(a, b, true));
    let mut at_node: HashMap<usize, Vec<usize>> = HashMap::new();
    for &facet in &faced {
        for node in &sides[facet].facet.nodes {
            let others = at_node.entry(*node).or_default();
            let along = |other: &&usize| sides[**other].normal.dot(&sides[facet].normal) > -OPPOSED;
            others
                .iter()
                .filter(along)
                .for_each(|&other| link(other, facet, false));
            others.push(facet);
        }
    }
    let second = two_sides(&faced, &links)?;
    let of = |on: bool| {
        let of_side = second.iter().filter(|(_, second)| **second == on);
        of_side.map(|(&at, _)| sides[at].facet.clone()).collect()
    };
    Some([of(false), of(true)])
}

/// Which of some facets are on the second side, from links that change sides or do not; nothing where they contradict
/// each other.
fn two_sides(
    faced: &BTreeSet<usize>,
    links: &BTreeMap<usize, Vec<(usize, bool)>>,
) -> Option<BTreeMap<usize, bool>> {
    let mut second = BTreeMap::new();
    for &start in faced {
        let mut open = match second.contains_key(&start) {
            true => Vec::new(),
            false => vec![(start, false)],
        };
        while let Some((at, side)) = open.pop() {
            match second.insert(at, side) {
                Some(before) if before != side => return None,
                Some(_) => {}
                None => {
                    let next = links.get(&at).into_iter().flatten();
                    open.extend(next.map(|&(next, turns)| (next, side != turns)));
                }
            }
        }
    }
    Some(second)
}

/// Pairs of facets that face each other within a distance, in metre.
fn facing(first: &[Side], second: &[Side], distance: f64) -> Vec<[usize; 2]> {
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
        let facing = near
            .flatten()
            .filter(|at| side.faces(&second[**at], distance));
        pairs.extend(facing.map(|&other| [own, other]));
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
            facet,
        }
    };
    facets.into_iter().map(side).collect()
}

impl Side {
    fn neighbours(&self, other: &Self) -> bool {
        self.facet
            .nodes
            .iter()
            .any(|node| other.facet.nodes.contains(node))
    }

    fn faces(&self, other: &Self, distance: f64) -> bool {
        if self.normal.dot(&other.normal) >= OPPOSED {
            return false;
        }
        let across = (self.normal - other.normal).normalize();
        let gap = across.dot(&(other.centre - self.centre));
        gap.abs() <= distance && self.covers(other, across, gap)
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
        let [under, above] = facing_skins([&cube, &plate], 0.02);
        assert_eq!(under.len(), 16);
        // 4 × 4 under the cube; those around it only touch it at an edge.
        assert_eq!(above.len(), 16);
        let swapped = facing_skins([&plate, &cube], 0.02);
        assert_eq!([swapped[1].len(), swapped[0].len()], [16, 16]);
        assert!(
            facing_skins([&cube, &plate], 0.005)
                .iter()
                .all(Vec::is_empty)
        );
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
        assert_eq!(found.map(|facets| facets.len()), [4, 4]);
    }
}
