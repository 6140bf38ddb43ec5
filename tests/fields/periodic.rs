//! Faces of bodies that repeat: Westergaard's wave, and a ring by its sector.
//! (Johnson, Contact Mechanics, § 13.2; Timoshenko & Goodier, Theory of Elasticity, § 28.)

use std::f64::consts::PI;

use dpana::body::{CellKind, box_mesh, graded, rectangle};
use dpana::report::Report;
use dpana::scene::{
    SceneAxis, SceneContact, SceneLoad, SceneObstacle, ScenePeriodic, SceneSupport,
};
use dpana::{Variation, cases, solve};

use crate::local_supports::{sector, shipped};
use crate::stacks::{body, certified, scene};

/// Amplitude of the wave, whose length is 1 m.
const AMPLITUDE: f64 = 1e-4;

#[test]
fn a_wave_that_repeats_is_pressed_flat_as_westergaard_says() {
    // p* = π E* Δ/λ flattens it; below, the largest pressure is 2 √(p̄ p*). The crest is within, or on the seam.
    let full = PI * 1000.0 / (1.0 - 0.09) * AMPLITUDE;
    let factors = [0.1, 0.3, 0.6, 0.9];
    for crest in [0.5, 0.0] {
        let (xs, ys) = (graded(0.0, 1.0, 64, 1.0), graded(0.0, 1.5, 32, 12.0));
        let mut mesh = rectangle(&xs.unwrap(), &ys.unwrap(), CellKind::Quad4).unwrap();
        for x in &mut mesh.nodes {
            let wave = AMPLITUDE * (1.0 - (2.0 * PI * (x[0] - crest)).cos());
            x[1] += wave * (1.0 - x[1] / 1.5);
        }
        let strip = body("strip", mesh, 1000.0, 0.3)
            .with_periodic(ScenePeriodic::translated("left", "right", &[1.0, 0.0]))
            .with_support(SceneSupport::At {
                at: vec![0.5, 1.5],
                displacement: vec![Some(0.0), None],
            })
            .with_load(SceneLoad::pressure("top", full));
        let floor = SceneObstacle::plane(&[0.0, 0.0], &[0.0, 1.0]);
        let contact = SceneContact::on(floor, "bottom", 0.0);
        let scene = scene(vec![strip], vec![contact]);
        assert_eq!(scene.mechanics().unwrap().bodies[0].free_motions(), Ok(1));
        let load = Variation {
            name: "bodies[0].loads[0]".to_owned(),
            values: factors.to_vec(),
        };
        let table = cases(&scene, &[load]).unwrap();
        let peaks = table.column("peak_pressure").unwrap();
        for (factor, peak) in factors.iter().zip(peaks) {
            let expected = 2.0 * full * f64::sqrt(*factor);
            assert!(
                (peak / expected - 1.0).abs() < 0.01,
                "{crest} {factor} {}",
                peak / expected
            );
        }
    }
}

/// A ring or its sector, shrunk onto a rigid mandrel.
fn shrunk(sectors: usize, whole: bool) -> Report {
    let angle = 2.0 * PI / sectors as f64;
    let axis = || SceneAxis {
        point: vec![0.0, 0.0],
        direction: None,
    };
    let of = match whole {
        false => {
            let mesh = sector(CellKind::Quad4, [4, 6], [0.3, 0.3 + angle]);
            let turned = ScenePeriodic::turned("bottom", "top", axis(), angle);
            body("ring", mesh, 1000.0, 0.3).with_periodic(turned)
        }
        true => {
            let around = 6 * sectors;
            let mut mesh = sector(CellKind::Quad4, [4, around], [0.3, 0.3 + 2.0 * PI]);
            // The last row of nodes is the first.
            let last = mesh.nodes.len() - 5;
            let cells: Vec<Vec<usize>> = mesh
                .cells()
                .map(|cell| {
                    cell.nodes
                        .iter()
                        .map(|n| if *n >= last { n - last } else { *n })
                        .collect()
                })
                .collect();
            let mut closed = dpana::body::Mesh::new(2, mesh.nodes.drain(..last).collect());
            cells
                .iter()
                .for_each(|nodes| closed.push_cell(CellKind::Quad4, nodes));
            let closed = closed
                .with_surface("left", |[x, y, _]| x.hypot(y) < 1.0 + 1e-9)
                .and_then(|mesh| mesh.with_surface("right", |[x, y, _]| x.hypot(y) > 2.0 - 1e-9));
            body("ring", closed.unwrap(), 1000.0, 0.3)
        }
    };
    let mandrel = SceneObstacle::Circle {
        center: vec![0.0, 0.0],
        radius: 0.999,
    };
    let mut contact = SceneContact::on(mandrel, "left", 0.2);
    contact.gap = -0.003;
    // It turns nowhere.
    let of = of.with_support(SceneSupport::around("right", axis(), &[None, Some(0.0)]));
    certified(&scene(vec![of], vec![contact])).1
}

