//! Bodies that supports do not hold, or not in full: contact carries what statics demands, or the
//! motion that nothing stops is named.

use dpana::body::{CellKind, box_mesh, rectangle};
use dpana::report::{Report, ReportedStatus};
use dpana::scene::{SceneBody, SceneContact, SceneLoad, SceneObstacle};
use dpana::{Scene, Solution, solve};
use serde_json::{Value, json};

use crate::stacks::{self, body, contact, hold};

fn solved(scene: &Value) -> (Solution, Report) {
    let solution = solve(&Scene::from_json(&scene.to_string(), "floating.json").unwrap()).unwrap();
    let report = solution.report().unwrap();
    (solution, report)
}

/// A certified solution, with every body in balance.
fn certified(scene: &Value) -> Report {
    let (_, report) = solved(scene);
    assert_eq!(
        report.status,
        ReportedStatus::Certified,
        "{}",
        report.summary()
    );
    assert!(report.certificate.natural_map <= 1e-12);
    assert!(report.certificate.equilibrium.unwrap().scaled <= 1e-12);
    for body in &report.certificate.bodies {
        assert!(body.force_defect.scaled < 1e-12, "{body:?}");
        assert!(body.moment_defect.scaled < 1e-12, "{body:?}");
        // A stiff block that sinks with soft ones: K u is a difference of numbers 1e6 times as large.
        assert!(body.equilibrium.scaled < 1e-9, "{body:?}");
    }
    report
}

fn no_equilibrium(scene: &Value) -> dpana::report::ReportedFailure {
    let (_, report) = solved(scene);
    assert_eq!(
        report.status,
        ReportedStatus::NoEquilibrium,
        "{}",
        report.summary()
    );
    report.failure.unwrap()
}

fn close(found: f64, expected: f64, relative: f64) {
    assert!(
        (found - expected).abs() <= relative * expected.abs(),
        "{found} {expected}"
    );
}

const WEIGHT: f64 = 1000.0;

/// Equilibrium is certified to 1e-12 of the load, and no resultant is less than a twentieth of it.
const RESULTANT: f64 = 1e-10;

/// A proof of sliding may leave a resistance of 1e-6 of what is missing.
const MISSING: f64 = 1e-6;

/// A block of unit depth on a slope of tangent `slope`, x down the slope: no support at all.
fn incline(dimension: usize, cell: &str, friction: f64, slope: f64, size: [f64; 2]) -> Value {
    let [width, height] = size;
    let (a, density) = (f64::atan(slope), WEIGHT / (width * height));
    let (along, down) = (density * a.sin(), -density * a.cos());
    let (mesh, force, plane) = if dimension == 2 {
        (
            json!({ "rectangle": { "x": [0, width], "y": [0, height], "cells": [8, 6], "cell": cell } }),
            json!([along, down]),
            json!({ "point": [0, 0], "normal": [0, 1] }),
        )
    } else {
        (
            json!({ "box": { "x": [0, width], "y": [0, 1], "z": [0, height], "cells": [4, 3, 4], "cell": cell } }),
            json!([along, 0, down]),
            json!({ "point": [0, 0, 0], "normal": [0, 0, 1] }),
        )
    };
    let model = if dimension == 2 {
        "plane_strain"
    } else {
        "solid"
    };
    json!({
        "bodies": [{ "name": "block", "mesh": mesh, "model": model,
                     "materials": [{ "young": 1e7, "poisson": 0.3 }],
                     "loads": [{ "body_force": force }] }],
        "contacts": [{ "group": "bottom", "friction": friction, "obstacle": { "plane": plane } }]
    })
}

