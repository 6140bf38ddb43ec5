//! Drawn points: weighted means of a body's nodes, each there once.

use std::collections::HashMap;

/// Shares of nodes that differ by less are the same.
const SAME: f64 = 1e-6;

/// The points that a body is drawn with.
#[derive(Clone, Debug, Default)]
pub(super) struct Points {
    /// End of each point's entries in the two arrays below.
    ends: Vec<usize>,
    nodes: Vec<usize>,
    shares: Vec<f64>,
    /// The point at a node, once there is one.
    at_node: HashMap<usize, u32>,
    /// Those between nodes, by rounded shares in the order of nodes.
    between: HashMap<Vec<(usize, i64)>, u32>,
}

impl Points {
    /// The point `Σ N_a x_a`, a new one if there is none yet.
    pub(super) fn point(&mut self, nodes: &[usize], shape: &[f64]) -> u32 {
        let entries = nodes.iter().copied().zip(shape.iter().copied());
        let mut entries: Vec<(usize, f64)> =
            entries.filter(|(_, share)| share.abs() > SAME).collect();
        if let [(node, _)] = entries[..] {
            if let Some(&known) = self.at_node.get(&node) {
                return known;
            }
            let new = self.push(&[(node, 1.0)]);
            self.at_node.insert(node, new);
            return new;
        }
        entries.sort_unstable_by_key(|entry| entry.0);
        let key = entries.iter();
        let key: Vec<_> = key
            .map(|(node, share)| (*node, (share / SAME).round() as i64))
            .collect();
        if let Some(&known) = self.between.get(&key) {
            return known;
        }
        let new = self.push(&entries);
        self.between.insert(key, new);
        new
    }

    fn push(&mut self, entries: &[(usize, f64)]) -> u32 {
        let new = self.ends.len();
        self.nodes.extend(entries.iter().map(|entry| entry.0));
        self.shares.extend(entries.iter().map(|entry| entry.1));
        self.ends.push(self.nodes.len());
        new as u32
    }

    /// Nodes and shares of every point.
    fn entries(&self) -> impl Iterator<Item = (&[usize], &[f64])> {
        let starts = std::iter::once(0).chain(self.ends.iter().copied());
        starts
            .zip(&self.ends)
            .map(|(start, &end)| (&self.nodes[start..end], &self.shares[start..end]))
    }

    /// The node that each point stands at; none between nodes.
    pub(super) fn node_of(&self) -> impl Iterator<Item = Option<usize>> {
        self.entries().map(|(nodes, _)| match nodes {
            [node] => Some(*node),
            _ => None,
        })
    }

    /// A field at the points from its values at the nodes.
    pub(super) fn means<const N: usize>(
        &self,
        value: impl Fn(usize) -> [f64; N],
    ) -> impl Iterator<Item = [f64; N]> {
        self.entries().map(move |(nodes, shares)| {
            let mut mean = [0.0; N];
            for (&node, share) in nodes.iter().zip(shares) {
                let terms = mean.iter_mut().zip(value(node));
                terms.for_each(|(sum, component)| *sum += share * component);
            }
            mean
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_seen_from_two_cells_is_one() {
        let mut points = Points::default();
        assert_eq!(points.point(&[7, 3], &[1.0, 0.0]), 0);
        assert_eq!(points.point(&[7, 3], &[0.25, 0.75]), 1);
        assert_eq!(points.point(&[3, 9, 7], &[0.75, 0.0, 0.25]), 1);
        assert_eq!(points.point(&[9, 7], &[1e-17, 1.0]), 0);
        let means: Vec<_> = points.means(|node| [node as f64]).collect();
        assert_eq!(means, [[7.0], [4.0]]);
        assert_eq!(points.node_of().collect::<Vec<_>>(), [Some(7), None]);
    }
}
