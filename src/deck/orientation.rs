//! Where the axes of materials point: `*ORIENTATION`.

use std::collections::BTreeMap;

use super::statement::{Stated, Statement};
use super::transform::{minus, numbers};
use crate::error::Error;
use crate::mesh_file::abaqus::{Card, Contents, Scope, Space};
use crate::scene::{SceneAxes, SceneLine};

/// The orientations of a deck, by full name: one of a part turns with every instance of it.
pub(super) struct Orientations(BTreeMap<String, Orientation>);

/// Points a, b and c of a deck.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Orientation {
    /// Axis 1 from c to a, 2 in the plane of a, b and c.
    Rectangular([[f64; 3]; 3]),
    /// 1 radial, 2 around and 3 along the line from a to b.
    Cylindrical([[f64; 3]; 2]),
}

impl Orientations {
    /// Reads them all.
    pub(super) fn new(statement: &Statement<'_, '_>, contents: &Contents) -> Result<Self, Error> {
        let mut found = BTreeMap::new();
        let model = statement.model.iter();
        for &(scope, card) in model.filter(|(_, card)| card.name == "ORIENTATION") {
            let name = contents.nodes.full(scope, card.need("NAME")?);
            let stated = Orientation::read(card)?.placed(contents.nodes.scope(scope));
            if found.insert(name, stated).is_some() {
                return Err(card.error("an orientation of this name stands before"));
            }
        }
        Ok(Self(found))
    }

    /// The one that a card speaks of: its part's own, or the model's.
    pub(super) fn of(
        &self,
        (scope, card): Stated<'_, '_>,
        contents: &Contents,
    ) -> Result<Option<Orientation>, Error> {
        let Some(name) = card.get("ORIENTATION") else {
            return Ok(None);
        };
        let own = self.0.get(&contents.nodes.full(scope, name));
        let found = own.or_else(|| self.0.get(name));
        let unknown = || card.error(format!("orientation `{name}` is not known"));
        found.copied().map(Some).ok_or_else(unknown)
    }
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

    /// In the model, of one that is stated in a scope.
    fn placed(self, scope: &Scope) -> Self {
        match self {
            Self::Rectangular(points) => Self::Rectangular(points.map(|point| scope.place(point))),
            Self::Cylindrical(points) => Self::Cylindrical(points.map(|point| scope.place(point))),
        }
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
