//! Springs to the ground: beds and single ones, beside springs in series and statics.

use dpana::solve;
use serde_json::{Value, json};

use crate::gaps::{off, read};
use crate::stacks::certified;

/// A block of height 1, E = 1000, ν = 0, on the springs given; a plane drawn at its top comes in by `gap`.
fn pressed(model: &Value, cell: &str, foundation: &Value, gap: f64) -> Value {
    let solid = model == "solid";
    let mesh = if solid {
        json!({"box": {"x": [0, 2], "y": [0, 1], "z": [0, 1], "cells": [4, 2, 3], "cell": cell}})
    } else {
        json!({"rectangle": {"x": [0, 2], "y": [0, 1], "cells": [5, 3], "cell": cell}})
    };
    let down = |z: f64| {
        if solid {
            vec![0.0, 0.0, z]
        } else {
            vec![0.0, z]
        }
    };
    json!({
        "bodies": [{
            "mesh": mesh, "model": model,
            "materials": [{"young": 1000, "poisson": 0}],
            "foundation": foundation
        }],
        "contacts": [{"group": "top", "friction": 0, "gap": gap,
                      "obstacle": {"plane": {"point": down(1.0), "normal": down(-1.0)}}}]
    })
}

#[test]
fn a_block_on_a_bed_is_springs_in_series() {
    // p = δ / (h/E + 1/k), in every model and kind of cell.
    let expected = 0.01 / (1.0 / 1000.0 + 1.0 / 500.0);
    let plate = json!({"plane_stress": {"thickness": 0.5}});
    for (model, cell) in [
        (json!("plane_strain"), "quad4"),
        (json!("plane_strain"), "tri6"),
        (plate, "tri3"),
        (json!("axisymmetric"), "quad8"),
        (json!("solid"), "hex8"),
        (json!("solid"), "tet4"),
        (json!("solid"), "tet10"),
    ] {
        let stiffness = match model == "solid" {
            true => json!([10, 10, 0]),
            false => json!([10, 0]),
        };
        let bed = json!([{"group": "bottom", "normal": 500, "stiffness": stiffness}]);
        let (solution, report) = certified(&read(&pressed(&model, cell, &bed, -0.01)));
        assert!(off(&report, expected) < 1e-9, "{model} {cell}");
        // The springs hold it: nothing floats, and what they carry counts as of supports.
        assert_eq!(solution.bodies()[0].free_motions(), Ok(0));
        let balance = &solution.balances()[0];
        assert!(balance.force_defect.scaled < 1e-12, "{balance:?}");
        let up = solution.bodies()[0].mesh.dimension - 1;
        assert!((balance.supports.force[up] / report.totals.normal - 1.0).abs() < 1e-9);
        assert_eq!(solution.condensed().work().factorisations, 1);
    }
}

#[test]
fn what_springs_do_not_resist_stays_free() {
    let along = |foundation: &Value| {
        let scene = pressed(&json!("plane_strain"), "quad4", foundation, -0.01);
        solve(&read(&scene)).unwrap().bodies()[0]
            .free_motions()
            .unwrap()
    };
    assert_eq!(along(&json!([{"group": "bottom", "normal": 500}])), 1);
    assert_eq!(along(&json!([{"at": [0, 0], "stiffness": [5, 5]}])), 1);
    assert_eq!(
        along(&json!([{"at": [0, 0], "stiffness": [5, 5]}, {"at": [2, 0], "stiffness": [0, 5]}])),
        0
    );
}

#[test]
fn two_springs_share_a_force_as_a_lever_does() {
    // A stiff beam of length 2 on springs of 300 and 100 at its ends, 60 down at a quarter of its length:
    // 45 and 15, so that it sinks by 0.15 at both.
    let scene = json!({
        "bodies": [{
            "mesh": {"rectangle": {"x": [0, 2], "y": [0, 1], "cells": [8, 4]}},
            "model": "plane_strain",
            "materials": [{"young": 1e9, "poisson": 0.3}],
            "foundation": [{"at": [0, 0], "stiffness": [300, 300]}, {"at": [2, 0], "stiffness": [0, 100]}],
            "loads": [{"point_force": [0, -60], "at": [0.5, 1]}]
        }],
        "contacts": [{"group": "bottom", "friction": 0,
                      "obstacle": {"plane": {"point": [0, -9], "normal": [0, 1]}}}]
    });
    let (solution, _) = certified(&read(&scene));
    for x in [0.0, 1.0, 2.0] {
        let u = solution.displacement_near(0, [x, 0.0, 0.0]).unwrap();
        assert!((u[1] + 0.15).abs() < 1e-6 && u[0].abs() < 1e-6, "{u:?}");
    }
}

#[test]
fn a_long_beam_on_a_bed_sinks_as_hetenyi_says() {
    // Under a line of force P: w = P λ/(2k), λ⁴ = k/(4 E I); ν = 0, depth 0.1, ten half waves long.
    let (young, height, bed, force) = (1e6, 0.1_f64, 200.0, 1.0);
    let inertia = height.powi(3) / 12.0;
    let wave = (bed / (4.0 * young * inertia)).powf(0.25);
    let half = 5.0 * std::f64::consts::PI / wave;
    let scene = json!({
        "bodies": [{
            "mesh": {"rectangle": {"x": [0, half], "y": [0, height], "cells": [240, 2], "cell": "quad8"}},
            "model": "plane_strain",
            "materials": [{"young": young, "poisson": 0}],
            "supports": [{"group": "left", "displacement": [0, null]}],
            "foundation": [{"group": "bottom", "normal": bed}],
            "loads": [{"traction": [0, -0.5 * force / height], "group": "left"}]
        }],
        "contacts": [{"group": "bottom", "friction": 0,
                      "obstacle": {"plane": {"point": [0, -9], "normal": [0, 1]}}}]
    });
    let (solution, _) = certified(&read(&scene));
    let sunk = -solution
        .displacement_near(0, [0.0, height / 2.0, 0.0])
        .unwrap()[1];
    let expected = force * wave / (2.0 * bed);
    // Shear adds (λ h)² of a few per cent of that.
    assert!(
        (sunk / expected - 1.0).abs() < 0.5 * (wave * height).powi(2) + 1e-3,
        "{sunk} {expected}"
    );
}

#[test]
fn springs_that_make_no_sense_are_refused_by_place() {
    for (springs, says) in [
        (
            json!([{"group": "bottom"}]),
            "bodies[0].foundation[0]: no stiffness",
        ),
        (json!([{"normal": 5}]), "neither `group` nor `at`"),
        (
            json!([{"group": "bottom", "at": [0, 0], "normal": 5}]),
            "both `group` and `at`",
        ),
        (
            json!([{"group": "bottom", "normal": -5}]),
            "foundation[0].normal: -5 is not accepted",
        ),
        (
            json!([{"group": "bottom", "stiffness": [5]}]),
            "foundation[0].stiffness: expected 2 entries",
        ),
        (json!([{"at": [0, 0], "normal": 5}]), "a node has no normal"),
        (
            json!([{"group": "body", "normal": 5}]),
            "a group of surface facets",
        ),
        (
            json!([{"group": "botom", "normal": 5}]),
            "did you mean `bottom`",
        ),
    ] {
        let scene = pressed(&json!("plane_strain"), "quad4", &springs, 0.0);
        let refused = read(&scene).mechanics().unwrap_err().to_string();
        assert!(refused.contains(says), "{says}: {refused}");
    }
}
