//! Checks where the cover ends within facets, in 3D.

#![allow(clippy::unwrap_used)]

use nalgebra::{Rotation3, Vector3};

use super::sides::{Side, block, meet};
use crate::body::CellKind;
use crate::contact::mortar::{Mortar, MortarNode};

const KINDS: [CellKind; 4] = [
    CellKind::Hex8,
    CellKind::Tet4,
    CellKind::Hex20,
    CellKind::Tet10,
];

/// The block `[0, 1]³` above a lower one that is turned about z, squeezed and shifted in the plane.
fn pair(kind: CellKind, count: usize, angle: f64, size: [f64; 2], shift: [f64; 2]) -> [Side; 2] {
    let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), angle);
    let place = |[x, y, z]: [f64; 3]| {
        let at = turn * Vector3::new((x - 0.5) * size[0], (y - 0.5) * size[1], z);
        (at + Vector3::new(shift[0], shift[1], 0.0)).into()
    };
    let lower = match kind {
        CellKind::Hex8 | CellKind::Hex20 => CellKind::Tet4,
        _ => CellKind::Hex8,
    };
    [
        block(kind, count, 0.0, "bottom"),
        block(lower, 3, -1.0, "top").moved(place),
    ]
}

/// Where the reaction of a contact acts on side 1 and on side 2.
fn centres(node: &MortarNode, [one, two]: &[Side; 2]) -> [Vector3<f64>; 2] {
    let mean = |side: &Side, weights: &[(usize, f64)]| {
        let terms = weights.iter();
        terms
            .map(|(k, weight)| Vector3::from(side.mesh.nodes[*k]) * *weight)
            .sum()
    };
    [mean(one, &node.own), mean(two, &node.opposite)]
}

/// Corners of the rectangle that the lower block has at the top, in order.
fn rectangle(angle: f64, size: [f64; 2], shift: [f64; 2]) -> [Vector3<f64>; 4] {
    let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), angle);
    [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]].map(|[x, y]| {
        turn * Vector3::new(x * size[0], y * size[1], 0.0) + Vector3::new(shift[0], shift[1], 0.0)
    })
}

/// How far a point is outside of both blocks' faces.
fn beyond(at: Vector3<f64>, corners: &[Vector3<f64>; 4]) -> f64 {
    let of_unit = [-at.x, at.x - 1.0, -at.y, at.y - 1.0];
    let of_lower = (0..4).map(|k| {
        let (from, along) = (corners[k], corners[(k + 1) % 4] - corners[k]);
        -along.cross(&(at - from)).z / along.norm()
    });
    of_unit
        .into_iter()
        .chain(of_lower)
        .fold(f64::NEG_INFINITY, f64::max)
}

/// Pseudo-random numbers in 0..1 that are the same on every machine.
fn random(seed: &mut u64) -> f64 {
    *seed = seed
        .wrapping_mul(6_364_136_223_846_793_005)
        .wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 11) as f64 / (1_u64 << 53) as f64
}

#[test]
fn no_contact_stands_beyond_the_cover_wherever_it_ends() {
    let mut seed = 7;
    let mut tried = 0;
    for case in 0..160 {
        let kind = KINDS[case % 4];
        let mut next = || random(&mut seed);
        let (angle, size) = (3.0 * next(), [0.3 + next(), 0.3 + next()]);
        let shift = [next(), next()];
        let sides = pair(kind, 4, angle, size, shift);
        let corners = rectangle(angle, size, shift);
        let Ok(mortar) = meet(&sides) else {
            continue;
        };
        tried += 1;
        for node in &mortar.nodes {
            let [own, across] = centres(node, &sides);
            assert!(
                beyond(own, &corners) < 1e-9,
                "{case} {kind:?} {}",
                beyond(own, &corners)
            );
            assert!(
                (own - across).norm() < 1e-12,
                "{case} {kind:?} {}",
                (own - across).norm()
            );
            assert!(node.weight > 0.0 && node.weight.is_finite());
            // Bounded however narrow the cover: no weight is beyond what affine functions need.
            let weights = node.own.iter().chain(&node.opposite);
            let most = weights.fold(0.0_f64, |most, (_, weight)| most.max(weight.abs()));
            assert!(most < 8.0, "{case} {kind:?} {most}");
        }
        exact(&mortar, &sides, &corners);
    }
    assert!(tried > 140, "{tried}");
}

/// A unit pressure has the cover's area and moments on side 2.
fn exact(mortar: &Mortar, sides: &[Side; 2], corners: &[Vector3<f64>; 4]) {
    let cover = clipped(corners);
    let (mut area, mut moment) = (0.0, Vector3::zeros());
    for k in 1..cover.len().max(1) - 1 {
        let [a, b, c] = [cover[0], cover[k], cover[k + 1]];
        let part = (b - a).cross(&(c - a)).z / 2.0;
        area += part;
        moment += (a + b + c) * (part / 3.0);
    }
    let mut found = (0.0, Vector3::zeros());
    for node in &mortar.nodes {
        found.0 += node.weight;
        found.1 += centres(node, sides)[1] * node.weight;
    }
    assert!((found.0 - area).abs() < 1e-13 && (found.1 - moment).norm() < 1e-13);
}

/// The rectangle within the unit square.
fn clipped(corners: &[Vector3<f64>; 4]) -> Vec<Vector3<f64>> {
    let mut polygon = corners.to_vec();
    for (axis, sign, end) in [(0, 1.0, 1.0), (0, -1.0, 0.0), (1, 1.0, 1.0), (1, -1.0, 0.0)] {
        let inside = |at: &Vector3<f64>| sign * (end - at[axis]);
        let mut cut = Vec::new();
        for (k, at) in polygon.iter().enumerate() {
            let next = polygon[(k + 1) % polygon.len()];
            let (here, there) = (inside(at), inside(&next));
            if here >= 0.0 {
                cut.push(*at);
            }
            if here * there < 0.0 {
                cut.push(at + (next - at) * (here / (here - there)));
            }
        }
        polygon = cut;
    }
    polygon
}

#[test]
fn contacts_stand_at_the_straight_ends_of_the_cover() {
    // Blocks of one size, shifted along x and then along both axes: the cover is [a, 1] × [b, 1].
    for kind in KINDS {
        for step in 0..12 {
            let along = 0.013 + 0.07 * f64::from(step);
            for across in [0.0, 0.83 - 0.9 * along] {
                let sides = pair(kind, 4, 0.0, [1.0, 1.0], [0.5 + along, 0.5 + across]);
                let mortar = meet(&sides).unwrap();
                let mut range = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
                for node in &mortar.nodes {
                    let [at, _] = centres(node, &sides);
                    for axis in 0..2 {
                        range[0][axis] = range[0][axis].min(at[axis]);
                        range[1][axis] = range[1][axis].max(at[axis]);
                    }
                }
                let ends = [along, across.max(0.0)];
                for axis in 0..2 {
                    let low = range[0][axis] - ends[axis];
                    let high = range[1][axis] - (1.0 + across.min(0.0) * axis as f64);
                    assert!(
                        low.abs() < 1e-12 && high.abs() < 1e-12,
                        "{kind:?} {ends:?} {low} {high}"
                    );
                }
                // A facet has 1/16 of the face; no contact has less than a hundredth of that.
                let least = mortar.nodes.iter().map(|node| node.weight);
                let least = least.fold(f64::INFINITY, f64::min);
                assert!(least > 0.01 / 16.0, "{kind:?} {ends:?} {least}");
            }
        }
    }
}
