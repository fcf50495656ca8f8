//! PCD, the format of the Point Cloud Library: a header of text, then points as text, binary or compressed.
//!
//! *Read.* The fields x, y and z, or those that are selected, in any of the types of the format. A field of several values has a
//! column for each.
//! *Compressed.* All values of a field one after the other, packed by LZF.
//! *Trap.* A header may claim any number of points: memory grows with the bytes that are there.
//! *Reference.* Point Cloud Library, "The PCD (Point Cloud Data) file format", version 0.7; M. Lehmann, liblzf.

use std::io::{BufRead, Read};

use super::Decoded;
use super::lines::Lines;
use super::rows::{Delimiter, Rows};
use crate::cursor::Kind;
use crate::input::Job;
use crate::sink::Sink;
use crate::{Error, FilePlace, Format, Missing, Place, limits};

/// Bytes of a line of the header, at most.
const HEADER_LINE_MAX: u64 = 1 << 16;

/// Lines of a header, at most: it has ten, and comments.
const HEADER_LINES_MAX: u64 = 1000;

/// Bytes of a point, at most.
const POINT_BYTES_MAX: usize = 1 << 20;

/// A byte of LZF stands for so many bytes at most: three bytes for 264.
const LARGEST_RATIO: u64 = 88;

/// A column of numbers: a field, or one of its values.
struct Column {
    name: String,
    kind: Kind,
    /// Where it begins in a point.
    at: usize,
    /// Where its field begins, and the bytes of that.
    field: [usize; 2],
}

enum Data {
    Text,
    Binary,
    Compressed,
}

struct Header {
    columns: Vec<Column>,
    /// Bytes of a point.
    size: usize,
    points: u64,
    data: Data,
    /// Lines of the header.
    lines: u64,
}

pub(super) fn read(job: &Job<'_>, mut stream: Box<dyn BufRead>) -> Result<Decoded, Error> {
    let header = header(job, &mut *stream)?;
    let names: Vec<String> = header.columns.iter().map(|column| column.name.clone()).collect();
    let numbers = match &job.options.columns {
        Some(columns) => columns.resolve(job.path, &names, names.len())?,
        None => {
            let wanted = ["x", "y", "z"];
            let found = wanted.iter().filter_map(|name| names.iter().position(|n| n == name));
            let found: Vec<usize> = found.collect();
            if found.is_empty() {
                let problem = "no field x, y or z";
                let path = job.path.to_owned();
                return Err(Error::NoCoordinates { path, problem, columns: names });
            }
            found
        }
    };
    let sink = match header.data {
        Data::Text => return text(job, stream, &header, names, numbers),
        Data::Binary => binary(job, &mut *stream, &header, &numbers)?,
        Data::Compressed => compressed(job, &mut *stream, &header, &numbers)?,
    };
    let columns = numbers.iter().map(|&number| names[number].clone()).collect();
    Ok(Decoded { source: sink.finish()?, columns, numbers: Some(numbers), labels: vec![] })
}

fn damaged(job: &Job<'_>, place: FilePlace, problem: impl Into<String>) -> Error {
    Error::Damaged {
        path: job.path.to_owned(),
        format: Format::Pcd,
        place,
        problem: problem.into(),
    }
}

