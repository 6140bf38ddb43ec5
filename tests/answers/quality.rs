//! The oscillation of the contact pressure: of second order where the pressure is smooth, and of the
//! size of the checkerboard where there is one.

use dpana::body::{self, CellKind, graded};
use dpana::condensation::Condensed;
use dpana::kkt::{self, BodyState, Judge};
use dpana::report::{Report, ReportParts, RigidParts, StageWork};
use dpana::scene::{MeshSource, Scene};
use dpana::{Settings, solve};
use serde_json::json;

/// A block of `cells` per unit on a plane, two units wide, in two or three dimensions.
fn block(cells: [usize; 3]) -> Scene {
    let two = cells[1] == 0;
    let mesh = match two {
        true => json!({"rectangle": {"x": [-1, 1], "y": [0, 1], "cells": [cells[0], cells[2]]}}),
        false => json!({"box": {"x": [-1, 1], "y": [-1, 1], "z": [0, 1], "cells": cells}}),
    };
    let moved = if two {
        json!([0, -0.01])
    } else {
        json!([0, 0, -0.01])
    };
    let plane = match two {
        true => json!({"point": [0, 0], "normal": [0, 1]}),
        false => json!({"point": [0, 0, 0], "normal": [0, 0, 1]}),
    };
    let mut scene = json!({
        "bodies": [{
            "name": "block", "mesh": mesh,
            "materials": [{"young": 1000, "poisson": 0.3}],
            "supports": [{"group": "top", "displacement": moved}]
        }],
        "contacts": [{"group": "bottom", "friction": 0, "obstacle": {"plane": plane}}]
    });
    if two {
        scene["bodies"][0]["model"] = json!("plane_strain");
    }
    Scene::from_json(&scene.to_string(), "").unwrap()
}

/// Oscillation that the report finds in a pressure `p(x, y, number of the node along x and y)`.
fn oscillation(cells: [usize; 3], pressure: impl Fn([f64; 2], [i64; 2]) -> f64) -> Option<f64> {
    let mechanics = block(cells).mechanics().unwrap();
    let condensed = Condensed::new(&mechanics.bodies, &mechanics.contacts).unwrap();
    let (surface, problem) = (condensed.surface(), condensed.problem());
    let along = |x: f64, axis: usize| (0.5 * (x + 1.0) * cells[axis] as f64).round() as i64;
    let reaction: Vec<f64> = surface
        .nodes
        .iter()
        .map(|node| {
            let [x, y, _] = node.position;
            let number = [along(x, 0), if cells[1] == 0 { 0 } else { along(y, 1) }];
            -node.area * pressure([x, y], number)
        })
        .collect();
    let displacements = condensed.recover(&reaction, &[]).unwrap();
    let states = BodyState::of_bodies(&mechanics.bodies, &condensed, &reaction, &displacements);
    let balances: Vec<_> = states
        .iter()
        .map(|state| kkt::balance(state).unwrap())
        .collect();
    let mut outcome = dpana::alternation::solve(problem, &Settings::default()).unwrap();
    outcome.verdict = Judge::new(problem).measure(&reaction);
    outcome.reaction = reaction;
    let none = kkt::Worst {
        value: 0.0,
        scaled: 0.0,
        contact: 0,
    };
    let report = Report::new(&ReportParts {
        title: "",
        units: "",
        bodies: &mechanics.bodies,
        pairs: &mechanics.contacts,
        surface,
        problem,
        outcome: &outcome,
        displacements: &displacements,
        motions: &[],
        balances: &balances,
        rigid: RigidParts::default(),
        extremes: &vec![body::Extremes::default(); mechanics.bodies.len()],
        support_forces: &vec![Vec::new(); mechanics.bodies.len()],
        group_states: &[],
        departure: none,
        fits: &[],
        stages: &StageWork::default(),
        ranks: &[],
        origins: &[],
        step: None,
        notes: &[],
    });
    report.unwrap().quality.oscillation
}

#[test]
fn a_checkerboard_has_the_oscillation_of_its_amplitude() {
    for cells in [[20, 0, 4], [6, 6, 2]] {
        let found = oscillation(cells, |_, [i, j]| match (i + j) % 2 {
            0 => 5.0 * 1.1,
            _ => 5.0 * 0.9,
        });
        assert!((found.unwrap() - 0.1).abs() < 1e-12, "{cells:?}: {found:?}");
    }
}

#[test]
fn a_linear_pressure_does_not_oscillate_and_a_curved_one_of_second_order() {
    for cells in [[20, 0, 4], [6, 5, 2]] {
        let found = oscillation(cells, |[x, y], _| 5.0 + x - 0.3 * y);
        assert!(found.unwrap() < 1e-14, "{cells:?}: {found:?}");
    }
    // p = 1 + x²: d = −h², so that the oscillation is h² / (2 √mean (p − h²/2)²); at the inner nodes
    // mean p² is 1.87 up to first order in h.
    for count in [20, 40, 80] {
        let h = 2.0 / count as f64;
        let found = oscillation([count, 0, 4], |[x, _], _| 1.0 + x * x).unwrap();
        let expected = h * h / (2.0 * 1.87_f64.sqrt());
        assert!(
            (found / expected - 1.0).abs() < 2.0 * h,
            "{count}: {found} {expected}"
        );
    }
}

#[test]
fn without_pressure_there_is_nothing_to_say() {
    assert_eq!(oscillation([10, 0, 4], |_, _| 0.0), None);
    assert_eq!(oscillation([1, 1, 1], |_, _| 1.0), None);
}

#[test]
fn the_ends_of_a_hertz_contact_do_not_count() {
    // p₀ √(1 − x²/a²) with a = 1/2 ends in a vertical slope between nodes, wherever they are.
    let found = [40, 320].map(|count| {
        let hertz = |[x, _]: [f64; 2], _| (0.25_f64 - x * x).max(0.0).sqrt();
        oscillation([count, 0, 2], hertz).unwrap()
    });
    // Of second order but for the node at which the range of pressures that count begins.
    assert!(found[1] < found[0] / 8.0_f64.powf(1.5), "{found:?}");
}

#[test]
fn a_solved_hertz_contact_is_smooth_and_says_so_in_words() {
    let xs = graded(0.0, 4.0, 80, 20.0).unwrap();
    let ys = graded(0.0, 4.0, 40, 20.0).unwrap();
    let mut mesh = body::rectangle(&xs, &ys, CellKind::Quad4).unwrap();
    for [x, y, _] in &mut mesh.nodes {
        *y += *x * *x / 100.0 * (1.0 - *y / 4.0);
    }
    let mut scene = block([2, 0, 2]);
    scene.bodies[0].mesh = MeshSource::Given(mesh);
    let hold = json!({"group": "left", "displacement": [0, null]});
    scene.bodies[0]
        .supports
        .push(serde_json::from_value(hold).unwrap());
    let solution = solve(&scene).unwrap();
    let report = solution.report().unwrap();
    // (h/a)²/2 is 1e-3 with cells of a twentieth of the half-width, and more towards its ends.
    assert!(
        report.quality.oscillation.unwrap() < 5e-3,
        "{:?}",
        report.quality
    );
    assert!(
        report.summary().contains("pressure oscillates by"),
        "{}",
        report.summary()
    );
    // The estimate is made on request.
    assert_eq!(report.quality.stress_error_estimate, None);
    assert!((1e-3..0.5).contains(&solution.stress_error_estimate()));
}
