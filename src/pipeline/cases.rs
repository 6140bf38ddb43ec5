//! One scene under many values of friction, loads, supports, gaps and obstacle positions.

use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use super::quantities::{Drive, Quantities, Variation};
use super::{Acting, Setup, Solution};
use crate::alternation;
use crate::alternation::{Outcome, Status};
use crate::condensation::{Driven, Superposition};
use crate::contact::{ContactPair, RigidMotion};
use crate::error::Error;
use crate::report::{Cell, Table};
use crate::scene::Scene;

/// Most cases that start one from another, one after the other.
const CHAIN: usize = 25;

/// Solves a scene for every combination of values, all on one factorisation, and tabulates totals,
/// extremes, status and certificate; the last variation changes fastest.
///
/// ```
/// use dpana::{Scene, Variation, cases};
///
/// # fn main() -> Result<(), dpana::Error> {
/// let scene = r#"{
///     "bodies": [{ "mesh": { "rectangle": { "x": [0, 2], "y": [0, 1], "cells": [8, 4] } },
///                  "model": "plane_strain",
///                  "materials": [{ "young": 1000, "poisson": 0.3 }],
///                  "supports": [{ "group": "top", "displacement": [0.01, -0.01] }] }],
///     "contacts": [{ "group": "bottom", "friction": 0.3,
///                    "obstacle": { "plane": { "point": [0, 0], "normal": [0, 1] } } }] }"#;
/// let friction = Variation { name: "friction".to_owned(), values: vec![0.0, 0.1, 0.2] };
/// let table = cases(&Scene::from_json(scene, "")?, &[friction])?;
/// // The block slides: the more friction, the stronger it is held back.
/// let pull = table.column("friction_x").unwrap();
/// assert!(pull[0] == 0.0 && pull[0] > pull[1] && pull[1] > pull[2]);
/// # Ok(())
/// # }
/// ```
///
/// Along the last variation every case starts from the one before, if that is certified, in
/// chains of at most 25; the chains are solved side by side on the threads of the current pool:
/// the table does not depend on their number.
///
/// # Errors
///
/// Whatever is wrong with the scene, a scene with load steps, a quantity that it does not have or
/// that is given twice, a value that the quantity cannot take.
pub fn cases(scene: &Scene, variations: &[Variation]) -> Result<Table, Error> {
    cases_watched(scene, variations, |_, _| {})
}

/// The same, telling `done` after every case how many of how many are solved.
///
/// # Errors
///
/// Those of [`cases`].
pub fn cases_watched(
    scene: &Scene,
    variations: &[Variation],
    done: impl Fn(usize, usize) + Sync,
) -> Result<Table, Error> {
    let at_scene = |error| scene.locate(error);
    let stated = Stated::new(scene, variations)?;
    let cases = combinations(variations);
    let (solved, all) = (AtomicUsize::new(0), cases.len());
    let row = variations.last().map_or(1, |last| last.values.len());
    let chains = cases.chunks(row.max(1)).flat_map(|row| row.chunks(CHAIN));
    let chains: Vec<&[Vec<f64>]> = chains.collect();
    let tables: Vec<Result<Table, Error>> = chains
        .into_par_iter()
        .map(|chain| {
            stated.solve(chain, || {
                done(solved.fetch_add(1, Ordering::Relaxed) + 1, all);
            })
        })
        .collect();
    let mut table = Table::default();
    for part in tables {
        table.append(part.map_err(at_scene)?);
    }
    Ok(table)
}

/// Refuses other friction where a law has none, or several coefficients, to put it in place of.
fn check_varied(name: &str, varied: &[usize], pairs: &[ContactPair]) -> Result<(), Error> {
    let mut varied = varied.iter().filter_map(|&k| pairs.get(k));
    let fixed = varied.find(|pair| {
        let law = &pair.law;
        law.places.is_some() || law.ellipse.is_some() || law.sticks || law.tension > 0.0
    });
    match fixed {
        None => Ok(()),
        Some(pair) => Err(Error::NotAccepted {
            place: format!("{name} of {}", pair.place),
            found: format!(
                "the law `{}`",
                pair.law.words(pair.friction).unwrap_or_default()
            ),
            accepted: "a law with one coefficient that is free of others; `dpana solve` takes any law, a scene each"
                .to_owned(),
        }),
    }
}

/// All combinations of values, the last varying fastest; one without values if nothing varies.
pub(super) fn combinations(variations: &[Variation]) -> Vec<Vec<f64>> {
    let mut cases = vec![Vec::new()];
    for variation in variations {
        let longer = cases.iter().flat_map(|case: &Vec<f64>| {
            let values = variation.values.iter();
            values.map(move |&value| [case.as_slice(), &[value]].concat())
        });
        cases = longer.collect();
    }
    cases
}

/// What the scene states, before any case.
pub(super) struct Stated {
    setup: Setup,
    under: Superposition,
    names: Vec<String>,
    drives: Vec<Drive>,
    friction: Vec<f64>,
    gaps: Vec<f64>,
}

