//! Answers that are files, behind their Python signatures: sorted records, transposed matrices; and samples.

use std::fs::File;
use std::path::{Path, PathBuf};

use numpy::PyArray1;
use pyo3::exceptions::{PyOSError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use taut::certify::{AnyFileSolution, Data, FileCheckError, Files, SortedFile, TransposedFile};
use taut::files::{StoredMatrix, sorted, transposed};
use taut::oblivious::external::{FileSortOptions, KeyKind, RecordLayout, sort_file as sort};
use taut::oblivious::{
    Error, TransposeFileOptions, sample as draw, transpose_file_pending as transpose,
};

use crate::numbers::whole;
use crate::rows::numbers;
use crate::solution::{Trace, Violation};
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
) -> PyResult<FileSolution> {
    let kind = match kind {
        "u64" => KeyKind::U64,
        "i64" => KeyKind::I64,
        "f64" => KeyKind::F64,
        "bytes" => KeyKind::Bytes,
        _ => {
            let problem =
                format!("option `kind` is {kind:?}: expected one of u64, i64, f64, bytes");
            return Err(PyValueError::new_err(problem));
        }
    };
    let key = whole::<usize>("key", &key.0, SIZE)?..whole::<usize>("key", &key.1, SIZE)?;
    let layout = RecordLayout { width: whole("width", width, "1 to 16777216 bytes")?, key, kind };
    let options = FileSortOptions { memory: whole("memory", memory, SIZE)?, scratch, resume };
    let found = interruptible(py, |monitor| sort(&input, &output, &layout, &options, monitor))?
        .map_err(raise)?;
    FileSolution::new(py, AnyFileSolution::Sort(sorted(&layout, &found)))
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
) -> PyResult<FileSolution> {
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
    FileSolution::new(py, AnyFileSolution::Transpose(transposed(answer, certificate, &found)))
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
    numbers(py, interruptible(py, |_| draw(seed, n, k))?.map_err(raise)?)
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

/// A file that was written, what proves its content, and how it came about.
///
/// Two are equal when all that they say is. They can be pickled.
///
/// Attributes
/// ----------
/// kind : str
///     ``"sort"``, ``"transpose"`` or ``"sample"``.
/// answer : dict
///     What the file is said to be, by the names of the JSON. A fresh copy each time.
/// certificate : dict
///     Its proof. A fresh copy each time.
/// trace : Trace
///     Counters of the run.
#[pyclass(frozen, module = "taut")]
pub(crate) struct FileSolution {
    solution: AnyFileSolution,
    #[pyo3(get)]
    trace: Py<Trace>,
}

impl FileSolution {
    fn new(py: Python<'_>, solution: AnyFileSolution) -> PyResult<Self> {
        let trace = match &solution {
            AnyFileSolution::Sort(found) => found.trace.clone(),
            AnyFileSolution::Transpose(found) => found.trace.clone(),
            AnyFileSolution::Sample(found) => found.trace.clone(),
        };
        Ok(FileSolution { solution, trace: Py::new(py, Trace::new(trace))? })
    }

    /// A part of the document as Python's own objects.
    fn part(&self, py: Python<'_>, name: &str) -> PyResult<Py<PyAny>> {
        let document = py.import("json")?.getattr("loads")?.call1((self.solution.to_json(),))?;
        Ok(document.get_item(name)?.unbind())
    }
}

#[pymethods]
impl FileSolution {
    #[getter]
    fn kind(&self) -> &'static str {
        match self.solution {
            AnyFileSolution::Sort(_) => "sort",
            AnyFileSolution::Transpose(_) => "transpose",
            AnyFileSolution::Sample(_) => "sample",
        }
    }

    #[getter]
    fn answer(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        self.part(py, "answer")
    }

    #[getter]
    fn certificate(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        self.part(py, "certificate")
    }

    /// A second opinion: reads the file that was written, and compares it with the one it was made from.
    ///
    /// Parameters
    /// ----------
    /// output : path
    ///     The file that was written.
    /// input : path, optional
    ///     The file that was read. Without it the content is judged by the hash of the certificate.
    ///
    /// Returns
    /// -------
    /// FileVerdict
    ///
    /// Raises
    /// ------
    /// Violation
    ///     When the file is not what this says.
    /// OSError
    ///     When a file cannot be read.
    /// ValueError
    ///     When an input is named for a sample, which is made from none.
    #[pyo3(signature = (output, input=None))]
    fn check(
        &self,
        py: Python<'_>,
        output: PathBuf,
        input: Option<PathBuf>,
    ) -> PyResult<FileVerdict> {
        let opened = |path: &Path| {
            let failed = |source| raise(Error::File { path: path.display().to_string(), source });
            File::open(path).map_err(failed)
        };
        let mut to = opened(&output)?;
        let mut from = input.as_deref().map(opened).transpose()?;
        let judgement = interruptible(py, |monitor| {
            let input = from.as_mut().map(|file| file as &mut dyn Data);
            self.solution.check(Files { input, output: &mut to }, monitor)
        })?;
        let proved = judgement.map_err(judged)?;
        Ok(FileVerdict { items: proved.items, compared: proved.compared })
    }

    /// The solution as a JSON document, as the command line writes it.
    ///
    /// Returns
    /// -------
    /// str
    fn to_json(&self) -> String {
        self.solution.to_json()
    }

    /// Reads what `to_json` or the command line wrote.
    ///
    /// Parameters
    /// ----------
    /// text : str
    ///     The document. Nothing in it is believed until `check` has judged it.
    ///
    /// Returns
    /// -------
    /// FileSolution
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     When the text is not an answer about files, or of a newer schema.
    #[staticmethod]
    fn from_json(py: Python<'_>, text: &str) -> PyResult<Self> {
        let solution = AnyFileSolution::from_json(text)
            .map_err(|error| PyValueError::new_err(error.to_string()))?;
        FileSolution::new(py, solution)
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        other.cast::<FileSolution>().is_ok_and(|other| self.solution == other.get().solution)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (String,))> {
        Ok((py.get_type::<FileSolution>().getattr("from_json")?, (self.to_json(),)))
    }

    fn __repr__(&self) -> String {
        let kind = self.kind();
        match &self.solution {
            AnyFileSolution::Sort(found) => {
                let SortedFile { records, width, .. } = found.answer;
                format!("FileSolution(kind='{kind}', records={records}, width={width})")
            }
            AnyFileSolution::Transpose(found) => {
                let TransposedFile { rows, columns, width, .. } = found.answer;
                format!(
                    "FileSolution(kind='{kind}', rows={rows}, columns={columns}, width={width})"
                )
            }
            AnyFileSolution::Sample(found) => {
                let (of, drawn) = (found.answer.of, found.answer.drawn);
                format!("FileSolution(kind='{kind}', of={of}, drawn={drawn})")
            }
        }
    }
}

/// What was proved of a file.
///
/// Attributes
/// ----------
/// items : int
///     Records, elements or numbers that were read, in each of the files.
/// compared : bool
///     Whether the file that was read was compared, or the certificate's word taken for it.
#[pyclass(frozen, get_all, module = "taut")]
pub(crate) struct FileVerdict {
    items: u64,
    compared: bool,
}

#[pymethods]
impl FileVerdict {
    fn __repr__(&self) -> String {
        let compared = if self.compared { "True" } else { "False" };
        format!("FileVerdict(items={}, compared={compared})", self.items)
    }
}
