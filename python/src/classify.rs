//! `taut.MebClassifier` and `taut.Svdd`, behind their Python classes.

use numpy::{PyArray1, PyArrayMethods};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use taut::points::gather;
use taut::recognize::classify::{Labeled, Model, Preset, PresetOptions, TrainOptions, train};
use taut::{Items, Points};

use crate::choice::choice;
use crate::items::raise;
use crate::numbers::whole;
use crate::rows::Rows;
use crate::work::interruptible;

/// A trained classifier.
#[pyclass(frozen, module = "taut._native")]
pub(crate) struct Classifier {
    model: Model,
}

#[pymethods]
impl Classifier {
    /// The number of the class of each row, −1 where it is rejected; and the scores of all classes, row after row.
    fn predict(&self, py: Python<'_>, rows: &Bound<'_, PyAny>) -> PyResult<(Vec<i64>, Vec<f64>)> {
        let (values, dim) = values(rows)?;
        let found = interruptible(py, |_| match Points::new(&values, dim) {
            Ok(points) => {
                self.model.predict(points).map_err(|error| raise(error, Items::Points, dim))
            }
            Err(error) => Err(PyValueError::new_err(error.to_string())),
        })??;
        let classes = found.iter().map(|found| found.class.map_or(-1, i64::from)).collect();
        Ok((classes, found.into_iter().flat_map(|found| found.scores).collect()))
    }

    /// The model as JSON.
    fn to_json(&self) -> String {
        self.model.to_json()
    }

    /// The model that a JSON holds.
    #[staticmethod]
    fn from_json(text: &str) -> PyResult<Self> {
        match Model::from_json(text) {
            Ok(model) => Ok(Classifier { model }),
            Err(error) => Err(PyValueError::new_err(error.to_string())),
        }
    }
}

/// Learns a classifier from rows and the numbers of their classes.
#[pyfunction]
pub(crate) fn train_classifier(
    py: Python<'_>,
    rows: &Bound<'_, PyAny>,
    labels: &Bound<'_, PyAny>,
    classes: usize,
    method: &str,
    names: (Option<String>, Option<String>, Option<String>),
    numbers: (Option<f64>, Option<Bound<'_, PyAny>>),
    seed: &Bound<'_, PyAny>,
    threads: &Bound<'_, PyAny>,
) -> PyResult<Classifier> {
    let ((scaling, width, cells), (nu, steps)) = (names, numbers);
    let (values, dim) = values(rows)?;
    let labels = labels.cast::<PyArray1<u32>>();
    let labels = labels.map_err(|_| PyTypeError::new_err("expected labels of uint32"))?;
    let labels = labels.try_readonly()?;
    let refused = |error: taut::recognize::Error| raise(error, Items::Points, dim);
    let options = PresetOptions {
        scaling: scaling.map(|name| choice("scaling", &name)).transpose()?,
        width: width
            .map(|text| text.parse())
            .transpose()
            .map_err(|error: taut::points::InputError| PyValueError::new_err(error.to_string()))?,
        cells: cells.map(|name| choice("cells", &name)).transpose()?,
        nu,
        cost: None,
        steps: steps
            .map(|steps| whole("thesis_steps", &steps, "at least 2, or None"))
            .transpose()?,
    };
    let candidates = choice::<Preset>("method", method)?.candidates(&options).map_err(refused)?;
    let options = TrainOptions {
        candidates,
        seed: whole("seed", seed, "0 to 2**64 - 1")?,
        threads: whole("threads", threads, "1 to 1024, or None")?,
        ..TrainOptions::default()
    };
    let names: Vec<String> = (0..classes).map(|class| class.to_string()).collect();
    let points = Points::new(&values, dim);
    let points = points.map_err(|error| PyValueError::new_err(error.to_string()))?;
    let labels = labels.as_slice()?;
    let found = interruptible(py, |monitor| {
        let data = Labeled::new(points, labels, &names)?;
        train(data, &TrainOptions { monitor: *monitor, ..options })
    })?;
    Ok(Classifier { model: found.map_err(refused)? })
}

/// All numbers of an array in double precision, and its columns.
fn values(rows: &Bound<'_, PyAny>) -> PyResult<(Vec<f64>, usize)> {
    let rows = Rows::borrow(rows)?;
    let source = rows.source()?;
    let all: Vec<u64> = (0..source.len()).collect();
    let values = gather(source.as_ref(), &all);
    let values = values.map_err(|error| PyValueError::new_err(error.to_string()))?;
    Ok((values, source.dim()))
}
