//! Nodes that move as one rigid body: `*RIGID BODY`, and `*COUPLING` with `*KINEMATIC` in all directions.
//!
//! Motions and forces are stated at a reference node, degrees of freedom 1 to 3, its rotations and moments
//! there as 4 to 6 or at a node of their own (`ROT NODE`) as 1 to 3.

use std::collections::BTreeMap;

use super::parts::Parts;
use super::statement::{Stated, Statement};
use crate::error::Error;
use crate::mesh_file::abaqus::{Card, Contents};

/// Nodes that move as one.
#[derive(Debug)]
pub(super) struct RigidGroup<'a, 'c> {
    pub(super) nodes: Vec<usize>,
    /// The node at which motions and forces are stated.
    pub(super) reference: usize,
    /// The connected part that they all belong to.
    pub(super) part: usize,
    /// Where it is stated.
    pub(super) card: &'c Card<'a>,
}

/// All groups of a deck, and what their reference nodes stand for.
#[derive(Debug, Default)]
pub(super) struct RigidGroups<'a, 'c> {
    pub(super) groups: Vec<RigidGroup<'a, 'c>>,
    /// Group of a reference node, and whether its directions are rotations.
    of_node: BTreeMap<usize, (usize, bool)>,
}

impl<'a, 'c> RigidGroups<'a, 'c> {
    pub(super) fn new(
        statement: &Statement<'a, 'c>,
        contents: &Contents,
        parts: &Parts,
    ) -> Result<Self, Error> {
        let mut found = Self::default();
        let mut cards = statement.model.iter().peekable();
        while let Some(&stated) = cards.next() {
            match stated.1.name.as_str() {
                "RIGIDBODY" => found.read_body(stated, contents, parts)?,
                "COUPLING" => {
                    let next = cards.next_if(|(_, card)| card.name == "KINEMATIC");
                    found.read_coupling(stated, next, contents, parts)?;
                }
                "KINEMATIC" => {
                    return Err(stated.1.error("expected *COUPLING right before"));
                }
                _ => {}
            }
        }
        Ok(found)
    }

    /// The group that a node stands for, and whether its directions are rotations.
    pub(super) fn of(&self, node: usize) -> Option<(usize, bool)> {
        self.of_node.get(&node).copied()
    }

    fn read_body(
        &mut self,
        (scope, card): Stated<'a, 'c>,
        contents: &Contents,
        parts: &Parts,
    ) -> Result<(), Error> {
        card.only(&["NSET", "ELSET", "REFNODE", "ROTNODE"])?;
        let head = card.head(scope);
        let mut nodes = Vec::new();
        match (card.get("NSET"), card.get("ELSET")) {
            (Some(set), None) => nodes = contents.nodes.members(head, set)?,
            (None, Some(set)) => {
                for cell in contents.cells.members(head, set)? {
                    nodes.extend(&contents.elements[cell].nodes);
                }
            }
            _ => return Err(card.error("expected one of `NSET=` and `ELSET=`")),
        }
        let node = |key: &str| match contents.nodes.members(head, card.need(key)?)?[..] {
            [node] => Ok(node),
            _ => Err(card.error(format!("`{key}=`: expected one node"))),
        };
        let reference = node("REFNODE")?;
        if card.get("ROTNODE").is_some() {
            self.stand_for(node("ROTNODE")?, true, card)?;
        }
        self.add(nodes, reference, card, parts)
    }

    fn read_coupling(
        &mut self,
        (scope, card): Stated<'a, 'c>,
        kinematic: Option<&Stated<'a, 'c>>,
        contents: &Contents,
        parts: &Parts,
    ) -> Result<(), Error> {
        card.only(&["CONSTRAINTNAME", "REFNODE", "SURFACE"])?;
        let &(_, kinematic) = kinematic
            .ok_or_else(|| card.error("expected *KINEMATIC right after; no other is read"))?;
        kinematic.only(&[])?;
        let mut coupled = [false; 6];
        for row in kinematic.rows(scope) {
            let first = row.label(row.word(0), "degree of freedom")? as usize;
            let last = match row.word(1) {
                "" => first,
                word => row.label(word, "degree of freedom")? as usize,
            };
            (coupled.iter_mut().enumerate())
                .filter(|(at, _)| (first..=last).contains(&(at + 1)))
                .for_each(|(_, coupled)| *coupled = true);
        }
        let directions = if parts.plane() { 2 } else { 3 };
        let stated = kinematic.rows(scope).next().is_some();
        if stated && coupled[..directions].contains(&false) {
            return Err(kinematic.error(format!(
                "couples some directions only; expected 1 to {directions}, as of a rigid surface"
            )));
        }
        let head = card.head(scope);
        let (_, sides) = contents.surface(head, card.need("SURFACE")?)?;
        let nodes = sides.iter().flat_map(|&side| contents.facet(side));
        match contents.nodes.members(head, card.need("REFNODE")?)?[..] {
            [node] => self.add(nodes.collect(), node, card, parts),
            _ => Err(card.error("`REF NODE=`: expected one node")),
        }
    }

    fn add(
        &mut self,
        mut nodes: Vec<usize>,
        reference: usize,
        card: &'c Card<'a>,
        parts: &Parts,
    ) -> Result<(), Error> {
        self.stand_for(reference, false, card)?;
        nodes.sort_unstable();
        nodes.dedup();
        nodes.retain(|&node| parts.of_node[node].is_some());
        let of = |node: &usize| parts.of_node[*node];
        let part = nodes.first().and_then(of);
        let Some(part) = part.filter(|_| nodes.iter().all(|node| of(node) == part)) else {
            return Err(card.error("expected nodes of one connected part"));
        };
        self.groups.push(RigidGroup {
            nodes,
            reference,
            part,
            card,
        });
        Ok(())
    }

    fn stand_for(&mut self, node: usize, turns: bool, card: &Card<'_>) -> Result<(), Error> {
        let group = (self.groups.len(), turns);
        match self.of_node.insert(node, group) {
            None => Ok(()),
            Some(_) => Err(card.error("a reference node that stands for another group, too")),
        }
    }
}
