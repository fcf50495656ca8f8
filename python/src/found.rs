//! The contents of a `taut.Solution`: a solution of any kind, as Rust has it.

use pyo3::create_exception;
use pyo3::exceptions::{PyException, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use taut::certify::{Answer, AnySolution, CheckError, Solution, with_solution};
use taut::{Error, Items, Monitor, PointSource};

use crate::items::{items_of_name, raise, words};
use crate::object::plain;
use crate::picture::picture;
use crate::rows::Rows;
use crate::work::interruptible;

create_exception!(
    taut,
    Violation,
    PyException,
    "An answer or its certificate is wrong for these points; the message says what and by how much."
);

/// A solution about points, of any kind.
#[pyclass(frozen, eq, module = "taut._native")]
#[derive(PartialEq)]
pub(crate) struct Found(AnySolution);

/// Solves for the rows of an array; `raise` also gets the number of columns.
pub(crate) fn solve<A: Answer, E: Send>(
    py: Python<'_>,
    rows: &Bound<'_, PyAny>,
    solver: impl FnOnce(&dyn PointSource, &Monitor<'_>) -> Result<Solution<A>, E> + Send,
    raise: impl FnOnce(E, usize) -> PyErr,
) -> PyResult<Found>
where
    AnySolution: From<Solution<A>>,
    Solution<A>: Send,
{
    let rows = Rows::borrow(rows)?;
    let source = rows.source()?;
    let found = interruptible(py, |monitor| solver(source.as_ref(), monitor))?;
    Ok(Found::from(found.map_err(|error| raise(error, source.dim()))?))
}

/// Solves for the points that are the rows of an array.
pub(crate) fn solve_points<A: Answer, E: Into<Error> + Send>(
    py: Python<'_>,
    rows: &Bound<'_, PyAny>,
    solver: impl FnOnce(&dyn PointSource, &Monitor<'_>) -> Result<Solution<A>, E> + Send,
) -> PyResult<Found>
where
    AnySolution: From<Solution<A>>,
    Solution<A>: Send,
{
    solve(py, rows, solver, |error, columns| raise(error, Items::Points, columns))
}

impl<A: Answer> From<Solution<A>> for Found
where
    AnySolution: From<Solution<A>>,
{
    fn from(found: Solution<A>) -> Self {
        Found(found.into())
    }
}

impl Found {
    pub(crate) fn of(solution: AnySolution) -> Self {
        Found(solution)
    }

    pub(crate) fn solution(&self) -> &AnySolution {
        &self.0
    }
}

#[pymethods]
impl Found {
    #[getter]
    fn kind(&self) -> &'static str {
        self.0.kind()
    }

    /// Answer, certificate and trace, each as a dict by the names of the JSON.
    fn parts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        with_solution!(&self.0, found => {
            plain(py, &(&found.answer, &found.certificate, &found.trace))
        })
    }

    /// Returns what the checker proves over these rows, as a dict; `items` says what they are.
    fn check<'py>(
        &self,
        py: Python<'py>,
        rows: &Bound<'py, PyAny>,
        items: &str,
    ) -> PyResult<Bound<'py, PyAny>> {
        let items = items_of_name(items)?;
        let rows = Rows::borrow(rows)?;
        let source = rows.source()?;
        match interruptible(py, |monitor| self.0.check(source.as_ref(), monitor))? {
            Ok(verdict) => plain(py, &verdict),
            Err(CheckError::Rejected(violation)) => {
                Err(Violation::new_err(words(violation, items, source.dim())))
            }
            Err(error) => Err(PyRuntimeError::new_err(error.to_string())),
        }
    }

    /// The picture of the answer among these rows; None where there is none.
    fn svg(&self, py: Python<'_>, rows: &Bound<'_, PyAny>) -> PyResult<Option<String>> {
        let rows = Rows::borrow(rows)?;
        let source = rows.source()?;
        interruptible(py, |_| picture(&self.0, source.as_ref()))
    }

    fn to_json(&self) -> String {
        self.0.to_json()
    }

    #[staticmethod]
    fn from_json(text: &str) -> PyResult<Self> {
        AnySolution::from_json(text)
            .map(Found)
            .map_err(|error| PyValueError::new_err(error.to_string()))
    }
}
