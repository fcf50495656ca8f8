//! Apache Parquet: a column of ids for each vertex of a simplex, and nothing of the points.

use arrow_array::cast::AsArray;
use arrow_array::types::{Int32Type, Int64Type, UInt32Type, UInt64Type};
use arrow_array::{Array, ArrayRef};
use arrow_schema::DataType;
use parquet::file::properties::WriterProperties;
use parquet::file::reader::ChunkReader;

use super::MeshBuilder;
use super::writing::Job;
use crate::input::{self, Medium};
use crate::read::{Seekable, first_line, quiet, thrift};
use crate::write::OutputFile;
use crate::write::parquet::{ColumnKind, GROUP_ROWS, ParquetFile, Values};
use crate::{Error, FilePlace, Format, ReadOptions};

/// Simplices in a batch that is read.
const BATCH: usize = 1 << 16;

pub(super) fn write(job: &Job<'_>, out: &mut OutputFile<'_>) -> Result<(), Error> {
    let width = job.mesh.width;
    let columns = (0..width).map(|i| (format!("v{i}"), ColumnKind::U32)).collect();
    // Ids hardly repeat within a page, so a dictionary would only be tried and given up.
    let properties = WriterProperties::builder().set_dictionary_enabled(false);
    let mut file = ParquetFile::new(out, columns, properties)?;
    let mut held: Vec<u32> = Vec::new();
    let group = |file: &mut ParquetFile<'_, '_>, ids: &[u32]| {
        file.group(|i| {
            let column = ids.iter().skip(i).step_by(width);
            Values::Whole32(column.map(|id| id.cast_signed()).collect())
        })
    };
    job.each_piece(|piece| {
        held.extend_from_slice(piece);
        while held.len() >= GROUP_ROWS * width {
            group(&mut file, &held[..GROUP_ROWS * width])?;
            held.drain(..GROUP_ROWS * width);
        }
        Ok(())
    })?;
    if !held.is_empty() {
        group(&mut file, &held)?;
    }
    file.finish()
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
    let table = thrift::open(chunks).map_err(|e| mesh.damaged(at, first_line(&e)))?;
    let fields = table.schema().fields();
    let width = fields.len();
    if !(1..=4).contains(&width)
        || fields.iter().enumerate().any(|(i, field)| *field.name() != format!("v{i}"))
    {
        return Err(mesh.unsupported(at, "its columns are not v0, v1, … up to v3"));
    }
    let other = "its columns are not whole numbers of 32 or 64 bits, or some are missing";
    let is_id = |kind: &DataType| {
        matches!(kind, DataType::Int32 | DataType::Int64 | DataType::UInt32 | DataType::UInt64)
    };
    if !fields.iter().all(|field| is_id(field.data_type())) {
        return Err(mesh.unsupported(at, other));
    }
    let held: Vec<usize> = (0..width).collect();
    let batches = table.batches(&held, BATCH).ok_or_else(|| mesh.unsupported(at, other))?;
    let mut row = 0;
    let mut simplex = vec![0; width];
    for batch in batches {
        let batch =
            batch.map_err(|e| mesh.damaged(FilePlace::Element("row", row), first_line(&e)))?;
        let columns = batch.columns().iter().map(ids).collect::<Option<Vec<_>>>();
        let columns = columns.ok_or_else(|| mesh.unsupported(at, other))?;
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
