//! Ranges of arguments.

use crate::error::Error;

/// The value, if it is positive and finite.
pub(super) fn positive(place: &str, value: f64) -> Result<f64, Error> {
    within(
        place,
        value,
        value > 0.0 && value.is_finite(),
        "a finite number > 0",
    )
}

/// The value, if it is not negative and finite.
pub(super) fn not_negative(place: &str, value: f64) -> Result<f64, Error> {
    within(
        place,
        value,
        value >= 0.0 && value.is_finite(),
        "a finite number >= 0",
    )
}

/// The value, if it is accepted.
pub(super) fn within(
    place: &str,
    value: f64,
    accept: bool,
    accepted: &'static str,
) -> Result<f64, Error> {
    if accept {
        return Ok(value);
    }
    let place = place.to_owned();
    Err(Error::OutOfRange {
        place,
        value,
        accepted,
    })
}
