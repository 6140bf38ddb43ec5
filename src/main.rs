//! The command line: solve, limit, check, schema, verify.

use std::error::Error;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Args, Parser, Subcommand};
use dpana::Status;
use dpana::body;
use dpana::report::replace_file;
use dpana::scene::{self, Scene};

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
    /// Say by what factor each load can grow before nothing holds the bodies that only
    /// contact holds, and how much friction they take.
    Limit(Limit),
    /// Read a scene and its meshes and say what is wrong, without solving.
    Check {
        /// Scene in JSON.
        scene: PathBuf,
    },
    /// Print the JSON Schema of scenes.
    Schema,
    /// Compute scenes whose answers are known, and say by how much they miss them.
    Verify(Verify),
}

#[derive(Args)]
struct Solve {
    /// Scene in JSON.
    scene: PathBuf,
    /// Write the whole report to this file, in JSON.
    #[arg(long, value_name = "FILE")]
    report: Option<PathBuf>,
    /// Write displacement and stress to this file for ParaView, and the contact surface
    /// beside it (`FILE_contact.vtu`).
    #[arg(long, value_name = "FILE")]
    vtu: Option<PathBuf>,
}

#[derive(Args)]
struct Limit {
    /// Scene in JSON.
    scene: PathBuf,
    /// Write the limits to this file, in JSON.
    #[arg(long, value_name = "FILE")]
    report: Option<PathBuf>,
}

#[derive(Args)]
struct Verify {
    /// Leave out the finest meshes.
    #[arg(long)]
    quick: bool,
    /// Write every number to this file, in JSON.
    #[arg(long, value_name = "FILE")]
    report: Option<PathBuf>,
}

fn main() -> ExitCode {
    let done = match CommandLine::parse().command {
        Command::Solve(arguments) => solve(&arguments),
        Command::Limit(arguments) => limit(&arguments),
        Command::Check { scene } => check(&scene),
        Command::Schema => schema(),
        Command::Verify(arguments) => verify(&arguments),
    };
    done.unwrap_or_else(|error| {
        // With standard error closed there is nobody left to tell.
        let _ = writeln!(io::stderr(), "error: {error}");
        ExitCode::from(2)
    })
}

fn solve(arguments: &Solve) -> Result<ExitCode, Box<dyn Error>> {
    for (option, output) in [("--report", &arguments.report), ("--vtu", &arguments.vtu)] {
        if let Some(output) = output {
            check_output(option, output, &arguments.scene)?;
        }
    }
    if arguments.report.is_some() && arguments.report == arguments.vtu {
        return Err("--report, --vtu: the same file; expected two".into());
    }
    let scene = Scene::from_file(&arguments.scene)?;
    let solution = dpana::solve(&scene)?;
    let report = solution.report()?;
    if let Some(path) = &arguments.report {
        replace_file(path, &report.to_json())?;
    }
    if let Some(path) = &arguments.vtu {
        solution.write_vtu(path)?;
    }
    writeln!(io::stdout(), "{}", report.summary().trim_end())?;
    Ok(match solution.status() {
        Status::Certified => ExitCode::SUCCESS,
        Status::NotConverged | Status::NoEquilibrium => ExitCode::from(1),
    })
}

fn limit(arguments: &Limit) -> Result<ExitCode, Box<dyn Error>> {
    if let Some(output) = &arguments.report {
        check_output("--report", output, &arguments.scene)?;
    }
    let limits = dpana::limit(&Scene::from_file(&arguments.scene)?)?;
    if let Some(path) = &arguments.report {
        replace_file(path, &limits.to_json())?;
    }
    writeln!(io::stdout(), "{}", limits.summary().trim_end())?;
    Ok(ExitCode::SUCCESS)
}

fn check(path: &Path) -> Result<ExitCode, Box<dyn Error>> {
    let scene = Scene::from_file(path)?;
    let mechanics = scene.mechanics()?;
    let mut out = io::stdout().lock();
    for body in &mechanics.bodies {
        writeln!(
            out,
            "body `{}`: {}D, {} nodes, {} cells, {} materials, {} supports, {} loads",
            body.name,
            body.mesh.dimension,
            body.mesh.nodes.len(),
            body.mesh.cell_count(),
            body.materials.len(),
            body.supports.len(),
            body.loads.len(),
        )?;
        let free = body::free_modes(body, &body::prescribed(body)?).modes.len();
        if free > 0 {
            let name = &body.name;
            writeln!(
                out,
                "body `{name}`: {free} rigid motions that only contact holds"
            )?;
        }
    }
    for (contact, stated) in mechanics.contacts.iter().zip(&scene.contacts) {
        writeln!(
            out,
            "contact `{}`: {} facets, friction {}",
            stated.group,
            contact.facets.len(),
            contact.friction,
        )?;
    }
    Ok(ExitCode::SUCCESS)
}

fn schema() -> Result<ExitCode, Box<dyn Error>> {
    writeln!(io::stdout(), "{:#}", scene::schema())?;
    Ok(ExitCode::SUCCESS)
}

fn verify(arguments: &Verify) -> Result<ExitCode, Box<dyn Error>> {
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

/// Refuses an output file that could not be written, before any time goes into the solve.
fn check_output(option: &str, output: &Path, scene: &Path) -> Result<(), String> {
    check_writable(option, output)?;
    let same = |path: &Path| fs::canonicalize(path).ok();
    if same(output).is_some_and(|output| Some(output) == same(scene)) {
        return Err(format!(
            "{option} {}: would overwrite the scene; expected another file",
            output.display()
        ));
    }
    Ok(())
}

fn check_writable(option: &str, output: &Path) -> Result<(), String> {
    let refuse = |reason: &str| Err(format!("{option} {}: {reason}", output.display()));
    if output.is_dir() || output.file_name().is_none() {
        return refuse("is a folder; expected a file name");
    }
    if !folder(output).is_dir() {
        return refuse("its folder does not exist; expected an existing folder");
    }
    Ok(())
}

/// Folder of a file; a bare name lies in the working folder.
fn folder(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}
