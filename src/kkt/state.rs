//! One contact as the laws see it: its reaction and displacement, normal apart from tangent.

use super::law::JudgedLaw;
use crate::problem::ContactProblem;

/// State of one contact; unused tangents are zero.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct ContactState {
    /// Coefficient `μ ≥ 0`.
    pub(super) friction: f64,
    /// `t_N`, in newton.
    pub(super) normal_reaction: f64,
    /// `t_T`, in newton.
    pub(super) tangential_reaction: [f64; 2],
    /// `u_N − g₀`, minus the gap, in metre.
    pub(super) overlap: f64,
    /// `u_T`, in metre.
    pub(super) slip: [f64; 2],
    /// What it obeys beside Coulomb's law.
    pub(super) law: JudgedLaw,
}

impl ContactState {
    /// Radius of the friction disc, `−μ min(t_N, 0)` or that of (L5), in newton.
    pub(super) fn friction_bound(&self) -> f64 {
        self.law.radius(self.friction, self.normal_reaction)
    }

    /// Whether it is in contact, as its reaction says: what sticks while it is pressed does so here.
    pub(super) fn is_pressed(&self) -> bool {
        self.law.is_bilateral() || self.normal_reaction < self.law.tension()
    }

    /// `t_T · u_T`, in joule.
    pub(super) fn friction_work(&self) -> f64 {
        let ([t_1, t_2], [u_1, u_2]) = (self.tangential_reaction, self.slip);
        t_1 * u_1 + t_2 * u_2
    }
}

/// `‖v‖` in the tangent plane.
pub(super) fn length([v_1, v_2]: [f64; 2]) -> f64 {
    v_1.hypot(v_2)
}

/// Cuts reactions, and displacements beyond the gaps, into the states of the contacts.
pub(super) fn contact_states(
    problem: &ContactProblem,
    reaction: &[f64],
    beyond: &[f64],
) -> Vec<ContactState> {
    let blocks = problem.offsets().windows(2);
    let laws = problem.laws();
    blocks
        .zip(problem.friction())
        .enumerate()
        .map(|(contact, (ends, &friction))| {
            let (t, u) = (&reaction[ends[0]..ends[1]], &beyond[ends[0]..ends[1]]);
            ContactState {
                friction,
                normal_reaction: t[0],
                tangential_reaction: tangents(t),
                overlap: u[0],
                slip: tangents(u),
                law: JudgedLaw::new(laws.map(|laws| &laws[contact])),
            }
        })
        .collect()
}

/// The tangential entries of a block, padded with zeros.
fn tangents(block: &[f64]) -> [f64; 2] {
    let entry = |k: usize| block.get(k).copied().unwrap_or(0.0);
    [entry(1), entry(2)]
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use faer::Mat;

    use super::*;
    use crate::problem::Operator;

    #[test]
    fn blocks_of_one_two_and_three_unknowns_are_cut_normal_first() {
        let operator = Operator::from_compliance(Mat::identity(6, 6)).unwrap();
        let (friction, gaps) = (vec![0.0, 0.3, 0.5], vec![1.0, 2.0, 3.0]);
        let problem =
            ContactProblem::new(&[0, 1, 2], friction, gaps, vec![0.0; 6], operator).unwrap();
        let reaction = [-1.0, -2.0, 20.0, -3.0, 30.0, 31.0];
        let beyond = [0.1, 0.2, 2.0, 0.3, 3.0, 3.1];
        let states = contact_states(&problem, &reaction, &beyond);
        assert_eq!(states[0].tangential_reaction, [0.0, 0.0]);
        assert_eq!(states[1].slip, [2.0, 0.0]);
        let last = ContactState {
            friction: 0.5,
            normal_reaction: -3.0,
            tangential_reaction: [30.0, 31.0],
            overlap: 0.3,
            slip: [3.0, 3.1],
            law: JudgedLaw::COULOMB,
        };
        assert_eq!(states[2], last);
    }

    #[test]
    fn a_pulled_contact_has_an_empty_friction_disc() {
        let pressed = ContactState {
            friction: 0.5,
            normal_reaction: -4.0,
            ..Default::default()
        };
        let pulled = ContactState {
            normal_reaction: 4.0,
            ..pressed
        };
        assert_eq!(
            (pressed.friction_bound(), pulled.friction_bound()),
            (2.0, 0.0)
        );
    }
}
