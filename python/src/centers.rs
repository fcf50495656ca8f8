//! `taut.centers`, behind its Python signature, and its answer as Python sees it.

use std::str::FromStr;

use numpy::{PyArray1, PyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use taut::certify::{self, AnySolution, LowerBound, Placement};
use taut::enclose::Error;
use taut::{CentersMethod, CentersOptions, centers_of_source};

use crate::items::{items_of_name, name_of_items, raise, weight};
use crate::numbers::{float, whole};
use crate::rows::{Rows, numbers, table};
use crate::solution::{Solution, row_numbers};
use crate::work::interruptible;

/// k centres of the rows of an array; `items` says what these are.
#[pyfunction]
pub(crate) fn centers(
    py: Python<'_>,
    rows: &Bound<'_, PyAny>,
    k: &Bound<'_, PyAny>,
    items: &str,
    weights: bool,
    epsilon: f64,
    method: &str,
    discrete: bool,
    outliers: &Bound<'_, PyAny>,
    max_nodes: &Bound<'_, PyAny>,
    assignment: bool,
    threads: &Bound<'_, PyAny>,
) -> PyResult<Solution> {
    let items = items_of_name(items)?;
    let method = CentersMethod::from_str(method).map_err(|error| raise(error, items, 0))?;
    let k: usize = whole("k", k, "at least 1")?;
    let options = CentersOptions {
        epsilon,
        method,
        placement: if discrete { Placement::Rows } else { Placement::Free },
        outliers: whole("outliers", outliers, "at least 0 and less than the number of points")?,
        weights,
        max_nodes: whole("max_nodes", max_nodes, "0 to 2**64 - 1")?,
        assignment,
        threads: whole("threads", threads, "1 to 1024, or None")?,
    };
    let rows = Rows::borrow(rows)?;
    let source = rows.source()?;
    let found = interruptible(py, |monitor| {
        centers_of_source(source.as_ref(), items, k, &options, monitor)
    })?
    .map_err(|error| match error {
        Error::NonFinite { row, column, value } if weights && column + 1 == source.dim() => {
            PyValueError::new_err(weight(row, value))
        }
        error => raise(error, items, source.dim()),
    })?;
    Solution::new(py, AnySolution::Centers(found))
}

/// k centres, from one of which each item is at most `radius` away.
///
/// Attributes
/// ----------
/// centers : ndarray of shape (m, d)
///     The centres: k, or fewer where fewer are as good. Read-only.
/// rows : ndarray of int64, shape (m,) or (0,)
///     For centres among the points the row of each. Read-only.
/// radius : float
///     The largest distance of a point to the centre next to it; times its weight, or with its radius, where it has one.
/// lower_bound : float
///     No k centres have a smaller radius.
/// outliers : ndarray of int64, shape (z,)
///     Row numbers that are left out, ascending. Read-only.
/// assignment : ndarray of uint32, shape (n,), or None
///     On request, for each row the number of the centre next to it. Read-only.
#[pyclass(frozen, get_all, module = "taut")]
pub(crate) struct Centers {
    centers: Py<PyArray2<f64>>,
    rows: Py<PyArray1<i64>>,
    radius: f64,
    lower_bound: f64,
    outliers: Py<PyArray1<i64>>,
    assignment: Option<Py<PyArray1<u32>>>,
}

impl Centers {
    pub(crate) fn new(py: Python<'_>, answer: &taut::Centers) -> PyResult<Self> {
        let dim = answer.centers.first().map_or(0, Vec::len);
        if answer.centers.iter().any(|center| center.len() != dim) {
            return Err(PyValueError::new_err("the centres have different numbers of coordinates"));
        }
        let assignment =
            (!answer.assignment.is_empty()).then(|| numbers(py, answer.assignment.clone()));
        Ok(Centers {
            centers: table(py, answer.centers.concat(), dim)?,
            rows: row_numbers(py, &answer.rows)?,
            radius: answer.radius,
            lower_bound: answer.lower_bound,
            outliers: row_numbers(py, &answer.outliers)?,
            assignment: assignment.transpose()?,
        })
    }
}

#[pymethods]
impl Centers {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let (radius, lower_bound) = (float(py, self.radius)?, float(py, self.lower_bound)?);
        let count = self.centers.bind(py).len()?;
        Ok(format!("Centers(radius={radius}, lower_bound={lower_bound}, centers=<{count} rows>)"))
    }
}

