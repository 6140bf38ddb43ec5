//! Laws of contact, as a scene states them.

use std::collections::{BTreeMap, HashSet};
use std::slice::from_ref;

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::selection;
use super::selection::{norm, vector};
use super::table::Table;
use crate::body::{Body, Facet};
use crate::contact::{PairLaw, Places, Region, facet_key};
use crate::error::Error;

/// What contacts obey, drawn in the docs of [`problem::Law`](crate::problem::Law); stresses are per area of the
/// contact surface. A law that weakens with slip is not convex, and refused.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum SceneLaw {
    /// Friction up to μ times the pressure.
    Coulomb {
        /// Coefficient, `μ ≥ 0`; with `regions` where none of them is.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[cfg_attr(feature = "cli", schemars(range(min = 0)))]
        friction: Option<f64>,
        /// Coefficients by groups of surface facets of one body of the contact.
        #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
        regions: BTreeMap<String, f64>,
        /// Coefficients over the position along a direction, in place of `friction`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        table: Option<SceneFrictionTable>,
        /// Shear stress that friction does not exceed, `> 0`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[cfg_attr(feature = "cli", schemars(extend("exclusiveMinimum" = 0)))]
        shear_cap: Option<f64>,
        /// Not accepted: a coefficient at rest above that of sliding is not convex.
        #[serde(default, skip_serializing)]
        #[cfg_attr(feature = "cli", schemars(skip))]
        static_friction: Option<NotConvex>,
    },
    /// Friction that differs along and across a direction, in 3D.
    Orthotropic {
        /// Coefficients `> 0` along the direction, and across it.
        friction: [f64; 2],
        /// Along the surface; what of it is along a contact's normal does not count.
        direction: Vec<f64>,
        /// Shear stress along the direction that friction does not exceed, `> 0`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        shear_cap: Option<f64>,
    },
    /// A given bound on the shear stress that does not depend on pressure (Tresca); it holds across a gap as well.
    Tresca {
        /// Shear stress, `> 0`.
        #[cfg_attr(feature = "cli", schemars(extend("exclusiveMinimum" = 0)))]
        shear: f64,
    },
    /// Glue: tension up to a bound, shear up to another and friction beside. A contact that parts goes on pulling.
    Cohesion {
        /// Tension, `≥ 0`.
        #[cfg_attr(feature = "cli", schemars(range(min = 0)))]
        tension: f64,
        /// Shear stress without pressure, at least friction times tension.
        #[cfg_attr(feature = "cli", schemars(range(min = 0)))]
        shear: f64,
        /// Coefficient, `μ ≥ 0`; 0 when left out.
        #[serde(default)]
        #[cfg_attr(feature = "cli", schemars(range(min = 0)))]
        friction: f64,
        /// Shear stress that is not exceeded, at least `shear`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        shear_cap: Option<f64>,
    },
    /// The sides are one, as they are drawn; shear across a distance between them has a moment that nothing bears. A `gap` pulls them together, or presses them apart.
    Bonded,
    /// The sides stay at the distance they are drawn with; friction where they are pressed.
    NoSeparation {
        /// Coefficient, `μ ≥ 0`; 0 when left out.
        #[serde(default)]
        #[cfg_attr(feature = "cli", schemars(range(min = 0)))]
        friction: f64,
    },
    /// No slip while pressed, whatever the pressure.
    Rough,
    /// Not accepted: friction that weakens with slip is not convex.
    #[serde(skip_serializing)]
    #[cfg_attr(feature = "cli", schemars(skip))]
    SlipWeakening(NotConvex),
}

/// A law whose half-steps are no convex programs: nothing states it.
#[derive(Clone, Debug, PartialEq)]
pub enum NotConvex {}

/// Coefficients of friction over a coordinate.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, expecting = "an object with direction and values")]
pub struct SceneFrictionTable {
    /// Direction of the coordinate, of any length but zero; the coordinate is a length from the origin.
    pub direction: Vec<f64>,
    /// Rows of coordinate and coefficient, rising; linear between them, constant beyond.
    pub values: Vec<Vec<f64>>,
}

