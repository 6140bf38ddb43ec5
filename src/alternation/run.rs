//! The named steps of a solve, and the state they share.

use std::time::Instant;

use super::anderson::Anderson;
use super::condition::condition;
use super::finish::Finish;
use super::gauss_seidel::GaussSeidel;
use super::iterate::{Iterate, Step};
use super::prediction::Roles;
use super::{
    Failure, Mixing, Outcome, Settings, Shortfall, Status, SweepRecord, Variant, Work, exact,
};
use crate::cone::{CoulombProgram, FrictionHalfStep, HalfStepWork, NormalHalfStep};
use crate::kkt::{ContactStatus, Judge};
use crate::problem::ContactProblem;

/// The prediction stops when a pass changes the reaction by less than this, relative.
const PREDICTED: f64 = 1e-2;

/// Passes of the prediction at most.
const PREDICTION_PASSES: usize = 40;

/// Cone programs are solved to this part of the outer residual.
const INEXACT: f64 = 1e-1;

/// Tolerances of cone programs: the tightest and the loosest.
const CONE_TOLERANCE: (f64, f64) = (1e-12, 1e-2);

/// Newton steps after a sweep at most, and how many may pass without a better state.
const NEWTON_STEPS: (usize, usize) = (12, 3);

/// Sweeps without a better state after which the solve gives up.
const PATIENCE: usize = 30;

/// A residual below this many times what round-off may leave, and not improved by so many sweeps,
/// is round-off.
const ROUNDED: f64 = 4.0;
const UNIMPROVED: usize = 2;

/// A solve in progress.
pub(super) struct Run<'a> {
    pub(super) problem: &'a ContactProblem,
    settings: &'a Settings,
    judge: Judge<'a>,
    pub(super) normal: NormalHalfStep<'a>,
    friction: FrictionHalfStep<'a>,
    gauss_seidel: GaussSeidel<'a>,
    /// Shift of the last program over all Coulomb cones, in metre per contact.
    pub(super) shift: Vec<f64>,
    pub(super) anderson: Anderson,
    roles: Roles,
    pub(super) coulomb: Option<CoulombProgram<'a>>,
    finish: Option<Finish<'a>>,
    /// The iterate.
    pub(super) state: Iterate,
    /// The state of least residual so far.
    best: Iterate,
    /// Sweep that found it.
    found: usize,
    /// Normal reaction at the start of the sweep.
    before: Vec<f64>,
    pub(super) record: SweepRecord,
    sweep_start: Instant,
    history: Vec<SweepRecord>,
    pub(super) work: Work,
    pub(super) shortfall: Option<Shortfall>,
    pub(super) failure: Option<Failure>,
}

impl<'a> Run<'a> {
    /// Starts from no reaction.
    pub(super) fn new(problem: &'a ContactProblem, settings: &'a Settings) -> Self {
        let judge = Judge::new(problem);
        let state = Iterate::new(
            &judge,
            vec![0.0; problem.unknowns()],
            vec![0.0; problem.free_modes()],
        );
        Self {
            problem,
            settings,
            judge,
            normal: NormalHalfStep::new(problem),
            friction: FrictionHalfStep::new(problem),
            gauss_seidel: GaussSeidel::new(problem),
            anderson: Anderson::default(),
            shift: vec![0.0; problem.contacts()],
            roles: Roles::full(problem.contacts()),
            coulomb: None,
            finish: None,
            best: state.clone(),
            found: 0,
            state,
            before: Vec::new(),
            record: SweepRecord::default(),
            sweep_start: Instant::now(),
            history: Vec::new(),
            work: Work::default(),
            shortfall: None,
            failure: None,
        }
    }

    /// Starts from a state that is likely near, with a finish where sweeps need not be run; its
    /// first step takes each contact's state from `displacement`, if that is known.
    pub(super) fn begin_from(
        &mut self,
        reaction: &[f64],
        motion: &[f64],
        displacement: Option<&[f64]>,
    ) {
        self.state.reaction = reaction.to_vec();
        self.state.motion = motion.to_vec();
        self.judge();
        // Rest may be a state too, but it is not the one that is asked for.
        self.best = self.state.clone();
        if self.settings.variant == Variant::Default {
            self.newton_steps(displacement);
        }
    }

    pub(super) fn variant(&self) -> Variant {
        self.settings.variant
    }

    /// The judge's residual of the best state is at most the tolerance.
    pub(super) fn is_solved(&self) -> bool {
        self.best.residual() <= self.settings.tolerance
    }

