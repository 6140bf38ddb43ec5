//! SSNV128 from no friction to ten times its own, from no Poisson effect to nearly incompressible.

use super::Reach;
use super::case::Case;
use crate::body::CellKind;
use crate::closed_forms::Elastic;
use crate::error::Error;
use crate::scene::Scene;
use crate::verify::ssnv128::{MATERIAL, PRESSURE, SIDE, scene, square};

const FRICTION: [f64; 10] = [0.0, 1e-12, 0.2, 0.5, 1.0, 2.0, 3.0, 5.0, 7.0, 10.0];
const POISSON: [f64; 5] = [0.0, 0.2, 0.3, 0.45, 0.4999];
const CELLS: [usize; 3] = [32, 64, 96];

/// Nodal forces add up to the load with the round-off of some thousand nodes, each 1e-16 of the
/// stiffness against which nearly incompressible cells balance.
const STATICS: f64 = 1e-9;

/// The square of another material.
pub(super) fn dragged(cells: usize, poisson: f64, friction: f64) -> Result<Scene, Error> {
    let mut scene = scene(square(cells, [1.0; 2], CellKind::Quad4)?, friction);
    for body in &mut scene.bodies {
        for material in &mut body.materials {
            material.young = Some(MATERIAL.young);
            material.poisson = Some(poisson);
        }
    }
    Ok(scene)
}

pub(super) fn cases() -> Result<Vec<Case>, Error> {
    let mut cases = Vec::new();
    for cells in CELLS {
        for poisson in POISSON {
            for friction in FRICTION {
                let name = format!("{cells} cells, nu {poisson}, mu {friction:e}");
                let case = Case::scene("SSNV128", name, dragged(cells, poisson, friction)?);
                let load = PRESSURE[1] * SIDE;
                let mut case = case.knows("normal and corner force", STATICS, move |answer| {
                    Ok(((answer.held(0, 1) - answer.normal()) / load - 1.0).abs())
                });
                if friction < 1e-6 {
                    case = uniform(case, cells);
                }
                if cells > CELLS[0] {
                    case = case.reach(Reach::All);
                }
                cases.push(case);
            }
        }
    }
    Ok(cases)
}

/// Without friction the pressure is that on the top, on any mesh; 1e-12 of friction moves it by as much.
fn uniform(case: Case, cells: usize) -> Case {
    let of_cell = PRESSURE[1] * SIDE / cells as f64;
    case.knows("uniform pressure", STATICS, move |answer| {
        let Some(solution) = &answer.solution else {
            return Ok(f64::NAN);
        };
        let contacts = &solution.condensed().surface().nodes;
        let mut worst = 0.0_f64;
        for (contact, &n) in contacts.iter().zip(answer.problem.normals()) {
            let node = solution.bodies()[0].mesh.nodes[contact.node];
            let part = if node[0] == 0.0 { 0.5 } else { 1.0 };
            worst = worst.max((answer.outcome.reaction[n] / (part * of_cell) + 1.0).abs());
        }
        Ok(worst)
    })
}

/// Nothing but Young's modulus and Poisson's ratio of a material.
pub(super) fn elastic(young: f64, poisson: f64) -> Elastic {
    Elastic { young, poisson }
}
