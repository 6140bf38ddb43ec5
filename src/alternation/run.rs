//! The named steps of a solve, and the state they share.

use std::time::Instant;

use super::anderson::Anderson;
use super::finish::{Finish, Springs};
use super::gauss_seidel::GaussSeidel;
use super::iterate::{Iterate, Motion};
use super::prediction::Roles;
use super::settings::Clock;
use super::{Failure, Outcome, Settings, Shortfall, Status, SweepRecord, Work};
use crate::cone::{FrictionHalfStep, HalfStepWork, NormalHalfStep};
use crate::kkt::{ContactStatus, Judge};
use crate::problem::ContactProblem;
use crate::stage::{self, Stage};

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
const PATIENCE: usize = 3;

/// Unknowns beyond which programs of half-steps are not kept.
const LARGE: usize = 1024;

/// A residual below this many times what round-off may leave is round-off.
const ROUNDED: f64 = 4.0;

/// What is left of what the laws miss at rest where a state answers it.
const ANSWERED: f64 = 1e-3;

/// Reactions of more than so many times what acts at rest may grow without bound.
const UNBOUNDED: f64 = 1e3;

/// A solve in progress.
pub(super) struct Run<'a> {
    pub(super) problem: &'a ContactProblem,
    settings: &'a Settings,
    judge: Judge<'a>,
    normal: NormalHalfStep<'a>,
    friction: FrictionHalfStep<'a>,
    gauss_seidel: GaussSeidel<'a>,
    anderson: Anderson,
    roles: Roles,
    pub(super) finish: Option<Finish<'a>>,
    pub(super) clock: Clock,
    /// What the laws miss at rest, see [`Finish::residual`].
    rest: f64,
    /// The iterate.
    pub(super) state: Iterate,
    /// Where the last finish began.
    pub(super) start: Iterate,
    /// The state of least residual so far.
    pub(super) best: Iterate,
    /// Sweep that found it.
    found: usize,
    /// Normal reaction at the start of the sweep.
    before: Vec<f64>,
    pub(super) record: SweepRecord,
    sweep_start: Instant,
    history: Vec<SweepRecord>,
    pub(super) work: Work,
    /// κ of (D7) where it is known.
    pub(super) condition: Option<f64>,
    pub(super) shortfall: Option<Shortfall>,
    pub(super) failure: Option<Failure>,
    /// Where a program whose equilibrium cannot be had would move the bodies.
    pub(super) doubted: Option<Vec<f64>>,
}

impl<'a> Run<'a> {
    /// Starts from no reaction.
    pub(super) fn new(problem: &'a ContactProblem, settings: &'a Settings) -> Self {
        Stage::Sweeps.begin();
        let judge = Judge::new(problem);
        let state = Iterate::new(
            &judge,
            vec![0.0; problem.unknowns()],
            Motion::of(vec![0.0; problem.free_modes()]),
        );
        let finish = Finish::new(problem);
        Self {
            problem,
            settings,
            judge,
            normal: NormalHalfStep::new(problem),
            friction: FrictionHalfStep::new(problem),
            gauss_seidel: GaussSeidel::new(problem),
            anderson: Anderson::default(),
            roles: Roles::full(problem.contacts()),
            rest: finish.as_ref().map_or(0.0, |finish| finish.missed(&state)),
            finish,
            clock: Clock::start(settings),
            start: state.clone(),
            best: state.clone(),
            found: 0,
            state,
            before: Vec::new(),
            record: SweepRecord::default(),
            sweep_start: Instant::now(),
            history: Vec::new(),
            work: Work::default(),
            condition: None,
            shortfall: None,
            failure: None,
            doubted: None,
        }
    }

    /// Starts from a state that is likely near, with a finish where sweeps need not be run; its
    /// first step takes each contact's state from a displacement beyond the gaps, if that is known.
    pub(super) fn begin_from(&mut self, reaction: &[f64], motion: &[f64], beyond: Option<&[f64]>) {
        self.state.reaction = reaction.to_vec();
        self.state.motion = Motion::of(motion.to_vec());
        self.judge();
        // Rest may be a state too, but it is not the one that is asked for.
        self.best = self.state.clone();
        self.newton_steps(beyond);
    }

