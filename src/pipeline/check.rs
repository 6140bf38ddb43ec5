//! What a scene holds, without solving it: all that a solve would refuse before it begins is refused
//! here.

use crate::body;
use crate::body::Support;
use crate::condensation::{Driven, Estimate, Precision, RigidBodies, dense_bytes, estimate};
use crate::contact::ContactSurface;
use crate::error::Error;
use crate::scene::{LoadHistory, Mechanics, Scene};

/// A scene that is fit to be solved.
#[derive(Debug)]
pub struct Checked {
    /// Bodies, pairs and history.
    pub mechanics: Mechanics,
    /// The contacts.
    pub surface: ContactSurface,
    /// Rigid motions per body that only contact holds.
    pub free_modes: Vec<usize>,
    /// What the condensed problem takes of the memory, in bytes.
    pub dense_bytes: usize,
    /// What the solve will take, by the pattern of the factors.
    pub estimate: Estimate,
}

/// Reads a scene and its meshes and finds its contacts.
///
/// # Errors
///
/// Whatever is wrong with the scene, in the words of [`solve`](super::solve()), and load steps whose
/// factors set supports against each other at an instant.
pub fn check(scene: &Scene) -> Result<Checked, Error> {
    let mechanics = scene.mechanics()?;
    checked(mechanics).map_err(|error| scene.locate(error))
}

fn checked(mechanics: Mechanics) -> Result<Checked, Error> {
    let bodies = &mechanics.bodies;
    let rigid = RigidBodies::new(bodies, &mechanics.contacts, &mechanics.rigid_bodies)?;
    let dense_bytes = dense_bytes(rigid.surface())?;
    check_supports(&mechanics)?;
    let once = mechanics.history.instants().is_empty() && mechanics.rigid_bodies.is_empty();
    let precision = if once {
        Precision::Single
    } else {
        Precision::Double
    };
    let free_modes = bodies.iter().map(|body| {
        let prescribed = body::prescribed(body)?;
        Ok(body::free_modes(body, &prescribed).modes.len())
    });
    Ok(Checked {
        free_modes: free_modes.collect::<Result<_, Error>>()?,
        dense_bytes,
        estimate: estimate(bodies, rigid.surface(), precision)?,
        surface: rigid.into_surface(),
        mechanics,
    })
}

/// Refuses supports that contradict each other at an instant.
fn check_supports(mechanics: &Mechanics) -> Result<(), Error> {
    let history = &mechanics.history;
    for (index, body) in mechanics.bodies.iter().enumerate() {
        let stated = body.supports.len() + body.ties.len();
        if stated < 2 || !moves(history, index) {
            continue;
        }
        let tied = body::dependence(body)?;
        for &at in history.instants() {
            if let Some(tied) = &tied {
                tied.check(&tied.values(|by| history.factor(index, by, at)))?;
                continue;
            }
            let supports = supports_at(history, at, index, &body.supports);
            let (axes, nodes) = (body.mesh.dimension, body.mesh.nodes.len());
            body::prescribed_by(&supports, axes, nodes)?;
        }
    }
    Ok(())
}

/// The history has a factor for a support of the body.
fn moves(history: &LoadHistory, of: usize) -> bool {
    let driven = history.driven();
    let mut supports = driven.iter();
    supports.any(|driven| match driven {
        Driven::Support { body, .. } | Driven::Motion { body, .. } => *body == of,
        Driven::Load { .. } | Driven::Rigid { .. } => false,
    })
}

fn supports_at(history: &LoadHistory, at: f64, of: usize, stated: &[Support]) -> Vec<Support> {
    let mut supports = stated.to_vec();
    for (driven, factor) in history.driven().into_iter().zip(history.factors(at)) {
        if let Driven::Support { body, index } = driven
            && body == of
        {
            supports[index] = stated[index].scaled(factor);
        }
    }
    supports
}
