//! `taut.inscribed_polygon`, behind its Python signature.

use pyo3::prelude::*;
use taut::Items;
use taut::inscribe::ConvexOptions;

use crate::found::{Found, solve};
use crate::items::raise;
use crate::numbers::whole;

/// A large convex polygon in the polygon whose rings are the rows of an array.
#[pyfunction]
pub(crate) fn inscribed_polygon(
    py: Python<'_>,
    rows: &Bound<'_, PyAny>,
    epsilon: f64,
    rounds: &Bound<'_, PyAny>,
    starts: &Bound<'_, PyAny>,
    seed: &Bound<'_, PyAny>,
) -> PyResult<Found> {
    let rounds = whole("rounds", rounds, "at least 0")?;
    let starts = whole("starts", starts, "at least 1")?;
    let seed = whole("seed", seed, "at least 0")?;
    solve(
        py,
        rows,
        |source, monitor| {
            let options = ConvexOptions { rounds, starts, seed, epsilon, monitor: *monitor };
            taut::inscribe::inscribed_polygon(source, &options)
        },
        |error, columns| raise(error, Items::Points, columns),
    )
}
