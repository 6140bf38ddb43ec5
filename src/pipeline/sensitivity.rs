//! Derivatives of a solved state with respect to what its scene states.

use super::Solution;
use super::quantities::{Drive as Quantity, Quantities};
use crate::alternation::{Centred, Drive, Linearised, Rate, Sides, Status};
use crate::condensation::{BodyRate, Driven};
use crate::error::Error;
use crate::report::{Moved, Sensitivity, derivatives};

/// What a parameter changes before contacts answer.
struct Parameter {
    name: String,
    drive: Drive,
    body: Option<BodyRate>,
    /// Motion of the other side per contact, in metre; none at all where no rigid body is given one.
    sides: Vec<[f64; 3]>,
}

impl Solution {
    /// Derivatives of the totals with respect to friction, gaps, factors of loads and supports, motions of
    /// obstacles (named as in [`Variation`](super::Variation)) and a factor on the moduli of each
    /// body (`bodies[0].young`), all from one factorisation of the contacts' Newton matrix (D16). None for a
    /// solution without certificate.
    ///
    /// ```
    /// use dpana::{Scene, solve};
    ///
    /// # fn main() -> Result<(), dpana::Error> {
    /// // A block on a floor is dragged along: T = μ N.
    /// let scene = r#"{
    ///     "bodies": [{ "mesh": { "rectangle": { "x": [0, 2], "y": [0, 1], "cells": [8, 4] } },
    ///                  "model": "plane_strain",
    ///                  "materials": [{ "young": 1000, "poisson": 0 }],
    ///                  "supports": [{ "group": "top", "displacement": [0.5, -0.01] }] }],
    ///     "contacts": [{ "group": "bottom", "friction": 0.25,
    ///                    "obstacle": { "plane": { "point": [0, 0], "normal": [0, 1] } } }] }"#;
    /// let solution = solve(&Scene::from_json(scene, "")?)?;
    /// let (normal, all) = (solution.report()?.totals.normal, solution.sensitivities()?);
    /// let all = all.unwrap_or_default();
    /// let friction = all.iter().find(|one| one.parameter == "friction").unwrap();
    /// let (pull, press) = (friction.of("friction_x").unwrap(), friction.of("normal").unwrap());
    /// // dT/dμ = N + μ dN/dμ.
    /// assert!((pull + normal + 0.25 * press).abs() < 1e-9 * normal);
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// Friction of contacts that were stated without any is no parameter.
    ///
    /// # Errors
    ///
    /// [`Error::NotAccepted`] for a state of a load history, which depends on all that came before.
    pub fn sensitivities(&self) -> Result<Option<Vec<Sensitivity>>, Error> {
        let single = self.setup.pairs.len() == 1;
        // Of one pair alone they say what `friction` and `gap` say.
        let again = |name: &str| {
            single
                && ["friction", "gap"]
                    .iter()
                    .any(|of| name == format!("contacts[0].{of}"))
        };
        self.all(|name| !again(name))
    }

    /// The same with respect to one parameter; none also where there is no such one.
    ///
    /// # Errors
    ///
    /// Those of [`sensitivities`](Self::sensitivities).
    pub fn sensitivity(&self, parameter: &str) -> Result<Option<Sensitivity>, Error> {
        let all = self.all(|name| name == parameter)?;
        Ok(all.and_then(|mut all| all.pop()))
    }

    fn all(&self, wanted: impl Fn(&str) -> bool) -> Result<Option<Vec<Sensitivity>>, Error> {
        self.with_parts(|parts| {
            self.each_rate(wanted, |parameter, sides| {
                let moved = sides.map(|rate| match self.slip_needs_bodies() {
                    true => Moved {
                        displacements: self.recovered(parameter, &rate),
                        sides: self.sides_moved(parameter, &rate),
                        rate,
                    },
                    false => Moved {
                        displacements: Vec::new(),
                        sides: Vec::new(),
                        rate,
                    },
                });
                Sensitivity {
                    parameter: parameter.name.clone(),
                    derivatives: derivatives(parts, &moved),
                }
            })
        })
    }

    /// Derivative of the displacement of every body with respect to a parameter of
    /// [`sensitivities`](Self::sensitivities): per body and unknown (`node · dimension + axis`), in metre
    /// per unit.
    ///
    /// # Errors
    ///
    /// Those of [`sensitivities`](Self::sensitivities).
    pub fn displacement_rates(
        &self,
        parameter: &str,
    ) -> Result<Option<Sides<Vec<Vec<f64>>>>, Error> {
        let all = self.each_rate(
            |name| name == parameter,
            |parameter, sides| sides.map(|rate| self.recovered(parameter, &rate)),
        );
        Ok(all?.and_then(|mut all| all.pop()))
    }

    fn recovered(&self, parameter: &Parameter, rate: &Rate) -> Vec<Vec<f64>> {
        let condensed = self.most_precise();
        condensed.recover_rate(parameter.body.as_ref(), &rate.reaction, &rate.motion)
    }

