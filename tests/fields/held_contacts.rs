//! Contact nodes that a support holds along the surface, while the other side moves: Coulomb's law holds there as well, and
//! the support bears the friction. Expected are μ N against the motion, and statics.

use dpana::report::Beyond;
use dpana::{Scene, Status, Variation, cases, limit, solve, solve_steps};
use serde_json::{Value, json};

use crate::gaps::read;

/// A block of 2 by 1 in plane strain, its top under a pressure that presses it down with 10.
fn block(cells: [usize; 2], supports: Value) -> Value {
    json!({
        "name": "block",
        "mesh": {"rectangle": {"x": [0, 2], "y": [0, 1], "cells": cells}},
        "model": "plane_strain",
        "materials": [{"young": 1000, "poisson": 0.3}],
        "supports": supports,
        "loads": [{"group": "top", "pressure": 5}]
    })
}

const FLOOR: &str = r#"{"plane": {"point": [0, 0], "normal": [0, 1]}}"#;

/// The block on a floor that is moved so far along x in a step.
fn on_moved_floor(group: &str, moved: f64) -> Scene {
    let floor: Value = serde_json::from_str(FLOOR).unwrap();
    read(&json!({
        "bodies": [block([4, 2], json!([{"group": group, "displacement": [0, null]}]))],
        "contacts": [{"group": "bottom", "friction": 0.3, "obstacle": floor}],
        "steps": {"at": [1], "obstacles": {"contacts[0]": [[1, moved, 0]]}}
    }))
}

/// The block on a rigid floor that is free along x under a force.
fn on_pulled_floor(group: &str, force: f64) -> Scene {
    let floor: Value = serde_json::from_str(FLOOR).unwrap();
    read(&json!({
        "bodies": [block([4, 2], json!([{"group": group, "displacement": [0, null]}]))],
        "rigid_bodies": [{"name": "floor", "surfaces": [floor], "displacement": [null, 0], "force": [force, 0]}],
        "contacts": [{"group": "bottom", "friction": 0.3, "rigid_body": "floor"}]
    }))
}

#[test]
fn an_obstacle_that_moves_drags_what_supports_hold() {
    // All nodes, one corner node of the contact, none.
    for group in ["body", "left", "top"] {
        for moved in [0.02, -0.02] {
            let solution = solve_steps(&on_moved_floor(group, moved), None, |_| Ok(())).unwrap();
            let report = solution.report().unwrap();
            assert_eq!(solution.status(), Status::Certified);
            let friction = report.totals.friction[0];
            assert!(
                (friction - 3.0 * moved.signum()).abs() < 1e-9,
                "{group}: {friction}"
            );
            assert_eq!((report.totals.stick, report.totals.slip), (0, 5));
        }
    }
}

#[test]
fn a_rigid_floor_is_held_by_what_supports_hold_up_to_the_friction_there() {
    for group in ["body", "left", "top"] {
        let held = solve(&on_pulled_floor(group, 2.9)).unwrap();
        assert_eq!(held.status(), Status::Certified, "{group}");
        assert!((held.report().unwrap().totals.friction[0] - 2.9).abs() < 1e-9);
        let pulled_off = solve(&on_pulled_floor(group, 3.1)).unwrap();
        assert_eq!(pulled_off.status(), Status::NoEquilibrium, "{group}");
    }
    let limits = limit(&on_pulled_floor("body", 2.0)).unwrap();
    let of_force = limits
        .loads
        .iter()
        .find(|load| load.place.contains("force[0]"))
        .unwrap();
    assert!(
        matches!(of_force.beyond, Beyond::Grows { factor, certified: true, .. } if (factor - 1.5).abs() < 1e-6),
        "{of_force:?}"
    );
}

