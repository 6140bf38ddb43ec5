//! Loops beside the default one, composed of its half-steps from outside.
//!
//! ```text
//! sweeps      (H1), then t_N as it is, or part of the way, or accelerated, then (H2); full programs, no prediction
//! full cone   (H8) with the slip of its own minimiser as shift, accelerated, until both are one
//! penalty     springs in place of contacts (M6), and multipliers around them (M7)
//! Newton      whole Newton steps (D4) from rest, with nothing that would catch them
//! primal      the alternation of Panagiotopoulos, on displacements (M10), (M11)
//! NSGS        Gauss–Seidel passes (D1), (D2) on all contacts: the baseline
//! ```

use std::time::Instant;

use faer::Mat;

use super::exact;
use super::panagiotopoulos::Primal;
use crate::alternation::{
    Anderson, GaussSeidel, Outcome, Settings, Shortfall, Status, SweepRecord, Work, finish,
};
use crate::cone::{CoulombProgram, FrictionHalfStep, NormalHalfStep, Role};
use crate::error::Error;
use crate::kkt::{ContactStatus, Judge, Verdict};
use crate::problem::ContactProblem;

/// Cone programs are solved to this part of the outer residual; the tightest and the loosest tolerance.
const INEXACT: f64 = 1e-1;
const CONE_TOLERANCE: (f64, f64) = (1e-12, 1e-2);

/// Tolerance of the first program over all Coulomb cones, and the tightest; from program to program.
const FULL_TOLERANCE: (f64, f64) = (1e-8, 1e-13);
const TIGHTER: f64 = 1e-2;

/// Which loop runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Variant {
    /// Sweeps of full programs without prediction.
    Sweeps(Sweeps),
    /// Fixed point of one program over all Coulomb cones (H8).
    FullCone,
    /// Springs of so many times the contacts' own stiffness (M6).
    Penalty(f64),
    /// Uzawa's iteration around such springs (M7).
    Augmented(f64),
    /// Generalised Newton steps from rest (Alart, Curnier): an active set without safeguards.
    Newton,
    /// The alternation on displacements: Signorini's problem, then Tresca's (M10), (M11).
    Panagiotopoulos,
    /// Projected block Gauss–Seidel on all contacts, the baseline.
    Nsgs,
}

impl Variant {
    /// Unaccelerated exact sweeps: the alternation itself.
    pub const PLAIN: Self = Self::Sweeps(Sweeps {
        mixing: Mixing::None,
        exact: true,
        finish: false,
    });

    /// Solves a problem whose bodies are held; `max_sweeps` counts programs or passes where there are no sweeps.
    ///
    /// # Errors
    ///
    /// Settings outside their range, a relaxation outside (0, 1], bodies that float, laws beyond Coulomb's.
    pub fn solve(self, problem: &ContactProblem, settings: &Settings) -> Result<Outcome, Error> {
        settings.validate()?;
        self.check(problem)?;
        let mut run = Run::new(problem, settings);
        while run.goes_on() {
            run.work.sweeps += 1;
            run.record = SweepRecord::default();
            let start = Instant::now();
            match self {
                Self::Sweeps(sweeps) => run.sweep(sweeps)?,
                Self::FullCone => run.full_cone(),
                Self::Penalty(parameter) => run.penalty(parameter)?,
                Self::Augmented(parameter) => run.augmented(parameter)?,
                Self::Newton => {
                    run.newton()?;
                    run.given_up = !run.is_solved();
                }
                Self::Panagiotopoulos => run.alternate(),
                Self::Nsgs => run.pass(),
            }
            run.end(start);
        }
        Ok(run.into_outcome())
    }

    fn check(self, problem: &ContactProblem) -> Result<(), Error> {
        if problem.floating().is_some() {
            return Err(Error::NotAccepted {
                place: "variant".to_owned(),
                found: format!("{self:?}"),
                accepted: "bodies that their supports hold".to_owned(),
            });
        }
        if problem.laws().is_some() {
            return Err(Error::NotAccepted {
                place: "variant".to_owned(),
                found: "contacts with laws of their own".to_owned(),
                accepted: "Coulomb's law alone, which the variants are compared under".to_owned(),
            });
        }
        match self {
            Self::Sweeps(Sweeps {
                mixing: Mixing::Relaxed(part),
                ..
            }) if !(part > 0.0 && part <= 1.0) => Err(Error::OutOfRange {
                place: "variant: relaxed".into(),
                value: part,
                accepted: "0 < part <= 1",
            }),
            Self::Penalty(parameter) | Self::Augmented(parameter)
                if !(parameter > 0.0 && parameter.is_finite()) =>
            {
                Err(Error::OutOfRange {
                    place: "variant: penalty".into(),
                    value: parameter,
                    accepted: "0 < parameter < infinity",
                })
            }
            _ => Ok(()),
        }
    }
}

