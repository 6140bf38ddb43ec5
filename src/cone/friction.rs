//! The friction half-step (H2): friction with normal reactions held.
//!
//! Other laws of contact (problem::L5) have other radii; a contact that sticks has none, and no cone.

use super::reduced::{Half, HalfStepWork, Role, WorkingSet};
use crate::problem::ContactProblem;

/// A disc this much smaller than the largest is a point: its reaction is zero.
const POINT: f64 = 1e-12;

/// A contact without a cone may leave its disc by this many tolerances of the program.
const SLACK: f64 = 30.0;

/// A contact whose friction exceeds this part of its bound is near its disc.
const NEAR: f64 = 0.8;

/// (H2) for one problem.
///
/// ```text
/// min ½ s_T·G_TT s_T + s_T·(û_T + G_TN t_N)    s.t.  ‖s_T,i‖ ≤ −μ_i t_N,i
/// ```
pub struct FrictionHalfStep<'a> {
    problem: &'a ContactProblem,
    set: WorkingSet<'a>,
}

impl<'a> FrictionHalfStep<'a> {
    /// The half-step of `problem`.
    #[must_use]
    pub fn new(problem: &'a ContactProblem) -> Self {
        Self {
            problem,
            set: WorkingSet::new(problem, Half::Tangential),
        }
    }

    /// Gives up what is kept of the last program for the next one.
    pub(crate) fn forget(&mut self) {
        self.set.forget();
    }

    /// Replaces the tangential part of `reaction` by the minimiser of (H2).
    ///
    /// `roles` is the prediction, one entry per contact; a contact whose disc is a
    /// point comes back as [`Role::Absent`], one that breaks its prediction as
    /// [`Role::Cone`]. `None` if the cone solver gives up.
    pub fn solve(
        &mut self,
        reaction: &mut [f64],
        roles: &mut [Role],
        tolerance: f64,
    ) -> Option<HalfStepWork> {
        let bounds = self.friction_bounds(reaction);
        self.drop_points(&bounds, roles);
        for contact in 0..self.problem.contacts() {
            reaction[self.set.unknowns(contact)].fill(0.0);
        }
        let mut work = HalfStepWork::default();
        if roles.iter().all(|&role| role == Role::Absent) {
            return Some(work);
        }
        let linear = self.problem.displacement(reaction);
        loop {
            let x = self
                .set
                .minimise(&linear, &bounds, roles, tolerance, &mut work)?;
            if self.give_back(&x, &bounds, roles, tolerance) {
                continue;
            }
            for (contact, &bound) in bounds.iter().enumerate() {
                let tangents = self.set.unknowns(contact);
                let size = norm(&x[tangents.clone()]);
                // The program, or a broken prediction, may leave the disc by its tolerance.
                let shrink = if size > bound { bound / size } else { 1.0 };
                for unknown in tangents {
                    reaction[unknown] = shrink * x[unknown];
                }
            }
            return Some(work);
        }
    }

    /// If a contact without a cone left its disc, all that are near their discs get
    /// their cones: leaving one at a time would cost a program each.
    fn give_back(&self, x: &[f64], bounds: &[f64], roles: &mut [Role], tolerance: f64) -> bool {
        let size = |contact: usize| norm(&x[self.set.unknowns(contact)]);
        let free: Vec<usize> = (0..roles.len())
            .filter(|&i| roles[i] == Role::Free)
            .collect();
        let allowed = 1.0 + SLACK * tolerance;
        if free
            .iter()
            .all(|&contact| size(contact) <= allowed * bounds[contact])
        {
            return false;
        }
        for contact in free {
            if size(contact) > NEAR * bounds[contact] {
                roles[contact] = Role::Cone;
            }
        }
        true
    }

    /// `−μ t_N` per contact, or that of its law, in newton.
    fn friction_bounds(&self, reaction: &[f64]) -> Vec<f64> {
        let normals = self.problem.normals().iter().enumerate();
        normals
            .map(|(contact, &n)| self.problem.friction_bound(contact, reaction[n]))
            .collect()
    }

    fn drop_points(&self, bounds: &[f64], roles: &mut [Role]) {
        let finite = bounds.iter().filter(|bound| bound.is_finite());
        let largest = finite.fold(0.0_f64, |largest, &bound| largest.max(bound));
        for (contact, role) in roles.iter_mut().enumerate() {
            if bounds[contact].is_infinite() && !self.set.unknowns(contact).is_empty() {
                *role = Role::Free;
            } else if bounds[contact] <= POINT * largest || self.set.unknowns(contact).is_empty() {
                *role = Role::Absent;
            } else if *role == Role::Absent {
                *role = Role::Cone;
            }
        }
    }
}

