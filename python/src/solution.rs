//! Solutions as Python sees them: attributes that mirror the Rust fields, arrays that cannot be written to.

use numpy::{PyArray1, PyArray2};
use pyo3::create_exception;
use pyo3::exceptions::{PyAttributeError, PyException, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use taut::Items;
use taut::certify::{self, AnySolution, AnyVerdict, CheckError, Stop};

use crate::centers::{Centers, CentersCertificate, CentersVerdict};
use crate::curve::{Curve, CurveCertificate, CurveVerdict};
use crate::ellipsoid::{Ellipsoid, EllipsoidCertificate, EllipsoidVerdict, directions};
use crate::inscribed::{InscribedCertificate, InscribedEllipsoid, InscribedVerdict};
use crate::items::{name_of_items, words};
use crate::numbers::float;
use crate::order::{Order, OrderCertificate, OrderVerdict};
use crate::robust::{RobustCertificate, RobustEllipsoid, RobustVerdict};
use crate::rows::{Rows, numbers};
use crate::surface::{Surface, SurfaceCertificate, SurfaceVerdict};
use crate::triangulation::{Triangulation, TriangulationCertificate, TriangulationVerdict};
use crate::work::interruptible;

create_exception!(
    taut,
    Violation,
    PyException,
    "An answer or its certificate is wrong for these points; the message says what and by how much."
);

/// A ball in d dimensions.
///
/// Attributes
/// ----------
/// center : ndarray of shape (d,)
///     The centre, rounded to float64. Read-only.
/// center_tail : ndarray of shape (d,)
///     What is to be added to `center` for the exact centre: zeros, unless the points lie so far from the origin
///     that the rounding would cost more than 1e-15 of the radius. Read-only.
/// radius : float
///     The radius.
#[pyclass(frozen, get_all, module = "taut")]
pub(crate) struct Ball {
    center: Py<PyArray1<f64>>,
    center_tail: Py<PyArray1<f64>>,
    radius: f64,
}

#[pymethods]
impl Ball {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let d = self.center.bind(py).len()?;
        Ok(format!("Ball(radius={}, center=<{d} coordinates>)", float(py, self.radius)?))
    }
}

/// Convex multipliers over few rows: the proof that no much smaller ball exists.
///
/// Attributes
/// ----------
/// items : str
///     ``"points"``, ``"balls"`` or ``"ellipsoids"``.
/// support : ndarray of int64, shape (s,)
///     Row numbers with a positive multiplier, ascending; an ellipsoid that touches in several points occurs several
///     times. Read-only.
/// multipliers : ndarray of float64, shape (s,)
///     The multipliers, in the order of `support`; they sum to 1. Read-only.
/// directions : ndarray of float64, shape (s, d) or (0, d)
///     For ellipsoids {m + v : v v.T <= S}, directions a in which they touch: at m + S a / sqrt(a S a). Read-only.
/// gap : float
///     The gap claimed: radius <= (1 + gap) R*.
/// points_hash : str
///     Hash of the rows this was made for, 16 hexadecimal digits.
#[pyclass(frozen, get_all, module = "taut")]
pub(crate) struct BallCertificate {
    items: &'static str,
    support: Py<PyArray1<i64>>,
    multipliers: Py<PyArray1<f64>>,
    directions: Py<PyArray2<f64>>,
    gap: f64,
    points_hash: String,
}

#[pymethods]
impl BallCertificate {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let s = self.support.bind(py).len()?;
        let gap = float(py, self.gap)?;
        Ok(format!("BallCertificate(gap={gap}, support=<{s} {}>)", self.items))
    }
}

/// The bounds known after one pass over all points.
///
/// Attributes
/// ----------
/// lower, upper : float
///     Proved lower bound on the optimal radius or log-volume, and one with which all points are enclosed.
/// working_set : int
///     Points in the working set then.
#[pyclass(frozen, get_all, module = "taut")]
pub(crate) struct PassBounds {
    lower: f64,
    upper: f64,
    working_set: u64,
}

#[pymethods]
impl PassBounds {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let (lower, upper) = (float(py, self.lower)?, float(py, self.upper)?);
        let working_set = self.working_set;
        Ok(format!("PassBounds(lower={lower}, upper={upper}, working_set={working_set})"))
    }
}

