//! How far a state is from satisfying Coulomb's law.
//!
//! ```text
//! (L2)  ‖t_T‖ ≤ −μ t_N                      the reaction stays inside the friction disc
//! (L3)  −μ t_N ‖u_T‖ + t_T · u_T = 0        slip dissipates all the disc allows; and (L5)
//! ```
//!
//! Inside the disc the left side of (L3) cannot be negative (Cauchy–Schwarz), and it
//! vanishes only for stick or for slip opposed to a reaction on the edge of the disc,
//! so it serves as a residual without casework.

use super::certificate::Worst;
use super::law::JudgedLaw;
use super::state::{ContactState, length};

/// Worst violation of (L2) and (L3), in physical units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct CoulombResidual {
    /// Largest `‖t_T‖ + μ t_N > 0`, in newton.
    pub(super) disc_excess: Worst,
    /// Largest `|−μ t_N ‖u_T‖ + t_T · u_T|`, in joule.
    pub(super) dissipation_defect: Worst,
}

/// Measures (L2) and (L3) over all contacts.
pub(super) fn coulomb_residual(states: &[ContactState]) -> CoulombResidual {
    let mut worst = CoulombResidual::default();
    for (contact, state) in states.iter().enumerate() {
        // Not `friction_bound`: (L2) and (L3) hold the signed −μ t_N, so that a
        // reaction that pulls is charged here as well.
        let bound = match state.law == JudgedLaw::COULOMB {
            true => -state.friction * state.normal_reaction,
            false => state.friction_bound(),
        };
        let force = length(state.law.rounded(state.tangential_reaction));
        let (excess, dissipation) = match (state.law.sticks(), state.is_pressed()) {
            (true, true) => (0.0, force * length(state.slip)),
            (true, false) => (force, 0.0),
            (false, _) => (
                force - bound,
                state.law.dissipation(bound, state.slip) + state.friction_work(),
            ),
        };
        worst.disc_excess.raise(excess, contact);
        worst.dissipation_defect.raise(dissipation.abs(), contact);
    }
    worst
}

#[cfg(test)]
mod tests {
    use super::*;

    // The disc of every state below has the radius −0.5 · (−10) = 5 N.
    fn state(tangential_reaction: [f64; 2], slip: [f64; 2]) -> ContactState {
        ContactState {
            friction: 0.5,
            normal_reaction: -10.0,
            tangential_reaction,
            overlap: 0.0,
            slip,
            law: JudgedLaw::COULOMB,
        }
    }

    #[test]
    fn stick_inside_the_disc_and_slip_opposed_on_its_edge_have_no_residual() {
        let states = [
            state([1.0, -2.0], [0.0, 0.0]),
            state([-3.0, -4.0], [0.6, 0.8]),
        ];
        assert_eq!(coulomb_residual(&states), CoulombResidual::default());
    }

    #[test]
    fn a_reaction_outside_the_disc_is_measured_in_newton() {
        // (L2): ‖(6, 8)‖ − 5 = 5 N; no slip, so (L3) holds.
        let found = coulomb_residual(&[state([0.0; 2], [0.0; 2]), state([6.0, 8.0], [0.0; 2])]);
        assert_eq!(
            (found.disc_excess.value, found.disc_excess.contact),
            (5.0, 1)
        );
        assert_eq!(found.dissipation_defect.value, 0.0);
    }

    #[test]
    fn a_reaction_that_pushes_along_the_slip_is_caught() {
        // (L3): 5 · 1 + (3 · 0.6 + 4 · 0.8) = 10 J; (L2) still holds.
        let found = coulomb_residual(&[state([3.0, 4.0], [0.6, 0.8])]);
        assert!((found.dissipation_defect.value - 10.0).abs() < 1e-14);
        assert_eq!(found.disc_excess.value, 0.0);
    }

    #[test]
    fn slip_inside_the_disc_is_caught() {
        // (L3): 5 · 2 + (−1) · 2 = 8 J: a reaction of 1 N must not slip on a disc of 5 N.
        let found = coulomb_residual(&[state([-1.0, 0.0], [2.0, 0.0])]);
        assert_eq!(found.dissipation_defect.value, 8.0);
    }

    #[test]
    fn slip_across_the_reaction_is_caught() {
        // (L3): 5 · 1 + 0 = 5 J: on the edge, but at a right angle to the slip.
        let found = coulomb_residual(&[state([0.0, 5.0], [1.0, 0.0])]);
        assert_eq!(found.dissipation_defect.value, 5.0);
    }

    #[test]
    fn friction_without_pressure_is_caught_without_friction_and_with_it() {
        let open = ContactState {
            normal_reaction: 0.0,
            ..state([2.0, 0.0], [0.0; 2])
        };
        let smooth = ContactState {
            friction: 0.0,
            ..state([2.0, 0.0], [0.0; 2])
        };
        assert_eq!(coulomb_residual(&[open]).disc_excess.value, 2.0);
        assert_eq!(coulomb_residual(&[smooth]).disc_excess.value, 2.0);
    }

    #[test]
    fn a_nan_is_an_infinite_violation() {
        let found = coulomb_residual(&[state([f64::NAN, 0.0], [0.0, 0.0])]);
        assert_eq!(found.disc_excess.value, f64::INFINITY);
        assert_eq!(found.dissipation_defect.value, f64::INFINITY);
    }
}
