//! Triangulations as Python sees them.

use numpy::PyArray2;
use pyo3::prelude::*;
use taut::certify::{self, NO_NEIGHBOR};

use crate::rows::table;

/// The Delaunay triangulation of a point set. Ids are rows of the points, from 0.
///
/// Attributes
/// ----------
/// dimension : int
///     Dimension of the points, 2 or 3.
/// hull_dimension : int or None
///     Dimension of the affine hull of the points: less where all are on a plane, on a line or equal. None for no points.
/// simplices : ndarray of uint32, shape (m, k + 1)
///     Vertices of the simplices, positively oriented; k is `hull_dimension`. Read-only.
/// neighbors : ndarray of int64, shape (m, k + 1)
///     For each vertex the simplex across the facet opposite it; -1 on the hull. Read-only.
/// hull : ndarray of uint32, shape (h, k)
///     The facets of the convex hull, turned outward. Read-only.
/// duplicates : ndarray of uint32, shape (c, 2)
///     Rows that equal an earlier row, each with the first row it equals. Read-only.
#[pyclass(frozen, get_all, module = "taut")]
pub(crate) struct Triangulation {
    dimension: u8,
    hull_dimension: Option<u8>,
    simplices: Py<PyArray2<u32>>,
    neighbors: Py<PyArray2<i64>>,
    hull: Py<PyArray2<u32>>,
    duplicates: Py<PyArray2<u32>>,
}

impl Triangulation {
    pub(crate) fn new(
        py: Python<'_>,
        found: &taut::Solution<taut::Triangulation>,
    ) -> PyResult<Self> {
        let (answer, certificate) = (&found.answer, &found.certificate);
        let width = answer.vertices_per_simplex();
        let neighbor = |&across: &u32| if across == NO_NEIGHBOR { -1 } else { i64::from(across) };
        let neighbors: Vec<i64> = certificate.neighbors.iter().map(neighbor).collect();
        Ok(Triangulation {
            dimension: answer.dimension,
            hull_dimension: answer.hull_dimension,
            simplices: table(py, answer.simplices.clone(), width)?,
            neighbors: table(py, neighbors, width)?,
            hull: table(py, answer.hull.clone(), answer.hull_dimension.map_or(0, usize::from))?,
            duplicates: table(py, answer.duplicates.concat(), 2)?,
        })
    }
}

#[pymethods]
impl Triangulation {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let (simplices, hull) = (self.simplices.bind(py).len()?, self.hull.bind(py).len()?);
        let dimension = self.dimension;
        Ok(format!("Triangulation(dimension={dimension}, simplices=<{simplices}>, hull=<{hull}>)"))
    }
}

/// What ties a triangulation to its points, and makes its check one linear pass.
///
/// Attributes
/// ----------
/// fingerprint : str
///     A hash of the set of simplices and their coordinates, whatever their order.
/// points_hash : str
///     Hash of the rows this was made for, 16 hexadecimal digits.
/// sites : int
///     Distinct points.
#[pyclass(frozen, get_all, module = "taut")]
pub(crate) struct TriangulationCertificate {
    fingerprint: String,
    points_hash: String,
    sites: u64,
}

impl TriangulationCertificate {
    pub(crate) fn new(certificate: &certify::TriangulationCertificate) -> Self {
        TriangulationCertificate {
            fingerprint: certificate.fingerprint.to_string(),
            points_hash: certificate.points_hash.to_string(),
            sites: certificate.counts.sites,
        }
    }
}

#[pymethods]
impl TriangulationCertificate {
    fn __repr__(&self) -> String {
        format!(
            "TriangulationCertificate(sites={}, fingerprint='{}')",
            self.sites, self.fingerprint
        )
    }
}

/// What the checker proved: these simplices are the Delaunay triangulation, and there is no other.
///
/// Attributes
/// ----------
/// sites, simplices, hull : int
///     Distinct points, simplices, and facets of the convex hull.
/// ties : int
///     Facets whose two simplices lie on one sphere, so that the perturbation decided between them.
/// refined : int
///     Signs that double precision left open, decided exactly.
/// fingerprint : str
///     The hash of the simplices.
#[pyclass(frozen, get_all, module = "taut")]
pub(crate) struct TriangulationVerdict {
    sites: u64,
    simplices: u64,
    hull: u64,
    ties: u64,
    refined: u64,
    fingerprint: String,
}

impl TriangulationVerdict {
    pub(crate) fn new(proved: &certify::TriangulationVerdict) -> Self {
        let certify::TriangulationCounts { sites, simplices, hull } = proved.counts;
        let (ties, refined) = (proved.ties, proved.refined);
        let fingerprint = proved.fingerprint.to_string();
        TriangulationVerdict { sites, simplices, hull, ties, refined, fingerprint }
    }
}

#[pymethods]
impl TriangulationVerdict {
    fn __repr__(&self) -> String {
        let TriangulationVerdict { sites, simplices, hull, ties, .. } = self;
        format!(
            "TriangulationVerdict(sites={sites}, simplices={simplices}, hull={hull}, ties={ties})"
        )
    }
}
