//! Whether admissible contact forces can hold a load, decided by the numbers of (H5).
//!
//! Both answers carry their evidence: reactions that leave nothing of the load over, or a motion that no contact
//! resists while the load works on it.

use super::rigid_contacts::RigidContacts;
use super::separation::Separation;
use crate::error::Error;
use crate::problem::velocity_basis::norm;

/// A load is held if no more than this part of it is left over, or this part of the reactions.
const HELD: f64 = 1e-11;
const HELD_BY_LARGE: f64 = 1e-14;

/// A load on idle motions below this part of it, or a velocity below this part of an amplitude, is round-off.
const IDLE: f64 = 1e-11;

/// Round-off in the velocities of a motion of unit size: less resistance is none.
const RESTING: f64 = 4e-16;

/// A motion that the contacts resist a little proves that an equilibrium would take reactions of at least
/// work / resistance: beyond this multiple of the load they count as none. (On the edge of a jam
/// ever less friction is made up for by ever larger reactions.)
const FAR: f64 = 1e6;

/// Proximal steps; ten are usual, more are for jams.
const STEPS: usize = 40;

/// Whether contact holds a load, with the evidence.
#[derive(Clone, Debug, PartialEq)]
pub enum Equilibrium {
    /// Admissible reactions hold the load.
    Held {
        /// Such reactions, in newton per contact unknown.
        reaction: Vec<f64>,
    },
    /// No admissible reactions hold the load.
    Impossible {
        /// Rigid motion α that no contact resists while the load works on it. Its fastest sliding
        /// contact has unit speed; if none slides, the fastest opening one.
        motion: Vec<f64>,
        /// Power of the load on this motion: the force that is missing at that contact, in newton.
        excess: f64,
    },
    /// Too close to the limit, or too badly conditioned, to tell.
    Undecided {
        /// Part of the load that the best admissible reactions leave over.
        remainder: f64,
    },
}

impl RigidContacts {
    /// Decides whether admissible reactions hold `load` (its virtual work on each mode).
    ///
    /// # Errors
    ///
    /// A load of the wrong length, or one that is not finite.
    pub fn admissible(&self, load: &[f64]) -> Result<Equilibrium, Error> {
        self.check_load("load", load)?;
        Ok(self.decide(load))
    }

    /// [`admissible`](Self::admissible) for a load that has been checked.
    pub(super) fn decide(&self, load: &[f64]) -> Equilibrium {
        if let Some(idle) = self.idle(load) {
            return idle;
        }
        let impossible = |motion| self.impossible(motion, load);
        let mut moved = self.basis.load(load);
        let size = length(&moved);
        if size == 0.0 {
            let reaction = vec![0.0; self.modes().nrows()];
            return Equilibrium::Held { reaction };
        }
        moved.iter_mut().for_each(|e| *e /= size);
        let mut search = Separation::new(self.cones(), self.basis.velocities.as_ref(), &moved);
        let mut proof: Option<(Vec<f64>, f64)> = None;
        for _ in 0..STEPS {
            let motion = search.step();
            if search.remainder() <= HELD.max(HELD_BY_LARGE * length(&search.reaction)) {
                let reaction = search.reaction.iter().map(|t| t * size).collect();
                return Equilibrium::Held { reaction };
            }
            let (work, resistance) = search.work_and_resistance(&motion);
            let resistance = (resistance - RESTING).max(0.0);
            if work > FAR * resistance {
                // Steps go on as long as they sharpen the proof.
                let sharper = proof
                    .as_ref()
                    .is_none_or(|(_, last)| resistance < 0.5 * last);
                if sharper {
                    proof = Some((motion, resistance));
                }
                if !sharper || resistance == 0.0 {
                    break;
                }
            }
        }
        match proof {
            Some((motion, _)) => impossible(self.basis.amplitudes(&motion)),
            None => Equilibrium::Undecided {
                remainder: search.remainder(),
            },
        }
    }

    /// Impossible, whatever laws the contacts obey, if the load works on a motion that moves none of them; else
    /// nothing is known.
    #[must_use]
    pub(crate) fn idle(&self, load: &[f64]) -> Option<Equilibrium> {
        Some(self.impossible(self.idle_motion(load)?, load))
    }

