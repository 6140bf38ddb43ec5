//! `dpana limit`: how far loads can grow.

use std::error::Error;
use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;
use dpana::report::replace_file;

use super::outputs::check_output;
use super::scene_file::read_scene;

#[derive(Args)]
pub(crate) struct Limit {
    /// Scene in JSON, or an Abaqus or CalculiX deck (`.inp`).
    scene: PathBuf,
    /// Write the limits to this file, in JSON.
    #[arg(long, value_name = "FILE")]
    report: Option<PathBuf>,
}

pub(crate) fn limit(arguments: &Limit) -> Result<ExitCode, Box<dyn Error>> {
    if let Some(output) = &arguments.report {
        check_output("--report", output, &arguments.scene)?;
    }
    let limits = dpana::limit(&read_scene(&arguments.scene)?)?;
    if let Some(path) = &arguments.report {
        replace_file(path, &limits.to_json())?;
    }
    writeln!(io::stdout(), "{}", limits.summary().trim_end())?;
    Ok(ExitCode::SUCCESS)
}
