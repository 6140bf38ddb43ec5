//! Bolts under preload: `*PRE-TENSION SECTION` across the solid elements of a shank.
//!
//! The first degree of freedom of its reference node is the shortening of the bolt, a force there is what the bolt
//! carries, and `*BOUNDARY, FIXED` locks it. Both are along a vector that is stated, or along the normal out of
//! the elements whose faces are named; along that normal a positive one pulls.

use std::collections::BTreeSet;

use super::acting::largest;
use super::assemble::{Building, Stock, Tables};
use super::load::Slot;
use super::pre_tension::Section;
use super::transform::dot;
use crate::body::{Facet, Group};
use crate::error::Error;
use crate::mesh_file::abaqus::Contents;
use crate::scene::SceneBolt;

impl Stock<'_, '_> {
    /// Bolts.
    pub(super) fn add_bolts(
        &self,
        bodies: &mut [Building],
        factors: &mut Tables,
    ) -> Result<(), Error> {
        for (number, section) in self.sections.sections.iter().enumerate() {
            let building = &mut bodies[section.part];
            let at = building.body.bolts.len();
            let (mut bolt, sign) = building.bolt(&self.contents, number, section)?;
            let values = |slot: fn(usize) -> Slot| self.history.values.get(&slot(number)).cloned();
            let place = format!("bodies[{}].bolts[{at}]", section.part);
            let mut tabulate = |key: &str, values: &[f64]| {
                let stated = largest(values);
                if stated != 0.0 {
                    self.tabulate(format!("{place}.{key}"), (values, stated), factors);
                }
                Some(sign * stated)
            };
            if let Some(shortening) = values(Slot::Shortening) {
                bolt.shortening = tabulate("shortening", &shortening);
            } else {
                let none = || vec![0.0; self.history.instants.len()];
                let mut force = values(Slot::Preload).unwrap_or_else(none);
                let locked = values(Slot::Lock);
                let locked = locked.and_then(|there| there.iter().position(|lock| *lock > 0.0));
                if let Some(first) = locked {
                    let before = first.checked_sub(1).ok_or_else(|| {
                        section.card.error(
                            "`FIXED` in the first step; expected it after a step with a force",
                        )
                    })?;
                    let last = force[before];
                    force[first..].fill(last);
                    bolt.locked_from = Some(self.history.instants[before]);
                }
                bolt.force = tabulate("force", &force);
            }
            building.body.bolts.push(bolt);
        }
        Ok(())
    }
}

impl Building {
    /// A bolt that is cut along a section, and the sign of what is stated of it.
    fn bolt(
        &mut self,
        contents: &Contents,
        number: usize,
        section: &Section<'_, '_>,
    ) -> Result<(SceneBolt, f64), Error> {
        let dimension = self.mesh.dimension;
        let sides = section.sides.iter();
        let facets: Vec<Facet> = sides.map(|&side| self.facet(contents, side)).collect();
        let [point, along] = self.mesh.plane_of(&facets);
        let size = dot(along, along).sqrt();
        let axis = along.map(|n| n / size);
        let nodes: BTreeSet<usize> = facets.into_iter().flat_map(|facet| facet.nodes).collect();
        let around = |&cell: &usize| self.mesh.cell(cell).nodes.iter().any(|n| nodes.contains(n));
        let cells: Vec<usize> = (0..self.mesh.cell_count()).filter(around).collect();
        let (name, group) = (format!("bolt {number}"), format!("cells of bolt {number}"));
        // What the scene will do, here where the deck's line is known.
        let mut parted = self.mesh.clone();
        let cut = parted.cut(&name, &name, &cells, [point, axis]);
        cut.map_err(|error| section.card.error(format!("is not read: {error}")))?;
        let faces = match &parted.groups[&format!("{name}.own")] {
            Group::Facets(facets) => facets.len(),
            _ => 0,
        };
        if faces != section.sides.len() {
            return Err(section.card.error(format!(
                "a surface of {} faces where the plane through them parts {faces}; expected all faces of the section",
                section.sides.len()
            )));
        }
        self.mesh.groups.insert(group.clone(), Group::Cells(cells));
        let sign = section.sign(axis)?;
        let [point, axis] = [point, axis].map(|x| x[..dimension].to_vec());
        let bolt = SceneBolt {
            force: None,
            ..SceneBolt::preloaded(&name, &group, &point, &axis, 0.0)
        };
        Ok((bolt, sign))
    }
}
