//! The steps for bodies that contact alone holds.
//!
//! With equilibrium as rows in both half-steps the resultants of normal and friction forces
//! would each stay what they were at the start, which is wrong on anything but a plane. So all
//! Coulomb cones stand in one program, whose fixed point under the shift `μ ‖u_T‖` is the
//! solution (Acary, Cadoux, Lemaréchal, Malick, Z. Angew. Math. Mech. 91 (2011) 155–175); it is
//! infeasible exactly where no admissible equilibrium exists.

use std::time::Instant;

use super::iterate::Motion;
use super::run::Run;
use super::{Failure, Shortfall};
use crate::cone::CoulombProgram;
use crate::kkt;
use crate::limit::{Equilibrium, RigidContacts};
use crate::problem::{Floating, Law};

/// The judge believes a failing motion that would take reactions of more than this times the load.
const IMPOSSIBLE: f64 = 1e3;

/// A program that leaves more of the load than this part is doubted.
const UNHELD: f64 = 1e-6;

/// Tolerance of the program: its state is a start for Newton steps.
const TOLERANCE: f64 = 1e-8;

impl Run<'_> {
    /// After a first program that led nowhere, asks whether any admissible reactions hold the
    /// bodies; a motion that proves the contrary, and that the judge believes, ends the run.
    pub(super) fn doubt_equilibrium(&mut self) {
        let Some(floating) = self.problem.floating() else {
            return;
        };
        let laws = self.problem.laws().unwrap_or_default();
        let bounded = laws.iter().all(Law::is_within_coulomb);
        if self.is_solved() || self.work.sweeps > 1 {
            return;
        }
        let start = Instant::now();
        if let Some(contacts) = RigidContacts::of(self.problem, floating) {
            // Beyond Coulomb's cone reactions have no other bound than that they do no work on what moves no contact.
            let found = match bounded {
                true => contacts.admissible(floating.load()).ok(),
                false => contacts.idle(floating.load()),
            };
            if let Some(Equilibrium::Impossible { motion, excess }) = found {
                self.failure = self.believe(&contacts, floating, motion, Some(excess));
            } else if let Some(motion) = self.doubted.clone() {
                let (motion, _) = contacts.at_unit_speed(motion, floating.load());
                self.failure = self.believe(&contacts, floating, motion, None);
            }
        }
        self.work.seconds.coulomb += start.elapsed().as_secs_f64();
    }

    /// (H8) with the equilibrium of the bodies that float.
    pub(super) fn coulomb_program(&mut self, floating: &Floating) {
        let start = Instant::now();
        let none = vec![0.0; self.problem.contacts()];
        let program = CoulombProgram::new(self.problem, floating.modes());
        match program.and_then(|mut program| program.solve(floating.load(), &none, TOLERANCE)) {
            Some(solution) => {
                self.record.coulomb_iterations = solution.iterations;
                self.work.cone_iterations += solution.iterations;
                self.work.coulomb_programs += 1;
                let doubted = self.problem.laws().is_some() && solution.remainder > UNHELD;
                self.doubted = doubted.then_some(solution.multipliers);
                self.state.reaction = solution.reaction;
                self.state.motion = Motion::of(solution.motion);
            }
            None => self.shortfall = Some(Shortfall::ConeSolver),
        }
        self.work.seconds.coulomb += start.elapsed().as_secs_f64();
    }

    /// The failure that a motion proves, if it does. Where `missing` is left out it is what the laws leave of the load's work.
    fn believe(
        &self,
        contacts: &RigidContacts,
        floating: &Floating,
        motion: Vec<f64>,
        missing: Option<f64>,
    ) -> Option<Failure> {
        let proof = self.proof(floating, &motion)?;
        let load = floating.load().iter().fold(0.0, |s: f64, e| s.hypot(*e));
        let apparent = contacts.failure(&motion);
        (proof.least_reaction > IMPOSSIBLE * load).then_some(Failure {
            motion,
            apparent: apparent.motion,
            sliding: apparent.sliding,
            opening: apparent.opening,
            missing: missing.unwrap_or(proof.work),
            proof,
            elastic: false,
        })
    }

    /// Whether springs that soften let the bodies move farther than `far`, in metre, since an earlier motion:
    /// nothing else holds them.
    pub(super) fn give_way(&mut self, before: &Motion, far: f64) -> bool {
        self.failure = self.elastic_failure(self.state.motion.since(before), far);
        self.failure.is_some()
    }

    fn elastic_failure(&self, motion: Vec<f64>, far: f64) -> Option<Failure> {
        let floating = self.problem.floating()?;
        let contacts = RigidContacts::of(self.problem, floating)?;
        let moved = contacts.velocity(&motion);
        if moved.iter().fold(0.0_f64, |most, v| most.max(v.abs())) < far {
            return None;
        }
        let modes = floating.modes().col_iter().zip(floating.load());
        let left = modes.map(|(mode, e)| {
            let held = mode.iter().zip(&self.state.reaction);
            e + held.map(|(r, t)| r * t).sum::<f64>()
        });
        let (motion, missing) = contacts.at_unit_speed(motion, &left.collect::<Vec<_>>());
        let apparent = contacts.failure(&motion);
        Some(Failure {
            proof: self.proof(floating, &motion)?,
            apparent: apparent.motion,
            sliding: apparent.sliding,
            opening: apparent.opening,
            motion,
            missing,
            // What the program could not hold rigid bodies may not hold either.
            elastic: self.doubted.is_none(),
        })
    }

    /// What the judge finds of a motion.
    fn proof(&self, floating: &Floating, motion: &[f64]) -> Option<kkt::Impossibility> {
        let (offsets, friction) = (self.problem.offsets(), self.problem.friction());
        if self.problem.laws().is_some() {
            return kkt::impossibility_under_laws(self.problem, floating, motion).ok();
        }
        kkt::impossibility(offsets, friction, floating.modes(), floating.load(), motion).ok()
    }
}
