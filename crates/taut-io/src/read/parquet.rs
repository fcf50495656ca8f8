//! Apache Parquet, batch by batch.

use arrow_array::RecordBatch;
use parquet::arrow::ProjectionMask;
use parquet::file::metadata::ParquetMetaData;
use parquet::file::reader::ChunkReader;
use parquet::schema::types::SchemaDescriptor;
use taut_points::Blocks;

use super::columnar::Plan;
use super::{Decoded, Seekable, first_line, geoparquet, guarded, thrift};
use crate::input::{Job, Medium};
use crate::labels;
use crate::{Columns, Error, FilePlace, Format};

pub(super) fn read(job: &Job<'_>, medium: Medium) -> Result<Decoded, Error> {
    guarded(job, || match medium.seekable(job)? {
        Seekable::File(file) => read_chunks(job, file),
        Seekable::Bytes(bytes) => read_chunks(job, bytes),
    })
}

fn read_chunks<R: ChunkReader + 'static>(job: &Job<'_>, chunks: R) -> Result<Decoded, Error> {
    let damaged = |problem: String| Error::Damaged {
        path: job.path.to_owned(),
        format: Format::Parquet,
        place: FilePlace::File,
        problem,
    };
    let builder = thrift::open(chunks).map_err(|e| damaged(first_line(&e)))?;
    let schema = builder.schema().clone();
    if let Some(number) = geoparquet::column(job, &schema)? {
        let mask = ProjectionMask::roots(builder.parquet_schema(), [number]);
        let batches = builder.with_projection(mask).build().map_err(|e| damaged(first_line(&e)))?;
        let batches = batches
            .map(|batch| batch.map_err(|e| damaged(first_line(&e))) as Result<RecordBatch, Error>);
        let read = geoparquet::read(job, (number, schema.field(number).name().as_str()), batches)?;
        return match job.options.label.as_deref().map(Columns::of_label) {
            Some(label) => labels::split(read, &label, job.path, false),
            None => Ok(read),
        };
    }
    let plan = Plan::new(job, &schema)?;
    let held = plan.held();
    let width = width(builder.metadata(), builder.parquet_schema(), &held);
    let mask = ProjectionMask::roots(builder.parquet_schema(), held.iter().copied());
    let batches = builder
        .with_projection(mask)
        .with_batch_size((Blocks::VALUES / width).max(1))
        .build()
        .map_err(|e| damaged(first_line(&e)))?
        .map(|batch| batch.map_err(|e| damaged(first_line(&e))) as Result<RecordBatch, Error>);
    plan.read(job, &held, batches)
}

/// Values of a row in the columns `held` (rising), those of lists counted one by one.
fn width(metadata: &ParquetMetaData, schema: &SchemaDescriptor, held: &[usize]) -> usize {
    let is_held = |leaf: usize| held.binary_search(&schema.get_column_root_idx(leaf)).is_ok();
    let (mut values, mut rows) = (0_u64, 0_u64);
    for group in metadata.row_groups() {
        rows = rows.saturating_add(u64::try_from(group.num_rows()).unwrap_or(0));
        for (_, chunk) in group.columns().iter().enumerate().filter(|(leaf, _)| is_held(*leaf)) {
            values = values.saturating_add(u64::try_from(chunk.num_values()).unwrap_or(0));
        }
    }
    usize::try_from(values / rows.max(1)).unwrap_or(usize::MAX).max(held.len()).max(1)
}
