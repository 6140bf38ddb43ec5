//! Solves bare condensed problems, from any code that can write `W`, `q` and `μ`.
//!
//! `cargo run --release --example condensed [--symmetrise] [FILE…]`; without a file the public problems
//! under `tests/data/discrete`. Most of them come from rigid bodies, and their operator has
//! fewer independent columns (`rank`) than unknowns: the forces are then not unique, the
//! displacements and the residual are.
//!
//! A file that is refused has its reason in the table, and the next one follows. With `--symmetrise` the
//! symmetric part of every operator is solved.
#![allow(clippy::print_stdout)]

use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

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

fn main() -> ExitCode {
    let (options, names): (Vec<_>, Vec<_>) = std::env::args_os()
        .skip(1)
        .partition(|argument| argument == "--symmetrise");
    let mut files: Vec<PathBuf> = names.into_iter().map(PathBuf::from).collect();
    if files.is_empty() {
        files = shipped();
    }
    println!(
        "problem                          contacts  unknowns  rank  status         residual  sweeps  Newton"
    );
    let mut refused = 0;
    for file in &files {
        match line(file, !options.is_empty()) {
            Ok(line) => println!("{line}"),
            Err(error) => {
                refused += 1;
                println!("{}: {error}", file.display());
            }
        }
    }
    match refused {
        0 => ExitCode::SUCCESS,
        _ => {
            println!("{refused} of {} files refused", files.len());
            ExitCode::from(2)
        }
    }
}

/// The line of a file in the table.
fn line(file: &Path, symmetrise: bool) -> Result<String, Box<dyn Error>> {
    let Solved {
        name,
        problem,
        outcome,
    } = run(file, symmetrise)?;
    Ok(format!(
        "{name:<32} {:>8} {:>9} {:>5}  {:<13} {:>9.1e} {:>7} {:>7}",
        problem.contacts(),
        problem.unknowns(),
        rank(&problem)?,
        words(outcome.status),
        outcome.verdict.certificate.natural_map,
        outcome.work.sweeps,
        outcome.work.newton_steps,
    ))
}

fn run(file: &Path, symmetrise: bool) -> Result<Solved, Box<dyn Error>> {
    let bare =
        BareProblem::from_json(&std::fs::read_to_string(file)?, &file.display().to_string())?;
    Ok(solved(&if symmetrise { bare.symmetrised() } else { bare })?)
}

fn solved(bare: &BareProblem) -> Result<Solved, dpana::Error> {
    let problem = bare.to_problem()?;
    let settings = Settings::default().with_tolerance(TOLERANCE);
    let outcome = solve(&problem, &settings)?;
    Ok(Solved {
        name: bare.name.clone(),
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

/// All public problems; `*_loads.json` are further loads of one of them.
fn shipped() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/discrete");
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
    files.retain(|path| {
        let name = path.to_string_lossy();
        name.ends_with(".json") && !name.ends_with("_loads.json")
    });
    files.sort();
    files
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use dpana::Judge;

    use super::*;

    #[test]
    fn every_shipped_problem_is_certified_by_a_judge_called_once_more() {
        let files = shipped();
        assert_eq!(files.len(), 10);
        for file in files {
            let solved = run(&file, false).unwrap();
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
            let problem = run(&folder.join(name), false).unwrap().problem;
            problem.unknowns() - rank(&problem).unwrap()
        };
        assert_eq!(deficit("fem_static_N4_mu0.8.json"), 0);
        // 82 contacts of 3 unknowns against 6 motions of each box.
        assert!(deficit("Box_Stacks-i0122-82-5.json") > 0);
    }

    #[test]
    fn a_lopsided_problem_is_refused_and_its_symmetric_part_solved() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/discrete");
        let text = std::fs::read_to_string(folder.join("FrictionContactProblem00374.json"));
        let mut bare = BareProblem::from_json(&text.unwrap(), "").unwrap();
        // The largest entry of W off its diagonal, by a thousandth.
        let size = |k: &usize| bare.w_values[*k].abs();
        let off = (0..bare.w_values.len()).filter(|&k| bare.w_rows[k] != bare.w_cols[k]);
        let largest = off.max_by(|a, b| size(a).total_cmp(&size(b))).unwrap();
        bare.w_values[largest] *= 1.001;
        let refused = solved(&bare).err().unwrap().to_string();
        assert!(refused.contains("not symmetric by"), "{refused}");
        let half = solved(&bare.symmetrised()).unwrap();
        assert_eq!(half.outcome.status, Status::Certified);
    }
}
