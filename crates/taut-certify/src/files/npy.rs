//! The header of a NumPy array, read once more: type of the elements, order, shape, and where the elements begin.
//!
//! *Trap.* What reads must read what NumPy reads, or a true answer is called wrong: keys in any order, either quote, any
//! white space, and a type by any of its names, of which `<f8`, `f8`, `=f8`, `d` and `float64` mean the same.
//! *Reference.* NumPy enhancement proposal 1 (the npy format), versions 1.0 to 3.0; the array interface protocol.

mod literal;
mod names;

use super::bytes::Source;
use super::{FileCheckError, FileViolation};

pub(super) use names::{is_same_type, width};

/// The first bytes of such a file.
const MAGIC: &[u8; 6] = b"\x93NUMPY";
/// A header is looked at if it has at most this many bytes.
const HEADER_BYTES_MAX: u64 = 1 << 16;

/// The contents of a header.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Header {
    pub(super) dtype: String,
    pub(super) fortran: bool,
    pub(super) shape: Vec<u64>,
    pub(super) offset: u64,
    /// As the file has it, without what fills it up at the end.
    text: String,
}

impl Header {
    /// Returns true if the text is the one that NumPy writes for what it says: readers need not be lenient.
    pub(super) fn is_plain(&self) -> bool {
        let Self { dtype, fortran, shape, text, .. } = self;
        let order = if *fortran { "True" } else { "False" };
        let shape: Vec<String> = shape.iter().map(u64::to_string).collect();
        let shape = shape.join(", ");
        *text == format!("{{'descr': '{dtype}', 'fortran_order': {order}, 'shape': ({shape}), }}")
    }
}

/// Tests whether a file begins as one with such a header.
pub(super) fn begins(source: &mut Source<'_>) -> Result<bool, FileCheckError> {
    let mut start = [0; MAGIC.len()];
    if source.length < start.len() as u64 {
        return Ok(false);
    }
    source.read_at(0, &mut start)?;
    Ok(start == *MAGIC)
}

pub(super) fn header(source: &mut Source<'_>) -> Result<Header, FileCheckError> {
    let file = source.which;
    let wrong = |problem: &str| FileViolation::Header { file, problem: problem.to_owned() };
    let mut start = [0; 12];
    if source.length < 12 {
        return Err(wrong("is not there: the file is too short").into());
    }
    source.read_at(0, &mut start)?;
    if !start.starts_with(MAGIC) {
        return Err(wrong("is not that of an npy file").into());
    }
    let (before, length) = match start[6] {
        _ if start[7] != 0 => return Err(wrong("has a version that is not known").into()),
        1 => (10, u64::from(u16::from_le_bytes([start[8], start[9]]))),
        2 | 3 => (12, u64::from(u32::from_le_bytes([start[8], start[9], start[10], start[11]]))),
        _ => return Err(wrong("has a version that is not known").into()),
    };
    if length > HEADER_BYTES_MAX || before + length > source.length {
        return Err(wrong("is longer than the file, or than 65536 bytes").into());
    }
    let mut text = vec![0; length as usize];
    source.read_at(before, &mut text)?;
    let text = String::from_utf8(text).map_err(|_| wrong("is no text"))?;
    let (dtype, fortran, shape) =
        literal::parse(&text).ok_or_else(|| wrong("does not tell type, order and shape"))?;
    let text = text.trim_end_matches('\n').trim_end_matches(' ').to_owned();
    Ok(Header { dtype, fortran, shape, offset: before + length, text })
}
