//! The last resort of a solve: paths that always end in a state, of surfaces that approach from afar in the plane
//! (D10), of contacts that are joined in space (D13); and where bodies float, of contacts that open as they slide (D19).

use std::time::Instant;

use super::dilation::DilationPath;
use super::joined::JoinedPath;
use super::plane::{End, PlanePath};
use crate::alternation::run::Run;

impl Run<'_> {
    /// (D10) or (D13), or (D19), once, with Newton steps to the last digits.
    ///
    /// Of elastic bodies that give way on another path nothing is proved: friction has many.
    pub(in crate::alternation) fn follow_a_path(&mut self) {
        let once = self.work.path_changes + self.work.path_steps == 0;
        let proved = self
            .failure
            .as_ref()
            .is_some_and(|failure| !failure.elastic);
        if self.is_solved() || !once || proved || self.is_over() {
            return;
        }
        let start = Instant::now();
        let found = match self.problem.floating() {
            Some(_) => self.take_dilation_away(),
            None => self.approach().or_else(|| self.join()),
        };
        if found.is_some() {
            self.judge();
            self.newton_finish();
            if self.is_solved() {
                self.failure = None;
            }
        }
        self.work.seconds.finish += start.elapsed().as_secs_f64();
    }

    fn take_dilation_away(&mut self) -> Option<()> {
        let start = self.start.clone();
        let mut path = DilationPath::new(self.problem, &start, self.clock);
        let found = path.follow(&start);
        self.work.path_steps += path.steps;
        self.state = found?;
        Some(())
    }

    fn approach(&mut self) -> Option<()> {
        let mut path = PlanePath::of_approach(self.problem)?.until(self.clock);
        let end = path.follow(0.0, true);
        self.work.path_changes += path.changes;
        match end {
            End::Reached(reaction) => {
                self.state.reaction = reaction;
                Some(())
            }
            End::Turned(_) | End::Lost(_) => None,
        }
    }

    fn join(&mut self) -> Option<()> {
        let mut path = JoinedPath::new(self.problem, self.clock)?;
        let reached = path.follow();
        self.work.path_steps += path.steps;
        self.state.reaction = reached?;
        Some(())
    }
}
