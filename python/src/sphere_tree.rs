//! `taut.sphere_tree`, behind its Python signature, and its nodes as arrays.

use pyo3::prelude::*;
use taut::{Items, SphereTreeOptions};

use crate::items::raise;
use crate::numbers::whole;
use crate::object::plain;
use crate::rows::Rows;
use crate::work::interruptible;

/// The arrays of a `taut.SphereTree`.
type Arrays<'py> = [Bound<'py, PyAny>; 5];

/// The tree of balls around the rows of an array.
#[pyfunction]
pub(crate) fn sphere_tree<'py>(
    py: Python<'py>,
    rows: &Bound<'py, PyAny>,
    leaf_size: &Bound<'py, PyAny>,
    epsilon: f64,
    threads: &Bound<'py, PyAny>,
) -> PyResult<Arrays<'py>> {
    let options = SphereTreeOptions {
        leaf_size: whole("leaf_size", leaf_size, "at least 1")?,
        epsilon,
        threads: whole("threads", threads, "1 to 1024, or None")?,
        ..SphereTreeOptions::default()
    };
    let rows = Rows::borrow(rows)?;
    let source = rows.source()?;
    let tree = interruptible(py, |monitor| {
        let options = SphereTreeOptions { monitor: *monitor, ..options };
        taut::sphere_tree(source.as_ref(), &options)
    })?;
    arrays(py, &tree.map_err(|error| raise(error, Items::Points, 0))?)
}

/// Centers, radii, ranges and children of the nodes, and the order of the rows.
fn arrays<'py>(py: Python<'py>, tree: &taut::enclose::SphereTree) -> PyResult<Arrays<'py>> {
    let centers: Vec<&[f64]> = tree.nodes.iter().map(|node| &node.ball.center[..]).collect();
    let radii: Vec<f64> = tree.nodes.iter().map(|node| radius(&node.ball)).collect();
    let ranges: Vec<_> = tree.nodes.iter().map(|node| (node.range.start, node.range.end)).collect();
    let children = tree.nodes.iter().map(|node| match node.children {
        Some(children) => children.map(|child| child as i64),
        None => [-1; 2],
    });
    let children: Vec<_> = children.collect();
    Ok([
        plain(py, &centers)?,
        plain(py, &radii)?,
        plain(py, &ranges)?,
        plain(py, &children)?,
        plain(py, &tree.order)?,
    ])
}

/// The radius from the center as one `f64` a coordinate: where there is a tail, it is that much farther to the points.
fn radius(ball: &taut::certify::Ball) -> f64 {
    let tail: f64 = ball.center_tail.iter().map(|tail| tail.abs()).sum();
    if tail > 0.0 { (ball.radius + tail).next_up() } else { ball.radius }
}
