//! Which contacts need a cone: the working sets of the next half-steps.

use crate::cone::Role;
use crate::problem::ContactProblem;

/// A contact pressed in, or open, by more than this part of the mean indentation is
/// taken as decided.
const DECIDED: f64 = 0.25;

/// A contact whose friction stays below this part of its bound is taken as stuck.
const STUCK: f64 = 0.8;

/// Roles of every contact in the two half-steps.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Roles {
    pub(super) normal: Vec<Role>,
    pub(super) friction: Vec<Role>,
}

impl Roles {
    /// Every contact has its cone.
    pub(super) fn full(contacts: usize) -> Self {
        Self {
            normal: vec![Role::Cone; contacts],
            friction: vec![Role::Cone; contacts],
        }
    }

    /// Roles that a state suggests.
    ///
    /// The indentation `−G_NN t_N` of a pressed contact and the gap of an open one are
    /// lengths; both are compared with the mean indentation. In each half-step the
    /// least decided contact keeps its cone.
    pub(super) fn predict(
        problem: &ContactProblem,
        reaction: &[f64],
        displacement: &[f64],
    ) -> Self {
        let margins: Vec<f64> = (0..problem.contacts())
            .map(|contact| {
                let n = problem.offsets()[contact];
                if problem.is_bilateral(contact) {
                    f64::INFINITY
                } else if reaction[n] < 0.0 {
                    -problem.compliance()[(n, n)] * reaction[n]
                } else {
                    displacement[n] - problem.initial_gap()[contact]
                }
            })
            .collect();
        let pressed: Vec<f64> = margins
            .iter()
            .copied()
            .filter(|&margin| margin > 0.0 && margin.is_finite())
            .collect();
        let mean = pressed.iter().sum::<f64>() / pressed.len().max(1) as f64;
        let mut normal: Vec<Role> = margins
            .iter()
            .map(|&margin| match margin {
                m if m > DECIDED * mean => Role::Free,
                m if m < -DECIDED * mean => Role::Absent,
                _ => Role::Cone,
            })
            .collect();
        keep_least(&mut normal, |contact| margins[contact].abs());

        let ratios: Vec<f64> = (0..problem.contacts())
            .map(|contact| friction_ratio(problem, reaction, contact))
            .collect();
        let mut friction: Vec<Role> = (0..problem.contacts())
            .map(|contact| match normal[contact] {
                Role::Absent => Role::Absent,
                Role::Free if ratios[contact] < STUCK => Role::Free,
                _ => Role::Cone,
            })
            .collect();
        keep_least(&mut friction, |contact| -ratios[contact]);
        Self { normal, friction }
    }
}

/// `‖t_T‖ / (−μ t_N)`; 1 where the bound is zero, and less than any where there is none.
fn friction_ratio(problem: &ContactProblem, reaction: &[f64], contact: usize) -> f64 {
    let (n, end) = (problem.offsets()[contact], problem.offsets()[contact + 1]);
    let bound = problem.friction_bound(contact, reaction[n]);
    if bound.is_infinite() {
        return f64::NEG_INFINITY;
    }
    let size = reaction[n + 1..end]
        .iter()
        .fold(0.0_f64, |size, t| size.hypot(*t));
    if bound > 0.0 { size / bound } else { 1.0 }
}

/// Where no contact has a cone, the one of least `margin` gets it.
fn keep_least(roles: &mut [Role], margin: impl Fn(usize) -> f64) {
    if roles.contains(&Role::Cone) {
        return;
    }
    let candidates = (0..roles.len())
        .filter(|&contact| roles[contact] == Role::Free && margin(contact).is_finite());
    if let Some(least) = candidates.min_by(|&a, &b| margin(a).total_cmp(&margin(b))) {
        roles[least] = Role::Cone;
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use faer::Mat;

    use super::*;
    use crate::problem::Operator;

    #[test]
    fn contacts_are_decided_by_their_indentation_and_their_friction() {
        // Pressed by 4 with little friction, pressed by 4 on its disc, open by 4, and just touching.
        let operator = Operator::from_compliance(Mat::identity(8, 8)).unwrap();
        let zero = vec![0.0; 8];
        let problem =
            ContactProblem::new(&[1; 4], vec![0.5; 4], vec![0.0; 4], zero, operator).unwrap();
        let reaction = [-4.0, 0.2, -4.0, 2.0, 0.0, 0.0, -0.1, 0.0];
        let displacement = [0.0, 0.0, 0.0, 0.0, -4.0, 0.0, 0.0, 0.0];
        let found = Roles::predict(&problem, &reaction, &displacement);
        assert_eq!(
            found.normal,
            [Role::Free, Role::Free, Role::Absent, Role::Cone]
        );
        assert_eq!(
            found.friction,
            [Role::Free, Role::Cone, Role::Absent, Role::Cone]
        );
    }

    #[test]
    fn where_all_are_decided_the_least_decided_contact_keeps_its_cone() {
        // Smooth: pressed by 4 and by 5.
        let operator = Operator::from_compliance(Mat::identity(2, 2)).unwrap();
        let zero = vec![0.0; 2];
        let problem =
            ContactProblem::new(&[0, 0], zero.clone(), zero.clone(), zero, operator).unwrap();
        let found = Roles::predict(&problem, &[-4.0, -5.0], &[0.0; 2]);
        assert_eq!(found.normal, [Role::Cone, Role::Free]);
    }
}
