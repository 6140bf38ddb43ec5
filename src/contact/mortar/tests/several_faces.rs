//! Checks where there is more than one face to meet, and where there is none.

#![allow(clippy::unwrap_used)]

use nalgebra::Vector3;

use super::sides::{Side, block, join, meet, stack, weight, worst_gap};
use crate::body::{CellKind, Facet, Mesh, Model};
use crate::contact::mortar::{MortarNode, couple};
use crate::error::Error;

#[test]
fn of_several_layers_the_nearest_is_met() {
    // A second lower block at half the width, 0.3 higher: 0.2 below the upper one instead of 0.5.
    for (kind, kind2) in [
        (CellKind::Quad4, CellKind::Tri3),
        (CellKind::Hex8, CellKind::Tet4),
    ] {
        let [one, two] = stack([kind, kind2], [7, 5], 0.5);
        let half = block(kind2, 4, -1.0, "top").moved(|[x, y, z]| {
            if kind.dimension() == 2 {
                [0.5 * x, y + 0.3, z]
            } else {
                [0.5 * x, y, z + 0.3]
            }
        });
        let both = join(two, &half);
        let upper = both.mesh.nodes.len() - half.mesh.nodes.len();
        let mortar = meet(&[one, both]).unwrap();
        assert!((weight(&mortar) - 1.0).abs() < 1e-13);
        // The upper layer takes the half of the pressure that falls on it, no more.
        let taken = mortar.nodes.iter().flat_map(|node| {
            let upper = node.opposite.iter().filter(move |entry| entry.0 >= upper);
            upper.map(|entry| entry.1 * node.weight)
        });
        let taken: f64 = taken.sum();
        assert!((taken - 0.5).abs() < 1e-13, "{kind:?} {taken}");
    }
}

#[test]
fn what_lies_far_behind_a_face_is_not_met() {
    // A second body whose top is 5 above the face, seen through body 1; the first one, moved by
    // 0.4, covers 0.6 of the face and nothing else does.
    for kinds in [[CellKind::Quad4; 2], [CellKind::Hex8; 2]] {
        let [one, two] = stack(kinds, [4, 3], 0.0);
        let two = two.moved(|[x, y, z]| [x + 0.4, y, z]);
        let mortar = meet(&[one, join(two, &block(kinds[1], 3, 4.0, "top"))]).unwrap();
        assert!((weight(&mortar) - 0.6).abs() < 1e-14);
        assert!(worst_gap(&mortar, Vector3::zeros()) < 1e-14);
    }
}

#[test]
fn overlap_is_a_negative_gap_down_to_a_twentieth_of_the_smaller_side() {
    for (kinds, allowed) in [
        ([CellKind::Quad4; 2], 0.05),
        ([CellKind::Hex8; 2], 0.05 * 2.0_f64.sqrt()),
    ] {
        let mortar = meet(&stack(kinds, [4, 3], 0.001 - allowed)).unwrap();
        let off = |node: &MortarNode| (node.initial_gap - 0.001 + allowed).abs();
        assert!(mortar.nodes.iter().all(|node| off(node) < 1e-15));
        for depth in [allowed + 0.001, 0.4, 0.8] {
            let found = meet(&stack(kinds, [4, 3], -depth)).unwrap_err();
            let Error::Overlap { overlap, .. } = found else {
                unreachable!("{depth} {found}");
            };
            assert!((overlap - depth).abs() < 1e-15, "{found}");
        }
    }
}

#[test]
fn the_far_side_of_a_thin_body_is_no_overlap() {
    // The top of a plate 0.2 thick looks at the bottom of the block below it from behind; the
    // assumed surfaces hold both.
    for kinds in [[CellKind::Quad4; 2], [CellKind::Hex8; 2]] {
        let dimension = kinds[0].dimension();
        let plain = stack(kinds, [4, 3], 0.0).map(|side| {
            side.moved(|mut x| {
                x[dimension - 1] *= 0.2;
                x
            })
        });
        let grown = plain.each_ref().map(|side| Side {
            mesh: side.mesh.clone(),
            facets: side.mesh.boundary_facets(),
        });
        let (plain, grown) = (meet(&plain).unwrap(), meet(&grown).unwrap());
        assert_eq!(plain.nodes.len(), grown.nodes.len(), "{kinds:?}");
        for node in &plain.nodes {
            let same = grown
                .nodes
                .iter()
                .find(|other| other.node == node.node)
                .unwrap();
            let weights = node.opposite.iter().zip(&same.opposite);
            for ((a, weight), (b, other)) in weights {
                assert!(a == b && (weight - other).abs() < 1e-14, "{kinds:?}");
            }
        }
    }
}

