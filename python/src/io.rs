//! `taut.read_points` and `taut.write_mesh`, behind their Python signatures.

use std::path::PathBuf;

use numpy::{Element, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::exceptions::{
    PyFileNotFoundError, PyIsADirectoryError, PyMemoryError, PyOSError, PyPermissionError,
    PyValueError,
};
use pyo3::prelude::*;
use taut::points::{ReadError, Rows as SourceRows, ScalarKind, Scratch, try_reserve_exact};
use taut::{Monitor, PointSource};
use taut_io::{
    Bounds, Decimal, Encoding, Error, Feature, Format, Header, Mesh, MeshOptions, MeshView,
    Missing, ReadOptions,
};

use crate::rows::Rows;
use crate::work::interruptible;

/// Points that are copied at once.
const BLOCK: u64 = 1 << 16;

/// Values of a file in the type in which they are there.
enum Values {
    F32(Vec<f32>),
    F64(Vec<f64>),
}

/// The points of a file as an array.
#[pyfunction]
pub(crate) fn read_points<'py>(
    py: Python<'py>,
    path: PathBuf,
    format: Option<&str>,
    columns: Option<&str>,
    header: Option<bool>,
    select: Option<String>,
    classes: Option<Vec<u8>>,
    bounds: Option<&str>,
    choices: (bool, bool, bool),
) -> PyResult<Bound<'py, PyAny>> {
    let (numeric, is_missing_dropped, has_decimal_commas) = choices;
    let options = ReadOptions {
        format: format.map(str::parse).transpose().map_err(raise)?,
        columns: columns.map(str::parse).transpose().map_err(raise)?,
        header: match header {
            None => Header::Auto,
            Some(true) => Header::Present,
            Some(false) => Header::Absent,
        },
        feature: select.map(|text| text.parse::<Feature>().unwrap_or_else(|never| match never {})),
        classes,
        bounds: bounds.map(str::parse::<Bounds>).transpose().map_err(PyValueError::new_err)?,
        numeric,
        missing: if is_missing_dropped { Missing::Drop } else { Missing::Refuse },
        decimal: if has_decimal_commas { Decimal::Comma } else { Decimal::Point },
        ..ReadOptions::default()
    };
    let read = interruptible(py, |monitor| {
        let input = taut_io::open(&path, &options)?;
        let dim = input.source.dim();
        let values = match input.source.scalar() {
            ScalarKind::F32 => Values::F32(all(&*input.source, monitor, |to, rows| match rows {
                SourceRows::F32(points) => to.extend_from_slice(points.values()),
                SourceRows::F64(points) => to.extend(points.values().iter().map(|&x| x as f32)),
            })?),
            ScalarKind::F64 => Values::F64(all(&*input.source, monitor, |to, rows| match rows {
                SourceRows::F32(points) => to.extend(points.values().iter().map(|&x| f64::from(x))),
                SourceRows::F64(points) => to.extend_from_slice(points.values()),
            })?),
        };
        Ok((values, dim))
    })?;
    let (values, dim) = read.map_err(raise)?;
    Ok(match values {
        Values::F32(values) => rows(py, values, dim)?.into_any(),
        Values::F64(values) => rows(py, values, dim)?.into_any(),
    })
}

/// All coordinates of a source, as `add` takes them from a block.
fn all<T>(
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
    add: impl Fn(&mut Vec<T>, SourceRows<'_>),
) -> Result<Vec<T>, Error> {
    let count = usize::try_from(source.len()).ok().and_then(|n| n.checked_mul(source.dim()));
    let (mut values, mut scratch) = (Vec::new(), Scratch::new());
    if count.is_none_or(|count| try_reserve_exact(&mut values, count).is_err()) {
        return Err(ReadError::TooLarge { rows: source.len(), dim: source.dim() }.into());
    }
    let mut first = 0;
    while first < source.len() && monitor.check().is_ok() {
        let next = source.len().min(first + BLOCK);
        add(&mut values, source.read(first..next, &mut scratch)?);
        first = next;
    }
    Ok(values)
}

fn rows<T: Element>(
    py: Python<'_>,
    values: Vec<T>,
    dim: usize,
) -> PyResult<Bound<'_, PyArray2<T>>> {
    let count = values.len() / dim.max(1);
    PyArray1::from_vec(py, values).reshape([count, dim])
}

/// Writes simplices on the rows of an array: triangles in space as a surface. `simplices` has been checked.
#[pyfunction]
pub(crate) fn write_mesh(
    py: Python<'_>,
    path: PathBuf,
    points: &Bound<'_, PyAny>,
    simplices: PyReadonlyArray2<'_, u32>,
    normals: Option<Vec<[f64; 3]>>,
    colors: Option<Vec<[u8; 3]>>,
    format: Option<&str>,
    text: bool,
) -> PyResult<()> {
    let points = Rows::borrow(points)?;
    let (ids, width) = (simplices.as_slice()?, simplices.shape()[1]);
    let format: Option<Format> = format.map(str::parse).transpose().map_err(raise)?;
    let encoding = if text { Encoding::Text } else { Encoding::Binary };
    let options = MeshOptions { format, encoding };
    let write = |mesh: &MeshView<'_>| {
        interruptible(py, |monitor| taut_io::write_mesh(mesh, &path, &options, monitor))?
            .map_err(raise)
    };
    match &points {
        Rows::F64(array) if array.shape()[1] == 3 && width == 3 => {
            let vertices = array.as_slice()?.as_chunks().0.to_vec();
            let mesh = Mesh { vertices, width, simplices: ids.to_vec(), normals, colors };
            write(&mesh.view().map_err(|error| PyValueError::new_err(error.to_string()))?)
        }
        _ => write(&MeshView::on_points(&*points.source()?, ids, width)),
    }
}

/// A file that the system refuses is an `OSError`, a lack of memory a `MemoryError`, all else a `ValueError`.
/// The options of reading as errors advise them, and as they are said here.
const OPTIONS: [(&str, &str); 3] = [
    ("--missing drop", "missing=\"drop\""),
    ("--decimal ,", "decimal=\",\""),
    ("say with --header whether", "say with header=True or header=False whether"),
];

fn raise(error: Error) -> PyErr {
    let said = error.to_string();
    let said = OPTIONS.iter().fold(said, |said, (option, here)| said.replace(option, here));
    match error {
        Error::NotFound { .. } => PyFileNotFoundError::new_err(said),
        Error::Permission { .. } => PyPermissionError::new_err(said),
        Error::Directory { .. } => PyIsADirectoryError::new_err(said),
        Error::Read { .. } | Error::Write { .. } | Error::Replace { .. } | Error::Spill { .. } => {
            PyOSError::new_err(said)
        }
        Error::OutOfMemory { .. } | Error::Points(ReadError::TooLarge { .. }) => {
            PyMemoryError::new_err(said)
        }
        _ => PyValueError::new_err(said),
    }
}
