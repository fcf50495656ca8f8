//! `taut.generate`, behind its Python signature.

use numpy::{Element, PyArray2, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use taut::Distribution;
use taut::points::{Scalar, generate_into};

use crate::ball::whole;

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
    let distribution = named(distribution, thickness, count, spread, vertices)?;
    if let Ok(out) = out.cast::<PyArray2<f64>>() {
        fill(py, out, distribution, seed)
    } else if let Ok(out) = out.cast::<PyArray2<f32>>() {
        fill(py, out, distribution, seed)
    } else {
        Err(PyTypeError::new_err("expected a two-dimensional array of float32 or float64"))
    }
}

/// The distribution with a name, which takes the parameters of that name and no others.
fn named(
    name: &str,
    thickness: Option<f64>,
    count: Option<&Bound<'_, PyAny>>,
    spread: Option<f64>,
    vertices: Option<&Bound<'_, PyAny>>,
) -> PyResult<Distribution> {
    let wanted: &[&str] = match name {
        "shell" => &["thickness"],
        "clusters" => &["count", "spread"],
        "polygon" => &["vertices"],
        _ => &[],
    };
    for (parameter, given) in [
        ("thickness", thickness.is_some()),
        ("count", count.is_some()),
        ("spread", spread.is_some()),
        ("vertices", vertices.is_some()),
    ] {
        if given && !wanted.contains(&parameter) {
            let message = format!("distribution `{name}` has no parameter `{parameter}`");
            return Err(PyValueError::new_err(message));
        }
    }
    let needs = |parameter| {
        PyValueError::new_err(format!("distribution `{name}` needs the parameter `{parameter}`"))
    };
    let number = |parameter, value: Option<&Bound<'_, PyAny>>| match value {
        Some(value) => whole(parameter, value, "at least 1"),
        None => Err(needs(parameter)),
    };
    Ok(match name {
        "uniform" => Distribution::Uniform,
        "cube-vertices" => Distribution::CubeVertices,
        "normal" => Distribution::Normal,
        "poisson" => Distribution::Poisson,
        "sphere" => Distribution::Sphere,
        "shell" => {
            Distribution::Shell { thickness: thickness.ok_or_else(|| needs("thickness"))? }
        }
        "clusters" => Distribution::Clusters {
            count: number("count", count)?,
            spread: spread.ok_or_else(|| needs("spread"))?,
        },
        "simplex" => Distribution::Simplex,
        "polygon" => Distribution::Polygon { vertices: number("vertices", vertices)? },
        _ => {
            return Err(PyValueError::new_err(format!(
                "distribution is `{name}`: expected uniform, cube-vertices, normal, poisson, sphere, shell, \
                 clusters, simplex or polygon"
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
    py.detach(|| generate_into(distribution, dim, seed, values))
        .map_err(|error| PyValueError::new_err(error.to_string()))
}
