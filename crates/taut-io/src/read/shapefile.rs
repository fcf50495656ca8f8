//! Shapefiles: the points, or the vertices of lines and polygons, of the file `.shp`.
//!
//! *Read.* Points in their order, with z where they have it. Lines and polygons as their vertices, ring by ring: where there are several
//! parts a last column has the number of each, from 0. One shape of several can be chosen by its number.
//! *Refused.* Patches of surfaces (type 31), and of points a null shape, which lacks its coordinates.
//! *Trap.* Lengths are counted in 16-bit words and the highest byte comes first, but coordinates are little-endian. A ring ends
//! with its first vertex.
//! *Reference.* ESRI Shapefile Technical Description, 1998.

use std::io::{BufRead, Read};

use super::Decoded;
use crate::input::Job;
use crate::sink::Sink;
use crate::{Error, Feature, FilePlace, Format, Missing, Place, limits};

/// Bytes of the header of the file.
const HEADER_BYTES: usize = 100;

/// What the code at its beginning is.
const FILE_CODE: u32 = 9994;

/// The places of one part of a shape: x, y, z.
type Part = Vec<[f64; 3]>;

/// The kinds of shapes, by their type modulo 10.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Null,
    Point,
    Parts,
    Points,
}

pub(super) fn read(job: &Job<'_>, mut stream: Box<dyn BufRead>) -> Result<Decoded, Error> {
    let wanted = match &job.options.feature {
        None => None,
        Some(Feature::Number(number)) => Some(*number),
        Some(Feature::Name(name)) => {
            let problem =
                format!("shapes have numbers, counted from 0, but no names such as {name:?}");
            return Err(Error::Feature { path: job.path.to_owned(), problem });
        }
    };
    let mut header = [0; HEADER_BYTES];
    fill(job, &mut *stream, &mut header, FilePlace::File)?;
    let code = u32::from_be_bytes([header[0], header[1], header[2], header[3]]);
    if code != FILE_CODE {
        return Err(damaged(job, FilePlace::File, "it does not begin as a .shp file"));
    }
    let has_z = matches!(word(&header, 32), 11 | 13 | 15 | 18);
    let is_of_points = matches!(word(&header, 32), 1 | 11 | 21);
    let promised =
        2 * u64::from(u32::from_be_bytes([header[24], header[25], header[26], header[27]]));
    let mut found = HEADER_BYTES as u64;
    let (mut parts, mut number, mut has_parts): (Vec<Part>, u64, bool) = (vec![], 0, false);
    loop {
        let place = FilePlace::Element("shape", number);
        let mut head = [0; 8];
        match first_byte(job, &mut *stream)? {
            None => break,
            Some(byte) => {
                head[0] = byte;
                fill(job, &mut *stream, &mut head[1..], place)?;
            }
        }
        let bytes = 2 * u64::from(u32::from_be_bytes([head[4], head[5], head[6], head[7]]));
        let most = limits::most_held(job.options.memory) / 2;
        if bytes > most {
            return Err(Error::TooLarge {
                path: job.path.to_owned(),
                problem: "a shape",
                bytes,
                memory: most,
                remedy: "allow more memory, or divide the shape",
            });
        }
        let mut content = Vec::new();
        (&mut *stream)
            .take(bytes)
            .read_to_end(&mut content)
            .map_err(|source| Error::reading(job.path, source))?;
        if (content.len() as u64) < bytes {
            return Err(damaged(job, place, "the file ends here, too early"));
        }
        if wanted.is_none_or(|wanted| wanted == number) {
            let (mut kind, mut found) =
                shape(&content).map_err(|problem| damaged(job, place, problem))?;
            if kind == Kind::Null && is_of_points {
                if job.options.missing == Missing::Refuse {
                    let (path, name) = (job.path.to_owned(), Some("x".to_owned()));
                    let place = Place { path, row: number + 1, line: None, column: 0, name };
                    return Err(Error::Missing { place });
                }
                (kind, found) = (Kind::Point, vec![vec![[f64::NAN; 3]]]);
            }
            has_parts |= kind == Kind::Parts;
            match (kind, parts.last_mut()) {
                // Points go on; each part of a line or a polygon is one of its own.
                (Kind::Point | Kind::Points, Some(last)) if !has_parts => {
                    last.extend(found.into_iter().flatten());
                }
                _ => parts.extend(found),
            }
        }
        number += 1;
        found = found.saturating_add(8 + bytes);
    }
    if found < promised {
        let problem = format!("its header promises {promised} bytes, but there are {found}");
        return Err(damaged(job, FilePlace::File, problem));
    }
    if let Some(wanted) = wanted.filter(|&wanted| wanted >= number) {
        let problem = format!("there is no shape {wanted}: it has {number}, counted from 0");
        return Err(Error::Feature { path: job.path.to_owned(), problem });
    }
    rows(job, &parts, has_z)
}

