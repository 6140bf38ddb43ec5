//! SCENE: what the user writes.
//!
//! ```text
//! bodies    mesh, model, materials, supports, loads
//! contacts  group of surface facets, rigid obstacle, friction
//! settings  tolerance, max_sweeps
//! ```
//!
//! A [`Scene`] comes from JSON or is built in code; [`Scene::mechanics`] turns it into
//! bodies and contact pairs. Every mistake is an error that names its place, such as
//! `bodies[0].materials[1].poisson`, the value and what is accepted. Numbers are in one
//! consistent system of units of the user's choice; nothing is converted.

mod bare;
mod contact;
mod elastic_body;
mod json;
mod load;
mod mesh_source;
mod selection;
mod spelling;
mod support;

use std::path::{Path, PathBuf};

use schemars::JsonSchema;
use serde::Deserialize;

use crate::body::Body;
use crate::condensation::ContactPair;
use crate::dpana::{Settings, Variant};
use crate::error::Error;

pub use bare::BareProblem;
pub use contact::{SceneContact, SceneObstacle};
pub use elastic_body::{SceneBody, SceneMaterial, SceneModel};
pub use load::SceneLoad;
pub use mesh_source::{BoxMesh, MeshSource, PlaneCell, Rectangle, SolidCell};
pub use support::SceneSupport;

/// An elastic body on rigid obstacles, as the user states it.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a scene")]
pub struct Scene {
    /// Shown in reports.
    #[serde(default)]
    pub title: String,
    /// Label of the units, such as `m, N, Pa`: shown in reports, never used to convert.
    #[serde(default)]
    pub units: String,
    /// The elastic bodies; exactly one for now.
    pub bodies: Vec<SceneBody>,
    /// Where the bodies may touch obstacles; at least one.
    pub contacts: Vec<SceneContact>,
    /// When the solve may stop.
    #[serde(default)]
    pub settings: SceneSettings,
    /// File that the scene came from: named in messages, and mesh files are relative to
    /// its folder. Empty for a scene built in code.
    #[serde(skip)]
    pub source: PathBuf,
}

/// Settings of the solve; left out, the defaults hold.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "an object of settings")]
pub struct SceneSettings {
    /// Largest natural-map residual that counts as solved, from 1e-15 to 1e-2.
    pub tolerance: Option<f64>,
    /// Sweeps after which the solve gives up, at least 1.
    pub max_sweeps: Option<usize>,
    /// Which outer loop runs; for study, from code only.
    #[serde(skip)]
    pub variant: Variant,
}

/// A scene in the terms of mechanics: groups resolved, facets outward, values checked.
#[derive(Clone, Debug, PartialEq)]
pub struct Mechanics {
    /// The elastic bodies.
    pub bodies: Vec<Body>,
    /// What may touch what.
    pub contacts: Vec<ContactPair>,
    /// Settings of the outer loop.
    pub settings: Settings,
}

impl Scene {
    /// Reads a scene from JSON text; `file` stands for it in messages, and mesh files are
    /// relative to its folder.
    ///
    /// # Errors
    ///
    /// [`Error::Json`] with line, column and path: no JSON, an unknown key (with the known
    /// one that is spelt most alike), a missing one, a value of the wrong type.
    pub fn from_json(text: &str, file: impl AsRef<Path>) -> Result<Self, Error> {
        let file = file.as_ref();
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
        let bytes = read("scene", path)?;
        let text = String::from_utf8(bytes).map_err(|bytes| Error::Unreadable {
            place: "scene".to_owned(),
            file: path.display().to_string(),
            reason: format!(
                "byte {} is not UTF-8 text; expected JSON",
                bytes.utf8_error().valid_up_to()
            ),
        })?;
        Self::from_json(&text, path)
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
        let [body] = &self.bodies[..] else {
            return Err(Error::NotAccepted {
                place: "bodies".to_owned(),
                found: format!("a list of {}", self.bodies.len()),
                accepted: "exactly one body".to_owned(),
            });
        };
        if self.contacts.is_empty() {
            return Err(Error::Empty {
                place: "contacts".to_owned(),
            });
        }
        let folder = self.source.parent().unwrap_or(Path::new(""));
        let bodies = vec![body.resolve("bodies[0]", folder)?];
        let contacts = self.contacts.iter().enumerate();
        let contacts = contacts
            .map(|(at, contact)| contact.resolve(&format!("contacts[{at}]"), &bodies))
            .collect::<Result<_, _>>()?;
        Ok(Mechanics {
            bodies,
            contacts,
            settings,
        })
    }
}

impl SceneSettings {
    fn resolve(&self) -> Result<Settings, Error> {
        let default = Settings::default();
        let settings = Settings {
            tolerance: self.tolerance.unwrap_or(default.tolerance),
            max_sweeps: self.max_sweeps.unwrap_or(default.max_sweeps),
            variant: self.variant,
        };
        settings.validate()?;
        Ok(settings)
    }
}

/// The JSON Schema of a scene, from the types that read it.
#[must_use]
pub fn schema() -> serde_json::Value {
    schemars::schema_for!(Scene).to_value()
}

/// Reads a whole file. Folders and pipes are refused: a pipe could hold the program forever.
fn read(place: &str, path: &Path) -> Result<Vec<u8>, Error> {
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
