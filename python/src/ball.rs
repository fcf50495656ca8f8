//! `taut.ball` and `taut.ball_of_balls`, behind their Python signatures.

use std::str::FromStr;

use pyo3::exceptions::{PyOverflowError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use taut::certify::AnySolution;
use taut::enclose::Error;
use taut::{BallMethod, BallOptions, Items, ball_of_source};

use crate::rows::Rows;
use crate::solution::Solution;
use crate::work::interruptible;

/// The smallest ball around the rows of an array; `balls` says that the last column holds radii.
#[pyfunction]
pub(crate) fn ball(
    py: Python<'_>,
    rows: &Bound<'_, PyAny>,
    balls: bool,
    epsilon: f64,
    method: &str,
    batch: &Bound<'_, PyAny>,
    max_passes: &Bound<'_, PyAny>,
    threads: &Bound<'_, PyAny>,
    seed: &Bound<'_, PyAny>,
) -> PyResult<Solution> {
    let options = BallOptions {
        epsilon,
        method: BallMethod::from_str(method).map_err(raise)?,
        batch: whole("batch", batch, "at least 1, or None")?,
        max_passes: whole("max_passes", max_passes, "at least 2: one to look, one to prove")?,
        threads: whole("threads", threads, "at least 1, or None")?,
        seed: whole("seed", seed, "0 to 2**64 - 1")?,
    };
    let items = if balls { Items::Balls } else { Items::Points };
    let rows = Rows::borrow(rows)?;
    let source = rows.source()?;
    let found =
        interruptible(py, |monitor| ball_of_source(source.as_ref(), items, &options, monitor))?
            .map_err(raise)?;
    Solution::new(py, AnySolution::Ball(found))
}

/// Reads a whole number; one that is too small or too large gets the message of a wrong option.
pub(crate) fn whole<'py, T: FromPyObjectOwned<'py>>(
    name: &'static str,
    value: &Bound<'py, PyAny>,
    expected: &'static str,
) -> PyResult<T> {
    value.extract::<T>().map_err(|error| {
        let error: PyErr = error.into();
        if error.is_instance_of::<PyOverflowError>(value.py()) {
            raise(Error::Option { name, value: value.to_string(), expected })
        } else {
            error
        }
    })
}

/// A wrong input is a `ValueError` with the library's sentence.
fn raise(error: Error) -> PyErr {
    match error {
        Error::Read(_) | Error::Conic { .. } => PyRuntimeError::new_err(error.to_string()),
        _ => PyValueError::new_err(error.to_string()),
    }
}
