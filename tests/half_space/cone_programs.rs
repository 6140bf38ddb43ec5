//! The same contacts with a matrix, solved by the cone programs.

use dpana::ContactProblem;
use dpana::alternation::{Settings, Status, solve};
use dpana::half_space::{Drag, HalfSpaceProblem, HalfSpaceStatus, Press, SelfAffine, Surroundings};
use dpana::problem::Operator;
use faer::Mat;

use crate::{RUBBER, half_space};

/// The problem of an approach and a shift with its matrix, all cells.
fn dense(problem: &HalfSpaceProblem, approach: f64, shift: [f64; 2]) -> ContactProblem {
    let rows = problem.operator().entries(|_| true);
    let unknowns = rows.len();
    // Symmetric to round-off of the transforms.
    let entry = |i: usize, j: usize| 0.5 * (rows[i][j] + rows[j][i]);
    let operator = Operator::from_compliance(Mat::from_fn(unknowns, unknowns, entry)).unwrap();
    let cells = unknowns / 3;
    let free = (0..cells).flat_map(|_| [approach, -shift[0], -shift[1]]);
    ContactProblem::new(
        &vec![2; cells],
        problem.friction().to_vec(),
        problem.initial_gap().to_vec(),
        free.collect(),
        operator,
    )
    .unwrap()
}

#[test]
fn both_find_the_same_reactions() {
    let space = half_space([12, 11], [1.0; 2], Surroundings::Free, RUBBER);
    let surface = SelfAffine {
        hurst: 0.8,
        roll_off: 0.5,
        cut_off: 0.25,
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
    for (mu, shift) in [(0.0, [0.0; 2]), (0.3, [4e-3, 2e-3]), (0.8, [0.0, -0.02])] {
        let approach = 0.03 + least;
        let press = Press::Approach(approach);
        let problem = HalfSpaceProblem::new(space.clone(), gap.clone(), &[mu], press).unwrap();
        let problem = problem.dragged(Drag::Shift(shift)).unwrap();
        let free_of_matrix = problem.solve_to(1e-12).unwrap();
        assert_eq!(free_of_matrix.status, HalfSpaceStatus::Certified);
        let settings = Settings {
            tolerance: 1e-12,
            ..Settings::default()
        };
        let with_matrix = solve(&dense(&problem, approach, shift), &settings).unwrap();
        assert_eq!(with_matrix.status, Status::Certified);
        let most = with_matrix
            .reaction
            .iter()
            .fold(0.0_f64, |m, t| m.max(t.abs()));
        let found = &free_of_matrix.state.reaction;
        for (unknown, expected) in with_matrix.reaction.iter().enumerate() {
            let off = found[unknown % 3][unknown / 3] - expected;
            assert!(
                off.abs() < 1e-9 * most,
                "{mu} {unknown} {off:e} of {most:e}"
            );
        }
        // A contact whose friction does not matter: some slip, some stick, some are open.
        let kinds = free_of_matrix.certificate;
        assert!(kinds.open > 10 && (mu == 0.0 || (kinds.stick > 0 && kinds.slip > 0)));
    }
}