    pub(super) fn goes_on(&self) -> bool {
        let ended = self.failure.is_some() || self.shortfall.is_some();
        !self.is_solved() && !ended && self.work.sweeps < self.settings.max_sweeps
    }

    /// A few Gauss–Seidel passes tell which contacts need a cone.
    pub(super) fn predict(&mut self) {
        let start = Instant::now();
        for _ in 0..PREDICTION_PASSES {
            self.work.passes += 1;
            if self.gauss_seidel.pass(&mut self.state.reaction) < PREDICTED {
                break;
            }
        }
        self.work.seconds.predict += start.elapsed().as_secs_f64();
        self.judge();
    }

    pub(super) fn begin_sweep(&mut self) {
        self.work.sweeps += 1;
        self.record = SweepRecord::default();
        self.sweep_start = Instant::now();
        self.before = self.normal_reaction();
        if self.settings.variant == Variant::Default {
            self.roles = Roles::predict(
                self.problem,
                &self.state.reaction,
                &self.state.verdict.displacement,
            );
        }
    }

    /// (H1).
    pub(super) fn normal_half_step(&mut self) {
        let start = Instant::now();
        let (tolerance, roles) = (self.cone_tolerance(), &mut self.roles.normal);
        let work = self
            .normal
            .solve(&mut self.state.reaction, roles, tolerance);
        let work = self.count(work);
        if self.is_exact() {
            exact::normal(self.problem, &mut self.state.reaction);
        }
        self.record.normal_iterations = work.iterations;
        self.work.normal_programs += work.programs;
        self.work.seconds.normal += start.elapsed().as_secs_f64();
    }

    /// Takes the normal reaction on as a sweep for study asks.
    pub(super) fn mix(&mut self, mixing: Mixing) {
        match mixing {
            Mixing::None => {}
            Mixing::Relaxed(part) => {
                for (contact, before) in self.before.iter().enumerate() {
                    let t = &mut self.state.reaction[self.problem.offsets()[contact]];
                    *t = before + part * (*t - before);
                }
            }
            Mixing::Anderson => self.accelerate(),
        }
    }

    /// (D3) on the normal reaction, clipped to t_N ≤ 0.
    pub(super) fn accelerate(&mut self) {
        let image = self.normal_reaction();
        let next = self.anderson.next(&self.before, &image);
        for (contact, t) in next.iter().enumerate() {
            self.state.reaction[self.problem.offsets()[contact]] = t.min(0.0);
        }
    }

    /// (H2).
    pub(super) fn friction_half_step(&mut self) {
        let start = Instant::now();
        let (tolerance, roles) = (self.cone_tolerance(), &mut self.roles.friction);
        let work = self
            .friction
            .solve(&mut self.state.reaction, roles, tolerance);
        let work = self.count(work);
        if self.is_exact() {
            exact::friction(self.problem, &mut self.state.reaction);
        }
        self.record.friction_iterations = work.iterations;
        self.work.friction_programs += work.programs;
        self.work.friction_program_contacts = self.work.friction_program_contacts.max(work.cones);
        self.work.seconds.friction += start.elapsed().as_secs_f64();
    }

    pub(super) fn judge(&mut self) {
        let start = Instant::now();
        self.state.measure(&self.judge);
        self.keep(&self.state.clone());
        self.work.seconds.judge += start.elapsed().as_secs_f64();
    }

    /// Takes a state that is better than all before.
    fn keep(&mut self, state: &Iterate) {
        if state.residual() < self.best.residual() {
            self.best = state.clone();
            self.found = self.work.sweeps;
        }
    }

    /// Newton steps from the iterate, which moves only to a state of smaller residual.
    pub(super) fn newton_finish(&mut self) {
        self.newton_steps(None);
    }

    fn newton_steps(&mut self, mut near: Option<&[f64]>) {
        let start = Instant::now();
        let Some(finish) = self.finish.take().or_else(|| Finish::new(self.problem)) else {
            return;
        };
        let mut trial = self.state.clone();
        let mut idle = 0;
        for _ in 0..NEWTON_STEPS.0 {
            if self.is_solved() || idle == NEWTON_STEPS.1 {
                break;
            }
            let states = near.take().unwrap_or(&trial.verdict.displacement);
            let Some(step) = finish.step(&trial, states) else {
                break;
            };
            self.record.newton_steps += 1;
            self.work.newton_steps += 1;
            trial = self.after(&trial, &step);
            idle += 1;
            if trial.residual() < self.state.residual() {
                self.state = trial.clone();
                idle = 0;
            }
            self.keep(&trial);
        }
        self.finish = Some(finish);
        self.work.seconds.finish += start.elapsed().as_secs_f64();
    }

