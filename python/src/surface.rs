//! `taut.surface`, behind its Python signature, and its answer as Python sees it.

use numpy::{PyArray1, PyArray2};
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use taut::certify::{self, AnySolution, Apex};
use taut::reconstruct::Error;
use taut::reconstruct::thesis::{AlphaFilter, Extent, Priority, ThesisOptions};
use taut::{Denoise, Positions, SurfaceMethod, SurfaceMode, SurfaceOptions, surface_of_source};

use crate::numbers::{float, whole};
use crate::rows::{Rows, numbers, table};
use crate::solution::Solution;
use crate::work::interruptible;

/// The surface through the rows of an array.
#[pyfunction]
pub(crate) fn surface(
    py: Python<'_>,
    rows: &Bound<'_, PyAny>,
    method: &str,
    open: bool,
    denoise: bool,
    neighbors: &Bound<'_, PyAny>,
    iterations: &Bound<'_, PyAny>,
    original: bool,
    alpha: Option<f64>,
    epsilon: f64,
    sliver_angle: Option<f64>,
    forbidden_angle: Option<f64>,
    priority: &str,
    restarts: bool,
    threads: &Bound<'_, PyAny>,
) -> PyResult<Solution> {
    let known = SurfaceMethod::ALL.into_iter().find(|known| known.name() == method);
    let method = known.ok_or_else(|| {
        let names = SurfaceMethod::ALL.map(SurfaceMethod::name).join(", ");
        PyValueError::new_err(format!("option `method` is {method:?}: expected one of {names}"))
    })?;
    let known = Priority::NAMES.iter().find(|(name, _)| *name == priority);
    let priority = known.map(|(_, priority)| *priority).ok_or_else(|| {
        let names = Priority::NAMES.map(|(name, _)| name).join(", ");
        PyValueError::new_err(format!("option `priority` is {priority:?}: expected one of {names}"))
    })?;
    let usual = ThesisOptions::default();
    let is_filtered = matches!(method, SurfaceMethod::Thesis | SurfaceMethod::Hull);
    let thesis = ThesisOptions {
        epsilon,
        alpha: alpha.filter(|_| is_filtered).map_or(AlphaFilter::None, AlphaFilter::Circumradius),
        sliver_angle: sliver_angle.unwrap_or(usual.sliver_angle),
        forbidden_angle: forbidden_angle.unwrap_or(usual.forbidden_angle),
        priority,
        extent: if restarts { Extent::Restarts } else { Extent::Front },
        ..usual
    };
    let noise = Denoise {
        neighbors: whole("neighbors", neighbors, "from 4 to 1000")?,
        iterations: whole("iterations", iterations, "from 0 to 100")?,
        positions: if original { Positions::Original } else { Positions::Projected },
    };
    let of_denoise = [
        ("neighbors", noise.neighbors != Denoise::default().neighbors),
        ("iterations", noise.iterations != Denoise::default().iterations),
        ("original", original),
    ];
    if let Some((name, _)) = of_denoise.iter().find(|(_, is_given)| *is_given && !denoise) {
        return Err(PyValueError::new_err(format!("option `{name}` is of denoise=True")));
    }
    let given = [
        ("open", open),
        ("alpha", alpha.is_some()),
        ("epsilon", epsilon != usual.epsilon),
        ("sliver_angle", sliver_angle.is_some()),
        ("forbidden_angle", forbidden_angle.is_some()),
        ("priority", priority != usual.priority),
        ("restarts", restarts),
    ];
    for (name, is_given) in given {
        let methods = SurfaceOptions::methods_of(name);
        if is_given && !methods.contains(&method) {
            let names: Vec<&str> = methods.iter().map(|method| method.name()).collect();
            let (names, method) = (names.join(" and "), method.name());
            let message = format!("option `{name}` is of method {names}, not of {method}");
            return Err(PyValueError::new_err(message));
        }
    }
    let options = SurfaceOptions {
        method,
        mode: if open { SurfaceMode::Open } else { SurfaceMode::Closed },
        alpha: alpha.filter(|_| method == SurfaceMethod::Alpha),
        thesis,
        denoise: denoise.then_some(noise),
        threads: whole("threads", threads, "1 to 1024, or None")?,
    };
    let rows = Rows::borrow(rows)?;
    let source = rows.source()?;
    let found = interruptible(py, |monitor| surface_of_source(source.as_ref(), &options, monitor))?
        .map_err(raise)?;
    Solution::new(py, AnySolution::Surface(found))
}

/// A wrong input is a `ValueError` with the library's sentence.
fn raise(error: Error) -> PyErr {
    match error {
        Error::Read(_) | Error::Cancelled(_) => PyRuntimeError::new_err(error.to_string()),
        _ => PyValueError::new_err(error.to_string()),
    }
}

