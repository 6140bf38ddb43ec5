//! What a card of loads or supports sets: a number for each node and axis, face, or element and axis.

use std::collections::BTreeSet;

use super::material::Materials;
use super::parts::Parts;
use super::statement::{Notes, Stated};
use crate::error::Error;
use crate::mesh_file::abaqus::{Contents, Row, Side, Space, bare};

/// What a number is given for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Slot {
    /// Displacement of a node along an axis.
    Held(usize, usize),
    /// Force on a node along an axis.
    Force(usize, usize),
    /// Pressure on a face.
    Pressure(Side),
    /// Force per volume of an element along an axis.
    Weight(usize, usize),
}

/// What one row of a card says.
pub(super) type Given = (Slot, f64);

/// What the numbers of loads and supports mean.
pub(super) struct Reader<'r> {
    pub(super) contents: &'r Contents,
    pub(super) materials: &'r Materials,
    pub(super) parts: &'r Parts,
    pub(super) outer: BTreeSet<Side>,
}

/// Supports by name: which axes are held.
const NAMED: [(&str, [bool; 3]); 8] = [
    ("ENCASTRE", [true; 3]),
    ("PINNED", [true; 3]),
    ("XSYMM", [true, false, false]),
    ("YSYMM", [false, true, false]),
    ("ZSYMM", [false, false, true]),
    ("XASYMM", [false, true, true]),
    ("YASYMM", [true, false, true]),
    ("ZASYMM", [true, true, false]),
];

