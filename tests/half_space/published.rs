//! What other codes and papers print of their problems, and laws of pressures at an edge.

use std::f64::consts::PI;
use std::sync::Arc;

use dpana::half_space::{
    Drag, ElasticHalf, Grid, HalfSpace, HalfSpaceProblem, HalfSpaceStatus, Press, Surroundings,
};

use crate::{RUBBER, half_space, modulus};

/// Steps, approach and peak pressure as CONTACT prints them, to four digits.
const CONTACT: [(usize, f64, f64); 6] = [
    (2, 3.274e-4, 1.208e-3),
    (6, 2.901e-3, 3.941e-3),
    (8, 5.153e-3, 5.320e-3),
    (10, 8.064e-3, 6.707e-3),
    (12, 1.160e-2, 8.075e-3),
    (35, 9.874e-2, 2.392e-2),
];

/// Displacement along x of the surface on the line y = 1e-4 after the last step.
const DRAWN_IN: [(f64, f64); 6] = [
    (-4.4, 0.1456e-1),
    (-3.4, 0.1702e-1),
    (-2.0, 0.8320e-2),
    (-0.4, 0.3243e-3),
    (1.0, -0.2093e-2),
    (3.2, -0.1655e-1),
];

#[test]
fn contacts_spence_compression_in_35_steps_is_what_it_prints() {
    // CONTACT 23.1, example `spence35` (Kalker 1990, figure 5.25): a soft sphere, ν = 0, G = 0.5, on an
    // almost rigid plane, 45² elements of 0.2 mm, μ = 0.2986, P = (k/45)³ in step k; the grid is off
    // the middle by 1e-4. Printed of the last step: 225 elements of adhesion.
    let half = |shear: f64| ElasticHalf {
        young: 2.0 * shear,
        poisson: 0.0,
    };
    let grid = Grid::new([45, 45], [0.2; 2]).unwrap();
    let space = HalfSpace::new(grid, Surroundings::Free, half(0.5), Some(half(1e5))).unwrap();
    let gap = grid.sample(|[x, y]| 0.004116 * ((x + 1e-4).powi(2) + (y + 1e-4).powi(2)));
    // To six decimals, as its input has them.
    let load = |step: usize| Press::Load((1e6 * (step as f64 / 45.0).powi(3)).round() * 1e-6);
    let first = HalfSpaceProblem::new(Arc::new(space), gap, &[0.2986], load(1)).unwrap();
    let mut problem = first;
    let mut outcome = problem.solve().unwrap();
    for step in 2..=35 {
        problem = problem.pressed(load(step)).unwrap();
        problem = problem.following(&outcome).unwrap();
        outcome = problem.solve_from(&outcome.state, 1e-10).unwrap();
        assert_eq!(outcome.status, HalfSpaceStatus::Certified, "{step}");
        assert!(outcome.work.outer <= 25, "{step} {:?}", outcome.work);
        let pressed = &outcome.state.reaction[0];
        let peak = pressed.iter().fold(0.0_f64, |most, t| most.max(-t)) / grid.cell_area();
        for (at, approach, most) in CONTACT {
            if at == step {
                let off = [outcome.state.approach / approach - 1.0, peak / most - 1.0];
                // Half of the last printed digit.
                assert!(off.iter().all(|off| off.abs() < 6e-4), "{step} {off:?}");
            }
        }
    }
    assert_eq!(outcome.certificate.stick, 225);
    let [normal, x, y] = &outcome.state.reaction;
    let moved = problem.operator().apply([normal, x, y]).unwrap();
    for (at, drawn) in DRAWN_IN {
        let found = moved[1][(at / 0.2 + 22.0).round() as usize + 45 * 22];
        assert!((found - drawn).abs() < 3e-4 * 0.017, "{at} {found} {drawn}");
    }
}

