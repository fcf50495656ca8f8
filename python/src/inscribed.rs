//! `taut.inscribed_ellipsoid`, behind its Python signature.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use taut::enclose::Error;
use taut::points::InputError;
use taut::{InscribedOptions, Items};

use crate::found::{Found, solve};
use crate::items::raise;
use crate::numbers::whole;

/// The ellipsoid of largest volume in the polytope whose half-spaces are the rows of an array.
#[pyfunction]
pub(crate) fn inscribed_ellipsoid(
    py: Python<'_>,
    rows: &Bound<'_, PyAny>,
    epsilon: f64,
    max_steps: &Bound<'_, PyAny>,
) -> PyResult<Found> {
    let options = InscribedOptions {
        epsilon,
        max_steps: whole("max_steps", max_steps, "at least 1")?,
        ..InscribedOptions::default()
    };
    solve(
        py,
        rows,
        |source, monitor| {
            taut::inscribed_ellipsoid(source, &InscribedOptions { monitor: *monitor, ..options })
        },
        refused,
    )
}

/// Returns what is wrong with a half-space, in the words of somebody who gave normals and offsets.
fn refused(error: Error, columns: usize) -> PyErr {
    match error {
        Error::Input(InputError::NonFinite { row, column, value }) => {
            let place = match column + 1 == columns {
                true => format!("offset {row}"),
                false => format!("coordinate {column} of normal {row}"),
            };
            PyValueError::new_err(format!("{place} is {value}: all numbers must be finite"))
        }
        Error::Empty => {
            PyValueError::new_err("there are no half-spaces: a polytope is made of at least two")
        }
        other => raise(other, Items::Points, columns),
    }
}
