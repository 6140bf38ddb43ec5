//! `dpana solve --accuracy`: meshes until a total is as accurate as asked.

use std::fs;

use dpana::report::Accuracy;
use dpana::{Request, Scene, Solution, solve_within};

use super::progress::Progress;

/// Part of the free memory that meshes may fill.
const FREE: f64 = 0.75;

/// Memory of a machine that does not tell, in GB.
const MODEST: f64 = 4.0;

/// Reads `1%` or `0.01`.
pub(super) fn part(text: &str) -> Result<f64, String> {
    let (number, unit) = match text.strip_suffix('%') {
        Some(percent) => (percent, 0.01),
        None => (text, 1.0),
    };
    let value = number.trim().parse::<f64>().map(|value| unit * value);
    match value {
        Ok(value) if value > 0.0 && value < 1.0 => Ok(value),
        _ => Err("expected a part between 0 and 1, such as `1%` or `0.01`".to_owned()),
    }
}

/// Bytes: those of the option, or of what is free.
pub(super) fn memory(gigabytes: Option<f64>) -> Result<usize, String> {
    let gigabytes = gigabytes.unwrap_or_else(|| free().map_or(MODEST, |free| FREE * free));
    match gigabytes > 0.0 && gigabytes < 1e6 {
        true => Ok((gigabytes * 1e9) as usize),
        false => Err(format!(
            "--memory {gigabytes}: expected GB, more than 0 and less than 1e6"
        )),
    }
}

/// Free memory in GB, where the system tells.
fn free() -> Option<f64> {
    let known = fs::read_to_string("/proc/meminfo").ok()?;
    let line = known
        .lines()
        .find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let kilobytes: f64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kilobytes * 1024e-9)
}

/// Solves on finer and finer meshes and shows how the total goes.
pub(super) fn refine(
    scene: &Scene,
    request: &Request,
    progress: &Progress,
) -> Result<(Solution, Accuracy), dpana::Error> {
    let mut meshes = 0;
    solve_within(scene, request, |level| {
        meshes += 1;
        let (cells, value, of) = (level.cells, level.value, &request.of);
        progress.show(&format!("mesh {meshes}: {cells} cells, {of} {value}"));
    })
}
