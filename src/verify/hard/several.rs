//! Problems with several exact states: any one of them, and never a mixture.
//!
//! One contact, `G = [[1, −1], [−1, 2]]`, `K = G⁻¹ = [[2, 1], [1, 1]]`: unique while μ < K_tt / |K_nt| = 1.
//! All states by hand: open `t = 0`; stick `t = −K û`; slip with `t_T = ± μ t_N` and `u_N = 0`.

use faer::Mat;

use super::Reach;
use super::case::Case;
use super::friction::dragged;
use crate::error::Error;
use crate::problem::{ContactProblem, Operator};

/// Many times the friction of handbooks, and 2 / (1 − 2ν), from where the square's alternation cannot work.
const ROUGH: [f64; 4] = [15.0, 20.0, 50.0, 100.0];

/// Several of the one contact, each with its own free displacement, not touching each other.
fn contacts(free: &[[f64; 2]], friction: f64) -> Result<ContactProblem, Error> {
    let own = [[1.0, -1.0], [-1.0, 2.0]];
    let size = 2 * free.len();
    let entry = |i: usize, j: usize| {
        if i / 2 == j / 2 {
            own[i % 2][j % 2]
        } else {
            0.0
        }
    };
    ContactProblem::new(
        &vec![1; free.len()],
        vec![friction; free.len()],
        vec![0.0; free.len()],
        free.iter().flatten().copied().collect(),
        Operator::from_compliance(Mat::from_fn(size, size, entry))?,
    )
}

/// Every state of the one contact, by hand.
fn states([n, t]: [f64; 2], friction: f64) -> Vec<[f64; 2]> {
    let mut states = Vec::new();
    if n <= 0.0 {
        states.push([0.0; 2]);
    }
    let stick = [-2.0 * n - t, -n - t];
    if stick[0] <= 0.0 && stick[1].abs() <= -friction * stick[0] {
        states.push(stick);
    }
    for way in [1.0, -1.0] {
        // t_T = −way μ |t_N| opposes a slip along `way`; u_N = n + t_N − t_T = 0 with t_T = way μ t_N.
        let normal = -n / (1.0 - way * friction);
        let slip = t - normal + 2.0 * way * friction * normal;
        if normal <= 0.0 && slip * way >= 0.0 {
            states.push([normal, way * friction * normal]);
        }
    }
    states
}

pub(super) fn cases() -> Result<Vec<Case>, Error> {
    let mut cases = Vec::new();
    for friction in [0.5, 0.99, 1.01, 1.5, 3.0, 10.0] {
        for (name, free) in [
            (
                "one contact that may open, stick or slip",
                vec![[-0.1, 0.5]],
            ),
            ("one contact that is pressed", vec![[0.5, -1.0]]),
            ("one contact without load", vec![[0.0, 0.0]]),
            (
                "twenty contacts",
                (0..20)
                    .map(|k| [0.1 * (k as f64 - 10.0), (1.7 * k as f64).sin()])
                    .collect(),
            ),
        ] {
            let problem = contacts(&free, friction)?;
            let case = Case::bare("several states", format!("{name}, mu {friction}"), problem);
            // Two unknowns of order one at a residual of 1e-12.
            cases.push(case.knows("nearest exact state", 1e-10, move |answer| {
                let found = answer.outcome.reaction.chunks(2).zip(&free);
                Ok(found.fold(0.0_f64, |worst, (found, free)| {
                    let distances = states(*free, friction)
                        .into_iter()
                        .map(|state| (found[0] - state[0]).hypot(found[1] - state[1]));
                    worst.max(distances.fold(f64::INFINITY, f64::min))
                }))
            }));
        }
    }
    for (cells, reach) in [(32, Reach::Coarse), (96, Reach::All)] {
        for friction in ROUGH {
            let name = format!("SSNV128, {cells} cells, mu {friction}");
            let case = Case::scene("several states", name, dragged(cells, 0.0, friction)?);
            cases.push(case.reach(reach));
        }
    }
    Ok(cases)
}
