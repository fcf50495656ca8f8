//! LAS and LAZ, the formats of laser scans, point by point.
//!
//! *Coordinates.* The file has whole numbers of 32 bits, a scale and an offset for each of x, y and z; a coordinate is
//! number·scale + offset in double precision, rounded twice, as every reader has it.
//! *Reference.* ASPRS, LAS Specification 1.4, revision 15, 2019; M. Isenburg, LASzip: lossless compression of lidar data, 2013.

use std::io::{BufReader, Cursor};

use las::{PointDataBuilder, Reader};

use super::{Decoded, Seekable, first_line, guarded};
use crate::input::{Job, Medium};
use crate::sink::Sink;
use crate::{Error, FilePlace, Format};

/// Bytes of points that are decoded at once; the header may claim up to 64 KiB for each.
const BATCH_BYTES: u64 = 1 << 20;

/// Bytes of the file that are read at once.
const READ_BYTES: usize = 1 << 18;

pub(super) fn read(job: &Job<'_>, medium: Medium) -> Result<Decoded, Error> {
    guarded(job, || match medium.seekable(job)? {
        Seekable::File(file) => {
            decode(job, Reader::new(BufReader::with_capacity(READ_BYTES, file)))
        }
        Seekable::Bytes(bytes) => decode(job, Reader::new(Cursor::new(bytes))),
    })
}

fn decode(job: &Job<'_>, opened: las::Result<Reader>) -> Result<Decoded, Error> {
    let damaged = |place: FilePlace, error: las::Error| Error::Damaged {
        path: job.path.to_owned(),
        format: Format::Las,
        place,
        problem: first_line(&error),
    };
    let mut reader = opened.map_err(|error| damaged(FilePlace::File, error))?;
    let expected = reader.header().number_of_points();
    let names = ["x", "y", "z"].map(str::to_owned);
    let numbers = match &job.options.columns {
        Some(columns) => columns.resolve(job.path, &names, names.len())?,
        None => vec![0, 1, 2],
    };
    let is_kept = |class: u8| job.options.classes.as_ref().is_none_or(|list| list.contains(&class));
    let mut sink = Sink::<f64>::new(job, numbers.len());
    let mut batch = PointDataBuilder::new().for_header(reader.header()).build();
    let at_once = (BATCH_BYTES / batch.record_len().max(1) as u64).max(1);
    let (mut done, mut rows) = (0, vec![]);
    while done < expected {
        let wanted = at_once.min(expected - done);
        let place = FilePlace::Element("the batch from point", done);
        let found =
            reader.fill_points(wanted, &mut batch).map_err(|error| damaged(place, error))?;
        if found == 0 {
            let (path, found) = (job.path.to_owned(), done);
            let unit = ("point", "points");
            return Err(Error::Count { path, format: Format::Las, expected, found, unit });
        }
        rows.clear();
        let points = batch.x().zip(batch.y()).zip(batch.z()).zip(batch.classification());
        for (((x, y), z), class) in points.take(found as usize) {
            if is_kept(class) {
                let point = [x, y, z];
                rows.extend(numbers.iter().map(|&number| point[number]));
            }
        }
        sink.push(&rows)?;
        done += found;
    }
    let columns = numbers.iter().map(|&number| names[number].clone()).collect();
    Ok(Decoded { source: sink.finish()?, columns, numbers: Some(numbers), labels: Vec::new() })
}
