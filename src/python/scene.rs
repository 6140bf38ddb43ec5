//! Scenes: stated as JSON with meshes beside it, as the Python class `Scene` holds them.

use std::path::PathBuf;
use std::sync::Arc;

use dpana::condensation::Condensed;
use dpana::deck::Deck;
use dpana::scene::{MeshSource, SavedState, Scene};
use dpana::{Error as Refusal, Solution, Variation};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::error::refused;
use super::mesh::Mesh;
use super::problem::Problem;
use super::result::{Solved, parsed};
use super::watched::{Flag, watched};

/// A scene that was read; behind `dpana.Scene`.
#[pyclass(module = "dpana", frozen)]
pub(super) struct StatedScene(Scene);

#[pymethods]
impl StatedScene {
    /// `text`: JSON, in which the mesh of a body that is in `meshes` is held by any file name;
    /// `source`: the file that it came from, if any; `meshes`: body, from 0, and its mesh.
    #[new]
    fn new(text: &str, source: Option<PathBuf>, meshes: Vec<(usize, Mesh)>) -> PyResult<Self> {
        let name = source.clone().unwrap_or_else(|| "scene".into());
        let mut scene = Scene::from_json(text, name).map_err(refused)?;
        scene.source = source.unwrap_or_default();
        for (at, mesh) in meshes {
            if let Some(body) = scene.bodies.get_mut(at) {
                body.mesh = MeshSource::Given(mesh.0);
            }
        }
        Ok(Self(scene))
    }

    /// Reads a deck of Abaqus or CalculiX: JSON of its scene, meshes by body, notes.
    #[staticmethod]
    #[allow(clippy::type_complexity, reason = "three things, taken apart at once")]
    fn read_deck(path: PathBuf) -> PyResult<(String, Vec<(usize, Mesh)>, Vec<String>)> {
        let Deck { mut scene, notes } = Deck::from_file(path).map_err(refused)?;
        let mut meshes = Vec::new();
        for (at, body) in scene.bodies.iter_mut().enumerate() {
            let held = MeshSource::File {
                file: PathBuf::from("in memory"),
                scale: 1.0,
                split: None,
                groups: Vec::new(),
            };
            match std::mem::replace(&mut body.mesh, held) {
                MeshSource::Given(mesh) => meshes.push((at, Mesh(mesh))),
                stated => body.mesh = stated,
            }
        }
        Ok((scene.to_json().map_err(refused)?, meshes, notes))
    }

    /// Solves the scene; `each` is called with the result of every state; `restart` is the text of a
    /// state to go on from.
    fn solve(
        &self,
        py: Python<'_>,
        each: Option<Py<PyAny>>,
        restart: Option<&str>,
    ) -> PyResult<Solved> {
        let from = restart.map(|text| SavedState::from_json(text, "restart"));
        let from = from.transpose().map_err(refused)?;
        let flag = Arc::new(Flag::take());
        let (solution, raised) = watched(py, &flag, |interrupt| {
            let mut scene = self.0.clone();
            scene.settings.interrupt = Some(interrupt);
            let mut raised = None;
            let solution = dpana::solve_steps(&scene, from.as_ref(), |solution| {
                if interrupt.is_raised() {
                    return Err(ended());
                }
                let Some(each) = &each else {
                    return Ok(());
                };
                show(each, solution, &flag).map_err(|error| {
                    raised = Some(error);
                    ended()
                })
            });
            (solution, raised)
        })?;
        match raised {
            Some(error) => Err(error),
            None => Solved::new(solution.map_err(refused)?, flag),
        }
    }

    /// Solves the scene for every combination of values: the table as `columns` and `rows`.
    fn cases<'py>(
        &self,
        py: Python<'py>,
        variations: Vec<(String, Vec<f64>)>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let variations = variations.into_iter();
        let variations = variations.map(|(name, values)| Variation { name, values });
        let variations: Vec<Variation> = variations.collect();
        let table = watched(py, &Flag::take(), |interrupt| {
            let mut scene = self.0.clone();
            scene.settings.interrupt = Some(interrupt);
            dpana::cases(&scene, &variations)
        })?;
        parsed(py, &table.map_err(refused)?.to_json())
    }

    /// By what factor each load can grow, on rigid bodies (an upper bound) and on the elastic ones, and how much friction the loads take.
    fn limit<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let limits = watched(py, &Flag::take(), |interrupt| {
            let mut scene = self.0.clone();
            scene.settings.interrupt = Some(interrupt);
            dpana::limit(&scene)
        })?;
        parsed(py, &limits.map_err(refused)?.to_json())
    }

    /// The condensed problem, without solving it.
    fn condense(&self, py: Python<'_>) -> PyResult<Problem> {
        let found = py.detach(|| {
            let mechanics = self.0.mechanics()?;
            let dimension = mechanics
                .bodies
                .first()
                .map_or(3, |body| body.mesh.dimension);
            let condensed = Condensed::with_rigid(
                &mechanics.bodies,
                &mechanics.contacts,
                &mechanics.rigid_bodies,
            );
            let condensed = condensed.map_err(|error| self.0.locate(error))?;
            Ok(Problem::of_scene(&condensed, dimension))
        });
        found.map_err(refused)
    }

    /// Reads meshes and finds the contacts without solving; refuses what a solve would refuse.
    fn check<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let checked = py.detach(|| dpana::check(&self.0)).map_err(refused)?;
        let found = PyDict::new(py);
        let bodies = checked.mechanics.bodies.iter();
        found.set_item(
            "nodes",
            bodies.map(|body| body.mesh.nodes.len()).sum::<usize>(),
        )?;
        found.set_item("contacts", checked.surface.nodes.len())?;
        found.set_item("free_modes", &checked.free_modes)?;
        found.set_item("dense_bytes", checked.dense_bytes)?;
        found.set_item("notes", &checked.mechanics.notes)?;
        Ok(found)
    }
}

/// The JSON Schema of a scene as a dict.
#[pyfunction]
pub(super) fn schema(py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
    parsed(py, &dpana::scene::schema().to_string())
}

/// Calls `each` with a result.
fn show(each: &Py<PyAny>, solution: &Solution, flag: &Arc<Flag>) -> PyResult<()> {
    let result = Solved::new(solution.clone(), Arc::clone(flag))?;
    Python::attach(|py| each.call1(py, (result,)).map(drop))
}

/// What ends a history where Python raises: never shown.
fn ended() -> Refusal {
    Refusal::NotAccepted {
        place: "each".to_owned(),
        found: "an exception".to_owned(),
        accepted: "a return".to_owned(),
    }
}
