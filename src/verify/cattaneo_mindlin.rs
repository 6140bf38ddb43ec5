//! Cattaneo's and Mindlin's partial slip: two parabolas of steel, pressed, then pulled sideways.

use std::f64::consts::PI;

use super::Entry;
use super::growing::{falling, growing};
use super::ladder::{Ladder, Measured};
use super::scenes::{STEEL, body, hold, pair};
use crate::alternation::Status;
use crate::body::{CellKind, Mesh, rectangle};
use crate::closed_forms::{CattaneoMindlin, HertzLine};
use crate::error::Error;
use crate::pipeline::solve_steps;
use crate::report::{Criterion, Report, VerifiedQuantity};
use crate::scene::{Scene, SceneSteps};

pub(super) const ENTRY: Entry = Entry {
    name: "Cattaneo and Mindlin, two parabolas of steel, pressed and pulled",
    source: "Johnson 1985, §7.2 (E5)",
    floor: "the bodies are a hundred half-widths wide and high, not half-planes: (a/L)² = 1e-4; tangents are inclined by x/R, so that p x/R of a vertical pressure counts as friction: a/(2 μ R) = 8e-6 of μ p₀",
    measure,
    drawn: None,
};

/// Half the width and the height of each body, in mm.
const SIZE: f64 = 100.0;

/// R of both, in mm. The friction that an inclined tangent makes out of the pressure, p x/R, does
/// not fall with the mesh: at R = 200 mm it is 0.8 % of μ p₀ and 2 % of the shear.
const RADIUS: f64 = 2e5;

const FRICTION: f64 = 0.3;

/// How far the upper body is pushed down and then aside, in mm.
const PRESSED: f64 = 2.8e-5;
const SHEARED: f64 = 8e-6;

/// Instants from 1 on: Q/(μP) of about 1/4, 1/2, 3/4, 9/10.
const PULLED: [f64; 4] = [1.36, 1.72, 2.09, 2.34];

/// The upper and the lower body, `cells` per mm at their faces.
fn meshes(cells: f64) -> Result<[Mesh; 2], Error> {
    let fine = 1.0 / cells;
    // All cells shrink together.
    let growth = 5.0 * fine;
    let right = growing(fine, 1.5, SIZE, growth);
    let left = falling(fine, 1.5, SIZE, growth);
    let xs: Vec<f64> = left.iter().chain(&right[1..]).copied().collect();
    let mut upper = rectangle(&xs, &growing(fine, fine, SIZE, growth), CellKind::Quad4)?;
    let mut lower = rectangle(&xs, &falling(fine, fine, SIZE, growth), CellKind::Quad4)?;
    let bent = |x: f64| x * x / (2.0 * RADIUS);
    for [x, y, _] in &mut upper.nodes {
        *y += bent(*x) * (1.0 - *y / SIZE);
    }
    for [x, y, _] in &mut lower.nodes {
        *y -= bent(*x) * (1.0 + *y / SIZE);
    }
    Ok([upper, lower])
}

/// Pressed in one step, as bodies of one material do not slip in that; then pulled.
fn scene(cells: f64) -> Result<Scene, Error> {
    let [upper, lower] = meshes(cells)?;
    let upper = hold(body("upper", upper, STEEL), "top", 0, SHEARED);
    let upper = hold(upper, "top", 1, -PRESSED);
    let lower = hold(body("lower", lower, STEEL), "bottom", 0, 0.0);
    let lower = hold(lower, "bottom", 1, 0.0);
    let mut scene = pair([upper, lower], ["bottom", "top"], FRICTION);
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
        at: [1.0].into_iter().chain(PULLED).collect(),
        factors: factors.map(|(name, rows)| (name.to_owned(), rows)).into(),
        ..SceneSteps::default()
    });
    Ok(scene)
}

/// A computed shear beside the exact one for the loads carried.
pub(super) struct Compared {
    /// Half-width or radius of the part that sticks.
    pub(super) stick: Measured,
    /// The shear in L2.
    pub(super) shear: Measured,
    /// What the shear's own shape costs on cells of a size h, over h²: of the shear in L2,
    pub(super) edges: f64,
    /// and of the part that sticks.
    pub(super) curvature: f64,
}

