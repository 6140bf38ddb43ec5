//! SCENE: what the user writes.
//!
//! ```text
//! bodies    mesh, model, materials, supports, loads, springs, bolts
//! rigid_bodies  surfaces, motion given or free under forces
//! contacts  group of surface facets, what it may touch, friction or another law, gap
//! steps     instants, factors of loads, supports and rigid bodies, motions of obstacles, gaps
//! settings  tolerance, max_sweeps, time_limit
//! ```
//!
//! A [`Scene`] comes from JSON or is built in code; [`Scene::mechanics`] turns it into
//! bodies and contact pairs. Every mistake is an error that names its place, such as
//! `bodies[0].materials[1].poisson`, the value and what is accepted. Numbers are in one
//! consistent system of units of the user's choice; nothing is converted.

mod bare;
mod bolt;
mod contact;
mod elastic_body;
mod field;
mod foundation;
mod general_contact;
mod group;
mod half_space;
mod heat;
mod height_map;
mod itself;
mod json;
mod law;
mod load;
mod load_keys;
mod local_axes;
mod material;
mod mesh_source;
mod nodal_table;
mod obstacle;
mod remeshed;
mod rigid_body;
mod saved_state;
mod selection;
mod spelling;
mod steps;
mod support;
mod table;
mod ties;
mod transverse;

use std::path::{Path, PathBuf};
use std::time::Duration;

use serde::{Deserialize, Serialize};

use crate::alternation::{Interrupt, Settings};
use crate::body::Body;
use crate::condensation::Engine;
use crate::contact::{ContactPair, RigidBody};
use crate::error::Error;

pub use bare::BareProblem;
pub use bolt::SceneBolt;
pub use contact::{SceneContact, SceneSurface};
pub use elastic_body::{SceneBody, SceneFormulation, SceneModel};
pub use field::{SceneAffine, SceneAffineVector, SceneLine, SceneSpin, SceneTurn};
pub use foundation::SceneFoundation;
pub use general_contact::SceneGeneralContact;
pub use group::SceneGroup;
pub use half_space::{
    HalfSpaceHistory, HalfSpaceScene, SceneDrive, SceneHalf, SceneHalfSpace, SceneRolling,
    SceneSurfaceShape, SceneSurroundings,
};
pub use heat::{NodalFile, SceneTemperature};
pub use law::{NotConvex, SceneCompliance, SceneFrictionTable, SceneLaw};
pub use load::SceneLoad;
pub use local_axes::SceneAxis;
pub use material::{SceneAxes, SceneMaterial, SceneOrthotropic};
pub use mesh_source::{BoxMesh, MeshSource, PlaneCell, Rectangle, SolidCell};
pub use obstacle::SceneObstacle;
pub use rigid_body::SceneRigidBody;
pub use saved_state::SavedState;
pub(crate) use saved_state::{Exact, Fingerprint, exact, plain};
pub use steps::SceneSteps;
pub(crate) use steps::{LoadHistory, driven};
pub use support::SceneSupport;
pub use ties::{ScenePeriodic, SceneRigidGroup};
pub use transverse::{CylindricalAxis, SceneAlong, SceneTransverse};

pub(crate) use spelling::nearest;

use mesh_source::MOST_NODES;
use rigid_body::Resolved;

