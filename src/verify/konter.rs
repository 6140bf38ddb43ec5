//! Konter's first benchmark: a steel cylinder on an aluminium block.

use std::f64::consts::PI;

use super::Entry;
use super::growing::{falling, growing};
use super::hertz_line::half_width;
use super::ladder::{Ladder, Measured};
use super::scenes::{STEEL, body, hold, pair, solved};
use crate::body::{CellKind, Mesh, rectangle};
use crate::closed_forms::{Elastic, HertzLine};
use crate::error::Error;
use crate::report::{Criterion, Report, VerifiedQuantity};
use crate::scene::Scene;

pub(super) const ENTRY: Entry = Entry {
    name: "Konter, a steel cylinder on an aluminium block",
    source: "NAFEMS 2006, no. 1; Johnson 1985, §4.2 (E3)",
    floor: "at the edge the circle rises 0.4 % more than its parabola, so coarse meshes are near by \
            chance; u_y is published for large displacement, and how its base is held is not stated",
    measure,
    drawn: Some(|| scene(2.0, 0.1, 1.0)),
};

const ALUMINIUM: Elastic = Elastic {
    young: 70e3,
    poisson: 0.3,
};

/// R of the cylinder in mm, load in N per mm of depth, and the published u_y in mm.
const RADIUS: f64 = 50.0;
const LOAD: f64 = 35e3;
const PUBLISHED: f64 = -1.30264;

/// The load counts as reached within this part of it.
const REACHED: f64 = 1e-4;

/// A quarter of a ring of radii 1 and 50 mm about (0, 50), fine at its lowest point; groups
/// `bottom` (outside), `left` (x = 0), `right` (y = 50).
fn quarter_ring(fine: f64) -> Result<Mesh, Error> {
    let depths = growing(fine, fine, RADIUS - 1.0, 0.2);
    let arcs = growing(fine, 9.0, RADIUS * PI / 2.0, 0.2);
    let mut mesh = rectangle(&arcs, &depths, CellKind::Quad4)?;
    for [x, y, _] in &mut mesh.nodes {
        let (angle, r) = (*x / RADIUS, RADIUS - *y);
        (*x, *y) = (r * angle.sin(), RADIUS - r * angle.cos());
    }
    Ok(mesh)
}

/// Right half, `fine` the cells at the contact in mm; the level of the cylinder's axis is lowered.
fn scene(fine: f64, friction: f64, lowered: f64) -> Result<Scene, Error> {
    let cylinder = body("cylinder", quarter_ring(fine)?, STEEL);
    let cylinder = hold(hold(cylinder, "left", 0, 0.0), "right", 1, -lowered);
    let xs = growing(1.25 * fine, 10.0, 100.0, 0.2);
    let ys = falling(1.25 * fine, 1.25 * fine, 200.0, 0.2);
    let mut block = body("block", rectangle(&xs, &ys, CellKind::Quad4)?, ALUMINIUM);
    for (side, axis) in [("left", 0), ("bottom", 0), ("bottom", 1)] {
        block = hold(block, side, axis, 0.0);
    }
    Ok(pair([block, cylinder], ["top", "bottom"], friction))
}

/// Report and u_y of the block's top on the axis, in mm, under the load of the benchmark, and
/// whether that was reached and certified.
fn loaded(fine: f64, friction: f64) -> Result<(Report, f64, bool), Error> {
    let mut lowered = 1.55;
    let mut left = 10;
    loop {
        let (solution, report, certified) = solved(&scene(fine, friction, lowered)?)?;
        let load = 2.0 * report.totals.normal;
        let reached = (load / LOAD - 1.0).abs() <= REACHED;
        left -= 1;
        if reached || !certified || left == 0 {
            let u_y = solution.displacement_near(0, [0.0; 3])?[1];
            return Ok((report, u_y, reached && certified));
        }
        // The load grows a little faster than the displacement.
        lowered *= (LOAD / load).powf(0.9);
    }
}

fn measure(quick: bool) -> Result<Vec<VerifiedQuantity>, Error> {
    let hertz = HertzLine::new(LOAD, RADIUS, STEEL.contact_modulus(Some(ALUMINIUM))?)?;
    let meshes: &[f64] = if quick {
        &[1.0, 0.5, 0.25]
    } else {
        &[1.0, 0.5, 0.25, 0.125]
    };
    let mut peak = Ladder::new("p₀, μ = 0, MPa");
    let mut width = Ladder::new("a, μ = 0, mm");
    let mut sunk = Ladder::new("u_y, μ = 0.1, mm");
    for &fine in meshes {
        let name = format!("{fine} mm quad4");
        let (report, _, settled) = loaded(fine, 0.0)?;
        let found = Measured::number(report.totals.peak_pressure, hertz.peak);
        peak.climb(&name, fine, settled, found);
        let found = Measured::number(half_width(&report), hertz.half_width);
        width.climb(&name, fine, settled, found);
        let (_, u_y, settled) = loaded(fine, 0.1)?;
        sunk.climb(&name, fine, settled, Measured::number(u_y, PUBLISHED));
    }
    // At the edge the circle rises by a²/(4R²) = 0.4 % more than its parabola, and the block is a half-plane but for
    // (a/L)² = 0.4 %, L = 100 mm.
    let within = Criterion::FinestMesh { within: 0.01 };
    Ok(vec![
        peak.judge(within),
        width.judge(within),
        sunk.judge(Criterion::Compared),
    ])
}
