//! Loads and supports under factors: substitutions for each once, and none for any sum of them.
//!
//! ```text
//! (C15)  f = f₀ + Σ λ_k f_k,   u_p = u₀ + Σ λ_k u_k      λ_k: factor of a driven load or support
//!        y = y₀ + Σ λ_k y_k,   v̂ = v̂₀ + Σ λ_k v̂_k
//! ```

use super::Condensed;
use super::load_case::Action;
use crate::body;
use crate::body::{Body, Load, Support};
use crate::error::{Error, check_finite, check_length};

/// A load or a support, by the number of its body and its own there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Driven {
    /// A load.
    Load {
        /// Its body.
        body: usize,
        /// Its number among the body's loads.
        index: usize,
    },
    /// The given displacement of a support.
    Support {
        /// Its body.
        body: usize,
        /// Its number among the body's supports.
        index: usize,
    },
}

/// What acts on bodies as a function of factors (C15).
#[derive(Debug)]
pub struct Superposition {
    driven: Vec<Driven>,
    /// f₀, u₀ and their answers, per body.
    rest: Vec<Action>,
    /// f_k or u_k and its answer, per driven load or support.
    parts: Vec<Action>,
    supports: Vec<Vec<Support>>,
    dimension: usize,
}

impl Condensed {
    /// Prepares to [`act`](Self::act) on the bodies by factors: one pair of substitutions per driven
    /// load or support, and one per body that has any.
    ///
    /// `bodies` are those that were condensed, under loads and supports as they stand at factors
    /// of one.
    ///
    /// # Errors
    ///
    /// A number of bodies that does not fit, a load or support that there is not.
    pub fn superpose(
        &mut self,
        bodies: &[Body],
        driven: &[Driven],
    ) -> Result<Superposition, Error> {
        check_length("bodies", self.bodies.len(), bodies.len())?;
        driven.iter().try_for_each(|driven| driven.check(bodies))?;
        let mut rest = Vec::with_capacity(bodies.len());
        for (at, body) in bodies.iter().enumerate() {
            rest.push(match driven.iter().any(|driven| driven.body() == at) {
                false => self.bodies[at].action.clone(),
                true => self.answer(at, body, |acts| !driven.contains(&acts)),
            });
        }
        let mut parts = Vec::with_capacity(driven.len());
        for &part in driven {
            let at = part.body();
            parts.push(self.answer(at, &bodies[at], |acts| acts == part));
        }
        Ok(Superposition {
            driven: driven.to_vec(),
            rest,
            parts,
            supports: bodies.iter().map(|body| body.supports.clone()).collect(),
            dimension: bodies.first().map_or(3, |body| body.mesh.dimension),
        })
    }

    /// (C5) under those loads and given displacements of a body that act.
    fn answer(&mut self, at: usize, body: &Body, acts: impl Fn(Driven) -> bool) -> Action {
        self.work.substitutions += 1;
        self.answer_of(at, body, acts)
    }

    /// The same, not counted.
    pub(super) fn answer_of(
        &self,
        at: usize,
        body: &Body,
        acts: impl Fn(Driven) -> bool,
    ) -> Action {
        let loads = body.loads.iter().enumerate();
        let loads = loads.filter(|&(index, _)| acts(Driven::Load { body: at, index }));
        let loads: Vec<Load> = loads.map(|(_, load)| load.clone()).collect();
        let moves = |index| acts(Driven::Support { body: at, index });
        self.bodies[at].answer(
            body::nodal_forces(body, &loads),
            displacements_of(body, moves),
        )
    }
}

impl Superposition {
    /// What acts on every body under a factor per driven load or support.
    ///
    /// # Errors
    ///
    /// A number of factors that does not fit, a NaN or infinity, supports that contradict each
    /// other under these factors.
    pub(super) fn at(&self, factors: &[f64]) -> Result<Vec<Action>, Error> {
        check_length("factors", self.driven.len(), factors.len())?;
        check_finite("factors", factors)?;
        let mut supports = self.supports.clone();
        let mut actions = self.rest.clone();
        for ((driven, part), &factor) in self.driven.iter().zip(&self.parts).zip(factors) {
            actions[driven.body()].add(factor, part);
            if let Driven::Support { body, index } = *driven {
                supports[body][index] = supports[body][index].scaled(factor);
            }
        }
        for (action, supports) in actions.iter().zip(&supports) {
            check_finite("load", &action.load)?;
            let nodes = action.load.len() / self.dimension;
            body::prescribed_by(supports, self.dimension, nodes)?;
        }
        Ok(actions)
    }
}

impl Driven {
    pub(super) fn check(self, bodies: &[Body]) -> Result<(), Error> {
        let body = bodies.get(self.body());
        let (what, index, count) = match (self, body) {
            (_, None) => ("body", self.body(), bodies.len()),
            (Self::Load { index, .. }, Some(body)) => ("load", index, body.loads.len()),
            (Self::Support { index, .. }, Some(body)) => ("support", index, body.supports.len()),
        };
        match index < count {
            true => Ok(()),
            false => Err(Error::UnknownIndex {
                place: "driven".to_owned(),
                what,
                index,
                count,
            }),
        }
    }

    pub(super) fn body(self) -> usize {
        match self {
            Self::Load { body, .. } | Self::Support { body, .. } => body,
        }
    }
}

/// Given displacements with only the supports that `moves` names away from zero. Of several
/// supports that hold one unknown the first counts: all others agree with it.
fn displacements_of(body: &Body, moves: impl Fn(usize) -> bool) -> Vec<Option<f64>> {
    let axes = body.mesh.dimension;
    let mut prescribed = vec![None; axes * body.mesh.nodes.len()];
    for (index, support) in body.supports.iter().enumerate() {
        for (at, node) in support.nodes.iter().enumerate() {
            let of_node = &mut prescribed[axes * node..axes * (node + 1)];
            for (held, value) in of_node.iter_mut().zip(support.given(at)) {
                if let (None, Some(value)) = (&held, value) {
                    *held = Some(if moves(index) { value } else { 0.0 });
                }
            }
        }
    }
    for unknown in body::held_by_axis(body) {
        prescribed[unknown] = Some(0.0);
    }
    prescribed
}
