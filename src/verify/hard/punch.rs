//! Punches with sharp corners, where pressure has no bound, and contact up to a support.

use super::case::Case;
use super::friction::elastic;
use crate::body::{CellKind, graded, rectangle};
use crate::error::Error;
use crate::scene::{Scene, SceneLoad};
use crate::verify::scenes::{body, hold, on, pair, plane};

/// Force on a punch, in newton per metre.
const FORCE: f64 = 1e6;

/// A punch of width 1 on a block of width 6, four cells of the one on one cell of the other or not at all matching.
fn punch(cells: [usize; 2], contrast: f64, friction: f64) -> Result<Scene, Error> {
    let line = |from: f64, to: f64, cells: usize| graded(from, to, cells, 1.0);
    let base = rectangle(
        &line(-3.0, 3.0, 6 * cells[1])?,
        &line(-2.0, 0.0, 2 * cells[1])?,
        CellKind::Quad4,
    )?;
    let base = hold(body("base", base, elastic(1e9, 0.3)), "bottom", 1, 0.0);
    let base = hold(base, "bottom", 0, 0.0);
    let punch = rectangle(
        &line(-0.5, 0.5, cells[0])?,
        &line(0.0, 1.0, cells[0])?,
        CellKind::Quad4,
    )?;
    let mut punch = body("punch", punch, elastic(1e9 * contrast, 0.3));
    punch = hold(punch, "top", 0, 0.0);
    let (group, pressure) = ("top".into(), FORCE);
    punch.loads.push(SceneLoad::Pressure { pressure, group });
    Ok(pair([punch, base], ["bottom", "top"], friction))
}

/// A square on a plane, one side of it held in one direction or in both down to the contact.
fn beside_a_support(cells: usize, both: bool, friction: f64) -> Result<Scene, Error> {
    let side = graded(0.0, 1.0, cells, 1.0)?;
    let mesh = rectangle(&side, &side, CellKind::Quad4)?;
    let mut block = hold(body("block", mesh, elastic(1e9, 0.3)), "right", 0, 0.0);
    if both {
        block = hold(block, "right", 1, 0.0);
    }
    for (group, pressure) in [("top", 1e6), ("left", 5e5)] {
        let group = group.into();
        block.loads.push(SceneLoad::Pressure { pressure, group });
    }
    Ok(on(plane(&[0.0, 1.0]), block, "bottom", friction))
}

pub(super) fn cases() -> Result<Vec<Case>, Error> {
    let mut cases = Vec::new();
    for friction in [0.0, 0.3, 1.0, 5.0] {
        for (cells, contrast) in [
            ([8, 4], 1.0),
            ([9, 5], 1e3),
            ([24, 8], 1e3),
            ([7, 11], 1e-3),
        ] {
            let name = format!(
                "punch {} on {} cells, 1 : {contrast:e}, mu {friction}",
                cells[0], cells[1]
            );
            let scene = punch(cells, contrast, friction)?;
            // Statics, certified to 1e-12, less three digits for the contrast.
            cases.push(Case::scene("corner", name, scene).presses(1e-9, FORCE));
        }
        for both in [false, true] {
            let held = if both { "clamped" } else { "held along x" };
            let name = format!("contact up to a side {held}, mu {friction}");
            let case = Case::scene("corner", name, beside_a_support(24, both, friction)?);
            // Sums of K u, up to a thousand times as large as what is left of them.
            cases.push(case.knows("normal and support force", 1e-9, |answer| {
                Ok(((answer.held(0, 1) - answer.normal()) / 1e6 - 1.0).abs())
            }));
        }
    }
    Ok(cases)
}
