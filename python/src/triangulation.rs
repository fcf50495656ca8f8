//! `taut.spatial.Triangulation`, behind its Python class: a triangulation that is kept to be asked.

use numpy::{Element, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use taut::certify::{AnySolution, Solution, Triangulation as Answer};
use taut::delaunay::{
    Complex, ConvexHull, Error, Plane, Segment, Space, Triangulation, TriangulationIndex,
    convex_hull,
};
use taut::points::{PointsHash, Scalar, hash_points};
use taut::{DelaunayOptions, Items, Monitor, Points};

use crate::found::Found;
use crate::items::raise;
use crate::numbers::whole;
use crate::rows::{Rows, points};
use crate::work::interruptible;

type Numbers<'py> = Bound<'py, PyArray1<i32>>;
type Starts<'py> = Bound<'py, PyArray1<i64>>;
type Places<'py> = Bound<'py, PyArray1<f64>>;
type Table<'py, T> = Bound<'py, PyArray2<T>>;

/// Numbers of rows and simplices, which fit 31 bits; what stands for none becomes −1.
fn numbers<'py>(py: Python<'py>, values: Vec<u32>) -> Numbers<'py> {
    PyArray1::from_vec(py, values.into_iter().map(|x| x as i32).collect())
}

fn starts<'py>(py: Python<'py>, values: Vec<u64>) -> Starts<'py> {
    PyArray1::from_vec(py, values.into_iter().map(|x| x as i64).collect())
}

fn table<'py, T: Element>(array: Bound<'py, PyArray1<T>>, width: usize) -> PyResult<Table<'py, T>> {
    let rows = array.len()?.checked_div(width).unwrap_or(0);
    array.reshape([rows, width])
}

fn refused(error: Error) -> PyErr {
    raise(error, Items::Points, 0)
}

/// A triangulation of the plane or of space, ready to be asked.
enum Index {
    Plane(Box<TriangulationIndex<2, 3>>),
    Space(Box<TriangulationIndex<3, 4>>),
}

/// Does the same with the index of either dimension.
macro_rules! with_index {
    ($index:expr, $name:ident => $work:expr) => {
        match $index {
            Index::Plane($name) => $work,
            Index::Space($name) => $work,
        }
    };
}

/// A triangulation that is kept.
#[pyclass(frozen, module = "taut._native")]
pub(crate) struct KeptTriangulation {
    index: Index,
    /// The hash of the points that it was built from.
    points_hash: PointsHash,
    /// The answer where the points do not span all dimensions; else it is made when asked for.
    degenerate: Option<Solution<Answer>>,
}

/// Builds the triangulation of the dimension of the points.
fn build<T: Scalar>(
    points: &Points<'_, T>,
    threads: Option<usize>,
    monitor: &Monitor<'_>,
) -> Result<KeptTriangulation, Error> {
    let options = DelaunayOptions { threads, monitor: *monitor, ..DelaunayOptions::default() };
    fn kept<T: Scalar, const D: usize, const V: usize>(
        triangulation: Triangulation<D, V>,
        points: &Points<'_, T>,
        monitor: &Monitor<'_>,
        index: impl FnOnce(Box<TriangulationIndex<D, V>>) -> Index,
    ) -> Result<KeptTriangulation, Error> {
        let degenerate = match triangulation.complex() {
            Complex::Full => None,
            _ => Some(triangulation.solution(points, monitor)?),
        };
        let points_hash = hash_points(points, monitor)?;
        let index = index(Box::new(TriangulationIndex::new(triangulation)));
        Ok(KeptTriangulation { index, points_hash, degenerate })
    }
    // The plane refuses other dimensions than its own.
    if points.dim() == 3 {
        return kept(Space::build(points, &options)?, points, monitor, Index::Space);
    }
    kept(Plane::build(points, &options)?, points, monitor, Index::Plane)
}

/// The rows of all simplices.
fn simplices<const D: usize, const V: usize>(index: &TriangulationIndex<D, V>) -> Vec<u32> {
    let of = index.triangulation();
    let mut rows = Vec::with_capacity(V * index.slots().len());
    index.slots().for_each(|t| rows.extend(of.vertices(t).map(|v| of.row(v))));
    rows
}

/// For each vertex of a simplex the one across the facet opposite it, `u32::MAX` for none.
fn neighbors<const D: usize, const V: usize>(index: &TriangulationIndex<D, V>) -> Vec<u32> {
    let (of, count) = (index.triangulation(), index.slots().end);
    let mut numbers = Vec::with_capacity(V * index.slots().len());
    let across = |t, i| Some(of.neighbor(t, i).0).filter(|&other| other < count);
    index.slots().for_each(|t| {
        numbers.extend(std::array::from_fn::<_, V, _>(|i| across(t, i).unwrap_or(u32::MAX)));
    });
    numbers
}

