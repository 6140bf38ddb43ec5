//! Rigid bodies beside the condensed ones: floating bodies without compliance.
//!
//! ```text
//! (C31)  R_ik = −B_i d_k(x_i),   e_k = F_k           d_k: unit motion of a free component, F_k: its force
//!        u_ref,i = B_i d(x_i)                        d: motion of the components that are given (C14)
//! ```
//!
//! Between the faces of a cut d is what moves the second of them on, so that it counts against the first, from
//! whichever side a contact looks. A cut that is locked has its shortening given.
//!
//! The motion is taken where a contact's displacement is measured and its force acts, so that what the
//! bodies give each other is equal in force and moment. Amplitudes of rotations are in metre at the
//! contact farthest from the reference point.

use std::sync::Arc;

use faer::MatMut;
use faer::prelude::ReborrowMut;

use crate::body::Body;
use crate::contact::{Component, ContactSurface, RigidBody, RigidMotion};
use crate::error::{Error, check_finite};

/// Part of a unit motion below which a contact feels nothing of it but round-off.
const ROUND_OFF: f64 = 1e-13;

/// Rigid bodies, where contacts see them, and what acts on them.
#[derive(Clone, Debug, Default)]
pub(super) struct Carried {
    /// As they are stated, and with what is locked.
    stated: Arc<[RigidBody]>,
    bodies: Arc<[RigidBody]>,
    seats: Arc<[Seat]>,
    /// Distance of the farthest contact from each reference point, in metre.
    sizes: Vec<f64>,
    /// Factor per body and component.
    factors: Vec<[f64; 6]>,
    /// Shortening per body at which its cut is locked, in metre.
    locked: Vec<Option<f64>>,
}

/// A contact against a rigid body.
#[derive(Clone, Copy, Debug)]
struct Seat {
    contact: usize,
    body: usize,
    /// Where its displacement is measured, in metre.
    centre: [f64; 3],
    /// −1 if it looks from the second face of a cut.
    sign: f64,
}

impl Seat {
    /// How its other side moves, in metre.
    fn moved(&self, motion: &RigidMotion) -> [f64; 3] {
        motion.at(self.centre).map(|d| self.sign * d)
    }
}

impl Carried {
    /// Finds the contacts of rigid bodies.
    pub(super) fn new(rigid: &[RigidBody], bodies: &[Body], surface: &ContactSurface) -> Self {
        let mut seats = Vec::new();
        let mut sizes = vec![0.0_f64; rigid.len()];
        for (body, of_body) in rigid.iter().enumerate() {
            let contacts = surface.nodes.iter().enumerate();
            for (contact, at) in contacts.filter(|(_, at)| of_body.pairs.contains(&at.pair)) {
                let centre = at.centre(&bodies[at.body].mesh.nodes);
                let arm = (0..3).map(|axis| centre[axis] - of_body.reference[axis]);
                sizes[body] = sizes[body].max(arm.fold(0.0, f64::hypot));
                seats.push(Seat {
                    contact,
                    body,
                    centre,
                    sign: if at.second { -1.0 } else { 1.0 },
                });
            }
        }
        for size in &mut sizes {
            *size = if *size > 0.0 { *size } else { 1.0 };
        }
        Self {
            stated: rigid.into(),
            bodies: rigid.into(),
            seats: seats.into(),
            sizes,
            factors: vec![[1.0; 6]; rigid.len()],
            locked: vec![None; rigid.len()],
        }
    }

    /// Locks cuts at a shortening per body, in metre, and frees all others; whether that changes what is free.
    pub(super) fn lock(&mut self, locked: &[Option<f64>]) -> bool {
        if self.locked == locked {
            return false;
        }
        let held = |locked: &[Option<f64>]| locked.iter().map(Option::is_some).collect::<Vec<_>>();
        let changed = held(&self.locked) != held(locked);
        let mut bodies = self.stated.to_vec();
        for (body, shortening) in bodies.iter_mut().zip(locked) {
            if let Some(shortening) = shortening {
                body.components[0] = Component::Given(*shortening);
            }
        }
        self.bodies = bodies.into();
        self.locked = locked.to_vec();
        changed
    }

    /// Shortening per body at which its cut is locked, in metre.
    pub(super) fn locked(&self) -> &[Option<f64>] {
        &self.locked
    }

    /// The amplitudes, one per free mode, of those modes that are left once these cuts are locked.
    pub(super) fn unlocked(&self, amplitudes: &[f64], locked: &[Option<f64>]) -> Vec<f64> {
        let modes = self.free().zip(amplitudes);
        let left = modes.filter(|((body, ..), _)| locked.get(*body).is_none_or(Option::is_none));
        left.map(|(_, &amplitude)| amplitude).collect()
    }

