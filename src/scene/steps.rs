//! Load steps: the instants at which a state is solved, and what changes from one to the next.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::Deserialize;

use super::spelling;
use super::table::Table;
use crate::body::{Body, Load, Support};
use crate::condensation::{ContactPair, Opposite};
use crate::error::{Error, check_finite};

/// A load history, quasi-static: one state per instant, each with the law of friction on the
/// slip since the state before. The first starts from bodies at rest, without any load.
///
/// Tables are linear between their rows and constant before the first and after the last.
/// A load or support without a table acts in full at every instant.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(
    deny_unknown_fields,
    expecting = "an object with at, and factors or obstacles"
)]
pub struct SceneSteps {
    /// Instants at which a state is solved, rising; any parameter of the history will do.
    #[schemars(length(min = 1))]
    pub at: Vec<f64>,
    /// By what a load or a support is multiplied: rows `[instant, factor]`, rising, under its
    /// place, such as `bodies[0].loads[1]` or `bodies[0].supports[0]`.
    #[serde(default)]
    pub factors: BTreeMap<String, Vec<Vec<f64>>>,
    /// How far an obstacle has moved from where the scene puts it: rows `[instant, x, y]` or
    /// `[instant, x, y, z]`, in metre, rising, under the place of its contact, such as
    /// `contacts[0]`. Round obstacles keep the normals that they have there.
    #[serde(default)]
    pub obstacles: BTreeMap<String, Vec<Vec<f64>>>,
}

/// A load history in the terms of mechanics; none where the scene has no steps.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LoadHistory {
    instants: Vec<f64>,
    loads: Vec<Driven<Load>>,
    supports: Vec<Driven<Support>>,
    obstacles: Vec<(usize, Table)>,
    contacts: usize,
}

/// A load or support as the scene states it, and its factor over the instants.
#[derive(Clone, Debug, PartialEq)]
struct Driven<T> {
    body: usize,
    index: usize,
    stated: T,
    factor: Table,
}

impl SceneSteps {
    /// The history of these bodies and contacts.
    pub(super) fn resolve(
        &self,
        bodies: &[Body],
        contacts: &[ContactPair],
    ) -> Result<LoadHistory, Error> {
        let place = "steps.at".to_owned();
        check_finite(&place, &self.at)?;
        if self.at.is_empty() {
            return Err(Error::Empty { place });
        }
        if let Some(at) = (1..self.at.len()).find(|&k| self.at[k - 1] >= self.at[k]) {
            return Err(Error::OutOfRange {
                place: format!("steps.at[{at}]"),
                value: self.at[at],
                accepted: "an instant after the one before",
            });
        }
        let mut history = LoadHistory {
            instants: self.at.clone(),
            contacts: contacts.len(),
            ..LoadHistory::default()
        };
        let known = places(bodies);
        for (name, rows) in &self.factors {
            let place = format!("steps.factors.{name}");
            let known_names = known.iter().map(|(name, ..)| name.as_str());
            let (_, body, list, index) = known
                .iter()
                .find(|(known, ..)| known == name)
                .ok_or_else(|| unknown(&place, "load or support", name, known_names))?;
            let (body, index, factor) = (*body, *index, Table::new(&place, rows, 1)?);
            match list {
                List::Loads => history.loads.push(Driven {
                    body,
                    index,
                    stated: bodies[body].loads[index].clone(),
                    factor,
                }),
                List::Supports => history.supports.push(Driven {
                    body,
                    index,
                    stated: bodies[body].supports[index].clone(),
                    factor,
                }),
            }
        }
        let dimension = bodies.first().map_or(3, |body| body.mesh.dimension);
        let obstacles = contacts.iter().enumerate();
        let obstacles: Vec<_> = obstacles
            .filter(|(_, pair)| matches!(pair.opposite, Opposite::Obstacle(_)))
            .collect();
        for (name, rows) in &self.obstacles {
            let place = format!("steps.obstacles.{name}");
            let known = obstacles.iter().map(|(_, pair)| pair.place.as_str());
            let (contact, _) = obstacles
                .iter()
                .find(|(_, pair)| pair.place == *name)
                .ok_or_else(|| unknown(&place, "contact with an obstacle", name, known))?;
            let table = Table::new(&place, rows, dimension)?;
            history.obstacles.push((*contact, table));
        }
        Ok(history)
    }
}

#[derive(Clone, Copy)]
enum List {
    Loads,
    Supports,
}

/// Every load and support by its place.
fn places(bodies: &[Body]) -> Vec<(String, usize, List, usize)> {
    let mut places = Vec::new();
    for (at, body) in bodies.iter().enumerate() {
        for (list, name, count) in [
            (List::Loads, "loads", body.loads.len()),
            (List::Supports, "supports", body.supports.len()),
        ] {
            let of_list = (0..count).map(|k| (format!("bodies[{at}].{name}[{k}]"), at, list, k));
            places.extend(of_list);
        }
    }
    places
}

fn unknown<'a>(
    place: &str,
    what: &'static str,
    name: &str,
    known: impl Iterator<Item = &'a str> + Clone,
) -> Error {
    Error::UnknownName {
        place: place.to_owned(),
        what,
        name: name.to_owned(),
        nearest: spelling::nearest(name, known.clone()).map(str::to_owned),
        known: known.map(str::to_owned).collect(),
    }
}

impl LoadHistory {
    /// Instants at which a state is solved; none where the scene has no steps.
    #[must_use]
    pub fn instants(&self) -> &[f64] {
        &self.instants
    }

    /// Puts the bodies under the loads and supports of an instant.
    pub fn apply(&self, instant: f64, bodies: &mut [Body]) {
        for load in &self.loads {
            let factor = load.factor.at(instant)[0];
            bodies[load.body].loads[load.index] = load.stated.scaled(factor);
        }
        for support in &self.supports {
            let factor = support.factor.at(instant)[0];
            bodies[support.body].supports[support.index] = support.stated.scaled(factor);
        }
    }

    /// How far the obstacle of every contact has moved at an instant, in metre.
    #[must_use]
    pub fn obstacles(&self, instant: f64) -> Vec<[f64; 3]> {
        let mut moved = vec![[0.0; 3]; self.contacts];
        for (contact, table) in &self.obstacles {
            for (axis, value) in table.at(instant).into_iter().enumerate() {
                moved[*contact][axis] = value;
            }
        }
        moved
    }

    /// Every table's value at an instant, under the place of what it drives.
    #[must_use]
    pub fn driven(&self, instant: f64) -> Vec<(String, f64)> {
        let loads = self.loads.iter().map(|load| {
            let name = format!("bodies[{}].loads[{}]", load.body, load.index);
            (name, load.factor.at(instant)[0])
        });
        let supports = self.supports.iter().map(|support| {
            let name = format!("bodies[{}].supports[{}]", support.body, support.index);
            (name, support.factor.at(instant)[0])
        });
        let obstacles = self.obstacles.iter().flat_map(|(contact, table)| {
            let axes = ["x", "y", "z"].into_iter().zip(table.at(instant));
            axes.map(move |(axis, value)| (format!("contacts[{contact}].{axis}"), value))
        });
        loads.chain(supports).chain(obstacles).collect()
    }
}
