//! General contact: every two bodies whose skins face each other may touch there.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::SceneContact;
use crate::body::{Body, Group};
use crate::contact::{ContactPair, facing_skins};
use crate::error::Error;

/// Contact between all bodies that no other contact brings together, where their skins face each other.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(
    deny_unknown_fields,
    expecting = "an object with distance and friction"
)]
pub struct SceneGeneralContact {
    /// Largest distance, apart or in each other, at which skins may touch, in the unit of length, `> 0`.
    #[cfg_attr(feature = "cli", schemars(extend("exclusiveMinimum" = 0)))]
    pub distance: f64,
    /// Coefficient of friction, `≥ 0`.
    #[cfg_attr(feature = "cli", schemars(range(min = 0)))]
    pub friction: f64,
}

impl SceneGeneralContact {
    /// A pair for every face on which two bodies face each other that none of the `stated` pairs has; the facets of each
    /// become a group `facing NAME` of its mesh, or `facing NAME (2)` and on.
    pub(super) fn pairs(
        &self,
        bodies: &mut [Body],
        stated: &[ContactPair],
    ) -> Result<Vec<ContactPair>, Error> {
        const PLACE: &str = "general_contact";
        if !(self.distance > 0.0 && self.distance.is_finite()) {
            return Err(Error::OutOfRange {
                place: format!("{PLACE}.distance"),
                value: self.distance,
                accepted: "0 < distance < infinity",
            });
        }
        let mut pairs = Vec::new();
        for second in 0..bodies.len() {
            for first in 0..second {
                if stated.iter().any(|pair| pair.joins([first, second])) {
                    continue;
                }
                let names = [first, second].map(|at| bodies[at].name.clone());
                let faces = facing_skins([&bodies[first], &bodies[second]], self.distance);
                for (number, facets) in faces.into_iter().enumerate() {
                    // Of bodies that meet on several faces, all but the first have a number.
                    let mark = |name: String| match number {
                        0 => name,
                        _ => format!("{name} ({})", number + 1),
                    };
                    let groups =
                        [1, 0].map(|other: usize| mark(format!("facing {}", names[other])));
                    let sides = [first, second].into_iter().zip(&groups).zip(facets);
                    for ((at, group), facets) in sides {
                        let mesh = &mut bodies[at].mesh;
                        mesh.groups.insert(group.clone(), Group::Facets(facets));
                    }
                    let contact = SceneContact::between(
                        [&names[0], &groups[0]],
                        [&names[1], &groups[1]],
                        self.friction,
                    );
                    let place = mark(format!("{PLACE}: {}, {}", names[0], names[1]));
                    pairs.push(contact.resolve(&place, Path::new(""), bodies, &[])?);
                }
            }
        }
        match pairs.is_empty() {
            false => Ok(pairs),
            true => Err(Error::NotAccepted {
                place: format!("{PLACE}.distance"),
                found: self.distance.to_string(),
                accepted: "a distance within which the skins of two bodies face each other, which are in no other contact"
                    .to_owned(),
            }),
        }
    }
}
