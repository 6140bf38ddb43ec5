//! The limit pipeline: scene → rigid bodies → cone programs → judge; scene → its state → elastic limits.

use super::{Setup, solve_steps};
use crate::alternation::{Outcome, Status};
use crate::body::{Body, Load};
use crate::condensation::{Driven, RigidBodies, Superposition};
use crate::contact::{ContactPair, RigidBody};
use crate::error::Error;
use crate::limit::{LeastFriction, Limit, RigidContacts};
use crate::report::{Beyond, Limits, LoadLimit, ReportedElasticLimit};
use crate::scene::{LoadHistory, Mechanics, Scene};
use crate::trust::{ElasticLimit, LimitStart, elastic_limit};
use crate::{body, condensation, kkt, report};

/// The judge believes reactions that leave less than this open, relative to them.
const HOLDS: f64 = 1e-9;

/// Beyond the limit by this part, reactions of more than a thousand times the load would be needed.
const BEYOND: (f64, f64) = (1e-6, 1e3);

/// By what factor each load of a scene can grow, the others held, before nothing holds the bodies
/// that supports leave free; and how much friction the loads take.
///
/// Two answers per load: of rigid bodies, an upper bound that needs no stiffness, and of the elastic ones, between
/// a factor whose state is certified and one at which nothing holds. Only elastic bodies say how hard an overlap presses.
/// A scene with load steps is solved to its end, and grows from there, with the slip so far.
///
/// ```
/// use dpana::{Scene, limit};
///
/// # fn main() -> Result<(), dpana::Error> {
/// // A block of 1 m between plates that squeeze it by 1 mm, pulled out with 1 N: rigid plates would squeeze without
/// // limit, the block pushes back with E · 1e-3 = 1 N/m on its 2 m. Friction of 0.3 on both sides holds 1.2 N.
/// let scene = r#"{
///     "bodies": [{ "mesh": { "rectangle": { "x": [0, 2], "y": [0, 1], "cells": [4, 2] } },
///                  "model": "plane_strain",
///                  "materials": [{ "young": 1000, "poisson": 0 }],
///                  "loads": [{ "body_force": [0.5, 0] }] }],
///     "contacts": [{ "group": "bottom", "friction": 0.3,
///                    "obstacle": { "plane": { "point": [0, 0], "normal": [0, 1] } } },
///                  { "group": "top", "friction": 0.3,
///                    "obstacle": { "plane": { "point": [0, 0.999], "normal": [0, -1] } } }] }"#;
/// let limits = limit(&Scene::from_json(scene, "")?)?;
/// let elastic = limits.loads[0].elastic.as_ref().unwrap();
/// let (held, fails) = (elastic.held.unwrap(), elastic.fails.unwrap());
/// assert!(held < 1.2 && 1.2 < fails && fails - held < 1e-5);
/// # Ok(())
/// # }
/// ```
///
/// # Errors
///
/// Whatever is wrong with the scene, a history that ends without a certified state, and a scene whose supports hold
/// every body.
pub fn limit(scene: &Scene) -> Result<Limits, Error> {
    limits(scene, true)
}

/// The same, of rigid bodies alone: no stiffness is factorised, and no history solved, whose loads act as at its end.
///
/// Contacts that are open before loading count as if they could close.
///
/// # Errors
///
/// Whatever is wrong with the scene, and one whose supports hold every body.
pub fn rigid_limit(scene: &Scene) -> Result<Limits, Error> {
    limits(scene, false)
}

fn limits(scene: &Scene, elastic: bool) -> Result<Limits, Error> {
    let at_scene = |error| scene.locate(error);
    let mut mechanics = scene.mechanics()?;
    let history = std::mem::take(&mut mechanics.history);
    let ends = Ends::of(&history);
    let bodies = ends.bodies(&mechanics.bodies);
    let pairs = mechanics.contacts.clone();
    let rigid_bodies = mechanics.rigid_bodies.clone();
    let case = Case::new(&bodies, &pairs, &rigid_bodies).map_err(at_scene)?;
    let total = case.total();
    let grown = case.grown();
    let mut elastic = match elastic && !grown.is_empty() {
        true => Some(Elastic::new(scene, mechanics, ends, &grown).map_err(at_scene)?),
        false => None,
    };
    let mut loads = Vec::new();
    for grown in &grown {
        let limit = case.limit_of(grown, &total, elastic.as_mut());
        loads.push(limit.map_err(at_scene)?);
    }
    Ok(Limits {
        title: scene.title.clone(),
        loads,
        least_friction: case.least_friction(&total, &pairs).map_err(at_scene)?,
    })
}

