//! Laws beyond Coulomb's: one contact by hand for each, then many at random against the laws written out once more.

use dpana::alternation::{Outcome, Settings, Status, finish, solve, solve_from, solve_near};
use dpana::kkt::ContactStatus;
use dpana::problem::{ContactProblem, Ellipse, Floating, Law, Operator};
use dpana::trust::other_starts;
use faer::{Mat, mat};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// One contact that nothing but its own compliance of 1 m/N gives way to, without a gap.
fn alone(law: Law, friction: f64, free: &[f64]) -> ContactProblem {
    let operator = Operator::from_compliance(Mat::identity(free.len(), free.len())).unwrap();
    let tangents = [free.len() - 1];
    let problem = ContactProblem::new(
        &tangents,
        vec![friction],
        vec![0.0],
        free.to_vec(),
        operator,
    );
    problem.unwrap().with_laws(vec![law]).unwrap()
}

fn certified(problem: &ContactProblem) -> Outcome {
    let outcome = solve(problem, &Settings::default()).unwrap();
    assert_eq!(outcome.status, Status::Certified, "{:?}", outcome.verdict);
    outcome
}

fn assert_reaction(law: Law, friction: f64, free: &[f64], expected: &[f64]) {
    let outcome = certified(&alone(law, friction, free));
    let pairs = outcome.reaction.iter().zip(expected);
    assert!(
        pairs.clone().all(|(a, b)| (a - b).abs() < 1e-12),
        "{law:?}, {friction}: {:?}, not {expected:?}",
        outcome.reaction
    );
}

#[test]
fn a_cap_ends_the_growth_of_friction_with_pressure() {
    let capped = Law {
        cap: 0.25,
        ..Law::default()
    };
    assert_reaction(capped, 0.5, &[1.0, 3.0], &[-1.0, -0.25]);
    assert_reaction(capped, 0.5, &[0.4, 3.0], &[-0.4, -0.2]);
    assert_reaction(capped, 0.5, &[1.0, 0.1], &[-1.0, -0.1]);
    assert_reaction(capped, 0.5, &[-1.0, 0.1], &[0.0, 0.0]);
}

#[test]
fn a_given_bound_does_not_ask_for_pressure() {
    let given = Law {
        shear: 0.3,
        ..Law::default()
    };
    assert_reaction(given, 0.0, &[1.0, 3.0], &[-1.0, -0.3]);
    assert_reaction(given, 0.0, &[-1.0, 3.0], &[0.0, -0.3]);
    assert_reaction(given, 0.0, &[-1.0, 0.1], &[0.0, -0.1]);
    assert_reaction(given, 0.0, &[1.0, -3.0, 4.0], &[-1.0, 0.18, -0.24]);
}

#[test]
fn glue_pulls_as_far_as_it_bears_and_shears_the_less_for_it() {
    let glue = Law {
        tension: 0.25,
        shear: 0.5,
        ..Law::default()
    };
    // Held: t_N = 0.1, and 0.5 − 1 · 0.1 is left to shear.
    assert_reaction(glue, 1.0, &[-0.1, 2.0], &[0.1, -0.4]);
    assert_reaction(glue, 1.0, &[1.0, 2.0], &[-1.0, -1.5]);
    // Parted by 0.75 m.
    assert_reaction(glue, 1.0, &[-1.0, 2.0], &[0.25, -0.25]);
    let parted = certified(&alone(glue, 1.0, &[-1.0, 2.0]));
    assert_eq!(parted.verdict.status, [ContactStatus::Open]);
    assert!((parted.verdict.displacement[0] + 0.75).abs() < 1e-12);
}

#[test]
fn ties_do_not_part_and_rough_contacts_do_not_slip() {
    let bonded = Law {
        bilateral: true,
        sticks: true,
        ..Law::default()
    };
    assert_reaction(bonded, 0.0, &[-1.0, 3.0, -2.0], &[1.0, -3.0, 2.0]);
    let inseparable = Law {
        bilateral: true,
        ..Law::default()
    };
    assert_reaction(inseparable, 0.5, &[-1.0, 3.0], &[1.0, 0.0]);
    assert_reaction(inseparable, 0.5, &[1.0, 3.0], &[-1.0, -0.5]);
    let rough = Law {
        sticks: true,
        ..Law::default()
    };
    assert_reaction(rough, 0.0, &[1.0, 3.0], &[-1.0, -3.0]);
    assert_reaction(rough, 0.0, &[-1.0, 3.0], &[0.0, 0.0]);
}