/// Elastic bodies that may touch rigid obstacles and each other, as the user states it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, expecting = "a scene")]
#[non_exhaustive]
pub struct Scene {
    /// Where editors find the schema of scenes; not read.
    #[serde(default, rename = "$schema", skip_serializing_if = "Option::is_none")]
    pub schema: Option<String>,
    /// Anything the author wants to say; not read.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub comment: Option<SceneComment>,
    /// Shown in reports.
    #[serde(default)]
    pub title: String,
    /// Label of the units, such as `mm, N, MPa`: shown in reports, never used to convert. All numbers are in
    /// one consistent system of the author's choice.
    #[serde(default)]
    pub units: String,
    /// The elastic bodies, all in 2D or all in 3D; names differ.
    #[cfg_attr(feature = "cli", schemars(length(min = 1)))]
    pub bodies: Vec<SceneBody>,
    /// Bodies without compliance; names differ, also from those of the elastic bodies.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub rigid_bodies: Vec<SceneRigidBody>,
    /// Where the bodies may touch obstacles or each other; at least one, unless there is `general_contact`.
    #[serde(default)]
    pub contacts: Vec<SceneContact>,
    /// Contact between all bodies whose skins face each other.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub general_contact: Option<SceneGeneralContact>,
    /// A load history; left out, there is one state under the loads as they stand.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steps: Option<SceneSteps>,
    /// When the solve may stop.
    #[serde(default)]
    pub settings: SceneSettings,
    /// File that the scene came from: named in messages, and mesh files are relative to
    /// its folder. Empty for a scene built in code.
    #[serde(skip)]
    pub source: PathBuf,
}

/// What the author of a scene wants to say.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(untagged, expecting = "text, or a list of lines of text")]
pub enum SceneComment {
    /// One line.
    Line(String),
    /// Several.
    Lines(Vec<String>),
}

/// Settings of the solve; left out, the defaults hold.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, expecting = "an object of settings")]
#[non_exhaustive]
pub struct SceneSettings {
    /// Largest natural-map residual that counts as solved, from 1e-15 to 1e-2.
    #[cfg_attr(feature = "cli", schemars(range(min = 1e-15, max = 1e-2)))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
    /// Sweeps after which the solve gives up, at least 1.
    #[cfg_attr(feature = "cli", schemars(range(min = 1)))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_sweeps: Option<usize>,
    /// Seconds after which the solve of a state (each part of a load step has its own) gives up with the best state
    /// it found, more than 0; without it there is no end.
    #[cfg_attr(feature = "cli", schemars(range(min = 0)))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_limit: Option<f64>,
    /// A flag that ends the solve once it is raised, with the best state; not part of a scene's file.
    #[serde(skip)]
    pub interrupt: Option<Interrupt>,
    /// What factorises the bodies; not part of a scene's file.
    #[serde(skip)]
    pub engine: Engine,
}

/// A scene in the terms of mechanics: groups resolved, facets outward, values checked.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Mechanics {
    /// The elastic bodies.
    pub bodies: Vec<Body>,
    /// What may touch what.
    pub contacts: Vec<ContactPair>,
    /// Rigid bodies that carry the obstacles of some contacts.
    pub rigid_bodies: Vec<RigidBody>,
    /// How loads, supports and obstacles change; no instants where the scene has no steps.
    pub history: LoadHistory,
    /// Settings of the outer loop.
    pub settings: Settings,
    /// What was changed on the way here, in words.
    pub notes: Vec<String>,
}

impl Scene {
    /// A scene of bodies and contacts from memory, with default settings and without steps.
    ///
    /// ```
    /// use dpana::body::{CellKind, Mesh};
    /// use dpana::scene::{
    ///     SceneBody, SceneContact, SceneMaterial, SceneModel, SceneObstacle, SceneSupport,
    /// };
    /// use dpana::{Scene, Status, solve};
    ///
    /// # fn main() -> Result<(), dpana::Error> {
    /// // Two unit squares side by side, as arrays of another program.
    /// let positions = [0.0, 0.0, 1.0, 0.0, 2.0, 0.0, 0.0, 1.0, 1.0, 1.0, 2.0, 1.0];
    /// let cells = [0, 1, 4, 3, 1, 2, 5, 4];
    /// let mesh = Mesh::from_arrays(CellKind::Quad4, &positions, &cells)?
    ///     .with_surface("bottom", |[_, y, _]| y == 0.0)?
    ///     .with_surface("top", |[_, y, _]| y == 1.0)?;
    /// let block = SceneBody::new("block", mesh)
    ///     .with_model(SceneModel::PlaneStrain)
    ///     .with_material(SceneMaterial::new(1000.0, 0.0))
    ///     .with_support(SceneSupport::of("top", &[Some(0.0), Some(-0.01)]));
    /// let floor = SceneObstacle::plane(&[0.0, 0.0], &[0.0, 1.0]);
    /// let scene = Scene::new(vec![block], vec![SceneContact::on(floor, "bottom", 0.3)]);
    ///
    /// let solution = solve(&scene)?;
    /// assert_eq!(solution.status(), Status::Certified);
    /// // E ε = 10 Pa.
    /// let report = solution.report()?;
    /// assert!((report.totals.peak_pressure - 10.0).abs() < 1e-9);
    /// # Ok(())
    /// # }
    /// ```
    #[must_use]
    pub fn new(bodies: Vec<SceneBody>, contacts: Vec<SceneContact>) -> Self {
        Self {
            bodies,
            contacts,
            ..Self::default()
        }
    }

