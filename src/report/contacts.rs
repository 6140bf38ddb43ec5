//! Contact by contact: where it is, what it does, what it carries.

use serde::Serialize;

use super::ReportParts;
use super::certificate::in_dimension;
use crate::kkt::{ContactStatus, global_force, relative_displacement};
use crate::problem::Law;

/// What a contact does, as reports spell it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ReportedContactState {
    /// No reaction; under other laws, parted.
    Open,
    /// Pressed and held by friction, or held by its law.
    Stick,
    /// Pressed and sliding; without friction every pressed contact.
    Slip,
}

/// One contact; vectors in global axes with the bodies' dimension.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Contact {
    /// The body it belongs to, as an index into the certificate's `bodies`.
    pub body: usize,
    /// Node of that body's mesh, from 0.
    pub node: usize,
    /// Contact pair of the scene, from 0.
    pub pair: usize,
    /// Position before loading, in metre.
    pub position: Vec<f64>,
    /// Unit normal, out of the body towards the other side.
    pub normal: Vec<f64>,
    /// What it does.
    pub state: ReportedContactState,
    /// Distance left to the other side, in metre.
    pub gap: f64,
    /// Tangential displacement relative to the other side since the start of the load step,
    /// in metre; zero where open, as nothing slips there.
    pub slip: Vec<f64>,
    /// Tributary area, in m².
    pub area: f64,
    /// Contact force on the body, in newton.
    pub force: Vec<f64>,
    /// Pressure `−t_N / area ≥ 0`, in pascal, negative where a law bears tension; `null` without an area.
    pub pressure: Option<f64>,
    /// Largest friction that its law allows under that pressure, along an ellipse's direction, in pascal; absent where
    /// the scene has no laws but Coulomb's, and where nothing bounds it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shear_bound: Option<f64>,
    /// Friction force on the body per area, in pascal; `null` without an area.
    pub friction_traction: Option<Vec<f64>>,
}

/// Reactions of one contact, before they are cut to the bodies' dimension.
#[derive(Clone, Copy, Debug)]
pub(super) struct ContactForce {
    /// `−t_N`, in newton.
    pub(super) pressing: f64,
    /// Friction on the body in global axes, in newton.
    pub(super) friction: [f64; 3],
    /// Whole contact force on the body in global axes, in newton.
    pub(super) total: [f64; 3],
}

/// The contacts of a report, in the order of the contact problem.
pub(super) fn contacts(parts: &ReportParts<'_>, forces: &[ContactForce]) -> Vec<Contact> {
    let dimension = parts.dimension();
    let nodes = parts.surface.nodes.iter().zip(forces).enumerate();
    nodes
        .map(|(i, (contact, force))| Contact {
            body: contact.body,
            node: contact.node,
            pair: contact.pair,
            position: in_dimension(contact.position, dimension),
            normal: in_dimension(contact.frame[0], dimension),
            state: parts.outcome.verdict.status[i].into(),
            gap: parts.problem.gap(i, &parts.outcome.verdict.displacement),
            slip: in_dimension(slip(parts, i), dimension),
            area: contact.area,
            force: in_dimension(force.total, dimension),
            pressure: per_area(force.pressing, contact.area),
            shear_bound: shear_bound(parts, i),
            friction_traction: in_dimension(force.friction, dimension)
                .into_iter()
                .map(|f| per_area(f, contact.area))
                .collect(),
        })
        .collect()
}

/// Reactions of all contacts, split into normal and friction.
pub(super) fn contact_forces(parts: &ReportParts<'_>, reaction: &[f64]) -> Vec<ContactForce> {
    let nodes = parts.surface.nodes.iter().zip(parts.problem.blocks());
    nodes
        .map(|(contact, block)| {
            let block = &reaction[block];
            let total = global_force(contact, block);
            let normal = global_force(contact, &block[..1]);
            ContactForce {
                // 0 − t, so that an open contact reads 0 and not −0.
                pressing: 0.0 - block[0],
                friction: [0, 1, 2].map(|axis| total[axis] - normal[axis]),
                total,
            }
        })
        .collect()
}

/// `u − (u·n) n` of the relative displacement u in the recovered bodies, from the start of the
/// step on, in metre. Not read
/// from the contact problem, which holds no tangent where there is no friction: the bodies
/// slide all the same.
pub(super) fn slip(parts: &ReportParts<'_>, i: usize) -> [f64; 3] {
    if parts.outcome.verdict.status[i] == ContactStatus::Open {
        return [0.0; 3];
    }
    let contact = &parts.surface.nodes[i];
    if has_sliding_layer(parts, i) {
        return slip_without_layer(parts, i);
    }
    let mut slip = relative_displacement(contact, parts.displacements, parts.dimension());
    if let Some(origin) = parts.origins.get(i) {
        slip.iter_mut().zip(origin).for_each(|(u, from)| *u -= from);
    }
    across(contact.frame[0], slip)
}

/// `u − (u·n) n`.
pub(super) fn across(normal: [f64; 3], vector: [f64; 3]) -> [f64; 3] {
    let along: f64 = vector.iter().zip(normal).map(|(u, n)| u * n).sum();
    [0, 1, 2].map(|axis| vector[axis] - along * normal[axis])
}

/// Whether a layer of the surfaces gives way to a contact's friction.
pub(super) fn has_sliding_layer(parts: &ReportParts<'_>, i: usize) -> bool {
    let gives = |laws: &[Law]| laws[i].compliance[1] > 0.0;
    parts.problem.laws().is_some_and(gives) && parts.problem.block(i).len() > 1
}

/// Slip of what obeys the law, as the contact problem has it: the bodies' displacement holds that of the layer.
fn slip_without_layer(parts: &ReportParts<'_>, i: usize) -> [f64; 3] {
    let displacement = &parts.outcome.verdict.displacement[parts.problem.block(i)];
    let directions = parts.surface.nodes[i].frame[1..].iter();
    let mut slip = [0.0; 3];
    for (direction, u) in directions.zip(&displacement[1..]) {
        slip.iter_mut()
            .zip(direction)
            .for_each(|(sum, d)| *sum += u * d);
    }
    slip
}

/// The shear that a contact's law allows, per area; none for Coulomb's own, where it is friction times pressure.
fn shear_bound(parts: &ReportParts<'_>, i: usize) -> Option<f64> {
    parts.problem.laws()?;
    let normal = parts.outcome.reaction[parts.problem.normals()[i]];
    let bound = parts.problem.stated_bound(i, normal);
    per_area(bound, parts.surface.nodes[i].area).filter(|bound| bound.is_finite())
}

/// A traction; none for a contact without area, whose force has no finite one.
fn per_area(force: f64, area: f64) -> Option<f64> {
    (area > 0.0).then(|| force / area)
}

impl From<ContactStatus> for ReportedContactState {
    fn from(status: ContactStatus) -> Self {
        match status {
            ContactStatus::Open => Self::Open,
            ContactStatus::Stick => Self::Stick,
            ContactStatus::Slip => Self::Slip,
        }
    }
}