fn header(job: &Job<'_>, stream: &mut dyn BufRead) -> Result<Header, Error> {
    let (mut names, mut sizes, mut types): (Vec<String>, Vec<String>, Vec<String>) =
        (vec![], vec![], vec![]);
    let (mut counts, mut points): (Vec<usize>, Option<u64>) = (vec![], None);
    for line_number in 1..=HEADER_LINES_MAX {
        let at = FilePlace::Line(line_number);
        let mut line = Vec::new();
        (&mut *stream)
            .take(HEADER_LINE_MAX)
            .read_until(b'\n', &mut line)
            .map_err(|source| Error::reading(job.path, source))?;
        if line.last() != Some(&b'\n') {
            return Err(damaged(job, at, "the header ends here, before its line DATA"));
        }
        let line = String::from_utf8_lossy(&line).into_owned();
        let mut words = line.split_ascii_whitespace();
        let Some(key) = words.next().filter(|key| !key.starts_with('#')) else { continue };
        let words: Vec<String> = words.map(str::to_owned).collect();
        let whole = |word: &String| {
            let problem = || damaged(job, at, format!("`{word}` is no whole number"));
            word.parse::<u64>().map_err(|_| problem())
        };
        match key {
            "FIELDS" => names = words,
            "SIZE" => sizes = words,
            "TYPE" => types = words,
            "COUNT" => {
                let each = words.iter().map(whole).collect::<Result<Vec<u64>, Error>>()?;
                counts = each.iter().map(|&n| usize::try_from(n).unwrap_or(usize::MAX)).collect();
            }
            "POINTS" => points = words.first().map(whole).transpose()?,
            "DATA" => {
                let data = match words.first().map(String::as_str) {
                    Some("ascii") => Data::Text,
                    Some("binary") => Data::Binary,
                    Some("binary_compressed") => Data::Compressed,
                    _ => {
                        let problem = "DATA is none of ascii, binary and binary_compressed";
                        return Err(damaged(job, at, problem));
                    }
                };
                let points = points.ok_or_else(|| damaged(job, at, "no line POINTS is before"))?;
                if counts.is_empty() {
                    counts = vec![1; names.len()];
                }
                let (columns, size) = columns(job, at, &names, &sizes, &types, &counts)?;
                return Ok(Header { columns, size, points, data, lines: line_number });
            }
            _ => {}
        }
    }
    Err(damaged(job, FilePlace::File, "its header has no line DATA"))
}

fn columns(
    job: &Job<'_>,
    at: FilePlace,
    names: &[String],
    sizes: &[String],
    types: &[String],
    counts: &[usize],
) -> Result<(Vec<Column>, usize), Error> {
    let lengths = [sizes.len(), types.len(), counts.len()];
    if names.is_empty() || lengths.iter().any(|&length| length != names.len()) {
        let problem = "FIELDS, SIZE, TYPE and COUNT have different numbers of words";
        return Err(damaged(job, at, problem));
    }
    let (mut columns, mut size) = (vec![], 0usize);
    for (k, name) in names.iter().enumerate() {
        let kind = match (&*types[k], &*sizes[k]) {
            ("F", "4") => Kind::F32,
            ("F", "8") => Kind::F64,
            ("I", "1") => Kind::I8,
            ("I", "2") => Kind::I16,
            ("I", "4") => Kind::I32,
            ("I", "8") => Kind::I64,
            ("U", "1") => Kind::U8,
            ("U", "2") => Kind::U16,
            ("U", "4") => Kind::U32,
            ("U", "8") => Kind::U64,
            (kind, bytes) => {
                let problem = format!("field {name} has the type {kind} of {bytes} bytes");
                return Err(damaged(job, at, problem));
            }
        };
        let bytes = kind.size().saturating_mul(counts[k]);
        let end = size.saturating_add(bytes);
        if end > POINT_BYTES_MAX {
            let problem = format!("a point has more than {POINT_BYTES_MAX} bytes");
            return Err(damaged(job, at, problem));
        }
        for value in 0..counts[k] {
            let name = if counts[k] == 1 { name.clone() } else { format!("{name}{value}") };
            let at = size + value * kind.size();
            columns.push(Column { name, kind, at, field: [size, bytes] });
        }
        size = end;
    }
    match size {
        0 => Err(damaged(job, at, "a point has no byte")),
        _ => Ok((columns, size)),
    }
}

