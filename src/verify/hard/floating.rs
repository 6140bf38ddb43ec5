//! Blocks that nothing but friction holds, up to the limit and beyond.

use super::case::Case;
use super::friction::elastic;
use crate::alternation::Status;
use crate::body::{CellKind, box_mesh, graded, rectangle};
use crate::error::Error;
use crate::scene::{Scene, SceneLoad};
use crate::verify::scenes::{body, on, plane};

/// Pressing force, and side and height of the pad.
const PRESSED: f64 = 12_000.0;
const SIDE: f64 = 20.0;
const HEIGHT: f64 = 10.0;

/// Pulls as parts of what friction holds.
const HELD: [f64; 4] = [0.0, 0.5, 0.99, 0.999_999];
const BEYOND: [f64; 2] = [1.000_1, 2.0];

/// A pad without support, pressed and pulled along its plane, in 2D or 3D.
fn pad(dimension: usize, friction: f64, pull: f64) -> Result<Scene, Error> {
    let (side, up) = (graded(0.0, SIDE, 5, 1.0)?, graded(0.0, HEIGHT, 3, 1.0)?);
    let (mesh, area) = match dimension {
        2 => (rectangle(&side, &up, CellKind::Quad4)?, SIDE),
        _ => (box_mesh(&side, &side, &up, CellKind::Hex8)?, SIDE * SIDE),
    };
    let mut pad = body("pad", mesh, elastic(2.1e5, 0.0));
    let mut normal = vec![0.0; dimension];
    normal[dimension - 1] = 1.0;
    for (group, axis, force) in [("top", dimension - 1, -PRESSED), ("bottom", 0, pull)] {
        let mut traction = vec![0.0; dimension];
        traction[axis] = force / area;
        let group = group.into();
        pad.loads.push(SceneLoad::Traction { traction, group });
    }
    Ok(on(plane(&normal), pad, "bottom", friction))
}

pub(super) fn cases() -> Result<Vec<Case>, Error> {
    let mut cases = Vec::new();
    for dimension in [2, 3] {
        for friction in [0.1, 0.3, 1.0, 3.0] {
            let limit = friction * PRESSED;
            let scene = |part: f64| pad(dimension, friction, part * limit);
            let name =
                |part: f64| format!("pad in {dimension}D, mu {friction}, {part} of its limit");
            for part in HELD {
                // Statics of six forces at a tolerance of 1e-12.
                cases
                    .push(Case::scene("floating", name(part), scene(part)?).presses(1e-9, PRESSED));
            }
            for part in BEYOND {
                // The missing force is a small part of the limit, to which the search is exact.
                let case = Case::scene("floating", name(part), scene(part)?);
                let case = case.ends(Status::NoEquilibrium);
                cases.push(case.knows("missing force", 1e-7, move |answer| {
                    let failure = answer.outcome.failure.as_ref();
                    let missing = failure.map_or(f64::NAN, |failure| failure.missing);
                    Ok((missing / limit - (part - 1.0)).abs())
                }));
            }
        }
    }
    Ok(cases)
}
