//! Mindlin's partial slip in 3D: two equal paraboloids, pressed, then pulled sideways,
//! at several loads one after the other.

use std::f64::consts::PI;

use super::Entry;
use super::cattaneo_mindlin::{Compared, Ladders, compared};
use super::growing::{falling, growing};
use super::ladder::{Ladder, Measured};
use super::scenes::{body, hold, pair};
use crate::alternation::Status;
use crate::body::{CellKind, Group, Mesh, box_mesh};
use crate::closed_forms::{CattaneoMindlin, Elastic, HertzSphere, mindlin_displacement};
use crate::error::Error;
use crate::pipeline::solve_steps;
use crate::report::{Criterion, Report, VerifiedQuantity};
use crate::scene::{Scene, SceneBody, SceneSteps};

pub(super) const ENTRY: Entry = Entry {
    name: "Mindlin, two paraboloids of ν = 0, pressed and pulled",
    source: "Mindlin 1949, Johnson 1985, §7.2 (E5)",
    floor: "the far sides, a hundred contact radii away, are rigid: 2a/(π L) = 0.7 % of δ_t at most; normals are inclined by r/R = 1e-4",
    measure,
    drawn: None,
};

/// One material on both sides does not couple pressure and slip, and without ν friction is parallel
/// to the pull: with both the closed form is exact.
const MATERIAL: Elastic = Elastic {
    young: 210e3,
    poisson: 0.0,
};

/// Radii of the contacts that the bodies are pressed to one after the other, in mm, so that the edges
/// of contact and stick fall anywhere between two nodes.
const CONTACTS: [f64; 5] = [0.9, 0.95, 1.0, 1.05, 1.1];

/// R of each body, and how far its far sides are, in mm.
const RADIUS: f64 = 1e4;
const SIZE: f64 = 100.0;

/// Nodes at least this far from the middle along x or y do not touch, in mm.
const EDGE: f64 = 1.6;

const FRICTION: f64 = 0.3;

/// Q/(μP), one after the other at each load.
const PULLED: [f64; 4] = [0.25, 0.5, 0.75, 0.9];

/// Half a block (y > 0) with a paraboloid for a face, `cells` per mm there, above or below it. Group
/// `face` is the part of it that may touch, `far` all sides that are far.
fn block(cells: f64, above: bool) -> Result<Mesh, Error> {
    let fine = 1.0 / cells;
    // All cells shrink together. The even part is a whole number of cells on every mesh.
    let growth = 2.0 * fine;
    let even = 4.0 / 3.0;
    let right = growing(fine, even, SIZE, growth);
    let left = falling(fine, even, SIZE, growth);
    let xs: Vec<f64> = left.iter().chain(&right[1..]).copied().collect();
    let (zs, side, face, back) = if above {
        (growing(fine, fine, SIZE, growth), 1.0, "bottom", "top")
    } else {
        (falling(fine, fine, SIZE, growth), -1.0, "top", "bottom")
    };
    let mut mesh = box_mesh(&xs, &right, &zs, CellKind::Hex8)?;
    let touch = |node: &[f64; 3]| node[0].abs() < EDGE && node[1] < EDGE;
    let nodes = mesh.nodes.clone();
    for [x, y, z] in &mut mesh.nodes {
        let risen = (*x * *x + *y * *y) / (2.0 * RADIUS);
        *z += side * risen * (1.0 - z.abs() / SIZE);
    }
    let facets = |name: &str| match mesh.groups.get(name) {
        Some(Group::Facets(facets)) => facets.clone(),
        _ => Vec::new(),
    };
    let mut near = facets(face);
    near.retain(|facet| facet.nodes.iter().all(|&node| touch(&nodes[node])));
    let far = [back, "left", "right", "back"].map(facets).concat();
    mesh.groups.insert("face".to_owned(), Group::Facets(near));
    mesh.groups.insert("far".to_owned(), Group::Facets(far));
    Ok(mesh)
}

/// A state of the far sides of the upper body, moved along x and pressed down, in mm.
#[derive(Clone, Copy)]
struct Moved {
    along: f64,
    down: f64,
    /// Pulled, not just pressed or lifted.
    pulled: bool,
}

/// What the closed forms need of the bodies.
struct Bodies {
    modulus: f64,
    compliance: f64,
}

impl Bodies {
    fn hertz(&self, load: f64) -> Result<HertzSphere, Error> {
        HertzSphere::new(load, RADIUS / 2.0, self.modulus)
    }

    fn displacement(&self, hertz: &HertzSphere, pull: f64) -> Result<f64, Error> {
        mindlin_displacement(hertz, FRICTION, pull, self.compliance)
    }

