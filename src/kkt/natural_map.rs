//! The natural map: one residual for all laws, zero at a solution and nowhere else.
//!
//! ```text
//! (K1)  r_N = t_N − min(0, t_N − ρ_N (u_N − g₀))     = max(t_N, ρ_N (u_N − g₀))
//!       r_T = t_T − P_disc(t_T − ρ_T u_T)              disc of radius −μ min(t_N, 0), or the set of (L5)
//! ```
//!
//! A solution of (L1)–(L3) is a reaction that projection gives back after a step
//! `−ρ u`, whatever `ρ > 0`; the local stiffness as `ρ` makes the step a force of the
//! contact's own size. The trial point of the same step tells what the contact does.

use super::certificate::ContactStatus;
use super::state::{ContactState, length};

/// Part of the disc's radius by which a trial point must leave it to count as slip:
/// stick on the edge of the disc must not turn into slip by round-off.
const EDGE: f64 = 1e-9;

/// Steps `ρ` of one contact, in N/m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Step {
    pub(super) normal: f64,
    pub(super) tangential: f64,
}

impl Step {
    /// The residual (K1) of one contact, in newton; normal first.
    pub(super) fn residual(&self, state: &ContactState) -> [f64; 3] {
        let [r_1, r_2] = self.tangential_residual(state);
        [self.normal_residual(state), r_1, r_2]
    }

    /// Reads the contact's state off the trial point of (K1).
    pub(super) fn status(&self, state: &ContactState) -> ContactStatus {
        if !self.is_pressed(state) {
            return ContactStatus::Open;
        }
        if state.law.sticks() {
            return ContactStatus::Stick;
        }
        let bound = state.friction_bound();
        let smooth = state.friction == 0.0 && bound == 0.0;
        if smooth || length(self.trial(state)) > bound * (1.0 + EDGE) {
            return ContactStatus::Slip;
        }
        ContactStatus::Stick
    }

    /// Whether the trial point is in contact.
    fn is_pressed(&self, state: &ContactState) -> bool {
        let reaction = state.normal_reaction - state.law.tension();
        let parted = reaction >= self.normal * state.overlap;
        state.law.is_bilateral() || !parted
    }

    fn normal_residual(&self, state: &ContactState) -> f64 {
        let step = self.normal * state.overlap;
        let reaction = state.normal_reaction - state.law.tension();
        if state.law.is_bilateral() {
            return step;
        }
        // `max` alone would return the other operand and hide a NaN.
        if reaction.is_nan() || step.is_nan() {
            return f64::NAN;
        }
        reaction.max(step)
    }

    fn tangential_residual(&self, state: &ContactState) -> [f64; 2] {
        let pressed = self.is_pressed(state);
        let (trial, radius) = match (state.law.sticks(), pressed) {
            (true, true) => return state.slip.map(|u| self.tangential * u),
            (true, false) => return state.tangential_reaction,
            (false, _) => (self.trial(state), state.friction_bound()),
        };
        let distance = length(trial);
        if distance <= radius {
            // The projection does nothing; ρ u without the detour keeps its digits.
            return state.slip.map(|u| self.tangential * u);
        }
        let [t_1, t_2] = state.tangential_reaction;
        let shrink = radius / distance;
        let held = state.law.unrounded(trial.map(|t| shrink * t));
        [t_1 - held[0], t_2 - held[1]]
    }

    /// `t_T − ρ_T u_T`, in newton, where the set is a disc.
    fn trial(&self, state: &ContactState) -> [f64; 2] {
        let [t_1, t_2] = state.law.rounded(state.tangential_reaction);
        let [u_1, u_2] = state.law.squeezed(state.slip);
        [t_1 - self.tangential * u_1, t_2 - self.tangential * u_2]
    }
}

/// `‖v‖₂`, by way of the largest entry: squares of forces may overflow or vanish.
pub(super) fn norm(values: &[f64]) -> f64 {
    let largest = largest(values);
    if largest == 0.0 || largest.is_infinite() {
        return largest;
    }
    let squares = values.iter().map(|v| (v / largest) * (v / largest));
    largest * squares.sum::<f64>().sqrt()
}

/// Largest `‖v_i‖` over the contacts' blocks, which the choice of tangents does not change.
pub(super) fn largest_block(offsets: &[usize], values: &[f64]) -> f64 {
    let blocks = offsets.windows(2).map(|ends| &values[ends[0]..ends[1]]);
    blocks.map(norm).fold(0.0, f64::max)
}

