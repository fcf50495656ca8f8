//! `taut.robust_ellipsoid`, behind its Python signature, and its answer as Python sees it.

use std::str::FromStr;

use numpy::{PyArray1, PyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use taut::certify::{self, AnySolution};
use taut::{Items, RobustMethod, RobustOptions, robust_ellipsoid_of_source};

use crate::ellipsoid::{Ellipsoid, EllipsoidVerdict, rectangular};
use crate::items::raise;
use crate::numbers::{float, whole};
use crate::rows::{Rows, table};
use crate::solution::{Solution, row_numbers};
use crate::work::interruptible;

/// Centre and scatter of most of the rows of an array.
#[pyfunction]
pub(crate) fn robust_ellipsoid(
    py: Python<'_>,
    rows: &Bound<'_, PyAny>,
    method: &str,
    coverage: Option<f64>,
    level: f64,
    epsilon: f64,
    threads: &Bound<'_, PyAny>,
) -> PyResult<Solution> {
    let options = RobustOptions {
        method: RobustMethod::from_str(method)
            .map_err(|error| PyValueError::new_err(error.to_string()))?,
        coverage,
        level,
        epsilon,
        threads: whole("threads", threads, "1 to 1024, or None")?,
    };
    let rows = Rows::borrow(rows)?;
    let source = rows.source()?;
    let found = interruptible(py, |monitor| {
        robust_ellipsoid_of_source(source.as_ref(), &options, monitor)
    })?
    .map_err(|error| raise(error, Items::Points, source.dim()))?;
    Solution::new(py, AnySolution::Robust(Box::new(found)))
}

/// Centre and scatter of most of the points, the ellipsoid they mean, and the points that lie outside of it.
///
/// Attributes
/// ----------
/// center : ndarray of shape (d,)
///     The centre c. Read-only.
/// scatter : ndarray of shape (d, d)
///     S: for normal points an estimate of their covariance. Read-only.
/// log_det : float
///     ln det S; of dimension r where `hull` is given.
/// outliers : ndarray of int64, shape (k,)
///     Row numbers outside the ellipsoid or off the hull, ascending; `flagged` in the JSON. Read-only.
/// ellipsoid : Ellipsoid
///     By "mcd" and "mve" the tolerance ellipsoid, by "trim" the smallest around the points kept.
/// matrix, factor, hull, log_volume, rank
///     Those of `ellipsoid`, for short. Where `hull` is not None, most points lie in it exactly.
#[pyclass(frozen, get_all, module = "taut")]
pub(crate) struct RobustEllipsoid {
    scatter: Py<PyArray2<f64>>,
    log_det: f64,
    outliers: Py<PyArray1<i64>>,
    ellipsoid: Py<Ellipsoid>,
}

impl RobustEllipsoid {
    pub(crate) fn new(py: Python<'_>, answer: &taut::RobustEllipsoid) -> PyResult<Self> {
        let dim = answer.center.len();
        Ok(RobustEllipsoid {
            scatter: table(py, rectangular("the scatter", &answer.scatter, dim)?, dim)?,
            log_det: answer.log_det,
            outliers: row_numbers(py, &answer.flagged)?,
            ellipsoid: Py::new(py, Ellipsoid::new(py, &answer.ellipsoid())?)?,
        })
    }
}

#[pymethods]
impl RobustEllipsoid {
    #[getter]
    fn center(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        self.ellipsoid.getattr(py, "center")
    }

    #[getter]
    fn matrix(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        self.ellipsoid.getattr(py, "matrix")
    }

    #[getter]
    fn factor(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        self.ellipsoid.getattr(py, "factor")
    }

    #[getter]
    fn hull(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        self.ellipsoid.getattr(py, "hull")
    }

    #[getter]
    fn log_volume(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        self.ellipsoid.getattr(py, "log_volume")
    }

    #[getter]
    fn rank(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        self.ellipsoid.getattr(py, "rank")
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let (log_det, k) = (float(py, self.log_det)?, self.outliers.bind(py).len()?);
        Ok(format!("RobustEllipsoid(log_det={log_det}, outliers=<{k} rows>)"))
    }
}

/// What a robust ellipsoid is made of, so that all of it can be calculated again from the points.
///
/// Attributes
/// ----------
/// method : str
///     ``"mcd"``, ``"mve"`` or ``"trim"``.
/// kept : int
///     h, how many points were asked for.
/// left_out : ndarray of int64, shape (l,)
///     Row numbers not among them, ascending. Read-only.
/// objective : float
///     What was minimised, reached: ln det of the covariance of the points kept, or the log-volume around them.
/// level : float
///     The part of normal points that the tolerance ellipsoid holds; 1 by "trim".
/// cutoff : float
///     The quantile of chi-squared at `level`; 0 by "trim".
/// raw_scale, scale : float
///     By what the scatter of the points kept, and the covariance of those not weighed out, is multiplied.
/// weighed_out : ndarray of int64, shape (w,)
///     Row numbers beyond `cutoff` in the metric of the points kept, ascending. Read-only.
/// gap : float or None
///     By "mve" and "trim", the gap in log-volume of the ellipsoid around the points kept.
/// points_hash : str
///     Hash of the rows this was made for, 16 hexadecimal digits.
#[pyclass(frozen, get_all, module = "taut")]
pub(crate) struct RobustCertificate {
    method: &'static str,
    kept: u64,
    left_out: Py<PyArray1<i64>>,
    objective: f64,
    level: f64,
    cutoff: f64,
    raw_scale: f64,
    scale: f64,
    weighed_out: Py<PyArray1<i64>>,
    gap: Option<f64>,
    points_hash: String,
}

impl RobustCertificate {
    pub(crate) fn new(py: Python<'_>, proof: &certify::RobustCertificate) -> PyResult<Self> {
        Ok(RobustCertificate {
            method: proof.method.name(),
            kept: proof.kept,
            left_out: row_numbers(py, &proof.left_out)?,
            objective: proof.objective,
            level: proof.level,
            cutoff: proof.cutoff,
            raw_scale: proof.raw_scale,
            scale: proof.scale,
            weighed_out: row_numbers(py, &proof.weighed_out)?,
            gap: proof.enclosure.as_ref().map(|enclosure| enclosure.certificate.gap),
            points_hash: proof.points_hash.to_string(),
        })
    }
}

#[pymethods]
impl RobustCertificate {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let (method, kept, objective) = (self.method, self.kept, float(py, self.objective)?);
        Ok(format!("RobustCertificate(method='{method}', kept={kept}, objective={objective})"))
    }
}

