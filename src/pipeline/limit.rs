//! The limit pipeline: scene → rigid bodies → cone programs → judge.

use crate::body::{Body, Load};
use crate::condensation::RigidBodies;
use crate::contact::ContactPair;
use crate::error::Error;
use crate::limit::{LeastFriction, Limit, RigidContacts};
use crate::report::{Beyond, Limits, LoadLimit};
use crate::scene::{Mechanics, Scene};
use crate::{body, kkt, report};

/// The judge believes reactions that leave less than this open, relative to them.
const HOLDS: f64 = 1e-9;

/// Beyond the limit by this part, reactions of more than a thousand times the load would be needed.
const BEYOND: (f64, f64) = (1e-6, 1e3);

/// By what factor each load of a scene can grow, the others held, before nothing holds the bodies
/// that supports leave free; and how much friction the loads take.
///
/// Bodies count as rigid here: no stiffness is factorised. Contacts that are open before
/// loading count as if they could close.
///
/// ```
/// use dpana::report::Beyond;
/// use dpana::{Scene, limit};
///
/// # fn main() -> Result<(), dpana::Error> {
/// // A loose block of weight 10 N on a floor with μ = 0.3, pushed by 1 N.
/// let scene = r#"{
///     "bodies": [{ "mesh": { "rectangle": { "x": [0, 2], "y": [0, 1], "cells": [4, 2] } },
///                  "model": "plane_strain",
///                  "materials": [{ "young": 1000, "poisson": 0.3 }],
///                  "loads": [{ "body_force": [0, -5] }, { "group": "left", "traction": [1, 0] }] }],
///     "contacts": [{ "group": "bottom", "friction": 0.3,
///                    "obstacle": { "plane": { "point": [0, 0], "normal": [0, 1] } } }] }"#;
/// let limits = limit(&Scene::from_json(scene, "")?)?;
/// let Beyond::Grows { factor, certified, .. } = limits.loads[1].beyond else {
///     panic!("friction holds no load without end");
/// };
/// assert!(certified && (factor - 3.0).abs() < 1e-6);
/// # Ok(())
/// # }
/// ```
///
/// # Errors
///
/// Whatever is wrong with the scene, a scene with load steps, and one whose supports hold every body.
pub fn limit(scene: &Scene) -> Result<Limits, Error> {
    let Mechanics {
        bodies,
        contacts: pairs,
        history,
        ..
    } = scene.mechanics()?;
    if !history.instants().is_empty() {
        return Err(scene.locate(Error::NotAccepted {
            place: "steps".to_owned(),
            found: "a load history".to_owned(),
            accepted: "a scene without steps, whose loads act as they stand".to_owned(),
        }));
    }
    limits(&scene.title, &bodies, &pairs).map_err(|error| scene.locate(error))
}

fn limits(title: &str, bodies: &[Body], pairs: &[ContactPair]) -> Result<Limits, Error> {
    let rigid = RigidBodies::new(bodies, pairs)?;
    let modes = rigid.modes();
    if modes.ncols() == 0 {
        return Err(Error::NotAccepted {
            place: "bodies".to_owned(),
            found: "supports that hold every body".to_owned(),
            accepted: "a body that only contact holds, as supports carry any load".to_owned(),
        });
    }
    let nodes = &rigid.surface().nodes;
    let tangents: Vec<usize> = nodes.iter().map(|contact| contact.tangents).collect();
    let friction = nodes.iter().map(|contact| pairs[contact.pair].friction);
    let case = Case {
        bodies,
        contacts: RigidContacts::new(&tangents, friction.collect(), modes)?,
        rigid,
    };
    let forces: Vec<_> = bodies.iter().map(body::load_vector).collect();
    let total = case.rigid.load(&forces);
    let mut loads = Vec::new();
    for (index, body) in bodies.iter().enumerate() {
        for (number, load) in body.loads.iter().enumerate() {
            // Heat and initial stress are in equilibrium with themselves.
            if load.stresses() {
                continue;
            }
            let growing = case.alone(index, load);
            if growing.iter().any(|e| *e != 0.0) {
                let fixed: Vec<f64> = total.iter().zip(&growing).map(|(t, g)| t - g).collect();
                let beyond = case.beyond(&fixed, &growing)?;
                loads.push(LoadLimit {
                    place: format!("bodies[{index}].loads[{number}]"),
                    body: body.name.clone(),
                    kind: kind(load),
                    beyond,
                });
            }
        }
    }
    let least_friction = case.least_friction(&total, pairs)?;
    Ok(Limits {
        title: title.to_owned(),
        loads,
        least_friction,
    })
}

