//! What is wrong with an input, as Python raises it: the words are the crate's.

use pyo3::PyErr;
use pyo3::create_exception;
use pyo3::exceptions::PyValueError;

create_exception!(
    dpana,
    Error,
    PyValueError,
    "An input that cannot be solved: place, value, what is accepted."
);

/// The exception of an error.
pub(super) fn refused(error: dpana::Error) -> PyErr {
    Error::new_err(error.to_string())
}
