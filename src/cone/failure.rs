//! What a failing motion looks like: which contacts slide, which open, and the sentence for it.
//!
//! The motions that prove a load impossible open a little as they slide (`v_N = −μ ‖v_T‖`). A body under Coulomb's law
//! slides along its contacts, so for words that part is taken out:
//!
//! ```text
//! (H9)  min ‖R (α' − α)‖    s.t.  (R α')_N = 0 at the sliding contacts
//! ```

use std::fmt;

use faer::Mat;

use super::rigid_contacts::RigidContacts;
use super::velocity_basis::{norm, product};

/// What is left of a motion below this part of it is nothing.
const NOTHING: f64 = 1e-3;

/// What the contacts do in a failing motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Failure {
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
    pub fn failure(&self, motion: &[f64]) -> Failure {
        let velocity = self.velocity(motion);
        let (sliding, opening) = self.sliding_and_opening(&velocity);
        let motion = if sliding.is_empty() {
            motion.to_vec()
        } else {
            self.along_contacts(motion, &velocity, &sliding)
                .unwrap_or_else(|| motion.to_vec())
        };
        Failure {
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

/// How one body moves: `translation + rotation × (x − centre)`.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyMotion {
    /// Name for the sentence, such as `body 2`.
    pub name: String,
    /// A point of the body, in metre.
    pub centre: [f64; 3],
    /// Distance of its farthest point from there, in metre.
    pub size: f64,
    /// Velocity of the centre.
    pub translation: [f64; 3],
    /// Rotation.
    pub rotation: [f64; 3],
}

/// The sentence: `body 2 slides along +x; 36 N of friction missing`.
#[derive(Clone, Debug, PartialEq)]
pub struct FailureSentence {
    /// Every body that may move.
    pub bodies: Vec<BodyMotion>,
    /// Whether a contact slides; if not, contacts open.
    pub slides: bool,
    /// The force that is missing.
    pub missing: f64,
    /// Its unit, such as `N`, or `N/m` in plane scenes.
    pub unit: &'static str,
}

impl fmt::Display for FailureSentence {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let largest = self
            .bodies
            .iter()
            .fold(0.0, |m: f64, body| m.max(body.reach()));
        let moving = self
            .bodies
            .iter()
            .filter(|body| body.reach() > NOTHING * largest);
        for (index, body) in moving.enumerate() {
            if index > 0 {
                out.write_str(", ")?;
            }
            body.write(out, self.slides, NOTHING * largest)?;
        }
        let what = if self.slides {
            "friction"
        } else {
            "holding force"
        };
        write!(
            out,
            "; {} {} of {what} missing",
            significant(self.missing),
            self.unit
        )
    }
}

impl BodyMotion {
    /// Largest speed a point of the body may have.
    fn reach(&self) -> f64 {
        length(self.translation) + length(self.rotation) * self.size
    }

    fn write(&self, out: &mut fmt::Formatter<'_>, slides: bool, nothing: f64) -> fmt::Result {
        let turning = length(self.rotation);
        if turning * self.size <= nothing {
            let verb = if slides { "slides" } else { "moves off" };
            return write!(
                out,
                "{} {verb} along {}",
                self.name,
                direction(self.translation)
            );
        }
        let verb = if slides { "turns" } else { "tips" };
        let (w, v) = (self.rotation, self.translation);
        let arm = [
            w[1] * v[2] - w[2] * v[1],
            w[2] * v[0] - w[0] * v[2],
            w[0] * v[1] - w[1] * v[0],
        ];
        let square = turning * turning;
        let [x, y, z] = std::array::from_fn(|k| {
            let at = self.centre[k] + arm[k] / square;
            if at.abs() < NOTHING * self.size {
                0.0
            } else {
                at
            }
        });
        write!(
            out,
            "{} {verb} about {} through ({}, {}, {})",
            self.name,
            direction(w),
            significant(x),
            significant(y),
            significant(z)
        )?;
        let advance = (0..3).map(|k| w[k] * v[k]).sum::<f64>() / turning;
        if advance.abs() > nothing {
            let along = w.map(|w| w * advance);
            write!(out, " and along {}", direction(along))?;
        }
        Ok(())
    }
}

/// `+x` for a direction along an axis, otherwise its components.
fn direction(vector: [f64; 3]) -> String {
    let unit = vector.map(|x| x / length(vector));
    for (name, x) in ["x", "y", "z"].into_iter().zip(unit) {
        if x.abs() > 1.0 - NOTHING * NOTHING {
            return format!("{}{name}", if x > 0.0 { '+' } else { '-' });
        }
    }
    let [x, y, z] = unit.map(|x| if x.abs() < NOTHING { 0.0 } else { x });
    format!("({x:.3}, {y:.3}, {z:.3})")
}

