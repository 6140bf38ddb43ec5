//! Bodies that contact alone holds, as random rigid problems: what was built to be held is held, every
//! refusal is proved by a motion that the judge accepts, and the limit is where the verdict changes.

use dpana::kkt::impossibility;
use dpana::limit::{Equilibrium, LeastFriction, Limit, RigidContacts};
use faer::Mat;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// Contacts of random place and direction on bodies in a row.
#[derive(Clone, Debug)]
struct Problem {
    tangents: usize,
    friction: Vec<f64>,
    modes: Mat<f64>,
    /// Numbers to make reactions and loads from, as many as unknowns.
    numbers: Vec<f64>,
}

impl Problem {
    fn contacts(&self) -> RigidContacts {
        let tangents = vec![self.tangents; self.friction.len()];
        RigidContacts::new(&tangents, self.friction.clone(), self.modes.clone()).unwrap()
    }

    /// An admissible reaction; of every third contact it is on the edge of the disc, every fourth is open.
    fn reaction(&self) -> Vec<f64> {
        let block = 1 + self.tangents;
        let mut reaction = self.numbers.clone();
        for (contact, t) in reaction.chunks_exact_mut(block).enumerate() {
            t[0] = if contact % 4 == 3 { 0.0 } else { -t[0].abs() };
            let size = t[1..].iter().map(|x| x * x).sum::<f64>().sqrt();
            let share = if contact % 3 == 0 { 1.0 } else { 0.5 };
            let radius = -self.friction[contact] * t[0] * share;
            t[1..]
                .iter_mut()
                .for_each(|x| *x *= radius / size.max(1e-300));
        }
        reaction
    }

    /// `−Rᵀ t`.
    fn answered(&self, reaction: &[f64]) -> Vec<f64> {
        let column = |k: usize| {
            (0..reaction.len())
                .map(|i| -self.modes[(i, k)] * reaction[i])
                .sum()
        };
        (0..self.modes.ncols()).map(column).collect()
    }

    fn assert_admissible(&self, reaction: &[f64], load: &[f64]) {
        let size = largest(reaction);
        for (t, mu) in reaction.chunks_exact(1 + self.tangents).zip(&self.friction) {
            let slip = t[1..].iter().map(|x| x * x).sum::<f64>().sqrt();
            assert!(t[0] <= 0.0 && slip + mu * t[0] <= 1e-12 * size, "{t:?}");
        }
        let scale = largest(load);
        for (answer, e) in self.answered(reaction).iter().zip(load) {
            // A few decades of room for modes that the contacts hardly feel.
            assert!((answer - e).abs() <= 1e-7 * scale, "{answer} {e}");
        }
    }

    fn assert_proved(&self, motion: &[f64], load: &[f64]) {
        let contacts = self.contacts();
        let proof = impossibility(
            contacts.offsets(),
            &self.friction,
            self.modes.as_ref(),
            load,
            motion,
        )
        .unwrap();
        let scale = largest(load);
        // The search asks for a million times the load as the contacts feel it, in the norm; R may shrink a load by
        // some decades on the way there.
        assert!(
            proof.work > 0.0 && proof.least_reaction > 100.0 * scale,
            "{proof:?} {scale}"
        );
    }
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |largest, x| largest.max(x.abs()))
}

fn problem() -> impl Strategy<Value = Problem> {
    (1..=2_usize, 1..=24_usize, 1..=3_usize).prop_flat_map(|(tangents, contacts, bodies)| {
        let block = 1 + tangents;
        let unknowns = block * contacts;
        let per_body = if tangents == 1 { 3 } else { 6 };
        let entries = prop::collection::vec(-1.0..1.0_f64, unknowns * per_body);
        let friction = prop::collection::vec(prop_oneof![Just(0.0), 0.05..1.5_f64], contacts);
        let numbers = prop::collection::vec(-10.0..10.0_f64, unknowns);
        (entries, friction, numbers).prop_map(move |(entries, friction, numbers)| {
            // Contact i belongs to body i mod bodies, and every other one also to the next.
            let modes = Mat::from_fn(unknowns, per_body * bodies, |row, column| {
                let (contact, body) = (row / block, column / per_body);
                let entry = entries[row * per_body + column % per_body];
                if contact % bodies == body {
                    entry
                } else if contact % 2 == 0 && (contact + 1) % bodies == body {
                    -entry
                } else {
                    0.0
                }
            });
            Problem {
                tangents,
                friction,
                modes,
                numbers,
            }
        })
    })
}