/// How an answer came about: counters of events, the same on every run and for every number of threads.
///
/// Attributes
/// ----------
/// method : str
///     The method.
/// stop : str
///     ``"converged"``, ``"rounding"`` (no smaller gap can be proved in float64), ``"pass-budget"``,
///     ``"node-budget"`` or ``"proof-budget"`` (what was found takes too many nodes to prove).
/// passes : int
///     Reads of all points.
/// iterations : int
///     Steps of the inner solver.
/// core_set : int
///     Points the method chose to work on; the support is a part of them.
/// history : tuple of PassBounds
///     Bounds by pass.
/// counters : dict of str to int
///     Other events worth counting, by name. A fresh copy each time.
#[pyclass(frozen, module = "taut")]
pub(crate) struct Trace {
    trace: taut::Trace,
}

impl Trace {
    pub(crate) fn new(trace: taut::Trace) -> Self {
        Trace { trace }
    }
}

#[pymethods]
impl Trace {
    #[getter]
    fn method(&self) -> &str {
        &self.trace.method
    }

    #[getter]
    fn stop(&self) -> &'static str {
        match self.trace.stop {
            Stop::Converged => "converged",
            Stop::Rounding => "rounding",
            Stop::PassBudget => "pass-budget",
            Stop::NodeBudget => "node-budget",
            Stop::ProofBudget => "proof-budget",
        }
    }

    #[getter]
    fn passes(&self) -> u64 {
        self.trace.passes
    }

    #[getter]
    fn iterations(&self) -> u64 {
        self.trace.iterations
    }

    #[getter]
    fn core_set(&self) -> u64 {
        self.trace.core_set
    }

    #[getter]
    fn history<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(
            py,
            self.trace.history.iter().map(|&certify::PassBounds { lower, upper, working_set }| {
                PassBounds { lower, upper, working_set }
            }),
        )
    }

    #[getter]
    fn counters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let counters = PyDict::new(py);
        self.trace.counters.iter().try_for_each(|(name, count)| counters.set_item(name, count))?;
        Ok(counters)
    }

    fn __repr__(&self) -> String {
        let taut::Trace { method, passes, iterations, core_set, .. } = &self.trace;
        let stop = self.stop();
        format!(
            "Trace(method='{method}', stop='{stop}', passes={passes}, iterations={iterations}, core_set={core_set})"
        )
    }
}

/// What the checker proved.
///
/// Attributes
/// ----------
/// lower : float
///     No enclosing shape is smaller than this.
/// upper : float
///     The size of the answer, which was found to enclose every point.
/// gap : float
///     ``upper / lower - 1``, rounded up; 0 where both are 0.
#[pyclass(frozen, get_all, module = "taut")]
pub(crate) struct Verdict {
    lower: f64,
    upper: f64,
    gap: f64,
}

#[pymethods]
impl Verdict {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let [lower, upper, gap] = [self.lower, self.upper, self.gap].map(|value| float(py, value));
        Ok(format!("Verdict(lower={}, upper={}, gap={})", lower?, upper?, gap?))
    }
}

/// An answer, what proves it, and how it came about.
///
/// Two solutions are equal when all their numbers are. Solutions can be pickled.
///
/// Attributes
/// ----------
/// kind : str
///     ``"ball"``, ``"ellipsoid"``, ``"inscribed-ellipsoid"``, ``"robust-ellipsoid"``, ``"centers"``,
///     ``"curve"``, ``"surface"``, ``"order"`` or ``"delaunay"``.
/// answer : Ball, Ellipsoid, InscribedEllipsoid, RobustEllipsoid, Centers, Curve, Surface, Order or Triangulation
///     The shape.
/// certificate : BallCertificate, EllipsoidCertificate and so on
///     Its proof.
/// trace : Trace
///     Counters of the run.
/// simplices, neighbors, hull, duplicates, fingerprint
///     Those of a triangulation, its answer and certificate, for short. Other shapes have none.
#[pyclass(frozen, module = "taut")]
pub(crate) struct Solution {
    solution: AnySolution,
    #[pyo3(get)]
    answer: Py<PyAny>,
    #[pyo3(get)]
    certificate: Py<PyAny>,
    #[pyo3(get)]
    trace: Py<Trace>,
}