    /// The judge's residual of the best state is at most the tolerance, and not for want of digits only.
    pub(super) fn is_solved(&self) -> bool {
        self.is_within() && !self.is_unanswered() && !self.has_run_off()
    }

    fn is_within(&self) -> bool {
        self.best.residual() <= self.settings.tolerance
    }

    /// Residuals are relative to the reaction. One that grows without bound, with hardly anything that resists it,
    /// answers nothing.
    fn is_unanswered(&self) -> bool {
        let excess = self.excess();
        self.is_within() && excess > UNBOUNDED && self.best.residual() * excess > ANSWERED
    }

    /// The reaction over what acts on the contacts at rest.
    fn excess(&self) -> f64 {
        let size = self
            .finish
            .as_ref()
            .map_or(0.0, |finish| finish.size(&self.best.reaction));
        if self.rest > 0.0 {
            size / self.rest
        } else {
            0.0
        }
    }

    pub(super) fn goes_on(&self) -> bool {
        let ended = self.failure.is_some() || self.shortfall.is_some();
        !self.is_solved() && !ended && self.work.sweeps < self.settings.max_sweeps
    }

    /// Ends the solve if its time is over.
    pub(super) fn is_over(&mut self) -> bool {
        if let Some(reason) = self.clock.over() {
            self.shortfall = Some(reason);
        }
        self.clock.over().is_some()
    }

    /// A few Gauss–Seidel passes tell which contacts need a cone, where bodies are held.
    pub(super) fn predict(&mut self) {
        if self.problem.floating().is_some() {
            return;
        }
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
        let displacement = &self.state.verdict.displacement;
        self.roles = Roles::predict(self.problem, &self.state.reaction, displacement);
    }

    /// (H1).
    pub(super) fn normal_half_step(&mut self) {
        let start = Instant::now();
        let (tolerance, roles) = (self.cone_tolerance(), &mut self.roles.normal);
        let work = self
            .normal
            .solve(&mut self.state.reaction, roles, tolerance);
        let work = self.count(work);
        self.record.normal_iterations = work.iterations;
        self.work.normal_programs += work.programs;
        self.work.seconds.normal += start.elapsed().as_secs_f64();
    }

    /// (D3) on the normal reaction, clipped to t_N ≤ 0 unless bilateral.
    pub(super) fn accelerate(&mut self) {
        let image = self.normal_reaction();
        let next = self.anderson.next(&self.before, &image);
        for (&n, t) in self.problem.normals().iter().zip(next) {
            self.state.reaction[n] = t;
        }
        self.normal.admit(&mut self.state.reaction);
    }

    /// (H2).
    pub(super) fn friction_half_step(&mut self) {
        let start = Instant::now();
        let (tolerance, roles) = (self.cone_tolerance(), &mut self.roles.friction);
        let work = self
            .friction
            .solve(&mut self.state.reaction, roles, tolerance);
        let work = self.count(work);
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
        if self.problem.unknowns() > LARGE {
            // As large as a Newton matrix, and hardly ever asked for again.
            self.normal.forget();
            self.friction.forget();
        }
        self.newton_steps(None);
    }

    fn newton_steps(&mut self, mut near: Option<&[f64]>) {
        let start = Instant::now();
        self.start = self.state.clone();
        let mut trial = self.state.clone();
        let mut idle = 0;
        for _ in 0..NEWTON_STEPS.0 {
            if self.is_solved() || idle == NEWTON_STEPS.1 || self.is_over() {
                break;
            }
            let states = near.take().unwrap_or(&trial.verdict.beyond);
            let springs = Springs {
                softness: 0.0,
                anchor: &trial.reaction,
            };
            let Some(finish) = self.finish.as_mut() else {
                break;
            };
            let Some(next) = finish.step(&finish.point(&trial), states, springs) else {
                break;
            };
            let motion = finish.moved(&trial.motion, &next.drift);
            self.record.newton_steps += 1;
            self.work.newton_steps += 1;
            trial = Iterate::new(&self.judge, next.reaction, motion);
            idle += 1;
            if trial.residual() < self.state.residual() {
                self.state = trial.clone();
                idle = 0;
            }
            self.keep(&trial);
        }
        self.work.seconds.finish += start.elapsed().as_secs_f64();
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
        stage::swept(self.work.sweeps, self.record.residual);
        if self.shortfall.is_none() && !self.is_solved() {
            self.shortfall = self.hopeless();
        }
    }

