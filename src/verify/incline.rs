//! A block on an incline that nothing but contact holds.

use super::Entry;
use super::ladder::{Ladder, Measured};
use super::scenes::{STEEL, body, on, plane, solved};
use crate::alternation::Status;
use crate::body::{CellKind, Mesh, box_mesh, graded, rectangle};
use crate::closed_forms::Incline;
use crate::error::Error;
use crate::report::{Criterion, VerifiedQuantity};
use crate::scene::{Scene, SceneLoad};

pub(super) const ENTRY: Entry = Entry {
    name: "block on an incline, no support",
    source: "statics (E11)",
    floor: "",
    measure,
    drawn: Some(|| scene(CellKind::Quad4, 0.9 * FRICTION, FRICTION, [2.0, 1.0])),
};

const WEIGHT: f64 = 1000.0;
const FRICTION: f64 = 0.5;

/// How close to the angle of friction it still sticks, and how far beyond it slides.
const CLOSE: f64 = 1e-6;
const BEYOND: f64 = 0.01;

/// Meshes of a block, unit depth, x down the slope.
fn block(kind: CellKind, [width, height]: [f64; 2]) -> Result<Mesh, Error> {
    let along = graded(0.0, width, 4, 1.0)?;
    let up = graded(0.0, height, 4, 1.0)?;
    match kind.dimension() {
        2 => rectangle(&along, &up, kind),
        _ => box_mesh(&along, &graded(0.0, 1.0, 3, 1.0)?, &up, kind),
    }
}

/// A block of width and height on a slope of tangent `slope`.
fn scene(kind: CellKind, slope: f64, friction: f64, size: [f64; 2]) -> Result<Scene, Error> {
    let weight = Incline::new(WEIGHT / (size[0] * size[1]), slope)?;
    let mut block = body("block", block(kind, size)?, STEEL);
    let (force, up) = match kind.dimension() {
        2 => (vec![weight.tangential, -weight.normal], vec![0.0, 1.0]),
        _ => (
            vec![weight.tangential, 0.0, -weight.normal],
            vec![0.0, 0.0, 1.0],
        ),
    };
    block.loads.push(SceneLoad::BodyForce {
        body_force: force,
        group: None,
    });
    Ok(on(plane(&up), block, "bottom", friction))
}

fn measure(_quick: bool) -> Result<Vec<VerifiedQuantity>, Error> {
    let mut normal = Ladder::new("N where it just sticks, N");
    let mut along = Ladder::new("T where it just sticks, N");
    let mut missing = Ladder::new("friction missing beyond, N");
    let mut tips = Ladder::new("tips beyond its diagonal");
    for kind in CellKind::LINEAR {
        let low = [2.0, 1.0];
        let climb = |ladder: &mut Ladder, settled, found| {
            ladder.climb(kind.name(), 1.0, settled, found);
        };

        let slope = FRICTION * (1.0 - CLOSE);
        let exact = Incline::new(WEIGHT, slope)?;
        let (_, report, certified) = solved(&scene(kind, slope, FRICTION, low)?)?;
        let settled = certified == exact.sticks(FRICTION);
        let friction = report.totals.friction.first().map_or(f64::NAN, |f| -f);
        climb(
            &mut normal,
            settled,
            Measured::number(report.totals.normal, exact.normal),
        );
        climb(
            &mut along,
            settled,
            Measured::number(friction, exact.tangential),
        );

        let slope = FRICTION * (1.0 + BEYOND);
        let exact = Incline::new(WEIGHT, slope)?;
        let (solution, report, _) = solved(&scene(kind, slope, FRICTION, low)?)?;
        let slides = solution.status() == Status::NoEquilibrium && !exact.sticks(FRICTION);
        let found = report.failure.map_or(f64::NAN, |failure| failure.missing);
        let found = Measured::number(found, exact.missing(FRICTION));
        climb(&mut missing, slides, found);

        // Half as wide as high and rough: it tips beyond a slope of 1/2.
        let (high, mut wrong) = ([1.0, 2.0], 0.0);
        for slope in [0.5 * (1.0 - CLOSE), 0.5 * (1.0 + BEYOND)] {
            let expected = Incline::new(WEIGHT, slope)?.tips(high[0], high[1]);
            let (solution, ..) = solved(&scene(kind, slope, 4.0 * FRICTION, high)?)?;
            let found = match solution.status() {
                Status::Certified => Some(false),
                Status::NoEquilibrium => Some(true),
                Status::NotConverged | Status::CouplingFault => None,
            };
            wrong += f64::from(found != Some(expected));
        }
        climb(&mut tips, true, Measured::field(wrong));
    }
    // Equilibrium is certified to 1e-12 of the weight, of which T is 0.45; a proof of sliding may leave a resistance
    // of 1e-6 of what is missing.
    let exact = |within| Criterion::EveryMesh { within };
    Ok(vec![
        normal.judge(exact(1e-11)),
        along.judge(exact(1e-11)),
        missing.judge(exact(1e-6)),
        tips.judge(exact(0.0)),
    ])
}
