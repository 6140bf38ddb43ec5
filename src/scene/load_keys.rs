//! Loads from JSON: which keys stand there tells the kind.

use serde::{Deserialize, Deserializer, de};

use super::field::{Either, SceneAffine, SceneAffineVector, SceneSpin};
use super::heat::SceneTemperature;
use super::{SceneGroup, SceneLoad};

/// The keys of a load in JSON.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a load")]
struct Keys {
    pressure: Option<Either<f64, SceneAffine>>,
    traction: Option<Either<Vec<f64>, SceneAffineVector>>,
    body_force: Option<Vec<f64>>,
    point_force: Option<Vec<f64>>,
    force: Option<Vec<f64>>,
    moment: Option<Vec<f64>>,
    gravity: Option<Vec<f64>>,
    centrifugal: Option<SceneSpin>,
    temperature: Option<SceneTemperature>,
    initial_stress: Option<Vec<f64>>,
    group: Option<SceneGroup>,
    at: Option<Vec<f64>>,
}

impl<'de> Deserialize<'de> for SceneLoad {
    fn deserialize<D: Deserializer<'de>>(source: D) -> Result<Self, D::Error> {
        let keys = Keys::deserialize(source)?;
        keys.load().ok_or_else(|| {
            de::Error::custom(
                "expected exactly one of `pressure` with `group`, `traction` with `group`, \
                 `force` and `moment` or one of them with `group`, `point_force` with `at`, and \
                 `body_force`, `gravity`, `centrifugal`, `temperature` or `initial_stress` with or \
                 without `group`",
            )
        })
    }
}

impl Keys {
    /// How many kinds of load the keys name.
    fn kinds(&self) -> usize {
        [
            self.pressure.is_some(),
            self.traction.is_some(),
            self.body_force.is_some(),
            self.point_force.is_some(),
            self.force.is_some() || self.moment.is_some(),
            self.gravity.is_some(),
            self.centrifugal.is_some(),
            self.temperature.is_some(),
            self.initial_stress.is_some(),
        ]
        .into_iter()
        .filter(|named| *named)
        .count()
    }

    /// The load; none if its keys do not belong together.
    fn load(self) -> Option<SceneLoad> {
        if self.kinds() != 1 {
            return None;
        }
        if let Some(point_force) = self.point_force {
            return match (self.group, self.at) {
                (None, Some(at)) => Some(SceneLoad::PointForce { point_force, at }),
                _ => None,
            };
        }
        if self.force.is_some() || self.moment.is_some() {
            return Some(SceneLoad::Spread {
                force: self.force,
                moment: self.moment,
                at: self.at,
                group: self.group?,
            });
        }
        if self.at.is_some() {
            return None;
        }
        let group = self.group;
        if let Some(body_force) = self.body_force {
            return Some(SceneLoad::BodyForce { body_force, group });
        }
        if let Some(gravity) = self.gravity {
            return Some(SceneLoad::Gravity { gravity, group });
        }
        if let Some(centrifugal) = self.centrifugal {
            return Some(SceneLoad::Centrifugal { centrifugal, group });
        }
        if let Some(temperature) = self.temperature {
            return Some(SceneLoad::Temperature { temperature, group });
        }
        if let Some(initial_stress) = self.initial_stress {
            return Some(SceneLoad::InitialStress {
                initial_stress,
                group,
            });
        }
        let group = group?;
        match (self.pressure, self.traction) {
            (Some(Either::Plain(pressure)), _) => Some(SceneLoad::Pressure { pressure, group }),
            (Some(Either::Object(pressure)), _) => {
                Some(SceneLoad::VaryingPressure { pressure, group })
            }
            (_, Some(Either::Plain(traction))) => Some(SceneLoad::Traction { traction, group }),
            (_, Some(Either::Object(traction))) => {
                Some(SceneLoad::VaryingTraction { traction, group })
            }
            _ => None,
        }
    }
}
