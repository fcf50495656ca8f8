//! `taut.curve`, behind its Python signature, and its answer as Python sees it.

use numpy::{PyArray1, PyArray2};
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use taut::certify::{self, AnySolution};
use taut::reconstruct::Error;
use taut::{CurveMethod, CurveOptions, Ends, curve_of_source};

use crate::numbers::{float, whole};
use crate::rows::{Rows, table};
use crate::solution::{Solution, row_numbers};
use crate::work::interruptible;

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
) -> PyResult<Solution> {
    let known = CurveMethod::NAMES.iter().find(|(name, _)| *name == method);
    let options = CurveOptions {
        method: known.map(|(_, method)| *method).ok_or_else(|| {
            let names = CurveMethod::NAMES.map(|(name, _)| name).join(", ");
            PyValueError::new_err(format!("option `method` is {method:?}: expected one of {names}"))
        })?,
        ends: if open { Ends::Open } else { Ends::Auto },
        rho,
        omega,
        feature,
        places,
        threads: whole("threads", threads, "1 to 1024, or None")?,
    };
    let rows = Rows::borrow(rows)?;
    let source = rows.source()?;
    let found = interruptible(py, |monitor| curve_of_source(source.as_ref(), &options, monitor))?
        .map_err(raise)?;
    Solution::new(py, AnySolution::Curve(found))
}

/// A wrong input is a `ValueError` with the library's sentence.
fn raise(error: Error) -> PyErr {
    match error {
        Error::Read(_) | Error::Cancelled(_) => PyRuntimeError::new_err(error.to_string()),
        _ => PyValueError::new_err(error.to_string()),
    }
}

/// Curves through points of the plane.
///
/// Attributes
/// ----------
/// curves : tuple of CurveComponent
///     The connected curves.
/// noise : float
///     Half the width of the band around the curves that noise fills, as estimated; 0 where vertices are points.
/// outliers : ndarray of int64, shape (z,)
///     Row numbers that no curve accounts for, ascending. Read-only.
/// places : ndarray of float64, shape (n, 2), or None
///     On request, for each row its curve and the position k + t on it: the share t of the edge after vertex k. Of outliers
///     the place next to them. Read-only.
#[pyclass(frozen, get_all, module = "taut")]
pub(crate) struct Curve {
    curves: Py<PyTuple>,
    noise: f64,
    outliers: Py<PyArray1<i64>>,
    places: Option<Py<PyArray2<f64>>>,
}

impl Curve {
    pub(crate) fn new(py: Python<'_>, answer: &taut::Curve) -> PyResult<Self> {
        let component = |curve: &taut::CurveComponent| {
            Ok(CurveComponent {
                vertices: table(py, curve.vertices.as_flattened().to_vec(), 2)?,
                closed: curve.closed,
                rows: (!curve.rows.is_empty()).then(|| row_numbers(py, &curve.rows)).transpose()?,
            })
        };
        let curves: Vec<CurveComponent> =
            answer.curves.iter().map(component).collect::<PyResult<_>>()?;
        let places: Vec<f64> =
            answer.places.iter().flat_map(|place| [f64::from(place.0), place.1]).collect();
        Ok(Curve {
            curves: PyTuple::new(py, curves)?.unbind(),
            noise: answer.noise,
            outliers: row_numbers(py, &answer.outliers)?,
            places: (!places.is_empty()).then(|| table(py, places, 2)).transpose()?,
        })
    }
}

#[pymethods]
impl Curve {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let (curves, outliers) = (self.curves.bind(py).len(), self.outliers.bind(py).len()?);
        let noise = float(py, self.noise)?;
        Ok(format!("Curve(curves=<{curves}>, noise={noise}, outliers=<{outliers}>)"))
    }
}

/// One connected curve.
///
/// Attributes
/// ----------
/// vertices : ndarray of float64, shape (m, 2)
///     The vertices in order. Read-only.
/// closed : bool
///     Whether an edge leads from the last vertex back to the first.
/// rows : ndarray of int64, shape (m,), or None
///     Where vertices are points of the input, the row of each. Read-only.
#[pyclass(frozen, get_all, module = "taut")]
pub(crate) struct CurveComponent {
    vertices: Py<PyArray2<f64>>,
    closed: bool,
    rows: Option<Py<PyArray1<i64>>>,
}

