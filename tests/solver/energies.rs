//! Energies of displacements and of reactions bound each other, and the distance to the solution.

use dpana::kkt::{Motion, energies};
use dpana::{ContactProblem, Status};
use faer::linalg::solvers::Solve;
use faer::{Col, Side};
use proptest::prelude::*;

use crate::random_problems::numbers;

/// `½ vᵀ G v`.
fn energy(problem: &ContactProblem, v: &[f64]) -> f64 {
    let v = Col::from_fn(v.len(), |k| v[k]);
    0.5 * (v.transpose() * (problem.compliance() * &v))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]
    #[test]
    fn the_sum_is_never_negative_vanishes_at_the_solution_and_bounds_the_distance_to_it(
        numbers in numbers(1..=8, 0..=2, 0.5, 0.3..1.5),
        shares in prop::collection::vec((0.0..1.0_f64, -1.0..1.0_f64, 0.0..1.5_f64), 8),
    ) {
        let (problem, outcome) = numbers.solve();
        prop_assert_eq!(outcome.status, Status::Certified);
        let solution = &outcome.reaction;
        let normals = problem.normals().iter();
        let bound: Vec<f64> = normals
            .zip(problem.friction())
            .map(|(&n, mu)| -mu * solution[n].min(0.0))
            .collect();
        let of = |forces: &[f64], reaction: &[f64]| {
            let motion = Motion { forces, amplitudes: &[] };
            energies(&problem, &bound, motion, reaction).unwrap()
        };
        let scale = energy(&problem, solution) + energy(&problem, &problem_load(&problem));
        let exact = of(solution, solution);
        prop_assert!(exact.gap <= 1e-12 * scale, "{exact:?} of {scale:e}");
        prop_assert!((exact.potential + exact.complementary).abs() <= 1e-12 * scale);

        // Any admissible reaction; any displacement that the gaps admit, by the forces that make it.
        let (mut reaction, mut u) = (vec![0.0; problem.unknowns()], vec![0.0; problem.unknowns()]);
        for (contact, block) in problem.blocks().enumerate() {
            let (pressing, along, apart) = shares[contact];
            let tangents = block.len() - 1;
            reaction[block.start] = -pressing;
            u[block.start] = problem.initial_gap()[contact] - apart;
            for k in block.skip(1) {
                reaction[k] = along * bound[contact] / (tangents as f64).sqrt();
                u[k] = along;
            }
        }
        let free = problem.free_displacement();
        let moved = Col::from_fn(u.len(), |k| u[k] - free[k]);
        let forces = problem.compliance().llt(Side::Lower).unwrap().solve(&moved);
        let forces: Vec<f64> = forces.iter().copied().collect();
        let found = of(&forces, &reaction);
        prop_assert!(found.gap >= 0.0);
        let size = found.potential.abs() + found.complementary.abs() + scale;
        let sum = found.potential + found.complementary;
        prop_assert!((sum - found.gap).abs() <= 1e-12 * size, "{found:?}");
        let apart = |from: &[f64]| -> Vec<f64> {
            from.iter().zip(solution).map(|(a, b)| a - b).collect()
        };
        let distance = energy(&problem, &apart(&forces)) + energy(&problem, &apart(&reaction));
        prop_assert!(found.gap >= distance - 1e-11 * size, "{} {distance}", found.gap);
    }
}

/// The force that would undo the free displacement.
fn problem_load(problem: &ContactProblem) -> Vec<f64> {
    let free = problem.free_displacement();
    let free = Col::from_fn(free.len(), |k| free[k]);
    let force = problem.compliance().llt(Side::Lower).unwrap().solve(&free);
    force.iter().copied().collect()
}
