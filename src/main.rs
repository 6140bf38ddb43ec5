//! The command line: solve, sweep, limit, check, schema, verify.

use std::error::Error;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Args, Parser, Subcommand};
use dpana::body;
use dpana::report::{self, Table, replace_file, vtu};
use dpana::scene::{self, SavedState, Scene};
use dpana::{Solution, Status, Variation};

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
    Sweep(Sweep),
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
    ///
    /// A scene with load steps gets a file per step (`FILE_0001.vtu`) and their series beside
    /// them (`FILE.pvd`).
    #[arg(long, value_name = "FILE")]
    vtu: Option<PathBuf>,
    /// Write the totals of every state to this file: JSON if it ends so, else CSV.
    #[arg(long, value_name = "FILE")]
    table: Option<PathBuf>,
    /// Draw one column of that table against another to this file, in SVG.
    #[arg(long, value_name = "FILE", requires = "axes")]
    plot: Option<PathBuf>,
    /// Columns to draw: across, up.
    #[arg(long, value_name = "X,Y", requires = "plot")]
    axes: Option<String>,
    /// Write the state to this file after every load step, to restart from.
    #[arg(long, value_name = "FILE")]
    state: Option<PathBuf>,
    /// Take a load history on from the state in this file.
    #[arg(long, value_name = "FILE")]
    restart: Option<PathBuf>,
}

#[derive(Args)]
struct Sweep {
    /// Scene in JSON, without load steps.
    scene: PathBuf,
    /// Quantity and its values: `friction=0.1:0.9:17` (from, to, how many) or `gap=0,1e-3`.
    /// Given again, all combinations are solved. Quantities: friction, gap,
    /// contacts[0].friction, contacts[0].gap, contacts[0].x (motion of the obstacle),
    /// bodies[0].loads[0] and bodies[0].supports[0] (factors).
    #[arg(long, value_name = "NAME=VALUES", required = true)]
    vary: Vec<String>,
    /// Write the table to this file: JSON if it ends so, else CSV.
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
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
        Command::Sweep(arguments) => sweep(&arguments),
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
    check_outputs(arguments)?;
    let axes = match &arguments.axes {
        None => None,
        Some(axes) => Some(axes.split_once(',').ok_or_else(|| {
            format!("--axes {axes}: no comma; expected two columns, such as `at,normal`")
        })?),
    };
    let scene = Scene::from_file(&arguments.scene)?;
    let from = match &arguments.restart {
        None => None,
        Some(path) => Some(saved_state(path)?),
    };
    let mut states = States::default();
    let solution = dpana::solve_steps(&scene, from.as_ref(), |solution| {
        states.add(arguments, axes, solution)
    })?;
    let report = solution.report()?;
    if let Some(path) = &arguments.report {
        replace_file(path, &report.to_json())?;
    }
    if let Some(path) = &arguments.table {
        write_table(path, &states.table)?;
    }
    if let (Some(path), Some((x, y))) = (&arguments.plot, axes) {
        replace_file(path, &report::plot(&states.table, x, y)?)?;
    }
    writeln!(io::stdout(), "{}", report.summary().trim_end())?;
    Ok(match solution.status() {
        Status::Certified => ExitCode::SUCCESS,
        Status::NotConverged | Status::NoEquilibrium => ExitCode::from(1),
    })
}

/// The states of a solve so far, and what was written of them.
#[derive(Default)]
struct States {
    table: Table,
    files: Vec<(f64, PathBuf)>,
}

impl States {
    /// Takes up a state and writes what belongs to it alone.
    fn add(
        &mut self,
        arguments: &Solve,
        axes: Option<(&str, &str)>,
        solution: &Solution,
    ) -> Result<(), dpana::Error> {
        let report = solution.report()?;
        let given = match &report.step {
            None => Vec::new(),
            Some(step) => {
                let number = [("step", step.number as f64), ("at", step.at)];
                let number = number.map(|(name, value)| (name.to_owned(), value));
                number.into_iter().chain(step.driven.clone()).collect()
            }
        };
        self.table.push(&given, &report);
        if let Some((x, y)) = axes {
            // A column that is not there is known from the first state on.
            report::plot(&self.table, x, y)?;
        }
        if let (Some(path), Some(state)) = (&arguments.state, solution.saved_state()) {
            replace_file(path, &state.to_json())?;
        }
        match (&arguments.vtu, &report.step) {
            (None, _) => Ok(()),
            (Some(path), None) => solution.write_vtu(path),
            (Some(path), Some(step)) => {
                let of_step = vtu::step_path(path, step.number);
                solution.write_vtu(&of_step)?;
                self.files.push((step.at, of_step));
                replace_file(&path.with_extension("pvd"), &vtu::series(&self.files))
            }
        }
    }
}

