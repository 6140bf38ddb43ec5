//! Load histories of scenes: ledger, moving obstacles, floating bodies, restart, bad tables.

use dpana::report::Report;
use dpana::scene::SavedState;
use dpana::{Scene, Status, solve, solve_steps};
use serde_json::{Value, json};

/// A block of 2 m × 1 m, E = 1000 Pa, pressed down and pushed sideways at its top.
fn block(steps: &Value) -> Value {
    json!({
        "bodies": [{
            "name": "block",
            "mesh": {"rectangle": {"x": [0, 2], "y": [0, 1], "cells": [12, 6]}},
            "model": "plane_strain",
            "materials": [{"young": 1000, "poisson": 0.3}],
            "supports": [
                {"group": "top", "displacement": [null, -0.01]},
                {"group": "top", "displacement": [0.01, null]}
            ]
        }],
        "contacts": [{
            "group": "bottom", "friction": 0.4,
            "obstacle": {"plane": {"point": [0, 0], "normal": [0, 1]}}
        }],
        "steps": steps
    })
}

fn scene(value: &Value) -> Scene {
    Scene::from_json(&value.to_string(), "").unwrap()
}

/// The reports of all states, which must be certified.
fn history(scene: &Scene) -> Vec<Report> {
    let mut reports = Vec::new();
    solve_steps(scene, None, |solution| {
        assert_eq!(solution.status(), Status::Certified);
        assert_eq!(
            solution.condensed().work().factorisations,
            scene.bodies.len()
        );
        reports.push(solution.report()?);
        Ok(())
    })
    .unwrap();
    reports
}

fn press_and_rock() -> Value {
    let at: Vec<f64> = (1..=40).map(|k| 0.1 * f64::from(k)).collect();
    json!({
        "at": at,
        "factors": {
            "bodies[0].supports[0]": [[0, 0], [1, 1]],
            "bodies[0].supports[1]": [[1, 0], [2, 1.4], [4, -1.4]]
        }
    })
}

#[test]
fn work_is_energy_and_friction_and_what_a_step_does_not_tell_is_small() {
    let reports = history(&scene(&block(&press_and_rock())));
    let total = reports.last().unwrap().step.as_ref().unwrap().total;
    let work = total.loads + total.supports + total.obstacles;
    assert_eq!((total.loads, total.obstacles), (0.0, 0.0));
    // Both take a part that a wrong ledger could not hide in.
    assert!(
        total.dissipation > 0.05 * work && total.elastic > 0.05 * work,
        "{total:?}"
    );
    assert!((work - total.elastic - total.dissipation - total.closure).abs() < 1e-12 * work);
    // Contacts begin to slip once in each ramp of ten steps or more, and lose ½ Δt Δs of that step:
    // ½ · 1/10 · 1/10 of force times slip.
    assert!(total.closure.abs() < 0.005 * work, "{total:?}");
    for report in &reports {
        assert!(report.step.as_ref().unwrap().ledger.dissipation >= 0.0);
    }
}

#[test]
fn the_energy_of_a_fit_is_explained_and_what_closes_in_the_first_step_is_told() {
    // Between a held top and a plane that lies 0.01 deep in the block, ν = 0, without any load: a strain of
    // 0.01 on 2 m² takes ½ · 1000 · 0.01² · 2 J.
    let mut fit = block(&json!({"at": [1, 2]}));
    fit["bodies"][0]["materials"][0]["poisson"] = json!(0);
    fit["bodies"][0]["supports"] = json!([{"group": "top", "displacement": [0, 0]}]);
    fit["contacts"][0]["obstacle"]["plane"]["point"] = json!([0, 0.01]);
    let reports = history(&scene(&fit));
    for report in &reports {
        let total = report.step.as_ref().unwrap().total;
        assert!((total.fits - 0.1).abs() < 1e-13, "{total:?}");
        assert!((total.elastic - 0.1).abs() < 1e-13, "{total:?}");
        assert!(total.closure.abs() < 1e-14, "{total:?}");
    }
    let second = reports[1].step.as_ref().unwrap().ledger;
    assert_eq!(second.fits, 0.0);
    assert!(
        reports.iter().all(|report| report.notes.is_empty()),
        "{:?}",
        reports[0].notes
    );
    // The same strain by closing a gap of 0.005 first; nothing else is there that could close.
    fit["bodies"][0]["supports"] = json!([{"group": "top", "displacement": [0, -0.015]}]);
    fit["contacts"][0]["obstacle"]["plane"]["point"] = json!([0, -0.005]);
    let reports = history(&scene(&fit));
    assert!(
        reports[0].notes[0].contains("the first step closes 13 contacts"),
        "{:?}",
        reports[0].notes
    );
    assert!(reports[0].notes[0].contains("100 % of the normal force"));
    assert!(reports[1].notes.is_empty());
}

