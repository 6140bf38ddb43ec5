//! Two cubes of non-matching faces (`examples/scenes/two_cubes.json`) on ever finer meshes.
//!
//! `cargo bench --bench two_cubes [-- --quick]`
#![allow(clippy::print_stdout)]

mod measured;

use std::error::Error;

use dpana::Scene;
use dpana::scene::MeshSource;

fn main() -> Result<(), Box<dyn Error>> {
    measured::table(&[8, 16, 24], two_cubes)
}

/// The scene with `per_side` cells along every edge of both cubes.
fn two_cubes(per_side: usize) -> Result<Scene, Box<dyn Error>> {
    let file = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/examples/scenes/two_cubes.json"
    );
    let mut scene = Scene::from_file(file)?;
    for body in &mut scene.bodies {
        if let MeshSource::Box { solid } = &mut body.mesh {
            solid.cells = [per_side; 3];
        }
    }
    Ok(scene)
}
