//! `dpana solve`: one state, or a load history; Ctrl-C ends it with the best state so far.

use std::error::Error;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;
use dpana::report::{
    self, Accuracy, Cell, Continuity, Page, Reason, Report, Table, replace_file, vtu,
};
use dpana::scene::{SavedState, Scene, SceneBody, SceneModel};
use dpana::{Solution, Status};

use super::accuracy;
use super::accuracy::part;
use super::interrupt;
use super::outputs::{check_file, check_output, is_standard, say, write_output, write_table};
use super::progress::Progress;
use super::ranks;
use super::ranks::EngineName;
use super::scene_file::read_scene;

#[derive(Args, Clone)]
pub(crate) struct Solve {
    /// Scene in JSON (`-`: from standard input), or an Abaqus or CalculiX deck (`.inp`).
    scene: PathBuf,
    /// Write the whole report to this file, in JSON; `-` is standard output.
    #[arg(long, value_name = "FILE")]
    report: Option<PathBuf>,
    /// Write displacement and stress to this file for ParaView, and the contact surface
    /// beside it (`FILE_contact.vtu`, where `state` is 0 open, 1 slip, 2 stick, -1 no contact).
    ///
    /// A scene with load steps gets a file per step (`FILE_0001.vtu`) and their series beside
    /// them (`FILE.pvd`, `FILE_contact.pvd`). A name without an ending gets `.vtu`.
    #[arg(long, value_name = "FILE")]
    vtu: Option<PathBuf>,
    /// Name the arrays of `--vtu` as Abaqus does: U, S, MISES, CPRESS, COPEN, CSLIP, CSTATUS and so on.
    #[arg(long, requires = "vtu")]
    abaqus_names: bool,
    /// Draw the deformed bodies and the contact pressure to this file, in SVG; bodies in 2D only.
    ///
    /// A scene with load steps gets the drawing of its last state.
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    /// Write a page to this file (HTML) that shows bodies, fields, contacts and tables in a browser; it
    /// loads nothing else.
    ///
    /// A scene with load steps gets all of its states in it; one taken on by `--restart` those from there.
    #[arg(long, value_name = "FILE")]
    page: Option<PathBuf>,
    /// Write the totals of every state to this file: JSON if it ends so, else CSV.
    ///
    /// It is whole after every load step, and so are all other files of a history; `-` is standard
    /// output, after the last one.
    #[arg(long, value_name = "FILE")]
    table: Option<PathBuf>,
    /// Draw one column of that table against another to this file, in SVG.
    #[arg(long, value_name = "FILE", requires = "axes")]
    plot: Option<PathBuf>,
    /// Columns to draw: across, up.
    #[arg(long, value_name = "X,Y", requires = "plot")]
    axes: Option<String>,
    /// Write the state to this file after every load step that is certified, to restart from.
    #[arg(long, value_name = "FILE")]
    state: Option<PathBuf>,
    /// Take a load history on from the state in this file; what comes after it in the scene may
    /// have changed.
    ///
    /// `--table`, `--plot` and the series of `--vtu` go on from the rows and files that are there
    /// of earlier steps; where there are none they begin with the first step that is solved.
    #[arg(long, value_name = "FILE")]
    restart: Option<PathBuf>,
    /// Solve again from N other starts and say whether they end in the same state, and how much
    /// friction the alternation takes (of the last state, where the scene has load steps); say of every
    /// state whether bodies jump on the way to it.
    #[arg(long, value_name = "N")]
    starts: Option<usize>,
    /// Estimate the error of the stress, which takes one more pass over all cells.
    #[arg(long)]
    quality: bool,
    /// Bound the error of the stress of plane and axisymmetric bodies under the contact tractions that are found, by a
    /// stress that is in equilibrium with them at every point, which takes a small problem for each cell. What finer meshes
    /// change in the tractions themselves, and in where contact begins and ends, is not in it.
    #[arg(long)]
    bound: bool,
    /// Print the whole report on standard output, in JSON, and no summary.
    #[arg(long, conflicts_with = "report")]
    json: bool,
    /// Say what the totals gain per unit of friction, gap, load, support, obstacle motion and modulus, also
    /// as columns of `--table`; of scenes without load steps.
    #[arg(long)]
    sensitivity: bool,
    /// Refine the meshes until the total of `--of` is as accurate as this, such as `1%` or `0.01`: every
    /// cell is split, and the total extrapolated with the rate observed. All outputs are of the finest mesh.
    #[arg(long, value_name = "PART", value_parser = part, conflicts_with_all = ["restart", "state"])]
    accuracy: Option<f64>,
    /// Total that should be accurate: a column of `--table` such as peak_pressure or normal, `energy`, or
    /// a displacement at a point such as `u_x@0.5,0`.
    #[arg(
        long,
        value_name = "TOTAL",
        default_value = "normal",
        requires = "accuracy"
    )]
    of: String,
    /// Mesh files in place of the scene's one, from coarse to fine, three at least; cells are split where none
    /// are given.
    #[arg(
        long,
        value_name = "FILES",
        value_delimiter = ',',
        requires = "accuracy"
    )]
    meshes: Vec<PathBuf>,
    /// Memory that `--accuracy` may fill, in GB; three quarters of what is free when left out.
    #[arg(long, value_name = "GB", requires = "accuracy")]
    memory: Option<f64>,
    /// What factorises the bodies: `mumps` divides them among the processes of `mpirun -n N dpana solve …`, in a
    /// build with the feature `mumps`. Every process reads the scene; the first alone solves and writes.
    #[arg(long, value_enum, default_value_t = EngineName::Faer, hide_default_value = true)]
    engine: EngineName,
    /// Print no summary and no progress: the exit status says whether the state is certified.
    #[arg(short, long)]
    quiet: bool,
    /// Print the sweeps of the outer loop below the summary (of the last state, where the scene has
    /// load steps).
    #[arg(short, long, conflicts_with_all = ["quiet", "json"])]
    verbose: bool,
}

