//! A pad that is pressed and pulled, held by friction alone.

use super::Entry;
use super::ladder::{Ladder, Measured};
use super::scenes::{body, on, plane, solved};
use crate::alternation::Status;
use crate::body::{CellKind, box_mesh, graded};
use crate::closed_forms::Elastic;
use crate::error::Error;
use crate::report::{Criterion, VerifiedQuantity};
use crate::scene::{Scene, SceneLoad};

pub(super) const ENTRY: Entry = Entry {
    name: "sliding pad, no spring",
    source: "code_aster SSNV503",
    floor: "",
    measure,
    drawn: None,
};

/// Pressing force, and pulls of 0.99 and 1.01 times what friction holds, in newton.
const PRESSED: f64 = 12_000.0;
const HELD: f64 = 3564.0;
const BEYOND: f64 = 3636.0;
const FRICTION: f64 = 0.3;

const MATERIAL: Elastic = Elastic {
    young: 2.1e5,
    poisson: 0.0,
};

/// A pad of 20 × 20 × 10 mm.
fn scene(cells: usize, pull: f64) -> Result<Scene, Error> {
    let (side, height) = (graded(0.0, 20.0, cells, 1.0)?, graded(0.0, 10.0, 3, 1.0)?);
    let mut pad = body(
        "pad",
        box_mesh(&side, &side, &height, CellKind::Hex8)?,
        MATERIAL,
    );
    let area = 400.0;
    let traction = |group: &str, traction| SceneLoad::Traction {
        traction,
        group: group.into(),
    };
    pad.loads = vec![
        traction("top", vec![0.0, 0.0, -PRESSED / area]),
        traction("bottom", vec![pull / area, 0.0, 0.0]),
    ];
    Ok(on(plane(&[0.0, 0.0, 1.0]), pad, "bottom", FRICTION))
}

fn measure(_quick: bool) -> Result<Vec<VerifiedQuantity>, Error> {
    let mut normal = Ladder::new("normal resultant, N");
    let mut friction = Ladder::new("friction that holds, N");
    let mut missing = Ladder::new("friction missing beyond, N");
    for cells in [3, 5] {
        let (name, size) = (format!("{cells} × {cells} × 3 hex8"), 1.0 / cells as f64);
        let (_, report, certified) = solved(&scene(cells, HELD)?)?;
        let along = report.totals.friction.first().map_or(f64::NAN, |f| -f);
        normal.climb(
            &name,
            size,
            certified,
            Measured::number(report.totals.normal, PRESSED),
        );
        friction.climb(&name, size, certified, Measured::number(along, HELD));
        let (solution, report, _) = solved(&scene(cells, BEYOND)?)?;
        let slides = solution.status() == Status::NoEquilibrium;
        let found = report.failure.map_or(f64::NAN, |failure| failure.missing);
        missing.climb(
            &name,
            size,
            slides,
            Measured::number(found, BEYOND - FRICTION * PRESSED),
        );
    }
    // Equilibrium is certified to 1e-12 of the load, of which friction is a third; a proof of sliding may leave a
    // resistance of 1e-6 of what is missing.
    let exact = |within| Criterion::EveryMesh { within };
    Ok(vec![
        normal.judge(exact(1e-11)),
        friction.judge(exact(1e-11)),
        missing.judge(exact(1e-6)),
    ])
}
