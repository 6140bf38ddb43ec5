//! Arrays in and out; matrices in rows.

use dpana::faer::{Mat, MatRef};
use numpy::{
    AllowTypeChange, Element, PyArray1, PyArray2, PyArrayLike1, PyArrayLike2, PyArrayMethods,
};
use pyo3::prelude::*;

use super::error::Error;

/// Numbers as a list, an array of any kind of number, or what else NumPy takes.
pub(super) type Numbers<'py> = PyArrayLike1<'py, f64, AllowTypeChange>;
/// Rows of numbers.
pub(super) type Rows<'py> = PyArrayLike2<'py, f64, AllowTypeChange>;

pub(super) fn numbers(stated: &Numbers<'_>) -> Vec<f64> {
    stated.as_array().iter().copied().collect()
}

pub(super) fn matrix(stated: &Rows<'_>) -> Mat<f64> {
    let stated = stated.as_array();
    Mat::from_fn(stated.nrows(), stated.ncols(), |row, column| {
        stated[(row, column)]
    })
}

/// Whole numbers from 0, such as those of nodes.
pub(super) fn indices<'a>(
    place: &str,
    stated: impl Iterator<Item = &'a f64>,
) -> PyResult<Vec<usize>> {
    let whole = |&number: &f64| match number >= 0.0 && number.fract() == 0.0 {
        true => Ok(number as usize),
        false => Err(Error::new_err(format!(
            "{place}: {number} is not accepted; expected whole numbers >= 0"
        ))),
    };
    stated.map(whole).collect()
}

pub(super) fn column<T: Element>(
    py: Python<'_>,
    values: impl IntoIterator<Item = T>,
) -> Bound<'_, PyArray1<T>> {
    PyArray1::from_vec(py, values.into_iter().collect())
}

/// Rows of `width` numbers, one after the other.
pub(super) fn rows<'py, T: Element>(
    py: Python<'py>,
    values: impl IntoIterator<Item = T>,
    width: usize,
) -> PyResult<Bound<'py, PyArray2<T>>> {
    let values: Vec<T> = values.into_iter().collect();
    let count = values.len() / width.max(1);
    PyArray1::from_vec(py, values).reshape([count, width])
}

pub(super) fn of_matrix<'py>(
    py: Python<'py>,
    matrix: MatRef<'_, f64>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let entries = (0..matrix.nrows()).flat_map(|i| (0..matrix.ncols()).map(move |j| (i, j)));
    rows(py, entries.map(|at| matrix[at]), matrix.ncols())
}
