//! Reads the header of a NumPy array, for those who move its elements without looking at them.
//!
//! *Reference.* NumPy enhancement proposal 1 (the npy format); the array interface protocol, for the names of types.

use std::fs::{self, File};
use std::io::{self, BufReader};
use std::path::Path;

use crate::error::shown_path;
use crate::npy_header::{MAGIC, NpyHeader};
use crate::{Error, Format};

/// An array in a `.npy` file: elements of one fixed width, side by side after a header.
///
/// ```
/// let array = taut_io::NpyArray { dtype: "<f8".into(), width: 8, fortran: false, shape: vec![3, 2], offset: 0 };
/// let header = array.header();
/// assert_eq!(header.len() % 64, 0);
/// assert!(header.starts_with(b"\x93NUMPY"));
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NpyArray {
    /// The type of an element as the header has it: `<f8`, `|u1`, `<U16`, `<M8[ns]`.
    pub dtype: String,
    /// Bytes of an element, at least 1.
    pub width: usize,
    /// True if elements lie in Fortran order: those along the first axis side by side.
    pub fortran: bool,
    /// Length of each axis.
    pub shape: Vec<u64>,
    /// Bytes of the file before the first element.
    pub offset: u64,
}

impl NpyArray {
    /// Reads the header of an uncompressed file, whose elements must be as many as it promises.
    ///
    /// # Errors
    /// [`Error::NotFound`], [`Error::Damaged`] for another format, [`Error::Array`] for elements that are Python objects,
    /// records with fields or without bytes, [`Error::Count`] for a file of another length.
    pub fn open(path: &Path) -> Result<Self, Error> {
        let shown = shown_path(path);
        let failed = |source| Error::reading(&shown, source);
        let kind = fs::metadata(path).map_err(failed)?;
        if kind.is_dir() {
            return Err(Error::Directory { path: shown });
        }
        // To open a pipe is to wait until somebody writes to it.
        if !kind.is_file() {
            let not = io::Error::new(io::ErrorKind::InvalidInput, "not a regular file");
            return Err(failed(not));
        }
        let file = File::open(path).map_err(failed)?;
        let NpyHeader { descr, fortran, shape, offset } =
            NpyHeader::read(&shown, &mut BufReader::new(file))?;
        let refused = |problem, remedy| Err(Error::Array { path: shown.clone(), problem, remedy });
        let Some(dtype) = descr else {
            let remedy = "view each record as bytes first (`array.view(\"V16\")`)";
            return refused("its elements are records with fields".to_owned(), remedy);
        };
        let Some(width) = width(&dtype) else {
            let problem = format!("its element type is `{}`", dtype.escape_debug());
            return refused(
                problem,
                "save it with elements of a fixed number of bytes, at least 1",
            );
        };
        let array = NpyArray { dtype, width, fortran, shape, offset };
        let (expected, found) = (array.bytes(), kind.len().saturating_sub(offset));
        if expected != Some(found) {
            return Err(Error::Count {
                path: shown,
                format: Format::Npy,
                expected: expected.unwrap_or(u64::MAX),
                found,
                unit: ("byte of values", "bytes of values"),
            });
        }
        Ok(array)
    }

    /// Bytes of all elements; none where these are 2⁶⁴ or more.
    pub fn bytes(&self) -> Option<u64> {
        // An axis without elements, wherever it stands, makes an array of none.
        if self.shape.contains(&0) {
            return Some(0);
        }
        self.shape.iter().try_fold(self.width as u64, |bytes, &length| bytes.checked_mul(length))
    }

    /// The header of such an array, as NumPy writes it: a multiple of 64 bytes, after which the elements begin. `offset`
    /// plays no part.
    pub fn header(&self) -> Vec<u8> {
        let lengths: Vec<String> = self.shape.iter().map(u64::to_string).collect();
        let comma = if lengths.len() == 1 { "," } else { "" };
        let order = if self.fortran { "True" } else { "False" };
        let mut text = format!(
            "{{'descr': '{}', 'fortran_order': {order}, 'shape': ({}{comma}), }}",
            self.dtype,
            lengths.join(", ")
        );
        // Version 1 counts the text in two bytes, version 2 in four.
        let long = text.len() + 64 > usize::from(u16::MAX);
        let before = if long { 12 } else { 10 };
        while !(before + text.len() + 1).is_multiple_of(64) {
            text.push(' ');
        }
        text.push('\n');
        let length = text.len() as u32;
        let mut header = MAGIC.to_vec();
        header.extend_from_slice(if long { &[2, 0] } else { &[1, 0] });
        header.extend_from_slice(&length.to_le_bytes()[..if long { 4 } else { 2 }]);
        header.extend_from_slice(text.as_bytes());
        header
    }
}

