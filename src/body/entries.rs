//! Numbers and indices that a body names.

use super::Body;
use crate::error::{Error, check_finite};

/// Refuses a component out of the plane of a plane body, and one that is not finite.
pub(super) fn check_vector(
    body: &Body,
    place: impl Fn() -> String,
    components: &[f64; 3],
) -> Result<(), Error> {
    if components.iter().any(|x| !x.is_finite()) {
        return check_finite(&place(), components);
    }
    if body.mesh.dimension == 2 && components[2] != 0.0 {
        return Err(Error::OutOfRange {
            place: format!("{}[2]", place()),
            value: components[2],
            accepted: "0, for the body is plane",
        });
    }
    Ok(())
}

pub(super) fn check_indices(
    place: impl Fn() -> String,
    what: &'static str,
    indices: &[usize],
    count: usize,
) -> Result<(), Error> {
    match indices.iter().find(|index| **index >= count) {
        None => Ok(()),
        Some(index) => Err(Error::UnknownIndex {
            place: place(),
            what,
            index: *index,
            count,
        }),
    }
}
