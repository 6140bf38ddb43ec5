//! One scene of half-spaces under many loads, coefficients of friction and drags.

use super::cases::combinations;
use super::quantities::{Quantities, Variation};
use crate::error::Error;
use crate::half_space::{HalfSpaceOutcome, HalfSpaceStatus};
use crate::report::{Cell, HalfSpaceStep, Table};
use crate::scene::HalfSpaceScene;

/// What a variation changes; the axis of a drag.
#[derive(Clone, Copy)]
enum Drive {
    Load,
    Approach,
    Friction,
    Shift(usize),
    Force(usize),
}

/// Their names.
const KNOWN: [(&str, Drive); 7] = [
    ("load", Drive::Load),
    ("approach", Drive::Approach),
    ("friction", Drive::Friction),
    ("shift_x", Drive::Shift(0)),
    ("shift_y", Drive::Shift(1)),
    ("force_x", Drive::Force(0)),
    ("force_y", Drive::Force(1)),
];

/// Solves a scene of half-spaces for every combination of values, all with one operator, and tabulates
/// totals, area, [stiffness](crate::half_space::HalfSpaceProblem::normal_stiffness), status and
/// certificate; the last variation changes fastest, and along it every case starts from the one before.
/// No case remembers the slip of another.
///
/// Quantities: `load`, `approach`, `friction`, `shift_x`, `shift_y`, `force_x`, `force_y`. `done` is told
/// after every case how many of how many are solved.
///
/// # Errors
///
/// Whatever is wrong with the scene, a scene with steps or rolling, a quantity that there is not or
/// that is given twice, a value that the quantity cannot take.
pub fn half_space_cases(
    scene: &HalfSpaceScene,
    variations: &[Variation],
    mut done: impl FnMut(usize, usize),
) -> Result<Table, Error> {
    for (place, has) in [
        ("steps", !scene.steps.is_empty()),
        ("rolling", scene.rolling.is_some()),
    ] {
        if has {
            return Err(Error::NotAccepted {
                place: place.to_owned(),
                found: "a history".to_owned(),
                accepted: "a scene of one state, of which `cases` solves many".to_owned(),
            });
        }
    }
    let known = KNOWN.map(|(name, drive)| (name.to_owned(), drive));
    let drives = Quantities(known.to_vec()).find_all(variations)?;
    let cases = combinations(variations);
    let along = variations.last().map_or(1, |last| last.values.len());
    let first = put(scene, &drives, &cases[0]).history()?;
    let mut table = Table::default();
    let mut near: Option<HalfSpaceOutcome> = None;
    for (number, values) in cases.iter().enumerate() {
        let stated = put(scene, &drives, values);
        let (press, drag) = stated.drives()?[0];
        let problem = first.problem.clone().with_friction(&[stated.friction])?;
        let problem = problem.pressed(press)?.dragged(drag)?;
        let outcome = match near.filter(|_| number % along > 0) {
            Some(near) => problem.solve_from(&near.state, first.tolerance)?,
            None => problem.solve_to(first.tolerance)?,
        };
        let step = HalfSpaceStep::new(number + 1, &problem, &outcome, None);
        let stiffness = Cell::Number(problem.normal_stiffness(&outcome)?);
        let names = variations.iter().map(|variation| variation.name.clone());
        let given = names.zip(values.iter().map(|&value| Cell::Number(value)));
        // What is varied is no column of results as well.
        let given_once = |(name, _): &(String, Cell)| variations.iter().all(|v| v.name != *name);
        let found = step.row().into_iter().filter(given_once);
        let stiffness = [("stiffness".to_owned(), stiffness)];
        table.add(given.chain(found).chain(stiffness));
        // What slides as a whole may be anywhere.
        let most = scene.half_space.size[0].max(scene.half_space.size[1]);
        let here = outcome.state.shift.iter().all(|shift| shift.abs() <= most);
        near = (here && outcome.status == HalfSpaceStatus::Certified).then_some(outcome);
        done(number + 1, cases.len());
    }
    Ok(table)
}

/// The scene under the values of a case; what is varied takes the place of what it excludes.
fn put(scene: &HalfSpaceScene, drives: &[Drive], values: &[f64]) -> HalfSpaceScene {
    let mut scene = scene.clone();
    let varied = |wanted: fn(&Drive) -> bool| drives.iter().any(wanted);
    let presses = varied(|d| matches!(d, Drive::Load)) || varied(|d| matches!(d, Drive::Approach));
    if presses {
        (scene.load, scene.approach) = (None, None);
    }
    if varied(|d| matches!(d, Drive::Shift(_))) {
        scene.force = None;
    }
    if varied(|d| matches!(d, Drive::Force(_))) {
        scene.shift = None;
    }
    for (drive, &value) in drives.iter().zip(values) {
        match drive {
            Drive::Load => scene.load = Some(value),
            Drive::Approach => scene.approach = Some(value),
            Drive::Friction => scene.friction = value,
            Drive::Shift(axis) => scene.shift.get_or_insert_default()[*axis] = value,
            Drive::Force(axis) => scene.force.get_or_insert_default()[*axis] = value,
        }
    }
    scene
}
