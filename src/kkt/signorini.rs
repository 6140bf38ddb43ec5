//! How far a state is from satisfying Signorini's law.
//!
//! ```text
//! (L1)  t_N ≤ 0,   u_N − g₀ ≤ 0,   t_N (u_N − g₀) = 0          and (L4)
//! ```

use super::certificate::Worst;
use super::state::ContactState;

/// Worst violation of each part of (L1), in physical units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct SignoriniResidual {
    /// Largest `u_N − g₀ > 0`, in metre.
    pub(super) penetration: Worst,
    /// Largest `t_N > 0`, in newton.
    pub(super) tension: Worst,
    /// Largest `|t_N (u_N − g₀)|`, in joule.
    pub(super) complementarity: Worst,
}

/// Measures (L1) over all contacts.
pub(super) fn signorini_residual(states: &[ContactState]) -> SignoriniResidual {
    let mut worst = SignoriniResidual::default();
    for (contact, state) in states.iter().enumerate() {
        if state.law.is_bilateral() {
            worst.penetration.raise(state.overlap.abs(), contact);
            continue;
        }
        let tension = state.normal_reaction - state.law.tension();
        let work = tension * state.overlap;
        worst.penetration.raise(state.overlap, contact);
        worst.tension.raise(tension, contact);
        worst.complementarity.raise(work.abs(), contact);
    }
    worst
}

#[cfg(test)]
mod tests {
    use super::*;

    fn state(normal_reaction: f64, overlap: f64) -> ContactState {
        ContactState {
            normal_reaction,
            overlap,
            ..Default::default()
        }
    }

    #[test]
    fn open_pressed_and_grazing_contacts_have_no_residual() {
        let states = [state(0.0, -1.0), state(-1.0, 0.0), state(0.0, 0.0)];
        assert_eq!(signorini_residual(&states), SignoriniResidual::default());
    }

    #[test]
    fn penetration_is_measured_in_metre_where_it_is_deepest() {
        let found = signorini_residual(&[state(0.0, 0.25), state(0.0, 0.5)]);
        assert_eq!(
            (found.penetration.value, found.penetration.contact),
            (0.5, 1)
        );
        assert_eq!(
            (found.tension.value, found.complementarity.value),
            (0.0, 0.0)
        );
    }

    #[test]
    fn a_reaction_that_pulls_is_measured_in_newton() {
        let found = signorini_residual(&[state(3.0, 0.0), state(-9.0, 0.0)]);
        assert_eq!((found.tension.value, found.tension.contact), (3.0, 0));
        assert_eq!(
            (found.penetration.value, found.complementarity.value),
            (0.0, 0.0)
        );
    }

    #[test]
    fn a_reaction_across_an_open_gap_is_measured_in_joule() {
        // (L1): |−4 · (−0.5)| = 2 J; neither penetration nor tension.
        let found = signorini_residual(&[state(-4.0, -0.5)]);
        assert_eq!(found.complementarity.value, 2.0);
        assert_eq!((found.penetration.value, found.tension.value), (0.0, 0.0));
    }

    #[test]
    fn a_nan_is_an_infinite_violation() {
        let found = signorini_residual(&[state(-1.0, f64::NAN)]);
        assert_eq!(found.penetration.value, f64::INFINITY);
        assert_eq!(found.complementarity.value, f64::INFINITY);
    }
}
