//! Values that vary with position, and lines in space.

use std::fmt;
use std::marker::PhantomData;

use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

use super::selection::{norm, vector};
use crate::body::{Affine, Line, Model};
use crate::error::{Error, check_finite, check_length};

/// A number that is an affine function of position: `value + gradient · (x − at)`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(
    deny_unknown_fields,
    expecting = "an object with value, gradient and at"
)]
pub struct SceneAffine {
    /// The value at `at`.
    pub value: f64,
    /// Change per unit of length along each axis, one entry per axis.
    pub gradient: Vec<f64>,
    /// Where it has the value, in the unit of length; the origin when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<Vec<f64>>,
}

/// A vector that is an affine function of position: `value + gradient (x − at)`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(
    deny_unknown_fields,
    expecting = "an object with value, gradient and at"
)]
pub struct SceneAffineVector {
    /// The vector at `at`, one entry per axis.
    pub value: Vec<f64>,
    /// A row per component: its change per unit of length along each axis.
    pub gradient: Vec<Vec<f64>>,
    /// Where it has the value, in the unit of length; the origin when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<Vec<f64>>,
}

/// A steady spin.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(
    deny_unknown_fields,
    expecting = "an object with speed, and in 2D and 3D a point of the axis"
)]
pub struct SceneSpin {
    /// Angular velocity, in radian per unit of time.
    pub speed: f64,
    /// A point of the axis, in the unit of length; an axisymmetric body has its own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub point: Option<Vec<f64>>,
    /// Direction of the axis in 3D, of any length but zero; in 2D it is that out of the plane.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub direction: Option<Vec<f64>>,
}

/// A small rotation of a rigid group.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(
    deny_unknown_fields,
    expecting = "an object with angle, point and in 3D direction"
)]
pub struct SceneTurn {
    /// Angle in radian; nodes move by it times their distance from the axis, as in small displacements.
    pub angle: f64,
    /// A point of the axis, in the unit of length.
    pub point: Vec<f64>,
    /// Direction of the axis in 3D, of any length but zero; in 2D it is that out of the plane.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub direction: Option<Vec<f64>>,
}

impl SceneAffine {
    /// The function in the terms of mechanics.
    pub(super) fn resolve(&self, place: &str, dimension: usize) -> Result<Affine, Error> {
        finite(format!("{place}.value"), self.value)?;
        let gradient = vector(&format!("{place}.gradient"), &self.gradient, dimension)?;
        Ok(through(
            self.value,
            gradient,
            origin(place, self.at.as_deref(), dimension)?,
        ))
    }
}

impl SceneAffineVector {
    /// The function per component.
    pub(super) fn resolve(&self, place: &str, dimension: usize) -> Result<[Affine; 3], Error> {
        let value = vector(&format!("{place}.value"), &self.value, dimension)?;
        let of_gradient = format!("{place}.gradient");
        check_length(&of_gradient, dimension, self.gradient.len())?;
        let at = origin(place, self.at.as_deref(), dimension)?;
        let mut components = [Affine::default(); 3];
        for (axis, row) in self.gradient.iter().enumerate() {
            let gradient = vector(&format!("{of_gradient}[{axis}]"), row, dimension)?;
            components[axis] = through(value[axis], gradient, at);
        }
        Ok(components)
    }
}

/// The affine function with a value at a position.
fn through(value: f64, gradient: [f64; 3], at: [f64; 3]) -> Affine {
    let along = gradient.iter().zip(at);
    Affine {
        value: along.fold(value, |sum, (slope, x)| sum - slope * x),
        gradient,
    }
}

fn origin(place: &str, at: Option<&[f64]>, dimension: usize) -> Result<[f64; 3], Error> {
    match at {
        None => Ok([0.0; 3]),
        Some(at) => vector(&format!("{place}.at"), at, dimension),
    }
}

impl SceneSpin {
    /// The axis, and the square of the angular velocity.
    pub(super) fn resolve(
        &self,
        place: &str,
        dimension: usize,
        ring: bool,
    ) -> Result<(Line, f64), Error> {
        finite(format!("{place}.speed"), self.speed)?;
        let speed_squared = self.speed * self.speed;
        finite(format!("{place}.speed"), speed_squared)?;
        if ring {
            for (field, given) in [("point", &self.point), ("direction", &self.direction)] {
                if let Some(given) = given {
                    return Err(Error::NotAccepted {
                        place: format!("{place}.{field}"),
                        found: format!("{given:?}"),
                        accepted: "nothing, for an axisymmetric body spins about its own axis"
                            .to_owned(),
                    });
                }
            }
            let axis = Line {
                point: [0.0; 3],
                direction: [0.0, 1.0, 0.0],
            };
            return Ok((axis, speed_squared));
        }
        let Some(point) = &self.point else {
            return Err(Error::NotAccepted {
                place: format!("{place}.point"),
                found: "nothing".to_owned(),
                accepted: "a point of the axis".to_owned(),
            });
        };
        let axis = line(place, point, self.direction.as_deref(), dimension)?;
        Ok((axis, speed_squared))
    }
}

impl SceneTurn {
    /// Displacement of every position, in metre.
    pub(super) fn resolve(
        &self,
        place: &str,
        dimension: usize,
        positions: impl Iterator<Item = [f64; 3]>,
    ) -> Result<Vec<[f64; 3]>, Error> {
        finite(format!("{place}.angle"), self.angle)?;
        let axis = line(place, &self.point, self.direction.as_deref(), dimension)?;
        let length = norm(axis.direction);
        let [a, b, c] = axis.direction.map(|d| self.angle * d / length);
        let moved = positions.map(|position| {
            let [x, y, z] = [0, 1, 2].map(|k| position[k] - axis.point[k]);
            [b * z - c * y, c * x - a * z, a * y - b * x]
        });
        Ok(moved.collect())
    }
}

