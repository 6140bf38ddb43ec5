//! One scene at growing sizes: what contact costs beside the factorisation.
//!
//! Every size runs in a process of its own, so that its peak memory is its own.

use std::error::Error;
use std::process::Command;
use std::time::Instant;

use dpana::condensation::Condensed;
use dpana::kkt::{self, BodyState, SceneGeometry, Surroundings};
use dpana::{Scene, Status};

/// Prints a Markdown table with a row per number of cells along a side.
///
/// Only the first size where `--quick` is asked for, or where `cargo test` runs the bench
/// (`cargo bench` says `--bench`).
pub(crate) fn table(
    sizes: &[usize],
    scene: impl Fn(usize) -> Result<Scene, Box<dyn Error>>,
) -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let has = |option: &str| arguments.iter().any(|argument| argument == option);
    if let Some(at) = arguments.iter().position(|argument| argument == "--size") {
        let size = arguments.get(at + 1).ok_or("--size: expected a number")?;
        println!("{}", row(&scene(size.parse()?)?, size)?);
        return Ok(());
    }
    println!("{}", header());
    let quick = has("--quick") || !has("--bench");
    for size in &sizes[..if quick { 1 } else { sizes.len() }] {
        let child = Command::new(std::env::current_exe()?)
            .args(["--size", &size.to_string()])
            .status()?;
        if !child.success() {
            return Err(format!("size {size}: {child}").into());
        }
    }
    Ok(())
}

const COLUMNS: [&str; 15] = [
    "per side",
    "unknowns",
    "contacts",
    "ordering s",
    "factorisation s",
    "rest s",
    "rest / factorisation",
    "rest / (ordering + factorisation)",
    "sweeps",
    "cone iterations",
    "Newton steps",
    "residual",
    "scene judge s",
    "scene judge / solve",
    "peak MiB",
];

fn header() -> String {
    let rule = vec!["---:"; COLUMNS.len()];
    format!("| {} |\n|{}|", COLUMNS.join(" | "), rule.join("|"))
}

/// Solves the scene stage by stage; the rest is all that is neither assembly nor ordering
/// nor factorisation.
fn row(scene: &Scene, size: &str) -> Result<String, Box<dyn Error>> {
    let mechanics = scene.mechanics()?;
    let bodies = &mechanics.bodies;
    let condensed = Condensed::new(bodies, &mechanics.contacts)?;
    let start = Instant::now();
    let problem = condensed.problem();
    let outcome = dpana::alternation::solve(problem, &mechanics.settings)?;
    let displacements = condensed.recover(&outcome.reaction, &outcome.motion)?;
    let mut balanced = true;
    for state in BodyState::of_bodies(bodies, &condensed, &outcome.reaction, &displacements) {
        balanced &= kkt::balance(&state)?.equilibrium.scaled <= 1e-8;
    }
    let work = condensed.work();
    let rest = work.condensation_seconds + start.elapsed().as_secs_f64();
    let judging = Instant::now();
    let geometry = SceneGeometry::new(bodies, &mechanics.contacts, condensed.surface())?;
    let fits = geometry.fit(
        &BodyState::of_bodies(bodies, &condensed, &outcome.reaction, &displacements),
        &Surroundings {
            obstacles: &[],
            openings: &[],
            residual: outcome.verdict.certificate.residual(),
            departure: 0.0,
        },
    )?;
    let judging = judging.elapsed().as_secs_f64();
    balanced &= fits.iter().all(|fit| fit.fault().is_none());
    if outcome.status != Status::Certified || !balanced {
        return Err(format!("{size} per side is not certified").into());
    }
    let (ordering, factorisation) = (work.ordering_seconds, work.factorisation_seconds);
    let cells = [
        size.to_owned(),
        work.unknowns.to_string(),
        problem.contacts().to_string(),
        format!("{ordering:.3}"),
        format!("{factorisation:.3}"),
        format!("{rest:.3}"),
        format!("{:.3}", rest / factorisation),
        format!("{:.3}", rest / (ordering + factorisation)),
        outcome.work.sweeps.to_string(),
        outcome.work.cone_iterations.to_string(),
        outcome.work.newton_steps.to_string(),
        format!("{:.1e}", outcome.verdict.certificate.natural_map),
        format!("{judging:.3}"),
        format!(
            "{:.3}",
            judging / (work.assembly_seconds + ordering + factorisation + rest)
        ),
        peak_memory().map_or("–".to_owned(), |peak| format!("{peak:.0}")),
    ];
    Ok(format!("| {} |", cells.join(" | ")))
}

/// Largest memory this process ever held, in MiB, where the system tells.
fn peak_memory() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let peak = status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kibibytes: f64 = peak.split_whitespace().next()?.parse().ok()?;
    Some(kibibytes / 1024.0)
}
