//! The command line: solve, cases, find, limit, half-space, study, check, new, import, schema, verify, and
//! completions and manual pages for itself.

mod commands;

use std::error::Error;
use std::io::{self, Write};
use std::process::ExitCode;

use clap::{CommandFactory, Parser, Subcommand};

use commands::{
    Cases, Check, Completions, Find, HalfSpace, Import, Limit, Man, New, Schema, Solve, Study,
    Verify,
};

/// Certified frictional contact of elastic bodies.
///
/// Exit status: 0 certified (or the scene is sound, or the gallery passes), 1 solved but not
/// certified (or the gallery does not pass), 2 bad input.
#[derive(Parser)]
#[command(version)]
struct CommandLine {
    /// Compute on N threads; all cores when left out.
    #[arg(
        long,
        value_name = "N",
        global = true,
        value_parser = clap::value_parser!(u16).range(1..=MOST_THREADS)
    )]
    threads: Option<u16>,
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Solve a scene and print a summary.
    Solve(Solve),
    /// Solve a scene for many values of friction, loads, gaps or obstacle positions, on one
    /// factorisation.
    #[command(alias = "sweep")]
    Cases(Cases),
    /// Find the friction, load, gap or obstacle position at which a total has a given value, such as
    /// one that was measured.
    Find(Find),
    /// Say by what factor each load can grow before nothing holds the bodies that only
    /// contact holds, and how much friction they take.
    Limit(Limit),
    /// Solve contact of elastic half-spaces on a grid, without a mesh.
    HalfSpace(HalfSpace),
    /// Run a scene over meshes, tolerances, friction and loops, and put tables and figures of
    /// time and error on a page.
    Study(Study),
    /// Read a scene and its meshes and say what is wrong, without solving.
    Check(Check),
    /// Write a starter scene for a mesh file, with its groups filled in and comments on what to change.
    New(New),
    /// Turn an Abaqus or CalculiX deck into a scene and Gmsh meshes.
    Import(Import),
    /// Print the JSON Schema of scenes.
    Schema(Schema),
    /// Compute scenes whose answers are known, and say by how much they miss them.
    Verify(Verify),
    /// Print the script that lets a shell complete commands and options.
    Completions(Completions),
    /// Print the manual page, as `man -l` reads it.
    Man(Man),
}

/// Most threads to ask for: beyond it a slip of the pen would fill the machine.
const MOST_THREADS: i64 = 1024;

fn main() -> ExitCode {
    let line = CommandLine::parse();
    let done = use_threads(line.threads).and_then(|()| run(line.command));
    done.unwrap_or_else(|error| {
        // With standard error closed there is nobody left to tell.
        let _ = writeln!(io::stderr(), "error: {error}");
        ExitCode::from(2)
    })
}

/// Sets the number of threads that everything computes on.
fn use_threads(count: Option<u16>) -> Result<(), Box<dyn Error>> {
    let Some(count) = count else {
        return Ok(());
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(count.into());
    let built = pool.build_global();
    built.map_err(|error| format!("--threads {count}: {error}; expected fewer").into())
}

fn run(command: Command) -> Result<ExitCode, Box<dyn Error>> {
    match command {
        Command::Solve(arguments) => commands::solve(&arguments),
        Command::Cases(arguments) => commands::cases(&arguments),
        Command::Find(arguments) => commands::find(&arguments),
        Command::Limit(arguments) => commands::limit(&arguments),
        Command::HalfSpace(arguments) => commands::half_space(&arguments),
        Command::Study(arguments) => commands::study(&arguments),
        Command::Check(arguments) => commands::check(&arguments),
        Command::New(arguments) => commands::new(&arguments),
        Command::Import(arguments) => commands::import(&arguments),
        Command::Schema(arguments) => commands::schema(&arguments),
        Command::Verify(arguments) => commands::verify(&arguments),
        Command::Completions(arguments) => {
            commands::completions(&arguments, CommandLine::command())
        }
        Command::Man(arguments) => commands::man(&arguments, CommandLine::command()),
    }
}
