//! Materials, and the section of every element: its material, where its axes point, its thickness.

use std::collections::HashMap;

use super::elastic::{Elastic, elastic, expansion};
use super::orientation::{Orientation, Orientations};
use super::statement::Statement;
use crate::error::Error;
use crate::mesh_file::abaqus::{Card, Contents, Space};
use crate::scene::{SceneMaterial, SceneOrthotropic};

/// An elastic material.
#[derive(Clone, Debug)]
pub(super) struct Material {
    /// Name in the deck.
    pub(super) name: String,
    pub(super) elastic: Option<Elastic>,
    /// Mass per volume.
    pub(super) density: Option<f64>,
    /// Thermal expansion along each axis.
    expansion: [f64; 3],
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
    orientation: Option<Orientation>,
}

impl Section {
    /// Whether elements are the same in either.
    fn is_alike(&self, other: &Self) -> bool {
        let filled = |of: &Self| (of.material, of.orientation, of.thickness);
        filled(self) == filled(other)
    }
}

/// Materials and sections of a deck.
#[derive(Debug, Default)]
pub(super) struct Materials {
    pub(super) materials: Vec<Material>,
    pub(super) sections: Vec<Section>,
    /// Section of every element.
    pub(super) of_cell: Vec<usize>,
}

impl Materials {
    /// Reads materials, then sections, which may stand before them.
    pub(super) fn new(statement: &Statement<'_, '_>, contents: &Contents) -> Result<Self, Error> {
        let (mut read, model) = (Self::default(), &statement.model);
        for (_, card) in model {
            read.read_material(card)?;
        }
        let orientations = Orientations::new(statement, contents)?;
        const NONE: usize = usize::MAX;
        read.of_cell = vec![NONE; contents.elements.len()];
        for &(scope, card) in model.iter().filter(|(_, card)| card.name == "SOLIDSECTION") {
            let mut section = read.section(scope, card, contents)?;
            section.orientation = orientations.of((scope, card), contents)?;
            let set = card.need("ELSET")?;
            for cell in contents.cells.members(card.head(scope), set)? {
                let before = read.sections.get(read.of_cell[cell]);
                if before.is_some_and(|before| !before.is_alike(&section)) {
                    let label = contents.elements[cell].label;
                    let reason = format!("element {label} is in another section before");
                    return Err(card.error(reason));
                }
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

    /// The first section that is filled as this one.
    pub(super) fn filling(&self, section: usize) -> usize {
        let of = |at: usize| (self.sections[at].material, self.sections[at].orientation);
        (0..section)
            .find(|&before| of(before) == of(section))
            .unwrap_or(section)
    }

    /// The name of what fills a section.
    pub(super) fn name(&self, section: usize) -> String {
        let section = &self.sections[section];
        let material = &self.materials[section.material].name;
        match section.orientation {
            None => material.clone(),
            Some(_) => format!("{material} in {}", section.set),
        }
    }

    /// Whether heat strains anything.
    pub(super) fn expand(&self) -> bool {
        self.materials
            .iter()
            .any(|material| material.expansion != [0.0; 3])
    }

    /// What fills a section, in a scene.
    pub(super) fn in_scene(&self, section: usize, space: Space) -> SceneMaterial {
        let section = &self.sections[section];
        let material = &self.materials[section.material];
        let (elastic, expansion) = (material.elastic.unwrap_or_default(), material.expansion);
        let stated = match elastic {
            Elastic::Isotropic([young, poisson]) if expansion == [expansion[0]; 3] => {
                SceneMaterial::new(young, poisson).with_expansion(expansion[0])
            }
            _ => SceneMaterial::orthotropic(SceneOrthotropic {
                expansion: Some(expansion),
                axes: section
                    .orientation
                    .map(|orientation| orientation.axes(space)),
                ..elastic.constants()
            }),
        };
        stated.with_density(material.density.unwrap_or_default())
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
                    expansion: [0.0; 3],
                });
            }
            "ELASTIC" => {
                let material = last.ok_or_else(orphan)?;
                if material.elastic.replace(elastic(card)?).is_some() {
                    return Err(card.error(format!("twice in material `{}`", material.name)));
                }
            }
            "DENSITY" => {
                let row = card.row("one density")?;
                let density = row.number(0, "a density", None)?;
                last.ok_or_else(orphan)?.density = Some(density);
            }
            "EXPANSION" => last.ok_or_else(orphan)?.expansion = expansion(card)?,
            _ => {}
        }
        Ok(())
    }

    fn section(
        &self,
        scope: usize,
        card: &Card<'_>,
        contents: &Contents,
    ) -> Result<Section, Error> {
        card.only(&["ELSET", "MATERIAL", "ORIENTATION", "CONTROLS"])?;
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
            orientation: None,
        })
    }
}
