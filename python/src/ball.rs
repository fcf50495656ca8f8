//! `taut.ball` and `taut.ball_of_balls`, behind their Python signatures.

use std::str::FromStr;

use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use taut::certify::AnySolution;
use taut::enclose::Error;
use taut::{BallMethod, BallOptions, Items, ball_of_source};

use crate::numbers::whole;
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
        max_passes: whole(
            "max_passes",
            max_passes,
            "at least 3, and 4 for the methods of the thesis",
        )?,
        threads: whole("threads", threads, "at least 1, or None")?,
        seed: whole("seed", seed, "0 to 2**64 - 1")?,
    };
    let items = if balls { Items::Balls } else { Items::Points };
    let rows = Rows::borrow(rows)?;
    let source = rows.source()?;
    let found =
        interruptible(py, |monitor| ball_of_source(source.as_ref(), items, &options, monitor))?
            .map_err(|error| match balls {
                false => raise(error),
                true => raise_of_balls(error, source.dim() - 1),
            })?;
    Solution::new(py, AnySolution::Ball(found))
}

/// As `raise`, in the words of somebody who gave centres of dimension `dim` and radii in two arrays.
fn raise_of_balls(error: Error, dim: usize) -> PyErr {
    match error {
        Error::NonFinite { row, column, value } => {
            PyValueError::new_err(not_finite_of_ball(row, column, value, dim))
        }
        Error::NegativeRadius { row, value } => PyValueError::new_err(negative_radius(row, value)),
        other => raise(other),
    }
}

/// What is wrong in a row of a centre of dimension `dim` and a radius.
pub(crate) fn not_finite_of_ball(row: u64, column: usize, value: f64, dim: usize) -> String {
    if column == dim {
        format!("the radius of ball {row} is {value}: all radii must be finite")
    } else {
        format!(
            "coordinate {column} of the center of ball {row} is {value}: all coordinates must be finite"
        )
    }
}

pub(crate) fn negative_radius(row: u64, value: f64) -> String {
    format!("the radius of ball {row} is {value}: all radii must be at least 0")
}

/// A wrong input is a `ValueError` with the library's sentence.
fn raise(error: Error) -> PyErr {
    match error {
        Error::Read(_) | Error::Conic { .. } => PyRuntimeError::new_err(error.to_string()),
        _ => PyValueError::new_err(error.to_string()),
    }
}
