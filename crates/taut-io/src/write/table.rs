//! Tables of results: columns of numbers or names, to csv, tsv, npy, parquet and arrow.

#[cfg(feature = "arrow")]
use std::io::Write;
use std::path::Path;
#[cfg(feature = "arrow")]
use std::sync::Arc;

#[cfg(feature = "arrow")]
use arrow_array::{ArrayRef, Float64Array, Int64Array, RecordBatch, StringArray};
#[cfg(feature = "arrow")]
use arrow_schema::{DataType, Field, Schema};
#[cfg(feature = "arrow")]
use parquet::file::properties::WriterProperties;

use super::OutputFile;
#[cfg(feature = "arrow")]
use super::parquet::{ColumnKind, GROUP_ROWS, ParquetFile, Values};
use super::text::name_to_text;
use crate::create::AtomicFile;
use crate::error::shown_path;
use crate::format::format_to_write;
use crate::words::{put_number, put_whole};
use crate::{Content, Error, Format, NpyArray};

/// A table: columns of one length, each with a name.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    columns: Vec<(String, Column)>,
}

/// The values of a column.
#[derive(Clone, Debug, PartialEq)]
pub enum Column {
    /// Whole numbers, at least 0.
    Whole(Vec<u64>),
    /// Real numbers.
    Real(Vec<f64>),
    /// Names. NumPy arrays leave them out.
    Text(Vec<String>),
}

impl Column {
    fn len(&self) -> usize {
        match self {
            Column::Whole(values) => values.len(),
            Column::Real(values) => values.len(),
            Column::Text(values) => values.len(),
        }
    }
}

impl Table {
    /// A table without columns.
    pub fn new() -> Self {
        Self::default()
    }

    /// The table with one column more, of as many values as the others. Where its name is taken, underscores follow it.
    ///
    /// # Panics
    /// If it has another number of values.
    #[must_use]
    pub fn with(mut self, name: impl Into<String>, column: Column) -> Self {
        let rows = self.columns.first().map_or(column.len(), |(_, first)| first.len());
        assert_eq!(rows, column.len(), "columns of a table have one length");
        let mut name = name.into();
        while self.columns.iter().any(|(taken, _)| *taken == name) {
            name.push('_');
        }
        self.columns.push((name, column));
        self
    }

    fn rows(&self) -> usize {
        self.columns.first().map_or(0, |(_, column)| column.len())
    }
}

/// The formats that tables are written in, by their names.
pub fn table_formats() -> impl Iterator<Item = Format> {
    [Format::Csv, Format::Tsv, Format::Npy, Format::Parquet, Format::Arrow]
        .into_iter()
        .filter(|format| format.is_built())
}

/// Writes a table in the format and the compression that the name of the file tells; it takes its name when it is committed.
///
/// ```
/// use taut_io::{Column, Table, table_file};
///
/// let table = Table::new()
///     .with("row", Column::Whole(vec![3, 7]))
///     .with("distance", Column::Real(vec![0.5, 1.25]));
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("table.csv");
/// table_file(&table, &path)?.commit()?;
/// assert_eq!(std::fs::read_to_string(path)?, "row,distance\n3,0.5\n7,1.25\n");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`Error`]: of the format, which must be one of [`table_formats`], and of writing.
pub fn table_file(table: &Table, path: &Path) -> Result<AtomicFile, Error> {
    let shown = shown_path(path);
    let (format, compression) = format_to_write(path, &shown, None, Content::Points)?;
    let mut out = OutputFile::create(path, &shown, compression)?;
    match format {
        Format::Csv => text(table, b',', &mut out)?,
        Format::Tsv => text(table, b'\t', &mut out)?,
        Format::Npy => array(table, &mut out)?,
        #[cfg(feature = "arrow")]
        Format::Parquet => parquet(table, &mut out)?,
        #[cfg(feature = "arrow")]
        Format::Arrow => arrow(table, &mut out)?,
        _ => return Err(Error::not_writable(&shown, format, Content::Points)),
    }
    out.finish()
}

