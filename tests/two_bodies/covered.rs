//! Where one side ends on the other: reactions stand on what is covered, and nowhere else.
//!
//! Scenes rebuilt from reports of what went wrong (`tests/data/scenes`), each with its right value.

use dpana::body::CellKind;
use dpana::report::{Beyond, Report};
use dpana::{Scene, Status, rigid_limit, solve};
use serde_json::{Value, json};

use crate::stacks::certified;

fn from_file(name: &str) -> Scene {
    Scene::from_file(format!(
        "{}/tests/data/scenes/{name}",
        env!("CARGO_MANIFEST_DIR")
    ))
    .unwrap()
}

fn from_json(value: &Value) -> Scene {
    Scene::from_json(&value.to_string(), "covered.json").unwrap()
}

/// What the sides exchange is balanced to round-off.
fn check_exchange(report: &Report, place: &str) {
    for pair in &report.totals.pairs {
        if let Some(exchange) = &pair.exchange {
            assert!(exchange.force_defect.scaled < 1e-12, "{place} {exchange:?}");
        }
    }
}

fn close(found: f64, expected: f64, part: f64, place: &str) {
    let off = (found - expected).abs();
    assert!(
        off <= part * expected.abs(),
        "{place}: {found} against {expected}"
    );
}

/// The plane cells, as scenes name them.
const PLANE: [&str; 5] = ["quad4", "tri3", "quad8", "quad9", "tri6"];

/// A block of the given range, height 1 from `low` on.
fn block(name: &str, x: [f64; 2], low: f64, cells: usize, cell: &str) -> Value {
    json!({
        "name": name,
        "mesh": {"rectangle": {"x": x, "y": [low, low + 1.0], "cells": [cells, 2], "cell": cell}},
        "model": "plane_strain",
        "materials": [{"young": 3e10, "poisson": 0.2}]
    })
}

fn sides(upper_first: bool) -> (Value, Value) {
    let (upper, lower) = (
        json!({"body": "upper", "group": "bottom"}),
        json!({"body": "lower", "group": "top"}),
    );
    if upper_first {
        (upper, lower)
    } else {
        (lower, upper)
    }
}

fn against(upper_first: bool, friction: f64) -> Value {
    let (mut own, other) = sides(upper_first);
    own["against"] = other;
    own["friction"] = json!(friction);
    own
}

#[test]
fn a_block_topples_about_the_end_of_the_one_below() {
    // Weight W = 48 kN on the arm 1 − s to the end of the lower block, pushed at half its height 1:
    // F/2 = W (1 − s), whatever the cells, and whichever side is named first.
    for (upper, lower) in PLANE.iter().zip(PLANE.iter().cycle().skip(2)) {
        for cells in [[4, 4], [4, 5], [7, 5], [10, 33]] {
            for (offset, upper_first) in [(0.9, true), (0.9, false), (0.377, true), (0.377, false)]
            {
                let mut below = block("lower", [0.0, 2.0], 0.0, cells[1], lower);
                below["supports"] = json!([{"group": "bottom", "displacement": [0, 0]}]);
                let mut above = block("upper", [offset, offset + 2.0], 1.0, cells[0], upper);
                above["loads"] =
                    json!([{"body_force": [0, -24000]}, {"group": "left", "traction": [1, 0]}]);
                let scene =
                    json!({"bodies": [below, above], "contacts": [against(upper_first, 10.0)]});
                let limits = rigid_limit(&from_json(&scene)).unwrap();
                let Beyond::Grows { factor, .. } = &limits.loads[1].beyond else {
                    unreachable!("{limits:?}");
                };
                let place = format!("{upper} on {lower} {cells:?} {offset} {upper_first}");
                close(*factor, 96000.0 * (1.0 - offset), 1e-7, &place);
            }
        }
    }
}

#[test]
fn a_block_beyond_its_balance_has_no_equilibrium_and_one_before_it_stands() {
    for name in ["topples_quad4", "topples_quad4_lower_first"] {
        let scene = from_file(&format!("toppling_overhang/{name}.json"));
        assert_eq!(
            solve(&scene).unwrap().status(),
            Status::NoEquilibrium,
            "{name}"
        );
    }
    for name in ["stands_quad8", "stands_quad8_lower_first"] {
        let (_, report) = certified(&from_file(&format!("toppling_overhang/{name}.json")));
        check_exchange(&report, name);
        // Two blocks of 48 kN on the ground, one on the other.
        close(report.totals.pairs[1].totals.normal, 48e3, 1e-9, name);
    }
}

