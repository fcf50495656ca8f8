//! Whole numbers as Python has them, of any size.

use pyo3::exceptions::{PyOverflowError, PyValueError};
use pyo3::prelude::*;

/// Reads a whole number; one that is too small or too large gets the message of a wrong option.
pub(crate) fn whole<'py, T: FromPyObjectOwned<'py>>(
    name: &'static str,
    value: &Bound<'py, PyAny>,
    expected: &'static str,
) -> PyResult<T> {
    value.extract::<T>().map_err(|error| {
        let error: PyErr = error.into();
        if error.is_instance_of::<PyOverflowError>(value.py()) {
            PyValueError::new_err(format!("option `{name}` is {value}: expected {expected}"))
        } else {
            error
        }
    })
}
