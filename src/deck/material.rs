//! Materials, and the section of every element: its material and its thickness.

use std::collections::HashMap;

use super::statement::{Notes, Statement};
use crate::error::Error;
use crate::mesh_file::abaqus::{Card, Contents};

/// An elastic material.
#[derive(Clone, Debug)]
pub(super) struct Material {
    /// Name in the deck.
    pub(super) name: String,
    /// Young's modulus and Poisson's ratio.
    pub(super) elastic: Option<[f64; 2]>,
    /// Mass per volume.
    pub(super) density: Option<f64>,
}

/// What fills a set of elements.
#[derive(Clone, Debug)]
pub(super) struct Section {
    /// The set, by its full name.
    pub(super) set: String,
    /// Where it is stated, for messages.
    pub(super) place: String,
    /// Index of the material.
    pub(super) material: usize,
    /// Thickness of plane elements.
    pub(super) thickness: f64,
}

/// Materials and sections of a deck.
#[derive(Debug, Default)]
pub(super) struct Materials {
    pub(super) materials: Vec<Material>,
    pub(super) sections: Vec<Section>,
    /// Section of every element.
    pub(super) of_cell: Vec<usize>,
    /// Where thermal expansion is stated.
    pub(super) expansion: bool,
}

impl Materials {
    /// Reads materials, then sections, which may stand before them.
    pub(super) fn new(
        statement: &Statement<'_, '_>,
        contents: &Contents,
        notes: &mut Notes,
    ) -> Result<Self, Error> {
        let (mut read, model) = (Self::default(), &statement.model);
        for (_, card) in model {
            read.read_material(card)?;
        }
        const NONE: usize = usize::MAX;
        read.of_cell = vec![NONE; contents.elements.len()];
        for &(scope, card) in model.iter().filter(|(_, card)| card.name == "SOLIDSECTION") {
            let section = read.section(scope, card, contents, notes)?;
            let set = card.need("ELSET")?;
            for cell in contents.cells.members(card.head(scope), set)? {
                read.of_cell[cell] = read.sections.len();
            }
            read.sections.push(section);
        }
        match read.of_cell.iter().position(|&section| section == NONE) {
            None => Ok(read),
            Some(cell) => {
                let label = contents.elements[cell].label;
                Err(statement.missing(format!("*SOLID SECTION that has element {label}")))
            }
        }
    }

    /// The material of an element.
    pub(super) fn of(&self, cell: usize) -> &Material {
        &self.materials[self.sections[self.of_cell[cell]].material]
    }

    fn read_material(&mut self, card: &Card<'_>) -> Result<(), Error> {
        let last = self.materials.last_mut();
        let orphan = || card.error("expected *MATERIAL before");
        match card.name.as_str() {
            "MATERIAL" => {
                card.only(&["NAME"])?;
                let name = card.need("NAME")?.to_owned();
                if self.materials.iter().any(|known| known.name == name) {
                    return Err(card.error(format!("material `{name}` once more")));
                }
                self.materials.push(Material {
                    name,
                    elastic: None,
                    density: None,
                });
            }
            "ELASTIC" => {
                card.only(&["TYPE"])?;
                card.one_of("TYPE", &["ISO", "ISOTROPIC"])?;
                last.ok_or_else(orphan)?.elastic = Some(elastic(card)?);
            }
            "DENSITY" => {
                let row = card.row("one density")?;
                let density = row.number(0, "a density", None)?;
                last.ok_or_else(orphan)?.density = Some(density);
            }
            "EXPANSION" => self.expansion = true,
            _ => {}
        }
        Ok(())
    }

    fn section(
        &self,
        scope: usize,
        card: &Card<'_>,
        contents: &Contents,
        notes: &mut Notes,
    ) -> Result<Section, Error> {
        card.only(&["ELSET", "MATERIAL", "ORIENTATION", "CONTROLS"])?;
        if card.get("ORIENTATION").is_some() {
            notes.add(
                card,
                "`ORIENTATION` is not needed here: materials are isotropic",
            );
        }
        let (set, material) = (card.need("ELSET")?, card.need("MATERIAL")?);
        let known: HashMap<&str, usize> = (self.materials.iter().enumerate())
            .map(|(at, material)| (material.name.as_str(), at))
            .collect();
        let unknown = || card.error(format!("material `{material}` is not known"));
        let found = *known.get(material).ok_or_else(unknown)?;
        if self.materials[found].elastic.is_none() {
            return Err(card.error(format!("material `{material}` has no *ELASTIC")));
        }
        let thickness = match card.rows(scope).next() {
            None => 1.0,
            Some(_) => card.row("the thickness")?.number(0, "a thickness", 1.0)?,
        };
        if thickness <= 0.0 {
            return Err(card.error(format!("thickness {thickness}; expected one above 0")));
        }
        Ok(Section {
            set: contents.cells.full(scope, set),
            place: card.place(),
            material: found,
            thickness,
        })
    }
}

fn elastic(card: &Card<'_>) -> Result<[f64; 2], Error> {
    let row = card.row("Young's modulus and Poisson's ratio, the same at every temperature")?;
    let young = row.number(0, "Young's modulus", None)?;
    let poisson = row.number(1, "Poisson's ratio", None)?;
    if young <= 0.0 || poisson <= -1.0 || poisson >= 0.5 {
        return Err(row.error(format!(
            "moduli {young}, {poisson}; expected E > 0 and -1 < ν < 0.5"
        )));
    }
    Ok([young, poisson])
}
