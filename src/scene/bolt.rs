//! Bolts: a shank is cut, and what is between the faces of the cut carries a given force or shortens the bolt.

use std::collections::HashMap;

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::SceneGroup;
use super::field::finite;
use super::selection::{self, AT_NODE};
use super::steps::LoadHistory;
use crate::body::{Mesh, Model};
use crate::condensation::Driven;
use crate::contact::{Component, ContactPair, Cut, Opposite, PairLaw, RigidBody};
use crate::error::Error;

/// A bolt under preload. Its shank is cut across its axis, and the two faces are tied to each other but for a
/// shortening along the axis: this is given, or found from the force that the bolt carries.
///
/// The cut is made along a plane that facets of the mesh lie in (`group`, `point`, `axis`), or is there already
/// (`faces`). A table of `steps` under its place and `.force` or `.shortening` multiplies what is given.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(
    deny_unknown_fields,
    expecting = "an object with name, force or shortening, and group, point and axis, or faces"
)]
pub struct SceneBolt {
    /// Name of its own, by which reports name it; the facets of its cut become the groups `NAME.own`, ahead along
    /// the axis, and `NAME.other`.
    pub name: String,
    /// Group of cells that the plane cuts through: all cells around the cut.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub group: Option<SceneGroup>,
    /// A point of the plane, in the unit of length.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub point: Option<Vec<f64>>,
    /// Direction of the bolt, across the plane, of any length but zero.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axis: Option<Vec<f64>>,
    /// In place of these: two groups of facets that lie on each other, of cells without common nodes there; the bolt
    /// runs along their normal.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub faces: Option<[SceneGroup; 2]>,
    /// Force that the bolt carries, positive if it pulls (plane strain: per unit of depth; axisymmetric: on the whole
    /// ring).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub force: Option<f64>,
    /// In place of it: how much shorter the bolt is made than it is drawn, in the unit of length.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shortening: Option<f64>,
    /// Instant of `steps` from which on the shortening stays what it was then, and the force is found.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub locked_from: Option<f64>,
}

/// A bolt in the terms of mechanics: its faces are tied, and what is between them is a rigid body.
pub(super) struct Resolved {
    pub(super) pair: ContactPair,
    pub(super) between: RigidBody,
}

/// Of every node at a cut the direction out of its side, and the place of the bolt.
pub(super) type Cuts = HashMap<usize, (Vector3<f64>, String)>;

/// The nodes at the cuts of bolts.
pub(super) fn cuts(bolts: &[Resolved]) -> Cuts {
    let mut cuts = Cuts::new();
    for Resolved { pair, between } in bolts {
        let (Some(cut), Opposite::Surface { facets, .. }) = (&between.cut, &pair.opposite) else {
            continue;
        };
        let out = Vector3::from(cut.towards);
        for (facets, out) in [(&pair.facets, out), (facets, -out)] {
            let nodes = facets.iter().flat_map(|facet| &facet.nodes);
            cuts.extend(nodes.map(|&node| (node, (out, pair.place.clone()))));
        }
    }
    cuts
}

impl SceneBolt {
    /// A bolt that is cut along the plane through a point across an axis and carries a force.
    #[must_use]
    pub fn preloaded(name: &str, group: &str, point: &[f64], axis: &[f64], force: f64) -> Self {
        Self {
            name: name.to_owned(),
            group: Some(group.into()),
            point: Some(point.to_vec()),
            axis: Some(axis.to_vec()),
            force: Some(force),
            ..Self::default()
        }
    }

    /// Cuts the mesh, unless the faces are there already; their names, ahead along the axis and behind.
    pub(super) fn cut(&self, place: &str, mesh: &mut Mesh) -> Result<[SceneGroup; 2], Error> {
        match (&self.group, &self.point, &self.axis, &self.faces) {
            (Some(group), Some(point), Some(axis), None) => {
                let cells = selection::cells(mesh, &format!("{place}.group"), group)?;
                for &cell in &cells {
                    selection::check_cell(mesh, &format!("{place}.group"), cell)?;
                }
                let of = |key: &str, values: &[f64]| {
                    selection::vector(&format!("{place}.{key}"), values, mesh.dimension)
                };
                let plane = [of("point", point)?, of("axis", axis)?];
                if mesh.groups.contains_key(&format!("{}.own", self.name)) {
                    return Err(Error::NotAccepted {
                        place: format!("{place}.name"),
                        found: format!("`{}`, which names a cut already", self.name),
                        accepted: "another name".to_owned(),
                    });
                }
                mesh.cut(place, &self.name, &cells, plane)?;
                Ok(["own", "other"].map(|side| format!("{}.{side}", self.name).into()))
            }
            (None, None, None, Some(faces)) => Ok(faces.clone()),
            _ => Err(Error::NotAccepted {
                place: place.to_owned(),
                found: "other keys for the cut".to_owned(),
                accepted: "`group`, `point` and `axis`, or `faces`".to_owned(),
            }),
        }
    }