/// What drives a scene at its end.
struct Ends {
    driven: Vec<Driven>,
    factors: Vec<f64>,
}

impl Ends {
    /// Of a history; of a scene without one, whose loads act as they stand, nothing.
    fn of(history: &LoadHistory) -> Self {
        let last = history.instants().last();
        Self {
            driven: history.driven(),
            factors: last.map_or_else(Vec::new, |&last| history.factors(last)),
        }
    }

    /// Bodies under the loads that act at the end.
    fn bodies(&self, stated: &[Body]) -> Vec<Body> {
        let mut bodies = stated.to_vec();
        for (driven, factor) in self.driven.iter().zip(&self.factors) {
            if let Driven::Load { body, index } = *driven {
                let load = &mut bodies[body].loads[index];
                *load = load.scaled(*factor);
            }
        }
        bodies
    }

    /// The place of a load among what drives the scene.
    fn place(&mut self, driven: Driven) -> usize {
        let known = self.driven.iter().position(|known| *known == driven);
        known.unwrap_or_else(|| {
            self.driven.push(driven);
            self.factors.push(1.0);
            self.driven.len() - 1
        })
    }
}

/// A load that the free motions feel, and that grows alone.
struct Grown {
    driven: Driven,
    place: String,
    body: String,
    kind: &'static str,
    /// Its work on every free mode.
    work: Vec<f64>,
}

/// The elastic bodies in the scene's last state.
struct Elastic {
    setup: Setup,
    under: Superposition,
    ends: Ends,
    slip: Vec<f64>,
    /// Of a history.
    last: Option<Outcome>,
}

impl Elastic {
    fn new(
        scene: &Scene,
        mechanics: Mechanics,
        mut ends: Ends,
        grown: &[Grown],
    ) -> Result<Self, Error> {
        let stated = mechanics.bodies.clone();
        let steps = !ends.factors.is_empty();
        for load in grown {
            ends.place(load.driven);
        }
        let (mut setup, slip, last) = match steps {
            true => {
                let solution = solve_steps(scene, None, |_| Ok(()))?;
                let step = solution
                    .step()
                    .filter(|_| solution.status() == Status::Certified);
                let step = step.ok_or_else(|| Error::NotAccepted {
                    place: "steps".to_owned(),
                    found: "a history that ends without a certified state".to_owned(),
                    accepted: "one that is solved to its end, from where a load can grow"
                        .to_owned(),
                })?;
                let slip = step.slip().to_vec();
                (solution.setup.clone(), slip, Some(solution.outcome.clone()))
            }
            false => {
                let setup = Setup::new(scene, mechanics)?;
                let slip = vec![0.0; setup.condensed.problem().unknowns()];
                (setup, slip, None)
            }
        };
        Ok(Self {
            under: setup.condensed.superpose(&stated, &ends.driven)?,
            setup,
            ends,
            slip,
            last,
        })
    }

    /// Follows a load to its limit.
    fn limit(&mut self, load: &Grown, guess: Option<f64>) -> Result<ElasticLimit, Error> {
        let place = self.ends.place(load.driven);
        let condensed = &mut self.setup.condensed;
        let mut obstacles = self.setup.acting.obstacles.clone();
        obstacles.resize(self.setup.pairs.len(), [0.0; 3]);
        let mut with = |part: f64| {
            let mut factors = self.ends.factors.clone();
            factors[place] *= part;
            condensed.act(&self.under, &factors, &obstacles, &self.slip)?;
            Ok(condensed.problem().clone())
        };
        let (without, stated) = (with(0.0)?, with(1.0)?);
        let state = self.last.as_ref();
        let start = LimitStart {
            guess,
            state: state.map(|last| (&last.reaction[..], &last.motion[..])),
        };
        elastic_limit(&without, &stated, &self.setup.settings, start)
    }
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
    rigid_bodies: &'a [RigidBody],
    rigid: RigidBodies,
    contacts: RigidContacts,
}

