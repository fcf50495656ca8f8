//! `taut.passes`: solvers that ask, and the answers of parts, all but the solver as bytes.

use std::sync::{Mutex, PoisonError};
use std::thread::available_parallelism;

use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use taut::certify::{AnySolution, CheckError, PartialVerdict, Placement};
use taut::enclose::passes::{Partial, Query, RobustSolver, Solver};
use taut::enclose::{CentersMethod, CentersOptions, Error, StreamingCenters, StreamingOptions};
use taut::points::{Blocks, PartsError, THREADS_MAX, on_threads};
use taut::{BallMethod, BallOptions, Items, RobustOptions};

use crate::ellipsoid::options;
use crate::found::{Found, Violation};
use crate::items::{items_of_name, raise, words};
use crate::numbers::whole;
use crate::object::plain;
use crate::rows::Rows;
use crate::work::interruptible;

/// A solver that waits for answers.
#[pyclass(frozen, module = "taut._native")]
pub(crate) struct PassSolver {
    /// Taken when the solution is.
    solver: Mutex<Option<Solver>>,
    items: Items,
    columns: usize,
}

#[pymethods]
impl PassSolver {
    /// The solver of the smallest ball; options are those of `ball`.
    #[staticmethod]
    fn ball(
        rows: u64,
        columns: usize,
        items: &str,
        epsilon: f64,
        method: &str,
        batch: &Bound<'_, PyAny>,
        delta: Option<f64>,
        max_passes: &Bound<'_, PyAny>,
        threads: &Bound<'_, PyAny>,
        seed: &Bound<'_, PyAny>,
    ) -> PyResult<Self> {
        let items = items_of_name(items)?;
        let method = method.parse::<BallMethod>().map_err(|error| raise(error, items, 0))?;
        let options = BallOptions {
            inputs: items,
            epsilon,
            method,
            batch: whole("batch", batch, "at least 1, or None")?,
            delta,
            max_passes: whole("max_passes", max_passes, "at least 3")?,
            threads: Some(living(whole("threads", threads, "1 to 1024, or None")?)),
            seed: whole("seed", seed, "0 to 2**64 - 1")?,
            ..BallOptions::default()
        };
        let solver =
            Solver::ball(rows, columns, options).map_err(|error| raise(error, items, columns))?;
        Ok(PassSolver { solver: Mutex::new(Some(solver)), items, columns })
    }

    /// The solver of the ellipsoid of least volume; options are those of `ellipsoid`.
    #[staticmethod]
    fn ellipsoid(
        rows: u64,
        columns: usize,
        epsilon: f64,
        max_passes: &Bound<'_, PyAny>,
        threads: &Bound<'_, PyAny>,
        seed: &Bound<'_, PyAny>,
    ) -> PyResult<Self> {
        let mut options = options(epsilon, "newton", max_passes, threads, seed)?;
        options.threads = Some(living(options.threads));
        let items = Items::Points;
        let solver = Solver::ellipsoid(rows, columns, options)
            .map_err(|error| raise(error, items, columns))?;
        Ok(PassSolver { solver: Mutex::new(Some(solver)), items, columns })
    }

    /// The solver of centers whose cover has seen all rows.
    #[staticmethod]
    fn centers(cover: &[u8], discrete: bool) -> PyResult<Self> {
        let cover = StreamingCenters::from_bytes(cover).map_err(refused)?;
        let (items, columns) = (Items::Points, cover.dim());
        let placement = if discrete { Placement::Rows } else { Placement::Free };
        let solver = Solver::centers(cover, placement);
        Ok(PassSolver { solver: Mutex::new(Some(solver)), items, columns })
    }

    /// The solver of k centers by a traversal or over a core-set; options are those of `centers`.
    #[staticmethod]
    fn k_centers(
        rows: u64,
        columns: usize,
        k: &Bound<'_, PyAny>,
        method: &str,
        epsilon: f64,
        discrete: bool,
        max_nodes: &Bound<'_, PyAny>,
        threads: &Bound<'_, PyAny>,
    ) -> PyResult<Self> {
        let items = Items::Points;
        let options = CentersOptions {
            method: method.parse::<CentersMethod>().map_err(|error| raise(error, items, 0))?,
            epsilon,
            placement: if discrete { Placement::Rows } else { Placement::Free },
            max_nodes: whole("max_nodes", max_nodes, "0 to 2**64 - 1")?,
            threads: Some(living(whole("threads", threads, "1 to 1024, or None")?)),
            ..CentersOptions::default()
        };
        let k = whole("k", k, "at least 1")?;
        let solver = Solver::k_centers(rows, columns, k, options)
            .map_err(|error| raise(error, items, columns))?;
        Ok(PassSolver { solver: Mutex::new(Some(solver)), items, columns })
    }

    /// The open query; None at the end.
    fn query<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyBytes>>> {
        let asked = interruptible(py, |monitor| {
            let mut solver = self.solver.lock().unwrap_or_else(PoisonError::into_inner);
            let query = solver.as_mut()?.query(monitor);
            query.ok()?.map(Query::to_bytes)
        })?;
        Ok(asked.map(|bytes| PyBytes::new(py, &bytes)))
    }