    fn impossible(&self, motion: Vec<f64>, load: &[f64]) -> Equilibrium {
        let (motion, excess) = self.at_unit_speed(motion, load);
        Equilibrium::Impossible { motion, excess }
    }

    /// An idle motion on which the load works, if there is one.
    fn idle_motion(&self, load: &[f64]) -> Option<Vec<f64>> {
        let idle = self.basis.idle_load(load);
        let works = length(&idle) > IDLE * self.basis.load_size(load);
        works.then(|| self.basis.idle_amplitudes(&idle))
    }

    /// A motion brought to unit speed of the contacts, or unit amplitude if none moves, and the load's power on it.
    pub(crate) fn at_unit_speed(&self, mut motion: Vec<f64>, load: &[f64]) -> (Vec<f64>, f64) {
        let amplitude = self.basis.largest_amplitude(&motion);
        let mut speed = self.speed(&motion);
        if speed <= IDLE * amplitude {
            speed = amplitude;
        }
        motion.iter_mut().for_each(|amplitude| *amplitude /= speed);
        let excess = power(load, &motion);
        (motion, excess)
    }
}

fn length(vector: &[f64]) -> f64 {
    norm(vector.iter().copied())
}

/// `e·α`.
pub(super) fn power(load: &[f64], motion: &[f64]) -> f64 {
    load.iter().zip(motion).map(|(e, a)| e * a).sum()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::limit::tests::blocks::{Blocks, Touch, force, incline};

    fn held(contacts: &RigidContacts, load: &[f64]) -> Vec<f64> {
        match contacts.admissible(load).unwrap() {
            Equilibrium::Held { reaction } => reaction,
            other => unreachable!("{other:?}"),
        }
    }

    fn impossible(contacts: &RigidContacts, load: &[f64]) -> (Vec<f64>, f64) {
        match contacts.admissible(load).unwrap() {
            Equilibrium::Impossible { motion, excess } => (motion, excess),
            other => unreachable!("{other:?}"),
        }
    }

    /// Sums of the normal and of the first tangential reactions.
    fn sums(contacts: &RigidContacts, reaction: &[f64]) -> (f64, f64) {
        let starts = &contacts.offsets()[..contacts.contacts()];
        let normal = starts.iter().map(|&n| reaction[n]).sum();
        (normal, starts.iter().map(|&n| reaction[n + 1]).sum())
    }

    #[test]
    fn a_block_on_an_incline_presses_with_w_cos_a_and_rubs_with_w_sin_a() {
        for dimension in [2, 3] {
            let (contacts, weight) = incline(dimension, 0.5, 0.4, [2.0, 1.0]);
            let (normal, friction) = sums(&contacts, &held(&contacts, &weight));
            let a = 0.4_f64.atan();
            // Weight 1, of which `HELD` may be left: friction holds it back against +x, down the slope.
            assert!((normal + a.cos()).abs() < 1e-10 && (friction + a.sin()).abs() < 1e-10);
        }
    }

    #[test]
    fn a_block_sticks_just_below_the_angle_of_friction_and_slides_just_above() {
        for dimension in [2, 3] {
            for (mu, margin) in [(1e-3, 1e-6), (0.1, 1e-9), (0.3, 1e-9), (1.0, 1e-9)] {
                let block = |slope: f64| incline(dimension, mu, slope, [3.0, 1.0]);
                let (contacts, weight) = block(mu * (1.0 - margin));
                held(&contacts, &weight);
                let slope = mu * (1.0 + margin);
                let (contacts, weight) = block(slope);
                let (motion, excess) = impossible(&contacts, &weight);
                // It slides down the slope and may open as it does: (1, μ), and up to 1/`FAR` otherwise.
                assert!(
                    (motion[0] - 1.0).abs() < 1e-6 && (motion[1] - mu).abs() < 1e-6,
                    "{motion:?}"
                );
                // W sin a − μ W cos a, a difference of numbers of order W = 1.
                let missing = slope.atan().sin() - mu * slope.atan().cos();
                assert!(
                    (excess - missing).abs() < 1e-6 * missing + 1e-14,
                    "{excess:e} {missing:e}"
                );
            }
        }
    }

    #[test]
    fn a_slender_block_tips_when_tan_a_exceeds_width_over_height() {
        for dimension in [2, 3] {
            // Width 1, height 2: tips beyond tan a = 0.5 although μ = 2 would not let it slide.
            let (contacts, weight) = incline(dimension, 2.0, 0.5 * (1.0 - 1e-6), [1.0, 2.0]);
            held(&contacts, &weight);
            let (contacts, weight) = incline(dimension, 2.0, 0.5 * (1.0 + 1e-6), [1.0, 2.0]);
            let (motion, excess) = impossible(&contacts, &weight);
            let velocity = contacts.velocity(&motion);
            let normals: Vec<f64> = contacts.offsets()[..contacts.contacts()]
                .iter()
                .map(|&n| velocity[n])
                .collect();
            // The upper edge opens with speed 1 (or a little slip with it: what a slope beyond by 1e-6 leaves free, to
            // the root at worst), the lower stays.
            assert!((normals[0] + 1.0).abs() < 1e-3 && normals[normals.len() - 1].abs() < 1e-3);
            assert!(excess > 0.0);
        }
    }

    #[test]
    fn a_load_that_pulls_the_block_off_opens_every_contact() {
        let pad = Blocks::pad(3, 0.5);
        let contacts = pad.contacts();
        let (motion, excess) = impossible(&contacts, &pad.load(&[(0, [0.0, 0.0, 7.0], [0.0; 3])]));
        let velocity = contacts.velocity(&motion);
        let starts = &contacts.offsets()[..contacts.contacts()];
        // By symmetry it is lifted evenly, at unit speed: 7 N are missing.
        assert!(
            starts.iter().all(|&n| (velocity[n] + 1.0).abs() < 1e-6),
            "{motion:?}"
        );
        assert!((excess - 7.0).abs() < 1e-6, "{excess}");
    }

    #[test]
    fn a_sliding_pad_is_held_at_99_percent_and_misses_36_newton_at_101() {
        // SSNV503: 12000 N on 20 × 20 mm, μ = 0.3: at most 3600 N along x.
        for dimension in [2, 3] {
            let pad = Blocks::pad(dimension, 0.3);
            let contacts = pad.contacts();
            let load = |pull: f64| pad.load(&[(0, force([pull, -12_000.0], dimension), [0.0; 3])]);
            let reaction = held(&contacts, &load(3564.0));
            let (normal, friction) = sums(&contacts, &reaction);
            // What is held is to `HELD` of the load, 1e-7 N; a proof is sharp to 1/`FAR` of what is missing.
            assert!((normal + 12_000.0).abs() < 1e-6 && (friction + 3564.0).abs() < 1e-6);
            let (motion, excess) = impossible(&contacts, &load(3636.0));
            assert!((excess - 36.0).abs() < 1e-4, "{excess} {motion:?}");
        }
    }

    #[test]
    fn a_pad_under_a_twisting_moment_turns_when_the_moment_passes_the_friction_s() {
        // Four corners at distance √2 · 10 mm, N/4 each: M = μ N √2 · 10 mm.
        let pad = Blocks::pad(3, 0.3);
        let contacts = pad.contacts();
        let limit = 0.3 * 12_000.0 * 0.01 * 2.0_f64.sqrt();
        let load = |moment: f64| {
            let mut load = pad.load(&[(0, [0.0, 0.0, -12_000.0], [0.0; 3])]);
            load[5] += moment;
            load
        };
        held(&contacts, &load(limit * (1.0 - 1e-6)));
        let (motion, _) = impossible(&contacts, &load(limit * (1.0 + 1e-6)));
        // Unit speed of the corners: ω = 1 / (√2 · 0.01); a moment beyond by 1e-6 leaves room for a part of it.
        assert!(
            (motion[5] * 0.01 * 2.0_f64.sqrt() - 1.0).abs() < 1e-4,
            "{motion:?}"
        );
    }

    #[test]
    fn duplicated_contacts_do_not_change_the_verdict_or_the_resultants() {
        let mut pad = Blocks::pad(3, 0.3);
        let twice = pad.touches.clone();
        pad.touches.extend(twice);
        let contacts = pad.contacts();
        let load = |pull: f64| pad.load(&[(0, [pull, 0.0, -12_000.0], [0.0; 3])]);
        let (normal, _) = sums(&contacts, &held(&contacts, &load(3600.0 * (1.0 - 1e-6))));
        // `HELD` is 1e-7 N, a part of 3e-5 of the 3.6e-3 N that are missing.
        assert!((normal + 12_000.0).abs() < 1e-6);
        let (_, excess) = impossible(&contacts, &load(3600.0 * (1.0 + 1e-6)));
        assert!((excess / 3.6e-3 - 1.0).abs() < 1e-4);
    }

    #[test]
    fn units_of_length_and_force_do_not_matter() {
        for unit in [1e-6, 1e-3, 1.0, 1e3, 1e6] {
            for size in [1e-9, 1.0, 1e9] {
                for (above, sticks) in [(1.0 - 1e-6, true), (1.0 + 1e-6, false)] {
                    let mut pad = Blocks::pad(3, 0.3);
                    pad.scale(unit);
                    let contacts = pad.contacts();
                    let forces = [3600.0 * above * size, 0.0, -12_000.0 * size];
                    let load = pad.load(&[(0, forces, [0.0; 3])]);
                    match contacts.admissible(&load).unwrap() {
                        Equilibrium::Held { .. } => assert!(sticks),
                        Equilibrium::Impossible { excess, .. } => {
                            assert!(!sticks && (excess / size - 3.6e-3).abs() < 1e-6);
                        }
                        Equilibrium::Undecided { .. } => unreachable!("{unit} {size}"),
                    }
                }
            }
        }
    }

    #[test]
    fn a_load_that_no_contact_feels_is_not_held() {
        // Frictionless contacts without tangents on a plane: nothing answers along x.
        let mut pad = Blocks::pad(3, 0.0);
        pad.tangents = false;
        let contacts = pad.contacts();
        held(&contacts, &pad.load(&[(0, [0.0, 0.0, -5.0], [0.0; 3])]));
        let (motion, excess) = impossible(&contacts, &pad.load(&[(0, [1.0, 0.0, -5.0], [0.0; 3])]));
        assert!(motion[0] > 0.1 && excess > 0.0, "{motion:?}");
    }

    #[test]
    fn a_body_jammed_between_two_walls_holds_any_load_along_them() {
        // No gravity presses: the walls press on each other through the body as hard as it takes.
        let touch = |x: f64, y: f64| Touch {
            point: [x, y, 0.0],
            normal: [x.signum(), 0.0, 0.0],
            bodies: (0, None),
            friction: 0.2,
        };
        let corners = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)];
        let blocks = Blocks::new(2, 1, corners.map(|(x, y)| touch(x, y)).to_vec());
        let contacts = blocks.contacts();
        let reaction = held(&contacts, &blocks.load(&[(0, [0.0, -10.0, 0.0], [0.0; 3])]));
        // 10 N of friction at μ = 0.2 takes 25 N of pressure on each side at least.
        // `HELD` of 10 N, over μ on two sides, is 1e-9 N.
        let (normal, _) = sums(&contacts, &reaction);
        assert!(normal <= -50.0 + 1e-9, "{normal}");
    }

    #[test]
    fn nothing_to_hold_and_nothing_that_holds() {
        let pad = Blocks::pad(2, 0.3);
        assert_eq!(
            held(&pad.contacts(), &[0.0; 3]),
            vec![0.0; 2 * pad.touches.len()]
        );
        let lonely = Blocks::new(2, 1, Vec::new());
        let (motion, excess) = impossible(&lonely.contacts(), &[0.0, -3.0, 0.0]);
        assert!((motion[1] + 1.0).abs() < 1e-12 && (excess - 3.0).abs() < 1e-12);
        assert!(matches!(
            pad.contacts().admissible(&[f64::NAN, 0.0, 0.0]),
            Err(Error::NotFinite { .. })
        ));
    }
}
