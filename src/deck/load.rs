//! What a card of loads or supports sets: a number for each node and axis, face, or element and axis.

use std::collections::BTreeSet;

use super::material::Materials;
use super::parts::Parts;
use super::statement::{Notes, Stated};
use crate::error::Error;
use crate::mesh_file::abaqus::{Card, Contents, Line, Side, Space, bare, fields};

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

/// Last degree of freedom of a rotation; from the dimension on they are no matter of solids.
const LAST_ROTATION: u64 = 6;

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
        for row in &card.rows {
            let of_row = match card.name.as_str() {
                "BOUNDARY" => self.held(scope, card, row, notes)?,
                "CLOAD" => self.forces(scope, card, row, notes)?,
                "DSLOAD" => self.surface_pressure(scope, card, row)?,
                _ => self.distributed(scope, card, row)?,
            };
            given.extend(of_row);
        }
        Ok(given)
    }

    fn dimension(&self) -> usize {
        match self.parts.parts.first().map(|part| part.space) {
            Some(Space::Solid) | None => 3,
            Some(_) => 2,
        }
    }

    /// The nodes of a word that some element has.
    fn nodes(
        &self,
        scope: usize,
        (card, row): (&Card<'_>, &Line<'_>),
        word: &str,
        notes: &mut Notes,
    ) -> Result<Vec<usize>, Error> {
        let mut nodes = self.contents.nodes.members(scope, (card, row), word)?;
        let all = nodes.len();
        nodes.retain(|&node| self.parts.of_node[node].is_some());
        if nodes.len() < all {
            notes.add(card, "nodes that belong to no element are left out");
        }
        Ok(nodes)
    }

    fn held(
        &self,
        scope: usize,
        card: &Card<'_>,
        row: &Line<'_>,
        notes: &mut Notes,
    ) -> Result<Vec<Given>, Error> {
        let words: Vec<&str> = fields(row).collect();
        let nodes = self.nodes(scope, (card, row), words[0], notes)?;
        let word = |at: usize| words.get(at).copied().unwrap_or_default();
        let mut axes = [false; 3];
        let mut value = 0.0;
        if let Some((_, held)) = NAMED.iter().find(|(name, _)| *name == bare(word(1))) {
            axes = *held;
        } else {
            let first = card.label(row, word(1), "degree of freedom")?;
            let last = match word(2) {
                "" => first,
                word => card.label(row, word, "degree of freedom")?,
            };
            value = card.number(row, 3, "a displacement", Some(0.0))?;
            if last < first || last > LAST_ROTATION {
                let reason = format!("degrees of freedom {first} to {last}; expected 1 to 3");
                return Err(card.at(row, reason));
            }
            (first..=last.min(3)).for_each(|dof| axes[dof as usize - 1] = true);
        }
        let axes = (0..self.dimension()).filter(|&axis| axes[axis]);
        let each = axes.flat_map(|axis| nodes.iter().map(move |&node| Slot::Held(node, axis)));
        Ok(each.map(|slot| (slot, value)).collect())
    }

    fn forces(
        &self,
        scope: usize,
        card: &Card<'_>,
        row: &Line<'_>,
        notes: &mut Notes,
    ) -> Result<Vec<Given>, Error> {
        let words: Vec<&str> = fields(row).collect();
        let nodes = self.nodes(scope, (card, row), words[0], notes)?;
        let dof = card.label(
            row,
            words.get(1).copied().unwrap_or_default(),
            "degree of freedom",
        )?;
        if dof > LAST_ROTATION {
            return Err(card.at(row, format!("degree of freedom {dof}; expected 1 to 3")));
        }
        let force = card.number(row, 2, "a force", None)?;
        if dof as usize > self.dimension() {
            return Ok(Vec::new());
        }
        let each = nodes.into_iter().map(|node| {
            let part = self.parts.of_node[node].map(|part| &self.parts.parts[part]);
            let depth = match part {
                Some(part) if part.space == Space::PlaneStrain => part.thickness,
                _ => 1.0,
            };
            (Slot::Force(node, dof as usize - 1), force / depth)
        });
        Ok(each.collect())
    }

    fn surface_pressure(
        &self,
        scope: usize,
        card: &Card<'_>,
        row: &Line<'_>,
    ) -> Result<Vec<Given>, Error> {
        let words: Vec<String> = fields(row).map(bare).collect();
        let label = words.get(1).map(String::as_str).unwrap_or_default();
        if label != "P" {
            return Err(card.at(row, format!("load `{label}` is not read; accepted: P")));
        }
        let full = self.contents.cells.full(scope, &words[0]);
        let surface = self.contents.surfaces.get(&full);
        let surface = surface.or_else(|| self.contents.surfaces.get(&words[0]));
        let unknown = || card.at(row, format!("surface `{}` is not known", words[0]));
        let sides = surface.ok_or_else(unknown)?;
        let pressure = card.number(row, 2, "a pressure", None)?;
        Ok(sides
            .iter()
            .map(|&side| (Slot::Pressure(side), pressure))
            .collect())
    }

    /// Pressure on faces, weight, force per volume.
    fn distributed(
        &self,
        scope: usize,
        card: &Card<'_>,
        row: &Line<'_>,
    ) -> Result<Vec<Given>, Error> {
        let words: Vec<&str> = fields(row).collect();
        let cells = self.contents.cells.members(scope, (card, row), words[0])?;
        let label = words.get(1).map(|word| bare(word)).unwrap_or_default();
        let value = card.number(row, 2, "a load", None)?;
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
            "GRAV" => self.weight(card, row, &cells, value),
            _ if label.len() == 2 && label.starts_with('P') => cells
                .into_iter()
                .map(|cell| {
                    let side = self.contents.side(cell, &label, 'P', &self.outer);
                    Ok((Slot::Pressure(side.map_err(|e| card.at(row, e))?), value))
                })
                .collect(),
            _ => Err(card.at(
                row,
                format!("load `{label}` is not read; accepted: P1 to P6, GRAV, BX, BY, BZ"),
            )),
        }
    }

    fn weight(
        &self,
        card: &Card<'_>,
        row: &Line<'_>,
        cells: &[usize],
        gravity: f64,
    ) -> Result<Vec<Given>, Error> {
        let mut direction = [0.0; 3];
        for (axis, component) in direction.iter_mut().enumerate() {
            *component = card.number(row, 3 + axis, "a direction", Some(0.0))?;
        }
        let length = direction.iter().fold(0.0_f64, |sum, x| sum.hypot(*x));
        if (length - 1.0).abs() > 1e-6 {
            let reason = format!("direction of length {length}; expected one of length 1");
            return Err(card.at(row, reason));
        }
        let mut given = Vec::new();
        for &cell in cells {
            let material = self.materials.of(cell);
            let missing = || card.at(row, format!("material `{}` has no *DENSITY", material.name));
            let density = material.density.ok_or_else(missing)?;
            let axes = direction.iter().take(self.dimension()).enumerate();
            let axes = axes.filter(|(_, component)| **component != 0.0);
            given.extend(axes.map(|(axis, n)| (Slot::Weight(cell, axis), density * gravity * n)));
        }
        Ok(given)
    }
}
