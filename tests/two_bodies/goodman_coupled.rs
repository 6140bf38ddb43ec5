//! What Goodman's closed form neglects: the integral equations of a half-plane, solved without it.
//!
//! ```text
//! −(1/π) ∫ p ln|x−s| ds + β' ∫₀ˣ q ds = const    for |x| < a   a flat punch goes straight down
//! −(1/π) ∫ q ln|x−s| ds − β  ∫₀ˣ p ds = 0        for |x| < c   its middle sticks
//!  q = μ p                                       for c < x < a  the rest slips inward
//! ```
//!
//! β' = β is the half-plane, β' = 0 the closed form (E8). The part that sticks is the one at whose
//! end q is bounded; it is the same for every punch whose shape is a power (Spence, J. Elasticity 5
//! (1975) 297–319), so also for the parabola of the gallery.

use std::f64::consts::{FRAC_PI_2, PI};

use dpana::closed_forms::friction_of_stick_line;
use faer::linalg::solvers::Solve;
use faer::{Mat, Side};

const BETA: f64 = 0.12 / 1.12;

/// Cells on (0, c) that shrink towards c, then half as many on (c, 1) that shrink towards both ends.
fn ends(c: f64, count: usize) -> Vec<f64> {
    let part = |k: usize, of: usize| k as f64 / of as f64;
    let sticks = (0..=count).map(|k| c * (FRAC_PI_2 * part(k, count)).sin());
    let half = count / 2;
    let slips = (1..=half).map(|k| c + (1.0 - c) * 0.5 * (1.0 - (PI * part(k, half)).cos()));
    sticks.chain(slips).collect()
}

/// ∫ ln|z| dz.
fn logarithm(z: f64) -> f64 {
    if z == 0.0 { 0.0 } else { z * z.abs().ln() - z }
}

/// Strength of the singularity 1/√(c−x) of q − μ p at the end of the part that sticks, with p and q
/// constant on every cell: p even, q odd.
fn singularity(c: f64, friction: f64, onto_pressure: f64, count: usize) -> f64 {
    let ends = ends(c, count);
    let cells = ends.len() - 1;
    let middle = |i: usize| 0.5 * (ends[i] + ends[i + 1]);
    let kernel = |i: usize, j: usize, image: f64| {
        let (x, low, high) = (middle(i), ends[j], ends[j + 1]);
        let own = logarithm(x - low) - logarithm(x - high);
        let mirrored = logarithm(x + high) - logarithm(x + low);
        -(own + image * mirrored) / PI
    };
    // ∫₀ˣ over cell j, up to the middle of cell i.
    let up_to = |i: usize, j: usize| {
        let width = ends[j + 1] - ends[j];
        match j.cmp(&i) {
            std::cmp::Ordering::Less => width,
            std::cmp::Ordering::Equal => 0.5 * width,
            std::cmp::Ordering::Greater => 0.0,
        }
    };
    // Unknown: p on all cells, q on those that stick, the constant; load one half.
    let unknowns = cells + count + 1;
    let mut matrix = Mat::<f64>::zeros(unknowns, unknowns);
    let mut load = Mat::<f64>::zeros(unknowns, 1);
    for j in 0..cells {
        let slips = if j < count { 0.0 } else { friction };
        for i in 0..cells {
            matrix[(i, j)] = kernel(i, j, 1.0) + onto_pressure * slips * up_to(i, j);
        }
        for i in 0..count {
            matrix[(cells + i, j)] = slips * kernel(i, j, -1.0) - BETA * up_to(i, j);
        }
        matrix[(j, unknowns - 1)] = -1.0;
        matrix[(unknowns - 1, j)] = ends[j + 1] - ends[j];
    }
    for j in 0..count {
        for i in 0..cells {
            matrix[(i, cells + j)] = onto_pressure * up_to(i, j);
        }
        for i in 0..count {
            matrix[(cells + i, cells + j)] = kernel(i, j, -1.0);
        }
    }
    load[(unknowns - 1, 0)] = 0.5;
    let solved = matrix.partial_piv_lu().solve(&load);

    // q/(μp) − 1 near c is a sum of (c−x)^(−½), (c−x)^½, (c−x)^(3/2): least squares over five cells,
    // the last one left out, which is where constant cells are worst.
    let (mut normal, mut right) = (Mat::<f64>::zeros(3, 3), Mat::<f64>::zeros(3, 1));
    for i in count - 6..count - 1 {
        let bound = friction * solved[(i, 0)];
        let root = (c - middle(i)).sqrt();
        let powers = [1.0 / root, root, root.powi(3)];
        for (row, power) in powers.iter().enumerate() {
            right[(row, 0)] += power * (solved[(cells + i, 0)] / bound - 1.0);
            for (column, other) in powers.iter().enumerate() {
                normal[(row, column)] += power * other;
            }
        }
    }
    normal.llt(Side::Lower).unwrap().solve(&right)[(0, 0)]
}

/// c/a by bisection: friction holds too little where q wants to grow beyond it.
fn stick_ratio(friction: f64, onto_pressure: f64, count: usize) -> f64 {
    let (mut low, mut high) = (0.6, 0.8);
    let at = |c: f64| singularity(c, friction, onto_pressure, count);
    let rising = at(high) > at(low);
    assert!(at(low) * at(high) < 0.0);
    for _ in 0..20 {
        let middle = 0.5 * (low + high);
        if (at(middle) > 0.0) == rising {
            high = middle;
        } else {
            low = middle;
        }
    }
    0.5 * (low + high)
}

#[test]
fn without_what_it_neglects_goodmans_closed_form_solves_the_integral_equations() {
    let friction = friction_of_stick_line(BETA, 0.7).unwrap();
    // The cells at c, of size 1/count², hold it within a part of 1/count.
    let found = stick_ratio(friction, 0.0, 60);
    assert!((found - 0.7).abs() < 3e-4, "{found}");
}

#[test]
fn friction_on_the_pressure_takes_one_percent_of_the_part_that_sticks() {
    // The value that the gallery holds the computed part against.
    let friction = friction_of_stick_line(BETA, 0.7).unwrap();
    let found = stick_ratio(friction, BETA, 60);
    assert!((found - 0.6925).abs() < 3e-4, "{found}");
    // What is neglected is of the order of μβ.
    let neglected = (0.7 - found) / 0.7;
    assert!(neglected > 0.5 * friction * BETA && neglected < 2.0 * friction * BETA);
}
