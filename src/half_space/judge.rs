//! Judge: how far reactions are from the laws, by products and by direct sums alone.
//!
//! ```text
//! (K1)  r_N = t_N − min(0, t_N − (u_N − g₀)/G_NN),   r_T = t_T − P_disc(t_T − u_T/G_xx),   ‖r‖/‖t‖
//! (S10) |Σ −t_N − P| / P,   ‖Σ t_T − Q‖ / max(‖Q‖, Σ −μ t_N)      resultants that are given
//! (S11) |u − Σ_j G_ij t_j| / max(|u|, G_ii |t|)                       at random cells, by the formulas (S3)
//! ```
//!
//! It shares no line with the half-steps: it takes one product of the reactions and measures. The
//! operator itself is checked by (S11); a periodic one, which has no formula, by its own series at
//! random waves.

use std::f64::consts::PI;

use rustfft::num_complex::Complex;

use super::operator::{HalfSpace, Surroundings};
use super::outcome::{HalfSpaceCertificate, HalfSpaceState};
use super::problem::{Drag, HalfSpaceProblem, Press};
use super::rough::scattered;
use crate::error::Error;

/// Cells or waves at which the operator is checked.
const SAMPLES: u64 = 8;

/// Relative distance from a disc's edge below which a contact slips.
const ON_EDGE: f64 = 1e-8;

/// What the judge found, with the displacements it computed.
pub(super) struct Judged {
    pub(super) certificate: HalfSpaceCertificate,
    /// `u − û` along the normal, x and y, in metre per cell.
    pub(super) elastic: [Vec<f64>; 3],
}

/// Measures a state against a problem.
///
/// # Errors
///
/// [`Error::Length`] if the state is not of the problem's cells.
pub(super) fn judge(problem: &HalfSpaceProblem, state: &HalfSpaceState) -> Result<Judged, Error> {
    let [normal, x, y] = &state.reaction;
    let elastic = problem.operator().apply([normal, x, y])?;
    let mut certificate = measure(problem, state, &elastic);
    certificate.resultant_defect = resultants(problem, state);
    certificate.operator_defect = match problem.operator().surroundings() {
        Surroundings::Periodic => waves(problem.operator(), &state.reaction, &elastic),
        Surroundings::Free | Surroundings::Plane => {
            sums(problem.operator(), &state.reaction, &elastic)
        }
    };
    Ok(Judged {
        certificate,
        elastic,
    })
}

fn measure(
    problem: &HalfSpaceProblem,
    state: &HalfSpaceState,
    elastic: &[Vec<f64>; 3],
) -> HalfSpaceCertificate {
    let [of_normal, of_tangent, _] = problem.operator().diagonal();
    let mut found = HalfSpaceCertificate::default();
    let (mut defect, mut size) = (0.0, 0.0);
    for (cell, gap) in problem.initial_gap().iter().enumerate() {
        let [t_n, t_x, t_y] = [0, 1, 2].map(|c| state.reaction[c][cell]);
        let closed = elastic[0][cell] + state.approach - gap;
        let r_n = t_n - (t_n - closed / of_normal).min(0.0);
        let bound = problem.friction()[cell] * (-t_n).max(0.0);
        let slip = [0, 1].map(|axis| {
            elastic[axis + 1][cell] - state.shift[axis] - problem.reference[axis][cell]
        });
        let trial = [t_x - slip[0] / of_tangent, t_y - slip[1] / of_tangent];
        let length = trial[0].hypot(trial[1]);
        let factor = if length > bound { bound / length } else { 1.0 };
        let r_t = [t_x - factor * trial[0], t_y - factor * trial[1]];
        defect += r_n * r_n + r_t[0] * r_t[0] + r_t[1] * r_t[1];
        size += t_n * t_n + t_x * t_x + t_y * t_y;
        let sticks = t_x.hypot(t_y) < bound * (1.0 - ON_EDGE);
        match (t_n < 0.0, sticks) {
            (false, _) => found.open += 1,
            (true, true) => found.stick += 1,
            (true, false) => found.slip += 1,
        }
    }
    found.residual = match (defect > 0.0, size > 0.0) {
        (false, _) if !defect.is_nan() => 0.0,
        (true, true) => (defect / size).sqrt(),
        _ => f64::INFINITY,
    };
    found
}

