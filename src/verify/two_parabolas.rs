//! Hertz' line contact of two parabolas of one material on meshes that do not match.

use super::Entry;
use super::hertz_line::{Ladders, SIZE, compared, lowered, meshes, parabola};
use super::scenes::{STEEL, body, hold, pair, solved};
use crate::body::{CellKind, Mesh};
use crate::closed_forms::contact_radius;
use crate::error::Error;
use crate::report::VerifiedQuantity;
use crate::scene::Scene;

pub(super) const ENTRY: Entry = Entry {
    name: "Hertz, two parabolas of steel that do not match",
    source: "Johnson 1985, §4.2 (E3)",
    floor: "the bodies are four hundred half-widths wide and high, not half-planes: (a/L)² = 9e-6 at most",
    measure,
    drawn: Some(|| scene(5.0, 1e-3)),
};

/// R of the upper and of the lower parabola, in mm.
const RADII: [f64; 2] = [15e3, 30e3];

/// The mesh upside down, cells still turning to the left.
fn mirrored(mesh: &Mesh) -> Mesh {
    let nodes = mesh.nodes.iter().map(|[x, y, z]| [*x, 0.0 - *y, *z]);
    let mut mirror = Mesh::new(mesh.dimension, nodes.collect());
    for cell in mesh.cells() {
        let nodes: Vec<usize> = cell.nodes.iter().rev().copied().collect();
        mirror.push_cell(CellKind::Quad4, &nodes);
    }
    mirror.groups = mesh.groups.clone();
    mirror
}

/// Cells of the lower body over those of the upper one.
const COARSER: f64 = 0.8;

/// Right halves; the upper one is lowered.
fn scene(cells: f64, lowered: f64) -> Result<Scene, Error> {
    let upper = body("upper", parabola(cells, RADII[0], SIZE)?, STEEL);
    let below = mirrored(&parabola(COARSER * cells, RADII[1], SIZE)?);
    let lower = body("lower", below, STEEL);
    let halves = [(upper, -lowered), (lower, 0.0)];
    // The mirror has its top at the bottom.
    let bodies = halves.map(|(half, moved)| hold(hold(half, "left", 0, 0.0), "top", 1, moved));
    Ok(pair(bodies, ["bottom", "bottom"], 0.0))
}

fn measure(quick: bool) -> Result<Vec<VerifiedQuantity>, Error> {
    let modulus = STEEL.contact_modulus(Some(STEEL))?;
    let radius = contact_radius(RADII[0], RADII[1])?;
    let mut ladders = Ladders::new();
    for &cells in meshes(quick) {
        let (mut all, mut settled) = (Vec::new(), true);
        for lowered in lowered(radius, SIZE) {
            let (_, report, certified) = solved(&scene(cells, lowered)?)?;
            settled &= certified;
            all.push(compared(&report, radius, modulus)?);
        }
        ladders.climb(cells, settled, &all);
    }
    let finest = meshes(quick).last().copied().unwrap_or(1.0);
    Ok(ladders.judge(COARSER * finest))
}