/// A line through a point; out of the plane in 2D.
pub(super) fn line(
    place: &str,
    point: &[f64],
    direction: Option<&[f64]>,
    dimension: usize,
) -> Result<Line, Error> {
    let point = vector(&format!("{place}.point"), point, dimension)?;
    let place = format!("{place}.direction");
    let direction = match (direction, dimension) {
        (None, 2) => [0.0, 0.0, 1.0],
        (Some(given), 3) => {
            check_length(&place, 3, given.len())?;
            check_finite(&place, given)?;
            let direction = [given[0], given[1], given[2]];
            if norm(direction) == 0.0 {
                return Err(Error::NotAccepted {
                    place,
                    found: format!("{given:?}"),
                    accepted: "a direction of any length but zero".to_owned(),
                });
            }
            direction
        }
        (given, _) => {
            return Err(Error::NotAccepted {
                place,
                found: given.map_or("nothing".to_owned(), |given| format!("{given:?}")),
                accepted: match dimension {
                    2 => "nothing, for in 2D the axis is out of the plane".to_owned(),
                    _ => "the direction of the axis".to_owned(),
                },
            });
        }
    };
    Ok(Line { point, direction })
}

/// A line.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(
    deny_unknown_fields,
    expecting = "an object with point, and in 3D direction"
)]
pub struct SceneLine {
    /// A point of it, in the unit of length.
    pub point: Vec<f64>,
    /// Its direction in 3D, of any length but zero; in 2D it is that out of the plane.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub direction: Option<Vec<f64>>,
}

impl SceneLine {
    pub(super) fn resolve(&self, place: &str, model: Model) -> Result<Line, Error> {
        line(
            place,
            &self.point,
            self.direction.as_deref(),
            model.dimension(),
        )
    }
}

/// A direction of a material: in 2D its third entry may be left out.
pub(super) fn material_direction(
    place: &str,
    given: &[f64],
    model: Model,
) -> Result<[f64; 3], Error> {
    check_finite(place, given)?;
    let direction = match *given {
        [x, y, z] => [x, y, z],
        [x, y] if model.dimension() == 2 => [x, y, 0.0],
        _ => {
            return Err(Error::Length {
                place: place.to_owned(),
                expected: model.dimension(),
                found: given.len(),
            });
        }
    };
    if norm(direction) == 0.0 {
        return Err(Error::Direction {
            place: place.to_owned(),
            value: direction,
            accepted: "a direction of any length but zero",
        });
    }
    Ok(direction)
}

/// A plain value, or an object in its place; the message is that of whichever stands there.
pub(super) enum Either<A, B> {
    /// A number, or a list.
    Plain(A),
    /// An object.
    Object(B),
}

impl<'de, B: Deserialize<'de>> Deserialize<'de> for Either<f64, B> {
    fn deserialize<D: Deserializer<'de>>(source: D) -> Result<Self, D::Error> {
        struct Number<B>(PhantomData<B>);

        impl<'de, B: Deserialize<'de>> Visitor<'de> for Number<B> {
            type Value = Either<f64, B>;

            fn expecting(&self, text: &mut fmt::Formatter<'_>) -> fmt::Result {
                text.write_str("a number or an object")
            }

            fn visit_f64<E>(self, value: f64) -> Result<Self::Value, E> {
                Ok(Either::Plain(value))
            }

            // As serde reads a number that is written without a point.
            fn visit_u64<E>(self, value: u64) -> Result<Self::Value, E> {
                Ok(Either::Plain(value as f64))
            }

            fn visit_i64<E>(self, value: i64) -> Result<Self::Value, E> {
                Ok(Either::Plain(value as f64))
            }

            fn visit_map<M: MapAccess<'de>>(self, map: M) -> Result<Self::Value, M::Error> {
                B::deserialize(MapAccessDeserializer::new(map)).map(Either::Object)
            }
        }

        source.deserialize_any(Number(PhantomData))
    }
}

impl<'de, B: Deserialize<'de>> Deserialize<'de> for Either<Vec<f64>, B> {
    fn deserialize<D: Deserializer<'de>>(source: D) -> Result<Self, D::Error> {
        struct List<B>(PhantomData<B>);

        impl<'de, B: Deserialize<'de>> Visitor<'de> for List<B> {
            type Value = Either<Vec<f64>, B>;

            fn expecting(&self, text: &mut fmt::Formatter<'_>) -> fmt::Result {
                text.write_str("a list in brackets or an object")
            }

            fn visit_seq<S: SeqAccess<'de>>(self, list: S) -> Result<Self::Value, S::Error> {
                Vec::deserialize(SeqAccessDeserializer::new(list)).map(Either::Plain)
            }

            fn visit_map<M: MapAccess<'de>>(self, map: M) -> Result<Self::Value, M::Error> {
                B::deserialize(MapAccessDeserializer::new(map)).map(Either::Object)
            }
        }

        source.deserialize_any(List(PhantomData))
    }
}

/// Refuses a number that is not finite.
pub(super) fn finite(place: String, value: f64) -> Result<(), Error> {
    match value.is_finite() {
        true => Ok(()),
        false => Err(Error::NotFinite { place, value }),
    }
}

/// Whether a number can be left out.
pub(super) fn is_zero(value: &f64) -> bool {
    *value == 0.0
}
