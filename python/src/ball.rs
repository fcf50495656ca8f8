//! `taut.ball` and `taut.ball_of_balls`, behind their Python signatures.

use pyo3::prelude::*;
use taut::{BallMethod, BallOptions};

use crate::found::{Found, solve};
use crate::items::{items_of_name, raise};
use crate::numbers::whole;

/// The smallest ball around the rows of an array; `items` says what they are.
#[pyfunction]
pub(crate) fn ball(
    py: Python<'_>,
    rows: &Bound<'_, PyAny>,
    items: &str,
    epsilon: f64,
    method: &str,
    batch: &Bound<'_, PyAny>,
    max_passes: &Bound<'_, PyAny>,
    threads: &Bound<'_, PyAny>,
    seed: &Bound<'_, PyAny>,
) -> PyResult<Found> {
    let items = items_of_name(items)?;
    let method = method.parse::<BallMethod>().map_err(|error| raise(error, items, 0))?;
    let passes = "at least 3, and 4 for the methods of the thesis";
    let options = BallOptions {
        inputs: items,
        epsilon,
        method,
        batch: whole("batch", batch, "at least 1, or None")?,
        max_passes: whole("max_passes", max_passes, passes)?,
        threads: whole("threads", threads, "1 to 1024, or None")?,
        seed: whole("seed", seed, "0 to 2**64 - 1")?,
        ..BallOptions::default()
    };
    solve(
        py,
        rows,
        |source, monitor| taut::ball(source, &BallOptions { monitor: *monitor, ..options }),
        |error, columns| raise(error, items, columns),
    )
}
