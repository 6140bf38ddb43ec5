//! The pipeline of half-spaces: scene → problem → loop and judge → report, step by step.

use crate::error::Error;
use crate::half_space::{HalfSpaceOutcome, HalfSpaceProblem};
use crate::report::{HalfSpaceReport, HalfSpaceStep};
use crate::scene::HalfSpaceScene;

/// Solves a scene of half-spaces; `watch` sees every step with its number, from 1.
///
/// A step starts from the one before, whose slip it remembers. Rolling, if the scene has any, goes on
/// under the last step.
///
/// # Errors
///
/// Whatever is wrong with the scene, and what `watch` gives.
pub fn solve_half_space(
    scene: &HalfSpaceScene,
    mut watch: impl FnMut(usize, &HalfSpaceProblem, &HalfSpaceOutcome) -> Result<(), Error>,
) -> Result<HalfSpaceReport, Error> {
    let history = scene.history()?;
    let mut problem = history.problem;
    let mut last: Option<HalfSpaceOutcome> = None;
    let mut steps = Vec::with_capacity(history.steps.len());
    for (number, (press, drag)) in (1..).zip(&history.steps) {
        let next = problem.clone().pressed(*press)?.dragged(*drag)?;
        let (next, outcome) = match &last {
            None => {
                let outcome = next.solve_to(history.tolerance)?;
                (next, outcome)
            }
            Some(last) => {
                let next = next.following(last)?;
                let outcome = next.solve_from(&last.state, history.tolerance)?;
                (next, outcome)
            }
        };
        let rolls = history.rolling.filter(|_| number == history.steps.len());
        let (outcome, rolled) = match rolls {
            None => (outcome, None),
            Some(creepage) => {
                let (outcome, rolled) = problem.clone().pressed(*press)?.roll(creepage)?;
                (outcome, Some(rolled))
            }
        };
        watch(number, &next, &outcome)?;
        steps.push(HalfSpaceStep::new(number, &next, &outcome, rolled));
        problem = next;
        last = Some(outcome);
    }
    Ok(HalfSpaceReport {
        title: scene.title.clone(),
        units: scene.units.clone(),
        steps,
    })
}
