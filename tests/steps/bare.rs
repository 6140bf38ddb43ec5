//! Load steps of bare condensed problems: a chain of springs on a frictional base against its exact
//! history, event by event, and contacts that open and close again.

use dpana::alternation::{Outcome, Settings, Status, solve, solve_from, solve_near};
use dpana::kkt::ContactStatus;
use dpana::problem::{ContactProblem, Operator};
use faer::linalg::solvers::Solve;
use faer::{Mat, mat};

/// Blocks in a row on a rough base, each joined to the next by a spring, the last to a wall.
struct Chain {
    stiffness: Mat<f64>,
    /// Load per block at load factor one, in newton; all of one sign.
    load: Vec<f64>,
    /// μ N per block, in newton.
    bound: Vec<f64>,
}

const SPRINGS: [f64; 5] = [3.0, 1.0, 2.0, 5.0, 0.5];

impl Chain {
    fn new() -> Self {
        let count = SPRINGS.len();
        let mut stiffness = Mat::zeros(count, count);
        for (i, k) in SPRINGS.into_iter().enumerate() {
            stiffness[(i, i)] += k;
            if i + 1 < count {
                stiffness[(i + 1, i + 1)] += k;
                stiffness[(i, i + 1)] -= k;
                stiffness[(i + 1, i)] -= k;
            }
        }
        Self {
            stiffness,
            load: vec![1.0, 0.2, 2.5, 0.7, 1.6],
            bound: vec![0.5, 1.6, 1.1, 2.2, 0.4],
        }
    }

    fn count(&self) -> usize {
        self.load.len()
    }

    /// Normal springs of 4 N/m, pushed in so that the normal force is bound / μ, μ = 0.5.
    fn problem(&self) -> ContactProblem {
        let count = self.count();
        let tangential = self.solve(&Mat::identity(count, count));
        let compliance = Mat::from_fn(2 * count, 2 * count, |i, j| match (i % 2, j % 2) {
            (0, 0) if i == j => 0.25,
            (1, 1) => 0.5 * (tangential[(i / 2, j / 2)] + tangential[(j / 2, i / 2)]),
            _ => 0.0,
        });
        let operator = Operator::from_compliance(compliance).unwrap();
        let tangents = vec![1; count];
        let (friction, gaps) = (vec![0.5; count], vec![0.0; count]);
        ContactProblem::new(&tangents, friction, gaps, self.free(0.0), operator).unwrap()
    }

    fn free(&self, factor: f64) -> Vec<f64> {
        let load = Mat::from_fn(self.count(), 1, |i, _| factor * self.load[i]);
        let moved = self.solve(&load);
        let blocks = (0..self.count()).flat_map(|i| [0.25 * self.bound[i] / 0.5, moved[(i, 0)]]);
        blocks.collect()
    }

    fn solve(&self, right: &Mat<f64>) -> Mat<f64> {
        self.stiffness.partial_piv_lu().solve(right)
    }
}

/// Position and friction force of every block, followed from event to event.
struct Exact<'a> {
    chain: &'a Chain,
    factor: f64,
    position: Vec<f64>,
    friction: Vec<f64>,
}

impl<'a> Exact<'a> {
    fn at_rest(chain: &'a Chain) -> Self {
        let zero = vec![0.0; chain.count()];
        Self {
            chain,
            factor: 0.0,
            position: zero.clone(),
            friction: zero,
        }
    }

    /// Loads grow (or fall) to `factor`. The springs' stiffness is an M-matrix, so every block that
    /// moves goes the way of the loads and, once moving, keeps moving: blocks only join.
    fn ramp(&mut self, factor: f64) {
        let count = self.chain.count();
        let way = (factor - self.factor).signum();
        let mut slips = vec![false; count];
        while self.factor != factor {
            for (i, slips) in slips.iter_mut().enumerate() {
                let edge = -way * self.chain.bound[i];
                *slips |= (self.friction[i] - edge).abs() < 1e-13;
            }
            let (velocity, growth) = self.rates(&slips);
            let mut step = (factor - self.factor).abs();
            for i in (0..count).filter(|&i| !slips[i]) {
                // Friction of a stuck block goes against the loads: to −way · bound.
                let to_edge = -way * self.chain.bound[i] - self.friction[i];
                let time = to_edge / (way * growth[i]);
                assert!(growth[i] <= 0.0 && time >= 0.0);
                step = step.min(time);
            }
            for i in 0..count {
                self.position[i] += way * step * velocity[i];
                self.friction[i] += way * step * growth[i];
            }
            let left = (factor - self.factor).abs() - step;
            self.factor = if left < 1e-14 {
                factor
            } else {
                self.factor + way * step
            };
        }
    }

