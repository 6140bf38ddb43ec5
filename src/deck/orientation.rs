//! Where the axes of materials point: `*ORIENTATION`.

use std::collections::BTreeMap;

use super::statement::Statement;
use super::transform::{minus, numbers};
use crate::error::Error;
use crate::mesh_file::abaqus::{Card, Space};
use crate::scene::{SceneAxes, SceneLine};

/// The orientations of a deck, by name.
pub(super) type Orientations = BTreeMap<String, Orientation>;

/// Points a, b and c of a deck.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Orientation {
    /// Axis 1 from c to a, 2 in the plane of a, b and c.
    Rectangular([[f64; 3]; 3]),
    /// 1 radial, 2 around and 3 along the line from a to b.
    Cylindrical([[f64; 3]; 2]),
}

/// Reads them all.
pub(super) fn orientations(statement: &Statement<'_, '_>) -> Result<Orientations, Error> {
    let mut found = Orientations::new();
    let model = statement.model.iter();
    for (_, card) in model.filter(|(_, card)| card.name == "ORIENTATION") {
        let name = card.need("NAME")?.to_owned();
        if found.insert(name, Orientation::read(card)?).is_some() {
            return Err(card.error("an orientation of this name stands before"));
        }
    }
    Ok(found)
}

impl Orientation {
    fn read(card: &Card<'_>) -> Result<Self, Error> {
        card.only(&["NAME", "SYSTEM", "DEFINITION"])?;
        card.one_of("SYSTEM", &["RECTANGULAR", "CYLINDRICAL"])?;
        card.one_of("DEFINITION", &["COORDINATES"])?;
        let mut rows = card.rows(0);
        let Some(row) = rows.next() else {
            return Err(card.error("expected a line with two points"));
        };
        if let Some(more) = rows.next()
            && more.number(1, "an angle", 0.0)? != 0.0
        {
            return Err(more.error("a rotation is not read; expected the angle 0"));
        }
        let all: [f64; 9] = numbers(row)?;
        let [a, b, c] = [0, 3, 6].map(|at| [all[at], all[at + 1], all[at + 2]]);
        Ok(match card.get("SYSTEM") {
            Some("CYLINDRICAL") => Self::Cylindrical([a, b]),
            _ => Self::Rectangular([a, b, c]),
        })
    }

    /// The axes in a scene.
    pub(super) fn axes(self, space: Space) -> SceneAxes {
        match self {
            Self::Rectangular([a, b, c]) => {
                SceneAxes::Directions([minus(a, c).to_vec(), minus(b, c).to_vec()])
            }
            Self::Cylindrical([a, b]) => SceneAxes::Cylinder(match space {
                Space::Solid => SceneLine {
                    point: a.to_vec(),
                    direction: Some(minus(b, a).to_vec()),
                },
                _ => SceneLine {
                    point: a[..2].to_vec(),
                    direction: None,
                },
            }),
        }
    }
}
