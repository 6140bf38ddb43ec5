//! Sums of nodal forces and of their moments.

use super::certificate::length;

/// Sum of forces and of their moments.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Resultant {
    /// Force in global axes, in newton.
    pub force: [f64; 3],
    /// Moment about the origin, in newton metre.
    pub moment: [f64; 3],
}

impl Resultant {
    /// Adds a force, in newton, that acts at a position, in metre.
    pub fn add(&mut self, [x, y, z]: [f64; 3], force: [f64; 3]) {
        let [f_x, f_y, f_z] = force;
        let moment = [y * f_z - z * f_y, z * f_x - x * f_z, x * f_y - y * f_x];
        for axis in 0..3 {
            self.force[axis] += force[axis];
            self.moment[axis] += moment[axis];
        }
    }

    /// Sums nodal forces, `dimension` entries per node.
    pub(super) fn of(positions: &[[f64; 3]], forces: &[f64], dimension: usize) -> Self {
        let mut sum = Self::default();
        for (&position, force) in positions.iter().zip(nodal(forces, dimension)) {
            sum.add(position, force);
        }
        sum
    }
}

/// `‖v‖` node by node, from `dimension` entries per node.
pub(super) fn nodal_lengths(values: &[f64], dimension: usize) -> impl Iterator<Item = f64> + '_ {
    nodal(values, dimension).map(length)
}

/// The vectors node by node, padded with zeros to three axes.
fn nodal(values: &[f64], dimension: usize) -> impl Iterator<Item = [f64; 3]> + '_ {
    let blocks = values.chunks_exact(dimension.max(1));
    blocks.map(|block| [0, 1, 2].map(|axis| block.get(axis).copied().unwrap_or(0.0)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kkt::Defect;

    #[test]
    fn a_couple_has_a_moment_and_no_force() {
        // 5 N up at x = 2 and 5 N down at x = −1: 3 m · 5 N about z, anywhere.
        let sum = Resultant::of(
            &[[2.0, 9.0, 0.0], [-1.0, 7.0, 0.0]],
            &[0.0, 5.0, 0.0, -5.0],
            2,
        );
        assert_eq!((sum.force, sum.moment), ([0.0; 3], [0.0, 0.0, 15.0]));
    }

    #[test]
    fn moments_follow_the_right_hand() {
        let mut sum = Resultant::default();
        sum.add([1.0, 2.0, 3.0], [4.0, 5.0, 6.0]);
        // (2·6 − 3·5, 3·4 − 1·6, 1·5 − 2·4)
        assert_eq!(sum.moment, [-3.0, 6.0, -3.0]);
    }

    #[test]
    fn a_sum_that_is_not_a_number_is_an_infinite_defect() {
        let found = Defect::of(&[[f64::NAN, 0.0, 0.0], [0.0; 3]], 1.0);
        assert_eq!((found.value, found.scaled), (f64::INFINITY, f64::INFINITY));
    }

    #[test]
    fn lengths_are_taken_node_by_node() {
        let found: Vec<f64> = nodal_lengths(&[3.0, 4.0, 0.0, -5.0], 2).collect();
        assert_eq!(found, [5.0, 5.0]);
    }
}
