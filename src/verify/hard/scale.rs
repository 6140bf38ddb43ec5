//! The same square under loads from 1e-12 to 1e12 times its own, in metre, millimetre and micrometre.

use super::case::Case;
use super::friction::dragged;
use crate::body::CellKind;
use crate::error::Error;
use crate::scene::{Scene, SceneLoad, SceneSupport};
use crate::verify::ssnv128::square;

const CELLS: usize = 32;

/// Lengths and stresses of the square in other units.
fn scaled(mut scene: Scene, length: f64, stress: f64, load: f64) -> Result<Scene, Error> {
    let mut mesh = square(CELLS, [1.0; 2], CellKind::Quad4)?;
    for x in mesh.nodes.iter_mut().flatten() {
        *x *= length;
    }
    for body in &mut scene.bodies {
        body.mesh = crate::scene::MeshSource::Given(mesh.clone());
        for material in &mut body.materials {
            material.young = material.young.map(|young| young * stress);
        }
        for applied in &mut body.loads {
            if let SceneLoad::Pressure { pressure, .. } = applied {
                *pressure *= stress * load;
            }
        }
        for support in &mut body.supports {
            if let SceneSupport::At { at, .. } = support {
                at.iter_mut().for_each(|x| *x *= length);
            }
        }
    }
    Ok(scene)
}

pub(super) fn cases() -> Result<Vec<Case>, Error> {
    let mut cases = Vec::new();
    for friction in [0.3, 1.0, 5.0] {
        let twin = || dragged(CELLS, 0.2, friction);
        // Everything is homogeneous in the load: what differs is round-off, through a condition of
        // some hundreds.
        for power in [-12, -9, 9, 12] {
            let load = 10_f64.powi(power);
            let name = format!("load 1e{power}, mu {friction}");
            let case = Case::scene("scale", name, scaled(twin()?, 1.0, 1.0, load)?);
            cases.push(case.like("reactions to scale", 1e-9, load, twin()?));
        }
        for (units, length, stress) in [("mm, MPa", 1e3, 1e-6), ("um, GPa", 1e6, 1e-9)] {
            let name = format!("{units}, mu {friction}");
            let case = Case::scene("scale", name, scaled(twin()?, length, stress, 1.0)?);
            cases.push(case.like("reactions to scale", 1e-9, length * stress, twin()?));
        }
    }
    Ok(cases)
}