#[test]
fn quadratic_cells_that_are_partly_covered_carry_what_linear_ones_do() {
    // 64 linear cells, 1.8606 on both sides; a mesh of four quadratic ones is within 3 %.
    let moved = "moved_100";
    for (name, part) in [
        ("scene", 0.03),
        ("fine", 0.01),
        (moved, 0.03),
        ("linear_fine", 1e-3),
    ] {
        let (_, report) = certified(&from_file(&format!("quadratic_partial_cover/{name}.json")));
        check_exchange(&report, name);
        close(report.totals.normal, 1.8606, part, name);
    }
    let (_, report) = certified(&from_file("quadratic_partial_cover/tet10.json"));
    check_exchange(&report, "tet10");
}

#[test]
fn bodies_that_do_not_touch_feel_nothing() {
    for name in [
        "phantom_quadratic/scene.json",
        "phantom_linear_coarse/scene.json",
    ] {
        let (_, report) = certified(&from_file(name));
        assert_eq!(
            (report.totals.normal, report.totals.open),
            (0.0, report.contacts.len())
        );
        // The smooth surfaces are 0.2 mm apart at the nearest place.
        assert!(
            report.contacts.iter().all(|contact| contact.gap > 0.199),
            "{name}"
        );
    }
}

/// A block of a width on one of width 1 and ten cells, pressed together by 0.02.
fn overhang(wide: usize, wide_first: bool, shift: f64, cell: &str) -> Report {
    let mut lower = block("lower", [-0.5, 0.5], -1.0, 10, cell);
    let mut upper = block("upper", [shift - 0.6, shift + 0.6], 0.0, wide, cell);
    for body in [&mut lower, &mut upper] {
        body["materials"] = json!([{"young": 100, "poisson": 0.3}]);
        body["mesh"]["rectangle"]["cells"][1] = json!(6);
    }
    lower["supports"] = json!([{"group": "bottom", "displacement": [0, 0]}]);
    upper["supports"] = json!([{"group": "top", "displacement": [0, -0.02]}]);
    let scene = json!({"bodies": [lower, upper], "contacts": [against(wide_first, 0.3)]});
    let (_, report) = certified(&from_json(&scene));
    check_exchange(&report, &format!("{wide} {wide_first} {shift} {cell}"));
    report
}

#[test]
fn the_peak_under_an_overhanging_edge_is_that_with_the_sides_exchanged() {
    for wide in 5..=40 {
        let [first, second] = [true, false].map(|first| overhang(wide, first, 0.0, "quad4").totals);
        close(
            first.peak_pressure,
            second.peak_pressure,
            0.5,
            &format!("{wide}"),
        );
        close(first.normal, second.normal, 0.01, &format!("{wide}"));
    }
}

#[test]
fn the_reported_overhang_has_the_peak_of_its_exchanged_pair() {
    let [wide, narrow] = ["scene", "sides_exchanged"].map(|name| {
        let (_, report) = certified(&from_file(&format!("overhang_peak/{name}.json")));
        check_exchange(&report, name);
        close(report.totals.normal, 2.5, 0.02, name);
        report.totals.peak_pressure
    });
    // The exchanged pair has finer cells on one side.
    close(wide, narrow, 0.05, "peak");
}

#[test]
fn where_both_sides_overhang_it_does_not_matter_which_is_named_first() {
    // Either side ends on the other. Peaks at both edges were 1.6 to 3.6 with the cells of a tenth of the width below,
    // and 2.2 to 2.5 with the finest ones above: no sliver carries more.
    for cell in ["quad4", "quad8"] {
        for wide in [5, 9, 11, 13, 23, 37] {
            for shift in [0.15, 0.27, 0.401] {
                let [one, two] =
                    [true, false].map(|first| overhang(wide, first, shift, cell).totals);
                let place = format!("{cell} {wide} {shift}");
                close(one.normal, two.normal, 1e-9, &place);
                close(one.peak_pressure, two.peak_pressure, 1e-9, &place);
                assert!(one.peak_pressure < 4.0, "{place} {}", one.peak_pressure);
            }
        }
    }
}

#[test]
fn cells_of_every_kind_are_asked() {
    assert_eq!(
        PLANE.len(),
        CellKind::all().filter(|kind| kind.dimension() == 2).count()
    );
}
