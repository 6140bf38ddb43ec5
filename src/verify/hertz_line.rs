//! Hertz' line contact: a parabola pressed on a rigid plane.

use super::Entry;
use super::growing::growing;
use super::ladder::{Ladder, Measured};
use super::scenes::{STEEL, body, hold, on, plane, solved};
use crate::body::{CellKind, Mesh, rectangle};
use crate::closed_forms::{HertzLine, contact_modulus};
use crate::error::Error;
use crate::report::{Contact, Criterion, Report, VerifiedQuantity};

pub(super) const ENTRY: Entry = Entry {
    name: "Hertz, a parabola on a rigid plane",
    source: "Johnson 1985, §4.2 (E3)",
    floor: "the body is a hundred half-widths wide and high, not a half-plane: (a/L)² = 1e-4 at most",
    measure,
};

/// R of the parabola, width and height of half the body, in mm.
const RADIUS: f64 = 1000.0;
pub(super) const SIZE: f64 = 100.0;

/// How far the top goes down, in mm: half-widths of 1 to 1.2 mm, so that the edge of the contact
/// falls anywhere between two nodes.
pub(super) fn lowered() -> impl Iterator<Item = f64> {
    (0..8).map(|k| 0.0026 * 1.06_f64.powi(k))
}

/// Cells per mm at the contact.
pub(super) fn meshes(quick: bool) -> &'static [f64] {
    if quick {
        &[5.0, 10.0, 20.0, 40.0]
    } else {
        &[5.0, 10.0, 20.0, 40.0, 80.0]
    }
}

/// Right half of a body above a parabola y = x²/(2R), its cells as fine relative to the distance
/// from the contact as at the contact.
pub(super) fn parabola(cells: f64, radius: f64) -> Result<Mesh, Error> {
    let fine = 1.0 / cells;
    let xs = growing(fine, 1.5, SIZE, fine);
    let ys = growing(fine, fine, SIZE, fine);
    let mut mesh = rectangle(&xs, &ys, CellKind::Quad4)?;
    for [x, y, _] in &mut mesh.nodes {
        *y += *x * *x / (2.0 * radius) * (1.0 - *y / SIZE);
    }
    Ok(mesh)
}

/// What one load on one mesh gives beside Hertz' answer for the load that the mesh carries.
pub(super) struct Compared {
    peak: Measured,
    half_width: Measured,
    pressure: Measured,
}

/// A report on half a symmetric contact, beside Hertz.
pub(super) fn compared(report: &Report, radius: f64, modulus: f64) -> Result<Compared, Error> {
    let hertz = HertzLine::new(2.0 * report.totals.normal, radius, modulus)?;
    let (mut error, mut size) = (0.0, 0.0);
    for contact in &report.contacts {
        let (x, pressure) = distance_and_pressure(contact);
        error += contact.area * (pressure - hertz.pressure(x)).powi(2);
        size += contact.area * hertz.pressure(x).powi(2);
    }
    Ok(Compared {
        peak: Measured::number(report.totals.peak_pressure, hertz.peak),
        half_width: Measured::number(half_width(report), hertz.half_width),
        pressure: Measured::field((error / size).sqrt()),
    })
}

/// Half-width of the elliptic pressure with the same second moment, ∫ x² p dx / ∫ p dx = a²/4:
/// unlike the last pressed node, it does not jump.
pub(super) fn half_width(report: &Report) -> f64 {
    let (mut moment, mut sum) = (0.0, 0.0);
    for contact in &report.contacts {
        let (x, pressure) = distance_and_pressure(contact);
        let force = pressure * contact.area;
        sum += force;
        moment += force * x * x;
    }
    2.0 * (moment / sum).sqrt()
}

fn distance_and_pressure(contact: &Contact) -> (f64, f64) {
    let x = contact.position.first().copied();
    (x.unwrap_or(f64::NAN), contact.pressure.unwrap_or(f64::NAN))
}

/// The three quantities of a line contact up their ladders.
pub(super) struct Ladders {
    peak: Ladder,
    half_width: Ladder,
    pressure: Ladder,
}

impl Ladders {
    pub(super) fn new() -> Self {
        Self {
            peak: Ladder::new("p₀, MPa, mean error"),
            half_width: Ladder::new("a, mm, mean error"),
            pressure: Ladder::new("pressure in L2, mean error"),
        }
    }

    /// Several loads on one mesh.
    pub(super) fn climb(&mut self, cells: f64, settled: bool, all: &[Compared]) {
        let mean =
            |of: fn(&Compared) -> Measured| Measured::mean(&all.iter().map(of).collect::<Vec<_>>());
        let name = format!("{cells} quad4 per mm");
        let size = 1.0 / cells;
        self.peak.climb(&name, size, settled, mean(|c| c.peak));
        self.half_width
            .climb(&name, size, settled, mean(|c| c.half_width));
        self.pressure
            .climb(&name, size, settled, mean(|c| c.pressure));
    }

    /// Strips of constant pressure, n on half the width, have an error of 0.11/n in L2 (computed
    /// independently), of first order as the pressure ends inside a strip: twice that is allowed.
    /// Peak and half-width are of second order, 1.3e-3 (10/n)², and allowed a few times the floor.
    pub(super) fn judge(self, quick: bool) -> Vec<VerifiedQuantity> {
        let finest = meshes(quick).last().copied().unwrap_or(1.0);
        let within = 0.22 / finest;
        vec![
            self.peak.judge(Criterion::FinestMesh { within: 5e-4 }),
            self.half_width
                .judge(Criterion::FinestMesh { within: 5e-4 }),
            self.pressure
                .judge(Criterion::Converges { within, rate: 0.8 }),
        ]
    }
}

fn measure(quick: bool) -> Result<Vec<VerifiedQuantity>, Error> {
    let modulus = contact_modulus(STEEL, None)?;
    let mut ladders = Ladders::new();
    for &cells in meshes(quick) {
        let (mut all, mut settled) = (Vec::new(), true);
        for lowered in lowered() {
            let half = hold(
                body("half", parabola(cells, RADIUS)?, STEEL),
                "left",
                0,
                0.0,
            );
            let half = hold(half, "top", 1, -lowered);
            let (_, report, certified) = solved(&on(plane(&[0.0, 1.0]), half, "bottom", 0.0))?;
            settled &= certified;
            all.push(compared(&report, RADIUS, modulus)?);
        }
        ladders.climb(cells, settled, &all);
    }
    Ok(ladders.judge(quick))
}
