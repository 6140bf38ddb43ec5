//! How far along the contact surface of plane bodies a contact stands.
//!
//! Facets run from node to node in outward order, so the surface falls into chains. Each is measured
//! from its left end.

use std::collections::{HashMap, HashSet};

/// A facet of a plane body's contact surface: body, first node, last node.
pub(super) type Link = (usize, usize, usize);

/// Number of its chain, and its distance from the chain's start in metre, of every body and node.
pub(super) fn arcs(
    links: &[Link],
    length: impl Fn(usize) -> f64,
    position: impl Fn(usize, usize) -> [f64; 3],
) -> HashMap<(usize, usize), (u32, f64)> {
    let mut from = HashMap::new();
    for (at, &(body, first, _)) in links.iter().enumerate() {
        from.entry((body, first)).or_insert(at);
    }
    let ends: HashSet<(usize, usize)> = links.iter().map(|link| (link.0, link.2)).collect();
    let starts = links.iter().map(|link| (link.0, link.1));
    // Open chains first, each from its start; what is left are rings.
    let (rings, open): (Vec<_>, Vec<_>) = starts.partition(|start| ends.contains(start));
    let (mut arcs, mut chains) = (HashMap::new(), 0);
    for start in open.into_iter().chain(rings) {
        if arcs.contains_key(&start) {
            continue;
        }
        let mut chain = vec![(start, 0.0)];
        let (mut node, mut arc) = (start, 0.0);
        while let Some(&at) = from.get(&node) {
            node = (links[at].0, links[at].2);
            arc += length(at);
            if node == start || arcs.contains_key(&node) || chain.len() > links.len() {
                break;
            }
            chain.push((node, arc));
        }
        let backwards = position(node.0, node.1) < position(start.0, start.1);
        let whole = chain.last().map_or(0.0, |last| last.1);
        arcs.extend(chain.into_iter().map(|(node, arc)| {
            let arc = if backwards { whole - arc } else { arc };
            (node, (chains, arc))
        }));
        chains += 1;
    }
    arcs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chains_are_measured_from_their_left_end() {
        // Nodes at x = node: one chain to the right, one to the left, each of two links.
        let links = [(0, 1, 2), (0, 0, 1), (1, 9, 7), (1, 7, 4)];
        let length = |at: usize| (links[at].1 as f64 - links[at].2 as f64).abs();
        let found = arcs(&links, length, |_, node| [node as f64, 0.0, 0.0]);
        assert_eq!(found[&(0, 0)], (0, 0.0));
        assert_eq!(found[&(0, 2)], (0, 2.0));
        assert_eq!(found[&(1, 4)], (1, 0.0));
        assert_eq!(found[&(1, 9)], (1, 5.0));
    }

    #[test]
    fn a_ring_is_measured_once_around() {
        let links = [(0, 0, 1), (0, 1, 2), (0, 2, 0)];
        let found = arcs(&links, |_| 1.0, |_, node| [node as f64, 0.0, 0.0]);
        assert_eq!(found.len(), 3);
        assert_eq!(found[&(0, 2)], (0, 2.0));
    }
}
