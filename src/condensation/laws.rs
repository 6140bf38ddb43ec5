//! The laws of the contacts: those of their pairs, over their areas, in their tangents.
//!
//! ```text
//! (C25)  c = c' A,  a = a' A,  τ = τ' A,  C = C'/A        A: tributary area, primed: per area
//!        ellipse: the direction's part in the tangent plane; of one tangent half its width along it
//! ```

use std::ops::Range;

use crate::contact::{ContactNode, ContactPair, ContactSurface, PairLaw};
use crate::error::Error;
use crate::problem::{ContactProblem, Ellipse, Law};

/// Least part of a direction in the tangent plane.
const LEANING: f64 = 1e-6;

/// Tangential compliance of a contact that supports hold along the surface, over its normal one.
const HELD: f64 = 1e-6;

/// Coefficient of friction per contact.
pub(crate) fn friction(surface: &ContactSurface, pairs: &[ContactPair]) -> Vec<f64> {
    let nodes = surface.nodes.iter();
    nodes
        .map(|contact| {
            let pair = &pairs[contact.pair];
            pair.law.friction_at(pair.friction, contact) * narrowed(&pair.law, contact)
        })
        .collect()
}

/// The same problem under the laws of its pairs, and layers where supports hold; as it is where there are neither.
pub(super) fn under_laws(
    problem: ContactProblem,
    surface: &ContactSurface,
    pairs: &[ContactPair],
) -> Result<ContactProblem, Error> {
    let plain = PairLaw {
        places: None,
        ..PairLaw::default()
    };
    let stated = |pair: &ContactPair| {
        PairLaw {
            places: None,
            ..pair.law.clone()
        } != plain
    };
    let held = held(&problem);
    if !pairs.iter().any(stated) && held.iter().all(|layer| *layer == 0.0) {
        return Ok(problem);
    }
    let laws = surface.nodes.iter().zip(held).map(|(contact, layer)| {
        let mut law = law(&pairs[contact.pair], contact)?;
        if law.compliance[1] == 0.0 {
            law.compliance[1] = layer;
        }
        Ok(law)
    });
    problem.with_laws(laws.collect::<Result<_, Error>>()?)
}

/// Tangential compliance, in m/N, of contacts with friction that supports hold along the surface, and zero of all others: where
/// nothing gives way, friction would not be unique while the sides stand still, nor go on from what it was.
fn held(problem: &ContactProblem) -> Vec<f64> {
    let g = problem.compliance();
    let diagonal = |unknowns: Range<usize>| unknowns.map(|k| g[(k, k)]);
    let largest = diagonal(0..problem.unknowns()).fold(0.0, f64::max);
    let layers = problem.blocks().map(|block| {
        let rigid = diagonal(block.start + 1..block.end).any(|compliance| compliance == 0.0);
        let normal = g[(block.start, block.start)];
        let like = if normal > 0.0 { normal } else { largest };
        if rigid { HELD * like } else { 0.0 }
    });
    layers.collect()
}

fn law(pair: &ContactPair, contact: &ContactNode) -> Result<Law, Error> {
    let (law, area) = (&pair.law, contact.area.max(0.0));
    let refuse = |found: &str, accepted: &str| Error::NotAccepted {
        place: pair.place.clone(),
        found: format!(
            "{found} at node {}, at {:?}",
            contact.node, contact.position
        ),
        accepted: accepted.to_owned(),
    };
    if area == 0.0 && law.compliance != [0.0; 2] {
        return Err(refuse(
            "a contact without area under a law with compliance",
            "facets whose contacts all have an area: linear ones, or quadratic ones that face the other side whole",
        ));
    }
    let ellipse = match (law.ellipse, direction(law, contact)) {
        (Some(_), None) => {
            return Err(refuse(
                "a direction of friction along the normal",
                "one that lies in the surface everywhere",
            ));
        }
        (Some((ratio, _)), Some(direction)) if contact.tangents == 2 => {
            Some(Ellipse { direction, ratio })
        }
        _ => None,
    };
    let of = |compliance: f64| {
        if compliance > 0.0 {
            compliance / area
        } else {
            0.0
        }
    };
    Ok(Law {
        bilateral: law.bilateral,
        sticks: law.sticks,
        tension: law.tension * area,
        shear: law.shear * area,
        cap: if law.cap.is_finite() {
            law.cap * area
        } else {
            law.cap
        },
        ellipse,
        compliance: law.compliance.map(of),
    })
}

/// The direction of an ellipse in the contact's tangents, of unit length.
fn direction(law: &PairLaw, contact: &ContactNode) -> Option<[f64; 2]> {
    let (_, direction) = law.ellipse?;
    let along = |row: [f64; 3]| row.iter().zip(direction).map(|(a, b)| a * b).sum::<f64>();
    let [x, y] = [along(contact.frame[1]), along(contact.frame[2])];
    let size = x.hypot(y);
    (size > LEANING).then(|| [x / size, y / size])
}

/// What an ellipse makes of the coefficient where a support leaves one tangent: half its width along that, as the support
/// bears what friction does across.
fn narrowed(law: &PairLaw, contact: &ContactNode) -> f64 {
    match (law.ellipse, direction(law, contact), contact.tangents) {
        (Some((ratio, _)), Some([x, y]), 1) => x.hypot(y * ratio),
        _ => 1.0,
    }
}
