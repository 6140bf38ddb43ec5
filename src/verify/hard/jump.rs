//! Friction that jumps from contact to contact, from nothing to much.

use super::case::Case;
use super::friction::dragged;
use crate::condensation::Condensed;
use crate::error::Error;
use crate::problem::ContactProblem;

/// Friction at a contact, by its place along the surface in [0, 1) and its number.
type Along = fn(f64, usize) -> f64;

const PATTERNS: [(&str, Along); 6] = [
    ("from 0 to 1 evenly", |x, _| x),
    ("0 and 1 in turn", |_, contact| (contact % 2) as f64),
    ("0 then 2", |x, _| if x < 0.5 { 0.0 } else { 2.0 }),
    ("2 then 0", |x, _| if x < 0.5 { 2.0 } else { 0.0 }),
    ("1e-6 and 5 in turn", |_, contact| [1e-6, 5.0][contact % 2]),
    ("stripes of 0.1, 1 and 10", |x, _| {
        [0.1, 1.0, 10.0][(12.0 * x) as usize % 3]
    }),
];

/// The square with friction of a pattern.
fn square(cells: usize, along: Along) -> Result<ContactProblem, Error> {
    // With friction everywhere, so that every contact has its tangent.
    let mechanics = dragged(cells, 0.2, 1.0)?.mechanics()?;
    let condensed = Condensed::new(&mechanics.bodies, &mechanics.contacts)?;
    let problem = condensed.problem();
    let count = problem.contacts();
    let friction = (0..count).map(|contact| along(contact as f64 / count as f64, contact));
    problem.with_friction(friction.collect())
}

pub(super) fn cases() -> Result<Vec<Case>, Error> {
    let mut cases = Vec::new();
    for cells in [24, 48] {
        for (pattern, along) in PATTERNS {
            let name = format!("{cells} cells, {pattern}");
            let case = Case::bare("friction that jumps", name, square(cells, along)?);
            // (L2) to the tolerance of the solve: a smooth contact among rough ones has no friction.
            cases.push(case.knows("friction where there is none", 1e-12, |answer| {
                let (problem, t) = (&answer.problem, &answer.outcome.reaction);
                let largest = t.iter().fold(0.0_f64, |most, t| most.max(t.abs()));
                let smooth = (0..problem.contacts()).filter(|&k| problem.friction()[k] == 0.0);
                let worst = smooth.fold(0.0_f64, |most, k| {
                    most.max(t[problem.normals()[k] + 1].abs())
                });
                Ok(worst / largest)
            }));
        }
    }
    Ok(cases)
}
