//! OUTER LOOP: D-PANA, the alternation of normal and friction half-steps.
//!
//! ```text
//! predict    which contacts are open, pressed, stuck
//! sweep      t_N ← (H1) with t_T held;  accelerate t_N;  t_T ← (H2) with t_N held
//! finish     Newton steps on the laws (D4), kept only if the judge's residual falls
//! proximal   where a finish fails: a proximal point loop around Newton steps (D6)
//! path       where that fails too, between bodies that are held: surfaces brought together from afar (D10),
//!            or contacts joined one with the other (D13); between those that float: what sliding contacts open by in
//!            their program is taken away (D19)
//! stop       judge's residual ≤ tolerance
//! ```
//!
//! Bodies that only contact holds have one program over all Coulomb cones, or the convex sets of other laws, in place of
//! both half-steps, with their equilibrium as rows (H8), (H10).
//!
//! Contacts may obey laws beyond Coulomb's (`problem::Law`): bounds of friction and of normal reactions differ, sets that
//! lie elsewhere or are no discs are moved first (D15). Without any the work is the same to the last step.
//!
//! A load step starts from the last state instead: its reaction tells which contacts are open,
//! pressed, stuck, and a finish is tried before any sweep. A neighbouring case starts with a Newton
//! step on what each contact does there.
//!
//! A solved state's derivatives come from the same Newton matrix (D16): [`Linearised`].
//!
//! Bisegna, Lebon, Maceri, C. R. Acad. Sci. Paris I 333 (2001) 1053–1058; Adv. Eng.
//! Software 35 (2004) 595–600.

mod anderson;
mod centred;
mod condition;
mod displacement_method;
mod felt;
mod finish;
mod float;
mod gauss_seidel;
mod history;
mod iterate;
mod last_digits;
mod laws;
mod path;
mod prediction;
mod proximal;
mod rates;
mod run;
mod settings;

pub use anderson::Anderson;
pub use centred::Centred;
pub(crate) use condition::times;
pub use gauss_seidel::GaussSeidel;
pub use history::{Failure, Outcome, Seconds, Shortfall, Status, SweepRecord, Work};
pub(crate) use path::plane::{End, PlanePath};
pub use rates::{Drive, Linearised, Rate, Sides};
pub use settings::{Interrupt, Settings};

use crate::error::{Error, check_finite, check_length};
use crate::problem::ContactProblem;
use centred::on_centred_sets;
use felt::on_felt_motions;
use run::Run;

/// Solves a condensed contact problem.
///
/// # Errors
///
/// Settings outside their range.
pub fn solve(problem: &ContactProblem, settings: &Settings) -> Result<Outcome, Error> {
    settings.validate()?;
    on_centred_sets(problem, settings, |problem, _| {
        on_felt_motions(problem, |problem, _| Ok(run(Run::new(problem, settings))))
    })
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
    check_length("motion", problem.free_modes(), motion.len())?;
    check_length("reaction", problem.unknowns(), reaction.len())?;
    on_centred_sets(problem, settings, |problem, centred| {
        let reaction = centred.reaction(reaction);
        on_felt_motions(problem, |problem, felt| {
            let state = (&reaction[..], &felt(motion)[..]);
            Ok(run(begun(problem, settings, state, None)?))
        })
    })
}

/// Newton steps on the laws from a state (D4), and nothing else: what a sweep for study ends with.
///
/// # Errors
///
/// Those of [`solve_from`].
pub fn finish(
    problem: &ContactProblem,
    settings: &Settings,
    reaction: &[f64],
    motion: &[f64],
) -> Result<Outcome, Error> {
    check_length("motion", problem.free_modes(), motion.len())?;
    check_length("reaction", problem.unknowns(), reaction.len())?;
    on_centred_sets(problem, settings, |problem, centred| {
        let reaction = centred.reaction(reaction);
        on_felt_motions(problem, |problem, felt| {
            let state = (&reaction[..], &felt(motion)[..]);
            Ok(begun(problem, settings, state, None)?.into_outcome())
        })
    })
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
    solve_beside(problem, settings, near, None)
}

/// What [`solve_near`] finds where the neighbour is the same state with fewer digits: its condition is that of this one.
pub(crate) fn solve_again(
    problem: &ContactProblem,
    settings: &Settings,
    near: &Outcome,
) -> Result<Outcome, Error> {
    solve_beside(problem, settings, near, near.condition)
}

fn solve_beside(
    problem: &ContactProblem,
    settings: &Settings,
    near: &Outcome,
    condition: Option<f64>,
) -> Result<Outcome, Error> {
    let displacement = &near.verdict.displacement;
    check_length("displacement", problem.unknowns(), displacement.len())?;
    check_finite("displacement", displacement)?;
    check_length("motion", problem.free_modes(), near.motion.len())?;
    let beyond = problem.beyond(displacement.clone());
    check_length("reaction", problem.unknowns(), near.reaction.len())?;
    on_centred_sets(problem, settings, |problem, centred| {
        let (reaction, beyond) = (
            centred.reaction(&near.reaction),
            centred.displacement(&beyond),
        );
        on_felt_motions(problem, |problem, felt| {
            let state = (&reaction[..], &felt(&near.motion)[..]);
            let mut begun = begun(problem, settings, state, Some(&beyond))?;
            begun.condition = condition;
            Ok(run(begun))
        })
    })
}

/// A solve that begins from a state, after a first finish.
fn begun<'a>(
    problem: &'a ContactProblem,
    settings: &'a Settings,
    (reaction, motion): (&[f64], &[f64]),
    beyond: Option<&[f64]>,
) -> Result<Run<'a>, Error> {
    settings.validate()?;
    check_length("reaction", problem.unknowns(), reaction.len())?;
    check_finite("reaction", reaction)?;
    check_finite("motion", motion)?;
    let mut run = Run::new(problem, settings);
    run.begin_from(reaction, motion, beyond);
    Ok(run)
}

fn run(mut run: Run<'_>) -> Outcome {
    let mut cold = !run.is_solved();
    if cold {
        run.predict();
    }
    while cold || run.goes_on() {
        cold = false;
        run.begin_sweep();
        match run.problem.floating() {
            None => {
                run.normal_half_step();
                run.accelerate();
                run.friction_half_step();
            }
            Some(floating) => run.coulomb_program(floating),
        }
        run.judge();
        run.newton_finish();
        run.doubt_equilibrium();
        run.proximal_steps();
        run.follow_a_path();
        run.end_sweep();
    }
    run.into_outcome()
}
