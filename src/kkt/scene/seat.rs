//! A contact as it is recorded, beside what the meshes say of the place where it stands.
//!
//! ```text
//! (K12)  Σ b_k = Σ w_j = 1                                  the nodes of either side
//!        low ≤ g₀ ≤ high                                    distances along n of the facets around it
//!        Σ w_j x_j − Σ b_k x_k ∥ n                          the force and what answers it on one line
//!        n                                                  among the normals of both sides there
//! ```
//!
//! Facets around are those of the nodes that the contact moves with, and their neighbours. On a plane of symmetry
//! all this is said of what lies in the plane: mirror images have the rest, turned back.

use nalgebra::Vector3;

use super::measure::Measure;
use super::meeting::Meeting;
use super::supported::{Supported, across};
use crate::body::Body;
use crate::contact::ContactNode;

/// Least cosine between the contact's normal and a way from side to side for it to count.
const ALONG: f64 = 0.1;

/// Part of a facet's size that is round-off, and of weights.
const ROUNDED: f64 = 1e-9;

/// Angle in radian that is round-off.
const DIRECTION: f64 = 1e-6;

/// Part of the range of distances around a contact by which their weighted mean may leave it: weights
/// may be negative.
const OVERSHOOT: f64 = 0.5;

/// Where a contact stands.
#[derive(Clone, Debug)]
pub(super) struct Seat {
    /// Number of the contact.
    pub(super) contact: usize,
    /// Faces around it, of the side that carries it.
    pub(super) faces: Vec<usize>,
    /// Least and greatest distance there along its normal, in metre; reversed where there is none.
    pub(super) distances: [f64; 2],
    /// All ways from side to side there are across its normal, as before a wall.
    beside: bool,
    /// Largest sagitta of both sides there, in metre.
    pub(super) sagitta: f64,
    /// How far both sides' means are from one line along the normal, in metre.
    aside: Measure,
    /// The same along what supports of both sides hold.
    mirrored: f64,
    /// How far its normal is from all between those of both sides there, in metre: as an angle times the
    /// facets' size.
    turned: Measure,
    /// What the weights miss of one, in metre: as large a part of the facets' size.
    pub(super) unshared: Measure,
}

impl Seat {
    pub(super) fn new(
        number: usize,
        contact: &ContactNode,
        meeting: &Meeting,
        bodies: &[Body],
        supported: &Supported,
    ) -> Self {
        let still = supported.still(contact);
        let side = usize::from(contact.second);
        let faces = match meeting.skins.get(side) {
            Some(skin) if skin.body == contact.body => {
                let of_nodes = contact.own.iter().flat_map(|(node, _)| skin.at(*node));
                skin.around(&of_nodes.copied().collect::<Vec<_>>())
            }
            _ => Vec::new(),
        };
        let towards = Vector3::from(contact.frame[0]) * if contact.second { -1.0 } else { 1.0 };
        let (mut distances, mut sagitta) = ([f64::INFINITY, f64::NEG_INFINITY], 0.0_f64);
        let (mut leant, mut size) = (0.0_f64, 0.0_f64);
        let mut beside = !faces.is_empty();
        let mut normals = Vec::new();
        for &face in &faces {
            size = size.max(meeting.skins[side].faces[face].size);
            for sample in meeting.on(side, face).map(|k| &meeting.samples[k]) {
                normals.extend(sample.normals());
                if !still.is_empty() {
                    let in_plane = sample.normals().map(|normal| across(normal, &still));
                    normals.extend(in_plane.filter_map(|normal| normal.try_normalize(ALONG)));
                }
                let cosine = sample.towards.dot(&towards);
                beside &= cosine.abs() <= ALONG;
                if cosine > ALONG {
                    let distance = sample.distance / cosine;
                    distances = [distances[0].min(distance), distances[1].max(distance)];
                    leant = leant.max(distance.abs() * (sample.towards - towards).norm());
                    sagitta = sagitta.max(meeting.sagitta(sample));
                }
            }
        }
        let rounded = ROUNDED * size;
        // A contact that moves with nothing has no facets, and is off all the same.
        let extent = if size > 0.0 { size } else { 1.0 };
        let stray = stray(contact, bodies);
        Self {
            contact: number,
            mirrored: (stray - across(stray, &still)).norm(),
            aside: Measure {
                value: across(stray, &still).norm(),
                explained: leant + 4.0 * sagitta + rounded,
                contact: number,
            },
            turned: turned(number, towards, &normals, size),
            unshared: Measure {
                value: unshared(contact) * extent,
                explained: ROUNDED * extent,
                contact: number,
            },
            faces,
            distances,
            beside,
            sagitta,
        }
    }

