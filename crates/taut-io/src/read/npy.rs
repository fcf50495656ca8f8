//! NumPy arrays: n × d, or n numbers as points of dimension 1.
//!
//! *Idea.* Little-endian floats in C order already lie as a [`PointSource`](taut_points::PointSource) wants them: an
//! uncompressed file is read in place. Other byte orders, integers, Fortran order and selections are decoded.
//! *Trap.* A header can promise any shape: nothing is allocated by its word, only by bytes that are there.
//! *Reference.* NumPy enhancement proposal 1 (the npy format), versions 1.0 to 3.0.

use std::io::{self, BufRead, Read};

use taut_points::{Scalar, ScalarKind};

use super::Decoded;
use crate::input::Job;
use crate::limits;
use crate::npy_header::{self, NpyHeader};
use crate::sink::Sink;
use crate::{Error, Format, Missing, Place};

/// Values read at a time.
const CHUNK: usize = 1 << 13;

pub(super) struct Header {
    element: Element,
    big_endian: bool,
    fortran: bool,
    n: u64,
    dim: usize,
    /// Bytes up to the first value.
    pub(super) offset: u64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Element {
    Float(ScalarKind),
    Signed(usize),
    Unsigned(usize),
}

impl Element {
    fn size(self) -> usize {
        match self {
            Element::Float(kind) => kind.size(),
            Element::Signed(size) | Element::Unsigned(size) => size,
        }
    }
}

impl Header {
    /// Shape and type of values that lie as points do, if they lie so.
    pub(super) fn in_place(&self) -> Option<(u64, usize, ScalarKind)> {
        match self.element {
            Element::Float(kind) if !self.big_endian && !self.fortran => {
                Some((self.n, self.dim, kind))
            }
            _ => None,
        }
    }

    fn bytes(&self) -> Option<u64> {
        self.n.checked_mul(self.dim as u64)?.checked_mul(self.element.size() as u64)
    }

    /// Refuses values of another length than the header promises.
    pub(super) fn check_bytes(&self, job: &Job<'_>, found: u64) -> Result<(), Error> {
        if self.bytes() == Some(found) { Ok(()) } else { Err(self.count(job, found)) }
    }

    fn count(&self, job: &Job<'_>, found: u64) -> Error {
        Error::Count {
            path: job.path.to_owned(),
            format: Format::Npy,
            expected: self.bytes().unwrap_or(u64::MAX),
            found,
            unit: ("byte of values", "bytes of values"),
        }
    }

