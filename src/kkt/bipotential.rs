//! The bipotential gap: one energy that vanishes only where all three laws hold.
//!
//! ```text
//! (K3)  η = Σ [ t_N (u_N − g₀) + t_T · u_T − μ t_N ‖u_T‖ ]
//! ```
//!
//! Under other laws (L4), (L5) the sets' support functions stand for the terms of Coulomb's.
//! For admissible reactions and no penetration every term is non-negative: the first
//! is (L1)'s work across open gaps, the others are (L3)'s defect. For a given friction
//! bound η is a duality gap, and √η bounds the distance `‖t − t*‖_G` to the solution.
//! Form: de Saxcé & Feng, Math. Comput. Modelling 28 (1998) 225–245.

use super::certificate::infinite_if_nan;
use super::law::JudgedLaw;
use super::state::{ContactState, length};

/// η of (K3), in joule; negative only where reactions or displacements are inadmissible.
pub(super) fn bipotential_gap(states: &[ContactState]) -> f64 {
    let terms = states.iter().map(|state| {
        if state.law == JudgedLaw::COULOMB {
            let t_n = state.normal_reaction;
            let friction = state.friction * t_n * length(state.slip);
            return t_n * state.overlap + state.friction_work() - friction;
        }
        let t_n = state.normal_reaction - state.law.tension();
        let bound = state.law.dissipation(state.friction_bound(), state.slip);
        t_n * state.overlap + state.friction_work() + bound
    });
    infinite_if_nan(terms.sum())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_gap_is_the_sum_of_both_defects() {
        let across_a_gap = ContactState {
            normal_reaction: -4.0,
            overlap: -0.5,
            ..Default::default()
        };
        let slip_inside_the_disc = ContactState {
            friction: 0.5,
            normal_reaction: -10.0,
            tangential_reaction: [-1.0, 0.0],
            overlap: 0.0,
            slip: [2.0, 0.0],
            law: JudgedLaw::COULOMB,
        };
        // −4 · (−0.5) = 2 J, and (−1) · 2 + 0.5 · 10 · 2 = 8 J.
        assert_eq!(bipotential_gap(&[across_a_gap, slip_inside_the_disc]), 10.0);
    }

    #[test]
    fn a_state_on_all_laws_has_no_gap_and_a_nan_an_infinite_one() {
        let slip = ContactState {
            friction: 0.5,
            normal_reaction: -10.0,
            tangential_reaction: [-3.0, -4.0],
            overlap: 0.0,
            slip: [0.75, 1.0],
            law: JudgedLaw::COULOMB,
        };
        assert_eq!(bipotential_gap(&[slip]), 0.0);
        let broken = ContactState {
            overlap: f64::NAN,
            ..slip
        };
        assert_eq!(bipotential_gap(&[slip, broken]), f64::INFINITY);
    }
}
