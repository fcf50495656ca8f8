//! Apache Parquet, batch by batch.

mod batches;
mod schema;

use parquet::file::reader::ChunkReader;
use taut_points::Blocks;

pub(crate) use batches::Table;

use super::columnar::Plan;
use super::{Decoded, Seekable, first_line, geoparquet, guarded, thrift};
use crate::input::{Job, Medium};
use crate::labels;
use crate::{Columns, Error, FilePlace, Format};

/// Rows of geometries in a batch: each may take megabytes, and a batch at most 2 GiB.
const GEOMETRIES: usize = 64;

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
    let failed = |error: parquet::errors::ParquetError| damaged(first_line(&error));
    let unread = || damaged("a column is nested in another way than the schema says".to_owned());
    let table = thrift::open(chunks).map_err(failed)?;
    if let Some(number) = geoparquet::column(job, table.schema())? {
        let name = table.schema().field(number).name().clone();
        let batches = table.batches(&[number], GEOMETRIES).ok_or_else(unread)?;
        let batches = batches.map(|batch| batch.map_err(failed));
        let read = geoparquet::read(job, (number, &name), batches)?;
        return match job.options.label.as_deref().map(Columns::of_label) {
            Some(label) => labels::split(read, &label, job.path, false),
            None => Ok(read),
        };
    }
    let plan = Plan::new(job, table.schema())?;
    let held = plan.held();
    let rows = (Blocks::VALUES / table.width(&held)).max(1);
    let batches = table.batches(&held, rows).ok_or_else(unread)?;
    plan.read(job, &held, batches.map(|batch| batch.map_err(failed)))
}