/// The rows of all parts: x, y, z where the file has it, and of several parts the number of each.
fn rows(job: &Job<'_>, parts: &[Part], has_z: bool) -> Result<Decoded, Error> {
    let mut names = vec!["x", "y"];
    names.extend(has_z.then_some("z"));
    names.extend((parts.len() > 1).then_some("ring"));
    let names: Vec<String> = names.into_iter().map(str::to_owned).collect();
    let numbers = match &job.options.columns {
        Some(columns) => columns.resolve(job.path, &names, names.len())?,
        None => (0..names.len()).collect(),
    };
    let mut sink = Sink::new(job, numbers.len());
    let mut row = Vec::new();
    for (part, places) in parts.iter().enumerate() {
        for [x, y, z] in places {
            let all = if has_z { [*x, *y, *z, part as f64] } else { [*x, *y, part as f64, 0.0] };
            row.clear();
            row.extend(numbers.iter().map(|&number| all[number]));
            sink.push(&row)?;
        }
    }
    let columns = numbers.iter().map(|&number| names[number].clone()).collect();
    Ok(Decoded { source: sink.finish()?, columns, numbers: Some(numbers), labels: vec![] })
}

fn damaged(job: &Job<'_>, place: FilePlace, problem: impl Into<String>) -> Error {
    let (path, format) = (job.path.to_owned(), Format::Shapefile);
    Error::Damaged { path, format, place, problem: problem.into() }
}

fn fill(
    job: &Job<'_>,
    stream: &mut dyn BufRead,
    bytes: &mut [u8],
    place: FilePlace,
) -> Result<(), Error> {
    stream.read_exact(bytes).map_err(|source| match source.kind() {
        std::io::ErrorKind::UnexpectedEof => damaged(job, place, "the file ends here, too early"),
        _ => Error::reading(job.path, source),
    })
}

/// The first byte of the next record; `None` at the end of the file.
fn first_byte(job: &Job<'_>, stream: &mut dyn BufRead) -> Result<Option<u8>, Error> {
    let mut byte = Vec::new();
    stream.take(1).read_to_end(&mut byte).map_err(|source| Error::reading(job.path, source))?;
    Ok(byte.first().copied())
}

fn word(bytes: &[u8], at: usize) -> u32 {
    let four = bytes.get(at..at + 4).and_then(|four| four.try_into().ok());
    four.map_or(0, u32::from_le_bytes)
}

/// The parts of a shape.
fn shape(content: &[u8]) -> Result<(Kind, Vec<Part>), String> {
    const CUT: &str = "it is shorter than its numbers of parts and points say";
    let real = |at: usize| {
        let eight = content.get(at..at + 8).and_then(|eight| eight.try_into().ok());
        eight.map(f64::from_le_bytes).ok_or(CUT)
    };
    let place = |at: usize, z: Option<usize>| -> Result<[f64; 3], String> {
        let found = [real(at)?, real(at + 8)?, z.map_or(Ok(0.0), real)?];
        match found.iter().all(|value| value.is_finite()) {
            true => Ok(found),
            false => Err("a coordinate is not finite".to_owned()),
        }
    };
    if content.len() < 4 {
        return Err(CUT.to_owned());
    }
    let code = word(content, 0);
    let has_z = (10..20).contains(&code);
    let kind = match code {
        0 => Kind::Null,
        1 | 11 | 21 => Kind::Point,
        3 | 5 | 13 | 15 | 23 | 25 => Kind::Parts,
        8 | 18 | 28 => Kind::Points,
        other => return Err(format!("it is of type {other}, which is not read")),
    };
    match kind {
        Kind::Null => return Ok((kind, vec![])),
        Kind::Point => {
            let z = has_z.then_some(20);
            return Ok((kind, vec![vec![place(4, z)?]]));
        }
        Kind::Parts | Kind::Points => {}
    }
    let (parts, points, begin) = match kind {
        Kind::Points => (1, word(content, 36) as usize, 40),
        _ => {
            let parts = word(content, 36) as usize;
            (parts, word(content, 40) as usize, parts.saturating_mul(4).saturating_add(44))
        }
    };
    // The values of z come after all points and two bounds.
    let after = points.checked_mul(16).and_then(|bytes| bytes.checked_add(begin)).ok_or(CUT)?;
    if content.len() < after {
        return Err(CUT.to_owned());
    }
    let first = |part: usize| match (kind, part == parts) {
        (_, true) => points,
        (Kind::Parts, false) => word(content, 44 + 4 * part) as usize,
        _ => 0,
    };
    let mut found = Vec::new();
    for part in 0..parts {
        let (from, to) = (first(part), first(part + 1));
        if from > to || to > points {
            return Err("its parts are not in order".to_owned());
        }
        let places = (from..to).map(|k| place(begin + 16 * k, has_z.then(|| after + 16 + 8 * k)));
        found.push(places.collect::<Result<Part, String>>()?);
    }
    Ok((kind, found))
}
