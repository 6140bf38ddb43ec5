//! The default loop against projected block Gauss–Seidel (NSGS) on the same operators.
//!
//! `cargo bench --bench baseline [-- --quick]`; the cube of `examples/scenes/cube.json`,
//! condensed once per size, so that the operator's cost counts on neither side. The default's
//! seconds are those of its whole solve, Gauss–Seidel's are those of its passes alone, without
//! the judge. Repetitions alternate, and the ratio is the median of theirs.
#![allow(clippy::print_stdout)]

mod dragged_cube;

use std::error::Error;
use std::time::Instant;

use dpana::alternation::{Outcome, solve};
use dpana::condensation::Condensed;
use dpana::study::Variant;
use dpana::{ContactProblem, Settings, Status};
use dragged_cube::dragged_cube;

const REPETITIONS: usize = 5;

fn main() -> Result<(), Box<dyn Error>> {
    let has = |option: &str| std::env::args().any(|argument| argument == option);
    let quick = has("--quick") || !has("--bench");
    println!(
        "| per side | contacts | to residual | default s | NSGS s | NSGS passes | NSGS / default |"
    );
    println!("|---:|---:|---:|---:|---:|---:|---:|");
    for per_side in if quick { vec![8] } else { vec![16, 24, 32] } {
        let mechanics = dragged_cube(per_side)?.mechanics()?;
        let condensed = Condensed::new(&mechanics.bodies, &mechanics.contacts)?;
        for tolerance in [1e-8, 1e-12] {
            let duel = duel(condensed.problem(), tolerance)?;
            println!(
                "| {per_side} | {} | {tolerance:.0e} | {:.4} | {:.4} | {} | {:.1} |",
                condensed.problem().contacts(),
                duel.default,
                duel.gauss_seidel,
                duel.passes,
                duel.ratio,
            );
        }
    }
    Ok(())
}

/// Medians over the repetitions, in second.
struct Duel {
    default: f64,
    gauss_seidel: f64,
    ratio: f64,
    passes: usize,
}

fn duel(problem: &ContactProblem, tolerance: f64) -> Result<Duel, Box<dyn Error>> {
    let (mut default, mut gauss_seidel, mut ratio) = (Vec::new(), Vec::new(), Vec::new());
    let mut passes = 0;
    for _ in 0..REPETITIONS {
        let start = Instant::now();
        run(problem, tolerance, None)?;
        default.push(start.elapsed().as_secs_f64());
        let baseline = run(problem, tolerance, Some(Variant::Nsgs))?;
        passes = baseline.work.passes;
        gauss_seidel.push(baseline.work.seconds.predict);
        ratio.push(gauss_seidel[ratio.len()] / default[ratio.len()]);
    }
    Ok(Duel {
        default: median(default),
        gauss_seidel: median(gauss_seidel),
        ratio: median(ratio),
        passes,
    })
}

fn run(
    problem: &ContactProblem,
    tolerance: f64,
    variant: Option<Variant>,
) -> Result<Outcome, Box<dyn Error>> {
    let settings = Settings::default()
        .with_tolerance(tolerance)
        .with_max_sweeps(1_000_000);
    let outcome = match variant {
        None => solve(problem, &settings)?,
        Some(variant) => variant.solve(problem, &settings)?,
    };
    match outcome.status {
        Status::Certified => Ok(outcome),
        status => Err(format!("{variant:?} to {tolerance:e}: {status:?}").into()),
    }
}

fn median(mut seconds: Vec<f64>) -> f64 {
    seconds.sort_by(f64::total_cmp);
    seconds[seconds.len() / 2]
}