#[test]
fn a_sliding_flat_punch_has_the_exponents_of_its_edges() {
    // Johnson (1985), section 2.8: p = P cos(πγ)/(π √(a² − x²)) ((a + x)/(a − x))^γ with
    // tan πγ = μ (1 − 2ν)/(2 (1 − ν)): pressure rises towards the trailing edge.
    let (a, mu, poisson) = (0.4_f64, 0.5, 0.1);
    let material = ElasticHalf {
        young: 2.0,
        poisson,
    };
    let slope = mu * (1.0 - 2.0 * poisson) / (2.0 * (1.0 - poisson));
    let exponent = slope.atan() / PI;
    let mut errors = vec![];
    for n in [50, 100, 200, 400] {
        let space = half_space([n, 1], [1.0, 1.0], Surroundings::Plane, material);
        let grid = *space.grid();
        let gap = grid.sample(|[x, _]| if x.abs() < a { 0.0 } else { 1.0 });
        let problem = HalfSpaceProblem::new(space, gap, &[mu], Press::Load(1e-3)).unwrap();
        let problem = problem.dragged(Drag::Shift([1.0, 0.0])).unwrap();
        let outcome = problem.solve().unwrap();
        assert_eq!(outcome.status, HalfSpaceStatus::Certified);
        assert_eq!(outcome.certificate.stick, 0);
        // γ = ln(p(x)/p(−x)) / (2 ln((a + x)/(a − x))) at x = a/2.
        let at = (0..n)
            .min_by(|&i, &j| {
                let off = |cell: usize| (grid.position(cell)[0] - 0.5 * a).abs();
                off(i).total_cmp(&off(j))
            })
            .unwrap();
        let (x, pressed) = (grid.position(at)[0], &outcome.state.reaction[0]);
        let found = (pressed[at] / pressed[n - 1 - at]).ln() / (2.0 * ((a + x) / (a - x)).ln());
        errors.push(found.abs() / exponent - 1.0);
    }
    assert!(errors[3].abs() < 2e-3, "{errors:?}");
    assert!(errors[3].abs() < 0.6 * errors[2].abs(), "{errors:?}");
}

#[test]
fn a_pattern_of_waves_touches_over_the_areas_of_johnson_greenwood_and_higginson() {
    // Int. J. Mech. Sci. 27 (1985) 383–396: h = Δ cos 2πx cos 2πy is flat at p* = √2 π E* Δ. Light: two
    // Hertz contacts per square, A = 2π a², a³ = 3 (p̄/2) R/(4 E*), 1/R = 4π²Δ. Almost flat: two
    // penny-shaped cracks, 1 − A = 3/(2π) (1 − p̄/p*).
    let (amplitude, es) = (0.01, modulus(RUBBER));
    let full = 2.0_f64.sqrt() * PI * es * amplitude;
    let space = half_space([256, 256], [1.0; 2], Surroundings::Periodic, RUBBER);
    let gap = space
        .grid()
        .sample(|[x, y]| amplitude * (1.0 - (2.0 * PI * x).cos() * (2.0 * PI * y).cos()));
    let open = |part: f64| {
        let press = Press::Load(part * full);
        let problem = HalfSpaceProblem::new(space.clone(), gap.clone(), &[0.0], press).unwrap();
        let outcome = problem.solve().unwrap();
        assert_eq!(outcome.status, HalfSpaceStatus::Certified);
        outcome.certificate.open as f64 / 256.0_f64.powi(2)
    };
    let light = [0.04, 0.01].map(|part| {
        let a = (3.0 * part * full / 2.0 / (4.0 * es * 4.0 * PI * PI * amplitude)).cbrt();
        (1.0 - open(part)) / (2.0 * PI * a * a) - 1.0
    });
    let heavy = [0.8, 0.95].map(|part| open(part) / (1.5 / PI * (1.0 - part)) - 1.0);
    for errors in [light, heavy] {
        assert!(
            errors[1].abs() < 0.03 && errors[1].abs() < errors[0].abs(),
            "{errors:?}"
        );
    }
}
