//! By what factor a load can grow before nothing holds it.
//!
//! ```text
//! (H6)  max λ   s.t.  Rᵀ t + e_fixed + λ e_growing = 0,  t ∈ K,  λ ≥ 0
//!     = min −e_fixed·α / e_growing·α   s.t.  R α ∈ K*,  e_growing·α > 0
//! ```
//!
//! Statical and kinematical theorem of limit analysis. Every motion that proves a factor impossible (H5) bounds λ from
//! above; at the bound the next motion is sought, until the load is held there: Newton's method on the distance
//! (H5), which is a convex function of λ. The reactions at the end prove that λ is held, the last motion that more is not.
//!
//! Both are exact if the sliding contacts may open as they slide (`v_N = −μ ‖v_T‖`); under Coulomb's law, where they do
//! not, no factor above λ is admissible, and whether a factor below it is reached depends on the elastic bodies.

use faer::Mat;

use super::equilibrium::{Equilibrium, power};
use super::rigid_contacts::RigidContacts;
use crate::error::Error;

/// Bounds that are tried; five are usual.
const BOUNDS: usize = 40;

/// Distance from a bound to the factor that is tried below it, relative to that at which the loads are of one size:
/// at first, and the largest after having been doubled where round-off hides whether the bound is held.
const RETREAT: (f64, f64) = (1e-10, 1e-7);

/// How far a load can grow.
#[derive(Clone, Debug, PartialEq)]
pub enum Limit {
    /// Up to a factor.
    Finite {
        /// Largest λ.
        factor: f64,
        /// Rigid motion that begins there, at unit speed of its fastest sliding (else opening) contact.
        motion: Vec<f64>,
        /// Admissible reactions that hold the fixed load and λ times the growing one, in newton per contact unknown.
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
        match self.with_growing(growing)?.decide(fixed) {
            Equilibrium::Held { .. } => {}
            Equilibrium::Undecided { .. } => return Ok(Limit::Undecided),
            Equilibrium::Impossible { motion, .. } => {
                let (motion, excess) = self.at_unit_speed(motion, fixed);
                return Ok(Limit::Never { motion, excess });
            }
        }
        Ok(match self.decide(growing) {
            Equilibrium::Held { .. } => Limit::Unbounded,
            Equilibrium::Undecided { .. } => Limit::Undecided,
            Equilibrium::Impossible { motion, .. } => self.largest(fixed, growing, motion),
        })
    }

    /// (H6), from a motion on which the growing load alone is not held.
    fn largest(&self, fixed: &[f64], growing: &[f64], mut motion: Vec<f64>) -> Limit {
        let bound = |motion: &[f64]| -power(fixed, motion) / power(growing, motion);
        let mut factor = bound(&motion);
        let balance = self.basis.load_size(fixed) / self.basis.load_size(growing);
        let mut retreat = RETREAT.0;
        for _ in 0..BOUNDS {
            if !factor.is_finite() || retreat > RETREAT.1 {
                break;
            }
            factor = factor.max(0.0);
            let sum = fixed.iter().zip(growing).map(|(f, g)| f + factor * g);
            match self.decide(&sum.collect::<Vec<_>>()) {
                Equilibrium::Held { reaction } => {
                    return Limit::Finite {
                        factor,
                        motion,
                        reaction,
                    };
                }
                Equilibrium::Impossible { motion: next, .. } => {
                    let below = factor - retreat * factor.max(balance);
                    factor = bound(&next).min(below);
                    motion = next;
                }
                Equilibrium::Undecided { .. } => {
                    factor -= retreat * factor.max(balance);
                    retreat *= 2.0;
                }
            }
        }
        Limit::Undecided
    }

