//! Laws of contact in scenes: ties, glue, given bounds, layers, friction by place and by direction, each against a
//! closed form or statics.

use dpana::body::{CellKind, rectangle};
use dpana::report::ReportedContactState;
use dpana::scene::{
    MeshSource, SceneCompliance, SceneContact, SceneFrictionTable, SceneLaw, SceneLoad,
    SceneObstacle,
};
use dpana::study::Plan;
use dpana::{Scene, Status, Variation, cases, limit, solve, study};

use crate::stacks::{block, body, certified, contact, hold, scene};

/// A block of 2 m by 1 m on a floor, without Poisson's effect.
fn on_floor(law: SceneLaw, young: f64) -> Scene {
    let mesh = block(CellKind::Quad4, [0.0; 3], [2.0, 1.0, 0.0], [6, 3, 0]);
    let floor = SceneObstacle::plane(&[0.0, 0.0], &[0.0, 1.0]);
    let contact = SceneContact::on(floor, "bottom", 0.0).with_law(law);
    scene(vec![body("block", mesh, young, 0.0)], vec![contact])
}

/// The same, its top moved by this.
fn moved(law: SceneLaw, young: f64, [x, y]: [f64; 2]) -> Scene {
    let mut scene = on_floor(law, young);
    let block = scene.bodies.remove(0);
    scene
        .bodies
        .push(hold(hold(block, "top", 0, x), "top", 1, y));
    scene
}

/// The same, loose, under tractions on its top.
fn loose(law: SceneLaw, traction: [f64; 2]) -> Scene {
    let mut scene = on_floor(law, 1000.0);
    scene.bodies[0].loads.push(SceneLoad::Traction {
        traction: traction.to_vec(),
        group: "top".into(),
    });
    scene
}

fn glue(tension: f64, shear: f64, friction: f64) -> SceneLaw {
    SceneLaw::Cohesion {
        tension,
        shear,
        friction,
        shear_cap: None,
    }
}

fn coulomb(friction: f64, shear_cap: Option<f64>) -> SceneLaw {
    SceneLaw::Coulomb {
        friction: Some(friction),
        regions: Default::default(),
        table: None,
        shear_cap,
        static_friction: None,
    }
}

#[test]
fn tied_blocks_of_other_meshes_are_pulled_as_one() {
    // Uniform tension ε E over meshes that do not match: exact to round-off, as one body is.
    for kind in [
        CellKind::Quad4,
        CellKind::Tri3,
        CellKind::Hex8,
        CellKind::Tet4,
    ] {
        let up = kind.dimension() - 1;
        let (mut middle, mut top) = ([1.0; 3], [1.0; 3]);
        (middle[up], top[up]) = (1.0, 2.0);
        let (mut low, sides) = ([0.0; 3], ["left", "front"]);
        let lower = block(kind, low, middle, [3; 3]);
        low[up] = 1.0;
        let upper = block(kind, low, top, [4; 3]);
        let held = |mut part, sides: &[&str]| {
            for (axis, side) in sides.iter().take(up).enumerate() {
                part = hold(part, side, axis, 0.0);
            }
            part
        };
        let lower = held(
            hold(body("lower", lower, 1000.0, 0.3), "bottom", up, 0.0),
            &sides,
        );
        let upper = held(
            hold(body("upper", upper, 1000.0, 0.3), "top", up, 0.002),
            &sides,
        );
        let tie = contact(["upper", "bottom"], ["lower", "top"], 0.0).with_law(SceneLaw::Bonded);
        let (solution, report) = certified(&scene(vec![lower, upper], vec![tie]));
        let strain = 0.001;
        let stress = match up {
            1 => strain * 1000.0 / (1.0 - 0.09),
            _ => strain * 1000.0,
        };
        for contact in &report.contacts {
            assert_eq!(contact.state, ReportedContactState::Stick);
            assert!(
                (contact.pressure.unwrap() + stress).abs() < 1e-12 * 1000.0,
                "{contact:?}"
            );
            let shear = contact.friction_traction.as_ref().unwrap();
            assert!(shear.iter().all(|q| q.abs() < 1e-11), "{contact:?}");
        }
        for (body, u) in solution.bodies().iter().zip(solution.displacements()) {
            let axes = body.mesh.dimension;
            for (node, u) in body.mesh.nodes.iter().zip(u.chunks(axes)) {
                assert!(
                    (u[up] - strain * node[up]).abs() < 1e-14,
                    "{kind:?}: {node:?} {u:?}"
                );
            }
        }
        assert_eq!(report.totals.pairs[0].law.as_deref(), Some("bonded"));
        assert!(
            report
                .summary()
                .contains("law             bonded, at contacts[0]")
        );
    }
}