#[test]
fn a_layer_is_a_spring_in_series() {
    // 1 + 1 m/N along the normal, 1 + 3 m/N along the tangent; the bodies move by half of what they would.
    let layer = Law {
        sticks: true,
        compliance: [1.0, 3.0],
        ..Law::default()
    };
    assert_reaction(layer, 0.0, &[1.0, 1.0], &[-0.5, -0.25]);
    let problem = alone(layer, 0.0, &[1.0, 1.0]);
    let outcome = certified(&problem);
    let bodies = problem.displacement_of_bodies(&outcome.verdict.displacement, &outcome.reaction);
    assert!((bodies[0] - 0.5).abs() < 1e-12 && (bodies[1] - 0.75).abs() < 1e-12);
}

#[test]
fn orthotropic_friction_slips_along_the_normal_of_its_ellipse() {
    // t = −p (μ₁ cos φ, μ₂ sin φ) and u = λ (cos φ/μ₁, sin φ/μ₂) along and across a direction at 30°, p = 2 N; G = 1
    // m/N, so that û = u − t.
    let (mu, ratio, p, slip) = (0.2, 2.5, 2.0, 0.05);
    let (c, s) = (f64::sqrt(0.75), 0.5);
    let law = Law {
        ellipse: Some(Ellipse {
            direction: [c, s],
            ratio,
        }),
        ..Law::default()
    };
    let turned = |[x, y]: [f64; 2]| [c * x - s * y, s * x + c * y];
    for phi in [0.0, 0.4, 1.1, 2.0, 3.0, 4.5] {
        let (sin, cos) = f64::sin_cos(phi);
        let t = turned([-p * mu * cos, -p * mu * ratio * sin]);
        let u = turned([slip * cos / mu, slip * sin / (mu * ratio)]);
        assert_reaction(law, mu, &[p, u[0] - t[0], u[1] - t[1]], &[-p, t[0], t[1]]);
        let problem = alone(law, mu, &[p, u[0] - t[0], u[1] - t[1]]);
        let verdict = certified(&problem).verdict;
        assert_eq!(verdict.status, [ContactStatus::Slip]);
        let found = &verdict.displacement;
        assert!((found[1] - u[0]).abs() < 1e-12 && (found[2] - u[1]).abs() < 1e-12);
    }
}

#[test]
fn sets_that_are_not_convex_and_numbers_that_are_none_are_refused() {
    let problem = alone(Law::default(), 0.5, &[1.0, 1.0]);
    let none = Law::default();
    let ellipse = |direction, ratio| Law {
        ellipse: Some(Ellipse { direction, ratio }),
        ..none
    };
    for (law, place) in [
        (
            Law {
                tension: 1.0,
                shear: 0.4,
                ..none
            },
            "laws[0].shear",
        ),
        (
            Law {
                shear: 1.0,
                cap: 0.5,
                ..none
            },
            "laws[0].cap",
        ),
        (
            Law {
                cap: f64::NAN,
                ..none
            },
            "laws[0].cap",
        ),
        (
            Law {
                tension: -1.0,
                ..none
            },
            "laws[0].tension",
        ),
        (
            Law {
                shear: f64::INFINITY,
                ..none
            },
            "laws[0].shear",
        ),
        (
            Law {
                compliance: [0.0, f64::NAN],
                ..none
            },
            "laws[0].compliance[1]",
        ),
        (ellipse([1.0, 1.0], 1.0), "laws[0].ellipse.direction"),
        (ellipse([1.0, 0.0], 0.0), "laws[0].ellipse.ratio"),
    ] {
        let refused = problem.with_laws(vec![law]).unwrap_err().to_string();
        assert!(refused.starts_with(place), "{refused}");
    }
    assert!(problem.with_laws(Vec::new()).is_err());
    // More friction would make the set concave too.
    let glued = problem
        .with_laws(vec![Law {
            tension: 1.0,
            shear: 0.5,
            ..none
        }])
        .unwrap();
    assert!(glued.with_friction(vec![0.6]).is_err());
}

