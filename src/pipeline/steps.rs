//! Load histories: one state after the other on one factorisation.

use super::halving::Halving;
use super::substep::{Course, State};
use super::{Setup, Solution};
use crate::alternation::Status;
use crate::error::{Error, check_length};
use crate::kkt::Ledger;
use crate::report;
use crate::scene::{Exact, Fingerprint, LoadHistory, SavedState, Scene, exact, plain};
use crate::trust::Earlier;

/// Solves a scene state by state and shows each to `each`; ends after the last instant, or with the
/// first state that is not certified, and returns that state.
///
/// ```
/// use dpana::{Scene, Status, solve_steps};
///
/// # fn main() -> Result<(), dpana::Error> {
/// // Pressed, then pulled aside and let go again: friction remembers.
/// let scene = r#"{
///     "bodies": [{ "mesh": { "rectangle": { "x": [0, 2], "y": [0, 1], "cells": [8, 4] } },
///                  "model": "plane_strain",
///                  "materials": [{ "young": 1000, "poisson": 0.3 }],
///                  "supports": [{ "group": "top", "displacement": [null, -0.01] },
///                               { "group": "top", "displacement": [0.004, null] }] }],
///     "contacts": [{ "group": "bottom", "friction": 0.3,
///                    "obstacle": { "plane": { "point": [0, 0], "normal": [0, 1] } } }],
///     "steps": { "at": [1, 2, 3],
///                "factors": { "bodies[0].supports[1]": [[1, 0], [2, 1], [3, 0]] } } }"#;
/// let mut pull = Vec::new();
/// let last = solve_steps(&Scene::from_json(scene, "")?, None, |solution| {
///     pull.push(solution.report()?.totals.friction[0]);
///     Ok(())
/// })?;
/// assert_eq!((last.status(), pull.len()), (Status::Certified, 3));
/// // It slid out, so that back where it was friction pushes the other way.
/// assert!(pull[0].abs() < 1e-9 && pull[1] < 0.0 && pull[2] > 0.0);
/// # Ok(())
/// # }
/// ```
///
/// `from` takes a history on after the step that it was saved at: bit for bit as if it had never
/// been left, on as many threads. What comes after that step may have changed in the scene, not
/// what led to it.
///
/// # Errors
///
/// Whatever is wrong with the scene or with a state that is not one of it, and what `each` returns.
pub fn solve_steps(
    scene: &Scene,
    from: Option<&SavedState>,
    mut each: impl FnMut(&Solution) -> Result<(), Error>,
) -> Result<Solution, Error> {
    let at_scene = |error| scene.locate(error);
    let mut mechanics = scene.mechanics()?;
    let bodies = match mechanics.rigid_bodies.as_slice() {
        [] => Fingerprint::of(&(&mechanics.bodies, &mechanics.contacts)),
        rigid => Fingerprint::of(&(&mechanics.bodies, &mechanics.contacts, rigid)),
    };
    let history = std::mem::take(&mut mechanics.history);
    let Some(&last) = history.instants().last() else {
        if from.is_some() {
            return Err(at_scene(not_of_this_scene("a state", "a scene with steps")));
        }
        let setup = Setup::of_one_state(scene, mechanics).map_err(at_scene)?;
        let solution = setup.solve().map_err(at_scene)?;
        each(&solution)?;
        return Ok(solution);
    };
    let setup = Setup::new(scene, mechanics).map_err(at_scene)?;
    let mut past = Past {
        bodies,
        state: State::at_rest(&setup),
        done: None,
        total: Ledger::default(),
    };
    let mut course = Course::new(setup, &history).map_err(at_scene)?;
    if let Some(saved) = from {
        past = past.restored(&mut course, saved).map_err(at_scene)?;
    }
    loop {
        let solution = past.next(&mut course).map_err(at_scene)?;
        each(&solution)?;
        let Some(step) = &solution.step else {
            return Ok(solution);
        };
        if step.at >= last || solution.status() != Status::Certified {
            return Ok(solution);
        }
        past = step.past();
    }
}

fn not_of_this_scene(found: impl Into<String>, accepted: impl Into<String>) -> Error {
    Error::NotAccepted {
        place: "state".to_owned(),
        found: found.into(),
        accepted: accepted.into(),
    }
}

/// What a step leaves to the next.
#[derive(Clone, Debug)]
struct Past {
    /// Of bodies and contacts.
    bodies: Fingerprint,
    state: State,
    /// Steps done and the instant of the last; none before the first.
    done: Option<(usize, f64)>,
    total: Ledger,
}

/// A load step that was solved.
#[derive(Clone, Debug)]
pub struct SolvedStep {
    number: usize,
    at: f64,
    driven: Vec<(String, f64)>,
    origins: Vec<[f64; 3]>,
    ledger: Ledger,
    total: Ledger,
    halving: Option<Halving>,
    bodies: Fingerprint,
    history: Fingerprint,
    state: State,
    start: Earlier,
}

