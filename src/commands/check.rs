//! `dpana check`: what a scene holds, what it takes, and what is wrong with it.

use std::error::Error;
use std::fs;
use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

use clap::Args;
use dpana::faer::Mat;

use super::scene_file::read_scene;

/// Rows of the matrices whose product tells how fast the machine is.
const SAMPLE: usize = 400;

#[derive(Args)]
pub(crate) struct Check {
    /// Scene in JSON (`-`: from standard input), or an Abaqus or CalculiX deck (`.inp`).
    scene: PathBuf,
}

pub(crate) fn check(arguments: &Check) -> Result<ExitCode, Box<dyn Error>> {
    let scene = read_scene(&arguments.scene)?;
    let checked = dpana::check(&scene)?;
    let (mechanics, surface) = (&checked.mechanics, &checked.surface);
    let mut out = io::stdout().lock();
    for (body, free) in mechanics.bodies.iter().zip(&checked.free_modes) {
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
        if *free > 0 {
            let name = &body.name;
            writeln!(
                out,
                "body `{name}`: {free} rigid motions that only contact holds"
            )?;
        }
    }
    for (at, contact) in mechanics.contacts.iter().enumerate() {
        let stated = scene.contacts.get(at).map(|stated| stated.group.join(", "));
        let contacts = surface.nodes.iter().filter(|node| node.pair == at).count();
        writeln!(
            out,
            "contact `{}`: {} facets, {}, {contacts} contacts",
            stated.as_deref().unwrap_or(&contact.place),
            contact.facets.len(),
            match contact.law.words(contact.friction) {
                Some(law) => format!("law {law}"),
                None => format!("friction {}", contact.friction),
            },
        )?;
    }
    for note in &mechanics.notes {
        writeln!(out, "note: {note}")?;
    }
    let estimate = &checked.estimate;
    let gigabytes = estimate.bytes as f64 * 1e-9;
    writeln!(
        out,
        "estimate: {} unknowns, {} contacts, {gigabytes:.2} GB, of which the condensed problem {:.2} GB, \
         {} a factorisation and its condensation",
        estimate.unknowns,
        estimate.contacts,
        checked.dense_bytes as f64 * 1e-9,
        about(estimate.operations / rate()),
    )?;
    if let Some(available) = available().filter(|available| gigabytes > *available) {
        writeln!(
            out,
            "warning: that is more than the {available:.1} GB that are free here; take a smaller group of \
             facets, or a coarser surface"
        )?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Seconds in words.
fn about(seconds: f64) -> String {
    match seconds {
        ..1.0 => "less than a second for".to_owned(),
        ..120.0 => format!("about {seconds:.0} s for"),
        ..7200.0 => format!("about {:.0} min for", seconds / 60.0),
        _ => format!("about {:.0} h for", seconds / 3600.0),
    }
}

/// Additions and multiplications a second that a factorisation makes of this machine: half of those of a
/// product of matrices.
fn rate() -> f64 {
    let matrix = Mat::<f64>::from_fn(SAMPLE, SAMPLE, |row, column| (row * column % 7) as f64);
    let start = Instant::now();
    let product = &matrix * &matrix;
    let seconds = start.elapsed().as_secs_f64().max(1e-6);
    // Read, so that it is computed.
    let read = if product[(0, 0)].is_finite() {
        1.0
    } else {
        0.0
    };
    read * (SAMPLE as f64).powi(3) / seconds
}

/// Memory that is free, in gigabytes; none where the system does not say so.
fn available() -> Option<f64> {
    let text = fs::read_to_string("/proc/meminfo").ok()?;
    let line = text
        .lines()
        .find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let kilobytes: f64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(1.024e-6 * kilobytes)
}