/// references.md, item 11: R_N = W cos a, R_T = W sin a; it sticks if tan a ≤ μ.
#[test]
fn a_block_on_an_incline_sticks_just_below_the_angle_of_friction() {
    for (dimension, cell) in [(2, "quad4"), (2, "tri3"), (3, "hex8"), (3, "tet4")] {
        for friction in [0.1, 0.5] {
            for slope in [0.5 * friction, friction * (1.0 - 1e-6)] {
                let report = certified(&incline(dimension, cell, friction, slope, [2.0, 1.0]));
                let a = f64::atan(slope);
                close(report.totals.normal, WEIGHT * a.cos(), RESULTANT);
                close(report.totals.friction[0], -WEIGHT * a.sin(), RESULTANT);
                assert!(report.work.sweeps <= 5, "{:?}", report.work);
            }
        }
    }
}

#[test]
fn a_block_on_an_incline_slides_just_above_the_angle_of_friction() {
    for (dimension, cell) in [(2, "quad4"), (2, "tri3"), (3, "hex8"), (3, "tet4")] {
        for friction in [0.1, 0.5] {
            let slope = friction * (1.0 + 1e-6);
            let failure = no_equilibrium(&incline(dimension, cell, friction, slope, [2.0, 1.0]));
            assert!(
                failure.words.starts_with("block slides along +x;"),
                "{}",
                failure.words
            );
            // W sin a − μ W cos a, down to 1e-7 W, of loads that are 1e-13 W off as summed over a mesh.
            let a = f64::atan(slope);
            close(
                failure.missing,
                WEIGHT * (a.sin() - friction * a.cos()),
                10.0 * MISSING,
            );
            assert!(failure.opening.is_empty() && !failure.sliding.is_empty());
        }
    }
}

/// references.md, item 11: it tips if tan a > width / height, however rough the slope.
#[test]
fn a_slender_block_tips_about_its_lower_edge() {
    for (dimension, cell) in [(2, "quad4"), (3, "hex8")] {
        let size = [1.0, 2.0];
        certified(&incline(dimension, cell, 2.0, 0.5 * (1.0 - 1e-6), size));
        let failure = no_equilibrium(&incline(dimension, cell, 2.0, 0.5 * (1.0 + 1e-3), size));
        let axis = if dimension == 2 { "-z" } else { "+y" };
        let expected = format!("block tips about {axis} through (1, ");
        assert!(failure.words.starts_with(&expected), "{}", failure.words);
        assert!(failure.sliding.is_empty());
    }
}

/// references.md, item 10 (code_aster SSNV503), lengths in mm: a pad of 20 × 20 mm under 12000 N.
fn pad(dimension: usize, pull: f64) -> Value {
    let (area, top) = (400.0, "top");
    let (mesh, model, press, shear, plane) = if dimension == 2 {
        (
            json!({ "rectangle": { "x": [0, 20], "y": [0, 10], "cells": [10, 5] } }),
            json!({ "plane_stress": { "thickness": 20 } }),
            json!([0, -12000.0 / area]),
            json!([pull / area, 0]),
            json!({ "point": [0, 0], "normal": [0, 1] }),
        )
    } else {
        (
            json!({ "box": { "x": [0, 20], "y": [0, 20], "z": [0, 10], "cells": [5, 5, 3] } }),
            json!("solid"),
            json!([0, 0, -12000.0 / area]),
            json!([pull / area, 0, 0]),
            json!({ "point": [0, 0, 0], "normal": [0, 0, 1] }),
        )
    };
    json!({
        "bodies": [{ "name": "pad", "mesh": mesh, "model": model,
                     "materials": [{ "young": 2.1e5, "poisson": 0.0 }],
                     "loads": [{ "group": top, "traction": press },
                               { "group": "bottom", "traction": shear }] }],
        "contacts": [{ "group": "bottom", "friction": 0.3, "obstacle": { "plane": plane } }]
    })
}

#[test]
fn a_pad_without_any_spring_sticks_at_99_percent_and_slides_at_101() {
    for dimension in [2, 3] {
        let report = certified(&pad(dimension, 3564.0));
        close(report.totals.normal, 12000.0, RESULTANT);
        close(report.totals.friction[0], -3564.0, RESULTANT);
        let failure = no_equilibrium(&pad(dimension, 3636.0));
        assert!(
            failure.words.starts_with("pad slides along +x;"),
            "{}",
            failure.words
        );
        close(failure.missing, 36.0, MISSING);
    }
}

