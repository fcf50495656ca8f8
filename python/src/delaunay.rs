//! `taut.delaunay` and `taut.spatial_order`, behind their Python signatures.

use pyo3::prelude::*;
use taut::certify::OrderCurve;
use taut::delaunay::Error;
use taut::{DelaunayOptions, InsertionOrder, delaunay_of_source, spatial_order as ordered};

use crate::choice::choice;
use crate::found::{Found, solve};
use crate::numbers::whole;
use crate::work::refused;

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
        order: choice("order", order, InsertionOrder::NAMES)?,
        threads: whole("threads", threads, "1 to 1024, or None")?,
        seed: whole("seed", seed, "0 to 2**64 - 1")?,
        ..DelaunayOptions::default()
    };
    solve(py, rows, |source, monitor| delaunay_of_source(source, &options, monitor), raise)
}

/// The rows of an array in the order of a curve through them.
#[pyfunction]
pub(crate) fn spatial_order(
    py: Python<'_>,
    rows: &Bound<'_, PyAny>,
    curve: &str,
) -> PyResult<Found> {
    let curve = choice("curve", curve, OrderCurve::NAMES)?;
    solve(py, rows, |source, monitor| ordered(source, curve, monitor), raise)
}

fn raise(error: Error, _: usize) -> PyErr {
    refused(&error, matches!(error, Error::Read(_) | Error::Cancelled(_)))
}
