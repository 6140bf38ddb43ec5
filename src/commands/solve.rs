//! `dpana solve`: one state, or a load history.

use std::error::Error;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;
use dpana::report::{self, Table, replace_file, vtu};
use dpana::scene::{SavedState, Scene};
use dpana::{Solution, Status};

use super::outputs::{check_output, write_table};

#[derive(Args)]
pub(crate) struct Solve {
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
    /// Solve again from N other starts and say whether they end in the same state, and how much
    /// friction the alternation takes (of the last state, where the scene has load steps).
    #[arg(long, value_name = "N")]
    starts: Option<usize>,
}

pub(crate) fn solve(arguments: &Solve) -> Result<ExitCode, Box<dyn Error>> {
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
    let mut report = solution.report()?;
    if let Some(starts) = arguments.starts {
        report.trust = solution.trust(starts)?;
    }
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