    /// Rates per load factor: K_SS v_S = f_S, and the friction of the others holds them.
    fn rates(&self, slips: &[bool]) -> (Vec<f64>, Vec<f64>) {
        let count = self.chain.count();
        let moving: Vec<usize> = (0..count).filter(|&i| slips[i]).collect();
        let size = moving.len();
        let k = &self.chain.stiffness;
        let mut velocity = vec![0.0; count];
        if size > 0 {
            let matrix = Mat::from_fn(size, size, |i, j| k[(moving[i], moving[j])]);
            let right = Mat::from_fn(size, 1, |i, _| self.chain.load[moving[i]]);
            let solved = matrix.partial_piv_lu().solve(&right);
            for (at, &i) in moving.iter().enumerate() {
                velocity[i] = solved[(at, 0)];
                assert!(velocity[i] >= 0.0);
            }
        }
        let growth = (0..count).map(|i| match slips[i] {
            true => 0.0,
            false => (0..count).map(|j| k[(i, j)] * velocity[j]).sum::<f64>() - self.chain.load[i],
        });
        let growth = growth.collect();
        (velocity, growth)
    }
}

fn certified(problem: &ContactProblem, before: Option<&Outcome>) -> Outcome {
    let settings = Settings::default();
    let outcome = match before {
        None => solve(problem, &settings),
        Some(before) => solve_from(problem, &settings, &before.reaction, &before.motion),
    };
    let outcome = outcome.unwrap();
    assert_eq!(outcome.status, Status::Certified);
    outcome
}

/// Slip so far at the tangents, zero at the normals.
fn slip(problem: &ContactProblem, outcome: &Outcome) -> Vec<f64> {
    let mut slip = problem.total_displacement(&outcome.verdict.displacement);
    for &normal in &problem.offsets()[..problem.contacts()] {
        slip[normal] = 0.0;
    }
    slip
}

#[test]
fn a_chain_of_blocks_follows_its_exact_history_through_reversals() {
    let chain = Chain::new();
    let reversals = [1.0, -0.6, 0.9, -1.2, 0.2, 1.4, 0.0];
    for parts in [1, 2, 7] {
        let mut exact = Exact::at_rest(&chain);
        let mut problem = chain.problem();
        let mut outcome = certified(&problem, None);
        let (mut from, mut partly) = (0.0, 0);
        for to in reversals {
            for part in 1..=parts {
                let factor = from + (to - from) * f64::from(part) / f64::from(parts);
                exact.ramp(factor);
                problem = problem
                    .step(chain.free(factor), slip(&problem, &outcome))
                    .unwrap();
                outcome = certified(&problem, Some(&outcome));
                let position = slip(&problem, &outcome);
                // Certified to 1e-12 of forces of newtons, up to 49 times in a row; the springs give way by
                // 1/3 + 1 + 1/2 + 1/5 + 2 = 4 m per newton.
                for i in 0..chain.count() {
                    let (at, force) = (position[2 * i + 1], outcome.reaction[2 * i + 1]);
                    assert!(
                        (at - exact.position[i]).abs() < 1e-11,
                        "{parts} {factor} {i}"
                    );
                    assert!(
                        (force - exact.friction[i]).abs() < 1e-11,
                        "{parts} {factor} {i}"
                    );
                }
                let status = &outcome.verdict.status;
                let stuck = status
                    .iter()
                    .filter(|s| **s == ContactStatus::Stick)
                    .count();
                partly += usize::from(stuck > 0 && stuck < chain.count());
            }
            from = to;
        }
        assert!(partly >= 4, "the history shows partial slip: {partly}");
    }
}

#[test]
fn steps_share_the_operator_and_a_near_state_takes_no_cone_program() {
    let chain = Chain::new();
    let first = chain.problem();
    let first = first.step(chain.free(0.9), vec![0.0; 10]).unwrap();
    let outcome = certified(&first, None);
    let next = first
        .step(chain.free(0.91), slip(&first, &outcome))
        .unwrap();
    assert!(std::ptr::eq(first.compliance(), next.compliance()));
    let near = certified(&next, Some(&outcome));
    assert_eq!((near.work.sweeps, near.work.passes), (0, 0));
    assert!(near.work.newton_steps <= 3, "{}", near.work.newton_steps);
}

