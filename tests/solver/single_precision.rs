//! A factor in single precision (C32), set right by rounds of (C24), answers as one in double precision does; where it
//! has too few digits it is given up, and the work says why.

use dpana::body::Group;
use dpana::condensation::{Condensed, Fallback};
use dpana::scene::{MeshSource, SceneMaterial};
use dpana::{Scene, Solution, Status, alternation, solve};

/// A block of a unit of length across, pressed down and dragged along a plane by its top.
fn block(cells: [usize; 3], poisson: f64) -> Scene {
    let text = format!(
        r#"{{ "bodies": [{{ "mesh": {{ "box": {{ "x": [0, 1], "y": [0, 1], "z": [0, 1], "cells": {cells:?} }} }},
                "materials": [{{ "young": 1000, "poisson": {poisson} }}],
                "supports": [{{ "group": "top", "displacement": [0.0045, 0, -0.01] }}] }}],
             "contacts": [{{ "group": "bottom", "friction": 0.3,
                "obstacle": {{ "plane": {{ "point": [0, 0, 0], "normal": [0, 0, 1] }} }} }}] }}"#
    );
    Scene::from_json(&text, "").unwrap()
}

/// Reaction and displacements in double precision from the start.
fn in_double(scene: &Scene) -> (Vec<f64>, Vec<f64>) {
    let mechanics = scene.mechanics().unwrap();
    let condensed = Condensed::new(&mechanics.bodies, &mechanics.contacts).unwrap();
    let outcome = alternation::solve(condensed.problem(), &mechanics.settings).unwrap();
    assert_eq!(outcome.status, Status::Certified);
    let moved = condensed.recover(&outcome.reaction, &outcome.motion);
    (outcome.reaction, moved.unwrap().concat())
}

/// Largest difference over the largest of all.
fn difference(found: &[f64], expected: &[f64]) -> f64 {
    let largest =
        |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, |m: f64, x| m.max(x.abs()));
    let mut off = found.iter().zip(expected).map(|(a, b)| a - b);
    largest(&mut off) / largest(&mut expected.iter().copied())
}

fn assert_same(scene: &Scene, found: &Solution) {
    assert_eq!(found.status(), Status::Certified);
    let (reaction, displacements) = in_double(scene);
    let off = difference(&found.outcome().reaction, &reaction);
    assert!(off < 1e-10, "reactions differ by {off:e}");
    let off = difference(&found.displacements().concat(), &displacements);
    assert!(off < 1e-10, "displacements differ by {off:e}");
}

#[test]
fn a_cube_is_solved_to_all_digits_on_a_factor_of_seven() {
    let scene = block([14; 3], 0.3);
    let found = solve(&scene).unwrap();
    let work = found.condensed().work();
    assert_eq!((work.factorisations, work.single_factors), (1, 1));
    assert_eq!(
        (work.factor_bytes, work.fallback),
        (4 * work.factor_entries, None)
    );
    assert!((2..=3).contains(&work.corrections), "{work:?}");
    assert_same(&scene, &found);
    let report = found.report().unwrap();
    assert!(report.certificate.natural_map <= 1e-12);
    assert_eq!(
        (report.work.single_factors, report.work.fallback),
        (1, None)
    );
    assert!(found.balances()[0].equilibrium.scaled < 1e-11);
}

#[test]
fn what_is_asked_of_a_solved_state_later_is_answered_in_double_precision() {
    let scene = block([14; 3], 0.3);
    let found = solve(&scene).unwrap();
    let mechanics = scene.mechanics().unwrap();
    let expected = Condensed::new(&mechanics.bodies, &mechanics.contacts).unwrap();
    let [rounded, precise] = [found.condensed(), found.precise().unwrap()].map(|condensed| {
        (condensed.problem().compliance() - expected.problem().compliance()).norm_max()
    });
    assert_eq!(precise, 0.0);
    let size = expected.problem().compliance().norm_max();
    assert!(
        (1e-9..1e-5).contains(&(rounded / size)),
        "{rounded:e} of {size:e}"
    );
}

