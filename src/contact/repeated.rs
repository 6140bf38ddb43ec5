//! Contacts at the two ends of a surface that repeats: they are one.
//!
//! Nodes of periodic faces (B14) move alike, so that how their contacts share a force is not unique. The contact
//! of one of them stands for both, with the area of both.

use std::collections::HashMap;

use nalgebra::{Matrix3, Vector3};

use super::ContactNode;
use crate::body::{Body, Tie, TiedPairs};

/// Difference of normals, one turned onto the other, that is round-off.
const ROUND_OFF: f64 = 1e-6;

/// Joins contacts at nodes that move alike: with an obstacle, or with a body that repeats as theirs does.
pub(super) fn join(contacts: Vec<ContactNode>, bodies: &[Body]) -> Vec<ContactNode> {
    let Some(first) = contacts.first() else {
        return contacts;
    };
    let own = &bodies[first.body];
    let across = first.opposite.as_ref().map(|side| &bodies[side.body]);
    if ties(own).next().is_none() {
        return contacts;
    }
    let numbered = contacts.iter().enumerate();
    let number: HashMap<usize, usize> = numbered.map(|(k, contact)| (contact.node, k)).collect();
    // The contact that stands for each.
    let mut stands: Vec<usize> = (0..contacts.len()).collect();
    for tied in ties(own).filter(|tied| across.is_none_or(|across| repeats(tied, own, across))) {
        let rotation = Matrix3::from_fn(|i, j| tied.rotation[i][j]);
        for [a, b] in &tied.pairs {
            let (Some(&one), Some(&other)) = (number.get(a), number.get(b)) else {
                continue;
            };
            if alike(&contacts[one], &contacts[other], rotation) {
                let (kept, gone) = (stands[one], stands[other]);
                let ends = stands.iter_mut().filter(|contact| **contact == gone);
                ends.for_each(|contact| *contact = kept);
            }
        }
    }
    let mut joined: Vec<Option<ContactNode>> = contacts.into_iter().map(Some).collect();
    for (contact, &to) in stands.iter().enumerate().filter(|(k, to)| k != *to) {
        if let (Some(gone), Some(kept)) = (joined[contact].take(), joined[to].as_mut()) {
            absorb(kept, &gone);
        }
    }
    joined.into_iter().flatten().collect()
}

fn ties(body: &Body) -> impl Iterator<Item = &TiedPairs> {
    body.ties.iter().filter_map(|tie| match tie {
        Tie::Pairs(tied) => Some(tied),
        Tie::Rigid(_) => None,
    })
}

/// Whether another body repeats along the same way, without a turn.
fn repeats(tied: &TiedPairs, body: &Body, other: &Body) -> bool {
    let shift = |body: &Body, tied: &TiedPairs| {
        let ends = tied
            .pairs
            .first()?
            .map(|node| Vector3::from(body.mesh.nodes[node]));
        let straight = Matrix3::from_fn(|i, j| tied.rotation[i][j]) == Matrix3::identity();
        straight.then(|| ends[1] - ends[0])
    };
    let Some(own) = shift(body, tied) else {
        return false;
    };
    let mut shifts = ties(other).filter_map(|tied| shift(other, tied));
    shifts.any(|shift| {
        let apart = (shift - own).norm().min((shift + own).norm());
        apart < ROUND_OFF * own.norm()
    })
}

/// One contact serves for both: their normals agree, and they move alike as they are seen.
fn alike(one: &ContactNode, other: &ContactNode, rotation: Matrix3<f64>) -> bool {
    let [n, m] = [one, other].map(|contact| Vector3::from(contact.frame[0]));
    let single = one.own.len() == 1 && other.own.len() == 1;
    let parallel = (rotation - Matrix3::identity()).amax() == 0.0;
    one.tangents == other.tangents && (rotation * n - m).norm() < ROUND_OFF && (single || parallel)
}

/// A force between bodies goes on as the means of both ends, lest it have a moment.
fn absorb(kept: &mut ContactNode, gone: &ContactNode) {
    let area = kept.area + gone.area;
    let shares = [kept.area / area, gone.area / area];
    let mean = |a: f64, b: f64| shares[0] * a + shares[1] * b;
    let mix = |kept: &mut Vec<(usize, f64)>, gone: &[(usize, f64)]| {
        kept.iter_mut().for_each(|(_, weight)| *weight *= shares[0]);
        let others = gone
            .iter()
            .map(|(node, weight)| (*node, shares[1] * weight));
        kept.extend(others);
    };
    if kept.own.len() > 1 || kept.opposite.is_some() {
        mix(&mut kept.own, &gone.own);
    }
    if let (Some(kept), Some(gone)) = (&mut kept.opposite, &gone.opposite) {
        mix(&mut kept.nodes, &gone.nodes);
    }
    kept.initial_gap = mean(kept.initial_gap, gone.initial_gap);
    kept.bulge = mean(kept.bulge, gone.bulge);
    kept.area = area;
}