#[pymethods]
impl CurveComponent {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let m = self.vertices.bind(py).len()?;
        let closed = if self.closed { "True" } else { "False" };
        Ok(format!("CurveComponent(closed={closed}, vertices=<{m} rows>)"))
    }
}

/// What is claimed of curves.
///
/// Attributes
/// ----------
/// band : float
///     No row but the outliers is farther than this from the curves.
/// sampling_ratio : float
///     The largest of half the gap between samples that follow each other, over the feature size there; the largest float
///     where it is not known.
/// noise_ratio : float
///     The largest distance of a row over the feature size next to it; the largest float where it is not known.
/// certified : bool
///     Whether the sampling is dense enough, beside the features of the curves themselves, to call them homeomorphic to
///     those that were sampled.
/// tour_lower : float or None
///     Of a tour, a length that none falls below.
/// points_hash : str
///     Hash of the rows this was made for, 16 hexadecimal digits.
#[pyclass(frozen, get_all, module = "taut")]
pub(crate) struct CurveCertificate {
    band: f64,
    sampling_ratio: f64,
    noise_ratio: f64,
    certified: bool,
    tour_lower: Option<f64>,
    points_hash: String,
}

impl CurveCertificate {
    pub(crate) fn new(proof: &certify::CurveCertificate) -> Self {
        CurveCertificate {
            band: proof.band,
            sampling_ratio: proof.sampling_ratio,
            noise_ratio: proof.noise_ratio,
            certified: proof.certified,
            tour_lower: proof.tour.as_ref().map(|tour| tour.lower),
            points_hash: proof.points_hash.to_string(),
        }
    }
}

#[pymethods]
impl CurveCertificate {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let certified = if self.certified { "True" } else { "False" };
        Ok(format!("CurveCertificate(certified={certified}, band={})", float(py, self.band)?))
    }
}

/// What the checker proved of curves.
///
/// Attributes
/// ----------
/// rows, outliers : int
///     How many rows there are, and how many of them were left out as outliers: nothing is claimed of these.
/// band : float
///     The largest distance of a row that is no outlier from the curves, rounded up.
/// simple : bool
///     Whether no two edges meet but neighbours at their vertex; only of tours it may be False.
/// sampling_ratio, noise_ratio : float
///     As the checker finds them; infinite where they are not known.
/// certified : bool
///     Whether the evidence for a homeomorphism was found.
/// doubt : str or None
///     Where it was not, the first reason.
/// tour_gap : float or None
///     Of a tour, its length over the lower bound, less 1, rounded up.
#[pyclass(frozen, get_all, module = "taut")]
pub(crate) struct CurveVerdict {
    rows: u64,
    outliers: u64,
    band: f64,
    simple: bool,
    sampling_ratio: f64,
    noise_ratio: f64,
    certified: bool,
    doubt: Option<String>,
    tour_gap: Option<f64>,
}

impl CurveVerdict {
    pub(crate) fn new(proved: &certify::CurveVerdict) -> Self {
        CurveVerdict {
            rows: proved.rows,
            outliers: proved.outliers,
            band: proved.band,
            simple: proved.is_simple,
            sampling_ratio: proved.sampling_ratio,
            noise_ratio: proved.noise_ratio,
            certified: proved.certified,
            doubt: proved.doubt.map(|doubt| doubt.to_string()),
            tour_gap: proved.tour_gap,
        }
    }
}

#[pymethods]
impl CurveVerdict {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let word = |yes: bool| if yes { "True" } else { "False" };
        let (certified, simple) = (word(self.certified), word(self.simple));
        let (band, outliers, rows) = (float(py, self.band)?, self.outliers, self.rows);
        Ok(format!(
            "CurveVerdict(certified={certified}, simple={simple}, band={band}, outliers={outliers} of {rows})"
        ))
    }
}
