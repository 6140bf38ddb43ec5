//! Contacts: a part of a body's surface, what it may touch, and friction.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::field::{finite, is_zero};
use super::itself::two_sides;
use super::law::{SceneCompliance, SceneLaw, Side, coefficient};
use super::rigid_body::Resolved;
use super::{SceneGroup, SceneObstacle, selection, spelling};
use crate::body::{Body, Facet};
use crate::contact::{ContactPair, Opposite, PairLaw};
use crate::error::Error;

/// A part of a body's surface that may touch a rigid obstacle or another surface.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, expecting = "a contact")]
#[non_exhaustive]
pub struct SceneContact {
    /// Group of surface facets; it need only contain the true contact. Of two
    /// surfaces the one carries the contacts that has fewer facets on which the other one ends, this one if
    /// they are equal in that; but never one that is more than a hundred times as stiff.
    pub group: SceneGroup,
    /// Name of the body; may be left out while there is only one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub body: Option<String>,
    /// The rigid obstacle that the surface may touch; this, `against`, `against_itself` or `rigid_body`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub obstacle: Option<SceneObstacle>,
    /// The other surface that it may touch.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub against: Option<SceneSurface>,
    /// It may touch itself, where facets of the group face each other within this distance, apart or
    /// in each other, `> 0` in the unit of length; the two sides of a wall do not face each other.
    #[cfg_attr(feature = "cli", schemars(extend("exclusiveMinimum" = 0)))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub against_itself: Option<f64>,
    /// Name of the rigid body that it may touch.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rigid_body: Option<String>,
    /// Number of the rigid body's surface, from 0; may be left out while it has only one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub surface: Option<usize>,
    /// Coefficient of friction, `μ ≥ 0`; 0 is frictionless. This or `law`.
    #[cfg_attr(feature = "cli", schemars(range(min = 0)))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub friction: Option<f64>,
    /// Another law than friction of one coefficient; this or `friction`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub law: Option<SceneLaw>,
    /// Compliance of the surfaces themselves, in series with the bodies; none when left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub compliance: Option<SceneCompliance>,
    /// Gaps are measured between the smooth surfaces that straight facets stand for where these turn alike at three nodes on
    /// end, and behind planes of symmetry; `false`: between the facets. Left out, they are rounded.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rounded: Option<bool>,
    /// Length added to all gaps of the contact before loading: clearance if positive, interference if
    /// negative; 0 when left out. Meshes may be drawn touching.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub gap: f64,
    /// Supports may move nodes of the surface along the obstacle: these slip by that motion, and friction acts
    /// against it. Left out, such a motion is refused where there is friction, as it is mostly a mistake.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub dragged: bool,
}

/// The opposite surface of a contact between two bodies, or across a crack in one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, expecting = "a surface")]
pub struct SceneSurface {
    /// Name of the body; may be left out while there is only one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub body: Option<String>,
    /// Group of surface facets.
    pub group: SceneGroup,
}

impl SceneContact {
    /// A group of surface facets of the only body, which may touch an obstacle with this friction.
    #[must_use]
    pub fn on(obstacle: SceneObstacle, group: &str, friction: f64) -> Self {
        Self {
            group: group.into(),
            obstacle: Some(obstacle),
            friction: Some(friction),
            ..Self::default()
        }
    }

    /// Surfaces of two bodies, or of one, which may touch each other with this friction; each is
    /// `[body, group]`.
    #[must_use]
    pub fn between(own: [&str; 2], other: [&str; 2], friction: f64) -> Self {
        Self {
            group: own[1].into(),
            body: Some(own[0].to_owned()),
            against: Some(SceneSurface {
                body: Some(other[0].to_owned()),
                group: other[1].into(),
            }),
            friction: Some(friction),
            ..Self::default()
        }
    }

    /// A group of surface facets of the only body, which may touch itself with this friction where facets face each
    /// other within a distance, in metre.
    #[must_use]
    pub fn with_itself(group: &str, distance: f64, friction: f64) -> Self {
        Self {
            group: group.into(),
            against_itself: Some(distance),
            friction: Some(friction),
            ..Self::default()
        }
    }

