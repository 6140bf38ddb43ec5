//! STUDY: one scene over meshes, tolerances, friction and loops: how fast, how wrong.
//!
//! ```text
//! (M1)  mesh       relative difference to the finest mesh in the energy norm, and to known totals
//! (M2)  loop       ‖t − t*‖_G / ‖t*‖_G on one mesh, t* the default loop's at the tightest tolerance
//! (M3)  judge      natural map, and √(η / ½ t·G t) of the bipotential gap
//! (M4)  seconds ~ unknowns^p          least squares of the logarithms over the finest meshes
//! (M5)  half-steps to the last digit  so that loops differ in nothing but what they are named for
//! (M8)  half-spaces in place of the bodies: the difference of pressures as a field
//! (M6)  penalty    springs of ε = τ^(−1/2) times a contact's own stiffness, at a tolerance τ; (M7) multipliers around them
//! ```
//!
//! Rivals, a file each: penalty and augmented Lagrangian (M6), (M7) in `penalty`, whole bodies that are factorised anew in every
//! step (M9) in `active_set`, the alternation on displacements (M10), (M11) in `panagiotopoulos`. Their seconds are held
//! against those of a whole solve from the assembled stiffness on: ordering, factorisation, condensation and loop.
//!
//! A mesh that is generated is refined by its number of cells; meshes from files are given as a
//! list. Loops are compared on the finest mesh whose contact surface is small enough for all of
//! them, on an operator that is condensed once, so that its cost counts on no side. What takes less
//! than a quarter of a second is repeated, and the median is kept.

mod active_set;
mod exact;
mod half_space;
mod ladder;
mod loops;
mod panagiotopoulos;
mod penalty;
mod plan;
mod tensor_grid;
mod variant;

pub use half_space::{HalfSpaceFit, half_space_fit};
pub use plan::{Plan, Progress};
pub use variant::{Mixing, Sweeps, Variant};

use crate::error::Error;
use crate::report::Study;
use crate::scene::Scene;
use ladder::Ladder;

/// Runs a scene over the meshes, tolerances, coefficients of friction and loops of a plan, and
/// tells `progress` before each of them.
///
/// # Errors
///
/// A plan outside its ranges or one that does not fit the scene, a scene with load steps or other laws than friction, and
/// whatever is wrong with the scene on any of the meshes. A loop that does not converge is no
/// error: the study says so.
pub fn study(
    scene: &Scene,
    plan: &Plan,
    mut progress: impl FnMut(Progress<'_>),
) -> Result<Study, Error> {
    plan.validate()?;
    check_laws(scene)?;
    let scenes = plan.scenes(scene)?;
    let mut ladder = Ladder::default();
    let mut runs = Vec::new();
    for (done, (name, scene)) in scenes.iter().enumerate() {
        let (of, doing) = (scenes.len() + 1, &format!("mesh {name}"));
        progress(Progress { done, of, doing });
        let problem = ladder.climb(name, scene, plan)?;
        for run in loops::of_mesh(done, &problem, plan)? {
            runs.push(run.run()?);
        }
    }
    let (meshes, chosen) = ladder.finish();
    let compared = chosen.map(|chosen| loops::all(&chosen, plan));
    let compared = compared.transpose()?.unwrap_or_default();
    let of = scenes.len() + compared.len();
    for (at, run) in compared.iter().enumerate() {
        let (done, doing) = (scenes.len() + at, &run.name());
        progress(Progress { done, of, doing });
        runs.push(run.run()?);
    }
    let doing = "the page";
    progress(Progress {
        done: of,
        of,
        doing,
    });
    Ok(Study::new(&scene.title, &scene.units, meshes, runs))
}

/// The loops that are compared know Coulomb's law alone, with the coefficient that the study varies.
fn check_laws(scene: &Scene) -> Result<(), Error> {
    let other = scene.contacts.iter().enumerate().find_map(|(at, contact)| {
        let law = contact.law.as_ref().map(|_| (at, "law", "a law"));
        let layer = contact.compliance.as_ref();
        law.or_else(|| layer.map(|_| (at, "compliance", "a compliance")))
    });
    match other {
        None => Ok(()),
        Some((at, key, found)) => Err(Error::NotAccepted {
            place: format!("contacts[{at}].{key}"),
            found: found.to_owned(),
            accepted: "`friction` alone in a study, whose loops know Coulomb's law; `dpana solve` knows all laws"
                .to_owned(),
        }),
    }
}
