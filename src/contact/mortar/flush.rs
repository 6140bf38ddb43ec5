//! Where both sides end flush they end together, in 2D.
//!
//! Facets are looked at along their normals. Where these lean, as at a symmetry plane that cuts facets of
//! an arc, and the sides are apart, an end that stands above the facet's own is seen beside it, and part of
//! the facet would be bare although neither body goes on there. The ends are flush where one of them stands on the line
//! along which the other body's boundary goes on; then what covers the facet is taken to cover it up to its end.
//! Ends that are not flush are where they are seen.

use nalgebra::Vector3;

use super::check::Surface;
use super::seen::Seen;

/// Distance from a flank, as part of a facet, that is none: coordinates may come with five digits.
const ON_FLANK: f64 = 1e-4;

/// Part of a facet that is round-off.
const ROUND_OFF: f64 = 1e-12;

/// Stretches the cover of a piece up to its ends where both sides end flush.
pub(super) fn reach_flush_ends(
    one: &Surface<'_>,
    two: &Surface<'_>,
    piece: usize,
    seen: &mut Seen,
) {
    for (end, node) in one.corners[piece].nodes.iter().enumerate() {
        if !one.flanks.contains_key(node) {
            continue;
        }
        let to = seen.outline.corners()[end].x;
        let from_end = |x: f64| (x - to).abs();
        // What covers the piece nearest to its end, and the end of that.
        let ends = seen.parts.iter().enumerate().flat_map(|(part, covering)| {
            let corners = covering.outline.corners().iter();
            let nodes = &two.corners[covering.opposite].nodes;
            let ends = corners.zip(nodes);
            ends.map(move |(corner, across)| (part, corner.x, *across))
        });
        let nearest = ends.min_by(|a, b| from_end(a.1).total_cmp(&from_end(b.1)));
        let Some((part, last, across)) = nearest else {
            continue;
        };
        if are_flush([one, two], [*node, across], seen.view.size) {
            let polygon = seen.parts[part].polygon.iter_mut();
            for at in polygon.filter(|at| (at.x - last).abs() <= ROUND_OFF) {
                at.x = to;
            }
        }
    }
}

/// Whether the last nodes of two sides stand on one flank, on facets of such a size in metre.
fn are_flush(sides: [&Surface<'_>; 2], nodes: [usize; 2], size: f64) -> bool {
    let [one, two] = [0, 1].map(|side| Vector3::from(sides[side].mesh.nodes[nodes[side]]));
    let between = two - one;
    (0..2).any(|side| {
        let flank = sides[side].flanks.get(&nodes[side]);
        let both = sides[1 - side].flanks.contains_key(&nodes[1 - side]);
        flank.is_some_and(|flank| {
            both && between.cross(flank).norm() <= ON_FLANK * size * flank.norm()
        })
    })
}
