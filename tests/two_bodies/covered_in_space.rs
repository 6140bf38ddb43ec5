//! Where one solid ends on another, and where its facets are round: reactions stand on what is covered and
//! nowhere else, and gaps are those of the surfaces that facets stand for.

use std::collections::HashMap;
use std::f64::consts::PI;

use dpana::body::{CellKind, Facet, Group, Mesh};
use dpana::report::{Beyond, Report};
use dpana::scene::SceneBody;
use dpana::{Scene, rigid_limit};
use nalgebra::Vector3;
use serde_json::{Value, json};

use crate::stacks::{body, certified, contact, hold_at, scene};

/// The solid cells, as scenes name them.
const SOLID: [&str; 5] = ["hex8", "tet4", "hex20", "tet10", "hex27"];

fn from_json(value: &Value) -> Scene {
    Scene::from_json(&value.to_string(), "covered.json").unwrap()
}

fn close(found: f64, expected: f64, part: f64, place: &str) {
    let off = (found - expected).abs();
    assert!(
        off <= part * expected.abs(),
        "{place}: {found} against {expected}"
    );
}

/// Forces and moments of the two sides are equal and opposite.
fn check_exchange(report: &Report, place: &str) {
    for pair in &report.totals.pairs {
        if let Some(exchange) = &pair.exchange {
            let (force, moment) = (exchange.force_defect.scaled, exchange.moment_defect.scaled);
            assert!(force < 1e-12 && moment < 1e-12, "{place} {exchange:?}");
        }
    }
}

/// A block between ranges along the three axes.
fn block(name: &str, ranges: [[f64; 2]; 3], cells: [usize; 3], cell: &str, young: f64) -> Value {
    let [x, y, z] = ranges;
    json!({
        "name": name,
        "mesh": {"box": {"x": x, "y": y, "z": z, "cells": cells, "cell": cell}},
        "materials": [{"young": young, "poisson": 0.3}]
    })
}

/// The upper block's bottom against the lower one's top; either may be named first.
fn against(upper_first: bool, friction: f64) -> Value {
    let (upper, lower) = (
        json!({"body": "upper", "group": "bottom"}),
        json!({"body": "lower", "group": "top"}),
    );
    let (mut own, other) = if upper_first {
        (upper, lower)
    } else {
        (lower, upper)
    };
    own["against"] = other;
    own["friction"] = json!(friction);
    own
}

#[test]
fn a_solid_block_topples_about_the_end_of_the_one_below() {
    // Weight W = 48 kN on the arm 1 − s to the end of the lower block, pushed at half its height 1:
    // F/2 = W (1 − s), whatever the cells, and whichever side is named first.
    for (upper, lower) in SOLID.iter().zip(SOLID.iter().cycle().skip(1)) {
        for (cells, offset, upper_first) in [
            ([4, 5], 0.9, true),
            ([4, 5], 0.9, false),
            ([5, 4], 0.377, true),
            ([5, 4], 0.377, false),
        ] {
            let unit = [0.0, 1.0];
            let (along, above) = ([offset, offset + 2.0], [1.0, 2.0]);
            let mut below = block(
                "lower",
                [[0.0, 2.0], unit, unit],
                [cells[1], 2, 1],
                lower,
                3e10,
            );
            below["supports"] = json!([{"group": "bottom", "displacement": [0, 0, 0]}]);
            let mut above = block("upper", [along, unit, above], [cells[0], 3, 1], upper, 3e10);
            above["loads"] =
                json!([{"body_force": [0, 0, -24000]}, {"group": "left", "traction": [1, 0, 0]}]);
            let scene = json!({"bodies": [below, above], "contacts": [against(upper_first, 10.0)]});
            let limits = rigid_limit(&from_json(&scene)).unwrap();
            let Beyond::Grows { factor, .. } = &limits.loads[1].beyond else {
                unreachable!("{limits:?}");
            };
            let place = format!("{upper} on {lower} {cells:?} {offset} {upper_first}");
            close(*factor, 96000.0 * (1.0 - offset), 1e-6, &place);
        }
    }
}

