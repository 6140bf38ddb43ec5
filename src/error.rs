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

    /// Something other than a number is not accepted where it stands.
    #[error("{place}: {found} is not accepted; expected {accepted}")]
    NotAccepted {
        /// Where it stands, such as `contacts[0].obstacle`.
        place: String,
        /// What stands there.
        found: String,
        /// What is accepted, in words.
        accepted: String,
    },

    /// A name that nothing carries.
    #[error(
        "{place}: there is no {what} `{name}`{}; expected {}",
        did_you_mean(nearest),
        listed(known)
    )]
    UnknownName {
        /// Where the name stands, such as `contacts[0].group`.
        place: String,
        /// What the name should stand for, such as `group`.
        what: &'static str,
        /// The name.
        name: String,
        /// The known name that is spelt most alike.
        nearest: Option<String>,
        /// All known names.
        known: Vec<String>,
    },

    /// No single node stands at a given position.
    #[error(
        "{place}: no node at {position:?}; the nearest is node {node} at {found:?}, {distance:e} \
         away; expected at most {tolerance:e}"
    )]
    NoNodeAt {
        /// Where the position stands, such as `bodies[0].supports[1].at`.
        place: String,
        /// The position, in metre.
        position: [f64; 3],
        /// The nearest node.
        node: usize,
        /// Its position, in metre.
        found: [f64; 3],
        /// Its distance, in metre.
        distance: f64,
        /// Largest distance accepted, in metre.
        tolerance: f64,
    },

    /// A scene's text is not JSON, or not a scene.
    #[error("{file}:{line}:{column}: {place}: {reason}")]
    Json {
        /// File name.
        file: String,
        /// Line, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
        /// Path inside the file, such as `bodies[0].materials[1].poisson`.
        place: String,
        /// What is wrong and what is accepted.
        reason: String,
    },

    /// A mesh file cannot be read as a mesh.
    #[error("{file}:{line}: {reason}")]
    Mesh {
        /// File name.
        file: String,
        /// Line, from 1.
        line: usize,
        /// What is wrong and what is accepted.
        reason: String,
    },

    /// A file cannot be read.
    #[error("{place}: cannot read the file {file}: {reason}")]
    Unreadable {
        /// What the file should hold, such as `scene` or `bodies[0].mesh.file`.
        place: String,
        /// File name.
        file: String,
        /// The system's reason.
        reason: String,
    },

    /// Any other variant, with the larger place that it happened in.
    #[error("{place}: {error}")]
    Within {
        /// Such as the scene's file, or the group of a load.
        place: String,
        /// What is wrong there.
        error: Box<Error>,
    },
}

impl Error {
    /// Puts a larger place in front.
    pub(crate) fn within(self, place: impl std::fmt::Display) -> Self {
        Self::Within {
            place: place.to_string(),
            error: Box::new(self),
        }
    }
}

fn did_you_mean(nearest: &Option<String>) -> String {
    nearest
        .as_ref()
        .map(|name| format!(" (did you mean `{name}`?)"))
        .unwrap_or_default()
}

fn listed(known: &[String]) -> String {
    if known.is_empty() {
        return "none, as there are none".to_owned();
    }
    format!("one of `{}`", known.join("`, `"))
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
