//! Curves of the plane to files.
//!
//! *Guarantee.* Coordinates are the shortest decimals that read back to the same bits.

mod csv;
mod geojson;
mod svg;

use std::fmt;
use std::path::Path;

use taut_mesh::Polyline;

use crate::create::AtomicFile;
use crate::error::shown_path;
use crate::write::Out;
use crate::{Compression, Error};

/// Bytes gathered before they are written.
const PIECE: usize = 1 << 18;

/// A file format of polylines.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PolylineFormat {
    /// A row for each vertex: curve, closed, x, y.
    Csv,
    /// Polygons with their holes, line strings and points, as in RFC 7946.
    GeoJson,
    /// One path of SVG.
    Svg,
}

impl PolylineFormat {
    /// Every format.
    pub const ALL: [PolylineFormat; 3] =
        [PolylineFormat::Csv, PolylineFormat::GeoJson, PolylineFormat::Svg];

    /// The name; it is the extension too.
    pub fn name(self) -> &'static str {
        match self {
            PolylineFormat::Csv => "csv",
            PolylineFormat::GeoJson => "geojson",
            PolylineFormat::Svg => "svg",
        }
    }

    /// One line for a list of formats.
    pub fn description(self) -> &'static str {
        match self {
            PolylineFormat::Csv => {
                "a row for each vertex, in order: curve (from 0), closed (1 or 0), x, y"
            }
            PolylineFormat::GeoJson => {
                "loops as polygons, those within as their holes; open curves as line strings"
            }
            PolylineFormat::Svg => "all curves as one path, in coordinates of the input",
        }
    }

    /// The format and compression that the name of a file tells: `coast.csv.gz` is CSV and gzip.
    pub fn of_path(path: &Path) -> (Option<PolylineFormat>, Option<Compression>) {
        let (inner, compression) = Compression::split(path);
        let format = inner
            .and_then(|inner| PolylineFormat::ALL.into_iter().find(|known| known.name() == inner));
        (format, compression)
    }
}

impl fmt::Display for PolylineFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// Writes curves to `path` in the given format, or in that of the extension, as [`polylines_file`] and [`AtomicFile::commit`].
///
/// # Errors
/// [`Error`]; an earlier file of that name is then as it was.
pub fn write_polylines(
    curves: &[Polyline<'_>],
    path: &Path,
    format: Option<PolylineFormat>,
) -> Result<(), Error> {
    polylines_file(curves, path, format)?.commit()
}

/// The file that [`write_polylines`] writes, complete, but not yet in its place. The extensions `.gz`, `.xz` and `.zst` compress.
///
/// Of curves with numbers that are not finite no file is read back.
///
/// # Errors
/// [`Error::UnknownPolylines`], those of [`create`](crate::create), and of writing.
pub fn polylines_file(
    curves: &[Polyline<'_>],
    path: &Path,
    format: Option<PolylineFormat>,
) -> Result<AtomicFile, Error> {
    let shown = shown_path(path);
    let (named, compression) = PolylineFormat::of_path(path);
    let format = format.or(named).ok_or_else(|| Error::UnknownPolylines { path: shown.clone() })?;
    let mut text = Text { bytes: Vec::new(), out: Out::create(path, &shown, compression)? };
    match format {
        PolylineFormat::Csv => csv::write(curves, &mut text)?,
        PolylineFormat::GeoJson => geojson::write(curves, &mut text)?,
        PolylineFormat::Svg => svg::write(curves, &mut text)?,
    }
    text.flush()?;
    text.out.finish()
}

/// Text on its way to a file.
struct Text<'a> {
    bytes: Vec<u8>,
    out: Out<'a>,
}

impl Text<'_> {
    /// Words as they are.
    fn put(&mut self, words: &str) {
        self.bytes.extend_from_slice(words.as_bytes());
    }

    /// A number: the shortest decimals that read back to the same bits.
    fn number(&mut self, value: f64) {
        let mut buffer = zmij::Buffer::new();
        // Adding 0 turns −0 into 0.
        let digits = buffer.format(value + 0.0);
        self.put(digits.strip_suffix(".0").unwrap_or(digits));
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
