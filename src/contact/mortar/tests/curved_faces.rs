//! Checks on curved faces, where facets only approximate the surface.

#![allow(clippy::unwrap_used)]

use nalgebra::Vector3;

use super::sides::{Side, block, meet, shipped};
use crate::body::CellKind;
use crate::contact::mortar::{Mortar, MortarNode};

/// How a block's face is bent, its height above the face becoming the radius less 2.
type Bend = fn([f64; 3]) -> [f64; 3];

/// A plane arc of one radian.
fn arc([x, y, _]: [f64; 3]) -> [f64; 3] {
    let (angle, r) = (x - 0.5, 2.0 + y);
    [r * angle.sin(), r * angle.cos(), 0.0]
}

/// Part of a cylinder: facets stay plane.
fn barrel([x, y, z]: [f64; 3]) -> [f64; 3] {
    let (angle, r) = (x - 0.5, 2.0 + z);
    [r * angle.sin(), y, r * angle.cos()]
}

/// Part of a sphere: quadrilaterals are warped and no parallelograms.
fn dome([x, y, z]: [f64; 3]) -> [f64; 3] {
    let ray = Vector3::new(x - 0.5, y - 0.5, 1.0).normalize();
    (ray * (2.0 + z)).into()
}

const CASES: [([CellKind; 2], Bend); 6] = [
    ([CellKind::Quad4; 2], arc),
    ([CellKind::Tri3; 2], arc),
    ([CellKind::Hex8; 2], barrel),
    ([CellKind::Tet4, CellKind::Hex8], barrel),
    ([CellKind::Hex8; 2], dome),
    ([CellKind::Hex8, CellKind::Tet4], dome),
];

/// A face of radius 2 + `gap` (side 1, seen from inside) around one of radius 2.
fn around((kinds, bend): ([CellKind; 2], Bend), counts: [usize; 2], gap: f64) -> [Side; 2] {
    [
        block(kinds[0], counts[0], gap, "bottom").moved(bend),
        block(kinds[1], counts[1], -1.0, "top").moved(bend),
    ]
}

/// Worst error of a gap that should be `expected` at the nodes between two others.
///
/// At an end the normal is that of the last facet, half a facet off: first order.
fn worst_error(mortar: &Mortar, expected: impl Fn(&MortarNode) -> Option<f64>) -> f64 {
    let errors = mortar.nodes.iter().filter_map(|node| {
        let expected = expected(node)?;
        Some((node.initial_gap - expected).abs())
    });
    errors.fold(0.0, f64::max)
}

#[test]
fn the_gap_between_concentric_faces_converges_at_second_order() {
    for case in CASES {
        for gap in [0.0, 0.3] {
            let error = |n: usize| {
                let mortar = meet(&around(case, [7 * n, 5 * n], gap)).unwrap();
                assert!(mortar.nodes.len() > 7 * n);
                worst_error(&mortar, |node| (node.covered > 0.999).then_some(gap))
            };
            let errors = [error(1), error(2), error(4)];
            // Four in the limit; three tell second order from first.
            let rates = [errors[0] / errors[1], errors[1] / errors[2]];
            assert!(
                rates.iter().all(|rate| *rate > 3.0),
                "{:?} {gap} {errors:?}",
                case.0
            );
            // Chords of 1/28 and 1/20 rad on a radius of 2 stand off by 2 h²/8: 3e-4 and 6e-4.
            assert!(errors[2] < 1e-3, "{:?} {gap} {errors:?}", case.0);
        }
    }
}

#[test]
fn warped_facets_inside_a_face_are_wholly_covered() {
    // Weights count the warped facet's own area, not that of the plane it is seen in; the whole
    // is integrated with 2 × 2 points, 1e-8 off. At the rim chords of different length leave
    // some of it uncovered.
    for case in &CASES[4..] {
        let sides = around(*case, [7, 5], 0.0);
        let mortar = meet(&sides).unwrap();
        let inside = |node: &&MortarNode| {
            let [x, y, z] = sides[0].mesh.nodes[node.node];
            x.abs().max(y.abs()) < 0.3 * z
        };
        let inner: Vec<_> = mortar.nodes.iter().filter(inside).collect();
        assert!(inner.len() >= 9);
        for node in inner {
            assert!(
                (node.covered - 1.0).abs() < 1e-7,
                "{:e}",
                node.covered - 1.0
            );
        }
    }
}

