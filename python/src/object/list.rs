//! The elements of a list: numbers side by side, which become one array, or objects.

use numpy::{Element, PyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyList;

use super::Raised;

/// A number of any type that serde knows.
#[derive(Clone, Copy)]
pub(super) enum Number {
    Float(f64),
    Signed(i64),
    Whole(u64),
    Short(u32),
}

impl Number {
    pub(super) fn into_object(self, py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
        Ok(match self {
            Number::Float(value) => value.into_pyobject(py)?.into_any(),
            Number::Signed(value) => value.into_pyobject(py)?.into_any(),
            Number::Whole(value) => value.into_pyobject(py)?.into_any(),
            Number::Short(value) => value.into_pyobject(py)?.into_any(),
        })
    }
}

/// Numbers side by side; the first decides of which type, a float among whole numbers makes floats of all.
enum Numbers {
    Float(Vec<f64>),
    Signed(Vec<i64>),
    Short(Vec<u32>),
}

pub(super) struct List<'py> {
    numbers: Numbers,
    /// Where each row ends, if the elements are rows.
    ends: Vec<usize>,
    pub(super) objects: Vec<Bound<'py, PyAny>>,
}

impl Default for List<'_> {
    fn default() -> Self {
        List { numbers: Numbers::Float(Vec::new()), ends: Vec::new(), objects: Vec::new() }
    }
}

impl<'py> List<'py> {
    pub(super) fn push(&mut self, number: Number) -> Result<(), Raised> {
        // Whole numbers of 64 bits are those of rows, which NumPy counts with a sign.
        let signed = match number {
            Number::Whole(value) => Some(i64::try_from(value).map_err(|_| {
                PyValueError::new_err(format!("row number {value} exceeds 2**63 - 1"))
            })?),
            Number::Signed(value) => Some(value),
            Number::Float(_) | Number::Short(_) => None,
        };
        match (&mut self.numbers, number) {
            (Numbers::Short(values), Number::Short(value)) => values.push(value),
            (Numbers::Float(values), Number::Float(value)) => values.push(value),
            (Numbers::Signed(values), _) if signed.is_some() => values.extend(signed),
            (Numbers::Float(values), _) if values.is_empty() => {
                self.numbers = match (signed, number) {
                    (None, Number::Short(value)) => Numbers::Short(vec![value]),
                    _ => Numbers::Signed(signed.into_iter().collect()),
                };
            }
            _ => self.floats().push(match number {
                Number::Float(value) => value,
                Number::Signed(value) => value as f64,
                Number::Whole(value) => value as f64,
                Number::Short(value) => value.into(),
            }),
        }
        Ok(())
    }

    /// The numbers as floats from now on.
    fn floats(&mut self) -> &mut Vec<f64> {
        match &self.numbers {
            Numbers::Float(_) => {}
            Numbers::Signed(values) => {
                self.numbers = Numbers::Float(values.iter().map(|&value| value as f64).collect());
            }
            Numbers::Short(values) => {
                self.numbers = Numbers::Float(values.iter().copied().map(f64::from).collect());
            }
        }
        match &mut self.numbers {
            Numbers::Float(values) => values,
            Numbers::Signed(_) | Numbers::Short(_) => unreachable!("floats by now"),
        }
    }

    fn count(&self) -> usize {
        match &self.numbers {
            Numbers::Float(values) => values.len(),
            Numbers::Signed(values) => values.len(),
            Numbers::Short(values) => values.len(),
        }
    }

    pub(super) fn end_row(&mut self) {
        self.ends.push(self.count());
    }

    pub(super) fn into_object(self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        if !self.objects.is_empty() {
            if self.count() > 0 {
                return Err(PyValueError::new_err("a list has numbers and other things"));
            }
            return Ok(PyList::new(py, self.objects)?.into_any());
        }
        let array = match self.numbers {
            Numbers::Float(values) => array(py, values),
            Numbers::Signed(values) => array(py, values),
            Numbers::Short(values) => array(py, values),
        };
        let Some(&width) = self.ends.first() else { return closed(array) };
        if (1..).zip(&self.ends).all(|(rows, &end)| end == rows * width) {
            return closed(array.call_method1("reshape", ((self.ends.len(), width),))?);
        }
        let starts = &self.ends[..self.ends.len() - 1];
        py.import("numpy")?.call_method1("split", (closed(array)?, starts))
    }
}

fn array<T: Element>(py: Python<'_>, values: Vec<T>) -> Bound<'_, PyAny> {
    PyArray1::from_vec(py, values).into_any()
}

/// The array, which cannot be written to from now on.
fn closed(array: Bound<'_, PyAny>) -> PyResult<Bound<'_, PyAny>> {
    array.call_method1("setflags", (false,))?;
    Ok(array)
}
