//! `taut.sphere_tree`, behind its Python signature, and its nodes as arrays.

use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use taut::enclose::Error;
use taut::{Items, SphereTreeOptions, sphere_tree_of_source};

use crate::items::raise;
use crate::numbers::whole;
use crate::rows::{Rows, numbers, points, table};
use crate::solution::row_numbers;
use crate::work::interruptible;

/// The tree of balls around the rows of an array.
#[pyfunction]
pub(crate) fn sphere_tree(
    py: Python<'_>,
    rows: &Bound<'_, PyAny>,
    leaf_size: &Bound<'_, PyAny>,
    epsilon: f64,
    threads: &Bound<'_, PyAny>,
) -> PyResult<SphereTree> {
    let options = SphereTreeOptions {
        leaf_size: whole("leaf_size", leaf_size, "at least 1")?,
        epsilon,
        threads: whole("threads", threads, "1 to 1024, or None")?,
    };
    let rows = Rows::borrow(rows)?;
    let refused = |error: Error| raise(error, Items::Points, 0);
    let tree = match &rows {
        Rows::F32(array) => {
            let points = points(array)?;
            interruptible(py, |monitor| sphere_tree_of_source(&points, &options, monitor))?
        }
        Rows::F64(array) => {
            let points = points(array)?;
            interruptible(py, |monitor| sphere_tree_of_source(&points, &options, monitor))?
        }
    };
    SphereTree::new(py, &tree.map_err(refused)?)
}

/// Balls within balls. Node 0 is the root, and each node comes before its children.
///
/// Attributes
/// ----------
/// centers : ndarray of float64, shape (m, d)
///     The centre of the ball of each node. Read-only.
/// radii : ndarray of float64, shape (m,)
///     Its radius. Read-only.
/// ranges : ndarray of int64, shape (m, 2)
///     The points of node i are the rows ``order[ranges[i, 0]:ranges[i, 1]]``. Read-only.
/// children : ndarray of int64, shape (m, 2)
///     The two nodes that share its points; -1 for a leaf. Read-only.
/// order : ndarray of int64, shape (n,)
///     Row numbers, those of each node side by side. Read-only.
#[pyclass(frozen, get_all, module = "taut")]
pub(crate) struct SphereTree {
    centers: Py<PyArray2<f64>>,
    radii: Py<PyArray1<f64>>,
    ranges: Py<PyArray2<i64>>,
    children: Py<PyArray2<i64>>,
    order: Py<PyArray1<i64>>,
}

impl SphereTree {
    fn new(py: Python<'_>, tree: &taut::SphereTree) -> PyResult<Self> {
        let nodes = &tree.nodes;
        let dim = nodes.first().map_or(0, |node| node.ball.center.len());
        let centers = nodes.iter().flat_map(|node| &node.ball.center).copied().collect();
        let ranges = nodes.iter().flat_map(|node| [node.range.start, node.range.end]);
        let children = nodes.iter().flat_map(|node| match node.children {
            Some(children) => children.map(|child| child as i64),
            None => [-1; 2],
        });
        Ok(SphereTree {
            centers: table(py, centers, dim)?,
            radii: numbers(py, nodes.iter().map(|node| radius(&node.ball)).collect())?,
            ranges: table(py, ranges.map(|end| end as i64).collect(), 2)?,
            children: table(py, children.collect(), 2)?,
            order: row_numbers(py, &tree.order)?,
        })
    }
}

/// The radius from the centre as one `f64` a coordinate: where there is a tail, it is that much farther to the points.
fn radius(ball: &taut::Ball) -> f64 {
    let tail: f64 = ball.center_tail.iter().map(|tail| tail.abs()).sum();
    if tail > 0.0 { (ball.radius + tail).next_up() } else { ball.radius }
}

#[pymethods]
impl SphereTree {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let (nodes, rows) = (self.radii.bind(py).len()?, self.order.bind(py).len()?);
        Ok(format!("SphereTree(nodes=<{nodes}>, order=<{rows} rows>)"))
    }
}
