//! How a solve went: status, sweep by sweep, and the work it took.

use crate::kkt::{Impossibility, Verdict};

/// A solved contact problem.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Outcome {
    /// Certified, or not.
    pub status: Status,
    /// Why the solve ended without a certificate, with [`Status::NotConverged`].
    pub shortfall: Option<Shortfall>,
    /// Condition of the last Newton matrix, each unknown in units of its own (D7), about: a residual of r
    /// leaves reactions wrong by up to so many r; none where no Newton step was needed.
    pub condition: Option<f64>,
    /// Reaction per unknown, in newton.
    pub reaction: Vec<f64>,
    /// Rigid motion α in metre, per free mode of bodies that float; else empty.
    pub motion: Vec<f64>,
    /// What the rounding of `motion` leaves out, in metre: the certificate is that of their sum. Contacts feel it
    /// only where bodies move millions of times as far as contacts indent.
    pub motion_left_out: Vec<f64>,
    /// Why nothing holds the bodies, with [`Status::NoEquilibrium`].
    pub failure: Option<Failure>,
    /// The judge's last word: displacement, state of each contact, residuals.
    pub verdict: Verdict,
    /// One record per sweep.
    pub history: Vec<SweepRecord>,
    /// What it took.
    pub work: Work,
}

impl Seconds {
    /// Of all stages.
    pub(crate) fn total(&self) -> f64 {
        let programs = self.coulomb + self.normal + self.friction;
        self.predict + programs + self.finish + self.judge
    }
}

impl Outcome {
    /// This one, with what led to the one that it goes on from.
    pub(crate) fn after(mut self, before: Self) -> Self {
        self.history.splice(0..0, before.history);
        self.work = before.work.and(self.work);
        self.condition = self.condition.or(before.condition);
        self
    }
}

/// A rigid motion that no contact resists while the load works on it.
#[derive(Clone, Debug, PartialEq)]
pub struct Failure {
    /// α, per free mode; its fastest sliding (if none slides, opening) contact has unit speed.
    pub motion: Vec<f64>,
    /// The same without the opening of sliding contacts (H9): how the bodies begin to move.
    pub apparent: Vec<f64>,
    /// Contacts that slide.
    pub sliding: Vec<usize>,
    /// Contacts that open.
    pub opening: Vec<usize>,
    /// The force that is missing at that contact, in newton.
    pub missing: f64,
    /// What the judge found of the motion.
    pub proof: Impossibility,
    /// Rigid bodies could be held; these give way: their contacts carry all they can, and the motion
    /// goes on without more resistance.
    pub elastic: bool,
}

/// How a solve ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// The judge's residual is at most the tolerance, see [`Settings::tolerance`](super::Settings::tolerance).
    Certified,
    /// The best state found is returned with its residuals; it is not certified: see
    /// [`Outcome::shortfall`].
    NotConverged,
    /// No admissible contact forces hold the bodies: see [`Outcome::failure`].
    NoEquilibrium,
    /// The problem is solved, but the bodies of the scene are not in the state that it says: forces that
    /// their sides exchange, or distances between them, are off by more than rounding and mesh explain.
    /// Said of scenes, never of a bare problem.
    CouplingFault,
}

/// Why a solve ended without a certificate; the best state found is returned all the same.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shortfall {
    /// The sweeps that the settings allow ran out.
    SweepLimit,
    /// So many sweeps, one after the other, led to no better state.
    Stalled {
        /// Their number.
        sweeps: usize,
    },
    /// The time that the settings allow ran out.
    TimeLimit,
    /// The flag of the settings was raised.
    Interrupted,
    /// The cone solver gave up on a half-step's program.
    ConeSolver,
    /// Reactions that grow without bound meet no resistance but that of the last digits of G: the
    /// residual is small beside them, and what acts is not answered.
    IllConditioned {
        /// The reaction over what acts.
        excess: f64,
    },
    /// The contacts are solved, but what was recovered of a body is not in equilibrium (K4): its cells
    /// leave the stiffness no digits.
    OutOfBalance {
        /// Which body.
        body: usize,
        /// The force that nothing carries, as a part of the largest on that body, or of loads and contact forces.
        part: f64,
    },
    /// The residual is what the rounding of the reaction itself may leave: the tolerance asks for
    /// more digits than the problem has.
    RoundOff {
        /// Smallest residual that can be asked for, about.
        floor: f64,
    },
}

