//! `taut.inscribed_ellipse`, behind its Python signature.

use pyo3::prelude::*;
use taut::Items;
use taut::inscribe::EllipseOptions;

use crate::found::{Found, solve};
use crate::items::raise;
use crate::numbers::whole;

/// The largest ellipse in the polygon whose rings are the rows of an array.
#[pyfunction]
pub(crate) fn inscribed_ellipse(
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
            let options = EllipseOptions {
                epsilon,
                max_cells,
                monitor: *monitor,
                ..EllipseOptions::default()
            };
            taut::inscribe::inscribed_ellipse(source, &options)
        },
        |error, columns| raise(error, Items::Points, columns),
    )
}
