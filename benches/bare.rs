//! Bare condensed problems, one by one: processor time of a whole solve and what it took.
//!
//! `cargo bench --bench bare [-- --quick] [--reactions FOLDER] [FILE…]`; without a file the shipped problems
//! (`tests/data/discrete`). The mean of several solves, to 1e-8. `benches/bare_beside.py` sets Siconos beside it.
#![allow(clippy::print_stdout)]

mod processor;

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use dpana::alternation::{Outcome, Settings, Status, solve};
use dpana::scene::BareProblem;
use processor::processor;

/// Natural-map residual at which a problem counts as solved here.
const TOLERANCE: f64 = 1e-8;

/// Processor time after which no further solve follows, in second: many times what its clock may be off.
const REPEATED: f64 = 0.5;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let (mut files, mut reactions, mut quick) = (Vec::new(), None, true);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--quick" => quick = true,
            "--bench" => quick &= std::env::args().any(|other| other == "--quick"),
            "--reactions" => reactions = arguments.next(),
            file => files.push(PathBuf::from(file)),
        }
    }
    if files.is_empty() {
        files = shipped()?;
    }
    println!(
        "| problem | contacts | s | residual | status | cone iterations | Newton steps | proximal steps |"
    );
    println!("|---|---:|---:|---:|---|---:|---:|---:|");
    for file in files {
        row(&file, reactions.as_deref(), quick)?;
    }
    Ok(())
}

fn row(file: &Path, reactions: Option<&str>, quick: bool) -> Result<(), Box<dyn Error>> {
    let bare = BareProblem::from_json(&fs::read_to_string(file)?, &file.display().to_string())?;
    let problem = bare.symmetrised().to_problem()?;
    let settings = Settings::default().with_tolerance(TOLERANCE);
    let (clock, mut solves) = (Instant::now(), 0.0);
    let start = processor(clock);
    let (outcome, seconds): (Outcome, f64) = loop {
        let outcome = solve(&problem, &settings)?;
        solves += 1.0;
        let spent = processor(clock) - start;
        if quick || spent > REPEATED {
            break (outcome, spent / solves);
        }
    };
    let (work, certificate) = (outcome.work, outcome.verdict.certificate);
    println!(
        "| {} | {} | {:.6} | {:.1e} | {} | {} | {} | {} |",
        bare.name,
        problem.contacts(),
        seconds,
        certificate.natural_map,
        if outcome.status == Status::Certified {
            "certified"
        } else {
            "not certified"
        },
        work.cone_iterations,
        work.newton_steps,
        work.proximal_steps,
    );
    if let Some(folder) = reactions {
        let text = format!("{:?}", outcome.reaction);
        fs::write(Path::new(folder).join(&bare.name), text)?;
    }
    Ok(())
}

fn shipped() -> Result<Vec<PathBuf>, Box<dyn Error>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/discrete");
    let mut files = Vec::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        let name = path.to_string_lossy();
        if name.ends_with(".json") && !name.ends_with("_loads.json") {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}
