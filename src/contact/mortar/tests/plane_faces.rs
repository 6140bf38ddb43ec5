//! Checks on plane faces, where everything is exact to round-off.

#![allow(clippy::unwrap_used)]

use nalgebra::{Rotation3, Vector3};

use super::sides::{STACKS, Side, meet, shipped, stack, weight, worst_gap};
use crate::body::CellKind;
use crate::contact::mortar::{Mortar, MortarNode};

/// Worst difference between what a unit pressure on side 1 does to side 2, `Σ_i D_i P_ik`,
/// and `∫ N²_k dA` over side 2's whole face.
fn worst_share(mortar: &Mortar, two: &Side) -> f64 {
    let mut share = vec![0.0; two.mesh.nodes.len()];
    for facet in &two.facets {
        let geometry = two.mesh.facet_geometry(facet);
        for (node, weight) in facet.nodes.iter().zip(geometry.weights) {
            share[*node] -= weight;
        }
    }
    for node in &mortar.nodes {
        for (across, weight) in &node.opposite {
            share[*across] += node.weight * weight;
        }
    }
    share
        .into_iter()
        .fold(0.0, |worst, left| worst.max(left.abs()))
}

#[test]
fn faces_that_do_not_match_pass_constants_and_linear_fields() {
    for (kinds, counts) in STACKS {
        let sides = stack(kinds, counts, 0.0);
        let mortar = meet(&sides).unwrap();
        let normal = if kinds[0].dimension() == 2 {
            [0.0, -1.0, 0.0]
        } else {
            [0.0, 0.0, -1.0]
        };
        for node in &mortar.nodes {
            let sum: f64 = node.opposite.iter().map(|entry| entry.1).sum();
            assert!((sum - 1.0).abs() < 1e-14 && (node.covered - 1.0).abs() < 1e-14);
            assert!((Vector3::from(node.normal) - Vector3::from(normal)).norm() < 1e-15);
        }
        // Σ_k P_ik x²_k = x_i is the exact transfer of every linear field; the face has the area 1.
        assert!(worst_gap(&mortar, Vector3::zeros()) < 1e-14, "{kinds:?}");
        assert!((weight(&mortar) - 1.0).abs() < 1e-14, "{kinds:?}");
        assert!(worst_share(&mortar, &sides[1]) < 1e-15, "{kinds:?}");
    }
}

#[test]
fn a_node_carries_the_whole_of_its_tributary_area() {
    for (kinds, counts) in STACKS {
        let [one, two] = stack(kinds, counts, 0.0);
        let mut areas = vec![0.0; one.mesh.nodes.len()];
        for facet in &one.facets {
            let geometry = one.mesh.facet_geometry(facet);
            for (node, weight) in facet.nodes.iter().zip(geometry.weights) {
                areas[*node] += weight;
            }
        }
        for node in meet(&[one, two]).unwrap().nodes {
            assert!((node.weight - areas[node.node]).abs() < 1e-15);
        }
    }
}

#[test]
fn matching_faces_meet_node_by_node() {
    for kind in CellKind::LINEAR {
        let sides = stack([kind; 2], [6, 6], 0.25);
        for node in meet(&sides).unwrap().nodes {
            let [(across, weight)] = node.opposite[..] else {
                unreachable!("{kind:?} {:?}", node.opposite);
            };
            let (x, x2) = (sides[0].mesh.nodes[node.node], sides[1].mesh.nodes[across]);
            assert_eq!((x[0], weight), (x2[0], 1.0));
            assert!((node.initial_gap - 0.25).abs() < 1e-15);
        }
    }
}

#[test]
fn any_forces_on_coincident_faces_balance_in_force_and_moment() {
    for (kinds, counts) in STACKS {
        let [one, two] = stack(kinds, counts, 0.0);
        let mortar = meet(&[one, two]).unwrap();
        let [one, two] = stack(kinds, counts, 0.0);
        let (mut force, mut moment) = (Vector3::zeros(), Vector3::zeros());
        for (index, node) in mortar.nodes.iter().enumerate() {
            let wave = |phase: f64| (2.3 * index as f64 + phase).sin();
            let reaction = Vector3::new(wave(0.0), wave(1.0), wave(2.0));
            force += reaction;
            moment += Vector3::from(one.mesh.nodes[node.node]).cross(&reaction);
            for (across, weight) in &node.opposite {
                force -= reaction * *weight;
                moment -= Vector3::from(two.mesh.nodes[*across]).cross(&reaction) * *weight;
            }
        }
        assert!(
            force.norm() < 1e-13 && moment.norm() < 1e-13,
            "{kinds:?} {force} {moment}"
        );
    }
}

#[test]
fn a_gap_of_ten_elements_changes_no_weight() {
    for (kinds, counts) in STACKS {
        let near = meet(&stack(kinds, counts, 0.0)).unwrap();
        for gap in [10.0 / counts[0] as f64, 300.0, -0.04] {
            let far = meet(&stack(kinds, counts, gap)).unwrap();
            for (near, far) in near.nodes.iter().zip(&far.nodes) {
                assert_eq!(near.node, far.node);
                assert!((far.initial_gap - gap).abs() < 1e-15 * (1.0 + gap.abs()));
                let nodes = near.opposite.iter().chain(&far.opposite);
                for (across, _) in nodes {
                    let difference = weight_of(near, *across) - weight_of(far, *across);
                    // The coordinates themselves are only as good as the gap's last digit.
                    let digit = 1e-14 * (1.0 + gap.abs());
                    assert!(difference.abs() < digit, "{kinds:?} {gap} {difference:e}");
                }
            }
        }
    }
}

