//! `taut.ellipsoid` and `taut.ellipsoids`, behind their Python signatures, and what is inside of an ellipsoid.

use numpy::PyArray1;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use taut::certify::Ellipsoid;
use taut::points::{Blocks, ReadError, Scratch};
use taut::{EllipsoidMethod, EllipsoidOptions, Items, PointSource};

use crate::found::{Found, solve};
use crate::items::{items_of_name, raise};
use crate::numbers::whole;
use crate::rows::Rows;
use crate::work::interruptible;

/// The ellipsoid of least volume around the rows of an array; `items` says what they are.
#[pyfunction]
pub(crate) fn ellipsoid(
    py: Python<'_>,
    rows: &Bound<'_, PyAny>,
    items: &str,
    epsilon: f64,
    method: &str,
    max_passes: &Bound<'_, PyAny>,
    threads: &Bound<'_, PyAny>,
    seed: &Bound<'_, PyAny>,
) -> PyResult<Found> {
    let items = items_of_name(items)?;
    let options = options(epsilon, method, max_passes, threads, seed)?;
    solve(
        py,
        rows,
        |source, monitor| {
            taut::ellipsoid(
                source,
                &EllipsoidOptions { inputs: items, monitor: *monitor, ..options },
            )
        },
        |error, columns| raise(error, items, columns),
    )
}

/// One ellipsoid for each of many arrays.
#[pyfunction]
pub(crate) fn ellipsoids(
    py: Python<'_>,
    sets: Vec<Bound<'_, PyAny>>,
    epsilon: f64,
    method: &str,
    max_passes: &Bound<'_, PyAny>,
    threads: &Bound<'_, PyAny>,
    seed: &Bound<'_, PyAny>,
) -> PyResult<Vec<Found>> {
    let options = options(epsilon, method, max_passes, threads, seed)?;
    let sets: Vec<Rows<'_>> = sets.iter().map(Rows::borrow).collect::<PyResult<_>>()?;
    let sources = sets.iter().map(Rows::source).collect::<PyResult<Vec<_>>>()?;
    let sources: Vec<&dyn PointSource> = sources.iter().map(AsRef::as_ref).collect();
    let found = interruptible(py, |monitor| {
        taut::ellipsoids(&sources, &EllipsoidOptions { monitor: *monitor, ..options })
    })?
    .map_err(|error| raise(error, Items::Points, 0))?;
    Ok(found.into_iter().map(Found::from).collect())
}

pub(crate) fn options(
    epsilon: f64,
    method: &str,
    max_passes: &Bound<'_, PyAny>,
    threads: &Bound<'_, PyAny>,
    seed: &Bound<'_, PyAny>,
) -> PyResult<EllipsoidOptions<'static>> {
    let method =
        method.parse::<EllipsoidMethod>().map_err(|error| raise(error, Items::Points, 0))?;
    Ok(EllipsoidOptions {
        epsilon,
        method,
        max_passes: whole("max_passes", max_passes, "at least 2")?,
        threads: whole("threads", threads, "1 to 1024, or None")?,
        seed: whole("seed", seed, "0 to 2**64 - 1")?,
        ..EllipsoidOptions::default()
    })
}

/// |F(x − c)| of each row x, for F the factor and c the center with its tail.
#[pyfunction]
pub(crate) fn norms<'py>(
    py: Python<'py>,
    rows: &Bound<'py, PyAny>,
    center: Vec<f64>,
    center_tail: Vec<f64>,
    factor: Vec<Vec<f64>>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let rows = Rows::borrow(rows)?;
    let source = rows.source()?;
    let (given, dim) = (source.dim(), center.len());
    if given != dim {
        return Err(PyValueError::new_err(format!(
            "points have dimension {given}, but the ellipsoid has dimension {dim}"
        )));
    }
    // The norm looks neither at the matrix nor at the volume.
    let (matrix, hull, log_volume) = (Vec::new(), None, 0.0);
    let ellipsoid = Ellipsoid { center, center_tail, matrix, factor, hull, log_volume };
    let norms = interruptible(py, |monitor| {
        let (blocks, mut scratch) = (Blocks::of(source.as_ref()), Scratch::new());
        let (mut norms, mut point) = (Vec::new(), vec![0.0; dim]);
        for block in 0..blocks.count() {
            monitor.check()?;
            let rows = source.read(blocks.range(block), &mut scratch)?;
            for i in 0..rows.len() {
                rows.copy_row(i, &mut point);
                norms.push(ellipsoid.norm(&point));
            }
        }
        Ok::<_, ReadError>(norms)
    })?;
    let norms = norms.map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
    Ok(PyArray1::from_vec(py, norms))
}
