//! Outer loop: normal and friction half-steps in turn, each as exact as the outer residual deserves.
//!
//! ```text
//! start     the same problem on a grid half as fine, down to some 32 × 32, to 1 %
//! repeat    p   ← (S7) with c = g₀ − δ − G_NT q         to a tenth of the residual
//!           q   ← slipping contacts to their new radius −μ t_N
//!           q   ← (S8) with R = μ p, c = û_T − G_TN p    to a tenth of the residual
//!                 with U by (S18)                        if the force is given
//! until     natural map (K1) of all contacts ≤ tolerance
//! ```

use super::coupled::Coupled;
use super::judge::judge;
use super::outcome::{HalfSpaceOutcome, HalfSpaceState, HalfSpaceStatus, HalfSpaceWork};
use super::problem::HalfSpaceProblem;
use super::range::check_range;
use super::sweep::Iterate;
use crate::error::{Error, check_finite, check_length};

/// Residual that counts as solved.
const TOLERANCE: f64 = 1e-10;

/// Half-steps go to this share of the outer residual.
const INNER: f64 = 0.1;

/// What is left of the last digits for the judge, who starts from fresh products.
const LAST: f64 = 0.3;

/// Outer iterations after which the loop gives up.
const MOST_OUTER: usize = 100;

/// Fall of the residual in one sweep above which Newton's method is tried.
const SLOW: f64 = 0.25;

/// Largest μ|β| beyond which half-steps in turn part from the solution.
const STRONG: f64 = 1.0;

/// Least share of friction's lift that a damped sweep passes on.
const LEAST_SHARE: f64 = 1.0 / 32.0;

/// Residual of coarser grids, which only have to give a start.
const COARSE: f64 = 1e-2;

/// Departure of the operator from its formulas that is round-off of the transforms.
const OPERATOR: f64 = 1e-9;

/// Departure of given resultants that no tolerance may be below.
const ROUND_OFF: f64 = 1e-12;

impl HalfSpaceProblem {
    /// Solves to a residual of 1e-10.
    ///
    /// # Errors
    ///
    /// None once the problem stands; what cannot be solved is a status.
    pub fn solve(&self) -> Result<HalfSpaceOutcome, Error> {
        self.solve_to(TOLERANCE)
    }

    /// Solves to another residual, from 1e-15 to 1e-2.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for a tolerance beyond that.
    pub fn solve_to(&self, tolerance: f64) -> Result<HalfSpaceOutcome, Error> {
        check_tolerance(tolerance)?;
        let mut work = HalfSpaceWork::default();
        let start = self.start(tolerance, &mut work)?;
        self.end(start, tolerance, work)
    }

    /// Solves from a state that is near, such as that of the load step before, to a residual.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for the tolerance, [`Error::Length`] and [`Error::NotFinite`] for a state
    /// that is not of the problem's cells.
    pub fn solve_from(
        &self,
        near: &HalfSpaceState,
        tolerance: f64,
    ) -> Result<HalfSpaceOutcome, Error> {
        check_tolerance(tolerance)?;
        for part in &near.reaction {
            check_length("near.reaction", self.friction.len(), part.len())?;
            check_finite("near.reaction", part)?;
        }
        let before = self.operator.transforms();
        let start = Progress::new(Iterate::near(self, near), 0.1);
        let work = HalfSpaceWork {
            outer: 0,
            transforms: (self.operator.transforms() - before) as f64,
        };
        self.end(start, tolerance, work)
    }

    /// Iterates from a start and has the end judged.
    fn end(
        &self,
        start: Progress,
        tolerance: f64,
        mut work: HalfSpaceWork,
    ) -> Result<HalfSpaceOutcome, Error> {
        let end = self.run(start, tolerance, &mut work);
        let state = end.iterate.state();
        let judged = judge(self, &state)?;
        let certificate = judged.certificate;
        let sound = certificate.residual <= tolerance
            && certificate.resultant_defect <= tolerance.max(ROUND_OFF)
            && certificate.operator_defect <= OPERATOR;
        let status = match (end.lost, sound) {
            (true, _) => HalfSpaceStatus::NoEquilibrium,
            (false, true) => HalfSpaceStatus::Certified,
            (false, false) => HalfSpaceStatus::NotConverged,
        };
        let gaps = judged.elastic[0].iter().zip(&self.initial_gap);
        let gap = gaps.map(|(u, gap)| gap - state.approach - u).collect();
        let slip = [0, 1].map(|axis| {
            let pairs = judged.elastic[axis + 1].iter().zip(&self.reference[axis]);
            let of = |(u, before)| u - state.shift[axis] - before;
            pairs.map(of).collect()
        });
        let at_border = self.pressing_at_border(&state.reaction[0]);
        Ok(HalfSpaceOutcome {
            status,
            certificate,
            state,
            gap,
            slip,
            at_border,
            work,
        })
    }

