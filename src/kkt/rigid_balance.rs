//! Equilibrium of a rigid body, from the forces of its contacts at the nodes of the others.
//!
//! ```text
//! (K21)  Σ (−f) + F = 0,   Σ (x − c) × (−f) + M = 0        f: contact forces on the nodes x of elastic bodies
//! ```
//!
//! Only where a component of the motion is free; elsewhere whatever holds it answers.

use super::body_state::BodyState;
use super::certificate::{Defect, length};
use super::resultant::Resultant;
use super::sides::{block, global_force, shares};
use crate::contact::RigidBody;
use crate::error::{Error, check_length};

/// A rigid body is in equilibrium if what nothing answers is less than this part of all forces on it.
const UNANSWERED: f64 = 1e-6;

/// Forces on a rigid body, in global axes; moments are about its reference point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RigidBalance {
    /// Contact forces.
    pub contact: Resultant,
    /// Given force and moment on the free components.
    pub given: Resultant,
    /// What is left along free translations.
    pub force_defect: Defect,
    /// What is left about free rotations; scaled by all forces at the farthest contact.
    pub moment_defect: Defect,
}

impl RigidBalance {
    /// Whether it is in equilibrium.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.force_defect.scaled <= UNANSWERED && self.moment_defect.scaled <= UNANSWERED
    }
}

/// Measures (K21) under `given` forces, in newton, then moments, in newton metre, per component.
///
/// # Errors
///
/// [`Error::Length`] if arrays do not belong together.
pub fn rigid_balance(
    states: &[BodyState<'_>],
    rigid: &RigidBody,
    given: [f64; 6],
) -> Result<RigidBalance, Error> {
    let [f_x, f_y, f_z, m_x, m_y, m_z] = given;
    let mut found = RigidBalance {
        given: Resultant {
            force: [f_x, f_y, f_z],
            moment: [m_x, m_y, m_z],
        },
        ..RigidBalance::default()
    };
    let Some(first) = states.first() else {
        return Ok(found);
    };
    check_length(
        "contact nodes",
        first.problem.contacts(),
        first.surface.nodes.len(),
    )?;
    let (mut total, mut turning) = (length(found.given.force), length(found.given.moment));
    let contacts = first.surface.nodes.iter().enumerate();
    for (i, contact) in contacts.filter(|(_, contact)| rigid.pairs.contains(&contact.pair)) {
        let on_body = global_force(contact, block(first.problem, i, first.reaction));
        for share in shares(contact) {
            let Some(x) =
                (states.get(share.body)).and_then(|at| at.body.mesh.nodes.get(share.node))
            else {
                continue;
            };
            let arm = [0, 1, 2].map(|axis| x[axis] - rigid.reference[axis]);
            let force = on_body.map(|f| -share.weight * f);
            found.contact.add(arm, force);
            total += length(force);
            turning += length(arm) * length(force);
        }
    }
    let free: Vec<usize> = rigid.free().collect();
    let left = |first: usize, [a, b]: [[f64; 3]; 2]| {
        [0, 1, 2].map(|axis| match free.contains(&(first + axis)) {
            true => a[axis] + b[axis],
            false => 0.0,
        })
    };
    let (contact, given) = (found.contact, found.given);
    found.force_defect = Defect::of(&[left(0, [contact.force, given.force])], total);
    found.moment_defect = Defect::of(&[left(3, [contact.moment, given.moment])], turning);
    Ok(found)
}
