//! The normal half-step (H1): normal reactions with friction held. Bilateral contacts have no bound.

use super::reduced::{Half, HalfStepWork, Role, WorkingSet};
use crate::problem::ContactProblem;

/// (H1) for one problem.
///
/// ```text
/// min ½ s_N·G_NN s_N + s_N·(û_N + G_NT t_T − g₀)    s.t.  s_N ≤ 0
/// s_N ≤ 0,   gap = g₀ − u_N ≥ 0,   s_N · gap = 0
/// ```
pub struct NormalHalfStep<'a> {
    problem: &'a ContactProblem,
    set: WorkingSet<'a>,
}

impl<'a> NormalHalfStep<'a> {
    /// The half-step of `problem`.
    #[must_use]
    pub fn new(problem: &'a ContactProblem) -> Self {
        Self {
            problem,
            set: WorkingSet::new(problem, Half::Normal),
        }
    }

    /// Gives up what is kept of the last program for the next one.
    pub(crate) fn forget(&mut self) {
        self.set.forget();
    }

    /// Replaces the normal part of `reaction` by the minimiser of (H1).
    ///
    /// `roles` is the prediction, one entry per contact; contacts that break it come
    /// back as [`Role::Cone`], and all where it is broken twice. `None` if the cone solver gives up.
    pub fn solve(
        &mut self,
        reaction: &mut [f64],
        roles: &mut [Role],
        tolerance: f64,
    ) -> Option<HalfStepWork> {
        let normals = self.problem.normals();
        for &n in normals {
            reaction[n] = 0.0;
        }
        for (contact, role) in roles.iter_mut().enumerate() {
            if self.problem.is_bilateral(contact) {
                *role = Role::Free;
            }
        }
        let mut linear = self.problem.displacement(reaction);
        for (&n, g0) in normals.iter().zip(self.problem.initial_gap()) {
            linear[n] -= g0;
        }
        let scale = normals
            .iter()
            .fold(0.0_f64, |largest, &n| largest.max(linear[n].abs()));
        let (mut work, mut again) = (HalfStepWork::default(), false);
        loop {
            let x = self
                .set
                .minimise(&linear, &[], roles, tolerance, &mut work)?;
            for &n in normals {
                reaction[n] = x[n];
            }
            let broken = self.broken(reaction, roles, tolerance * scale);
            if broken.is_empty() {
                break;
            }
            match again {
                // One after the other they would cost a program each, by the hundred where bodies bend.
                true => roles.fill(Role::Cone),
                false => broken.into_iter().for_each(|k| roles[k] = Role::Cone),
            }
            again = true;
        }
        self.admit(reaction);
        Some(work)
    }

    /// Contacts without a cone that press the wrong way, or overlap by more than `slack` in metre.
    fn broken(&self, reaction: &[f64], roles: &[Role], slack: f64) -> Vec<usize> {
        let displacement = self.problem.displacement(reaction);
        let normals = self.problem.normals();
        let breaks = |&contact: &usize| match roles[contact] {
            Role::Absent => self.problem.gap(contact, &displacement) < -slack,
            Role::Free => reaction[normals[contact]] > 0.0 && !self.problem.is_bilateral(contact),
            Role::Cone => false,
        };
        (0..roles.len()).filter(breaks).collect()
    }

    /// The nearest normal reactions that contacts can have.
    pub(crate) fn admit(&self, reaction: &mut [f64]) {
        for (contact, &n) in self.problem.normals().iter().enumerate() {
            if !self.problem.is_bilateral(contact) {
                reaction[n] = reaction[n].min(0.0);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::problem::Operator;
    use faer::mat;

    /// G = [[2, 1], [1, 2]], û = (1, −3), g₀ = 0: contact 0 is pressed with t = −1/2,
    /// contact 1 is open with u = −3.5.
    fn problem() -> ContactProblem {
        let operator = Operator::from_compliance(mat![[2.0, 1.0], [1.0, 2.0]]).unwrap();
        ContactProblem::new(
            &[0, 0],
            vec![0.0; 2],
            vec![0.0; 2],
            vec![1.0, -3.0],
            operator,
        )
        .unwrap()
    }

    /// A gap of 1e-10 leaves 1e-5 at worst, and less where no contact is on the brink.
    #[test]
    fn a_pressed_and_an_open_contact_come_out_of_the_full_program() {
        let problem = problem();
        let mut reaction = vec![0.0; 2];
        let mut roles = [Role::Cone; 2];
        let work = NormalHalfStep::new(&problem)
            .solve(&mut reaction, &mut roles, 1e-10)
            .unwrap();
        assert!(
            (reaction[0] + 0.5).abs() < 1e-6 && reaction[1].abs() < 1e-6,
            "{reaction:?}"
        );
        assert_eq!((work.programs, work.cones), (1, 2));
    }

    #[test]
    fn a_right_prediction_needs_no_program() {
        let problem = problem();
        let mut reaction = vec![0.0; 2];
        let mut roles = [Role::Free, Role::Absent];
        let work = NormalHalfStep::new(&problem)
            .solve(&mut reaction, &mut roles, 1e-10)
            .unwrap();
        assert!(
            (reaction[0] + 0.5).abs() < 1e-15 && reaction[1] == 0.0,
            "{reaction:?}"
        );
        assert_eq!(work, HalfStepWork::default());
    }

    #[test]
    fn a_wrong_prediction_gets_its_cones_back() {
        let problem = problem();
        let mut reaction = vec![0.0; 2];
        let mut roles = [Role::Absent, Role::Free];
        let work = NormalHalfStep::new(&problem)
            .solve(&mut reaction, &mut roles, 1e-10)
            .unwrap();
        assert!(
            (reaction[0] + 0.5).abs() < 1e-6 && reaction[1].abs() < 1e-6,
            "{reaction:?}"
        );
        assert!(work.programs >= 1 && roles == [Role::Cone; 2]);
    }

    #[test]
    fn where_bodies_bend_a_prediction_that_is_wrong_twice_is_given_up() {
        // A cantilever s = 1/24 … 1 pushed by sin 7s: G_ij = a² (3b − a)/6 with a ≤ b the places, and a little of each
        // contact's own. Who is taken as pressed pulls; let go by and by, contacts would take seven programs:
        // with 11, 14, 16, … cones.
        let places: Vec<f64> = (1..=24).map(|k| f64::from(k) / 24.0).collect();
        let operator = Operator::from_compliance(faer::Mat::from_fn(24, 24, |i, j| {
            let (a, b) = (places[i.min(j)], places[i.max(j)]);
            a * a * (3.0 * b - a) / 6.0 + if i == j { 1e-4 } else { 0.0 }
        }));
        let free = places.iter().map(|s| (7.0 * s).sin()).collect();
        let zero = vec![0.0; 24];
        let problem =
            ContactProblem::new(&[0; 24], zero.clone(), zero, free, operator.unwrap()).unwrap();
        let (mut reaction, mut roles) = (vec![0.0; 24], [Role::Free; 24]);
        let work = NormalHalfStep::new(&problem)
            .solve(&mut reaction, &mut roles, 1e-10)
            .unwrap();
        assert_eq!((work.programs, roles), (2, [Role::Cone; 24]));
        // Of the order of the gap of the program, with displacements of one.
        let overlap = problem.displacement(&reaction).into_iter();
        assert!(overlap.fold(0.0, f64::max) < 1e-6, "{reaction:?}");
    }
}