/// Compliance of the surfaces themselves, such as that of asperities or a layer, in series with the bodies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(
    deny_unknown_fields,
    expecting = "an object with normal and tangential"
)]
pub struct SceneCompliance {
    /// Approach per pressure, `≥ 0`: one over a stiffness per area.
    #[serde(default)]
    #[cfg_attr(feature = "cli", schemars(range(min = 0)))]
    pub normal: f64,
    /// Displacement per shear stress, `≥ 0`.
    #[serde(default)]
    #[cfg_attr(feature = "cli", schemars(range(min = 0)))]
    pub tangential: f64,
}

impl<'de> Deserialize<'de> for NotConvex {
    fn deserialize<D: Deserializer<'de>>(_: D) -> Result<Self, D::Error> {
        Err(serde::de::Error::custom(
            "friction that falls, with slip or from rest to sliding, is not convex and not solved for; give the \
             coefficient of sliding, or bound the answer with either",
        ))
    }
}

impl Serialize for NotConvex {
    fn serialize<S: Serializer>(&self, _: S) -> Result<S::Ok, S::Error> {
        match *self {}
    }
}

impl SceneLaw {
    /// The pair's coefficient of friction and its law; `sides` are those of the contact, the first one named first.
    pub(super) fn resolve(
        &self,
        place: &str,
        sides: &[Side<'_>],
        dimension: usize,
    ) -> Result<(f64, PairLaw), Error> {
        let none = PairLaw::default();
        let capped = |cap: Option<f64>| PairLaw {
            cap: cap.unwrap_or(f64::INFINITY),
            ..PairLaw::default()
        };
        Ok(match self {
            Self::Coulomb {
                friction,
                regions,
                table,
                shear_cap,
                ..
            } => {
                let (friction, places) =
                    coefficients(place, (friction, regions, table), sides, dimension)?;
                let law = capped(*shear_cap);
                (friction, PairLaw { places, ..law })
            }
            Self::Orthotropic {
                friction: [along, across],
                direction,
                shear_cap,
            } => {
                if dimension == 2 {
                    return Err(Error::NotAccepted {
                        place: format!("{place}.orthotropic"),
                        found: "a direction in the surface of a body in 2D".to_owned(),
                        accepted: "coulomb, as there is but one direction".to_owned(),
                    });
                }
                let place = format!("{place}.orthotropic");
                for (at, mu) in [along, across].into_iter().enumerate() {
                    positive(format!("{place}.friction[{at}]"), *mu)?;
                }
                let direction = unit(&format!("{place}.direction"), direction, dimension)?;
                let ellipse = Some((across / along, direction));
                let law = capped(*shear_cap);
                (*along, PairLaw { ellipse, ..law })
            }
            Self::Tresca { shear } => {
                positive(format!("{place}.tresca.shear"), *shear)?;
                (
                    0.0,
                    PairLaw {
                        shear: *shear,
                        ..none
                    },
                )
            }
            Self::Cohesion {
                tension,
                shear,
                friction,
                shear_cap,
            } => {
                let law = PairLaw {
                    tension: *tension,
                    shear: *shear,
                    ..capped(*shear_cap)
                };
                (
                    coefficient(format!("{place}.cohesion.friction"), *friction)?,
                    law,
                )
            }
            Self::Bonded => {
                let (bilateral, sticks) = (true, true);
                (
                    0.0,
                    PairLaw {
                        bilateral,
                        sticks,
                        ..none
                    },
                )
            }
            Self::NoSeparation { friction } => {
                let friction = coefficient(format!("{place}.no_separation.friction"), *friction)?;
                (
                    friction,
                    PairLaw {
                        bilateral: true,
                        ..none
                    },
                )
            }
            Self::Rough => (
                0.0,
                PairLaw {
                    sticks: true,
                    ..none
                },
            ),
            Self::SlipWeakening(never) => match *never {},
        })
    }
}

/// A side of a contact.
pub(super) struct Side<'a> {
    /// Number of the body.
    pub(super) index: usize,
    pub(super) body: &'a Body,
    pub(super) facets: &'a [Facet],
}