/// The rows of the facets of the hull in the order of the answer: by the simplices behind them, the lowest site of each first.
fn hull_facets<const D: usize, const V: usize>(index: &TriangulationIndex<D, V>) -> Vec<u32> {
    let (of, count) = (index.triangulation(), index.slots().end);
    let mut rows = Vec::new();
    for t in index.slots() {
        for ghost in (0..V).map(|i| of.neighbor(t, i).0).filter(|&other| other >= count) {
            let mut facet = of.hull_facet(ghost);
            // Turning keeps the orientation of three, and an edge stays as it is.
            if D == 3 {
                let first = (0..D).min_by_key(|&i| facet[i]).unwrap_or(0);
                facet.rotate_left(first);
            }
            rows.extend(facet.map(|site| of.row(site)));
        }
    }
    rows
}

#[pymethods]
impl KeptTriangulation {
    #[new]
    fn new(py: Python<'_>, rows: &Bound<'_, PyAny>, threads: &Bound<'_, PyAny>) -> PyResult<Self> {
        let threads: Option<usize> = whole("threads", threads, "1 to 1024, or None")?;
        let built = match &Rows::borrow(rows)? {
            Rows::F32(array) => {
                let points = points(array)?;
                interruptible(py, |monitor| build(&points, threads, monitor))?
            }
            Rows::F64(array) => {
                let points = points(array)?;
                interruptible(py, |monitor| build(&points, threads, monitor))?
            }
        };
        built.map_err(refused)
    }

    /// The dimension of the affine hull of the points; none for no points.
    fn hull_dimension(&self) -> Option<u8> {
        match &self.degenerate {
            Some(solution) => solution.answer.hull_dimension,
            None => Some(self.dimension() as u8),
        }
    }

    /// The solution with its certificate, over the rows that it was built from.
    fn found(&self, py: Python<'_>, rows: &Bound<'_, PyAny>) -> PyResult<Found> {
        if let Some(solution) = &self.degenerate {
            return Ok(Found::of(AnySolution::from(solution.clone())));
        }
        macro_rules! solution {
            ($array:expr) => {{
                let points = points($array)?;
                interruptible(py, |monitor| {
                    with_index!(&self.index, index => {
                        index.triangulation().solution(&points, monitor)
                    })
                })?
            }};
        }
        let found = match &Rows::borrow(rows)? {
            Rows::F32(array) => solution!(array),
            Rows::F64(array) => solution!(array),
        };
        let found = found.map_err(refused)?;
        if found.certificate.points_hash != self.points_hash {
            return Err(PyValueError::new_err(
                "the points were changed after the triangulation was built from them",
            ));
        }
        Ok(Found::of(AnySolution::from(found)))
    }

