//! `dpana limit`: how far loads can grow.

use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;

use super::outputs::{check_output, say, write_output};
use super::scene_file::read_scene;

#[derive(Args)]
pub(crate) struct Limit {
    /// Scene in JSON (`-`: from standard input), or an Abaqus or CalculiX deck (`.inp`).
    scene: PathBuf,
    /// Write the limits to this file, in JSON; `-` is standard output.
    #[arg(long, value_name = "FILE")]
    report: Option<PathBuf>,
    /// Rigid bodies alone: an upper bound, without any stiffness.
    #[arg(long)]
    rigid: bool,
}

pub(crate) fn limit(arguments: &Limit) -> Result<ExitCode, Box<dyn Error>> {
    if let Some(output) = &arguments.report {
        check_output("--report", output, &arguments.scene)?;
    }
    let scene = read_scene(&arguments.scene)?;
    let limits = match arguments.rigid {
        true => dpana::rigid_limit(&scene)?,
        false => dpana::limit(&scene)?,
    };
    if let Some(path) = &arguments.report {
        write_output(path, &limits.to_json())?;
    }
    say(&arguments.report, limits.summary().trim_end())?;
    Ok(ExitCode::SUCCESS)
}
