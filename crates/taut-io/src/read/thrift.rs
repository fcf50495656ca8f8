//! A look at the structures by which a Parquet file describes itself, before its decoder reads them.
//!
//! *Problem.* Footer and page headers are in Thrift's compact protocol, and the decoder passes over fields that it does not
//! know. It takes no byte for each boolean of a list, so that a few bytes announce 2³¹ lists of 2³¹ booleans, and the decoder
//! does not end.
//! *Idea.* Each structure is walked once before. Lists, sets and maps of booleans are refused: the format has none here. Every
//! other element takes a byte or more, so that the decoder ends with the file.
//! *Reference.* Thrift, compact protocol; Parquet format, `PageHeader` and `FileMetaData`.

use bytes::Bytes;
use parquet::arrow::arrow_reader::{
    ArrowReaderMetadata, ArrowReaderOptions, ParquetRecordBatchReaderBuilder,
};
use parquet::errors::ParquetError;
use parquet::file::reader::ChunkReader;

/// Levels of structures within structures; no file needs more than ten.
const DEPTH_MAX: u32 = 64;
/// The first window for a page header, bytes: few headers are larger.
const FIRST_WINDOW: u64 = 1 << 10;
/// The largest page header, bytes: statistics hold two values of a column.
const HEADER_MAX: u64 = 16 << 20;
/// The field of a page header that says how many bytes follow it.
const COMPRESSED_PAGE_SIZE: i16 = 3;

/// Why a structure cannot be walked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Unsound {
    /// It goes on beyond the bytes given.
    Cut,
    /// It is none, or one on which the decoder might not end.
    Wrong,
}

/// Opens a file for the decoder, if that is sure to come to an end with it.
pub(crate) fn open<R: ChunkReader + 'static>(
    chunks: R,
) -> Result<ParquetRecordBatchReaderBuilder<R>, ParquetError> {
    check_footer(&chunks)?;
    let metadata = ArrowReaderMetadata::load(&chunks, ArrowReaderOptions::default())?;
    for column in metadata.metadata().row_groups().iter().flat_map(|group| group.columns()) {
        let start = column.dictionary_page_offset().unwrap_or(column.data_page_offset());
        // What is negative or beyond the file is for the decoder to refuse.
        if let (Ok(start), Ok(length)) =
            (u64::try_from(start), u64::try_from(column.compressed_size()))
        {
            check_pages(&chunks, start, start.saturating_add(length))?;
        }
    }
    Ok(ParquetRecordBatchReaderBuilder::new_with_metadata(chunks, metadata))
}

fn check_footer(chunks: &impl ChunkReader) -> Result<(), ParquetError> {
    let Some(end) = chunks.len().checked_sub(8) else { return Ok(()) };
    let tail: Bytes = chunks.get_bytes(end, 4)?;
    let length = tail.iter().rev().fold(0, |length, &byte| length << 8 | u64::from(byte));
    let Some(start) = end.checked_sub(length) else { return Ok(()) };
    let footer = chunks.get_bytes(start, length as usize)?;
    match Walk::new(&footer).structure(DEPTH_MAX) {
        Err(Unsound::Wrong) => Err(refused("the footer")),
        Ok(_) | Err(Unsound::Cut) => Ok(()),
    }
}

/// Walks the headers of the pages between two places.
fn check_pages(chunks: &impl ChunkReader, start: u64, end: u64) -> Result<(), ParquetError> {
    let (mut at, end) = (start, end.min(chunks.len()));
    while at < end {
        let (mut window, left) = (FIRST_WINDOW, chunks.len() - at);
        let (header, page) = loop {
            let bytes = chunks.get_bytes(at, window.min(left) as usize)?;
            let mut walk = Walk::new(&bytes);
            match walk.structure(DEPTH_MAX) {
                Ok(page) => break (walk.at as u64, page),
                Err(Unsound::Cut) if window >= left => return Ok(()),
                Err(Unsound::Cut) if window < HEADER_MAX => window *= 8,
                Err(_) => return Err(refused("a page header")),
            }
        };
        // A page without a size, or with a negative one, is for the decoder to refuse.
        let Some(page) = page.and_then(|page| u64::try_from(page).ok()) else { return Ok(()) };
        at = at.saturating_add(header).saturating_add(page);
    }
    Ok(())
}

fn refused(what: &str) -> ParquetError {
    ParquetError::General(format!("{what} holds what no reader can pass over"))
}

