//! `dpana half-space`: contact of half-spaces on a grid.

use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;
use dpana::half_space::{HalfSpaceOutcome, HalfSpaceProblem};
use dpana::report::{half_space_fields, npy, replace_file, spectrum_table, vtu};
use dpana::scene::HalfSpaceScene;

use super::outputs::{check_output, say, write_output, write_table};
use super::progress::Progress;

#[derive(Args)]
pub(crate) struct HalfSpace {
    /// Scene of half-spaces in JSON.
    scene: PathBuf,
    /// Write totals and certificates of all steps to this file, in JSON.
    #[arg(long, value_name = "FILE")]
    report: Option<PathBuf>,
    /// Write a row of totals per step to this file: JSON if it ends so, else CSV.
    #[arg(long, value_name = "FILE")]
    table: Option<PathBuf>,
    /// Write pressure, shear, gap and slip of the cells to this file for ParaView, as image (`.vti`);
    /// of several steps, a file each (`FILE_0001.vti`).
    #[arg(long, value_name = "FILE")]
    vti: Option<PathBuf>,
    /// Write the same as NumPy arrays of the last step: `FILE_pressure.npy` and so on for `FILE.npy`.
    #[arg(long, value_name = "FILE")]
    npy: Option<PathBuf>,
    /// Write the power spectrum of the gap before loading to this file, a row per ring of waves: JSON if it
    /// ends so, else CSV.
    #[arg(long, value_name = "FILE")]
    spectrum: Option<PathBuf>,
}

pub(crate) fn half_space(arguments: &HalfSpace) -> Result<ExitCode, Box<dyn Error>> {
    let outputs = [
        ("--report", &arguments.report),
        ("--table", &arguments.table),
        ("--vti", &arguments.vti),
        ("--npy", &arguments.npy),
        ("--spectrum", &arguments.spectrum),
    ];
    for (option, path) in outputs {
        if let Some(path) = path {
            check_output(option, path, &arguments.scene)?;
        }
    }
    let scene = HalfSpaceScene::from_file(&arguments.scene)?;
    let count = scene.steps.len().max(1);
    let progress = Progress::new(false);
    let report = dpana::solve_half_space(&scene, |number, problem, outcome| {
        progress.show(&format!("step {number} of {count}"));
        write_fields(arguments, (number, count), problem, outcome)
    });
    drop(progress);
    let report = report?;
    if let Some(path) = &arguments.report {
        write_output(path, &report.to_json())?;
    }
    if let Some(path) = &arguments.table {
        write_table(path, &report.table())?;
    }
    let outputs = outputs.into_iter().filter_map(|(_, path)| path.as_ref());
    say(outputs, report.summary().trim_end())?;
    Ok(match report.steps.iter().all(|step| step.certified()) {
        true => ExitCode::SUCCESS,
        false => ExitCode::from(1),
    })
}

fn write_fields(
    arguments: &HalfSpace,
    (number, count): (usize, usize),
    problem: &HalfSpaceProblem,
    outcome: &HalfSpaceOutcome,
) -> Result<(), dpana::Error> {
    if let Some(path) = arguments.spectrum.as_ref().filter(|_| number == 1) {
        write_table(path, &spectrum_table(problem)?)?;
    }
    let fields = half_space_fields(problem, outcome);
    if let Some(path) = &arguments.vti {
        let path = match count {
            1 => path.clone(),
            _ => vtu::step_path(path, number),
        };
        replace_file(&path, &vtu::half_space_vti(problem, &fields))?;
    }
    if let Some(path) = arguments.npy.as_ref().filter(|_| number == count) {
        for field in &fields {
            replace_file(&named(path, field.name), &npy(problem, field))?;
        }
    }
    Ok(())
}

/// `out/a.npy` → `out/a_gap.npy`.
fn named(path: &Path, name: &str) -> PathBuf {
    let mut file = path.file_stem().unwrap_or_default().to_owned();
    file.push(format!("_{name}.npy"));
    path.with_file_name(file)
}