/// Friction along x on a contact that is round about the last axis, beside its closed form.
///
/// Friction that is not used, μ p − q, is an elliptic pressure on the part that sticks. Its second
/// moment gives c, which unlike the last node that sticks does not jump:
/// ∫ r² (μ p − q) dA/∫ (μ p − q) dA = c²/4, in 3D (2/5) c².
///
/// Strips of constant pressure, n on half the width, miss an elliptic pressure by 0.11/n in L2
/// (computed independently), all of it where the pressure ends: per length of such an edge by
/// (0.11²/3) h² times the slope of p². The shear has two edges, with (μ p₀)²/a and (μ p₀)² c/a².
pub(super) fn compared(report: &Report, friction: f64, exact: &CattaneoMindlin) -> Compared {
    let (mut error, mut size, mut moment, mut unused) = (0.0, 0.0, 0.0, 0.0);
    let round = report.totals.friction.len() == 3;
    for contact in &report.contacts {
        let across = contact.position.iter().rev().skip(1);
        let r = across.map(|x| x * x).sum::<f64>().sqrt();
        let traction = contact.friction_traction.iter().flatten();
        let expected = [-exact.shear(r), 0.0];
        let differences = traction.clone().zip(expected).map(|(t, e)| t - e);
        error += contact.area * differences.map(|d| d * d).sum::<f64>();
        size += contact.area * exact.shear(r).powi(2);
        let along = traction.clone().next().copied().unwrap_or(f64::NAN);
        let left = contact.area * (friction * contact.pressure.unwrap_or(f64::NAN) + along);
        unused += left;
        moment += left * r * r;
    }
    let (a, c) = (
        exact.contact_radius,
        exact.stick_ratio * exact.contact_radius,
    );
    let (factor, lengths) = if round {
        (2.5, [2.0 * PI * a, 2.0 * PI * c])
    } else {
        (4.0, [2.0, 2.0])
    };
    let slopes = [1.0 / a, c / (a * a)].map(|slope| 2.0 * exact.bound.powi(2) * slope);
    let ends = lengths[0] * slopes[0] + lengths[1] * slopes[1];
    Compared {
        stick: Measured::number((factor * moment / unused).sqrt(), c),
        shear: Measured::field((error / size).sqrt()),
        edges: (0.11_f64.powi(2) / 3.0 * ends / size).sqrt(),
        curvature: 1.0 / (c * c),
    }
}

/// Stick and shear up their ladders.
pub(super) struct Ladders {
    stick: Ladder,
    shear: Ladder,
    within: [f64; 2],
}

impl Ladders {
    pub(super) fn new() -> Self {
        Self {
            stick: Ladder::new("c, mm, mean error"),
            shear: Ladder::new("shear in L2, mean error"),
            within: [f64::NAN; 2],
        }
    }

    /// Several pulls on cells of a size.
    pub(super) fn climb(&mut self, mesh: &str, size: f64, settled: bool, found: &[Compared]) {
        let mean = |of: fn(&Compared) -> Measured| {
            Measured::mean(&found.iter().map(of).collect::<Vec<_>>())
        };
        self.stick.climb(mesh, size, settled, mean(|c| c.stick));
        self.shear.climb(mesh, size, settled, mean(|c| c.shear));
        let sum = |of: fn(&Compared) -> f64| found.iter().map(of).sum::<f64>() / found.len() as f64;
        self.within = [
            size * size * sum(|c| c.curvature),
            2.0 * size * sum(|c| c.edges),
        ];
    }

    /// Allowed are (h/c)², mean over the pulls, for what is of second order, at a rate nearer to two
    /// than to one, and twice what strips of constant shear have for what is of first, at the least
    /// rate given, if any.
    pub(super) fn judge(self, rate: Option<f64>) -> [VerifiedQuantity; 2] {
        let [stick, shear] = self.within;
        [
            self.stick.judge(Criterion::Converges {
                within: stick,
                rate: 1.5,
            }),
            self.shear.judge(match rate {
                Some(rate) => Criterion::Converges {
                    within: shear,
                    rate,
                },
                None => Criterion::FinestMesh { within: shear },
            }),
        ]
    }
}

fn measure(quick: bool) -> Result<Vec<VerifiedQuantity>, Error> {
    let modulus = STEEL.contact_modulus(Some(STEEL))?;
    let mut ladders = Ladders::new();
    let meshes: &[f64] = if quick {
        &[10.0, 20.0, 40.0]
    } else {
        &[10.0, 20.0, 40.0, 80.0]
    };
    for &cells in meshes {
        let mut found = Vec::new();
        let last = solve_steps(&scene(cells)?, None, |solution| {
            if solution.step().is_some_and(|step| step.at() > 1.0) {
                let report = solution.report()?;
                let hertz = HertzLine::new(report.totals.normal, 0.5 * RADIUS, modulus)?;
                let pull = report.totals.friction.first().map_or(f64::NAN, |f| -f);
                let exact = CattaneoMindlin::line(&hertz, FRICTION, pull)?;
                found.push(compared(&report, FRICTION, &exact));
            }
            Ok(())
        })?;
        let settled = last.status() == Status::Certified && found.len() == PULLED.len();
        let name = format!("{cells} quad4 per mm");
        ladders.climb(&name, 1.0 / cells, settled, &found);
    }
    Ok(ladders.judge(Some(0.8)).into())
}