/// A surface through points of space: triangles between the rows.
///
/// Attributes
/// ----------
/// triangles : ndarray of uint32, shape (m, 3)
///     The rows at the corners of each triangle, counter-clockwise seen from outside. Of equal rows the first stands for all.
///     Read-only.
/// vertices : ndarray of float64, shape (n, 3), or None
///     Where points were moved, the place of each row; None where every vertex is where its row is. Read-only.
/// components : tuple of SurfaceComponent
///     The connected parts.
/// genus : int or None
///     Handles of all parts together; None if one of them is not a surface with two sides.
/// boundary_loops : int
///     Loops of edges with one triangle.
/// boundary_edges, non_manifold_edges, non_manifold_vertices, inconsistent_edges : int
///     Edges of one triangle, edges of more than two, vertices whose triangles are not one fan, and edges whose two triangles
///     run along them in the same direction. Of a closed surface all are 0.
/// euler_characteristic : int
///     Vertices less edges plus triangles.
/// duplicates : ndarray of uint32, shape (c, 2)
///     Rows that equal an earlier one, each with the first that it equals. Read-only.
/// outliers, interior, unreferenced : ndarray of uint32
///     The other rows that no triangle has: those left out from the beginning, those inside closed parts, and all others.
///     Read-only.
#[pyclass(frozen, get_all, module = "taut")]
pub(crate) struct Surface {
    triangles: Py<PyArray2<u32>>,
    vertices: Option<Py<PyArray2<f64>>>,
    components: Py<PyTuple>,
    genus: Option<u64>,
    boundary_loops: u64,
    boundary_edges: u64,
    non_manifold_edges: u64,
    non_manifold_vertices: u64,
    inconsistent_edges: u64,
    euler_characteristic: i64,
    duplicates: Py<PyArray2<u32>>,
    outliers: Py<PyArray1<u32>>,
    interior: Py<PyArray1<u32>>,
    unreferenced: Py<PyArray1<u32>>,
}

impl Surface {
    pub(crate) fn new(py: Python<'_>, answer: &taut::Surface) -> PyResult<Self> {
        let (topology, unused) = (&answer.topology, &answer.unused);
        let components = topology.components.iter().map(|one| SurfaceComponent {
            first_triangle: one.first_triangle,
            vertices: one.vertices,
            edges: one.edges,
            triangles: one.triangles,
            boundary_loops: one.boundary_loops,
            orientable: one.orientable,
            genus: one.genus,
        });
        let moved = !answer.vertices.is_empty();
        let vertices = moved.then(|| table(py, answer.vertices.concat(), 3)).transpose()?;
        Ok(Surface {
            triangles: table(py, answer.triangles.concat(), 3)?,
            vertices,
            components: PyTuple::new(py, components.collect::<Vec<_>>())?.unbind(),
            genus: topology.genus,
            boundary_loops: topology.boundary_loops,
            boundary_edges: topology.boundary_edges,
            non_manifold_edges: topology.non_manifold_edges,
            non_manifold_vertices: topology.non_manifold_vertices,
            inconsistent_edges: topology.inconsistent_edges,
            euler_characteristic: topology.euler_characteristic,
            duplicates: table(py, unused.duplicates.concat(), 2)?,
            outliers: numbers(py, unused.outliers.clone())?,
            interior: numbers(py, unused.interior.clone())?,
            unreferenced: numbers(py, unused.unreferenced.clone())?,
        })
    }
}

#[pymethods]
impl Surface {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let (triangles, parts) = (self.triangles.bind(py).len()?, self.components.bind(py).len());
        let genus = self.genus.map_or("None".to_owned(), |genus| genus.to_string());
        let loops = self.boundary_loops;
        Ok(format!(
            "Surface(triangles=<{triangles}>, components=<{parts}>, genus={genus}, boundary_loops={loops})"
        ))
    }
}

/// A connected part of a surface.
///
/// Attributes
/// ----------
/// first_triangle : int
///     Its first triangle.
/// vertices, edges, triangles : int
///     How many it has.
/// boundary_loops : int
///     Its boundary loops; 0 of a closed part.
/// orientable : bool
///     Whether it has two sides.
/// genus : int or None
///     Handles, or cross-caps of a part with one side; None of what is no surface.
#[pyclass(frozen, get_all, module = "taut")]
pub(crate) struct SurfaceComponent {
    first_triangle: u32,
    vertices: u64,
    edges: u64,
    triangles: u64,
    boundary_loops: u64,
    orientable: bool,
    genus: Option<u64>,
}

