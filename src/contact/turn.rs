//! Turns between facets: which are round, which are corners of the body, which are none.

use nalgebra::Vector3;

use crate::body::{Facet, FacetReference, Mesh};

/// Turn in radian from which the edge between two facets is one of the body's own, 34°.
pub(super) const CORNER: f64 = 0.6;

/// Turn in radian that is none: coordinates may come with seven digits.
pub(super) const STRAIGHT: f64 = 1e-6;

/// How many times as long as its neighbour a facet may be to have a part in its curvature: a long one beside
/// a short one is a flat that goes over into a fillet.
pub(super) const UNLIKE: f64 = 3.0;

/// A facet that turns at its ends by less than this part of what the surface does behind them is a flat between arcs.
pub(super) const FLAT: f64 = 0.6;

/// Departure from straight sides, relative to the size of the facet, that is round-off.
const ON_SIDE: f64 = 1e-10;

/// Of two curvatures or turns the smaller one; zero where they are of unlike sign.
pub(super) fn smaller(ends: [Option<f64>; 2]) -> f64 {
    match ends {
        [Some(a), Some(b)] if a * b <= 0.0 => 0.0,
        [Some(a), Some(b)] if a.abs() < b.abs() => a,
        [_, Some(b)] => b,
        [Some(a), None] => a,
        [None, None] => 0.0,
    }
}

/// Angle in radian from one line to the next, positive where the body is convex: it lies on the left.
pub(super) fn turn(before: Vector3<f64>, after: Vector3<f64>) -> f64 {
    before.cross(&after).z.atan2(before.dot(&after))
}

/// Whether the nodes between corners are where straight sides have them.
pub(super) fn is_straight(mesh: &Mesh, facet: &Facet) -> bool {
    let Some(reference) = FacetReference::of(mesh.dimension, facet.nodes.len()) else {
        return true;
    };
    let x = |node: &usize| Vector3::from(mesh.nodes[*node]);
    let corners: Vec<_> = facet.corners(mesh.dimension).iter().map(x).collect();
    let size = corners.iter().map(|c| (c - corners[0]).norm());
    let allowed = ON_SIDE * size.fold(0.0, f64::max);
    facet.nodes.iter().zip(reference.nodes()).all(|(node, at)| {
        let terms = corners.iter().zip(reference.hats(*at));
        let straight: Vector3<f64> = terms.map(|(corner, hat)| corner * hat).sum();
        (x(node) - straight).norm() <= allowed
    })
}
