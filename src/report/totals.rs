//! Totals over the contact surface.

use serde::Serialize;

use super::ReportParts;
use super::certificate::{Resultant, in_dimension};
use super::contacts::contact_forces;
use crate::kkt::{self, ContactStatus};

/// Totals over the contacts; vectors in global axes, forces act on the body.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Totals {
    /// Contacts without reaction.
    pub open: usize,
    /// Pressed contacts that friction holds.
    pub stick: usize,
    /// Pressed contacts that slide.
    pub slip: usize,
    /// `Σ −t_N ≥ 0`, in newton.
    pub normal: f64,
    /// Sum of the friction forces, in newton.
    pub friction: Vec<f64>,
    /// Sum of the contact forces, normal and friction, in newton.
    pub contact_force: Vec<f64>,
    /// Moment of the contact forces about the origin, in newton metre; in 2D its single component.
    pub moment: Vec<f64>,
    /// Area of the pressed contacts, in m².
    pub contact_area: f64,
    /// Area of the pressed contacts that slide, in m².
    pub slip_area: f64,
    /// Largest pressure, in pascal.
    pub peak_pressure: f64,
}

impl Totals {
    pub(super) fn new(parts: &ReportParts<'_>) -> Self {
        let dimension = parts.body.mesh.dimension;
        let status = &parts.outcome.verdict.status;
        let count = |wanted| status.iter().filter(|&&state| state == wanted).count();
        let area = |wanted: &[ContactStatus]| {
            let contacts = parts.surface.nodes.iter().zip(status);
            let counted = contacts.filter(|(_, state)| wanted.contains(state));
            counted
                .map(|(contact, _)| contact.area)
                .fold(0.0, |sum, area| sum + area)
        };
        let (mut sum, mut friction) = (kkt::Resultant::default(), [0.0; 3]);
        let (mut normal, mut peak_pressure) = (0.0, 0.0_f64);
        for (contact, force) in parts.surface.nodes.iter().zip(contact_forces(parts)) {
            sum.add(contact.position, force.total);
            normal += force.pressing;
            (0..3).for_each(|axis| friction[axis] += force.friction[axis]);
            if contact.area > 0.0 {
                peak_pressure = peak_pressure.max(force.pressing / contact.area);
            }
        }
        let Resultant { force, moment } = Resultant::new(&sum, dimension);
        Self {
            open: count(ContactStatus::Open),
            stick: count(ContactStatus::Stick),
            slip: count(ContactStatus::Slip),
            normal,
            friction: in_dimension(friction, dimension),
            contact_force: force,
            moment,
            contact_area: area(&[ContactStatus::Stick, ContactStatus::Slip]),
            slip_area: area(&[ContactStatus::Slip]),
            peak_pressure,
        }
    }
}
