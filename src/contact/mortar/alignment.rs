//! Contact forces that meet on one line, so that moments balance.
//!
//! A reaction `t n` at `x` on side 1 and `−P_k t n` at `x²_k` on side 2 have the moment
//! `−t v × n` together, `v = Σ_k P_k x²_k − x`. On plane faces `v` is along `n` by itself. On
//! faceted curved ones a small part across the normal is left; the least change of the
//! weights that removes it, with their sum kept, is
//!
//! ```text
//! min Σ_k δ_k²   s.t.  Σ_k δ_k = 0,  Σ_k δ_k τ_k = −v_T        τ_k = (x²_k − x̄²)_T
//! δ_k = −τ_k · (Σ_k τ_k τ_kᵀ)⁻¹ v_T
//! ```
//!
//! By duality a rigid rotation of both sides then opens no contact (C10). Along an axis that
//! supports hold on both sides, as across a symmetry plane, no rotation goes, and the mirror image
//! has the opposite `v`: what is left of it there is none of the whole, and stays.

use nalgebra::{Matrix2, Vector2, Vector3};

use super::super::held::Directions;

/// Largest change of a weight. Beyond it the sides are not nearly parallel there, or far from each
/// other: what is left of `v` across the normal is for the normal to follow.
const LARGEST: f64 = 0.1;

/// Part of the distance of the farthest node by which a gap may lie across its normal: round-off of
/// positions a thousand times as far away.
const ROUND_OFF: f64 = 1e-9;

/// Part of the extent of the positions that is no spread along a direction.
const RANK: f64 = 1e-10;

/// Corrects the weights in place; positions of side 2 in metre, nothing moves along `still` directions.
pub(super) fn align(
    weights: &mut [(usize, f64)],
    positions: &[[f64; 3]],
    from: [f64; 3],
    normal: Vector3<f64>,
    still: &Directions,
) {
    let axes = tangents(normal);
    let across = |vector: Vector3<f64>| {
        let vector = still.across(vector);
        Vector2::from(axes.map(|axis| axis.dot(&vector)))
    };
    // Relative to x: large coordinates shall not cost digits.
    let offsets = weights
        .iter()
        .map(|(k, _)| Vector3::from(positions[*k]) - Vector3::from(from));
    let offsets: Vec<Vector3<f64>> = offsets.collect();
    let extent = extent(&offsets);
    let mut offsets: Vec<Vector2<f64>> = offsets.into_iter().map(across).collect();
    let stray = offsets.iter().zip(weights.iter());
    let stray: Vector2<f64> = stray.map(|(offset, (_, weight))| offset * *weight).sum();
    let mean = offsets.iter().sum::<Vector2<f64>>() / offsets.len() as f64;
    let mut spread = Matrix2::zeros();
    for offset in &mut offsets {
        *offset -= mean;
        spread += *offset * offset.transpose();
    }
    let multiplier = solve(spread, stray, RANK * extent);
    let changes = offsets.iter().map(|offset| -offset.dot(&multiplier));
    let largest = changes
        .clone()
        .fold(LARGEST, |most, change| change.abs().max(most));
    for ((_, weight), change) in weights.iter_mut().zip(changes) {
        *weight += change * (LARGEST / largest);
    }
}

/// Whether a gap vector has a part across the normal, `size` being the distance of the farthest node: by
/// more than round-off of that, along directions that are not `still`.
pub(super) fn is_across(
    normal: Vector3<f64>,
    gap: Vector3<f64>,
    size: f64,
    still: &Directions,
) -> bool {
    let gap = still.across(gap);
    (gap - normal * gap.dot(&normal)).norm() > ROUND_OFF * size
}

/// The normal that a gap vector asks for: its own direction but for directions that are `still`. A vector that
/// is more across the normal than along it says nothing.
pub(super) fn follow(
    normal: Vector3<f64>,
    gap: Vector3<f64>,
    size: f64,
    still: &Directions,
) -> Vector3<f64> {
    let movable = still.across(gap);
    let along = movable.dot(&normal);
    let steep = (movable - normal * along).norm() >= along.abs();
    if steep || !is_across(normal, gap, size, still) {
        return normal;
    }
    (movable * along).normalize()
}

/// Sum of the squared distances from the mean, in m²: directions along which nothing counts have no part in how far
/// positions spread, but in what of that is round-off.
fn extent(offsets: &[Vector3<f64>]) -> f64 {
    let mean = offsets.iter().sum::<Vector3<f64>>() / offsets.len() as f64;
    let squares = offsets.iter().map(|offset| (offset - mean).norm_squared());
    squares.sum()
}

/// Solves `spread · multiplier = stray` along the directions in which the positions spread by more than `least`.
fn solve(spread: Matrix2<f64>, stray: Vector2<f64>, least: f64) -> Vector2<f64> {
    let eigen = spread.symmetric_eigen();
    let mut multiplier = Vector2::zeros();
    for (value, direction) in eigen
        .eigenvalues
        .iter()
        .zip(eigen.eigenvectors.column_iter())
    {
        if *value > least {
            multiplier += direction * (direction.dot(&stray) / value);
        }
    }
    multiplier
}

