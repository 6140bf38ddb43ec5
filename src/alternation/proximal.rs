//! Where a finish fails: a proximal point loop around whole Newton steps.
//!
//! ```text
//! (D6)   t_k, α_k ← best state;  σ ← 1e-6
//!        from t_k, α_k Newton steps (D4) under springs of softness σ that are anchored there (D5)
//!        their residual fell to a tenth:   accept;  after few steps: σ ← σ/10, or σ/3 once one was thrown away
//!        else:                             throw away, σ ← 1000 σ
//! ```
//!
//! Every subproblem is well posed: springs tell contacts apart that stand twice, and hold bodies that contact
//! does not yet hold. At the end they are as good as gone, and where they are anchored no longer matters.
//!
//! A subproblem that is thrown away costs a dozen steps, one that is accepted one or two: a σ that does is found in few
//! strides, and lowered with care.
//!
//! Where nothing holds elastic bodies the springs do to the last: what they carry stays while they soften tenfold
//! again and again, and the bodies move tenfold each time.

use std::time::Instant;

use super::finish::{Finish, Point, Springs};
use super::iterate::Iterate;
use super::run::Run;
use crate::problem::velocity_basis::product;

/// Softness of the first springs, and the largest that is tried.
const SOFTNESS: (f64, f64) = (1e-6, 1e6);

/// Springs that are as good as none.
const LEAST: f64 = 1e-18;

/// σ falls by the first; once a subproblem was thrown away by the second, down to the third.
const FALLS: (f64, f64, f64) = (10.0, 3.0, 1e-3);

/// It rises by this.
const RISES: f64 = 1e3;

/// Newton steps on a subproblem at most, and how few let the springs soften.
const STEPS: (usize, usize) = (12, 5);

/// The residual of a subproblem that counts as solved, as a part of that where it began.
const SETTLED: f64 = 0.1;

/// Residuals that differ by less than this part are one.
const AGAIN: f64 = 1e-9;

/// Newton steps in all at most, and products of two numbers that they take: those of a minute or two.
const STEPS_IN_ALL: usize = 600;
const PRODUCTS: f64 = 1e12;

/// What springs carry stands if it changes by less than this part, so many times on end; and nothing holds the
/// bodies if they move farther then than so many times what any contact is away, or indents. Farther still, what
/// rounding leaves of a motion along a contact would press it.
const STANDS: (f64, usize) = (0.1, 3);
const FAR: f64 = 1e4;

/// A state that bodies have gone so many times as far to is none: its pressures are rounding of their motion.
const BEYOND: f64 = 1e8;

impl Run<'_> {
    /// (D6) from the best state.
    pub(super) fn proximal_steps(&mut self) {
        if self.is_solved() || self.failure.is_some() || self.is_over() {
            return;
        }
        let start = Instant::now();
        if let Some(mut finish) = self.finish.take() {
            self.proximal_loop(&mut finish);
            self.finish = Some(finish);
        }
        self.work.seconds.finish += start.elapsed().as_secs_f64();
    }

    fn proximal_loop(&mut self, finish: &mut Finish<'_>) {
        let (mut softness, most) = (SOFTNESS.0, self.work.newton_steps + STEPS_IN_ALL);
        let (mut products, mut stood, mut careful) = (0.0, (0.0, 0), false);
        // Newton steps that failed may have left a state far off.
        self.state = self.start.clone();
        while (LEAST..=SOFTNESS.1).contains(&softness) && products < PRODUCTS {
            // A last step once it is solved, for digits that the judge does not ask for.
            let last = self.is_solved();
            let (settled, steps) = settle(finish, &self.state, softness);
            self.record.newton_steps += steps;
            self.work.newton_steps += steps;
            self.work.proximal_steps += 1;
            products += steps as f64 * finish.products();
            if self.work.newton_steps >= most || self.is_over() {
                break;
            }
            let Some(point) = settled else {
                softness *= RISES;
                careful = true;
                continue;
            };
            let before = self.state.motion.clone();
            self.state.motion = finish.moved(&before, &point.drift);
            self.state.reaction = point.reaction;
            self.judge();
            if steps <= STEPS.1 {
                softness /= match careful && softness > FALLS.2 {
                    true => FALLS.1,
                    false => FALLS.0,
                };
            }
            stood = self.stood(stood);
            if last
                || (stood.1 >= STANDS.1 && self.give_way(&before, FAR * self.reach(&self.state)[0]))
            {
                break;
            }
        }
    }

    /// What the springs carry, and how many times on end it stood.
    fn stood(&self, (before, times): (f64, usize)) -> (f64, usize) {
        let certificate = &self.state.verdict.certificate;
        let left = certificate.equilibrium.scaled;
        let kept = (left - before).abs() <= STANDS.0 * left;
        let stands = kept && left > self.tolerance() && certificate.natural_map <= STANDS.0 * left;
        (left, if stands { times + 1 } else { 0 })
    }

    /// Whether the best state is one that bodies ran off to; where nothing acts any place is as good.
    pub(super) fn has_run_off(&self) -> bool {
        let acts = self.best.reaction.iter().any(|t| *t != 0.0);
        self.problem.floating().is_some() && acts && {
            let [reach, moved] = self.reach(&self.best);
            // Of bodies without compliance nothing else is left of it.
            let free = largest(self.problem.free_displacement().iter().copied());
            moved > BEYOND * reach.max(free)
        }
    }

    /// Largest gap, indentation or slip of a measured state that no motion of whole bodies makes, and the largest that one
    /// makes, in metre.
    fn reach(&self, state: &Iterate) -> [f64; 2] {
        let Some(floating) = self.problem.floating() else {
            return [largest(state.verdict.beyond.iter().copied()), 0.0];
        };
        let moved = product(floating.modes(), &state.motion.amplitudes);
        let beyond = state.verdict.beyond.iter().zip(&moved);
        let reach = largest(beyond.map(|(beyond, moved)| beyond - moved));
        [reach, largest(moved.iter().copied())]
    }
}