/// Twenty blocks of 1 × 0.5 m, each 1e4 N, floating one upon the other; the top one is pulled.
fn stack(cells: fn(usize) -> [usize; 2]) -> Value {
    let (mut bodies, mut contacts) = (Vec::new(), Vec::new());
    for k in 0..20 {
        let (low, high) = (0.5 * k as f64, 0.5 * (k + 1) as f64);
        let young = if k % 2 == 0 { 1e12 } else { 1e9 };
        let mut loads = vec![json!({ "body_force": [0, -2e4] })];
        if k == 19 {
            loads.push(json!({ "group": "top", "traction": [100, 0] }));
        }
        bodies.push(json!({
            "name": format!("block {k}"),
            "mesh": { "rectangle": { "x": [0, 1], "y": [low, high], "cells": cells(k) } },
            "model": "plane_strain", "materials": [{ "young": young, "poisson": 0.3 }],
            "loads": loads
        }));
        let mut contact =
            json!({ "body": format!("block {k}"), "group": "bottom", "friction": 0.4 });
        if k == 0 {
            contact["obstacle"] = json!({ "plane": { "point": [0, 0], "normal": [0, 1] } });
        } else {
            contact["against"] = json!({ "body": format!("block {}", k - 1), "group": "top" });
        }
        contacts.push(contact);
    }
    json!({ "bodies": bodies, "contacts": contacts })
}

#[test]
fn every_interface_of_a_stack_of_twenty_blocks_carries_what_stands_above_it() {
    for cells in
        [|k| [6 + k % 2, 3], |_| [5, 2], |k| [3 + k % 5, 4]] as [fn(usize) -> [usize; 2]; 3]
    {
        let report = certified(&stack(cells));
        // To 1e-12 of the whole weight, 2e5 N, beside a pull of 100 N.
        for (k, pair) in report.totals.pairs.iter().enumerate() {
            close(pair.totals.normal, 1e4 * (20 - k) as f64, 1e-8);
            close(pair.totals.friction[0], -100.0, 1e-8);
        }
        assert_eq!(report.work.factorisations, 20);
        assert!(report.work.sweeps <= 5, "{:?}", report.work);
    }
}

/// A beam of weight W, hinged at one end and resting on a round bar near the other.
#[test]
fn a_hinge_is_held_by_one_contact() {
    let scene = json!({
        "bodies": [{ "mesh": { "rectangle": { "x": [0, 4], "y": [0, 0.5], "cells": [32, 4] } },
                     "model": "plane_strain", "materials": [{ "young": 1e7, "poisson": 0.3 }],
                     "supports": [{ "at": [0, 0], "displacement": [0, 0] }],
                     "loads": [{ "body_force": [0, -WEIGHT / 2.0] }] }],
        "contacts": [{ "group": "bottom", "friction": 0,
                       "obstacle": { "circle": { "center": [3, -0.1], "radius": 0.1 } } }]
    });
    let report = certified(&scene);
    // Moments about the hinge: the bar stands at three quarters, the weight acts at one half.
    close(report.totals.normal, WEIGHT * 2.0 / 3.0, RESULTANT);
    close(
        report.certificate.bodies[0].supports.force[1],
        WEIGHT / 3.0,
        RESULTANT,
    );
}

/// Held along x only, a slider sinks onto the floor under its weight and pushes nothing sideways.
#[test]
fn a_slider_rests_on_the_floor() {
    for friction in [0.0, 0.3] {
        let scene = json!({
            "bodies": [{ "mesh": { "rectangle": { "x": [0, 1], "y": [0.25, 1.25], "cells": [6, 5] } },
                         "model": "plane_strain", "materials": [{ "young": 1e7, "poisson": 0.3 }],
                         "supports": [{ "group": "left", "displacement": [0, null] }],
                         "loads": [{ "body_force": [0, -WEIGHT] }] }],
            "contacts": [{ "group": "bottom", "friction": friction,
                           "obstacle": { "plane": { "point": [0, 0], "normal": [0, 1] } } }]
        });
        close(certified(&scene).totals.normal, WEIGHT, RESULTANT);
    }
}