    /// A group of surface facets of the only body, which may touch the rigid body of this name with this friction.
    #[must_use]
    pub fn on_rigid(rigid_body: &str, group: &str, friction: f64) -> Self {
        Self {
            group: group.into(),
            rigid_body: Some(rigid_body.to_owned()),
            friction: Some(friction),
            ..Self::default()
        }
    }

    /// The same for a surface of the body of this name.
    #[must_use]
    pub fn of(mut self, body: &str) -> Self {
        self.body = Some(body.to_owned());
        self
    }

    /// The same with a length added to all gaps before loading: clearance if positive, interference if
    /// negative.
    #[must_use]
    pub fn with_gap(mut self, gap: f64) -> Self {
        self.gap = gap;
        self
    }

    /// The same under a law in place of its coefficient of friction.
    #[must_use]
    pub fn with_law(mut self, law: SceneLaw) -> Self {
        (self.friction, self.law) = (None, Some(law));
        self
    }

    /// The contact in the terms of mechanics.
    pub(super) fn resolve(
        &self,
        place: &str,
        folder: &Path,
        bodies: &[Body],
        rigid: &[Resolved],
    ) -> Result<ContactPair, Error> {
        let body = find_body(&format!("{place}.body"), self.body.as_deref(), bodies)?;
        finite(format!("{place}.gap"), self.gap)?;
        let (facets, opposite) = self.sides(place, folder, (body, bodies), rigid)?;
        if let (None, Some(surface)) = (&self.rigid_body, self.surface) {
            return Err(Error::NotAccepted {
                place: format!("{place}.surface"),
                found: format!("{surface} without `rigid_body`"),
                accepted: "the number of a surface of the rigid body that `rigid_body` names"
                    .to_owned(),
            });
        }
        if self.dragged && matches!(opposite, Opposite::Surface { .. }) {
            return Err(Error::NotAccepted {
                place: format!("{place}.dragged"),
                found: "true beside `against` or `against_itself`".to_owned(),
                accepted: "a contact with `obstacle` or `rigid_body`, along which supports drag the surface"
                    .to_owned(),
            });
        }
        let (friction, law) = self.law(place, (body, &facets), &opposite, bodies)?;
        Ok(ContactPair {
            place: place.to_owned(),
            body,
            facets,
            opposite,
            friction,
            law,
            rounded: self.rounded.unwrap_or(true),
            gap: self.gap,
            dragged: self.dragged,
            obstacle_motions: Vec::new(),
        })
    }
}

impl SceneContact {
    /// The facets of the contact and what they may touch.
    fn sides(
        &self,
        place: &str,
        folder: &Path,
        (body, bodies): (usize, &[Body]),
        rigid: &[Resolved],
    ) -> Result<(Vec<Facet>, Opposite), Error> {
        let mesh = &bodies[body].mesh;
        let facets = selection::facets(mesh, &format!("{place}.group"), &self.group)?;
        let stated = (
            &self.obstacle,
            &self.against,
            &self.rigid_body,
            self.against_itself,
        );
        let opposite = match stated {
            (Some(obstacle), None, None, None) => {
                let place = format!("{place}.obstacle");
                Opposite::Obstacle(obstacle.resolve(&place, folder, mesh.dimension)?)
            }
            (None, Some(surface), None, None) => {
                surface.resolve(&format!("{place}.against"), bodies)?
            }
            (None, None, Some(name), None) => {
                let of = &rigid[self.rigid_number(place, name, rigid)?];
                Opposite::Obstacle(of.surface(place, self.surface)?)
            }
            (None, None, None, Some(distance)) => {
                let place = format!("{place}.against_itself");
                let [facets, other] = two_sides(&place, &bodies[body], facets, distance)?;
                let facing = Opposite::Surface {
                    body,
                    facets: other,
                };
                return Ok((facets, facing));
            }
            _ => return Err(self.not_one_side(place)),
        };
        Ok((facets, opposite))
    }