    /// (K12) for the gap before loading that is said of the contact, in metre, lengths being known to
    /// `rounded`. Of one that does not press, beside a wall, nothing is said.
    pub(super) fn misplacement(&self, initial_gap: f64, rounded: f64, pressed: bool) -> Measure {
        let [low, high] = self.distances;
        if !pressed && self.beside {
            return Measure::default();
        }
        let outside = (low - initial_gap).max(initial_gap - high).max(0.0);
        let explained = self.sagitta + OVERSHOOT * (high - low).max(0.0) + rounded;
        let mut worst = Measure::new(outside, explained, self.contact);
        for other in [self.aside, self.turned] {
            worst.take(Measure {
                explained: other.explained + rounded,
                ..other
            });
        }
        worst
    }

    /// What a force and its friction, in newton, may leave of the moment, in newton metre.
    pub(super) fn leaning(&self, force: f64, friction: f64) -> f64 {
        let gap = self
            .distances
            .iter()
            .fold(0.0_f64, |most, d| match d.is_finite() {
                true => most.max(d.abs()),
                false => most,
            });
        force * (self.aside.explained + self.mirrored) + friction * (gap + self.sagitta)
    }
}

/// `v − (v · n) n` with `v = Σ w_j x_j − Σ b_k x_k`, in metre; zero against an obstacle.
fn stray(contact: &ContactNode, bodies: &[Body]) -> Vector3<f64> {
    let Some(opposite) = &contact.opposite else {
        return Vector3::zeros();
    };
    let from = Vector3::from(contact.position);
    // Relative to where it stands: large coordinates shall not cost digits.
    let mean = |body: usize, weights: &[(usize, f64)]| -> Vector3<f64> {
        let terms = weights.iter().map(|&(node, weight)| {
            let x = bodies.get(body).and_then(|body| body.mesh.nodes.get(node));
            x.map_or(Vector3::repeat(f64::NAN), |&x| {
                (Vector3::from(x) - from) * weight
            })
        });
        terms.sum()
    };
    let apart = mean(opposite.body, &opposite.nodes) - mean(contact.body, &contact.own);
    let normal = Vector3::from(contact.frame[0]);
    apart - normal * apart.dot(&normal)
}

/// The angle from a direction to the nearest of some normals, beside the largest between these.
fn turned(contact: usize, towards: Vector3<f64>, normals: &[Vector3<f64>], size: f64) -> Measure {
    let away = |from: Vector3<f64>| normals.iter().map(move |normal| (normal - from).norm());
    let nearest = away(towards).fold(f64::INFINITY, f64::min);
    let among = normals
        .first()
        .map_or(0.0, |&first| away(first).fold(0.0, f64::max));
    Measure::new(nearest * size, (among + DIRECTION) * size, contact)
}

/// How far the weights of either side are from adding up to one.
fn unshared(contact: &ContactNode) -> f64 {
    let missed = |weights: &[(usize, f64)]| {
        (weights.iter().map(|(_, weight)| weight).sum::<f64>() - 1.0).abs()
    };
    let opposite = contact.opposite.as_ref();
    missed(&contact.own) + opposite.map_or(0.0, |side| missed(&side.nodes))
}
