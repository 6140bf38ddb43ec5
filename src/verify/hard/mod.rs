//! HARD CASES: scenes built to break the method, and what has to come out of each.
//!
//! Every case is solved with the settings as they are. It passes if it ends as it should (certified, or
//! proved to be without equilibrium) and if what is known of its answer holds: by statics, a scaling
//! law, symmetry or a closed form. Where nothing else is known, the judge's certificate is the claim.

mod case;
mod contrast;
mod duplicated;
mod floating;
mod friction;
mod gap;
mod jump;
mod large;
mod punch;
mod scale;
mod several;
mod shape;

use crate::error::Error;
use crate::report::HardCases;

/// Which of the hard cases are solved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reach {
    /// Coarse meshes: seconds.
    Coarse,
    /// All but the largest contact surfaces: minutes.
    All,
    /// The largest contact surfaces alone: minutes and gigabytes.
    Largest,
}

/// Solves the hard cases and says which ended as they should; `each` sees every one as it is done.
///
/// # Errors
///
/// None unless a case of the battery is broken: one that does not pass is told in the result.
pub fn hard_cases(reach: Reach, mut each: impl FnMut(&str)) -> Result<HardCases, Error> {
    let families = [
        friction::cases,
        contrast::cases,
        shape::cases,
        gap::cases,
        scale::cases,
        punch::cases,
        duplicated::cases,
        jump::cases,
        several::cases,
        floating::cases,
        large::cases,
    ];
    let mut solved = Vec::new();
    for family in families {
        for case in family()? {
            if case.is_within(reach) {
                let done = case.solve()?;
                each(&done.row());
                solved.push(done);
            }
        }
    }
    Ok(HardCases::new(solved))
}