/// What was asked, and a few rows that prove the lower bound: no k smaller balls hold them all.
///
/// Attributes
/// ----------
/// items : str
///     ``"points"`` or ``"balls"``.
/// weights : bool
///     Whether the points have weights.
/// discrete : bool
///     Whether centres are points of the input.
/// k : int
///     Most centres.
/// outliers : int
///     Most rows that may be left out.
/// gap : float
///     The gap claimed: radius <= (1 + gap) lower_bound.
/// core_set : ndarray of int64, shape (m,)
///     Row numbers. Read-only.
/// proof : str
///     ``"apart"`` (no two of the core-set fit in one ball), ``"search"`` (the checker searches) or ``"branches"`` (the
///     checker goes through the branches of a search again).
/// points_hash : str
///     Hash of the rows this was made for, 16 hexadecimal digits.
#[pyclass(frozen, get_all, module = "taut")]
pub(crate) struct CentersCertificate {
    items: &'static str,
    weights: bool,
    discrete: bool,
    k: u64,
    outliers: u64,
    gap: f64,
    core_set: Py<PyArray1<i64>>,
    proof: &'static str,
    points_hash: String,
}

impl CentersCertificate {
    pub(crate) fn new(py: Python<'_>, proof: &certify::CentersCertificate) -> PyResult<Self> {
        Ok(CentersCertificate {
            items: name_of_items(proof.items),
            weights: proof.weights,
            discrete: proof.placement == Placement::Rows,
            k: proof.k,
            outliers: proof.outliers,
            gap: proof.gap,
            core_set: row_numbers(py, &proof.core_set)?,
            proof: match proof.proof {
                LowerBound::Apart => "apart",
                LowerBound::Search => "search",
                LowerBound::Branches { .. } => "branches",
            },
            points_hash: proof.points_hash.to_string(),
        })
    }
}

#[pymethods]
impl CentersCertificate {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let (k, gap, m) = (self.k, float(py, self.gap)?, self.core_set.bind(py).len()?);
        Ok(format!("CentersCertificate(k={k}, gap={gap}, core_set=<{m} rows>)"))
    }
}

/// What the checker proved of centres.
///
/// Attributes
/// ----------
/// lower : float
///     No k centres have a smaller radius.
/// upper : float
///     The radius of the answer, within which every item that counts was found.
/// gap : float
///     ``upper / lower - 1``, rounded up; 0 where both are 0.
/// nodes : int
///     Nodes of the search by which the lower bound was confirmed.
/// cover_nodes : int or None
///     Nodes of the second search, over candidate balls, where one was made.
#[pyclass(frozen, get_all, module = "taut")]
pub(crate) struct CentersVerdict {
    lower: f64,
    upper: f64,
    gap: f64,
    nodes: u64,
    cover_nodes: Option<u64>,
}

impl CentersVerdict {
    pub(crate) fn new(proved: certify::CentersVerdict) -> Self {
        let certify::CentersVerdict { lower, upper, gap, nodes, cover_nodes } = proved;
        CentersVerdict { lower, upper, gap, nodes, cover_nodes }
    }
}

#[pymethods]
impl CentersVerdict {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let [lower, upper, gap] = [self.lower, self.upper, self.gap].map(|value| float(py, value));
        let nodes = self.nodes;
        Ok(format!(
            "CentersVerdict(lower={}, upper={}, gap={}, nodes={nodes})",
            lower?, upper?, gap?
        ))
    }
}