#[test]
fn a_tied_cantilever_bends_as_one_of_a_piece() {
    // Matching meshes: the same stiffness, assembled by contact forces in place of common nodes.
    let lines = |low: f64, high: f64, cells: u32| -> Vec<f64> {
        let at = |k| low + (high - low) * f64::from(k) / f64::from(cells);
        (0..=cells).map(at).collect()
    };
    let mesh = |low, high, cells| {
        rectangle(
            &lines(low, high, cells),
            &lines(0.0, 1.0, 4),
            CellKind::Quad4,
        )
        .unwrap()
    };
    let floor = || {
        // Something has to touch: far away.
        SceneContact::on(
            SceneObstacle::plane(&[0.0, -50.0], &[0.0, 1.0]),
            "bottom",
            0.0,
        )
    };
    let clamped = |part| hold(hold(part, "left", 0, 0.0), "left", 1, 0.0);
    let load = SceneLoad::Traction {
        traction: vec![0.0, -1.0],
        group: "right".into(),
    };
    let mut whole = clamped(body("whole", mesh(0.0, 6.0, 12), 1e4, 0.3));
    whole.loads.push(load.clone());
    let whole = solve(&scene(vec![whole], vec![floor()])).unwrap();
    let root = clamped(body("root", mesh(0.0, 3.0, 6), 1e4, 0.3));
    let mut tip = body("tip", mesh(3.0, 6.0, 6), 1e4, 0.3);
    tip.loads.push(load);
    let tie = contact(["root", "right"], ["tip", "left"], 0.0).with_law(SceneLaw::Bonded);
    let (tied, _) = certified(&scene(vec![root, tip], vec![tie]));
    for at in [[6.0, 0.0, 0.0], [6.0, 1.0, 0.0], [4.5, 0.5, 0.0]] {
        let (one, other) = (
            whole.displacement_near(0, at).unwrap(),
            tied.displacement_near(1, at).unwrap(),
        );
        for axis in 0..2 {
            assert!(
                (one[axis] - other[axis]).abs() < 1e-9 * one[1].abs(),
                "{one:?} {other:?}"
            );
        }
    }
}

#[test]
fn a_loose_block_holds_up_to_the_limit_load_of_its_law() {
    // Area 2 m²: tractions on the top are those on the floor, whose moment a wide block bears.
    for (law, traction, holds) in [
        (SceneLaw::Tresca { shear: 0.1 }, [0.0999, -1.0], true),
        (SceneLaw::Tresca { shear: 0.1 }, [0.1001, -1.0], false),
        (coulomb(0.5, Some(0.1)), [0.0999, -1.0], true),
        (coulomb(0.5, Some(0.1)), [0.1001, -1.0], false),
        (glue(0.5, 1.0, 0.0), [0.0, 0.4999], true),
        (glue(0.5, 1.0, 0.0), [0.0, 0.5001], false),
        (SceneLaw::Bonded, [0.3, 2.0], true),
        (SceneLaw::NoSeparation { friction: 0.0 }, [0.0, 2.0], true),
    ] {
        let solution = solve(&loose(law.clone(), traction)).unwrap();
        let expected = if holds {
            Status::Certified
        } else {
            Status::NoEquilibrium
        };
        let report = solution.report().unwrap();
        assert_eq!(
            solution.status(),
            expected,
            "{law:?}, {traction:?}: {}",
            report.summary()
        );
    }
}

