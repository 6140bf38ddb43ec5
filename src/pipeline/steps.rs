//! Load histories: one state after the other on one factorisation.

use super::{Setup, Solution};
use crate::condensation::Condensed;
use crate::dpana::{self, Outcome, Status};
use crate::error::{Error, check_length};
use crate::kkt::{Account, ContactStep, Ledger, relative_displacement};
use crate::report;
use crate::scene::{Exact, LoadHistory, SavedState, Scene, exact, plain};

/// Solves a scene state by state and shows each to `each`; ends after the last instant, or with the
/// first state that is not certified, and returns that state.
///
/// `from` takes a history on after the step that it was saved at: bit for bit as if it had never
/// been left, on as many threads.
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
    let history = std::mem::take(&mut mechanics.history);
    let mut setup = Setup::new(scene, mechanics).map_err(at_scene)?;
    let Some(&last) = history.instants().last() else {
        if from.is_some() {
            return Err(at_scene(not_of_this_scene("a state", "a scene with steps")));
        }
        let problem = setup.condensed.problem();
        let outcome = dpana::solve(problem, &setup.settings).map_err(at_scene)?;
        let solution = setup.recover(outcome)?;
        each(&solution)?;
        return Ok(solution);
    };
    let mut past = match from {
        None => Past::new(&setup),
        Some(saved) => Past::restored(&mut setup, &history, saved).map_err(at_scene)?,
    };
    loop {
        let solution = past.next(setup, &history).map_err(at_scene)?;
        each(&solution)?;
        let step = solution.step.as_ref();
        let at_end = step.is_none_or(|step| step.at >= last);
        if at_end || solution.status() != Status::Certified {
            return Ok(solution);
        }
        (past, setup) = solution.leave();
    }
}

fn not_of_this_scene(found: impl Into<String>, accepted: impl Into<String>) -> Error {
    Error::NotAccepted {
        place: "state".to_owned(),
        found: found.into(),
        accepted: accepted.into(),
    }
}

/// What a state leaves to the next.
#[derive(Debug)]
struct Past {
    steps: usize,
    reaction: Vec<f64>,
    motion: Vec<f64>,
    /// Per contact unknown since the start of the history, in metre.
    slip: Vec<f64>,
    /// Relative displacement per contact in global axes, to obstacles where they are, in metre.
    relative: Vec<[f64; 3]>,
    /// Motion of the obstacle per contact pair, in metre.
    obstacles: Vec<[f64; 3]>,
    /// None before the first step.
    account: Option<Account>,
    total: Ledger,
}

/// A load step that was solved.
#[derive(Debug)]
pub struct SolvedStep {
    number: usize,
    at: f64,
    driven: Vec<(String, f64)>,
    origins: Vec<[f64; 3]>,
    slip: Vec<f64>,
    obstacles: Vec<[f64; 3]>,
    account: Account,
    ledger: Ledger,
    total: Ledger,
}

impl Past {
    /// Before the first step.
    fn new(setup: &Setup) -> Self {
        let problem = setup.condensed.problem();
        Self {
            steps: 0,
            reaction: vec![0.0; problem.unknowns()],
            motion: vec![0.0; problem.free_modes()],
            slip: vec![0.0; problem.unknowns()],
            relative: vec![[0.0; 3]; problem.contacts()],
            obstacles: vec![[0.0; 3]; setup.pairs.len()],
            account: None,
            total: Ledger::default(),
        }
    }

    /// Where a saved state was.
    fn restored(
        setup: &mut Setup,
        history: &LoadHistory,
        saved: &SavedState,
    ) -> Result<Self, Error> {
        let done = saved.steps.checked_sub(1);
        let at = done.and_then(|done| history.instants().get(done));
        if at != Some(&saved.at.0) || saved.steps == history.instants().len() {
            return Err(not_of_this_scene(
                format!("step {} at {}", saved.steps, saved.at.0),
                "an instant of the scene before its last, at the same place",
            ));
        }
        let problem = setup.condensed.problem();
        check_length("state.reaction", problem.unknowns(), saved.reaction.len())?;
        check_length("state.slip", problem.unknowns(), saved.slip.len())?;
        check_length("state.motion", problem.free_modes(), saved.motion.len())?;
        check_length(
            "state.displacements",
            setup.bodies.len(),
            saved.displacements.len(),
        )?;
        for (index, (body, displacement)) in
            setup.bodies.iter().zip(&saved.displacements).enumerate()
        {
            let unknowns = body.mesh.nodes.len() * body.mesh.dimension;
            let place = format!("state.displacements[{index}]");
            check_length(&place, unknowns, displacement.len())?;
        }
        let total = <[f64; 6]>::try_from(plain(&saved.ledger)).map_err(|found| Error::Length {
            place: "state.ledger".to_owned(),
            expected: 6,
            found: found.len(),
        })?;
        let (reaction, slip) = (plain(&saved.reaction), plain(&saved.slip));
        let displacements: Vec<_> = saved.displacements.iter().map(|u| plain(u)).collect();
        let moved = history.obstacles(saved.at.0);
        history.apply(saved.at.0, &mut setup.bodies);
        setup.condensed.act(&setup.bodies, &moved, &slip)?;
        Ok(Self {
            steps: saved.steps,
            motion: plain(&saved.motion),
            relative: relative(setup, &displacements, &moved),
            obstacles: moved,
            account: Some(Account::new(&setup.body_states(&reaction, &displacements))?),
            total: Ledger::from(total),
            reaction,
            slip,
        })
    }