impl Solution {
    pub(crate) fn new(py: Python<'_>, solution: AnySolution) -> PyResult<Self> {
        let (answer, certificate, trace) = match &solution {
            AnySolution::Ball(found) => {
                let (answer, certificate) = ball(py, found)?;
                let answer = Py::new(py, answer)?.into_any();
                (answer, Py::new(py, certificate)?.into_any(), found.trace.clone())
            }
            AnySolution::Ellipsoid(found) => {
                let answer = Py::new(py, Ellipsoid::new(py, &found.answer)?)?.into_any();
                let certificate =
                    EllipsoidCertificate::new(py, &found.certificate, found.answer.dim())?;
                (answer, Py::new(py, certificate)?.into_any(), found.trace.clone())
            }
            AnySolution::Inscribed(found) => {
                let answer = Py::new(py, InscribedEllipsoid::new(py, &found.answer)?)?.into_any();
                let certificate = InscribedCertificate::new(py, &found.certificate)?;
                (answer, Py::new(py, certificate)?.into_any(), found.trace.clone())
            }
            AnySolution::Robust(found) => {
                let answer = Py::new(py, RobustEllipsoid::new(py, &found.answer)?)?.into_any();
                let certificate = RobustCertificate::new(py, &found.certificate)?;
                (answer, Py::new(py, certificate)?.into_any(), found.trace.clone())
            }
            AnySolution::Centers(found) => {
                let answer = Py::new(py, Centers::new(py, &found.answer)?)?.into_any();
                let certificate = CentersCertificate::new(py, &found.certificate)?;
                (answer, Py::new(py, certificate)?.into_any(), found.trace.clone())
            }
            AnySolution::Curve(found) => {
                let answer = Py::new(py, Curve::new(py, &found.answer)?)?.into_any();
                let certificate = CurveCertificate::new(&found.certificate);
                (answer, Py::new(py, certificate)?.into_any(), found.trace.clone())
            }
            AnySolution::Surface(found) => {
                let answer = Py::new(py, Surface::new(py, &found.answer)?)?.into_any();
                let certificate = SurfaceCertificate::new(py, &found.certificate)?;
                (answer, Py::new(py, certificate)?.into_any(), found.trace.clone())
            }
            AnySolution::Order(found) => {
                let answer = Py::new(py, Order::new(py, &found.answer)?)?.into_any();
                let certificate = OrderCertificate::new(&found.certificate);
                (answer, Py::new(py, certificate)?.into_any(), found.trace.clone())
            }
            AnySolution::Triangulation(found) => {
                let answer = Py::new(py, Triangulation::new(py, found)?)?.into_any();
                let certificate = TriangulationCertificate::new(&found.certificate);
                (answer, Py::new(py, certificate)?.into_any(), found.trace.clone())
            }
        };
        let trace = Py::new(py, Trace { trace })?;
        Ok(Solution { solution, answer, certificate, trace })
    }

    /// An attribute of a part, which only triangulations have.
    fn of_triangulation(
        &self,
        py: Python<'_>,
        part: &Py<PyAny>,
        name: &str,
    ) -> PyResult<Py<PyAny>> {
        match self.solution {
            AnySolution::Triangulation(_) => part.getattr(py, name),
            AnySolution::Ball(_)
            | AnySolution::Ellipsoid(_)
            | AnySolution::Inscribed(_)
            | AnySolution::Robust(_)
            | AnySolution::Centers(_)
            | AnySolution::Curve(_)
            | AnySolution::Surface(_)
            | AnySolution::Order(_) => {
                let kind = self.kind();
                let holder = match kind {
                    "centers" => "centers have".to_owned(),
                    _ if kind.starts_with(['e', 'i', 'o']) => format!("an {kind} has"),
                    _ => format!("a {kind} has"),
                };
                let problem = format!("{holder} no {name}: triangulations do");
                Err(PyAttributeError::new_err(problem))
            }
        }
    }