/// A block 1.2 wide and 0.8 deep on one of 1 by 1, moved across it, pressed together by 0.02: each of the
/// two ends on the other.
fn crossing(cell: &str, cells: [usize; 2], upper_first: bool, shift: [f64; 2]) -> Report {
    let range = |half: f64, shift: f64| [shift - half, shift + half];
    let lower = [range(0.5, 0.0), range(0.5, 0.0), [-0.5, 0.0]];
    let upper = [range(0.6, shift[0]), range(0.4, shift[1]), [0.0, 0.5]];
    let [below, above] = cells.map(|n| [n, n, n.div_ceil(2)]);
    let mut lower = block("lower", lower, below, cell, 100.0);
    let mut upper = block("upper", upper, above, cell, 100.0);
    lower["supports"] = json!([{"group": "bottom", "displacement": [0, 0, 0]}]);
    upper["supports"] = json!([{"group": "top", "displacement": [0, 0, -0.02]}]);
    let scene = json!({"bodies": [lower, upper], "contacts": [against(upper_first, 0.3)]});
    let (_, report) = certified(&from_json(&scene));
    check_exchange(
        &report,
        &format!("{cell} {cells:?} {upper_first} {shift:?}"),
    );
    report
}

#[test]
fn blocks_that_end_on_each_other_press_alike_from_either_side() {
    for cell in ["hex8", "tet4"] {
        for (cells, shift) in [
            ([5, 6], [0.0, 0.0]),
            ([6, 5], [0.23, 0.05]),
            ([6, 7], [0.31, -0.27]),
        ] {
            let [first, second] =
                [true, false].map(|first| crossing(cell, cells, first, shift).totals);
            let place = format!("{cell} {cells:?} {shift:?}");
            close(first.normal, second.normal, 0.03, &place);
            close(first.peak_pressure, second.peak_pressure, 0.5, &place);
        }
    }
}

/// A block whose bottom is a cap of the radius 10 over a wide flat one of coarse cells, `gap` above it.
fn cap(gap: f64, cap_first: bool, down: f64, coarse: f64) -> Report {
    let mut upper = dpana::body::box_mesh(
        &(0..=16)
            .map(|k| f64::from(k) * 0.5 - 4.0)
            .collect::<Vec<_>>(),
        &(0..=16)
            .map(|k| f64::from(k) * 0.5 - 4.0)
            .collect::<Vec<_>>(),
        &[0.0, 0.5, 1.0, 2.0, 4.0],
        CellKind::Tet4,
    )
    .unwrap();
    for [x, y, z] in &mut upper.nodes {
        let rise = 10.0 - (100.0 - *x * *x - *y * *y).sqrt();
        *z += rise * (1.0 - *z / 4.0) + gap;
    }
    let count = (30.0 / coarse).round();
    let lines = |low: f64, high: f64, count: f64| -> Vec<f64> {
        (0..=count as usize)
            .map(|k| low + (high - low) * k as f64 / count)
            .collect()
    };
    let lower = dpana::body::box_mesh(
        &lines(-15.0, 15.0, count),
        &lines(-15.0, 15.0, count),
        &lines(-10.0, 0.0, (10.0 / coarse).round()),
        CellKind::Hex8,
    )
    .unwrap();
    let held = |body: SceneBody, group: &str, down: f64| {
        let ways = [(0, 0.0), (1, 0.0), (2, down)];
        ways.into_iter().fold(body, |body, (axis, value)| {
            crate::stacks::hold(body, group, axis, value)
        })
    };
    let bodies = vec![
        held(body("upper", upper, 210e3, 0.3), "top", -down),
        held(body("lower", lower, 210e3, 0.3), "bottom", 0.0),
    ];
    let (upper, lower) = (["upper", "bottom"], ["lower", "top"]);
    let pair = if cap_first {
        contact(upper, lower, 0.0)
    } else {
        contact(lower, upper, 0.0)
    };
    let (_, report) = certified(&scene(bodies, vec![pair]));
    check_exchange(&report, &format!("{gap} {cap_first}"));
    report
}

#[test]
fn a_cap_over_coarse_flat_facets_touches_only_where_it_is_pressed() {
    for cap_first in [true, false] {
        for gap in [0.2, 0.01] {
            assert_eq!(
                cap(gap, cap_first, 0.0, 5.0).totals.normal,
                0.0,
                "{gap} {cap_first}"
            );
        }
    }
    // Hertz: 4/3 E*/2 √R δ^(3/2) = 1376 N; the block's facets are eleven times the radius of the contact.
    for cap_first in [true, false] {
        let [coarse, fine] = [5.0, 1.25].map(|size| cap(0.0, cap_first, 0.02, size).totals.normal);
        close(coarse, 1376.0, 0.7, "coarse");
        close(fine, 1376.0, 0.3, "fine");
    }
}

/// Radii of the hollow of the ball, of the joint and of the shell in mm, by how much the ball is too thick.
const RADII: [f64; 3] = [5.0, 10.0, 20.0];
const TOO_THICK: f64 = 0.02;

