//! By what factor a load can grow before nothing holds it.
//!
//! ```text
//! (H6)  max λ   s.t.  Rᵀ t + e_fixed + λ e_growing = 0,  t ∈ K,  λ ≥ 0
//!     = min −e_fixed·α   s.t.  R α ∈ K*,  e_growing·α ≥ 1
//! ```
//!
//! Statical and kinematical theorem of limit analysis. Both answers are exact if the sliding contacts
//! may open as they slide (`v_N = −μ ‖v_T‖`); under Coulomb's law, where they do not, no factor above λ
//! is admissible, and whether a factor below it is reached depends on the elastic bodies.

use super::equilibrium::{Equilibrium, HELD, TOLERANCE};
use super::holdable::Holdable;
use super::rigid_contacts::RigidContacts;
use super::velocity_basis::norm;
use crate::error::Error;

/// Largest difference of the two sides of (H6), relative to λ, that counts as an answer.
const DUALITY: f64 = 1e-8;

/// The two sides are brought this close if they can be.
const SHARP: f64 = 1e-10;

/// Proximal steps from the cone solver's answer.
const REFINEMENTS: usize = 12;

/// A factor smaller than this, loads compared as the contacts feel them, is right to its 1e-8th only.
const SMALL: f64 = 1e-3;

/// How far a load can grow.
#[derive(Clone, Debug, PartialEq)]
pub enum Limit {
    /// Up to a factor.
    Finite {
        /// Largest λ.
        factor: f64,
        /// Rigid motion that begins there, at unit speed of its fastest sliding (else opening) contact.
        motion: Vec<f64>,
        /// Admissible reactions that hold the load times λ, in newton per contact unknown.
        reaction: Vec<f64>,
    },
    /// Without end: the contacts hold the growing load alone, however large.
    Unbounded,
    /// Not at any factor λ ≥ 0.
    Never {
        /// Rigid motion on which the fixed load works, the growing load does no negative work,
        /// and that no contact resists.
        motion: Vec<f64>,
        /// Power of the fixed load on it, in newton per unit of speed.
        excess: f64,
    },
    /// Too badly conditioned to tell.
    Undecided,
}

impl RigidContacts {
    /// The largest factor λ ≥ 0 at which admissible reactions hold `fixed + λ growing`.
    ///
    /// # Errors
    ///
    /// A load of the wrong length, or one that is not finite.
    pub fn limit(&self, fixed: &[f64], growing: &[f64]) -> Result<Limit, Error> {
        self.check_load("fixed load", fixed)?;
        self.check_load("growing load", growing)?;
        if let Some(motion) = self.idle_motion(growing) {
            return Ok(self.balanced(fixed, growing, motion));
        }
        match self.decide(self.friction(), fixed, Some(growing)) {
            Equilibrium::Held { .. } => {}
            Equilibrium::Impossible { motion, excess } => {
                return Ok(Limit::Never { motion, excess });
            }
            Equilibrium::Undecided { .. } => return Ok(Limit::Undecided),
        }
        Ok(match self.decide(self.friction(), growing, None) {
            Equilibrium::Held { .. } => Limit::Unbounded,
            Equilibrium::Undecided { .. } => Limit::Undecided,
            Equilibrium::Impossible { motion, .. } if norm(fixed.iter().copied()) == 0.0 => {
                Limit::Finite {
                    factor: 0.0,
                    motion,
                    reaction: vec![0.0; self.modes().nrows()],
                }
            }
            Equilibrium::Impossible { .. } => {
                self.largest(fixed, growing).unwrap_or(Limit::Undecided)
            }
        })
    }

    /// The one factor at which the two loads balance on an idle motion of the growing one.
    fn balanced(&self, fixed: &[f64], growing: &[f64], motion: Vec<f64>) -> Limit {
        let motion = self.at_unit_speed(motion);
        let power = |load: &[f64]| motion.iter().zip(load).map(|(a, e)| a * e).sum::<f64>();
        let factor = (-power(fixed) / power(growing)).max(0.0);
        let total: Vec<f64> = fixed
            .iter()
            .zip(growing)
            .map(|(f, g)| f + factor * g)
            .collect();
        match self.decide(self.friction(), &total, None) {
            Equilibrium::Held { reaction } => Limit::Finite {
                factor,
                motion,
                reaction,
            },
            Equilibrium::Impossible { motion, .. } => {
                let excess = motion.iter().zip(fixed).map(|(a, e)| a * e).sum();
                Limit::Never { motion, excess }
            }
            Equilibrium::Undecided { .. } => Limit::Undecided,
        }
    }

