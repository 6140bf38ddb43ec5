//! `*PRE-TENSION SECTION` as it is stated.

use std::collections::BTreeMap;

use super::parts::Parts;
use super::statement::Statement;
use super::transform::{dot, numbers};
use crate::error::Error;
use crate::mesh_file::abaqus::{Card, Contents, Side};

/// Sine of the angle by which a stated vector may lie off the normal of the section.
const ASIDE: f64 = 1e-3;

/// A section.
#[derive(Debug)]
pub(super) struct Section<'a, 'c> {
    /// Faces on one side of the cut.
    pub(super) sides: Vec<Side>,
    /// The vector that is stated.
    direction: Option<[f64; 3]>,
    /// The connected part that is cut.
    pub(super) part: usize,
    /// Where it is stated.
    pub(super) card: &'c Card<'a>,
}

/// All sections of a deck, and their reference nodes.
#[derive(Debug, Default)]
pub(super) struct Sections<'a, 'c> {
    pub(super) sections: Vec<Section<'a, 'c>>,
    of_node: BTreeMap<usize, usize>,
}

impl<'a, 'c> Sections<'a, 'c> {
    pub(super) fn new(
        statement: &Statement<'a, 'c>,
        contents: &Contents,
        parts: &Parts,
    ) -> Result<Self, Error> {
        let mut found = Self::default();
        let model = statement.model.iter();
        for &(scope, card) in model.filter(|(_, card)| card.name == "PRE-TENSIONSECTION") {
            if card.get("ELEMENT").is_some() {
                return Err(card.error("`ELEMENT=` is not read: beams"));
            }
            card.only(&["SURFACE", "NODE"])?;
            let head = card.head(scope);
            let sides = contents.section(head, card.need("SURFACE")?)?;
            let [node] = contents.nodes.members(head, card.need("NODE")?)?[..] else {
                return Err(card.error("`NODE=`: expected one node"));
            };
            if parts.of_node[node].is_some() || found.of_node.contains_key(&node) {
                return Err(card.error(
                    "a reference node of elements, or of another section; expected a node of its own",
                ));
            }
            let mut of_sides = sides.iter().map(|side| parts.of_cell[side.0]);
            let part = of_sides
                .next()
                .filter(|part| of_sides.all(|other| other == *part));
            let apart = || card.error("expected faces of one connected part");
            let direction = match card.rows(scope).next() {
                Some(_) => {
                    let stated = contents.nodes.scope(scope);
                    Some(stated.turn(numbers(card.row("a vector")?)?))
                }
                None => None,
            };
            found.of_node.insert(node, found.sections.len());
            found.sections.push(Section {
                sides: sides.iter().copied().collect(),
                direction,
                part: part.ok_or_else(apart)?,
                card,
            });
        }
        Ok(found)
    }

    /// The section whose reference node it is.
    pub(super) fn of(&self, node: usize) -> Option<usize> {
        self.of_node.get(&node).copied()
    }
}

impl Section<'_, '_> {
    /// Whether what is stated pulls (1) or presses (−1), beside the normal out of the faces.
    pub(super) fn sign(&self, outward: [f64; 3]) -> Result<f64, Error> {
        let Some(stated) = self.direction else {
            return Ok(1.0);
        };
        let cosine = dot(stated, outward) / dot(stated, stated).sqrt();
        match 1.0 - cosine * cosine < ASIDE * ASIDE {
            true => Ok(cosine.signum()),
            false => Err(self.card.error(format!(
                "the vector {stated:?} aside of the section's normal {outward:?}; expected one along it"
            ))),
        }
    }
}
