//! NumPy arrays as points, without a copy; and answers as arrays that cannot be written to, as what was proved of them
//! would no longer hold.
//!
//! *Trap.* `as_slice` of rust-numpy also accepts Fortran order, whose rows are columns: C order is checked here,
//! although `taut/_arrays.py` has already seen to it.

use numpy::{Element, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use taut::points::Scalar;
use taut::{PointSource, Points};

/// A borrowed n × d array in C order.
pub(crate) enum Rows<'py> {
    F32(PyReadonlyArray2<'py, f32>),
    F64(PyReadonlyArray2<'py, f64>),
}

impl<'py> Rows<'py> {
    /// Borrows `array`, which must be a two-dimensional array of float32 or float64.
    pub(crate) fn borrow(array: &Bound<'py, PyAny>) -> PyResult<Self> {
        if let Ok(array) = array.cast::<PyArray2<f64>>() {
            Ok(Rows::F64(array.try_readonly()?))
        } else if let Ok(array) = array.cast::<PyArray2<f32>>() {
            Ok(Rows::F32(array.try_readonly()?))
        } else {
            Err(PyTypeError::new_err("expected a two-dimensional array of float32 or float64"))
        }
    }

    /// The same memory as a source of points.
    pub(crate) fn source(&self) -> PyResult<Box<dyn PointSource + '_>> {
        match self {
            Rows::F32(array) => Ok(Box::new(points(array)?)),
            Rows::F64(array) => Ok(Box::new(points(array)?)),
        }
    }
}

/// An array as points.
pub(crate) fn points<'a, T: Scalar + Element>(
    array: &'a PyReadonlyArray2<'_, T>,
) -> PyResult<Points<'a, T>> {
    if !array.is_c_contiguous() {
        return Err(PyValueError::new_err("expected an array in C order"));
    }
    Points::new(array.as_slice()?, array.shape()[1])
        .map_err(|error| PyValueError::new_err(error.to_string()))
}

/// An array of the numbers that cannot be written to.
pub(crate) fn numbers<T: Element>(py: Python<'_>, values: Vec<T>) -> PyResult<Py<PyArray1<T>>> {
    let array = PyArray1::from_vec(py, values);
    array.call_method1("setflags", (false,))?;
    Ok(array.unbind())
}

/// Rows of `width` numbers that cannot be written to.
pub(crate) fn table<T: Element>(
    py: Python<'_>,
    values: Vec<T>,
    width: usize,
) -> PyResult<Py<PyArray2<T>>> {
    let rows = values.len().checked_div(width).unwrap_or(0);
    let array = PyArray1::from_vec(py, values).reshape([rows, width])?;
    array.call_method1("setflags", (false,))?;
    Ok(array.unbind())
}