fn text(table: &Table, delimiter: u8, out: &mut OutputFile<'_>) -> Result<(), Error> {
    let mut head = Vec::new();
    for (at, (name, _)) in table.columns.iter().enumerate() {
        if at > 0 {
            head.push(delimiter);
        }
        name_to_text(name, delimiter, &mut head);
    }
    head.push(b'\n');
    out.put(&head)?;
    out.each(0..table.rows(), |row, line| {
        for (at, (_, column)) in table.columns.iter().enumerate() {
            if at > 0 {
                line.push(delimiter);
            }
            match column {
                Column::Whole(values) => put_whole(values[row], line),
                Column::Real(values) => put_number(values[row], line),
                Column::Text(values) => name_to_text(&values[row], delimiter, line),
            }
        }
        line.push(b'\n');
    })
}

/// Whole numbers of 64 bits where all columns are whole, else doubles; one column is an array of one axis.
fn array(table: &Table, out: &mut OutputFile<'_>) -> Result<(), Error> {
    let columns: Vec<&Column> = table.columns.iter().map(|(_, column)| column).collect();
    let columns: Vec<&Column> =
        columns.into_iter().filter(|column| !matches!(column, Column::Text(_))).collect();
    let is_whole = columns.iter().all(|column| matches!(column, Column::Whole(_)));
    let mut shape = vec![table.rows() as u64];
    if columns.len() != 1 {
        shape.push(columns.len() as u64);
    }
    let dtype = if is_whole { "<i8" } else { "<f8" }.to_owned();
    out.put(&NpyArray { dtype, width: 8, fortran: false, shape, offset: 0 }.header())?;
    out.each(0..table.rows(), |row, bytes| {
        for column in &columns {
            bytes.extend_from_slice(&match column {
                Column::Whole(values) if is_whole => values[row].to_le_bytes(),
                Column::Whole(values) => (values[row] as f64).to_le_bytes(),
                Column::Real(values) => values[row].to_le_bytes(),
                Column::Text(_) => continue,
            });
        }
    })
}

#[cfg(feature = "arrow")]
fn batch(table: &Table) -> RecordBatch {
    let kind = |column: &Column| match column {
        Column::Whole(_) => DataType::Int64,
        Column::Real(_) => DataType::Float64,
        Column::Text(_) => DataType::Utf8,
    };
    let fields: Vec<Field> =
        table.columns.iter().map(|(name, column)| Field::new(name, kind(column), false)).collect();
    let values = |column: &Column| -> ArrayRef {
        match column {
            Column::Whole(values) => {
                Arc::new(values.iter().map(|&value| value as i64).collect::<Int64Array>())
            }
            Column::Real(values) => Arc::new(Float64Array::from(values.clone())),
            Column::Text(values) => Arc::new(values.iter().map(Some).collect::<StringArray>()),
        }
    };
    let columns = table.columns.iter().map(|(_, column)| values(column)).collect();
    RecordBatch::try_new(Arc::new(Schema::new(fields)), columns)
        .expect("columns of one length fit their schema")
}

#[cfg(feature = "arrow")]
fn parquet(table: &Table, out: &mut OutputFile<'_>) -> Result<(), Error> {
    let kind = |column: &Column| match column {
        Column::Whole(_) => ColumnKind::I64,
        Column::Real(_) => ColumnKind::F64,
        Column::Text(_) => ColumnKind::Text,
    };
    let columns = table.columns.iter().map(|(name, column)| (name.clone(), kind(column)));
    let mut file = ParquetFile::new(out, columns.collect(), WriterProperties::builder())?;
    let texts = |values: &[String]| values.iter().map(|text| text.as_str().into()).collect();
    for first in (0..table.rows()).step_by(GROUP_ROWS) {
        let rows = first..table.rows().min(first + GROUP_ROWS);
        file.group(|j| match &table.columns[j].1 {
            Column::Whole(values) => {
                Values::Whole64(values[rows.clone()].iter().map(|&value| value as i64).collect())
            }
            Column::Real(values) => Values::F64(values[rows.clone()].to_vec()),
            Column::Text(values) => Values::Text(texts(&values[rows.clone()])),
        })?;
    }
    file.finish()
}

#[cfg(feature = "arrow")]
fn arrow(table: &Table, out: &mut OutputFile<'_>) -> Result<(), Error> {
    let (path, failure, batch) = (out.path, out.failure, batch(table));
    let failed =
        |source: arrow_schema::ArrowError| failure(path, std::io::Error::other(source.to_string()));
    let mut writer =
        arrow_ipc::writer::FileWriter::try_new(&mut out.to, &batch.schema()).map_err(failed)?;
    writer.write(&batch).map_err(failed)?;
    writer.finish().map_err(failed)?;
    out.to.flush().map_err(|source| failure(path, source))
}
