//! How far the numbers can be trusted by eye: does the pressure oscillate, how wrong is the stress.
//!
//! ```text
//! (R1)  d_i = p_i − a_i         a_i: value at contact i of the linear function closest to its
//!                               neighbours' pressures;  s_i = ½ (p_i + a_i)
//! (R2)  oscillation = ½ √(Σ A_i d_i² / Σ A_i s_i²)     over contacts with ½ s̄ ≤ s_i ≤ 2 s̄
//! ```
//!
//! s̄ is the mean of s over the pressed area. A pressure that is smooth leaves second differences
//! of order h², one that alternates as p (1 ± ε) has an oscillation of ε. The ends of the contact,
//! where pressure falls to nothing, and corners, where it grows without bound, have steep pressures
//! without oscillating: the range of s leaves them out. Contacts at the rim of the surface have
//! neighbours on one side only and do not count.

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::{Matrix3, Vector3};
use serde::Serialize;

use super::ReportParts;
use super::contacts::Contact;

/// Pressures that count, relative to their mean.
const INSIDE: [f64; 2] = [0.5, 2.0];

/// What the eye would look for in pressure and stress.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Quality {
    /// Part of the contact pressure that alternates from contact to contact (R2): far below 1 where
    /// the mesh resolves the pressure; `null` where no contact is well inside the contact zone.
    pub oscillation: Option<f64>,
    /// Estimated error of the stress of all bodies relative to the stress, both in the energy norm
    /// (B9); `null` unless asked for.
    pub stress_error_estimate: Option<f64>,
    /// A bound of the same error (B18), of bodies under the tractions on their contact; `null` unless asked for.
    pub stress_error_bound: Option<f64>,
}

impl Quality {
    /// Of contacts in the order of the contact problem; the stress is not looked at.
    pub(super) fn new(parts: &ReportParts<'_>, contacts: &[Contact]) -> Self {
        Self {
            oscillation: oscillation(parts, contacts),
            stress_error_estimate: None,
            stress_error_bound: None,
        }
    }
}

/// (R2).
fn oscillation(parts: &ReportParts<'_>, contacts: &[Contact]) -> Option<f64> {
    let pressure = |contact: usize| contacts.get(contact).and_then(|found| found.pressure);
    let mut inside = Vec::new();
    for (contact, neighbours) in neighbours(parts).into_iter().enumerate() {
        let (Some(own), Some(around)) = (
            pressure(contact),
            fitted(parts, contact, &neighbours, pressure),
        ) else {
            continue;
        };
        let area = parts.surface.nodes[contact].area;
        let smooth = 0.5 * (own + around);
        if smooth > 0.0 {
            inside.push((area, own - around, smooth));
        }
    }
    let area: f64 = inside.iter().map(|(area, ..)| area).sum();
    let mean = inside
        .iter()
        .map(|(area, _, smooth)| area * smooth)
        .sum::<f64>()
        / area;
    let [least, most] = INSIDE.map(|part| part * mean);
    inside.retain(|(.., smooth)| (least..=most).contains(smooth));
    let square = |of: fn(&(f64, f64, f64)) -> f64| {
        let terms = inside.iter().map(|found| found.0 * of(found).powi(2));
        terms.sum::<f64>()
    };
    let ratio = square(|found| found.1) / square(|found| found.2);
    ratio.is_finite().then(|| 0.5 * ratio.sqrt())
}

/// Neighbours of every contact along the surface; none for contacts that they do not surround.
fn neighbours(parts: &ReportParts<'_>) -> Vec<BTreeSet<usize>> {
    let mut contacts_at: BTreeMap<(usize, usize), Vec<usize>> = BTreeMap::new();
    for (contact, node) in parts.surface.nodes.iter().enumerate() {
        contacts_at
            .entry((node.body, node.node))
            .or_default()
            .push(contact);
    }
    let mut rings = vec![BTreeSet::new(); parts.surface.nodes.len()];
    let mut facets_at = vec![BTreeSet::new(); rings.len()];
    for (number, (body, facet)) in parts.surface.facets.iter().enumerate() {
        let count = facet.nodes.len();
        for (at, &node) in facet.nodes.iter().enumerate() {
            let beside = [
                facet.nodes[(at + 1) % count],
                facet.nodes[(at + count - 1) % count],
            ];
            for &contact in contacts_at.get(&(*body, node)).into_iter().flatten() {
                let pair = parts.surface.nodes[contact].pair;
                let facet_nodes: BTreeSet<usize> = facet.nodes.iter().copied().collect();
                facets_at[contact].insert((facet_nodes, number));
                for other in beside
                    .iter()
                    .filter_map(|node| contacts_at.get(&(*body, *node)))
                {
                    let same = other
                        .iter()
                        .filter(|o| parts.surface.nodes[**o].pair == pair);
                    rings[contact].extend(same.copied());
                }
            }
        }
    }
    for (ring, facets) in rings.iter_mut().zip(facets_at) {
        // A facet counts once however many pairs it stands in.
        let distinct: BTreeSet<_> = facets.into_iter().map(|(nodes, _)| nodes).collect();
        if ring.len() != distinct.len() {
            ring.clear();
        }
    }
    rings
}

/// a_i of (R1); none where the neighbours do not determine it.
fn fitted(
    parts: &ReportParts<'_>,
    contact: usize,
    neighbours: &BTreeSet<usize>,
    pressure: impl Fn(usize) -> Option<f64>,
) -> Option<f64> {
    let own = &parts.surface.nodes[contact];
    let axes = parts.dimension() - 1;
    let place = |other: usize| {
        let away = Vector3::from(parts.surface.nodes[other].position) - Vector3::from(own.position);
        let along = |axis: usize| Vector3::from(own.frame[1 + axis]).dot(&away);
        [along(0), if axes > 1 { along(1) } else { 0.0 }]
    };
    let places: Vec<[f64; 2]> = neighbours.iter().map(|&other| place(other)).collect();
    let far = places
        .iter()
        .fold(0.0_f64, |far, [x, y]| far.max(x.hypot(*y)));
    let (mut matrix, mut right) = (Matrix3::zeros(), Vector3::zeros());
    for (&other, [x, y]) in neighbours.iter().zip(places) {
        let terms = Vector3::new(1.0, x / far, y / far);
        matrix += terms * terms.transpose();
        right += terms * pressure(other)?;
    }
    if axes == 1 {
        matrix.m33 = 1.0;
    }
    let fit = matrix.cholesky()?.solve(&right)[0];
    fit.is_finite().then_some(fit)
}