/// What the checker proved of a robust ellipsoid. That no other points kept would do better is not proved.
///
/// Attributes
/// ----------
/// objective : float
///     What the method minimises, of the points kept, as found here.
/// enclosure : EllipsoidVerdict or None
///     By "mve" and "trim", what was proved of the ellipsoid around the points kept.
/// wanted : int
///     h, how many points were to be kept. By "mcd" and "mve" at least half of the points.
/// kept : int
///     How many are kept: h, and by "mve" and "trim" those that lie on the border besides.
/// on_hull : int
///     Points on the hull; all of them where there is none.
/// flag_excess : float
///     By how much a point that is no outlier lies beyond the border, or an outlier within, in units of the border; 0 where
///     the outliers are exactly the points outside.
/// slack : float
///     What centre, scatter and border may be off by in that unit, where coordinates have few digits for the points.
/// reweighted : bool
///     Whether centre and scatter are those of the points not weighed out.
/// rank : int
///     The dimension of the ellipsoid itself.
#[pyclass(frozen, get_all, module = "taut")]
pub(crate) struct RobustVerdict {
    objective: f64,
    enclosure: Option<Py<EllipsoidVerdict>>,
    wanted: u64,
    kept: u64,
    on_hull: u64,
    flag_excess: f64,
    slack: f64,
    reweighted: bool,
    rank: usize,
}

impl RobustVerdict {
    pub(crate) fn new(py: Python<'_>, proved: certify::RobustVerdict) -> PyResult<Self> {
        let enclosure = proved.enclosure.map(|proved| Py::new(py, EllipsoidVerdict::new(proved)));
        Ok(RobustVerdict {
            objective: proved.objective,
            enclosure: enclosure.transpose()?,
            wanted: proved.wanted,
            kept: proved.kept,
            on_hull: proved.on_hull,
            flag_excess: proved.flag_excess,
            slack: proved.slack,
            reweighted: proved.reweighted,
            rank: proved.rank,
        })
    }
}

#[pymethods]
impl RobustVerdict {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let (objective, on_hull, rank) = (float(py, self.objective)?, self.on_hull, self.rank);
        Ok(format!("RobustVerdict(objective={objective}, on_hull={on_hull}, rank={rank})"))
    }
}