    /// Number of the rigid body that the contact names.
    pub(super) fn rigid_number(
        &self,
        place: &str,
        name: &str,
        rigid: &[Resolved],
    ) -> Result<usize, Error> {
        let known = || rigid.iter().map(|rigid| rigid.body.name.as_str());
        known()
            .position(|known| known == name)
            .ok_or_else(|| Error::UnknownName {
                place: format!("{place}.rigid_body"),
                what: "rigid body",
                nearest: spelling::nearest(name, known()).map(str::to_owned),
                name: name.to_owned(),
                known: known().map(str::to_owned).collect(),
            })
    }

    fn not_one_side(&self, place: &str) -> Error {
        let stated = [
            ("`obstacle`", self.obstacle.is_some()),
            ("`against`", self.against.is_some()),
            ("`rigid_body`", self.rigid_body.is_some()),
            ("`against_itself`", self.against_itself.is_some()),
        ];
        let stated: Vec<_> = stated
            .iter()
            .filter(|(_, is)| *is)
            .map(|(key, _)| *key)
            .collect();
        Error::NotAccepted {
            place: place.to_owned(),
            found: match stated.as_slice() {
                [] => "neither `obstacle` nor `against` nor `rigid_body` nor `against_itself`"
                    .to_owned(),
                several => format!("both {}", several.join(" and ")),
            },
            accepted: "one of `obstacle`, `against`, `rigid_body` and `against_itself`".to_owned(),
        }
    }

    /// Coefficient of friction, and what else the contacts obey.
    fn law(
        &self,
        place: &str,
        (body, facets): (usize, &[Facet]),
        opposite: &Opposite,
        bodies: &[Body],
    ) -> Result<(f64, PairLaw), Error> {
        let compliance = self.compliance.unwrap_or_default();
        let compliance = [compliance.normal, compliance.tangential];
        let (friction, law) = match (self.friction, &self.law) {
            (Some(friction), None) => {
                let friction = coefficient(format!("{place}.friction"), friction)?;
                (friction, PairLaw::default())
            }
            (None, Some(law)) => {
                let side = |index: usize, facets| Side {
                    index,
                    body: &bodies[index],
                    facets,
                };
                let mut sides = vec![side(body, facets)];
                if let Opposite::Surface { body, facets } = opposite {
                    sides.push(side(*body, facets));
                }
                let dimension = bodies[body].mesh.dimension;
                law.resolve(&format!("{place}.law"), &sides, dimension)?
            }
            (given, _) => {
                return Err(Error::NotAccepted {
                    place: place.to_owned(),
                    found: match given {
                        Some(_) => "both `friction` and `law`".to_owned(),
                        None => "neither `friction` nor `law`".to_owned(),
                    },
                    accepted: "one of the two".to_owned(),
                });
            }
        };
        Ok((friction, PairLaw { compliance, ..law }))
    }
}

impl SceneSurface {
    fn resolve(&self, place: &str, bodies: &[Body]) -> Result<Opposite, Error> {
        let body = find_body(&format!("{place}.body"), self.body.as_deref(), bodies)?;
        let mesh = &bodies[body].mesh;
        let facets = selection::facets(mesh, &format!("{place}.group"), &self.group)?;
        Ok(Opposite::Surface { body, facets })
    }
}

/// Index of a body by its name, which may be left out while there is only one.
fn find_body(place: &str, name: Option<&str>, bodies: &[Body]) -> Result<usize, Error> {
    let known = || bodies.iter().map(|body| body.name.as_str());
    match (name, bodies) {
        (None, [_]) => Ok(0),
        (None, _) => Err(Error::NotAccepted {
            place: place.to_owned(),
            found: "no name".to_owned(),
            accepted: format!(
                "the name of one of the bodies: {}",
                known().collect::<Vec<_>>().join(", ")
            ),
        }),
        (Some(name), _) => {
            known()
                .position(|known| known == name)
                .ok_or_else(|| Error::UnknownName {
                    place: place.to_owned(),
                    what: "body",
                    nearest: spelling::nearest(name, known()).map(str::to_owned),
                    name: name.to_owned(),
                    known: known().map(str::to_owned).collect(),
                })
        }
    }
}
