//! Parquet: columns of points, of tables and of simplices, in row groups.
//!
//! *Idea.* Rows are gathered until they make a row group; then its columns are written one after the other.

use std::sync::Arc;

use arrow_ipc::writer::{DictionaryTracker, IpcDataGenerator, IpcWriteOptions};
use arrow_schema::{DataType, Field, Schema};
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use parquet::basic::{Compression, ConvertedType, LogicalType, Repetition, Type as Physical};
use parquet::column::writer::{ColumnWriter, ColumnWriterImpl};
use parquet::data_type::{ByteArray, DataType as Stored};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::{WriterProperties, WriterPropertiesBuilder};
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;
use taut_points::{Rows, Scalar, ScalarKind};

use super::{OutputFile, Points};
use crate::Error;
use crate::compress::Encoder;
use crate::create::AtomicFile;

/// Bytes of points in a row group.
const ROW_GROUP: usize = 64 << 20;

/// Rows of a table, and simplices, in a row group.
pub(crate) const GROUP_ROWS: usize = 1 << 20;

/// Beyond this dimension points without names are one column of lists: readers keep buffers of some KiB for each column, whatever the
/// number of rows.
const COLUMNS_MAX: usize = 1000;

/// Values of a column of lists that are written at a time, with their levels.
const LIST_PIECE: usize = 1 << 16;

/// What a column holds; no value is missing.
pub(crate) enum ColumnKind {
    F32,
    F64,
    U32,
    I64,
    Text,
    /// Lists of so many numbers each; the only column then.
    Lists(ScalarKind, usize),
}

/// Values of a column.
pub(crate) enum Values {
    F32(Vec<f32>),
    F64(Vec<f64>),
    /// The bits of whole numbers of 32 bits.
    Whole32(Vec<i32>),
    Whole64(Vec<i64>),
    Text(Vec<ByteArray>),
}

/// A file that is being written.
pub(crate) struct ParquetFile<'a, 'b> {
    writer: SerializedFileWriter<&'b mut Encoder<AtomicFile>>,
    /// For each column the length of its lists, if it is one of lists.
    lists: Vec<Option<usize>>,
    path: &'a str,
    failure: fn(&str, std::io::Error) -> Error,
}

impl<'a, 'b> ParquetFile<'a, 'b> {
    /// Begins a file with these columns.
    pub(crate) fn new(
        out: &'b mut OutputFile<'a>,
        columns: Vec<(String, ColumnKind)>,
        properties: WriterPropertiesBuilder,
    ) -> Result<ParquetFile<'a, 'b>, Error> {
        let (path, failure) = (out.path, out.failure);
        let lists = columns.iter().map(|(_, kind)| match kind {
            ColumnKind::Lists(_, length) => Some(*length),
            _ => None,
        });
        let lists: Vec<_> = lists.collect();
        let hint = match &columns[..] {
            [(name, ColumnKind::Lists(scalar, length))] => arrow_schema(name, *scalar, *length),
            _ => None,
        };
        let properties = properties
            .set_compression(Compression::SNAPPY)
            .set_key_value_metadata(hint.map(|hint| vec![hint]))
            .build();
        let begin = || {
            let fields = columns.iter().map(|(name, kind)| Ok(Arc::new(field(name, kind)?)));
            let fields = fields.collect::<Result<_, ParquetError>>()?;
            let root = Type::group_type_builder("schema").with_fields(fields).build()?;
            SerializedFileWriter::new(&mut out.to, Arc::new(root), Arc::new(properties))
        };
        let writer = begin().map_err(|error| failure(path, error.into()))?;
        Ok(ParquetFile { writer, lists, path, failure })
    }

    /// Writes a row group; `values` gives each column by its number.
    pub(crate) fn group(&mut self, mut values: impl FnMut(usize) -> Values) -> Result<(), Error> {
        let lists = &self.lists;
        let mut write = || {
            let mut group = self.writer.next_row_group()?;
            let mut number = 0;
            while let Some(mut column) = group.next_column()? {
                put(column.untyped(), &values(number), lists[number])?;
                column.close()?;
                number += 1;
            }
            group.close().map(drop)
        };
        write().map_err(|error: ParquetError| (self.failure)(self.path, error.into()))
    }

    pub(crate) fn finish(self) -> Result<(), Error> {
        self.writer.close().map(drop).map_err(|error| (self.failure)(self.path, error.into()))
    }
}

/// Writes the values of a column of a row group.
fn put(
    column: &mut ColumnWriter<'_>,
    values: &Values,
    list: Option<usize>,
) -> Result<(), ParquetError> {
    match (column, values) {
        (ColumnWriter::FloatColumnWriter(column), Values::F32(values)) => {
            put_all(column, values, list)
        }
        (ColumnWriter::DoubleColumnWriter(column), Values::F64(values)) => {
            put_all(column, values, list)
        }
        (ColumnWriter::Int32ColumnWriter(column), Values::Whole32(values)) => {
            put_all(column, values, list)
        }
        (ColumnWriter::Int64ColumnWriter(column), Values::Whole64(values)) => {
            put_all(column, values, list)
        }
        (ColumnWriter::ByteArrayColumnWriter(column), Values::Text(values)) => {
            put_all(column, values, list)
        }
        _ => unreachable!("the values of a column are of its kind"),
    }
}