    /// Refuses arrays that do not belong to what the answer encloses, and asks for those that do.
    fn match_arrays(&self, is_given: [bool; 4]) -> PyResult<()> {
        let (what, wanted) = match (&self.solution, self.items()) {
            (AnySolution::Centers(found), _) if found.certificate.weights => {
                ("is about points with weights", "weights")
            }
            (AnySolution::Centers(_), Some(Items::Points)) => ("is about points", ""),
            (AnySolution::Centers(_), Some(Items::Balls)) => ("is about balls", "radii"),
            (AnySolution::Inscribed(_), _) => ("lies in half-spaces", "offsets"),
            (_, Some(Items::Balls)) => ("encloses balls", "radii"),
            (_, Some(Items::Ellipsoids)) => ("encloses ellipsoids", "shapes"),
            (
                AnySolution::Robust(_)
                | AnySolution::Curve(_)
                | AnySolution::Surface(_)
                | AnySolution::Order(_),
                _,
            ) => ("speaks of points", ""),
            (_, Some(Items::Points)) => ("encloses points", ""),
            (_, None) => ("joins points", ""),
        };
        let names = ["radii", "shapes", "offsets", "weights"];
        for (name, given) in names.into_iter().zip(is_given) {
            let problem = match (given, name == wanted) {
                (false, true) => format!("the answer {what}: give their {name}"),
                (true, false) => format!("the answer {what}, which have no {name}"),
                _ => continue,
            };
            return Err(PyValueError::new_err(problem));
        }
        Ok(())
    }

    /// What the answer encloses, if it encloses anything.
    fn items(&self) -> Option<Items> {
        match &self.solution {
            AnySolution::Ball(found) => Some(found.certificate.items),
            AnySolution::Ellipsoid(found) => Some(found.certificate.items),
            AnySolution::Robust(_) => Some(Items::Points),
            AnySolution::Centers(found) => Some(found.certificate.items),
            AnySolution::Curve(_) | AnySolution::Surface(_) | AnySolution::Order(_) => {
                Some(Items::Points)
            }
            AnySolution::Inscribed(_) | AnySolution::Triangulation(_) => None,
        }
    }
}

/// Row numbers as NumPy has them: signed.
pub(crate) fn row_numbers(py: Python<'_>, rows: &[u64]) -> PyResult<Py<PyArray1<i64>>> {
    let signed = rows.iter().map(|&row| i64::try_from(row)).collect::<Result<Vec<i64>, _>>();
    numbers(
        py,
        signed
            .map_err(|_| PyValueError::new_err("a row number of the support exceeds 2**63 - 1"))?,
    )
}

/// A ball and its certificate.
fn ball(py: Python<'_>, found: &taut::Solution<taut::Ball>) -> PyResult<(Ball, BallCertificate)> {
    let (ball, proof) = (&found.answer, &found.certificate);
    let tail = if ball.center_tail.is_empty() {
        vec![0.0; ball.center.len()]
    } else {
        ball.center_tail.clone()
    };
    let answer = Ball {
        center: numbers(py, ball.center.clone())?,
        center_tail: numbers(py, tail)?,
        radius: ball.radius,
    };
    let certificate = BallCertificate {
        items: name_of_items(proof.items),
        support: row_numbers(py, &proof.support)?,
        multipliers: numbers(py, proof.multipliers.clone())?,
        directions: directions(py, &proof.directions, ball.center.len())?,
        gap: proof.gap,
        points_hash: proof.points_hash.to_string(),
    };
    Ok((answer, certificate))
}

