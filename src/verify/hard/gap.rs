//! Gaps of nothing and of a millionth of a millionth of the size, contact without force, no contact.

use super::case::{Case, apart};
use super::friction::{dragged, elastic};
use crate::body::{CellKind, graded, rectangle};
use crate::error::Error;
use crate::kkt::ContactStatus;
use crate::scene::{Scene, SceneObstacle};
use crate::verify::scenes::{body, hold, on};
use crate::verify::ssnv128::SIDE;

/// Meshes and material of the blocks that hang above their plane.
const CELLS: usize = 8;
const YOUNG: f64 = 1e9;

/// The square with its plane a little lower, or higher.
fn parted(gap: f64, friction: f64) -> Result<Scene, Error> {
    let mut scene = dragged(32, 0.2, friction)?;
    for contact in &mut scene.contacts {
        contact.obstacle = Some(level(-gap));
    }
    Ok(scene)
}

fn level(height: f64) -> SceneObstacle {
    SceneObstacle::Plane {
        point: vec![0.0, height],
        normal: vec![0.0, 1.0],
    }
}

/// A unit square, its top moved by (along, −down), above a plane at −1.
fn hanging(along: f64, down: f64, friction: f64) -> Result<Scene, Error> {
    let side = graded(0.0, 1.0, CELLS, 1.0)?;
    let mesh = rectangle(&side, &side, CellKind::Quad4)?;
    let block = body("block", mesh, elastic(YOUNG, 0.3));
    let block = hold(hold(block, "top", 0, along), "top", 1, -down);
    Ok(on(level(-1.0), block, "bottom", friction))
}

pub(super) fn cases() -> Result<Vec<Case>, Error> {
    let mut cases = Vec::new();
    for friction in [0.0, 0.3, 1.0, 5.0] {
        for gap in [0.0, 1e-12, -1e-12] {
            let name = format!("{gap:e} of the size, mu {friction}");
            let case = Case::scene("gap", name, parted(gap * SIDE, friction)?);
            let twin = || parted(0.0, friction);
            // A node next to the held corner takes the gap as a strain over one cell, E · gap = 5.2e-3 N
            // per metre, beside 6.25e4 N of pressure on its cell: 8.3e-8.
            let case = case.like("reactions without gap", 8.3e-8, 1.0, twin()?);
            // The gap, 4e-14 m, beside displacements of 2.8e-5 m, is 1.4e-9; its strain moves others by no
            // more than it. Without friction only normal displacements are known, which are nothing but the gap.
            cases.push(match friction > 0.0 {
                false => case,
                true => {
                    let twin = twin()?;
                    case.knows("displacements without gap", 3e-9, move |answer| {
                        let without = crate::pipeline::solve(&twin)?;
                        let expected = &without.outcome().verdict.displacement;
                        Ok(apart(&answer.outcome.verdict.displacement, expected))
                    })
                }
            });
        }
        // Rigid motion to the plane and not further: the reactions that round-off of 1e-16 m calls
        // forth, beside E times the motion.
        let grazing = Case::scene(
            "gap",
            format!("touching without force, mu {friction}"),
            hanging(0.0, 1.0, friction)?,
        );
        cases.push(grazing.knows("no force", 1e-12, |answer| {
            let largest = answer
                .outcome
                .reaction
                .iter()
                .fold(0.0_f64, |m, t| m.max(t.abs()));
            Ok(largest / YOUNG)
        }));
        for (what, along, down) in [
            ("away", 0.0, 0.5),
            ("along, not near", 3.0, 0.0),
            ("at rest", 0.0, 0.0),
        ] {
            let name = format!("moved {what}, mu {friction}");
            let apart = Case::scene("gap", name, hanging(along, down, friction)?);
            cases.push(apart.knows("no reaction, no sweep", 0.0, |answer| {
                let open = |status: &ContactStatus| *status == ContactStatus::Open;
                let none = answer.outcome.reaction.iter().all(|t| *t == 0.0)
                    && answer.outcome.verdict.status.iter().all(open)
                    && answer.outcome.work.sweeps == 0;
                Ok(if none { 0.0 } else { 1.0 })
            }));
        }
    }
    Ok(cases)
}
