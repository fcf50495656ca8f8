//! Points to a file, block by block.
//!
//! *Guarantee.* What is read back has the same values: text holds the shortest decimals that give the same `f64`,
//! of `f32` points too, so a certificate of one file holds for the other.

#[cfg(feature = "arrow")]
mod arrow;
mod npy;
#[cfg(feature = "arrow")]
pub(crate) mod parquet;
mod table;
mod text;

use std::io::Write;
use std::path::Path;

use taut_points::{Blocks, Monitor, PointSource, ReadError, Rows, Scratch};

use crate::compress::Encoder;
use crate::create::{AtomicFile, create};
use crate::error::shown_path;
use crate::format::format_to_write;
use crate::space::{check_space, least_bytes};
use crate::{Compression, Content, Error, Format};

pub use table::{Column, Table, table_file, table_formats};

/// Bytes gathered before they are written.
const PIECE: usize = 1 << 18;

/// Writes `source` to `path` in the given format, or in that of the extension; `-` is standard output (CSV).
///
/// `columns` names the coordinates; empty means no names (parquet and arrow then call them `x0`, `x1`, …). A header
/// that could be taken for numbers, or for numbers that went wrong, is left out. The extensions `.gz`, `.xz` and `.zst` compress. Points of more than 1000 coordinates
/// without names are one column of lists in parquet, which would else hold a buffer for each column. The extensions `.xyzn` and
/// `.xyzrgb` promise normals or colors and are refused.
///
/// # Errors
/// [`Error`]; an earlier file of that name is then as it was.
pub fn write_points(
    source: &dyn PointSource,
    columns: &[String],
    path: &Path,
    format: Option<Format>,
    monitor: &Monitor<'_>,
) -> Result<(), Error> {
    let shown = shown_path(path);
    let (format, compression) = format_to_write(path, &shown, format, Content::Points)?;
    if !columns.is_empty() && columns.len() != source.dim() {
        return Err(Error::Names { path: shown, names: columns.len(), dim: source.dim() });
    }
    if format == Format::Xyz && source.dim() != 3 {
        return Err(Error::Dimension { path: shown, format, expected: "3", dim: source.dim() });
    }
    check_space(path, &shown, least_bytes(source, format, compression))?;
    let mut out = OutputFile::create(path, &shown, compression)?;
    let points = Points { source, columns, monitor };
    match format {
        Format::Csv => text::write(&points, b',', &mut out)?,
        Format::Tsv => text::write(&points, b'\t', &mut out)?,
        Format::Whitespace | Format::Xyz => text::write(&points, b' ', &mut out)?,
        Format::Npy => npy::write(&points, &mut out)?,
        Format::Raw => npy::write_values(&points, &mut out)?,
        #[cfg(feature = "arrow")]
        Format::Parquet => parquet::write(&points, &mut out)?,
        #[cfg(feature = "arrow")]
        Format::Arrow => arrow::write(&points, &mut out)?,
        _ => return Err(Error::not_writable(&shown, format, Content::Points)),
    }
    out.finish()?.commit()
}

pub(crate) struct Points<'a> {
    pub(crate) source: &'a dyn PointSource,
    pub(crate) columns: &'a [String],
    pub(crate) monitor: &'a Monitor<'a>,
}

impl Points<'_> {
    /// What formats with a schema call a coordinate.
    #[cfg(feature = "arrow")]
    pub(crate) fn column_name(&self, j: usize) -> String {
        self.columns.get(j).cloned().unwrap_or_else(|| format!("x{j}"))
    }

    /// Calls `write` for each block in order.
    pub(crate) fn blocks(
        &self,
        mut write: impl FnMut(Rows<'_>) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let blocks = Blocks::of(self.source);
        let mut scratch = Scratch::new();
        self.monitor.pass(1, self.source.len());
        for block in 0..blocks.count() {
            self.monitor.check().map_err(ReadError::from)?;
            let range = blocks.range(block);
            let points = range.end - range.start;
            write(self.source.read(range, &mut scratch)?)?;
            self.monitor.points(points);
        }
        Ok(())
    }
}

/// The file being written, with its name for messages.
pub(crate) struct OutputFile<'a> {
    pub(crate) to: Encoder<AtomicFile>,
    pub(crate) path: &'a str,
    /// The meaning of an error of writing.
    pub(crate) failure: fn(&str, std::io::Error) -> Error,
}

impl<'a> OutputFile<'a> {
    pub(crate) fn create(
        path: &Path,
        shown: &'a str,
        compression: Option<Compression>,
    ) -> Result<Self, Error> {
        Self::of(create(path)?, shown, compression)
    }

    /// The same for bytes in memory.
    pub(crate) fn in_memory(
        shown: &'a str,
        compression: Option<Compression>,
    ) -> Result<Self, Error> {
        Self::of(AtomicFile::in_memory(shown), shown, compression)
    }

    fn of(
        file: AtomicFile,
        shown: &'a str,
        compression: Option<Compression>,
    ) -> Result<Self, Error> {
        let failure = file.failure();
        let to = Encoder::new(compression, file, shown, failure)?;
        Ok(OutputFile { to, path: shown, failure })
    }

    /// Ends the compressed stream, if there is one.
    pub(crate) fn finish(self) -> Result<AtomicFile, Error> {
        self.to.finish().map_err(|source| (self.failure)(self.path, source))
    }

    /// Writes what `write` makes of each item, many at a time.
    pub(crate) fn each<T>(
        &mut self,
        items: impl IntoIterator<Item = T>,
        mut write: impl FnMut(T, &mut Vec<u8>),
    ) -> Result<(), Error> {
        let mut bytes = Vec::new();
        for item in items {
            write(item, &mut bytes);
            if bytes.len() >= PIECE {
                self.put(&bytes)?;
                bytes.clear();
            }
        }
        self.put(&bytes)
    }

    pub(crate) fn put(&mut self, bytes: &[u8]) -> Result<(), Error> {
        self.to.write_all(bytes).map_err(|source| (self.failure)(self.path, source))
    }
}
