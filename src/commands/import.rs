//! `dpana import`: a deck of another program as a scene of its own, with its meshes beside it.

use std::error::Error;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;
use dpana::body::Mesh;
use dpana::deck::Deck;
use dpana::mesh_file::gmsh;
use dpana::report::replace_file;
use dpana::scene::{MeshSource, NodalFile, SceneLoad, SceneTemperature};

use super::outputs::{check_output, is_standard};
use super::scene_file::tell;

#[derive(Args)]
pub(crate) struct Import {
    /// Abaqus or CalculiX deck.
    deck: PathBuf,
    /// Write the scene to this file, in JSON, and the mesh of its bodies beside it (`FILE_1.msh`).
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
}

pub(crate) fn import(arguments: &Import) -> Result<ExitCode, Box<dyn Error>> {
    if is_standard(&arguments.out) {
        return Err(
            "--out: `-` is no name for the meshes beside the scene; expected a file".into(),
        );
    }
    check_output("--out", &arguments.out, &arguments.deck)?;
    let mut scene = tell(Deck::from_file(&arguments.deck)?).scene;
    // Meshes and groups are looked at before anything is written.
    scene.mechanics()?;
    let folder = arguments.out.parent().unwrap_or(Path::new(""));
    let stem = arguments.out.file_stem().unwrap_or_default();
    let stem = stem.to_string_lossy();
    for (number, body) in (1..).zip(&mut scene.bodies) {
        let MeshSource::Given(mesh) = &body.mesh else {
            continue;
        };
        for (load, of) in (1..).zip(&mut body.loads) {
            let SceneLoad::Temperature { temperature, .. } = of else {
                continue;
            };
            if let SceneTemperature::Given(values) = temperature {
                let file = PathBuf::from(format!("{stem}_{number}_{load}.csv"));
                replace_file(&folder.join(&file), &table(mesh, values))?;
                *temperature = SceneTemperature::Table(NodalFile { file });
            }
        }
        let file = PathBuf::from(format!("{stem}_{number}.msh"));
        replace_file(&folder.join(&file), &gmsh::to_text(mesh))?;
        writeln!(
            io::stdout(),
            "body `{}`: {}",
            body.name,
            folder.join(&file).display()
        )?;
        body.mesh = MeshSource::File {
            file,
            scale: 1.0,
            split: None,
            groups: Vec::new(),
        };
    }
    replace_file(&arguments.out, &scene.to_json()?)?;
    writeln!(io::stdout(), "scene: {}", arguments.out.display())?;
    Ok(ExitCode::SUCCESS)
}

/// A row for every node: its position and a value.
fn table(mesh: &Mesh, values: &[f64]) -> String {
    let rows = mesh.nodes.iter().zip(values).map(|(node, value)| {
        let numbers = node[..mesh.dimension].iter().chain([value]);
        let numbers: Vec<String> = numbers.map(|x| format!("{x:?}")).collect();
        numbers.join(", ") + "\n"
    });
    rows.collect()
}
