//! Loads and supports under factors: substitutions for each once, and none for any sum of them.
//!
//! ```text
//! (C15)  f = f₀ + Σ λ_k f_k,   u_p = u₀ + Σ λ_k u_k      λ_k: factor of a driven load or support
//!        y = y₀ + Σ λ_k y_k,   v̂ = v̂₀ + Σ λ_k v̂_k
//! ```

use super::Condensed;
use super::load_case::{Action, Given};
use crate::body;
use crate::body::{Body, Load, Source, Support};
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
    /// What is given of a component of a rigid body: its motion, or the force on it.
    Rigid {
        /// Number of the rigid body.
        body: usize,
        /// Number of the component.
        component: usize,
    },
    /// The given motion of a rigid group.
    Motion {
        /// Its body.
        body: usize,
        /// Its number among the body's ties.
        index: usize,
    },
}

/// What acts on bodies as a function of factors (C15).
#[derive(Debug)]
pub struct Superposition {
    driven: Vec<Driven>,
    /// f₀, u₀ and their answers, per body.
    rest: Vec<Action>,
    /// f_k or u_k and its answer, per driven load or support; none of a rigid body.
    parts: Vec<Option<Action>>,
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
        let rigid = self.carried.bodies().len();
        (driven.iter()).try_for_each(|driven| driven.check(bodies, rigid))?;
        let mut rest = Vec::with_capacity(bodies.len());
        for (at, body) in bodies.iter().enumerate() {
            rest.push(
                match driven.iter().any(|driven| driven.body() == Some(at)) {
                    false => self.bodies[at].action.clone(),
                    true => self.answer(at, body, |acts| !driven.contains(&acts)),
                },
            );
        }
        let mut parts = Vec::with_capacity(driven.len());
        for &part in driven {
            let answer = |at: usize| self.answer(at, &bodies[at], |acts| acts == part);
            parts.push(part.body().map(answer));
        }
        Ok(Superposition {
            driven: driven.to_vec(),
            rest,
            parts,
            supports: bodies.iter().map(stated).collect(),
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
        let given = match self.bodies[at].dependence() {
            Some(tied) => Given::of(tied, |by| match by {
                Source::Axis => false,
                Source::Support(index) => moves(index),
                Source::Tie(index) => acts(Driven::Motion { body: at, index }),
            }),
            None => Given {
                prescribed: displacements_of(body, moves),
                ..Given::default()
            },
        };
        self.bodies[at].answer(body::nodal_forces(body, &loads), given)
    }
}

impl Superposition {
    /// What has a factor.
    pub(super) fn driven(&self) -> &[Driven] {
        &self.driven
    }

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
            if let (Some(body), Some(part)) = (driven.body(), part) {
                actions[body].add(factor, part);
            }
            if let Driven::Support { body, index } = *driven
                && let Some(support) = supports[body].get_mut(index)
            {
                *support = support.scaled(factor);
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

/// The supports that can contradict each other unknown by unknown.
fn stated(body: &Body) -> Vec<Support> {
    match body.is_tied() {
        true => Vec::new(),
        false => body.supports.clone(),
    }
}

impl Driven {
    pub(super) fn check(self, bodies: &[Body], rigid: usize) -> Result<(), Error> {
        let (what, index, count) = match self {
            Self::Rigid { body, .. } => ("rigid body", body, rigid),
            Self::Load { body, index } => match bodies.get(body) {
                None => ("body", body, bodies.len()),
                Some(of_body) => ("load", index, of_body.loads.len()),
            },
            Self::Support { body, index } => match bodies.get(body) {
                None => ("body", body, bodies.len()),
                Some(of_body) => ("support", index, of_body.supports.len()),
            },
            Self::Motion { body, index } => match bodies.get(body) {
                None => ("body", body, bodies.len()),
                Some(of_body) => ("tie", index, of_body.ties.len()),
            },
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

    /// The elastic body that it acts on.
    pub(super) fn body(self) -> Option<usize> {
        match self {
            Self::Load { body, .. } | Self::Support { body, .. } | Self::Motion { body, .. } => {
                Some(body)
            }
            Self::Rigid { .. } => None,
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