/// A walk over bytes.
struct Walk<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Walk<'a> {
    fn new(bytes: &'a [u8]) -> Self {
        Walk { bytes, at: 0 }
    }

    fn byte(&mut self) -> Result<u8, Unsound> {
        let byte = *self.bytes.get(self.at).ok_or(Unsound::Cut)?;
        self.at += 1;
        Ok(byte)
    }

    fn skip(&mut self, bytes: u64) -> Result<(), Unsound> {
        let left = (self.bytes.len() - self.at) as u64;
        if bytes > left {
            return Err(Unsound::Cut);
        }
        self.at += bytes as usize;
        Ok(())
    }

    /// A number in sevens of bits, the lowest first.
    fn varint(&mut self) -> Result<u64, Unsound> {
        let mut number = 0;
        for shift in (0..70).step_by(7) {
            let byte = self.byte()?;
            number |= u64::from(byte & 0x7f).checked_shl(shift).unwrap_or(0);
            if byte & 0x80 == 0 {
                return Ok(number);
            }
        }
        Err(Unsound::Wrong)
    }

    /// Walks a structure; returns its field [`COMPRESSED_PAGE_SIZE`] if it is a number of 32 bits.
    fn structure(&mut self, depth: u32) -> Result<Option<i64>, Unsound> {
        let depth = depth.checked_sub(1).ok_or(Unsound::Wrong)?;
        let (mut id, mut size) = (0i16, None);
        loop {
            let head = self.byte()?;
            let kind = head & 0xf;
            if kind == 0 {
                return Ok(size);
            }
            id = match head >> 4 {
                0 => unzigzag(self.varint()?) as i16,
                step => id.checked_add(step.into()).ok_or(Unsound::Wrong)?,
            };
            match kind {
                // A boolean is told by its kind.
                1 | 2 => {}
                5 if id == COMPRESSED_PAGE_SIZE => size = Some(unzigzag(self.varint()?)),
                kind => self.value(kind, depth)?,
            }
        }
    }

    /// Walks a value that takes at least one byte.
    fn value(&mut self, kind: u8, depth: u32) -> Result<(), Unsound> {
        match kind {
            3 => self.skip(1),
            4..=6 => self.varint().map(drop),
            7 => self.skip(8),
            8 => {
                let length = self.varint()?;
                self.skip(length)
            }
            9 | 10 => {
                let head = self.byte()?;
                let count = match head >> 4 {
                    15 => self.varint()?,
                    count => count.into(),
                };
                self.elements(count, &[head & 0xf], depth)
            }
            11 => match self.varint()? {
                0 => Ok(()),
                count => {
                    let kinds = self.byte()?;
                    self.elements(count, &[kinds >> 4, kinds & 0xf], depth)
                }
            },
            12 => self.structure(depth).map(drop),
            13 => self.skip(16),
            _ => Err(Unsound::Wrong),
        }
    }

    fn elements(&mut self, count: u64, kinds: &[u8], depth: u32) -> Result<(), Unsound> {
        let depth = depth.checked_sub(1).ok_or(Unsound::Wrong)?;
        if count > 0 && kinds.iter().any(|&kind| kind <= 2) {
            return Err(Unsound::Wrong);
        }
        for _ in 0..count {
            kinds.iter().try_for_each(|&kind| self.value(kind, depth))?;
        }
        Ok(())
    }
}

/// A signed number from one whose lowest bit is the sign.
fn unzigzag(number: u64) -> i64 {
    (number >> 1) as i64 ^ -((number & 1) as i64)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn walked(bytes: &[u8]) -> Result<Option<i64>, Unsound> {
        Walk::new(bytes).structure(DEPTH_MAX)
    }

    #[test]
    fn a_structure_ends_where_it_says() {
        // Field 3 is 21, a boolean, a text, a list of two structures, a map of a byte to a double.
        let bytes = [
            0x35, 42, 0x11, 0x18, 2, b'a', b'b', 0x19, 0x2c, 0, 0x15, 1, 0, 0x1b, 1, 0x37, 9, 0, 0,
            0, 0, 0, 0, 0, 0, 0,
        ];
        assert_eq!(walked(&bytes), Ok(Some(21)));
        for cut in 0..bytes.len() {
            assert_eq!(walked(&bytes[..cut]), Err(Unsound::Cut), "{cut}");
        }
    }

    #[test]
    fn what_takes_no_bytes_is_refused() {
        let many = [0xff, 0xff, 0xff, 0xff, 0x07];
        let list = [&[0x19, 0xf1][..], &many, &[0]].concat();
        let lists = [&[0x19, 0xf9][..], &many, &[0xf2], &many, &[0]].concat();
        let map = [&[0x1b][..], &many, &[0x12, 0]].concat();
        for bytes in [list, lists, map] {
            assert_eq!(walked(&bytes), Err(Unsound::Wrong));
        }
        // None of them, and of a kind that is none.
        assert_eq!(walked(&[0x19, 0x01, 0]), Ok(None));
        assert_eq!(walked(&[0x1e, 0]), Err(Unsound::Wrong));
        assert_eq!(walked(&[0x1c; 100]), Err(Unsound::Wrong));
    }
}
