//! Solves bare condensed problems, from any code that can write `W`, `q` and `μ`.
//!
//! `cargo run --release --example condensed [FILE…]`; without a file the public problems
//! under `tests/data/discrete`. Most of them come from rigid bodies, and their operator has
//! fewer independent columns (`rank`) than unknowns: the forces are then not unique, the
//! displacements and the residual are.
#![allow(clippy::print_stdout)]

use std::error::Error;
use std::path::{Path, PathBuf};

use dpana::ContactProblem;
use dpana::alternation::{Outcome, Settings, Status, solve};
use dpana::scene::BareProblem;
use faer::Side;

/// Natural-map residual at which a problem counts as solved here.
const TOLERANCE: f64 = 1e-8;

/// An eigenvalue of the operator below this part of the largest one counts as zero.
const RANK: f64 = 1e-10;

struct Solved {
    name: String,
    problem: ContactProblem,
    outcome: Outcome,
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut files: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    if files.is_empty() {
        files = shipped()?;
    }
    println!(
        "problem                          contacts  unknowns  rank  status         residual  sweeps  Newton"
    );
    for file in files {
        let Solved {
            name,
            problem,
            outcome,
        } = run(&file)?;
        println!(
            "{name:<32} {:>8} {:>9} {:>5}  {:<13} {:>9.1e} {:>7} {:>7}",
            problem.contacts(),
            problem.unknowns(),
            rank(&problem)?,
            words(outcome.status),
            outcome.verdict.certificate.natural_map,
            outcome.work.sweeps,
            outcome.work.newton_steps,
        );
    }
    Ok(())
}

fn run(file: &Path) -> Result<Solved, Box<dyn Error>> {
    let bare =
        BareProblem::from_json(&std::fs::read_to_string(file)?, &file.display().to_string())?;
    let problem = bare.to_problem()?;
    let settings = Settings {
        tolerance: TOLERANCE,
        ..Settings::default()
    };
    let outcome = solve(&problem, &settings)?;
    Ok(Solved {
        name: bare.name,
        problem,
        outcome,
    })
}

fn words(status: Status) -> &'static str {
    match status {
        Status::Certified => "certified",
        Status::NotConverged => "not converged",
        Status::NoEquilibrium => "no equilibrium",
        Status::CouplingFault => "coupling fault",
    }
}

/// Number of eigenvalues of the operator that are not zero.
fn rank(problem: &ContactProblem) -> Result<usize, Box<dyn Error>> {
    let eigenvalues = problem
        .compliance()
        .self_adjoint_eigenvalues(Side::Lower)
        .map_err(|_| "the eigenvalues of the operator were not found")?;
    let largest = eigenvalues
        .iter()
        .fold(0.0, |most: f64, &value| most.max(value));
    Ok(eigenvalues
        .iter()
        .filter(|&&value| value > RANK * largest)
        .count())
}

fn shipped() -> Result<Vec<PathBuf>, Box<dyn Error>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/discrete");
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        if path.extension().is_some_and(|ending| ending == "json") {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use dpana::Judge;

    use super::*;

    #[test]
    fn every_shipped_problem_is_certified_by_a_judge_called_once_more() {
        let files = shipped().unwrap();
        assert_eq!(files.len(), 7);
        for file in files {
            let solved = run(&file).unwrap();
            assert_eq!(solved.outcome.status, Status::Certified, "{}", solved.name);
            let verdict = Judge::new(&solved.problem).measure(&solved.outcome.reaction);
            assert!(
                verdict.certificate.natural_map <= TOLERANCE,
                "{}",
                solved.name
            );
        }
    }

    #[test]
    fn elastic_operators_have_full_rank_and_stacked_rigid_boxes_do_not() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/discrete");
        let deficit = |name: &str| {
            let problem = run(&folder.join(name)).unwrap().problem;
            problem.unknowns() - rank(&problem).unwrap()
        };
        assert_eq!(deficit("fem_static_N4_mu0.8.json"), 0);
        // 82 contacts of 3 unknowns against 6 motions of each box.
        assert!(deficit("Box_Stacks-i0122-82-5.json") > 0);
    }
}
