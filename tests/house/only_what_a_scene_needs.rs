//! A scene pays only for what it needs: counts of programs and factorisations, and an assumed contact
//! surface whose extent does not matter.

use crate::square;
use dpana::body::{CellKind, Facet, Group, Mesh, graded, rectangle};
use dpana::report::Report;
use dpana::scene::{MeshSource, SceneSupport};
use dpana::{Scene, Solution, Status, solve};
use serde_json::json;

fn certified(scene: &Scene) -> (Solution, Report) {
    let solution = solve(scene).unwrap();
    assert_eq!(solution.status(), Status::Certified);
    let report = solution.report().unwrap();
    (solution, report)
}

/// A square of 2 m on a circle of radius 5 m, its top moved by (0.004, −0.01) m: contact lies
/// within 0.17 m of the middle, far from the corners.
fn on_a_circle(friction: f64) -> Scene {
    let scene = json!({
        "bodies": [{
            "mesh": {"rectangle": {"x": [-1, 1], "y": [0, 2], "cells": [64, 64]}},
            "model": "plane_strain",
            "materials": [{"young": 1000, "poisson": 0.3}],
            "supports": [{"group": "top", "displacement": [0.004, -0.01]}]
        }],
        "contacts": [{
            "group": "bottom", "friction": friction,
            "obstacle": {"circle": {"center": [0, -5], "radius": 5}}
        }]
    });
    Scene::from_json(&scene.to_string(), "").unwrap()
}

/// The same with another assumed contact surface: the named sides, and of the bottom what lies
/// between two positions.
fn assuming(sides: &[&str], from: f64, to: f64) -> Scene {
    let lines = graded(-1.0, 1.0, 64, 1.0).unwrap();
    let heights = graded(0.0, 2.0, 64, 1.0).unwrap();
    let mut mesh = rectangle(&lines, &heights, CellKind::Quad4).unwrap();
    let within = |mesh: &Mesh, facet: &Facet| {
        let mut nodes = facet.nodes.iter().map(|&node| mesh.nodes[node][0]);
        nodes.all(|x| (from..=to).contains(&x))
    };
    let mut assumed = facets(&mesh, "bottom");
    assumed.retain(|facet| within(&mesh, facet));
    assumed.extend(sides.iter().flat_map(|side| facets(&mesh, side)));
    mesh.groups.insert("assumed".into(), Group::Facets(assumed));
    let mut scene = on_a_circle(0.3);
    scene.bodies[0].mesh = MeshSource::Given(mesh);
    scene.contacts[0].group = "assumed".into();
    scene
}

fn facets(mesh: &Mesh, group: &str) -> Vec<Facet> {
    match &mesh.groups[group] {
        Group::Facets(facets) => facets.clone(),
        other => unreachable!("{group}: {other:?}"),
    }
}

fn rim_is_noted(report: &Report) -> bool {
    let mut notes = report.notes.iter();
    notes.any(|note| note.contains("contact reaches the rim"))
}

/// Largest difference of the bodies' displacements, relative to the largest displacement.
fn difference(a: &Solution, b: &Solution) -> f64 {
    let largest =
        |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, |m: f64, x| m.max(x.abs()));
    let pairs = a.displacements()[0].iter().zip(&b.displacements()[0]);
    largest(&mut pairs.map(|(a, b)| a - b)) / largest(&mut b.displacements()[0].iter().copied())
}

#[test]
fn without_friction_there_is_no_tangential_unknown_and_no_friction_program() {
    let (_, smooth) = certified(&on_a_circle(0.0));
    assert_eq!(smooth.size.contact_unknowns, smooth.size.contacts);
    assert_eq!(smooth.work.friction_programs, 0);
    assert_eq!(smooth.work.friction_program_contacts, 0);
    assert!(smooth.work.normal_programs >= 1);
    let (_, rough) = certified(&on_a_circle(0.3));
    assert_eq!(rough.size.contact_unknowns, 2 * rough.size.contacts);
}

#[test]
fn hardly_any_friction_is_no_friction() {
    let (smooth, _) = certified(&square::scene(32, 0.2, 0.0));
    let (hardly, _) = certified(&square::scene(32, 0.2, 1e-12));
    // A friction of 1e-12 of the pressure, and a certificate of as much, times the condition of G: 32
    // contacts across.
    assert!(difference(&hardly, &smooth) < 1e-10);
}

