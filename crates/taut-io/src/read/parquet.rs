//! Apache Parquet, batch by batch.

use std::fs::File;

use arrow_array::RecordBatch;
use bytes::Bytes;
use parquet::arrow::ProjectionMask;
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use parquet::file::reader::ChunkReader;
use taut_points::Blocks;

use super::columnar::Plan;
use super::{Decoded, guarded};
use crate::input::{Job, Medium};
use crate::{Error, Format};

pub(super) fn read(job: &Job<'_>, medium: Medium) -> Result<Decoded, Error> {
    guarded(job, || match medium.seekable(job)? {
        Seekable::File(file) => read_chunks(job, file),
        Seekable::Bytes(bytes) => read_chunks(job, bytes),
    })
}

/// What can be read at any place; parquet keeps its index at the end.
pub(crate) enum Seekable {
    File(File),
    Bytes(Bytes),
}

fn read_chunks<R: ChunkReader + 'static>(job: &Job<'_>, chunks: R) -> Result<Decoded, Error> {
    let damaged = |problem: String| Error::Damaged {
        path: job.path.to_owned(),
        format: Format::Parquet,
        problem,
    };
    let builder =
        ParquetRecordBatchReaderBuilder::try_new(chunks).map_err(|e| damaged(e.to_string()))?;
    let plan = Plan::new(job, builder.schema())?;
    let mut held = plan.numbers.clone();
    held.sort_unstable();
    held.dedup();
    let mask = ProjectionMask::roots(builder.parquet_schema(), held.iter().copied());
    let batches = builder
        .with_projection(mask)
        .with_batch_size((Blocks::VALUES / held.len().max(1)).max(1))
        .build()
        .map_err(|e| damaged(e.to_string()))?
        .map(|batch| batch.map_err(|e| damaged(e.to_string())) as Result<RecordBatch, Error>);
    plan.read(job, &held, batches)
}