    /// The value of some bytes; an integer that is no `f64` as itself.
    fn value(&self, raw: &[u8]) -> Result<f64, i128> {
        let mut word = [0; 8];
        word[..raw.len()].copy_from_slice(raw);
        if self.big_endian {
            word[..raw.len()].reverse();
        }
        let bits = u64::from_le_bytes(word);
        let integer = match self.element {
            Element::Float(ScalarKind::F32) => return Ok(f32::from_bits(bits as u32).into()),
            Element::Float(ScalarKind::F64) => return Ok(f64::from_bits(bits)),
            Element::Signed(size) => {
                let unused = 64 - 8 * size as u32;
                i128::from(((bits << unused) as i64) >> unused)
            }
            Element::Unsigned(_) => i128::from(bits),
        };
        if integer as f64 as i128 == integer { Ok(integer as f64) } else { Err(integer) }
    }
}

/// Reads the header and leaves `stream` at the first value.
pub(super) fn header(job: &Job<'_>, stream: &mut dyn BufRead) -> Result<Header, Error> {
    let NpyHeader { descr, fortran, shape, offset } = NpyHeader::read(job.path, stream)?;
    let Some(descr) = descr else {
        return Err(Error::Array {
            path: job.path.to_owned(),
            problem: "its elements are records with fields".to_owned(),
            remedy: "save the coordinate fields as one array, for instance with np.column_stack",
        });
    };
    let (element, big_endian) = element(job, &descr)?;
    let (n, dim) = match shape[..] {
        [n] => (n, 1),
        [n, dim] => (n, dim),
        _ => {
            return Err(Error::Array {
                path: job.path.to_owned(),
                problem: format!("its shape {shape:?} has {} axes, not 2 (or 1)", shape.len()),
                remedy: "reshape it to n points × d coordinates",
            });
        }
    };
    let dim = match usize::try_from(dim) {
        Ok(0) => {
            return Err(Error::Array {
                path: job.path.to_owned(),
                problem: format!("its shape {shape:?} gives points of dimension 0"),
                remedy: "a point needs at least one coordinate",
            });
        }
        Ok(dim) => dim,
        Err(_) => {
            return Err(npy_header::damaged(
                job.path,
                &format!("its shape {shape:?} is out of range"),
            ));
        }
    };
    if n == 0 {
        return Err(Error::NoRows { path: job.path.to_owned() });
    }
    // In one dimension, and for one column, both orders are the same.
    let fortran = fortran && dim > 1 && n > 1;
    Ok(Header { element, big_endian, fortran, n, dim, offset })
}

/// Reads `<f8` and its kin.
fn element(job: &Job<'_>, descr: &str) -> Result<(Element, bool), Error> {
    let (order, kind) = match descr.as_bytes().first() {
        Some(b'<' | b'=' | b'|') => (false, &descr[1..]),
        Some(b'>') => (true, &descr[1..]),
        _ => (false, descr),
    };
    let element = match kind {
        "f4" => Element::Float(ScalarKind::F32),
        "f8" => Element::Float(ScalarKind::F64),
        "i1" => Element::Signed(1),
        "i2" => Element::Signed(2),
        "i4" => Element::Signed(4),
        "i8" => Element::Signed(8),
        "u1" => Element::Unsigned(1),
        "u2" => Element::Unsigned(2),
        "u4" => Element::Unsigned(4),
        "u8" => Element::Unsigned(8),
        _ => {
            return Err(Error::Array {
                path: job.path.to_owned(),
                problem: format!("its element type is `{}`", super::rows::shown(descr.as_bytes())),
                remedy: "save it as float32 or float64 (`array.astype(\"float64\")`)",
            });
        }
    };
    Ok((element, order))
}

/// Decodes the values that follow the header.
pub(super) fn decode(
    job: &Job<'_>,
    header: &Header,
    stream: Box<dyn BufRead>,
) -> Result<Decoded, Error> {
    match header.element {
        Element::Float(ScalarKind::F32) => Decoder::<f32>::new(job, header, stream)?.decode(),
        _ => Decoder::<f64>::new(job, header, stream)?.decode(),
    }
}

struct Decoder<'a, T> {
    job: &'a Job<'a>,
    header: &'a Header,
    stream: Box<dyn BufRead>,
    /// The selected columns; all where none.
    numbers: Option<Vec<usize>>,
    /// Values read so far, and the last of them as bytes and as numbers.
    read: u64,
    bytes: Vec<u8>,
    values: Vec<T>,
}

impl<'a, T: Scalar> Decoder<'a, T> {
    fn new(
        job: &'a Job<'a>,
        header: &'a Header,
        mut stream: Box<dyn BufRead>,
    ) -> Result<Self, Error> {
        // d values must be there in either order; from here on, memory of size d is paid for by bytes that exist.
        let mut first = Vec::new();
        let size = (header.dim as u64).saturating_mul(header.element.size() as u64);
        limits::check_point(job.path, size, job.options.memory)?;
        (&mut stream)
            .take(size)
            .read_to_end(&mut first)
            .map_err(|source| Error::reading(job.path, source))?;
        if (first.len() as u64) < size {
            return Err(header.count(job, first.len() as u64));
        }
        let stream = Box::new(io::Cursor::new(first).chain(stream));
        let numbers = job
            .options
            .columns
            .as_ref()
            .map(|columns| columns.resolve(job.path, &[], header.dim))
            .transpose()?;
        Ok(Decoder { job, header, stream, numbers, read: 0, bytes: Vec::new(), values: Vec::new() })
    }

    fn decode(mut self) -> Result<Decoded, Error> {
        let sink = if self.header.fortran { self.by_columns()? } else { self.by_rows()? };
        let rest = io::copy(&mut self.stream, &mut io::sink())
            .map_err(|source| Error::reading(self.job.path, source))?;
        if rest > 0 {
            return Err(self.header.count(self.job, self.bytes_read().saturating_add(rest)));
        }
        Ok(Decoded {
            source: sink.finish()?,
            columns: Vec::new(),
            numbers: self.numbers,
            labels: Vec::new(),
        })
    }

