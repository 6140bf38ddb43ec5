//! What a failing motion looks like: which contacts slide, and which open.
//!
//! The motions that prove a load impossible open a little as they slide (`v_N = −μ ‖v_T‖`). A body under Coulomb's law
//! slides along its contacts, so for words that part is taken out:
//!
//! ```text
//! (H9)  min ‖R (α' − α)‖    s.t.  (R α')_N = 0 at the sliding contacts
//! ```

use faer::Mat;

use super::rigid_contacts::RigidContacts;
use crate::problem::velocity_basis::{norm, product};

/// What is left of a motion below this part of it is nothing.
const NOTHING: f64 = 1e-3;

/// What the contacts do in a failing motion.
#[derive(Clone, Debug, PartialEq)]
pub struct FailureMotion {
    /// Rigid motion without the opening of its sliding contacts (H9); the motion itself if nothing is left so.
    pub motion: Vec<f64>,
    /// Contacts that slide.
    pub sliding: Vec<usize>,
    /// Contacts that open.
    pub opening: Vec<usize>,
}

impl RigidContacts {
    /// Reads a motion α, as from [`Equilibrium::Impossible`](super::Equilibrium::Impossible) or [`Limit`](super::Limit).
    #[must_use]
    pub fn failure(&self, motion: &[f64]) -> FailureMotion {
        let velocity = self.velocity(motion);
        let (sliding, opening) = self.sliding_and_opening(motion, &velocity);
        let motion = if sliding.is_empty() {
            motion.to_vec()
        } else {
            self.along_contacts(motion, &velocity, &sliding)
                .unwrap_or_else(|| motion.to_vec())
        };
        FailureMotion {
            motion,
            sliding,
            opening,
        }
    }

    /// (H9); `None` if the sliding contacts leave no such motion.
    fn along_contacts(
        &self,
        motion: &[f64],
        velocity: &[f64],
        sliding: &[usize],
    ) -> Option<Vec<f64>> {
        let q = &self.basis.velocities;
        let rank = self.basis.rank();
        let beta = product(q.transpose(), velocity);
        let normals = Mat::from_fn(sliding.len().max(rank), rank, |row, j| {
            sliding
                .get(row)
                .map_or(0.0, |&contact| q[(self.offsets()[contact], j)])
        });
        let svd = normals.thin_svd().ok()?;
        let values = svd.S().column_vector();
        let mut left = beta.clone();
        for (k, direction) in svd.V().col_iter().enumerate() {
            if values[k] > NOTHING * values[0] {
                let along: f64 = direction.iter().zip(&beta).map(|(v, b)| v * b).sum();
                for (left, v) in left.iter_mut().zip(direction.iter()) {
                    *left -= along * v;
                }
            }
        }
        if norm(left.iter().copied()) <= NOTHING * norm(beta.iter().copied()) {
            return None;
        }
        // Motions that no contact feels stay as they are.
        let taken: Vec<f64> = beta.iter().zip(&left).map(|(b, l)| b - l).collect();
        let removed = self.basis.amplitudes(&taken);
        Some(motion.iter().zip(removed).map(|(a, r)| a - r).collect())
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::limit::Equilibrium;
    use crate::limit::tests::blocks::{Blocks, incline};

    /// What fails, its motion as translations and rotations about the origin, and the missing force.
    fn failure(contacts: &RigidContacts, load: &[f64]) -> (FailureMotion, f64) {
        match contacts.admissible(load).unwrap() {
            Equilibrium::Impossible { motion, excess } => (contacts.failure(&motion), excess),
            other => unreachable!("{other:?}"),
        }
    }

    /// Motions of unit size, a hundred times coarser than `IDLE`, below which a velocity is round-off.
    fn close(found: &[f64], expected: &[f64]) -> bool {
        let mut pairs = found.iter().zip(expected);
        found.len() == expected.len() && pairs.all(|(a, b)| (a - b).abs() < 1e-9)
    }

    #[test]
    fn a_pad_that_is_pulled_too_hard_slides_along_its_plane() {
        let pad = Blocks::pad(3, 0.3);
        let load = pad.load(&[(0, [3636.0, 0.0, -12_000.0], [0.0; 3])]);
        let (failure, missing) = failure(&pad.contacts(), &load);
        assert_eq!((failure.sliding.len(), failure.opening.len()), (4, 0));
        assert!(close(&failure.motion, &[1.0, 0.0, 0.0, 0.0, 0.0, 0.0]));
        // Of loads of 12 kN, a part of 1e-10.
        assert!((missing - 36.0).abs() < 1e-6, "{missing}");
    }

    #[test]
    fn a_pad_that_is_twisted_too_hard_turns_on_the_spot() {
        // 4 corners · 909 N · 0.01 √2 m, where friction holds 900 N each; unit speed there.
        let pad = Blocks::pad(3, 0.3);
        let mut load = pad.load(&[(0, [0.0, 0.0, -12_000.0], [0.0; 3])]);
        let arm = 0.01 * 2.0_f64.sqrt();
        load[5] = -3636.0 * arm;
        let (failure, missing) = failure(&pad.contacts(), &load);
        assert_eq!((failure.sliding.len(), failure.opening.len()), (4, 0));
        assert!(close(&failure.motion[..5], &[0.0; 5]), "{failure:?}");
        assert!((failure.motion[5] * arm + 1.0).abs() < 1e-9 && (missing - 36.0).abs() < 1e-6);
    }

    #[test]
    fn a_pad_that_is_lifted_leaves_the_floor() {
        let pad = Blocks::pad(3, 0.3);
        let (failure, missing) = failure(
            &pad.contacts(),
            &pad.load(&[(0, [0.0, 0.0, 1.25], [0.0; 3])]),
        );
        assert_eq!((failure.sliding.len(), failure.opening.len()), (0, 4));
        assert!(close(&failure.motion, &[0.0, 0.0, 1.0, 0.0, 0.0, 0.0]));
        assert!((missing - 1.25).abs() < 1e-9, "{missing}");
    }

    #[test]
    fn a_slender_block_on_a_slope_turns_about_its_lower_edge() {
        // Width 1, height 2, slope 0.6, x down the slope: clockwise about x = 0.5, which stays.
        let (contacts, weight) = incline(2, 2.0, 0.6, [1.0, 2.0]);
        let (failure, _) = failure(&contacts, &weight);
        let [x, y, turn] = [0, 1, 2].map(|k| failure.motion[k]);
        assert!(turn < 0.0 && (x / turn).abs() < 1e-6 && (y / turn + 0.5).abs() < 1e-6);
        assert!(
            failure.sliding.is_empty() && failure.opening.len() == 2,
            "{failure:?}"
        );
    }
}
