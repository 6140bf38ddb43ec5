//! OUTER LOOP: D-PANA, the alternation of normal and friction half-steps.
//!
//! ```text
//! predict    which contacts are open, pressed, stuck
//! sweep      t_N ← (H1) with t_T held;  accelerate t_N;  t_T ← (H2) with t_N held
//! finish     semismooth Newton on the laws, kept only if the judge's residual falls
//! path       if that failed twice: friction raised from nothing by Newton steps; then in the plane the
//!            surfaces brought together from afar, in space friction lowered from rough
//! stop       judge's residual ≤ tolerance
//! ```
//!
//! Bodies that only contact holds have one program over all Coulomb cones in place of both
//! half-steps, with their equilibrium as rows (H8).
//!
//! A load step starts from the last state instead: its reaction tells which contacts are open,
//! pressed, stuck, and a finish is tried before any sweep. A neighbouring case starts with a Newton
//! step on what each contact does there.
//!
//! Bisegna, Lebon, Maceri, C. R. Acad. Sci. Paris I 333 (2001) 1053–1058; Adv. Eng.
//! Software 35 (2004) 595–600.

mod anderson;
mod condition;
mod contraction;
mod exact;
mod finish;
mod float;
mod gauss_seidel;
mod history;
mod iterate;
mod path;
mod prediction;
mod run;
mod settings;
mod starts;
mod stiffness;

pub(crate) use contraction::Contraction;
pub use contraction::contraction;
pub(crate) use history::Failure;
pub use history::{Outcome, Seconds, Shortfall, Status, SweepRecord, Work};
pub use path::continuity::{Earlier, WayBack, way_back};
pub(crate) use settings::Mixing;
pub use settings::{Settings, Sweeps, Variant};
pub(crate) use starts::OtherStarts;
pub use starts::other_starts;

use crate::error::{Error, check_finite, check_length};
use crate::problem::ContactProblem;
use run::Run;

/// Solves a condensed contact problem.
///
/// # Errors
///
/// Settings outside their range, and a variant for study on bodies that float.
pub fn solve(problem: &ContactProblem, settings: &Settings) -> Result<Outcome, Error> {
    check(problem, settings)?;
    Ok(run(Run::new(problem, settings)))
}

/// Solves a condensed contact problem from a state that is likely near: that of the load step
/// before, or of a neighbouring load.
///
/// `reaction` is in newton per unknown, `motion` in metre per free mode. Of several solutions
/// (high friction) it finds one near that state.
///
/// # Errors
///
/// Those of [`solve`], and a state that is not of the problem's length or not finite.
pub fn solve_from(
    problem: &ContactProblem,
    settings: &Settings,
    reaction: &[f64],
    motion: &[f64],
) -> Result<Outcome, Error> {
    run_from(problem, settings, reaction, motion, None)
}

/// Solves a condensed contact problem from a solved neighbour: the same contacts under a little
/// more or less load, friction or gap.
///
/// The first Newton step takes each contact's state from the neighbour, so that where no contact
/// changes it no cone program is posed. Of several solutions (high friction) it finds one near
/// that neighbour.
///
/// # Errors
///
/// Those of [`solve`], and a neighbour that is not of the problem's length or not finite.
pub fn solve_near(
    problem: &ContactProblem,
    settings: &Settings,
    near: &Outcome,
) -> Result<Outcome, Error> {
    let displacement = &near.verdict.displacement;
    check_length("displacement", problem.unknowns(), displacement.len())?;
    check_finite("displacement", displacement)?;
    run_from(
        problem,
        settings,
        &near.reaction,
        &near.motion,
        Some(displacement),
    )
}

fn run_from(
    problem: &ContactProblem,
    settings: &Settings,
    reaction: &[f64],
    motion: &[f64],
    displacement: Option<&[f64]>,
) -> Result<Outcome, Error> {
    check(problem, settings)?;
    check_length("reaction", problem.unknowns(), reaction.len())?;
    check_length("motion", problem.free_modes(), motion.len())?;
    check_finite("reaction", reaction)?;
    check_finite("motion", motion)?;
    let mut near = Run::new(problem, settings);
    near.begin_from(reaction, motion, displacement);
    Ok(run(near))
}

fn check(problem: &ContactProblem, settings: &Settings) -> Result<(), Error> {
    settings.validate()?;
    if settings.variant != Variant::Default && problem.floating().is_some() {
        return Err(Error::NotAccepted {
            place: "settings.variant".to_owned(),
            found: format!("{:?}", settings.variant),
            accepted: "Default, as supports do not hold every body".to_owned(),
        });
    }
    Ok(())
}

fn run(mut run: Run<'_>) -> Outcome {
    match (run.variant(), run.problem.floating()) {
        (Variant::Default, Some(floating)) => {
            while run.goes_on() {
                run.begin_sweep();
                run.coulomb_program(Some(floating));
                run.judge();
                run.shift_by_slip();
                run.newton_finish();
                run.end_sweep();
                run.doubt_equilibrium(floating);
            }
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
                run.follow_a_path();
                run.end_sweep();
            }
        }
        (Variant::Sweeps(sweeps), _) => {
            while run.goes_on() {
                run.begin_sweep();
                run.normal_half_step();
                run.mix(sweeps.mixing);
                run.friction_half_step();
                run.judge();
                if sweeps.finish {
                    run.newton_finish();
                }
                run.end_sweep();
            }
        }
        (Variant::FullCone, _) => {
            while run.goes_on() {
                run.begin_sweep();
                run.coulomb_program(None);
                run.judge();
                run.shift_by_slip();
                run.end_sweep();
            }
        }
        (Variant::Nsgs, _) => {
            while run.goes_on() {
                run.begin_sweep();
                run.gauss_seidel_pass();
                run.end_sweep();
            }
        }
    }
    run.into_outcome()
}
