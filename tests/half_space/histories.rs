//! Histories: slip that is remembered, forces that come back.

use std::f64::consts::TAU;

use dpana::half_space::{
    Drag, ElasticHalf, HalfSpaceOutcome, HalfSpaceProblem, HalfSpaceStatus, Press, SelfAffine,
    Surroundings,
};

use crate::half_space;

/// Numbers in [0, 1) that are the same in every run (SplitMix64).
struct Random(u64);

impl Random {
    fn part(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((mixed ^ (mixed >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn one_of<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[(self.part() * choices.len() as f64) as usize]
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.part()
    }
}

/// A bowl, smooth or rough, or a rough plane, pressed with a load.
fn pressed(random: &mut Random) -> HalfSpaceProblem {
    let n = random.one_of(&[16, 20, 24, 32]);
    let material = ElasticHalf {
        young: 1.0,
        poisson: random.one_of(&[0.0, 0.15, 0.3]),
    };
    let around = random.one_of(&[
        Surroundings::Free,
        Surroundings::Free,
        Surroundings::Periodic,
    ]);
    let space = half_space([n, n], [1.0; 2], around, material);
    let mut gap = space.grid().sample(|[x, y]| 0.5 * (x * x + y * y));
    if around == Surroundings::Periodic || random.part() < 0.5 {
        let surface = SelfAffine {
            hurst: 0.8,
            roll_off: 0.5,
            cut_off: 4.0 / n as f64,
            slope: random.between(0.02, 0.1),
            seed: (1000.0 * random.part()) as u64,
        };
        let heights = surface.heights(space.grid()).unwrap();
        gap.iter_mut().zip(&heights).for_each(|(gap, h)| *gap -= h);
    }
    let friction = random.between(0.2, 0.8);
    let load = Press::Load(random.between(0.01, 0.06));
    HalfSpaceProblem::new(space, gap, &[friction], load).unwrap()
}

/// Largest tangential force, in N.
fn carried(problem: &HalfSpaceProblem) -> f64 {
    match problem.press() {
        Press::Load(load) => problem.friction()[0] * load,
        Press::Approach(_) => unreachable!("all are pressed by loads"),
    }
}

#[test]
fn forces_that_come_back_from_near_what_friction_carries_are_met() {
    let mut random = Random(1);
    for history in 0..40 {
        let mut problem = pressed(&mut random);
        let turns = random.part() < 0.5;
        let mut parts = vec![random.between(0.9, 0.99), -random.between(0.9, 0.99)];
        parts.extend([random.between(-0.6, 0.6), random.between(-0.99, 0.99), 0.0]);
        let mut last: Option<HalfSpaceOutcome> = None;
        for part in parts {
            let angle = if turns { random.between(0.0, TAU) } else { 0.0 };
            let force = [angle.cos(), angle.sin()].map(|along| part * carried(&problem) * along);
            problem = problem.dragged(Drag::Force(force)).unwrap();
            let outcome = match &last {
                None => problem.solve().unwrap(),
                Some(last) => {
                    problem = problem.following(last).unwrap();
                    problem.solve_from(&last.state, 1e-10).unwrap()
                }
            };
            let told = format!(
                "history {history}, {part:.3} of what friction carries: {:?} {:?}",
                outcome.work, outcome.certificate
            );
            assert_eq!(outcome.status, HalfSpaceStatus::Certified, "{told}");
            for (axis, given) in force.into_iter().enumerate() {
                let found: f64 = outcome.state.reaction[axis + 1].iter().sum();
                let off = (found - given).abs();
                assert!(off < 1e-9 * carried(&problem), "{told}");
            }
            assert!(outcome.work.applications() < 400.0, "{told}");
            last = Some(outcome);
        }
    }
}