/// (S10).
fn resultants(problem: &HalfSpaceProblem, state: &HalfSpaceState) -> f64 {
    let sum = |component: usize| state.reaction[component].iter().sum::<f64>();
    let normal = match problem.press() {
        Press::Load(load) if load > 0.0 => (sum(0) + load).abs() / load,
        Press::Load(_) | Press::Approach(_) => 0.0,
    };
    let tangential = match problem.drag() {
        Drag::Shift(_) => 0.0,
        Drag::Force([x, y]) => {
            let pairs = problem.friction().iter().zip(&state.reaction[0]);
            let most: f64 = pairs.map(|(mu, t_n)| -mu * t_n).sum();
            let missing = (sum(1) - x).hypot(sum(2) - y);
            match missing > 0.0 {
                true => missing / most.max(x.hypot(y)),
                false => 0.0,
            }
        }
    };
    normal.max(tangential)
}

/// (S11) by the formulas of one cell on another.
fn sums(operator: &HalfSpace, force: &[Vec<f64>; 3], elastic: &[Vec<f64>; 3]) -> f64 {
    let cells = operator.grid().len();
    let loaded: Vec<usize> = (0..cells)
        .filter(|&cell| force.iter().any(|part| part[cell] != 0.0))
        .collect();
    let most = |fields: &[Vec<f64>; 3]| {
        let values = fields.iter().flatten();
        values.fold(0.0_f64, |most, value| most.max(value.abs()))
    };
    let size = most(elastic).max(operator.diagonal()[0] * most(force));
    let mut worst = 0.0_f64;
    for sample in 0..SAMPLES {
        let at = (scattered(sample) % cells as u64) as usize;
        let mut sum = [0.0; 3];
        for &of in &loaded {
            let Some(entries) = operator.influence(at, of) else {
                return 0.0;
            };
            for (sum, row) in sum.iter_mut().zip(entries) {
                *sum += (0..3).map(|c| row[c] * force[c][of]).sum::<f64>();
            }
        }
        for (component, sum) in sum.iter().enumerate() {
            worst = worst.max((elastic[component][at] - sum).abs());
        }
    }
    if worst > 0.0 { worst / size } else { 0.0 }
}

/// (S11) by the series: the displacement's amplitude at a wave is the symbol times that of the force.
fn waves(operator: &HalfSpace, force: &[Vec<f64>; 3], elastic: &[Vec<f64>; 3]) -> f64 {
    let [columns, rows] = operator.grid().cells;
    let (unit, mut worst) = (Complex::<f64>::I, 0.0_f64);
    for sample in 0..SAMPLES {
        let pick = |seed: u64, count: usize| (scattered(seed) % (count as u64 / 2 + 1)) as usize;
        let wave = [pick(2 * sample, columns), pick(2 * sample + 1, rows)];
        let of = |field: &Vec<f64>| amplitude(field, [columns, rows], wave);
        let ([n, x, y], found) = (force.each_ref().map(of), elastic.each_ref().map(of));
        let [nn, xx, yy, xy, xn, yn] = operator.symbol(wave);
        let expected = [
            n * nn - unit * (x * xn + y * yn),
            x * xx + y * xy + unit * (n * xn),
            y * yy + x * xy + unit * (n * yn),
        ];
        for (found, expected) in found.into_iter().zip(expected) {
            worst = worst.max((found - expected).norm());
        }
    }
    let norm = |fields: &[Vec<f64>; 3]| {
        let square: f64 = fields.iter().flatten().map(|value| value * value).sum();
        (square * (columns * rows) as f64).sqrt()
    };
    // A uniform load moves nothing: what it leaves is round-off of its own size.
    let size = norm(elastic).max(operator.diagonal()[0] * norm(force));
    if worst > 0.0 { worst / size } else { 0.0 }
}

/// `Σ field · exp(−i k·x)`, term by term.
fn amplitude(field: &[f64], [columns, rows]: [usize; 2], wave: [usize; 2]) -> Complex<f64> {
    let phases = |count: usize, wave: usize| -> Vec<Complex<f64>> {
        let turn = |at: usize| -2.0 * PI * ((at * wave) % count) as f64 / count as f64;
        (0..count).map(|at| Complex::cis(turn(at))).collect()
    };
    let along_x = phases(columns, wave[0]);
    let of_row = |values: &[f64]| -> Complex<f64> {
        let pairs = values.iter().zip(&along_x);
        pairs.map(|(value, phase)| phase * value).sum()
    };
    let along_y = phases(rows, wave[1]);
    let pairs = field.chunks(columns).zip(along_y);
    pairs.map(|(row, phase)| of_row(row) * phase).sum()
}