#[test]
fn a_sector_that_repeats_around_its_axis_is_the_whole_ring() {
    let (part, whole) = (shrunk(8, false), shrunk(8, true));
    let pressures = |report: &Report| -> Vec<f64> {
        report
            .contacts
            .iter()
            .filter_map(|contact| contact.pressure)
            .collect()
    };
    let mean = whole.totals.normal / whole.totals.contact_area;
    for pressure in pressures(&part).iter().chain(&pressures(&whole)) {
        assert!((pressure / mean - 1.0).abs() < 1e-8, "{pressure} {mean}");
    }
    // What the bore is widened by, facets and all, by Lamé: 0.002 m, and the sagitta.
    let expected = 0.002 * 1000.0 * 3.0 / (1.3 * 4.4);
    assert!((mean / expected - 1.0).abs() < 0.02, "{mean} {expected}");
}

/// Sectors of two rings, of which the outer one is too narrow.
fn shrunk_on(sectors: f64, around: [usize; 2]) -> Report {
    let angle = 2.0 * PI / sectors;
    let axis = || SceneAxis {
        point: vec![0.0, 0.0],
        direction: None,
    };
    let ring = |name: &str, grow: f64, cells: usize| {
        let mut mesh = sector(CellKind::Quad4, [3, cells], [0.3, 0.3 + angle]);
        for x in &mut mesh.nodes {
            let radius = x[0].hypot(x[1]);
            let grown = (radius + grow) / radius;
            *x = x.map(|x| x * grown);
        }
        body(name, mesh, 1000.0, 0.3)
            .with_periodic(ScenePeriodic::turned("bottom", "top", axis(), angle))
            .with_support(SceneSupport::around(
                if grow == 0.0 { "left" } else { "right" },
                axis(),
                &[None, Some(0.0)],
            ))
    };
    let bodies = vec![ring("shaft", 0.0, around[0]), ring("hub", 1.0, around[1])];
    let fit = SceneContact::between(["shaft", "right"], ["hub", "left"], 0.2).with_gap(-0.01);
    certified(&scene(bodies, vec![fit])).1
}

#[test]
fn sectors_of_two_rings_press_evenly_at_their_seam_as_well() {
    // Facets of 2.5 to 5 degrees, whose roundness goes on beyond the seam.
    for (around, off, beside) in [
        ([6, 6], 1e-8, false),
        ([12, 9], 0.03, false),
        ([12, 8], 0.03, false),
        ([9, 12], 0.03, true),
    ] {
        let report = shrunk_on(12.0, around);
        let mean = report.totals.normal / report.totals.contact_area;
        for contact in &report.contacts {
            let pressure = contact.pressure.unwrap();
            assert!(
                (pressure / mean - 1.0).abs() < off,
                "{around:?}: {pressure} {mean}"
            );
        }
        let mut notes = report.notes.iter();
        let noted = notes.any(|note| note.contains("at a seam around an axis"));
        assert_eq!(noted, beside, "{around:?}");
        let finer = shrunk_on(12.0, [12, 12]).totals.normal;
        assert!(
            (report.totals.normal / finer - 1.0).abs() < 0.02,
            "{around:?}: {finer}"
        );
    }
}

#[test]
fn faces_that_do_not_match_are_refused_with_the_node() {
    let mesh = |bent: f64| {
        let (xs, ys) = (graded(0.0, 1.0, 2, 1.0), graded(0.0, 1.0, 2, 1.0));
        let mut mesh = rectangle(&xs.unwrap(), &ys.unwrap(), CellKind::Quad4).unwrap();
        let middle = mesh.nodes.iter_mut().find(|x| **x == [1.0, 0.5, 0.0]);
        middle.unwrap()[1] += bent;
        mesh
    };
    let floor = || SceneObstacle::plane(&[0.0, 0.0], &[0.0, 1.0]);
    for (bent, periodic, says) in [
        (
            0.1,
            ScenePeriodic::translated("left", "right", &[1.0, 0.0]),
            "mapped to [1.0, 0.5, 0.0]",
        ),
        (
            0.0,
            ScenePeriodic::translated("left", "right", &[0.9, 0.0]),
            "nodes that match",
        ),
        (
            0.0,
            ScenePeriodic::translated("left", "bottom", &[1.0, 0.0]),
            "nodes that match",
        ),
        (
            0.0,
            ScenePeriodic {
                translation: None,
                ..ScenePeriodic::translated("left", "right", &[])
            },
            "`translation`, or `axis` with `angle`",
        ),
    ] {
        let of = body("block", mesh(bent), 1000.0, 0.3).with_periodic(periodic);
        let found = solve(&scene(
            vec![of],
            vec![SceneContact::on(floor(), "bottom", 0.0)],
        ));
        let words = found.unwrap_err().to_string();
        assert!(
            words.contains("bodies[0].periodic[0]") && words.contains(says),
            "{words}"
        );
    }
}

#[test]
fn a_row_of_rollers_carries_its_load_below_the_middle_of_each() {
    // The roller is at x = 7, not in the middle of the piece that repeats: mirrored about it all the same.
    let (_, report) = certified(&shipped("rollers"));
    let [x, y] = [
        report.totals.contact_force[0],
        report.totals.contact_force[1],
    ];
    assert!((y / 1000.0 - 1.0).abs() < 1e-9 && x.abs() < 1e-6, "{x} {y}");
    assert!((report.totals.moment[0] / 7000.0 - 1.0).abs() < 1e-6);
}