#[test]
fn glue_that_is_pulled_off_pulls_on_by_what_it_bears() {
    let report = certified(&moved(glue(0.5, 1.0, 0.3), 1000.0, [0.0, 0.01])).1;
    assert_eq!(report.totals.open, report.size.contacts);
    // c A, and a gap of what the block does not give: 0.01 − c h/E.
    assert!((report.totals.normal + 0.5 * 2.0).abs() < 1e-12);
    for contact in &report.contacts {
        assert!((contact.gap - (0.01 - 0.0005)).abs() < 1e-12, "{contact:?}");
    }
    // At half of that it still holds.
    let report = certified(&moved(glue(0.5, 1.0, 0.3), 1000.0, [0.0, 0.00025])).1;
    assert!((report.totals.normal + 0.25 * 2.0).abs() < 1e-12);
    assert_eq!(report.totals.stick, report.size.contacts);
}

#[test]
fn shear_ends_at_a_given_bound_and_at_a_cap() {
    // Pushed far, everything slides: bound times area, whatever the pressure is.
    let given = certified(&moved(
        SceneLaw::Tresca { shear: 2.0 },
        1000.0,
        [0.1, -0.01],
    ))
    .1;
    assert_eq!(given.totals.slip, given.size.contacts);
    assert!(
        (given.totals.friction[0] + 2.0 * 2.0).abs() < 1e-11,
        "{:?}",
        given.totals
    );
    for contact in &given.contacts {
        assert!((contact.shear_bound.unwrap() - 2.0).abs() < 1e-12);
    }
    let capped = certified(&moved(coulomb(0.5, Some(4.0)), 1000.0, [0.1, -0.01])).1;
    for contact in capped.contacts {
        let (pressure, q) = (
            contact.pressure.unwrap(),
            contact.friction_traction.unwrap()[0],
        );
        assert!(
            (q + (0.5 * pressure).min(4.0)).abs() < 1e-9,
            "{pressure}: {q}"
        );
    }
}

#[test]
fn a_given_bound_holds_what_is_lifted_off() {
    // What is left of the pressure is round-off of any size; friction, all that acts, does not depend on the lift.
    for cells in [3, 4, 7] {
        for kind in [CellKind::Tri3, CellKind::Quad4] {
            let frictions = [3e-3, 5e-3, 0.013].map(|lift| {
                let mut scene = moved(SceneLaw::Tresca { shear: 1.6 }, 1000.0, [1.8e-3, lift]);
                let mesh = block(kind, [0.0; 3], [2.0, 0.9, 0.0], [cells, 2, 0]);
                scene.bodies[0].mesh = MeshSource::Given(mesh);
                let totals = certified(&scene).1.totals;
                assert!(totals.normal.abs() < 1e-9, "{totals:?}");
                totals.friction[0]
            });
            assert!(
                frictions[0] < -1.0 && frictions.iter().all(|t| (t - frictions[0]).abs() < 1e-9)
            );
        }
    }
}

#[test]
fn a_layer_and_a_block_are_springs_in_series() {
    // d = p (h/E + C): 0.01 = p (0.001 + 0.004).
    let mut pressed = moved(SceneLaw::Rough, 1000.0, [0.0, -0.01]);
    pressed.contacts[0].compliance = Some(SceneCompliance {
        normal: 0.004,
        tangential: 0.0,
    });
    let report = certified(&pressed).1;
    for contact in report.contacts {
        assert!(
            (contact.pressure.unwrap() - 2.0).abs() < 1e-11,
            "{contact:?}"
        );
    }
    // Along the floor a block that is as good as rigid: q = d/C.
    let mut pushed = moved(SceneLaw::Bonded, 1e9, [0.002, 0.0]);
    pushed.contacts[0].compliance = Some(SceneCompliance {
        normal: 0.0,
        tangential: 0.004,
    });
    let report = certified(&pushed).1;
    assert!(
        (report.totals.friction[0] + 0.5 * 2.0).abs() < 1e-6,
        "{:?}",
        report.totals
    );
}