    /// Reads a scene from JSON text; `file` stands for it in messages, and mesh files are
    /// relative to its folder.
    ///
    /// ```
    /// use dpana::{Scene, Status, solve};
    ///
    /// # fn main() -> Result<(), dpana::Error> {
    /// let scene = r#"{
    ///     "bodies": [{ "mesh": { "rectangle": { "x": [0, 1], "y": [0, 1], "cells": [8, 8] } },
    ///                  "model": "plane_strain",
    ///                  "materials": [{ "young": 1000, "poisson": 0.3 }],
    ///                  "supports": [{ "group": "top", "displacement": [0.002, -0.01] }] }],
    ///     "contacts": [{ "group": "bottom", "friction": 0.3,
    ///                    "obstacle": { "plane": { "point": [0, 0], "normal": [0, 1] } } }] }"#;
    /// let solution = solve(&Scene::from_json(scene, "square.json")?)?;
    /// assert_eq!(solution.status(), Status::Certified);
    /// let totals = solution.report()?.totals;
    /// assert_eq!(totals.open + totals.stick + totals.slip, 9);
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    ///
    /// [`Error::Json`] with line, column and path: no JSON, an unknown key (with the known
    /// one that is spelt most alike), a missing one, a value of the wrong type.
    pub fn from_json(text: &str, file: impl AsRef<Path>) -> Result<Self, Error> {
        let file = file.as_ref();
        // Editors of one system put a mark of byte order in front.
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let mut scene: Self = json::parse(text, &file.display().to_string())?;
        scene.source = file.to_owned();
        Ok(scene)
    }

    /// Reads a scene from a JSON file.
    ///
    /// # Errors
    ///
    /// [`Error::Unreadable`], and those of [`Scene::from_json`].
    pub fn from_file(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        Self::from_bytes(read("scene", path)?, path)
    }

    /// Reads a scene from the bytes of a JSON file; `file` stands for it as in [`Scene::from_json`].
    ///
    /// # Errors
    ///
    /// [`Error::Unreadable`] where they are no UTF-8 text, and those of [`Scene::from_json`].
    pub fn from_bytes(bytes: Vec<u8>, file: impl AsRef<Path>) -> Result<Self, Error> {
        let file = file.as_ref();
        let text = String::from_utf8(bytes).map_err(|bytes| Error::Unreadable {
            place: "scene".to_owned(),
            file: file.display().to_string(),
            reason: format!(
                "byte {} is not UTF-8 text; expected JSON",
                bytes.utf8_error().valid_up_to()
            ),
        })?;
        Self::from_json(&text, file)
    }

    /// The scene in JSON, as [`Scene::from_json`] reads it.
    ///
    /// # Errors
    ///
    /// [`Error::NotAccepted`] for a body whose mesh is in memory: put it into a file first, with
    /// [`to_text`](crate::mesh_file::gmsh::to_text).
    pub fn to_json(&self) -> Result<String, Error> {
        serde_json::to_string_pretty(self).map_err(|reason| Error::NotAccepted {
            place: "scene".to_owned(),
            found: reason.to_string(),
            accepted: "meshes from files or generators".to_owned(),
        })
    }