/// How sweeps are run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sweeps {
    /// What follows the normal half-step.
    pub mixing: Mixing,
    /// Half-steps to the last digit (M5); else tied to the outer residual.
    pub exact: bool,
    /// A Newton finish after every sweep.
    pub finish: bool,
}

/// How the normal reaction is taken on from sweep to sweep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mixing {
    /// As the half-step left it.
    None,
    /// This part of the way to it, in (0, 1].
    Relaxed(f64),
    /// By Anderson acceleration.
    Anderson,
}

/// A solve in progress.
pub(super) struct Run<'a> {
    pub(super) problem: &'a ContactProblem,
    pub(super) settings: &'a Settings,
    judge: Judge<'a>,
    normal: NormalHalfStep<'a>,
    friction: FrictionHalfStep<'a>,
    gauss_seidel: GaussSeidel<'a>,
    coulomb: Option<CoulombProgram<'a>>,
    anderson: Anderson,
    /// Shift of (H8), in metre per contact.
    shift: Vec<f64>,
    pub(super) reaction: Vec<f64>,
    verdict: Verdict,
    /// Of (M10).
    pub(super) primal: Option<Primal>,
    /// Of (M7).
    pub(super) softened: Option<(ContactProblem, Vec<f64>)>,
    best: (Vec<f64>, Verdict),
    pub(super) given_up: bool,
    pub(super) record: SweepRecord,
    history: Vec<SweepRecord>,
    pub(super) work: Work,
}

impl<'a> Run<'a> {
    pub(super) fn new(problem: &'a ContactProblem, settings: &'a Settings) -> Self {
        let judge = Judge::new(problem);
        let reaction = vec![0.0; problem.unknowns()];
        let verdict = judge.measure(&reaction);
        Self {
            problem,
            settings,
            judge,
            normal: NormalHalfStep::new(problem),
            friction: FrictionHalfStep::new(problem),
            gauss_seidel: GaussSeidel::new(problem),
            coulomb: None,
            anderson: Anderson::default(),
            shift: vec![0.0; problem.contacts()],
            primal: None,
            softened: None,
            best: (reaction.clone(), verdict.clone()),
            reaction,
            verdict,
            given_up: false,
            record: SweepRecord::default(),
            history: Vec::new(),
            work: Work::default(),
        }
    }

    pub(super) fn is_solved(&self) -> bool {
        self.best.1.certificate.residual() <= self.settings.tolerance
    }

    pub(super) fn goes_on(&self) -> bool {
        !self.is_solved() && !self.given_up && self.work.sweeps < self.settings.max_sweeps
    }

    fn sweep(&mut self, sweeps: Sweeps) -> Result<(), Error> {
        let before = self.normal_reaction();
        self.normal_half_step(sweeps.exact);
        self.mix(sweeps.mixing, &before);
        self.friction_half_step(sweeps.exact);
        self.measure();
        match sweeps.finish && !self.is_solved() {
            true => self.newton(),
            false => Ok(()),
        }
    }

    /// Newton steps from where the reaction is, until they lead no further.
    fn newton(&mut self) -> Result<(), Error> {
        let found = finish(self.problem, self.settings, &self.reaction, &[])?;
        self.take(found);
        Ok(())
    }

    fn normal_half_step(&mut self, exact: bool) {
        let mut roles = vec![Role::Cone; self.problem.contacts()];
        let tolerance = self.cone_tolerance(exact);
        match self.normal.solve(&mut self.reaction, &mut roles, tolerance) {
            None => self.given_up = true,
            Some(work) => {
                self.record.normal_iterations = work.iterations;
                self.work.cone_iterations += work.iterations;
                self.work.normal_programs += work.programs;
            }
        }
        if exact {
            exact::normal(self.problem, &mut self.reaction);
        }
    }

    fn mix(&mut self, mixing: Mixing, before: &[f64]) {
        let image = self.normal_reaction();
        let next = match mixing {
            Mixing::None => return,
            Mixing::Relaxed(part) => {
                let pairs = before.iter().zip(&image);
                pairs.map(|(from, to)| from + part * (to - from)).collect()
            }
            Mixing::Anderson => self.anderson.next(before, &image),
        };
        for (&n, t) in self.problem.offsets().iter().zip(&next) {
            self.reaction[n] = t.min(0.0);
        }
    }