#[test]
fn sides_that_supports_move_against_each_other_rub() {
    let low = |moved: f64| {
        json!({
            "name": "low",
            "mesh": {"rectangle": {"x": [-1, 3], "y": [-1, 0], "cells": [9, 2]}},
            "model": "plane_strain",
            "materials": [{"young": 1000, "poisson": 0.3}],
            "supports": [{"group": "body", "displacement": [moved, 0]}]
        })
    };
    for (own, moved, friction) in [(0.0, 0.03, 3.0), (0.03, 0.0, -3.0), (0.03, 0.03, 0.0)] {
        let up = block(
            [4, 2],
            json!([{"group": "body", "displacement": [own, null]}]),
        );
        let scene = read(&json!({
            "bodies": [up, low(moved)],
            "contacts": [{"body": "block", "group": "bottom", "against": {"body": "low", "group": "top"},
                          "friction": 0.3}]
        }));
        let solution = solve(&scene).unwrap();
        assert_eq!(solution.status(), Status::Certified);
        let report = solution.report().unwrap();
        let held = &report.certificate.bodies[0].supports.force;
        assert!((held[0] + friction).abs() < 1e-9, "{own} {moved}: {held:?}");
    }
}

#[test]
fn friction_goes_on_from_what_it_was_while_nothing_moves() {
    // Dragged to 6 = μ N, then pressed by half: it slips back to 3; pressed by three quarters again it stays; dragged on it grows.
    let history = |resolve: Option<f64>| {
        let floor: Value = serde_json::from_str(FLOOR).unwrap();
        let mut scene = json!({
            "bodies": [block([4, 2], json!([{"group": "bottom", "displacement": [0, null]}]))],
            "contacts": [{"group": "bottom", "friction": 0.6, "obstacle": floor}],
            "steps": {"at": [1, 2, 3, 4],
                      "obstacles": {"contacts[0]": [[1, 0.01, 0], [2, 0.01, 0], [3, 0.01, 0], [4, 0.02, 0]]},
                      "factors": {"bodies[0].loads[0]": [[1, 1], [2, 0.5], [3, 0.75], [4, 0.75]]}}
        });
        if let Some(part) = resolve {
            scene["steps"]["resolve"] = json!(part);
        }
        let mut friction = Vec::new();
        solve_steps(&read(&scene), None, |solution| {
            friction.push(solution.report()?.totals.friction[0]);
            Ok(())
        })
        .unwrap();
        friction
    };
    for resolve in [None, Some(1e-3)] {
        let found = history(resolve);
        for (found, expected) in found.iter().zip([6.0, 3.0, 3.0, 4.5]) {
            assert!(
                (found - expected).abs() < 1e-4,
                "{resolve:?}: {found}, {expected}"
            );
        }
    }
}

#[test]
fn two_bodies_that_supports_shift_together_rub_as_those_that_stand() {
    // Quadratic corners move with nodes that are free.
    let half = |shift: f64| {
        let body = |name: &str, y: [f64; 2], cells: [usize; 2], kind: &str, supports: Value| {
            json!({
                "name": name,
                "mesh": {"rectangle": {"x": [0, 2], "y": y, "cells": cells, "cell": kind}},
                "model": "plane_strain",
                "materials": [{"young": 1000, "poisson": 0.3}],
                "supports": supports
            })
        };
        let mut up = body(
            "up",
            [0.0, 1.0],
            [4, 2],
            "tri6",
            json!([{"group": "left", "displacement": [shift, null]}]),
        );
        up["loads"] =
            json!([{"group": "top", "pressure": 5}, {"group": "right", "traction": [1, 0]}]);
        let low = body(
            "low",
            [-1.0, 0.0],
            [3, 2],
            "quad8",
            json!([
            {"group": "left", "displacement": [shift, null]}, {"group": "bottom", "displacement": [shift, 0]}]),
        );
        let scene = read(&json!({
            "bodies": [up, low],
            "contacts": [{"body": "up", "group": "bottom", "against": {"body": "low", "group": "top"}, "friction": 0.3}]
        }));
        let solution = solve(&scene).unwrap();
        assert_eq!(solution.status(), Status::Certified);
        solution.report().unwrap().totals.friction[0]
    };
    let (still, shifted) = (half(0.0), half(0.013));
    assert!((still - shifted).abs() < 1e-9, "{still} {shifted}");
}