impl Reader<'_> {
    /// All that a card says, row by row.
    pub(super) fn read(
        &self,
        (scope, card): Stated<'_, '_>,
        notes: &mut Notes,
    ) -> Result<Vec<Given>, Error> {
        match card.name.as_str() {
            "BOUNDARY" => card.only(&["OP", "AMPLITUDE", "TYPE"])?,
            _ => card.only(&["OP", "AMPLITUDE"])?,
        }
        card.one_of("OP", &["NEW", "MOD"])?;
        card.one_of("TYPE", &["DISPLACEMENT"])?;
        let mut given = Vec::new();
        for row in card.rows(scope) {
            given.extend(match card.name.as_str() {
                "BOUNDARY" => self.held(row, notes)?,
                "CLOAD" => self.forces(row, notes)?,
                "DSLOAD" => self.surface_pressure(row)?,
                _ => self.distributed(row)?,
            });
        }
        Ok(given)
    }

    fn dimension(&self) -> usize {
        match self.parts.parts.first().map(|part| part.space) {
            Some(Space::Solid) | None => 3,
            Some(_) => 2,
        }
    }

    /// The nodes of a row's first word that some element has.
    fn nodes(&self, row: Row<'_, '_>, notes: &mut Notes) -> Result<Vec<usize>, Error> {
        let mut nodes = self.contents.nodes.members(row, row.word(0))?;
        let all = nodes.len();
        nodes.retain(|&node| self.parts.of_node[node].is_some());
        if nodes.len() < all {
            notes.add(row.card, "nodes that belong to no element are left out");
        }
        Ok(nodes)
    }

    fn held(&self, row: Row<'_, '_>, notes: &mut Notes) -> Result<Vec<Given>, Error> {
        let nodes = self.nodes(row, notes)?;
        let named = NAMED.iter().find(|(name, _)| *name == bare(row.word(1)));
        let (axes, value) = match named {
            Some((_, held)) => (*held, 0.0),
            None => {
                let first = degree(row, row.word(1))?;
                let last = match row.word(2) {
                    "" => first,
                    word => degree(row, word)?,
                };
                if last < first {
                    let reason = format!("degrees of freedom {first} to {last}; expected a rise");
                    return Err(row.error(reason));
                }
                let axes = [1, 2, 3].map(|dof| (first..=last).contains(&dof));
                (axes, row.number(3, "a displacement", 0.0)?)
            }
        };
        let axes = (0..self.dimension()).filter(|&axis| axes[axis]);
        let each = axes.flat_map(|axis| nodes.iter().map(move |&node| Slot::Held(node, axis)));
        Ok(each.map(|slot| (slot, value)).collect())
    }

    fn forces(&self, row: Row<'_, '_>, notes: &mut Notes) -> Result<Vec<Given>, Error> {
        let nodes = self.nodes(row, notes)?;
        let axis = degree(row, row.word(1))? - 1;
        let force = row.number(2, "a force", None)?;
        if axis >= self.dimension() {
            return Ok(Vec::new());
        }
        let depth = |node: usize| match self.parts.of_node[node] {
            Some(part) => self.parts.parts[part].depth(),
            None => 1.0,
        };
        let each = nodes.into_iter();
        Ok(each
            .map(|node| (Slot::Force(node, axis), force / depth(node)))
            .collect())
    }

    fn surface_pressure(&self, row: Row<'_, '_>) -> Result<Vec<Given>, Error> {
        let label = bare(row.word(1));
        if label != "P" {
            return Err(row.error(format!("load `{label}` is not read; accepted: P")));
        }
        let sides = self.contents.surface(row, row.word(0))?;
        let pressure = row.number(2, "a pressure", None)?;
        Ok(sides
            .1
            .iter()
            .map(|&side| (Slot::Pressure(side), pressure))
            .collect())
    }

    /// Pressure on faces, weight, force per volume.
    fn distributed(&self, row: Row<'_, '_>) -> Result<Vec<Given>, Error> {
        let cells = self.contents.cells.members(row, row.word(0))?;
        let label = bare(row.word(1));
        let value = row.number(2, "a load", None)?;
        let along = |axis: usize| {
            Ok(cells
                .iter()
                .map(|&c| (Slot::Weight(c, axis), value))
                .collect())
        };
        match label.as_str() {
            "BX" => along(0),
            "BY" => along(1),
            "BZ" if self.dimension() == 3 => along(2),
            "GRAV" => self.weight(row, &cells, value),
            _ if label.len() == 2 && label.starts_with('P') => cells
                .into_iter()
                .map(|cell| {
                    let side = self.contents.side(cell, &label, 'P', &self.outer);
                    Ok((Slot::Pressure(side.map_err(|e| row.error(e))?), value))
                })
                .collect(),
            _ => Err(row.error(format!(
                "load `{label}` is not read; accepted: P1 to P6, GRAV, BX, BY, BZ"
            ))),
        }
    }

    fn weight(&self, row: Row<'_, '_>, cells: &[usize], gravity: f64) -> Result<Vec<Given>, Error> {
        let mut direction = [0.0; 3];
        for (axis, component) in direction.iter_mut().enumerate() {
            *component = row.number(3 + axis, "a direction", 0.0)?;
        }
        let length = direction.iter().fold(0.0_f64, |sum, x| sum.hypot(*x));
        if (length - 1.0).abs() > 1e-6 {
            let reason = format!("direction of length {length}; expected one of length 1");
            return Err(row.error(reason));
        }
        let mut given = Vec::new();
        for &cell in cells {
            let material = self.materials.of(cell);
            let missing = || row.error(format!("material `{}` has no *DENSITY", material.name));
            let density = material.density.ok_or_else(missing)?;
            let axes = direction.iter().take(self.dimension()).enumerate();
            let axes = axes.filter(|(_, component)| **component != 0.0);
            given.extend(axes.map(|(axis, n)| (Slot::Weight(cell, axis), density * gravity * n)));
        }
        Ok(given)
    }
}

/// A degree of freedom, from 1; those of rotations are no matter of solids and are passed over.
fn degree(row: Row<'_, '_>, word: &str) -> Result<usize, Error> {
    match row.label(word, "degree of freedom")? {
        dof @ 1..=6 => Ok(dof as usize),
        dof => Err(row.error(format!("degree of freedom {dof}; expected 1 to 3"))),
    }
}
