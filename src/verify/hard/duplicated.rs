//! Contacts that say the same twice, or nearly: forces are then not unique, displacements are.

use faer::Mat;

use super::case::{Case, apart};
use super::friction::dragged;
use crate::alternation;
use crate::alternation::Settings;
use crate::condensation::Condensed;
use crate::error::Error;
use crate::kkt::Judge;
use crate::problem::{ContactProblem, Operator};

const CELLS: usize = 24;

/// Both copies pressed at once have no state; the one that the turn opens is apart by the angle times
/// the slip, which is 1e-5 m.
const ANGLES: [f64; 10] = [
    0.0, 1e-15, 1e-13, 1e-12, 1e-11, 1e-10, 1e-9, 1e-8, 1e-6, 1e-4,
];

/// Above this friction single contacts may have several states.
const UNIQUE: f64 = 3.0;

/// Of the tolerance 1e-12 a compliance without inverse leaves displacements their digits; a turn moves
/// them and the edges of the disc by its angle, and tilts what each copy carries.
fn within(friction: f64, angle: f64) -> f64 {
    1e-9 + 2.0 * (1.0 + friction) * angle
}

/// How far what both copies carry together is from a state of single contacts. A turn changes gaps by
/// its angle times the slip, so that this is measured beside the force that would undo the slip.
fn departure(single: &ContactProblem, joined: &[f64]) -> f64 {
    let verdict = Judge::new(single).measure(joined);
    let (mut force, mut slip) = (0.0_f64, 0.0_f64);
    for (k, t) in joined.iter().enumerate() {
        force = force.hypot(*t);
        if k % 2 == 1 {
            slip = slip.hypot(verdict.displacement[k] / single.compliance()[(k - 1, k - 1)]);
        }
    }
    verdict.certificate.natural_map * force / (force + slip)
}

/// What both copies carry, in the axes of the first.
fn joined(reaction: &[f64], angle: f64) -> Vec<f64> {
    let (sin, cos) = angle.sin_cos();
    let (first, second) = reaction.split_at(reaction.len() / 2);
    let pairs = first.chunks(2).zip(second.chunks(2));
    let sums = pairs.map(|(a, b)| {
        [
            a[0] + cos * b[0] - sin * b[1],
            a[1] + sin * b[0] + cos * b[1],
        ]
    });
    sums.flatten().collect()
}

/// Every contact of a plane problem once more, turned by an angle.
fn twice(single: &ContactProblem, angle: f64) -> Result<ContactProblem, Error> {
    let (contacts, (sin, cos)) = (single.contacts(), angle.sin_cos());
    let turned = |unknown: usize| -> [(usize, f64); 2] {
        let (contact, axis) = (unknown / 2, unknown % 2);
        let first = 2 * (contact % contacts);
        match (contact < contacts, axis) {
            (true, _) => [(first + axis, 1.0), (first + axis, 0.0)],
            (false, 0) => [(first, cos), (first + 1, sin)],
            (false, _) => [(first, -sin), (first + 1, cos)],
        }
    };
    let g = single.compliance();
    let entry = |i: usize, j: usize| -> f64 {
        let pairs = turned(i)
            .into_iter()
            .flat_map(|a| turned(j).map(|b| (a, b)));
        pairs.map(|((k, x), (l, y))| x * g[(k, l)] * y).sum()
    };
    let size = 2 * single.unknowns();
    let compliance = Mat::from_fn(size, size, |i, j| entry(i.min(j), i.max(j)));
    let u = single.free_displacement();
    let free = (0..size).map(|k| turned(k).iter().map(|(k, x)| x * u[*k]).sum());
    ContactProblem::new(
        &vec![1; 2 * contacts],
        single.friction().repeat(2),
        single.initial_gap().repeat(2),
        free.collect(),
        Operator::from_compliance(compliance)?,
    )
}

pub(super) fn cases() -> Result<Vec<Case>, Error> {
    let mut cases = Vec::new();
    for friction in [0.0_f64, 0.3, 1.0, 3.0, 10.0] {
        for angle in ANGLES {
            let mechanics = dragged(CELLS, 0.2, friction.max(1e-3))?.mechanics()?;
            let condensed = Condensed::new(&mechanics.bodies, &mechanics.contacts)?;
            let single = condensed.problem().with_friction(vec![friction; CELLS])?;
            let name = format!("turned by {angle:e}, mu {friction}");
            let case = Case::bare("duplicated contacts", name, twice(&single, angle)?);
            let alone = single.clone();
            let case = case.knows(
                "a state of single contacts",
                within(friction, angle),
                move |answer| Ok(departure(&alone, &joined(&answer.outcome.reaction, angle))),
            );
            cases.push(match friction > UNIQUE {
                true => case,
                false => case.knows(
                    "displacements of single contacts",
                    within(friction, angle),
                    move |answer| {
                        let alone = alternation::solve(&single, &Settings::default())?;
                        let found = &answer.outcome.verdict.displacement[..single.unknowns()];
                        Ok(apart(found, &alone.verdict.displacement))
                    },
                ),
            });
        }
    }
    Ok(cases)
}