fn largest(lengths: impl Iterator<Item = f64>) -> f64 {
    lengths.fold(0.0, |most, length| most.max(length.abs()))
}

/// The solution of a subproblem anchored at a state, if Newton steps lead there, and how many were taken.
fn settle(finish: &mut Finish<'_>, anchor: &Iterate, softness: f64) -> (Option<Point>, usize) {
    let springs = Springs {
        softness,
        anchor: &anchor.reaction,
    };
    let mut point = finish.point(anchor);
    let mut residuals = vec![finish.residual(&point, springs)];
    let wanted = SETTLED * residuals[0];
    for steps in 1..=STEPS.0 {
        let seen = point.beyond.clone();
        let Some(next) = finish.step(&point, &seen, springs) else {
            return (None, steps);
        };
        point = next;
        let residual = finish.residual(&point, springs);
        if residual <= wanted {
            return (Some(point), steps);
        }
        // What comes back goes round in circles.
        let again = |earlier: &f64| (earlier - residual).abs() <= AGAIN * residual;
        if residuals.iter().any(again) {
            return (None, steps);
        }
        residuals.push(residual);
    }
    (None, STEPS.0)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use faer::{Mat, mat};

    use crate::alternation::iterate::{Iterate, Motion};
    use crate::alternation::run::Run;
    use crate::alternation::{Settings, Status, solve};
    use crate::kkt::Judge;
    use crate::problem::{ContactProblem, Floating, Operator};

    #[test]
    fn contacts_that_stand_twice_are_told_apart_by_springs() {
        // Two contacts on one spot: only the sum of their reactions is determined, −2.
        let operator = Operator::from_compliance(mat![[1.0, 1.0], [1.0, 1.0]]).unwrap();
        let (zero, free) = (vec![0.0; 2], vec![2.0; 2]);
        let problem = ContactProblem::new(&[0, 0], zero.clone(), zero, free, operator).unwrap();
        let found = solve(&problem, &Settings::default()).unwrap();
        assert_eq!(found.status, Status::Certified);
        assert!((found.reaction[0] + found.reaction[1] + 2.0).abs() < 1e-11);
    }

    /// A block between jaws that overlap it by half a metre, G = 1 m/N, pulled along them: N = ½, μ = ½.
    fn clamped(pull: f64) -> ContactProblem {
        let operator = Operator::from_compliance(Mat::identity(2, 2)).unwrap();
        let problem =
            ContactProblem::new(&[1], vec![0.5], vec![-0.5], vec![0.0; 2], operator).unwrap();
        let floating = Floating::new(mat![[0.0], [1.0]], vec![pull]).unwrap();
        problem.float(floating).unwrap()
    }

    #[test]
    fn a_clamp_holds_up_to_its_friction() {
        let found = solve(&clamped(0.25 - 1e-6), &Settings::default()).unwrap();
        assert_eq!(found.status, Status::Certified);
        assert!((found.reaction[0] + 0.5).abs() < 1e-12);
        assert!((found.reaction[1] + 0.25 - 1e-6).abs() < 1e-12);
    }

    #[test]
    fn a_state_that_a_body_ran_off_to_is_none() {
        // Jaws overlap by half a metre: a motion of 1e9 m is beyond all that is known to eight digits of it.
        let (problem, settings) = (clamped(0.2), Settings::default());
        let mut run = Run::new(&problem, &settings);
        for (motion, far) in [(0.2, false), (-1e6, false), (1e9, true)] {
            let judge = Judge::new(&problem);
            run.best = Iterate::new(&judge, vec![-0.25, 0.0], Motion::of(vec![motion]));
            assert_eq!(run.has_run_off(), far, "{motion:e}");
            // Where nothing acts it may be anywhere.
            run.best = Iterate::new(&judge, vec![0.0; 2], Motion::of(vec![motion]));
            assert!(!run.has_run_off());
        }
    }

    #[test]
    fn a_clamp_gives_way_beyond_though_rigid_jaws_would_hold() {
        let found = solve(&clamped(0.3), &Settings::default()).unwrap();
        assert_eq!(found.status, Status::NoEquilibrium);
        let failure = found.failure.unwrap();
        // It slides along its pull at unit speed, for want of 0.3 − μ N.
        assert!(failure.elastic && failure.sliding == [0], "{failure:?}");
        assert!((failure.motion[0] - 1.0).abs() < 1e-12 && (failure.missing - 0.05).abs() < 1e-9);
    }
}
