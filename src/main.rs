//! The command line: solve, cases, limit, half-space, study, check, import, schema, verify.

mod commands;

use std::io::{self, Write};
use std::process::ExitCode;

use clap::{Parser, Subcommand};

use commands::{Cases, Check, HalfSpace, Import, Limit, Solve, Study, Verify};

/// Certified frictional contact of elastic bodies.
///
/// Exit status: 0 certified (or the scene is sound, or the gallery passes), 1 solved but not
/// certified (or the gallery does not pass), 2 bad input.
#[derive(Parser)]
#[command(version)]
struct CommandLine {
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
    /// Turn an Abaqus or CalculiX deck into a scene and Gmsh meshes.
    Import(Import),
    /// Print the JSON Schema of scenes.
    Schema,
    /// Compute scenes whose answers are known, and say by how much they miss them.
    Verify(Verify),
}

fn main() -> ExitCode {
    let done = match CommandLine::parse().command {
        Command::Solve(arguments) => commands::solve(&arguments),
        Command::Cases(arguments) => commands::cases(&arguments),
        Command::Limit(arguments) => commands::limit(&arguments),
        Command::HalfSpace(arguments) => commands::half_space(&arguments),
        Command::Study(arguments) => commands::study(&arguments),
        Command::Check(arguments) => commands::check(&arguments),
        Command::Import(arguments) => commands::import(&arguments),
        Command::Schema => commands::schema(),
        Command::Verify(arguments) => commands::verify(&arguments),
    };
    done.unwrap_or_else(|error| {
        // With standard error closed there is nobody left to tell.
        let _ = writeln!(io::stderr(), "error: {error}");
        ExitCode::from(2)
    })
}