    /// A start by the same problem on a coarser grid, if there is one.
    pub(super) fn start(
        &self,
        tolerance: f64,
        work: &mut HalfSpaceWork,
    ) -> Result<Progress, Error> {
        let Some(coarse) = self.coarser()? else {
            return Ok(Progress::new(Iterate::new(self), 0.3));
        };
        let tolerance = COARSE.max(tolerance);
        let mut of_coarse = HalfSpaceWork::default();
        let start = coarse.start(tolerance, &mut of_coarse)?;
        let end = coarse.run(start, tolerance, &mut of_coarse);
        let share = coarse.friction.len() as f64 / self.friction.len() as f64;
        work.transforms = of_coarse.transforms * share;
        Ok(Progress::new(end.iterate.refined(&coarse, self), 0.1))
    }

    pub(super) fn run(
        &self,
        mut progress: Progress,
        tolerance: f64,
        work: &mut HalfSpaceWork,
    ) -> Progress {
        let before = self.operator.transforms();
        let mut may_grow = self.strength() > STRONG;
        while work.outer < MOST_OUTER && !progress.ends(tolerance) {
            work.outer += 1;
            let slow = progress.sweep(self, tolerance) > SLOW && work.outer > 1;
            let helped = slow && !progress.ends(tolerance) && progress.newton(self, tolerance);
            if helped || progress.ends(tolerance) {
                continue;
            }
            if may_grow && progress.share < 1.0 {
                may_grow = false;
                if let Some(state) = self.grown(tolerance, work) {
                    progress.take(self, &state);
                    continue;
                }
            }
            progress.damp();
        }
        work.transforms += (self.operator.transforms() - before) as f64;
        progress
    }
}

fn check_tolerance(tolerance: f64) -> Result<(), Error> {
    let good = (1e-15..=1e-2).contains(&tolerance);
    check_range("tolerance", tolerance, good, "from 1e-15 to 1e-2")
}

/// Where the loop stands, and how well it goes.
pub(super) struct Progress {
    pub(super) iterate: Iterate,
    residual: f64,
    /// Least residual so far.
    best: f64,
    /// Residual at which Newton's method was last tried.
    tried: f64,
    /// Part of friction's lift that a sweep passes on.
    share: f64,
    /// The given force is beyond what friction can carry.
    lost: bool,
}

impl Progress {
    /// `residual`: what the start is supposed to have.
    fn new(iterate: Iterate, residual: f64) -> Self {
        Self {
            iterate,
            residual,
            best: f64::INFINITY,
            tried: f64::INFINITY,
            share: 1.0,
            lost: false,
        }
    }

    fn ends(&self, tolerance: f64) -> bool {
        self.lost || self.residual <= tolerance
    }

    /// A sweep; gives the factor by which it lowered the residual.
    fn sweep(&mut self, problem: &HalfSpaceProblem, tolerance: f64) -> f64 {
        let target = match problem.has_friction() {
            true => (INNER * self.residual.min(1.0)).max(LAST * tolerance),
            false => tolerance,
        };
        let laws = problem.sweep(&mut self.iterate, target, self.share);
        let [missing, beyond] = problem.missing(&self.iterate);
        let before = self.residual;
        self.residual = laws.hypot(missing);
        self.lost = beyond > 10.0 * laws;
        self.residual / before
    }

    /// Newton's method, if the residual is well below where it was tried before; says whether it helped.
    fn newton(&mut self, problem: &HalfSpaceProblem, tolerance: f64) -> bool {
        if self.residual > 0.3 * self.tried {
            return false;
        }
        self.tried = self.residual;
        let end = problem.finish(self.iterate.coupled(problem), tolerance);
        if end.residual >= self.residual {
            return false;
        }
        self.take(problem, &end);
        self.residual < 0.1 * self.tried
    }

    fn take(&mut self, problem: &HalfSpaceProblem, state: &Coupled) {
        self.iterate = Iterate::of(problem, state.held.clone());
        self.residual = state.residual;
    }

    /// Half the share where sweeps do not get on: eigenvalues ±iμβ beyond 1 then come inside.
    fn damp(&mut self) {
        if self.residual > 0.7 * self.best {
            self.share = (0.5 * self.share).max(LEAST_SHARE);
        }
        self.best = self.best.min(self.residual);
    }
}