type Stated<'a> = (
    &'a Option<f64>,
    &'a BTreeMap<String, f64>,
    &'a Option<SceneFrictionTable>,
);

/// The coefficient of a pair, and those by place.
fn coefficients(
    place: &str,
    (friction, regions, table): Stated<'_>,
    sides: &[Side<'_>],
    dimension: usize,
) -> Result<(f64, Option<Places>), Error> {
    let place = format!("{place}.coulomb");
    match (friction, table) {
        (Some(friction), None) => {
            let friction = coefficient(format!("{place}.friction"), *friction)?;
            if regions.is_empty() {
                return Ok((friction, None));
            }
            let regions = self::regions(&format!("{place}.regions"), regions, sides)?;
            Ok((friction, Some(Places::Regions(regions))))
        }
        (None, Some(table)) if regions.is_empty() => {
            let place = format!("{place}.table");
            let values = format!("{place}.values");
            Table::new(&values, &table.values, 1)?;
            let rows: Vec<[f64; 2]> = table.values.iter().map(|row| [row[0], row[1]]).collect();
            for (at, row) in rows.iter().enumerate() {
                coefficient(format!("{values}[{at}][1]"), row[1])?;
            }
            let direction = unit(&format!("{place}.direction"), &table.direction, dimension)?;
            let most = rows.iter().fold(0.0, |most: f64, row| most.max(row[1]));
            Ok((most, Some(Places::Along { direction, rows })))
        }
        _ => Err(Error::NotAccepted {
            place,
            found: match friction {
                Some(_) => "`table` beside `friction`".to_owned(),
                None => "no `friction`".to_owned(),
            },
            accepted: "`friction`, maybe with `regions`, or `table` alone".to_owned(),
        }),
    }
}

/// Regions on the first of the sides that has facets of all of their groups.
fn regions(
    place: &str,
    stated: &BTreeMap<String, f64>,
    sides: &[Side<'_>],
) -> Result<Vec<Region>, Error> {
    let on = |side: &Side<'_>| {
        let of_contact: HashSet<Vec<usize>> = side.facets.iter().map(facet_key).collect();
        let regions = stated.iter().map(|(group, friction)| {
            let place = format!("{place}.{group}");
            let friction = coefficient(place.clone(), *friction)?;
            let mut facets = selection::facets(&side.body.mesh, &place, from_ref(group))?;
            facets.retain(|facet| of_contact.contains(&facet_key(facet)));
            if facets.is_empty() {
                return Err(Error::NotAccepted {
                    place,
                    found: "a group without facets of the contact".to_owned(),
                    accepted: "one with facets of either of its sides".to_owned(),
                });
            }
            Ok(Region {
                body: side.index,
                facets,
                friction,
            })
        });
        regions.collect::<Result<Vec<_>, Error>>()
    };
    let mut found = sides.iter().map(on);
    let first = found.next().unwrap_or(Ok(Vec::new()));
    first.or_else(|error| found.find_map(Result::ok).ok_or(error))
}

pub(super) fn coefficient(place: String, friction: f64) -> Result<f64, Error> {
    if friction >= 0.0 && friction.is_finite() {
        return Ok(friction);
    }
    Err(Error::OutOfRange {
        place,
        value: friction,
        accepted: "0 <= friction < infinity",
    })
}

fn positive(place: String, value: f64) -> Result<(), Error> {
    if value > 0.0 && value.is_finite() {
        return Ok(());
    }
    Err(Error::OutOfRange {
        place,
        value,
        accepted: "0 < number < infinity",
    })
}

fn unit(place: &str, values: &[f64], dimension: usize) -> Result<[f64; 3], Error> {
    let direction = vector(place, values, dimension)?;
    let size = norm(direction);
    if size > 0.0 && size.is_finite() {
        return Ok(direction.map(|x| x / size));
    }
    Err(Error::NotAccepted {
        place: place.to_owned(),
        found: format!("{values:?}"),
        accepted: "a direction of any length but zero".to_owned(),
    })
}