#[test]
fn friction_follows_a_table_and_regions() {
    let law = SceneLaw::Coulomb {
        friction: None,
        regions: Default::default(),
        table: Some(SceneFrictionTable {
            direction: vec![2.0, 0.0],
            values: vec![vec![0.5, 0.1], vec![1.5, 0.3]],
        }),
        shear_cap: None,
        static_friction: None,
    };
    let report = certified(&moved(law, 1000.0, [0.1, -0.01])).1;
    for contact in report.contacts {
        let mu = 0.1 + 0.2 * (contact.position[0] - 0.5).clamp(0.0, 1.0);
        let (p, q) = (
            contact.pressure.unwrap(),
            contact.friction_traction.unwrap()[0],
        );
        assert!((q + mu * p).abs() < 1e-10 * p, "{mu}: {p} {q}");
    }
    let mut regions = moved(coulomb(0.1, None), 1000.0, [0.1, -0.01]);
    let mesh = block(CellKind::Quad4, [0.0; 3], [2.0, 1.0, 0.0], [6, 3, 0]);
    let mesh = mesh
        .with_surface("icy", |[x, y, _]| y == 0.0 && x < 1.0)
        .unwrap();
    regions.bodies[0].mesh = dpana::scene::MeshSource::Given(mesh);
    if let Some(SceneLaw::Coulomb { regions, .. }) = &mut regions.contacts[0].law {
        regions.insert("icy".to_owned(), 0.02);
    }
    let report = certified(&regions).1;
    let mut met = [0; 2];
    for contact in report.contacts {
        let (p, q) = (
            contact.pressure.unwrap(),
            contact.friction_traction.unwrap()[0],
        );
        let icy = (q + 0.02 * p).abs() < 1e-10 * p;
        assert!(icy || (q + 0.1 * p).abs() < 1e-10 * p, "{p} {q}");
        met[usize::from(icy)] += 1;
    }
    assert!(met[0] > 1 && met[1] > 1, "{met:?}");
}

#[test]
fn an_orthotropic_block_is_held_back_aside_of_its_way() {
    // A block as good as rigid slides by (sx, sy): t = −p (μ₁² sx, μ₂² sy)/√(μ₁² sx² + μ₂² sy²).
    let mesh = block(CellKind::Hex8, [0.0; 3], [1.0; 3], [2, 2, 2]);
    let floor = SceneObstacle::plane(&[0.0; 3], &[0.0, 0.0, 1.0]);
    let (mu, way) = ([0.2, 0.5], [0.03, 0.04]);
    let law = SceneLaw::Orthotropic {
        friction: mu,
        direction: vec![1.0, 0.0, 0.0],
        shear_cap: None,
    };
    let mut block = body("block", mesh, 1e8, 0.0);
    for (axis, u) in [way[0], way[1], -1e-8].into_iter().enumerate() {
        block = hold(block, "top", axis, u);
    }
    let contact = SceneContact::on(floor, "bottom", 0.0).with_law(law);
    let report = certified(&scene(vec![block], vec![contact])).1;
    assert_eq!(report.totals.slip, report.size.contacts);
    let size = f64::hypot(mu[0] * way[0], mu[1] * way[1]);
    for axis in 0..2 {
        let expected = -report.totals.normal * mu[axis].powi(2) * way[axis] / size;
        let found = report.totals.friction[axis];
        assert!(
            (found - expected).abs() < 1e-6 * report.totals.normal,
            "{found} {expected}"
        );
    }
}

