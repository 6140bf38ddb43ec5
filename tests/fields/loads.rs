//! Weight, spin, water and forces that are spread, beside closed forms and statics.
//! (Timoshenko & Goodier, Theory of Elasticity, § 32.)

use dpana::{Scene, Status, solve_steps};
use serde_json::{Value, json};

use crate::gaps::{POISSON, YOUNG, lame, off, read};
use crate::stacks::certified;

const DENSITY: f64 = 7.85e-9;

fn shipped(name: &str) -> Scene {
    let file = format!("{}/examples/scenes/{name}", env!("CARGO_MANIFEST_DIR"));
    Scene::from_file(file).unwrap()
}

/// Radial displacement of a spinning hollow cylinder of radii a and b without strain along its axis, over ω².
fn spinning([a, b]: [f64; 2], r: f64) -> f64 {
    // The disc of plane stress, with the moduli of plane strain.
    let (young, v) = (YOUNG / (1.0 - POISSON * POISSON), POISSON / (1.0 - POISSON));
    let [aa, bb, rr] = [a * a, b * b, r * r];
    let k = DENSITY / 8.0;
    let radial = (3.0 + v) * k * (aa + bb - aa * bb / rr - rr);
    let hoop = k * ((3.0 + v) * (aa + bb + aa * bb / rr) - (1.0 + 3.0 * v) * rr);
    r / young * (hoop - v * radial)
}

#[test]
fn a_spinning_fit_loses_the_pressure_that_the_closed_form_takes() {
    // Shaft and hub of the press fit grow apart by ω² (u_hub − u_shaft) at their joint.
    let scene = shipped("spinning_fit.json");
    let apart = spinning([20.0, 40.0], 20.0) - spinning([8.0, 20.0], 20.0);
    let mut speeds = Vec::new();
    solve_steps(&scene, None, |solution| {
        assert_eq!(solution.status(), Status::Certified);
        let report = solution.report()?;
        let squared = report.step.as_ref().unwrap().driven[0].1 * 4000.0 * 4000.0;
        let left = lame(0.02 - squared * apart);
        assert!(
            off(&report, left) < 5e-3,
            "{squared} {left} {}",
            off(&report, left)
        );
        speeds.push(left);
        Ok(())
    })
    .unwrap();
    // It takes a good part of the fit, so that a wrong spin would show.
    assert!(
        speeds.len() == 3 && speeds[2] < 0.5 * speeds[0],
        "{speeds:?}"
    );
}

#[test]
fn a_spinning_plate_and_bar_pull_with_the_force_of_their_mass() {
    // m ω² x̄ on the wall that holds the plate, whatever its cells.
    let spin = |point: &[f64], direction: Value| {
        let mut spin = json!({"speed": 3, "point": point});
        if !direction.is_null() {
            spin["direction"] = direction;
        }
        spin
    };
    let plane = |cell: &str| {
        json!({
            "bodies": [{
                "mesh": {"rectangle": {"x": [1, 3], "y": [-1, 0], "cells": [4, 3], "cell": cell}},
                "model": {"plane_stress": {"thickness": 0.5}},
                "materials": [{"young": 1000, "poisson": 0.3, "density": 2}],
                "supports": [{"group": "left", "displacement": [0, 0]}],
                "loads": [{"centrifugal": spin(&[0.0, 0.0], Value::Null)}]
            }],
            "contacts": [{"group": "bottom", "friction": 0,
                          "obstacle": {"plane": {"point": [0, -9], "normal": [0, 1]}}}]
        })
    };
    let solid = |cell: &str| {
        json!({
            "bodies": [{
                "mesh": {"box": {"x": [1, 3], "y": [-1, 0], "z": [0, 0.5], "cells": [4, 3, 2], "cell": cell}},
                "materials": [{"young": 1000, "poisson": 0.3, "density": 2}],
                "supports": [{"group": "left", "displacement": [0, 0, 0]}],
                "loads": [{"centrifugal": spin(&[0.0, 0.0, 7.0], json!([0, 0, 2]))}]
            }],
            "contacts": [{"group": "bottom", "friction": 0,
                          "obstacle": {"plane": {"point": [0, 0, -9], "normal": [0, 0, 1]}}}]
        })
    };
    let scenes = [
        plane("quad4"),
        plane("tri3"),
        plane("tri6"),
        plane("quad9"),
        solid("hex8"),
        solid("tet4"),
        solid("tet10"),
        solid("hex20"),
    ];
    for scene in scenes {
        // m = 2 · 2 · 1 · 0.5 = 2, x̄ = (2, −½): (36, −9).
        let (solution, _) = certified(&read(&scene));
        let loads = solution.balances()[0].loads;
        assert!((loads.force[0] - 36.0).abs() < 1e-11, "{loads:?}");
        assert!((loads.force[1] + 9.0).abs() < 1e-11);
        assert!(loads.force[2].abs() < 1e-11);
    }
}

