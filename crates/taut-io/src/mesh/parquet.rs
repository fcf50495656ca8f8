//! Apache Parquet: a column of ids for each vertex of a simplex, and nothing of the points.

use std::sync::Arc;

use arrow_array::cast::AsArray;
use arrow_array::types::{Int32Type, Int64Type, UInt32Type, UInt64Type};
use arrow_array::{Array, ArrayRef, RecordBatch, UInt32Array};
use arrow_schema::{DataType, Field, Schema};
use parquet::arrow::ArrowWriter;
use parquet::basic::Compression;
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::reader::ChunkReader;

use super::MeshBuilder;
use super::writing::Job;
use crate::input::{self, Medium};
use crate::read::{Seekable, first_line, quiet, thrift};
use crate::write::OutputFile;
use crate::{Error, FilePlace, Format, ReadOptions};

pub(super) fn write(job: &Job<'_>, out: &mut OutputFile<'_>) -> Result<(), Error> {
    let (path, failure, width) = (out.path, out.failure, job.mesh.width);
    let failed = |source: ParquetError| failure(path, source.into());
    let field = |i| Field::new(format!("v{i}"), DataType::UInt32, false);
    let schema = Arc::new(Schema::new((0..width).map(field).collect::<Vec<_>>()));
    // Ids hardly repeat within a page, so a dictionary would only be tried and given up.
    let properties = WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .set_dictionary_enabled(false)
        .build();
    let mut writer =
        ArrowWriter::try_new(&mut out.to, schema.clone(), Some(properties)).map_err(failed)?;
    job.each_piece(|piece| {
        let column = |i: usize| -> ArrayRef {
            Arc::new(UInt32Array::from_iter_values(piece.chunks_exact(width).map(|row| row[i])))
        };
        let batch = RecordBatch::try_new(schema.clone(), (0..width).map(column).collect())
            .expect("the columns fit the schema of the simplices");
        writer.write(&batch).map_err(failed)
    })?;
    writer.close().map(drop).map_err(failed)
}

pub(super) fn read(mesh: &mut MeshBuilder<'_>, medium: Medium) -> Result<(), Error> {
    let options = ReadOptions::default();
    let job = input::Job { path: mesh.path, format: Format::Parquet, options: &options };
    let seekable = medium.seekable(&job)?;
    let damaged =
        mesh.damaged(FilePlace::File, "its decoder stumbled over bytes that contradict each other");
    // The decoder checks most, but not all, of what a damaged file can hold before it indexes into it.
    quiet::catch(|| match seekable {
        Seekable::File(file) => read_chunks(mesh, file),
        Seekable::Bytes(bytes) => read_chunks(mesh, bytes),
    })
    .unwrap_or(Err(damaged))
}

fn read_chunks<R: ChunkReader + 'static>(
    mesh: &mut MeshBuilder<'_>,
    chunks: R,
) -> Result<(), Error> {
    let at = FilePlace::File;
    let builder = thrift::open(chunks).map_err(|e| mesh.damaged(at, first_line(&e)))?;
    let names: Vec<&str> = builder.schema().fields().iter().map(|f| f.name().as_str()).collect();
    let width = names.len();
    if !(1..=4).contains(&width)
        || names.iter().enumerate().any(|(i, name)| *name != format!("v{i}"))
    {
        return Err(mesh.unsupported(at, "its columns are not v0, v1, … up to v3"));
    }
    let batches = builder.build().map_err(|e| mesh.damaged(at, first_line(&e)))?;
    let mut row = 0;
    let mut simplex = vec![0; width];
    for batch in batches {
        let batch =
            batch.map_err(|e| mesh.damaged(FilePlace::Element("row", row), first_line(&e)))?;
        let columns =
            batch.columns().iter().map(ids).collect::<Option<Vec<_>>>().ok_or_else(|| {
                mesh.unsupported(
                    at,
                    "its columns are not whole numbers of 32 or 64 bits, or some are missing",
                )
            })?;
        for i in 0..batch.num_rows() {
            for (id, column) in simplex.iter_mut().zip(&columns) {
                *id = column[i];
            }
            mesh.simplex(FilePlace::Element("row", row), &simplex, width, u32::MAX.into())?;
            row += 1;
        }
    }
    Ok(())
}

/// The values of a column; −1 for what is no id of 63 bits. `None` for another type, or where some are missing.
fn ids(column: &ArrayRef) -> Option<Vec<i64>> {
    if column.null_count() > 0 {
        return None;
    }
    Some(match column.data_type() {
        DataType::UInt32 => {
            column.as_primitive::<UInt32Type>().values().iter().map(|&id| id.into()).collect()
        }
        DataType::Int32 => {
            column.as_primitive::<Int32Type>().values().iter().map(|&id| id.into()).collect()
        }
        DataType::Int64 => column.as_primitive::<Int64Type>().values().to_vec(),
        DataType::UInt64 => column
            .as_primitive::<UInt64Type>()
            .values()
            .iter()
            .map(|&id| i64::try_from(id).unwrap_or(-1))
            .collect(),
        _ => return None,
    })
}