fn kind(load: &Load) -> &'static str {
    match load {
        Load::Pressure { .. } => "pressure",
        Load::Traction { .. } => "traction",
        Load::BodyForce { .. } => "body_force",
        Load::PointForce { .. } => "point_force",
        Load::VaryingPressure { .. } => "pressure",
        Load::VaryingTraction { .. } => "traction",
        Load::Spread { .. } | Load::AtReference { .. } => "force",
        Load::Gravity { .. } => "gravity",
        Load::Centrifugal { .. } => "centrifugal",
        Load::Temperature { .. } => "temperature",
        Load::InitialStress { .. } => "initial_stress",
    }
}

/// The scene as rigid bodies.
struct Case<'a> {
    bodies: &'a [Body],
    rigid: RigidBodies,
    contacts: RigidContacts,
}

impl Case<'_> {
    /// Work of one load alone on every free mode.
    fn alone(&self, index: usize, load: &Load) -> Vec<f64> {
        let forces = self.bodies.iter().enumerate().map(|(k, body)| {
            if k == index {
                body::nodal_forces(body, std::slice::from_ref(load))
            } else {
                Vec::new()
            }
        });
        self.rigid.load(&forces.collect::<Vec<_>>())
    }

    fn beyond(&self, fixed: &[f64], growing: &[f64]) -> Result<Beyond, Error> {
        Ok(match self.contacts.limit(fixed, growing)? {
            Limit::Finite {
                factor,
                motion,
                reaction,
            } => {
                let at = |factor: f64| -> Vec<f64> {
                    let pairs = fixed.iter().zip(growing);
                    pairs.map(|(f, g)| f + factor * g).collect()
                };
                let step = if factor > 0.0 { factor } else { 1.0 };
                Beyond::Grows {
                    factor,
                    motions: self.motions(&motion),
                    certified: self.holds(&at(factor), &reaction)?
                        && self.fails(&at(factor + BEYOND.0 * step), &motion)?,
                }
            }
            Limit::Unbounded => Beyond::Unbounded,
            Limit::Never { motion, excess } => Beyond::Never {
                motions: self.motions(&motion),
                missing: excess,
            },
            Limit::Undecided => Beyond::Undecided,
        })
    }

    fn least_friction(
        &self,
        load: &[f64],
        pairs: &[ContactPair],
    ) -> Result<report::ReportedLeastFriction, Error> {
        Ok(match self.contacts.least_friction(load)? {
            LeastFriction::Multiple {
                multiple, motion, ..
            } => {
                let first = pairs.first().map_or(0.0, |pair| pair.friction);
                let uniform = pairs.iter().all(|pair| pair.friction == first);
                report::ReportedLeastFriction::Multiple {
                    multiple,
                    coefficient: uniform.then_some(multiple * first),
                    motions: motion.map_or_else(Vec::new, |motion| self.motions(&motion)),
                }
            }
            LeastFriction::Never { motion, excess } => report::ReportedLeastFriction::Never {
                motions: self.motions(&motion),
                missing: excess,
            },
            LeastFriction::Undecided => report::ReportedLeastFriction::Undecided,
        })
    }

    /// How the bodies begin to move, in words and numbers.
    fn motions(&self, motion: &[f64]) -> Vec<report::ReportedMotion> {
        let apparent = self.contacts.failure(motion);
        let parts = self.rigid.motions(&apparent.motion);
        let opens_only = apparent.sliding.is_empty() && !apparent.opening.is_empty();
        report::motions(self.bodies, &parts, !opens_only)
    }

    fn holds(&self, load: &[f64], reaction: &[f64]) -> Result<bool, Error> {
        let (offsets, friction) = (self.contacts.offsets(), self.contacts.friction());
        let held = kkt::held(offsets, friction, self.contacts.modes(), load, reaction)?;
        Ok(held.equilibrium.scaled <= HOLDS && held.excess.scaled <= HOLDS)
    }

    fn fails(&self, load: &[f64], motion: &[f64]) -> Result<bool, Error> {
        let (offsets, friction) = (self.contacts.offsets(), self.contacts.friction());
        let proof = kkt::impossibility(offsets, friction, self.contacts.modes(), load, motion)?;
        let size = load.iter().fold(0.0, |size: f64, e| size.hypot(*e));
        Ok(proof.least_reaction > BEYOND.1 * size)
    }
}
