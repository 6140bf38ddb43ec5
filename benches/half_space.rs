//! Rough surfaces on ever finer grids: with friction to 1e-10, and without to 1e-10; then one application on
//! a padded grid beside its own two-dimensional transforms with nothing done to their waves, in turn, and beside the
//! one-dimensional transforms in it, each in one small buffer that stays in the cache.
//!
//! `cargo bench --bench half_space [-- --quick]`
#![allow(clippy::print_stdout)]

use std::error::Error;
use std::fs;
use std::sync::Arc;
use std::time::Instant;

use realfft::RealFftPlanner;
use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

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
    for n in if quick {
        vec![64]
    } else {
        vec![256, 512, 1024]
    } {
        let [whole, alone, lines] = application(n)?;
        println!(
            "{n:>4}² padded, processor ms: application {whole:.1}, its transforms alone {alone:.1}, ratio {:.2}; lines in \
             one buffer {lines:.1}, ratio {:.2}",
            whole / alone,
            whole / lines
        );
    }
    Ok(())
}

/// Processor time of one application with padding, of its transforms alone, and of their lines one by one, in ms;
/// medians of rounds in turn.
fn application(n: usize) -> Result<[f64; 3], Box<dyn Error>> {
    let material = ElasticHalf {
        young: 1.0,
        poisson: 0.3,
    };
    let grid = Grid::new([n, n], [1.0 / n as f64; 2])?;
    let operator = HalfSpace::new(grid, Surroundings::Free, material, None)?;
    let force = grid.sample(|[x, y]| (9.0 * x + y).sin());
    let times = (4 << 20) / (n * n) + 1;
    let mut found: [Vec<f64>; 3] = Default::default();
    for _ in 0..7 {
        for (kind, found) in found.iter_mut().enumerate() {
            let start = processor()?;
            for _ in 0..times {
                match kind {
                    0 => drop(operator.apply([&force, &force, &force])?),
                    1 => drop(operator.transform([&force, &force, &force])?),
                    _ => transforms(n, 2 * n)?,
                }
            }
            found.push(1e3 * (processor()? - start) / times as f64);
        }
    }
    Ok(found.map(|mut times| {
        times.sort_by(f64::total_cmp);
        times[times.len() / 2]
    }))
}

/// Three fields of `n` rows there and back, padded to `m` by `m`: rows, columns, columns back, rows back.
fn transforms(n: usize, m: usize) -> Result<(), Box<dyn Error>> {
    let (mut rows, mut columns) = (RealFftPlanner::<f64>::new(), FftPlanner::<f64>::new());
    let (there, back) = (rows.plan_fft_forward(m), rows.plan_fft_inverse(m));
    let (mut row, mut waves) = (there.make_input_vec(), there.make_output_vec());
    let (forward, inverse) = (columns.plan_fft_forward(m), columns.plan_fft_inverse(m));
    let mut column = vec![Complex::default(); m];
    let lengths = [
        forward.get_inplace_scratch_len(),
        there.get_scratch_len(),
        back.get_scratch_len(),
    ];
    let mut scratch = vec![Complex::default(); lengths.into_iter().fold(m, usize::max)];
    for _ in 0..3 * n {
        there.process_with_scratch(&mut row, &mut waves, &mut scratch)?;
        back.process_with_scratch(&mut waves, &mut row, &mut scratch)?;
    }
    for _ in 0..3 * (m / 2 + 1) {
        forward.process_with_scratch(&mut column, &mut scratch);
        inverse.process_with_scratch(&mut column, &mut scratch);
    }
    Ok(())
}

/// Processor time of this process so far, in second; where the system does not tell it, none passes.
fn processor() -> Result<f64, Box<dyn Error>> {
    let text = fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields = text
        .rsplit(')')
        .next()
        .unwrap_or_default()
        .split_whitespace();
    let ticks = fields.skip(11).take(2).map(str::parse::<f64>);
    let ticks: Vec<f64> = ticks.collect::<Result<_, _>>()?;
    Ok(ticks.iter().sum::<f64>() / 100.0)
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
