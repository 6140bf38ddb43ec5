//! Load steps: the instants at which a state is solved, and what changes from one to the next.
//!
//! `at` are the instants, rising, from bodies at rest without any load. `factors` multiply a load or
//! support over the instants, `obstacles` move an obstacle from where the scene puts it, `gaps` add a length to
//! all gaps of a contact. Tables are linear between rows and constant outside; what has no table acts in full throughout. A support may be split in
//! two, one per component, so that each has its table. In every step Coulomb's law sees the slip since the
//! state before; a contact that was open takes up its slip from where it was last seen open. Where surfaces
//! are inclined and bodies approach, several steps of approach tell better than one where each contact
//! closed. All steps share one factorisation per body, and one pair of substitutions per driven load or
//! support: free displacements are sums of these. A history ends with the first state that is not certified.
//!
//! The ledger of a step says where the work of loads, supports and obstacles went: elastic energy, friction,
//! and a rest (`closure`) that the two ends of the step do not explain. It is zero where loads grow in
//! proportion and no contact changes its state, and otherwise shrinks with the square of the steps.
//! `resolve` solves every step in two halves as well, and these in halves, until the ledger leaves at most
//! that part of the work unexplained and halving changes the dissipated energy by at most that part of the
//! work, and the state of contacts on at most that part of the area of contact; 128 parts at most, then a
//! note says what is left. Reports and tables show the stated instants only; `step.halving` says in how many
//! parts a step was solved and what halving these changed. The first step is not halved: nothing is stated
//! of the way to it. What this does to a cycle of shear is measured in `tests/README.md`.
//!
//! A run that is interrupted loses the step in progress: with `--table`, `--plot`, `--vtu` and `--state`
//! every file is whole after each step, the state last. `--restart STATE` goes on from there, bit for bit,
//! and so do the table, the plot and the series that it finds. The state knows the bodies, the contacts and
//! what acted at every instant so far, and refuses another scene; instants and rows that come later may change.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::spelling;
use super::table::Table;
use crate::body::{Body, Load, Source, Tie};
use crate::condensation::Driven;
use crate::contact::{ContactPair, Opposite, RigidBody, RigidMotion};
use crate::error::{Error, check_finite};

/// A load history, quasi-static: one state per instant, each with the law of friction on the
/// slip since the state before. The first starts from bodies at rest, without any load.
///
/// Tables are linear between their rows and constant before the first and after the last.
/// A load or support without a table acts in full at every instant.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(
    deny_unknown_fields,
    expecting = "an object with at, and factors, obstacles or gaps"
)]
pub struct SceneSteps {
    /// Instants at which a state is solved, rising; any parameter of the history will do.
    #[cfg_attr(feature = "cli", schemars(length(min = 1)))]
    pub at: Vec<f64>,
    /// By what a load, a support, or a component of a rigid body is multiplied: rows `[instant, factor]`, rising,
    /// under its place, such as `bodies[0].loads[1]`, `bodies[0].supports[0]` or `rigid_bodies[0].force[1]`; of a
    /// rigid group its given motion, `bodies[0].rigid_groups[0].motion`, and force and moment,
    /// `bodies[0].rigid_groups[0].load`; of a bolt what is given, `bodies[0].bolts[0].force` or `.shortening`.
    #[serde(default)]
    pub factors: BTreeMap<String, Vec<Vec<f64>>>,
    /// How far an obstacle has moved from where the scene puts it: rows `[instant, x, y]` or
    /// `[instant, x, y, z]`, in the unit of length, rising, under the place of its contact, such as
    /// `contacts[0]`. Normals stay those of the obstacle where the scene puts it: gaps follow a
    /// motion `d` along them, as they follow all displacements, which leaves out `d² / 2R` of a
    /// motion across the normals of an obstacle of radius R.
    #[serde(default)]
    pub obstacles: BTreeMap<String, Vec<Vec<f64>>>,
    /// Length added to all gaps of a contact, in place of its `gap`: rows `[instant, gap]`, rising, under the
    /// place of the contact, such as `contacts[0]`. Clearance if positive, interference if negative.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub gaps: BTreeMap<String, Vec<Vec<f64>>>,
    /// Left out, every step is solved once. Given, also in halves, and in halves of these, until
    /// the ledger leaves at most this part of the work unexplained, and halving changes the
    /// dissipated energy by at most this part of the work, and the state of contacts on at most this
    /// part of the area of contact; or until there are 128 parts, with a note. The first step is
    /// not halved: nothing is stated of the way to it.
    #[cfg_attr(feature = "cli", schemars(range(min = 1e-12, max = 1)))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub resolve: Option<f64>,
}

