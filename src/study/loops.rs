//! Loops against each other on one condensed problem.

use std::rc::Rc;
use std::time::Instant;

use super::active_set::WholeBodies;
use super::ladder::{Chosen, SHORT};
use super::plan::Plan;
use super::{Mixing, Sweeps, Variant};
use crate::alternation::{self, Outcome, Settings};
use crate::error::Error;
use crate::problem::ContactProblem;
use crate::report::{Part, StudiedRun};

/// Loops by name: the default first, the baseline last.
const LOOPS: [(&str, Way); 9] = [
    ("default", Way::Default),
    ("plain sweeps", Way::Loop(Variant::PLAIN)),
    ("plain, inexact", sweeps(Mixing::None, false, false)),
    ("relaxed by 1/2", sweeps(Mixing::Relaxed(0.5), true, false)),
    ("Anderson", sweeps(Mixing::Anderson, true, false)),
    ("Anderson, inexact", sweeps(Mixing::Anderson, false, false)),
    ("plain, inexact, finish", sweeps(Mixing::None, false, true)),
    ("full-cone fixed point", Way::Loop(Variant::FullCone)),
    ("NSGS", Way::Loop(Variant::Nsgs)),
];

/// Rivals, to every tolerance of the scene's friction; none of them needs nothing from the user.
const RIVALS: [(&str, Way); 6] = [
    ("primal alternation", Way::Loop(Variant::Panagiotopoulos)),
    (
        "augmented Lagrangian",
        Way::Loop(Variant::Augmented(AUGMENTED)),
    ),
    ("Newton from rest", Way::Loop(Variant::Newton)),
    PENALTIES[0],
    PENALTIES[1],
    ("active set, whole bodies", Way::ActiveSet),
];

/// On the condensed problem, and as finite-element codes do it.
const PENALTIES: [(&str, Way); 2] = [
    ("penalty", Way::Loop(Variant::Penalty(1.0))),
    ("penalty, whole bodies", Way::WholePenalty),
];

/// Who solves.
#[derive(Clone, Copy, PartialEq)]
enum Way {
    Default,
    /// On the condensed problem.
    Loop(Variant),
    /// Whole bodies (M9).
    ActiveSet,
    WholePenalty,
}

impl Way {
    fn is_whole(self) -> bool {
        matches!(self, Self::ActiveSet | Self::WholePenalty)
    }
}

/// Springs of the augmented Lagrangian over the contacts' own stiffness.
const AUGMENTED: f64 = 10.0;

const fn sweeps(mixing: Mixing, exact: bool, finish: bool) -> Way {
    Way::Loop(Variant::Sweeps(Sweeps {
        mixing,
        exact,
        finish,
    }))
}

/// Multiplications that the passes of one Gauss–Seidel solve may take: about ten seconds.
const MOST_WORK: f64 = 1e10;

/// Steps of whole bodies after which they give up.
const MOST_STEPS: usize = 40;

/// The solution that loops are held against is computed to this part of the tightest tolerance.
const CLOSER: f64 = 1e-2;

/// A problem, and the reaction that solves it as far as the default loop comes.
struct Reference {
    problem: ContactProblem,
    /// Coefficient for all contacts; none where they keep the scene's.
    friction: Option<f64>,
    reaction: Vec<f64>,
    /// Directions of each contact's unknowns; none where nobody asks for resultants.
    frames: Vec<[[f64; 3]; 3]>,
    /// Of (M9); none where the bodies are too large for it.
    whole: Option<WholeBodies>,
}

/// One loop on one problem to one tolerance.
pub(super) struct LoopRun<'a> {
    plan: &'a Plan,
    part: Part,
    mesh: usize,
    reference: Rc<Reference>,
    name: &'static str,
    way: Way,
    tolerance: f64,
    /// Springs over the contacts' own stiffness, where they do not follow the tolerance.
    parameter: Option<f64>,
}

/// The default and the baseline, to the loosest and the tightest tolerance.
pub(super) fn of_mesh<'a>(
    mesh: usize,
    problem: &ContactProblem,
    plan: &'a Plan,
) -> Result<Vec<LoopRun<'a>>, Error> {
    let part = Part::Meshes;
    let set = Set { part, mesh, plan };
    let reference = Reference::new(problem.clone(), None, plan)?.into();
    let ends = [LOOPS[0], LOOPS[LOOPS.len() - 1]];
    let (loosest, tightest) = tolerances(plan);
    let runs = [loosest, tightest].map(|tolerance| set.runs(&ends, &reference, tolerance));
    Ok(runs.into_iter().flatten().collect())
}

