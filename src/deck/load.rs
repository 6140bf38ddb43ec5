//! What a card of loads or supports sets: a number for each node and axis, face, element, or rigid group.

use std::collections::BTreeSet;

use super::material::Materials;
use super::parts::Parts;
use super::pre_tension::Sections;
use super::rigid::RigidGroups;
use super::statement::{Notes, Stated};
use super::transform::Transforms;
use crate::error::Error;
use crate::mesh_file::abaqus::{Contents, Row, Side, bare};

/// What a number is given for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Slot {
    /// Displacement of a node along an axis: a global one, or from 3 on those of the transforms, three of each.
    Held(usize, usize),
    /// Force on a node along a global axis.
    Force(usize, usize),
    /// Force on a node along an axis of its own.
    OwnForce(usize, usize),
    /// Pressure on a face of an element.
    Pressure(Side),
    /// Pressure on a face of a surface.
    SurfacePressure(Side),
    /// Force per volume of an element along an axis.
    Weight(usize, usize),
    /// The same of gravity, always with all axes.
    Gravity(usize, usize),
    /// Square of the angular velocity of an element, about a line through two points, of which these are the bits.
    Spin(usize, [u64; 6]),
    /// Rise of the temperature of a node.
    Heat(usize),
    /// Displacement or, from 3 on, rotation of a rigid group.
    Motion(usize, usize),
    /// The same along an axis of a reference node's own.
    OwnMotion(usize, usize),
    /// Force on a rigid group or, from 3 on, moment.
    Wrench(usize, usize),
    /// The same along an axis of a reference node's own.
    OwnWrench(usize, usize),
    /// How much shorter a bolt is made.
    Shortening(usize),
    /// Force that a bolt carries.
    Preload(usize),
    /// Whether a bolt is locked.
    Lock(usize),
}

/// What one row of a card says.
pub(super) type Given = (Slot, f64);

/// What the numbers of loads and supports mean.
pub(super) struct Reader<'r> {
    pub(super) contents: &'r Contents,
    pub(super) materials: &'r Materials,
    pub(super) parts: &'r Parts,
    pub(super) rigid: &'r RigidGroups<'r, 'r>,
    pub(super) sections: &'r Sections<'r, 'r>,
    pub(super) transforms: &'r Transforms,
    /// Temperature of every node before the first step.
    pub(super) initial: Vec<f64>,
    pub(super) outer: BTreeSet<Side>,
}

/// Supports by name: which displacements and rotations are held.
const NAMED: [(&str, [bool; 6]); 8] = [
    ("ENCASTRE", [true; 6]),
    ("PINNED", [true, true, true, false, false, false]),
    ("XSYMM", [true, false, false, false, true, true]),
    ("YSYMM", [false, true, false, true, false, true]),
    ("ZSYMM", [false, false, true, true, true, false]),
    ("XASYMM", [false, true, true, true, false, false]),
    ("YASYMM", [true, false, true, false, true, false]),
    ("ZASYMM", [true, true, false, false, false, true]),
];

