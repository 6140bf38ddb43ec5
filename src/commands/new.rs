//! `dpana new`: a starter scene for a mesh file.

use std::error::Error;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;
use dpana::body::Mesh;
use dpana::mesh_file;
use dpana::report::replace_file;

use super::outputs::{check_writable, is_standard, write_output};
use super::starter;

#[derive(Args)]
pub(crate) struct New {
    /// Mesh file: Gmsh (`.msh`), VTK (`.vtu`), Abaqus or CalculiX (`.inp`).
    mesh: PathBuf,
    /// Write the scene to this file; left out, beside the mesh, with the ending `.json`. `-` is standard
    /// output.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

pub(crate) fn new(arguments: &New) -> Result<ExitCode, Box<dyn Error>> {
    let path = &arguments.mesh;
    let beside = || path.with_extension("json");
    let out = arguments.out.clone().unwrap_or_else(beside);
    check_writable("--out", &out)?;
    if !is_standard(&out) && out.exists() {
        let out = out.display();
        return Err(format!("--out {out}: is there already; expected another file").into());
    }
    let mesh = read_mesh(path)?;
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    let mut scene = starter::scene(&mesh, &name, &seen_from(&out, path)?)?;
    scene.source.clone_from(&out);
    let text = scene.to_json()?;
    if is_standard(&out) {
        write_output(&out, &text)?;
        return Ok(ExitCode::SUCCESS);
    }
    replace_file(&out, &text)?;
    let mut stdout = io::stdout().lock();
    writeln!(stdout, "scene: {}", out.display())?;
    match dpana::check(&scene) {
        Ok(_) => writeln!(
            stdout,
            "next: dpana check {0}; dpana solve {0}",
            out.display()
        )?,
        Err(error) => writeln!(stdout, "to be mended: {error}")?,
    }
    Ok(ExitCode::SUCCESS)
}

/// The mesh file as the scene names it: relative to its folder where it is the same.
fn seen_from(out: &Path, mesh: &Path) -> io::Result<PathBuf> {
    let folder = |path: &Path| match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => fs::canonicalize(folder),
        _ => fs::canonicalize("."),
    };
    // Of a scene from standard input meshes are relative to the working folder.
    if is_standard(out) {
        return Ok(mesh.to_owned());
    }
    match mesh.file_name() {
        Some(name) if folder(out)? == folder(mesh)? => Ok(PathBuf::from(name)),
        _ => fs::canonicalize(mesh),
    }
}

fn read_mesh(path: &Path) -> Result<Mesh, dpana::Error> {
    let read = |path: &Path, place: &str| {
        fs::read(path).map_err(|error| dpana::Error::Unreadable {
            place: place.to_owned(),
            file: path.display().to_string(),
            reason: error.to_string(),
        })
    };
    let folder = path.parent().unwrap_or(Path::new(""));
    let include = |name: &str| read(&folder.join(name), "*INCLUDE");
    let bytes = read(path, "mesh")?;
    mesh_file::parse(&bytes, &path.display().to_string(), &include)
}
