//! Parquet and arrow: a column for each coordinate, a batch for each block.

use std::sync::Arc;

use arrow_array::{ArrayRef, Float32Array, Float64Array, RecordBatch};
use arrow_ipc::writer::FileWriter;
use arrow_schema::{DataType, Field, Schema, SchemaRef};
use parquet::arrow::ArrowWriter;
use parquet::basic::Compression;
use parquet::file::properties::WriterProperties;
use taut_points::{Points as View, Rows, Scalar, ScalarKind};

use super::{Out, Points};
use crate::Error;

/// Bytes of encoded points in a row group.
const ROW_GROUP: usize = 64 << 20;

pub(super) fn write_parquet(points: &Points<'_>, out: &mut Out<'_>) -> Result<(), Error> {
    let (path, schema) = (out.path, schema(points));
    let failed = |source: parquet::errors::ParquetError| Error::writing(path, source.into());
    let properties = WriterProperties::builder().set_compression(Compression::SNAPPY).build();
    let mut writer =
        ArrowWriter::try_new(&mut out.to, schema.clone(), Some(properties)).map_err(failed)?;
    points.blocks(|rows| {
        writer.write(&batch(&schema, rows)).map_err(failed)?;
        // A row group is held until it is complete; counted in rows it would hold whole files of wide points.
        if writer.in_progress_size() >= ROW_GROUP { writer.flush().map_err(failed) } else { Ok(()) }
    })?;
    writer.close().map(drop).map_err(failed)
}

pub(super) fn write_arrow(points: &Points<'_>, out: &mut Out<'_>) -> Result<(), Error> {
    let (path, schema) = (out.path, schema(points));
    let failed = |source: arrow_schema::ArrowError| {
        Error::writing(
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
    let kind = match points.source.scalar() {
        ScalarKind::F32 => DataType::Float32,
        ScalarKind::F64 => DataType::Float64,
    };
    let name = |j: usize| points.columns.get(j).cloned().unwrap_or_else(|| format!("x{j}"));
    let fields: Vec<Field> =
        (0..points.source.dim()).map(|j| Field::new(name(j), kind.clone(), false)).collect();
    Arc::new(Schema::new(fields))
}

fn batch(schema: &SchemaRef, rows: Rows<'_>) -> RecordBatch {
    fn columns<T: Scalar>(rows: View<'_, T>, make: impl Fn(Vec<T>) -> ArrayRef) -> Vec<ArrayRef> {
        (0..rows.dim()).map(|j| make(rows.rows().map(|row| row[j]).collect())).collect()
    }
    let columns = match rows {
        Rows::F32(rows) => columns(rows, |values| Arc::new(Float32Array::from(values))),
        Rows::F64(rows) => columns(rows, |values| Arc::new(Float64Array::from(values))),
    };
    RecordBatch::try_new(schema.clone(), columns).expect("the columns fit the schema of the points")
}
