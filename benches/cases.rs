//! Many cases on one factorisation against as many separate solves.
//!
//! `cargo bench --bench cases [-- --quick]`: friction by load on the SSNV128 square, friction by
//! displacement on the dragged cube. The time of a separate solve is the mean over a few of the cases.
#![allow(clippy::print_stdout)]

mod dragged_cube;
mod generated_square;

use std::error::Error;
use std::time::Instant;

use dpana::report::Cell;
use dpana::scene::{SceneLoad, SceneSupport};
use dpana::{Scene, Variation, cases, solve};
use dragged_cube::dragged_cube;
use generated_square::square;

/// Separate solves to take the mean of.
const SEPARATE: usize = 5;

fn main() -> Result<(), Box<dyn Error>> {
    let quick = std::env::args().any(|argument| argument == "--quick");
    let (square_cells, cube_cells) = if quick { (16, 4) } else { (128, 16) };
    println!(
        "| scene | cases | certified | sweep s | per case s | separate solve s | separate / case |"
    );
    println!("|---|---:|---:|---:|---:|---:|---:|");
    let few = |count: usize| if quick { 2 } else { count };
    let frictions = steps("friction", few(20), [0.1, 1.0]);
    let loads = steps("bodies[0].loads[1]", few(50), [0.2, 1.2]);
    row("square", &square(square_cells)?, &[frictions, loads])?;
    let frictions = steps("friction", few(10), [0.1, 1.0]);
    let supports = steps("bodies[0].supports[0]", few(10), [0.2, 2.0]);
    row("cube", &dragged_cube(cube_cells)?, &[frictions, supports])
}

fn steps(name: &str, count: usize, [first, last]: [f64; 2]) -> Variation {
    let values = (0..count).map(|k| first + (last - first) * k as f64 / (count - 1).max(1) as f64);
    Variation {
        name: name.to_owned(),
        values: values.collect(),
    }
}

fn row(name: &str, scene: &Scene, variations: &[Variation]) -> Result<(), Box<dyn Error>> {
    let start = Instant::now();
    let table = cases(scene, variations)?;
    let together = start.elapsed().as_secs_f64();
    let count = table.rows.len();
    let certified = table
        .rows
        .iter()
        .filter(|row| row.contains(&Cell::Word("certified".into())));
    let certified = certified.count();
    let start = Instant::now();
    for k in 0..SEPARATE {
        let mut alone = scene.clone();
        for variation in variations {
            let value = variation.values[(k * variation.values.len()) / SEPARATE];
            put(&mut alone, &variation.name, value);
        }
        solve(&alone)?.report()?;
    }
    let separate = start.elapsed().as_secs_f64() / SEPARATE as f64;
    let case = together / count as f64;
    println!(
        "| {name} | {count} | {certified} | {together:.2} | {case:.4} | {separate:.4} | {:.1} |",
        separate / case
    );
    if certified < count {
        return Err(format!("{name}: {} cases are not certified", count - certified).into());
    }
    Ok(())
}

/// What the sweep does, on a scene of its own.
fn put(scene: &mut Scene, name: &str, value: f64) {
    match name {
        "friction" => scene.contacts[0].friction = Some(value),
        "bodies[0].loads[1]" => {
            if let SceneLoad::Pressure { pressure, .. } = &mut scene.bodies[0].loads[1] {
                *pressure *= value;
            }
        }
        _ => {
            if let SceneSupport::Group { displacement, .. } = &mut scene.bodies[0].supports[0] {
                displacement.iter_mut().flatten().for_each(|u| *u *= value);
            }
        }
    }
}
