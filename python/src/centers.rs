//! `taut.centers`, behind its Python signature.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use taut::certify::Placement;
use taut::enclose::Error;
use taut::points::{InputError, shown_number};
use taut::{CentersMethod, CentersOptions};

use crate::found::{Found, solve};
use crate::items::{items_of_name, raise, weight};
use crate::numbers::whole;

/// k centers of the rows of an array; `items` says what these are.
#[pyfunction]
pub(crate) fn centers(
    py: Python<'_>,
    rows: &Bound<'_, PyAny>,
    k: &Bound<'_, PyAny>,
    items: &str,
    weights: bool,
    groups: bool,
    epsilon: f64,
    method: &str,
    discrete: bool,
    outliers: &Bound<'_, PyAny>,
    max_nodes: &Bound<'_, PyAny>,
    assignment: bool,
    threads: &Bound<'_, PyAny>,
) -> PyResult<Found> {
    let items = items_of_name(items)?;
    let method = method.parse::<CentersMethod>().map_err(|error| raise(error, items, 0))?;
    let k: usize = whole("k", k, "at least 1")?;
    let options = CentersOptions {
        inputs: items,
        epsilon,
        method,
        placement: if discrete { Placement::Rows } else { Placement::Free },
        outliers: whole("outliers", outliers, "at least 0 and less than the number of points")?,
        weights,
        max_nodes: whole("max_nodes", max_nodes, "0 to 2**64 - 1")?,
        assignment,
        threads: whole("threads", threads, "1 to 1024, or None")?,
        ..CentersOptions::default()
    };
    solve(
        py,
        rows,
        |source, monitor| {
            let group = groups.then(|| source.dim().saturating_sub(1));
            taut::centers(source, k, &CentersOptions { monitor: *monitor, group, ..options })
        },
        |error, columns| match error {
            Error::Input(InputError::NonFinite { row, column, value })
                if groups && column + 1 == columns =>
            {
                let value = shown_number(value);
                let words =
                    format!("the group of point {row} is {value}: all groups must be finite");
                PyValueError::new_err(words)
            }
            Error::Input(InputError::NonFinite { row, column, value })
                if weights && column + 1 + usize::from(groups) == columns =>
            {
                PyValueError::new_err(weight(row, value))
            }
            error => raise(error, items, columns - usize::from(groups)),
        },
    )
}
