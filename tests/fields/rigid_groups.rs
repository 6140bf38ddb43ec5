//! Groups that are coupled to a reference point: torsion and bending beside their closed forms.
//! (Timoshenko & Goodier, Theory of Elasticity, §§ 21, 101.)

use dpana::body::{CellKind, Group};
use dpana::report::Report;
use dpana::scene::{
    SceneBody, SceneContact, SceneModel, SceneObstacle, SceneRigidGroup, SceneSupport,
};
use dpana::{Error, solve, solve_steps};
use serde_json::json;

use crate::gaps::read;
use crate::local_supports::shipped;
use crate::stacks::{block, body, certified, scene};
use crate::turns::{LENGTH, POISSON, YOUNG, bar, stiffness};

/// Free of contact.
fn solved(of: SceneBody, group: &str) -> Report {
    let axes = if of.model.is_some() { 2 } else { 3 };
    let (mut far, mut normal) = (vec![0.0; axes], vec![0.0; axes]);
    let across = 3 - axes;
    (far[across], normal[across]) = (-99.0, 1.0);
    let wall = SceneObstacle::plane(&far, &normal);
    certified(&scene(vec![of], vec![SceneContact::on(wall, group, 0.0)])).1
}

#[test]
fn a_round_bar_is_turned_by_its_end_and_by_a_moment_alike() {
    let clamped = |group: SceneRigidGroup| {
        let bar = body("bar", bar(48), YOUNG, POISSON)
            .with_support(SceneSupport::of("bottom", &[Some(0.0); 3]))
            .with_rigid_group(group);
        solved(bar, "outer").rigid_groups.remove(0)
    };
    let end = SceneRigidGroup::new("top", &[0.0, 0.0, LENGTH]);
    let angle = 1e-3;
    let turned = clamped(SceneRigidGroup {
        rotation: Some(vec![None, None, Some(angle)]),
        ..end.clone()
    });
    let torque = turned.moment[2];
    assert!(
        (torque / (stiffness() * angle) - 1.0).abs() < 0.015,
        "{turned:?}"
    );
    let loaded = clamped(SceneRigidGroup {
        moment: Some(vec![0.0, 0.0, torque]),
        ..end
    });
    assert!(
        (loaded.rotation[2] / angle - 1.0).abs() < 1e-9,
        "{loaded:?}"
    );
    // Nothing holds it.
    assert!(loaded.moment.iter().all(|m| m.abs() < 1e-9 * torque));
}

#[test]
fn a_beam_with_a_rigid_end_bends_as_its_theory() {
    // ν = 0, quadratic cells: exact under a moment, and under a force but for shear; E I = E b h³/12.
    let beam = |group: SceneRigidGroup| {
        let mesh = block(CellKind::Quad8, [0.0; 3], [4.0, 0.5, 0.0], [8, 2, 0]);
        let beam = body("beam", mesh, 1000.0, 0.0)
            .with_model(SceneModel::PlaneStress { thickness: 0.1 })
            .with_support(SceneSupport::of("left", &[Some(0.0); 2]))
            .with_rigid_group(group);
        solved(beam, "bottom").rigid_groups.remove(0)
    };
    let inertia = 1000.0 * 0.1 * 0.5_f64.powi(3) / 12.0;
    let end = SceneRigidGroup::new("right", &[4.0, 0.25]);
    let bent = beam(SceneRigidGroup {
        moment: Some(vec![0.01]),
        ..end.clone()
    });
    let angle = 0.01 * 4.0 / inertia;
    assert!((bent.rotation[0] / angle - 1.0).abs() < 1e-9, "{bent:?}");
    assert!((bent.displacement[1] / (0.5 * angle * 4.0) - 1.0).abs() < 1e-9);
    // A reference point elsewhere: the same force there has a moment more.
    let tip = beam(SceneRigidGroup {
        reference_point: vec![5.0, 0.0],
        force: Some(vec![0.0, 0.01]),
        ..end.clone()
    });
    let angle = 0.01 * (8.0 + 4.0) / inertia;
    assert!((tip.rotation[0] / angle - 1.0).abs() < 1e-9, "{tip:?}");
    // Turned with its displacement held: 4 E I/L and 6 E I/L², shear apart (φ = 12 E I/(κ G A L²) < 0.03).
    let held = beam(SceneRigidGroup {
        displacement: Some(vec![Some(0.0); 2]),
        rotation: Some(vec![Some(0.001)]),
        ..end
    });
    assert!(
        (held.moment[0] / (4.0 * inertia / 4.0 * 0.001) - 1.0).abs() < 0.03,
        "{held:?}"
    );
    assert!(
        (held.force[1] / (-6.0 * inertia / 16.0 * 0.001) - 1.0).abs() < 0.04,
        "{held:?}"
    );
}