#[test]
fn the_shipped_dam_carries_water_and_weight_as_statics_says() {
    // 10 m of water, γ = 9810: ½ γ h² at h/3; concrete of 2400 kg/m³ on a triangle's worth of section.
    let (solution, report) = certified(&shipped("dam.json"));
    let [push, weight] = [0.5 * 9810.0 * 100.0, 2400.0 * 9.81 * 8.0 * 10.0];
    assert!((report.totals.friction[0] + push).abs() < 1e-8 * push);
    assert!((report.totals.normal - weight).abs() < 1e-8 * weight);
    let balance = &solution.balances()[0];
    assert!((balance.loads.force[0] - push).abs() < 1e-10 * push);
    // About the origin at the foot: −push · h/3 − weight · 4.
    let moment = -push * 10.0 / 3.0 - weight * 4.0;
    assert!((balance.loads.moment[2] / moment - 1.0).abs() < 1e-12);
    assert!((report.totals.moment[0] / -moment - 1.0).abs() < 1e-8);
}

#[test]
fn a_varying_traction_and_pressure_sum_up_in_every_model() {
    // On the top of a block of 2 × 1 (× 1): p = 3 + x, t = (y, 2 + x): ∫ = 8, (2, 6) times depth or 2π r.
    let block = |model: Value, loads: Value| {
        read(&json!({
            "bodies": [{
                "mesh": {"rectangle": {"x": [0, 2], "y": [0, 1], "cells": [4, 2], "cell": "tri6"}},
                "model": model,
                "materials": [{"young": 1000, "poisson": 0.3}],
                "supports": [{"group": "bottom", "displacement": [0, 0]}],
                "loads": loads
            }],
            "contacts": [{"group": "right", "friction": 0,
                          "obstacle": {"plane": {"point": [9, 0], "normal": [-1, 0]}}}]
        }))
    };
    let loads = json!([
        {"pressure": {"value": 5, "gradient": [1, 0], "at": [2, 0]}, "group": "top"},
        {"traction": {"value": [0, 2], "gradient": [[0, 1], [1, 0]]}, "group": "top"}
    ]);
    let pi = std::f64::consts::PI;
    for (model, along, down) in [
        (json!("plane_strain"), 2.0, -2.0),
        (json!({"plane_stress": {"thickness": 0.25}}), 0.5, -0.5),
        // ∫ (3 + r) 2πr dr = 2π (6 + 8/3), ∫ (2 + r) 2πr dr = 2π (4 + 8/3); across the axis only sizes count.
        (json!("axisymmetric"), f64::NAN, -2.0 * pi * 2.0),
    ] {
        let (solution, _) = certified(&block(model, loads.clone()));
        let force = solution.balances()[0].loads.force;
        assert!((force[1] - down).abs() < 1e-12, "{force:?}");
        assert!(
            along.is_nan() || (force[0] - along).abs() < 1e-12,
            "{force:?}"
        );
    }
}

