//! Contacts at the two ends of a surface that repeats: they are one.
//!
//! Nodes of periodic faces (B14) move alike, so that how their contacts share a force is not unique. The contact
//! of one of them stands for both, with the area of both.

use std::collections::HashMap;

use nalgebra::{Matrix3, Vector3};

use super::ContactNode;
use crate::body::{Body, Tie};

/// Difference of normals, one turned onto the other, that is round-off.
const ROUND_OFF: f64 = 1e-6;

/// Joins contacts with an obstacle at nodes that move alike.
pub(super) fn join(contacts: Vec<ContactNode>, body: &Body) -> Vec<ContactNode> {
    let ties = body.ties.iter().filter_map(|tie| match tie {
        Tie::Pairs(tied) => Some(tied),
        Tie::Rigid(_) => None,
    });
    if ties.clone().next().is_none() {
        return contacts;
    }
    let numbered = contacts.iter().enumerate();
    let number: HashMap<usize, usize> = numbered.map(|(k, contact)| (contact.node, k)).collect();
    // The contact that stands for each.
    let mut stands: Vec<usize> = (0..contacts.len()).collect();
    for tied in ties {
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

/// One contact serves for both: their normals agree, and they move alike as they are seen.
fn alike(one: &ContactNode, other: &ContactNode, rotation: Matrix3<f64>) -> bool {
    let [n, m] = [one, other].map(|contact| Vector3::from(contact.frame[0]));
    let single = one.own.len() == 1 && other.own.len() == 1;
    let parallel = (rotation - Matrix3::identity()).amax() == 0.0;
    one.tangents == other.tangents && (rotation * n - m).norm() < ROUND_OFF && (single || parallel)
}

fn absorb(kept: &mut ContactNode, gone: &ContactNode) {
    let area = kept.area + gone.area;
    let shares = [kept.area / area, gone.area / area];
    let mean = |a: f64, b: f64| shares[0] * a + shares[1] * b;
    if kept.own.len() > 1 {
        kept.own
            .iter_mut()
            .for_each(|(_, weight)| *weight *= shares[0]);
        let others = gone
            .own
            .iter()
            .map(|(node, weight)| (*node, shares[1] * weight));
        kept.own.extend(others);
    }
    kept.initial_gap = mean(kept.initial_gap, gone.initial_gap);
    kept.bulge = mean(kept.bulge, gone.bulge);
    kept.area = area;
}