#[test]
fn in_space_friction_opposes_the_whole_motion() {
    let scene = read(&json!({
        "bodies": [{
            "mesh": {"box": {"x": [0, 1], "y": [0, 1], "z": [0, 1], "cells": [2, 2, 2]}},
            "materials": [{"young": 1000, "poisson": 0}],
            "supports": [{"group": "body", "displacement": [0, 0, null]}],
            "loads": [{"group": "top", "pressure": 20}]
        }],
        "contacts": [{"group": "bottom", "friction": 0.3,
                      "obstacle": {"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}}}],
        "steps": {"at": [1], "obstacles": {"contacts[0]": [[1, 0.3, 0.4, 0]]}}
    }));
    let report = solve_steps(&scene, None, |_| Ok(()))
        .unwrap()
        .report()
        .unwrap();
    let friction = &report.totals.friction;
    assert!(
        (friction[0] - 3.6).abs() + (friction[1] - 4.8).abs() < 1e-9,
        "{friction:?}"
    );
}

#[test]
fn under_an_ellipse_friction_acts_across_the_motion_too() {
    // t = N M² s / |M s|, M = diag(0.1, 0.5) along 45 degrees: the support bears what acts across.
    for group in ["body", "bottom"] {
        let scene = read(&json!({
            "bodies": [{
                "mesh": {"box": {"x": [0, 1], "y": [0, 1], "z": [0, 1], "cells": [2, 2, 2]}},
                "materials": [{"young": 1e6, "poisson": 0}],
                "supports": [{"group": group, "displacement": [null, 0, null]},
                             {"group": "top", "displacement": [0, null, null]}],
                "loads": [{"group": "top", "pressure": 20}]
            }],
            "contacts": [{"group": "bottom",
                          "law": {"orthotropic": {"friction": [0.1, 0.5], "direction": [1, 1, 0]}},
                          "obstacle": {"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}}}],
            "steps": {"at": [1], "obstacles": {"contacts[0]": [[1, 0.5, 0, 0]]}}
        }));
        let report = solve_steps(&scene, None, |_| Ok(()))
            .unwrap()
            .report()
            .unwrap();
        let friction = &report.totals.friction;
        let bound = 0.13_f64.sqrt();
        let expected = [20.0 * 0.13 / bound, -20.0 * 0.12 / bound];
        for (found, expected) in friction.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-3, "{group}: {friction:?}");
        }
    }
}

#[test]
fn where_the_other_side_moves_across_the_support_nothing_is_added() {
    // Half a block beside its plane of symmetry: pressed on, the corner has no tangent; cases that move the floor along x give it one.
    let floor: Value = serde_json::from_str(FLOOR).unwrap();
    let half = |steps: Option<Value>| {
        let mut scene = json!({
            "bodies": [block([4, 2], json!([{"group": "left", "displacement": [0, null]}]))],
            "contacts": [{"group": "bottom", "friction": 0.3, "obstacle": floor}]
        });
        if let Some(steps) = steps {
            scene["steps"] = steps;
        }
        read(&scene)
    };
    let pushed = json!({"at": [1], "obstacles": {"contacts[0]": [[1, 0, 0.01]]}});
    let solution = solve_steps(&half(Some(pushed)), None, |_| Ok(())).unwrap();
    assert_eq!(solution.condensed().problem().unknowns(), 2 * 5 - 1);
    let moved = Variation {
        name: "contacts[0].x".to_owned(),
        values: vec![0.02, -0.02],
    };
    let table = cases(&half(None), &[moved]).unwrap();
    let friction = table.column("friction_x").unwrap();
    assert!(
        (friction[0] - 3.0).abs() + (friction[1] + 3.0).abs() < 1e-9,
        "{friction:?}"
    );
}

#[test]
fn a_body_whose_nodes_all_move_as_one_stands_on_a_floor() {
    // G t cancels û to the last digit: what is left of a motion is rounding beside them, and no flight.
    let floor: Value = serde_json::from_str(FLOOR).unwrap();
    for cells in [[3, 2], [4, 2], [5, 3], [6, 2]] {
        let scene = read(&json!({
            "bodies": [{
                "mesh": {"rectangle": {"x": [0, 2], "y": [0, 1], "cells": cells}},
                "model": "plane_strain",
                "materials": [{"young": 1000, "poisson": 0.3}],
                "loads": [{"group": "body", "body_force": [0, -5]}],
                "rigid_groups": [{"group": "body", "reference_point": [0, 0], "displacement": [0, null],
                                  "rotation": [null]}]
            }],
            "contacts": [{"group": "bottom", "friction": 0.3, "obstacle": floor}]
        }));
        let solution = solve(&scene).unwrap();
        assert_eq!(solution.status(), Status::Certified, "{cells:?}");
        assert!((solution.report().unwrap().totals.normal - 10.0).abs() < 1e-9);
    }
}