pub(crate) fn solve(arguments: &Solve) -> Result<ExitCode, Box<dyn Error>> {
    if matches!(arguments.engine, EngineName::Mumps) && arguments.accuracy.is_some() {
        return Err(
            "--engine mumps: --accuracy, whose meshes the other ranks do not have; expected one \
                    of the two"
                .into(),
        );
    }
    ranks::run(arguments.engine, &arguments.scene, || {
        state_or_history(arguments)
    })
}

fn state_or_history(arguments: &Solve) -> Result<ExitCode, Box<dyn Error>> {
    let arguments = &arguments.completed();
    check_outputs(arguments)?;
    let axes = match &arguments.axes {
        None => None,
        Some(axes) => Some(axes.split_once(',').ok_or_else(|| {
            format!("--axes {axes}: no comma; expected two columns, such as `at,normal`")
        })?),
    };
    let mut scene = read_scene(&arguments.scene)?;
    scene.settings.interrupt = interrupt::on_ctrl_c();
    scene.settings.engine = arguments.engine.into();
    check_drawable(arguments, &scene)?;
    if arguments.sensitivity && scene.steps.is_some() {
        return Err("--sensitivity: a load history; expected a scene without steps".into());
    }
    let from = match &arguments.restart {
        None => None,
        Some(path) => Some(saved_state(path)?),
    };
    let mut states = States::new(arguments, axes, &scene, from.as_ref())?;
    let progress = Progress::of_stages(arguments.quiet);
    let (solution, accuracy) = solved(&scene, from.as_ref(), &mut states, &progress)?;
    drop(progress);
    let mut report = states.last.take().map_or_else(|| solution.report(), Ok)?;
    if let Some(starts) = arguments.starts {
        report.trust = solution.trust(starts)?;
    }
    if arguments.quality {
        report.quality.stress_error_estimate = Some(solution.stress_error_estimate());
    }
    if arguments.bound {
        report.quality.stress_error_bound = Some(solution.stress_error_bound()?);
    }
    let missed = accuracy.as_ref().is_some_and(|accuracy| !accuracy.reached);
    report.accuracy = accuracy;
    if let Some(path) = &arguments.report {
        write_output(path, &report.to_json())?;
    }
    if let Some(path) = arguments.table.as_ref().filter(|path| is_standard(path)) {
        write_table(path, &states.table)?;
    }
    if !arguments.quiet && !arguments.json {
        let outputs = || arguments.report.iter().chain(&arguments.table);
        say(outputs(), report.summary().trim_end())?;
        for jump in &states.jumps {
            say(outputs(), jump)?;
        }
        if arguments.verbose {
            say(outputs(), sweeps(&report).trim_end())?;
        }
    }
    if let Some(hint) = restart_hint(arguments, &report) {
        // With standard error closed there is nobody left to tell.
        let _ = writeln!(io::stderr(), "{hint}");
    }
    Ok(match solution.status() {
        Status::Certified if missed => ExitCode::from(1),
        Status::Certified => ExitCode::SUCCESS,
        Status::NotConverged | Status::NoEquilibrium | Status::CouplingFault => ExitCode::from(1),
    })
}