fn text(
    job: &Job<'_>,
    stream: Box<dyn BufRead>,
    header: &Header,
    names: Vec<String>,
    numbers: Vec<usize>,
) -> Result<Decoded, Error> {
    let mut lines = Lines::new(stream, job);
    let mut rows = Rows::new(job, Delimiter::White, 0, names.len());
    (rows.names, rows.numbers, rows.why) = (names, Some(numbers), "as the header says");
    let mut sink = Sink::new(job, rows.dim());
    while let Some((line, text)) = lines.next_data()? {
        rows.push((line + header.lines, text), &mut sink)?;
    }
    check_count(job, header.points, sink.len())?;
    let (columns, numbers) = (rows.coordinate_names(), rows.numbers.take());
    Ok(Decoded { source: sink.finish()?, columns, numbers, labels: vec![] })
}

fn check_count(job: &Job<'_>, expected: u64, found: u64) -> Result<(), Error> {
    match expected == found {
        true => Ok(()),
        false => {
            let (path, unit) = (job.path.to_owned(), ("point", "points"));
            Err(Error::Count { path, format: Format::Pcd, expected, found, unit })
        }
    }
}

/// Points one after the other.
fn binary<'a>(
    job: &'a Job<'_>,
    stream: &mut dyn BufRead,
    header: &Header,
    numbers: &[usize],
) -> Result<Sink<'a, f64>, Error> {
    limits::check_point(job.path, header.size as u64, job.options.memory)?;
    let mut sink = Sink::new(job, numbers.len());
    let (mut point, mut row) = (vec![0; header.size], vec![0.0; numbers.len()]);
    for number in 0..header.points {
        if let Err(source) = stream.read_exact(&mut point) {
            return Err(match source.kind() {
                std::io::ErrorKind::UnexpectedEof => {
                    let (path, unit) = (job.path.to_owned(), ("point", "points"));
                    let (expected, found) = (header.points, number);
                    Error::Count { path, format: Format::Pcd, expected, found, unit }
                }
                _ => Error::reading(job.path, source),
            });
        }
        for (x, &at) in row.iter_mut().zip(numbers) {
            let column = &header.columns[at];
            *x = value(job, column, &point[column.at..], number, at)?;
        }
        sink.push(&row)?;
    }
    let rest = stream.fill_buf().map_err(|source| Error::reading(job.path, source))?;
    match rest.is_empty() {
        true => Ok(sink),
        false => {
            let at = FilePlace::Line(header.lines);
            let problem = format!("more bytes follow its {} points", header.points);
            Err(damaged(job, at, problem))
        }
    }
}

/// Fields one after the other, packed.
fn compressed<'a>(
    job: &'a Job<'_>,
    stream: &mut dyn BufRead,
    header: &Header,
    numbers: &[usize],
) -> Result<Sink<'a, f64>, Error> {
    let at = FilePlace::Line(header.lines);
    let failed = |source| Error::reading(job.path, source);
    let mut sizes = Vec::new();
    (&mut *stream).take(8).read_to_end(&mut sizes).map_err(failed)?;
    let Some(([packed, whole], _)) = sizes.as_chunks::<4>().0.split_first_chunk::<2>() else {
        return Err(damaged(job, at, "it ends before the size of its points"));
    };
    let [packed, whole] = [packed, whole].map(|bytes| u64::from(u32::from_le_bytes(*bytes)));
    let expected = header.points.saturating_mul(header.size as u64);
    if whole != expected || whole > packed.saturating_mul(LARGEST_RATIO) {
        let problem =
            format!("{packed} packed bytes are said to be {whole}, but points have {expected}");
        return Err(damaged(job, at, problem));
    }
    let most = limits::most_held(job.options.memory);
    if whole > most {
        return Err(Error::TooLarge {
            path: job.path.to_owned(),
            problem: "a compressed cloud",
            bytes: whole,
            memory: most,
            remedy: "allow more memory, or write it with DATA binary",
        });
    }
    let mut bytes = Vec::new();
    stream.take(packed).read_to_end(&mut bytes).map_err(failed)?;
    // What was not read must not decide how much memory is taken.
    if (bytes.len() as u64) < packed {
        return Err(damaged(job, at, "its packed points are cut short or damaged"));
    }
    let fields = unpack(&bytes, whole as usize)
        .ok_or_else(|| damaged(job, at, "its packed points are cut short or damaged"))?;
    let mut sink = Sink::new(job, numbers.len());
    let mut row = vec![0.0; numbers.len()];
    let points = header.points as usize;
    for number in 0..points {
        for (x, &at) in row.iter_mut().zip(numbers) {
            let column = &header.columns[at];
            // A field of several values has those of a point side by side.
            let [begin, width] = column.field;
            let place = begin * points + number * width + (column.at - begin);
            *x = value(job, column, &fields[place..], number as u64, at)?;
        }
        sink.push(&row)?;
    }
    Ok(sink)
}