/// A block of 2 × 1 × 1 on the floor under a weight of 40; loads on its top as given.
fn on_floor(loads: &Value) -> Value {
    json!({
        "bodies": [{
            "mesh": {"box": {"x": [-1, 1], "y": [-0.5, 0.5], "z": [0, 1], "cells": [6, 4, 3]}},
            "materials": [{"young": 1000, "poisson": 0.3, "density": 2}],
            "loads": loads
        }],
        "contacts": [{"group": "bottom", "friction": 0.5,
                      "obstacle": {"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}}}]
    })
}

#[test]
fn a_force_off_the_middle_and_a_torque_reach_the_floor_whole() {
    let loads = json!([
        {"gravity": [0, 0, -10]},
        {"force": [3, 0, -20], "moment": [0, 0, 2], "at": [0.25, 0.125, 1], "group": "top"}
    ]);
    let (solution, report) = certified(&read(&on_floor(&loads)));
    assert!((report.totals.normal - 60.0).abs() < 1e-9);
    assert!((report.totals.friction[0] + 3.0).abs() < 1e-9);
    // (¼, ⅛, 1) × (3, 0, −20) + (0, 0, 2), and nothing of the weight above the origin.
    let expected = [-2.5, 3.0 + 5.0, 2.0 - 0.375];
    let contact = solution.balances()[0].contact.moment;
    for axis in 0..3 {
        assert!((contact[axis] + expected[axis]).abs() < 1e-8, "{contact:?}");
    }
}

#[test]
fn loads_that_make_no_sense_are_refused_by_place() {
    let refused = |load: Value| {
        let scene = on_floor(&json!([load]));
        match Scene::from_json(&scene.to_string(), "") {
            Ok(scene) => scene.mechanics().unwrap_err().to_string(),
            Err(error) => error.to_string(),
        }
    };
    for (load, says) in [
        (
            json!({"gravity": [0, -10]}),
            "loads[0].gravity: expected 3 entries, found 2",
        ),
        (
            json!({"gravity": [0, 0, -10], "at": [0, 0, 0]}),
            "exactly one of",
        ),
        (
            json!({"force": [0, 0, 1]}),
            "`force` and `moment` or one of them with `group`",
        ),
        (
            json!({"force": [0, 1], "group": "top"}),
            "loads[0].force: expected 3 entries",
        ),
        (
            json!({"moment": [1], "group": "top"}),
            "loads[0].moment: expected 3 entries",
        ),
        (
            json!({"force": [0, 0, 1], "group": "body"}),
            "a group of surface facets",
        ),
        (
            json!({"centrifugal": {"speed": 3, "point": [0, 0, 0]}}),
            "centrifugal.direction: nothing",
        ),
        (
            json!({"centrifugal": {"speed": 3, "point": [0, 0, 0], "direction": [0, 0, 0]}}),
            "a direction of any length but zero",
        ),
        (json!({"centrifugal": {"sped": 3}}), "did you mean `speed`"),
        (
            json!({"pressure": {"value": 1, "gradient": [1, 2]}, "group": "top"}),
            "loads[0].pressure.gradient: expected 3 entries, found 2",
        ),
        (
            json!({"traction": {"value": [1, 2, 3], "gradient": [[1, 2, 3]]}, "group": "top"}),
            "loads[0].traction.gradient: expected 3 entries, found 1",
        ),
    ] {
        let found = refused(load);
        assert!(found.contains(says), "{says}: {found}");
    }
    let mut light = on_floor(&json!([{"gravity": [0, 0, -10]}]));
    light["bodies"][0]["materials"][0]["density"] = json!(0);
    let found = read(&light).mechanics().unwrap_err().to_string();
    assert!(found.contains("`density`"), "{found}");
    light["bodies"][0]["materials"][0]["density"] = json!(-1);
    let found = read(&light).mechanics().unwrap_err().to_string();
    assert!(
        found.contains("materials[0].density: -1 is not accepted"),
        "{found}"
    );
}

#[test]
fn a_block_under_water_is_pressed_up_or_down_by_its_weight_less_that_of_the_water() {
    // Archimedes: g (ρ − ρ_w) V, whatever the depth of the water.
    let (gravity, water) = (10.0, 1.0);
    let under = |density: f64, depth: f64| {
        let pressure =
            json!({"value": water * gravity * depth, "gradient": [0, 0, -water * gravity]});
        let sides = ["left", "right", "front", "back", "bottom", "top"];
        let floor = |z: f64, up: f64| json!({"plane": {"point": [0, 0, z], "normal": [0, 0, up]}});
        read(&json!({
            "bodies": [{
                "mesh": {"box": {"x": [0, 2], "y": [0, 1], "z": [0, 1.5], "cells": [3, 2, 3]}},
                "materials": [{"young": 1e5, "poisson": 0.3, "density": density}],
                "loads": [{"gravity": [0, 0, -gravity]}, {"pressure": pressure, "group": sides}]
            }],
            "contacts": [
                {"group": "bottom", "friction": 0.3, "obstacle": floor(0.0, 1.0)},
                {"group": "top", "friction": 0.3, "obstacle": floor(1.5, -1.0), "gap": 1e-3}
            ]
        }))
    };
    for (density, depth) in [(0.4, 3.0), (0.4, 30.0), (2.5, 3.0)] {
        let (_, report) = certified(&under(density, depth));
        let rises = 3.0 * gravity * (water - density);
        let [down, up] = [0, 1].map(|pair| report.totals.pairs[pair].totals.normal);
        let expected = [(-rises).max(0.0), rises.max(0.0)];
        assert!(
            (down - expected[0]).abs() < 1e-9 * depth,
            "{down} {expected:?}"
        );
        assert!((up - expected[1]).abs() < 1e-9 * depth, "{up} {expected:?}");
    }
}
