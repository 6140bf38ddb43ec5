//! `dpana verify`: the gallery of known answers.

use std::error::Error;
use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;
use dpana::report::replace_file;

use super::outputs::check_writable;

#[derive(Args)]
pub(crate) struct Verify {
    /// Leave out the finest meshes.
    #[arg(long)]
    quick: bool,
    /// Write every number to this file, in JSON.
    #[arg(long, value_name = "FILE")]
    report: Option<PathBuf>,
}

pub(crate) fn verify(arguments: &Verify) -> Result<ExitCode, Box<dyn Error>> {
    if let Some(output) = &arguments.report {
        check_writable("--report", output)?;
    }
    let verification = dpana::verify(arguments.quick)?;
    if let Some(path) = &arguments.report {
        replace_file(path, &verification.to_json())?;
    }
    writeln!(io::stdout(), "{}", verification.summary().trim_end())?;
    Ok(match verification.passed {
        true => ExitCode::SUCCESS,
        false => ExitCode::from(1),
    })
}