impl Stated {
    /// Factorises the bodies; each of the variations can then take any of its values.
    pub(super) fn new(scene: &Scene, variations: &[Variation]) -> Result<Self, Error> {
        let at_scene = |error| scene.locate(error);
        let mut mechanics = scene.mechanics()?;
        if !mechanics.history.instants().is_empty() {
            return Err(at_scene(Error::NotAccepted {
                place: "steps".to_owned(),
                found: "a load history".to_owned(),
                accepted: "a scene without steps, which is solved many times".to_owned(),
            }));
        }
        let quantities = Quantities::new(
            &mechanics.bodies,
            &mechanics.contacts,
            &mechanics.rigid_bodies,
        );
        let drives = quantities.find_all(variations)?;
        let friction: Vec<f64> = mechanics
            .contacts
            .iter()
            .map(|pair| pair.friction)
            .collect();
        // Contacts hold tangents where any case has friction, and along what any case moves.
        for (drive, variation) in drives.iter().zip(variations) {
            match drive {
                Drive::Friction(contacts) => {
                    check_varied(&variation.name, contacts, &mechanics.contacts)?;
                    let most = variation.values.iter().copied().fold(0.0, f64::max);
                    contacts
                        .iter()
                        .for_each(|&k| mechanics.contacts[k].friction = most);
                }
                Drive::Obstacle(contact, axis) => {
                    let mut motion = RigidMotion::default();
                    motion.translation[*axis] = 1.0;
                    mechanics.contacts[*contact].obstacle_motions.push(motion);
                }
                _ => {}
            }
        }
        let mut setup = Setup::new(scene, mechanics).map_err(at_scene)?;
        let driven = drives.iter().filter_map(Drive::driven);
        let driven: Vec<Driven> = driven.collect();
        let condensed = &mut setup.condensed;
        Ok(Self {
            under: condensed
                .superpose(&setup.bodies, &driven)
                .map_err(at_scene)?,
            names: variations.iter().map(|v| v.name.clone()).collect(),
            friction,
            gaps: condensed.problem().initial_gap().to_vec(),
            drives,
            setup,
        })
    }

    /// One case, from a neighbour where there is one.
    pub(super) fn solved(&self, values: &[f64], near: Option<&Outcome>) -> Result<Solution, Error> {
        let setup = self.put(values)?;
        let (problem, settings) = (setup.condensed.problem(), &setup.settings);
        let outcome = match near {
            Some(near) => alternation::solve_near(problem, settings, near)?,
            None => alternation::solve(problem, settings)?,
        };
        setup.recover(outcome)
    }

    /// Solves cases that differ little, each from the solution of the one before.
    fn solve(&self, chain: &[Vec<f64>], mut done: impl FnMut()) -> Result<Table, Error> {
        let mut table = Table::default();
        let mut near: Option<Outcome> = None;
        for values in chain {
            let solution = self.solved(values, near.as_ref())?;
            let report = solution.report()?;
            near = (solution.status() == Status::Certified).then_some(solution.outcome);
            let values = values.iter().map(|&value| Cell::Number(value));
            let given = self.names.iter().cloned().zip(values);
            table.push(&given.collect::<Vec<_>>(), &report);
            done();
        }
        Ok(table)
    }

    /// Whether a pair's friction is one number, which may vary.
    fn varies(&self, pair: usize) -> bool {
        let law = &self.setup.pairs[pair].law;
        law.places.is_none() && law.ellipse.is_none()
    }

    /// The bodies under the values of a case.
    fn put(&self, values: &[f64]) -> Result<Setup, Error> {
        let pairs = self.friction.len();
        let (mut friction, mut gaps) = (self.friction.clone(), vec![0.0; pairs]);
        let (mut obstacles, mut factors) = (vec![[0.0; 3]; pairs], Vec::new());
        for (drive, &value) in self.drives.iter().zip(values) {
            match drive {
                Drive::Friction(contacts) => contacts.iter().for_each(|&k| friction[k] = value),
                Drive::Gap(contacts) => contacts.iter().for_each(|&k| gaps[k] += value),
                Drive::Obstacle(contact, axis) => obstacles[*contact][*axis] = value,
                Drive::Factor(_) => factors.push(value),
            }
        }
        let mut setup = self.setup.clone();
        let contacts = &setup.condensed.surface().nodes;
        let held = setup.condensed.problem().friction().iter().zip(contacts);
        let friction = held
            .map(|(held, contact)| match self.varies(contact.pair) {
                true => friction[contact.pair],
                false => *held,
            })
            .collect();
        let parted = contacts.iter().zip(&self.gaps);
        let parted_gaps = parted
            .map(|(contact, gap)| gap + gaps[contact.pair])
            .collect();
        setup.condensed.replace(friction, parted_gaps)?;
        let slip = vec![0.0; setup.condensed.problem().unknowns()];
        let condensed = &mut setup.condensed;
        condensed.act(&self.under, &factors, &obstacles, &slip)?;
        let driven: Vec<Driven> = self.drives.iter().filter_map(Drive::driven).collect();
        setup.stress_under(&driven, &factors);
        setup.acting = Acting {
            obstacles,
            openings: self
                .setup
                .pairs
                .iter()
                .zip(gaps)
                .map(|(pair, gap)| pair.gap + gap)
                .collect(),
        };
        Ok(setup)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_variation_changes_fastest() {
        let vary = |values: &[f64]| Variation {
            name: String::new(),
            values: values.to_vec(),
        };
        let found = combinations(&[vary(&[1.0, 2.0]), vary(&[3.0, 4.0])]);
        assert_eq!(found, [[1.0, 3.0], [1.0, 4.0], [2.0, 3.0], [2.0, 4.0]]);
        assert_eq!(combinations(&[]), [[0.0; 0]; 1]);
    }
}