/// Bytes of an element of a type; none for types without a fixed number of them, at least 1.
fn width(dtype: &str) -> Option<usize> {
    let plain = dtype.strip_prefix(['<', '>', '=', '|']).unwrap_or(dtype);
    let mut characters = plain.chars();
    let kind = characters.next()?;
    let rest = characters.as_str();
    let end = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
    let (digits, unit) = rest.split_at(end);
    let count: usize = digits.parse().ok()?;
    let has_unit = unit.len() > 2 && unit.starts_with('[') && unit.ends_with(']');
    let unit_is_plain = unit.chars().all(|c| c.is_ascii_alphanumeric() || "[]/".contains(c));
    let width = match kind {
        'b' | 'i' | 'u' | 'f' | 'c' | 'S' | 'a' | 'V' if unit.is_empty() => count,
        'U' if unit.is_empty() => count.checked_mul(4)?,
        'm' | 'M' if unit.is_empty() || has_unit && unit_is_plain => count,
        _ => return None,
    };
    (1..=1 << 30).contains(&width).then_some(width)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn widths_of_types() {
        for (dtype, bytes) in [
            ("<f8", Some(8)),
            (">i2", Some(2)),
            ("|u1", Some(1)),
            ("|b1", Some(1)),
            ("=f4", Some(4)),
            ("<c16", Some(16)),
            ("<f16", Some(16)),
            ("|S7", Some(7)),
            ("<U3", Some(12)),
            ("|V24", Some(24)),
            ("<M8[ns]", Some(8)),
            ("<m8[25s]", Some(8)),
            ("<M8", Some(8)),
            ("|O", None),
            ("|O8", None),
            ("|S0", None),
            ("<U", None),
            ("", None),
            ("<", None),
            ("<f8[ns]", None),
            ("<M8[n's]", None),
            ("<i99999999999999999999", None),
            ("é8", None),
        ] {
            assert_eq!(width(dtype), bytes, "{dtype}");
        }
    }

    #[test]
    fn a_header_is_read_as_it_was_written() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.npy");
        let shapes: [&[u64]; 6] = [&[3, 2], &[7], &[], &[0, 5], &[2, 3, 4], &[1 << 40, 0]];
        for shape in shapes {
            for (dtype, width) in [("<f8", 8), ("|S3", 3), ("<M8[us]", 8)] {
                let mut array = NpyArray {
                    dtype: dtype.to_owned(),
                    width,
                    fortran: shape.len() == 2,
                    shape: shape.to_vec(),
                    offset: 0,
                };
                let header = array.header();
                array.offset = header.len() as u64;
                let bytes = array.bytes().unwrap() as usize;
                std::fs::write(&path, [header, vec![0; bytes]].concat()).unwrap();
                assert_eq!(NpyArray::open(&path).unwrap(), array);
            }
        }
    }

    #[test]
    fn other_files_are_refused_by_name() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.npy");
        let array = |shape: &[u64]| NpyArray {
            dtype: "<f8".to_owned(),
            width: 8,
            fortran: false,
            shape: shape.to_vec(),
            offset: 0,
        };
        let long = array(&[u64::MAX, u64::MAX]).header();
        let short = [array(&[2, 2]).header(), vec![0; 31]].concat();
        let records =
            String::from_utf8_lossy(&array(&[2]).header()[10..]).replace("'<f8'", "[('a', '<f8')]");
        let records = [
            b"\x93NUMPY\x01\x00".as_slice(),
            &(records.len() as u16).to_le_bytes(),
            records.as_bytes(),
        ]
        .concat();
        for (bytes, said) in [
            (long, "a.npy"),
            (short, "31"),
            (records, "records with fields"),
            (b"\x93NUMPY\x09\x00".to_vec(), "version is 9"),
            (b"points".to_vec(), "a.npy"),
        ] {
            std::fs::write(&path, bytes).unwrap();
            let error = NpyArray::open(&path).unwrap_err().to_string();
            assert!(error.contains(said), "{error}");
        }
        let missing = NpyArray::open(&folder.path().join("b.npy")).unwrap_err();
        assert!(matches!(missing, Error::NotFound { .. }));
        assert!(NpyArray::open(folder.path()).is_err());
    }
}