    fn simplices<'py>(&self, py: Python<'py>) -> PyResult<Table<'py, i32>> {
        let rows = py.detach(|| match &self.degenerate {
            Some(solution) => solution.answer.simplices.clone(),
            None => with_index!(&self.index, index => simplices(index)),
        });
        table(numbers(py, rows), self.corners())
    }

    fn neighbors<'py>(&self, py: Python<'py>) -> PyResult<Table<'py, i32>> {
        let across = py.detach(|| match &self.degenerate {
            Some(solution) => solution.certificate.neighbors.clone(),
            None => with_index!(&self.index, index => neighbors(index)),
        });
        table(numbers(py, across), self.corners())
    }

    fn hull<'py>(&self, py: Python<'py>) -> PyResult<Table<'py, i32>> {
        let rows = py.detach(|| match &self.degenerate {
            Some(solution) => solution.answer.hull.clone(),
            None => with_index!(&self.index, index => hull_facets(index)),
        });
        table(numbers(py, rows), self.corners().saturating_sub(1))
    }

    fn duplicates<'py>(&self, py: Python<'py>) -> PyResult<Table<'py, i32>> {
        table(numbers(py, self.duplicate_rows().as_flattened().to_vec()), 2)
    }

    /// The simplex that each place is in, −1 for none.
    fn locate<'py>(
        &self,
        py: Python<'py>,
        places: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Numbers<'py>> {
        let places = self.places(&places)?;
        let found = interruptible(
            py,
            |monitor| with_index!(&self.index, index => index.locate(&places, monitor)),
        )?;
        Ok(numbers(py, found.map_err(refused)?))
    }

    /// The row nearest to each place, −1 for none.
    fn nearest<'py>(
        &self,
        py: Python<'py>,
        places: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Numbers<'py>> {
        let places = self.places(&places)?;
        let found = interruptible(
            py,
            |monitor| with_index!(&self.index, index => index.nearest(&places, monitor)),
        )?;
        Ok(numbers(py, found.map_err(refused)?))
    }

    /// The natural neighbors of each place: where those of each begin, rows, and weights.
    fn natural_coordinates<'py>(
        &self,
        py: Python<'py>,
        places: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<(Starts<'py>, Numbers<'py>, Places<'py>)> {
        let places = self.places(&places)?;
        let found = interruptible(
            py,
            |monitor| with_index!(&self.index, index => index.natural_coordinates(&places, monitor)),
        )?;
        let found = found.map_err(refused)?;
        let weights = PyArray1::from_vec(py, found.weights);
        Ok((starts(py, found.starts), numbers(py, found.rows), weights))
    }

    /// The natural-neighbor interpolant of values for each row.
    fn interpolate<'py>(
        &self,
        py: Python<'py>,
        values: PyReadonlyArray1<'py, f64>,
        places: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Places<'py>> {
        let (places, values) = (self.places(&places)?, values.as_slice()?);
        let found = interruptible(
            py,
            |monitor| with_index!(&self.index, index => index.interpolate(values, &places, monitor)),
        )?;
        Ok(PyArray1::from_vec(py, found.map_err(refused)?))
    }

    fn circumcenters<'py>(&self, py: Python<'py>) -> PyResult<Table<'py, f64>> {
        let (flat, dim) = interruptible(py, |_| match &self.index {
            Index::Plane(index) => (index.circumcenters().into_flattened(), 2),
            Index::Space(index) => (index.circumcenters().into_flattened(), 3),
        })?;
        table(PyArray1::from_vec(py, flat), dim)
    }

    fn cospherical_groups<'py>(&self, py: Python<'py>) -> PyResult<Numbers<'py>> {
        let groups =
            interruptible(py, |_| with_index!(&self.index, index => index.cospherical_groups()))?;
        Ok(numbers(py, groups))
    }

    /// The Voronoi diagram: vertices, the vertex of each simplex, then ridges as rows, starts and vertices, and regions likewise.
    fn voronoi<'py>(&self, py: Python<'py>) -> PyResult<Diagram<'py>> {
        macro_rules! diagram {
            ($index:expr, $dim:literal) => {{
                let found = interruptible(py, |_| $index.voronoi())?;
                let vertices = PyArray1::from_vec(py, found.vertices.into_flattened());
                Ok((
                    table(vertices, $dim)?,
                    numbers(py, found.of_simplices),
                    table(numbers(py, found.ridge_rows.into_flattened()), 2)?,
                    starts(py, found.ridge_starts),
                    numbers(py, found.ridge_vertices),
                    numbers(py, found.region_rows),
                    starts(py, found.region_starts),
                    numbers(py, found.region_vertices),
                ))
            }};
        }
        match &self.index {
            Index::Plane(index) => diagram!(index, 2),
            Index::Space(index) => diagram!(index, 3),
        }
    }

    /// The alpha complex: simplices, and the facets of the boundary and the singular ones as rows.
    fn alpha_complex<'py>(
        &self,
        py: Python<'py>,
        alpha: f64,
    ) -> PyResult<(Numbers<'py>, Table<'py, i32>, Table<'py, i32>)> {
        macro_rules! complex {
            ($index:expr, $dim:literal) => {{
                let of = $index.triangulation();
                let found = interruptible(py, |_| of.alpha_complex(alpha))?;
                let rows = |facets: Vec<[u32; $dim]>| -> Vec<u32> {
                    facets.into_flattened().into_iter().map(|site| of.row(site)).collect()
                };
                // Slots are numbers here.
                let mut simplices = found.simplices.clone();
                simplices.sort_unstable();
                Ok((
                    numbers(py, simplices),
                    table(numbers(py, rows(found.boundary)), $dim)?,
                    table(numbers(py, rows(found.singular)), $dim)?,
                ))
            }};
        }
        match &self.index {
            Index::Plane(index) => complex!(index, 2),
            Index::Space(index) => complex!(index, 3),
        }
    }

    /// With segments between rows as edges: triangles as rows, which of their edges are parts of segments, which triangles are
    /// inside the rings, and segments with the rows that they go through.
    fn constrained<'py>(
        &self,
        py: Python<'py>,
        segments: Vec<(u32, u32)>,
        ring: bool,
    ) -> PyResult<Constrained<'py>> {
        let Index::Plane(index) = &self.index else {
            return Err(PyValueError::new_err("segments are constraints of points in the plane"));
        };
        let of = index.triangulation();
        let sites = of.sites_of_rows();
        let site = |row: u32| {
            let (count, known) = (sites.len(), sites.get(row as usize).copied());
            known.ok_or_else(|| {
                PyValueError::new_err(format!(
                    "a segment ends at row {row}, and there are {count} rows"
                ))
            })
        };
        let segments = segments
            .into_iter()
            .map(|(from, to)| Ok(Segment { from: site(from)?, to: site(to)?, ring }))
            .collect::<PyResult<Vec<_>>>()?;
        let found = interruptible(py, |_| of.constrained(&segments))?
            .map_err(|error| PyValueError::new_err(error.to_string()))?;
        let finite: Vec<u32> = (0u32..)
            .zip(found.triangles())
            .filter(|(_, triangle)| !triangle.is_ghost())
            .map(|(number, _)| number)
            .collect();
        let vertices = finite.iter().flat_map(|&t| found.triangles()[t as usize].vertices);
        let rows: Vec<u32> = vertices.map(|v| of.row(v)).collect();
        let edges: Vec<bool> = finite
            .iter()
            .flat_map(|&t| (0..3).map(move |i| (t, i)))
            .map(|(t, i)| found.is_constrained(t, i))
            .collect();
        let inside: Vec<bool> = finite.iter().map(|&t| found.is_inside(t)).collect();
        let splits: Vec<u32> =
            found.splits().iter().flat_map(|split| [split.segment, of.row(split.site)]).collect();
        Ok((
            table(numbers(py, rows), 3)?,
            table(PyArray1::from_vec(py, edges), 3)?,
            PyArray1::from_vec(py, inside),
            table(numbers(py, splits), 2)?,
        ))
    }
}