#[test]
fn an_orthotropic_block_is_held_by_what_friction_bears_across() {
    // Statics: N = 32, T = (−4, 2); along (2, 1)/√5 that is 6/√5 < 0.1 N, across 8/√5 = 3.6, more than 0.1 N.
    let lower = block(CellKind::Hex8, [0.0; 3], [2.0, 2.0, 1.0], [2, 2, 1]);
    let upper = block(CellKind::Hex8, [0.0, 0.0, 1.0], [2.0; 3], [3, 3, 1]);
    let mut low = body("low", lower, 1000.0, 0.25);
    for axis in 0..3 {
        low = hold(low, "bottom", axis, 0.0);
    }
    let mut up = body("up", upper, 1000.0, 0.25);
    up.loads = vec![
        SceneLoad::pressure("top", 8.0),
        SceneLoad::Traction {
            traction: vec![1.0, -0.5, 0.0],
            group: "top".into(),
        },
    ];
    let law = SceneLaw::Orthotropic {
        friction: [0.1, 0.4],
        direction: vec![2.0, 1.0, 0.0],
        shear_cap: None,
    };
    let contact = contact(["up", "bottom"], ["low", "top"], 0.0).with_law(law);
    let totals = certified(&scene(vec![low, up], vec![contact])).1.totals;
    for (found, expected) in totals.friction.iter().zip([-4.0, 2.0]) {
        assert!((found - expected).abs() < 1e-9, "{:?}", totals.friction);
    }
    assert!((totals.normal - 32.0).abs() < 1e-9);
}

#[test]
fn what_a_law_does_over_steps_is_accounted_for() {
    // Pressed into a layer and let go again: all the work comes back.
    let mut scene = moved(SceneLaw::Rough, 1000.0, [0.0, -0.01]);
    scene.contacts[0].compliance = Some(SceneCompliance {
        normal: 0.004,
        tangential: 0.001,
    });
    let text = r#"{"at": [1, 2], "factors": {"bodies[0].supports[1]": [[1, 1], [2, 0]]}}"#;
    scene.steps = Some(serde_json::from_str(text).unwrap());
    let mut energies = Vec::new();
    dpana::solve_steps(&scene, None, |solution| {
        assert_eq!(solution.status(), Status::Certified);
        energies.push(solution.step().unwrap().total());
        Ok(())
    })
    .unwrap();
    // ½ p d A = ½ · 2 · 0.01 · 2.
    assert!((energies[0].elastic - 0.02).abs() < 1e-12, "{energies:?}");
    assert!(
        energies.iter().all(|total| total.closure.abs() < 1e-12),
        "{energies:?}"
    );
    assert!(energies[1].elastic.abs() < 1e-12);
}

#[test]
fn laws_are_refused_by_name_where_they_are_not_known() {
    let tresca = loose(SceneLaw::Tresca { shear: 0.1 }, [0.05, -1.0]);
    let said = limit(&tresca).unwrap_err().to_string();
    assert!(
        said.contains("contacts[0].law: given bound, shear 0.1 is not accepted"),
        "{said}"
    );
    let said = study(&tresca, &Plan::quick(), |_| {})
        .unwrap_err()
        .to_string();
    assert!(
        said.contains("contacts[0].law: a law") && said.contains("dpana solve"),
        "{said}"
    );
    let friction = Variation {
        name: "friction".to_owned(),
        values: vec![0.1],
    };
    let bonded = moved(SceneLaw::Bonded, 1000.0, [0.0, -0.01]);
    let said = cases(&bonded, &[friction]).unwrap_err().to_string();
    assert!(said.contains("the law `bonded` is not accepted"), "{said}");
}

#[test]
fn a_bond_whose_gap_is_changed_does_the_work_of_it() {
    // ½ k g² with k = E A / h = 2000: pulled wider step by step, pressed, and let be again.
    for gaps in [[0.01, 0.02, 0.03], [0.01, -0.02, 0.0], [-0.01, 0.01, 0.02]] {
        for law in [SceneLaw::Bonded, SceneLaw::NoSeparation { friction: 0.0 }] {
            let mut scene = moved(law, 1000.0, [0.0, 0.0]);
            let rows: Vec<[f64; 2]> = (1..)
                .map(f64::from)
                .zip(gaps)
                .map(|(at, gap)| [at, gap])
                .collect();
            let steps = serde_json::json!({"at": [1, 2, 3], "gaps": {"contacts[0]": rows}});
            scene.steps = Some(serde_json::from_value(steps).unwrap());
            let mut totals = Vec::new();
            dpana::solve_steps(&scene, None, |solution| {
                totals.push(solution.step().unwrap().total());
                Ok(())
            })
            .unwrap();
            for (total, gap) in totals.iter().zip(gaps) {
                let stored = 0.5 * 2000.0 * gap * gap;
                assert!((total.elastic - stored).abs() < 1e-9, "{gaps:?}: {total:?}");
                assert!((total.fits - stored).abs() < 1e-9, "{gaps:?}: {total:?}");
            }
        }
    }
}

