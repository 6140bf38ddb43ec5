//! One scene under many values of friction, loads, supports, gaps and obstacle positions.

use rayon::prelude::*;

use super::Setup;
use crate::body::{Body, Load, Support};
use crate::condensation::{ContactPair, ContactProblem, Opposite};
use crate::dpana::{self, Outcome, Settings, Status};
use crate::error::{Error, check_finite};
use crate::report::Table;
use crate::scene::Scene;

/// A quantity of a scene and the values that it takes.
///
/// | name | values |
/// |---|---|
/// | `friction`, `contacts[0].friction` | coefficient, of all contacts or of one |
/// | `gap`, `contacts[0].gap` | added to the gap before loading, in metre |
/// | `bodies[0].loads[1]`, `bodies[0].supports[0]` | factor |
/// | `contacts[0].x`, `.y`, `.z` | how far the obstacle has moved, in metre |
#[derive(Clone, Debug, PartialEq)]
pub struct Variation {
    /// Name of the quantity.
    pub name: String,
    /// Its values.
    pub values: Vec<f64>,
}

/// Solves a scene for every combination of values, all on one factorisation, and tabulates totals,
/// extremes, status and certificate; the last variation changes fastest.
///
/// Along the last variation every case starts from the one before, if that is certified; the rows
/// are solved side by side on the threads of the current pool: the table does not depend on
/// their number.
///
/// # Errors
///
/// Whatever is wrong with the scene, a scene with load steps, a quantity that it does not have, a
/// value that the quantity cannot take. Nothing is solved then.
pub fn sweep(scene: &Scene, variations: &[Variation]) -> Result<Table, Error> {
    let at_scene = |error| scene.locate(error);
    let mut mechanics = scene.mechanics()?;
    if !mechanics.history.instants().is_empty() {
        return Err(at_scene(Error::NotAccepted {
            place: "steps".to_owned(),
            found: "a load history".to_owned(),
            accepted: "a scene without steps, of which a sweep solves many".to_owned(),
        }));
    }
    let quantities = Quantities::new(&mechanics.bodies, &mechanics.contacts);
    let drives: Vec<Drive> = variations
        .iter()
        .map(|variation| quantities.find(variation))
        .collect::<Result<_, _>>()?;
    let stated: Vec<f64> = mechanics
        .contacts
        .iter()
        .map(|pair| pair.friction)
        .collect();
    // Contacts hold tangents where any case has friction.
    for (drive, variation) in drives.iter().zip(variations) {
        if let Drive::Friction(contacts) = drive {
            let most = variation.values.iter().copied().fold(0.0, f64::max);
            contacts
                .iter()
                .for_each(|&k| mechanics.contacts[k].friction = most);
        }
    }
    let mut setup = Setup::new(scene, mechanics).map_err(at_scene)?;
    let stated = Stated {
        friction: stated,
        loads: setup.bodies.iter().map(|body| body.loads.clone()).collect(),
        supports: setup
            .bodies
            .iter()
            .map(|body| body.supports.clone())
            .collect(),
        gaps: setup.condensed.problem().initial_gap().to_vec(),
    };
    let cases = combinations(variations);
    let problems: Vec<ContactProblem> = cases
        .iter()
        .map(|values| stated.put(&mut setup, &drives, values))
        .collect::<Result<_, _>>()
        .map_err(at_scene)?;
    let row = variations.last().map_or(1, |last| last.values.len());
    let outcomes: Vec<Vec<Outcome>> = problems
        .par_chunks(row.max(1))
        .map(|row| neighbours(row, &setup.settings))
        .collect::<Result<_, _>>()
        .map_err(at_scene)?;
    let mut table = Table::default();
    for (values, outcome) in cases.iter().zip(outcomes.into_iter().flatten()) {
        stated.put(&mut setup, &drives, values).map_err(at_scene)?;
        let solution = setup.recover(outcome)?;
        let names = variations.iter().map(|variation| variation.name.clone());
        let given: Vec<_> = names.zip(values.iter().copied()).collect();
        table.push(&given, &solution.report()?);
        setup = solution.setup;
    }
    Ok(table)
}

/// Solves problems that differ little, each from the solution of the one before.
fn neighbours(row: &[ContactProblem], settings: &Settings) -> Result<Vec<Outcome>, Error> {
    let mut outcomes: Vec<Outcome> = Vec::with_capacity(row.len());
    for problem in row {
        let before = outcomes.last().filter(|o| o.status == Status::Certified);
        let outcome = match before {
            Some(near) => dpana::solve_from(problem, settings, &near.reaction, &near.motion),
            None => dpana::solve(problem, settings),
        };
        outcomes.push(outcome?);
    }
    Ok(outcomes)
}

