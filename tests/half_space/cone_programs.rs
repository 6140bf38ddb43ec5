//! The same contacts with a matrix, solved by the cone programs.

use std::sync::Arc;

use dpana::alternation::{Settings, Status, solve};
use dpana::half_space::{
    Drag, HalfSpace, HalfSpaceCertificate, HalfSpaceProblem, HalfSpaceStatus, Press, SelfAffine,
    Surroundings,
};
use dpana::problem::Compliance;

use crate::{RUBBER, half_space};

/// Whether a half-space's problem and the same with a matrix, by the cone programs, end alike.
fn agree(problem: &HalfSpaceProblem) -> HalfSpaceCertificate {
    let free_of_matrix = problem.solve_to(1e-12).unwrap();
    assert_eq!(free_of_matrix.status, HalfSpaceStatus::Certified);
    let dense = problem.contact_problem().unwrap().dense().unwrap();
    let settings = Settings::default().with_tolerance(1e-12);
    let with_matrix = solve(&dense, &settings).unwrap();
    assert_eq!(with_matrix.status, Status::Certified);
    let expected = &with_matrix.reaction;
    let most = expected.iter().fold(0.0_f64, |m, t| m.max(t.abs()));
    let found = &free_of_matrix.state.reaction;
    for (unknown, expected) in expected.iter().enumerate() {
        let off = found[unknown % 3][unknown / 3] - expected;
        assert!(off.abs() < 1e-9 * most, "{unknown} {off:e} of {most:e}");
    }
    free_of_matrix.certificate
}

/// A rough bowl on so many cells.
fn rough_bowl(cells: [usize; 2], cut_off: f64) -> (Arc<HalfSpace>, Vec<f64>) {
    let space = half_space(cells, [1.0; 2], Surroundings::Free, RUBBER);
    let surface = SelfAffine {
        hurst: 0.8,
        roll_off: 0.5,
        cut_off,
        slope: 0.05,
        seed: 2,
    };
    let heights = surface.heights(space.grid()).unwrap();
    let bowl = space.grid().sample(|[x, y]| 0.5 * (x * x + y * y));
    let gap: Vec<f64> = bowl
        .iter()
        .zip(&heights)
        .map(|(bowl, h)| bowl - h)
        .collect();
    let least = gap.iter().fold(f64::INFINITY, |least, gap| least.min(*gap));
    (space, gap.iter().map(|gap| gap - least).collect())
}

#[test]
fn both_find_the_same_reactions() {
    let (space, gap) = rough_bowl([12, 11], 0.25);
    for (mu, shift) in [(0.0, [0.0; 2]), (0.3, [4e-3, 2e-3]), (0.8, [0.0, -0.02])] {
        let press = Press::Approach(0.03);
        let problem = HalfSpaceProblem::new(space.clone(), gap.clone(), &[mu], press).unwrap();
        let problem = problem.dragged(Drag::Shift(shift)).unwrap();
        let kinds = agree(&problem);
        // A contact whose friction does not matter: some slip, some stick, some are open.
        assert!(kinds.open > 10 && (mu == 0.0 || (kinds.stick > 0 && kinds.slip > 0)));
    }
}

#[test]
#[ignore = "slow: run in release"]
fn both_find_the_same_reactions_at_a_thousand_contacts() {
    let (space, gap) = rough_bowl([32, 32], 0.125);
    for (mu, shift) in [(0.0, [0.0; 2]), (0.3, [4e-3, 2e-3])] {
        let press = Press::Approach(0.06);
        let problem = HalfSpaceProblem::new(space.clone(), gap.clone(), &[mu], press).unwrap();
        let problem = problem.dragged(Drag::Shift(shift)).unwrap();
        let kinds = agree(&problem);
        let mixed = mu == 0.0 || (kinds.stick > 0 && kinds.slip > 0);
        assert!(kinds.open > 10 && mixed, "{mu}: {kinds:?}");
    }
}

#[test]
fn a_given_load_and_force_are_free_modes_of_the_other_side() {
    let space = half_space([10, 9], [1.0, 0.9], Surroundings::Free, RUBBER);
    let gap = space.grid().sample(|[x, y]| 0.4 * (x * x + y * y));
    let problem = HalfSpaceProblem::new(space, gap, &[0.4], Press::Load(0.02)).unwrap();
    agree(&problem);
    let dragged = problem.dragged(Drag::Force([3e-3, -2e-3])).unwrap();
    let kinds = agree(&dragged);
    assert!(kinds.stick > 0 && kinds.slip > 0, "{kinds:?}");
}

#[test]
fn a_half_space_offers_what_a_matrix_does() {
    for around in [Surroundings::Free, Surroundings::Periodic] {
        let space = half_space([6, 5], [1.0, 0.9], around, RUBBER);
        let problem = HalfSpaceProblem::new(space.clone(), vec![0.0; 30], &[0.1], Press::Load(1.0));
        let dense = problem.unwrap().contact_problem().unwrap().dense().unwrap();
        let matrix = dense.compliance();
        let force: Vec<f64> = (0..90).map(|k| f64::from(k * k % 17) - 8.0).collect();
        let near = |found: &[f64], expected: &[f64]| {
            let pairs = found.iter().zip(expected);
            pairs.for_each(|(a, b)| assert!((a - b).abs() < 1e-12 * 8.0 * matrix.norm_max()));
        };
        near(
            &Compliance::apply(&*space, &force),
            &dense.displacement(&force),
        );
        let (to, of) = ([0, 4, 5, 40, 89], [1, 4, 30, 31, 88]);
        let few = &force[..5];
        let moved = dense.operator().apply_block(&to, &of, few);
        near(&space.apply_block(&to, &of, few), &moved);
        let own = dense.operator().diagonal_block(12..15);
        near(
            space.diagonal_block(12..15).as_flattened(),
            own.as_flattened(),
        );
        // Positive definite and symmetric on a set: what conjugate gradients need.
        let image = |at: usize| {
            let unit: Vec<f64> = (0..5).map(|k| f64::from(u8::from(k == at))).collect();
            space.precondition(&of, &unit)
        };
        let images: Vec<Vec<f64>> = (0..5).map(image).collect();
        for (i, image) in images.iter().enumerate() {
            assert!(image[i] > 0.0);
            for (j, other) in images.iter().enumerate() {
                assert!((image[j] - other[i]).abs() < 1e-12 * image[i]);
            }
        }
    }
}
