//! Distances between deformed sides, in the linear theory that the bodies are solved in.
//!
//! ```text
//! (K13)  g = d + (u²(q) − u¹(p)) · m       p, q, m, d: a sample's points, direction, distance before loading
//!        max g ≥ 0                         around every contact: nowhere is all of a side in the other
//!        min g ≤ 0                         around a pressed contact: what presses touches
//! ```
//!
//! Laws hold for means over facets. What a point may depart from them is what the facets around it depart
//! from each other: their sagittas, what the distance is off linear over a facet, and for what touches the change of the relative displacement over them.

use nalgebra::Vector3;

use super::measure::Measure;
use super::meeting::{Meeting, Sample};
use super::skin::{Place, Skin};
use crate::contact::RigidMotion;

/// Part of the change of the relative displacement around a contact by which all of its surroundings
/// may stand off the other side: the mean under a weight of two signs is none of its values.
const OVERSHOOT: f64 = 0.5;

/// Least and greatest of some values.
#[derive(Clone, Copy, Debug)]
pub(super) struct Range {
    pub(super) low: f64,
    pub(super) high: f64,
}

impl Range {
    const NONE: Self = Self {
        low: f64::INFINITY,
        high: f64::NEG_INFINITY,
    };

    fn with(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }

    /// A NaN is all values.
    fn of(value: f64) -> Self {
        match value.is_nan() {
            true => Self {
                low: f64::NEG_INFINITY,
                high: f64::INFINITY,
            },
            false => Self {
                low: value,
                high: value,
            },
        }
    }
}

/// What the samples on some faces say.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nearby {
    /// g of (K13), in metre.
    pub(super) gap: Range,
    /// `(u² − u¹) · m`, in metre.
    approach: Range,
    /// Largest sagitta of both sides, in metre.
    sagitta: f64,
    /// How far the distance before loading is from linear over a face, in metre.
    curved: f64,
}

impl Nearby {
    const NONE: Self = Self {
        gap: Range::NONE,
        approach: Range::NONE,
        sagitta: 0.0,
        curved: 0.0,
    };

    fn with(self, other: Self) -> Self {
        Self {
            gap: self.gap.with(other.gap),
            approach: self.approach.with(other.approach),
            sagitta: self.sagitta.max(other.sagitta),
            curved: self.curved.max(other.curved),
        }
    }

    /// The same sides moved together by what is between them, in metre; `given` is negative where that is pressed.
    pub(super) fn apart(self, given: f64) -> Self {
        let gap = Range {
            low: self.gap.low - given,
            high: self.gap.high - given,
        };
        Self { gap, ..self }
    }

    /// How deep all of a side is in the other.
    pub(super) fn overlap(&self, rounded: f64, contact: usize) -> Measure {
        let depth = (-self.gap.low).max(0.0);
        let varied = (self.gap.high - self.gap.low).max(0.0);
        let resolved = self.sagitta + self.curved;
        let explained = resolved + (1.0 + OVERSHOOT) * varied + rounded;
        Measure::new(depth, explained, contact)
    }

    /// How far from the other side something presses.
    pub(super) fn distance(&self, rounded: f64, contact: usize) -> Measure {
        let varied = (self.approach.high - self.approach.low).max(0.0);
        let explained = self.sagitta + self.curved + OVERSHOOT * varied + rounded;
        Measure::new(self.gap.low.max(0.0), explained, contact)
    }

    /// Whether something touches there.
    pub(super) fn touches(&self, rounded: f64) -> bool {
        self.gap.low <= self.sagitta + rounded
    }
}

/// Distances of a pair in a deformed state, face by face of the side that carries its contacts.
pub(super) struct Distances(Vec<Nearby>);

impl Distances {
    /// - `side`: that carries the contacts, 0 or 1;
    /// - `displacements`: per body and unknown, in metre;
    /// - `moved`: how the obstacle, or what is between the sides, has moved; `opening`: added to all gaps, in metre.
    pub(super) fn new(
        meeting: &Meeting,
        side: usize,
        displacements: &[&[f64]],
        moved: RigidMotion,
        opening: f64,
    ) -> Self {
        let faces = meeting.skins.get(side).map_or(0, |skin| skin.faces.len());
        let samples = meeting.samples.iter().map(|sample| {
            let approach = approach(meeting, sample, displacements, moved);
            Nearby {
                gap: Range::of(sample.distance + opening + approach),
                approach: Range::of(approach),
                sagitta: meeting.sagitta(sample),
                curved: 0.0,
            }
        });
        let samples: Vec<Nearby> = samples.collect();
        let on = |face| {
            let on_face = meeting.on(side, face).map(|number| samples[number]);
            Nearby {
                curved: meeting.curved(side, face),
                ..on_face.fold(Nearby::NONE, Nearby::with)
            }
        };
        Self((0..faces).map(on).collect())
    }

    /// Of some faces together.
    pub(super) fn around(&self, faces: &[usize]) -> Nearby {
        let faces = faces.iter().filter_map(|&face| self.0.get(face).copied());
        faces.fold(Nearby::NONE, Nearby::with)
    }
}

/// By how much a sample's sides move apart, in metre.
fn approach(
    meeting: &Meeting,
    sample: &Sample,
    displacements: &[&[f64]],
    moved: RigidMotion,
) -> f64 {
    let of = |side: usize| match (&sample.places[side], meeting.skins.get(side)) {
        (Some(place), Some(skin)) => displacement(place, skin, displacements),
        _ => Vector3::zeros(),
    };
    (of(1) + rigid(sample, moved) - of(0)).dot(&sample.towards)
}

/// Displacement of a rigid side, or of what is between the sides, at the point that a sample faces.
fn rigid(sample: &Sample, moved: RigidMotion) -> Vector3<f64> {
    let faced = sample.places[0]
        .as_ref()
        .map(|place| place.position + sample.towards * sample.distance);
    let arm = faced.map_or(Vector3::zeros(), |faced| faced - Vector3::from(moved.about));
    Vector3::from(moved.translation) + Vector3::from(moved.rotation).cross(&arm)
}

fn displacement(place: &Place, skin: &Skin, displacements: &[&[f64]]) -> Vector3<f64> {
    let (values, axes) = (displacements[skin.body], skin.dimension);
    let mut sum = Vector3::zeros();
    for (node, shape) in skin.faces[place.face].nodes.iter().zip(&place.shape) {
        for axis in 0..axes {
            sum[axis] += shape * values[node * axes + axis];
        }
    }
    sum
}