/// σ_y = −p and σ_x = 0 everywhere: u_y(top) = −p h (1 − ν²)/E, lateral strain ν (1 + ν) p/E.
#[test]
fn a_block_that_floats_on_a_smooth_floor_is_a_uniform_patch() {
    let (young, poisson, p) = (1e7, 0.3, 1e4);
    let scene = json!({
        "bodies": [{ "mesh": { "rectangle": { "x": [0, 1], "y": [0, 2], "cells": [4, 5], "grading": [3, 2] } },
                     "model": "plane_strain",
                     "materials": [{ "young": young, "poisson": poisson }],
                     "loads": [{ "group": "top", "pressure": p }] }],
        "contacts": [{ "group": "bottom", "friction": 0,
                       "obstacle": { "plane": { "point": [0, 0], "normal": [0, 1] } } }]
    });
    let (solution, report) = solved(&scene);
    assert_eq!(
        report.status,
        ReportedStatus::Certified,
        "{}",
        report.summary()
    );
    // Certified to 1e-12; two digits for the ratio of a node's stiffness to the block's.
    for contact in &report.contacts {
        close(contact.pressure.unwrap(), p, 1e-10);
    }
    let at = |x, y| solution.displacement_near(0, [x, y, 0.0]).unwrap();
    close(
        at(1.0, 2.0)[1],
        -p * 2.0 * (1.0 - poisson * poisson) / young,
        1e-10,
    );
    let wider = at(1.0, 2.0)[0] - at(0.0, 2.0)[0];
    close(wider, p * poisson * (1.0 + poisson) / young, 1e-10);
}

/// A free block between a fixed one and one that is pressed down: nothing but contact on either side.
#[test]
fn a_free_block_is_squeezed_between_two_held_ones() {
    let block = |name: &str, low: f64, cells: [usize; 2], supports: Value| {
        json!({ "name": name,
                "mesh": { "rectangle": { "x": [0, 1], "y": [low, low + 1.0], "cells": cells } },
                "model": "plane_strain", "materials": [{ "young": 1e3, "poisson": 0.25 }],
                "supports": supports })
    };
    let scene = json!({
        "bodies": [
            block("base", 0.0, [5, 4], json!([{ "group": "bottom", "displacement": [0, 0] }])),
            block("free", 1.0, [7, 5], json!([])),
            block("ram", 2.0, [6, 4], json!([{ "group": "top", "displacement": [0.001, -0.01] }]))
        ],
        "contacts": [
            { "body": "free", "group": "bottom", "against": { "body": "base", "group": "top" }, "friction": 0.3 },
            { "body": "free", "group": "top", "against": { "body": "ram", "group": "bottom" }, "friction": 0.3 }
        ]
    });
    let report = certified(&scene);
    let [below, above] = [
        &report.totals.pairs[0].totals,
        &report.totals.pairs[1].totals,
    ];
    close(below.normal, above.normal, RESULTANT);
    close(below.friction[0], -above.friction[0], RESULTANT);
    assert!(below.normal > 1.0 && below.friction[0] < 0.0);
}

#[test]
fn a_body_that_is_lifted_moves_off_and_one_without_loads_stays() {
    let block = |load: Value| {
        json!({
            "bodies": [{ "name": "block", "mesh": { "rectangle": { "x": [0, 1], "y": [0, 1], "cells": [3, 3] } },
                         "model": "plane_strain", "materials": [{ "young": 1e7, "poisson": 0.3 }],
                         "loads": [{ "body_force": load }] }],
            "contacts": [{ "group": "bottom", "friction": 0.3,
                           "obstacle": { "plane": { "point": [0, 0], "normal": [0, 1] } } }]
        })
    };
    let failure = no_equilibrium(&block(json!([0, 5])));
    assert_eq!(
        failure.words,
        "block moves off along +y; missing holding force: 5"
    );
    let (solution, report) = solved(&block(json!([0, 0])));
    assert_eq!(report.status, ReportedStatus::Certified);
    assert!(solution.displacements()[0].iter().all(|u| *u == 0.0));
    assert_eq!(report.work.cone_iterations, 0);
}

