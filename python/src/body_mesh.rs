//! The border of a convex body as arrays, behind `InscribedBodies.mesh`.

use numpy::{Element, PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use taut::certify::{ConvexBody, InscribedBodies};

/// Vertices, and triangles by their numbers.
type MeshArrays<'py> = (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<u32>>);

/// The vertices and triangles of a body on a grid.
#[pyfunction]
pub(crate) fn body_mesh<'py>(
    py: Python<'py>,
    exponent: i32,
    origin: [i64; 3],
    normals: Vec<[i64; 3]>,
    offsets: Vec<i64>,
) -> PyResult<MeshArrays<'py>> {
    let body = ConvexBody { normals, offsets, volume: 0.0 };
    let answer = InscribedBodies {
        exponent,
        origin,
        disjoint: false,
        caps: vec![],
        at: vec![],
        ends: vec![],
        bodies: vec![],
    };
    let (vertices, triangles) = answer.mesh(&body);
    Ok((rows(py, vertices)?, rows(py, triangles)?))
}

fn rows<T: Element>(py: Python<'_>, found: Vec<[T; 3]>) -> PyResult<Bound<'_, PyArray2<T>>> {
    let count = found.len();
    PyArray1::from_vec(py, found.into_iter().flatten().collect()).reshape([count, 3])
}
