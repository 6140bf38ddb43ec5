//! How much work a rough surface takes.

use dpana::half_space::{
    Drag, HalfSpaceOutcome, HalfSpaceProblem, HalfSpaceStatus, Press, SelfAffine, Surroundings,
};

use crate::{RUBBER, half_space, modulus};

/// H = 0.8, roll-off 8 waves, cut-off n/8, slope 0.1, mean pressure 0.01 E*.
fn rough(n: usize, mu: f64, seed: u64) -> HalfSpaceProblem {
    let space = half_space([n, n], [1.0; 2], Surroundings::Periodic, RUBBER);
    let surface = SelfAffine {
        hurst: 0.8,
        roll_off: 1.0 / 8.0,
        cut_off: 8.0 / n as f64,
        slope: 0.1,
        seed,
    };
    let gap = surface
        .heights(space.grid())
        .unwrap()
        .iter()
        .map(|h| -h)
        .collect();
    HalfSpaceProblem::new(space, gap, &[mu], Press::Load(0.01 * modulus(RUBBER))).unwrap()
}

fn sheared(n: usize, seed: u64) -> HalfSpaceOutcome {
    let problem = rough(n, 0.3, seed)
        .dragged(Drag::Shift([2e-4, 0.0]))
        .unwrap();
    let outcome = problem.solve().unwrap();
    assert_eq!(outcome.status, HalfSpaceStatus::Certified);
    assert!(outcome.work.outer <= 25, "{:?}", outcome.work);
    outcome
}

#[test]
fn a_rough_sheared_surface_takes_at_most_150_applications_at_128() {
    for seed in 0..6 {
        let work = sheared(128, seed).work;
        assert!(work.applications() <= 150.0, "{work:?}");
    }
}

#[test]
fn and_at_most_300_at_256() {
    let work = sheared(256, 3).work;
    assert!(work.applications() <= 300.0, "{work:?}");
}

#[test]
#[ignore = "slow: run in release"]
fn and_at_most_500_at_1024() {
    let work = sheared(1024, 3).work;
    assert!(work.applications() <= 500.0, "{work:?}");
}

#[test]
#[ignore = "slow: run in release"]
fn without_friction_512_takes_at_most_250_products_to_1e_12() {
    let outcome = rough(512, 0.0, 3).solve_to(1e-12).unwrap();
    assert_eq!(
        outcome.status,
        HalfSpaceStatus::Certified,
        "{:?}",
        outcome.certificate
    );
    // A product of the normal part is two transforms.
    assert!(outcome.work.transforms <= 2.0 * 250.0, "{:?}", outcome.work);
}