/// All combinations of values, the last varying fastest; one without values if nothing varies.
fn combinations(variations: &[Variation]) -> Vec<Vec<f64>> {
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

/// What a variation changes.
#[derive(Clone, Debug, PartialEq)]
enum Drive {
    Friction(Vec<usize>),
    Gap(Vec<usize>),
    Load(usize, usize),
    Support(usize, usize),
    Obstacle(usize, usize),
}

/// Everything that can vary, by name.
struct Quantities(Vec<(String, Drive)>);

impl Quantities {
    fn new(bodies: &[Body], pairs: &[ContactPair]) -> Self {
        let all: Vec<usize> = (0..pairs.len()).collect();
        let mut known = vec![
            ("friction".to_owned(), Drive::Friction(all.clone())),
            ("gap".to_owned(), Drive::Gap(all)),
        ];
        for (at, body) in bodies.iter().enumerate() {
            let loads = (0..body.loads.len())
                .map(|k| (format!("bodies[{at}].loads[{k}]"), Drive::Load(at, k)));
            let supports = (0..body.supports.len())
                .map(|k| (format!("bodies[{at}].supports[{k}]"), Drive::Support(at, k)));
            known.extend(loads.chain(supports));
        }
        let dimension = bodies.first().map_or(3, |body| body.mesh.dimension);
        for (at, pair) in pairs.iter().enumerate() {
            known.push((
                format!("contacts[{at}].friction"),
                Drive::Friction(vec![at]),
            ));
            known.push((format!("contacts[{at}].gap"), Drive::Gap(vec![at])));
            if matches!(pair.opposite, Opposite::Obstacle(_)) {
                let axes = ["x", "y", "z"].into_iter().take(dimension).enumerate();
                known.extend(axes.map(|(axis, name)| {
                    (format!("contacts[{at}].{name}"), Drive::Obstacle(at, axis))
                }));
            }
        }
        Self(known)
    }

    fn find(&self, variation: &Variation) -> Result<Drive, Error> {
        let name = &variation.name;
        let Some((_, drive)) = self.0.iter().find(|(known, _)| known == name) else {
            return Err(Error::UnknownName {
                place: "vary".to_owned(),
                what: "quantity",
                name: name.clone(),
                nearest: None,
                known: self.0.iter().map(|(name, _)| name.clone()).collect(),
            });
        };
        if variation.values.is_empty() {
            return Err(Error::Empty {
                place: name.clone(),
            });
        }
        check_finite(name, &variation.values)?;
        let negative = variation.values.iter().copied().find(|value| *value < 0.0);
        match (drive, negative) {
            (Drive::Friction(_), Some(value)) => Err(Error::OutOfRange {
                place: name.clone(),
                value,
                accepted: "friction >= 0",
            }),
            _ => Ok(drive.clone()),
        }
    }
}

/// What the scene states, before any case.
struct Stated {
    friction: Vec<f64>,
    loads: Vec<Vec<Load>>,
    supports: Vec<Vec<Support>>,
    gaps: Vec<f64>,
}

impl Stated {
    /// Puts the bodies under the values of a case and returns its contact problem.
    fn put(
        &self,
        setup: &mut Setup,
        drives: &[Drive],
        values: &[f64],
    ) -> Result<ContactProblem, Error> {
        let pairs = self.friction.len();
        let (mut friction, mut gaps) = (self.friction.clone(), vec![0.0; pairs]);
        let mut obstacles = vec![[0.0; 3]; pairs];
        for (drive, &value) in drives.iter().zip(values) {
            match drive {
                Drive::Friction(contacts) => contacts.iter().for_each(|&k| friction[k] = value),
                Drive::Gap(contacts) => contacts.iter().for_each(|&k| gaps[k] += value),
                Drive::Obstacle(contact, axis) => obstacles[*contact][*axis] = value,
                Drive::Load(body, k) => {
                    setup.bodies[*body].loads[*k] = self.loads[*body][*k].scaled(value);
                }
                Drive::Support(body, k) => {
                    setup.bodies[*body].supports[*k] = self.supports[*body][*k].scaled(value);
                }
            }
        }
        let contacts = &setup.condensed.surface().nodes;
        let friction = contacts
            .iter()
            .map(|contact| friction[contact.pair])
            .collect();
        let parted = contacts.iter().zip(&self.gaps);
        let gaps = parted
            .map(|(contact, gap)| gap + gaps[contact.pair])
            .collect();
        setup.condensed.replace(friction, gaps)?;
        let slip = vec![0.0; setup.condensed.problem().unknowns()];
        setup.condensed.act(&setup.bodies, &obstacles, &slip)?;
        Ok(setup.condensed.problem().clone())
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
