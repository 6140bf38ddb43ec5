//! What is largest in the bodies, and what their supports carry.

use serde::Serialize;

use super::ReportParts;
use super::certificate::in_dimension;
use crate::body::{Extreme, Extremes};

/// The largest values over all bodies.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ReportedExtremes {
    /// Length of a displacement, in metre; its place is a node.
    pub displacement: Largest,
    /// Von Mises stress at the centre of a cell, in pascal; this place and those below are cells.
    pub von_mises: Largest,
    /// Principal strain, by size.
    pub strain: Largest,
    /// Rotation, in degrees.
    pub rotation: Largest,
}

/// A largest value and where it is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Largest {
    /// Its size.
    pub value: f64,
    /// The body, as an index into the certificate's `bodies`.
    pub body: usize,
    /// Node or cell of its mesh, from 0.
    pub place: usize,
}

/// What a support carries.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SupportForce {
    /// Where the scene says so, such as `bodies[0].supports[1]`.
    pub place: String,
    /// Force on the body in global axes, in newton; a displacement that several supports give counts with
    /// the first.
    pub force: Vec<f64>,
}

impl ReportedExtremes {
    pub(super) fn new(parts: &ReportParts<'_>) -> Self {
        let largest = |of: fn(&Extremes) -> Extreme| {
            let mut largest = Largest::default();
            for (body, Extreme { value, place }) in parts.extremes.iter().map(of).enumerate() {
                if value > largest.value {
                    largest = Largest { value, body, place };
                }
            }
            largest
        };
        let rotation = largest(|found| found.rotation);
        Self {
            displacement: largest(|found| found.displacement),
            von_mises: largest(|found| found.von_mises),
            strain: largest(|found| found.strain),
            rotation: Largest {
                value: rotation.value.to_degrees(),
                ..rotation
            },
        }
    }
}

/// What all supports carry, body by body.
pub(super) fn support_forces(parts: &ReportParts<'_>) -> Vec<SupportForce> {
    let supports = parts.bodies.iter().flat_map(|body| &body.supports);
    let forces = parts.support_forces.iter().flatten();
    let carried = supports.zip(forces).map(|(support, force)| SupportForce {
        place: support.place.clone(),
        force: in_dimension(*force, parts.dimension()),
    });
    carried.collect()
}
