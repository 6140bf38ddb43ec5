//! VERIFICATION: a gallery of scenes whose answers are known, each on a ladder of meshes.
//!
//! ```text
//! (V1)  error = |computed/exact − 1|,  or a relative norm over the contacts
//! (V2)  rate  = slope of ln error over ln size, least squares over the ladder
//! ```
//!
//! Known means: a closed form, a published value, or a value that was computed independently. The
//! contact zone ends anywhere between two nodes, so its errors scatter with the load by as much as
//! they fall with a mesh: the Hertz scenes take the mean over several loads per mesh. All meshes are
//! generated here.

mod cattaneo_mindlin;
mod flat_punch;
mod goodman;
mod growing;
mod hard;
mod hertz_line;
mod hertz_sphere;
mod incline;
mod konter;
mod ladder;
mod metamorphic;
mod mindlin_sphere;
mod pad;
mod scenes;
mod ssnv128;
mod two_blocks;
mod two_parabolas;
mod uniform_patch;
mod wedge;

pub use hard::{Reach, hard_cases};
pub use metamorphic::metamorphic;

use std::time::Instant;

use crate::error::Error;
use crate::pipeline::solve;
use crate::report::{Verification, VerifiedQuantity, VerifiedScene};
use crate::scene::Scene;

/// One scene of the gallery, before it is computed.
struct Entry {
    name: &'static str,
    source: &'static str,
    /// What keeps the error from vanishing.
    floor: &'static str,
    /// Computes it; without the finest meshes if `quick`.
    measure: fn(quick: bool) -> Result<Vec<VerifiedQuantity>, Error>,
    /// A scene of it that a picture can show: plane, on a coarse mesh, in a single state.
    drawn: Option<fn() -> Result<Scene, Error>>,
}

const GALLERY: [Entry; 14] = [
    uniform_patch::ENTRY,
    two_blocks::ENTRY,
    ssnv128::ENTRY,
    hertz_line::ENTRY,
    two_parabolas::ENTRY,
    hertz_sphere::ENTRY,
    flat_punch::ENTRY,
    goodman::ENTRY,
    cattaneo_mindlin::ENTRY,
    mindlin_sphere::ENTRY,
    konter::ENTRY,
    incline::ENTRY,
    wedge::ENTRY,
    pad::ENTRY,
];

/// Computes the gallery; `quick` leaves out the finest meshes.
///
/// # Errors
///
/// None unless a scene of the gallery is broken: a quantity that misses its criterion is told in
/// the result.
pub fn verify(quick: bool) -> Result<Verification, Error> {
    let scenes = GALLERY.iter().map(|entry| entry.verify(quick));
    let scenes: Vec<VerifiedScene> = scenes.collect::<Result<_, _>>()?;
    Ok(Verification {
        quick,
        passed: scenes.iter().all(|scene| scene.passed),
        scenes,
    })
}

/// The gallery with pictures of its scenes, for the page.
///
/// # Errors
///
/// As [`verify`].
pub fn manual(quick: bool) -> Result<Verification, Error> {
    let mut all = verify(quick)?;
    for (entry, scene) in GALLERY.iter().zip(&mut all.scenes) {
        let drawn = entry.drawn.map(|drawn| solve(&drawn()?)?.to_svg());
        scene.picture = drawn
            .transpose()
            .map_err(|error| error.within(entry.name))?;
    }
    Ok(all)
}

impl Entry {
    fn verify(&self, quick: bool) -> Result<VerifiedScene, Error> {
        let start = Instant::now();
        let quantities = (self.measure)(quick).map_err(|error| error.within(self.name))?;
        Ok(VerifiedScene {
            name: self.name,
            source: self.source,
            floor: self.floor,
            picture: None,
            passed: quantities.iter().all(|quantity| quantity.passed),
            seconds: start.elapsed().as_secs_f64(),
            quantities,
        })
    }
}
