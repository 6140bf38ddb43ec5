//! What a condensation will take, from the pattern of its factors: nothing is factorised.

use super::condensed::supported;
use super::engine::Engine;
use super::factor::Precision;
use super::given::{given, possible};
use super::room::dense_bytes;
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

/// Orders the bodies and counts what their factors, in the precision that is wanted where it can be, and the dense
/// operator will take.
///
/// # Errors
///
/// Those of [`Condensed::new`](super::Condensed::new), short of what only the factor shows.
pub(crate) fn estimate(
    bodies: &[Body],
    surface: &ContactSurface,
    wanted: Precision,
) -> Result<Estimate, Error> {
    let dense = dense_bytes(surface)?;
    let mut found = Estimate {
        contacts: surface.nodes.len(),
        ..Estimate::default()
    };
    let (mut condensed, mut factors) = (0, 0);
    let prescribed = bodies.iter().map(crate::body::prescribed);
    let prescribed = prescribed.collect::<Result<_, _>>()?;
    let given = given(bodies, surface, prescribed, Engine::Faer)?;
    let precision = possible(wanted, bodies, &given);
    for (body, (prescribed, dependence, interface)) in bodies.iter().zip(given) {
        let supported = supported(body, (prescribed, dependence), &interface);
        let work = supported.count(&interface, precision)?;
        found.unknowns += work.unknowns;
        found.factor_entries += work.entries;
        found.operations += work.operations;
        factors += work.entries * work.precision.bytes();
        condensed += work.condensed;
    }
    found.bytes = dense + factors;
    // Triangular inverses and products for G, and the factors of a Newton finish: n³/3 each.
    found.operations += 2.0 * (condensed as f64).powi(3);
    Ok(found)
}