type Diagram<'py> = (
    Table<'py, f64>,
    Numbers<'py>,
    Table<'py, i32>,
    Starts<'py>,
    Numbers<'py>,
    Numbers<'py>,
    Starts<'py>,
    Numbers<'py>,
);

type Constrained<'py> =
    (Table<'py, i32>, Table<'py, bool>, Bound<'py, PyArray1<bool>>, Table<'py, i32>);

impl KeptTriangulation {
    /// The dimension of the points.
    fn dimension(&self) -> usize {
        match &self.index {
            Index::Plane(_) => 2,
            Index::Space(_) => 3,
        }
    }

    /// Vertices of a simplex; 1 if there is none.
    fn corners(&self) -> usize {
        usize::from(self.hull_dimension().unwrap_or(0)) + 1
    }

    fn duplicate_rows(&self) -> &[[u32; 2]] {
        with_index!(&self.index, index => index.triangulation().duplicates())
    }

    fn places<'a>(&self, places: &'a PyReadonlyArray2<'_, f64>) -> PyResult<Points<'a, f64>> {
        let (given, dim) = (points(places)?, self.dimension());
        if given.dim() == dim {
            return Ok(given);
        }
        let given = given.dim();
        Err(PyValueError::new_err(format!(
            "places have dimension {given}, but the triangulation has dimension {dim}"
        )))
    }
}

/// The dimension of the hull, its vertices, facets, neighbors of facets, and the face of each.
type Hull<'py> = (Option<u8>, Numbers<'py>, Table<'py, i32>, Table<'py, i32>, Numbers<'py>);

/// The convex hull of the rows of an array.
#[pyfunction]
pub(crate) fn hull<'py>(
    py: Python<'py>,
    rows: &Bound<'py, PyAny>,
    threads: &Bound<'py, PyAny>,
) -> PyResult<Hull<'py>> {
    let threads: Option<usize> = whole("threads", threads, "1 to 1024, or None")?;
    let rows = Rows::borrow(rows)?;
    let source = rows.source()?;
    let found = interruptible(py, |monitor| {
        let options = DelaunayOptions { threads, monitor: *monitor, ..DelaunayOptions::default() };
        convex_hull(source.as_ref(), &options)
    })?;
    let ConvexHull { hull_dimension, vertices, facets, neighbors, faces, .. } =
        found.map_err(refused)?;
    let width = usize::from(hull_dimension.unwrap_or(0));
    // The ends of a segment are facets of one vertex, with no neighbors.
    let (facets, width) = (numbers(py, facets), width.max(1));
    let neighbors = table(numbers(py, neighbors), width)?;
    Ok((
        hull_dimension,
        numbers(py, vertices),
        table(facets, width)?,
        neighbors,
        numbers(py, faces),
    ))
}
