//! Answers that are files, behind their Python signatures: sorted records, transposed matrices; and samples.

use std::fs::File;
use std::path::{Path, PathBuf};

use numpy::PyArray1;
use pyo3::exceptions::{PyOSError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use taut::certify::{AnyFileSolution, Data, FileCheckError, Files, with_file_solution};
use taut::files::{StoredMatrix, sorted, transposed};
use taut::oblivious::external::{FileSortOptions, KeyKind, RecordLayout, sort_file as sort};
use taut::oblivious::{
    Error, TransposeFileOptions, sample as draw, transpose_file_pending as transpose,
};

use crate::choice::one_of;
use crate::found::Violation;
use crate::numbers::whole;
use crate::object::plain;
use crate::work::interruptible;

/// Most numbers that the options for memory and widths take.
const SIZE: &str = "a number of bytes";

/// Sorts a file of records.
#[pyfunction]
pub(crate) fn sort_file(
    py: Python<'_>,
    input: PathBuf,
    output: PathBuf,
    width: &Bound<'_, PyAny>,
    key: (Bound<'_, PyAny>, Bound<'_, PyAny>),
    kind: &str,
    memory: &Bound<'_, PyAny>,
    scratch: Option<PathBuf>,
    resume: Option<PathBuf>,
) -> PyResult<FoundFile> {
    let kind = one_of("kind", kind, KeyKind::NAMES)?;
    let key = whole::<usize>("key", &key.0, SIZE)?..whole::<usize>("key", &key.1, SIZE)?;
    let layout = RecordLayout { width: whole("width", width, "1 to 16777216 bytes")?, key, kind };
    let memory = whole("memory", memory, SIZE)?;
    let options = FileSortOptions { memory, scratch, resume, ..FileSortOptions::default() };
    let found = interruptible(py, |monitor| sort(&input, &output, &layout, &options, monitor))?
        .map_err(raise)?;
    Ok(FoundFile(sorted(&layout, &found).into()))
}

/// Transposes a matrix in a file; `header` goes before the elements of the output.
#[pyfunction]
pub(crate) fn transpose_file(
    py: Python<'_>,
    input: PathBuf,
    output: PathBuf,
    shape: (Bound<'_, PyAny>, Bound<'_, PyAny>),
    width: &Bound<'_, PyAny>,
    fortran: bool,
    offset: &Bound<'_, PyAny>,
    dtype: Option<String>,
    header: &[u8],
    memory: &Bound<'_, PyAny>,
) -> PyResult<FoundFile> {
    let rows: u64 = whole("rows", &shape.0, "a number of rows")?;
    let columns: u64 = whole("columns", &shape.1, "a number of columns")?;
    let width: usize = whole("width", width, SIZE)?;
    let offset: u64 = whole("offset", offset, SIZE)?;
    let options = TransposeFileOptions { memory: whole("memory", memory, SIZE)? };
    let stored = StoredMatrix { rows, columns, width, offset, by_columns: fortran, dtype };
    let (matrix, answer) = (stored.matrix(), stored.transpose(header.len() as u64));
    let done = interruptible(py, |monitor| {
        let mut written = transpose(&input, matrix, &output, header, &options, monitor)?;
        let failed = |source| Error::File { path: input.display().to_string(), source };
        let mut from = File::open(&input).map_err(failed)?;
        let files = Files { input: Some(&mut from), output: written.file() };
        Ok(match answer.certify(files, monitor) {
            Ok(certificate) => (written.publish()?, Ok(certificate)),
            Err(violation) => (written.found, Err(violation)),
        })
    })?;
    let (found, certified) = done.map_err(raise)?;
    let certificate = certified.map_err(judged)?;
    Ok(FoundFile(transposed(answer, certificate, &found).into()))
}

/// Draws `k` different numbers below `n`.
#[pyfunction]
pub(crate) fn sample(
    py: Python<'_>,
    n: &Bound<'_, PyAny>,
    k: &Bound<'_, PyAny>,
    seed: &Bound<'_, PyAny>,
) -> PyResult<Py<PyArray1<u64>>> {
    let [n, k, seed] = [("n", n), ("k", k), ("seed", seed)]
        .map(|(name, value)| whole::<u64>(name, value, "0 to 2**64 - 1"));
    let (n, k, seed) = (n?, k?, seed?);
    let drawn = interruptible(py, |_| draw(seed, n, k))?.map_err(raise)?;
    let array = PyArray1::from_vec(py, drawn);
    array.call_method1("setflags", (false,))?;
    Ok(array.unbind())
}

/// A wrong input is a `ValueError`, what the system refuses an `OSError`, both with the library's sentence.
fn raise(error: Error) -> PyErr {
    match error {
        Error::File { source, path } => match source.raw_os_error() {
            // The subclass that fits: FileNotFoundError, PermissionError.
            Some(code) => {
                let said = source.to_string();
                PyOSError::new_err((code, said, path))
            }
            None => PyOSError::new_err(format!("{path}: {source}")),
        },
        Error::Cancelled(_) | Error::ReadBack { .. } => PyRuntimeError::new_err(error.to_string()),
        error => PyValueError::new_err(error.to_string()),
    }
}

fn judged(error: FileCheckError) -> PyErr {
    match error {
        FileCheckError::Rejected(violation) => Violation::new_err(violation.to_string()),
        FileCheckError::Read { .. } => PyOSError::new_err(error.to_string()),
        FileCheckError::NoInput => PyValueError::new_err(error.to_string()),
        error => PyRuntimeError::new_err(error.to_string()),
    }
}

/// The contents of a `taut.FileSolution`.
#[pyclass(frozen, eq, module = "taut._native")]
#[derive(PartialEq)]
pub(crate) struct FoundFile(AnyFileSolution);

#[pymethods]
impl FoundFile {
    #[getter]
    fn kind(&self) -> &'static str {
        self.0.kind()
    }

    /// Answer, certificate and trace, each as a dict by the names of the JSON.
    fn parts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        with_file_solution!(&self.0, found => {
            plain(py, &(&found.answer, &found.certificate, &found.trace))
        })
    }

    /// Returns what the checker proves of the file that was written, as a dict.
    fn check<'py>(
        &self,
        py: Python<'py>,
        output: PathBuf,
        input: Option<PathBuf>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let opened = |path: &Path| {
            let failed = |source| raise(Error::File { path: path.display().to_string(), source });
            File::open(path).map_err(failed)
        };
        let mut to = opened(&output)?;
        let mut from = input.as_deref().map(opened).transpose()?;
        let judgement = interruptible(py, |monitor| {
            let input = from.as_mut().map(|file| file as &mut dyn Data);
            self.0.check(Files { input, output: &mut to }, monitor)
        })?;
        plain(py, &judgement.map_err(judged)?)
    }

    fn to_json(&self) -> String {
        self.0.to_json()
    }

    #[staticmethod]
    fn from_json(text: &str) -> PyResult<Self> {
        AnyFileSolution::from_json(text)
            .map(FoundFile)
            .map_err(|error| PyValueError::new_err(error.to_string()))
    }
}