    /// The bolt of body `index`, whose mesh has these faces.
    pub(super) fn resolve(
        &self,
        place: &str,
        (index, mesh, model): (usize, &Mesh, Model),
        faces: &[SceneGroup; 2],
    ) -> Result<Resolved, Error> {
        let at = |side: usize| match self.faces {
            Some(_) => format!("{place}.faces[{side}]"),
            None => place.to_owned(),
        };
        let sides = [
            selection::facets(mesh, &at(0), &faces[0])?,
            selection::facets(mesh, &at(1), &faces[1])?,
        ];
        let [[centre, towards], other] = [0, 1].map(|side| mesh.plane_of(&sides[side]));
        check_coincident(place, mesh, [[centre, towards], other])?;
        let towards = towards.map(|m| m / selection::norm(towards));
        if model == Model::Axisymmetric && towards[0].abs() > AT_NODE {
            return Err(Error::NotAccepted {
                place: format!("{place}.axis"),
                found: format!("{towards:?}, beside an axisymmetric body"),
                accepted: "[0, 1]: a ring is cut across its axis".to_owned(),
            });
        }
        let mut components = [Component::Given(0.0); 6];
        components[0] = self.component(place)?;
        let [facets, opposite] = sides;
        let pair = ContactPair {
            place: place.to_owned(),
            body: index,
            facets,
            opposite: Opposite::Surface {
                body: index,
                facets: opposite,
            },
            friction: 0.0,
            law: PairLaw {
                bilateral: true,
                sticks: true,
                ..PairLaw::default()
            },
            rounded: false,
            gap: 0.0,
            dragged: false,
            obstacle_motions: Vec::new(),
        };
        let between = RigidBody {
            place: place.to_owned(),
            name: self.name.clone(),
            reference: centre,
            components,
            pairs: Vec::new(),
            cut: Some(Cut {
                towards,
                locked_from: self.locked_from,
            }),
        };
        Ok(Resolved { pair, between })
    }

    /// What is given: the force, or the shortening.
    fn component(&self, place: &str) -> Result<Component, Error> {
        let refuse = |key: &str, found: &str, accepted: &str| {
            Err(Error::NotAccepted {
                place: format!("{place}{key}"),
                found: found.to_owned(),
                accepted: accepted.to_owned(),
            })
        };
        match (self.force, self.shortening) {
            (Some(force), None) => {
                finite(format!("{place}.force"), force)?;
                Ok(Component::Free(force))
            }
            (None, Some(_)) if self.locked_from.is_some() => {
                let accepted = "`force` with it: a given shortening needs no lock";
                refuse(".locked_from", "a lock beside `shortening`", accepted)
            }
            (None, Some(shortening)) => {
                finite(format!("{place}.shortening"), shortening)?;
                Ok(Component::Given(shortening))
            }
            (Some(_), Some(_)) => refuse("", "both `force` and `shortening`", "one of the two"),
            (None, None) => refuse("", "no `force` and no `shortening`", "one of the two"),
        }
    }
}

/// Refuses faces that do not lie on each other.
fn check_coincident(
    place: &str,
    mesh: &Mesh,
    [[x, n], [y, m]]: [[[f64; 3]; 2]; 2],
) -> Result<(), Error> {
    let area = selection::norm(n);
    let apart = selection::norm([0, 1, 2].map(|k| x[k] - y[k]));
    let aside = selection::norm([0, 1, 2].map(|k| n[k] + m[k]));
    if area > 0.0 && apart <= AT_NODE * selection::size(mesh) && aside <= 1e-3 * area {
        return Ok(());
    }
    Err(Error::NotAccepted {
        place: format!("{place}.faces"),
        found: format!(
            "faces with centres {apart:e} apart, and areas along normals that differ by {aside:e} of {area:e}"
        ),
        accepted: "two faces that lie on each other and look against each other".to_owned(),
    })
}

/// Refuses bolts that are locked at no instant of a history, or driven after that.
pub(super) fn check_locks(rigid: &[RigidBody], history: &LoadHistory) -> Result<(), Error> {
    let instants = history.instants();
    for (number, body) in rigid.iter().enumerate() {
        let Some(from) = body.cut.and_then(|cut| cut.locked_from) else {
            continue;
        };
        if !instants.contains(&from) {
            return Err(Error::NotAccepted {
                place: format!("{}.locked_from", body.place),
                found: from.to_string(),
                accepted: match instants {
                    [] => "none without `steps`".to_owned(),
                    _ => format!("an instant of `steps.at`: {instants:?}"),
                },
            });
        }
        let component = Driven::Rigid {
            body: number,
            component: 0,
        };
        let factor = |at: f64| history.factor_of(component, at);
        let later = instants.iter().filter(|at| **at > from);
        if let Some(at) = later.copied().find(|at| factor(*at) != factor(from)) {
            return Err(Error::NotAccepted {
                place: format!("steps.factors.{}.force", body.place),
                found: format!(
                    "a factor that changes until {at}, after the bolt is locked at {from}"
                ),
                accepted: "one that stays: from the lock on the force is found".to_owned(),
            });
        }
    }
    Ok(())
}