#[test]
fn a_step_in_proportion_with_constant_states_leaves_nothing_open() {
    // From rest, and on from there: everything grows in proportion.
    let steps = json!({"at": [0.5, 1, 2, 4], "factors": {
        "bodies[0].supports[0]": [[0, 0], [4, 1]],
        "bodies[0].supports[1]": [[0, 0], [4, 0.8]]
    }});
    for report in history(&scene(&block(&steps))) {
        let ledger = report.step.as_ref().unwrap().ledger;
        assert!(report.totals.slip > 0 && report.totals.stick > 0);
        assert!(ledger.dissipation > 0.0);
        assert!(ledger.closure.abs() < 1e-12 * ledger.supports, "{ledger:?}");
    }
}

#[test]
fn an_obstacle_moved_under_a_body_is_the_body_moved_over_it() {
    let at: Vec<f64> = (1..=30).map(|k| 0.1 * f64::from(k)).collect();
    let over = json!({"at": at, "factors": {
        "bodies[0].supports[0]": [[0, 0], [1, 1]],
        "bodies[0].supports[1]": [[1, 0], [2, 0.8], [3, -0.5]]
    }});
    let under = json!({"at": at,
        "factors": {
            "bodies[0].supports[0]": [[0, 0]],
            "bodies[0].supports[1]": [[0, 0]]
        },
        "obstacles": {"contacts[0]": [[0, 0, 0], [1, 0, 0.01], [2, -0.008, 0.01], [3, 0.005, 0.01]]}
    });
    let [over, under] = [over, under].map(|steps| history(&scene(&block(&steps))));
    // Certified to 1e-12 of forces of newtons and displacements of 0.01 m, and a digit or two for the condition
    // of G, 13 contacts across.
    for (a, b) in over.iter().zip(&under) {
        for (a, b) in a.contacts.iter().zip(&b.contacts) {
            assert!((a.gap - b.gap).abs() < 1e-13);
            for axis in 0..2 {
                assert!((a.force[axis] - b.force[axis]).abs() < 1e-10);
                assert!((a.slip[axis] - b.slip[axis]).abs() < 1e-13);
            }
        }
        let [a, b] = [a, b].map(|report| report.step.as_ref().unwrap().total);
        assert!((a.supports - b.obstacles).abs() < 1e-12 * a.supports.abs());
        assert!((a.dissipation - b.dissipation).abs() < 1e-12 * a.supports.abs());
        assert!(b.supports.abs() < 1e-12 * b.obstacles.abs());
    }
}

#[test]
fn the_last_of_one_step_is_the_scene_without_steps() {
    let stated = block(&Value::Null);
    let one = solve(&scene(&stated)).unwrap();
    let stepped = solve(&scene(&block(&json!({"at": [7]})))).unwrap();
    assert_eq!(one.outcome().reaction, stepped.outcome().reaction);
    assert_eq!(one.displacements(), stepped.displacements());
    assert!(one.step().is_none() && one.saved_state().is_none());
    let report = one.report().unwrap();
    assert!(!report.to_json().contains("\"step\""));
}

#[test]
fn a_floating_pad_is_pushed_to_and_fro() {
    // ν = 0 and rigid enough: pressed by 2 N in all, μ = 0.5; pushed by up to 0.9 N, less than 1 N.
    let pad = |steps: Value| {
        scene(&json!({
            "bodies": [{
                "name": "pad",
                "mesh": {"rectangle": {"x": [0, 2], "y": [0, 0.5], "cells": [8, 2]}},
                "model": "plane_strain",
                "materials": [{"young": 1000, "poisson": 0}],
                "loads": [{"pressure": 1, "group": "top"}, {"traction": [0.45, 0], "group": "bottom"}]
            }],
            "contacts": [{"group": "bottom", "friction": 0.5,
                "obstacle": {"plane": {"point": [0, 0], "normal": [0, 1]}}}],
            "steps": steps
        }))
    };
    let factors = |most: f64| json!({"bodies[0].loads[1]": [[0, 0], [1, most], [3, -most]]});
    let reports = history(&pad(json!({"at": [0.5, 1, 2, 3], "factors": factors(1.0)})));
    for (report, push) in reports.iter().zip([0.45, 0.9, 0.0, -0.9]) {
        // Equilibrium is certified to 1e-12 of the load, 2 N and 0.9 N.
        assert!((report.totals.friction[0] + push).abs() < 1e-11, "{push}");
        assert!((report.totals.normal - 2.0).abs() < 1e-11);
    }
    // Beyond the limit the history ends with the state that has no equilibrium.
    let slides = pad(json!({"at": [0.5, 1, 2, 3], "factors": factors(1.5)}));
    let mut seen = 0;
    let last = solve_steps(&slides, None, |_| {
        seen += 1;
        Ok(())
    });
    assert_eq!((last.unwrap().status(), seen), (Status::NoEquilibrium, 2));
}

