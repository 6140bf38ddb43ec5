//! Thousands of contacts on thin layers.

use super::Reach;
use super::case::Case;
use super::friction::elastic;
use crate::body::{CellKind, box_mesh, graded, rectangle};
use crate::error::Error;
use crate::scene::{Scene, SceneSupport};
use crate::verify::scenes::{body, on, plane};

/// Contacts along a layer in 2D, and along each side of one in 3D (3025 in all).
const ALONG: usize = 4000;
const EACH_SIDE: usize = 55;

/// A layer of two cells of one unit, its top pushed down and along: it sticks inside, and slips and
/// opens at its ends.
fn layer(dimension: usize) -> Result<Scene, Error> {
    let line = |contacts: usize| graded(0.0, (contacts - 1) as f64, contacts - 1, 1.0);
    let up = graded(0.0, 2.0, 2, 1.0)?;
    let mesh = match dimension {
        2 => rectangle(&line(ALONG)?, &up, CellKind::Quad4)?,
        _ => box_mesh(&line(EACH_SIDE)?, &line(EACH_SIDE)?, &up, CellKind::Hex8)?,
    };
    let mut layer = body("layer", mesh, elastic(1e9, 0.3));
    let mut pushed = vec![Some(0.0); dimension];
    pushed[0] = Some(2e-3);
    pushed[dimension - 1] = Some(-5e-3);
    layer.supports.push(SceneSupport::Group {
        group: "top".into(),
        displacement: pushed,
    });
    let mut normal = vec![0.0; dimension];
    normal[dimension - 1] = 1.0;
    Ok(on(plane(&normal), layer, "bottom", 0.3))
}

pub(super) fn cases() -> Result<Vec<Case>, Error> {
    let case = |dimension: usize, name: &str| -> Result<Case, Error> {
        let case = Case::scene("many contacts", name.to_owned(), layer(dimension)?);
        // What the contacts give the supports give back: sums over thousands of nodes.
        let case = case.knows("contact and support force", 1e-9, move |answer| {
            let held = answer.held(0, dimension - 1);
            Ok((answer.normal() / held - 1.0).abs())
        });
        Ok(case.reach(Reach::Largest))
    };
    Ok(vec![case(2, "layer in 2D")?, case(3, "layer in 3D")?])
}
