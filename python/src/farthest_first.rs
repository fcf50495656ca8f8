//! `taut.farthest_first`, behind its Python signature.

use pyo3::prelude::*;
use taut::{FarthestFirstOptions, Items};

use crate::items::raise;
use crate::numbers::whole;
use crate::object::plain;
use crate::rows::Rows;
use crate::work::interruptible;

/// The rows of an array in farthest-first order, the radii, and the row that would come next.
#[pyfunction]
pub(crate) fn farthest_first<'py>(
    py: Python<'py>,
    rows: &Bound<'py, PyAny>,
    count: &Bound<'py, PyAny>,
    start: &Bound<'py, PyAny>,
    threads: &Bound<'py, PyAny>,
) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>, Option<u64>)> {
    let count: u64 = whole("count", count, "at least 1")?;
    let options = FarthestFirstOptions {
        start: whole("start", start, "the number of a row, from 0")?,
        threads: whole("threads", threads, "1 to 1024, or None")?,
        ..FarthestFirstOptions::default()
    };
    let rows = Rows::borrow(rows)?;
    let source = rows.source()?;
    let found = interruptible(py, |monitor| {
        taut::farthest_first(
            source.as_ref(),
            count,
            &FarthestFirstOptions { monitor: *monitor, ..options },
        )
    })?
    .map_err(|error| raise(error, Items::Points, source.dim()))?;
    Ok((plain(py, &found.order)?, plain(py, &found.radii)?, found.next))
}