#[test]
fn a_history_taken_on_is_the_history_unbroken_bit_for_bit() {
    let scene = scene(&block(&press_and_rock()));
    let mut states: Vec<String> = Vec::new();
    let unbroken = solve_steps(&scene, None, |solution| {
        states.push(solution.saved_state().unwrap().to_json());
        Ok(())
    })
    .unwrap();
    for broken_after in [1, 17, 39] {
        let saved = SavedState::from_json(&states[broken_after - 1], "state.json").unwrap();
        let mut after = Vec::new();
        let taken_on = solve_steps(&scene, Some(&saved), |solution| {
            after.push(solution.saved_state().unwrap().to_json());
            Ok(())
        })
        .unwrap();
        assert_eq!(after, states[broken_after..]);
        let [a, b] = [&unbroken, &taken_on].map(|solution| solution.report().unwrap());
        assert_eq!(
            (a.contacts, a.totals, a.step),
            (b.contacts, b.totals, b.step)
        );
    }
}

#[test]
fn what_comes_after_a_state_may_change() {
    let mut states = Vec::new();
    let mut stated = press_and_rock();
    solve_steps(&scene(&block(&stated)), None, |solution| {
        states.push(solution.saved_state().unwrap());
        Ok(())
    })
    .unwrap();
    // As it was until 2, and then on in the same direction instead of back.
    stated["factors"]["bodies[0].supports[1]"] = json!([[1, 0], [2, 1.4], [4, 3]]);
    stated["at"] = json!(stated["at"].as_array().unwrap()[..25]);
    let changed = scene(&block(&stated));
    let unbroken = solve(&changed).unwrap();
    let taken_on = solve_steps(&changed, Some(&states[19]), |_| Ok(())).unwrap();
    assert_eq!(unbroken.outcome().reaction, taken_on.outcome().reaction);
    assert_eq!(unbroken.saved_state(), taken_on.saved_state());
    assert_ne!(taken_on.saved_state().as_ref(), Some(&states[24]));
}

#[test]
fn a_state_of_another_scene_is_refused() {
    let rocked = scene(&block(&press_and_rock()));
    let mut first = None;
    solve_steps(&rocked, None, |solution| {
        first = first.take().or(solution.saved_state());
        Ok(())
    })
    .unwrap();
    let first = first.unwrap();
    let refused = |scene: &Scene, state: &SavedState| {
        let solved = solve_steps(scene, Some(state), |_| unreachable!("solved"));
        solved.unwrap_err().to_string()
    };
    let other = scene(&block(&json!({"at": [0.2, 0.3]})));
    assert!(refused(&other, &first).contains("state: step 1 at 0.1 is not accepted"));
    let mut slippery = block(&press_and_rock());
    slippery["contacts"][0]["friction"] = json!(0.3);
    let said = refused(&scene(&slippery), &first);
    assert!(
        said.contains("a state of other bodies or contacts"),
        "{said}"
    );
    let mut soft = block(&press_and_rock());
    soft["bodies"][0]["materials"][0]["young"] = json!(1001);
    assert!(refused(&scene(&soft), &first).contains("other bodies"));
    // The row at 1 is on the way to the instant 0.1.
    let mut harder = press_and_rock();
    harder["factors"]["bodies[0].supports[0]"] = json!([[0, 0], [1, 2]]);
    let said = refused(&scene(&block(&harder)), &first);
    assert!(
        said.contains("other instants, factors or motions up to 0.1"),
        "{said}"
    );
    assert!(refused(&scene(&block(&Value::Null)), &first).contains("a scene with steps"));
    let mut short = first.clone();
    short.reaction.pop();
    assert!(refused(&rocked, &short).contains("state.reaction: expected"));
    let mut short = first.clone();
    short.displacements[0].pop();
    assert!(refused(&rocked, &short).contains("state.displacements[0]: expected"));
    let mut short = first.clone();
    short.ledger.pop();
    assert!(refused(&rocked, &short).contains("state.ledger: expected 7 entries, found 6"));
    let mut late = first;
    late.steps = 0;
    assert!(refused(&rocked, &late).contains("state: step 0"));
}

