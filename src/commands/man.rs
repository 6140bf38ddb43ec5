//! `dpana man`: the manual page of the program, or of one of its commands.

use std::error::Error;
use std::io::{self, Write};
use std::process::ExitCode;

use clap::{Args, Command};

#[derive(Args)]
pub(crate) struct Man {
    /// The command to describe, such as solve; the program itself when left out.
    command: Option<String>,
}

pub(crate) fn man(arguments: &Man, mut program: Command) -> Result<ExitCode, Box<dyn Error>> {
    program.build();
    let page = match &arguments.command {
        None => program,
        Some(name) => described(&program, name)?,
    };
    let mut text = Vec::new();
    clap_mangen::Man::new(page).render(&mut text)?;
    io::stdout().write_all(&text)?;
    Ok(ExitCode::SUCCESS)
}

/// The command of this name.
fn described(program: &Command, name: &str) -> Result<Command, String> {
    let Some(command) = program.find_subcommand(name) else {
        let known: Vec<&str> = program.get_subcommands().map(Command::get_name).collect();
        return Err(format!(
            "man {name}: no such command; expected one of {}",
            known.join(", ")
        ));
    };
    Ok(command.clone())
}
