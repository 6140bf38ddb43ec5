//! How rigid bodies moved, and what acts on them.

use serde::Serialize;

use super::certificate::{ReportedDefect, ReportedResultant, in_dimension};
use crate::contact::{RigidBody, RigidMotion};
use crate::kkt::RigidBalance;

/// Rigid bodies of a solved scene, in the same order.
#[derive(Clone, Copy, Debug, Default)]
pub struct RigidParts<'a> {
    /// The bodies.
    pub bodies: &'a [RigidBody],
    /// Their motions.
    pub motions: &'a [RigidMotion],
    /// Their equilibrium.
    pub balances: &'a [RigidBalance],
}

impl<'a> RigidParts<'a> {
    /// Each with its motion and equilibrium.
    pub(super) fn all(
        &self,
    ) -> impl Iterator<Item = (&'a RigidBody, &'a RigidMotion, &'a RigidBalance)> {
        let moved = self.bodies.iter().zip(self.motions);
        let all = moved.zip(self.balances);
        all.map(|((body, motion), balance)| (body, motion, balance))
    }
}

/// A rigid body; vectors in global axes with the bodies' dimension.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ReportedRigidBody {
    /// Name of the body.
    pub name: String,
    /// Its reference point, in metre.
    pub reference: Vec<f64>,
    /// Displacement of the reference point, in metre.
    pub displacement: Vec<f64>,
    /// Rotation, in radian; in 2D its single component.
    pub rotation: Vec<f64>,
    /// Contact forces on the body; the moment is about the reference point.
    pub contact: ReportedResultant,
    /// Given forces on the components that are free.
    pub given: ReportedResultant,
    /// What is left of both along free translations, in newton.
    pub force_defect: ReportedDefect,
    /// What is left about free rotations, in newton metre.
    pub moment_defect: ReportedDefect,
}

impl ReportedRigidBody {
    pub(super) fn all(parts: &RigidParts<'_>, dimension: usize) -> Vec<Self> {
        let bodies = parts.all().filter(|(body, ..)| body.cut.is_none());
        let of_body = |(body, motion, balance): (&RigidBody, &RigidMotion, &RigidBalance)| Self {
            name: body.name.clone(),
            reference: in_dimension(body.reference, dimension),
            displacement: in_dimension(motion.translation, dimension),
            rotation: match dimension {
                2 => vec![motion.rotation[2]],
                _ => motion.rotation.to_vec(),
            },
            contact: ReportedResultant::new(&balance.contact, dimension),
            given: ReportedResultant::new(&balance.given, dimension),
            force_defect: balance.force_defect.into(),
            moment_defect: balance.moment_defect.into(),
        };
        bodies.map(of_body).collect()
    }
}
