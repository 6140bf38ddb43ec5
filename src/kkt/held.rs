//! Whether a reaction is admissible and holds a load on the free rigid modes.

use faer::MatRef;

use super::certificate::{Defect, ratio};
use super::floating::unanswered;
use super::impossibility::check_blocks;
use crate::error::{Error, check_length};

/// What a reaction that is said to hold a load leaves open; all zero where it holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Held {
    /// Largest load on a mode that is not answered, in newton (K8).
    pub equilibrium: Defect,
    /// Largest departure of a contact from `t_N ≤ 0`, `‖t_T‖ ≤ −μ t_N`, in newton; scaled by
    /// the largest reaction of a contact.
    pub excess: Defect,
}

/// Measures a reaction against the load `e` on the modes R.
///
/// Contacts' blocks begin at `offsets` (their end appended), normal first; `friction` per contact,
/// `modes` unknowns × modes, `load` and `reaction` in newton.
///
/// # Errors
///
/// [`Error::Length`] or [`Error::OutOfRange`] if the arrays do not belong together.
pub(crate) fn held(
    offsets: &[usize],
    friction: &[f64],
    modes: MatRef<'_, f64>,
    load: &[f64],
    reaction: &[f64],
) -> Result<Held, Error> {
    check_blocks(offsets, friction.len(), modes.nrows())?;
    check_length("load", modes.ncols(), load.len())?;
    check_length("reaction", modes.nrows(), reaction.len())?;
    let (mut excess, mut largest) = (0.0_f64, 0.0_f64);
    for (block, mu) in offsets.windows(2).zip(friction) {
        let t = &reaction[block[0]..block[1]];
        let tangential = t[1..].iter().fold(0.0, |size: f64, t| size.hypot(*t));
        // `max` drops NaN: a broken contact would score zero.
        if t.iter().any(|t| t.is_nan()) {
            excess = f64::INFINITY;
        }
        excess = excess.max(t[0]).max(tangential + mu * t[0].min(0.0));
        largest = largest.max(t[0].abs().hypot(tangential));
    }
    Ok(Held {
        equilibrium: unanswered(modes, (load, &vec![1.0; load.len()]), (offsets, reaction)),
        excess: Defect {
            value: excess,
            scaled: ratio(excess, largest),
        },
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use faer::mat;

    /// One contact with μ = 0.5 under a load (along, down): R is the identity turned to (down, along).
    fn measured(load: [f64; 2], reaction: [f64; 2]) -> Held {
        let modes = mat![[0.0, -1.0], [1.0, 0.0]];
        held(&[0, 2], &[0.5], modes.as_ref(), &load, &reaction).unwrap()
    }

    #[test]
    fn a_reaction_in_its_cone_that_answers_the_load_holds_it() {
        // Mode 0 moves along the tangent, mode 1 off the ground: Rᵀ t = (t_T, −t_N).
        let found = measured([3.0, -10.0], [-10.0, -3.0]);
        assert_eq!((found.equilibrium.value, found.excess.value), (0.0, 0.0));
    }

    #[test]
    fn what_is_not_answered_and_what_leaves_the_cone_is_measured() {
        // ‖t_T‖ + μ t_N = 7 − 5; along 8 − 7 = 1 N is left of 8 + 7.
        let found = measured([8.0, -10.0], [-10.0, -7.0]);
        assert_eq!((found.equilibrium.value, found.excess.value), (1.0, 2.0));
        assert_eq!(measured([0.0, 10.0], [10.0, 0.0]).excess.value, 10.0);
        let broken = measured([0.0, 0.0], [f64::NAN, 0.0]);
        assert_eq!(broken.excess.value, f64::INFINITY);
    }
    #[test]
    fn blocks_that_are_none_are_refused() {
        let modes = mat![[0.0, -1.0], [1.0, 0.0]];
        for offsets in [&[0, 3][..], &[1, 2], &[2, 0, 2]] {
            let friction = vec![0.5; offsets.len() - 1];
            let found = held(offsets, &friction, modes.as_ref(), &[0.0; 2], &[0.0; 2]);
            assert!(found.is_err(), "{offsets:?}");
        }
    }
}
