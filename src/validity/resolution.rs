//! What contacts and steps leave in doubt: a pressure on one contact alone, an obstacle deep in a body,
//! nothing that touches, contacts that a first step closes, seams around an axis.

use std::collections::HashSet;

use nalgebra::{Matrix3, Vector3};

use crate::body::Tie;
use crate::contact::{ContactNode, Opposite};
use crate::kkt::ContactStatus;
use crate::report::{ReportParts, significant};

/// Angle to its face, in degrees, from which the normal of a contact that alone carries is that of a corner.
const OFF_FACE: f64 = 15.0;

/// Part of the extent of a surface beyond which an overlap is no fit.
const FIT: f64 = 0.05;

/// Part of the farthest coordinate that is round-off.
const ROUNDED: f64 = 1e-12;

/// Part of the largest displacement beyond which sides that are in each other between contacts are told.
const OF_MOTION: f64 = 0.1;

/// Part of the normal force on contacts that closed in the first step from which a note says so.
const CLOSED: f64 = 0.01;

/// Weight of a node that is none.
const WEIGHT: f64 = 1e-6;

/// One contact that carries all.
pub(super) fn single(parts: &ReportParts<'_>, pressed: &[&ContactNode]) -> Option<String> {
    let [contact] = pressed else { return None };
    let off = off_its_face(parts, contact);
    if off > OFF_FACE {
        return Some(format!(
            "one contact alone carries, node {}, along a normal {off:.0} degrees off that of its face, as beside a \
             corner of the other side: neither its force nor its pressure is resolved; refine there",
            contact.node
        ));
    }
    Some(format!(
        "one contact alone carries, node {}: its force is right, its pressure is that force over an area of \
         the mesh's making; refine there for a pressure",
        contact.node
    ))
}

/// A contact at a seam around an axis that meets what is beside the seam.
pub(super) fn beside_a_seam(parts: &ReportParts<'_>, pressed: &[&ContactNode]) -> Option<String> {
    let straight: [[f64; 3]; 3] = Matrix3::identity().into();
    let turned = |body: usize| -> HashSet<usize> {
        let ties = parts.bodies[body].ties.iter().filter_map(|tie| match tie {
            Tie::Pairs(tied) if tied.rotation != straight => Some(tied),
            _ => None,
        });
        ties.flat_map(|tied| tied.pairs.as_flattened())
            .copied()
            .collect()
    };
    let first = pressed.first()?;
    let seams = [first.body, first.opposite.as_ref()?.body].map(turned);
    let beside = pressed.iter().find(|contact| {
        let met = contact.opposite.iter().flat_map(|opposite| &opposite.nodes);
        seams[0].contains(&contact.node)
            && met
                .clone()
                .any(|(node, weight)| weight.abs() > WEIGHT && !seams[1].contains(node))
    })?;
    Some(format!(
        "node {} presses at a seam around an axis where the sides do not match: of the other side it meets what is on its own \
         side of the seam alone, and pressures within a facet of it are less sure than elsewhere; let facets of both sides \
         end at the seam and be as long there, or put the seam where nothing touches",
        beside.node
    ))
}

/// Angle between a contact's normal and that of its face, in degrees.
fn off_its_face(parts: &ReportParts<'_>, contact: &ContactNode) -> f64 {
    let Some(body) = parts.bodies.get(contact.body) else {
        return 0.0;
    };
    let facets = parts.surface.facets.iter();
    let here =
        facets.filter(|(of, facet)| *of == contact.body && facet.nodes.contains(&contact.node));
    let outward: Vector3<f64> = here
        .map(|(_, facet)| Vector3::from(body.mesh.facet_geometry(facet).normal))
        .sum();
    let normal = Vector3::from(contact.frame[0]);
    outward
        .cross(&normal)
        .norm()
        .atan2(outward.dot(&normal))
        .to_degrees()
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

/// How deep the sides are in each other between contacts, beside what the bodies move.
///
/// Contacts hold means over facets: where those of the side that carries are wide beside a body that bends, it
/// goes through them.
pub(super) fn between_contacts(parts: &ReportParts<'_>, pair: usize) -> Option<String> {
    let depth = parts.fits.get(pair)?.overlap.value;
    let lengths = parts.extremes.iter().map(|body| body.displacement.value);
    let moved = lengths.fold(0.0, f64::max);
    let rounded = || {
        let nodes = parts
            .bodies
            .iter()
            .flat_map(|body| &body.mesh.nodes)
            .flatten();
        ROUNDED * nodes.fold(0.0_f64, |most, x| most.max(x.abs()))
    };
    (depth > OF_MOTION * moved && depth > rounded()).then(|| {
        format!(
            "the sides are up to {} in each other between contacts, where bodies move by {}: by as large a part \
             displacements and pressures may be wrong; refine the side that carries, or both",
            significant(depth),
            significant(moved)
        )
    })
}

/// No contact carries anything.
pub(super) fn nothing_touches(parts: &ReportParts<'_>) -> Option<String> {
    let status = &parts.outcome.verdict.status;
    // Glue and a given bound act across a gap.
    let mut laws = parts.problem.laws().into_iter().flatten();
    let across = laws.any(|law| law.tension > 0.0 || law.shear > 0.0);
    if across || status.iter().any(|status| *status != ContactStatus::Open) {
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