#[test]
fn two_layers_that_repeat_meet_across_their_seam() {
    // A wave on the lower layer, shifted so that its crest is at the seam, is one whose crest is in the middle:
    // the same force, and as many contacts pressed, on meshes that match and on those that do not.
    let layers = |shift: f64, cells: [usize; 2]| {
        let layer = |name: &str, low: f64, cells: usize, wave: f64| {
            let lines = |a: f64, b: f64, cells: usize| graded(a, b, cells, 1.0).unwrap();
            let xs = lines(0.0, 1.0, cells);
            let mut mesh = rectangle(&xs, &lines(low, low + 1.0, cells), CellKind::Quad4).unwrap();
            for x in mesh.nodes.iter_mut().filter(|x| x[1] == low + 1.0) {
                x[1] += wave * (std::f64::consts::TAU * (x[0] - shift)).cos();
            }
            body(name, mesh, 1000.0, 0.3).with_periodic(ScenePeriodic::translated(
                "left",
                "right",
                &[1.0, 0.0],
            ))
        };
        let lower = layer("lower", 0.0, cells[0], 1e-3)
            .with_support(SceneSupport::of("bottom", &[Some(0.0); 2]));
        let upper = layer("upper", 1.002, cells[1], 0.0)
            .with_support(SceneSupport::of("top", &[Some(0.0), Some(-4e-3)]));
        let pair = SceneContact::between(["lower", "top"], ["upper", "bottom"], 0.3);
        certified(&scene(vec![lower, upper], vec![pair])).1
    };
    for cells in [[16, 16], [16, 12], [12, 20]] {
        let [seam, middle] = [0.0, 0.5].map(|shift| layers(shift, cells));
        let pressed = |report: &Report| report.totals.contact_area;
        let (a, b) = (seam.totals.normal, middle.totals.normal);
        assert!(a > 0.0 && (a / b - 1.0).abs() < 0.02, "{cells:?} {a} {b}");
        let (a, b) = (pressed(&seam), pressed(&middle));
        assert!((a - b).abs() < 0.15, "{cells:?} {a} {b}");
    }
}

#[test]
fn layers_that_repeat_alike_press_evenly_at_their_seam_as_well() {
    // ν = 0: p = E δ over both heights, on meshes that match and on those that do not; friction as the laws say.
    for (kind, cells) in [
        (CellKind::Quad4, [3, 3]),
        (CellKind::Quad4, [3, 2]),
        (CellKind::Hex8, [2, 2]),
        (CellKind::Hex8, [3, 2]),
    ] {
        let axes = kind.dimension();
        let layer = |name: &str, low: f64, cells: usize| {
            let (mut from, mut to) = ([0.0; 3], [1.0; 3]);
            (from[axes - 1], to[axes - 1]) = (low, low + 1.0);
            let along = |axis: usize| graded(from[axis], to[axis], cells, 1.0).unwrap();
            let mesh = match axes {
                2 => rectangle(&along(0), &along(1), kind).unwrap(),
                _ => box_mesh(&along(0), &along(1), &along(2), kind).unwrap(),
            };
            let shift = |axis: usize| {
                (0..axes)
                    .map(|k| f64::from(u8::from(k == axis)))
                    .collect::<Vec<_>>()
            };
            let sides = [["left", "right"], ["front", "back"]]
                .into_iter()
                .take(axes - 1)
                .enumerate();
            sides.fold(
                body(name, mesh, 1000.0, 0.0),
                |body, (axis, [one, other])| {
                    body.with_periodic(ScenePeriodic::translated(one, other, &shift(axis)))
                },
            )
        };
        let mut pushed = vec![Some(0.0); axes];
        (pushed[0], pushed[axes - 1]) = (Some(2e-3), Some(-7e-3));
        let lower = layer("lower", 0.0, cells[0])
            .with_support(SceneSupport::of("bottom", &vec![Some(0.0); axes]));
        let upper = layer("upper", 1.0, cells[1]).with_support(SceneSupport::of("top", &pushed));
        for friction in [0.0, 0.1, 0.9] {
            let pair = SceneContact::between(["lower", "top"], ["upper", "bottom"], friction);
            let (_, report) = certified(&scene(vec![lower.clone(), upper.clone()], vec![pair]));
            // G γ, or what slides.
            let shear = f64::min(500.0 * 1e-3, friction * 3.5);
            let totals = &report.totals;
            assert!((totals.normal - 3.5).abs() < 1e-9 && (totals.contact_area - 1.0).abs() < 1e-9);
            assert!(
                (totals.friction[0].abs() - shear).abs() < 1e-9,
                "{friction} {:?}",
                totals.friction
            );
            for contact in &report.contacts {
                assert!(
                    (contact.pressure.unwrap() - 3.5).abs() < 1e-9,
                    "{kind:?} {cells:?} {contact:?}"
                );
            }
        }
    }
}