/// A shell of hexahedra: a cube with `n` by `n` facets a face, blown up, in layers; groups `inner`, `outer`.
fn shell(n: usize, layers: usize, radii: [f64; 2]) -> Mesh {
    let mut mesh = Mesh::new(3, Vec::new());
    let mut known: HashMap<[i64; 3], usize> = HashMap::new();
    let mut rays = Vec::new();
    let mut quads: Vec<[usize; 4]> = Vec::new();
    for face in 0..6 {
        let mut at = |i: usize, j: usize| {
            let along = |k: usize| (PI / 4.0 * (2.0 * k as f64 / n as f64 - 1.0)).tan();
            let sign = if face < 3 { 1.0 } else { -1.0 };
            let mut ray = [0.0; 3];
            // Turned so that the facets look outwards.
            (ray[face % 3], ray[(face + 1) % 3], ray[(face + 2) % 3]) =
                (sign, sign * along(i), along(j));
            let ray = Vector3::from(ray).normalize();
            let key = [ray.x, ray.y, ray.z].map(|x| (x * 1e9).round() as i64);
            *known.entry(key).or_insert_with(|| {
                rays.push(ray);
                rays.len() - 1
            })
        };
        for i in 0..n {
            for j in 0..n {
                quads.push([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
            }
        }
    }
    for layer in 0..=layers {
        let r = radii[0] + (radii[1] - radii[0]) * layer as f64 / layers as f64;
        mesh.nodes
            .extend(rays.iter().map(|ray| <[f64; 3]>::from(ray * r)));
    }
    let up = rays.len();
    for layer in 0..layers {
        for quad in &quads {
            let [a, b, c, d] = quad.map(|ray| ray + layer * up);
            mesh.push_cell(
                CellKind::Hex8,
                &[a, b, c, d, a + up, b + up, c + up, d + up],
            );
        }
    }
    for (name, layer) in [("inner", 0), ("outer", layers)] {
        let facets = quads.iter().map(|quad| Facet {
            nodes: quad.map(|ray| ray + layer * up).to_vec(),
        });
        mesh.groups
            .insert(name.to_owned(), Group::Facets(facets.collect()));
    }
    mesh
}

/// A shell that can only breathe: its nodes on the axes at a radius stay there.
fn breathing(name: &str, mesh: Mesh, radius: f64) -> SceneBody {
    let mut body = body(name, mesh, 210e3, 0.3);
    for axis in 0..3 {
        for sign in [1.0, -1.0] {
            let mut at = [0.0; 3];
            at[axis] = sign * radius;
            body = hold_at(body, at, (axis + 1) % 3, 0.0);
            body = hold_at(body, at, (axis + 2) % 3, 0.0);
        }
    }
    body
}

/// p of two spherical shells, in MPa (Timoshenko & Goodier, § 142).
fn lame() -> f64 {
    let [a, b, c] = RADII.map(|r| r * r * r);
    let give = |other: f64| (0.4 * b + 1.3 * other / 2.0) / (other - b).abs();
    TOO_THICK * 210e3 / (RADII[1] * (give(a) + give(c)))
}

/// A ball and a shell of so many facets along the edge of a face.
fn fit(facets: [usize; 2], ball_first: bool, rounded: bool) -> Report {
    let layers = 8;
    let ball = shell(facets[0], layers, [RADII[0], RADII[1] + TOO_THICK]);
    let hull = shell(facets[1], layers, [RADII[1], RADII[2]]);
    let bodies = vec![
        breathing("ball", ball, RADII[0]),
        breathing("shell", hull, RADII[2]),
    ];
    let (ball, hull) = (["ball", "outer"], ["shell", "inner"]);
    let mut pair = if ball_first {
        contact(ball, hull, 0.0)
    } else {
        contact(hull, ball, 0.0)
    };
    pair.rounded = Some(rounded);
    let (_, report) = certified(&scene(bodies, vec![pair]));
    check_exchange(&report, &format!("{facets:?} {ball_first} {rounded}"));
    report
}

#[test]
fn a_ball_of_straight_facets_fits_a_shell_as_a_sphere_would() {
    // Facets of 7.5° and 11°: the sagitta of the larger ones is 2.4 times the overlap. The cells themselves
    // are 1.2 % too soft at 11° (matching facets), 0.2 % at 7.5°.
    for ball_first in [true, false] {
        let report = fit([12, 8], ball_first, true);
        let force = report.totals.normal / (4.0 * PI * RADII[1] * RADII[1] * lame()) - 1.0;
        let mean = report.totals.normal / report.totals.contact_area;
        let peak = report.totals.peak_pressure / mean;
        assert!(
            force.abs() < 0.025 && peak < 1.05,
            "{ball_first} {force} {peak}"
        );
        assert_eq!(report.totals.open, 0);
    }
    let chords = fit([12, 8], true, false).totals;
    assert!(chords.open > 100, "{}", chords.open);
}
