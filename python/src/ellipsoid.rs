//! `taut.ellipsoid`, behind its Python signature, and ellipsoids as Python sees them.

use std::str::FromStr;

use numpy::{PyArray1, PyArray2};
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use taut::certify::{self, AnySolution};
use taut::points::{Blocks, Scratch};
use taut::{
    EllipsoidMethod, EllipsoidOptions, Items, PointSource, ellipsoid_of_items,
    ellipsoids_of_sources,
};

use crate::items::{items_of_name, name_of_items, raise};
use crate::numbers::{float, whole};
use crate::rows::{Rows, numbers, table};
use crate::solution::{Solution, row_numbers};
use crate::work::interruptible;

/// The ellipsoid of least volume around the rows of an array; `items` says what they are.
#[pyfunction]
pub(crate) fn ellipsoid(
    py: Python<'_>,
    rows: &Bound<'_, PyAny>,
    items: &str,
    epsilon: f64,
    method: &str,
    max_passes: &Bound<'_, PyAny>,
    threads: &Bound<'_, PyAny>,
    seed: &Bound<'_, PyAny>,
) -> PyResult<Solution> {
    let items = items_of_name(items)?;
    let options = options(epsilon, method, max_passes, threads, seed)?;
    let rows = Rows::borrow(rows)?;
    let source = rows.source()?;
    let found =
        interruptible(py, |monitor| ellipsoid_of_items(source.as_ref(), items, &options, monitor))?
            .map_err(|error| raise(error, items, source.dim()))?;
    Solution::new(py, AnySolution::Ellipsoid(found))
}

/// One ellipsoid for each of many arrays.
#[pyfunction]
pub(crate) fn ellipsoids(
    py: Python<'_>,
    sets: Vec<Bound<'_, PyAny>>,
    epsilon: f64,
    method: &str,
    max_passes: &Bound<'_, PyAny>,
    threads: &Bound<'_, PyAny>,
    seed: &Bound<'_, PyAny>,
) -> PyResult<Vec<Solution>> {
    let options = options(epsilon, method, max_passes, threads, seed)?;
    let sets: Vec<Rows<'_>> = sets.iter().map(Rows::borrow).collect::<PyResult<_>>()?;
    let sources = sets.iter().map(Rows::source).collect::<PyResult<Vec<_>>>()?;
    let sources: Vec<&dyn PointSource> = sources.iter().map(AsRef::as_ref).collect();
    let found = interruptible(py, |monitor| ellipsoids_of_sources(&sources, &options, monitor))?
        .map_err(|error| raise(error, Items::Points, 0))?;
    found.into_iter().map(|found| Solution::new(py, AnySolution::Ellipsoid(found))).collect()
}

fn options(
    epsilon: f64,
    method: &str,
    max_passes: &Bound<'_, PyAny>,
    threads: &Bound<'_, PyAny>,
    seed: &Bound<'_, PyAny>,
) -> PyResult<EllipsoidOptions> {
    let method =
        EllipsoidMethod::from_str(method).map_err(|error| raise(error, Items::Points, 0))?;
    Ok(EllipsoidOptions {
        epsilon,
        method,
        max_passes: whole("max_passes", max_passes, "at least 2")?,
        threads: whole("threads", threads, "1 to 1024, or None")?,
        seed: whole("seed", seed, "0 to 2**64 - 1")?,
    })
}

/// An ellipsoid {x : |F(x - c)| <= 1} in d dimensions, or in an affine subspace of dimension r < d.
///
/// Attributes
/// ----------
/// center : ndarray of shape (d,)
///     The centre c, rounded to float64. Read-only.
/// center_tail : ndarray of shape (d,)
///     What is to be added to `center` for the exact centre: zeros, unless the points lie so far from the origin
///     that the rounding would cost more than rounding the rest. Read-only.
/// matrix : ndarray of shape (d, d)
///     Q = F.T @ F, symmetric: (x - c) @ Q @ (x - c) <= 1. Of rank r. Read-only.
/// factor : ndarray of shape (r, d)
///     F, which tells inside from outside more sharply than `matrix` where the axes differ much. Read-only.
/// hull : Hull or None
///     The affine subspace in which the points lie; None where they span the space, so that r = d.
/// log_volume : float
///     Natural logarithm of the volume, of dimension r; 0 for a single point.
/// rank : int
///     r, the dimension of the ellipsoid itself.
#[pyclass(frozen, module = "taut")]
pub(crate) struct Ellipsoid {
    ellipsoid: taut::Ellipsoid,
    #[pyo3(get)]
    center: Py<PyArray1<f64>>,
    #[pyo3(get)]
    center_tail: Py<PyArray1<f64>>,
    #[pyo3(get)]
    matrix: Py<PyArray2<f64>>,
    #[pyo3(get)]
    factor: Py<PyArray2<f64>>,
    #[pyo3(get)]
    hull: Option<Py<Hull>>,
    #[pyo3(get)]
    log_volume: f64,
    #[pyo3(get)]
    rank: usize,
}

