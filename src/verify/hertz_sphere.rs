//! Hertz' point contact: a quarter of a block under a rigid sphere.

use super::Entry;
use super::ladder::{Ladder, Measured};
use super::scenes::{STEEL, body, hold, on, solved};
use crate::body::{CellKind, box_mesh, graded};
use crate::closed_forms::{Boussinesq, Elastic, HertzSphere};
use crate::error::Error;
use crate::report::{Criterion, Report, VerifiedQuantity};
use crate::scene::{Scene, SceneObstacle, SceneSupport};

pub(super) const ENTRY: Entry = Entry {
    name: "Hertz, a block under a rigid sphere",
    source: "Johnson 1985, §4.2 (E4)",
    floor: "normals are inclined by r/R, which Hertz neglects: 0.16 a/R = 5e-5 of the load, as measured with a hundred times that; the far sides, 40 contact radii away, move as under a point force (E12)",
    measure,
    drawn: None,
};

/// R of the sphere and side of the block, in mm.
const RADIUS: f64 = 1000.0;
const SIDE: f64 = 12.8;

/// Loads in newton, so that the edge of the contact falls anywhere between two nodes.
const LOADS: [f64; 4] = [6.4, 8.0, 10.0, 12.5];

const MATERIAL: Elastic = Elastic {
    young: 2.1e5,
    ..STEEL
};

/// Quarter of the block, `cells` along each axis: 14 cells grow by 1.35 each, other counts alike.
/// Its far sides move up by the approach of the load, less what the load moves a half-space there.
fn scene(cells: usize, hertz: &HertzSphere) -> Result<Scene, Error> {
    let grading = 1.35_f64.powf(14.0 * (cells as f64 - 1.0) / cells as f64);
    let lines = graded(0.0, SIDE, cells, grading)?;
    let heights: Vec<f64> = lines.iter().rev().map(|depth| 0.0 - depth).collect();
    let mesh = box_mesh(&lines, &lines, &heights, CellKind::Hex8)?;
    let force = Boussinesq::new(hertz.load, MATERIAL)?;
    let mut far = Vec::new();
    for &[x, y, z] in &mesh.nodes {
        if x == SIDE || y == SIDE || z == -SIDE {
            let r = x.hypot(y);
            let [out, down] = force.displacement(r, -z)?;
            let per_length = if r > 0.0 { out / r } else { 0.0 };
            let moved = [per_length * x, per_length * y, hertz.approach - down];
            far.push(SceneSupport::At {
                at: vec![x, y, z],
                displacement: moved.map(Some).to_vec(),
            });
        }
    }
    let mut quarter = body("quarter", mesh, MATERIAL);
    for (side, axis) in [("left", 0), ("front", 1)] {
        quarter = hold(quarter, side, axis, 0.0);
    }
    quarter.supports.extend(far);
    let sphere = SceneObstacle::Sphere {
        center: vec![0.0, 0.0, RADIUS],
        radius: RADIUS,
    };
    Ok(on(sphere, quarter, "top", 0.0))
}

/// Radius of the elliptic pressure with the same second moment: ∫ r² p dA / ∫ p dA = (2/5) a².
fn contact_radius(report: &Report) -> f64 {
    let (mut moment, mut sum) = (0.0, 0.0);
    for contact in &report.contacts {
        let force = contact.pressure.unwrap_or(f64::NAN) * contact.area;
        let across = contact.position.iter().take(2);
        sum += force;
        moment += force * across.map(|x| x * x).sum::<f64>();
    }
    (2.5 * moment / sum).sqrt()
}

fn measure(quick: bool) -> Result<Vec<VerifiedQuantity>, Error> {
    let modulus = MATERIAL.contact_modulus(None)?;
    let meshes: &[usize] = if quick {
        &[7, 10, 14, 20]
    } else {
        &[7, 10, 14, 20, 28]
    };
    let mut ladders = [
        Ladder::new("p₀ for the load carried, MPa"),
        Ladder::new("a for the load carried, mm"),
        Ladder::new("load for the approach, N"),
    ];
    for &cells in meshes {
        let (mut found, mut settled) = ([const { Vec::new() }; 3], true);
        for load in LOADS {
            let stated = HertzSphere::new(load, RADIUS, modulus)?;
            let (_, report, certified) = solved(&scene(cells, &stated)?)?;
            settled &= certified;
            let force = report.totals.contact_force.last();
            let carried = 4.0 * force.map_or(f64::NAN, |f| f.abs());
            let hertz = HertzSphere::new(carried, RADIUS, modulus)?;
            let of_load = [
                Measured::number(report.totals.peak_pressure, hertz.peak),
                Measured::number(contact_radius(&report), hertz.contact_radius),
                Measured::number(carried, load),
            ];
            for (all, one) in found.iter_mut().zip(of_load) {
                all.push(one);
            }
        }
        for (ladder, all) in ladders.iter_mut().zip(found) {
            let (name, size) = (format!("{cells}³ hex8"), 1.0 / cells as f64);
            ladder.climb(&name, size, settled, Measured::mean(&all));
        }
    }
    // (h/a)²: of 20 cells the smallest is a seventh of the radius. All three are of second order,
    // and their rates have to be nearer to two than to one.
    let finest = meshes.last().copied().unwrap_or(1) as f64;
    let within = 0.02 * (20.0 / finest).powi(2);
    let converges = Criterion::Converges { within, rate: 1.5 };
    Ok(ladders.map(|ladder| ladder.judge(converges)).into())
}
