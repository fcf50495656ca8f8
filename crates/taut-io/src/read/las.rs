//! LAS and LAZ, the formats of laser scans, point by point.
//!
//! *Coordinates.* The file has whole numbers of 32 bits, a scale and an offset for each of x, y and z; a coordinate is
//! number·scale + offset in double precision, rounded twice, as every reader has it.
//! *Reference.* ASPRS, LAS Specification 1.4, revision 15, 2019; M. Isenburg, LASzip: lossless compression of lidar data, 2013.

use std::io::{BufReader, Cursor, Read, Seek, SeekFrom};

use las::{PointDataBuilder, Reader};

use super::{Decoded, Seekable, first_line, guarded};
use crate::filter::Filter;
use crate::input::{Job, Medium};
use crate::sink::Sink;
use crate::{Error, FilePlace, FilterError, Format};

/// Bytes of points that are decoded at once; the header may claim up to 64 KiB for each.
const BATCH_BYTES: u64 = 1 << 20;

/// Bytes of the file that are read at once.
const READ_BYTES: usize = 1 << 18;

/// Where a header has the offset of the points.
const POINTS_OFFSET_AT: u64 = 96;

/// Where it has their format.
const POINT_FORMAT_AT: u64 = 104;

pub(super) fn read(job: &Job<'_>, medium: Medium, filter: &mut Filter) -> Result<Decoded, Error> {
    guarded(job, || match medium.seekable(job)? {
        Seekable::File(file) => {
            let mut stream = BufReader::with_capacity(READ_BYTES, file);
            check_chunks(job, &mut stream)?;
            decode(job, Reader::new(stream), filter)
        }
        Seekable::Bytes(bytes) => {
            let mut stream = Cursor::new(bytes);
            check_chunks(job, &mut stream)?;
            decode(job, Reader::new(stream), filter)
        }
    })
}

/// Least bytes of a point without compression, with which each chunk of points begins.
const POINT_BYTES_MIN: u64 = 20;

/// Refuses a compressed file that was cut before its table of chunks, which is at its end and which the decoder asks for first, and one
/// whose table claims more chunks than the file has room for: the decoder makes room for all of them before it reads one.
fn check_chunks(job: &Job<'_>, stream: &mut (impl Read + Seek)) -> Result<(), Error> {
    let failed = |source| Error::reading(job.path, source);
    let length = stream.seek(SeekFrom::End(0)).map_err(failed)?;
    let mut read = |at: u64, bytes: &mut [u8]| {
        stream.seek(SeekFrom::Start(at)).and_then(|_| stream.read_exact(bytes)).is_ok()
    };
    // The offset of the points, u32; the format of points, whose highest bits say that it is compressed; both in the header.
    let (mut points, mut format, mut place) = ([0; 4], [0; 1], [0; 8]);
    let has_header = read(POINTS_OFFSET_AT, &mut points) && read(POINT_FORMAT_AT, &mut format);
    let is_compressed = has_header && format[0] & 0xc0 != 0;
    let begin = u64::from(u32::from_le_bytes(points));
    let mut table = match read(begin, &mut place) {
        true => u64::try_from(i64::from_le_bytes(place)).unwrap_or(0),
        false => begin + 8,
    };
    let is_cut = table > length;
    // A writer that could not go back has the place of the table in the last bytes of the file.
    if table <= begin && length >= 8 && read(length - 8, &mut place) {
        table = u64::from_le_bytes(place);
    }
    // A version, u32, then the number of chunks, u32.
    let mut count = [0; 4];
    let has_count = table.checked_add(4).is_some_and(|at| read(at, &mut count));
    let chunks = if has_count { u64::from(u32::from_le_bytes(count)) } else { 0 };
    stream.rewind().map_err(failed)?;
    let damaged = |byte: u64, problem: String| {
        let (path, place) = (job.path.to_owned(), FilePlace::Element("byte", byte));
        Err(Error::Damaged { path, format: Format::Las, place, problem })
    };
    if is_compressed && is_cut {
        return damaged(
            length,
            format!(
                "it ends here, before its points and their table of chunks at byte {table}: it was cut"
            ),
        );
    }
    // The last chunk may be empty.
    if is_compressed && chunks > length / POINT_BYTES_MIN + 1 {
        return damaged(
            table + 4,
            format!(
                "its points are in {chunks} chunks, but {length} bytes have no room for so many"
            ),
        );
    }
    Ok(())
}

fn decode(
    job: &Job<'_>,
    opened: las::Result<Reader>,
    filter: &mut Filter,
) -> Result<Decoded, Error> {
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
    let columns: Vec<String> = numbers.iter().map(|&number| names[number].clone()).collect();
    let (keeps_all, dim) = (filter.keeps_all(), numbers.len());
    let mut sieve = filter.sieve(job.path, dim, &columns)?;
    let mut sink = Sink::<f64>::new(job, dim);
    let mut batch = PointDataBuilder::new().for_header(reader.header()).build();
    let at_once = (BATCH_BYTES / batch.record_len().max(1) as u64).max(1);
    let (mut done, mut rows, mut seen) = (0, vec![], [false; 256]);
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
        for (row, (((x, y), z), class)) in (done..).zip(points.take(found as usize)) {
            let point = [x, y, z];
            seen[usize::from(class)] = true;
            if is_kept(class) && (keeps_all || sieve.keeps(row, |k| point[numbers[k]], dim)?) {
                rows.extend(numbers.iter().map(|&number| point[number]));
            }
        }
        sink.push(&rows)?;
        done += found;
    }
    let found: Vec<u8> = (0..=u8::MAX).filter(|&class| seen[usize::from(class)]).collect();
    if let Some(wanted) = &job.options.classes
        && !found.is_empty()
        && !found.iter().any(|&class| is_kept(class))
    {
        let (path, wanted) = (job.path.to_owned(), wanted.clone());
        return Err(FilterError::NothingOfClasses { path, wanted, found }.into());
    }
    if sink.len() == 0 && !keeps_all {
        return Err(FilterError::NothingKept { path: job.path.to_owned() }.into());
    }
    Ok(Decoded { source: sink.finish()?, columns, numbers: Some(numbers), labels: Vec::new() })
}
