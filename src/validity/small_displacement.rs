//! Whether displacements are as small as the theory takes them.
//!
//! Strain and rotation enter to the first power: their squares are what is left out. A contact
//! meets what it faced before loading: a slip of a cell, or of a tenth of the radius of curvature, meets
//! other points and another normal; on a curve it changes the gap:
//!
//! ```text
//! (V2)  s²/(2 R)       by which a curve of radius R falls off over a slip s
//! ```

use std::f64::consts::PI;

use crate::body::{Body, Model};
use crate::contact::{ContactNode, Opposite};
use crate::kkt::{ContactStatus, relative_displacement};
use crate::report::{ReportParts, significant};

/// Strain from which a note says so.
const STRAIN: f64 = 0.05;

/// Rotation from which a note says so, in degrees.
const ROTATION: f64 = 5.0;

/// Part of the radius of curvature that a contact may slip.
const OF_RADIUS: f64 = 0.1;

/// Part of the largest gap that pressed contacts close by which a curve may fall off over their slip.
const OF_GAP: f64 = 0.1;

/// Notes on what leaves the theory.
pub(super) fn notes(parts: &ReportParts<'_>) -> Vec<String> {
    let found = parts.extremes.iter().zip(parts.bodies);
    let mut notes = Vec::new();
    for (extremes, body) in found {
        let (strain, rotation) = (extremes.strain, extremes.rotation);
        let degrees = rotation.value.to_degrees();
        let of_body = match parts.bodies.len() {
            1 => String::new(),
            _ => format!("body `{}`: ", body.name),
        };
        if strain.value > STRAIN {
            notes.push(format!(
                "{of_body}strain of {:.1} % in cell {}: beyond small displacements, whose theory leaves out \
                 its square",
                100.0 * strain.value,
                strain.place
            ));
        }
        if degrees > ROTATION {
            notes.push(format!(
                "{of_body}cell {} turns by {degrees:.1} degrees: beyond small displacements, forces keep the \
                 direction that they had",
                rotation.place
            ));
        }
    }
    let rigid = parts.rigid.bodies.iter().zip(parts.rigid.motions);
    notes.extend(rigid.filter_map(|(body, motion)| {
        let turned = motion.rotation.iter().fold(0.0, |size: f64, w| size.hypot(*w));
        let degrees = turned.to_degrees();
        (degrees > ROTATION).then(|| {
            format!(
                "rigid body `{}` turns by {degrees:.1} degrees: beyond small rotations, its surfaces keep the \
                 normals that they had",
                body.name
            )
        })
    }));
    notes.extend((0..parts.pairs.len()).filter_map(|pair| slip(parts, pair)));
    notes.extend((0..parts.pairs.len()).filter_map(|pair| far(parts, pair)));
    notes
}

/// A contact that presses after it came from farther than its body is large.
fn far(parts: &ReportParts<'_>, pair: usize) -> Option<String> {
    let pressed = super::pressed_of(parts, pair);
    let came = pressed.map(|i| (along_and_across(parts, i)[0], i));
    let (came, i) = came.max_by(|a, b| a.0.total_cmp(&b.0))?;
    let contact = &parts.surface.nodes[i];
    let body = &parts.bodies[contact.body];
    let extent = |axis: usize| {
        let at = body.mesh.nodes.iter().map(|node| node[axis]);
        let (low, high) = at.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
            (x.min(low), x.max(high))
        });
        high - low
    };
    let size = [0, 1, 2].map(extent).into_iter().fold(0.0, f64::max);
    (came > size).then(|| {
        format!(
            "{}: node {} presses after coming from {} away, farther than body `{}` is large ({}): beyond small \
             displacements; see whether it is meant to fall",
            parts.pairs[pair].place,
            contact.node,
            significant(came),
            body.name,
            significant(size)
        )
    })
}

/// The contact of a pair that slips farthest.
fn slip(parts: &ReportParts<'_>, pair: usize) -> Option<String> {
    let (limit, of) = limit(parts, pair)?;
    let pressed = super::pressed_of(parts, pair);
    let slips = pressed.map(|i| (along_and_across(parts, i)[1], parts.surface.nodes[i].node));
    let (slip, node) = slips.max_by(|a, b| a.0.total_cmp(&b.0))?;
    (slip > limit).then(|| {
        format!(
            "{}: node {node} moves by {} along the other side, more than {of} ({}): it meets other points \
             there than those it faced before loading",
            parts.pairs[pair].place,
            significant(slip),
            significant(limit)
        )
    })
}

/// How far contacts of a pair may slip, and what that is; any distance along a plane.
fn limit(parts: &ReportParts<'_>, pair: usize) -> Option<(f64, &'static str)> {
    match &parts.pairs[pair].opposite {
        Opposite::Obstacle(obstacle) => {
            let radius = obstacle.least_radius()?;
            let contacts = parts
                .surface
                .nodes
                .iter()
                .zip(&parts.outcome.verdict.status);
            let pressed = contacts.filter(|(contact, status)| {
                contact.pair == pair && **status != ContactStatus::Open
            });
            let closed = pressed.map(|(contact, _)| contact.initial_gap.abs());
            let falls = (2.0 * radius * OF_GAP * closed.fold(0.0, f64::max)).sqrt();
            Some(match falls > 0.0 && falls < OF_RADIUS * radius {
                true => (
                    falls,
                    "a way on which that falls off by a tenth of the gap that is closed",
                ),
                false => (OF_RADIUS * radius, "a tenth of its radius"),
            })
        }
        Opposite::Surface { .. } => {
            let own = parts.surface.nodes.iter().filter(|c| c.pair == pair);
            let sizes: Vec<f64> = own.filter_map(|c| size(&parts.bodies[c.body], c)).collect();
            let mean = sizes.iter().sum::<f64>() / sizes.len() as f64;
            (mean > 0.0).then_some((mean, "a cell"))
        }
    }
}

/// Length of the surface that belongs to a contact, about that of a cell, in metre; none on an axis.
fn size(body: &Body, contact: &ContactNode) -> Option<f64> {
    let around = 2.0 * PI * contact.position[0];
    match body.model {
        Model::Solid => Some(contact.area.max(0.0).sqrt()),
        Model::Axisymmetric => (around > 0.0).then(|| contact.area / around),
        model => Some(contact.area / model.depth()),
    }
}

/// Displacement towards the other side since before loading, and the length of that along it; since the last step where that
/// is an obstacle, which may have moved along.
fn along_and_across(parts: &ReportParts<'_>, i: usize) -> [f64; 2] {
    let contact = &parts.surface.nodes[i];
    let mut u = relative_displacement(contact, parts.displacements, parts.dimension());
    if let (None, Some(origin)) = (&contact.opposite, parts.origins.get(i)) {
        u.iter_mut().zip(origin).for_each(|(u, from)| *u -= from);
    }
    let normal = contact.frame[0];
    let along: f64 = u.iter().zip(normal).map(|(u, n)| u * n).sum();
    let rest = [0, 1, 2].map(|axis| u[axis] - along * normal[axis]);
    [along, rest.iter().fold(0.0, |size: f64, u| size.hypot(*u))]
}
