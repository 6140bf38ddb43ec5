//! Contacts at the two ends of a surface that repeats: they are one.
//!
//! Nodes of periodic faces (B14) move alike, so that how their contacts share a force is not unique. The contact
//! of one of them stands for both, with the area of both.

use std::collections::HashMap;

use nalgebra::{Matrix3, Vector3};

use super::ContactNode;
use super::frame::Stance;
use super::held::Directions;
use crate::body::{Body, Tie, TiedPairs};

/// Difference of normals, one turned onto the other, and of shifts that is round-off.
const ROUND_OFF: f64 = 1e-6;

/// Difference of normals of two bodies' facets on both sides of a seam, at most: half a radian.
const TURNED: f64 = 0.5;

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
    let mut joined: Vec<Option<ContactNode>> = contacts.into_iter().map(Some).collect();
    // The contact that stands for each.
    let mut stands: Vec<usize> = (0..joined.len()).collect();
    for tied in ties(own) {
        let seam = Seam::new(tied, own, across);
        for [a, b] in &tied.pairs {
            let (Some(&one), Some(&other)) = (number.get(a), number.get(b)) else {
                continue;
            };
            let (kept, gone) = (stands[one], stands[other]);
            if kept == gone {
                continue;
            }
            let whole = match (&joined[kept], &joined[gone]) {
                (Some(kept), Some(gone)) => seam.join(kept, gone),
                _ => None,
            };
            if let Some(whole) = whole {
                (joined[kept], joined[gone]) = (Some(whole), None);
                let ends = stands.iter_mut().filter(|contact| **contact == gone);
                ends.for_each(|contact| *contact = kept);
            }
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

/// How a body repeats, and how what it meets does.
struct Seam {
    dimension: usize,
    rotation: Matrix3<f64>,
    across: Across,
}

/// What a body that repeats meets.
enum Across {
    Obstacle,
    /// A body that repeats alike.
    Alike,
    /// One that does not.
    Other,
}

impl Seam {
    fn new(tied: &TiedPairs, own: &Body, across: Option<&Body>) -> Self {
        let across = match across {
            None => Across::Obstacle,
            Some(across) => {
                match ties(across).any(|other| repeat_alike([tied, other], [own, across])) {
                    true => Across::Alike,
                    false => Across::Other,
                }
            }
        };
        Self {
            dimension: own.mesh.dimension,
            rotation: rotation(tied),
            across,
        }
    }

    /// One contact for two that move alike as they are seen; none if they do not.
    fn join(&self, kept: &ContactNode, gone: &ContactNode) -> Option<ContactNode> {
        let parallel = self.rotation == Matrix3::identity();
        let single = kept.own.len() == 1 && gone.own.len() == 1;
        if kept.tangents != gone.tangents || !(single || parallel) {
            return None;
        }
        let area = kept.area + gone.area;
        let shares = [kept.area / area, gone.area / area];
        let mean = |a: f64, b: f64| shares[0] * a + shares[1] * b;
        let mut whole = ContactNode {
            initial_gap: mean(kept.initial_gap, gone.initial_gap),
            bulge: mean(kept.bulge, gone.bulge),
            area,
            ..kept.clone()
        };
        let mix = |kept: &mut Vec<(usize, f64)>, gone: &[(usize, f64)]| {
            kept.iter_mut().for_each(|(_, weight)| *weight *= shares[0]);
            let others = gone
                .iter()
                .map(|(node, weight)| (*node, shares[1] * weight));
            kept.extend(others);
        };
        let normals = [
            Vector3::from(kept.frame[0]),
            self.rotation.transpose() * Vector3::from(gone.frame[0]),
        ];
        let turned = (normals[0] - normals[1]).norm();
        match (&self.across, &mut whole.opposite, &gone.opposite) {
            (Across::Obstacle, _, _) if turned < ROUND_OFF => {
                if !single {
                    mix(&mut whole.own, &gone.own);
                }
            }
            (Across::Alike, Some(opposite), Some(far)) if parallel && turned < TURNED => {
                // A force goes on as the means of both ends, lest it have a moment.
                mix(&mut whole.own, &gone.own);
                mix(&mut opposite.nodes, &far.nodes);
                if turned > ROUND_OFF {
                    whole.frame =
                        self.frame(normals[0] * shares[0] + normals[1] * shares[1], kept)?;
                }
            }
            _ => return None,
        }
        Some(whole)
    }

    /// Axes around the mean of both ends' normals; none where supports hold a tangent.
    fn frame(&self, normal: Vector3<f64>, kept: &ContactNode) -> Option<[[f64; 3]; 3]> {
        if kept.tangents != 0 && kept.tangents + 1 != self.dimension {
            return None;
        }
        let normal = normal.normalize().into();
        match Stance::new(self.dimension, normal, &Directions(Vec::new())) {
            Stance::Free { frame, .. } => Some(frame),
            Stance::Held | Stance::Askew => None,
        }
    }
}

fn rotation(tied: &TiedPairs) -> Matrix3<f64> {
    Matrix3::from_fn(|i, j| tied.rotation[i][j])
}

/// Whether two bodies repeat along the same way, without a turn.
fn repeat_alike(tied: [&TiedPairs; 2], bodies: [&Body; 2]) -> bool {
    let shifts = [0, 1].map(|k| {
        let ends = tied[k].pairs.first()?;
        let [a, b] = ends.map(|node| Vector3::from(bodies[k].mesh.nodes[node]));
        (rotation(tied[k]) == Matrix3::identity()).then(|| b - a)
    });
    let [Some(one), Some(other)] = shifts else {
        return false;
    };
    let apart = (one - other).norm().min((one + other).norm());
    apart < ROUND_OFF * one.norm()
}