/// Four significant digits, without needless zeros.
fn significant(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let exponent = value.abs().log10().floor() as i32;
    if !(-4..6).contains(&exponent) {
        return format!("{value:.3e}");
    }
    let rounded = format!("{value:.*}", (3 - exponent).max(0) as usize);
    if !rounded.contains('.') {
        return rounded;
    }
    rounded
        .trim_end_matches('0')
        .trim_end_matches('.')
        .to_owned()
}

fn length(vector: [f64; 3]) -> f64 {
    norm(vector.into_iter())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::cone::Equilibrium;
    use crate::cone::blocks::{Blocks, incline};

    fn impossible(contacts: &RigidContacts, load: &[f64]) -> (Vec<f64>, f64) {
        match contacts.admissible(load).unwrap() {
            Equilibrium::Impossible { motion, excess } => (motion, excess),
            other => unreachable!("{other:?}"),
        }
    }

    /// The modes of these tests are translations and rotations about the origin.
    fn sentence(failure: &Failure, size: f64, missing: f64) -> String {
        let solid = failure.motion.len() == 6;
        let at = |k: usize| failure.motion[k];
        let body = BodyMotion {
            name: "body 2".to_owned(),
            centre: [0.0; 3],
            size,
            translation: [at(0), at(1), if solid { at(2) } else { 0.0 }],
            rotation: if solid {
                [at(3), at(4), at(5)]
            } else {
                [0.0, 0.0, at(2)]
            },
        };
        FailureSentence {
            bodies: vec![body],
            slides: !failure.sliding.is_empty(),
            missing,
            unit: "N",
        }
        .to_string()
    }

    #[test]
    fn a_pad_that_is_pulled_too_hard_slides() {
        let pad = Blocks::pad(3, 0.3);
        let contacts = pad.contacts();
        let load = pad.load(&[(0, [3636.0, 0.0, -12_000.0], [0.0; 3])]);
        let (motion, excess) = impossible(&contacts, &load);
        let failure = contacts.failure(&motion);
        assert_eq!((failure.sliding.len(), failure.opening.len()), (4, 0));
        assert!((failure.motion[0] - 1.0).abs() < 1e-6 && failure.motion[2].abs() < 1e-6);
        assert_eq!(
            sentence(&failure, 0.015, excess),
            "body 2 slides along +x; 36 N of friction missing"
        );
    }

    #[test]
    fn a_pad_that_is_twisted_too_hard_turns() {
        let pad = Blocks::pad(3, 0.3);
        let contacts = pad.contacts();
        let mut load = pad.load(&[(0, [0.0, 0.0, -12_000.0], [0.0; 3])]);
        // 4 corners · 909 N · 0.01 √2 m.
        load[5] = -3636.0 * 0.01 * 2.0_f64.sqrt();
        let (motion, excess) = impossible(&contacts, &load);
        assert_eq!(
            sentence(&contacts.failure(&motion), 0.015, excess),
            "body 2 turns about -z through (0, 0, 0); 36 N of friction missing"
        );
    }

    #[test]
    fn a_pad_that_is_lifted_moves_off() {
        let pad = Blocks::pad(3, 0.3);
        let contacts = pad.contacts();
        let (motion, excess) = impossible(&contacts, &pad.load(&[(0, [0.0, 0.0, 1.25], [0.0; 3])]));
        let failure = contacts.failure(&motion);
        assert_eq!((failure.sliding.len(), failure.opening.len()), (0, 4));
        assert_eq!(
            sentence(&failure, 0.015, excess),
            "body 2 moves off along +z; 1.25 N of holding force missing"
        );
    }

    #[test]
    fn a_slender_block_on_a_slope_tips_about_its_lower_edge() {
        // Width 1, height 2, slope 0.6, x down the slope: it turns clockwise about x = 0.5.
        let (contacts, weight) = incline(2, 2.0, 0.6, [1.0, 2.0]);
        let (motion, excess) = impossible(&contacts, &weight);
        let failure = contacts.failure(&motion);
        let found = sentence(&failure, 2.0, excess);
        assert!(
            found.starts_with("body 2 tips about -z through (0.5, 0, 0)"),
            "{found}"
        );
    }

    #[test]
    fn numbers_and_directions_read_well() {
        let found = [36.000_04, 1234.56, -0.25, 1.0e7, 3.2e-9, 0.0].map(significant);
        assert_eq!(found, ["36", "1235", "-0.25", "1.000e7", "3.200e-9", "0"]);
        assert_eq!(direction([0.0, -3.0, 0.0]), "-y");
        assert_eq!(direction([3.0, 0.0, 4.0]), "(0.600, 0.000, 0.800)");
    }
}