impl Reader<'_> {
    /// All that a card says, row by row.
    pub(super) fn read(
        &self,
        (scope, card): Stated<'_, '_>,
        notes: &mut Notes,
    ) -> Result<Vec<Given>, Error> {
        match card.name.as_str() {
            "BOUNDARY" => card.only(&["OP", "AMPLITUDE", "TIMEDELAY", "TYPE", "FIXED"])?,
            _ => card.only(&["OP", "AMPLITUDE", "TIMEDELAY"])?,
        }
        card.one_of("OP", &["NEW", "MOD"])?;
        card.one_of("TYPE", &["DISPLACEMENT"])?;
        let mut given = Vec::new();
        for row in card.rows(scope) {
            given.extend(match card.name.as_str() {
                "BOUNDARY" => self.held(row, notes)?,
                "CLOAD" => self.forces(row, notes)?,
                "DSLOAD" => self.surface_pressure(row)?,
                "TEMPERATURE" => self.heat(row, notes)?,
                _ => self.distributed(row, notes)?,
            });
        }
        Ok(given)
    }

    pub(super) fn dimension(&self) -> usize {
        if self.parts.plane() { 2 } else { 3 }
    }

    /// The nodes of a row's first word that some element has or that stand for a rigid group or a bolt.
    fn nodes(&self, row: Row<'_, '_>, notes: &mut Notes) -> Result<Vec<usize>, Error> {
        let mut nodes = self.contents.nodes.members(row, row.word(0))?;
        let all = nodes.len();
        let stands = |node| self.rigid.of(node).is_some() || self.sections.of(node).is_some();
        nodes.retain(|&node| self.parts.of_node[node].is_some() || stands(node));
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
                let axes = [1, 2, 3, 4, 5, 6].map(|dof| (first..=last).contains(&dof));
                (axes, row.number(3, "a displacement", 0.0)?)
            }
        };
        if row.card.get("FIXED").is_some() {
            let lock = |&node: &usize| Some((Slot::Lock(self.sections.of(node)?), 1.0));
            let locks: Option<Vec<Given>> = nodes.iter().map(lock).collect();
            let other = || row.error("`FIXED` is read of nodes of *PRE-TENSION SECTION only");
            return locks.filter(|_| axes[0]).ok_or_else(other);
        }
        let mut given = Vec::new();
        for node in nodes {
            if self.rigid.of(node).is_some() {
                self.check_axes(row, node)?;
            }
            let axes = (0..6).filter(|&axis| axes[axis]);
            let slots = axes.filter_map(|axis| self.support(node, axis));
            given.extend(slots.map(|slot| (slot, value)));
        }
        Ok(given)
    }

    /// What holds a node along an axis from 0, or its rotation from 3 on; none for what it does not have.
    fn support(&self, node: usize, axis: usize) -> Option<Slot> {
        if let Some(section) = self.sections.of(node) {
            return (axis == 0).then_some(Slot::Shortening(section));
        }
        if let Some((group, turns)) = self.rigid.of(node) {
            let component = self.component(turns, axis)?;
            return Some(match self.transforms.of(node) {
                None => Slot::Motion(group, component),
                Some(_) => Slot::OwnMotion(node, component),
            });
        }
        let own = self.transforms.of(node).map_or(0, |at| 3 * (1 + at));
        (axis < self.dimension()).then_some(Slot::Held(node, own + axis))
    }

    /// Component of a rigid group that a degree of freedom from 0 of a node of it is.
    fn component(&self, turns: bool, degree: usize) -> Option<usize> {
        let component = if turns { 3 + degree } else { degree };
        let lives = match self.dimension() {
            3 => component < 6,
            _ => [0, 1, 5].contains(&component),
        };
        lives.then_some(component)
    }

    fn forces(&self, row: Row<'_, '_>, notes: &mut Notes) -> Result<Vec<Given>, Error> {
        let nodes = self.nodes(row, notes)?;
        let axis = degree(row, row.word(1))? - 1;
        let force = row.number(2, "a force", None)?;
        let depth = |part: usize| self.parts.parts[part].depth();
        let mut given = Vec::new();
        for node in nodes {
            if let Some(section) = self.sections.of(node) {
                let force = force / depth(self.sections.sections[section].part);
                given.extend((axis == 0).then_some((Slot::Preload(section), force)));
                continue;
            }
            let own = self.transforms.of(node).is_some();
            self.check_axes(row, node)?;
            if let Some((group, turns)) = self.rigid.of(node) {
                let force = force / depth(self.rigid.groups[group].part);
                let slot = |at: usize| match own {
                    true => Slot::OwnWrench(node, at),
                    false => Slot::Wrench(group, at),
                };
                given.extend(self.component(turns, axis).map(|at| (slot(at), force)));
                continue;
            }
            let Some(part) = self.parts.of_node[node] else {
                continue;
            };
            if axis >= self.dimension() {
                if force == 0.0 {
                    continue;
                }
                let reason = "elements have no such degree of freedom here; a moment acts on the reference node of *RIGID \
                              BODY or *COUPLING";
                return Err(row.error(reason));
            }
            let slot = match own {
                true => Slot::OwnForce(node, axis),
                false => Slot::Force(node, axis),
            };
            given.push((slot, force / depth(part)));
        }
        Ok(given)
    }

    /// Refuses a node where axes of its own have no direction.
    fn check_axes(&self, row: Row<'_, '_>, node: usize) -> Result<(), Error> {
        let direction = self
            .transforms
            .direction(node, self.contents.positions[node], 0);
        let reason = "a node on the line that its axes turn around; expected one away from it";
        direction.map(|_| ()).ok_or_else(|| row.error(reason))
    }

    /// Rises of temperature.
    fn heat(&self, row: Row<'_, '_>, notes: &mut Notes) -> Result<Vec<Given>, Error> {
        let value = row.number(1, "a temperature", None)?;
        let nodes = self.contents.nodes.members(row, row.word(0))?;
        if !self.materials.expand() {
            notes.add(row.card, "is not needed here: nothing expands");
            return Ok(Vec::new());
        }
        let warm = nodes.iter().any(|&node| self.initial[node] != 0.0);
        if warm && row.card.get("AMPLITUDE").is_some() {
            let reason = "an amplitude of temperatures that do not begin at 0 is not read";
            return Err(row.error(reason));
        }
        let rise = |node: usize| (Slot::Heat(node), value - self.initial[node]);
        Ok(nodes.into_iter().map(rise).collect())
    }
}

/// A degree of freedom, from 1; those of rotations are no matter of solids and are passed over.
fn degree(row: Row<'_, '_>, word: &str) -> Result<usize, Error> {
    match row.label(word, "degree of freedom")? {
        dof @ 1..=6 => Ok(dof as usize),
        dof => Err(row.error(format!("degree of freedom {dof}; expected 1 to 3"))),
    }
}