    /// Solves the next step.
    fn next(self, mut setup: Setup, history: &LoadHistory) -> Result<Solution, Error> {
        let at = history.instants()[self.steps];
        let obstacles = history.obstacles(at);
        history.apply(at, &mut setup.bodies);
        setup.condensed.act(&setup.bodies, &obstacles, &self.slip)?;
        let outcome = self.solve(&setup)?;
        let slip = setup
            .condensed
            .slip(&outcome.verdict.displacement, &self.slip);
        let moved = moved(&setup.condensed, &self.obstacles, &obstacles);
        let mut solution = setup.recover(outcome)?;
        let (setup, outcome) = (&solution.setup, &solution.outcome);
        let account = Account::new(&setup.body_states(&outcome.reaction, &solution.displacements))?;
        let ledger = Ledger::new(
            self.account.as_ref().unwrap_or(&account.at_rest()),
            &account,
            &ContactStep {
                problem: setup.condensed.problem(),
                reaction: [&self.reaction, &outcome.reaction],
                displacement: &outcome.verdict.displacement,
                moved: &moved,
            },
        )?;
        solution.step = Some(SolvedStep {
            number: self.steps + 1,
            at,
            driven: history.driven(at),
            origins: origins(&setup.condensed, &self.relative, &obstacles),
            slip,
            obstacles,
            account,
            ledger,
            total: self.total.plus(&ledger),
        });
        Ok(solution)
    }

    fn solve(&self, setup: &Setup) -> Result<Outcome, Error> {
        let (problem, settings) = (setup.condensed.problem(), &setup.settings);
        match self.steps {
            0 => dpana::solve(problem, settings),
            _ => dpana::solve_from(problem, settings, &self.reaction, &self.motion),
        }
    }
}

impl Solution {
    /// What the next step needs.
    fn leave(self) -> (Past, Setup) {
        let setup = self.setup;
        let past = match self.step {
            None => Past::new(&setup),
            Some(step) => Past {
                steps: step.number,
                relative: relative(&setup, &self.displacements, &step.obstacles),
                reaction: self.outcome.reaction,
                motion: self.outcome.motion,
                slip: step.slip,
                obstacles: step.obstacles,
                account: Some(step.account),
                total: step.total,
            },
        };
        (past, setup)
    }

    /// The state, to take the history on from; none where the scene has no steps.
    #[must_use]
    pub fn saved_state(&self) -> Option<SavedState> {
        let step = self.step.as_ref()?;
        Some(SavedState {
            steps: step.number,
            at: Exact(step.at),
            reaction: exact(&self.outcome.reaction),
            motion: exact(&self.outcome.motion),
            slip: exact(&step.slip),
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

    pub(super) fn origins(&self) -> &[[f64; 3]] {
        &self.origins
    }

    pub(super) fn record(&self) -> report::Step {
        report::Step {
            number: self.number,
            at: self.at,
            driven: self.driven.clone(),
            ledger: self.ledger.into(),
            total: self.total.into(),
        }
    }
}

/// Displacement of each contact relative to its other side where that is now, in metre.
fn relative(setup: &Setup, displacements: &[Vec<f64>], obstacles: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let dimension = setup.bodies.first().map_or(3, |body| body.mesh.dimension);
    let contacts = setup.condensed.surface().nodes.iter();
    contacts
        .zip(setup.condensed.surface().obstacle_motions(obstacles))
        .map(|(contact, d)| {
            let u = relative_displacement(contact, displacements, dimension);
            [0, 1, 2].map(|axis| u[axis] - d[axis])
        })
        .collect()
}

/// Where the slip of a step counts from, per contact in global axes, in metre.
fn origins(condensed: &Condensed, relative: &[[f64; 3]], obstacles: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let moved = condensed.surface().obstacle_motions(obstacles);
    let contacts = relative.iter().zip(moved);
    contacts
        .map(|(u, d)| [0, 1, 2].map(|axis| u[axis] + d[axis]))
        .collect()
}

/// Motion of the other side from one state to the next, in metre per contact unknown.
fn moved(condensed: &Condensed, before: &[[f64; 3]], after: &[[f64; 3]]) -> Vec<f64> {
    let surface = condensed.surface();
    let motions = surface.obstacle_motions(before).into_iter();
    let motions = motions.zip(surface.obstacle_motions(after));
    let contacts = surface.nodes.iter();
    contacts
        .zip(motions)
        .flat_map(|(contact, (before, after))| {
            let rows = contact.frame[..=contact.tangents].iter();
            rows.map(move |row| (0..3).map(|k| row[k] * (after[k] - before[k])).sum())
        })
        .collect()
}
