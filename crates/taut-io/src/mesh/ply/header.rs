//! The header of Stanford PLY, which declares elements and the properties of each.
//!
//! *Guarantee.* No more elements are promised than the file can hold: each has at least one property, so a count that is
//! not true ends at the end of the file, and nobody has to trust it.
//! *Reference.* G. Turk, The PLY polygon file format, 1994.

use crate::cursor::{Cursor, Kind};
use crate::mesh::{MeshBuilder, printable};
use crate::{Error, FilePlace};

/// The way in which the values of elements are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

impl Encoding {
    const ALL: [Encoding; 3] = [Encoding::Ascii, Encoding::LittleEndian, Encoding::BigEndian];

    /// The word of the header.
    pub(super) fn word(self) -> &'static str {
        match self {
            Encoding::Ascii => "ascii",
            Encoding::LittleEndian => "binary_little_endian",
            Encoding::BigEndian => "binary_big_endian",
        }
    }
}

pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
    pub(super) lines: u64,
}

/// A property as the header declares it.
pub(super) struct Property {
    pub(super) name: String,
    pub(super) kind: Kind,
    /// The way in which the length is stored, where it is a list.
    pub(super) length: Option<Kind>,
}

/// An element as the header declares it.
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
}

/// Reads the header, up to the first byte of the first element.
pub(super) fn read(mesh: &MeshBuilder<'_>, cursor: &mut Cursor<'_>) -> Result<Header, Error> {
    let mut elements: Vec<Element> = Vec::new();
    let mut encoding = None;
    let mut number = 0;
    loop {
        number += 1;
        let at = FilePlace::Line(number);
        let line = cursor.line()?.ok_or_else(|| mesh.damaged(at, "the header does not end"))?;
        let words: Vec<&str> = line.split_ascii_whitespace().collect();
        match words[..] {
            ["ply"] if number == 1 => {}
            _ if number == 1 => return Err(mesh.damaged(at, "the first line is not `ply`")),
            ["format", word, "1.0"] => {
                let known = Encoding::ALL.into_iter().find(|known| known.word() == word);
                let known = known.ok_or_else(|| {
                    let word = printable(word.as_bytes());
                    mesh.damaged(at, format!("the format is `{word}`, which is none of ply"))
                })?;
                encoding = Some(known);
            }
            ["format", _, version] => {
                let version = printable(version.as_bytes());
                return Err(mesh.damaged(at, format!("the version is `{version}`, not `1.0`")));
            }
            ["comment" | "obj_info", ..] | [] => {}
            ["element", name, count] => {
                let count = count
                    .parse()
                    .map_err(|_| mesh.damaged(at, "the count of an element is no whole number"))?;
                elements.push(Element { name: name.to_owned(), count, properties: Vec::new() });
            }
            ["property", ref property @ ..] => {
                let element = elements
                    .last_mut()
                    .ok_or_else(|| mesh.damaged(at, "a property stands before any element"))?;
                let found = match *property {
                    ["list", length, each, name] => kind(length)
                        .zip(kind(each))
                        .map(|(l, k)| Property { name: name.to_owned(), kind: k, length: Some(l) }),
                    [each, name] => kind(each).map(|k| Property {
                        name: name.to_owned(),
                        kind: k,
                        length: None,
                    }),
                    _ => None,
                };
                let found =
                    found.ok_or_else(|| mesh.damaged(at, "a property is of no known type"))?;
                element.properties.push(found);
            }
            ["end_header"] => break,
            _ => return Err(mesh.damaged(at, "it is no line of a header")),
        }
    }
    let Some(encoding) = encoding else {
        return Err(mesh.damaged(FilePlace::File, "the header names no format"));
    };
    match elements.iter().find(|element| element.count > 0 && element.properties.is_empty()) {
        Some(element) => {
            let problem =
                format!("elements `{}` have no properties", printable(element.name.as_bytes()));
            Err(mesh.damaged(FilePlace::File, problem))
        }
        None => Ok(Header { encoding, elements, lines: number }),
    }
}

/// Steps over a value in binary, or over a list of them.
pub(super) fn skip(
    mesh: &MeshBuilder<'_>,
    cursor: &mut Cursor<'_>,
    property: &Property,
    place: FilePlace,
) -> Result<(), Error> {
    let count = match property.length {
        None => 1,
        Some(length) => u64::try_from(cursor.whole(length, mesh, place)?)
            .map_err(|_| mesh.damaged(place, "a list has a negative length"))?,
    };
    cursor.skip(count.saturating_mul(property.kind.size() as u64), mesh, place)
}

/// The types of values, under either of their two names.
fn kind(name: &str) -> Option<Kind> {
    Some(match name {
        "char" | "int8" => Kind::I8,
        "uchar" | "uint8" => Kind::U8,
        "short" | "int16" => Kind::I16,
        "ushort" | "uint16" => Kind::U16,
        "int" | "int32" => Kind::I32,
        "uint" | "uint32" => Kind::U32,
        "float" | "float32" => Kind::F32,
        "double" | "float64" => Kind::F64,
        _ => return None,
    })
}
