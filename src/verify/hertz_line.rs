//! Hertz' line contact: a parabola pressed on a rigid plane.

use super::Entry;
use super::growing::growing;
use super::ladder::{Ladder, Measured};
use super::scenes::{STEEL, body, hold, on, plane, solved};
use crate::body::{CellKind, Mesh, rectangle};
use crate::closed_forms::HertzLine;
use crate::error::Error;
use crate::report::{Contact, Criterion, Report, VerifiedQuantity};

pub(super) const ENTRY: Entry = Entry {
    name: "Hertz, a parabola on a rigid plane",
    source: "Johnson 1985, §4.2 (E3)",
    floor: "the body is four hundred half-widths wide and high, not a half-plane: (a/L)² = 9e-6 at most; smaller bodies show that p₀ goes with it",
    measure,
    drawn: None,
};

/// R of the parabola, width and height of half the body, in mm.
const RADIUS: f64 = 1e4;
pub(super) const SIZE: f64 = 400.0;

/// Bodies so small that their size shows, in mm, and their cells per mm at the contact.
const SMALL: [f64; 3] = [12.5, 25.0, 50.0];
const CELLS_OF_SMALL: f64 = 20.0;

/// How far the top goes down, in mm: half-widths of about 1 to 1.2 mm, so that the edge of the
/// contact falls anywhere between two nodes. The approach grows with the logarithm of the size.
pub(super) fn lowered(radius: f64, size: f64) -> impl Iterator<Item = f64> {
    let half_widths = (0..8).map(|k| 0.97 * 1.03_f64.powi(k));
    half_widths.map(move |a| a * a / (2.0 * radius) * (size.ln() + 0.8))
}

/// Least half-width, about, in mm; the largest is 1.2 times as large.
const HALF_WIDTH: f64 = 1.0;

/// Cells per mm at the contact.
pub(super) fn meshes(quick: bool) -> &'static [f64] {
    if quick {
        &[5.0, 10.0, 20.0, 40.0]
    } else {
        &[5.0, 10.0, 20.0, 40.0, 80.0]
    }
}

/// Right half of a body above a parabola y = x²/(2R), half as fine relative to the distance from
/// the contact as at the contact, so that all cells shrink together.
pub(super) fn parabola(cells: f64, radius: f64, size: f64) -> Result<Mesh, Error> {
    let fine = 1.0 / cells;
    let xs = growing(fine, 1.5, size, 2.0 * fine);
    let ys = growing(fine, fine, size, 2.0 * fine);
    let mut mesh = rectangle(&xs, &ys, CellKind::Quad4)?;
    for [x, y, _] in &mut mesh.nodes {
        *y += *x * *x / (2.0 * radius) * (1.0 - *y / size);
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

    /// Strips of constant pressure, n on half the width, have an error of 0.11/n in L2, of first
    /// order as the pressure ends inside a strip, and of 1.3e-3 (10/n)² in the peak (computed
    /// independently); half-width and peak have one product. Twice that is allowed, and (a/L)².
    /// The rate of what is of second order has to be nearer to two than to one.
    pub(super) fn judge(self, coarsest_side: f64) -> Vec<VerifiedQuantity> {
        let strips = coarsest_side * HALF_WIDTH;
        let second = Criterion::Converges {
            within: 2.0 * 1.3e-3 * (10.0 / strips).powi(2) + (1.2 * HALF_WIDTH / SIZE).powi(2),
            rate: 1.5,
        };
        let first = Criterion::Converges {
            within: 2.0 * 0.11 / strips,
            rate: 0.8,
        };
        vec![
            self.peak.judge(second),
            self.half_width.judge(second),
            self.pressure.judge(first),
        ]
    }
}

/// All loads on one mesh, and whether all are certified.
fn loaded(cells: f64, size: f64) -> Result<(Vec<Compared>, bool), Error> {
    let modulus = STEEL.contact_modulus(None)?;
    let (mut all, mut settled) = (Vec::new(), true);
    for lowered in lowered(RADIUS, size) {
        let half = body("half", parabola(cells, RADIUS, size)?, STEEL);
        let half = hold(hold(half, "left", 0, 0.0), "top", 1, -lowered);
        let (_, report, certified) = solved(&on(plane(&[0.0, 1.0]), half, "bottom", 0.0))?;
        settled &= certified;
        all.push(compared(&report, RADIUS, modulus)?);
    }
    Ok((all, settled))
}

/// p₀ over that of Hertz, mean over all loads.
fn peak_ratio(all: &[Compared]) -> f64 {
    all.iter().map(|one| one.peak.ratio()).sum::<f64>() / all.len() as f64
}

/// What the size of the body does to p₀, on meshes that are alike at the contact: second order in
/// a/L, with (a/L)² of the largest small body as bound.
fn of_size() -> Result<VerifiedQuantity, Error> {
    let mut ladder = Ladder::new("p₀/p₀(400 mm), small bodies");
    let (large, mut settled) = loaded(CELLS_OF_SMALL, SIZE)?;
    for size in SMALL {
        let (small, certified) = loaded(CELLS_OF_SMALL, size)?;
        settled &= certified;
        let found = Measured::number(peak_ratio(&small) / peak_ratio(&large), 1.0);
        ladder.climb(&format!("body of {size} mm"), 1.0 / size, settled, found);
    }
    let largest = SMALL.into_iter().fold(0.0, f64::max);
    let within = (1.2 * HALF_WIDTH / largest).powi(2);
    Ok(ladder.judge(Criterion::Converges { within, rate: 1.5 }))
}

fn measure(quick: bool) -> Result<Vec<VerifiedQuantity>, Error> {
    let mut ladders = Ladders::new();
    for &cells in meshes(quick) {
        let (all, settled) = loaded(cells, SIZE)?;
        ladders.climb(cells, settled, &all);
    }
    let finest = meshes(quick).last().copied().unwrap_or(1.0);
    let mut quantities = ladders.judge(finest);
    quantities.push(of_size()?);
    Ok(quantities)
}