/// The value of a column; a NaN is a gap.
fn value(
    job: &Job<'_>,
    column: &Column,
    bytes: &[u8],
    row: u64,
    number: usize,
) -> Result<f64, Error> {
    let mut raw = [0; 8];
    let size = column.kind.size();
    raw[..size].copy_from_slice(&bytes[..size]);
    let word = u64::from_le_bytes(raw);
    let place = || {
        let (path, name) = (job.path.to_owned(), Some(column.name.clone()));
        Place { path, row: row + 1, line: None, column: number, name }
    };
    let exact = |integer: i128| match integer as f64 as i128 == integer {
        true => Ok(integer as f64),
        false => Err(Error::Inexact { place: place(), value: integer.to_string() }),
    };
    let value = match column.kind {
        Kind::F32 => f32::from_bits(word as u32).into(),
        Kind::F64 => f64::from_bits(word),
        Kind::I8 => f64::from(word as i8),
        Kind::I16 => f64::from(word as i16),
        Kind::I32 => f64::from(word as i32),
        Kind::I64 => exact((word as i64).into())?,
        Kind::U8 | Kind::U16 | Kind::U32 | Kind::U64 => exact(word.into())?,
    };
    let is_gap = value.is_nan() && job.options.missing != Missing::Refuse;
    if value.is_finite() || is_gap {
        return Ok(value);
    }
    Err(Error::NonFinite { place: place(), value: value.to_string() })
}

/// Unpacks LZF to so many bytes; `None` where it stands for another number of them.
fn unpack(packed: &[u8], size: usize) -> Option<Vec<u8>> {
    let mut whole = Vec::with_capacity(size);
    let mut rest = packed.iter().copied();
    while let Some(control) = rest.next() {
        let control = usize::from(control);
        if control < 32 {
            // So many bytes and one more as they are.
            for _ in 0..=control {
                whole.push(rest.next()?);
            }
        } else {
            let mut length = control >> 5;
            if length == 7 {
                length += usize::from(rest.next()?);
            }
            let back = (control & 31) << 8 | usize::from(rest.next()?);
            let from = whole.len().checked_sub(back + 1)?;
            // They may overlap what is being written.
            for k in 0..length + 2 {
                whole.push(*whole.get(from + k)?);
            }
        }
        if whole.len() > size {
            return None;
        }
    }
    (whole.len() == size).then_some(whole)
}

#[cfg(test)]
mod tests {
    use super::unpack;

    #[test]
    fn packed_bytes_are_copied_and_repeated() {
        // Two bytes as they are, then five from two back: overlapping.
        assert_eq!(unpack(&[1, b'a', b'b', 3 << 5, 1], 7), Some(b"abababa".to_vec()));
        // Seven and more: the length goes on in a byte.
        let long = unpack(&[0, b'x', 7 << 5, 20, 0], 30);
        assert_eq!(long, Some(vec![b'x'; 30]));
        for (packed, size) in
            [(&[1, b'a'][..], 2), (&[3 << 5, 1], 5), (&[0, b'a'], 2), (&[0, b'a'], 0)]
        {
            assert_eq!(unpack(packed, size), None);
        }
    }
}
