//! Curves of the plane to files.
//!
//! *Guarantee.* Coordinates are the shortest decimals that read back to the same bits.

mod csv;
mod geojson;
mod lines;
mod svg;

use std::path::Path;

use taut_mesh::Polyline;

use crate::create::AtomicFile;
use crate::error::shown_path;
use crate::format::format_to_write;
use crate::words::put_number;
use crate::write::OutputFile;
use crate::{Compression, Content, Error, Format};

pub use lines::LineFile;

/// Bytes gathered before they are written.
const PIECE: usize = 1 << 18;

/// Writes curves to `path` in the given format, or in that of the extension, as [`polylines_file`] and [`AtomicFile::commit`].
///
/// # Errors
/// [`Error`]; an earlier file of that name is then as it was.
pub fn write_polylines(
    curves: &[Polyline<'_>],
    path: &Path,
    format: Option<Format>,
) -> Result<(), Error> {
    polylines_file(curves, path, format)?.commit()
}

/// The file that [`write_polylines`] writes, complete, but not yet in its place. The extensions `.gz`, `.xz` and `.zst` compress.
///
/// Of curves with numbers that are not finite no file is read back.
///
/// # Errors
/// [`Error::UnknownOutput`], [`Error::NotWritable`], those of [`create`](crate::create), and of writing.
pub fn polylines_file(
    curves: &[Polyline<'_>],
    path: &Path,
    format: Option<Format>,
) -> Result<AtomicFile, Error> {
    write_to(curves, path, format, |shown, compression| {
        OutputFile::create(path, shown, compression)
    })
}

/// The bytes of the file `name` that [`polylines_file`] would write, where there are no files.
///
/// ```
/// use taut_io::{Polyline, polylines_bytes};
///
/// let corner = Polyline { vertices: &[[0.0, 0.0], [1.0, 0.0], [1.0, 0.5]], closed: false };
/// assert_eq!(polylines_bytes(&[corner], "corner.csv")?, b"curve,closed,x,y\n0,0,0,0\n0,0,1,0\n0,0,1,0.5\n");
/// # Ok::<(), taut_io::Error>(())
/// ```
///
/// # Errors
/// As [`polylines_file`], but for those of files.
pub fn polylines_bytes(curves: &[Polyline<'_>], name: &str) -> Result<Vec<u8>, Error> {
    let file = write_to(curves, Path::new(name), None, |shown, compression| {
        OutputFile::in_memory(shown, compression)
    })?;
    Ok(file.into_memory())
}

fn write_to(
    curves: &[Polyline<'_>],
    path: &Path,
    format: Option<Format>,
    create: impl FnOnce(&str, Option<Compression>) -> Result<OutputFile<'_>, Error>,
) -> Result<AtomicFile, Error> {
    let shown = shown_path(path);
    let (format, compression) = format_to_write(path, &shown, format, Content::Curves)?;
    let mut text = Text { bytes: Vec::new(), out: create(&shown, compression)? };
    match format {
        Format::Csv => csv::write(curves, &mut text)?,
        Format::GeoJson => geojson::write(curves, &mut text)?,
        _ => svg::write(curves, &mut text)?,
    }
    text.flush()?;
    text.out.finish()
}

/// Text on its way to a file.
struct Text<'a> {
    bytes: Vec<u8>,
    out: OutputFile<'a>,
}

impl Text<'_> {
    fn put(&mut self, words: &str) {
        self.bytes.extend_from_slice(words.as_bytes());
    }

    /// A number: the shortest decimals that read back to the same bits.
    fn number(&mut self, value: f64) {
        // Adding 0 turns −0 into 0.
        put_number(value + 0.0, &mut self.bytes);
    }

    /// Hands on what was gathered, if it is much.
    fn spill(&mut self) -> Result<(), Error> {
        if self.bytes.len() >= PIECE { self.flush() } else { Ok(()) }
    }

    fn flush(&mut self) -> Result<(), Error> {
        self.out.put(&self.bytes)?;
        self.bytes.clear();
        Ok(())
    }
}
