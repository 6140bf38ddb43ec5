//! Normal and tangents of one contact node, and what its supports leave of them.
//!
//! ```text
//! F: supported directions     n ∈ span F    the normal is held: no contact
//!                          n ⟂ span F    the tangents along F are held, the others kept
//! ```

use nalgebra::Vector3;

use super::held::Directions;

/// Largest component by which a normal may miss the supported axes, or their complement.
const ALIGNED: f64 = 1e-8;

/// What the supports of a node leave to contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Stance {
    /// It can move along the normal.
    Free {
        /// Orthonormal rows, right-handed: normal, kept tangents, held tangents.
        frame: [[f64; 3]; 3],
        /// Number of kept tangents.
        kept: usize,
    },
    /// A support holds its normal.
    Held,
    /// The supports are neither along nor across the normal.
    Askew,
}

impl Stance {
    /// The stance of a node with unit normal `normal` and supported directions.
    pub(crate) fn new(dimension: usize, normal: [f64; 3], supported: &Directions) -> Self {
        let normal = Vector3::from(normal);
        let along = supported.along(normal);
        if !supported.0.is_empty() && (normal - along).norm() < ALIGNED {
            return Self::Held;
        }
        if along.norm() >= ALIGNED {
            return Self::Askew;
        }
        // Exactly across, so that the frame is orthonormal and held rows are the supported directions.
        let normal = supported.across(normal).normalize();
        let held = supported.0.len();
        let [first, second] = tangents(dimension, normal, supported);
        Self::Free {
            frame: [normal, first, second].map(|row| row.map(|x| x + 0.0).into()),
            kept: dimension - 1 - held,
        }
    }
}

/// Two tangents, those along supported directions last.
fn tangents(dimension: usize, normal: Vector3<f64>, supported: &Directions) -> [Vector3<f64>; 2] {
    if dimension == 2 {
        return [Vector3::new(-normal.y, normal.x, 0.0), Vector3::z()];
    }
    let axis = |index: usize| Vector3::ith_axis(index).into_inner();
    if let Some(held) = supported.0.first() {
        return [held.cross(&normal), *held];
    }
    // The global axis farthest from the normal; the first one where two are as far.
    let farthest = normal.map(f64::abs).imin();
    let first = (axis(farthest) - normal * normal[farthest]).normalize();
    [first, normal.cross(&first)]
}

#[cfg(test)]
mod tests {
    #![allow(clippy::panic)]
    use super::*;

    fn frame(dimension: usize, normal: [f64; 3], supported: [bool; 3]) -> ([[f64; 3]; 3], usize) {
        match Stance::new(dimension, normal, &supported.into()) {
            Stance::Free { frame, kept } => (frame, kept),
            other => panic!("{other:?}"),
        }
    }

    fn assert_right_handed(frame: [[f64; 3]; 3]) {
        let [n, a, b] = frame.map(Vector3::from);
        assert!((n.cross(&a) - b).norm() < 1e-15 && (n.norm() - 1.0).abs() < 1e-15);
        assert!(n.dot(&a).abs() < 1e-15 && (a.norm() - 1.0).abs() < 1e-15);
    }

    #[test]
    fn the_plane_tangent_is_the_normal_turned_by_a_right_angle() {
        let (rows, kept) = frame(2, [0.0, -1.0, 0.0], [false; 3]);
        assert_eq!(
            (rows[0], rows[1], kept),
            ([0.0, -1.0, 0.0], [1.0, 0.0, 0.0], 1)
        );
        assert_right_handed(rows);
    }

    #[test]
    fn below_a_box_the_tangents_are_global_axes() {
        let (rows, kept) = frame(3, [0.0, 0.0, -1.0], [false; 3]);
        assert_eq!(
            (rows[1], rows[2], kept),
            ([1.0, 0.0, 0.0], [0.0, -1.0, 0.0], 2)
        );
        assert_right_handed(rows);
        let n = Vector3::new(0.3, -0.5, 0.4).normalize();
        assert_right_handed(frame(3, n.into(), [false; 3]).0);
    }

    #[test]
    fn a_symmetry_plane_leaves_the_tangent_within_it() {
        // Plane x = 0, normal (0, 0.6, −0.8): kept e_x × n = (0, 0.8, 0.6), held e_x.
        let (rows, kept) = frame(3, [0.0, 0.6, -0.8], [true, false, false]);
        assert_eq!(
            (rows[1], rows[2], kept),
            ([0.0, 0.8, 0.6], [1.0, 0.0, 0.0], 1)
        );
        assert_right_handed(rows);
    }

    #[test]
    fn a_node_on_two_symmetry_planes_slides_nowhere() {
        let (rows, kept) = frame(3, [1e-10, 0.0, 1.0], [true, true, false]);
        assert_eq!((rows[0], kept), ([0.0, 0.0, 1.0], 0));
        assert_right_handed(rows);
        assert_eq!(frame(2, [0.0, 1.0, 0.0], [true, false, false]).1, 0);
    }

    #[test]
    fn a_support_of_the_normal_leaves_no_contact() {
        let pinned = Stance::new(2, [0.0, -1.0, 0.0], &[true, true, false].into());
        assert_eq!(pinned, Stance::Held);
        let on_wedge = Stance::new(3, [0.6, 0.8, 0.0], &[true, true, false].into());
        assert_eq!(on_wedge, Stance::Held);
        assert_eq!(
            Stance::new(3, [1.0, 0.0, 0.0], &[true; 3].into()),
            Stance::Held
        );
    }

    #[test]
    fn a_support_at_an_angle_to_the_normal_is_askew() {
        let found = Stance::new(2, [0.6, 0.8, 0.0], &[true, false, false].into());
        assert_eq!(found, Stance::Askew);
    }
}
