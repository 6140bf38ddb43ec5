//! Facets that meet the same other side in two contacts, and places where contacts of two have one motion.

use std::collections::{HashMap, HashSet};

use crate::body::Facet;
use crate::contact::{ContactNode, ContactPair, Opposite, facet_key};
use crate::report::ReportParts;

/// Difference of weights that is round-off.
const ALIKE: f64 = 1e-6;

/// That facets of a pair meet what they meet in an earlier one as well: each carries by itself.
pub(super) fn stated_twice(parts: &ReportParts<'_>, pair: usize) -> Option<String> {
    let this = &parts.pairs[pair];
    let earlier = parts.pairs[..pair].iter();
    let before = earlier
        .into_iter()
        .find(|before| meet_alike(this, before))?;
    Some(format!(
        "facets of it meet the same side in {} too, and both carry: what bounds shear or tension there counts twice, and \
         which of them a pressure is on is not determined; leave one out",
        before.place
    ))
}

/// That a contact of a pair moves as one of an earlier pair does, where two parts of a face end at one node.
pub(super) fn one_motion(parts: &ReportParts<'_>, pair: usize) -> Option<String> {
    let of = |wanted: fn(usize, usize) -> bool| {
        let all = parts.surface.nodes.iter();
        all.filter(move |contact| wanted(contact.pair, pair))
    };
    let mut before: HashMap<usize, Vec<&ContactNode>> = HashMap::new();
    for contact in of(|one, pair| one < pair) {
        before.entry(contact.node).or_default().push(contact);
    }
    let twin = of(|one, pair| one == pair).find_map(|contact| {
        let mut others = before.get(&contact.node)?.iter();
        let other = others.find(|other| move_alike(contact, other))?;
        Some((contact.node, other.pair))
    });
    let (node, other) = twin?;
    Some(format!(
        "its contact at node {node} moves as one of {} does: which of both carries is not determined, nor what bounds \
         its shear; put the groups of both into one contact, as a list",
        parts.pairs[other].place
    ))
}

/// Whether two contacts are between the same means of both sides, along the same normal.
fn move_alike(one: &ContactNode, other: &ContactNode) -> bool {
    let same = |a: &[(usize, f64)], b: &[(usize, f64)]| {
        let mut pairs = a.iter().zip(b);
        a.len() == b.len() && pairs.all(|(a, b)| a.0 == b.0 && (a.1 - b.1).abs() < ALIKE)
    };
    let across = match (&one.opposite, &other.opposite) {
        (Some(a), Some(b)) => a.body == b.body && same(&a.nodes, &b.nodes),
        _ => false,
    };
    let normals = one.frame[0].iter().zip(other.frame[0]);
    let along: f64 = normals.map(|(a, b)| a * b).sum();
    one.body == other.body && along > 1.0 - ALIKE && same(&one.own, &other.own) && across
}

fn meet_alike(one: &ContactPair, other: &ContactPair) -> bool {
    match (&one.opposite, &other.opposite) {
        (Opposite::Obstacle(a), Opposite::Obstacle(b)) => {
            one.body == other.body && a == b && share(&one.facets, &other.facets)
        }
        (
            Opposite::Surface {
                body: a,
                facets: on_a,
            },
            Opposite::Surface {
                body: b,
                facets: on_b,
            },
        ) => {
            let alike = one.body == other.body && a == b;
            let turned = one.body == *b && *a == other.body;
            alike && share(&one.facets, &other.facets) && share(on_a, on_b)
                || turned && share(&one.facets, on_b) && share(on_a, &other.facets)
        }
        _ => false,
    }
}

fn share(one: &[Facet], other: &[Facet]) -> bool {
    let of_one: HashSet<Vec<usize>> = one.iter().map(facet_key).collect();
    other.iter().any(|facet| of_one.contains(&facet_key(facet)))
}
