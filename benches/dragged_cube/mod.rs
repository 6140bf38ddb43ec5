//! The cube of `examples/scenes/cube.json` on a mesh of its own.

use std::error::Error;

use dpana::Scene;
use dpana::scene::MeshSource;

/// The scene with `per_side` cells along every edge.
pub(crate) fn dragged_cube(per_side: usize) -> Result<Scene, Box<dyn Error>> {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/scenes/cube.json");
    let mut scene = Scene::from_file(file)?;
    if let MeshSource::Box { solid } = &mut scene.bodies[0].mesh {
        solid.cells = [per_side; 3];
    }
    Ok(scene)
}
