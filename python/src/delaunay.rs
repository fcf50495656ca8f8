//! `taut.delaunay` and `taut.spatial_order`, behind their Python signatures.

use pyo3::prelude::*;
use taut::{DelaunayOptions, OrderOptions};

use crate::choice::choice;
use crate::found::{Found, solve_points};
use crate::numbers::whole;

/// The Delaunay triangulation of the rows of an array.
#[pyfunction]
pub(crate) fn delaunay(
    py: Python<'_>,
    rows: &Bound<'_, PyAny>,
    order: &str,
    threads: &Bound<'_, PyAny>,
    seed: &Bound<'_, PyAny>,
) -> PyResult<Found> {
    let options = DelaunayOptions {
        order: choice("order", order)?,
        threads: whole("threads", threads, "1 to 1024, or None")?,
        seed: whole("seed", seed, "0 to 2**64 - 1")?,
        ..DelaunayOptions::default()
    };
    solve_points(py, rows, |source, monitor| {
        taut::delaunay(source, &DelaunayOptions { monitor: *monitor, ..options })
    })
}

/// The rows of an array in the order of a curve through them.
#[pyfunction]
pub(crate) fn spatial_order(
    py: Python<'_>,
    rows: &Bound<'_, PyAny>,
    curve: &str,
) -> PyResult<Found> {
    let curve = choice("curve", curve)?;
    let options = OrderOptions { curve, ..OrderOptions::default() };
    solve_points(py, rows, |source, monitor| {
        taut::spatial_order(source, &OrderOptions { monitor: *monitor, ..options })
    })
}
