//! `taut.bounding_dop`, behind its Python signature.

use pyo3::prelude::*;
use taut::enclose::DopOptions;

use crate::found::{Found, solve_points};
use crate::numbers::whole;

/// The bounding k-dop of the points that are the rows of an array.
#[pyfunction]
pub(crate) fn bounding_dop(
    py: Python<'_>,
    rows: &Bound<'_, PyAny>,
    directions: &Bound<'_, PyAny>,
) -> PyResult<Found> {
    let directions = whole("directions", directions, "6, 14, 18 or 26")?;
    solve_points(py, rows, |source, monitor| {
        taut::enclose::bounding_dop(source, &DopOptions { directions, monitor: *monitor })
    })
}
