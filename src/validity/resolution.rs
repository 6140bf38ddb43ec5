//! What contacts and steps leave in doubt: a pressure on one contact alone, an obstacle deep in a body,
//! nothing that touches, contacts that a first step closes.

use nalgebra::Vector3;

use crate::contact::{ContactNode, Opposite};
use crate::kkt::ContactStatus;
use crate::report::{ReportParts, significant};

/// Part of the extent of a surface beyond which an overlap is no fit.
const FIT: f64 = 0.05;

/// Part of the normal force on contacts that closed in the first step from which a note says so.
const CLOSED: f64 = 0.01;

/// One contact that carries all.
pub(super) fn single(pressed: &[&ContactNode]) -> Option<String> {
    let [contact] = pressed else { return None };
    Some(format!(
        "one contact alone carries, node {}: its force is right, its pressure is that force over an area of \
         the mesh's making; refine there for a pressure",
        contact.node
    ))
}

/// An obstacle deeper in a body than what bodies may overlap.
pub(super) fn deep(parts: &ReportParts<'_>, pair: usize) -> Option<String> {
    let Opposite::Obstacle(_) = &parts.pairs[pair].opposite else {
        return None;
    };
    let own = parts.surface.nodes.iter().filter(|c| c.pair == pair);
    let (mut low, mut high, mut deepest) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3], 0.0);
    let mut at = 0;
    for contact in own {
        for axis in 0..3 {
            low[axis] = low[axis].min(contact.position[axis]);
            high[axis] = high[axis].max(contact.position[axis]);
        }
        if -contact.initial_gap > deepest {
            (deepest, at) = (-contact.initial_gap, contact.node);
        }
    }
    let extent = (Vector3::from(high) - Vector3::from(low)).norm();
    (extent > 0.0 && deepest > FIT * extent).then(|| {
        format!(
            "the obstacle lies {} deep in the body before loading, at node {at}: more than a twentieth of \
             the extent {} of the contacts is no fit, and beyond small displacements",
            significant(deepest),
            significant(extent)
        )
    })
}

/// No contact carries anything.
pub(super) fn nothing_touches(parts: &ReportParts<'_>) -> Option<String> {
    let status = &parts.outcome.verdict.status;
    if status.iter().any(|status| *status != ContactStatus::Open) {
        return None;
    }
    let displacement = &parts.outcome.verdict.displacement;
    let gaps = (0..status.len()).map(|i| parts.problem.gap(i, displacement));
    let least = gaps.fold(f64::INFINITY, f64::min);
    Some(format!(
        "nothing touches: the least distance left is {}; look at gaps, and at the signs of loads",
        significant(least)
    ))
}

/// Contacts that a first step from rest both closes and lets slip: how far they slid before they met
/// is a matter of its size.
pub(super) fn first_step(parts: &ReportParts<'_>) -> Option<String> {
    if parts.step.as_ref().is_none_or(|step| step.number > 1) {
        return None;
    }
    let (mut closed, mut carried, mut all) = (0, 0.0, 0.0);
    for (i, &normal) in parts.problem.normals().iter().enumerate() {
        let reaction = parts.outcome.reaction[normal];
        all += reaction;
        if parts.problem.initial_gap()[i] > 0.0
            && parts.problem.friction()[i] > 0.0
            && reaction < 0.0
        {
            closed += 1;
            carried += reaction;
        }
    }
    (carried < CLOSED * all && all < 0.0).then(|| {
        format!(
            "the first step closes {closed} contacts that were apart, which carry {:.0} % of the normal force: \
             friction there counts from before they met, and smaller first steps would change it",
            100.0 * carried / all
        )
    })
}