/// Every loop and rival to every tolerance, penalties of every size, then every loop with every coefficient of friction
/// to the tightest tolerance.
pub(super) fn all<'a>(chosen: &Chosen, plan: &'a Plan) -> Result<Vec<LoopRun<'a>>, Error> {
    let (mesh, problem) = (chosen.mesh, chosen.condensed.problem());
    let set = |part| Set { part, mesh, plan };
    let mut reference = Reference::new(problem.clone(), None, plan)?;
    let nodes = chosen.condensed.surface().nodes.iter();
    reference.frames = nodes.map(|node| node.frame).collect();
    reference.whole = WholeBodies::new(&chosen.condensed, chosen.axes);
    let reference = reference.into();
    let mut runs = Vec::new();
    for &tolerance in &plan.tolerances {
        runs.extend(set(Part::Loops).runs(&LOOPS, &reference, tolerance));
        runs.extend(set(Part::Rivals).runs(&RIVALS, &reference, tolerance));
    }
    for &parameter in &plan.penalties {
        let tried = set(Part::Penalties).runs(&PENALTIES, &reference, tolerances(plan).1);
        runs.extend(tried.into_iter().map(|run| LoopRun {
            parameter: Some(parameter),
            ..run
        }));
    }
    let has_tangents = problem.unknowns() > problem.contacts();
    for &friction in plan.friction.iter().filter(|_| has_tangents) {
        let blocks = problem.offsets().windows(2);
        let per_contact = blocks.map(|ends| if ends[1] - ends[0] > 1 { friction } else { 0.0 });
        let problem = problem.with_friction(per_contact.collect())?;
        let reference = Reference::new(problem, Some(friction), plan)?.into();
        runs.extend(set(Part::Friction).runs(&LOOPS, &reference, tolerances(plan).1));
    }
    Ok(runs)
}

/// Runs that belong together.
struct Set<'a> {
    part: Part,
    mesh: usize,
    plan: &'a Plan,
}

impl<'a> Set<'a> {
    /// The loops on one problem; those for study do not know bodies that float.
    fn runs(
        &self,
        loops: &[(&'static str, Way)],
        reference: &Rc<Reference>,
        tolerance: f64,
    ) -> Vec<LoopRun<'a>> {
        let floats = reference.problem.floating().is_some();
        let known = |way: Way| match way.is_whole() {
            true => reference.whole.is_some(),
            false => !floats || way == Way::Default,
        };
        let loops = loops.iter().filter(|(_, way)| known(*way));
        let run = |&(name, way): &(&'static str, Way)| LoopRun {
            part: self.part,
            mesh: self.mesh,
            plan: self.plan,
            reference: Rc::clone(reference),
            name,
            way,
            tolerance,
            parameter: None,
        };
        loops.map(run).collect()
    }
}

/// Loosest and tightest.
fn tolerances(plan: &Plan) -> (f64, f64) {
    let all = plan.tolerances.iter().copied();
    (all.clone().fold(0.0, f64::max), all.fold(1.0, f64::min))
}

impl Reference {
    fn new(problem: ContactProblem, friction: Option<f64>, plan: &Plan) -> Result<Self, Error> {
        let settings = Settings {
            tolerance: (CLOSER * tolerances(plan).1).max(1e-15),
            max_sweeps: plan.sweeps,
            ..Settings::default()
        };
        let reaction = alternation::solve(&problem, &settings)?.reaction;
        Ok(Self {
            problem,
            friction,
            reaction,
            frames: Vec::new(),
            whole: None,
        })
    }

    /// (M2) of a reaction; NaN without any reaction.
    fn distance(&self, reaction: &[f64]) -> f64 {
        let difference = reaction.iter().zip(&self.reaction).map(|(a, b)| a - b);
        (self.energy(&difference.collect::<Vec<_>>()) / self.energy(&self.reaction)).sqrt()
    }

    /// How far the resultant of friction is off, relative to it; NaN without any.
    fn friction_error(&self, reaction: &[f64]) -> f64 {
        let resultant = |reaction: &[f64]| {
            let mut sum = [0.0; 3];
            for (frame, block) in self.frames.iter().zip(self.problem.blocks()) {
                for (axis, t) in frame.iter().zip(&reaction[block]).skip(1) {
                    (0..3).for_each(|k| sum[k] += axis[k] * t);
                }
            }
            sum
        };
        let size = |sum: [f64; 3]| sum.iter().fold(0.0, |s: f64, x| s.hypot(*x));
        let (found, exact) = (resultant(reaction), resultant(&self.reaction));
        size([0, 1, 2].map(|k| found[k] - exact[k])) / size(exact)
    }