/// One sweep.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SweepRecord {
    /// The judge's residual at its end.
    pub residual: f64,
    /// Interior-point iterations of the program over all Coulomb cones, for bodies that float.
    pub coulomb_iterations: usize,
    /// Interior-point iterations of the normal half-step.
    pub normal_iterations: usize,
    /// Interior-point iterations of the friction half-step.
    pub friction_iterations: usize,
    /// Newton steps tried after the half-steps.
    pub newton_steps: usize,
    /// Contacts that are open, stick, slip at its end.
    pub open_stick_slip: [usize; 3],
    /// Wall time, in second.
    pub seconds: f64,
}

/// Counts and seconds of a whole solve.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Work {
    /// Gauss–Seidel passes of the prediction (or of the baseline).
    pub passes: usize,
    /// Sweeps.
    pub sweeps: usize,
    /// Programs over all Coulomb cones handed to the cone solver, for bodies that float.
    pub coulomb_programs: usize,
    /// Normal programs handed to the cone solver.
    pub normal_programs: usize,
    /// Friction programs handed to the cone solver.
    pub friction_programs: usize,
    /// Interior-point iterations over all programs.
    pub cone_iterations: usize,
    /// Largest number of contacts that any friction program held.
    pub friction_program_contacts: usize,
    /// Newton steps.
    pub newton_steps: usize,
    /// Subproblems of the proximal loop, solved or thrown away (D6).
    pub proximal_steps: usize,
    /// Contacts that changed what they do, one after the other, on a path from afar (D10).
    pub path_changes: usize,
    /// Steps on a path of contacts that are joined (D13).
    pub path_steps: usize,
    /// Seconds of prediction, half-steps, finish, judge.
    pub seconds: Seconds,
}

impl Work {
    /// What both took.
    fn and(self, more: Self) -> Self {
        Self {
            passes: self.passes + more.passes,
            sweeps: self.sweeps + more.sweeps,
            coulomb_programs: self.coulomb_programs + more.coulomb_programs,
            normal_programs: self.normal_programs + more.normal_programs,
            friction_programs: self.friction_programs + more.friction_programs,
            cone_iterations: self.cone_iterations + more.cone_iterations,
            friction_program_contacts: self
                .friction_program_contacts
                .max(more.friction_program_contacts),
            newton_steps: self.newton_steps + more.newton_steps,
            proximal_steps: self.proximal_steps + more.proximal_steps,
            path_changes: self.path_changes + more.path_changes,
            path_steps: self.path_steps + more.path_steps,
            seconds: Seconds {
                predict: self.seconds.predict + more.seconds.predict,
                coulomb: self.seconds.coulomb + more.seconds.coulomb,
                normal: self.seconds.normal + more.seconds.normal,
                friction: self.seconds.friction + more.seconds.friction,
                finish: self.seconds.finish + more.seconds.finish,
                judge: self.seconds.judge + more.seconds.judge,
            },
        }
    }
}

/// Wall time by stage of the outer loop, in second.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Seconds {
    /// Prediction.
    pub predict: f64,
    /// Programs over all Coulomb cones, and whether anything holds the bodies.
    pub coulomb: f64,
    /// Normal half-steps.
    pub normal: f64,
    /// Friction half-steps.
    pub friction: f64,
    /// Newton finish.
    pub finish: f64,
    /// Judge.
    pub judge: f64,
}