#[test]
fn small_and_plane_bodies_are_not_tried() {
    let small = solve(&block([6; 3], 0.3)).unwrap().condensed().work();
    assert_eq!(
        (small.single_factors, small.corrections, small.fallback),
        (0, 0, None)
    );
    let plane = r#"{ "bodies": [{ "mesh": { "rectangle": { "x": [0, 1], "y": [0, 1], "cells": [80, 80] } },
            "model": "plane_strain", "materials": [{ "young": 1000, "poisson": 0.3 }],
            "supports": [{ "group": "top", "displacement": [0.0045, -0.01] }] }],
         "contacts": [{ "group": "bottom", "friction": 0.3,
            "obstacle": { "plane": { "point": [0, 0], "normal": [0, 1] } } }] }"#;
    let plane = Scene::from_json(plane, "").unwrap();
    let plane = solve(&plane).unwrap().condensed().work();
    assert!(plane.unknowns > 10_000);
    assert_eq!((plane.single_factors, plane.fallback), (0, None));
}

/// A bar on its side, held and moved down at its left end.
fn bar(length: f64) -> Scene {
    let text = format!(
        r#"{{ "bodies": [{{ "mesh": {{ "box": {{ "x": [0, {length}], "y": [0, 1], "z": [0, 1], "cells": [100, 5, 5] }} }},
                "materials": [{{ "young": 1000, "poisson": 0.3 }}],
                "supports": [{{ "group": "left", "displacement": [0, 0, {}] }}] }}],
             "contacts": [{{ "group": "bottom", "friction": 0.3,
                "obstacle": {{ "plane": {{ "point": [0, 0, 0], "normal": [0, 0, 1] }} }} }}] }}"#,
        -0.001 * length
    );
    Scene::from_json(&text, "").unwrap()
}

/// Solves in double precision after all, says so in the report, and returns the sign.
fn given_up(scene: &Scene) -> Fallback {
    let found = solve(scene).unwrap();
    let work = found.condensed().work();
    assert_eq!(
        (work.factorisations, work.single_factors),
        (2, 0),
        "{work:?}"
    );
    assert_same(scene, &found);
    let sign = work.fallback.unwrap();
    let report = found.report().unwrap();
    assert_eq!(report.work.fallback, Some(sign.to_string()));
    assert!(report.summary().contains("single precision is not enough"));
    sign
}

#[test]
fn a_bar_fifty_times_as_long_as_wide_has_no_factor_in_single_precision() {
    let sign = given_up(&bar(50.0));
    assert!(matches!(sign, Fallback::Pivot { .. }), "{sign}");
}

#[test]
fn a_bar_ten_times_as_long_as_wide_is_recovered_with_too_few_digits() {
    let sign = given_up(&bar(10.0));
    assert!(
        matches!(sign, Fallback::Residual { part } if part > 1e-5),
        "{sign}"
    );
}

#[test]
fn corrections_of_a_nearly_incompressible_cube_contract_too_slowly() {
    let sign = given_up(&block([14; 3], 0.4999));
    assert!(
        matches!(sign, Fallback::Contraction { factor } if factor > 1e-3),
        "{sign}"
    );
}

#[test]
fn layers_a_million_times_as_stiff_end_as_in_double_precision() {
    let mut scene = block([14; 3], 0.3);
    let mut mesh = scene.mechanics().unwrap().bodies.remove(0).mesh;
    let (soft, stiff) = (0..mesh.cell_count())
        .partition(|&cell| ((7.0 * mesh.centroid(cell)[2]) as usize).is_multiple_of(2));
    mesh.groups.insert("soft".to_owned(), Group::Cells(soft));
    mesh.groups.insert("stiff".to_owned(), Group::Cells(stiff));
    scene.bodies[0].mesh = MeshSource::Given(mesh);
    scene.bodies[0].materials = vec![
        SceneMaterial::new(1000.0, 0.3).of("soft"),
        SceneMaterial::new(1e9, 0.3).of("stiff"),
    ];
    let sign = given_up(&scene);
    assert!(!matches!(sign, Fallback::Contacts), "{sign}");
}