#[test]
fn laws_that_are_not_convex_or_make_no_sense_are_refused_where_they_stand() {
    let with = |contact: &str| {
        let scene = format!(
            r#"{{"bodies": [{{"mesh": {{"rectangle": {{"x": [0, 1], "y": [0, 1], "cells": [1, 1]}}}},
                "model": "plane_strain", "materials": [{{"young": 1, "poisson": 0}}],
                "supports": [{{"group": "top", "displacement": [0, -0.01]}}]}}],
                "contacts": [{{"group": "bottom", {contact}
                "obstacle": {{"plane": {{"point": [0, 0], "normal": [0, 1]}}}}}}]}}"#
        );
        match Scene::from_json(&scene, "").and_then(|scene| solve(&scene)) {
            Ok(_) => String::new(),
            Err(error) => error.to_string(),
        }
    };
    for (contact, parts) in [
        ("", &["contacts[0]: neither `friction` nor `law`"][..]),
        (
            r#""friction": 0.1, "law": "bonded","#,
            &["both `friction` and `law`"],
        ),
        (
            r#""law": {"slip_weakening": {"peak": 0.5}},"#,
            &["contacts[0].law", "not convex"],
        ),
        (
            r#""law": {"coulomb": {"friction": 0.3, "static_friction": 0.5}},"#,
            &["static_friction", "not convex"],
        ),
        (r#""law": "glued","#, &["unknown choice `glued`", "bonded"]),
        (
            r#""law": {"cohesion": {"tension": 1, "shear": 0.1, "friction": 0.5}},"#,
            &["law.shear", "friction × tension"],
        ),
        (r#""law": {"coulomb": {}},"#, &["no `friction`"]),
        (
            r#""law": {"coulomb": {"friction": 0.1, "shear_cap": 0}},"#,
            &["law.shear_cap: 0"],
        ),
        (
            r#""law": {"coulomb": {"friction": 0.1, "regions": {"nowhere": 1}}},"#,
            &["regions.nowhere"],
        ),
        (
            r#""law": {"coulomb": {"friction": 0.1, "regions": {"right": 1}}},"#,
            &["regions.right", "a group without facets of the contact"],
        ),
        (
            r#""law": {"coulomb": {"table": {"direction": [0, 0], "values": [[0, 1]]}}},"#,
            &["table.direction"],
        ),
        (
            r#""law": {"coulomb": {"table": {"direction": [1, 0], "values": [[0, -1]]}}},"#,
            &["table.values[0][1]: -1"],
        ),
        (
            r#""law": {"tresca": {"shear": -1}},"#,
            &["law.tresca.shear: -1"],
        ),
        (
            r#""law": {"orthotropic": {"friction": [1, 2], "direction": [1, 0]}},"#,
            &["in 2D"],
        ),
        (
            r#""friction": 0, "compliance": {"normal": -1},"#,
            &["compliance.normal: -1"],
        ),
    ] {
        let said = with(contact);
        for part in parts {
            assert!(said.contains(part), "{contact}: `{part}` is not in: {said}");
        }
    }
    assert_eq!(with(r#""law": {"no_separation": {}},"#), "");
}

#[test]
fn a_bare_law_of_friction_takes_the_same_work_as_its_coefficient() {
    let mut short = moved(coulomb(0.3, None), 1000.0, [0.002, -0.01]);
    let long = certified(&short).1;
    (short.contacts[0].friction, short.contacts[0].law) = (Some(0.3), None);
    let short = certified(&short).1;
    let counts = |report: &dpana::report::Report| {
        let work = &report.work;
        (
            work.factorisations,
            work.sweeps,
            work.cone_iterations,
            work.newton_steps,
        )
    };
    assert_eq!(counts(&long), counts(&short));
    assert_eq!(long.contacts, short.contacts);
    assert!(long.totals.pairs[0].law.is_none());
}
