//! What bolts carry, and how much shorter they were made.

use serde::Serialize;

use super::certificate::ReportedDefect;
use super::rigid_body::RigidParts;

/// A bolt under preload.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ReportedBolt {
    /// Name of the bolt.
    pub name: String,
    /// Force across its cut, in newton; positive if it pulls.
    pub force: f64,
    /// How much shorter it is than it was drawn, in metre.
    pub shortening: f64,
    /// The shortening is given, by the scene or since the bolt was locked; else the force is.
    pub held: bool,
    /// How far the force across the cut is from the given one, in newton; zero while the shortening is given.
    pub force_defect: ReportedDefect,
}

impl ReportedBolt {
    pub(super) fn all(parts: &RigidParts<'_>) -> Vec<Self> {
        let bolts = parts.all().filter(|(body, ..)| body.cut.is_some());
        let bolt = bolts.map(|(body, motion, balance)| Self {
            name: body.name.clone(),
            force: -body.along(balance.contact.force),
            shortening: body.shortening(motion),
            held: body.free().next().is_none(),
            force_defect: balance.force_defect.into(),
        });
        bolt.collect()
    }
}