    /// Reads or generates the meshes, looks up the groups and checks every value.
    ///
    /// # Errors
    ///
    /// Whatever is wrong with the scene, with its file and place.
    pub fn mechanics(&self) -> Result<Mechanics, Error> {
        self.build().map_err(|error| self.locate(error))
    }

    /// Adds the scene's file to an error.
    #[must_use]
    pub fn locate(&self, error: Error) -> Error {
        if self.source.as_os_str().is_empty() {
            return error;
        }
        error.within(self.source.display())
    }

    fn build(&self) -> Result<Mechanics, Error> {
        let settings = self.settings.resolve()?;
        let bolted = self.bodies.iter().any(|body| !body.bolts.is_empty());
        if self.contacts.is_empty() && self.general_contact.is_none() && !bolted {
            return Err(Error::Empty {
                place: "contacts".to_owned(),
            });
        }
        let folder = self.source.parent().unwrap_or(Path::new(""));
        let (mut bodies, mut room) = (Vec::with_capacity(self.bodies.len()), MOST_NODES);
        let mut notes = Vec::new();
        let mut bolts = Vec::new();
        for (at, body) in self.bodies.iter().enumerate() {
            let (body, of_body) = body.resolve(at, folder, room, &mut notes)?;
            room = room.saturating_sub(body.mesh.nodes.len());
            bodies.push(body);
            bolts.extend(of_body);
        }
        check_together(&bodies)?;
        let mut rigid = self.resolve_rigid(folder, &bodies)?;
        let mut contacts = Vec::with_capacity(self.contacts.len());
        for (at, contact) in self.contacts.iter().enumerate() {
            let place = format!("contacts[{at}]");
            contacts.push(contact.resolve(&place, folder, &bodies, &rigid)?);
            if let Some(name) = &contact.rigid_body {
                let number = contact.rigid_number(&place, name, &rigid)?;
                rigid[number].body.pairs.push(at);
            }
        }
        let mut rigid_bodies: Vec<RigidBody> = rigid.into_iter().map(|rigid| rigid.body).collect();
        check_touched(&rigid_bodies)?;
        for bolt::Resolved { pair, mut between } in bolts {
            check_name(&bodies, &rigid_bodies, &between)?;
            between.pairs.push(contacts.len());
            rigid_bodies.push(between);
            contacts.push(pair);
        }
        if let Some(general) = &self.general_contact {
            let more = general.pairs(&mut bodies, &contacts)?;
            contacts.extend(more);
        }
        let history = match &self.steps {
            Some(steps) => steps.resolve(&bodies, &contacts, &rigid_bodies)?,
            None => LoadHistory::default(),
        };
        bolt::check_locks(&rigid_bodies, &history)?;
        for (at, pair) in contacts.iter_mut().enumerate() {
            let carriers = rigid_bodies
                .iter()
                .filter(|rigid| rigid.pairs.contains(&at));
            let carried = carriers.flat_map(RigidBody::possible_motions);
            pair.obstacle_motions = history.obstacle_motions(at).chain(carried).collect();
        }
        Ok(Mechanics {
            bodies,
            contacts,
            rigid_bodies,
            history,
            settings,
            notes,
        })
    }

    fn resolve_rigid(&self, folder: &Path, bodies: &[Body]) -> Result<Vec<Resolved>, Error> {
        let mut rigid: Vec<Resolved> = Vec::with_capacity(self.rigid_bodies.len());
        for (at, stated) in self.rigid_bodies.iter().enumerate() {
            let found = stated.resolve(&format!("rigid_bodies[{at}]"), folder, bodies)?;
            check_name(bodies, rigid.iter().map(|rigid| &rigid.body), &found.body)?;
            rigid.push(found);
        }
        Ok(rigid)
    }
}

