//! What is given of bodies before they are condensed, and in which precision they can be.

use super::engine::Engine;
use super::factor::Precision;
use super::interface::Interface;
use crate::body;
use crate::body::{Body, Dependence};
use crate::contact::ContactSurface;
use crate::error::Error;

/// Prescribed displacement per body and degree of freedom, in metre.
pub(super) type Prescribed = Vec<Vec<Option<f64>>>;

/// What is given of a body: prescribed displacements, what depends on what, and its side of the contacts.
pub(super) type GivenBody = (Vec<Option<f64>>, Option<Dependence>, Interface);

/// What is given of every body.
pub(super) fn given(
    bodies: &[Body],
    surface: &ContactSurface,
    prescribed: Prescribed,
    engine: Engine,
) -> Result<Vec<GivenBody>, Error> {
    let bodies = bodies.iter().zip(prescribed).enumerate();
    let of_one = |(index, (body, prescribed)): (usize, (&Body, Vec<_>))| {
        let tied = body::dependence(body)?;
        let dimension = body.mesh.dimension;
        let held = (&prescribed[..], tied.as_ref());
        let interface = match engine {
            Engine::Faer => Interface::new(surface, index, dimension, held),
            Engine::Mumps => Interface::bordered(surface, index, dimension, held),
        };
        Ok((prescribed, tied, interface))
    };
    bodies.map(of_one).collect()
}

/// Single precision only of bodies that (C24) can set right.
pub(super) fn possible(wanted: Precision, bodies: &[Body], given: &[GivenBody]) -> Precision {
    let held = |(body, (prescribed, _, interface)): (&Body, &GivenBody)| {
        interface.border.is_empty() && body::free_modes(body, prescribed).modes.is_empty()
    };
    match wanted {
        Precision::Single if bodies.iter().zip(given).all(held) => Precision::Single,
        _ => Precision::Double,
    }
}

/// Checks bodies; what their supports prescribe.
pub(super) fn checked(bodies: &[Body]) -> Result<Prescribed, Error> {
    let of_one = |body| {
        body::check(body)?;
        body::prescribed(body)
    };
    bodies.iter().map(of_one).collect()
}
