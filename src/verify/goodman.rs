//! Goodman's indentation: pressed straight on, the middle sticks and the ring around it slips.

use std::f64::consts::PI;

use super::Entry;
use super::hertz_line::{half_width, parabola};
use super::ladder::{Ladder, Measured};
use super::scenes::{body, hold, on, plane};
use crate::alternation::Status;
use crate::closed_forms::{Elastic, friction_of_stick_line};
use crate::error::Error;
use crate::pipeline::solve_steps;
use crate::report::{Criterion, Report, VerifiedQuantity};
use crate::scene::{Scene, SceneSteps};

pub(super) const ENTRY: Entry = Entry {
    name: "Goodman, a parabola with friction on a rigid plane",
    source: "Spence 1975, Johnson 1985, §5.4 (E8); coupled: computed independently",
    floor: "the closed form neglects what friction does to the pressure, μβ = 1.1 %; the body is 1600 half-widths high: its mean stress widens the contact by 0.4 % of what a growing pressure draws it together",
    measure,
    drawn: None,
};

/// β = 0.12/1.12: with more of it the closed form neglects more, with less the size of the body
/// counts for more.
const MATERIAL: Elastic = Elastic {
    young: 210e3,
    poisson: 0.44,
};

/// c/a that the coefficient of friction is chosen for.
const STICK: f64 = 0.7;

/// c/a if friction's share in the pressure is not neglected: the integral equations of the half-plane,
/// solved in `tests/two_bodies/goodman_coupled.rs`.
const COUPLED: f64 = 0.6925;

/// R of the parabola and how far its top goes down in the end, in mm.
const RADIUS: f64 = 1e5;
const LOWERED: f64 = 4.2e-5;

/// Width and height of half the body, in mm.
const SIZE: f64 = 1600.0;

/// Half-width of the contact in the end, about, in mm.
const HALF_WIDTH: f64 = 1.0;

/// The last half of the path is looked at: the ends of both zones pass many nodes in it.
const FROM: f64 = 0.5;

/// Right half of the body, lowered in `count` steps.
fn scene(cells: f64, friction: f64, count: u32) -> Result<Scene, Error> {
    let half = hold(
        body("half", parabola(cells, RADIUS, SIZE)?, MATERIAL),
        "left",
        0,
        0.0,
    );
    let half = hold(half, "top", 1, -LOWERED);
    let mut scene = on(plane(&[0.0, 1.0]), half, "bottom", friction);
    let factors = vec![vec![0.0, 0.0], vec![1.0, 1.0]];
    scene.steps = Some(SceneSteps {
        at: (1..=count)
            .map(|k| f64::from(k) / f64::from(count))
            .collect(),
        factors: [("bodies[0].supports[1]".to_owned(), factors)].into(),
        ..SceneSteps::default()
    });
    Ok(scene)
}

/// Half-width of the part that sticks over that of the contact.
fn stick_ratio(report: &Report) -> f64 {
    (report.totals.contact_area - report.totals.slip_area) / half_width(report)
}

fn measure(quick: bool) -> Result<Vec<VerifiedQuantity>, Error> {
    let beta = MATERIAL.dundurs_beta(None)?;
    let friction = friction_of_stick_line(beta, STICK)?;
    let mut uncoupled = Ladder::new("c/a, mean over the path");
    let mut coupled = Ladder::new("the same, coupled");
    let meshes: &[f64] = if quick {
        &[10.0, 20.0]
    } else {
        &[10.0, 20.0, 40.0]
    };
    for &cells in meshes {
        let mut ratios = Vec::new();
        let count = 4 * cells as u32;
        let last = solve_steps(&scene(cells, friction, count)?, None, |solution| {
            if solution.step().is_some_and(|step| step.at() >= FROM) {
                ratios.push(stick_ratio(&solution.report()?));
            }
            Ok(())
        })?;
        let settled = last.status() == Status::Certified;
        let mean = ratios.iter().sum::<f64>() / ratios.len() as f64;
        let name = format!("{cells} quad4 per mm");
        for (ladder, exact) in [(&mut uncoupled, STICK), (&mut coupled, COUPLED)] {
            let found = Measured::number(mean, exact);
            ladder.climb(&name, 1.0 / cells, settled, found);
        }
    }
    // Half a cell at the end of the zone that sticks, of first order; and the body's size: the mean
    // stress P/(2L) widens the contact by ν (1 + ν) P/(2LE), the pressure draws it together by
    // (1 − 2ν)(1 + ν) p₀/E, and P = π a p₀/2. While both grow, p₀ grows as √P, that is by half its
    // share. The closed form neglects μβ on top.
    let poisson = MATERIAL.poisson;
    let widened = 2.0 * PI * poisson / (4.0 * (1.0 - 2.0 * poisson)) * HALF_WIDTH / SIZE;
    let finest = meshes.last().copied().unwrap_or(1.0);
    let within = widened + 0.5 / (finest * STICK * HALF_WIDTH);
    Ok(vec![
        uncoupled.judge(Criterion::FinestMesh {
            within: within + friction * beta,
        }),
        coupled.judge(Criterion::Converges { within, rate: 0.8 }),
    ])
}