    /// Hands over the merged answer of all parts.
    fn feed(&self, partial: &[u8]) -> PyResult<()> {
        let partial = Partial::from_bytes(partial).map_err(refused)?;
        let mut solver = self.solver.lock().unwrap_or_else(PoisonError::into_inner);
        solver.as_mut().map_or(Err(refused(PartsError::Question)), |solver| {
            solver.feed(partial).map_err(refused)
        })
    }

    /// The solution; the solver ends with it.
    fn solution(&self, py: Python<'_>) -> PyResult<Found> {
        let solver = self.solver.lock().unwrap_or_else(PoisonError::into_inner).take();
        let Some(solver) = solver else {
            return Err(PyValueError::new_err("the solution was taken already"));
        };
        let found = interruptible(py, |monitor| solver.solution(monitor))?;
        found.map(Found::of).map_err(|error| self.raise(error))
    }
}

impl PassSolver {
    fn raise(&self, error: Error) -> PyErr {
        raise(error, self.items, self.columns)
    }
}

/// A solver of robust ellipsoids that waits for answers.
#[pyclass(frozen, module = "taut._native")]
pub(crate) struct RobustPasses {
    /// Taken when the estimate is.
    solver: Mutex<Option<RobustSolver>>,
    columns: usize,
}

#[pymethods]
impl RobustPasses {
    #[new]
    fn new(
        rows: u64,
        columns: usize,
        coverage: Option<f64>,
        level: f64,
        threads: &Bound<'_, PyAny>,
    ) -> PyResult<Self> {
        let threads = Some(living(whole("threads", threads, "1 to 1024, or None")?));
        let options = RobustOptions { coverage, level, threads, ..RobustOptions::default() };
        let solver = RobustSolver::new(rows, columns, options)
            .map_err(|error| raise(error, Items::Points, columns))?;
        Ok(RobustPasses { solver: Mutex::new(Some(solver)), columns })
    }

    /// The open query; None at the end.
    fn query<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyBytes>>> {
        let asked = interruptible(py, |monitor| {
            let mut solver = self.solver.lock().unwrap_or_else(PoisonError::into_inner);
            let query = solver.as_mut()?.query(monitor);
            query.ok()?.map(Query::to_bytes)
        })?;
        Ok(asked.map(|bytes| PyBytes::new(py, &bytes)))
    }

    /// Hands over the merged answer of all parts.
    fn feed(&self, partial: &[u8]) -> PyResult<()> {
        let partial = Partial::from_bytes(partial).map_err(refused)?;
        let mut solver = self.solver.lock().unwrap_or_else(PoisonError::into_inner);
        solver.as_mut().map_or(Err(refused(PartsError::Question)), |solver| {
            solver.feed(partial).map_err(refused)
        })
    }

    /// The answer without outliers as a dict; the objective, the rows kept and those not weighed out; the trace as a dict.
    fn solution<'py>(&self, py: Python<'py>) -> PyResult<RobustFound<'py>> {
        let solver = self.solver.lock().unwrap_or_else(PoisonError::into_inner).take();
        let Some(solver) = solver else {
            return Err(PyValueError::new_err("the solution was taken already"));
        };
        let found = interruptible(py, |monitor| solver.solution(monitor))?;
        let found = found.map_err(|error| raise(error, Items::Points, self.columns))?;
        let (answer, trace) = (plain(py, &found.answer)?, plain(py, &found.trace)?);
        Ok((answer, found.objective, found.kept, found.weighed, trace))
    }
}

type RobustFound<'py> = (Bound<'py, PyAny>, f64, u64, u64, Bound<'py, PyAny>);

/// The threads of a solver, which works on a thread of its own.
///
/// *Trap.* It outlives the call that starts it, and the global pool has no threads in a process that was forked: so it takes a pool of
/// its own.
fn living(threads: Option<usize>) -> usize {
    let all = || available_parallelism().map_or(1, |count| count.get().min(THREADS_MAX));
    threads.unwrap_or_else(all)
}

/// Rows, columns and whether it is a pass, of a query.
#[pyfunction]
pub(crate) fn query_shape(query: &[u8]) -> PyResult<(u64, usize, bool)> {
    let query = Query::from_bytes(query).map_err(refused)?;
    Ok((query.rows(), query.columns(), query.is_pass()))
}

/// Answers a query for whole blocks of rows.
#[pyfunction]
pub(crate) fn run_query<'py>(
    py: Python<'py>,
    query: &[u8],
    rows: &Bound<'py, PyAny>,
    first_row: u64,
    threads: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyBytes>> {
    let query = Query::from_bytes(query).map_err(refused)?;
    let threads = whole("threads", threads, "1 to 1024, or None")?;
    let rows = Rows::borrow(rows)?;
    let source = rows.source()?;
    let partial = interruptible(py, |monitor| {
        on_threads(threads, || query.run(source.as_ref(), first_row, monitor))
    })?;
    let partial = partial.map_err(|error| raise(error, Items::Points, query.columns()))?;
    Ok(PyBytes::new(py, &partial.to_bytes()))
}

