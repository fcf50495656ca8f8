//! Triangulations of the plane in parts, for `taut.spark`: points are dealt to leaves, and leaves and fronts are triangulated
//! anywhere. All but points is bytes.

use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use taut::delaunay::Error;
use taut::delaunay::outofcore::{
    Extent, FINE_LEVELS, Front, NodeJob, NodePoints, Router, TileCounts, Whole, finish, merge,
    summarize,
};
use taut::points::{PartsError, Scalar};
use taut::{Monitor, Points};

use crate::rows::{Rows, points};
use crate::tiles::raise;
use crate::work::interruptible;

/// Coordinates of a point.
const D: usize = 2;

/// Most levels of leaves, so that all cells together are few.
const LEVELS_MAX: u32 = 14;

fn refused(error: PartsError) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// The rows of an array of points of the plane, −0 as 0.
fn plane(rows: &Bound<'_, PyAny>) -> PyResult<Vec<[f64; D]>> {
    fn pairs<T: Scalar>(points: &Points<'_, T>) -> PyResult<Vec<[f64; D]>> {
        if points.dim() != D {
            return Err(PyValueError::new_err("expected points of the plane: two columns"));
        }
        let pair = |p: &[T; D]| p.map(|x| x.into() + 0.0);
        Ok(points.values().as_chunks::<D>().0.iter().map(pair).collect())
    }
    match Rows::borrow(rows)? {
        Rows::F32(array) => pairs(&points(&array)?),
        Rows::F64(array) => pairs(&points(&array)?),
    }
}

/// The leaf of each row, of 2^levels that a sample cuts, and what others must know of the rows.
#[pyfunction]
pub(crate) fn deal_points<'py>(
    py: Python<'py>,
    rows: &Bound<'py, PyAny>,
    sample: &Bound<'py, PyAny>,
    levels: u32,
) -> PyResult<(Bound<'py, PyArray1<u32>>, Bound<'py, PyBytes>)> {
    if levels > LEVELS_MAX {
        return Err(PyValueError::new_err(format!(
            "levels are {levels}: expected 0 to {LEVELS_MAX}"
        )));
    }
    let (rows, sample) = (plane(rows)?, plane(sample)?);
    let (leaves, extent) = py.detach(|| {
        let router = Router::new(sample, levels + FINE_LEVELS);
        let mut extent = Extent::<D>::new(router.cells());
        let leaf = |&p: &[f64; D]| {
            let cell = router.cell(p);
            extent.add(cell, p);
            (cell >> FINE_LEVELS) as u32
        };
        (rows.iter().map(leaf).collect(), extent)
    });
    Ok((PyArray1::from_vec(py, leaves), PyBytes::new(py, &extent.to_bytes())))
}

/// Merges what others must know.
#[pyfunction]
pub(crate) fn merge_extents<'py>(
    py: Python<'py>,
    extents: Vec<Bound<'py, PyBytes>>,
) -> PyResult<Bound<'py, PyBytes>> {
    let merged = extents
        .iter()
        .map(|extent| Extent::<D>::from_bytes(extent.as_bytes()))
        .reduce(|merged, extent| merged?.merge(&extent?))
        .unwrap_or(Err(PartsError::Missing { row: 0 }))
        .map_err(refused)?;
    Ok(PyBytes::new(py, &merged.to_bytes()))
}

/// A tile and its front as bytes, the rows of the sites of the front, and the counts of the tile: simplices, facets of the hull,
/// duplicates, and the fingerprint in digits.
type Node<'py> =
    (Bound<'py, PyBytes>, Bound<'py, PyBytes>, Bound<'py, PyArray1<u64>>, (u64, u64, u64, String));

fn node<'py>(
    py: Python<'py>,
    extent: &Extent<D>,
    work: impl FnOnce(&Whole<D>, &mut Vec<u8>, &Monitor<'_>) -> Result<(TileCounts, Front<D>), Error>
    + Send,
) -> PyResult<Node<'py>> {
    let whole = extent.whole();
    let done = interruptible(py, |monitor| {
        let mut tile = vec![];
        work(&whole, &mut tile, monitor).map(|(counts, front)| (tile, counts, front))
    })?;
    let (tile, counts, front) = done.map_err(raise)?;
    let TileCounts { simplices, hull, duplicates, fingerprint, .. } = counts;
    Ok((
        PyBytes::new(py, &tile),
        PyBytes::new(py, &front.to_bytes()),
        PyArray1::from_slice(py, front.rows()),
        (simplices, hull, duplicates, fingerprint.to_string()),
    ))
}

/// Triangulates the points of a leaf.
#[pyfunction]
pub(crate) fn triangulate_leaf<'py>(
    py: Python<'py>,
    extent: &[u8],
    number: u32,
    coordinates: &Bound<'py, PyAny>,
    rows: PyReadonlyArray1<'py, u64>,
) -> PyResult<Node<'py>> {
    let sites = NodePoints { coordinates: plane(coordinates)?, rows: rows.as_slice()?.to_vec() };
    if sites.coordinates.len() != sites.rows.len() {
        return Err(PyValueError::new_err("there are not as many row numbers as points"));
    }
    let extent = Extent::<D>::from_bytes(extent).map_err(refused)?;
    let (found, expected) = (sites.rows.len(), extent.points_of(number));
    if found as u64 != expected {
        return Err(PyValueError::new_err(format!(
            "node {number} has {expected} points, and {found} came"
        )));
    }
    let job = NodeJob { node: number, row_bytes: 8, output: "memory" };
    node(py, &extent, move |whole, tile, monitor| summarize(whole, job, sites, tile, monitor))
}

/// Triangulates what is unfinished in the nodes below one; 0 is the root.
#[pyfunction]
pub(crate) fn triangulate_fronts<'py>(
    py: Python<'py>,
    extent: &[u8],
    number: u32,
    fronts: Vec<Bound<'py, PyBytes>>,
) -> PyResult<Node<'py>> {
    let mut all = Front::<D>::empty();
    for front in fronts {
        all.append(Front::from_bytes(front.as_bytes()).map_err(raise)?);
    }
    let extent = Extent::<D>::from_bytes(extent).map_err(refused)?;
    let job = NodeJob { node: number, row_bytes: 8, output: "memory" };
    node(py, &extent, move |whole, tile, monitor| match number {
        0 => Ok((finish(whole, job, all, tile, monitor)?, Front::empty())),
        _ => merge(whole, job, all, tile, monitor),
    })
}