/// The last state, or that on the finest mesh with what the meshes say of a total.
fn solved(
    scene: &Scene,
    from: Option<&SavedState>,
    states: &mut States<'_>,
    progress: &Progress,
) -> Result<(Solution, Option<Accuracy>), Box<dyn Error>> {
    let arguments = states.arguments;
    if let Some(within) = arguments.accuracy {
        let request = arguments.request(within)?;
        let (solution, accuracy) = accuracy::refine(scene, &request, progress)?;
        states.add(&solution)?;
        return Ok((solution, Some(accuracy)));
    }
    let solution = dpana::solve_steps(scene, from, |solution| {
        if let (Some(step), Some(steps)) = (solution.step(), &scene.steps) {
            let (number, all) = (step.number(), steps.at.len());
            progress.show(&format!("step {number} of {all}, at {}", step.at()));
            // That of the last state is part of the report.
            if arguments.starts.is_some() && number < all {
                let jump = jump(solution)?;
                states
                    .jumps
                    .extend(jump.map(|words| format!("step {number:<11}{words}")));
            }
        }
        states.add(solution)
    });
    Ok((solution?, None))
}

impl Solve {
    fn request(&self, within: f64) -> Result<dpana::Request, String> {
        Ok(dpana::Request {
            of: self.of.clone(),
            within,
            memory: accuracy::memory(self.memory)?,
            meshes: self.meshes.clone(),
        })
    }

    /// The same with an ending where a file needs one.
    fn completed(&self) -> Self {
        let mut completed = self.clone();
        if completed.json {
            completed.report = Some(PathBuf::from("-"));
        }
        if let Some(vtu) = &mut completed.vtu
            && vtu.extension().is_none()
            && !is_standard(vtu)
            && !vtu.is_dir()
        {
            vtu.set_extension("vtu");
        }
        completed
    }
}

/// A line per sweep of the outer loop.
fn sweeps(report: &Report) -> String {
    let mut text =
        String::from("sweep  residual   cone iterations  Newton steps  open  stick   slip\n");
    for (number, sweep) in (1..).zip(&report.history) {
        let cone = sweep.coulomb_iterations + sweep.normal_iterations + sweep.friction_iterations;
        text += &format!(
            "{number:5}  {:8.1e}  {cone:16}  {:12}  {:4}  {:5}  {:5}\n",
            sweep.residual, sweep.newton_steps, sweep.open, sweep.stick, sweep.slip
        );
    }
    text
}

/// How to go on with a load history that was interrupted, or ran out of its time.
fn restart_hint(arguments: &Solve, report: &Report) -> Option<String> {
    let reason = report.shortfall.as_ref()?.reason;
    report.step.as_ref()?;
    if !matches!(reason, Reason::Interrupted | Reason::TimeLimit) || arguments.quiet {
        return None;
    }
    let scene = arguments.scene.display();
    Some(match &arguments.state {
        Some(state) if state.exists() => {
            let state = state.display();
            format!("go on with: dpana solve {scene} --restart {state} --state {state}")
        }
        _ => {
            "go on: from the first step only; with `--state FILE` every certified step is kept to \
            `--restart` from"
                .to_owned()
        }
    })
}

/// What there is to say of jumps on the way to a state.
fn jump(solution: &Solution) -> Result<Option<String>, dpana::Error> {
    let found = solution.continuity()?;
    let found = found.filter(|found| *found != Continuity::Continuous);
    Ok(found.map(Continuity::words))
}

/// The states of a solve so far, and what is written of them.
struct States<'a> {
    arguments: &'a Solve,
    axes: Option<(&'a str, &'a str)>,
    table: Table,
    files: Vec<(f64, PathBuf)>,
    page: Option<Page>,
    /// Report of the last state.
    last: Option<Report>,
    /// Of all steps but the last.
    jumps: Vec<String>,
}

impl<'a> States<'a> {
    /// None so far, or those of the files that a history taken on finds.
    fn new(
        arguments: &'a Solve,
        axes: Option<(&'a str, &'a str)>,
        scene: &Scene,
        from: Option<&SavedState>,
    ) -> Result<Self, String> {
        let mut states = Self {
            arguments,
            axes,
            table: Table::default(),
            files: Vec::new(),
            page: arguments.page.as_deref().map(Page::new),
            last: None,
            jumps: Vec::new(),
        };
        let (Some(from), Some(steps)) = (from, &scene.steps) else {
            return Ok(states);
        };
        if let Some(path) = arguments
            .table
            .as_ref()
            .filter(|path| !is_standard(path) && path.exists())
        {
            states.table = rows_before(path, from.steps)?;
        }
        if let Some(path) = &arguments.vtu {
            let numbers = (1..).zip(&steps.at).take(from.steps);
            let files = numbers.map(|(number, &at)| (at, vtu::step_path(path, number)));
            states.files = files.filter(|(_, path)| path.exists()).collect();
        }
        Ok(states)
    }

