//! From one state of a load history to a later one, in one solve.

use std::sync::Arc;

use super::Setup;
use crate::alternation;
use crate::alternation::{Outcome, Status};
use crate::condensation::Superposition;
use crate::contact::ContactSurface;
use crate::error::{Error, check_length};
use crate::kkt::{Account, ContactStep, Ledger, relative_displacement};
use crate::problem::ContactProblem;
use crate::scene::LoadHistory;
use crate::trust::Earlier;

/// Bodies on their way through a load history.
pub(super) struct Course<'a> {
    pub(super) setup: Setup,
    pub(super) history: &'a LoadHistory,
    under: Superposition,
}

/// What the next solve needs of a state.
#[derive(Clone, Debug)]
pub(super) struct State {
    reaction: Vec<f64>,
    /// Per mode that is free from here on, in metre.
    motion: Vec<f64>,
    /// Per contact unknown since the start of the history, in metre.
    slip: Vec<f64>,
    /// Relative displacement per contact in global axes, to obstacles where they are, in metre.
    relative: Vec<[f64; 3]>,
    /// Motion of a rigid other side per contact, in metre.
    others: Vec<[f64; 3]>,
    /// Initial gap per contact, in metre.
    gaps: Vec<f64>,
    /// Shortening per rigid body at which its cut is locked from here on, in metre.
    locked: Vec<Option<f64>>,
    /// None at rest.
    account: Option<Arc<Account>>,
}

/// A state that was solved for, and how it was reached.
pub(super) struct Reached {
    pub(super) at: f64,
    pub(super) outcome: Outcome,
    pub(super) displacements: Vec<Vec<f64>>,
    pub(super) state: State,
    pub(super) ledger: Ledger,
    /// Where it was reached from.
    pub(super) start: Earlier,
}

impl<'a> Course<'a> {
    /// Bodies as they were condensed, at rest.
    pub(super) fn new(mut setup: Setup, history: &'a LoadHistory) -> Result<Self, Error> {
        let (condensed, driven) = (&mut setup.condensed, history.driven());
        let under = condensed.superpose(&setup.bodies, &driven)?;
        Ok(Self {
            setup,
            history,
            under,
        })
    }

    /// Puts the bodies under what acts at an instant, with the slip so far and what is locked; returns the motion
    /// of the obstacles.
    fn act(
        &mut self,
        at: f64,
        slip: &[f64],
        locked: &[Option<f64>],
    ) -> Result<Vec<[f64; 3]>, Error> {
        let (factors, obstacles) = (self.history.factors(at), self.history.obstacles(at));
        let condensed = &mut self.setup.condensed;
        condensed.lock(locked)?;
        if let Some(openings) = self.history.openings(at) {
            condensed.open(&openings)?;
            self.setup.acting.openings = openings;
        }
        condensed.act(&self.under, &factors, &obstacles, slip)?;
        self.setup.acting.obstacles.clone_from(&obstacles);
        let driven = self.history.driven();
        self.setup.stress_under(&driven, &factors);
        Ok(obstacles)
    }

    /// A state that was solved for before, with these cuts locked.
    pub(super) fn state(
        &mut self,
        at: f64,
        reaction: Vec<f64>,
        (motion, locked): (Vec<f64>, &[Option<f64>]),
        slip: Vec<f64>,
        displacements: &[Vec<f64>],
    ) -> Result<State, Error> {
        let obstacles = self.act(at, &slip, locked)?;
        let free = self.setup.condensed.problem().free_modes();
        check_length("state.motion", free, motion.len())?;
        let others = self.setup.condensed.other_sides(&obstacles, &motion);
        let (locked, motion) = self.setup.condensed.locks_from(at, &motion);
        let account = Account::new(&self.setup.body_states(&reaction, displacements))?;
        Ok(State {
            relative: self.setup.relative(displacements, &others),
            account: Some(Arc::new(account)),
            reaction,
            motion,
            slip,
            others,
            locked,
            gaps: self.setup.condensed.problem().initial_gap().to_vec(),
        })
    }

    /// Solves the state at an instant from an earlier one; the bodies stay under what acts then.
    pub(super) fn solve(&mut self, from: &State, at: f64) -> Result<Reached, Error> {
        let obstacles = self.act(at, &from.slip, &from.locked)?;
        let settings = &self.setup.settings;
        let problem = self.setup.condensed.problem();
        let outcome = match from.account {
            None => alternation::solve(problem, settings)?,
            Some(_) => alternation::solve_from(problem, settings, &from.reaction, &from.motion)?,
        };
        let (outcome, displacements) = self.setup.displacements(outcome)?;
        let (setup, displacement) = (&self.setup, &outcome.verdict.displacement);
        let (condensed, problem) = (&setup.condensed, setup.condensed.problem());
        let others = condensed.other_sides(&obstacles, &outcome.motion);
        let account = Account::new(&setup.body_states(&outcome.reaction, &displacements))?;
        let at_rest = match from.account {
            None => Some(account.at_rest()),
            Some(_) => None,
        };
        let before = at_rest.as_ref().or(from.account.as_deref());
        let ledger = Ledger::new(
            before.unwrap_or(&account),
            &account,
            &ContactStep {
                problem,
                reaction: [&from.reaction, &outcome.reaction],
                displacement,
                moved: &moved(condensed.surface(), &from.others, &others),
                opened: &from.opened(problem, condensed.surface()),
                assembles: from.account.is_none(),
            },
        )?;
        let (locked, motion) = condensed.locks_from(at, &outcome.motion);
        let state = State {
            reaction: outcome.reaction.clone(),
            motion,
            locked,
            slip: condensed.slip(displacement, &from.slip),
            relative: setup.relative(&displacements, &others),
            others,
            gaps: problem.initial_gap().to_vec(),
            account: Some(Arc::new(account)),
        };
        Ok(Reached {
            start: from.seen_from(problem, condensed.surface()),
            at,
            outcome,
            displacements,
            state,
            ledger,
        })
    }
}

