//! A surface that may touch itself.

use crate::body::{Body, Facet};
use crate::contact::facing_itself;
use crate::error::Error;

/// The two sides on which facets of a body meet each other within a distance, in metre.
pub(super) fn two_sides(
    place: &str,
    body: &Body,
    facets: Vec<Facet>,
    distance: f64,
) -> Result<[Vec<Facet>; 2], Error> {
    if !(distance > 0.0 && distance.is_finite()) {
        return Err(Error::OutOfRange {
            place: place.to_owned(),
            value: distance,
            accepted: "0 < distance < infinity",
        });
    }
    let refuse = |found: String, accepted: &str| {
        Err(Error::NotAccepted {
            place: place.to_owned(),
            found,
            accepted: accepted.to_owned(),
        })
    };
    match facing_itself(body, facets, distance) {
        Some([first, _]) if first.is_empty() => refuse(
            format!("{distance}, within which no facet of the group faces another one"),
            "a distance as large as the gap that closes",
        ),
        Some(sides) => Ok(sides),
        None => refuse(
            format!("{distance}, within which facets face each other all around"),
            "a smaller distance, or a group of two walls that face each other",
        ),
    }
}