/// Refuses a name that a body, a rigid body or a bolt has already.
fn check_name<'a>(
    bodies: &[Body],
    rigid: impl IntoIterator<Item = &'a RigidBody>,
    new: &RigidBody,
) -> Result<(), Error> {
    let mut names =
        (bodies.iter().map(|body| &body.name)).chain(rigid.into_iter().map(|body| &body.name));
    match names.any(|name| *name == new.name) {
        false => Ok(()),
        true => Err(Error::NotAccepted {
            place: format!("{}.name", new.place),
            found: format!("`{}` again", new.name),
            accepted: "a name of its own for every body".to_owned(),
        }),
    }
}

/// Refuses a rigid body that no contact names.
fn check_touched(rigid: &[RigidBody]) -> Result<(), Error> {
    match rigid.iter().find(|body| body.pairs.is_empty()) {
        None => Ok(()),
        Some(body) => Err(Error::NotAccepted {
            place: body.place.clone(),
            found: format!("`{}`, which no contact names", body.name),
            accepted: "a rigid body that some contact has as its `rigid_body`".to_owned(),
        }),
    }
}

/// Bodies of one scene live in one space, under names of their own.
fn check_together(bodies: &[Body]) -> Result<(), Error> {
    let Some(first) = bodies.first() else {
        return Err(Error::Empty {
            place: "bodies".to_owned(),
        });
    };
    for (at, body) in bodies.iter().enumerate() {
        if body.mesh.dimension != first.mesh.dimension {
            return Err(Error::NotAccepted {
                place: format!("bodies[{at}].mesh"),
                found: format!("a mesh in {}D", body.mesh.dimension),
                accepted: format!(
                    "one in {}D, as that of `{}`",
                    first.mesh.dimension, first.name
                ),
            });
        }
        if bodies[..at].iter().any(|other| other.name == body.name) {
            return Err(Error::NotAccepted {
                place: format!("bodies[{at}].name"),
                found: format!("`{}` again", body.name),
                accepted: "a name of its own for every body".to_owned(),
            });
        }
    }
    Ok(())
}

impl SceneSettings {
    fn resolve(&self) -> Result<Settings, Error> {
        let default = Settings::default();
        let settings = Settings {
            tolerance: self.tolerance.unwrap_or(default.tolerance),
            max_sweeps: self.max_sweeps.unwrap_or(default.max_sweeps),
            time_limit: self.time_limit.map(seconds).transpose()?,
            interrupt: self.interrupt,
        };
        settings.validate()?;
        Ok(settings)
    }
}

/// A time limit.
fn seconds(limit: f64) -> Result<Duration, Error> {
    let found = Duration::try_from_secs_f64(limit);
    let found = found.ok().filter(|limit| !limit.is_zero());
    found.ok_or_else(|| Error::OutOfRange {
        place: "settings.time_limit".into(),
        value: limit,
        accepted: "0 < time_limit <= 1.8e19, in second",
    })
}

/// The JSON Schema of a scene, from the types that read it.
#[cfg(feature = "cli")]
#[must_use]
pub fn schema() -> serde_json::Value {
    schemars::schema_for!(Scene).to_value()
}

/// The same of a scene of half-spaces.
#[cfg(feature = "cli")]
#[must_use]
pub fn half_space_schema() -> serde_json::Value {
    schemars::schema_for!(HalfSpaceScene).to_value()
}