    /// C order: point after point.
    fn by_rows(&mut self) -> Result<Sink<'a, T>, Error> {
        let dim = self.header.dim;
        let mut sink = Sink::new(self.job, self.numbers.as_ref().map_or(dim, Vec::len));
        let rows = (CHUNK / dim).max(1);
        let mut chosen = Vec::new();
        let mut row = 0;
        while row < self.header.n {
            let count = self.header.n.min(row + rows as u64) - row;
            self.next(count as usize * dim, |at| (row + (at / dim) as u64, at % dim))?;
            match &self.numbers {
                None => sink.push(&self.values)?,
                Some(numbers) => {
                    chosen.clear();
                    for point in self.values.chunks_exact(dim) {
                        chosen.extend(numbers.iter().map(|&number| point[number]));
                    }
                    sink.push(&chosen)?;
                }
            }
            row += count;
        }
        Ok(sink)
    }

    /// Fortran order: column after column, held in memory to be put in order.
    fn by_columns(&mut self) -> Result<Sink<'a, T>, Error> {
        let Header { n, dim, .. } = *self.header;
        let wanted = self.numbers.clone().unwrap_or_else(|| (0..dim).collect());
        // The columns and, while they are put in order, the points.
        let bytes = n.saturating_mul(wanted.len() as u64).saturating_mul(2 * size_of::<T>() as u64);
        if let Some(memory) = self.job.options.memory.filter(|&memory| memory < bytes) {
            return Err(Error::TooLarge {
                path: self.job.path.to_owned(),
                problem: "an array in Fortran order",
                bytes,
                memory,
                remedy: "allow more memory, or save it in C order (`numpy.ascontiguousarray`)",
            });
        }
        let mut columns: Vec<Vec<T>> = vec![Vec::new(); dim];
        let mut used = vec![false; dim];
        wanted.iter().for_each(|&number| used[number] = true);
        for column in 0..dim {
            let mut row = 0;
            while row < n {
                let count = n.min(row + CHUNK as u64) - row;
                self.next(count as usize, |at| (row + at as u64, column))?;
                if used[column] {
                    columns[column].extend_from_slice(&self.values);
                }
                row += count;
            }
        }
        let mut sink = Sink::new(self.job, wanted.len());
        let mut point = Vec::new();
        for row in 0..n as usize {
            point.clear();
            point.extend(wanted.iter().map(|&number| columns[number][row]));
            sink.push(&point)?;
        }
        Ok(sink)
    }

    /// Reads the next `count` values; `place` tells row and column of the i-th of them.
    fn next(&mut self, count: usize, place: impl Fn(usize) -> (u64, usize)) -> Result<(), Error> {
        let size = self.header.element.size();
        self.bytes.clear();
        (&mut self.stream)
            .take((count * size) as u64)
            .read_to_end(&mut self.bytes)
            .map_err(|source| Error::reading(self.job.path, source))?;
        if self.bytes.len() < count * size {
            let found = self.bytes_read() + self.bytes.len() as u64;
            return Err(self.header.count(self.job, found));
        }
        self.read += count as u64;
        self.values.clear();
        for (at, raw) in self.bytes.chunks_exact(size).enumerate() {
            let value = self.header.value(raw);
            let exact = value.is_ok();
            let (Ok(value) | Err(value)) = value.map_err(|integer| integer as f64);
            let is_gap = value.is_nan() && self.job.options.missing != Missing::Refuse;
            if !(is_gap || exact && value.is_finite()) && self.selected(place(at).1) {
                let (row, column) = place(at);
                let path = self.job.path.to_owned();
                let place = Place { path, row: row + 1, line: None, column, name: None };
                return Err(match self.header.value(raw) {
                    Ok(value) => Error::NonFinite { place, value: value.to_string() },
                    Err(integer) => Error::Inexact { place, value: integer.to_string() },
                });
            }
            self.values.push(T::from_f64(value));
        }
        Ok(())
    }

    fn selected(&self, column: usize) -> bool {
        self.numbers.as_ref().is_none_or(|numbers| numbers.contains(&column))
    }

    fn bytes_read(&self) -> u64 {
        self.read.saturating_mul(self.header.element.size() as u64)
    }
}
