//! `taut.delaunay`, behind its Python signature.

use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use taut::certify::AnySolution;
use taut::delaunay::Error;
use taut::{DelaunayOptions, InsertionOrder, delaunay_of_source};

use crate::numbers::whole;
use crate::rows::Rows;
use crate::solution::Solution;
use crate::work::interruptible;

/// The Delaunay triangulation of the rows of an array.
#[pyfunction]
pub(crate) fn delaunay(
    py: Python<'_>,
    rows: &Bound<'_, PyAny>,
    order: &str,
    threads: &Bound<'_, PyAny>,
    seed: &Bound<'_, PyAny>,
) -> PyResult<Solution> {
    let known = InsertionOrder::NAMES.iter().find(|(name, _)| *name == order);
    let options = DelaunayOptions {
        order: known.map(|(_, order)| *order).ok_or_else(|| {
            let names = InsertionOrder::NAMES.map(|(name, _)| name).join(", ");
            PyValueError::new_err(format!("option `order` is {order:?}: expected one of {names}"))
        })?,
        threads: whole("threads", threads, "1 to 1024, or None")?,
        seed: whole("seed", seed, "0 to 2**64 - 1")?,
        ..DelaunayOptions::default()
    };
    let rows = Rows::borrow(rows)?;
    let source = rows.source()?;
    let found =
        interruptible(py, |monitor| delaunay_of_source(source.as_ref(), &options, monitor))?
            .map_err(raise)?;
    Solution::new(py, AnySolution::Triangulation(found))
}

/// A wrong input is a `ValueError` with the library's sentence.
fn raise(error: Error) -> PyErr {
    match error {
        Error::Read(_) | Error::Cancelled(_) => PyRuntimeError::new_err(error.to_string()),
        _ => PyValueError::new_err(error.to_string()),
    }
}
