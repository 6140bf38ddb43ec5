//! Checks on plane faces, where everything is exact to round-off.

#![allow(clippy::unwrap_used)]

use nalgebra::{Rotation3, Vector3};

use super::{Mortar, MortarNode, couple};
use crate::body::samples::facets;
use crate::body::{CellKind, Facet, Mesh, box_mesh, gmsh, graded, rectangle};
use crate::error::Error;

/// One of two bodies that meet: its mesh and its contact face in outward order.
pub(super) struct Side {
    pub(super) mesh: Mesh,
    pub(super) facets: Vec<Facet>,
}

impl Side {
    fn new(mesh: Mesh, face: &str) -> Self {
        let facets = mesh.orient(&facets(&mesh, face)).unwrap();
        Self { mesh, facets }
    }

    /// Moves every node.
    pub(super) fn moved(mut self, to: impl Fn([f64; 3]) -> [f64; 3]) -> Self {
        for node in &mut self.mesh.nodes {
            *node = to(*node);
        }
        self
    }
}

/// A block of edge one with uneven cells, `counts` along the face and one across it.
pub(super) fn block(kind: CellKind, count: usize, from: f64, face: &str) -> Side {
    let along = graded(0.0, 1.0, count, 1.7).unwrap();
    let across = [from, from + 1.0];
    let mesh = match kind.dimension() {
        2 => rectangle(&along, &across, kind).unwrap(),
        _ => box_mesh(
            &along,
            &graded(0.0, 1.0, count, 0.8).unwrap(),
            &across,
            kind,
        )
        .unwrap(),
    };
    Side::new(mesh, face)
}

/// An upper block `gap` above a lower one: side 1 and side 2.
fn stack(kinds: [CellKind; 2], counts: [usize; 2], gap: f64) -> [Side; 2] {
    [
        block(kinds[0], counts[0], gap, "bottom"),
        block(kinds[1], counts[1], -1.0, "top"),
    ]
}

pub(super) fn meet([one, two]: &[Side; 2]) -> Result<Mortar, Error> {
    couple(
        &one.mesh,
        &one.facets,
        &two.mesh,
        &two.facets,
        "contacts[0]",
    )
}

const STACKS: [([CellKind; 2], [usize; 2]); 8] = [
    ([CellKind::Quad4; 2], [7, 5]),
    ([CellKind::Quad4, CellKind::Tri3], [35, 25]),
    ([CellKind::Tri3; 2], [5, 7]),
    ([CellKind::Hex8; 2], [4, 3]),
    ([CellKind::Hex8; 2], [12, 9]),
    ([CellKind::Tet4; 2], [4, 3]),
    ([CellKind::Tet4, CellKind::Hex8], [3, 4]),
    ([CellKind::Hex8, CellKind::Tet4], [4, 7]),
];

/// Worst distance of `Σ_k P_ik x²_k − x_i` from `expected`.
fn worst_gap(mortar: &Mortar, expected: Vector3<f64>) -> f64 {
    let gaps = mortar.nodes.iter();
    gaps.map(|node| (Vector3::from(node.gap_vector) - expected).norm())
        .fold(0.0, f64::max)
}

fn weight(mortar: &Mortar) -> f64 {
    mortar.nodes.iter().map(|node| node.weight).sum()
}

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
    for kind in CellKind::ALL {
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
        for gap in [10.0 / counts[0] as f64, 300.0, -0.05] {
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
fn overlap_is_a_negative_gap_down_to_half_the_extent_of_the_face() {
    for (kinds, reach) in [
        ([CellKind::Quad4; 2], 0.5),
        ([CellKind::Hex8; 2], 0.5_f64.sqrt()),
    ] {
        let mortar = meet(&stack(kinds, [4, 3], 0.01 - reach)).unwrap();
        let off = |node: &MortarNode| (node.initial_gap - 0.01 + reach).abs();
        assert!(mortar.nodes.iter().all(|node| off(node) < 1e-15));
        let found = meet(&stack(kinds, [4, 3], -0.01 - reach)).unwrap_err();
        assert!(matches!(found, Error::NothingFacesOpposite { .. }));
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
    let found = couple(&mesh, &sheet, &mesh, &flats, "contacts[0]").unwrap_err();
    assert!(matches!(found, Error::Direction { .. }), "{found}");
    assert_eq!(
        couple(&mesh, &sheet[..1], &mesh, &flats, "contacts[0]")
            .unwrap()
            .nodes
            .len(),
        2
    );
}

/// Two bodies as one side.
fn join(mut one: Side, other: &Side) -> Side {
    let first = one.mesh.nodes.len();
    one.mesh.nodes.extend(&other.mesh.nodes);
    one.facets.extend(other.facets.iter().map(|facet| Facet {
        nodes: facet.nodes.iter().map(|node| node + first).collect(),
    }));
    one
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
        let slot = couple(&body.mesh, above, &body.mesh, below, "contacts[0]").unwrap();
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
    let mortar = couple(&mesh, &upper, &mesh, &lower, "contacts[0]").unwrap();
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

/// The two sides of a mesh with the groups `contact` and `master`.
pub(super) fn shipped(name: &str) -> [Side; 2] {
    let root = env!("CARGO_MANIFEST_DIR");
    let bytes = std::fs::read(format!("{root}/tests/data/meshes/{name}.msh")).unwrap();
    let mesh = gmsh::parse_bytes(&bytes, name).unwrap();
    ["contact", "master"].map(|side| Side::new(mesh.clone(), side))
}

#[test]
fn the_shipped_patches_are_exact() {
    for (name, contacts, axis) in [("D_patch2d_7_5", 8, 1), ("D_patch3d_4_3", 25, 2)] {
        let mortar = meet(&shipped(name)).unwrap();
        assert_eq!(mortar.nodes.len(), contacts);
        assert!(mortar.nodes.iter().all(|node| node.normal[axis] == -1.0));
        assert!(worst_gap(&mortar, Vector3::zeros()) < 1e-14, "{name}");
        assert!((weight(&mortar) - 1.0).abs() < 1e-14, "{name}");
    }
}
