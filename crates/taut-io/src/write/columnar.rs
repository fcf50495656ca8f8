//! Parquet and arrow: a column for each coordinate, a batch for each block.

use std::sync::Arc;

use arrow_array::{ArrayRef, FixedSizeListArray, Float32Array, Float64Array, RecordBatch};
use arrow_ipc::writer::FileWriter;
use arrow_schema::{DataType, Field, Schema, SchemaRef};
use parquet::arrow::ArrowWriter;
use parquet::basic::Compression;
use parquet::file::properties::WriterProperties;
use taut_points::{Points as View, Rows, Scalar, ScalarKind};

use super::{OutputFile, Points};
use crate::Error;

/// Bytes of encoded points in a row group.
const ROW_GROUP: usize = 64 << 20;

/// Beyond this dimension parquet holds points without names as one column of lists: its writer keeps buffers of some 20
/// KiB for each column, whatever the number of rows.
const COLUMNS_MAX: usize = 1000;

pub(super) fn write_parquet(points: &Points<'_>, out: &mut OutputFile<'_>) -> Result<(), Error> {
    let (path, failure) = (out.path, out.failure);
    let wide = points.source.dim() > COLUMNS_MAX;
    let list = wide && points.columns.is_empty();
    let schema = match list {
        true => list_schema(points).map_err(|source| failure(path, source))?,
        false => schema(points),
    };
    let failed = |source: parquet::errors::ParquetError| failure(path, source.into());
    let properties = WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        // A dictionary for each of many columns takes far more memory than their values.
        .set_dictionary_enabled(!wide || list)
        .build();
    let mut writer =
        ArrowWriter::try_new(&mut out.to, schema.clone(), Some(properties)).map_err(failed)?;
    points.blocks(|rows| {
        writer.write(&batch(&schema, rows)).map_err(failed)?;
        // A row group is held until it is complete; counted in rows it would hold whole files of wide points.
        if writer.in_progress_size() >= ROW_GROUP { writer.flush().map_err(failed) } else { Ok(()) }
    })?;
    writer.close().map(drop).map_err(failed)
}

pub(super) fn write_arrow(points: &Points<'_>, out: &mut OutputFile<'_>) -> Result<(), Error> {
    let (path, failure, schema) = (out.path, out.failure, schema(points));
    let failed = |source: arrow_schema::ArrowError| {
        failure(
            path,
            match source {
                arrow_schema::ArrowError::IoError(_, source) => source,
                other => std::io::Error::other(other),
            },
        )
    };
    let mut writer = FileWriter::try_new(&mut out.to, &schema).map_err(failed)?;
    points.blocks(|rows| writer.write(&batch(&schema, rows)).map_err(failed))?;
    writer.finish().map_err(failed)
}

fn schema(points: &Points<'_>) -> SchemaRef {
    let kind = kind(points);
    let name = |j: usize| points.columns.get(j).cloned().unwrap_or_else(|| format!("x{j}"));
    let fields: Vec<Field> =
        (0..points.source.dim()).map(|j| Field::new(name(j), kind.clone(), false)).collect();
    Arc::new(Schema::new(fields))
}

/// One column of lists, of which each is a point.
fn list_schema(points: &Points<'_>) -> std::io::Result<SchemaRef> {
    let kind = kind(points);
    let size = i32::try_from(points.source.dim()).map_err(|_| {
        std::io::Error::other(format!("a list of parquet holds at most {} values", i32::MAX))
    })?;
    let item = Arc::new(Field::new("item", kind, false));
    let field = Field::new("point", DataType::FixedSizeList(item, size), false);
    Ok(Arc::new(Schema::new(vec![field])))
}

fn kind(points: &Points<'_>) -> DataType {
    match points.source.scalar() {
        ScalarKind::F32 => DataType::Float32,
        ScalarKind::F64 => DataType::Float64,
    }
}

fn batch(schema: &SchemaRef, rows: Rows<'_>) -> RecordBatch {
    if let DataType::FixedSizeList(item, size) = schema.field(0).data_type() {
        let values: ArrayRef = match rows {
            Rows::F32(rows) => Arc::new(Float32Array::from(rows.values().to_vec())),
            Rows::F64(rows) => Arc::new(Float64Array::from(rows.values().to_vec())),
        };
        let lists = FixedSizeListArray::new(item.clone(), *size, values, None);
        return RecordBatch::try_new(schema.clone(), vec![Arc::new(lists)])
            .expect("the lists fit the schema of the points");
    }
    fn columns<T: Scalar>(rows: View<'_, T>, make: impl Fn(Vec<T>) -> ArrayRef) -> Vec<ArrayRef> {
        (0..rows.dim()).map(|j| make(rows.rows().map(|row| row[j]).collect())).collect()
    }
    let columns = match rows {
        Rows::F32(rows) => columns(rows, |values| Arc::new(Float32Array::from(values))),
        Rows::F64(rows) => columns(rows, |values| Arc::new(Float64Array::from(values))),
    };
    RecordBatch::try_new(schema.clone(), columns).expect("the columns fit the schema of the points")
}
