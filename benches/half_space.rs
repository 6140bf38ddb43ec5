//! Rough surfaces on ever finer grids: with friction to 1e-10, and without to 1e-10.
//!
//! `cargo bench --bench half_space [-- --quick]`
#![allow(clippy::print_stdout)]

use std::error::Error;
use std::sync::Arc;
use std::time::Instant;

use dpana::half_space::{
    Drag, ElasticHalf, Grid, HalfSpace, HalfSpaceProblem, Press, SelfAffine, Surroundings,
};

fn main() -> Result<(), Box<dyn Error>> {
    let quick = std::env::args().any(|argument| argument == "--quick");
    let sizes: &[usize] = if quick { &[64] } else { &[128, 256, 512, 1024] };
    println!("cells   friction  status        residual  outer  applications  seconds");
    for (&n, friction) in sizes.iter().flat_map(|n| [(n, 0.0), (n, 0.3)]) {
        let problem = rough(n, friction)?;
        let start = Instant::now();
        let outcome = problem.solve()?;
        println!(
            "{n:>4}²   {friction:>8}  {:<12}  {:>8.1e}  {:>5}  {:>12.0}  {:>7.2}",
            format!("{:?}", outcome.status),
            outcome.certificate.residual,
            outcome.work.outer,
            outcome.work.applications(),
            start.elapsed().as_secs_f64(),
        );
    }
    Ok(())
}

/// H = 0.8, roll-off 8 waves, cut-off n/8, slope 0.1, mean pressure 0.01 E*, sheared.
fn rough(n: usize, friction: f64) -> Result<HalfSpaceProblem, dpana::Error> {
    let material = ElasticHalf {
        young: 1.0,
        poisson: 0.3,
    };
    let grid = Grid::new([n, n], [1.0 / n as f64; 2])?;
    let operator = Arc::new(HalfSpace::new(
        grid,
        Surroundings::Periodic,
        material,
        None,
    )?);
    let surface = SelfAffine {
        hurst: 0.8,
        roll_off: 1.0 / 8.0,
        cut_off: 8.0 / n as f64,
        slope: 0.1,
        seed: 3,
    };
    let gap = surface
        .heights(&grid)?
        .iter()
        .map(|height| -height)
        .collect();
    let problem = HalfSpaceProblem::new(operator, gap, &[friction], Press::Load(0.01 / 0.91))?;
    problem.dragged(Drag::Shift([2e-4, 0.0]))
}
