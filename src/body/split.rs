//! Parts of a mesh that share nodes get nodes of their own, so that they can touch each other.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use super::mesh::{Facet, Group, Mesh};
use crate::error::Error;

impl Mesh {
    /// Cuts the cells of a group free from all others: nodes that both have are doubled.
    ///
    /// Two groups are added, of the facets that were shared: `NAME.own` of the group's cells and
    /// `NAME.other` of those that they touched. Every other group keeps its facets: those at the
    /// cut belong to the other cells, those only on the group's cells follow them, and edges and points
    /// at the cut stand on both sides.
    ///
    /// # Errors
    ///
    /// [`Error::NotAccepted`] for a name that is no group of cells, cells that share no node with others, or
    /// a group that is there already under a name to be added.
    pub fn split(&mut self, name: &str) -> Result<(), Error> {
        let refuse = |found: String, accepted: &str| {
            Err(Error::NotAccepted {
                place: format!("split `{name}`"),
                found,
                accepted: accepted.to_owned(),
            })
        };
        let Some(Group::Cells(cells)) = self.groups.get(name) else {
            let cells = |(name, group): (&String, &Group)| {
                matches!(group, Group::Cells(_)).then(|| format!("`{name}`"))
            };
            let known: Vec<String> = self.groups.iter().filter_map(cells).collect();
            return refuse(
                "no group of cells".to_owned(),
                &format!("a group of cells: {}", known.join(", ")),
            );
        };
        let own: BTreeSet<usize> = cells.iter().copied().collect();
        let rest = (0..self.cell_count()).filter(|cell| !own.contains(cell));
        let rest: BTreeSet<usize> = rest.collect();
        let shared = self.shared_nodes(&own, &rest);
        if shared.is_empty() {
            let accepted = "cells that share nodes with others";
            return refuse("cells that share no node with others".to_owned(), accepted);
        }
        self.part_from(
            &format!("split `{name}`: groups"),
            name,
            [&own, &rest],
            &shared,
        )
    }

    /// Gives cells nodes of their own in place of those that they share with others, and adds the groups of
    /// the facets that were shared: `NAME.own` and `NAME.other`. `place` stands for names in messages.
    pub(super) fn part_from(
        &mut self,
        place: &str,
        name: &str,
        [own, other]: [&BTreeSet<usize>; 2],
        shared: &BTreeSet<usize>,
    ) -> Result<(), Error> {
        let added = [format!("{name}.own"), format!("{name}.other")];
        if let Some(known) = added.iter().find(|name| self.groups.contains_key(*name)) {
            return Err(Error::NotAccepted {
                place: place.to_owned(),
                found: format!("a mesh with a group `{known}`"),
                accepted: "another name".to_owned(),
            });
        }
        let mut twin = HashMap::new();
        for &node in shared {
            twin.insert(node, self.nodes.len());
            self.nodes.push(self.nodes[node]);
        }
        let [inside, outside] = [own, other].map(|cells| self.facets_by_nodes(cells));
        for &cell in own {
            let nodes = self.cell(cell).nodes.iter();
            let nodes: Vec<usize> = nodes.map(|node| twin_of(&twin, *node)).collect();
            self.renumber_cell(cell, &nodes);
        }
        let only_own = |facet: &Facet| {
            let key = sorted(facet);
            inside.contains_key(&key) && !outside.contains_key(&key)
        };
        let groups = self.groups.values_mut();
        groups.for_each(|group| follow(group, &twin, only_own));
        let shared = inside
            .iter()
            .filter_map(|(key, facet)| Some((facet, outside.get(key)?)));
        let (of_own, of_other) = shared
            .map(|(own, other)| (moved(&twin, own), other.clone()))
            .unzip();
        let [own, other] = added;
        self.groups.insert(own, Group::Facets(of_own));
        self.groups.insert(other, Group::Facets(of_other));
        Ok(())
    }

    /// Nodes of some cells that others have as well.
    pub(super) fn shared_nodes(
        &self,
        own: &BTreeSet<usize>,
        other: &BTreeSet<usize>,
    ) -> BTreeSet<usize> {
        let mut on_other = vec![false; self.nodes.len()];
        let nodes = other.iter().flat_map(|&cell| self.cell(cell).nodes);
        nodes.for_each(|&node| on_other[node] = true);
        let nodes = own.iter().flat_map(|&cell| self.cell(cell).nodes);
        nodes.copied().filter(|&node| on_other[node]).collect()
    }