fn saved_state(path: &Path) -> Result<SavedState, Box<dyn Error>> {
    let text = fs::read_to_string(path)
        .map_err(|error| format!("--restart {}: {error}", path.display()))?;
    Ok(SavedState::from_json(&text, &path.display().to_string())?)
}

fn write_table(path: &Path, table: &Table) -> Result<(), dpana::Error> {
    match path.extension().is_some_and(|ending| ending == "json") {
        true => replace_file(path, &table.to_json()),
        false => replace_file(path, &table.to_csv()),
    }
}

fn sweep(arguments: &Sweep) -> Result<ExitCode, Box<dyn Error>> {
    check_output("--out", &arguments.out, &arguments.scene)?;
    let variations = arguments.vary.iter().map(|text| variation(text));
    let variations: Vec<Variation> = variations.collect::<Result<_, _>>()?;
    let table = dpana::sweep(&Scene::from_file(&arguments.scene)?, &variations)?;
    write_table(&arguments.out, &table)?;
    let certified = dpana::report::Cell::Word("certified");
    let sound = table
        .rows
        .iter()
        .filter(|row| row.contains(&certified))
        .count();
    writeln!(
        io::stdout(),
        "{} cases, {sound} certified",
        table.rows.len()
    )?;
    Ok(match sound == table.rows.len() {
        true => ExitCode::SUCCESS,
        false => ExitCode::from(1),
    })
}

/// Reads `name=from:to:count` or `name=value,value,...`.
fn variation(text: &str) -> Result<Variation, String> {
    let refuse = || {
        format!(
            "--vary {text}: not understood; expected NAME=FROM:TO:COUNT with a COUNT of 2 to \
             1000000, or NAME=VALUE,VALUE"
        )
    };
    let (name, values) = text.split_once('=').ok_or_else(refuse)?;
    let number = |text: &str| text.trim().parse::<f64>().map_err(|_| refuse());
    let parts: Vec<&str> = values.split(':').collect();
    let values = match parts[..] {
        [from, to, count] => {
            let (from, to) = (number(from)?, number(to)?);
            let count: usize = count.trim().parse().map_err(|_| refuse())?;
            if !(2..=1_000_000).contains(&count) {
                return Err(refuse());
            }
            let last = (count - 1) as f64;
            let part = |k: usize| k as f64 / last;
            (0..count)
                .map(|k| from * (1.0 - part(k)) + to * part(k))
                .collect()
        }
        [list] => list.split(',').map(number).collect::<Result<_, _>>()?,
        _ => return Err(refuse()),
    };
    Ok(Variation {
        name: name.trim().to_owned(),
        values,
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

/// Refuses outputs that could not be written, or that would overwrite each other.
fn check_outputs(arguments: &Solve) -> Result<(), String> {
    let outputs = [
        ("--report", &arguments.report),
        ("--vtu", &arguments.vtu),
        ("--table", &arguments.table),
        ("--plot", &arguments.plot),
        ("--state", &arguments.state),
    ];
    let given = outputs
        .iter()
        .filter_map(|(option, path)| Some((*option, path.as_ref()?)));
    let given: Vec<(&str, &PathBuf)> = given.collect();
    for (number, (option, output)) in given.iter().enumerate() {
        check_output(option, output, &arguments.scene)?;
        if let Some((other, _)) = given[..number].iter().find(|(_, path)| path == output) {
            return Err(format!("{other}, {option}: the same file; expected two"));
        }
    }
    Ok(())
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
