//! `taut.spatial_order`, behind its Python signature, and its answer as Python sees it.

use numpy::PyArray1;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use taut::certify::{self, AnySolution, OrderCurve};
use taut::delaunay::Error;
use taut::spatial_order as solve;

use crate::rows::Rows;
use crate::solution::{Solution, row_numbers};
use crate::work::interruptible;

/// The rows of an array in the order of a curve through them.
#[pyfunction]
pub(crate) fn spatial_order(
    py: Python<'_>,
    rows: &Bound<'_, PyAny>,
    curve: &str,
) -> PyResult<Solution> {
    let curve = match curve {
        "hilbert" => OrderCurve::Hilbert,
        "morton" => OrderCurve::Morton,
        _ => {
            let problem = format!("option `curve` is {curve:?}: expected one of hilbert, morton");
            return Err(PyValueError::new_err(problem));
        }
    };
    let rows = Rows::borrow(rows)?;
    let source = rows.source()?;
    let found = interruptible(py, |monitor| solve(source.as_ref(), curve, monitor))?;
    let found = found.map_err(|error| match error {
        Error::Read(_) | Error::Cancelled(_) => PyRuntimeError::new_err(error.to_string()),
        _ => PyValueError::new_err(error.to_string()),
    })?;
    Solution::new(py, AnySolution::Order(found))
}

/// The rows of points along a curve.
///
/// Attributes
/// ----------
/// curve : str
///     ``"hilbert"`` or ``"morton"``.
/// rows : ndarray of int64, shape (n,)
///     Row numbers in order: ``points[rows]`` are the points along the curve. Read-only.
#[pyclass(frozen, get_all, module = "taut")]
pub(crate) struct Order {
    curve: &'static str,
    rows: Py<PyArray1<i64>>,
}

impl Order {
    pub(crate) fn new(py: Python<'_>, order: &certify::Order) -> PyResult<Self> {
        Ok(Order { curve: name(order.curve), rows: row_numbers(py, &order.rows)? })
    }
}

pub(crate) fn name(curve: OrderCurve) -> &'static str {
    match curve {
        OrderCurve::Hilbert => "hilbert",
        OrderCurve::Morton => "morton",
    }
}

#[pymethods]
impl Order {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        Ok(format!("Order(curve='{}', rows=<{}>)", self.curve, self.rows.bind(py).len()?))
    }
}

/// What an order belongs to; it is a function of the points alone, and is proved from these.
///
/// Attributes
/// ----------
/// points_hash : str
///     Hash of the points this was made for, 16 hexadecimal digits.
#[pyclass(frozen, get_all, module = "taut")]
pub(crate) struct OrderCertificate {
    points_hash: String,
}

impl OrderCertificate {
    pub(crate) fn new(certificate: &certify::OrderCertificate) -> Self {
        OrderCertificate { points_hash: certificate.points_hash.to_string() }
    }
}

#[pymethods]
impl OrderCertificate {
    fn __repr__(&self) -> String {
        format!("OrderCertificate(points_hash='{}')", self.points_hash)
    }
}

/// What was proved of an order: it is the one that the points have.
///
/// Attributes
/// ----------
/// points : int
///     Points.
/// grids : int
///     Grids that were laid over the points and, within cells of many, again.
#[pyclass(frozen, get_all, module = "taut")]
pub(crate) struct OrderVerdict {
    points: u64,
    grids: u64,
}

impl OrderVerdict {
    pub(crate) fn new(proved: &certify::OrderVerdict) -> Self {
        OrderVerdict { points: proved.points, grids: proved.grids }
    }
}

#[pymethods]
impl OrderVerdict {
    fn __repr__(&self) -> String {
        format!("OrderVerdict(points={}, grids={})", self.points, self.grids)
    }
}