impl State {
    /// Before the first step.
    pub(super) fn at_rest(setup: &Setup) -> Self {
        let problem = setup.condensed.problem();
        Self {
            reaction: vec![0.0; problem.unknowns()],
            motion: vec![0.0; problem.free_modes()],
            locked: setup.condensed.locked().to_vec(),
            slip: vec![0.0; problem.unknowns()],
            relative: vec![[0.0; 3]; problem.contacts()],
            others: vec![[0.0; 3]; problem.contacts()],
            gaps: problem.initial_gap().to_vec(),
            account: None,
        }
    }

    pub(super) fn slip(&self) -> &[f64] {
        &self.slip
    }

    /// What a step from here on sees of it, under its own reference (C13).
    fn seen_from(&self, problem: &ContactProblem, surface: &ContactSurface) -> Earlier {
        if self.account.is_none() {
            return Earlier::rest(problem);
        }
        let mut displacement = vec![0.0; problem.unknowns()];
        let gaps = self.gaps.iter().zip(problem.initial_gap());
        let contacts = self.approaches(surface).zip(gaps);
        let layers = problem.layers();
        for (&n, (approach, (before, gap))) in problem.normals().iter().zip(contacts) {
            // What is left of the gap is the same.
            displacement[n] = approach + layers[n] * self.reaction[n] + (gap - before);
        }
        Earlier {
            reaction: self.reaction.clone(),
            displacement,
            motion: self.motion.clone(),
        }
    }

    /// Displacement of each contact along its normal, in metre.
    fn approaches<'a>(&'a self, surface: &'a ContactSurface) -> impl Iterator<Item = f64> + 'a {
        let contacts = surface.nodes.iter().zip(&self.relative);
        contacts.map(|(contact, relative)| {
            let along = contact.frame[0].iter().zip(relative);
            along.map(|(axis, u)| axis * u).sum()
        })
    }

    /// How far a gap that changes from here to a later problem moves each contact, in metre: all of the
    /// change where it is pressed, and where it is open what no displacement leaves room for.
    fn opened(&self, problem: &ContactProblem, surface: &ContactSurface) -> Vec<f64> {
        let normals = problem.normals().iter().enumerate();
        let gaps = self.gaps.iter().zip(problem.initial_gap());
        let contacts = normals.zip(self.approaches(surface)).zip(gaps);
        contacts
            .map(|(((contact, &n), approach), (before, gap))| {
                // A bond goes wherever its gap does.
                let follows = self.reaction[n] < 0.0 || problem.is_bilateral(contact);
                match (gap == before, follows) {
                    (true, _) => 0.0,
                    (false, true) => gap - before,
                    (false, false) => (gap - approach).min(0.0),
                }
            })
            .collect()
    }

    /// Elastic energy of all bodies, in joule.
    pub(super) fn elastic(&self) -> f64 {
        self.account
            .as_ref()
            .map_or(0.0, |account| account.elastic())
    }

    /// Where the slip from here to a later state counts from, per contact in global axes, in metre.
    pub(super) fn origins(&self, later: &Self) -> Vec<[f64; 3]> {
        let contacts = self.relative.iter().zip(&later.others);
        contacts
            .map(|(u, d)| [0, 1, 2].map(|axis| u[axis] + d[axis]))
            .collect()
    }
}

impl Reached {
    pub(super) fn is_certified(&self) -> bool {
        self.outcome.status == Status::Certified
    }
}

impl Setup {
    /// Displacement of each contact relative to its other side where that is now, in metre.
    fn relative(&self, displacements: &[Vec<f64>], others: &[[f64; 3]]) -> Vec<[f64; 3]> {
        let dimension = self.bodies.first().map_or(3, |body| body.mesh.dimension);
        let contacts = self.condensed.surface().nodes.iter();
        contacts
            .zip(others)
            .map(|(contact, d)| {
                let u = relative_displacement(contact, displacements, dimension);
                [0, 1, 2].map(|axis| u[axis] - d[axis])
            })
            .collect()
    }
}

/// Motion of the other side from one state to the next, in metre per contact unknown.
fn moved(surface: &ContactSurface, before: &[[f64; 3]], after: &[[f64; 3]]) -> Vec<f64> {
    let motions = before.iter().zip(after);
    let contacts = surface.nodes.iter();
    contacts
        .zip(motions)
        .flat_map(|(contact, (before, after))| {
            let rows = contact.frame[..=contact.tangents].iter();
            rows.map(move |row| (0..3).map(|k| row[k] * (after[k] - before[k])).sum())
        })
        .collect()
}
