//! Whether a rigid motion proves that no contact forces hold a load.
//!
//! ```text
//! (K7)  e·α > 0   and   v_N + μ ‖v_T‖ ≤ 0  for every contact,   v = R α
//! ```
//!
//! For admissible `t` in equilibrium `0 = α·(Rᵀ t + e) = v·t + e·α`, and `v·t ≥ (v_N + μ ‖v_T‖) t_N`. A motion that
//! misses (K7) by a velocity `r` therefore still proves that `Σ −t_N ≥ e·α / r`.

use faer::MatRef;

use super::law::JudgedLaw;
use crate::error::{Error, check_finite, check_length};
use crate::problem::{ContactProblem, Floating};

/// What a motion proves (K7).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impossibility {
    /// Work of the load on the motion, `e·α`, in newton times the unit of the motion.
    pub work: f64,
    /// Largest `v_N + μ ‖v_T‖`, or zero, in the unit of the motion.
    pub resistance: f64,
    /// The contact where it occurs.
    pub contact: usize,
    /// Normal reactions, summed over all contacts, that an equilibrium would take at least, in newton:
    /// zero if the load does no work on the motion, infinite if nothing resists it.
    pub least_reaction: f64,
}

/// Measures (K7) for contacts whose blocks begin at `offsets` (their end appended), normal first.
///
/// `friction` per contact; `modes` R, unknowns × modes; `load` e and `motion` α per mode.
///
/// # Errors
///
/// [`Error::Length`] or [`Error::OutOfRange`] if the arrays do not belong together, [`Error::NotFinite`] for a NaN.
pub fn impossibility(
    offsets: &[usize],
    friction: &[f64],
    modes: MatRef<'_, f64>,
    load: &[f64],
    motion: &[f64],
) -> Result<Impossibility, Error> {
    check_blocks(offsets, friction.len(), modes.nrows())?;
    check_length("load", modes.ncols(), load.len())?;
    check_length("motion", modes.ncols(), motion.len())?;
    let velocity: Vec<f64> = (0..modes.nrows())
        .map(|row| (0..motion.len()).map(|k| modes[(row, k)] * motion[k]).sum())
        .collect();
    check_finite("velocity", &velocity)?;
    let work = load.iter().zip(motion).map(|(e, a)| e * a).sum::<f64>();
    check_finite("work", &[work])?;

    let (mut resistance, mut contact) = (0.0, 0);
    for (index, mu) in friction.iter().enumerate() {
        let block = &velocity[offsets[index]..offsets[index + 1]];
        let slip = block[1..].iter().map(|v| v * v).sum::<f64>().sqrt();
        let resists = block[0] + mu * slip;
        if resists > resistance {
            (resistance, contact) = (resists, index);
        }
    }
    let least_reaction = if work <= 0.0 { 0.0 } else { work / resistance };
    Ok(Impossibility {
        work,
        resistance,
        contact,
        least_reaction,
    })
}

/// Measures (K7) where contacts obey other laws than Coulomb's: what they dissipate at most on the motion, by bounds that
/// need no pressure, is taken off the work of the load.
///
/// # Errors
///
/// Those of [`impossibility`].
pub fn impossibility_under_laws(
    problem: &ContactProblem,
    floating: &Floating,
    motion: &[f64],
) -> Result<Impossibility, Error> {
    let (offsets, friction, modes) = (problem.offsets(), problem.friction(), floating.modes());
    let plain = impossibility(offsets, friction, modes, floating.load(), motion)?;
    let (mut work, mut resistance, mut contact) = (plain.work, 0.0, plain.contact);
    for (index, block) in problem.blocks().enumerate() {
        let velocity = |row: usize| -> f64 {
            let terms = motion.iter().enumerate();
            terms.map(|(k, along)| modes[(row, k)] * along).sum()
        };
        let mut along = block.map(velocity);
        let mut next = || along.next().unwrap_or(0.0);
        let (normal, tangents) = (next(), [next(), next()]);
        let law = JudgedLaw::new(problem.laws().map(|laws| &laws[index]));
        let [spent, resists] = law.resistance(friction[index], normal, tangents);
        work -= spent;
        if resists > resistance {
            (resistance, contact) = (resists, index);
        }
    }
    Ok(Impossibility {
        work,
        resistance,
        contact,
        least_reaction: if work <= 0.0 { 0.0 } else { work / resistance },
    })
}

