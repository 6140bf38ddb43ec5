//! Rolling against Carter's and Kalker's theories.

use std::f64::consts::PI;
use std::sync::Arc;

use dpana::half_space::{
    Creepage, ElasticHalf, Grid, HalfSpace, HalfSpaceProblem, HalfSpaceStatus, Press, Surroundings,
};

use crate::{CORK, RUBBER, half_space, modulus};

#[test]
fn carters_cylinder_sticks_at_its_leading_edge() {
    // Like cylinders (β = 0): creepage ξ = μ (a − a')/R, Q = μ P (1 − (a'/a)²); the stick zone of half
    // length a' ends at the leading edge. Johnson (1985), section 8.3; here 1/R = 1, E* of both.
    let (a, mu, stick) = (0.1_f64, 0.3, 0.6);
    let es = 0.5 * modulus(CORK);
    let load = PI * es * a * a / 4.0;
    let mut errors = vec![];
    for n in [40, 80, 160] {
        let grid = Grid::new([n, 1], [0.25 / n as f64, 1.0]).unwrap();
        let space = HalfSpace::new(grid, Surroundings::Plane, CORK, Some(CORK)).unwrap();
        let gap = grid.sample(|[x, _]| 0.5 * x * x);
        let problem =
            HalfSpaceProblem::new(Arc::new(space), gap, &[mu], Press::Load(load)).unwrap();
        let along = [mu * a * (1.0 - stick), 0.0];
        let (outcome, steps) = problem.roll(Creepage { along, spin: 0.0 }).unwrap();
        assert_eq!(outcome.status, HalfSpaceStatus::Certified);
        assert!(steps < 20 * n, "{steps}");
        let force: f64 = outcome.state.reaction[1].iter().sum();
        errors.push(force / (mu * load * (1.0 - stick * stick)) - 1.0);
        let sticks = |cell: usize| {
            let [t_n, t_x] = [0, 1].map(|c| outcome.state.reaction[c][cell]);
            t_n < 0.0 && t_x.abs() < -mu * t_n * (1.0 - 1e-6)
        };
        let middle: Vec<f64> = (0..n)
            .filter(|&c| sticks(c))
            .map(|c| grid.position(c)[0])
            .collect();
        let (first, last) = (middle[0], middle[middle.len() - 1]);
        assert!(last > a - 3.0 * grid.spacing[0], "{last}");
        assert!(
            (first - (a - 2.0 * stick * a)).abs() < 3.0 * grid.spacing[0],
            "{first}"
        );
    }
    assert!(
        errors[2].abs() < 0.02 && errors[2].abs() < 0.6 * errors[1].abs(),
        "{errors:?}"
    );
}

#[test]
fn kalkers_creep_coefficients_of_a_circle() {
    // ν = 0.25, a = b: F_x = G a² C11 ξ_x, F_y = G a² C22 ξ_y + G a³ C23 φ; Kalker (1967), table: 4.12,
    // 3.67, 1.47. Like bodies, friction so high that (almost) nothing slips.
    let steel = ElasticHalf {
        young: 2.5,
        poisson: 0.25,
    };
    let (a, shear) = (0.1_f64, 1.0);
    let es = 0.5 * modulus(steel);
    let load = 4.0 / 3.0 * es * a.powi(3);
    let coefficients = |n: usize| {
        let grid = Grid::new([n, n], [0.22 / n as f64; 2]).unwrap();
        let space = HalfSpace::new(grid, Surroundings::Free, steel, Some(steel)).unwrap();
        let gap = grid.sample(|[x, y]| 0.5 * (x * x + y * y));
        let problem =
            HalfSpaceProblem::new(Arc::new(space), gap, &[50.0], Press::Load(load)).unwrap();
        let roll = |along: [f64; 2], spin: f64| {
            let (outcome, steps) = problem.roll(Creepage { along, spin }).unwrap();
            assert_eq!(outcome.status, HalfSpaceStatus::Certified, "{steps} steps");
            let pressed = (outcome.certificate.stick + outcome.certificate.slip) as f64;
            let radius = (pressed * grid.cell_area() / PI).sqrt();
            (
                [1, 2].map(|c| outcome.state.reaction[c].iter().sum::<f64>()),
                radius,
            )
        };
        let tiny = 1e-2;
        // The radius of as large an area as the pressed cells have: a staircase is no circle.
        let ((along, a), (across, _), (turned, _)) = (
            roll([tiny, 0.0], 0.0),
            roll([0.0, tiny], 0.0),
            roll([0.0; 2], tiny),
        );
        let unit = shear * a * a * tiny;
        [along[0] / unit, across[1] / unit, turned[1] / (unit * a)]
    };
    let (coarse, fine) = rayon::join(|| coefficients(22), || coefficients(44));
    for (at, expected) in [4.12, 3.67, 1.47].into_iter().enumerate() {
        // First order in the cell: what two grids say of the limit.
        let limit = 2.0 * fine[at].abs() - coarse[at].abs();
        assert!(
            (limit / expected - 1.0).abs() < 0.01,
            "{limit} {expected} {coarse:?} {fine:?}"
        );
    }
}

#[test]
fn rolling_without_creepage_has_no_friction_and_periodic_surfaces_do_not_roll() {
    let space = half_space([16, 16], [0.25; 2], Surroundings::Periodic, RUBBER);
    let problem = HalfSpaceProblem::new(space, vec![0.0; 256], &[0.1], Press::Load(1.0)).unwrap();
    let error = problem.roll(Creepage::default()).unwrap_err().to_string();
    assert!(error.starts_with("surroundings"), "{error}");
}