/// Reads a whole file. Folders and pipes are refused: a pipe could hold the program forever; what
/// comes through one is given as standard input.
pub(crate) fn read(place: &str, path: &Path) -> Result<Vec<u8>, Error> {
    let regular = std::fs::metadata(path).and_then(|found| match found.is_file() {
        true => std::fs::read(path),
        false => Err(std::io::Error::other("not a regular file")),
    });
    regular.map_err(|error| Error::Unreadable {
        place: place.to_owned(),
        file: path.display().to_string(),
        reason: error.to_string(),
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use std::sync::atomic::AtomicBool;

    use super::*;
    use crate::body::{CellKind, Group, Load, Mesh, Model, rectangle};
    use crate::contact::{Obstacle, Opposite};

    /// Two by two quads on a square of side 2 m, pressed on a line.
    const SQUARE: &str = r#"{
        "title": "square", "units": "m, N, Pa",
        "bodies": [{
            "name": "square",
            "mesh": {"rectangle": {"x": [0, 2], "y": [0, 2], "cells": [2, 2]}},
            "model": "plane_strain",
            "materials": [{"young": 3, "poisson": 0.25}],
            "supports": [
                {"group": "right", "displacement": [0, null]},
                {"at": [2, 0], "displacement": [null, 0.5]}
            ],
            "loads": [
                {"pressure": 7, "group": "top"},
                {"traction": [1, 2], "group": "left"},
                {"body_force": [0, -9]},
                {"point_force": [3, 4], "at": [1, 1]}
            ]
        }],
        "contacts": [{
            "group": "bottom", "friction": 0.5,
            "obstacle": {"plane": {"point": [0, -1], "normal": [0, 1]}}
        }],
        "settings": {"max_sweeps": 7}
    }"#;

    #[test]
    fn every_part_of_a_scene_reaches_the_mechanics() {
        let Mechanics {
            bodies,
            contacts,
            settings,
            ..
        } = Scene::from_json(SQUARE, "").unwrap().mechanics().unwrap();
        let (body, contact) = (&bodies[0], &contacts[0]);
        assert_eq!(
            (body.name.as_str(), body.model),
            ("square", Model::PlaneStrain)
        );
        assert_eq!(body.material_of_cell, [0; 4]);
        assert_eq!(
            (body.materials[0].young, body.materials[0].poisson),
            (3.0, 0.25)
        );
        // Node at column i and row j is number i + 3 j.
        assert_eq!(body.supports[0].nodes, [2, 5, 8]);
        assert_eq!(body.supports[0].displacement, [Some(0.0), None, None]);
        assert_eq!(body.supports[1].place, "bodies[0].supports[1]");
        assert_eq!(body.supports[1].nodes, [2]);
        assert_eq!(body.supports[1].displacement, [None, Some(0.5), None]);
        assert!(matches!(&body.loads[0], Load::Pressure { facets, pressure }
            if facets.len() == 2 && *pressure == 7.0));
        assert!(matches!(&body.loads[1], Load::Traction { facets, traction }
            if facets.len() == 2 && *traction == [1.0, 2.0, 0.0]));
        assert!(matches!(&body.loads[2], Load::BodyForce { cells, density }
            if *cells == [0, 1, 2, 3] && *density == [0.0, -9.0, 0.0]));
        assert!(matches!(&body.loads[3], Load::PointForce { node: 4, force }
            if *force == [3.0, 4.0, 0.0]));
        assert_eq!(
            (contact.place.as_str(), contact.friction),
            ("contacts[0]", 0.5)
        );
        assert_eq!(contact.facets.len(), 2);
        let (point, normal) = ([0.0, -1.0, 0.0], [0.0, 1.0, 0.0]);
        let plane = Opposite::Obstacle(Obstacle::Plane { point, normal });
        assert_eq!((contact.body, &contact.opposite), (0, &plane));
        assert_eq!(settings.max_sweeps, 7);
        assert_eq!(settings.tolerance, Settings::default().tolerance);
    }

    #[test]
    fn a_flag_set_in_code_reaches_the_loop_and_stays_out_of_json() {
        static FLAG: AtomicBool = AtomicBool::new(false);
        let mut scene = Scene::from_json(SQUARE, "").unwrap();
        scene.settings.interrupt = Some(Interrupt::new(&FLAG));
        assert!(!scene.to_json().unwrap().contains("interrupt"));
        let settings = scene.mechanics().unwrap().settings;
        assert_eq!(settings.interrupt, scene.settings.interrupt);
    }

    #[test]
    fn a_scene_built_in_code_takes_a_mesh_built_in_code() {
        let mut mesh = rectangle(&[0.0, 1.0, 3.0], &[0.0, 1.0], CellKind::Quad4).unwrap();
        mesh.groups.insert("soft".into(), Group::Cells(vec![1]));
        mesh.groups.insert("stiff".into(), Group::Cells(vec![0]));
        let material = |group: &str, young| SceneMaterial::new(young, 0.0).of(group);
        let scene = Scene {
            bodies: vec![SceneBody {
                model: Some(SceneModel::PlaneStress { thickness: 0.1 }),
                materials: vec![material("soft", 1.0), material("stiff", 2.0)],
                ..SceneBody::new("bar", mesh)
            }],
            contacts: vec![SceneContact {
                group: "bottom".into(),
                body: Some("bar".into()),
                obstacle: Some(SceneObstacle::Circle {
                    center: vec![0.0, -2.0],
                    radius: 1.5,
                }),
                friction: Some(0.0),
                ..SceneContact::default()
            }],
            ..Scene::default()
        };
        let mechanics = scene.mechanics().unwrap();
        assert_eq!(mechanics.bodies[0].material_of_cell, [1, 0]);
        assert_eq!(
            mechanics.bodies[0].model,
            Model::PlaneStress { thickness: 0.1 }
        );
        assert_eq!(
            mechanics.contacts[0].opposite,
            Opposite::Obstacle(Obstacle::Cylinder {
                center: [0.0, -2.0, 0.0],
                axis: [0.0, 0.0, 1.0],
                radius: 1.5
            })
        );
    }

    #[test]
    fn a_mesh_file_is_found_beside_the_scene_and_scaled() {
        let scene = SQUARE
            .replace(
                r#"{"rectangle": {"x": [0, 2], "y": [0, 2], "cells": [2, 2]}}"#,
                r#"{"file": "meshes/A_block_n32.msh", "scale": 0.001}"#,
            )
            .replace("\"right\"", "\"sym\"")
            .replace("\"bottom\"", "\"contact\"")
            .replace("\"at\": [2, 0]", "\"at\": [0.04, 0]")
            .replace("\"at\": [1, 1]", "\"at\": [0.02, 0.02]");
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/scene.json");
        let mechanics = Scene::from_json(&scene, file).unwrap().mechanics().unwrap();
        let mesh: &Mesh = &mechanics.bodies[0].mesh;
        // 40 mm in 32 cells; the corner (40 mm, 0) is the last node of the lowest row.
        assert_eq!(mesh.nodes.len(), 33 * 33);
        assert_eq!(mechanics.bodies[0].supports[1].nodes, [32]);
        assert!((mesh.nodes[32][0] - 0.04).abs() < 1e-15);
        assert_eq!(mechanics.contacts[0].facets.len(), 32);
    }

    #[test]
    fn the_schema_names_every_key_and_closes_every_object() {
        let schema = schema();
        let keys = |of: &serde_json::Value| {
            let keys = of["properties"].as_object().unwrap().keys().cloned();
            keys.collect::<Vec<_>>().join(" ")
        };
        let expected = "$schema bodies comment contacts general_contact rigid_bodies settings steps title units";
        assert_eq!(keys(&schema), expected);
        assert_eq!(schema["additionalProperties"], false);
        let loads = schema["$defs"]["SceneLoad"]["anyOf"].as_array().unwrap();
        let of_loads: Vec<_> = loads.iter().map(keys).collect();
        assert_eq!(
            of_loads,
            [
                "group pressure",
                "group traction",
                "body_force group",
                "at point_force",
                "group pressure",
                "group traction",
                "at force group moment",
                "gravity group",
                "centrifugal group",
                "group temperature",
                "group initial_stress"
            ]
        );
        assert!(
            loads
                .iter()
                .all(|load| load["additionalProperties"] == false)
        );
        let meshes = schema["$defs"]["MeshSource"]["anyOf"].as_array().unwrap();
        let of_meshes: Vec<_> = meshes.iter().map(keys).collect();
        assert_eq!(of_meshes, ["file groups scale split", "rectangle", "box"]);
    }
}
