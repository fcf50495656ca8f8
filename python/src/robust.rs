//! `taut.robust_ellipsoid`, behind its Python signature.

use std::str::FromStr;

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use taut::{Items, RobustMethod, RobustOptions, robust_ellipsoid_of_source};

use crate::found::{Found, solve};
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
    epsilon: f64,
    threads: &Bound<'_, PyAny>,
) -> PyResult<Found> {
    let method = RobustMethod::from_str(method);
    let options = RobustOptions {
        method: method.map_err(|error| PyValueError::new_err(error.to_string()))?,
        coverage,
        level,
        epsilon,
        threads: whole("threads", threads, "1 to 1024, or None")?,
    };
    solve(
        py,
        rows,
        |source, monitor| robust_ellipsoid_of_source(source, &options, monitor),
        |error, columns| raise(error, Items::Points, columns),
    )
}