/// A load history in the terms of mechanics; none where the scene has no steps.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LoadHistory {
    instants: Vec<f64>,
    factors: Vec<(String, Driven, Table)>,
    obstacles: Vec<(usize, Table)>,
    gaps: Vec<(usize, Table)>,
    /// Stated gap per contact, in metre.
    stated: Vec<f64>,
    contacts: usize,
    resolution: Option<f64>,
}

impl SceneSteps {
    /// The history of these bodies and contacts.
    pub(super) fn resolve(
        &self,
        bodies: &[Body],
        contacts: &[ContactPair],
        rigid: &[RigidBody],
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
        if let Some(value) = self.resolve.filter(|part| !(1e-12..=1.0).contains(part)) {
            return Err(Error::OutOfRange {
                place: "steps.resolve".to_owned(),
                value,
                accepted: "1e-12 <= resolve <= 1",
            });
        }
        let mut history = LoadHistory {
            instants: self.at.clone(),
            contacts: contacts.len(),
            stated: contacts.iter().map(|pair| pair.gap).collect(),
            resolution: self.resolve,
            ..LoadHistory::default()
        };
        let known = driven(bodies, rigid);
        for (name, rows) in &self.factors {
            let place = format!("steps.factors.{name}");
            let known_names = known.iter().map(|(name, _)| name.as_str());
            let (_, driven) = known
                .iter()
                .find(|(known, _)| known == name)
                .ok_or_else(|| unknown(&place, "load or support", name, known_names))?;
            let factor = Table::new(&place, rows, 1)?;
            history.factors.push((name.clone(), *driven, factor));
        }
        let dimension = bodies.first().map_or(3, |body| body.mesh.dimension);
        let obstacles = contacts.iter().enumerate();
        let obstacles: Vec<_> = obstacles
            .filter(|(_, pair)| matches!(pair.opposite, Opposite::Obstacle(_)))
            .filter(|(at, _)| !rigid.iter().any(|body| body.pairs.contains(at)))
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
        for (name, rows) in &self.gaps {
            history.gaps.push(gap_table(name, rows, contacts)?);
        }
        Ok(history)
    }
}

/// The table of a contact's gap, and the number of the contact.
fn gap_table(
    name: &str,
    rows: &[Vec<f64>],
    contacts: &[ContactPair],
) -> Result<(usize, Table), Error> {
    let place = format!("steps.gaps.{name}");
    let known = contacts.iter().map(|pair| pair.place.as_str());
    let contact = (known.clone().position(|known| known == name))
        .ok_or_else(|| unknown(&place, "contact", name, known))?;
    let stated = contacts[contact].gap;
    if stated != 0.0 {
        return Err(Error::NotAccepted {
            place,
            found: format!("a table beside `gap`: {stated} of {name}"),
            accepted: "one of the two: the table stands in place of the number".to_owned(),
        });
    }
    Ok((contact, Table::new(&place, rows, 1)?))
}