    /// Why more sweeps would not help, if so.
    fn hopeless(&self) -> Option<Shortfall> {
        if let Some(over) = self.clock.over() {
            return Some(over);
        }
        let sweeps = self.work.sweeps - self.found;
        let floor = self.judge.round_off(&self.best.reaction);
        if self.best.residual() <= ROUNDED * floor {
            return Some(Shortfall::RoundOff { floor });
        }
        // The program over all Coulomb cones would only be posed again.
        let most = match self.problem.floating() {
            None => PATIENCE,
            Some(_) => 0,
        };
        (sweeps >= most).then_some(Shortfall::Stalled { sweeps })
    }

    pub(super) fn into_outcome(self) -> Outcome {
        let status = if self.failure.is_some() {
            Status::NoEquilibrium
        } else if self.is_solved() {
            Status::Certified
        } else {
            Status::NotConverged
        };
        let estimated = || self.finish.as_ref().and_then(Finish::condition);
        let condition = self.condition.or_else(estimated);
        let shortfall = match self.shortfall {
            _ if self.is_unanswered() && self.hangs_on_last_digits() => Shortfall::IllConditioned {
                excess: self.excess(),
            },
            known => known.unwrap_or(Shortfall::SweepLimit),
        };
        Outcome {
            status,
            shortfall: (status == Status::NotConverged).then_some(shortfall),
            condition,
            reaction: self.best.reaction,
            motion: self.best.motion.amplitudes,
            motion_left_out: self.best.motion.left_out,
            failure: self.failure,
            verdict: self.best.verdict,
            history: self.history,
            work: self.work,
        }
    }

    /// Tied to the outer residual.
    fn cone_tolerance(&self) -> f64 {
        let (tightest, loosest) = CONE_TOLERANCE;
        (INEXACT * self.state.residual()).clamp(tightest, loosest)
    }