impl<'a> Case<'a> {
    fn new(
        bodies: &'a [Body],
        pairs: &[ContactPair],
        rigid_bodies: &'a [RigidBody],
    ) -> Result<Self, Error> {
        if let Some(pair) = pairs.iter().find(|pair| !pair.law.is_coulomb()) {
            return Err(Error::NotAccepted {
                place: format!("{}.law", pair.place),
                found: pair.law.words(pair.friction).unwrap_or_default(),
                accepted: "Coulomb's law, whose cone limit analysis knows; `dpana solve` holds bodies by any law"
                    .to_owned(),
            });
        }
        let rigid = RigidBodies::new(bodies, pairs, rigid_bodies)?;
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
        let friction = condensation::friction(rigid.surface(), pairs);
        Ok(Self {
            bodies,
            rigid_bodies,
            contacts: RigidContacts::new(&tangents, friction, modes)?,
            rigid,
        })
    }

    /// Number of each rigid body and free component.
    fn on_rigid(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        let bodies = self.rigid_bodies.iter().enumerate();
        bodies.flat_map(|(body, of)| of.free().map(move |component| (body, component)))
    }

    /// Work of all loads on every free mode.
    fn total(&self) -> Vec<f64> {
        let forces: Vec<_> = self.bodies.iter().map(body::load_vector).collect();
        let mut total = self.rigid.load(&forces);
        for (body, component) in self.on_rigid() {
            let more = self.rigid.rigid_load(body, component);
            total.iter_mut().zip(more).for_each(|(e, more)| *e += more);
        }
        total
    }

    /// Every load that the free motions feel.
    fn grown(&self) -> Vec<Grown> {
        let mut grown = Vec::new();
        for (index, body) in self.bodies.iter().enumerate() {
            let loads = body.loads.iter().enumerate();
            // Heat and initial stress are in equilibrium with themselves.
            let loads = loads.filter(|(_, load)| !load.stresses());
            grown.extend(loads.map(|(number, load)| Grown {
                driven: Driven::Load {
                    body: index,
                    index: number,
                },
                place: format!("bodies[{index}].loads[{number}]"),
                body: body.name.clone(),
                kind: kind(load),
                work: self.alone(index, load),
            }));
        }
        let dimension = self.bodies.first().map_or(3, |body| body.mesh.dimension);
        grown.extend(self.on_rigid().map(|(index, component)| {
            let body = &self.rigid_bodies[index];
            Grown {
                driven: Driven::Rigid {
                    body: index,
                    component,
                },
                place: body.component_place(component, dimension),
                body: body.name.clone(),
                kind: if component < 3 { "force" } else { "moment" },
                work: self.rigid.rigid_load(index, component),
            }
        }));
        grown.retain(|load| load.work.iter().any(|e| *e != 0.0));
        grown
    }

    /// Both limits of a load.
    fn limit_of(
        &self,
        grown: &Grown,
        total: &[f64],
        elastic: Option<&mut Elastic>,
    ) -> Result<LoadLimit, Error> {
        let fixed: Vec<f64> = total.iter().zip(&grown.work).map(|(t, g)| t - g).collect();
        let beyond = self.beyond(&fixed, &grown.work)?;
        let guess = match &beyond {
            Beyond::Grows { factor, .. } => Some(*factor),
            _ => None,
        };
        let found = elastic
            .map(|elastic| elastic.limit(grown, guess))
            .transpose()?;
        Ok(LoadLimit {
            place: grown.place.clone(),
            body: grown.body.clone(),
            kind: grown.kind,
            beyond,
            elastic: found.map(|found| self.reported(found)),
        })
    }

    fn reported(&self, found: ElasticLimit) -> ReportedElasticLimit {
        let (fails, failure) = found.fails.unzip();
        ReportedElasticLimit {
            held: found.held,
            fails,
            motions: failure.map_or_else(Vec::new, |failure| self.motions(&failure.motion)),
        }
    }

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
                let mut one = pairs.iter();
                let uniform = one.all(|pair| pair.friction == first && pair.law.places.is_none());
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
        report::motions(
            &report::names(self.bodies, self.rigid_bodies),
            &parts,
            !opens_only,
        )
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
