//! `taut.farthest_first`, behind its Python signature, and its order as Python sees it.

use numpy::PyArray1;
use pyo3::prelude::*;
use taut::{FarthestFirstOptions, Items, farthest_first_of_source};

use crate::items::raise;
use crate::numbers::whole;
use crate::rows::{Rows, numbers};
use crate::solution::row_numbers;
use crate::work::interruptible;

/// The rows of an array in farthest-first order.
#[pyfunction]
pub(crate) fn farthest_first(
    py: Python<'_>,
    rows: &Bound<'_, PyAny>,
    count: &Bound<'_, PyAny>,
    start: &Bound<'_, PyAny>,
    threads: &Bound<'_, PyAny>,
) -> PyResult<FarthestFirst> {
    let count: u64 = whole("count", count, "at least 1")?;
    let options = FarthestFirstOptions {
        start: whole("start", start, "the number of a row, from 0")?,
        threads: whole("threads", threads, "1 to 1024, or None")?,
    };
    let rows = Rows::borrow(rows)?;
    let source = rows.source()?;
    let found = interruptible(py, |monitor| {
        farthest_first_of_source(source.as_ref(), count, &options, monitor)
    })?
    .map_err(|error| raise(error, Items::Points, source.dim()))?;
    Ok(FarthestFirst {
        order: row_numbers(py, &found.order)?,
        radii: numbers(py, found.radii)?,
        next: found.next,
    })
}

/// Points in farthest-first order, and how far the others are from each beginning of it.
///
/// Attributes
/// ----------
/// order : ndarray of int64, shape (m,)
///     Row numbers, each that of the point farthest from all before it; fewer than asked for where all other points are
///     copies of these. Read-only.
/// radii : ndarray of float64, shape (m,)
///     ``radii[k - 1]`` is the largest distance of a point to the nearest of the first k. No k balls of a radius below
///     its half hold all points. Read-only.
/// next : int or None
///     The row that would come next.
#[pyclass(frozen, get_all, module = "taut")]
pub(crate) struct FarthestFirst {
    order: Py<PyArray1<i64>>,
    radii: Py<PyArray1<f64>>,
    next: Option<u64>,
}

#[pymethods]
impl FarthestFirst {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        Ok(format!("FarthestFirst(order=<{} rows>)", self.order.bind(py).len()?))
    }
}
