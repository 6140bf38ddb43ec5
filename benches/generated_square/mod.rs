//! The SSNV128 square of `examples/scenes/ssnv128.json` on a mesh of its own.

use std::error::Error;

use dpana::Scene;
use dpana::scene::{MeshSource, PlaneCell, Rectangle, SceneSupport};

/// The scene with `per_side` cells along both edges.
pub(crate) fn square(per_side: usize) -> Result<Scene, Box<dyn Error>> {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/scenes/ssnv128.json");
    let mut scene = Scene::from_file(file)?;
    let body = &mut scene.bodies[0];
    body.mesh = MeshSource::Rectangle {
        rectangle: Rectangle {
            x: [0.0, 0.04],
            y: [0.0, 0.04],
            cells: [per_side; 2],
            grading: [1.0; 2],
            cell: PlaneCell::Quad4,
        },
    };
    // The generator names the sides by where they are; the mesh file by what they do.
    if let SceneSupport::Group { group, .. } = &mut body.supports[0] {
        *group = "right".into();
    }
    scene.contacts[0].group = "bottom".into();
    Ok(scene)
}
