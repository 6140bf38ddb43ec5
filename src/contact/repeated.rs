//! Contacts at the two ends of a surface that repeats: they are one.
//!
//! Nodes of periodic faces (B14) move alike, so that how their contacts share a force is not unique. The contact
//! of one of them stands for both, with the area of both. Between two bodies it moves with the mean of what both move with; where
//! they repeat around an axis, whose turn no weight can make, with what it moves with itself.

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

/// The faces on which a body repeats, by node.
#[derive(Debug, Default)]
pub(super) struct Seams(HashMap<usize, Vec<Image>>);

/// What a node moves with at the other end.
#[derive(Debug)]
pub(super) struct Image {
    pub(super) node: usize,
    /// Turns what is there to what is seen here.
    pub(super) turn: Matrix3<f64>,
    /// Number of the tie, and whether it is the face that depends.
    face: (usize, bool),
}

impl Seams {
    pub(super) fn new(body: &Body) -> Self {
        let mut seams = Self::default();
        for (number, tied) in ties(body).enumerate() {
            let turn = rotation(tied);
            for &[a, b] in &tied.pairs {
                let faces = [(a, b, turn.transpose(), false), (b, a, turn, true)];
                for (here, node, turn, depends) in faces {
                    let face = (number, depends);
                    seams
                        .0
                        .entry(here)
                        .or_default()
                        .push(Image { node, turn, face });
                }
            }
        }
        seams
    }

    /// The image of a node in whose face another one lies as well.
    pub(super) fn beyond(&self, node: usize, other: usize) -> Option<&Image> {
        let of_other = self.0.get(&other)?;
        let images = self.0.get(&node)?;
        images
            .iter()
            .find(|image| of_other.iter().any(|of| of.face == image.face))
    }
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
            (Across::Alike, Some(opposite), Some(far)) if turned < TURNED => {
                if parallel {
                    // A force goes on as the means of both ends, lest it have a moment.
                    mix(&mut whole.own, &gone.own);
                    mix(&mut opposite.nodes, &far.nodes);
                }
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

/// Whether two bodies repeat along the same way, or around the same axis by the same angle, from either end.
fn repeat_alike(tied: [&TiedPairs; 2], bodies: [&Body; 2]) -> bool {
    let maps = [0, 1].map(|k| {
        let ends = tied[k].pairs.first()?;
        let [a, b] = ends.map(|node| Vector3::from(bodies[k].mesh.nodes[node]));
        let turn = rotation(tied[k]);
        Some((turn, b - turn * a, a.norm().max(b.norm())))
    });
    let [Some((turn, shift, size)), Some((other, way, far))] = maps else {
        return false;
    };
    let scale = match turn == Matrix3::identity() {
        true => shift.norm(),
        false => size.max(far),
    };
    let same = |turn: Matrix3<f64>, shift: Vector3<f64>| {
        (turn - other).norm() < ROUND_OFF && (shift - way).norm() < ROUND_OFF * scale
    };
    let back = turn.transpose();
    same(turn, shift) || same(back, -(back * shift))
}
