//! `dpana verify`: the gallery of known answers, and the hard cases.

use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;
use dpana::report::MetamorphicBattery;
use dpana::verify::{Reach, hard_cases, manual, metamorphic};

use super::outputs::{check_writable, command_line, say, write_output};

/// Random scenes whose changes belong to the hard cases.
const CHANGED: usize = 250;

#[derive(Args)]
pub(crate) struct Verify {
    /// Leave out the finest meshes.
    #[arg(long)]
    quick: bool,
    /// Solve the hard cases instead: scenes that were built to break the method, and some of `--metamorphic`.
    #[arg(long, conflicts_with = "largest")]
    hard: bool,
    /// Solve only those with the most contacts: minutes, and gigabytes of memory.
    #[arg(long, conflicts_with = "quick")]
    largest: bool,
    /// Solve this many random scenes, and each again after every change that must not change its answer.
    #[arg(long, value_name = "SCENES", conflicts_with_all = ["quick", "hard", "largest"])]
    metamorphic: Option<usize>,
    /// First of the random scenes.
    #[arg(
        long,
        value_name = "NUMBER",
        default_value_t = 1,
        requires = "metamorphic"
    )]
    seed: u64,
    /// Write every number to this file, in JSON; `-` is standard output.
    #[arg(long, value_name = "FILE")]
    report: Option<PathBuf>,
    /// Write the verification manual to this file, a page of HTML: of each scene picture, source, floor, errors
    /// and rates.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["hard", "largest", "metamorphic"])]
    page: Option<PathBuf>,
}

pub(crate) fn verify(arguments: &Verify) -> Result<ExitCode, Box<dyn Error>> {
    for (option, output) in [("--report", &arguments.report), ("--page", &arguments.page)] {
        if let Some(output) = output {
            check_writable(option, output)?;
        }
    }
    if arguments.hard || arguments.largest {
        return hard(arguments);
    }
    if let Some(scenes) = arguments.metamorphic {
        let battery = what_must_not_change(arguments, scenes)?;
        if let Some(path) = &arguments.report {
            write_output(path, &battery.to_json())?;
        }
        return Ok(ended(battery.passed));
    }
    let verification = match arguments.page {
        Some(_) => manual(arguments.quick)?,
        None => dpana::verify(arguments.quick)?,
    };
    if let Some(path) = &arguments.page {
        write_output(path, &verification.page(&command_line()))?;
    }
    if let Some(path) = &arguments.report {
        write_output(path, &verification.to_json())?;
    }
    let outputs = arguments.report.iter().chain(&arguments.page);
    say(outputs, verification.summary().trim_end())?;
    Ok(ended(verification.passed))
}

/// The hard cases; with all of them, what must not change an answer.
fn hard(arguments: &Verify) -> Result<ExitCode, Box<dyn Error>> {
    let reach = match (arguments.largest, arguments.quick) {
        (true, _) => Reach::Largest,
        (false, true) => Reach::Coarse,
        (false, false) => Reach::All,
    };
    let mut told = Ok(());
    let solved = hard_cases(reach, |row| {
        if told.is_ok() {
            told = say(&arguments.report, row);
        }
    })?;
    told?;
    if let Some(path) = &arguments.report {
        write_output(path, &solved.to_json())?;
    }
    say(&arguments.report, solved.summary().trim_end())?;
    let held = match reach {
        Reach::All => what_must_not_change(arguments, CHANGED)?.passed,
        _ => true,
    };
    Ok(ended(solved.passed && held))
}

fn what_must_not_change(
    arguments: &Verify,
    scenes: usize,
) -> Result<MetamorphicBattery, Box<dyn Error>> {
    let mut told = Ok(());
    let battery = metamorphic(arguments.seed, scenes, |wrong| {
        if told.is_ok() {
            told = say(&arguments.report, wrong);
        }
    })?;
    told?;
    say(&arguments.report, battery.summary().trim_end())?;
    Ok(battery)
}

fn ended(passed: bool) -> ExitCode {
    match passed {
        true => ExitCode::SUCCESS,
        false => ExitCode::from(1),
    }
}
