//! Cattaneo's and Mindlin's partial slip: two parabolas of steel, pressed, then pulled sideways.

use super::Entry;
use super::growing::{falling, growing};
use super::ladder::{Ladder, Measured};
use super::scenes::{STEEL, body, hold, pair};
use crate::body::{CellKind, Mesh, rectangle};
use crate::closed_forms::{CattaneoMindlin, HertzLine, contact_modulus};
use crate::dpana::Status;
use crate::error::Error;
use crate::pipeline::solve_steps;
use crate::report::{Criterion, Report, VerifiedQuantity};
use crate::scene::{Scene, SceneSteps};

pub(super) const ENTRY: Entry = Entry {
    name: "Cattaneo and Mindlin, two parabolas of steel, pressed and pulled",
    source: "Johnson 1985, §7.2 (E5)",
    floor: "the bodies are twenty half-widths high, not half-planes: (a/L)² = 2e-3; the shear keeps 2 %, as every cell that closes begins its slip at once",
    measure,
};

/// Half the width and the height of each body, and the R of both, in mm.
const SIZE: f64 = 20.0;
const RADIUS: f64 = 200.0;
const FRICTION: f64 = 0.3;

/// How far the upper body is pushed down and then aside, in mm.
const PRESSED: f64 = 0.019;
const SHEARED: f64 = 0.006;

/// Instants from 1 on: Q/(μP) of about 1/4, 1/2, 3/4, 9/10.
const PULLED: [f64; 4] = [1.36, 1.72, 2.09, 2.34];

/// The upper and the lower body, `cells` per mm at their faces.
fn meshes(cells: f64) -> Result<[Mesh; 2], Error> {
    let fine = 1.0 / cells;
    let right = growing(fine, 1.5, SIZE, 0.15);
    let left = falling(fine, 1.5, SIZE, 0.15);
    let xs: Vec<f64> = left.iter().chain(&right[1..]).copied().collect();
    let mut upper = rectangle(&xs, &growing(fine, fine, SIZE, 0.12), CellKind::Quad4)?;
    let mut lower = rectangle(&xs, &falling(fine, fine, SIZE, 0.12), CellKind::Quad4)?;
    let bent = |x: f64| x * x / (2.0 * RADIUS);
    for [x, y, _] in &mut upper.nodes {
        *y += bent(*x) * (1.0 - *y / SIZE);
    }
    for [x, y, _] in &mut lower.nodes {
        *y -= bent(*x) * (1.0 + *y / SIZE);
    }
    Ok([upper, lower])
}

/// Pressed in `count` steps, so that a node begins its slip where it closes; then pulled.
fn scene(cells: f64, count: u32) -> Result<Scene, Error> {
    let [upper, lower] = meshes(cells)?;
    let upper = hold(body("upper", upper, STEEL), "top", 0, SHEARED);
    let upper = hold(upper, "top", 1, -PRESSED);
    let lower = hold(body("lower", lower, STEEL), "bottom", 0, 0.0);
    let lower = hold(lower, "bottom", 1, 0.0);
    let mut scene = pair([upper, lower], ["bottom", "top"], FRICTION);
    let pressing = (1..=count).map(|k| f64::from(k) / f64::from(count));
    let factors = [
        (
            "bodies[0].supports[0]",
            vec![vec![1.0, 0.0], vec![3.0, 2.0]],
        ),
        (
            "bodies[0].supports[1]",
            vec![vec![0.0, 0.0], vec![1.0, 1.0]],
        ),
    ];
    scene.steps = Some(SceneSteps {
        at: pressing.chain(PULLED).collect(),
        factors: factors.map(|(name, rows)| (name.to_owned(), rows)).into(),
        ..SceneSteps::default()
    });
    Ok(scene)
}

/// Half the length that sticks, over c; and the shear in L2, over its own.
fn compared(report: &Report) -> Result<[Measured; 2], Error> {
    let modulus = contact_modulus(STEEL, Some(STEEL))?;
    let hertz = HertzLine::new(report.totals.normal, 0.5 * RADIUS, modulus)?;
    let pull = report.totals.friction.first().map_or(f64::NAN, |f| -f);
    let exact = CattaneoMindlin::line(&hertz, FRICTION, pull)?;
    let (mut error, mut size) = (0.0, 0.0);
    for contact in &report.contacts {
        let x = contact.position.first().copied().unwrap_or(f64::NAN);
        let shear = contact.friction_traction.as_ref().and_then(|t| t.first());
        let shear = shear.map_or(f64::NAN, |t| -t);
        error += contact.area * (shear - exact.shear(x)).powi(2);
        size += contact.area * exact.shear(x).powi(2);
    }
    let stick = 0.5 * (report.totals.contact_area - report.totals.slip_area);
    Ok([
        Measured::number(stick, exact.stick_ratio * hertz.half_width),
        Measured::field((error / size).sqrt()),
    ])
}

fn measure(quick: bool) -> Result<Vec<VerifiedQuantity>, Error> {
    let mut stick = Ladder::new("c, mm, mean error");
    let mut shear = Ladder::new("shear in L2, mean error");
    let meshes: &[f64] = if quick {
        &[10.0, 20.0]
    } else {
        &[10.0, 20.0, 40.0, 80.0]
    };
    for &cells in meshes {
        let mut reports = Vec::new();
        let count = 2 * cells as u32;
        let last = solve_steps(&scene(cells, count)?, None, |solution| {
            if solution.step().is_some_and(|step| step.at() > 1.0) {
                reports.push(solution.report()?);
            }
            Ok(())
        })?;
        let settled = last.status() == Status::Certified && reports.len() == PULLED.len();
        let found: Vec<[Measured; 2]> = reports.iter().map(compared).collect::<Result<_, _>>()?;
        let (name, size) = (format!("{cells} quad4 per mm"), 1.0 / cells);
        let mean =
            |at: usize| Measured::mean(&found.iter().map(|both| both[at]).collect::<Vec<_>>());
        stick.climb(&name, size, settled, mean(0));
        shear.climb(&name, size, settled, mean(1));
    }
    let finest = meshes.last().copied().unwrap_or(1.0);
    // The zone of stick ends between two nodes: half a cell of its least half-width, a third of a
    // millimetre, with as much again for the widths where that is not the worst.
    let of_cell = 1.0 / (finest * 0.33);
    Ok(vec![
        stick.judge(Criterion::FinestMesh { within: of_cell }),
        shear.judge(Criterion::FinestMesh { within: 0.04 }),
    ])
}
