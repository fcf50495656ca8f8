//! `taut.inscribed_ellipsoid`, behind its Python signature, and its answer as Python sees it.

use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use taut::certify::{self, AnySolution};
use taut::{InscribedOptions, Items, inscribed_ellipsoid_of_source};

use crate::ellipsoid::rectangular;
use crate::items::raise;
use crate::numbers::{float, whole};
use crate::rows::{Rows, numbers, table};
use crate::solution::{Solution, row_numbers};
use crate::work::interruptible;

/// The ellipsoid of largest volume in the polytope whose half-spaces are the rows of an array.
#[pyfunction]
pub(crate) fn inscribed_ellipsoid(
    py: Python<'_>,
    rows: &Bound<'_, PyAny>,
    epsilon: f64,
    max_steps: &Bound<'_, PyAny>,
) -> PyResult<Solution> {
    let options =
        InscribedOptions { epsilon, max_steps: whole("max_steps", max_steps, "at least 1")? };
    let rows = Rows::borrow(rows)?;
    let source = rows.source()?;
    let found = interruptible(py, |monitor| {
        inscribed_ellipsoid_of_source(source.as_ref(), &options, monitor)
    })?
    .map_err(|error| match error {
        taut::enclose::Error::NonFinite { row, column, value } => {
            let place = match column + 1 == source.dim() {
                true => format!("offset {row}"),
                false => format!("coordinate {column} of normal {row}"),
            };
            pyo3::exceptions::PyValueError::new_err(format!(
                "{place} is {value}: all numbers must be finite"
            ))
        }
        taut::enclose::Error::Empty => pyo3::exceptions::PyValueError::new_err(
            "there are no half-spaces: a polytope is made of at least two",
        ),
        other => raise(other, Items::Points, source.dim()),
    })?;
    Solution::new(py, AnySolution::Inscribed(found))
}

/// An ellipsoid {c + G z : |z| <= 1} inside a polytope.
///
/// Attributes
/// ----------
/// center : ndarray of shape (d,)
///     The centre c. Read-only.
/// axes : ndarray of shape (d, d)
///     G. Read-only.
/// log_volume : float
///     Natural logarithm of the volume.
#[pyclass(frozen, get_all, module = "taut")]
pub(crate) struct InscribedEllipsoid {
    center: Py<PyArray1<f64>>,
    axes: Py<PyArray2<f64>>,
    log_volume: f64,
}

impl InscribedEllipsoid {
    pub(crate) fn new(py: Python<'_>, answer: &taut::InscribedEllipsoid) -> PyResult<Self> {
        let dim = answer.center.len();
        Ok(InscribedEllipsoid {
            center: numbers(py, answer.center.clone())?,
            axes: table(py, rectangular("the axes", &answer.axes, dim)?, dim)?,
            log_volume: answer.log_volume,
        })
    }
}

#[pymethods]
impl InscribedEllipsoid {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let (volume, dim) = (float(py, self.log_volume)?, self.center.bind(py).len()?);
        Ok(format!("InscribedEllipsoid(log_volume={volume}, center=<{dim} coordinates>)"))
    }
}

/// Multipliers over few half-spaces: the proof that no ellipsoid of much larger volume fits.
///
/// Attributes
/// ----------
/// support : ndarray of int64, shape (s,)
///     Row numbers with a positive multiplier, ascending. Read-only.
/// multipliers : ndarray of float64, shape (s,)
///     The multipliers, in the order of `support`. Read-only.
/// gap : float
///     The gap claimed: largest log-volume <= log_volume + gap.
/// points_hash : str
///     Hash of the rows this was made for, 16 hexadecimal digits.
#[pyclass(frozen, get_all, module = "taut")]
pub(crate) struct InscribedCertificate {
    support: Py<PyArray1<i64>>,
    multipliers: Py<PyArray1<f64>>,
    gap: f64,
    points_hash: String,
}

impl InscribedCertificate {
    pub(crate) fn new(py: Python<'_>, proof: &certify::InscribedCertificate) -> PyResult<Self> {
        Ok(InscribedCertificate {
            support: row_numbers(py, &proof.support)?,
            multipliers: numbers(py, proof.multipliers.clone())?,
            gap: proof.gap,
            points_hash: proof.points_hash.to_string(),
        })
    }
}

#[pymethods]
impl InscribedCertificate {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let (s, gap) = (self.support.bind(py).len()?, float(py, self.gap)?);
        Ok(format!("InscribedCertificate(gap={gap}, support=<{s} half-spaces>)"))
    }
}

/// What the checker proved of an inscribed ellipsoid.
///
/// Attributes
/// ----------
/// lower : float
///     Log-volume of the answer, which was found to lie in every half-space.
/// upper : float
///     No ellipsoid in the polytope has a log-volume above this.
/// gap : float
///     ``upper - lower``, rounded up.
#[pyclass(frozen, get_all, module = "taut")]
pub(crate) struct InscribedVerdict {
    lower: f64,
    upper: f64,
    gap: f64,
}

impl InscribedVerdict {
    pub(crate) fn new(proved: certify::InscribedVerdict) -> Self {
        let certify::InscribedVerdict { lower, upper, gap } = proved;
        InscribedVerdict { lower, upper, gap }
    }
}

#[pymethods]
impl InscribedVerdict {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let [lower, upper, gap] = [self.lower, self.upper, self.gap].map(|value| float(py, value));
        Ok(format!("InscribedVerdict(lower={}, upper={}, gap={})", lower?, upper?, gap?))
    }
}
