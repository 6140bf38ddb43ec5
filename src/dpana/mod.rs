//! OUTER LOOP: D-PANA, sweeps of normal and friction half-steps.
//!
//! ```text
//! predict    which contacts are open, pressed, stuck
//! sweep      t_N ← (H1) with t_T held;  accelerate t_N;  t_T ← (H2) with t_N held
//! finish     semismooth Newton on the laws, kept only if the judge's residual falls
//! stop       judge's residual ≤ tolerance
//! ```
//!
//! Bodies that only contact holds have one program over all Coulomb cones in place of both
//! half-steps, with their equilibrium as rows (H8).
//!
//! Bisegna, Lebon, Maceri, C. R. Acad. Sci. Paris I 333 (2001) 1053–1058; Adv. Eng.
//! Software 35 (2004) 595–600.

mod anderson;
mod finish;
mod float;
mod gauss_seidel;
mod history;
mod prediction;
mod settings;
mod state;
mod stiffness;
mod sweep;

pub use history::{Failure, Outcome, Seconds, Status, SweepRecord, Work};
pub use settings::{Settings, Variant};

use crate::condensation::ContactProblem;
use crate::error::Error;
use sweep::Run;

/// Solves a condensed contact problem.
///
/// # Errors
///
/// Settings outside their range, and a variant for study on bodies that float.
pub fn solve(problem: &ContactProblem, settings: &Settings) -> Result<Outcome, Error> {
    settings.validate()?;
    let mut run = Run::new(problem, settings);
    match (settings.variant, problem.floating()) {
        (Variant::Default, Some(floating)) => {
            while run.goes_on() {
                run.begin_sweep();
                run.coulomb_program(floating);
                run.judge();
                run.shift_by_slip();
                run.newton_finish();
                run.end_sweep();
                run.doubt_equilibrium(floating);
            }
        }
        (variant, Some(_)) => {
            return Err(Error::NotAccepted {
                place: "settings.variant".to_owned(),
                found: format!("{variant:?}"),
                accepted: "Default, as supports do not hold every body".to_owned(),
            });
        }
        (Variant::Default, None) => {
            let mut cold = !run.is_solved();
            if cold {
                run.predict();
            }
            while cold || run.goes_on() {
                cold = false;
                run.begin_sweep();
                run.normal_half_step();
                run.accelerate();
                run.friction_half_step();
                run.judge();
                run.newton_finish();
                run.end_sweep();
            }
        }
        (Variant::Plain, None) => {
            while run.goes_on() {
                run.begin_sweep();
                run.normal_half_step();
                run.friction_half_step();
                run.judge();
                run.end_sweep();
            }
        }
        (Variant::Nsgs, None) => {
            while run.goes_on() {
                run.begin_sweep();
                run.gauss_seidel_pass();
                run.end_sweep();
            }
        }
    }
    Ok(run.into_outcome())
}