#[test]
fn normal_forces_on_curved_faces_balance_in_force_and_moment() {
    for case in CASES {
        let sides = around(case, [7, 5], 0.05);
        let mortar = meet(&sides).unwrap();
        for node in mortar.nodes {
            // A unit reaction along the normal at x_i, the opposite ones at x²_k.
            let normal = Vector3::from(node.normal);
            let (mut force, mut moment) = (Vector3::zeros(), Vector3::zeros());
            for (own, weight) in &node.own {
                force += normal * *weight;
                moment += Vector3::from(sides[0].mesh.nodes[*own]).cross(&normal) * *weight;
            }
            for (across, weight) in &node.opposite {
                force -= normal * *weight;
                moment -= Vector3::from(sides[1].mesh.nodes[*across]).cross(&normal) * *weight;
            }
            assert!(
                force.norm() < 1e-14 && moment.norm() < 1e-13,
                "{:?} {moment}",
                case.0
            );
        }
    }
}

#[test]
fn a_rigid_motion_of_both_sides_opens_no_contact() {
    for case in CASES {
        let sides = around(case, [7, 5], 0.05);
        let (shift, spin) = (Vector3::new(0.3, -1.0, 0.2), Vector3::new(0.0, 0.0, 0.7));
        let moved = |x: [f64; 3]| shift + spin.cross(&Vector3::from(x));
        for node in meet(&sides).unwrap().nodes {
            let mut relative = Vector3::zeros();
            for (own, weight) in &node.own {
                relative += moved(sides[0].mesh.nodes[*own]) * *weight;
            }
            for (across, weight) in &node.opposite {
                relative -= moved(sides[1].mesh.nodes[*across]) * *weight;
            }
            assert!(
                relative.dot(&Vector3::from(node.normal)).abs() < 1e-13,
                "{:?}",
                case.0
            );
        }
    }
}

#[test]
fn the_gap_of_a_cylinder_on_a_flat_is_exact_along_the_normal() {
    // Side 1 bent to the circle of radius 2 about (0, 2): from (x, y) on it the flat y = 0 is y / |n_y|
    // away along the normal n. Near the lowest point that of the mean of both is inclined by half as much.
    let error = |n: usize| {
        let kinds = [CellKind::Quad4; 2];
        let lift = |[x, y, z]: [f64; 3]| {
            let (angle, r) = (x - 0.5, 2.0 - y);
            [r * angle.sin(), 2.0 - r * angle.cos(), z]
        };
        let one = block(kinds[0], 9 * n, 0.0, "bottom").moved(lift);
        let flat = |[x, y, z]: [f64; 3]| [4.0 * x - 2.0, y, z];
        let two = block(kinds[1], 7 * n, -1.0, "top").moved(flat);
        let nodes = one.mesh.nodes.clone();
        let mortar = meet(&[one, two]).unwrap();
        assert_eq!(mortar.nodes.len(), 9 * n + 1);
        worst_error(&mortar, |node| {
            let [x, y, _] = nodes[node.node];
            let (angle, inclined) = ((x / 2.0).asin(), node.normal[0].asin());
            assert!(angle.abs() > 0.1 || (inclined - angle / 2.0).abs() < 0.2 / n as f64);
            (angle.abs() < 0.3).then(|| y / node.normal[1].abs())
        })
    };
    assert!([2, 4, 8].into_iter().all(|n| error(n) < 1e-15));
}

#[test]
fn the_shipped_parabola_sees_the_flat_below_it() {
    // y = x²/(2R), R = 100 mm, over the flat y = 0; the slope is x/R, up to 0.2 at the rim.
    let sides = shipped(include_str!(
        "../../../../tests/data/meshes/B2_mindlin_n16.msh"
    ));
    let mortar = meet(&sides).unwrap();
    let count = |side: &Side| side.facets.len() + 1;
    assert_eq!(mortar.nodes.len(), count(&sides[0]));
    for node in &mortar.nodes {
        let along = |axis: usize| -> f64 {
            let terms = node.own.iter();
            terms.map(|(k, w)| w * sides[0].mesh.nodes[*k][axis]).sum()
        };
        let (x, y) = (along(0), along(1));
        // Coordinates of tens of mm, rounded as the mesh makes them: a guard that the right nodes are seen. At
        // the rim a facet 3 mm long ends beside the flat: there its contact stands on the chord.
        assert!((y - x * x / 200.0).abs() < if node.moved { 0.02 } else { 1e-9 });
        let off = (node.initial_gap - y / node.normal[1].abs()).abs();
        assert!(off < 1e-9, "{x} {y} {off:e}");
    }
}
