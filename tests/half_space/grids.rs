//! Grids, loads and surroundings at the edge of what there is.

use std::sync::Arc;

use dpana::half_space::{
    Drag, ElasticHalf, Grid, HalfSpace, HalfSpaceProblem, HalfSpaceStatus, Press, SelfAffine,
    Surroundings,
};

use crate::{RUBBER, half_space, modulus};

#[test]
fn odd_flat_and_single_grids_are_solved() {
    for cells in [
        [1, 1],
        [1, 7],
        [7, 1],
        [2, 2],
        [3, 5],
        [31, 17],
        [64, 3],
        [30, 50],
        [2, 33],
    ] {
        for around in [Surroundings::Free, Surroundings::Periodic] {
            if cells == [1, 1] && around == Surroundings::Periodic {
                continue;
            }
            let space = half_space(cells, [1.0, 0.7], around, RUBBER);
            let gap = space
                .grid()
                .sample(|[x, y]| 0.1 * (x * x + 2.0 * y * y + 0.3 * x));
            let problem = HalfSpaceProblem::new(space, gap, &[0.2], Press::Load(1e-3)).unwrap();
            let problem = problem.dragged(Drag::Shift([1e-4, 2e-4])).unwrap();
            let outcome = problem.solve().unwrap();
            assert_eq!(
                outcome.status,
                HalfSpaceStatus::Certified,
                "{cells:?} {around:?} {:?}",
                outcome.certificate
            );
        }
    }
    let space = half_space([33, 1], [1.0, 1.0], Surroundings::Plane, RUBBER);
    let gap = space.grid().sample(|[x, _]| 0.1 * x * x);
    let problem = HalfSpaceProblem::new(space, gap, &[0.2], Press::Load(1e-2)).unwrap();
    let outcome = problem
        .dragged(Drag::Shift([1e-3, 0.0]))
        .unwrap()
        .solve()
        .unwrap();
    assert_eq!(
        outcome.status,
        HalfSpaceStatus::Certified,
        "{:?}",
        outcome.certificate
    );
}

#[test]
fn no_contact_and_no_load_leave_no_reaction() {
    let space = half_space([16, 16], [1.0; 2], Surroundings::Free, RUBBER);
    let gap = space.grid().sample(|[x, y]| 0.1 + x * x + y * y);
    let problem = HalfSpaceProblem::new(space, gap, &[0.5], Press::Approach(0.05)).unwrap();
    let problem = problem.dragged(Drag::Shift([1.0, 0.0])).unwrap();
    for press in [
        Press::Approach(0.05),
        Press::Approach(-1.0),
        Press::Load(0.0),
    ] {
        let outcome = problem.clone().pressed(press).unwrap().solve().unwrap();
        assert_eq!(
            outcome.status,
            HalfSpaceStatus::Certified,
            "{press:?} {:?}",
            outcome.certificate
        );
        assert!(outcome.state.reaction.iter().flatten().all(|t| *t == 0.0));
        assert_eq!(outcome.certificate.open, 256);
        assert!(outcome.work.applications() < 20.0, "{:?}", outcome.work);
    }
}

#[test]
fn a_force_on_what_is_not_pressed_has_no_equilibrium_and_none_costs_nothing() {
    let space = half_space([16, 16], [1.0; 2], Surroundings::Free, RUBBER);
    let gap = space.grid().sample(|[x, y]| x * x + y * y - 0.2);
    let problem = HalfSpaceProblem::new(space, gap, &[0.5], Press::Load(0.0)).unwrap();
    for (force, status) in [
        ([1e-3, 0.0], HalfSpaceStatus::NoEquilibrium),
        ([0.0; 2], HalfSpaceStatus::Certified),
    ] {
        let outcome = problem
            .clone()
            .dragged(Drag::Force(force))
            .unwrap()
            .solve()
            .unwrap();
        assert_eq!(outcome.status, status);
        assert!(outcome.work.applications() < 20.0, "{:?}", outcome.work);
        // It just touches: x = y = 1/32.
        assert!((outcome.state.approach - (2.0 / 1024.0 - 0.2)).abs() < 1e-15);
    }
}