/// Writes values; those of lists some whole lists at a time, with their levels: each is there, and all but the first of a list go on with it.
fn put_all<T: Stored>(
    column: &mut ColumnWriterImpl<'_, T>,
    values: &[T::T],
    list: Option<usize>,
) -> Result<(), ParquetError> {
    let Some(length) = list else { return column.write_batch(values, None, None).map(drop) };
    let piece = (LIST_PIECE / length).max(1) * length;
    let defined = vec![1; piece];
    let repeated: Vec<i16> = (0..piece).map(|i| i16::from(i % length > 0)).collect();
    values.chunks(piece).try_for_each(|values| {
        let (defined, repeated) = (&defined[..values.len()], &repeated[..values.len()]);
        column.write_batch(values, Some(defined), Some(repeated)).map(drop)
    })
}

/// A column in the schema of Parquet.
fn field(name: &str, kind: &ColumnKind) -> Result<Type, ParquetError> {
    let of = |name: &str, physical, logical| {
        let builder = Type::primitive_type_builder(name, physical);
        builder.with_repetition(Repetition::REQUIRED).with_logical_type(logical).build()
    };
    match kind {
        ColumnKind::F32 => of(name, Physical::FLOAT, None),
        ColumnKind::F64 => of(name, Physical::DOUBLE, None),
        ColumnKind::U32 => of(name, Physical::INT32, Some(LogicalType::integer(32, false))),
        ColumnKind::I64 => of(name, Physical::INT64, None),
        ColumnKind::Text => of(name, Physical::BYTE_ARRAY, Some(LogicalType::String)),
        ColumnKind::Lists(scalar, _) => {
            let physical = match scalar {
                ScalarKind::F32 => Physical::FLOAT,
                ScalarKind::F64 => Physical::DOUBLE,
            };
            let repeated = Type::group_type_builder("list")
                .with_repetition(Repetition::REPEATED)
                .with_fields(vec![Arc::new(of("element", physical, None)?)])
                .build()?;
            Type::group_type_builder(name)
                .with_repetition(Repetition::REQUIRED)
                .with_logical_type(Some(LogicalType::List))
                .with_converted_type(ConvertedType::LIST)
                .with_fields(vec![Arc::new(repeated)])
                .build()
        }
    }
}

/// The schema of a column of lists as readers of arrow look for it: Parquet itself does not know that all lists have one length. None
/// where arrow has no lists of that length.
fn arrow_schema(name: &str, scalar: ScalarKind, length: usize) -> Option<KeyValue> {
    let kind = match scalar {
        ScalarKind::F32 => DataType::Float32,
        ScalarKind::F64 => DataType::Float64,
    };
    let item = Arc::new(Field::new("element", kind, false));
    let lists = DataType::FixedSizeList(item, i32::try_from(length).ok()?);
    let schema = Schema::new(vec![Field::new(name, lists, false)]);
    let message = IpcDataGenerator::default()
        .schema_to_bytes_with_dictionary_tracker(
            &schema,
            &mut DictionaryTracker::new(true),
            &IpcWriteOptions::default(),
        )
        .ipc_message;
    let length = u32::try_from(message.len()).ok()?;
    let bytes = [&[0xff; 4], &length.to_le_bytes()[..], &message].concat();
    Some(KeyValue::new("ARROW:schema".to_owned(), BASE64_STANDARD.encode(bytes)))
}

/// Writes points, each coordinate a column, or all of them one column of lists.
pub(super) fn write(points: &Points<'_>, out: &mut OutputFile<'_>) -> Result<(), Error> {
    let (dim, scalar) = (points.source.dim(), points.source.scalar());
    let is_wide = dim > COLUMNS_MAX;
    let is_list = is_wide && points.columns.is_empty();
    let columns = match is_list {
        true => vec![("point".to_owned(), ColumnKind::Lists(scalar, dim))],
        false => (0..dim).map(|j| (points.column_name(j), kind(scalar))).collect(),
    };
    // Coordinates hardly repeat, and in many columns the tries for a dictionary take longer than the values.
    let properties = WriterProperties::builder().set_dictionary_enabled(!is_wide || is_list);
    let mut file = ParquetFile::new(out, columns, properties)?;
    match scalar {
        ScalarKind::F32 => write_as(points, &mut file, is_list, Values::F32, |rows| match rows {
            Rows::F32(rows) => rows.values(),
            Rows::F64(_) => unreachable!("points of one source are of one type"),
        })?,
        ScalarKind::F64 => write_as(points, &mut file, is_list, Values::F64, |rows| match rows {
            Rows::F64(rows) => rows.values(),
            Rows::F32(_) => unreachable!("points of one source are of one type"),
        })?,
    }
    file.finish()
}

fn kind(scalar: ScalarKind) -> ColumnKind {
    match scalar {
        ScalarKind::F32 => ColumnKind::F32,
        ScalarKind::F64 => ColumnKind::F64,
    }
}

fn write_as<T: Scalar>(
    points: &Points<'_>,
    file: &mut ParquetFile<'_, '_>,
    is_list: bool,
    make: fn(Vec<T>) -> Values,
    values: impl for<'r> Fn(Rows<'r>) -> &'r [T],
) -> Result<(), Error> {
    let dim = points.source.dim();
    let mut held: Vec<T> = Vec::new();
    let group = |file: &mut ParquetFile<'_, '_>, held: &mut Vec<T>| {
        file.group(|j| match is_list {
            true => make(std::mem::take(held)),
            false => make(held.iter().skip(j).step_by(dim).copied().collect()),
        })?;
        held.clear();
        Ok(())
    };
    points.blocks(|rows| {
        held.extend_from_slice(values(rows));
        if size_of_val(&held[..]) >= ROW_GROUP { group(file, &mut held) } else { Ok(()) }
    })?;
    if held.is_empty() { Ok(()) } else { group(file, &mut held) }
}