impl Ellipsoid {
    pub(crate) fn new(py: Python<'_>, ellipsoid: &taut::Ellipsoid) -> PyResult<Self> {
        let dim = ellipsoid.dim();
        let hull = ellipsoid.hull.as_ref().map(|hull| {
            let basis = table(py, rectangular("the basis of the hull", &hull.basis, dim)?, dim)?;
            Py::new(py, Hull { basis, distance: hull.distance })
        });
        Ok(Ellipsoid {
            center: numbers(py, ellipsoid.center.clone())?,
            center_tail: numbers(
                py,
                match ellipsoid.center_tail.is_empty() {
                    true => vec![0.0; dim],
                    false => ellipsoid.center_tail.clone(),
                },
            )?,
            matrix: table(py, rectangular("the matrix", &ellipsoid.matrix, dim)?, dim)?,
            factor: table(py, rectangular("the factor", &ellipsoid.factor, dim)?, dim)?,
            hull: hull.transpose()?,
            log_volume: ellipsoid.log_volume,
            rank: ellipsoid.rank(),
            ellipsoid: ellipsoid.clone(),
        })
    }
}

/// The directions in which items touch; a document may hold any numbers of them, an array may not.
pub(crate) fn directions(
    py: Python<'_>,
    rows: &[Vec<f64>],
    dim: usize,
) -> PyResult<Py<PyArray2<f64>>> {
    table(py, rectangular("the directions", rows, dim)?, dim)
}

/// The rows one after the other; a document may hold rows of any length, an array may not.
pub(crate) fn rectangular(name: &str, rows: &[Vec<f64>], width: usize) -> PyResult<Vec<f64>> {
    match rows.iter().position(|row| row.len() != width) {
        None => Ok(rows.concat()),
        Some(at) => Err(PyValueError::new_err(format!(
            "row {at} of {name} has {} numbers, but the centre has {width}",
            rows[at].len()
        ))),
    }
}

#[pymethods]
impl Ellipsoid {
    /// |F(x - c)| of each point: at most 1 inside, but for rounding.
    ///
    /// Of points in a flat the distance from `hull` is not looked at. Ctrl-C stops the work.
    ///
    /// Parameters
    /// ----------
    /// points : array_like of shape (n, d)
    ///     Any points, converted as by `ellipsoid`.
    ///
    /// Returns
    /// -------
    /// ndarray of shape (n,)
    ///
    /// Examples
    /// --------
    /// >>> import taut
    /// >>> disc = taut.ellipsoid([[0, 0], [2, 0], [2, 2], [0, 2]]).answer
    /// >>> disc.norm([[1, 1], [3, 1], [1, 1.5]]).round(8)
    /// array([0.        , 1.41421356, 0.35355339])
    fn norm(&self, py: Python<'_>, points: &Bound<'_, PyAny>) -> PyResult<Py<PyArray1<f64>>> {
        // Arrays are put in order in one place, and that is written in Python.
        let rows = py.import("taut._arrays")?.getattr("as_rows")?.call1((points,))?;
        let rows = Rows::borrow(&rows)?;
        let source = rows.source()?;
        let (given, dim) = (source.dim(), self.ellipsoid.dim());
        if given != dim {
            return Err(PyValueError::new_err(format!(
                "points have dimension {given}, but the ellipsoid has dimension {dim}"
            )));
        }
        let norms = interruptible(py, |monitor| {
            let (blocks, mut scratch) = (Blocks::of(source.as_ref()), Scratch::new());
            let (mut norms, mut point) = (Vec::new(), vec![0.0; dim]);
            for block in 0..blocks.count() {
                monitor.check()?;
                let rows = source.read(blocks.range(block), &mut scratch)?;
                for i in 0..rows.len() {
                    rows.copy_row(i, &mut point);
                    norms.push(self.ellipsoid.norm(&point));
                }
            }
            Ok::<_, taut::points::ReadError>(norms)
        })?;
        let norms = norms.map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
        Ok(PyArray1::from_vec(py, norms).unbind())
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let volume = float(py, self.log_volume)?;
        let (rank, dim) = (self.rank, self.ellipsoid.dim());
        Ok(format!("Ellipsoid(log_volume={volume}, rank={rank}, center=<{dim} coordinates>)"))
    }
}