#[test]
fn one_contact_carries_what_its_own_compliance_says() {
    let space = half_space([15, 15], [1.0; 2], Surroundings::Free, RUBBER);
    let mut gap = vec![1.0; 225];
    gap[112] = 0.0;
    let own = space.diagonal()[0];
    let pressed =
        HalfSpaceProblem::new(space.clone(), gap.clone(), &[0.1], Press::Approach(0.01)).unwrap();
    let outcome = pressed.solve().unwrap();
    assert_eq!(outcome.status, HalfSpaceStatus::Certified);
    assert!((outcome.state.reaction[0][112] * own / -0.01 - 1.0).abs() < 1e-12);
    let loaded = HalfSpaceProblem::new(space, gap, &[0.1], Press::Load(0.1))
        .unwrap()
        .solve()
        .unwrap();
    assert_eq!(
        loaded.status,
        HalfSpaceStatus::Certified,
        "{:?}",
        loaded.certificate
    );
    assert_eq!(loaded.state.reaction[0][112], -0.1);
    assert!((loaded.state.approach / (0.1 * own) - 1.0).abs() < 1e-12);
}

/// A rough periodic problem, in units of length and stiffness of one's choice.
fn rough(length: f64, young: f64, load: f64) -> HalfSpaceProblem {
    let material = ElasticHalf {
        young,
        poisson: 0.3,
    };
    let space = half_space([32, 32], [length; 2], Surroundings::Periodic, material);
    let surface = SelfAffine {
        hurst: 0.8,
        roll_off: length / 4.0,
        cut_off: length / 8.0,
        slope: 0.1,
        seed: 5,
    };
    let gap = surface
        .heights(space.grid())
        .unwrap()
        .iter()
        .map(|h| -h)
        .collect();
    let load = load * modulus(material) * length * length;
    let problem = HalfSpaceProblem::new(space, gap, &[0.3], Press::Load(load)).unwrap();
    problem.dragged(Drag::Shift([1e-3 * length, 0.0])).unwrap()
}

#[test]
fn units_do_not_matter() {
    let one = rough(1.0, 1.0, 0.02).solve().unwrap();
    for (length, young) in [(1e-6, 1e12), (1e6, 1e-12), (1e3, 1e6), (1e-9, 1e-3)] {
        let other = rough(length, young, 0.02).solve().unwrap();
        assert_eq!(other.status, HalfSpaceStatus::Certified);
        assert!(
            one.work.outer.abs_diff(other.work.outer) <= 1,
            "{:?} {:?}",
            one.work,
            other.work
        );
        let unit = young * length * length;
        for component in 0..3 {
            let most = one.state.reaction[component]
                .iter()
                .fold(0.0_f64, |m, t| m.max(t.abs()));
            for (a, b) in one.state.reaction[component]
                .iter()
                .zip(&other.state.reaction[component])
            {
                assert!((a - b / unit).abs() < 1e-8 * most);
            }
        }
    }
}

#[test]
fn loads_from_almost_nothing_to_full_contact_and_far_beyond() {
    for load in [1e-12, 1e-8, 1e-4, 1e-2, 1e-1, 1.0, 1e4, 1e12] {
        let outcome = rough(1.0, 1.0, load).solve().unwrap();
        assert_eq!(
            outcome.status,
            HalfSpaceStatus::Certified,
            "{load} {:?} {:?}",
            outcome.certificate,
            outcome.work
        );
        let sum: f64 = outcome.state.reaction[0].iter().sum();
        assert!((-sum / (load / 0.91) - 1.0).abs() < 1e-10);
        assert_eq!(outcome.certificate.open == 0, load >= 1.0);
    }
}

#[test]
fn friction_up_to_ten_is_solved_under_a_shift() {
    let space = half_space([32, 32], [0.25; 2], Surroundings::Free, RUBBER);
    let gap = space.grid().sample(|[x, y]| 0.5 * (x * x + y * y));
    for mu in [0.0, 1e-12, 0.1, 1.0, 3.0, 10.0] {
        let problem =
            HalfSpaceProblem::new(space.clone(), gap.clone(), &[mu], Press::Approach(0.005))
                .unwrap();
        let outcome = problem
            .dragged(Drag::Shift([2e-3, 1e-3]))
            .unwrap()
            .solve()
            .unwrap();
        assert_eq!(
            outcome.status,
            HalfSpaceStatus::Certified,
            "{mu} {:?} {:?}",
            outcome.certificate,
            outcome.work
        );
    }
}

