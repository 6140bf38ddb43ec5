//! Contacts beyond the end of the cover move to it, in 2D.
//!
//! ```text
//! φ_0 = (b − s)/(b − a),  φ_1 = (s − a)/(b − a)       a ≤ s ≤ b: the covered part of the facet
//! ```
//!
//! Were the functions those of the whole facet, a reaction at a corner beyond the cover would be a
//! pressure of two signs on the covered part, whose resultant acts at the corner: blocks would stand
//! that topple. With the functions of the covered part every resultant of pressures is one of a
//! pressure that is nowhere negative, and the other way round: a unit force can stand anywhere on the
//! cover, and nowhere else.

use nalgebra::Vector3;

use super::coverage::Coverage;
use super::patch::{MOST_CONTACTS, Member, Patch, Stand};

/// Part of a facet's length up to which the cover ends at its end.
const AT_END: f64 = 1e-9;

/// Facets in a row with the functions of the two contacts at its ends.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Strip {
    /// Numbers and lengths of the facets, in outward order, in metre.
    pub(super) facets: Vec<(usize, f64)>,
    pub(super) ends: [Stand; 2],
    /// Where they stand, in metre from where the first facet starts.
    pub(super) range: [f64; 2],
}

/// A strip per facet that is covered at all.
pub(super) fn strips(coverage: &Coverage<'_>) -> Vec<Strip> {
    let facets = 0..coverage.one.facets.len();
    facets.filter_map(|facet| strip(coverage, facet)).collect()
}

fn strip(coverage: &Coverage<'_>, facet: usize) -> Option<Strip> {
    let [low, high] = range(coverage, facet)?;
    let &[start, end] = coverage.one.corners_of(facet) else {
        return None;
    };
    let moved = |node| Stand {
        node,
        moved: Some(facet),
    };
    let (first, from) = match low > 0.0 {
        true => (moved(start), low),
        false => (Stand::at(start), 0.0),
    };
    let (last, to) = match high < 1.0 {
        true => (moved(end), high),
        false => (Stand::at(end), 1.0),
    };
    let nodes = &coverage.one.mesh.nodes;
    let length = (Vector3::from(nodes[end]) - Vector3::from(nodes[start])).norm();
    (to > from).then(|| Strip {
        facets: vec![(facet, length)],
        ends: [first, last],
        range: [from * length, to * length],
    })
}

/// Where the cover of a facet starts and ends, as parts of its length; none without cover.
fn range(coverage: &Coverage<'_>, facet: usize) -> Option<[f64; 2]> {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for (piece, seen) in coverage.of(facet) {
        for at in seen.parts.iter().flat_map(|part| &part.polygon) {
            let along = piece.hats(&seen.outline.shape(*at))[1];
            (low, high) = (low.min(along), high.max(along));
        }
    }
    let from = if low > AT_END { low } else { 0.0 };
    let to = if high < 1.0 - AT_END { high } else { 1.0 };
    (low < high).then_some([from, to])
}

impl Strip {
    /// Covered part of its length.
    pub(super) fn share(&self) -> f64 {
        let length: f64 = self.facets.iter().map(|(_, length)| length).sum();
        (self.range[1] - self.range[0]) / length
    }

    /// Its facets with the functions of its ends (C19).
    pub(super) fn patch(&self) -> Patch {
        let [from, to] = self.range;
        let last = |at: f64| (at - from) / (to - from);
        let mut start = 0.0;
        let mut members = Vec::with_capacity(self.facets.len());
        for &(facet, length) in &self.facets {
            let ends = [start, start + length].map(last);
            members.push(Member {
                facet,
                values: rows(ends.map(|value| 1.0 - value), ends),
            });
            start += length;
        }
        let along = |at: f64| [1.0 - at / start, at / start];
        Patch {
            stands: self.ends.to_vec(),
            shares: (members.len() == 1).then(|| rows(along(from), along(to))),
            members,
        }
    }
}

fn rows(first: [f64; 2], second: [f64; 2]) -> [[f64; 4]; MOST_CONTACTS] {
    let row = |[a, b]: [f64; 2]| [a, b, 0.0, 0.0];
    [row(first), row(second), [0.0; 4], [0.0; 4]]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn strip_of(range: [f64; 2]) -> Strip {
        Strip {
            facets: vec![(3, 2.0)],
            ends: [Stand::at(7), Stand::at(8)],
            range,
        }
    }

    #[test]
    fn functions_are_one_where_their_contact_stands_and_zero_at_the_other() {
        let patch = strip_of([0.5, 1.5]).patch();
        for (contact, share) in patch.shares.into_iter().flatten().take(2).enumerate() {
            let values = patch.members[0].functions(&share);
            let expected = [0.0, 1.0].map(|other| if other == contact as f64 { 1.0 } else { 0.0 });
            assert!((values[0] - expected[0]).abs() < 1e-15);
            assert!((values[1] - expected[1]).abs() < 1e-15);
        }
    }

    #[test]
    fn a_facet_covered_whole_keeps_the_functions_of_its_corners() {
        assert_eq!(
            strip_of([0.0, 2.0]).patch().members,
            Patch::whole(3, &[7, 8]).members
        );
        assert_eq!(
            strip_of([0.0, 2.0]).patch().shares,
            Patch::whole(3, &[7, 8]).shares
        );
        assert_eq!(strip_of([0.0, 0.5]).share(), 0.25);
    }
}