/// One block per contact, of one entry or more, from the first row of the modes to the last.
pub(super) fn check_blocks(offsets: &[usize], contacts: usize, rows: usize) -> Result<(), Error> {
    check_length("offsets", contacts + 1, offsets.len())?;
    let starts_late = offsets.first().is_some_and(|&first| first > 0);
    let empty = offsets.windows(2).position(|block| block[0] >= block[1]);
    let wrong = if starts_late {
        Some(0)
    } else {
        empty.map(|i| i + 1)
    };
    if let Some(wrong) = wrong {
        return Err(Error::OutOfRange {
            place: format!("offsets[{wrong}]"),
            value: offsets[wrong] as f64,
            accepted: "0 at first, then ever larger",
        });
    }
    check_length("modes", offsets.last().copied().unwrap_or(0), rows)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use faer::mat;

    /// A point on a floor, μ = 0.5: modes x and up, which opens.
    fn point(load: [f64; 2], motion: [f64; 2]) -> Impossibility {
        let modes = mat![[0.0, -1.0], [1.0, 0.0]];
        impossibility(&[0, 2], &[0.5], modes.as_ref(), &load, &motion).unwrap()
    }

    #[test]
    fn sliding_that_opens_enough_proves_the_excess() {
        // 6 N along x on 10 N down: (1, 0.5) has 6 − 5 = 1 N of work and −0.5 + 0.5 · 1 = 0 of resistance.
        let found = point([6.0, -10.0], [1.0, 0.5]);
        assert_eq!((found.work, found.resistance), (1.0, 0.0));
        assert_eq!(found.least_reaction, f64::INFINITY);
    }

    #[test]
    fn sliding_that_friction_resists_proves_that_it_takes_a_large_reaction() {
        // (1, 0.25): work 6 − 2.5, resistance −0.25 + 0.5: Σ −t_N ≥ 3.5 / 0.25 = 14 N.
        let found = point([6.0, -10.0], [1.0, 0.25]);
        assert_eq!(
            (found.work, found.resistance, found.least_reaction),
            (3.5, 0.25, 14.0)
        );
    }

    #[test]
    fn a_motion_on_which_the_load_does_no_work_proves_nothing() {
        assert_eq!(point([4.0, -10.0], [1.0, 0.5]).least_reaction, 0.0);
        assert_eq!(point([0.0, 0.0], [0.0, 0.0]).least_reaction, 0.0);
    }

    #[test]
    fn numbers_that_are_none_and_arrays_that_do_not_fit_are_refused() {
        let modes = mat![[0.0, -1.0], [1.0, 0.0]];
        let check = |load: &[f64], motion: &[f64]| {
            impossibility(&[0, 2], &[0.5], modes.as_ref(), load, motion)
        };
        assert!(matches!(
            check(&[1.0], &[1.0, 0.0]),
            Err(Error::Length { .. })
        ));
        assert!(matches!(
            check(&[1.0; 2], &[f64::NAN, 0.0]),
            Err(Error::NotFinite { .. })
        ));
        assert!(matches!(
            check(&[f64::NAN; 2], &[1.0, 0.0]),
            Err(Error::NotFinite { .. })
        ));
        for offsets in [[1, 2], [0, 0], [2, 0]] {
            let found = impossibility(&offsets, &[0.5], modes.as_ref(), &[1.0; 2], &[1.0; 2]);
            assert!(
                matches!(found, Err(Error::OutOfRange { .. })),
                "{offsets:?}"
            );
        }
        let found = impossibility(&[0, 3], &[0.5], modes.as_ref(), &[1.0; 2], &[1.0; 2]);
        assert!(matches!(found, Err(Error::Length { .. })));
    }
}