    fn friction_half_step(&mut self, exact: bool) {
        let mut roles = vec![Role::Cone; self.problem.contacts()];
        let tolerance = self.cone_tolerance(exact);
        match self
            .friction
            .solve(&mut self.reaction, &mut roles, tolerance)
        {
            None => self.given_up = true,
            Some(work) => {
                self.record.friction_iterations = work.iterations;
                self.work.cone_iterations += work.iterations;
                self.work.friction_programs += work.programs;
            }
        }
        if exact {
            exact::friction(self.problem, &mut self.reaction);
        }
    }

    /// A cone program leaves the natural map at about the root of its tolerance: only the square of what is wanted
    /// keeps sweeps going.
    fn cone_tolerance(&self, exact: bool) -> f64 {
        let (tightest, loosest) = CONE_TOLERANCE;
        match exact {
            true => tightest,
            false => {
                let wanted = INEXACT * self.verdict.certificate.residual();
                wanted.powi(2).clamp(tightest, loosest)
            }
        }
    }

    fn alternate(&mut self) {
        let primal = self.primal.take().or_else(|| Primal::new(self.problem));
        let steps = primal.and_then(|mut primal| {
            let steps = primal.alternate(self.problem, &mut self.reaction);
            self.primal = Some(primal);
            steps
        });
        self.given_up = steps.is_none();
        self.record.newton_steps = steps.unwrap_or(0);
        self.work.newton_steps += steps.unwrap_or(0);
        self.measure();
    }

    fn full_cone(&mut self) {
        let none = Mat::zeros(self.problem.unknowns(), 0);
        let tolerance = FULL_TOLERANCE.0 * TIGHTER.powi(self.work.coulomb_programs as i32);
        let program = self
            .coulomb
            .take()
            .or_else(|| CoulombProgram::new(self.problem, none.as_ref()));
        self.coulomb = program;
        let shift = &self.shift;
        let solve = |program: &mut CoulombProgram<'_>| {
            program.solve(&[], shift, tolerance.max(FULL_TOLERANCE.1))
        };
        let Some(solution) = self.coulomb.as_mut().and_then(solve) else {
            self.given_up = true;
            return;
        };
        self.record.coulomb_iterations = solution.iterations;
        self.work.cone_iterations += solution.iterations;
        self.work.coulomb_programs += 1;
        self.reaction = solution.reaction;
        self.measure();
        let u = &self.verdict.displacement;
        let blocks = self.problem.offsets().windows(2);
        let slips = blocks.map(|ends| {
            let tangents = &u[ends[0] + 1..ends[1]];
            tangents.iter().fold(0.0, |s: f64, u| s.hypot(*u))
        });
        let slips: Vec<f64> = slips.collect();
        self.shift = self.anderson.next(&self.shift, &slips);
        self.shift.iter_mut().for_each(|s| *s = s.max(0.0));
    }

    /// The judge is asked when the pass changes little, and after 1, 2, 4, 8 … passes.
    fn pass(&mut self) {
        let start = Instant::now();
        self.work.passes += 1;
        let change = self.gauss_seidel.pass(&mut self.reaction);
        self.work.seconds.predict += start.elapsed().as_secs_f64();
        let asked = self.work.sweeps == self.settings.max_sweeps;
        if asked || self.work.sweeps.is_power_of_two() || change <= self.settings.tolerance {
            self.measure();
        }
    }

    pub(super) fn measure(&mut self) {
        self.verdict = self.judge.measure(&self.reaction);
        if self.verdict.certificate.residual() < self.best.1.certificate.residual() {
            self.best = (self.reaction.clone(), self.verdict.clone());
        }
    }

    pub(super) fn end(&mut self, start: Instant) {
        let status = &self.verdict.status;
        let count = |wanted| status.iter().filter(|status| **status == wanted).count();
        self.record.open_stick_slip = [
            count(ContactStatus::Open),
            count(ContactStatus::Stick),
            count(ContactStatus::Slip),
        ];
        self.record.residual = self.verdict.certificate.residual();
        self.record.seconds = start.elapsed().as_secs_f64();
        self.history.push(self.record);
    }

    fn normal_reaction(&self) -> Vec<f64> {
        let normals = &self.problem.offsets()[..self.problem.contacts()];
        normals.iter().map(|&n| self.reaction[n]).collect()
    }

    pub(super) fn into_outcome(self) -> Outcome {
        let solved = self.is_solved();
        let shortfall = match self.given_up {
            true => Shortfall::ConeSolver,
            false => Shortfall::SweepLimit,
        };
        let (reaction, verdict) = self.best;
        Outcome {
            status: match solved {
                true => Status::Certified,
                false => Status::NotConverged,
            },
            shortfall: (!solved).then_some(shortfall),
            condition: None,
            reaction,
            motion: Vec::new(),
            motion_left_out: Vec::new(),
            failure: None,
            verdict,
            history: self.history,
            work: self.work,
        }
    }
}