/// Two unit vectors across the normal.
fn tangents(normal: Vector3<f64>) -> [Vector3<f64>; 2] {
    let mut least = Vector3::zeros();
    least[normal.abs().imin()] = 1.0;
    let first = normal.cross(&least).normalize();
    [first, normal.cross(&first)]
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: [[f64; 3]; 4] = [
        [0.0, 0.0, 0.3],
        [1.0, 0.0, 0.3],
        [1.0, 1.0, 0.3],
        [0.0, 1.0, 0.3],
    ];

    fn stray(weights: &[(usize, f64)], from: Vector3<f64>, normal: Vector3<f64>) -> Vector3<f64> {
        let terms = weights.iter();
        let gap: Vector3<f64> = terms
            .map(|(k, weight)| (Vector3::from(SQUARE[*k]) - from) * *weight)
            .sum();
        gap - normal * normal.dot(&gap)
    }

    #[test]
    fn a_force_beside_its_reaction_is_brought_onto_one_line() {
        // Equal weights act at (½, ½); the node is at (0.52, 0.47).
        let mut weights = [0, 1, 2, 3].map(|k| (k, 0.25));
        let (from, normal) = (Vector3::new(0.52, 0.47, 0.0), Vector3::z());
        align(
            &mut weights,
            &SQUARE,
            from.into(),
            normal,
            &Directions::default(),
        );
        assert!(stray(&weights, from, normal).norm() < 1e-16);
        assert!((weights.iter().map(|entry| entry.1).sum::<f64>() - 1.0).abs() < 1e-15);
        // Least change: δ = ±½ · (0.02, −0.03) along x and y.
        assert!(
            (weights[0].1 - 0.25 + 0.01 - 0.015).abs() < 1e-15,
            "{weights:?}"
        );
    }

    #[test]
    fn nodes_on_one_line_take_what_they_can() {
        let mut weights = [(0, 0.5), (1, 0.5)];
        let (from, normal) = (Vector3::new(0.52, 0.03, 0.0), Vector3::z());
        align(
            &mut weights,
            &SQUARE,
            from.into(),
            normal,
            &Directions::default(),
        );
        let left = stray(&weights, from, normal);
        assert!(
            (left - Vector3::new(0.0, -0.03, 0.0)).norm() < 1e-15,
            "{left}"
        );
    }

    #[test]
    fn a_slanted_symmetry_plane_leaves_weights_as_one_along_an_axis_does() {
        // Nodes on a line that leaves the plane: projected onto the plane they spread by round-off.
        let across = Vector3::new(0.6, 0.8, 0.0);
        let positions = [0.0, 0.5, 1.0].map(|s| (across * s).into());
        let mut weights = [(0, 0.5), (1, 0.7), (2, -0.2)];
        let before = weights;
        align(
            &mut weights,
            &positions,
            [0.0; 3],
            Vector3::new(-0.8, 0.6, 0.0),
            &Directions(vec![across]),
        );
        assert_eq!(weights, before);
    }

    #[test]
    fn across_a_symmetry_plane_weights_stay_and_within_it_they_follow() {
        let mut weights = [0, 1, 2, 3].map(|k| (k, 0.25));
        let (from, normal) = (Vector3::new(0.52, 0.47, 0.0), Vector3::z());
        align(
            &mut weights,
            &SQUARE,
            from.into(),
            normal,
            &[true, false, false].into(),
        );
        let left = stray(&weights, from, normal);
        assert!(
            (left - Vector3::new(-0.02, 0.0, 0.0)).norm() < 1e-16,
            "{left}"
        );
        // Least change: δ = ±½ · 0.03 along y.
        assert!((weights[0].1 - 0.265).abs() < 1e-15, "{weights:?}");
        let before = weights;
        align(
            &mut weights,
            &SQUARE,
            from.into(),
            normal,
            &[true, true, false].into(),
        );
        assert_eq!(weights, before);
    }

    #[test]
    fn weights_far_beside_the_line_go_part_of_the_way_and_the_normal_the_rest() {
        let mut weights = [0, 1, 2, 3].map(|k| (k, 0.25));
        let (from, normal) = (Vector3::new(0.9, 0.5, 0.0), Vector3::z());
        align(
            &mut weights,
            &SQUARE,
            from.into(),
            normal,
            &Directions::default(),
        );
        // (−0.4, 0) to go: 0.1 for each node moves the mean by 0.2.
        assert!((weights[1].1 - 0.35).abs() < 1e-15 && (weights[0].1 - 0.15).abs() < 1e-15);
        let gap = Vector3::new(-0.2, 0.0, 0.3);
        assert!((stray(&weights, from, normal).x - gap.x).abs() < 1e-15);
        assert!(
            (follow(normal, gap, 1.0, &Directions::default()) - gap.normalize()).norm() < 1e-15
        );
        assert!(
            (follow(normal, -gap, 1.0, &Directions::default()) - gap.normalize()).norm() < 1e-15
        );
        assert_eq!(
            follow(normal, gap, 1.0, &[true, false, false].into()),
            normal
        );
        assert_eq!(
            follow(
                normal,
                Vector3::new(0.3, 0.0, 0.2),
                1.0,
                &Directions::default()
            ),
            normal
        );
        let mut one = [(2, 1.0)];
        align(
            &mut one,
            &SQUARE,
            [0.9, 0.5, 0.0],
            Vector3::z(),
            &Directions::default(),
        );
        assert_eq!(one, [(2, 1.0)]);
    }
}