#[test]
fn a_punch_that_is_pressed_over_its_middle_follows_its_tables() {
    // The head of the punch is rigid and pressed by a force off its middle: statics of the contact forces.
    let text = json!({
        "bodies": [{
            "mesh": {"rectangle": {"x": [-1, 1], "y": [0, 1], "cells": [8, 4]}},
            "model": "plane_strain",
            "materials": [{"young": 1000, "poisson": 0.3}],
            "rigid_groups": [{"group": "top", "reference_point": [0.2, 1.5], "displacement": [0.001, null],
                              "force": [0, -10]}]
        }],
        "contacts": [{"group": "bottom", "friction": 0.5,
                      "obstacle": {"plane": {"point": [0, 0], "normal": [0, 1]}}}],
        "steps": {"at": [1, 2, 3], "factors": {
            "bodies[0].rigid_groups[0].load": [[1, 1], [2, 2]],
            "bodies[0].rigid_groups[0].motion": [[1, 0], [2, 0], [3, 1]]
        }}
    });
    let mut forces = Vec::new();
    solve_steps(&read(&text), None, |step| {
        let report = step.report()?;
        let totals = &report.totals;
        assert!((totals.contact_force[1] - totals.normal).abs() < 1e-9);
        let group = &report.rigid_groups[0];
        // About the reference point: what holds it takes no moment.
        let [fx, fy] = [totals.contact_force[0], totals.contact_force[1]];
        let moment = totals.moment[0] - (0.2 * fy - 1.5 * fx);
        assert!(
            moment.abs() < 1e-8 && group.moment[0].abs() < 1e-8,
            "{moment} {group:?}"
        );
        assert!((group.force[0] + fx).abs() < 1e-8 && group.force[1].abs() < 1e-8);
        forces.push((totals.normal, group.displacement[0], fx));
        Ok(())
    })
    .unwrap();
    let close = |(found, expected): (f64, f64)| (found - expected).abs() < 1e-8;
    let expected = [(10.0, 0.0), (20.0, 0.0), (20.0, 0.001)];
    for ((normal, moved, _), (load, motion)) in forces.iter().zip(expected) {
        assert!(
            close((*normal, load)) && close((*moved, motion)),
            "{forces:?}"
        );
    }
    assert!(forces[1].2.abs() < 1e-9 || forces[1].2 != forces[2].2);
}

#[test]
fn groups_that_tell_no_rotation_are_refused_by_place() {
    let mut mesh = block(CellKind::Quad4, [0.0; 3], [1.0; 3], [2, 2, 0]);
    mesh.groups
        .insert("corner".to_owned(), Group::Points(vec![0]));
    let of = body("block", mesh, 1000.0, 0.3)
        .with_rigid_group(SceneRigidGroup::new("corner", &[0.0, 0.0]));
    let floor = SceneObstacle::plane(&[0.0, 0.0], &[0.0, 1.0]);
    let contact = SceneContact::on(floor, "bottom", 0.0);
    let found = solve(&scene(vec![of], vec![contact])).unwrap_err();
    assert!(matches!(found, Error::NotAccepted { .. }), "{found}");
    assert!(found.to_string().contains("rigid_groups[0]"), "{found}");
}

#[test]
fn the_head_of_a_punch_carries_no_moment_about_its_reference_point() {
    let (_, report) = certified(&shipped("punch_head"));
    let [x, y] = [
        report.totals.contact_force[0],
        report.totals.contact_force[1],
    ];
    let moment = report.totals.moment[0] - (4.0 * y - 30.0 * x);
    assert!(
        (y / 2000.0 - 1.0).abs() < 1e-9 && moment.abs() < 1e-6,
        "{y} {moment}"
    );
    assert!((report.rigid_groups[0].force[0] + x).abs() < 1e-6);
}

#[test]
fn a_tool_of_cells_that_all_move_as_one_is_the_tool_with_a_rigid_face() {
    // No elastic motion is left in it: its sides may be all that is coupled, or all of its cells.
    let pressed = |kind: CellKind, group: &str, poisson: f64| {
        let axes = kind.dimension();
        let box_of = |low: [f64; 2], high: [f64; 2], cells: usize| {
            let (mut from, mut to) = ([low[0]; 3], [high[0]; 3]);
            (from[axes - 1], to[axes - 1]) = (low[1], high[1]);
            block(kind, from, to, [cells; 3])
        };
        let base = body("base", box_of([0.0, -1.0], [1.0, 0.0], 4), 1000.0, 0.3)
            .with_support(SceneSupport::of("bottom", &vec![Some(0.0); axes]));
        let mut at = vec![0.5; axes];
        at[axes - 1] = 0.0;
        let mut force = vec![0.0; axes];
        force[axes - 1] = -5.0;
        let mut held = vec![Some(0.0); axes];
        held[axes - 1] = None;
        let mut tool = box_of([-0.5, 0.0], [1.5, 1.0], 3);
        let all = Group::Cells((0..tool.cells().count()).collect());
        tool.groups.insert("all".to_owned(), all);
        let tool = body("tool", tool, 500.0, poisson).with_rigid_group(SceneRigidGroup {
            force: Some(force),
            displacement: Some(held),
            rotation: Some(vec![Some(0.0); if axes == 2 { 1 } else { 3 }]),
            ..SceneRigidGroup::new(group, &at)
        });
        let contact = SceneContact::between(["base", "top"], ["tool", "bottom"], 0.0);
        let (_, report) = certified(&scene(vec![base, tool], vec![contact]));
        (
            report.rigid_groups[0].displacement[axes - 1],
            report.totals.peak_pressure,
        )
    };
    for kind in [CellKind::Quad4, CellKind::Tri3, CellKind::Hex8] {
        for poisson in [0.0, 0.3] {
            let (sunk, peak) = pressed(kind, "bottom", poisson);
            let found = pressed(kind, "all", poisson);
            assert!(
                (found.0 / sunk - 1.0).abs() < 1e-9,
                "{kind:?} {found:?} {sunk}"
            );
            assert!(
                (found.1 / peak - 1.0).abs() < 1e-9,
                "{kind:?} {found:?} {peak}"
            );
        }
    }
}
