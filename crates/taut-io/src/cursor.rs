//! Bytes and numbers of a binary stream, with the error of a file that ends too early.

use std::io::{BufRead, ErrorKind, Read};

use crate::mesh::MeshBuilder;
use crate::{Error, FilePlace};

/// The longest line of a header that is text.
const LONGEST_LINE: u64 = 1 << 16;

pub(crate) struct Cursor<'a> {
    stream: Box<dyn BufRead>,
    path: &'a str,
    /// Bytes read.
    pub(crate) at: u64,
    /// True if the first byte of a number is its highest.
    pub(crate) big_endian: bool,
}

/// The way in which a number is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

impl Kind {
    pub(crate) fn size(self) -> usize {
        match self {
            Kind::I8 | Kind::U8 => 1,
            Kind::I16 | Kind::U16 => 2,
            Kind::I32 | Kind::U32 | Kind::F32 => 4,
            Kind::I64 | Kind::U64 | Kind::F64 => 8,
        }
    }
}

impl<'a> Cursor<'a> {
    pub(crate) fn new(stream: Box<dyn BufRead>, path: &'a str) -> Self {
        Cursor { stream, path, at: 0, big_endian: false }
    }

    /// Returns what has not been read.
    pub(crate) fn into_stream(self) -> Box<dyn BufRead> {
        self.stream
    }

    /// Fills `bytes`; `place` and `mesh` say what was expected.
    pub(crate) fn fill(
        &mut self,
        bytes: &mut [u8],
        mesh: &MeshBuilder<'_>,
        place: FilePlace,
    ) -> Result<(), Error> {
        self.stream.read_exact(bytes).map_err(|source| match source.kind() {
            ErrorKind::UnexpectedEof => mesh.damaged(place, "the file ends here, too early"),
            _ => Error::reading(self.path, source),
        })?;
        self.at += bytes.len() as u64;
        Ok(())
    }

    /// A number as it is stored, in the lowest bytes.
    fn raw(
        &mut self,
        kind: Kind,
        mesh: &MeshBuilder<'_>,
        place: FilePlace,
    ) -> Result<[u8; 8], Error> {
        let mut bytes = [0; 8];
        let stored = &mut bytes[..kind.size()];
        self.fill(stored, mesh, place)?;
        if self.big_endian {
            stored.reverse();
        }
        Ok(bytes)
    }

    pub(crate) fn real(
        &mut self,
        kind: Kind,
        mesh: &MeshBuilder<'_>,
        place: FilePlace,
    ) -> Result<f64, Error> {
        let raw = self.raw(kind, mesh, place)?;
        Ok(match kind {
            Kind::F32 => f32::from_le_bytes([raw[0], raw[1], raw[2], raw[3]]).into(),
            Kind::F64 => f64::from_le_bytes(raw),
            _ => integer(kind, raw) as f64,
        })
    }

    /// A number as an id or a count; one that is no integer of 63 bits is −1, which is neither.
    pub(crate) fn whole(
        &mut self,
        kind: Kind,
        mesh: &MeshBuilder<'_>,
        place: FilePlace,
    ) -> Result<i64, Error> {
        let raw = self.raw(kind, mesh, place)?;
        Ok(match kind {
            Kind::F32 | Kind::F64 => -1,
            _ => i64::try_from(integer(kind, raw)).unwrap_or(-1),
        })
    }

    /// Steps over `count` bytes.
    pub(crate) fn skip(
        &mut self,
        count: u64,
        mesh: &MeshBuilder<'_>,
        place: FilePlace,
    ) -> Result<(), Error> {
        let skipped = std::io::copy(&mut (&mut self.stream).take(count), &mut std::io::sink())
            .map_err(|source| Error::reading(self.path, source))?;
        self.at = self.at.saturating_add(skipped);
        match skipped == count {
            true => Ok(()),
            false => Err(mesh.damaged(place, "the file ends here, too early")),
        }
    }

    /// A line of text without its end; `None` at the end of the stream or where a line does not end.
    pub(crate) fn line(&mut self) -> Result<Option<String>, Error> {
        let mut line = Vec::new();
        (&mut self.stream)
            .take(LONGEST_LINE)
            .read_until(b'\n', &mut line)
            .map_err(|source| Error::reading(self.path, source))?;
        self.at += line.len() as u64;
        let text = line.strip_suffix(b"\n").map(|line| line.strip_suffix(b"\r").unwrap_or(line));
        Ok(text.map(|text| String::from_utf8_lossy(text).into_owned()))
    }

    /// All text up to the byte `end`, without it; `None` if it does not come within `most` bytes.
    pub(crate) fn text_before(&mut self, end: u8, most: u64) -> Result<Option<String>, Error> {
        let mut text = Vec::new();
        (&mut self.stream)
            .take(most)
            .read_until(end, &mut text)
            .map_err(|source| Error::reading(self.path, source))?;
        self.at += text.len() as u64;
        Ok(match text.pop() {
            Some(last) if last == end => Some(String::from_utf8_lossy(&text).into_owned()),
            _ => None,
        })
    }

    /// Returns what is left, up to `most` bytes.
    pub(crate) fn rest(&mut self, most: u64) -> Result<Vec<u8>, Error> {
        let mut rest = Vec::new();
        (&mut self.stream)
            .take(most)
            .read_to_end(&mut rest)
            .map_err(|source| Error::reading(self.path, source))?;
        Ok(rest)
    }
}

fn integer(kind: Kind, raw: [u8; 8]) -> i128 {
    let value = u64::from_le_bytes(raw);
    match kind {
        Kind::I8 => i128::from(value as i8),
        Kind::I16 => i128::from(value as i16),
        Kind::I32 => i128::from(value as i32),
        Kind::I64 => i128::from(value as i64),
        _ => i128::from(value),
    }
}