#[pymethods]
impl SurfaceComponent {
    fn __repr__(&self) -> String {
        let genus = self.genus.map_or("None".to_owned(), |genus| genus.to_string());
        let (triangles, loops) = (self.triangles, self.boundary_loops);
        format!("SurfaceComponent(triangles={triangles}, genus={genus}, boundary_loops={loops})")
    }
}

/// What is claimed of a surface, beside its topology.
///
/// Attributes
/// ----------
/// method : str
///     How it was found.
/// apexes : ndarray of int64, shape (m,)
///     For each triangle what shows that it is a Delaunay triangle: a row such that no point is inside the sphere through it and
///     the triangle; -1 for a facet of the convex hull, -2 where the smallest sphere through the triangle is empty. Read-only.
/// embedded : bool
///     Whether it meets itself nowhere.
/// outward : bool
///     Whether closed parts face outwards, or inwards if they are inside others.
/// displacement : float
///     The largest distance of a vertex from its row.
/// points_hash : str
///     Hash of the rows this was made for, 16 hexadecimal digits.
#[pyclass(frozen, get_all, module = "taut")]
pub(crate) struct SurfaceCertificate {
    method: &'static str,
    apexes: Py<PyArray1<i64>>,
    embedded: bool,
    outward: bool,
    displacement: f64,
    points_hash: String,
}

impl SurfaceCertificate {
    pub(crate) fn new(py: Python<'_>, proof: &certify::SurfaceCertificate) -> PyResult<Self> {
        let number = |apex: &Apex| match apex {
            Apex::Row(row) => i64::from(*row),
            Apex::Hull => -1,
            Apex::Gabriel => -2,
        };
        Ok(SurfaceCertificate {
            method: proof.method.name(),
            apexes: numbers(py, proof.apexes.iter().map(number).collect())?,
            embedded: proof.embedded,
            outward: proof.outward,
            displacement: proof.displacement,
            points_hash: proof.points_hash.to_string(),
        })
    }
}

#[pymethods]
impl SurfaceCertificate {
    fn __repr__(&self) -> String {
        let word = |yes: bool| if yes { "True" } else { "False" };
        let (embedded, outward) = (word(self.embedded), word(self.outward));
        format!(
            "SurfaceCertificate(method='{}', embedded={embedded}, outward={outward})",
            self.method
        )
    }
}

/// What the checker proved of a surface.
///
/// Attributes
/// ----------
/// rows, outliers : int
///     How many rows there are, and how many of them were left out as outliers: nothing is claimed of these.
/// triangles, vertices, components, boundary_loops : int
///     How many there are.
/// genus : int or None
///     Handles of all parts together; None if one of them is not a surface with two sides.
/// closed, manifold, oriented, embedded, delaunay, outward : bool
///     Whether it has no boundary; whether each edge has at most two triangles and each vertex one fan; whether triangles agree about
///     sides; whether it meets itself nowhere; whether each triangle has an empty ball; whether closed parts face outwards.
/// displacement : float
///     The largest distance of a vertex from its row, rounded up.
/// certified : bool
///     Whether it is an oriented manifold of Delaunay triangles that meets itself nowhere and faces outwards.
/// doubt : str or None
///     Where it is not, the first reason.
#[pyclass(frozen, get_all, module = "taut")]
pub(crate) struct SurfaceVerdict {
    rows: u64,
    outliers: u64,
    triangles: u64,
    vertices: u64,
    components: u64,
    boundary_loops: u64,
    genus: Option<u64>,
    closed: bool,
    manifold: bool,
    oriented: bool,
    embedded: bool,
    delaunay: bool,
    outward: bool,
    displacement: f64,
    certified: bool,
    doubt: Option<String>,
}

impl SurfaceVerdict {
    pub(crate) fn new(proved: &certify::SurfaceVerdict) -> Self {
        SurfaceVerdict {
            rows: proved.rows,
            outliers: proved.outliers,
            triangles: proved.triangles,
            vertices: proved.vertices,
            components: proved.components,
            boundary_loops: proved.boundary_loops,
            genus: proved.genus,
            closed: proved.is_closed,
            manifold: proved.is_manifold,
            oriented: proved.is_oriented,
            embedded: proved.is_embedded,
            delaunay: proved.is_delaunay,
            outward: proved.is_outward,
            displacement: proved.displacement,
            certified: proved.certified,
            doubt: proved.doubt.map(|doubt| doubt.to_string()),
        }
    }
}

#[pymethods]
impl SurfaceVerdict {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let word = |yes: bool| if yes { "True" } else { "False" };
        let (certified, closed) = (word(self.certified), word(self.closed));
        let displacement = float(py, self.displacement)?;
        let (outliers, rows) = (self.outliers, self.rows);
        Ok(format!(
            "SurfaceVerdict(certified={certified}, closed={closed}, displacement={displacement}, outliers={outliers} of {rows})"
        ))
    }
}
