//! `taut.curve`, behind its Python signature.

use pyo3::prelude::*;
use taut::reconstruct::{CurveThesisOptions, Ends};
use taut::{CurveMethod, CurveOptions, Items};

use crate::choice::{check_method_options, choice};
use crate::found::{Found, solve_points};
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
    let chosen = choice::<CurveMethod>("method", method)?;
    let thesis = CurveThesisOptions { rho, omega, feature };
    let usual = CurveThesisOptions::default();
    let changed = [
        ("rho", rho != usual.rho),
        ("omega", omega != usual.omega),
        ("feature", feature.is_some()),
    ];
    check_method_options(method, &changed, |_, method: &CurveMethod| {
        matches!(method, CurveMethod::Thesis(_) | CurveMethod::ThesisCrude(_))
    })?;
    thesis.check().map_err(|error| raise(error, Items::Points, 0))?;
    let options = CurveOptions {
        method: match chosen {
            CurveMethod::Thesis(_) => CurveMethod::Thesis(thesis),
            CurveMethod::ThesisCrude(_) => CurveMethod::ThesisCrude(thesis),
            other => other,
        },
        ends: if open { Ends::Open } else { Ends::Auto },
        places,
        threads: whole("threads", threads, "1 to 1024, or None")?,
        ..CurveOptions::default()
    };
    solve_points(py, rows, |source, monitor| {
        taut::curve(source, &CurveOptions { monitor: *monitor, ..options })
    })
}