    /// How the other side of every contact moves with its rigid body; none at all where there is none.
    fn sides_moved(&self, parameter: &Parameter, rate: &Rate) -> Vec<[f64; 3]> {
        let found = self.setup.condensed.found_sides(&rate.motion);
        if found.is_empty() || parameter.sides.is_empty() {
            return if found.is_empty() {
                parameter.sides.clone()
            } else {
                found
            };
        }
        let both = found.iter().zip(&parameter.sides);
        both.map(|(a, b)| std::array::from_fn(|k| a[k] + b[k]))
            .collect()
    }

    /// Whether the contact problem does not tell how all contacts slide: those without friction hold no tangents.
    fn slip_needs_bodies(&self) -> bool {
        let dimension = self
            .setup
            .bodies
            .first()
            .map_or(3, |body| body.mesh.dimension);
        let mut nodes = self.setup.condensed.surface().nodes.iter();
        nodes.any(|node| node.tangents + 1 < dimension)
    }

    fn each_rate<T>(
        &self,
        wanted: impl Fn(&str) -> bool,
        take: impl Fn(&Parameter, Sides<Rate>) -> T,
    ) -> Result<Option<Vec<T>>, Error> {
        if self.step.is_some() {
            return Err(Error::NotAccepted {
                place: "steps".to_owned(),
                found: "a load history".to_owned(),
                accepted: "a scene without steps, as derivatives of a history are not traced"
                    .to_owned(),
            });
        }
        if self.status() != Status::Certified {
            return Ok(None);
        }
        let problem = self.precise()?.problem();
        let centred = Centred::new(problem)?;
        let Some(mut laws) = Linearised::new(&centred, &self.outcome)? else {
            return Ok(None);
        };
        let mut all = Vec::new();
        for parameter in self.parameters(wanted)? {
            let sides = laws.along(&parameter.drive)?;
            all.extend(sides.map(|sides| take(&parameter, sides)));
        }
        Ok(Some(all))
    }

    fn parameters(&self, wanted: impl Fn(&str) -> bool) -> Result<Vec<Parameter>, Error> {
        let (bodies, pairs) = (&self.setup.bodies, &self.setup.pairs);
        let mut all = Vec::new();
        let quantities = Quantities::new(bodies, pairs, self.setup.condensed.rigid_bodies());
        for (name, quantity) in quantities.all().filter(|(name, _)| wanted(name)) {
            all.extend(self.parameter(name, quantity)?);
        }
        for (index, body) in bodies.iter().enumerate() {
            let name = format!("bodies[{index}].young");
            if !wanted(&name) {
                continue;
            }
            let condensed = self.most_precise();
            let rate = condensed.rate_of_young(index, body, &self.displacements[index]);
            all.push(Parameter {
                name,
                drive: self.driven_by(&rate),
                body: Some(rate),
                sides: Vec::new(),
            });
        }
        Ok(all)
    }

    /// What a unit of a quantity changes; none of friction where contacts have no tangent for it.
    fn parameter(&self, name: &str, quantity: &Quantity) -> Result<Option<Parameter>, Error> {
        let condensed = self.most_precise();
        let (problem, nodes) = (condensed.problem(), &condensed.surface().nodes);
        let mut parameter = Parameter {
            name: name.to_owned(),
            drive: Drive::none(problem),
            body: None,
            sides: Vec::new(),
        };
        let drive = &mut parameter.drive;
        let blocks = nodes.iter().zip(problem.blocks());
        match quantity {
            Quantity::Friction(pairs) => {
                for (k, (contact, block)) in blocks.enumerate() {
                    if pairs.contains(&contact.pair) {
                        if block.len() < 2 {
                            return Ok(None);
                        }
                        drive.friction[k] = 1.0;
                    }
                }
            }
            Quantity::Gap(pairs) => {
                for (contact, block) in blocks {
                    if pairs.contains(&contact.pair) {
                        drive.beyond[block.start] = -1.0;
                    }
                }
            }
            Quantity::Obstacle(pair, axis) => {
                drive.beyond = condensed.rate_of_obstacle(*pair, *axis);
                let mut obstacles = vec![[0.0; 3]; pair + 1];
                obstacles[*pair][*axis] = 1.0;
                parameter.sides = condensed.surface().obstacle_motions(&obstacles);
            }
            Quantity::Factor(Driven::Rigid { body, component }) => {
                let rate = condensed.rate_of_rigid(*body, *component);
                (drive.beyond, drive.load) = (rate.beyond, rate.load);
                parameter.sides = rate.sides;
            }
            Quantity::Factor(driven) => {
                let rate = condensed.rate_of(&self.setup.stated, *driven)?;
                parameter.drive = self.driven_by(&rate);
                parameter.body = Some(rate);
            }
        }
        Ok(Some(parameter))
    }

    fn driven_by(&self, rate: &BodyRate) -> Drive {
        let condensed = self.most_precise();
        let (beyond, load) = condensed.driven_by(rate);
        Drive {
            beyond,
            load,
            ..Drive::none(condensed.problem())
        }
    }
}
