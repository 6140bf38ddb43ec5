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

    /// Replaces the normal part of `reaction` by the minimiser of (H1).
    ///
    /// `roles` is the prediction, one entry per contact; contacts that break it come
    /// back as [`Role::Cone`]. `None` if the cone solver gives up.
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
        let mut work = HalfStepWork::default();
        loop {
            let x = self
                .set
                .minimise(&linear, &[], roles, tolerance, &mut work)?;
            for &n in normals {
                reaction[n] = x[n];
            }
            let displacement = self.problem.displacement(reaction);
            let mut kept = true;
            for (contact, &n) in normals.iter().enumerate() {
                let gap = self.problem.gap(contact, &displacement);
                let broken = match roles[contact] {
                    Role::Absent => gap < -tolerance * scale,
                    Role::Free => x[n] > 0.0 && !self.problem.is_bilateral(contact),
                    Role::Cone => false,
                };
                if broken {
                    roles[contact] = Role::Cone;
                    kept = false;
                }
            }
            if kept {
                break;
            }
        }
        self.admit(reaction);
        Some(work)
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
}