/// Every load and support of bodies and component of rigid ones, by its place in the scene, such as
/// `bodies[0].loads[1]`.
#[must_use]
pub(crate) fn driven(bodies: &[Body], rigid: &[RigidBody]) -> Vec<(String, Driven)> {
    let mut places = Vec::new();
    for (body, of) in bodies.iter().enumerate() {
        places.extend(of.loads.iter().enumerate().map(|(index, load)| {
            let place = match load {
                Load::AtReference { place, .. } => format!("{place}.load"),
                _ => format!("bodies[{body}].loads[{index}]"),
            };
            (place, Driven::Load { body, index })
        }));
        let supports = 0..of.supports.len();
        places.extend(supports.map(|index| {
            let place = format!("bodies[{body}].supports[{index}]");
            (place, Driven::Support { body, index })
        }));
        places.extend(
            of.ties
                .iter()
                .enumerate()
                .filter_map(|(index, tie)| match tie {
                    Tie::Rigid(group) => {
                        let place = format!("{}.motion", group.place);
                        Some((place, Driven::Motion { body, index }))
                    }
                    Tie::Pairs(_) => None,
                }),
        );
    }
    let dimension = bodies.first().map_or(3, |body| body.mesh.dimension);
    for (body, of) in rigid.iter().enumerate() {
        places.extend(of.movable(dimension).map(|component| {
            (
                of.component_place(component, dimension),
                Driven::Rigid { body, component },
            )
        }));
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

    /// The loads, supports and components that have a table.
    #[must_use]
    pub fn driven(&self) -> Vec<Driven> {
        self.factors.iter().map(|(_, driven, _)| *driven).collect()
    }

    /// Their factors at an instant.
    #[must_use]
    pub fn factors(&self, instant: f64) -> Vec<f64> {
        let tables = self.factors.iter();
        tables.map(|(.., table)| table.at(instant)[0]).collect()
    }

    /// The factor of what a body's equation comes from, at an instant.
    pub(crate) fn factor(&self, body: usize, by: Source, instant: f64) -> f64 {
        let driven = match by {
            Source::Axis => return 1.0,
            Source::Support(index) => Driven::Support { body, index },
            Source::Tie(index) => Driven::Motion { body, index },
        };
        self.factor_of(driven, instant)
    }

    /// The factor of a load, support or component at an instant.
    pub(crate) fn factor_of(&self, driven: Driven, instant: f64) -> f64 {
        let found = self.factors.iter().find(|(_, other, _)| *other == driven);
        found.map_or(1.0, |(.., table)| table.at(instant)[0])
    }

    /// By how much halving a step may change it; none where steps are not halved.
    #[must_use]
    pub fn resolution(&self) -> Option<f64> {
        self.resolution
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

    /// Motions that the obstacle of a contact makes, besides those of a rigid body.
    pub(super) fn obstacle_motions(&self, contact: usize) -> impl Iterator<Item = RigidMotion> {
        let tables = self.obstacles.iter().filter(move |(of, _)| *of == contact);
        let instants = self.instants.iter();
        let moved = tables.flat_map(move |(_, table)| instants.clone().map(|at| table.at(*at)));
        moved.map(|moved| RigidMotion {
            translation: [0, 1, 2].map(|axis| moved.get(axis).copied().unwrap_or(0.0)),
            ..RigidMotion::default()
        })
    }

    /// Length added to all gaps of every contact at an instant, in metre; none where no gap changes.
    #[must_use]
    pub fn openings(&self, instant: f64) -> Option<Vec<f64>> {
        if self.gaps.is_empty() {
            return None;
        }
        let mut openings = self.stated.clone();
        for (contact, table) in &self.gaps {
            openings[*contact] = table.at(instant)[0];
        }
        Some(openings)
    }

    /// Every table's value at an instant, under the place of what it drives.
    #[must_use]
    pub fn values(&self, instant: f64) -> Vec<(String, f64)> {
        let factors = self.factors.iter();
        let factors = factors.map(|(name, _, table)| (name.clone(), table.at(instant)[0]));
        let obstacles = self.obstacles.iter().flat_map(|(contact, table)| {
            let axes = ["x", "y", "z"].into_iter().zip(table.at(instant));
            axes.map(move |(axis, value)| (format!("contacts[{contact}].{axis}"), value))
        });
        let gaps = self.gaps.iter();
        let gaps =
            gaps.map(|(contact, table)| (format!("contacts[{contact}].gap"), table.at(instant)[0]));
        factors.chain(obstacles).chain(gaps).collect()
    }
}
