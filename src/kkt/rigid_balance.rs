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
    let [force, moment] = rigid.wrench(given);
    let mut found = RigidBalance {
        given: Resultant { force, moment },
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
        // What is between two faces is in balance if it is with the first.
        for share in shares(contact).filter(|share| share.own != contact.second) {
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
    let (contact, given) = (found.contact, found.given);
    let force = [0, 1, 2].map(|axis| contact.force[axis] + given.force[axis]);
    let free: Vec<usize> = rigid.free().collect();
    let moment = [0, 1, 2].map(|axis| match free.contains(&(3 + axis)) {
        true => contact.moment[axis] + given.moment[axis],
        false => 0.0,
    });
    found.force_defect = Defect::of(&[rigid.freely(force)], total);
    found.moment_defect = Defect::of(&[moment], turning);
    Ok(found)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use sprs::TriMat;

    use super::*;
    use crate::contact::Component;
    use crate::kkt::tests::samples::lid_on_box;

    const FREE: Component = Component::Free(0.0);
    const HELD: Component = Component::Given(0.0);

    /// The lid presses and drags a rigid body below it, which is free under (2, 8) N and 12 N m about (0, 2).
    fn balance_under(reaction: &[f64; 2]) -> RigidBalance {
        let (bodies, mut surface, problem) = lid_on_box(0.0);
        surface.nodes[0].opposite = None;
        let rigid = RigidBody {
            place: "rigid_bodies[0]".into(),
            name: "base".into(),
            reference: [0.0, 2.0, 0.0],
            components: [FREE, FREE, HELD, HELD, HELD, FREE],
            pairs: vec![0],
            cut: None,
        };
        let stiffness = TriMat::new((2, 2)).to_csr();
        let state = BodyState {
            index: 0,
            body: &bodies[0],
            stiffness: &stiffness,
            load: &[0.0; 2],
            prescribed: &[None; 2],
            equations: &[],
            values: &[],
            surface: &surface,
            problem: &problem,
            reaction,
            displacement: &[0.0; 2],
        };
        rigid_balance(&[state], &rigid, [2.0, 8.0, 0.0, 0.0, 0.0, 12.0]).unwrap()
    }

    #[test]
    fn contact_forces_act_at_the_nodes_of_the_other_body() {
        // (2, 8) N on the lid at (1, 0): the reverse on the base, 1 · (−8) − (−2) · (−2) = −12 N m about (0, 2).
        let found = balance_under(&[-8.0, 2.0]);
        assert_eq!(found.contact.force, [-2.0, -8.0, 0.0]);
        assert_eq!(found.contact.moment, [0.0, 0.0, -12.0]);
        assert_eq!(
            (found.force_defect.value, found.moment_defect.value),
            (0.0, 0.0)
        );
        assert!(found.holds());
    }

    /// The lid is tied to the box, and what is between them carries a force of `given` newton.
    fn cut_under(reaction: &[f64; 2], given: f64, second: bool) -> RigidBalance {
        let (bodies, mut surface, problem) = lid_on_box(0.0);
        surface.nodes[0].second = second;
        // From the first side to the second: the lid lies on the box.
        let towards = [0.0, if second { 1.0 } else { -1.0 }, 0.0];
        let between = RigidBody {
            place: "bodies[0].bolts[0]".into(),
            name: "bolt".into(),
            reference: [1.0, 0.0, 0.0],
            components: [Component::Free(given), HELD, HELD, HELD, HELD, HELD],
            pairs: vec![0],
            cut: Some(crate::contact::Cut {
                towards,
                locked_from: None,
            }),
        };
        let stiffness = TriMat::new((2, 2)).to_csr();
        let displacement = [0.0; 4];
        let state = |index: usize| BodyState {
            index,
            body: &bodies[index],
            stiffness: &stiffness,
            load: &displacement,
            prescribed: &[],
            equations: &[],
            values: &[],
            surface: &surface,
            problem: &problem,
            reaction,
            displacement: &displacement,
        };
        let states = [state(0), state(1)];
        rigid_balance(&states, &between, [given, 0.0, 0.0, 0.0, 0.0, 0.0]).unwrap()
    }

    #[test]
    fn what_is_between_two_sides_answers_the_pull_of_the_first_along_the_cut() {
        // 8 N of tension, and 2 N across that the tie bears.
        for second in [false, true] {
            let found = cut_under(&[8.0, 2.0], 8.0, second);
            assert!(found.force_defect.value < 1e-15, "{found:?}");
            assert!(found.holds());
            let found = cut_under(&[7.0, 2.0], 8.0, second);
            assert!((found.force_defect.value - 1.0).abs() < 1e-15, "{found:?}");
            assert!(!found.holds());
        }
    }

    #[test]
    fn a_force_that_nothing_answers_is_found() {
        // One newton less leaves 1 N, and 1 N m.
        let found = balance_under(&[-7.0, 2.0]);
        assert_eq!(
            (found.force_defect.value, found.moment_defect.value),
            (1.0, 1.0)
        );
        assert!(!found.holds());
        assert!(!balance_under(&[f64::NAN, 2.0]).holds());
    }
}
