//! `dpana check`: what a scene holds, and what is wrong with it.

use std::error::Error;
use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;

use super::scene_file::read_scene;
use clap::Args;

#[derive(Args)]
pub(crate) struct Check {
    /// Scene in JSON, or an Abaqus or CalculiX deck (`.inp`).
    scene: PathBuf,
}

pub(crate) fn check(arguments: &Check) -> Result<ExitCode, Box<dyn Error>> {
    let scene = read_scene(&arguments.scene)?;
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
        let free = body.free_motions()?;
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
