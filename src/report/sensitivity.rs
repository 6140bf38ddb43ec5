//! Derivatives of the totals, under the names that tables give them.
//!
//! Areas in contact are sums over nodes and change in jumps: they have no derivative. What is largest
//! or least has one on either side where several contacts share it.

use serde::Serialize;

use super::ReportParts;
use super::contacts::{across, contact_forces, has_sliding_layer, slip};
use super::totals::Sums;
use crate::alternation::{Rate, Sides};
use crate::kkt::{ContactStatus, global_force, relative_displacement};

/// Values within this part of the extreme one share it.
const SHARED: f64 = 1e-9;

/// What the totals gain per unit of a parameter.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Sensitivity {
    /// Name of the parameter: as [`Variation`](crate::Variation) has it, or `bodies[0].young`, a factor on
    /// all moduli of the body.
    pub parameter: String,
    /// The derivatives.
    pub derivatives: Vec<ReportedDerivative>,
}

/// Derivative of one total.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ReportedDerivative {
    /// Which total, as tables name it.
    pub of: String,
    /// As the parameter grows.
    pub growing: f64,
    /// As it falls, where that differs: the state is at a kink.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub falling: Option<f64>,
}

/// How reactions and bodies move per unit of a parameter.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Moved {
    /// Of the contact problem.
    pub(crate) rate: Rate,
    /// Per body and unknown (`node · dimension + axis`), in metre per unit; none where `rate` tells how contacts slide.
    pub(crate) displacements: Vec<Vec<f64>>,
    /// Of the other side per contact that a rigid body moves, in metre per unit; none at all where none does.
    pub(crate) sides: Vec<[f64; 3]>,
}

impl Sensitivity {
    /// The derivative of a total, as the parameter grows; none if there is no such total.
    #[must_use]
    pub fn of(&self, total: &str) -> Option<f64> {
        let mut all = self.derivatives.iter();
        let found = all.find(|derivative| derivative.of == total)?;
        Some(found.growing)
    }
}

/// Derivatives of all totals of a state.
pub(crate) fn derivatives(
    parts: &ReportParts<'_>,
    moved: &Sides<Moved>,
) -> Vec<ReportedDerivative> {
    let growing = of_side(parts, &moved.growing, 1.0);
    let falling = of_side(
        parts,
        moved.falling.as_ref().unwrap_or(&moved.growing),
        -1.0,
    );
    let both = growing.into_iter().zip(falling);
    both.map(|((of, growing), (_, falling))| ReportedDerivative {
        of,
        growing,
        falling: differs(growing, falling).then_some(falling),
    })
    .collect()
}

fn differs(growing: f64, falling: f64) -> bool {
    (growing - falling).abs() > SHARED * growing.abs().max(falling.abs())
}

/// On the side of a sign.
fn of_side(parts: &ReportParts<'_>, moved: &Moved, sign: f64) -> Vec<(String, f64)> {
    let dimension = parts.dimension();
    let forces = contact_forces(parts, &moved.rate.reaction);
    let sums = Sums::of(parts, &forces, None);
    let mut all = vec![("normal".to_owned(), sums.normal)];
    let axes = |name: &str, vector: [f64; 3]| {
        let named = ["x", "y", "z"].into_iter().zip(vector).take(dimension);
        let named = named.map(|(axis, value)| (format!("{name}_{axis}"), value));
        named.collect::<Vec<_>>()
    };
    all.extend(axes("friction", sums.friction));
    all.extend(axes("contact_force", sums.contact.force));
    match dimension {
        2 => all.push(("moment".to_owned(), sums.contact.moment[2])),
        _ => all.extend(axes("moment", sums.contact.moment)),
    }
    let nodes = &parts.surface.nodes;
    let pressures = forces.iter().zip(nodes).enumerate();
    let pressures = pressures.filter(|(_, (_, contact))| contact.area > 0.0);
    let pressures = pressures.map(|(k, (force, contact))| {
        let value = -parts.outcome.reaction[parts.problem.normals()[k]] / contact.area;
        match value < 0.0 {
            // What pulls has no pressure.
            true => (0.0, 0.0),
            false => (value, force.pressing / contact.area),
        }
    });
    let pressures: Vec<_> = pressures.collect();
    let gaps = parts.problem.normals().iter().enumerate().map(|(k, &n)| {
        let gap = parts.problem.gap(k, &parts.outcome.verdict.displacement);
        (gap, 0.0 - moved.rate.beyond[n])
    });
    let gaps: Vec<_> = gaps.collect();
    let slips: Vec<_> = (0..nodes.len())
        .map(|k| slipping(parts, moved, k, sign))
        .collect();
    for (name, values, wanted) in [
        ("peak_pressure", &pressures, 1.0),
        ("least_gap", &gaps, -1.0),
        ("largest_gap", &gaps, 1.0),
        ("largest_slip", &slips, 1.0),
    ] {
        if let Some(rate) = of_extreme(values, wanted, sign * wanted) {
            all.push((name.to_owned(), rate));
        }
    }
    all
}

/// Length of a contact's slip, and its rate.
fn slipping(parts: &ReportParts<'_>, moved: &Moved, contact: usize, sign: f64) -> (f64, f64) {
    if parts.outcome.verdict.status[contact] == ContactStatus::Open {
        return (0.0, 0.0);
    }
    let node = &parts.surface.nodes[contact];
    let slip = slip(parts, contact);
    let told = node.tangents + 1 == parts.dimension() || has_sliding_layer(parts, contact);
    let rate = match moved.displacements.as_slice() {
        // A vector along the directions of its contact, like a force.
        bodies if told || bodies.is_empty() => {
            global_force(node, &moved.rate.beyond[parts.problem.block(contact)])
        }
        bodies => {
            let own = relative_displacement(node, bodies, parts.dimension());
            let side = moved.sides.get(contact).copied().unwrap_or_default();
            [0, 1, 2].map(|k| own[k] - side[k])
        }
    };
    let rate = across(node.frame[0], rate);
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let length = dot(slip, slip).sqrt();
    match length > 0.0 {
        true => (length, dot(slip, rate) / length),
        false => (0.0, sign * dot(rate, rate).sqrt()),
    }
}

/// Rate of the largest value (`wanted` 1) or the least (−1); of those that share it the one with the largest rate
/// (`sign` 1) or the least.
fn of_extreme(values: &[(f64, f64)], wanted: f64, sign: f64) -> Option<f64> {
    let (mut best, mut size) = (f64::NEG_INFINITY, 0.0_f64);
    for (value, _) in values {
        (best, size) = (best.max(wanted * value), size.max(value.abs()));
    }
    let shared = values
        .iter()
        .filter(|(value, _)| wanted * value >= best - SHARED * size);
    let rates = shared.map(|(_, rate)| *rate);
    rates.reduce(|one, other| {
        if sign * other > sign * one {
            other
        } else {
            one
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_of_two_that_share_it_grows_with_the_faster_one() {
        // max(3 + p, 3 − 2 p, 1 + 9 p): +1 as p grows, −2 as it falls; min: 1 + 9 p.
        let values = [(3.0, 1.0), (3.0, -2.0), (1.0, 9.0)];
        assert_eq!(of_extreme(&values, 1.0, 1.0), Some(1.0));
        assert_eq!(of_extreme(&values, 1.0, -1.0), Some(-2.0));
        assert_eq!(of_extreme(&values, -1.0, -1.0), Some(9.0));
        assert_eq!(of_extreme(&[], 1.0, 1.0), None);
    }
}
