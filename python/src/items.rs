//! The kinds of rows of an array, and what is wrong with one of them, in the words of somebody who gave centers, radii
//! and shapes in arrays of their own.

use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use taut::certify::{CentersViolation, Violation};
use taut::enclose::{Error as Refused, SearchError};
use taut::points::{InputError, shown_number};
use taut::{Error, Items};

use crate::choice::choice;

/// Returns the kind of the inputs, by its name in JSON.
pub(crate) fn items_of_name(name: &str) -> PyResult<Items> {
    choice("items", name)
}

/// Returns what a solver refused: what is wrong with the input is a `ValueError`. `columns` is the length of a row.
pub(crate) fn raise(error: impl Into<Error>, items: Items, columns: usize) -> PyErr {
    let error = error.into();
    match error {
        Error::Input(InputError::NonFinite { row, column, value }) if items != Items::Points => {
            PyValueError::new_err(not_finite(items, row, column, value, items.dim(columns)))
        }
        Error::Input(ref input) if !input.is_fault_of_caller() => {
            PyRuntimeError::new_err(error.to_string())
        }
        Error::Enclose(Refused::NegativeRadius { row, value })
        | Error::Search(SearchError::NegativeRadius { row, value }) => {
            PyValueError::new_err(negative_radius(row, value))
        }
        Error::Enclose(Refused::NonPositiveWeight { row, value }) => {
            PyValueError::new_err(weight(row, value))
        }
        Error::Enclose(Refused::Conic { .. }) => PyRuntimeError::new_err(error.to_string()),
        error => PyValueError::new_err(error.to_string()),
    }
}

/// Returns what a checker found.
pub(crate) fn words(violation: Violation, items: Items, columns: usize) -> String {
    match (violation, items) {
        (Violation::NonFinite { row, column, value }, Items::Balls | Items::Ellipsoids) => {
            not_finite(items, row, column, value, items.dim(columns))
        }
        (Violation::NegativeRadius { row, value }, _) => negative_radius(row, value),
        (Violation::Centers(CentersViolation::Weight { row, value }), _) => weight(row, value),
        (other, _) => other.to_string(),
    }
}

fn not_finite(items: Items, row: u64, column: usize, value: f64, dim: usize) -> String {
    let item = if items == Items::Balls { "ball" } else { "ellipsoid" };
    if column < dim {
        return format!(
            "coordinate {column} of the center of {item} {row} is {value}: all coordinates must be finite"
        );
    }
    if items == Items::Balls {
        return format!("the radius of ball {row} is {value}: all radii must be finite");
    }
    // Entries of the lower triangle, row by row.
    let at = column - dim;
    let j = (0..dim).take_while(|j| j * (j + 1) / 2 <= at).count().saturating_sub(1);
    let k = at - j * (j + 1) / 2;
    format!("entry ({j}, {k}) of shape {row} is {value}: all entries must be finite")
}

fn negative_radius(row: u64, value: f64) -> String {
    format!("the radius of ball {row} is {}: all radii must be at least 0", shown_number(value))
}

/// A weight that is NaN, infinite or not above 0.
pub(crate) fn weight(row: u64, value: f64) -> String {
    let expected = if value.is_finite() { "more than 0" } else { "finite" };
    format!("the weight of point {row} is {}: all weights must be {expected}", shown_number(value))
}
