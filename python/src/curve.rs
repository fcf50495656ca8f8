//! `taut.curve`, behind its Python signature.

use pyo3::prelude::*;
use taut::{CurveMethod, CurveOptions, Ends, Items, curve_of_source};

use crate::choice::choice;
use crate::found::{Found, solve};
use crate::items::raise;
use crate::numbers::whole;

/// The curves through the rows of an array.
#[pyfunction]
pub(crate) fn curve(
    py: Python<'_>,
    rows: &Bound<'_, PyAny>,
    method: &str,
    open: bool,
    rho: f64,
    omega: f64,
    feature: Option<f64>,
    places: bool,
    threads: &Bound<'_, PyAny>,
) -> PyResult<Found> {
    let options = CurveOptions {
        method: choice("method", method, CurveMethod::NAMES)?,
        ends: if open { Ends::Open } else { Ends::Auto },
        rho,
        omega,
        feature,
        places,
        threads: whole("threads", threads, "1 to 1024, or None")?,
    };
    solve(
        py,
        rows,
        |source, monitor| curve_of_source(source, &options, monitor),
        |error, columns| raise(error, Items::Points, columns),
    )
}