/// The affine subspace c + z @ basis in which flat points lie, but for rounding.
///
/// Attributes
/// ----------
/// basis : ndarray of shape (r, d)
///     Orthonormal rows. Read-only.
/// distance : float
///     No point lies farther than this from the subspace.
#[pyclass(frozen, get_all, module = "taut")]
pub(crate) struct Hull {
    basis: Py<PyArray2<f64>>,
    distance: f64,
}

#[pymethods]
impl Hull {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let (rows, distance) = (self.basis.bind(py).len()?, float(py, self.distance)?);
        Ok(format!("Hull(basis=<{rows} rows>, distance={distance})"))
    }
}

/// Convex multipliers over few rows: the proof that no ellipsoid of much smaller volume exists.
///
/// Attributes
/// ----------
/// items : str
///     ``"points"``, ``"balls"`` or ``"ellipsoids"``.
/// support : ndarray of int64, shape (s,)
///     Row numbers with a positive multiplier, ascending; a ball or an ellipsoid that touches in several points occurs
///     several times. Read-only.
/// multipliers : ndarray of float64, shape (s,)
///     The multipliers, in the order of `support`; they sum to 1. Read-only.
/// directions : ndarray of float64, shape (s, d) or (0, d)
///     For balls and ellipsoids {m + v : v v.T <= S}, directions a in which they touch: at m + S a / sqrt(a S a).
///     Read-only.
/// left_out : ndarray of int64, shape (l,)
///     Row numbers that the ellipsoid leaves out, ascending; the rest is enclosed. Read-only.
/// gap : float
///     The gap claimed: log_volume <= least log-volume + gap.
/// points_hash : str
///     Hash of the rows this was made for, 16 hexadecimal digits.
#[pyclass(frozen, get_all, module = "taut")]
pub(crate) struct EllipsoidCertificate {
    items: &'static str,
    support: Py<PyArray1<i64>>,
    multipliers: Py<PyArray1<f64>>,
    directions: Py<PyArray2<f64>>,
    left_out: Py<PyArray1<i64>>,
    gap: f64,
    points_hash: String,
}

impl EllipsoidCertificate {
    pub(crate) fn new(
        py: Python<'_>,
        proof: &certify::EllipsoidCertificate,
        dim: usize,
    ) -> PyResult<Self> {
        Ok(EllipsoidCertificate {
            items: name_of_items(proof.items),
            support: row_numbers(py, &proof.support)?,
            multipliers: numbers(py, proof.multipliers.clone())?,
            directions: directions(py, &proof.directions, dim)?,
            left_out: row_numbers(py, &proof.left_out)?,
            gap: proof.gap,
            points_hash: proof.points_hash.to_string(),
        })
    }
}

#[pymethods]
impl EllipsoidCertificate {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let s = self.support.bind(py).len()?;
        let gap = float(py, self.gap)?;
        Ok(format!("EllipsoidCertificate(gap={gap}, support=<{s} {}>)", self.items))
    }
}

/// What the checker proved of an ellipsoid.
///
/// Attributes
/// ----------
/// lower : float
///     No enclosing ellipsoid has a log-volume below this.
/// upper : float
///     Log-volume of the answer, enlarged by `excess` so that it encloses every row.
/// gap : float
///     ``upper - lower``, rounded up.
/// excess : float
///     By how much |F(x - c)| exceeds 1 at worst, rounded up; 0 when every row is inside without any tolerance.
/// matrix_excess : float
///     By how much (x - c) @ Q @ (x - c) can exceed 1 at worst, Q being `matrix` as it stands.
/// off_hull : float
///     No row is farther than this from the flat of a flat set, rounded up; 0 where there is no flat.
/// rank : int
///     The dimension of the ellipsoid itself.
#[pyclass(frozen, get_all, module = "taut")]
pub(crate) struct EllipsoidVerdict {
    lower: f64,
    upper: f64,
    gap: f64,
    excess: f64,
    matrix_excess: f64,
    off_hull: f64,
    rank: usize,
}

impl EllipsoidVerdict {
    pub(crate) fn new(proved: certify::EllipsoidVerdict) -> Self {
        let certify::EllipsoidVerdict { lower, upper, gap, excess, matrix_excess, off_hull, rank } =
            proved;
        EllipsoidVerdict { lower, upper, gap, excess, matrix_excess, off_hull, rank }
    }
}

#[pymethods]
impl EllipsoidVerdict {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let [lower, upper, gap] = [self.lower, self.upper, self.gap].map(|value| float(py, value));
        let rank = self.rank;
        Ok(format!(
            "EllipsoidVerdict(lower={}, upper={}, gap={}, rank={rank})",
            lower?, upper?, gap?
        ))
    }
}
