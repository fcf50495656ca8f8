//! `taut.inscribed_triangle`, behind its Python signature.

use pyo3::prelude::*;
use taut::Items;
use taut::inscribe::TriangleOptions;

use crate::found::{Found, solve};
use crate::items::raise;
use crate::numbers::whole;

/// The largest triangle in the polygon whose rings are the rows of an array.
#[pyfunction]
pub(crate) fn inscribed_triangle(
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
            let options = TriangleOptions {
                epsilon,
                max_cells,
                monitor: *monitor,
                ..TriangleOptions::default()
            };
            taut::inscribe::inscribed_triangle(source, &options)
        },
        |error, columns| raise(error, Items::Points, columns),
    )
}