impl Past {
    /// Where a saved state was.
    fn restored(self, course: &mut Course<'_>, saved: &SavedState) -> Result<Self, Error> {
        let instants = course.history.instants();
        let done = saved.steps.checked_sub(1);
        let at = done.and_then(|done| instants.get(done));
        if at != Some(&saved.at.0) || saved.steps == instants.len() {
            return Err(not_of_this_scene(
                format!("step {} at {}", saved.steps, saved.at.0),
                "an instant of the scene before its last, at the same place",
            ));
        }
        if saved.bodies != self.bodies {
            return Err(not_of_this_scene(
                "a state of other bodies or contacts",
                "meshes, materials, supports, loads, obstacles and friction as they were",
            ));
        }
        if saved.history != led_to(course.history, saved.steps) {
            return Err(not_of_this_scene(
                format!("other instants, factors or motions up to {}", saved.at.0),
                "the steps that led to it; those after it may change",
            ));
        }
        let problem = course.setup.condensed.problem();
        check_length("state.reaction", problem.unknowns(), saved.reaction.len())?;
        check_length("state.slip", problem.unknowns(), saved.slip.len())?;
        let rigid = course.setup.condensed.rigid_bodies().len();
        let locked: Vec<Option<f64>> = match saved.locked.is_empty() {
            true => vec![None; rigid],
            false => saved.locked.iter().map(|s| s.map(|s| s.0)).collect(),
        };
        check_length("state.locked", rigid, locked.len())?;
        let bodies = &course.setup.bodies;
        check_length(
            "state.displacements",
            bodies.len(),
            saved.displacements.len(),
        )?;
        for (index, (body, displacement)) in bodies.iter().zip(&saved.displacements).enumerate() {
            let unknowns = body.mesh.nodes.len() * body.mesh.dimension;
            let place = format!("state.displacements[{index}]");
            check_length(&place, unknowns, displacement.len())?;
        }
        let total = <[f64; 7]>::try_from(plain(&saved.ledger)).map_err(|found| Error::Length {
            place: "state.ledger".to_owned(),
            expected: 7,
            found: found.len(),
        })?;
        let displacements: Vec<_> = saved.displacements.iter().map(|u| plain(u)).collect();
        let (reaction, motion) = (plain(&saved.reaction), plain(&saved.motion));
        let state = course.state(
            saved.at.0,
            reaction,
            (motion, &locked),
            plain(&saved.slip),
            &displacements,
        )?;
        Ok(Self {
            state,
            done: Some((saved.steps, saved.at.0)),
            total: Ledger::from(total),
            ..self
        })
    }

    /// Solves the next step.
    fn next(self, course: &mut Course<'_>) -> Result<Solution, Error> {
        let (steps, from) = match self.done {
            None => (0, None),
            Some((steps, at)) => (steps, Some(at)),
        };
        let (path, halving) = course.step(&self.state, from, course.history.instants()[steps])?;
        let reached = path.last;
        let origins = self.state.origins(&reached.state);
        let step = SolvedStep {
            number: steps + 1,
            at: reached.at,
            driven: course.history.values(reached.at),
            origins,
            ledger: path.ledger,
            total: self.total.plus(&path.ledger),
            halving,
            bodies: self.bodies,
            history: led_to(course.history, steps + 1),
            state: reached.state,
            start: reached.start,
        };
        let setup = course.setup.clone();
        let mut solution = setup.measure(reached.outcome, reached.displacements)?;
        solution.step = Some(step);
        Ok(solution)
    }
}

/// Everything that steps before a number did to the bodies.
fn led_to(history: &LoadHistory, steps: usize) -> Fingerprint {
    let instants = history.instants().iter().take(steps);
    let states = instants.map(|&at| (at, history.values(at)));
    Fingerprint::of(&states.collect::<Vec<_>>())
}

impl Solution {
    /// The state, to take the history on from; none where the scene has no steps.
    #[must_use]
    pub fn saved_state(&self) -> Option<SavedState> {
        let step = self.step.as_ref()?;
        let locked = self.setup.condensed.locked();
        Some(SavedState {
            bodies: step.bodies,
            history: step.history,
            steps: step.number,
            at: Exact(step.at),
            reaction: exact(&self.outcome.reaction),
            motion: exact(&self.outcome.motion),
            locked: match locked.iter().any(Option::is_some) {
                true => locked.iter().map(|s| s.map(Exact)).collect(),
                false => Vec::new(),
            },
            slip: exact(step.state.slip()),
            displacements: self.displacements.iter().map(|u| exact(u)).collect(),
            ledger: exact(&step.total.entries()),
        })
    }
}

impl SolvedStep {
    /// From 1.
    #[must_use]
    pub fn number(&self) -> usize {
        self.number
    }

    /// Its instant.
    #[must_use]
    pub fn at(&self) -> f64 {
        self.at
    }

    /// Work and energy of this step, in joule.
    #[must_use]
    pub fn ledger(&self) -> Ledger {
        self.ledger
    }

    /// Work and energy since the start of the history, in joule.
    #[must_use]
    pub fn total(&self) -> Ledger {
        self.total
    }

    /// What its halving changed; none where steps are not halved.
    #[must_use]
    pub fn halving(&self) -> Option<Halving> {
        self.halving
    }

    /// Where it was solved from; the last of its parts, where it was halved.
    pub(super) fn start(&self) -> &Earlier {
        &self.start
    }

    /// Since the start of the history, in metre per contact unknown.
    pub(super) fn slip(&self) -> &[f64] {
        self.state.slip()
    }

    fn past(&self) -> Past {
        Past {
            bodies: self.bodies,
            state: self.state.clone(),
            done: Some((self.number, self.at)),
            total: self.total,
        }
    }

    pub(super) fn origins(&self) -> &[[f64; 3]] {
        &self.origins
    }

    pub(super) fn record(&self) -> report::ReportedStep {
        report::ReportedStep {
            number: self.number,
            at: self.at,
            driven: self.driven.clone(),
            ledger: self.ledger.into(),
            total: self.total.into(),
            halving: self.halving.map(|halving| halving.record()),
        }
    }
}
