//! `dpana completions`: a script that lets a shell complete commands and options.

use std::error::Error;
use std::io::{self, Write};
use std::process::ExitCode;

use clap::{Args, Command};
use clap_complete::Shell;

#[derive(Args)]
pub(crate) struct Completions {
    /// The shell, such as bash: `dpana completions bash > ~/.local/share/bash-completion/completions/dpana`.
    shell: Shell,
}

pub(crate) fn completions(
    arguments: &Completions,
    mut command: Command,
) -> Result<ExitCode, Box<dyn Error>> {
    let name = command.get_name().to_owned();
    // Into memory first: the generator panics where it cannot write, as into a pipe that was closed.
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut command, name, &mut script);
    io::stdout().write_all(&script)?;
    Ok(ExitCode::SUCCESS)
}
