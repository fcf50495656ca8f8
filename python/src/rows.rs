//! NumPy arrays as points, without a copy.
//!
//! *Trap.* `as_slice` of rust-numpy also accepts Fortran order, whose rows are columns: C order is checked here,
//! although `taut/_arrays.py` has already seen to it.

use numpy::{Element, PyArray2, PyArrayMethods, PyReadonlyArray2, PyUntypedArrayMethods};
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

/// The rows of an array in C order.
pub(crate) fn points<'a, T: Scalar + Element>(
    array: &'a PyReadonlyArray2<'_, T>,
) -> PyResult<Points<'a, T>> {
    if !array.is_c_contiguous() {
        return Err(PyValueError::new_err("expected an array in C order"));
    }
    Points::new(array.as_slice()?, array.shape()[1])
        .map_err(|error| PyValueError::new_err(error.to_string()))
}