proptest! {
    // The same draw every time: one load in some tens of thousands is too close to a jam to be told.
    #![proptest_config(ProptestConfig {
        cases: 300,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(11),
        ..ProptestConfig::default()
    })]

    #[test]
    fn a_load_that_admissible_reactions_answer_is_held(problem in problem()) {
        let load = problem.answered(&problem.reaction());
        match problem.contacts().admissible(&load).unwrap() {
            Equilibrium::Held { reaction } => problem.assert_admissible(&reaction, &load),
            other => prop_assert!(false, "{other:?}"),
        }
    }

    #[test]
    fn any_load_is_held_or_a_motion_proves_that_it_is_not(problem in problem()) {
        let load: Vec<f64> = (0..problem.modes.ncols())
            .map(|k| problem.numbers[k % problem.numbers.len()] * if k % 2 == 0 { 1.0 } else { -0.5 })
            .collect();
        match problem.contacts().admissible(&load).unwrap() {
            Equilibrium::Held { reaction } => problem.assert_admissible(&reaction, &load),
            Equilibrium::Impossible { motion, excess } => {
                prop_assert!(excess > 0.0);
                problem.assert_proved(&motion, &load);
            }
            Equilibrium::Undecided { remainder } => prop_assert!(false, "{remainder:e}"),
        }
    }

    #[test]
    fn at_the_limit_the_verdict_changes(problem in problem()) {
        let fixed = problem.answered(&problem.reaction());
        let growing: Vec<f64> = (0..fixed.len())
            .map(|k| (1.0 + k as f64).sin())
            .collect();
        let contacts = problem.contacts();
        let at = |factor: f64| {
            let load: Vec<f64> = fixed.iter().zip(&growing).map(|(f, g)| f + factor * g).collect();
            contacts.admissible(&load).unwrap()
        };
        let held = |factor| matches!(at(factor), Equilibrium::Held { .. });
        match contacts.limit(&fixed, &growing).unwrap() {
            Limit::Finite { factor, .. } => {
                // Loads are told apart by 1e-11 of their size, and less where the growing load leaves at a flat angle.
                let margin = 1e-7 * factor.max(1.0);
                prop_assert!(factor <= margin || held(factor - margin), "{factor}");
                prop_assert!(!held(factor + margin), "{factor}");
            }
            Limit::Unbounded => prop_assert!(held(1.0) && held(1e3)),
            // One in some thousands: a load that leaves the edge of what is held along its tangent.
            Limit::Undecided => {}
            // The fixed load alone is held by construction.
            Limit::Never { .. } => prop_assert!(false),
        }
    }

    #[test]
    fn below_the_least_friction_the_load_is_not_held(problem in problem()) {
        let load = problem.answered(&problem.reaction());
        let scaled = |multiple: f64| {
            let mut scaled = problem.clone();
            scaled.friction.iter_mut().for_each(|mu| *mu *= multiple);
            scaled.contacts().admissible(&load).unwrap()
        };
        // Near a jam ever larger reactions hold the load: the threshold is where they pass what can be
        // computed, a million times the load, and not where they end.
        let jams = |reaction: &[f64]| largest(reaction) > 1e4 * largest(&load);
        match problem.contacts().least_friction(&load).unwrap() {
            LeastFriction::Multiple { multiple, reaction, .. } => {
                prop_assert!(multiple <= 1.0 + 1e-6);
                let above = scaled(multiple * (1.0 + 1e-6));
                let told = match &above {
                    Equilibrium::Held { .. } => true,
                    Equilibrium::Undecided { .. } => jams(&reaction),
                    Equilibrium::Impossible { .. } => false,
                };
                prop_assert!(told, "{multiple} {above:?}");
                let below = scaled(multiple * (1.0 - 1e-4));
                let held = matches!(&below, Equilibrium::Held { reaction } if !jams(reaction));
                prop_assert!(multiple == 0.0 || !held, "{multiple} {below:?}");
            }
            other => prop_assert!(false, "{other:?}"),
        }
    }
}