#[test]
fn friction_up_to_ten_is_solved_on_rough_surfaces() {
    // μ|β| = 2.9: half-steps in turn part from the solution, and the coefficient grows to what it is.
    for (mu, drag) in [
        (3.0, Drag::Shift([1.0, 0.0])),
        (10.0, Drag::Shift([5e-3, 0.0])),
        (10.0, Drag::Force([0.35 * 10.0 * 0.02 / 0.91, 0.0])),
    ] {
        let problem = rough(1.0, 1.0, 0.02).with_friction(&[mu]).unwrap();
        let outcome = problem.dragged(drag).unwrap().solve().unwrap();
        let kinds = outcome.certificate;
        assert_eq!(
            outcome.status,
            HalfSpaceStatus::Certified,
            "{mu} {drag:?} {kinds:?}"
        );
        assert!(kinds.slip > 20, "{kinds:?}");
    }
}

#[test]
fn what_is_shifted_or_mirrored_gives_the_same_shifted_or_mirrored() {
    let space = half_space([24, 20], [1.0, 0.9], Surroundings::Periodic, RUBBER);
    let surface = SelfAffine {
        hurst: 0.7,
        roll_off: 0.3,
        cut_off: 0.15,
        slope: 0.1,
        seed: 9,
    };
    let gap: Vec<f64> = surface
        .heights(space.grid())
        .unwrap()
        .iter()
        .map(|h| -h)
        .collect();
    let solve = |gap: Vec<f64>, shift: [f64; 2]| {
        let problem = HalfSpaceProblem::new(space.clone(), gap, &[0.4], Press::Load(0.02)).unwrap();
        problem
            .dragged(Drag::Shift(shift))
            .unwrap()
            .solve()
            .unwrap()
            .state
            .reaction
    };
    let one = solve(gap.clone(), [1e-3, 4e-4]);
    let most = one[0].iter().fold(0.0_f64, |m, t| m.max(t.abs()));
    let moved = |cell: usize| (cell % 24 + 5) % 24 + 24 * ((cell / 24 + 13) % 20);
    let mirrored = |cell: usize| 23 - cell % 24 + 24 * (cell / 24);
    for (map, sign) in [(&moved as &dyn Fn(usize) -> usize, 1.0), (&mirrored, -1.0)] {
        let mut other = vec![0.0; gap.len()];
        (0..gap.len()).for_each(|cell| other[map(cell)] = gap[cell]);
        let other = solve(other, [sign * 1e-3, 4e-4]);
        for cell in 0..gap.len() {
            for (component, sign) in [(0, 1.0), (1, sign), (2, 1.0)] {
                assert!(
                    (one[component][cell] - sign * other[component][map(cell)]).abs() < 1e-8 * most
                );
            }
        }
    }
}

#[test]
fn threads_do_not_change_a_bit() {
    let solve = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| {
            let space = half_space([128, 128], [1.0; 2], Surroundings::Free, RUBBER);
            let gap = space
                .grid()
                .sample(|[x, y]| 0.1 * (x * x + y * y + 0.01 * (40.0 * x).sin()));
            let problem = HalfSpaceProblem::new(space, gap, &[0.3], Press::Load(0.05)).unwrap();
            problem
                .dragged(Drag::Force([0.004, 0.001]))
                .unwrap()
                .solve()
                .unwrap()
        })
    };
    let one = solve(1);
    assert_eq!(one.status, HalfSpaceStatus::Certified);
    for threads in [2, 16] {
        assert!(solve(threads) == one, "{threads} threads");
    }
}

