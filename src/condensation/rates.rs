//! What a unit more of a load, a support, an obstacle's motion or a modulus does to bodies, reactions held: the
//! drive of a derivative. Nothing is factorised again.
//!
//! ```text
//!        load      K u̇ = f_k              support   K u̇ = −K u_k
//! (C26)  modulus   K u̇ = E ∂f/∂E − K_e u    per relative change of E      K_e: K without springs to the ground
//!                                         f: of heat, whose stress is as stiff as the body
//! ```

use super::load_case::{Action, Given};
use super::rigid_bodies::mode_loads;
use super::{Condensed, CondensedBody, Driven};
use crate::body;
use crate::body::{Body, Load};
use crate::error::Error;

/// What one body gets per unit of a parameter.
#[derive(Debug)]
pub struct BodyRate {
    body: usize,
    action: Action,
}

/// What contacts see of a unit of a factor of a rigid body's component.
#[derive(Debug)]
pub(crate) struct RigidRate {
    /// Change of the displacement beyond the gaps, per contact unknown.
    pub(crate) beyond: Vec<f64>,
    /// Change of the load on every free mode.
    pub(crate) load: Vec<f64>,
    /// Motion of the other side per contact, in metre.
    pub(crate) sides: Vec<[f64; 3]>,
}

impl Condensed {
    /// Of the factor of a load or support.
    ///
    /// # Errors
    ///
    /// A load or support that there is not.
    pub fn rate_of(&self, bodies: &[Body], driven: Driven) -> Result<BodyRate, Error> {
        let Some(body) = driven.body() else {
            return Err(Error::NotAccepted {
                place: "driven".to_owned(),
                found: "a component of a rigid body".to_owned(),
                accepted: "a load or support of an elastic body".to_owned(),
            });
        };
        driven.check(bodies, 0)?;
        let action = self.answer_of(body, &bodies[body], |acts| acts == driven);
        Ok(BodyRate { body, action })
    }

    /// Of all moduli of a body, relative to what they are, in a state with this displacement, in metre.
    #[must_use]
    pub fn rate_of_young(&self, index: usize, body: &Body, displacement: &[f64]) -> BodyRate {
        let heat = body.loads.iter();
        let heat = heat.filter(|load| matches!(load, Load::Temperature { .. }));
        let mut force = body::nodal_forces(body, &heat.cloned().collect::<Vec<_>>());
        let condensed = &self.bodies[index];
        for (&entry, (row, column)) in condensed.stiffness() {
            force[row] -= entry * displacement[column];
        }
        if let Some(springs) = body::foundation_forces(body, displacement) {
            for (force, spring) in force.iter_mut().zip(springs) {
                *force -= spring;
            }
        }
        BodyRate {
            body: index,
            action: condensed.answer(force, at_rest(condensed)),
        }
    }

    /// Change of the free displacement per metre of an obstacle's motion along an axis, per contact unknown.
    #[must_use]
    pub fn rate_of_obstacle(&self, pair: usize, axis: usize) -> Vec<f64> {
        let mut moved = vec![[0.0; 3]; self.surface.nodes.len()];
        for (moved, contact) in moved.iter_mut().zip(&self.surface.nodes) {
            if contact.pair == pair {
                moved[axis] = 1.0;
            }
        }
        self.left_behind(&moved)
    }

    /// Of the factor of a component of a rigid body.
    #[must_use]
    pub(crate) fn rate_of_rigid(&self, body: usize, component: usize) -> RigidRate {
        let (motions, of_rigid) = self.carried.rate_of(body, component);
        let mut sides = vec![[0.0; 3]; self.surface.nodes.len()];
        self.carried.put(&motions, &mut sides);
        let mut load = vec![0.0; self.problem.free_modes() - of_rigid.len()];
        load.extend(of_rigid);
        RigidRate {
            beyond: self.left_behind(&sides),
            load,
            sides,
        }
    }

    /// Change of the displacement relative to the other side, per contact unknown, where that side moves.
    fn left_behind(&self, moved: &[[f64; 3]]) -> Vec<f64> {
        let along = self.along_contacts(moved, &vec![0.0; self.problem.unknowns()]);
        along.into_iter().map(|u| -u).collect()
    }

    /// Change of the free displacement, per contact unknown, and of the load on every free mode.
    #[must_use]
    pub fn driven_by(&self, rate: &BodyRate) -> (Vec<f64>, Vec<f64>) {
        let mut free = vec![0.0; self.problem.unknowns()];
        let action = &rate.action;
        self.interfaces[rate.body].add_displacement(action, &action.free_displacement, &mut free);
        let groundings: Vec<_> = self.bodies.iter().map(CondensedBody::grounding).collect();
        let load = |body| match body == rate.body {
            true => action.load.as_slice(),
            false => &[],
        };
        let loads: Vec<&[f64]> = (0..self.bodies.len()).map(load).collect();
        let mut load = mode_loads(&groundings, &loads);
        load.resize(self.problem.free_modes(), 0.0);
        (free, load)
    }

    /// Change of every displacement of every body, in metre, with reactions and motions that change by these; one
    /// pair of substitutions per body.
    #[must_use]
    pub fn recover_rate(
        &self,
        rate: Option<&BodyRate>,
        reaction: &[f64],
        motion: &[f64],
    ) -> Vec<Vec<f64>> {
        let mut motions = motion;
        let bodies = self.bodies.iter().zip(self.interfaces.iter()).enumerate();
        bodies
            .map(|(index, (body, interface))| {
                let (own, rest) = motions.split_at(body.grounding().modes.ncols());
                motions = rest;
                let forces = interface.forces(reaction);
                match rate.filter(|rate| rate.body == index) {
                    Some(rate) => body.factored.recover(&rate.action, &forces, own),
                    None => body.factored.recover(&unloaded(body), &forces, own),
                }
            })
            .collect()
    }
}

/// What holds a body, and does not move.
fn at_rest(body: &CondensedBody) -> Given {
    match body.dependence() {
        Some(tied) => Given::of(tied, |_| false),
        None => {
            let given = body.action.prescribed.iter();
            Given {
                prescribed: given.map(|given| given.map(|_| 0.0)).collect(),
                ..Given::default()
            }
        }
    }
}

/// Nothing acts on a body.
fn unloaded(body: &CondensedBody) -> Action {
    let Given { prescribed, values } = at_rest(body);
    Action {
        load: vec![0.0; body.action.load.len()],
        prescribed,
        values,
        constant: Vec::new(),
        half_solved: vec![0.0; body.action.half_solved.len()],
        free_displacement: Vec::new(),
    }
}
