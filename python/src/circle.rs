//! `taut.inscribed_circle`, behind its Python signature.

use pyo3::prelude::*;
use taut::{CircleOptions, Items};

use crate::found::{Found, solve};
use crate::items::raise;
use crate::numbers::whole;

/// The largest circle in the polygon whose rings are the rows of an array.
#[pyfunction]
pub(crate) fn inscribed_circle(
    py: Python<'_>,
    rows: &Bound<'_, PyAny>,
    epsilon: f64,
    max_cells: &Bound<'_, PyAny>,
) -> PyResult<Found> {
    let max_cells = whole("max_cells", max_cells, "at least 1")?;
    solve(
        py,
        rows,
        |source, monitor| {
            let options = CircleOptions { epsilon, max_cells, monitor: *monitor };
            taut::inscribed_circle(source, &options)
        },
        |error, columns| raise(error, Items::Points, columns),
    )
}
