//! A wedge that is pulled up a slope until it slides.

use super::Entry;
use super::ladder::{Ladder, Measured};
use super::scenes::{STEEL, body, on, plane, solved};
use crate::alternation::Status;
use crate::body::{CellKind, graded, rectangle};
use crate::closed_forms::wedge_pull;
use crate::error::Error;
use crate::pipeline::rigid_limit;
use crate::report::{Beyond, Criterion, VerifiedQuantity};
use crate::scene::{Scene, SceneLoad};

pub(super) const ENTRY: Entry = Entry {
    name: "wedge pulled up a slope of 1 : 10",
    source: "NAFEMS CGS-4 (E10)",
    floor: "",
    measure,
    drawn: Some(|| scene(0.2, 4, 0.2)),
};

const SLOPE: f64 = 0.1;

/// Length of the wedge along the slope; its height is 1.
const LENGTH: f64 = 4.0;

/// A wedge of weight 1 that is pulled by a horizontal force.
fn scene(friction: f64, cells: usize, pull: f64) -> Result<Scene, Error> {
    let (sin, cos) = SLOPE.atan().sin_cos();
    let lines = |length, count| graded(0.0, length, count, 1.0);
    let (along, up) = (lines(LENGTH, 4 * cells)?, lines(1.0, cells)?);
    let mut mesh = rectangle(&along, &up, CellKind::Quad4)?;
    for [x, y, _] in &mut mesh.nodes {
        (*x, *y) = (cos * *x - sin * *y, sin * *x + cos * *y);
    }
    let mut wedge = body("wedge", mesh, STEEL);
    wedge.loads = vec![
        SceneLoad::BodyForce {
            body_force: vec![0.0, -1.0 / LENGTH],
            group: None,
        },
        SceneLoad::Traction {
            traction: vec![pull / LENGTH, 0.0],
            group: "bottom".into(),
        },
    ];
    Ok(on(plane(&[-sin, cos]), wedge, "bottom", friction))
}

/// The limit that was found for the pull, and whether the judge certified it.
fn found(friction: f64, cells: usize) -> Result<(f64, bool), Error> {
    let limits = rigid_limit(&scene(friction, cells, 1.0)?)?;
    Ok(match limits.loads.last().map(|load| &load.beyond) {
        Some(Beyond::Grows {
            factor, certified, ..
        }) => (*factor, *certified),
        _ => (f64::NAN, false),
    })
}

fn measure(_quick: bool) -> Result<Vec<VerifiedQuantity>, Error> {
    let mut pull = Ladder::new("limit pull / weight, worst μ");
    let mut elastic = Ladder::new("held below it, not above");
    for cells in [2, 4] {
        let (mut settled, mut all) = (true, Vec::new());
        for friction in [0.0, 0.1, 0.2, 0.3] {
            let (factor, certified) = found(friction, cells)?;
            settled &= certified;
            all.push(Measured::number(factor, wedge_pull(SLOPE, friction)?));
        }
        let (name, size) = (format!("{} × {cells} quad4", 4 * cells), 1.0 / cells as f64);
        pull.climb(&name, size, settled, Measured::worst(all));

        let most = wedge_pull(SLOPE, 0.2)?;
        let mut wrong = 0.0;
        for (part, expected) in [
            (1.0 - 1e-6, Status::Certified),
            (1.0 + 1e-6, Status::NoEquilibrium),
        ] {
            let (solution, ..) = solved(&scene(0.2, cells, part * most)?)?;
            wrong += f64::from(solution.status() != expected);
        }
        elastic.climb(&name, size, true, Measured::field(wrong));
    }
    // The limit is tried from 1e-10 of the loads' own ratio below; the least of these pulls is a tenth of the weight.
    Ok(vec![
        pull.judge(Criterion::EveryMesh { within: 1e-9 }),
        elastic.judge(Criterion::EveryMesh { within: 0.0 }),
    ])
}