#[test]
fn units_and_the_size_of_the_load_change_nothing() {
    let reference = certified(&incline(2, "quad4", 0.5, 0.45, [2.0, 1.0]));
    for factor in [1e-9, 1e9] {
        let mut scene = incline(2, "quad4", 0.5, 0.45, [2.0, 1.0]);
        let loads = &mut scene["bodies"][0]["loads"][0]["body_force"];
        for component in loads.as_array_mut().unwrap() {
            *component = json!(component.as_f64().unwrap() * factor);
        }
        let report = certified(&scene);
        close(
            report.totals.peak_pressure,
            factor * reference.totals.peak_pressure,
            // Eight digits are asked for in other units; resultants follow from statics.
            1e-8,
        );
        assert!(report.work.sweeps.abs_diff(reference.work.sweeps) <= 1);
    }
    for unit in [1e-6, 1e3] {
        let mut scene = incline(2, "quad4", 0.5, 0.45, [2.0 * unit, unit]);
        scene["bodies"][0]["materials"][0]["young"] = json!(1e7 / unit);
        let report = certified(&scene);
        close(report.totals.normal, reference.totals.normal, RESULTANT);
        assert_eq!(report.totals.slip, reference.totals.slip);
        assert!(report.work.sweeps.abs_diff(reference.work.sweeps) <= 1);
    }
}

#[test]
fn variants_for_study_need_held_bodies() {
    let scene = incline(2, "quad4", 0.5, 0.1, [2.0, 1.0]);
    let scene = Scene::from_json(&scene.to_string(), "floating.json").unwrap();
    let solution = solve(&scene).unwrap();
    let problem = solution.condensed().problem();
    let found = dpana::study::Variant::PLAIN.solve(problem, &dpana::Settings::default());
    let said = found.unwrap_err().to_string();
    assert!(said.contains("variant: Sweeps"), "{said}");
}

/// A voussoir of two cells, from one joint up to the other: two nodes for each layer.
fn voussoir(name: &str, nodes: [[f64; 2]; 6], young: f64) -> SceneBody {
    let mut mesh = rectangle(&[0.0, 1.0], &[0.0, 0.5, 1.0], CellKind::Quad4).unwrap();
    for (node, [x, y]) in mesh.nodes.iter_mut().zip(nodes) {
        *node = [x, y, 0.0];
    }
    let mut body = body(name, mesh, young, 0.2);
    body.loads.push(SceneLoad::BodyForce {
        body_force: vec![0.0, -1.0],
        group: None,
    });
    body
}