    pub(super) fn tolerance(&self) -> f64 {
        self.settings.tolerance
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

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use std::sync::atomic::AtomicBool;
    use std::time::Duration;

    use faer::mat;

    use crate::alternation::{Interrupt, Outcome, Settings, Shortfall, Status, solve};
    use crate::problem::{ContactProblem, Floating, Operator};

    /// G = [[1, −1], [−1, 2]], û = (0.25, 0.5), μ = ½: slips with t = (−½, −¼).
    fn solved(settings: &Settings) -> Outcome {
        let operator = Operator::from_compliance(mat![[1.0, -1.0], [-1.0, 2.0]]).unwrap();
        let free = vec![0.25, 0.5];
        let problem = ContactProblem::new(&[1], vec![0.5], vec![0.0], free, operator).unwrap();
        solve(&problem, settings).unwrap()
    }

    #[test]
    fn a_cold_start_is_one_sweep_and_one_newton_step() {
        let found = solved(&Settings::default());
        assert_eq!(found.status, Status::Certified);
        assert!(
            (found.reaction[0] + 0.5).abs() < 1e-15 && (found.reaction[1] + 0.25).abs() < 1e-15
        );
        assert!(
            (found.work.sweeps, found.work.proximal_steps) == (1, 0),
            "{:?}",
            found.work
        );
        assert!(found.work.newton_steps <= 1, "{:?}", found.work);
    }

    #[test]
    fn time_that_is_over_leaves_the_best_state() {
        let settings = Settings {
            tolerance: 1e-15,
            time_limit: Some(Duration::ZERO),
            ..Settings::default()
        };
        let found = solved(&settings);
        assert_eq!(found.shortfall, Some(Shortfall::TimeLimit));
        assert_eq!(found.work.newton_steps, 0);
        // One sweep of an alternation that contracts by a half, after passes to a hundredth.
        assert!(found.verdict.certificate.natural_map < 0.1);
    }

    #[test]
    fn a_raised_flag_ends_a_solve() {
        static FLAG: AtomicBool = AtomicBool::new(true);
        let settings = Settings {
            tolerance: 1e-15,
            interrupt: Some(Interrupt::new(&FLAG)),
            ..Settings::default()
        };
        assert_eq!(solved(&settings).shortfall, Some(Shortfall::Interrupted));
    }

    /// Two smooth contacts of compliance ½ and ¼ m/N under a rigid lid that sinks and tilts.
    fn lid(load: [f64; 2]) -> Outcome {
        let operator = Operator::from_compliance(mat![[0.5, 0.0], [0.0, 0.25]]).unwrap();
        let zero = vec![0.0; 2];
        let problem =
            ContactProblem::new(&[0, 0], zero.clone(), zero.clone(), zero, operator).unwrap();
        let floating = Floating::new(mat![[1.0, 1.0], [1.0, -1.0]], load.to_vec()).unwrap();
        solve(&problem.float(floating).unwrap(), &Settings::default()).unwrap()
    }

    #[test]
    fn a_lid_that_only_contact_holds_is_one_program() {
        // t_1 + t_2 + 6 = 0, t_1 − t_2 + 2 = 0; u = G t + (α + β, α − β) = 0.
        let found = lid([6.0, 2.0]);
        assert_eq!(found.status, Status::Certified);
        let close = |found: &[f64], expected: [f64; 2]| {
            let apart = (found[0] - expected[0]).hypot(found[1] - expected[1]);
            assert!(apart < 1e-11, "{found:?}");
        };
        close(&found.reaction, [-4.0, -2.0]);
        close(&found.motion, [1.25, 0.75]);
        let work = found.work;
        assert!((work.sweeps, work.coulomb_programs) == (1, 1), "{work:?}");
        assert!(
            work.normal_programs == 0 && work.newton_steps <= 2,
            "{work:?}"
        );
    }

    #[test]
    fn a_lid_that_tilts_over_its_edge_has_no_equilibrium() {
        // t_1 = −4, t_2 = +1: it would have to be held down at the second contact, by 1 N.
        let found = lid([3.0, 5.0]);
        assert_eq!(found.status, Status::NoEquilibrium);
        let failure = found.failure.unwrap();
        assert!(!failure.elastic && failure.opening == [1], "{failure:?}");
        assert!((failure.missing - 1.0).abs() < 1e-9, "{failure:?}");
    }

    #[test]
    fn a_motion_far_beyond_its_indentation_is_certified_to_the_tolerance() {
        // A lid a metre above two contacts, 6e-10 N of weight: α = 1 m + 1.25e-10 m, of which a double keeps six digits.
        let operator = Operator::from_compliance(mat![[0.5, 0.0], [0.0, 0.25]]).unwrap();
        let (zero, gap) = (vec![0.0; 2], vec![1.0; 2]);
        let problem = ContactProblem::new(&[0, 0], zero.clone(), gap, zero, operator).unwrap();
        let floating = Floating::new(mat![[1.0, 1.0], [1.0, -1.0]], vec![6e-10, 2e-10]).unwrap();
        let problem = problem.float(floating).unwrap();
        let found = solve(&problem, &Settings::default()).unwrap();
        assert_eq!(found.status, Status::Certified);
        assert!(found.verdict.certificate.natural_map <= 1e-12);
        // t as above, in units of 1e-10 N; α = 1 + 1.25e-10 m to the last digit, and beyond it.
        assert!((found.reaction[0] / 1e-10 + 4.0).abs() < 1e-11);
        assert!((found.motion[0] - 1.0 - 1.25e-10).abs() < 3e-16);
        let indented = (found.motion[0] - 1.0) + found.motion_left_out[0];
        assert!((indented / 1e-10 - 1.25).abs() < 1e-11, "{indented:e}");
    }
}
