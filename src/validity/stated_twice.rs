//! Facets that meet the same other side in two contacts.

use std::collections::HashSet;

use crate::body::Facet;
use crate::contact::{ContactPair, Opposite};
use crate::report::ReportParts;

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
    let key = |facet: &Facet| {
        let mut nodes = facet.nodes.clone();
        nodes.sort_unstable();
        nodes
    };
    let of_one: HashSet<Vec<usize>> = one.iter().map(key).collect();
    other.iter().any(|facet| of_one.contains(&key(facet)))
}
