//! `taut.delaunay` and `taut.spatial_order`, behind their Python signatures.

use pyo3::prelude::*;
use taut::{DelaunayOptions, Items, OrderOptions};

use crate::choice::choice;
use crate::found::{Found, solve};
use crate::items::raise;
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
    solve(
        py,
        rows,
        |source, monitor| taut::delaunay(source, &DelaunayOptions { monitor: *monitor, ..options }),
        |error, columns| raise(error, Items::Points, columns),
    )
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
    solve(
        py,
        rows,
        |source, monitor| {
            taut::spatial_order(source, &OrderOptions { monitor: *monitor, ..options })
        },
        |error, columns| raise(error, Items::Points, columns),
    )
}
