//! Solves bare condensed problems, from any code that can write `W`, `q` and `μ`.
//!
//! `cargo run --release --example condensed [FILE…]`; without a file the public
//! problems under `tests/data/discrete`.
#![allow(clippy::print_stdout)]

use std::error::Error;
use std::path::{Path, PathBuf};

use dpana::dpana::{Outcome, Settings, solve};
use dpana::scene::BareProblem;

/// Residual at which a problem counts as solved here.
const TOLERANCE: f64 = 1e-8;

fn main() -> Result<(), Box<dyn Error>> {
    let mut files: Vec<PathBuf> = std::env::args().skip(1).map(PathBuf::from).collect();
    if files.is_empty() {
        files = shipped()?;
    }
    println!(
        "{:<32} {:>8} {:>12} {:>10} {:>7}",
        "problem", "contacts", "status", "residual", "sweeps"
    );
    for file in files {
        let (problem, outcome) = run(&file)?;
        println!(
            "{:<32} {:>8} {:>12} {:>10.1e} {:>7}",
            problem.name,
            problem.contacts,
            format!("{:?}", outcome.status),
            outcome.verdict.certificate.natural_map,
            outcome.work.sweeps,
        );
    }
    Ok(())
}

fn run(file: &Path) -> Result<(BareProblem, Outcome), Box<dyn Error>> {
    let name = file.display().to_string();
    let bare = BareProblem::from_json(&std::fs::read_to_string(file)?, &name)?;
    let settings = Settings {
        tolerance: TOLERANCE,
        ..Settings::default()
    };
    let outcome = solve(&bare.to_problem()?, &settings)?;
    Ok((bare, outcome))
}

fn shipped() -> Result<Vec<PathBuf>, Box<dyn Error>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/discrete");
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        if path
            .extension()
            .is_some_and(|extension| extension == "json")
        {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}
