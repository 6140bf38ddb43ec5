//! One scene at growing sizes: what contact costs beside the factorisation.
//!
//! Every size runs in a process of its own, so that its peak memory is its own.

use std::error::Error;
use std::process::Command;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::time::{Duration, Instant};

use dpana::kkt::{BodyState, SceneGeometry, Surroundings};
use dpana::{Scene, Status};

/// Prints a Markdown table with a row per number of cells along a side.
///
/// Only the first size where `--quick` is asked for, or where `cargo test` runs the bench
/// (`cargo bench` says `--bench`); `--cells N` is for one size, and `--estimate` for what that will take. With
/// `--stages` the largest memory and the seconds of each stage follow, on Linux.
pub(crate) fn table(
    sizes: &[usize],
    scene: impl Fn(usize) -> Result<Scene, Box<dyn Error>>,
) -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let has = |option: &str| arguments.iter().any(|argument| argument == option);
    let number = |option: &str| -> Result<Option<usize>, Box<dyn Error>> {
        let Some(at) = arguments.iter().position(|argument| argument == option) else {
            return Ok(None);
        };
        let size = arguments.get(at + 1).map(|size| size.parse());
        let size = size.ok_or_else(|| format!("{option}: expected a number"))?;
        Ok(Some(size?))
    };
    if let Some(size) = number("--size")? {
        if has("--stages") {
            std::thread::spawn(watch);
        }
        println!("{}", row(&scene(size)?, size)?);
        return Ok(());
    }
    let one = number("--cells")?;
    let sizes = match &one {
        Some(size) => std::slice::from_ref(size),
        None if has("--quick") || !has("--bench") => &sizes[..1],
        None => sizes,
    };
    if has("--estimate") {
        return estimate(sizes, scene);
    }
    println!("{}", header());
    for size in sizes {
        let child = Command::new(std::env::current_exe()?)
            .args(["--size", &size.to_string()])
            .args(has("--stages").then_some("--stages"))
            .status()?;
        if !child.success() {
            return Err(format!("size {size}: {child}").into());
        }
    }
    Ok(())
}

/// Prints what each size will take, without factorising.
fn estimate(
    sizes: &[usize],
    scene: impl Fn(usize) -> Result<Scene, Box<dyn Error>>,
) -> Result<(), Box<dyn Error>> {
    println!("| per side | unknowns | contacts | entries of L | L and dense, MiB | 1e9 products |");
    println!("|---:|---:|---:|---:|---:|---:|");
    for &size in sizes {
        let found = dpana::check(&scene(size)?)?.estimate;
        println!(
            "| {size} | {} | {} | {} | {:.0} | {:.1} |",
            found.unknowns,
            found.contacts,
            found.factor_entries,
            found.bytes as f64 / f64::from(1 << 20),
            1e-9 * found.operations,
        );
    }
    Ok(())
}

const COLUMNS: [&str; 17] = [
    "per side",
    "unknowns",
    "contacts",
    "ordering s",
    "factorisation s",
    "rest s",
    "rest / factorisation",
    "rest / (ordering + factorisation)",
    "single precision",
    "corrections",
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

/// Solves the scene; the rest is all that is neither assembly nor ordering nor factorisation.
fn row(scene: &Scene, size: usize) -> Result<String, Box<dyn Error>> {
    let solution = dpana::solve(scene)?;
    let (condensed, report) = (solution.condensed(), solution.report()?);
    if solution.status() != Status::Certified {
        return Err(format!("{size} per side is not certified").into());
    }
    let pairs = scene.mechanics()?.contacts;
    let judging = Instant::now();
    let (bodies, outcome) = (solution.bodies(), solution.outcome());
    let geometry = SceneGeometry::new(bodies, &pairs, condensed.surface())?;
    let displacements = solution.displacements();
    geometry.fit(
        &BodyState::of_bodies(bodies, condensed, &outcome.reaction, displacements),
        &Surroundings {
            obstacles: &[],
            openings: &[],
            residual: outcome.verdict.certificate.residual(),
            departure: 0.0,
        },
    )?;
    let judging = judging.elapsed().as_secs_f64();
    let (work, seconds) = (&report.work, &report.work.seconds);
    let (ordering, factorisation) = (seconds.ordering, seconds.factorisation);
    let rest = seconds.total - seconds.assembly - ordering - factorisation;
    let cells = [
        size.to_string(),
        condensed.work().unknowns.to_string(),
        condensed.problem().contacts().to_string(),
        format!("{ordering:.3}"),
        format!("{factorisation:.3}"),
        format!("{rest:.3}"),
        format!("{:.3}", rest / factorisation),
        format!("{:.3}", rest / (ordering + factorisation)),
        (if work.single_factors > 0 { "yes" } else { "no" }).to_owned(),
        work.corrections.to_string(),
        work.sweeps.to_string(),
        work.cone_iterations.to_string(),
        work.newton_steps.to_string(),
        format!("{:.1e}", report.certificate.natural_map),
        format!("{judging:.3}"),
        format!("{:.3}", judging / seconds.total),
        peak_memory().map_or("–".to_owned(), |peak| {
            format!("{:.0}", peak.max(PEAK.load(Relaxed) as f64))
        }),
    ];
    Ok(format!("| {} |", cells.join(" | ")))
}

/// Prints the largest memory that each stage held, and when it was over, as the next begins.
#[allow(clippy::print_stderr)]
fn watch() {
    let (start, mut stage) = (Instant::now(), dpana::stage::progress().stage);
    let mut most = 0.0_f64;
    loop {
        std::thread::sleep(Duration::from_millis(1));
        let now = dpana::stage::progress().stage;
        if now != stage {
            let peak = peak_memory().unwrap_or(f64::NAN);
            let seconds = start.elapsed().as_secs_f64();
            eprintln!("{}: {peak:.0} MiB, until {seconds:.2} s", stage.name());
            stage = now;
            // The largest memory of all is asked for at the end.
            most = most.max(peak);
            PEAK.store(most as u64, Relaxed);
            let _ = std::fs::write("/proc/self/clear_refs", "5");
        }
    }
}

/// Largest memory before the stage that runs, in MiB.
static PEAK: AtomicU64 = AtomicU64::new(0);

/// Largest memory this process ever held, in MiB, where the system tells.
fn peak_memory() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let peak = status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kibibytes: f64 = peak.split_whitespace().next()?.parse().ok()?;
    Some(kibibytes / 1024.0)
}
