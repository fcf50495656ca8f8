//! The header of a NumPy array, read here and nowhere else in this crate: type of the elements, order, shape, and where the
//! elements begin.
//!
//! *Reference.* NumPy enhancement proposal 1 (the npy format), versions 1.0 to 3.0.

mod literal;

use std::io::{BufRead, ErrorKind, Read};

use crate::{Error, FilePlace, Format};
use literal::Literal;

/// The first bytes of such a file.
pub(crate) const MAGIC: &[u8] = b"\x93NUMPY";

pub(crate) struct NpyHeader {
    /// The type of an element; none of records with fields.
    pub(crate) descr: Option<String>,
    /// True if elements along the first axis lie side by side.
    pub(crate) fortran: bool,
    /// Length of each axis.
    pub(crate) shape: Vec<u64>,
    /// Bytes of the file before the first element.
    pub(crate) offset: u64,
}

impl NpyHeader {
    /// Reads the header and leaves `stream` at the first element.
    pub(crate) fn read(path: &str, stream: &mut dyn BufRead) -> Result<Self, Error> {
        let (mut entries, offset) = dictionary(path, stream)?;
        // Of a key that comes twice the last value holds, as in Python.
        let mut entry = |key: &str| match entries.iter().rposition(|(name, _)| name == key) {
            Some(place) => Ok(entries.remove(place).1),
            None => Err(damaged(path, &format!("its header has no `{key}`"))),
        };
        let descr = match entry("descr")? {
            Literal::Text(descr) => Some(descr),
            _ => None,
        };
        let Literal::Bool(fortran) = entry("fortran_order")? else {
            return Err(damaged(path, "`fortran_order` is neither True nor False"));
        };
        let Literal::Tuple(shape) = entry("shape")? else {
            return Err(damaged(path, "`shape` is no tuple of numbers"));
        };
        Ok(NpyHeader { descr, fortran, shape, offset })
    }
}

/// The dictionary of a header, and the bytes up to the first value; leaves `stream` there.
fn dictionary(
    path: &str,
    stream: &mut dyn BufRead,
) -> Result<(Vec<(String, Literal)>, u64), Error> {
    let mut fixed = [0; 8];
    exact(path, stream, &mut fixed)?;
    if !fixed.starts_with(MAGIC) {
        return Err(damaged(path, "it does not begin as one"));
    }
    let (length, before) = match fixed[6] {
        1 => {
            let mut length = [0; 2];
            exact(path, stream, &mut length)?;
            (u64::from(u16::from_le_bytes(length)), 10)
        }
        2 | 3 => {
            let mut length = [0; 4];
            exact(path, stream, &mut length)?;
            (u64::from(u32::from_le_bytes(length)), 12)
        }
        version => return Err(damaged(path, &format!("its version is {version}, not 1, 2 or 3"))),
    };
    let mut text = Vec::new();
    stream.take(length).read_to_end(&mut text).map_err(|e| Error::reading(path, e))?;
    if (text.len() as u64) < length {
        return Err(damaged(path, "it ends within its header"));
    }
    let text = String::from_utf8_lossy(&text);
    match literal::parse(&text) {
        Some(Literal::Dict(entries)) => Ok((entries, before + length)),
        _ => Err(damaged(path, "its header is no dictionary")),
    }
}

fn exact(path: &str, stream: &mut dyn BufRead, bytes: &mut [u8]) -> Result<(), Error> {
    stream.read_exact(bytes).map_err(|source| match source.kind() {
        ErrorKind::UnexpectedEof => damaged(path, "it ends within its header"),
        _ => Error::reading(path, source),
    })
}

/// The error of a file that is no array.
pub(crate) fn damaged(path: &str, problem: &str) -> Error {
    let (path, problem) = (path.to_owned(), problem.to_owned());
    Error::Damaged { path, format: Format::Npy, place: FilePlace::File, problem }
}
