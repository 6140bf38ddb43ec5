//! What a condensation will take, from the pattern of its factors: nothing is factorised.

use super::condensed::supported;
use super::interface::Interface;
use super::room::dense_bytes;
use crate::body;
use crate::body::Body;
use crate::contact::ContactSurface;
use crate::error::Error;

/// What a scene will take.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Estimate {
    /// Unknowns of the supported bodies.
    pub unknowns: usize,
    /// Contacts.
    pub contacts: usize,
    /// Stored entries of the sparse factors.
    pub factor_entries: usize,
    /// What factors and dense matrices take of the memory, in bytes.
    pub bytes: usize,
    /// Multiplications, each with an addition.
    pub operations: f64,
}

/// Orders the bodies and counts what their factors and the dense operator will take.
///
/// # Errors
///
/// Those of [`Condensed::new`](super::Condensed::new), short of what only the factor shows.
pub(crate) fn estimate(bodies: &[Body], surface: &ContactSurface) -> Result<Estimate, Error> {
    let dense = dense_bytes(surface)?;
    let mut found = Estimate {
        contacts: surface.nodes.len(),
        ..Estimate::default()
    };
    let mut condensed = 0;
    for (index, body) in bodies.iter().enumerate() {
        let prescribed = body::prescribed(body)?;
        let dependence = body::dependence(body)?;
        let given = (&prescribed[..], dependence.as_ref());
        let interface = Interface::new(surface, index, body.mesh.dimension, given);
        let work = supported(body, (prescribed, dependence), &interface).count(&interface)?;
        found.unknowns += work.unknowns;
        found.factor_entries += work.entries;
        found.operations += work.operations;
        condensed += work.condensed;
    }
    found.bytes = dense + 8 * found.factor_entries;
    // Triangular inverses and products for G, and the factors of a Newton finish: n³/3 each.
    found.operations += 2.0 * (condensed as f64).powi(3);
    Ok(found)
}
