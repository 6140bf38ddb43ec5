//! The last resort in the plane: surfaces that approach from afar (D10), which always end in a state.

use std::time::Instant;

use super::plane::{End, PlanePath};
use crate::alternation::run::Run;

impl Run<'_> {
    /// (D10), once, with Newton steps to the last digits.
    pub(in crate::alternation) fn approach_from_afar(&mut self) {
        if self.is_solved() || self.work.path_changes > 0 || self.is_over() {
            return;
        }
        let start = Instant::now();
        if let Some(mut path) = PlanePath::of_approach(self.problem) {
            let end = path.follow(0.0, true);
            self.work.path_changes += path.changes;
            if let End::Reached(reaction) = end {
                self.state.reaction = reaction;
                self.judge();
                self.newton_finish();
            }
        }
        self.work.seconds.finish += start.elapsed().as_secs_f64();
    }
}