    /// `t · G t`, in joule.
    fn energy(&self, reaction: &[f64]) -> f64 {
        let columns = self.problem.compliance().col_iter().zip(reaction);
        columns
            .map(|(column, t)| t * column.iter().zip(reaction).map(|(g, s)| g * s).sum::<f64>())
            .sum()
    }
}

impl LoopRun<'_> {
    /// The run in words.
    pub(super) fn name(&self) -> String {
        match (self.reference.friction, self.parameter) {
            (None, None) => format!("{} to {:.0e}", self.name, self.tolerance),
            (None, Some(parameter)) => format!("{} of {parameter:.0e}", self.name),
            (Some(friction), _) => format!("{} with friction {friction}", self.name),
        }
    }

    /// Runs the loop, several times if that is short.
    pub(super) fn run(&self) -> Result<StudiedRun, Error> {
        let (mut outcome, mut seconds) = self.timed()?;
        let mut all = vec![seconds];
        while all.len() < self.plan.repetitions && seconds < SHORT {
            (outcome, seconds) = self.timed()?;
            all.push(seconds);
        }
        all.sort_by(f64::total_cmp);
        let certificate = &outcome.verdict.certificate;
        let gap = certificate.bipotential_gap.max(0.0) / certificate.reaction_energy;
        Ok(StudiedRun {
            part: self.part,
            mesh: self.mesh,
            name: self.name,
            friction: self.reference.friction,
            tolerance: self.tolerance,
            parameter: self.parameter,
            whole: self.way.is_whole(),
            status: outcome.status.into(),
            natural_map: certificate.natural_map,
            energy_gap: gap.sqrt(),
            distance: self.reference.distance(&outcome.reaction),
            friction_error: self.reference.friction_error(&outcome.reaction),
            contacts: self.reference.problem.contacts(),
            sweeps: if self.is_baseline() {
                0
            } else {
                outcome.work.sweeps
            },
            passes: outcome.work.passes,
            newton_steps: outcome.work.newton_steps,
            cone_iterations: outcome.work.cone_iterations,
            seconds: all[all.len() / 2],
            course: self.course(&outcome),
        })
    }

    /// The seconds of Gauss–Seidel are those of its passes alone, without the judge.
    fn timed(&self) -> Result<(Outcome, f64), Error> {
        let problem = &self.reference.problem;
        let settings = Settings {
            tolerance: self.tolerance,
            max_sweeps: self.most_sweeps(),
            ..Settings::default()
        };
        let start = Instant::now();
        // A penalty has no tolerance: it is as near as its springs are stiff.
        let springs = self.parameter.unwrap_or(self.tolerance.sqrt().recip());
        let whole = self
            .reference
            .whole
            .as_ref()
            .filter(|_| self.way.is_whole());
        let outcome = match (self.way, whole) {
            (Way::WholePenalty, Some(whole)) => whole.solve(problem, &settings, Some(springs))?,
            (_, Some(whole)) => whole.solve(problem, &settings, None)?,
            (Way::Loop(Variant::Penalty(_)), None) => {
                Variant::Penalty(springs).solve(problem, &settings)?
            }
            (Way::Loop(variant), None) => variant.solve(problem, &settings)?,
            (_, None) => alternation::solve(problem, &settings)?,
        };
        let seconds = match self.is_baseline() {
            true => outcome.work.seconds.predict,
            false => start.elapsed().as_secs_f64(),
        };
        Ok((outcome, seconds))
    }

    fn is_baseline(&self) -> bool {
        self.way == Way::Loop(Variant::Nsgs)
    }

    fn most_sweeps(&self) -> usize {
        if !self.is_baseline() {
            let most = if self.way.is_whole() {
                MOST_STEPS
            } else {
                usize::MAX
            };
            return self.plan.sweeps.min(most);
        }
        let work = (self.reference.problem.unknowns() as f64).powi(2);
        self.plan.passes.min((MOST_WORK / work).ceil() as usize)
    }

    /// Seconds since the start and the judge's residual, wherever that was asked.
    fn course(&self, outcome: &Outcome) -> Vec<[f64; 2]> {
        let mut at = match self.is_baseline() {
            true => 0.0,
            false => outcome.work.seconds.predict,
        };
        let mut course: Vec<[f64; 2]> = Vec::new();
        for sweep in &outcome.history {
            at += sweep.seconds;
            if course.last().is_none_or(|last| last[1] != sweep.residual) {
                course.push([at, sweep.residual]);
            }
        }
        course
    }
}