    /// (H6) for loads with a finite, attained limit; `None` if its two sides do not meet.
    ///
    /// The cone solver's answer is sharpened by proximal steps until the reactions, which prove that λ is
    /// held, and the motion, which proves that more is not, agree.
    fn largest(&self, fixed: &[f64], growing: &[f64]) -> Option<Limit> {
        let ((held, size), (pulled, growth)) = (self.unit_load(fixed), self.unit_load(growing));
        let holdable = Holdable::new(self, self.friction(), Some(&pulled));
        let (mut reaction, mut motion) = holdable.limit(&held, &pulled, TOLERANCE)?;
        let mut remainder = holdable.balance(&held, &mut reaction);
        let (mut below, mut above) = ((0.0, None), (f64::INFINITY, None));
        let mut length = 1.0;
        for _ in 0..REFINEMENTS {
            let factor = -reaction.last()?;
            if remainder <= HELD * (1.0 + factor) && (factor > below.0 || below.1.is_none()) {
                below = (factor, Some(reaction.clone()));
            }
            // For any motion: λ g·β = −e·β − t·Q β ≤ −e·β + resistance · Σ −t_N.
            let slack = holdable.resistance(&motion) * holdable.normal_sum(&reaction);
            let bound = (slack - holdable.work(&held, &motion)) / holdable.work(&pulled, &motion);
            if bound < above.0 {
                above = (bound, Some(motion.clone()));
            }
            if above.0 - below.0 <= SHARP * below.0 {
                break;
            }
            (reaction, motion, remainder) = holdable.sharpen(&held, &reaction, &motion, length);
            length *= 2.0;
        }
        let ((factor, Some(mut reaction)), (bound, Some(motion))) = (below, above) else {
            return None;
        };
        if bound - factor > DUALITY * factor.max(SMALL) {
            return None;
        }
        reaction.pop();
        Some(Limit::Finite {
            factor: factor * size / growth,
            motion: self.at_unit_speed(self.basis.amplitudes(&motion)),
            reaction: reaction.iter().map(|t| t * size).collect(),
        })
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::cone::blocks::{Blocks, Touch, force};

    fn factor(limit: &Limit) -> f64 {
        match limit {
            Limit::Finite { factor, .. } => *factor,
            other => unreachable!("{other:?}"),
        }
    }

    /// (tan a + μ)/(1 − μ tan a) with tan a = 0.1: CGS-4.
    const CGS4: [(f64, f64); 4] = [
        (0.0, 0.1),
        (0.1, 0.2 / 0.99),
        (0.2, 0.3 / 0.98),
        (0.3, 0.4 / 0.97),
    ];

    #[test]
    fn a_block_is_pulled_up_a_slope_as_nafems_cgs_4_has_it() {
        for dimension in [2, 3] {
            for (mu, expected) in CGS4 {
                let mut blocks = Blocks::pad(dimension, mu);
                let slope = (1.0_f64 + 0.01).sqrt();
                for touch in &mut blocks.touches {
                    let up = touch.point[0] * 0.1;
                    touch.point[dimension - 1] = up;
                    touch.normal = force([0.1 / slope, -1.0 / slope], dimension);
                }
                let contacts = blocks.contacts();
                let weight = blocks.load(&[(0, force([0.0, -1.0], dimension), [0.0; 3])]);
                let pull = blocks.load(&[(0, force([1.0, 0.0], dimension), [0.0; 3])]);
                let found = contacts.limit(&weight, &pull).unwrap();
                assert!(
                    (factor(&found) / expected - 1.0).abs() < 1e-8,
                    "{mu} {found:?}"
                );
                let Limit::Finite { motion, .. } = found else {
                    unreachable!()
                };
                assert!(motion[0] > 0.5, "{motion:?}");
            }
        }
    }

    /// Body 0, a wedge of slope 0.1 on a smooth floor, under body 1, guided between smooth walls.
    fn wedge(mu: f64) -> Blocks {
        let slope = 1.01_f64.sqrt();
        let mut touches = Vec::new();
        let mut touch = |point: [f64; 2], normal: [f64; 2], bodies, friction| {
            touches.push(Touch {
                point: [point[0], point[1], 0.0],
                normal: [normal[0], normal[1], 0.0],
                bodies,
                friction,
            });
        };
        for x in [-1.0, 1.0] {
            touch([x, 0.0], [0.0, -1.0], (0, None), 0.0);
            let down = [0.1 / slope, -1.0 / slope];
            touch([x, 1.0 + 0.1 * x], down, (1, Some(0)), mu);
            touch([x, 2.0], [x, 0.0], (1, None), 0.0);
            touch([x, 3.0], [x, 0.0], (1, None), 0.0);
        }
        Blocks::new(2, 2, touches)
    }

    #[test]
    fn a_wedge_lifts_a_guided_block_with_the_force_that_pulls_a_block_up_its_slope() {
        // Normal and friction on the block have the vertical resultant N (cos a − μ sin a) = 1 and the
        // horizontal one N (sin a + μ cos a), which is what the wedge is pushed with.
        for (mu, expected) in CGS4 {
            let blocks = wedge(mu);
            let weight = blocks.load(&[(1, [0.0, -1.0, 0.0], [0.0, 2.0, 0.0])]);
            let push = blocks.load(&[(0, [-1.0, 0.0, 0.0], [0.0, 0.2, 0.0])]);
            let found = blocks.contacts().limit(&weight, &push).unwrap();
            assert!(
                (factor(&found) / expected - 1.0).abs() < 1e-8,
                "{mu} {found:?}"
            );
        }
    }

    #[test]
    fn a_wedge_is_pulled_out_with_the_difference_of_friction_and_slope() {
        // The other way round: (μ − tan a)/(1 + μ tan a); without friction the weight drives it out.
        for (mu, expected) in [
            (0.2, 0.1 / 1.02),
            (0.3, 0.2 / 1.03),
            (0.1 + 1e-3, 1e-3 / 1.0101),
        ] {
            let blocks = wedge(mu);
            let weight = blocks.load(&[(1, [0.0, -1.0, 0.0], [0.0, 2.0, 0.0])]);
            let pull = blocks.load(&[(0, [1.0, 0.0, 0.0], [0.0, 0.2, 0.0])]);
            let found = blocks.contacts().limit(&weight, &pull).unwrap();
            assert!(
                (factor(&found) / expected - 1.0).abs() < 1e-8,
                "{mu} {found:?}"
            );
            let smooth = wedge(0.0).contacts().limit(&weight, &pull).unwrap();
            assert!(matches!(smooth, Limit::Never { .. }), "{smooth:?}");
        }
    }

    #[test]
    fn a_pad_slides_at_mu_times_its_weight_in_every_unit() {
        for unit in [1e-3, 1.0, 1e3] {
            for (size, pull) in [(1e-9, 1e9), (1.0, 1.0), (1e9, 1e-9)] {
                let mut pad = Blocks::pad(3, 0.3);
                pad.scale(unit);
                let weight = pad.load(&[(0, [0.0, 0.0, -12_000.0 * size], [0.0; 3])]);
                let pull_load = pad.load(&[(0, [0.6 * pull, 0.8 * pull, 0.0], [0.0; 3])]);
                let found = factor(&pad.contacts().limit(&weight, &pull_load).unwrap());
                let expected = 3600.0 * size / pull;
                assert!(
                    (found / expected - 1.0).abs() < 1e-8,
                    "{unit} {size} {found:e}"
                );
            }
        }
    }

    #[test]
    fn a_load_inside_the_cone_grows_without_end() {
        let pad = Blocks::pad(3, 0.3);
        let down = pad.load(&[(0, [0.29, 0.0, -1.0], [0.0; 3])]);
        assert_eq!(
            pad.contacts().limit(&[0.0; 6], &down).unwrap(),
            Limit::Unbounded
        );
        let pull = pad.load(&[(0, [0.31, 0.0, -1.0], [0.0; 3])]);
        assert_eq!(
            factor(&pad.contacts().limit(&[0.0; 6], &pull).unwrap()),
            0.0
        );
    }

    #[test]
    fn a_fixed_load_that_the_growing_one_can_only_make_worse_is_never_held() {
        let pad = Blocks::pad(2, 0.3);
        let up = pad.load(&[(0, [0.0, 2.0, 0.0], [0.0; 3])]);
        let side = pad.load(&[(0, [1.0, 0.0, 0.0], [0.0; 3])]);
        let Limit::Never { motion, excess } = pad.contacts().limit(&up, &side).unwrap() else {
            unreachable!()
        };
        assert!(motion[1] > 0.0 && excess > 0.0);
        // Pressing helps: 2 N up are held from λ = 2 on, and without end.
        let down = pad.load(&[(0, [0.0, -1.0, 0.0], [0.0; 3])]);
        assert_eq!(pad.contacts().limit(&up, &down).unwrap(), Limit::Unbounded);
    }

    #[test]
    fn a_load_that_no_contact_feels_has_no_room_to_grow() {
        let mut pad = Blocks::pad(2, 0.0);
        pad.tangents = false;
        let load = |x: f64, y: f64| pad.load(&[(0, [x, y, 0.0], [0.0; 3])]);
        let found = pad
            .contacts()
            .limit(&load(0.0, -1.0), &load(1.0, 0.0))
            .unwrap();
        assert!(factor(&found).abs() < 1e-12, "{found:?}");
        // −3 N along x is balanced by λ = 3 exactly.
        let found = pad
            .contacts()
            .limit(&load(-3.0, -1.0), &load(1.0, 0.0))
            .unwrap();
        assert!((factor(&found) - 3.0).abs() < 1e-12, "{found:?}");
        let found = pad
            .contacts()
            .limit(&load(3.0, -1.0), &load(1.0, 0.0))
            .unwrap();
        assert!(matches!(found, Limit::Never { .. }), "{found:?}");
    }
}
