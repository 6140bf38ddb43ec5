//! Penalty, and the augmented Lagrangian around it: contacts as springs that press and rub where they give way.
//!
//! ```text
//! (M6)  penalty     t_N = −ε ⟨u_N − g₀⟩₊,   t_T = P_disc(−ε u_T)          ⇔  the laws with G + 1/ε in place of G
//! (M7)  augmented   t ← laws with G + 1/ε and û − λ/ε,   λ ← t            Uzawa's iteration on the multipliers
//! ```
//!
//! ε is a multiple of each contact's own stiffness 1/G_kk, so that it has no unit. Both are solved here by
//! the crate's own loop on a condensed operator, which is the best case for them: a code that has springs in the
//! stiffness of its bodies factorises that anew in every Newton step. Wriggers, Computational Contact Mechanics
//! (2006), ch. 5 and 6; Simo, Laursen, Comput. Struct. 42 (1992) 97–116.

use super::variant::Run;
use crate::alternation::{Outcome, Settings, solve, solve_from};
use crate::error::Error;
use crate::problem::{ContactProblem, Operator};

impl Run<'_> {
    /// (M6), once: another pass gives the same.
    pub(super) fn penalty(&mut self, parameter: f64) -> Result<(), Error> {
        let (softened, _) = softened(self.problem, parameter)?;
        let found = solve(&softened, &self.inner())?;
        self.take(found);
        self.given_up = !self.is_solved();
        Ok(())
    }

    /// One pass of (M7).
    pub(super) fn augmented(&mut self, parameter: f64) -> Result<(), Error> {
        let (softened, spring) = match self.softened.take() {
            Some(known) => known,
            None => softened(self.problem, parameter)?,
        };
        let multipliers = self.reaction.iter().zip(&spring);
        let free = self.problem.free_displacement().iter().zip(multipliers);
        let free = free.map(|(u, (t, spring))| u - t * spring).collect();
        let at = softened.step(free, vec![0.0; self.problem.unknowns()])?;
        let found = solve_from(&at, &self.inner(), &self.reaction, &[])?;
        self.softened = Some((softened, spring));
        self.take(found);
        Ok(())
    }

    fn inner(&self) -> Settings {
        Settings {
            max_sweeps: Settings::default().max_sweeps,
            ..*self.settings
        }
    }

    pub(super) fn take(&mut self, found: Outcome) {
        self.record.newton_steps = found.work.newton_steps;
        self.work.newton_steps += found.work.newton_steps;
        self.work.cone_iterations += found.work.cone_iterations;
        self.reaction = found.reaction;
        self.measure();
    }
}

/// The problem with a spring in front of every contact, and its compliance 1/ε per unknown, in m/N.
fn softened(problem: &ContactProblem, parameter: f64) -> Result<(ContactProblem, Vec<f64>), Error> {
    let spring = springs(problem, parameter);
    let mut compliance = problem.compliance().clone();
    for (k, spring) in spring.iter().enumerate() {
        compliance[(k, k)] += spring;
    }
    let operator = Operator::from_bodies(compliance)?;
    Ok((problem.with_operator(operator), spring))
}

/// 1/ε of springs that are so many times as stiff as their contact, in m/N per unknown.
pub(super) fn springs(problem: &ContactProblem, parameter: f64) -> Vec<f64> {
    let own = problem.compliance();
    let mut spring = vec![0.0; problem.unknowns()];
    for block in problem.blocks() {
        let tangents = block.start + 1..block.end;
        let trace: f64 = tangents.clone().map(|k| own[(k, k)]).sum();
        spring[block.start] = own[(block.start, block.start)] / parameter;
        // The same in all directions, so that friction opposes slip.
        spring[tangents.clone()].fill(trace / tangents.len().max(1) as f64 / parameter);
    }
    spring
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use faer::mat;

    use super::super::Variant;
    use super::*;
    use crate::alternation::Status;

    /// G = 1, û = (2, 3), μ = ½: t = (−2, −1).
    fn contact() -> ContactProblem {
        let operator = Operator::from_compliance(mat![[1.0, 0.0], [0.0, 1.0]]).unwrap();
        ContactProblem::new(&[1], vec![0.5], vec![0.0], vec![2.0, 3.0], operator).unwrap()
    }

    #[test]
    fn springs_of_ten_times_the_stiffness_miss_an_eleventh() {
        let found = Variant::Penalty(10.0)
            .solve(&contact(), &Settings::default())
            .unwrap();
        assert_eq!(found.status, Status::NotConverged);
        // (1 + 1/10) t_N + 2 = 0.
        assert!((found.reaction[0] + 2.0 / 1.1).abs() < 1e-12, "{found:?}");
        assert!((found.reaction[1] + 1.0 / 1.1).abs() < 1e-12, "{found:?}");
    }

    #[test]
    fn multipliers_take_an_eleventh_of_what_is_left_in_every_pass() {
        let found = Variant::Augmented(10.0)
            .solve(&contact(), &Settings::default())
            .unwrap();
        assert_eq!(found.status, Status::Certified);
        // 11⁻¹² < 1e-12.
        assert!(
            (11..=13).contains(&found.work.sweeps),
            "{}",
            found.work.sweeps
        );
        assert!((found.reaction[0] + 2.0).abs() < 1e-11);
    }
}
