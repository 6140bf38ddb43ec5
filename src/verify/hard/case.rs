//! One hard case: how it is posed, how it has to end, what is known of its answer.

use std::time::Instant;

use super::Reach;
use crate::alternation::{Outcome, Settings, Status};
use crate::error::Error;
use crate::pipeline::Solution;
use crate::problem::ContactProblem;
use crate::report::HardCase;
use crate::scene::Scene;
use crate::{alternation, pipeline};

/// A case of the battery.
pub(super) struct Case {
    family: &'static str,
    name: String,
    reach: Reach,
    posed: Posed,
    expected: Status,
    truths: Vec<Truth>,
}

/// A scene, or a problem that is condensed already.
enum Posed {
    Scene(Box<Scene>),
    Bare(Box<ContactProblem>),
}

/// A solved case.
pub(super) struct Answer {
    pub(super) problem: ContactProblem,
    pub(super) outcome: Outcome,
    /// None for a problem without bodies.
    pub(super) solution: Option<Solution>,
    seconds: [f64; 2],
}

/// How far an answer is from a truth, relative.
type Measure = Box<dyn Fn(&Answer) -> Result<f64, Error>>;

/// Something that is known of an answer.
struct Truth {
    what: &'static str,
    within: f64,
    error: Measure,
}

impl Case {
    /// A scene that has a certified answer.
    pub(super) fn scene(family: &'static str, name: String, scene: Scene) -> Self {
        Self::new(family, name, Posed::Scene(Box::new(scene)))
    }

    /// A bare problem that has a certified answer.
    pub(super) fn bare(family: &'static str, name: String, problem: ContactProblem) -> Self {
        Self::new(family, name, Posed::Bare(Box::new(problem)))
    }

    fn new(family: &'static str, name: String, posed: Posed) -> Self {
        Self {
            family,
            name,
            reach: Reach::Coarse,
            posed,
            expected: Status::Certified,
            truths: Vec::new(),
        }
    }

    pub(super) fn reach(self, reach: Reach) -> Self {
        Self { reach, ..self }
    }

    pub(super) fn ends(self, expected: Status) -> Self {
        Self { expected, ..self }
    }

    /// Adds a truth: `error`, relative, is at most `within`.
    pub(super) fn knows(
        mut self,
        what: &'static str,
        within: f64,
        error: impl Fn(&Answer) -> Result<f64, Error> + 'static,
    ) -> Self {
        self.truths.push(Truth {
            what,
            within,
            error: Box::new(error),
        });
        self
    }

    /// Adds that the reactions are `factor` times those of another scene.
    pub(super) fn like(self, what: &'static str, within: f64, factor: f64, twin: Scene) -> Self {
        self.knows(what, within, move |answer| {
            let twin = pipeline::solve(&twin)?;
            let expected: Vec<f64> = twin.outcome().reaction.iter().map(|t| factor * t).collect();
            Ok(apart(&answer.outcome.reaction, &expected))
        })
    }

    /// Adds that the contacts push with this force along their normals, in newton, all together.
    pub(super) fn presses(self, within: f64, force: f64) -> Self {
        self.knows("normal force", within, move |answer| {
            Ok((-answer.normal() / force - 1.0).abs())
        })
    }

    pub(super) fn is_within(&self, reach: Reach) -> bool {
        match reach {
            Reach::Coarse => self.reach == Reach::Coarse,
            Reach::All => self.reach != Reach::Largest,
            Reach::Largest => self.reach == Reach::Largest,
        }
    }

    /// Solves it, and holds the answer against what is known.
    pub(super) fn solve(&self) -> Result<HardCase, Error> {
        let answer = self
            .posed
            .solve()
            .map_err(|error| error.within(format!("{}, {}", self.family, self.name)))?;
        let outcome = &answer.outcome;
        let mut missed = Vec::new();
        if outcome.status != self.expected {
            let reason = outcome.shortfall;
            missed.push(format!("ends {:?}, {reason:?}", outcome.status));
        }
        // A state without certificate claims nothing that could be wrong.
        let claims = matches!(outcome.status, Status::Certified | Status::NoEquilibrium);
        for truth in self.truths.iter().filter(|_| claims) {
            let error = (truth.error)(&answer)?;
            if error.is_nan() || error > truth.within {
                missed.push(format!("{} off by {error:.1e}", truth.what));
            }
        }
        Ok(HardCase {
            family: self.family,
            name: self.name.clone(),
            contacts: answer.problem.contacts(),
            status: outcome.status.into(),
            residual: outcome.verdict.certificate.residual(),
            condition: outcome.condition,
            sweeps: outcome.work.sweeps,
            newton_steps: outcome.work.newton_steps,
            contact_seconds: answer.seconds[0],
            seconds: answer.seconds[1],
            missed,
        })
    }
}

impl Posed {
    fn solve(&self) -> Result<Answer, Error> {
        let start = Instant::now();
        let (problem, outcome, solution) = match self {
            Self::Scene(scene) => {
                let solution = pipeline::solve(scene)?;
                let problem = solution.precise()?.problem().clone();
                (problem, solution.outcome().clone(), Some(solution))
            }
            Self::Bare(problem) => {
                let outcome = alternation::solve(problem, &Settings::default())?;
                (problem.as_ref().clone(), outcome, None)
            }
        };
        let spent = outcome.work.seconds;
        let contact = spent.predict
            + spent.coulomb
            + spent.normal
            + spent.friction
            + spent.finish
            + spent.judge;
        Ok(Answer {
            problem,
            outcome,
            solution,
            seconds: [contact, start.elapsed().as_secs_f64()],
        })
    }
}

impl Answer {
    /// Sum of normal reactions, in newton.
    pub(super) fn normal(&self) -> f64 {
        let normals = self.problem.normals().iter();
        normals.map(|&n| self.outcome.reaction[n]).sum()
    }

    /// Sum of the first tangential reactions, in newton.
    pub(super) fn friction(&self) -> f64 {
        let first = self.problem.blocks().filter(|block| block.len() > 1);
        first
            .map(|block| self.outcome.reaction[block.start + 1])
            .sum()
    }

    /// Force of the supports on a body along an axis, in newton; not a number without bodies.
    pub(super) fn held(&self, body: usize, axis: usize) -> f64 {
        let balances = self.solution.as_ref().map(Solution::balances);
        let body = balances.and_then(|balances| balances.get(body));
        body.map_or(f64::NAN, |body| body.supports.force[axis])
    }
}

/// Largest difference over the largest entry; infinite if there is nothing to compare with.
pub(super) fn apart(found: &[f64], expected: &[f64]) -> f64 {
    if found.len() != expected.len() {
        return f64::INFINITY;
    }
    let largest = expected.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let pairs = found.iter().zip(expected);
    let apart = pairs.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
    if apart == 0.0 { 0.0 } else { apart / largest }
}
