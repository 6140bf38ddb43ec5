//! Short pieces at the end of the cover are joined with the next facet, in 2D.
//!
//! A piece a hundredth of a facet long would be a contact of a hundredth of the area, with a pressure
//! of its own that the mesh cannot tell from its neighbour's. Joined, the piece and the facet have the
//! two functions that go linearly from the end of the cover to the facet's far end; the node between
//! is no contact. Across a corner nothing is joined.

use std::collections::HashMap;

use nalgebra::Vector3;

use super::super::turn::{CORNER, turn};
use super::check::Surface;
use super::trim::Strip;

/// Covered part of a facet below which its piece is short.
const SHORT: f64 = 0.5;

/// The strips with those joined that are short, in the order of their longer parts.
pub(super) fn join(strips: Vec<Strip>, surface: &Surface<'_>) -> Vec<Strip> {
    let ending = [0, 1].map(|end| strips_at(&strips, end));
    let mut strips: Vec<Option<Strip>> = strips.into_iter().map(Some).collect();
    for index in 0..strips.len() {
        let Some((inner, node)) = strips[index].as_ref().and_then(short) else {
            continue;
        };
        // What starts where this one ends, or ends where it starts.
        let neighbour = ending[1 - inner].get(&node).copied().flatten();
        let Some(other) = neighbour.filter(|other| *other != index) else {
            continue;
        };
        let pair = [&strips[index], &strips[other]].map(Option::as_ref);
        let [Some(this), Some(next)] = pair else {
            continue;
        };
        let [before, after] = if inner == 1 {
            [this, next]
        } else {
            [next, this]
        };
        if goes_on(surface, before, after) {
            strips[other] = Some(chained(before, after));
            strips[index] = None;
        }
    }
    strips.into_iter().flatten().collect()
}

/// The end (0 or 1) at which a short piece reaches a node, and the node.
fn short(strip: &Strip) -> Option<(usize, usize)> {
    let moved = strip.ends.map(|end| end.moved.is_some());
    let inner = match moved {
        [true, false] => 1,
        [false, true] => 0,
        _ => return None,
    };
    (strip.facets.len() == 1 && strip.share() < SHORT).then(|| (inner, strip.ends[inner].node))
}

/// Which strip reaches a node with its first (0) or last (1) end; none where several do.
fn strips_at(strips: &[Strip], end: usize) -> HashMap<usize, Option<usize>> {
    let mut at = HashMap::new();
    for (index, strip) in strips.iter().enumerate() {
        if strip.ends[end].moved.is_none() {
            at.entry(strip.ends[end].node)
                .and_modify(|only| *only = None)
                .or_insert(Some(index));
        }
    }
    at
}

/// Whether the surface turns no corner from the one strip to the next.
fn goes_on(surface: &Surface<'_>, before: &Strip, after: &Strip) -> bool {
    let line = |facet: Option<&(usize, f64)>| match facet.map(|at| surface.corners_of(at.0)) {
        Some(&[start, end]) => {
            let at = |node: usize| Vector3::from(surface.mesh.nodes[node]);
            at(end) - at(start)
        }
        _ => Vector3::zeros(),
    };
    let [before, after] = [line(before.facets.last()), line(after.facets.first())];
    turn(before, after).abs() < CORNER
}

fn chained(before: &Strip, after: &Strip) -> Strip {
    let length: f64 = before.facets.iter().map(|(_, length)| length).sum();
    Strip {
        facets: [&before.facets[..], &after.facets[..]].concat(),
        ends: [before.ends[0], after.ends[1]],
        range: [before.range[0], length + after.range[1]],
    }
}
