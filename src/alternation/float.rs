//! The steps for bodies that contact alone holds.
//!
//! With equilibrium as rows in both half-steps the resultants of normal and friction forces
//! would each stay what they were at the start, which is wrong on anything but a plane. So all
//! Coulomb cones stand in one program, whose fixed point under the shift `μ ‖u_T‖` is the
//! solution (Acary, Cadoux, Lemaréchal, Malick, Z. Angew. Math. Mech. 91 (2011) 155–175); it is
//! infeasible exactly where no admissible equilibrium exists.

use std::time::Instant;

use faer::Mat;

use super::run::Run;
use super::{Failure, Shortfall};
use crate::cone::CoulombProgram;
use crate::kkt;
use crate::limit::{Equilibrium, RigidContacts};
use crate::problem::Floating;

/// The judge believes a failing motion that would take reactions of more than this times the load.
const IMPOSSIBLE: f64 = 1e3;

/// Tolerance of the first program, and the tightest.
const TOLERANCE: (f64, f64) = (1e-8, 1e-13);

/// From program to program: where the finish fails, it is for want of digits in the slip.
const TIGHTER: f64 = 1e-2;

impl Run<'_> {
    /// After a first program that led nowhere, asks whether any admissible reactions hold the
    /// bodies; a motion that proves the contrary, and that the judge believes, ends the run.
    pub(super) fn doubt_equilibrium(&mut self, floating: &Floating) {
        if self.is_solved() || self.work.sweeps > 1 {
            return;
        }
        let start = Instant::now();
        if let Some(contacts) = RigidContacts::of(self.problem, floating)
            && let Ok(Equilibrium::Impossible { motion, excess }) =
                contacts.admissible(floating.load())
        {
            self.failure = self.believe(&contacts, floating, motion, excess);
        }
        self.work.seconds.coulomb += start.elapsed().as_secs_f64();
    }

    /// (H8), with the equilibrium of the bodies that float, if any do.
    pub(super) fn coulomb_program(&mut self, floating: Option<&Floating>) {
        let start = Instant::now();
        let none = Mat::zeros(self.problem.unknowns(), 0);
        let (modes, load) = match floating {
            Some(floating) => (floating.modes(), floating.load()),
            None => (none.as_ref(), &[][..]),
        };
        let tolerance = TOLERANCE.0 * TIGHTER.powi(self.work.coulomb_programs as i32);
        let tolerance = tolerance.max(TOLERANCE.1);
        let mut program = self
            .coulomb
            .take()
            .or_else(|| CoulombProgram::new(self.problem, modes));
        let shift = &self.shift;
        let solve = |program: &mut CoulombProgram<'_>| program.solve(load, shift, tolerance);
        match program.as_mut().and_then(solve) {
            Some(solution) => {
                self.record.coulomb_iterations = solution.iterations;
                self.work.cone_iterations += solution.iterations;
                self.work.coulomb_programs += 1;
                self.state.reaction = solution.reaction;
                self.state.motion = solution.motion;
            }
            None => self.shortfall = Some(Shortfall::ConeSolver),
        }
        self.coulomb = program;
        self.work.seconds.coulomb += start.elapsed().as_secs_f64();
    }

    /// The shift of the next program: the slip that this one left, accelerated (D3).
    pub(super) fn shift_by_slip(&mut self) {
        let u = &self.state.verdict.displacement;
        let blocks = self.problem.offsets().windows(2);
        let slips: Vec<f64> = blocks
            .map(|ends| {
                u[ends[0] + 1..ends[1]]
                    .iter()
                    .fold(0.0, |s: f64, u| s.hypot(*u))
            })
            .collect();
        self.shift = self.anderson.next(&self.shift, &slips);
        self.shift.iter_mut().for_each(|s| *s = s.max(0.0));
    }

    fn believe(
        &self,
        contacts: &RigidContacts,
        floating: &Floating,
        motion: Vec<f64>,
        missing: f64,
    ) -> Option<Failure> {
        let proof = kkt::impossibility(
            self.problem.offsets(),
            self.problem.friction(),
            floating.modes(),
            floating.load(),
            &motion,
        )
        .ok()?;
        let load = floating.load().iter().fold(0.0, |s: f64, e| s.hypot(*e));
        let apparent = contacts.failure(&motion);
        (proof.least_reaction > IMPOSSIBLE * load).then_some(Failure {
            motion,
            apparent: apparent.motion,
            sliding: apparent.sliding,
            opening: apparent.opening,
            missing,
            proof,
        })
    }
}
