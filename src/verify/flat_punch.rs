//! A rigid flat punch without friction: the pressure is singular at its edges.

use super::Entry;
use super::growing::growing;
use super::ladder::{Ladder, Measured};
use super::scenes::{STEEL, body, hold, on, plane, solved};
use crate::body::{CellKind, Facet, Group, Mesh, rectangle};
use crate::closed_forms::FlatLinePunch;
use crate::error::Error;
use crate::report::{Criterion, Report, VerifiedQuantity};

pub(super) const ENTRY: Entry = Entry {
    name: "flat punch without friction",
    source: "Johnson 1985, §2.8 (E6)",
    floor: "the body is a hundred half-widths wide and high, not a half-plane: (a/L)² = 1e-4",
    measure,
    drawn: None,
};

/// Half-width of the punch, width and height of half the body, in mm.
const HALF_WIDTH: f64 = 1.0;
const SIZE: f64 = 100.0;

/// The pressure is compared up to this part of the half-width.
const COMPARED: f64 = 0.5;

/// Right half of the body, the punch below its first millimetre; cells are fine at the edge.
fn mesh(cells: f64) -> Result<Mesh, Error> {
    let fine = 1.0 / cells;
    let inside = growing(fine, 0.5 * HALF_WIDTH, HALF_WIDTH, fine);
    let outside = growing(fine, HALF_WIDTH, SIZE - HALF_WIDTH, fine);
    let mut xs: Vec<f64> = inside.iter().rev().map(|x| HALF_WIDTH - x).collect();
    xs.extend(outside[1..].iter().map(|x| HALF_WIDTH + x));
    let ys = growing(fine, fine, SIZE, fine);
    let mut mesh = rectangle(&xs, &ys, CellKind::Quad4)?;
    let beneath = |facet: &&Facet| {
        let mut nodes = facet.nodes.iter();
        nodes.all(|node| mesh.nodes[*node][0] <= HALF_WIDTH)
    };
    if let Some(Group::Facets(bottom)) = mesh.groups.get("bottom") {
        let punch = bottom.iter().filter(beneath).cloned().collect();
        mesh.groups.insert("punch".to_owned(), Group::Facets(punch));
    }
    Ok(mesh)
}

/// Relative difference of the pressure in L2, up to [`COMPARED`].
fn pressure_error(report: &Report, exact: &FlatLinePunch) -> f64 {
    let (mut error, mut size) = (0.0, 0.0);
    for contact in &report.contacts {
        let x = contact.position.first().copied().unwrap_or(f64::NAN);
        if x <= COMPARED * HALF_WIDTH {
            let found = contact.pressure.unwrap_or(f64::NAN);
            error += contact.area * (found - exact.pressure(x)).powi(2);
            size += contact.area * exact.pressure(x).powi(2);
        }
    }
    (error / size).sqrt()
}

/// Half-width of the singular pressure with the same second moment: ∫ x² p dx / ∫ p dx = a²/2.
fn half_width(report: &Report) -> f64 {
    let (mut moment, mut sum) = (0.0, 0.0);
    for contact in &report.contacts {
        let x = contact.position.first().copied().unwrap_or(f64::NAN);
        let force = contact.pressure.unwrap_or(f64::NAN) * contact.area;
        sum += force;
        moment += force * x * x;
    }
    (2.0 * moment / sum).sqrt()
}

fn measure(quick: bool) -> Result<Vec<VerifiedQuantity>, Error> {
    let mut middle = Ladder::new("pressure in the middle, MPa");
    let mut pressure = Ladder::new("pressure in L2, up to a/2");
    let mut width = Ladder::new("a by the second moment, mm");
    let meshes: &[f64] = if quick {
        &[5.0, 10.0, 20.0]
    } else {
        &[5.0, 10.0, 20.0, 40.0, 80.0]
    };
    for &cells in meshes {
        let half = hold(body("half", mesh(cells)?, STEEL), "left", 0, 0.0);
        let half = hold(half, "top", 1, -0.01);
        let (_, report, certified) = solved(&on(plane(&[0.0, 1.0]), half, "punch", 0.0))?;
        let exact = FlatLinePunch::new(2.0 * report.totals.normal, HALF_WIDTH)?;
        let first = |x: &f64| *x == 0.0;
        let in_middle = report.contacts.iter();
        let mut in_middle = in_middle.filter(|contact| contact.position.first().is_some_and(first));
        let found = in_middle.next().and_then(|contact| contact.pressure);
        let (name, size) = (format!("{cells} quad4 per mm"), 1.0 / cells);
        let found = Measured::number(found.unwrap_or(f64::NAN), exact.pressure(0.0));
        middle.climb(&name, size, certified, found);
        let error = Measured::field(pressure_error(&report, &exact));
        pressure.climb(&name, size, certified, error);
        let found = Measured::number(half_width(&report), HALF_WIDTH);
        width.climb(&name, size, certified, found);
    }
    // The last node under the punch holds half a cell beyond its edge: the mesh's punch is wider
    // by at most that, and its pressure lower in proportion; a/2 from the middle by a²/(a² − x²),
    // which is 4/3, times as much.
    let finest = meshes.last().copied().unwrap_or(1.0);
    let within = 0.5 / (finest * HALF_WIDTH);
    let converges = Criterion::Converges { within, rate: 0.8 };
    let in_l2 = Criterion::Converges {
        within: 4.0 / 3.0 * within,
        rate: 0.8,
    };
    Ok(vec![
        middle.judge(converges),
        pressure.judge(in_l2),
        width.judge(converges),
    ])
}
