//! SSNV128: a square that is pressed on a rigid plane and pushed along it.

use super::Entry;
use super::ladder::{Ladder, Measured};
use super::scenes::{body, hold, on, plane, solved};
use crate::body::{CellKind, Mesh, graded, rectangle};
use crate::closed_forms::Elastic;
use crate::error::Error;
use crate::report::{Criterion, VerifiedQuantity};
use crate::scene::{Scene, SceneLoad, SceneSupport};

pub(super) const ENTRY: Entry = Entry {
    name: "SSNV128, a square dragged over a plane",
    source: "code_aster V6.04.128; limit and rows computed independently",
    floor: "the limit is known to 0.001e-6 m, 6.5e-5 of the smallest value",
    measure,
    drawn: Some(|| Ok(scene(square(16, [1.0, 1.0], CellKind::Quad4)?, 1.0))),
};

/// Side of the square, in metre.
pub(super) const SIDE: f64 = 0.04;

/// Pressure on its left and on its top, in pascal.
pub(super) const PRESSURE: [f64; 2] = [15e7, 5e7];

pub(super) const MATERIAL: Elastic = Elastic {
    young: 1.3e11,
    poisson: 0.2,
};

/// Distance of A, B, C, D, E from the pushed side, in metre.
const POINTS: [f64; 5] = [0.0, 0.00125, 0.005, 0.0075, 0.01125];

/// u_x at A to E in 1e-6 m: where meshes converge to, and on the meshes themselves.
const LIMIT: [f64; 5] = [28.602, 27.225, 22.867, 19.807, 15.413];
const ROWS: [(usize, [f64; 5]); 3] = [
    (32, [28.59438, 27.21685, 22.84998, 19.79627, 15.40564]),
    (64, [28.60421, 27.22727, 22.86527, 19.80566, 15.41248]),
    (128, [28.60218, 27.22501, 22.86695, 19.80672, 15.41338]),
];

/// Friction in all, in newton per metre.
const FRICTION: f64 = -1.40536e6;

/// A mesh of the square; `grading` as in [`graded`].
pub(super) fn square(cells: usize, grading: [f64; 2], cell: CellKind) -> Result<Mesh, Error> {
    let lines = |grading| graded(0.0, SIDE, cells, grading);
    rectangle(&lines(grading[0])?, &lines(grading[1])?, cell)
}

/// The square on its plane.
pub(super) fn scene(mesh: Mesh, friction: f64) -> Scene {
    let mut square = hold(body("square", mesh, MATERIAL), "right", 0, 0.0);
    square.supports.push(SceneSupport::At {
        at: vec![SIDE, 0.0],
        displacement: vec![None, Some(0.0)],
    });
    for (group, pressure) in ["left", "top"].into_iter().zip(PRESSURE) {
        let group = group.into();
        square.loads.push(SceneLoad::Pressure { pressure, group });
    }
    on(plane(&[0.0, 1.0]), square, "bottom", friction)
}

fn measure(_quick: bool) -> Result<Vec<VerifiedQuantity>, Error> {
    let mut limit = Ladder::new("worst u_x, limit, 1e-6 m");
    let mut row = Ladder::new("worst u_x, same mesh, 1e-6 m");
    let mut friction = Ladder::new("friction in all, N/m");
    let mut carried = Ladder::new("plane and corner carry, N/m");
    for (cells, of_mesh) in ROWS {
        let mesh = square(cells, [1.0; 2], CellKind::Quad4)?;
        let (solution, report, certified) = solved(&scene(mesh, 1.0))?;
        let mut found = [0.0; 5];
        for (u, x) in found.iter_mut().zip(POINTS) {
            *u = 1e6 * solution.displacement_near(0, [x, 0.0, 0.0])?[0];
        }
        let against = |exact: [f64; 5]| {
            let pairs = found.into_iter().zip(exact);
            Measured::worst(pairs.map(|(found, exact)| Measured::number(found, exact)))
        };
        let sum = |forces: &[f64], axis: usize| forces.get(axis).copied().unwrap_or(f64::NAN);
        let held: f64 = report
            .certificate
            .bodies
            .iter()
            .map(|body| sum(&body.supports.force, 1))
            .sum();
        let (mesh, size) = (format!("{cells} × {cells} quad4"), 1.0 / cells as f64);
        let all = [
            (&mut limit, against(LIMIT)),
            (&mut row, against(of_mesh)),
            (
                &mut friction,
                Measured::number(sum(&report.totals.friction, 0), FRICTION),
            ),
            (
                &mut carried,
                Measured::number(report.totals.normal + held, PRESSURE[1] * SIDE),
            ),
        ];
        for (ladder, measured) in all {
            ladder.climb(&mesh, size, certified, measured);
        }
    }
    Ok(vec![
        limit.judge(Criterion::Converges {
            within: 6.5e-5,
            rate: 1.0,
        }),
        // Half a unit of the last digit printed, of the smallest value.
        row.judge(Criterion::EveryMesh {
            within: 5e-6 / 15.4,
        }),
        // The sum is known in the limit no better than the displacements are; what carries the load is statics,
        // certified to 1e-12.
        friction.judge(Criterion::FinestMesh { within: 1e-4 }),
        carried.judge(Criterion::EveryMesh { within: 1e-12 }),
    ])
}