    /// Facets of cells, by their nodes in rising order.
    fn facets_by_nodes(&self, cells: &BTreeSet<usize>) -> BTreeMap<Vec<usize>, Facet> {
        let facets = cells.iter().flat_map(|&cell| {
            let cell = self.cell(cell);
            let facets = cell.kind.facets().iter();
            facets.map(move |local| Facet {
                nodes: local.iter().map(|&at| cell.nodes[at]).collect(),
            })
        });
        facets.map(|facet| (sorted(&facet), facet)).collect()
    }
}

/// Members of a group on cells that got nodes of their own.
fn follow(group: &mut Group, twin: &HashMap<usize, usize>, only_own: impl Fn(&Facet) -> bool) {
    match group {
        Group::Cells(_) => {}
        Group::Facets(facets) => facets
            .iter_mut()
            .filter(|facet| only_own(facet))
            .for_each(|facet| *facet = moved(twin, facet)),
        Group::Edges(edges) => {
            let cut = |edge: &&Vec<usize>| edge.iter().any(|node| twin.contains_key(node));
            let moved = |edge: &Vec<usize>| edge.iter().map(|n| twin_of(twin, *n)).collect();
            let more: Vec<Vec<usize>> = edges.iter().filter(cut).map(moved).collect();
            edges.extend(more);
        }
        Group::Points(points) => {
            let more = points.iter().filter_map(|point| twin.get(point).copied());
            points.extend(more.collect::<Vec<_>>());
        }
    }
}

fn moved(twin: &HashMap<usize, usize>, facet: &Facet) -> Facet {
    let nodes = facet.nodes.iter().map(|node| twin_of(twin, *node));
    Facet {
        nodes: nodes.collect(),
    }
}

fn sorted(facet: &Facet) -> Vec<usize> {
    let mut nodes = facet.nodes.clone();
    nodes.sort_unstable();
    nodes
}

fn twin_of(twin: &HashMap<usize, usize>, node: usize) -> usize {
    twin.get(&node).copied().unwrap_or(node)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::body::CellKind;

    /// Two unit squares side by side, nodes 1 and 4 between them.
    fn squares() -> Mesh {
        let positions = [0.0, 0.0, 1.0, 0.0, 2.0, 0.0, 0.0, 1.0, 1.0, 1.0, 2.0, 1.0];
        let cells = [0, 1, 4, 3, 1, 2, 5, 4];
        let mut mesh = Mesh::from_arrays(CellKind::Quad4, &positions, &cells).unwrap();
        let facet = |nodes: [usize; 2]| Facet {
            nodes: nodes.to_vec(),
        };
        let named = [
            ("right", Group::Cells(vec![1])),
            ("middle", Group::Facets(vec![facet([1, 4])])),
            ("floor", Group::Facets(vec![facet([0, 1]), facet([1, 2])])),
            ("corner", Group::Points(vec![1])),
        ];
        mesh.groups
            .extend(named.map(|(name, group)| (name.to_owned(), group)));
        mesh
    }

    #[test]
    fn a_part_gets_nodes_of_its_own_and_groups_follow() {
        let mut mesh = squares();
        mesh.split("right").unwrap();
        // Nodes 6 and 7 are those of the right square at 1 and 4.
        assert_eq!(mesh.nodes[6..], [[1.0, 0.0, 0.0], [1.0, 1.0, 0.0]]);
        assert_eq!(mesh.cell(0).nodes, [0, 1, 4, 3]);
        assert_eq!(mesh.cell(1).nodes, [6, 2, 5, 7]);
        let facets = |name: &str| match &mesh.groups[name] {
            Group::Facets(facets) => facets.iter().map(|f| f.nodes.clone()).collect::<Vec<_>>(),
            _ => unreachable!(),
        };
        assert_eq!(facets("floor"), [[0, 1], [6, 2]]);
        assert_eq!(facets("middle"), [[1, 4]]);
        assert_eq!(facets("right.own"), [[7, 6]]);
        assert_eq!(facets("right.other"), [[1, 4]]);
        assert_eq!(mesh.groups["corner"], Group::Points(vec![1, 6]));
    }

    #[test]
    fn what_cannot_be_cut_is_refused_by_name() {
        let said = squares().split("middle").unwrap_err().to_string();
        assert!(
            said.contains("no group of cells") && said.contains("`right`"),
            "{said}"
        );
        let mut twice = squares();
        twice.split("right").unwrap();
        assert!(twice.split("right").is_err());
        let mut alone = squares();
        alone
            .groups
            .insert("all".to_owned(), Group::Cells(vec![0, 1]));
        let said = alone.split("all").unwrap_err().to_string();
        assert!(said.contains("share no node"), "{said}");
    }
}
