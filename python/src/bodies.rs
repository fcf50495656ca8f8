//! `taut.inscribed_dops`, behind its Python signature.

use pyo3::prelude::*;
use taut::Items;
use taut::inscribe::DopsOptions;

use crate::found::{Found, solve};
use crate::items::raise;
use crate::numbers::whole;

/// Convex bodies inside the closed mesh whose triangles are the rows of an array.
#[pyfunction]
pub(crate) fn inscribed_dops(
    py: Python<'_>,
    rows: &Bound<'_, PyAny>,
    directions: &Bound<'_, PyAny>,
    count: &Bound<'_, PyAny>,
    disjoint: bool,
    events: &Bound<'_, PyAny>,
    seed: &Bound<'_, PyAny>,
) -> PyResult<Found> {
    let directions = whole("directions", directions, "6, 14, 18 or 26")?;
    let count = whole("count", count, "from 1 to 1000")?;
    let events = whole("events", events, "at least 1")?;
    let seed = whole("seed", seed, "from 0 to 2^64 - 1")?;
    solve(
        py,
        rows,
        |source, monitor| {
            let options =
                DopsOptions { directions, count, disjoint, events, seed, monitor: *monitor };
            taut::inscribe::inscribed_dops(source, &options)
        },
        |error, columns| raise(error, Items::Points, columns),
    )
}
