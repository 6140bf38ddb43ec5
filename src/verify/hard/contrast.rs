//! A block on a block that is up to 1e9 times softer or stiffer, their meshes not matching.

use super::case::Case;
use super::friction::elastic;
use crate::body::{CellKind, graded, rectangle};
use crate::error::Error;
use crate::scene::{Scene, SceneLoad};
use crate::verify::scenes::{body, hold, pair};

/// Pull on the top, as a part of the pressure there; friction holds 0.3.
const PULL: f64 = 0.1;

/// Two unit blocks under unit pressure; the upper one's sides held or nothing of it.
fn stacked(contrast: f64, friction: f64, held: bool, pull: f64) -> Result<Scene, Error> {
    let block = |low: f64, cells: usize| {
        let side = graded(0.0, 1.0, cells, 1.0)?;
        rectangle(&side, &graded(low, low + 1.0, cells, 1.0)?, CellKind::Quad4)
    };
    let lower = body("lower", block(0.0, 5)?, elastic(1000.0, 0.3));
    let lower = hold(hold(lower, "bottom", 1, 0.0), "left", 0, 0.0);
    let mut upper = body("upper", block(1.0, 7)?, elastic(1000.0 * contrast, 0.3));
    if held {
        upper = hold(upper, "left", 0, 0.0);
    }
    let group = "top".into();
    let traction = vec![pull, -1.0];
    upper.loads.push(SceneLoad::Traction { traction, group });
    Ok(pair([lower, upper], ["top", "bottom"], friction))
}

pub(super) fn cases() -> Result<Vec<Case>, Error> {
    let mut cases = Vec::new();
    for power in -9..=9 {
        let contrast = 10_f64.powi(power);
        let name = |what: &str| format!("1e{power}, {what}");
        // Uniform pressure is exact on any meshes; the softer block's round-off is that of the
        // stiffer one's stiffness only through a compliance that is a sum of both.
        let patch = stacked(contrast, 0.0, true, 0.0)?;
        let patch = Case::scene("stiffness contrast", name("patch"), patch);
        cases.push(
            patch
                .presses(1e-9, 1.0)
                .knows("uniform pressure", 1e-8, |answer| {
                    let Some(solution) = &answer.solution else {
                        return Ok(f64::NAN);
                    };
                    let pressures = solution.report()?.contacts.into_iter();
                    Ok(pressures
                        .map(|contact| (contact.pressure.unwrap_or(f64::NAN) - 1.0).abs())
                        .fold(0.0, |worst: f64, error| {
                            if error > worst || error.is_nan() {
                                error
                            } else {
                                worst
                            }
                        }))
                }),
        );
        let sheared = stacked(contrast, 0.3, true, PULL)?;
        cases.push(Case::scene("stiffness contrast", name("sheared"), sheared).presses(1e-9, 1.0));
        // Statics alone: the reactions of a floating block are right to the tolerance of 1e-12, less
        // the contrast's share of the digits.
        let floating = Case::scene(
            "stiffness contrast",
            name("floating"),
            stacked(contrast, 0.3, false, PULL)?,
        );
        cases.push(
            floating
                .presses(1e-9, 1.0)
                .knows("friction", 1e-8, |answer| {
                    Ok((answer.friction().abs() / PULL - 1.0).abs())
                }),
        );
    }
    Ok(cases)
}
