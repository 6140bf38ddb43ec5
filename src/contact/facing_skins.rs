//! Where the skins of bodies face each other within a distance.
//!
//! ```text
//! facets f, g with  n_f · n_g < −½,   |(c_g − c_f) · m| ≤ d,  m ∥ n_f − n_g,   boxes that overlap across m
//! ```
//!
//! c and n: centre and outward normal of a facet. Facets lie in a grid of boxes as large as the largest of them, so that each is
//! compared with its neighbours only.

use std::collections::HashMap;

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
    let [first, second] = bodies.map(skin);
    let extent = |side: &Side| (side.high - side.low).amax();
    let largest = first
        .iter()
        .chain(&second)
        .map(extent)
        .fold(distance, f64::max);
    let key = |at: Vector3<f64>| -> [i64; 3] { (at / largest).map(|x| x.floor() as i64).into() };
    let mut grid: HashMap<[i64; 3], Vec<usize>> = HashMap::new();
    for (at, side) in second.iter().enumerate() {
        grid.entry(key(side.centre)).or_default().push(at);
    }
    let mut faced = vec![false; second.len()];
    let mut facing = Vec::new();
    for side in &first {
        let mut any = false;
        for at in around(key(side.centre))
            .filter_map(|key| grid.get(&key))
            .flatten()
        {
            if side.faces(&second[*at], distance) {
                faced[*at] = true;
                any = true;
            }
        }
        if any {
            facing.push(side.facet.clone());
        }
    }
    let other = second.into_iter().zip(faced).filter(|(_, faced)| *faced);
    [facing, other.map(|(side, _)| side.facet).collect()]
}

/// Keys of the boxes around one, up to two away: as far as half of two facets and a distance reach.
fn around([x, y, z]: [i64; 3]) -> impl Iterator<Item = [i64; 3]> {
    let line = |x: i64| x.saturating_sub(2)..=x.saturating_add(2);
    line(x).flat_map(move |x| line(y).flat_map(move |y| line(z).map(move |z| [x, y, z])))
}

fn skin(body: &Body) -> Vec<Side> {
    let facets = body.mesh.boundary_facets().into_iter();
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
    facets.map(side).collect()
}

impl Side {
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
    fn the_far_sides_of_thick_bodies_do_not_face_each_other() {
        // Side by side: the facets at x = 1 and x = 1.01, none at x = 0 and 2.01, nor above and below.
        let [left, right] = [0.0, 1.01].map(|x| block([x, 0.0, 0.0], [x + 1.0, 1.0, 1.0], 2));
        let found = facing_skins([&left, &right], 0.1);
        assert_eq!(found.map(|facets| facets.len()), [4, 4]);
    }
}