#[pymethods]
impl Solution {
    #[getter]
    fn kind(&self) -> &'static str {
        match self.solution {
            AnySolution::Ball(_) => "ball",
            AnySolution::Ellipsoid(_) => "ellipsoid",
            AnySolution::Inscribed(_) => "inscribed-ellipsoid",
            AnySolution::Robust(_) => "robust-ellipsoid",
            AnySolution::Centers(_) => "centers",
            AnySolution::Curve(_) => "curve",
            AnySolution::Surface(_) => "surface",
            AnySolution::Order(_) => "order",
            AnySolution::Triangulation(_) => "delaunay",
        }
    }

    /// ``answer.simplices`` of a triangulation.
    #[getter]
    fn simplices(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        self.of_triangulation(py, &self.answer, "simplices")
    }

    /// ``answer.neighbors`` of a triangulation.
    #[getter]
    fn neighbors(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        self.of_triangulation(py, &self.answer, "neighbors")
    }

    /// ``answer.hull`` of a triangulation.
    #[getter]
    fn hull(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        self.of_triangulation(py, &self.answer, "hull")
    }

    /// ``answer.duplicates`` of a triangulation.
    #[getter]
    fn duplicates(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        self.of_triangulation(py, &self.answer, "duplicates")
    }

    /// ``certificate.fingerprint`` of a triangulation.
    #[getter]
    fn fingerprint(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        self.of_triangulation(py, &self.certificate, "fingerprint")
    }

    /// A second opinion: judges the answer over the points, with code that shares nothing with the solver.
    ///
    /// Parameters
    /// ----------
    /// points : array_like of shape (n, d)
    ///     The points, or the centres of the balls or ellipsoids, that the answer was found for; of an inscribed
    ///     ellipsoid the normals.
    /// radii : array_like of shape (n,), optional
    ///     The radii, when the answer is about balls.
    /// shapes : array_like of shape (n, d, d), optional
    ///     The shape matrices, when the answer encloses ellipsoids.
    /// offsets : array_like of shape (n,), optional
    ///     The offsets of the half-spaces, when the answer is inscribed.
    /// weights : array_like of shape (n,), optional
    ///     The weights of the points, when the answer is about points that have some.
    ///
    /// Returns
    /// -------
    /// Verdict, EllipsoidVerdict, InscribedVerdict, RobustVerdict, CentersVerdict, CurveVerdict, SurfaceVerdict or
    /// TriangulationVerdict
    ///     Proved bounds ``lower`` and ``upper``, and their ``gap``; of a robust ellipsoid, of curves and of a triangulation
    ///     what was proved instead.
    ///
    /// Raises
    /// ------
    /// Violation
    ///     When the answer or its certificate is wrong for these points, with the first place where.
    ///
    /// Examples
    /// --------
    /// >>> import taut
    /// >>> found = taut.ball([[0, 0], [2, 0], [1, 1]])
    /// >>> found.check([[0, 0], [2, 0], [1, 1]]).upper
    /// 1.0
    /// >>> found.check([[0, 0], [2, 0], [1, 2]])
    /// Traceback (most recent call last):
    /// taut.Violation: ...
    #[pyo3(signature = (points, radii=None, *, shapes=None, offsets=None, weights=None))]
    fn check(
        &self,
        py: Python<'_>,
        points: &Bound<'_, PyAny>,
        radii: Option<&Bound<'_, PyAny>>,
        shapes: Option<&Bound<'_, PyAny>>,
        offsets: Option<&Bound<'_, PyAny>>,
        weights: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Py<PyAny>> {
        let is_given = [radii, shapes, offsets, weights].map(|array| array.is_some());
        self.match_arrays(is_given)?;
        // Arrays are put in order in one place, and that is written in Python.
        let rows = py
            .import("taut._arrays")?
            .getattr("as_rows")?
            .call1((points, radii, shapes, offsets, weights))?;
        let rows = Rows::borrow(&rows)?;
        let source = rows.source()?;
        let verdict = interruptible(py, |monitor| self.solution.check(source.as_ref(), monitor))?;
        match verdict {
            Ok(AnyVerdict::Ball(certify::Verdict { lower, upper, gap })) => {
                Ok(Py::new(py, Verdict { lower, upper, gap })?.into_any())
            }
            Ok(AnyVerdict::Ellipsoid(proved)) => {
                Ok(Py::new(py, EllipsoidVerdict::new(proved))?.into_any())
            }
            Ok(AnyVerdict::Inscribed(proved)) => {
                Ok(Py::new(py, InscribedVerdict::new(proved))?.into_any())
            }
            Ok(AnyVerdict::Robust(proved)) => {
                Ok(Py::new(py, RobustVerdict::new(py, proved)?)?.into_any())
            }
            Ok(AnyVerdict::Centers(proved)) => {
                Ok(Py::new(py, CentersVerdict::new(proved))?.into_any())
            }
            Ok(AnyVerdict::Curve(proved)) => {
                Ok(Py::new(py, CurveVerdict::new(&proved))?.into_any())
            }
            Ok(AnyVerdict::Surface(proved)) => {
                Ok(Py::new(py, SurfaceVerdict::new(&proved))?.into_any())
            }
            Ok(AnyVerdict::Order(proved)) => {
                Ok(Py::new(py, OrderVerdict::new(&proved))?.into_any())
            }
            Ok(AnyVerdict::Triangulation(proved)) => {
                Ok(Py::new(py, TriangulationVerdict::new(&proved))?.into_any())
            }
            Err(CheckError::Rejected(violation)) => {
                Err(Violation::new_err(words(violation, self.items(), source.dim())))
            }
            Err(error) => Err(PyRuntimeError::new_err(error.to_string())),
        }
    }

    /// The solution as a JSON document, as the command line writes it; numbers read back to the same bits.
    ///
    /// Returns
    /// -------
    /// str
    fn to_json(&self) -> String {
        self.solution.to_json()
    }

    /// Reads what `to_json` or the command line wrote.
    ///
    /// Parameters
    /// ----------
    /// text : str
    ///     The document. Nothing in it is believed until `check` has judged it.
    ///
    /// Returns
    /// -------
    /// Solution
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     When the text is not an answer of taut, or of a newer schema.
    #[staticmethod]
    fn from_json(py: Python<'_>, text: &str) -> PyResult<Self> {
        let solution = AnySolution::from_json(text)
            .map_err(|error| PyValueError::new_err(error.to_string()))?;
        Solution::new(py, solution)
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        other.cast::<Solution>().is_ok_and(|other| self.solution == other.get().solution)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (String,))> {
        Ok((py.get_type::<Solution>().getattr("from_json")?, (self.to_json(),)))
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let kind = self.kind();
        Ok(match &self.solution {
            AnySolution::Ball(found) => {
                let radius = float(py, found.answer.radius)?;
                let gap = float(py, found.certificate.gap)?;
                format!("Solution(kind='{kind}', radius={radius}, gap={gap})")
            }
            AnySolution::Ellipsoid(found) => {
                let volume = float(py, found.answer.log_volume)?;
                let gap = float(py, found.certificate.gap)?;
                format!("Solution(kind='{kind}', log_volume={volume}, gap={gap})")
            }
            AnySolution::Inscribed(found) => {
                let volume = float(py, found.answer.log_volume)?;
                let gap = float(py, found.certificate.gap)?;
                format!("Solution(kind='{kind}', log_volume={volume}, gap={gap})")
            }
            AnySolution::Robust(found) => {
                let log_det = float(py, found.answer.log_det)?;
                let outliers = found.answer.flagged.len();
                format!("Solution(kind='{kind}', log_det={log_det}, outliers={outliers})")
            }
            AnySolution::Centers(found) => {
                let taut::Centers { radius, lower_bound, .. } = found.answer;
                let (radius, lower_bound) = (float(py, radius)?, float(py, lower_bound)?);
                let k = found.certificate.k;
                format!(
                    "Solution(kind='{kind}', k={k}, radius={radius}, lower_bound={lower_bound})"
                )
            }
            AnySolution::Curve(found) => {
                let curves = found.answer.curves.len();
                format!("Solution(kind='{kind}', curves={curves})")
            }
            AnySolution::Surface(found) => {
                let (triangles, parts) =
                    (found.answer.triangles.len(), found.answer.topology.components.len());
                format!("Solution(kind='{kind}', triangles={triangles}, components={parts})")
            }
            AnySolution::Order(found) => {
                let (curve, points) =
                    (crate::order::name(found.answer.curve), found.answer.rows.len());
                format!("Solution(kind='{kind}', curve='{curve}', points={points})")
            }
            AnySolution::Triangulation(found) => {
                let certify::TriangulationCounts { sites, simplices, hull } =
                    found.certificate.counts;
                format!(
                    "Solution(kind='{kind}', sites={sites}, simplices={simplices}, hull={hull})"
                )
            }
        })
    }
}
