//! The values of elements, in binary or, an element to a line, as words.

use super::header::{self, Encoding, Header, Property};
use crate::cursor::{Cursor, Kind};
use crate::mesh::{MeshBuilder, printable};
use crate::words::{Lines, whole};
use crate::{Error, FilePlace};

pub(super) enum Values<'a> {
    Binary(Cursor<'a>),
    /// Lines, and where in the last one the next word begins.
    Text(Lines, usize),
}

impl<'a> Values<'a> {
    /// The values that follow the header.
    pub(super) fn new(mesh: &MeshBuilder<'_>, mut cursor: Cursor<'a>, header: &Header) -> Self {
        match header.encoding {
            Encoding::Ascii => Values::Text(mesh.lines(cursor.into_stream(), header.lines), 0),
            encoding => {
                cursor.big_endian = encoding == Encoding::BigEndian;
                Values::Binary(cursor)
            }
        }
    }

    /// Goes to the next element, and says where it is.
    pub(super) fn begin(
        &mut self,
        mesh: &MeshBuilder<'_>,
        name: &'static str,
        number: u64,
    ) -> Result<FilePlace, Error> {
        match self {
            Values::Binary(_) => Ok(FilePlace::Element(name, number)),
            Values::Text(lines, at) => {
                *at = 0;
                match lines.advance(mesh)? {
                    true => Ok(lines.place()),
                    false => {
                        let problem = format!("it ends before {name} {number}");
                        Err(mesh.damaged(FilePlace::File, problem))
                    }
                }
            }
        }
    }

    /// A coordinate or a color.
    pub(super) fn real(
        &mut self,
        mesh: &MeshBuilder<'_>,
        kind: Kind,
        place: FilePlace,
    ) -> Result<f64, Error> {
        match self {
            Values::Binary(cursor) => cursor.real(kind, mesh, place),
            Values::Text(lines, at) => {
                let word = next_word(lines.bytes(), at).ok_or_else(|| too_few(mesh, place))?;
                mesh.number(place, word)
            }
        }
    }

    pub(super) fn whole(
        &mut self,
        mesh: &MeshBuilder<'_>,
        kind: Kind,
        place: FilePlace,
    ) -> Result<i64, Error> {
        match self {
            Values::Binary(cursor) => cursor.whole(kind, mesh, place),
            Values::Text(lines, at) => {
                let word = next_word(lines.bytes(), at).ok_or_else(|| too_few(mesh, place))?;
                whole(word).ok_or_else(|| no_number(mesh, place, word))
            }
        }
    }

    /// The length of a list.
    pub(super) fn count(
        &mut self,
        mesh: &MeshBuilder<'_>,
        kind: Kind,
        place: FilePlace,
    ) -> Result<u64, Error> {
        let count = self.whole(mesh, kind, place)?;
        u64::try_from(count)
            .map_err(|_| mesh.damaged(place, format!("a list has the length {count}")))
    }

    /// Steps over a value, or over a list of them.
    pub(super) fn skip(
        &mut self,
        mesh: &MeshBuilder<'_>,
        property: &Property,
        place: FilePlace,
    ) -> Result<(), Error> {
        if let Values::Binary(cursor) = self {
            return header::skip(mesh, cursor, property, place);
        }
        let count = match property.length {
            None => 1,
            Some(length) => self.count(mesh, length, place)?,
        };
        (0..count).try_for_each(|_| self.real(mesh, property.kind, place).map(drop))
    }

    /// Refuses an element that is longer than declared.
    pub(super) fn end(&self, mesh: &MeshBuilder<'_>, place: FilePlace) -> Result<(), Error> {
        match self {
            Values::Text(lines, at) if !lines.bytes()[*at..].trim_ascii().is_empty() => {
                Err(mesh.damaged(place, "it has more values than the header declares"))
            }
            _ => Ok(()),
        }
    }

    /// Refuses a file that goes on.
    pub(super) fn finish(self, mesh: &MeshBuilder<'_>) -> Result<(), Error> {
        let (more, place) = match self {
            Values::Binary(mut cursor) => (!cursor.rest(1)?.is_empty(), FilePlace::File),
            Values::Text(mut lines, _) => (lines.advance(mesh)?, lines.place()),
        };
        match more {
            false => Ok(()),
            true => Err(mesh.damaged(place, "it goes on after its last element")),
        }
    }
}

/// The word at or after `at`, which moves behind it.
fn next_word<'a>(line: &'a [u8], at: &mut usize) -> Option<&'a [u8]> {
    let start = *at + line[*at..].iter().position(|byte| !byte.is_ascii_whitespace())?;
    let length = line[start..].iter().position(u8::is_ascii_whitespace);
    *at = length.map_or(line.len(), |length| start + length);
    Some(&line[start..*at])
}

fn too_few(mesh: &MeshBuilder<'_>, place: FilePlace) -> Error {
    mesh.damaged(place, "it has fewer values than the header declares")
}

fn no_number(mesh: &MeshBuilder<'_>, place: FilePlace, word: &[u8]) -> Error {
    mesh.damaged(place, format!("`{}` is no number of the declared type", printable(word)))
}