#[test]
fn where_nothing_can_touch_no_cone_program_is_posed() {
    // The square hangs by its top, the circle is 1 m below, and a side wind shears it.
    for friction in [0.0, 0.3] {
        let mut scene = on_a_circle(friction);
        let held = vec![Some(0.004), Some(1.0)];
        if let SceneSupport::Group { displacement, .. } = &mut scene.bodies[0].supports[0] {
            *displacement = held;
        }
        let (solution, report) = certified(&scene);
        assert!(solution.outcome().reaction.iter().all(|&t| t == 0.0));
        let work = &report.work;
        assert_eq!((work.normal_programs, work.friction_programs), (0, 0));
        assert_eq!((work.cone_iterations, work.sweeps), (0, 0));
        assert_eq!(report.totals.open, report.size.contacts);
    }
}

#[test]
fn an_unloaded_body_just_touching_is_solved_without_dividing_zero_by_zero() {
    let mut scene = square::scene(8, 0.2, 1.0);
    scene.bodies[0].loads.clear();
    let (solution, report) = certified(&scene);
    assert!(solution.displacements()[0].iter().all(|&u| u == 0.0));
    assert_eq!(
        (report.certificate.natural_map, report.totals.normal),
        (0.0, 0.0)
    );
    assert_eq!(report.work.cone_iterations, 0);
}

#[test]
fn one_solve_is_one_factorisation_however_many_sweeps_it_takes() {
    let work = [(0.2, 0.0), (0.2, 1.0), (0.2, 10.0), (0.0, 50.0)]
        .map(|(poisson, friction)| certified(&square::scene(64, poisson, friction)).1.work);
    assert!(work.iter().all(|work| work.factorisations == 1));
    // What did not settle at once was followed on the same factorisation.
    let most = work.iter().map(|work| work.newton_steps).max();
    assert!(most > Some(20), "{work:?}");
}

#[test]
fn contacts_that_stay_open_never_enter_a_friction_program() {
    for scene in [
        on_a_circle(0.3),
        square::scene(32, 0.2, 1.0),
        square::scene(128, 0.2, 1.0),
    ] {
        let (_, report) = certified(&scene);
        let pressed = report.totals.stick + report.totals.slip;
        assert!(report.totals.open > 0);
        assert!(
            report.work.friction_program_contacts <= pressed,
            "{:?}",
            report.work
        );
    }
}

#[test]
fn from_a_cold_start_the_default_runs_cone_programs() {
    for scene in [on_a_circle(0.3), square::scene(32, 0.2, 1.0)] {
        let (_, report) = certified(&scene);
        let work = &report.work;
        assert!(work.sweeps >= 1 && work.cone_iterations >= 1, "{work:?}");
        assert!(work.normal_programs >= 1 && work.friction_programs >= 1);
    }
}

#[test]
fn an_assumed_contact_surface_may_grow_without_changing_the_answer() {
    let (whole, report) = certified(&on_a_circle(0.3));
    let (stick, slip) = (report.totals.stick, report.totals.slip);
    assert!(stick > 0 && slip > 0);
    for scene in [
        assuming(&[], -0.25, 0.25),
        assuming(&[], -0.1875, 0.8),
        assuming(&["left", "right"], -1.0, 1.0),
        assuming(&["left", "right", "top"], -0.5, 0.25),
    ] {
        let (part, report) = certified(&scene);
        let change = difference(&part, &whole);
        // As above: 1e-12 times the contacts across.
        assert!(change < 1e-10, "{change:e}");
        assert_eq!((report.totals.stick, report.totals.slip), (stick, slip));
        assert!(!rim_is_noted(&report), "{:?}", report.notes);
    }
}

#[test]
fn contact_that_reaches_the_rim_of_the_assumed_surface_is_noted() {
    for (from, to) in [(-0.125, 0.25), (-0.25, 0.0625), (-0.0625, 0.0625)] {
        let (_, report) = certified(&assuming(&[], from, to));
        assert!(rim_is_noted(&report), "{from} {to}: {:?}", report.notes);
    }
}

#[test]
fn contact_up_to_the_true_corners_of_the_body_is_no_rim() {
    let scene = json!({
        "bodies": [{
            "mesh": {"box": {"x": [0, 1], "y": [0, 1], "z": [0, 1], "cells": [4, 4, 4]}},
            "materials": [{"young": 1000, "poisson": 0.3}],
            "supports": [{"group": "top", "displacement": [0.0045, 0, -0.01]}]
        }],
        "contacts": [{
            "group": "bottom", "friction": 0.3,
            "obstacle": {"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}}
        }]
    });
    let (_, report) = certified(&Scene::from_json(&scene.to_string(), "").unwrap());
    assert_eq!(report.totals.open, 0);
    assert!(report.notes.is_empty(), "{:?}", report.notes);
}
