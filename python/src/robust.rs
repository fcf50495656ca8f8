//! `taut.robust_ellipsoid`, behind its Python signature.

use pyo3::prelude::*;
use taut::certify::RobustScale;
use taut::{Items, RobustMethod, RobustOptions};

use crate::found::{Found, solve_points};
use crate::items::raise;
use crate::numbers::whole;

/// Center and scatter of most of the rows of an array.
#[pyfunction]
pub(crate) fn robust_ellipsoid(
    py: Python<'_>,
    rows: &Bound<'_, PyAny>,
    method: &str,
    coverage: Option<f64>,
    level: f64,
    scale: &str,
    epsilon: f64,
    threads: &Bound<'_, PyAny>,
) -> PyResult<Found> {
    let options = RobustOptions {
        method: method.parse::<RobustMethod>().map_err(|error| raise(error, Items::Points, 0))?,
        coverage,
        level,
        scale: scale.parse::<RobustScale>().map_err(|error| raise(error, Items::Points, 0))?,
        epsilon,
        threads: whole("threads", threads, "1 to 1024, or None")?,
        ..RobustOptions::default()
    };
    solve_points(py, rows, |source, monitor| {
        taut::robust_ellipsoid(source, &RobustOptions { monitor: *monitor, ..options })
    })
}
