//! What of a scene can vary, by name.

use crate::body::Body;
use crate::condensation::Driven;
use crate::contact::{ContactPair, Opposite, RigidBody};
use crate::error::{Error, check_finite};
use crate::scene::{driven, nearest};

/// A quantity of a scene and the values that it takes.
///
/// | name | values |
/// |---|---|
/// | `friction`, `contacts[0].friction` | coefficient, of all contacts or of one |
/// | `gap`, `contacts[0].gap` | added to the gap before loading, `gap` of the contact included, in metre |
/// | `bodies[0].loads[1]`, `bodies[0].supports[0]`, `rigid_bodies[0].force[1]` | factor |
/// | `contacts[0].x`, `.y`, `.z` | how far the obstacle has moved, in metre |
#[derive(Clone, Debug, PartialEq)]
pub struct Variation {
    /// Name of the quantity.
    pub name: String,
    /// Its values.
    pub values: Vec<f64>,
}

/// What a variation changes.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Drive {
    Friction(Vec<usize>),
    Gap(Vec<usize>),
    Factor(Driven),
    /// A pair and an axis.
    Obstacle(usize, usize),
}

impl Drive {
    pub(super) fn driven(&self) -> Option<Driven> {
        match self {
            Self::Factor(driven) => Some(*driven),
            _ => None,
        }
    }
}

/// Everything that can vary, by name.
pub(super) struct Quantities<D>(pub(super) Vec<(String, D)>);

impl Quantities<Drive> {
    pub(super) fn new(bodies: &[Body], pairs: &[ContactPair], rigid: &[RigidBody]) -> Self {
        let cut = |at: &usize| {
            let mut bolts = rigid.iter().filter(|body| body.cut.is_some());
            bolts.any(|bolt| bolt.pairs.contains(at))
        };
        let all: Vec<usize> = (0..pairs.len()).filter(|at| !cut(at)).collect();
        let mut known = vec![
            ("friction".to_owned(), Drive::Friction(all.clone())),
            ("gap".to_owned(), Drive::Gap(all)),
        ];
        let driven = driven(bodies, rigid).into_iter();
        known.extend(driven.map(|(place, driven)| (place, Drive::Factor(driven))));
        let dimension = bodies.first().map_or(3, |body| body.mesh.dimension);
        for (at, pair) in pairs.iter().enumerate().filter(|(at, _)| !cut(at)) {
            known.push((
                format!("contacts[{at}].friction"),
                Drive::Friction(vec![at]),
            ));
            known.push((format!("contacts[{at}].gap"), Drive::Gap(vec![at])));
            let carried = rigid.iter().any(|body| body.pairs.contains(&at));
            if matches!(pair.opposite, Opposite::Obstacle(_)) && !carried {
                let axes = ["x", "y", "z"].into_iter().take(dimension).enumerate();
                known.extend(axes.map(|(axis, name)| {
                    (format!("contacts[{at}].{name}"), Drive::Obstacle(at, axis))
                }));
            }
        }
        Self(known)
    }
}

impl<D: Clone> Quantities<D> {
    pub(super) fn find_all(&self, variations: &[Variation]) -> Result<Vec<D>, Error> {
        for (number, Variation { name, .. }) in variations.iter().enumerate() {
            if variations[..number].iter().any(|other| other.name == *name) {
                return Err(Error::NotAccepted {
                    place: "vary".to_owned(),
                    found: format!("`{name}` twice"),
                    accepted: "every quantity once".to_owned(),
                });
            }
        }
        let found = variations.iter().map(|variation| self.find(variation));
        found.collect()
    }

    /// All names, with what they change.
    pub(super) fn all(&self) -> impl Iterator<Item = (&str, &D)> {
        self.0.iter().map(|(name, drive)| (name.as_str(), drive))
    }

    fn nearest(&self, name: &str) -> Option<String> {
        let known = self.0.iter().map(|(name, _)| name.as_str());
        nearest(name, known).map(str::to_owned)
    }

    fn find(&self, variation: &Variation) -> Result<D, Error> {
        let name = &variation.name;
        let Some((_, drive)) = self.0.iter().find(|(known, _)| known == name) else {
            return Err(Error::UnknownName {
                place: "vary".to_owned(),
                what: "quantity",
                name: name.clone(),
                nearest: self.nearest(name),
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
        match negative.filter(|_| name.ends_with("friction")) {
            Some(value) => Err(Error::OutOfRange {
                place: name.clone(),
                value,
                accepted: "friction >= 0",
            }),
            None => Ok(drive.clone()),
        }
    }
}
