//! `taut.generate`, behind its Python signature.

use numpy::{Element, PyArray2, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use taut::Distribution;
use taut::points::{Scalar, generate_into};

use crate::ball::whole;
use crate::work::interruptible;

/// Fills the n × d array `out`, which NumPy has allocated.
#[pyfunction]
pub(crate) fn generate(
    py: Python<'_>,
    out: &Bound<'_, PyAny>,
    distribution: &str,
    seed: &Bound<'_, PyAny>,
    thickness: Option<f64>,
    count: Option<&Bound<'_, PyAny>>,
    spread: Option<f64>,
    vertices: Option<&Bound<'_, PyAny>>,
) -> PyResult<()> {
    let seed = whole("seed", seed, "0 to 2**64 - 1")?;
    let points = out.len()? as u64;
    let drawn = named(distribution, points, thickness, count, spread, vertices)?;
    if let Ok(out) = out.cast::<PyArray2<f64>>() {
        fill(py, out, drawn, seed)
    } else if let Ok(out) = out.cast::<PyArray2<f32>>() {
        fill(py, out, drawn, seed)
    } else {
        Err(PyTypeError::new_err("expected a two-dimensional array of float32 or float64"))
    }
}

/// The distribution with a name, which takes the parameters of that name and no others; names and defaults are those
/// of the command line.
fn named(
    name: &str,
    n: u64,
    thickness: Option<f64>,
    count: Option<&Bound<'_, PyAny>>,
    spread: Option<f64>,
    vertices: Option<&Bound<'_, PyAny>>,
) -> PyResult<Distribution> {
    for (parameter, given, owner) in [
        ("thickness", thickness.is_some(), "shell"),
        ("count", count.is_some(), "clusters"),
        ("spread", spread.is_some(), "clusters"),
        ("vertices", vertices.is_some(), "polygon"),
    ] {
        if given && name != owner {
            let message = format!("`{parameter}` belongs to {owner}, not to {name}: leave it out");
            return Err(PyValueError::new_err(message));
        }
    }
    let number = |parameter, value: Option<&Bound<'_, PyAny>>, default| {
        value.map_or(Ok(default), |value| whole(parameter, value, "at least 1"))
    };
    Ok(match name {
        "normal" => Distribution::Normal,
        "uniform" => Distribution::Uniform,
        "cube" => Distribution::CubeVertices,
        "poisson" => Distribution::Poisson,
        "sphere" => Distribution::Sphere,
        "shell" => Distribution::Shell { thickness: thickness.unwrap_or(0.1) },
        "clusters" => Distribution::Clusters {
            count: number("count", count, 5)?,
            spread: spread.unwrap_or(0.05),
        },
        "simplex" => Distribution::Simplex,
        "polygon" => Distribution::Polygon { vertices: number("vertices", vertices, n.max(1))? },
        _ => {
            return Err(PyValueError::new_err(format!(
                "`distribution` is {name}: expected normal, uniform, cube, poisson, sphere, shell, clusters, \
                 simplex or polygon"
            )));
        }
    })
}

fn fill<T: Scalar + Element>(
    py: Python<'_>,
    out: &Bound<'_, PyArray2<T>>,
    distribution: Distribution,
    seed: u64,
) -> PyResult<()> {
    if !out.is_c_contiguous() {
        return Err(PyValueError::new_err("expected an array in C order"));
    }
    let mut out = out.try_readwrite()?;
    let dim = out.shape()[1];
    let values = out.as_slice_mut()?;
    interruptible(py, |_| generate_into(distribution, dim, seed, values))?
        .map_err(|error| PyValueError::new_err(error.to_string()))
}