    /// Body, component and amplitude's unit of every free mode.
    fn free(&self) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
        let bodies = self.bodies.iter().enumerate();
        let bodies = bodies.zip(&self.sizes);
        bodies.flat_map(|((body, of_body), size)| {
            let unit = move |k: usize| if k < 3 { 1.0 } else { 1.0 / size };
            of_body.free().map(move |k| (body, k, unit(k)))
        })
    }

    /// Number of free modes.
    pub(super) fn modes(&self) -> usize {
        self.free().count()
    }

    /// R of (C31), into one column per free mode.
    pub(super) fn fill(&self, surface: &ContactSurface, mut modes: MatMut<'_, f64>) {
        let mut firsts = Vec::with_capacity(surface.nodes.len());
        firsts.extend(surface.nodes.iter().scan(0, |next, node| {
            let first = *next;
            *next += 1 + node.tangents;
            Some(first)
        }));
        for (column, (body, k, unit)) in self.free().enumerate() {
            let motion = self.one(body, k, -unit);
            for seat in self.seats.iter().filter(|seat| seat.body == body) {
                let contact = &surface.nodes[seat.contact];
                let moved = seat.moved(&motion);
                for (row, direction) in contact.frame[..=contact.tangents].iter().enumerate() {
                    let along: f64 = direction.iter().zip(moved).map(|(d, u)| d * u).sum();
                    modes[(firsts[seat.contact] + row, column)] = along;
                }
            }
            let mut felt = modes.rb_mut().col_mut(column);
            if felt.norm_max() <= ROUND_OFF {
                felt.fill(0.0);
            }
        }
    }

    /// The motion of one component alone.
    fn one(&self, body: usize, component: usize, value: f64) -> RigidMotion {
        let mut values = [0.0; 6];
        values[component] = value;
        self.bodies[body].motion(values)
    }

    /// e of (C31), in newton per free mode.
    pub(super) fn load(&self) -> Vec<f64> {
        let of_mode = |(body, k, unit): (usize, usize, f64)| self.forces(body)[k] * unit;
        self.free().map(of_mode).collect()
    }

    /// e of one component's force alone.
    pub(super) fn load_of(&self, rigid: usize, component: usize) -> Vec<f64> {
        let mut load = self.load();
        for (e, (body, k, _)) in load.iter_mut().zip(self.free()) {
            if (body, k) != (rigid, component) {
                *e = 0.0;
            }
        }
        load
    }

    /// What a unit more of the factor of a component gives: motion of every body, and e.
    pub(super) fn rate_of(&self, rigid: usize, component: usize) -> (Vec<RigidMotion>, Vec<f64>) {
        let one = Self {
            factors: vec![[1.0; 6]; self.bodies.len()],
            ..self.clone()
        };
        let mut motions: Vec<_> = self
            .bodies
            .iter()
            .map(|body| body.motion([0.0; 6]))
            .collect();
        if let Component::Given(motion) = self.bodies[rigid].components[component] {
            motions[rigid] = self.one(rigid, component, motion);
        }
        (motions, one.load_of(rigid, component))
    }

    /// Given forces on the free components of a body, in newton, and moments in newton metre.
    pub(super) fn forces(&self, body: usize) -> [f64; 6] {
        self.values(body, |component| match component {
            Component::Free(force) => force,
            Component::Given(_) => 0.0,
        })
    }

    fn values(&self, body: usize, of: impl Fn(Component) -> f64) -> [f64; 6] {
        let components = self.bodies[body].components;
        // A shortening that is locked has no factor.
        let factor = |k: usize| match self.locked[body] {
            Some(_) => 1.0,
            None => self.factors[body][k],
        };
        std::array::from_fn(|k| factor(k) * of(components[k]))
    }

    /// Given motion of a body.
    fn given(&self, body: usize) -> [f64; 6] {
        self.values(body, |component| match component {
            Component::Given(motion) => motion,
            Component::Free(_) => 0.0,
        })
    }

    /// Motion of the free components under an amplitude per mode.
    pub(super) fn freely(&self, amplitudes: &[f64]) -> Vec<RigidMotion> {
        let mut values = vec![[0.0; 6]; self.bodies.len()];
        for ((body, k, unit), amplitude) in self.free().zip(amplitudes) {
            values[body][k] = unit * amplitude;
        }
        let bodies = self.bodies.iter().zip(values);
        bodies.map(|(body, values)| body.motion(values)).collect()
    }

    /// Motion of every body: what is given, and the free components under an amplitude per mode.
    pub(super) fn motions(&self, amplitudes: &[f64]) -> Vec<RigidMotion> {
        let mut motions = self.freely(amplitudes);
        for (body, motion) in motions.iter_mut().enumerate() {
            let given = self.bodies[body].motion(self.given(body));
            for axis in 0..3 {
                motion.translation[axis] += given.translation[axis];
                motion.rotation[axis] += given.rotation[axis];
            }
        }
        motions
    }

    /// Puts the displacement of the other side per contact, in metre, where that is a rigid body.
    pub(super) fn put(&self, motions: &[RigidMotion], moved: &mut [[f64; 3]]) {
        for seat in self.seats.iter() {
            moved[seat.contact] = seat.moved(&motions[seat.body]);
        }
    }

    /// Puts the motion of the obstacle per contact pair.
    pub(super) fn put_pairs(&self, motions: &[RigidMotion], pairs: &mut [RigidMotion]) {
        for (body, motion) in self.bodies.iter().zip(motions) {
            for &pair in &body.pairs {
                pairs[pair] = *motion;
            }
        }
    }

    /// Takes a factor of a component.
    pub(super) fn scale(
        &mut self,
        body: usize,
        component: usize,
        factor: f64,
    ) -> Result<(), Error> {
        self.factors[body][component] = factor;
        let place = &self.bodies[body].place;
        check_finite(place, &self.given(body))?;
        check_finite(place, &self.forces(body))
    }

    /// The rigid bodies, with what is locked.
    pub(super) fn bodies(&self) -> &[RigidBody] {
        &self.bodies
    }

    /// Distance of the farthest contact from each reference point, in metre.
    pub(super) fn sizes(&self) -> &[f64] {
        &self.sizes
    }
}