/// A cover that has seen no rows.
#[pyfunction]
pub(crate) fn new_stream<'py>(
    py: Python<'py>,
    columns: usize,
    k: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyBytes>> {
    let k = whole("k", k, "at least 1")?;
    let cover = StreamingCenters::new(columns, k, &StreamingOptions::DEFAULT)
        .map_err(|error| raise(error, Items::Points, columns))?;
    Ok(PyBytes::new(py, &cover.to_bytes()))
}

/// A cover that has seen some rows more.
#[pyfunction]
pub(crate) fn add_to_stream<'py>(
    py: Python<'py>,
    cover: &[u8],
    rows: &Bound<'py, PyAny>,
    threads: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyBytes>> {
    let mut cover = StreamingCenters::from_bytes(cover).map_err(refused)?;
    let threads = whole("threads", threads, "1 to 1024, or None")?;
    let rows = Rows::borrow(rows)?;
    let source = rows.source()?;
    let added = interruptible(py, |monitor| {
        on_threads(threads, || cover.add_source(source.as_ref(), monitor))
    })?;
    added.map_err(|error| raise(error, Items::Points, source.dim()))?;
    Ok(PyBytes::new(py, &cover.to_bytes()))
}

/// Merges answers to a query.
#[pyfunction]
pub(crate) fn merge_partials<'py>(
    py: Python<'py>,
    partials: Vec<Bound<'py, PyBytes>>,
) -> PyResult<Bound<'py, PyBytes>> {
    let merged = partials
        .iter()
        .map(|partial| Partial::from_bytes(partial.as_bytes()))
        .reduce(|merged, partial| merged?.merge(partial?))
        .unwrap_or(Err(PartsError::Missing { row: 0 }))
        .map_err(refused)?;
    Ok(PyBytes::new(py, &merged.to_bytes()))
}

/// Merges what was found of an answer in several parts.
#[pyfunction]
pub(crate) fn merge_verdicts<'py>(
    py: Python<'py>,
    partials: Vec<Bound<'py, PyBytes>>,
) -> PyResult<Bound<'py, PyBytes>> {
    Ok(PyBytes::new(py, &merged_verdict(&partials)?.to_bytes()))
}

fn merged_verdict(partials: &[Bound<'_, PyBytes>]) -> PyResult<PartialVerdict> {
    partials
        .iter()
        .map(|partial| PartialVerdict::from_bytes(partial.as_bytes()))
        .reduce(|merged, partial| merged?.merge(partial?))
        .unwrap_or(Err(PartsError::Missing { row: 0 }))
        .map_err(refused)
}

/// Rows of a block where there are `columns` numbers in a row.
#[pyfunction]
pub(crate) fn rows_of_block(columns: usize) -> u64 {
    Blocks::new(u64::MAX, columns).range(0).end
}

/// Judges an answer over whole blocks of rows.
#[pyfunction]
pub(crate) fn check_part<'py>(
    py: Python<'py>,
    found: &Bound<'py, Found>,
    rows: &Bound<'py, PyAny>,
    first_row: u64,
    count: u64,
    threads: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyBytes>> {
    let threads = whole("threads", threads, "1 to 1024, or None")?;
    let rows = Rows::borrow(rows)?;
    let source = rows.source()?;
    let solution = found.get().solution();
    let judged = interruptible(py, |monitor| {
        let judge =
            || Ok::<_, Error>(solution.check_part(source.as_ref(), first_row, count, monitor));
        on_threads(threads, judge)
    })?;
    let judged = judged.map_err(|error| raise(error, Items::Points, source.dim()))?;
    let partial = judged.map_err(|error| judgment(error, solution, source.dim()))?;
    Ok(PyBytes::new(py, &partial.to_bytes()))
}

/// The verdict from what was found in all parts, as a dict.
#[pyfunction]
pub(crate) fn check_parts<'py>(
    py: Python<'py>,
    found: &Bound<'py, Found>,
    columns: usize,
    partials: Vec<Bound<'py, PyBytes>>,
) -> PyResult<Bound<'py, PyAny>> {
    let solution = found.get().solution();
    let merged = merged_verdict(&partials)?;
    match interruptible(py, |monitor| solution.check_parts(&merged, monitor))? {
        Ok(verdict) => plain(py, &verdict),
        Err(error) => Err(judgment(error, solution, columns)),
    }
}

/// Returns the exception for an error of the checker.
fn judgment(error: CheckError, solution: &AnySolution, columns: usize) -> PyErr {
    let items = match solution {
        AnySolution::Ball(found) => found.certificate.items,
        _ => Items::Points,
    };
    match error {
        CheckError::Rejected(violation) => Violation::new_err(words(violation, items, columns)),
        CheckError::Read(error) => PyRuntimeError::new_err(error.to_string()),
        error => PyValueError::new_err(error.to_string()),
    }
}

fn refused(error: PartsError) -> PyErr {
    PyValueError::new_err(error.to_string())
}