    /// The same bodies on one contact more, smooth, whose reaction is the growing load itself: `t_N = −λ`
    /// works on the velocity `−e_growing·α`.
    fn with_growing(&self, growing: &[f64]) -> Result<Self, Error> {
        let size = self.basis.load_size(growing);
        let unit = if size > 0.0 { size } else { 1.0 };
        let (rows, modes) = (self.modes().nrows(), self.modes());
        let modes = Mat::from_fn(rows + 1, modes.ncols(), |i, k| {
            if i < rows {
                modes[(i, k)]
            } else {
                -growing[k] / unit
            }
        });
        let blocks = self.offsets().windows(2);
        let mut tangents: Vec<usize> = blocks.map(|block| block[1] - block[0] - 1).collect();
        tangents.push(0);
        let mut friction = self.friction().to_vec();
        friction.push(0.0);
        Self::new(&tangents, friction, modes)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::limit::tests::blocks::{Blocks, Touch, force};

    fn factor(limit: &Limit) -> f64 {
        match limit {
            Limit::Finite { factor, .. } => *factor,
            other => unreachable!("{other:?}"),
        }
    }

    /// (tan a + μ)/(1 − μ tan a) with tan a = 0.1: NAFEMS CGS-4 has the first four.
    fn cgs4() -> impl Iterator<Item = (f64, f64)> {
        let friction = [0.0, 0.1, 0.2, 0.3, 1e-6, 0.5, 0.7, 1.0];
        friction
            .into_iter()
            .map(|mu| (mu, (0.1 + mu) / (1.0 - 0.1 * mu)))
    }

    #[test]
    fn a_block_is_pulled_up_a_slope_as_nafems_cgs_4_has_it() {
        for dimension in [2, 3] {
            for (mu, expected) in cgs4() {
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
                    (factor(&found) / expected - 1.0).abs() < 1e-11,
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
        for (mu, expected) in cgs4() {
            let blocks = wedge(mu);
            let weight = blocks.load(&[(1, [0.0, -1.0, 0.0], [0.0, 2.0, 0.0])]);
            let push = blocks.load(&[(0, [-1.0, 0.0, 0.0], [0.0, 0.2, 0.0])]);
            let found = blocks.contacts().limit(&weight, &push).unwrap();
            assert!(
                (factor(&found) / expected - 1.0).abs() < 1e-11,
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
                (factor(&found) / expected - 1.0).abs() < 1e-11,
                "{mu} {found:?}"
            );
            let smooth = wedge(0.0).contacts().limit(&weight, &pull).unwrap();
            assert!(matches!(smooth, Limit::Never { .. }), "{smooth:?}");
        }
    }

    #[test]
    fn a_pad_slides_at_mu_times_its_weight_in_every_unit() {
        for unit in [1e-6, 1e-3, 1.0, 1e3, 1e6] {
            for (size, pull) in [(1e-9, 1e9), (1.0, 1.0), (1e9, 1e-9)] {
                let mut pad = Blocks::pad(3, 0.3);
                pad.scale(unit);
                let weight = pad.load(&[(0, [0.0, 0.0, -12_000.0 * size], [0.0; 3])]);
                let pull_load = pad.load(&[(0, [0.6 * pull, 0.8 * pull, 0.0], [0.0; 3])]);
                let found = factor(&pad.contacts().limit(&weight, &pull_load).unwrap());
                let expected = 3600.0 * size / pull;
                assert!(
                    (found / expected - 1.0).abs() < 1e-11,
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

    #[test]
    fn many_contacts_on_one_body_and_on_a_tower_of_twenty() {
        // Block k stands on block k − 1, block 0 on the ground. A pushed block slides on what it stands on, with
        // all that stands on it: μ times their weight.
        let tower = |bodies: usize, per_face: usize| {
            let mut touches = Vec::new();
            for body in 0..bodies {
                for i in 0..per_face {
                    let x = 200.0 * (i as f64 / (per_face - 1) as f64 - 0.5);
                    touches.push(Touch {
                        point: [x, body as f64, 0.0],
                        normal: [0.0, -1.0, 0.0],
                        bodies: (body, body.checked_sub(1)),
                        friction: 0.3,
                    });
                }
            }
            Blocks::new(2, bodies, touches)
        };
        for (bodies, per_face, pushed) in [(1, 200, 0), (20, 10, 0), (20, 10, 7), (20, 10, 19)] {
            let blocks = tower(bodies, per_face);
            let centre = |body: usize| [0.0, body as f64 + 0.5, 0.0];
            let each = (0..bodies).map(|body| (body, [0.0, -2.0, 0.0], centre(body)));
            let weight = blocks.load(&each.collect::<Vec<_>>());
            let push = blocks.load(&[(pushed, [1.0, 0.0, 0.0], centre(pushed))]);
            let found = factor(&blocks.contacts().limit(&weight, &push).unwrap());
            let expected = 0.3 * 2.0 * (bodies - pushed) as f64;
            // `RETREAT` resolves 1e-10 of the load, which is up to twenty times the least push.
            assert!((found / expected - 1.0).abs() < 1e-9, "{pushed} {found}");
        }
    }

    #[test]
    fn loads_too_large_for_their_work_are_undecided() {
        let pad = Blocks::pad(2, 0.3);
        let weight = pad.load(&[(0, [0.0, -1e308, 0.0], [0.0; 3])]);
        let pull = pad.load(&[(0, [1e-10, 0.0, 0.0], [0.0; 3])]);
        let found = pad.contacts().limit(&weight, &pull).unwrap();
        assert_eq!(found, Limit::Undecided);
    }
}