    /// At each load pressed by the approach of Hertz, pulled by the displacements of Mindlin and
    /// lifted: contacts that have been open start their slip anew.
    fn path(&self) -> Result<Vec<Moved>, Error> {
        let mut path = Vec::new();
        for contact in CONTACTS {
            let load = 4.0 / 3.0 * self.modulus * contact.powi(3) / (RADIUS / 2.0);
            let hertz = self.hertz(load)?;
            let down = hertz.approach;
            let still = |down| Moved {
                along: 0.0,
                down,
                pulled: false,
            };
            path.push(still(down));
            for part in PULLED {
                path.push(Moved {
                    along: self.displacement(&hertz, part * FRICTION * load)?,
                    down,
                    pulled: true,
                });
            }
            path.push(still(-down));
        }
        Ok(path)
    }

    /// A pulled state beside Mindlin's at the loads that it carries: the shear, and how far it took.
    fn compared(&self, report: &Report, along: f64) -> Result<(Compared, Measured), Error> {
        // The half that is not computed carries as much.
        let hertz = self.hertz(2.0 * report.totals.normal)?;
        let pull = report.totals.friction.first();
        let pull = pull.map_or(f64::NAN, |friction| -2.0 * friction);
        let exact = CattaneoMindlin::sphere(&hertz, FRICTION, pull)?;
        let displacement = self.displacement(&hertz, pull)?;
        Ok((
            compared(report, FRICTION, &exact),
            Measured::number(along, displacement),
        ))
    }
}

/// The far sides moved along x (first support) and down (second), not along y.
fn half(name: &str, mesh: Mesh, [along, down]: [f64; 2]) -> SceneBody {
    let half = hold(body(name, mesh, MATERIAL), "far", 0, along);
    let half = hold(hold(half, "far", 2, -down), "far", 1, 0.0);
    hold(half, "front", 1, 0.0)
}

/// One state of the path per instant 1, 2, 3 …
fn scene(cells: f64, path: &[Moved]) -> Result<Scene, Error> {
    // Supports move by one, the tables say how far.
    let upper = half("upper", block(cells, true)?, [1.0, 1.0]);
    let lower = half("lower", block(cells, false)?, [0.0, 0.0]);
    let mut scene = pair([upper, lower], ["face", "face"], FRICTION);
    let at: Vec<f64> = (1..).take(path.len()).map(f64::from).collect();
    let rows = |of: fn(&Moved) -> f64| {
        let rows = at.iter().zip(path);
        rows.map(|(at, moved)| vec![*at, of(moved)]).collect()
    };
    let [along, down] = ["bodies[0].supports[0]", "bodies[0].supports[1]"].map(str::to_owned);
    let factors = [(along, rows(|m| m.along)), (down, rows(|m| m.down))].into();
    scene.steps = Some(SceneSteps {
        factors,
        at,
        ..SceneSteps::default()
    });
    Ok(scene)
}

fn measure(quick: bool) -> Result<Vec<VerifiedQuantity>, Error> {
    let bodies = Bodies {
        modulus: MATERIAL.contact_modulus(Some(MATERIAL))?,
        compliance: MATERIAL.tangential_compliance(Some(MATERIAL))?,
    };
    let path = bodies.path()?;
    let meshes: &[f64] = if quick { &[3.0, 4.5] } else { &[3.0, 4.5, 6.0] };
    let mut ladders = Ladders::new();
    let mut displacement = Ladder::new("δ_t for P and Q carried, mm");
    for &cells in meshes {
        let (mut shears, mut displacements) = (Vec::new(), Vec::new());
        let mut states = path.iter();
        let last = solve_steps(&scene(cells, &path)?, None, |solution| {
            if let Some(state) = states.next().filter(|state| state.pulled) {
                let (shear, taken) = bodies.compared(&solution.report()?, state.along)?;
                shears.push(shear);
                displacements.push(taken);
            }
            Ok(())
        })?;
        let settled = last.status() == Status::Certified && states.next().is_none();
        let (name, size) = (format!("{cells} hex8 per mm"), 1.0 / cells);
        ladders.climb(&name, size, settled, &shears);
        displacement.climb(&name, size, settled, Measured::mean(&displacements));
    }
    // (h/a)², as for the sphere of Hertz, and the far sides.
    let finest = meshes.last().copied().unwrap_or(1.0);
    let [least, .., most] = CONTACTS;
    let within = (finest * least).powi(-2) + 2.0 * most / (PI * SIZE);
    // No rate is asked of the shear: the ring that slips is thinner than a cell at the first pulls, and
    // meshes over a factor of two do not tell its order.
    let mut quantities = Vec::from(ladders.judge(None));
    quantities.push(displacement.judge(Criterion::FinestMesh { within }));
    Ok(quantities)
}