#[test]
fn a_sheet_that_faces_both_ways_has_no_normal() {
    // Both sides of one line, between a flat below and a flat above.
    let nodes = vec![
        [0.0; 3],
        [1.0, 0.0, 0.0],
        [0.0, -1.0, 0.0],
        [1.0, -1.0, 0.0],
        [0.0, 1.0, 0.0],
        [1.0, 1.0, 0.0],
    ];
    let mesh = Mesh::new(2, nodes);
    let line = |nodes: [usize; 2]| Facet {
        nodes: nodes.to_vec(),
    };
    let (sheet, flats) = ([line([0, 1]), line([1, 0])], [line([3, 2]), line([4, 5])]);
    let found = couple(&mesh, &sheet, &mesh, &flats, Model::Solid, "contacts[0]").unwrap_err();
    assert!(matches!(found, Error::Direction { .. }), "{found}");
    assert_eq!(
        couple(
            &mesh,
            &sheet[..1],
            &mesh,
            &flats,
            Model::Solid,
            "contacts[0]"
        )
        .unwrap()
        .nodes
        .len(),
        2
    );
}

#[test]
fn two_faces_of_one_mesh_meet_across_a_slot() {
    for (kind, kind2) in [
        (CellKind::Quad4, CellKind::Tri3),
        (CellKind::Tet4, CellKind::Hex8),
    ] {
        let [one, two] = stack([kind, kind2], [7, 5], 0.01);
        let apart = meet(&stack([kind, kind2], [7, 5], 0.01)).unwrap();
        let lower = two.facets.len();
        let body = join(two, &one);
        let (below, above) = body.facets.split_at(lower);
        let first = body.mesh.nodes.len() - one.mesh.nodes.len();
        let slot = couple(
            &body.mesh,
            above,
            &body.mesh,
            below,
            Model::Solid,
            "contacts[0]",
        )
        .unwrap();
        for (a, b) in apart.nodes.iter().zip(&slot.nodes) {
            assert_eq!((a.node + first, &a.opposite), (b.node, &b.opposite));
        }
    }
}

#[test]
fn a_node_at_the_tip_of_a_crack_meets_nobody() {
    // Two matching lips of two lines each, joined at node 0 where the crack ends.
    let nodes = vec![
        [0.0; 3],
        [1.0, 0.0, 0.0],
        [2.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [2.0, 0.0, 0.0],
    ];
    let mesh = Mesh::new(2, nodes);
    let lines = |pairs: [[usize; 2]; 2]| {
        pairs.map(|pair| Facet {
            nodes: pair.to_vec(),
        })
    };
    let (upper, lower) = (lines([[0, 1], [1, 2]]), lines([[4, 3], [3, 0]]));
    let mortar = couple(&mesh, &upper, &mesh, &lower, Model::Solid, "contacts[0]").unwrap();
    let met = mortar
        .nodes
        .iter()
        .map(|n| (n.node, n.opposite[0].0, n.opposite.len()));
    let met: Vec<_> = met.collect();
    assert_eq!(met, [(1, 3, 1), (2, 4, 1)]);
}

#[test]
fn sides_that_do_not_face_each_other_are_refused_by_name() {
    for kinds in [[CellKind::Quad4; 2], [CellKind::Hex8; 2]] {
        let [one, two] = stack(kinds, [3, 4], 0.1);
        let beside = stack(kinds, [3, 4], 0.1).map(|side| side.moved(|x| x));
        let [_, away] = beside;
        let away = away.moved(|[x, y, z]| [x + 2.0, y, z]);
        let found = meet(&[one, away]).unwrap_err();
        let Error::NothingFacesOpposite { place, averted, .. } = found else {
            unreachable!("{found}");
        };
        assert_eq!((place.as_str(), averted), ("contacts[0]", 0));
        // The back of side 2 instead of its face.
        let mut back = two;
        for facet in &mut back.facets {
            facet.nodes.reverse();
        }
        let [one, _] = stack(kinds, [3, 4], 0.1);
        let found = meet(&[one, back]).unwrap_err();
        assert!(
            matches!(found, Error::NothingFacesOpposite { averted: 3.., .. }),
            "{found}"
        );
    }
}

#[test]
fn flawed_facets_are_refused_with_their_place() {
    let says = |change: &dyn Fn(&mut [Side; 2]), part: &str| {
        let mut sides = stack([CellKind::Hex8; 2], [2, 2], 0.0);
        change(&mut sides);
        let found = meet(&sides).unwrap_err().to_string();
        assert!(found.contains(part), "{found}");
    };
    says(&|s| s[0].facets.clear(), "contacts[0].facets: empty");
    says(
        &|s| s[1].facets[2].nodes[1] = 99_999,
        "contacts[0].opposite[2]: node 99999",
    );
    says(
        &|s| s[1].facets[1].nodes.truncate(2),
        "wrong number of nodes",
    );
    says(
        &|s| s[0].facets[3].nodes.swap(0, 1),
        "contacts[0].facets[3]",
    );
    says(
        &|s| s[0].facets[0].nodes = vec![0, 0, 1],
        "contacts[0].facets[0]",
    );
    let plane = |s: &mut [Side; 2]| s[1].mesh.dimension = 2;
    says(&plane, "dimension 2");
    let lost = |s: &mut [Side; 2]| {
        let node = s[1].facets[0].nodes[0];
        s[1].mesh.nodes[node][1] = f64::NAN;
    };
    says(&lost, "NaN");
}