#[test]
fn laws_that_add_nothing_cost_nothing() {
    let plain = alone(Law::default(), 0.5, &[1.0, 3.0]);
    assert!(plain.laws().is_none());
    // A bound far beyond what friction reaches takes the same way.
    let bounded = alone(
        Law {
            cap: 1e6,
            ..Law::default()
        },
        0.5,
        &[1.0, 3.0],
    );
    let count = |problem: &ContactProblem| {
        let work = certified(problem).work;
        [
            work.passes,
            work.sweeps,
            work.cone_iterations,
            work.newton_steps,
        ]
    };
    assert_eq!(count(&plain), count(&bounded));
}

/// A block of no weight under a lid that is pushed down by 2 N and pulled along: two contacts of 1 m/N.
fn floating(law: Law, friction: f64, down: f64, pull: f64) -> ContactProblem {
    let operator = Operator::from_compliance(Mat::identity(4, 4)).unwrap();
    let zero = vec![0.0; 2];
    let problem = ContactProblem::new(&[1, 1], vec![friction; 2], zero, vec![0.0; 4], operator);
    let modes = mat![[1.0, 0.0], [0.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
    let floating = Floating::new(modes, vec![down, pull]).unwrap();
    problem
        .unwrap()
        .with_laws(vec![law; 2])
        .unwrap()
        .float(floating)
        .unwrap()
}

#[test]
fn a_loose_block_holds_up_to_its_law_and_moves_off_beyond() {
    let glue = Law {
        tension: 0.5,
        shear: 0.5,
        ..Law::default()
    };
    let capped = Law {
        cap: 0.3,
        ..Law::default()
    };
    let given = Law {
        shear: 0.3,
        ..Law::default()
    };
    let inseparable = Law {
        bilateral: true,
        ..Law::default()
    };
    let bonded = Law {
        sticks: true,
        ..inseparable
    };
    for (law, friction, down, pull, holds) in [
        (glue, 0.0, -0.99, 0.0, true),
        (glue, 0.0, -1.01, 0.0, false),
        (glue, 0.0, -0.5, 0.99, true),
        (glue, 0.0, -0.5, 1.01, false),
        // Shear 2 (0.5 − 0.5 · 0.25) at a pull of 0.25 N per contact.
        (glue, 0.5, -0.5, 0.745, true),
        (glue, 0.5, -0.5, 0.755, false),
        (capped, 0.5, 2.0, 0.599, true),
        (capped, 0.5, 2.0, 0.601, false),
        (given, 0.0, 2.0, 0.599, true),
        (given, 0.0, 2.0, 0.601, false),
        (inseparable, 0.5, -2.0, 0.0, true),
        (inseparable, 0.5, 2.0, 0.99, true),
        (inseparable, 0.5, 2.0, 1.01, false),
        (bonded, 0.0, -2.0, 7.0, true),
    ] {
        let outcome = solve(&floating(law, friction, down, pull), &Settings::default()).unwrap();
        let expected = if holds {
            Status::Certified
        } else {
            Status::NoEquilibrium
        };
        assert_eq!(
            outcome.status, expected,
            "{law:?}, {friction}, {down}, {pull}: {outcome:?}"
        );
        if let Some(failure) = outcome.failure {
            assert!(
                failure.elastic || failure.proof.least_reaction > 10.0,
                "{failure:?}"
            );
        }
    }
}

/// Contacts in plain numbers, each with a law of its own.
#[derive(Clone, Debug)]
struct Numbers {
    problem: ContactProblem,
    settings: Settings,
}

fn law(rough: bool) -> impl Strategy<Value = Law> {
    let (size, layer) = (0.05..0.5_f64, 0.0..0.3_f64);
    let layers = (any::<bool>(), layer.clone(), layer);
    let ellipse = (0.0..6.3_f64, 0.3..3.0_f64);
    (
        0..if rough { 9_usize } else { 8 },
        size.clone(),
        size,
        ellipse,
        layers,
    )
        .prop_map(
            |(kind, a, b, (angle, ratio), (layers, normal, tangential))| {
                let (sin, cos) = angle.sin_cos();
                let ellipse = Some(Ellipse {
                    direction: [cos, sin],
                    ratio,
                });
                let none = Law::default();
                let law = match kind {
                    0 => none,
                    1 => Law { cap: a, ..none },
                    2 => Law { shear: a, ..none },
                    // Friction is up to one.
                    3 => Law {
                        tension: a,
                        shear: a + b,
                        ..none
                    },
                    4 => Law {
                        tension: a,
                        shear: a + b,
                        cap: a + b + 0.1,
                        ..none
                    },
                    5 => Law {
                        bilateral: true,
                        sticks: true,
                        ..none
                    },
                    6 => Law {
                        bilateral: true,
                        ..none
                    },
                    7 => Law { ellipse, ..none },
                    _ => Law {
                        sticks: true,
                        ..none
                    },
                };
                Law {
                    compliance: if layers {
                        [normal, tangential]
                    } else {
                        [0.0; 2]
                    },
                    ..law
                }
            },
        )
}

/// Rough contacts, which need not have a state where normals and tangents are strongly coupled, are clearly pressed or
/// open, and coupled little.
fn numbers(rough: bool) -> impl Strategy<Value = Numbers> {
    let least = if rough { 3.0 } else { 0.0 };
    (1..=12_usize, 1..=2_usize, 0.05..0.5_f64).prop_flat_map(move |(count, tangents, shift)| {
        let size = count * (1 + tangents);
        (
            prop::collection::vec((law(rough), 0.0..0.8_f64, -0.3..0.3_f64), count),
            prop::collection::vec(-1.0..1.0_f64, size),
            prop::collection::vec(-1.0..1.0_f64, size * size),
        )
            .prop_map(move |(contacts, mut free, entries)| {
                for u in free.iter_mut().step_by(1 + tangents).filter(|_| rough) {
                    *u += u.signum();
                }
                let a = Mat::from_fn(size, size, |i, j| entries[i * size + j]);
                let product = a.transpose() * &a;
                let compliance = Mat::from_fn(size, size, |i, j| {
                    let (i, j) = (i.min(j), i.max(j));
                    product[(i, j)] / size as f64 + if i == j { least + shift } else { 0.0 }
                });
                let operator = Operator::from_compliance(compliance).unwrap();
                let friction = contacts.iter().map(|contact| contact.1).collect();
                let gaps = contacts.iter().map(|contact| contact.2).collect();
                let problem =
                    ContactProblem::new(&vec![tangents; count], friction, gaps, free, operator);
                // In the plane an ellipse is a line.
                let laws = contacts.iter().map(|contact| Law {
                    ellipse: contact.0.ellipse.filter(|_| tangents == 2),
                    ..contact.0
                });
                Numbers {
                    problem: problem.unwrap().with_laws(laws.collect()).unwrap(),
                    settings: Settings::default(),
                }
            })
    })
}

/// The largest violation of a contact's law in its own terms: of its set, and of `w · (s − t) ≥ 0` for reactions `s`
/// at corners and edges of the set that its pressure allows.
fn violation(problem: &ContactProblem, outcome: &Outcome, contact: usize) -> f64 {
    let (law, mu) = (
        problem
            .laws()
            .map_or_else(Law::default, |laws| laws[contact]),
        problem.friction()[contact],
    );
    let block = problem.block(contact);
    let entry = |values: &[f64], k: usize| match k < block.len() {
        true => values[block.start + k],
        false => 0.0,
    };
    let moved = problem.displacement(&outcome.reaction);
    let t: Vec<f64> = (0..3).map(|k| entry(&outcome.reaction, k)).collect();
    let mut w: Vec<f64> = (0..3).map(|k| entry(&moved, k)).collect();
    w[0] -= problem.initial_gap()[contact];
    let mut worst = match law.bilateral {
        true => w[0].abs(),
        false => {
            let parted = (law.tension - t[0]) * w[0];
            w[0].max(t[0] - law.tension).max(parted.abs())
        }
    };
    let touches = law.bilateral || t[0] < law.tension - 1e-9;
    if law.sticks {
        let slip = w[1].hypot(w[2]);
        return worst.max(if touches { slip } else { t[1].hypot(t[2]) });
    }
    let pressure = if law.bilateral {
        f64::max(-t[0], 0.0)
    } else {
        -t[0]
    };
    let bound = (law.shear + mu * pressure).min(law.cap).max(0.0);
    let ([c, s], ratio) = match law.ellipse {
        Some(ellipse) => (ellipse.direction, ellipse.ratio),
        None => ([1.0, 0.0], 1.0),
    };
    let along = [c * t[1] + s * t[2], (c * t[2] - s * t[1]) / ratio];
    worst = worst.max(along[0].hypot(along[1]) - bound);
    for step in 0..48 {
        let (sin, cos) = (f64::from(step) * std::f64::consts::PI / 24.0).sin_cos();
        let [x, y] = match block.len() {
            2 => [cos.signum(), 0.0],
            _ => [cos, ratio * sin],
        };
        let edge = [bound * (c * x - s * y), bound * (s * x + c * y)];
        worst = worst.max(-(w[1] * (edge[0] - t[1]) + w[2] * (edge[1] - t[2])));
    }
    worst
}

fn check(numbers: &Numbers, outcome: &Outcome) -> Result<(), TestCaseError> {
    prop_assert_eq!(
        outcome.status,
        Status::Certified,
        "residual {}, {:?}",
        outcome.verdict.certificate.residual(),
        outcome.shortfall
    );
    let size = outcome
        .reaction
        .iter()
        .fold(1.0_f64, |size, t| size.max(t.abs()));
    let measured = outcome.verdict.certificate;
    for worst in [
        measured.penetration,
        measured.tension,
        measured.complementarity,
        measured.disc_excess,
        measured.dissipation_defect,
    ] {
        prop_assert!(worst.scaled < 1e-9, "{:?}", measured);
    }
    prop_assert!(
        measured.bipotential_gap.abs() < 1e-9 * size,
        "{:?}",
        measured
    );
    for contact in 0..numbers.problem.contacts() {
        let found = violation(&numbers.problem, outcome, contact);
        prop_assert!(found < 1e-10 * size, "contact {}: {:e}", contact, found);
    }
    Ok(())
}

proptest! {
    // The same problems in every run: of 4,000 in which the neighbours and six other starts were solved as well, two ended one part in
    // fifty above the tolerance or lost more than one start.
    #![proptest_config(ProptestConfig {
        cases: 96,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(20_261_130),
        ..ProptestConfig::default()
    })]

    #[test]
    fn contacts_under_all_laws_at_once_keep_them(numbers in any::<bool>().prop_flat_map(numbers)) {
        let outcome = solve(&numbers.problem, &numbers.settings).unwrap();
        check(&numbers, &outcome)?;
        prop_assert!(outcome.work.sweeps <= 5, "{:?}", outcome.work);
    }

    #[test]
    fn from_a_neighbour_and_from_other_starts_they_are_kept_too(numbers in any::<bool>().prop_flat_map(numbers)) {
        let (problem, settings) = (&numbers.problem, &numbers.settings);
        let outcome = solve(problem, settings).unwrap();
        prop_assert_eq!(outcome.status, Status::Certified);
        let again = finish(problem, settings, &outcome.reaction, &[]).unwrap();
        prop_assert_eq!(again.status, Status::Certified);
        prop_assert!(again.work.newton_steps <= 1, "{:?}", again.work);
        let free = problem.free_displacement().iter().map(|u| 1.01 * u).collect();
        let next = problem.step(free, vec![0.0; problem.unknowns()]).unwrap();
        let next = Numbers { problem: next, settings: *settings };
        check(&next, &solve_near(&next.problem, settings, &outcome).unwrap())?;
        check(&next, &solve_from(&next.problem, settings, &outcome.reaction, &[]).unwrap())?;
        let others = other_starts(problem, settings, &outcome, 6).unwrap();
        for (found, _) in &others.solutions {
            check(&numbers, found)?;
        }
        // A start may end without a certificate, and says so: measured are 2 of 4,600.
        prop_assert!(others.lost <= 1, "{}", others.lost);
    }

    /// The certificate is honest: a reaction that is off by a part in a thousand has none.
    #[test]
    fn the_judge_rejects_a_disturbed_answer(numbers in any::<bool>().prop_flat_map(numbers), pick in any::<prop::sample::Index>()) {
        let mut outcome = solve(&numbers.problem, &numbers.settings).unwrap();
        let scale = outcome.reaction.iter().fold(0.0_f64, |size, t| size.max(t.abs()));
        prop_assume!(scale > 0.0);
        outcome.reaction[pick.index(numbers.problem.unknowns())] += 1e-3 * scale;
        let judge = dpana::kkt::Judge::new(&numbers.problem);
        prop_assert!(judge.measure(&outcome.reaction).certificate.natural_map > 1e-7);
    }
}
