//! `dpana check`: what a scene holds, what it takes, and what is wrong with it.

use std::error::Error;
use std::fs;
use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;

use super::scene_file::read_scene;

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
        let stated = scene.contacts.get(at).map(|stated| stated.group.as_str());
        let contacts = surface.nodes.iter().filter(|node| node.pair == at).count();
        writeln!(
            out,
            "contact `{}`: {} facets, friction {}, {contacts} contacts",
            stated.unwrap_or(&contact.place),
            contact.facets.len(),
            contact.friction,
        )?;
    }
    for note in &mechanics.notes {
        writeln!(out, "note: {note}")?;
    }
    let (contacts, gigabytes) = (surface.nodes.len(), checked.dense_bytes as f64 * 1e-9);
    if gigabytes >= 0.1 {
        writeln!(
            out,
            "condensed problem: {contacts} contacts, {gigabytes:.1} GB"
        )?;
    }
    if let Some(available) = available().filter(|available| gigabytes > *available) {
        writeln!(
            out,
            "warning: that is more than the {available:.1} GB that are free here; take a smaller group of \
             facets, or a coarser surface"
        )?;
    }
    Ok(ExitCode::SUCCESS)
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
