//! Refusal of numbers that are out of range.

use crate::error::Error;

/// Refuses a number unless it is `good`; `accepted` says in words what would be.
pub(super) fn check_range(
    place: impl Into<String>,
    value: f64,
    good: bool,
    accepted: &'static str,
) -> Result<(), Error> {
    match good {
        true => Ok(()),
        false => Err(Error::OutOfRange {
            place: place.into(),
            value,
            accepted,
        }),
    }
}
