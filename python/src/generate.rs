//! `taut.generate`, behind its Python signature.

use numpy::{Element, PyArray2, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use taut::points::Distribution;
use taut::points::generate::Parameters;
use taut::points::{Error, Scalar, generate_into};

use crate::numbers::whole;
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
    side: Option<&Bound<'_, PyAny>>,
    angle: Option<f64>,
    turns: Option<f64>,
    noise: Option<f64>,
) -> PyResult<()> {
    let seed = whole("seed", seed, "0 to 2**64 - 1")?;
    let number = |name, given: Option<&Bound<'_, PyAny>>| {
        given.map(|value| whole(name, value, "at least 1")).transpose()
    };
    let given = Parameters {
        thickness,
        count: number("count", count)?,
        spread,
        vertices: number("vertices", vertices)?,
        side: number("side", side)?,
        angle,
        turns,
        noise,
    };
    if let Ok(out) = out.cast::<PyArray2<f64>>() {
        fill(py, out, distribution, &given, seed)
    } else if let Ok(out) = out.cast::<PyArray2<f32>>() {
        fill(py, out, distribution, &given, seed)
    } else {
        Err(PyTypeError::new_err("expected a two-dimensional array of float32 or float64"))
    }
}

fn fill<T: Scalar + Element>(
    py: Python<'_>,
    out: &Bound<'_, PyArray2<T>>,
    distribution: &str,
    given: &Parameters,
    seed: u64,
) -> PyResult<()> {
    if !out.is_c_contiguous() {
        return Err(PyValueError::new_err("expected an array in C order"));
    }
    let refused = |error: Error| PyValueError::new_err(error.to_string());
    let mut out = out.try_readwrite()?;
    let (n, dim) = (out.shape()[0] as u64, out.shape()[1]);
    let distribution = Distribution::named(distribution, n, dim, given).map_err(refused)?;
    let values = out.as_slice_mut()?;
    interruptible(py, |_| generate_into(distribution, dim, seed, values))?.map_err(refused)
}
