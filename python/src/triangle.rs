//! `taut.inscribed_triangle`, behind its Python signature.

use pyo3::prelude::*;
use taut::Items;
use taut::inscribe::{TriangleMethod, TriangleOptions, TriangleThesisOptions};

use crate::choice::choice;
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
    method: &str,
    sample_count: &Bound<'_, PyAny>,
    seed: &Bound<'_, PyAny>,
) -> PyResult<Found> {
    let max_cells = whole("max_cells", max_cells, "at least 1")?;
    let sample_count = whole("sample_count", sample_count, "a number from 3 to 4096")?;
    let seed = whole("seed", seed, "0 to 2**64 - 1")?;
    let thesis = TriangleThesisOptions { sample_count, seed };
    let method = match choice("method", method)? {
        TriangleMethod::Thesis(_) => TriangleMethod::Thesis(thesis),
        other => other,
    };
    solve(
        py,
        rows,
        |source, monitor| {
            let options = TriangleOptions { method, epsilon, max_cells, monitor: *monitor };
            taut::inscribe::inscribed_triangle(source, &options)
        },
        |error, columns| raise(error, Items::Points, columns),
    )
}