#[test]
fn bad_tables_are_refused_by_place_before_anything_is_solved() {
    for (steps, expected) in [
        (json!({"at": []}), "steps.at: empty"),
        (
            json!({"at": [1, 1]}),
            "steps.at[1]: 1 is not accepted; expected an instant after",
        ),
        (
            json!({"at": [1], "factors": {"bodies[0].supports[0]": [[2, 0], [1, 1]]}}),
            "steps.factors.bodies[0].supports[0][1][0]: 1 is not accepted",
        ),
        (
            json!({"at": [1], "factors": {"bodies[0].supports[0]": [[2]]}}),
            "steps.factors.bodies[0].supports[0][0]: expected 2 entries, found 1",
        ),
        (
            json!({"at": [1], "factors": {"bodies[0].supports[0]": []}}),
            "steps.factors.bodies[0].supports[0]: empty",
        ),
        (
            json!({"at": [1], "factors": {"bodies[0].suports[0]": [[0, 1]]}}),
            "did you mean `bodies[0].supports[0]`?",
        ),
        (
            json!({"at": [1], "factors": {"bodies[0].loads[0]": [[0, 1]]}}),
            "there is no load or support `bodies[0].loads[0]`",
        ),
        (
            json!({"at": [1], "obstacles": {"contacts[1]": [[0, 0, 0]]}}),
            "there is no contact with an obstacle `contacts[1]`",
        ),
        (
            json!({"at": [1], "obstacles": {"contacts[0]": [[0, 0]]}}),
            "steps.obstacles.contacts[0][0]: expected 3 entries, found 2",
        ),
    ] {
        let refused = scene(&block(&steps)).mechanics().unwrap_err().to_string();
        assert!(refused.contains(expected), "{refused}");
    }
    let misspelt = block(&json!({"at": [1], "factor": {}})).to_string();
    let refused = Scene::from_json(&misspelt, "").unwrap_err().to_string();
    assert!(refused.contains("did you mean `factors`?"), "{refused}");
    // No JSON says NaN; code can.
    let mut coded = scene(&block(&json!({"at": [1]})));
    let steps = coded.steps.as_mut().unwrap();
    steps.factors.insert(
        "bodies[0].supports[0]".to_owned(),
        vec![vec![0.0, f64::NAN]],
    );
    assert!(
        coded
            .mechanics()
            .unwrap_err()
            .to_string()
            .contains("NaN is not a finite number")
    );
}

#[test]
fn what_comes_back_to_nothing_is_certified_as_nothing() {
    // A block that contact alone holds, pressed and let go; two that are heated between walls and cooled. What rounding
    // leaves of gaps and forces has no digits, and is held against nothing.
    for cells in [[1, 1], [3, 2], [5, 4]] {
        let mut loose = block(&json!({"at": [1, 2, 3], "factors": {
            "bodies[0].loads[0]": [[0, 0], [1, 1], [2, 0], [3, 1]]
        }}));
        loose["bodies"][0]["mesh"]["rectangle"]["cells"] = json!(cells);
        loose["bodies"][0]["supports"] = json!([{"group": "top", "displacement": [0, null]}]);
        loose["bodies"][0]["loads"] = json!([{"group": "top", "pressure": 1.0}]);
        for friction in [0.0, 0.4] {
            loose["contacts"][0]["friction"] = json!(friction);
            let normals = history(&scene(&loose))
                .iter()
                .map(|report| report.totals.normal)
                .collect::<Vec<_>>();
            assert!(
                (normals[0] - 2.0).abs() < 1e-9 && normals[1].abs() < 1e-12,
                "{normals:?}"
            );
            assert!((normals[2] - 2.0).abs() < 1e-9, "{normals:?}");
        }
        let heated = |name: &str, y: [i32; 2], wide: f64, held: &str| {
            json!({
                "name": name,
                "mesh": {"rectangle": {"x": [0, wide], "y": y, "cells": cells}},
                "model": "plane_strain",
                "materials": [{"young": 1.5, "poisson": 0, "expansion": 1e-3}],
                "supports": [{"group": held, "displacement": [0, 0]}],
                "loads": [{"temperature": 48.65}]
            })
        };
        let factors = json!([[0, 0], [1, 1], [2, 0], [3, 1], [4, 0]]);
        let walls = json!({
            "bodies": [heated("upper", [1, 2], 1.0, "top"), heated("lower", [0, 1], 1.2, "bottom")],
            "contacts": [{
                "body": "upper", "group": "bottom", "friction": 0.3,
                "against": {"body": "lower", "group": "top"}
            }],
            "steps": {"at": [1, 2, 3, 4], "factors": {
                "bodies[0].loads[0]": factors, "bodies[1].loads[0]": factors
            }}
        });
        let reports = history(&scene(&walls));
        assert!(reports[0].totals.normal > 0.05 && reports[3].totals.normal.abs() < 1e-12);
    }
}
