//! Contacts that say the same twice, or nearly: forces are then not unique, displacements are.

use faer::Mat;

use super::case::{Case, apart};
use super::friction::dragged;
use crate::condensation::{Condensed, ContactProblem, Operator};
use crate::dpana::{self, Settings};
use crate::error::Error;

const CELLS: usize = 24;

/// Turned by less than what the operator's shift of a singular compliance resolves.
const UNRESOLVED: &str = "both copies pressed have no state, and the turn that decides which one is \
                          opens it by 1e-14 m";

/// Friction and turns that are not certified.
const BEYOND: [(f64, f64); 7] = [
    (0.0, 1e-12),
    (0.0, 1e-9),
    (0.3, 1e-12),
    (0.3, 1e-9),
    (1.0, 1e-12),
    (1.0, 1e-9),
    (3.0, 1e-9),
];

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
    for friction in [0.0_f64, 0.3, 1.0, 3.0] {
        for angle in [0.0, 1e-12, 1e-9, 1e-6] {
            let mechanics = dragged(CELLS, 0.2, friction.max(1e-3))?.mechanics()?;
            let condensed = Condensed::new(&mechanics.bodies, &mechanics.contacts)?;
            let single = condensed.problem().with_friction(vec![friction; CELLS])?;
            let name = format!("turned by {angle:e}, mu {friction}");
            let case = Case::bare("duplicated contacts", name, twice(&single, angle)?);
            // Of the tolerance 1e-12 a compliance without inverse leaves displacements their digits;
            // a turn moves them by its angle.
            let case = case.knows(
                "displacements of single contacts",
                1e-9 + 2.0 * angle,
                move |answer| {
                    let alone = dpana::solve(&single, &Settings::default())?;
                    let found = &answer.outcome.verdict.displacement[..single.unknowns()];
                    Ok(apart(found, &alone.verdict.displacement))
                },
            );
            cases.push(match BEYOND.contains(&(friction, angle)) {
                true => case.beyond(UNRESOLVED),
                false => case,
            });
        }
    }
    Ok(cases)
}
