//! The last resort of a solve: paths that always end in a state, of surfaces that approach from afar in the plane
//! (D10), of contacts that are joined in space (D13).

use std::time::Instant;

use super::joined::JoinedPath;
use super::plane::{End, PlanePath};
use crate::alternation::run::Run;

impl Run<'_> {
    /// (D10) or (D13), once, with Newton steps to the last digits.
    pub(in crate::alternation) fn follow_a_path(&mut self) {
        let once = self.work.path_changes + self.work.path_steps == 0;
        if self.is_solved() || !once || self.is_over() {
            return;
        }
        let start = Instant::now();
        if let Some(reaction) = self.approach().or_else(|| self.join()) {
            self.state.reaction = reaction;
            self.judge();
            self.newton_finish();
        }
        self.work.seconds.finish += start.elapsed().as_secs_f64();
    }

    fn approach(&mut self) -> Option<Vec<f64>> {
        let mut path = PlanePath::of_approach(self.problem)?.until(self.clock);
        let end = path.follow(0.0, true);
        self.work.path_changes += path.changes;
        match end {
            End::Reached(reaction) => Some(reaction),
            End::Turned(_) | End::Lost(_) => None,
        }
    }

    fn join(&mut self) -> Option<Vec<f64>> {
        let mut path = JoinedPath::new(self.problem, self.clock)?;
        let reached = path.follow();
        self.work.path_steps += path.steps;
        reached
    }
}
