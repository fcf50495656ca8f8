//! Triangulations as folders of tiles, behind their Python signatures.

use std::path::PathBuf;

use pyo3::exceptions::{PyMemoryError, PyOSError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use taut::certify::{TilesError, TilesOptions, TilesViolation};
use taut::delaunay::Error;
use taut::delaunay::outofcore::{FolderOptions, delaunay_to_folder};

use crate::found::Violation;
use crate::numbers::whole;
use crate::object::plain;
use crate::rows::Rows;
use crate::work::interruptible;

/// Most numbers that the options for memory take.
pub(crate) const SIZE: &str = "a number of bytes";

/// Triangulates the rows of an array to a folder.
#[pyfunction]
pub(crate) fn delaunay_tiles(
    py: Python<'_>,
    rows: &Bound<'_, PyAny>,
    folder: PathBuf,
    memory: &Bound<'_, PyAny>,
    threads: &Bound<'_, PyAny>,
    resume: bool,
) -> PyResult<()> {
    let (memory, threads) =
        (whole("memory", memory, SIZE)?, whole("threads", threads, "1 to 1024, or None")?);
    let rows = Rows::borrow(rows)?;
    let source = rows.source()?;
    let made = interruptible(py, |monitor| {
        let options = FolderOptions {
            memory,
            threads,
            resume,
            monitor: *monitor,
            ..FolderOptions::default()
        };
        delaunay_to_folder(&*source, &folder, &options)
    })?;
    made.map(drop).map_err(raise)
}

/// Returns what the checker proves of a folder, as a dict.
#[pyfunction]
pub(crate) fn check_tiles<'py>(
    py: Python<'py>,
    rows: &Bound<'py, PyAny>,
    folder: PathBuf,
    memory: &Bound<'py, PyAny>,
    scratch: Option<PathBuf>,
) -> PyResult<Bound<'py, PyAny>> {
    let memory = whole("memory", memory, SIZE)?;
    let rows = Rows::borrow(rows)?;
    let source = rows.source()?;
    let judged = interruptible(py, |monitor| {
        let options = TilesOptions { memory, temporary: scratch.as_deref(), monitor: *monitor };
        taut::certify::check_tiles(&folder, &*source, &options)
    })?;
    plain(py, &judged.map_err(refuse)?)
}

/// A wrong input is a `ValueError`, what the system refuses an `OSError`, a lack of memory a `MemoryError`.
pub(crate) fn raise(error: Error) -> PyErr {
    let said = error.to_string();
    match error {
        Error::File { .. } | Error::Space { .. } => PyOSError::new_err(said),
        Error::FolderLocked { .. } | Error::DamagedFolder { .. } => PyOSError::new_err(said),
        Error::Memory { .. } | Error::LinkMemory { .. } => PyMemoryError::new_err(said),
        Error::Input(taut::points::InputError::Cancelled(_)) => PyRuntimeError::new_err(said),
        _ => PyValueError::new_err(said),
    }
}

fn refuse(error: TilesError) -> PyErr {
    let said = error.to_string();
    match error {
        TilesError::Rejected(TilesViolation::NonFinite { .. }) => PyValueError::new_err(said),
        TilesError::Rejected(_) => Violation::new_err(said),
        TilesError::File { .. } => PyOSError::new_err(said),
        TilesError::Memory { .. } => PyMemoryError::new_err(said),
        TilesError::NoManifest { .. } => PyValueError::new_err(said),
        _ => PyRuntimeError::new_err(said),
    }
}