    /// The state after a Newton step; where bodies float and the whole step is no gain, after the
    /// part of it that leads to the first slip that ends.
    fn after(&self, trial: &Iterate, step: &Step) -> Iterate {
        let whole = trial.moved(step, 1.0, &self.judge);
        match step.first_stick {
            Some(part) if whole.residual() >= trial.residual() => {
                trial.moved(step, part, &self.judge)
            }
            _ => whole,
        }
    }

    /// One pass of the baseline; the judge is asked when the pass changes little, and after
    /// 1, 2, 4, 8 … passes.
    pub(super) fn gauss_seidel_pass(&mut self) {
        let start = Instant::now();
        self.work.passes += 1;
        let change = self.gauss_seidel.pass(&mut self.state.reaction);
        self.work.seconds.predict += start.elapsed().as_secs_f64();
        let asked = self.work.sweeps == self.settings.max_sweeps;
        if asked || self.work.sweeps.is_power_of_two() || change <= self.settings.tolerance {
            self.judge();
        }
    }

    pub(super) fn end_sweep(&mut self) {
        let mut counts = [0; 3];
        for status in &self.state.verdict.status {
            counts[match status {
                ContactStatus::Open => 0,
                ContactStatus::Stick => 1,
                ContactStatus::Slip => 2,
            }] += 1;
        }
        self.record.residual = self.state.residual();
        self.record.open_stick_slip = counts;
        self.record.seconds = self.sweep_start.elapsed().as_secs_f64();
        self.history.push(self.record);
        if self.shortfall.is_none() && !self.is_solved() {
            self.shortfall = self.hopeless();
        }
    }

    /// Why more sweeps would not help, if so; sweeps for study go on.
    fn hopeless(&self) -> Option<Shortfall> {
        let sweeps = self.work.sweeps - self.found;
        if self.settings.variant != Variant::Default || sweeps < UNIMPROVED {
            return None;
        }
        let floor = self.judge.round_off(&self.best.reaction);
        if self.best.residual() <= ROUNDED * floor {
            return Some(Shortfall::RoundOff { floor });
        }
        (sweeps >= PATIENCE).then_some(Shortfall::Stalled { sweeps })
    }

    pub(super) fn into_outcome(self) -> Outcome {
        let status = if self.failure.is_some() {
            Status::NoEquilibrium
        } else if self.is_solved() {
            Status::Certified
        } else {
            Status::NotConverged
        };
        let stalled = matches!(self.shortfall, Some(Shortfall::Stalled { .. }));
        let asked = stalled || self.finish.is_some();
        let condition = asked.then(|| condition(self.problem));
        let uncertain = self.settings.tolerance / f64::EPSILON;
        let shortfall = match (self.shortfall, condition) {
            (Some(Shortfall::Stalled { .. }), Some(condition)) if condition > uncertain => {
                Shortfall::IllConditioned { condition }
            }
            (known, _) => known.unwrap_or(Shortfall::SweepLimit),
        };
        Outcome {
            status,
            shortfall: (status == Status::NotConverged).then_some(shortfall),
            condition,
            reaction: self.best.reaction,
            motion: self.best.motion,
            failure: self.failure,
            verdict: self.best.verdict,
            history: self.history,
            work: self.work,
        }
    }

    /// Tied to the outer residual. A cone program leaves the natural map at about the root of its
    /// tolerance: without prediction and finish only the square keeps sweeps going.
    pub(super) fn cone_tolerance(&self) -> f64 {
        let (tightest, loosest) = CONE_TOLERANCE;
        let wanted = INEXACT * self.state.residual();
        match self.settings.variant {
            Variant::Sweeps(sweeps) if sweeps.exact => tightest,
            Variant::Sweeps(_) => wanted.powi(2).clamp(tightest, loosest),
            _ => wanted.clamp(tightest, loosest),
        }
    }

    fn is_exact(&self) -> bool {
        matches!(self.settings.variant, Variant::Sweeps(sweeps) if sweeps.exact)
    }

    fn normal_reaction(&self) -> Vec<f64> {
        let normals = &self.problem.offsets()[..self.problem.contacts()];
        normals.iter().map(|&n| self.state.reaction[n]).collect()
    }

    /// Books a half-step; one that the cone solver gave up is the last.
    fn count(&mut self, work: Option<HalfStepWork>) -> HalfStepWork {
        if work.is_none() {
            self.shortfall = Some(Shortfall::ConeSolver);
        }
        let work = work.unwrap_or_default();
        self.work.cone_iterations += work.iterations;
        work
    }
}