#[test]
fn an_arch_that_elastic_bodies_hold_is_not_refuted() {
    // Two voussoirs between slopes, μ = 0.7, under their weight and a push from aside. From rest Newton steps run off to
    // a motion that friction does not stop. N by an elimination of all states of the six contacts (mixed integer
    // programming on a finite element program of its own).
    let (cos, sin) = (0.777_409_653_591, 0.628_994_618_819);
    let left = [
        [cos, sin],
        [0.956_478_771_513, 0.773_877_707_227],
        [0.418_622_789_686, 0.813_601_422_292],
        [0.515_048_674_476, 1.001_006_979_141],
        [0.059_835_925_782, 0.998_208_225_765],
        [0.073_618_577_439, 1.228_136_251_055],
    ];
    let right = [
        [0.059_835_925_782, 0.998_208_225_765],
        [0.073_618_577_439, 1.228_136_251_055],
        [-0.358_786_863_904, 0.813_601_422_292],
        [-0.441_430_097_037, 1.001_006_979_141],
        [-cos, sin],
        [-0.956_478_771_513, 0.773_877_707_227],
    ];
    let mut pushed = voussoir("v0", left, 141.875_824_147_128);
    pushed.loads.push(SceneLoad::Traction {
        traction: vec![0.457_408_705_216, 0.0],
        group: "right".into(),
    });
    let slope = |sign: f64| SceneObstacle::plane(&[sign * cos, sin], &[-sign * sin, cos]);
    let contacts = vec![
        SceneContact::on(slope(1.0), "bottom", 0.7).of("v0"),
        contact(["v0", "top"], ["v1", "bottom"], 0.7),
        SceneContact::on(slope(-1.0), "top", 0.7).of("v1"),
    ];
    let bodies = vec![pushed, voussoir("v1", right, 269_081.301_053_165)];
    let (_, report) = stacks::certified(&Scene::new(bodies, contacts));
    close(report.totals.normal, 0.770_721_706_694, 1e-9);
}

#[test]
fn a_loose_block_is_held_alike_by_laws_that_are_one_where_it_stands() {
    // 32 N down and 4.8 N along x of the 6.4 N that friction holds; every law bears at least as much.
    let laws = [
        json!({"coulomb": {"friction": 0.2}}),
        json!({"coulomb": {"friction": 0.2, "shear_cap": 1e9}}),
        json!({"coulomb": {"friction": 0.2, "shear_cap": 3.0}}),
        json!({"orthotropic": {"friction": [0.2, 0.2], "direction": [1, 0.5, 0]}}),
        json!({"tresca": {"shear": 1.6}}),
        json!({"cohesion": {"tension": 0.1, "shear": 0.1, "friction": 0.2}}),
        json!("rough"),
        json!("bonded"),
    ];
    let cube = |name: &str, z: f64, cells: usize| {
        json!({
            "name": name, "materials": [{"young": 1000, "poisson": 0.25}],
            "mesh": {"box": {"x": [0, 2], "y": [0, 2], "z": [z, z + 1.0], "cells": [cells, cells, 1], "cell": "hex8"}}
        })
    };
    for law in laws {
        let (mut low, mut up) = (cube("low", 0.0, 2), cube("up", 1.0, 3));
        low["supports"] = json!([{"group": "bottom", "displacement": [0, 0, 0]}]);
        up["loads"] = json!([
            {"group": "top", "pressure": 8}, {"group": "top", "traction": [1.2, 0, 0]}
        ]);
        let pair = json!({
            "body": "up", "group": "bottom", "against": {"body": "low", "group": "top"}, "law": law
        });
        let report = certified(&json!({"bodies": [low, up], "contacts": [pair]}));
        close(report.totals.normal, 32.0, RESULTANT);
        close(report.totals.friction[0].abs(), 4.8, RESULTANT);
    }
}

#[test]
fn a_dome_that_one_contact_holds_is_pressed_without_a_spin() {
    // Friction at its apex resists no turn about the axis: the least motion has none, and the force is that without
    // friction.
    let force = |friction: f64| {
        let steps = [-1.0, 0.0, 1.0];
        let mut mesh = box_mesh(&steps, &steps, &[0.0, 0.5, 1.0], CellKind::Hex8).unwrap();
        for [x, y, z] in &mut mesh.nodes {
            *z += (1.0 - *z) * 0.05 * (*x * *x + *y * *y);
        }
        let dome = hold(body("dome", mesh, 1000.0, 0.3), "top", 2, -0.01);
        let ground = SceneObstacle::plane(&[0.0; 3], &[0.0, 0.0, 1.0]);
        let contacts = vec![SceneContact::on(ground, "bottom", friction)];
        let (_, report) = stacks::certified(&Scene::new(vec![dome], contacts));
        assert!(report.extremes.displacement.value < 0.02);
        report.totals.normal
    };
    close(force(0.2), force(0.0), 1e-9);
}
