//! Arrow: a column for each coordinate, a batch for each block.

use std::sync::Arc;

use arrow_array::{ArrayRef, Float32Array, Float64Array, RecordBatch};
use arrow_ipc::writer::FileWriter;
use arrow_schema::{DataType, Field, Schema, SchemaRef};
use taut_points::{Points as View, Rows, Scalar, ScalarKind};

use super::{OutputFile, Points};
use crate::Error;

pub(super) fn write(points: &Points<'_>, out: &mut OutputFile<'_>) -> Result<(), Error> {
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
    let field = |j| Field::new(points.column_name(j), kind.clone(), false);
    Arc::new(Schema::new((0..points.source.dim()).map(field).collect::<Vec<_>>()))
}

fn kind(points: &Points<'_>) -> DataType {
    match points.source.scalar() {
        ScalarKind::F32 => DataType::Float32,
        ScalarKind::F64 => DataType::Float64,
    }
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