#[test]
fn input_that_is_none_is_refused_with_its_place() {
    let refused = |error: dpana::Error, place: &str| {
        let text = error.to_string();
        assert!(
            text.starts_with(place),
            "{text} does not start with {place}"
        );
    };
    let grid = |cells, spacing| Grid::new(cells, spacing).unwrap_err();
    refused(grid([0, 3], [1.0; 2]), "grid.cells[0]");
    refused(grid([1 << 20, 1 << 20], [1.0; 2]), "grid.cells[1]");
    refused(grid([3, 3], [1.0, 0.0]), "grid.spacing[1]");
    refused(grid([3, 3], [f64::NAN, 1.0]), "grid.spacing[0]");
    let sound = Grid::new([4, 4], [1.0; 2]).unwrap();
    let make =
        |material, other| HalfSpace::new(sound, Surroundings::Free, material, other).unwrap_err();
    refused(
        make(
            ElasticHalf {
                young: 0.0,
                ..RUBBER
            },
            None,
        ),
        "half_space.material.young",
    );
    refused(
        make(
            RUBBER,
            Some(ElasticHalf {
                poisson: 0.6,
                ..RUBBER
            }),
        ),
        "half_space.other.poisson",
    );
    let single = Grid::new([1, 1], [1.0; 2]).unwrap();
    refused(
        HalfSpace::new(single, Surroundings::Periodic, RUBBER, None).unwrap_err(),
        "grid.cells[0]",
    );
    refused(
        HalfSpace::new(sound, Surroundings::Plane, RUBBER, None).unwrap_err(),
        "grid.cells[1]",
    );
    let around = |around| Arc::new(HalfSpace::new(sound, around, RUBBER, None).unwrap());
    let (free, periodic) = (around(Surroundings::Free), around(Surroundings::Periodic));
    let problem =
        |gap: Vec<f64>, mu: &[f64], press| HalfSpaceProblem::new(free.clone(), gap, mu, press);
    let mut broken = vec![0.0; 16];
    broken[7] = f64::NAN;
    refused(
        problem(broken, &[0.1], Press::Load(1.0)).unwrap_err(),
        "initial_gap[7]",
    );
    refused(
        problem(vec![0.0; 15], &[0.1], Press::Load(1.0)).unwrap_err(),
        "initial_gap",
    );
    refused(
        problem(vec![0.0; 16], &[-0.1], Press::Load(1.0)).unwrap_err(),
        "friction[0]",
    );
    refused(
        problem(vec![0.0; 16], &[0.1; 3], Press::Load(1.0)).unwrap_err(),
        "friction",
    );
    refused(
        problem(vec![0.0; 16], &[0.1], Press::Load(-1.0)).unwrap_err(),
        "load",
    );
    refused(
        problem(vec![0.0; 16], &[0.1], Press::Approach(f64::INFINITY)).unwrap_err(),
        "approach",
    );
    let mean = HalfSpaceProblem::new(periodic, vec![0.0; 16], &[0.1], Press::Approach(1.0));
    refused(mean.unwrap_err(), "approach");
    let good = problem(vec![0.0; 16], &[0.1], Press::Load(1.0)).unwrap();
    refused(
        good.clone()
            .dragged(Drag::Shift([0.0, f64::NAN]))
            .unwrap_err(),
        "shift[1]",
    );
    refused(
        good.clone()
            .after([vec![0.0; 16], vec![0.0; 3]])
            .unwrap_err(),
        "reference[1]",
    );
    // Squares of products would overflow.
    refused(
        problem(vec![0.0; 16], &[0.1], Press::Load(1e300)).unwrap_err(),
        "load",
    );
    refused(
        good.clone().dragged(Drag::Shift([0.0, 1e300])).unwrap_err(),
        "shift[1]",
    );
    refused(grid([3, 3], [1e-200, 1.0]), "grid.spacing[0]");
    let stiff = ElasticHalf {
        young: 1e300,
        ..RUBBER
    };
    refused(make(stiff, None), "half_space.material.young");
    refused(good.solve_to(0.5).unwrap_err(), "tolerance");
    let surface = SelfAffine {
        hurst: 0.8,
        roll_off: 4.0,
        cut_off: 2.0,
        slope: 0.1,
        seed: 0,
    };
    refused(
        SelfAffine {
            cut_off: 1.0,
            ..surface
        }
        .heights(&sound)
        .unwrap_err(),
        "surface.cut_off",
    );
    refused(
        SelfAffine {
            hurst: 2.0,
            ..surface
        }
        .heights(&sound)
        .unwrap_err(),
        "surface.hurst",
    );
}