fn norm(vector: &[f64]) -> f64 {
    vector.iter().fold(0.0_f64, |length, x| length.hypot(*x))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::problem::Operator;
    use faer::Mat;

    /// Three uncoupled contacts in 3D, G = 1, μ = 1/4, with t_N = −10, −10, 0: discs of 2.5, 2.5 and a point.
    fn solve(free: [[f64; 2]; 3], roles: &mut [Role], tolerance: f64) -> (Vec<f64>, HalfStepWork) {
        let operator = Operator::from_compliance(Mat::identity(9, 9)).unwrap();
        let free = free.iter().flat_map(|[x, y]| [0.0, *x, *y]).collect();
        let problem =
            ContactProblem::new(&[2; 3], vec![0.25; 3], vec![0.0; 3], free, operator).unwrap();
        let mut reaction = vec![-10.0, 0.0, 0.0, -10.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        let work = FrictionHalfStep::new(&problem)
            .solve(&mut reaction, roles, tolerance)
            .unwrap();
        (reaction, work)
    }

    /// The first slips with t_T = −2.5 · (0.6, 0.8), the second sticks with t_T = −û_T, the third has none.
    fn slip_and_stick(roles: &mut [Role]) -> (Vec<f64>, HalfStepWork) {
        let (reaction, work) = solve([[3.0, 4.0], [0.1, 0.0], [1.0, 0.0]], roles, 1e-10);
        let expected = [-10.0, -1.5, -2.0, -10.0, -0.1, 0.0, 0.0, 0.0, 0.0];
        let error = reaction
            .iter()
            .zip(expected)
            .map(|(t, e)| (t - e).abs())
            .fold(0.0, f64::max);
        // A gap of 1e-10 leaves 1e-5 at worst, and less where no contact is on the brink.
        assert!(error < 1e-6, "{reaction:?}");
        (reaction, work)
    }

    #[test]
    fn slip_stick_and_an_open_contact_come_out_of_the_full_program() {
        let mut roles = [Role::Cone; 3];
        let (_, work) = slip_and_stick(&mut roles);
        assert_eq!((work.programs, work.cones, roles[2]), (1, 2, Role::Absent));
    }

    #[test]
    fn a_stuck_contact_needs_no_cone() {
        let (reaction, work) = slip_and_stick(&mut [Role::Cone, Role::Free, Role::Cone]);
        assert_eq!((reaction[4], work.cones), (-0.1, 1));
    }

    #[test]
    fn a_contact_wrongly_taken_as_stuck_gets_its_disc_back() {
        let mut roles = [Role::Free, Role::Free, Role::Absent];
        let (_, work) = slip_and_stick(&mut roles);
        assert_eq!(
            (work.cones, roles),
            (1, [Role::Cone, Role::Free, Role::Absent])
        );
    }

    #[test]
    fn an_inexact_half_step_lets_pass_what_its_program_would_not_see() {
        // 2.55 wanted in a disc of 2.5: 2 % out, within 30 tolerances of 1e-3 but not of 1e-4.
        let stuck = [Role::Free, Role::Free, Role::Absent];
        let free = [[2.55, 0.0], [0.1, 0.0], [0.0, 0.0]];
        let mut roles = stuck;
        let (reaction, work) = solve(free, &mut roles, 1e-3);
        assert_eq!((work.programs, roles), (0, stuck));
        assert!(
            (reaction[1] + 2.5).abs() < 1e-12,
            "back on its disc: {reaction:?}"
        );
        let (_, work) = solve(free, &mut roles, 1e-4);
        assert_eq!((work.programs, roles[0]), (1, Role::Cone));
    }

    #[test]
    fn who_is_near_its_disc_gets_a_cone_together_with_who_left_it() {
        // 2.25 of 2.5 is more than four fifths, 1.5 is not.
        for (second, role) in [(2.25, Role::Cone), (1.5, Role::Free)] {
            let mut roles = [Role::Free, Role::Free, Role::Absent];
            solve([[3.0, 0.0], [second, 0.0], [0.0, 0.0]], &mut roles, 1e-8);
            assert_eq!(roles, [Role::Cone, role, Role::Absent]);
        }
    }
}