#[test]
fn a_contact_that_opens_and_closes_again_begins_a_new_slip() {
    // One contact, unit springs, μ = 0.5, never any coupling: (û_N, û_T) per step.
    let operator = Operator::from_compliance(mat![[1.0, 0.0], [0.0, 1.0]]).unwrap();
    let history = [
        // Pressed by 2 N, pulled by 3 N: slips by 2 m, friction −1 N.
        ([2.0, 3.0], [-2.0, -1.0], 2.0),
        // Opens and goes where it likes.
        ([-1.0, 10.0], [0.0, 0.0], 8.0),
        // Closes there: sticks, no friction.
        ([4.0, 10.0], [-4.0, 0.0], 0.0),
        // Pulled back by 1.5 N: friction up to 2 N holds it.
        ([4.0, 8.5], [-4.0, 1.5], 0.0),
        // Pulled back by 3 N: slips by 1 m.
        ([4.0, 7.0], [-4.0, 2.0], -1.0),
    ];
    let mut problem =
        ContactProblem::new(&[1], vec![0.5], vec![0.0], vec![0.0; 2], operator).unwrap();
    let mut reference = vec![0.0; 2];
    for (free, reaction, increment) in history {
        problem = problem.step(free.to_vec(), reference).unwrap();
        let outcome = certified(&problem, None);
        for (found, expected) in outcome.reaction.iter().zip(reaction) {
            assert!(
                (found - expected).abs() < 1e-12,
                "{free:?}: {:?}",
                outcome.reaction
            );
        }
        let found = outcome.verdict.displacement[1];
        assert!((found - increment).abs() < 1e-12, "{free:?}: {found}");
        reference = slip(&problem, &outcome);
    }
}

#[test]
fn a_step_that_does_not_fit_is_refused_by_name() {
    let problem = Chain::new().problem();
    let refused =
        |free: Vec<f64>, reference| problem.step(free, reference).unwrap_err().to_string();
    assert!(refused(vec![0.0; 9], vec![0.0; 10]).contains("free_displacement: expected 10"));
    assert!(refused(vec![0.0; 10], vec![0.0; 9]).contains("reference: expected 10"));
    assert!(refused(vec![0.0; 10], vec![f64::NAN; 10]).contains("reference[0]: NaN"));
    let settings = Settings::default();
    let short = solve_from(&problem, &settings, &[0.0; 9], &[]).unwrap_err();
    assert!(short.to_string().contains("reaction: expected 10"));
    assert!(solve_from(&problem, &settings, &[f64::NAN; 10], &[]).is_err());
    assert!(solve_from(&problem, &settings, &[0.0; 10], &[1.0]).is_err());
    let solved = certified(&problem, None);
    assert!(solve_near(&problem, &settings, &solved).is_ok());
    let mut broken = solved.clone();
    broken.verdict.displacement[3] = f64::INFINITY;
    let broken = solve_near(&problem, &settings, &broken).unwrap_err();
    assert!(broken.to_string().contains("displacement[3]"), "{broken}");
    let mut short = solved;
    short.reaction.pop();
    assert!(solve_near(&problem, &settings, &short).is_err());
    assert!(problem.with_friction(vec![-1.0; 5]).is_err());
    assert!(problem.with_initial_gap(vec![0.0; 4]).is_err());
}

/// Numbers between −1 and 1, always the same for a seed.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

#[test]
fn from_the_last_state_or_from_nothing_a_step_in_space_is_the_same() {
    for seed in 1..=12 {
        let mut random = Random(seed);
        let (contacts, size) = (8, 24);
        let factor = Mat::from_fn(size, size, |_, _| random.next());
        let product = &factor * factor.transpose();
        let compliance = Mat::from_fn(size, size, |i, j| {
            product[(i, j)] + if i == j { 4.0 } else { 0.0 }
        });
        let operator = Operator::from_compliance(compliance).unwrap();
        let (friction, gaps) = (vec![0.2; contacts], vec![0.05; contacts]);
        let first = ContactProblem::new(&[2; 8], friction, gaps, vec![0.0; size], operator);
        let mut problem = first.unwrap();
        let mut outcome = certified(&problem, None);
        let (mut free, mut changed) = (vec![0.0; size], 0);
        for step in 0..25 {
            let push = if step < 5 { 0.6 } else { 0.0 };
            for (unknown, u) in free.iter_mut().enumerate() {
                let normal = unknown % 3 == 0;
                *u += 0.5 * random.next() + if normal { push } else { 0.0 };
            }
            problem = problem
                .step(free.clone(), slip(&problem, &outcome))
                .unwrap();
            let near = certified(&problem, Some(&outcome));
            let cold = certified(&problem, None);
            // Certified to 1e-12 of ‖t‖ each; G is A Aᵀ + 4, of a condition of (2² · 24/3 + 4)/4 = 9.
            let size = cold
                .reaction
                .iter()
                .fold(0.0_f64, |size, t| size.max(t.abs()));
            for (a, b) in near.reaction.iter().zip(&cold.reaction) {
                assert!((a - b).abs() <= 1e-10 * size, "{seed} {step}: {a} {b}");
            }
            changed += usize::from(near.verdict.status != outcome.verdict.status);
            outcome = near;
        }
        assert!(
            changed > 10,
            "contacts open, close, stick and slip: {changed}"
        );
    }
}