/// Weight with which a contact node meets a node of side 2.
fn weight_of(contact: &MortarNode, across: usize) -> f64 {
    let entry = contact.opposite.iter().find(|entry| entry.0 == across);
    entry.map_or(0.0, |entry| entry.1)
}

#[test]
fn an_overhanging_face_counts_what_is_covered() {
    // The lower block moved by s covers 1 − s of the upper face.
    for (kinds, counts) in STACKS {
        for shift in [0.31, -0.5, 1e-3, 1.0 - 1e-3] {
            let [one, two] = stack(kinds, counts, 0.0);
            let two = two.moved(|[x, y, z]| [x + shift, y, z]);
            let mortar = meet(&[one, two]).unwrap();
            assert!((weight(&mortar) - 1.0 + shift.abs()).abs() < 1e-14);
            for node in &mortar.nodes {
                let sum: f64 = node.opposite.iter().map(|entry| entry.1).sum();
                assert!((sum - 1.0).abs() < 1e-14 && node.covered <= 1.0);
            }
            let worst = worst_gap(&mortar, Vector3::zeros());
            assert!(worst < 1e-12, "{kinds:?} {shift} {worst:e}");
        }
    }
}

#[test]
fn a_small_block_on_a_large_one_presses_evenly() {
    // Side 2 is the small one, of edge 0.37, turned by 30 degrees in 3D: each of its nodes
    // gets its own ∫ N²_k dA of a unit pressure although most facets of side 1 are cut.
    for (kinds, counts) in STACKS {
        let angle = if kinds[0].dimension() == 2 {
            0.0
        } else {
            std::f64::consts::FRAC_PI_6
        };
        let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), angle);
        let [one, two] = stack(kinds, counts, 0.0);
        let two = two.moved(|x| (turn * Vector3::from(x) * 0.37).into());
        let two = two.moved(|[x, y, z]| [x + 0.29, y + 0.2 * turn[(1, 0)].signum(), z]);
        let two = if kinds[0].dimension() == 2 {
            two.moved(|[x, y, z]| [x, y - 0.2 * turn[(1, 0)].signum(), z])
        } else {
            two
        };
        let sides = [one, two];
        let mortar = meet(&sides).unwrap();
        let area = if angle == 0.0 { 0.37 } else { 0.37 * 0.37 };
        assert!((weight(&mortar) - area).abs() < 1e-14, "{kinds:?}");
        let worst = (
            worst_share(&mortar, &sides[1]),
            worst_gap(&mortar, Vector3::zeros()),
        );
        assert!(worst.0 < 1e-14 && worst.1 < 1e-11, "{kinds:?} {worst:?}");
    }
}

/// Shears and squeezes the inside of the unit square so that no facet is a parallelogram.
fn distort([x, y, z]: [f64; 3]) -> [f64; 3] {
    let bubble = x * (1.0 - x) * y * (1.0 - y);
    [x + 0.9 * bubble, y - 0.6 * bubble * (1.0 + x), z]
}

#[test]
fn trapezia_carry_a_constant_pressure() {
    for (kinds, counts) in [
        ([CellKind::Hex8; 2], [4, 3]),
        ([CellKind::Hex8, CellKind::Tet4], [5, 6]),
    ] {
        let sides = stack(kinds, counts, 0.0).map(|side| side.moved(distort));
        let mortar = meet(&sides).unwrap();
        let (gap, share) = (
            worst_gap(&mortar, Vector3::zeros()),
            worst_share(&mortar, &sides[1]),
        );
        assert!(gap < 1e-14 && share < 1e-13, "{gap:e} {share:e}");
        for node in &mortar.nodes {
            assert!(
                (node.covered - 1.0).abs() < 1e-12,
                "{:e}",
                node.covered - 1.0
            );
        }
    }
}

#[test]
fn position_and_units_do_not_matter() {
    let axis = nalgebra::Unit::new_normalize(Vector3::new(1.0, 2.0, -0.5));
    for (kinds, counts) in STACKS {
        let solid = kinds[0].dimension() == 3;
        let axis = if solid { axis } else { Vector3::z_axis() };
        let turn = Rotation3::from_axis_angle(&axis, 0.7);
        let reference = meet(&stack(kinds, counts, 0.1)).unwrap();
        for unit in [1e-6_f64, 1.0, 1e6] {
            let place = |x| (turn * Vector3::from(x) * unit).into();
            let turned = meet(&stack(kinds, counts, 0.1).map(|side| side.moved(place))).unwrap();
            let area = if solid { unit * unit } else { unit };
            for (a, b) in reference.nodes.iter().zip(&turned.nodes) {
                assert!((turn * Vector3::from(a.normal) - Vector3::from(b.normal)).norm() < 1e-14);
                assert!((a.weight * area - b.weight).abs() < 1e-14 * area);
                assert!((b.initial_gap - 0.1 * unit).abs() < 1e-14 * unit);
                assert_eq!(a.node, b.node);
            }
        }
    }
}

#[test]
fn the_shipped_patches_are_exact() {
    for (text, contacts, axis) in [
        (
            include_str!("../../../../tests/data/meshes/D_patch2d_7_5.msh"),
            8,
            1,
        ),
        (
            include_str!("../../../../tests/data/meshes/D_patch3d_4_3.msh"),
            25,
            2,
        ),
    ] {
        let mortar = meet(&shipped(text)).unwrap();
        assert_eq!(mortar.nodes.len(), contacts);
        assert!(mortar.nodes.iter().all(|node| node.normal[axis] == -1.0));
        assert!(
            worst_gap(&mortar, Vector3::zeros()) < 1e-14,
            "along axis {axis}"
        );
        assert!((weight(&mortar) - 1.0).abs() < 1e-14, "along axis {axis}");
    }
}