/// `‖v‖_∞`; infinite if an entry is NaN, which `max` would hide.
pub(super) fn largest(values: &[f64]) -> f64 {
    if values.iter().any(|v| v.is_nan()) {
        return f64::INFINITY;
    }
    values.iter().fold(0.0, |most, v| v.abs().max(most))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kkt::law::JudgedLaw;

    const STEP: Step = Step {
        normal: 10.0,
        tangential: 2.0,
    };

    // Radius of the disc: −0.5 · (−10) = 5 N.
    const PRESSED: ContactState = ContactState {
        friction: 0.5,
        normal_reaction: -10.0,
        tangential_reaction: [0.0; 2],
        overlap: 0.0,
        slip: [0.0; 2],
        law: JudgedLaw::COULOMB,
    };

    #[test]
    fn states_on_all_laws_have_no_residual() {
        let open = ContactState {
            normal_reaction: 0.0,
            overlap: -3.0,
            slip: [7.0, 0.0],
            ..PRESSED
        };
        let stick = ContactState {
            tangential_reaction: [3.0, 4.0],
            ..PRESSED
        };
        let slip = ContactState {
            slip: [-0.6, -0.8],
            ..stick
        };
        for (state, status) in [
            (open, ContactStatus::Open),
            (stick, ContactStatus::Stick),
            (slip, ContactStatus::Slip),
        ] {
            // Slip: trial = (3, 4) + 2 · (0.6, 0.8) = (4.2, 5.6), brought back to (3, 4).
            assert!(norm(&STEP.residual(&state)) < 1e-15, "{status:?}");
            assert_eq!(STEP.status(&state), status);
        }
    }

    #[test]
    fn penetration_costs_the_force_that_pushes_it_out() {
        let state = ContactState {
            overlap: 0.5,
            ..PRESSED
        };
        assert_eq!(STEP.residual(&state), [5.0, 0.0, 0.0]);
    }

    #[test]
    fn a_pressure_across_a_gap_costs_the_smaller_of_reaction_and_closing_force() {
        let near = ContactState {
            overlap: -0.25,
            ..PRESSED
        };
        let far = ContactState {
            overlap: -8.0,
            ..PRESSED
        };
        assert_eq!(STEP.residual(&near), [-2.5, 0.0, 0.0]);
        assert_eq!(STEP.residual(&far), [-10.0, 0.0, 0.0]);
        assert_eq!(STEP.status(&near), ContactStatus::Stick);
        assert_eq!(STEP.status(&far), ContactStatus::Open);
    }

    #[test]
    fn slip_inside_the_disc_costs_the_force_that_stops_it() {
        let state = ContactState {
            slip: [1.0, 2.0],
            ..PRESSED
        };
        assert_eq!(STEP.residual(&state), [0.0, 2.0, 4.0]);
    }

    #[test]
    fn a_reaction_outside_the_disc_costs_its_excess() {
        // (6, 8) is brought back to (3, 4).
        let state = ContactState {
            tangential_reaction: [6.0, 8.0],
            ..PRESSED
        };
        assert_eq!(STEP.residual(&state), [0.0, 3.0, 4.0]);
    }

    #[test]
    fn stick_on_the_edge_of_the_disc_is_stick_under_round_off() {
        let state = ContactState {
            tangential_reaction: [3.0, 4.0 + 1e-12],
            ..PRESSED
        };
        assert_eq!(STEP.status(&state), ContactStatus::Stick);
    }

    #[test]
    fn pressed_without_friction_slides_freely_and_without_tangents_with_friction_is_held() {
        let smooth = ContactState {
            friction: 0.0,
            ..PRESSED
        };
        assert_eq!(STEP.status(&smooth), ContactStatus::Slip);
        assert_eq!(STEP.residual(&smooth), [0.0, 0.0, 0.0]);
        assert_eq!(STEP.status(&PRESSED), ContactStatus::Stick);
    }

    #[test]
    fn a_nan_anywhere_gives_an_infinite_norm() {
        let states = [
            ContactState {
                normal_reaction: f64::NAN,
                ..PRESSED
            },
            ContactState {
                overlap: f64::NAN,
                ..PRESSED
            },
            ContactState {
                tangential_reaction: [f64::NAN, 0.0],
                ..PRESSED
            },
            ContactState {
                slip: [0.0, f64::NAN],
                ..PRESSED
            },
        ];
        for state in states {
            assert_eq!(norm(&STEP.residual(&state)), f64::INFINITY, "{state:?}");
        }
    }

    #[test]
    fn the_norm_survives_the_square_of_its_entries() {
        assert!((norm(&[3e200, 4e200]) / 5e200 - 1.0).abs() < 1e-15);
        assert!((norm(&[3e-200, 4e-200]) / 5e-200 - 1.0).abs() < 1e-15);
        assert_eq!(norm(&[]), 0.0);
    }
}