    fn write_vtu(&self, solution: &Solution, path: &Path) -> Result<(), dpana::Error> {
        if !self.arguments.abaqus_names {
            return solution.write_vtu(path);
        }
        let [bodies, contact] = solution.to_vtu()?;
        replace_file(path, &vtu::abaqus_names(&bodies))?;
        replace_file(&vtu::contact_path(path), &vtu::abaqus_names(&contact))
    }

    /// Takes up a state; every file is whole after it.
    fn add(&mut self, solution: &Solution) -> Result<(), dpana::Error> {
        let arguments = self.arguments;
        let mut report = solution.report()?;
        if arguments.sensitivity {
            report.sensitivity = solution.sensitivities()?.unwrap_or_default();
        }
        let given = match &report.step {
            None => Vec::new(),
            Some(step) => {
                let number = ("step".to_owned(), Cell::Count(step.number));
                let at = ("at".to_owned(), step.at);
                let values = std::iter::once(at).chain(step.driven.clone());
                let values = values.map(|(name, value)| (name, Cell::Number(value)));
                std::iter::once(number).chain(values).collect()
            }
        };
        let before = std::mem::take(&mut self.table.columns);
        self.table.push(&given, &report);
        if let Some(path) = &arguments.table {
            if !before.is_empty() && before != self.table.columns {
                return Err(dpana::Error::NotAccepted {
                    place: format!("--table {}", path.display()),
                    found: "a table with other columns".to_owned(),
                    accepted: "that of the history taken on, or another file".to_owned(),
                });
            }
            if !is_standard(path) {
                write_table(path, &self.table)?;
            }
        }
        if let (Some(path), Some((x, y))) = (&arguments.plot, self.axes) {
            replace_file(path, &report::plot(&self.table, x, y)?)?;
        }
        if let (Some(path), Some(step)) = (&arguments.vtu, &report.step) {
            let of_step = vtu::step_path(path, step.number);
            self.write_vtu(solution, &of_step)?;
            self.files.push((step.at, of_step));
            replace_file(&path.with_extension("pvd"), &vtu::series(&self.files))?;
            let contacts = self.files.iter();
            let contacts = contacts.map(|(at, path)| (*at, vtu::contact_path(path)));
            let series = vtu::series(&contacts.collect::<Vec<_>>());
            let of_contact = vtu::contact_path(path).with_extension("pvd");
            replace_file(&of_contact, &series)?;
        } else if let Some(path) = &arguments.vtu {
            self.write_vtu(solution, path)?;
        }
        if let Some(path) = &arguments.svg {
            replace_file(path, &solution.to_svg()?)?;
        }
        if let Some(page) = &mut self.page {
            solution.add_to_page(page)?;
        }
        self.last = Some(report);
        // Last, so that whoever takes the history on from here finds all that came before.
        match (&arguments.state, solution.saved_state()) {
            (Some(path), Some(state)) if solution.status() == Status::Certified => {
                replace_file(path, &state.to_json())
            }
            _ => Ok(()),
        }
    }
}

/// The rows of a table on disk that belong to the first `steps` steps of a history.
fn rows_before(path: &Path, steps: usize) -> Result<Table, String> {
    let refuse = |reason: &str| {
        format!(
            "--table {}: {reason}; expected the table of the history taken on, or no file",
            path.display()
        )
    };
    let text = fs::read_to_string(path).map_err(|error| refuse(&error.to_string()))?;
    let table = Table::read(&text).ok_or_else(|| refuse("is no table"))?;
    let numbers = table.column("step");
    let numbers = numbers.ok_or_else(|| refuse("has no column `step`"))?;
    let rows = table.rows.into_iter().zip(numbers);
    let rows = rows.filter(|(_, number)| *number <= steps as f64);
    Ok(Table {
        columns: table.columns,
        rows: rows.map(|(row, _)| row).collect(),
    })
}

/// Refuses a drawing of bodies in 3D before they are solved; those in 2D have a plane model.
fn check_drawable(arguments: &Solve, scene: &Scene) -> Result<(), String> {
    let plane = |body: &SceneBody| !matches!(body.model, None | Some(SceneModel::Solid));
    match &arguments.svg {
        Some(path) if !scene.bodies.iter().all(plane) => Err(format!(
            "--svg {}: bodies in 3D; expected bodies in 2D (--page and --vtu show those in 3D)",
            path.display()
        )),
        _ => Ok(()),
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
        ("--svg", &arguments.svg),
        ("--page", &arguments.page),
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
        if !["--report", "--table"].contains(option) {
            check_file(option, output)?;
        }
        if let Some((other, _)) = given[..number].iter().find(|(_, path)| path == output) {
            return Err(format!("{other}, {option}: the same file; expected two"));
        }
    }
    Ok(())
}
