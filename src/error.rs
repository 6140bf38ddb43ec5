//! What can be wrong with an input, and how it is said.
//!
//! An error names the place, the value and what is accepted. Outcomes of a solve
//! that did run (not converged, no equilibrium) are a
//! [`Status`](crate::Status), never an error.

/// Why an input cannot be solved.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A number lies outside its accepted range.
    #[error("{place}: {value} is not accepted; expected {accepted}")]
    OutOfRange {
        /// Where the number stands, such as `bodies[0].materials[1].poisson`.
        place: String,
        /// The offending number.
        value: f64,
        /// The accepted range in words, such as `-1 < poisson < 0.5`.
        accepted: &'static str,
    },

    /// A NaN or an infinity.
    #[error("{place}: {value} is not a finite number")]
    NotFinite {
        /// Where the number stands.
        place: String,
        /// NaN or an infinity.
        value: f64,
    },

    /// Two arrays that belong together differ in length.
    #[error("{place}: expected {expected} entries, found {found}")]
    Length {
        /// Name of the array.
        place: String,
        /// Length it must have.
        expected: usize,
        /// Length it has.
        found: usize,
    },

    /// The operator of a bare problem is not symmetric.
    #[error(
        "operator[{row}][{column}] differs from operator[{column}][{row}] by {violation:e} \
         (largest entry {largest:e}); expected a symmetric matrix"
    )]
    NotSymmetric {
        /// Row of the first violation.
        row: usize,
        /// Its column.
        column: usize,
        /// Difference of the two entries, in m/N.
        violation: f64,
        /// Largest entry of the operator, in m/N.
        largest: f64,
    },

    /// A file could not be written.
    #[error("{path}: cannot be written: {reason}")]
    Write {
        /// The file.
        path: String,
        /// What the system says.
        reason: String,
    },
}

/// Refuses NaN and infinities, naming the first entry that holds one.
pub(crate) fn check_finite(place: &str, values: &[f64]) -> Result<(), Error> {
    match values.iter().position(|x| !x.is_finite()) {
        None => Ok(()),
        Some(at) => Err(Error::NotFinite {
            place: format!("{place}[{at}]"),
            value: values[at],
        }),
    }
}

/// Refuses an array of the wrong length.
pub(crate) fn check_length(place: &str, expected: usize, found: usize) -> Result<(), Error> {
    if expected == found {
        return Ok(());
    }
    Err(Error::Length {
        place: place.to_owned(),
        expected,
        found,
    })
}
