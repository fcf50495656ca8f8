//! `taut.inscribed_ellipse`, behind its Python signature.

use pyo3::prelude::*;
use taut::Items;
use taut::inscribe::{EllipseMethod, EllipseOptions, EllipseThesisOptions};

use crate::choice::choice;
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
    method: &str,
    sample_count: &Bound<'_, PyAny>,
    fatness: f64,
    angle: f64,
    seed: &Bound<'_, PyAny>,
) -> PyResult<Found> {
    let max_cells = whole("max_cells", max_cells, "at least 1")?;
    let sample_count = whole("sample_count", sample_count, "a number from 12 to 1000")?;
    let seed = whole("seed", seed, "0 to 2**64 - 1")?;
    let thesis = EllipseThesisOptions { sample_count, fatness, angle, seed };
    let method = match choice("method", method)? {
        EllipseMethod::Thesis(_) => EllipseMethod::Thesis(thesis),
        EllipseMethod::FivePoint(_) => EllipseMethod::FivePoint(thesis),
        other => other,
    };
    solve(
        py,
        rows,
        |source, monitor| {
            let options = EllipseOptions { method, epsilon, max_cells, monitor: *monitor };
            taut::inscribe::inscribed_ellipse(source, &options)
        },
        |error, columns| raise(error, Items::Points, columns),
    )
}
