//! A look at the structures by which a Parquet file describes itself, before its decoder reads them.
//!
//! *Problem.* Footer and page headers are in Thrift's compact protocol, and the decoder passes over fields that it does not
//! know. It takes no byte for each boolean of a list, so that a few bytes announce 2³¹ lists of 2³¹ booleans, and the decoder
//! does not end.
//! *Idea.* Each structure is walked once before, by the same steps as the decoder's; one on which a step takes no byte is
//! refused.
//! *Reference.* Parquet format, `PageHeader` and `FileMetaData`.

mod format;
mod walk;

use bytes::Bytes;
use parquet::errors::ParquetError;
use parquet::file::metadata::ParquetMetaDataReader;
use parquet::file::reader::ChunkReader;

use super::parquet::Table;
use format::{FILE_META_DATA, PAGE_HEADER};
use walk::{StructureError, walk};

/// The first window for a page header, bytes: few headers are larger.
const FIRST_WINDOW: u64 = 1 << 10;
/// The largest page header, bytes: statistics hold two values of a column.
const HEADER_MAX: u64 = 16 << 20;

/// Opens a file for the decoder, if that is sure to come to an end with its structures.
pub(crate) fn open<R: ChunkReader + 'static>(chunks: R) -> Result<Table<R>, ParquetError> {
    check_footer(&chunks)?;
    let metadata = ParquetMetaDataReader::new().parse_and_finish(&chunks)?;
    for column in metadata.row_groups().iter().flat_map(|group| group.columns()) {
        let start = column.dictionary_page_offset().unwrap_or(column.data_page_offset());
        // The decoder refuses sizes that are negative or beyond the file.
        if let (Ok(start), Ok(length)) =
            (u64::try_from(start), u64::try_from(column.compressed_size()))
        {
            check_pages(&chunks, start, start.saturating_add(length))?;
        }
    }
    Ok(Table::new(chunks, metadata))
}

fn check_footer(chunks: &impl ChunkReader) -> Result<(), ParquetError> {
    let Some(end) = chunks.len().checked_sub(8) else { return Ok(()) };
    let tail: Bytes = chunks.get_bytes(end, 4)?;
    let length = tail.iter().rev().fold(0, |length, &byte| length << 8 | u64::from(byte));
    let Some(start) = end.checked_sub(length) else { return Ok(()) };
    let footer = chunks.get_bytes(start, length as usize)?;
    match walk(&footer, FILE_META_DATA) {
        Err(StructureError::Wrong) => Err(refused("the footer")),
        Ok(_) | Err(StructureError::Cut) => Ok(()),
    }
}

/// Walks the headers of the pages between two places.
fn check_pages(chunks: &impl ChunkReader, start: u64, end: u64) -> Result<(), ParquetError> {
    let (mut at, end) = (start, end.min(chunks.len()));
    while at < end {
        let (mut window, left) = (FIRST_WINDOW, chunks.len() - at);
        let header = loop {
            let bytes = chunks.get_bytes(at, window.min(left) as usize)?;
            match walk(&bytes, PAGE_HEADER) {
                Ok(header) => break header,
                // Also at the end of the file: there the decoder takes no byte for a double, and might go through 2³¹ of them.
                Err(StructureError::Cut) if window < left.min(HEADER_MAX) => window *= 8,
                Err(_) => return Err(refused("a page header")),
            }
        };
        // A page without a size, or with a negative one, is for the decoder to refuse.
        let Some(page) = header.page.and_then(|page| u64::try_from(page).ok()) else {
            return Ok(());
        };
        at = at.saturating_add(header.length as u64).saturating_add(page);
    }
    Ok(())
}

fn refused(what: &str) -> ParquetError {
    ParquetError::General(format!("{what} holds what no reader can pass over"))
}
