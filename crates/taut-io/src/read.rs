//! A reader per format. Each takes bytes and returns points or says where and why not.

#[cfg(feature = "arrow")]
mod arrow;
mod chains;
#[cfg(feature = "arrow")]
mod columnar;
mod delimited;
mod geojson;
#[cfg(feature = "arrow")]
mod geoparquet;
mod las;
mod lines;
mod meshes;
mod npy;
mod npz;
pub(crate) mod numeric;
#[cfg(feature = "arrow")]
mod parquet;
mod pcd;
pub(crate) mod quiet;
mod raw;
mod rows;
mod shapefile;
mod svg;
#[cfg(feature = "arrow")]
pub(crate) mod thrift;
mod tsplib;
#[cfg(feature = "arrow")]
mod wkb;
mod wkt;
mod xyz;

pub(crate) use delimited::is_failed_value;

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use taut_points::{FileSource, MappedSource, PointSource, ScalarKind};

use bytes::Bytes;

use crate::FilePlace;
use crate::filter::Filter;
use crate::input::{Job, Medium};
use crate::{Content, Error, Format};
use crate::{limits, npy_header};

/// The sources that can be read at any place, for formats with an index at the end.
pub(crate) enum Seekable {
    File(File),
    Bytes(Bytes),
}

/// Points, and what the file says of them.
pub(crate) struct Decoded {
    pub(crate) source: Box<dyn PointSource>,
    /// Names of the coordinates; empty where there are none.
    pub(crate) columns: Vec<String>,
    /// The column of the file for each coordinate; the same numbers where none.
    pub(crate) numbers: Option<Vec<usize>>,
    /// The texts of the column of labels, where the reader knows of it.
    pub(crate) labels: Vec<String>,
}

/// The format whose files begin with these bytes.
pub(crate) fn format_of_magic(bytes: &[u8]) -> Option<Format> {
    const MAGIC: [(&[u8], Format); 8] = [
        (&[0, 0, 0x27, 0x0a, 0, 0, 0, 0], Format::Shapefile),
        (b"LASF", Format::Las),
        (npy_header::MAGIC, Format::Npy),
        (b"PAR1", Format::Parquet),
        (b"ARROW1", Format::Arrow),
        (b"ply\n", Format::Ply),
        (b"ply\r\n", Format::Ply),
        (b"OFF", Format::Off),
    ];
    if let Some((_, format)) = MAGIC.into_iter().find(|(magic, _)| bytes.starts_with(magic)) {
        return Some(format);
    }
    // An Arrow stream begins with the continuation mark of its first message.
    bytes.starts_with(&[0xff; 4]).then_some(Format::Arrow)
}

pub(crate) fn read(job: &Job<'_>, medium: Medium, filter: &mut Filter) -> Result<Decoded, Error> {
    match job.format {
        Format::Csv | Format::Tsv | Format::Whitespace => delimited::read(job, medium),
        Format::Tsplib => tsplib::read(job, medium.stream()),
        Format::Xyz => xyz::read(job, medium.stream()),
        Format::Ply | Format::Obj | Format::Off | Format::Stl => meshes::read(job, medium),
        Format::GeoJson => geojson::read(job, medium.stream()),
        Format::Wkt => wkt::read(job, medium.stream()),
        Format::Svg => svg::read(job, medium.stream()),
        Format::Las => las::read(job, medium, filter),
        Format::Pcd => pcd::read(job, medium.stream()),
        Format::Npz => npz::read(job, medium),
        Format::Shapefile => shapefile::read(job, medium.stream()),
        Format::Npy => read_npy(job, medium),
        Format::Raw => read_raw(job, medium),
        #[cfg(feature = "arrow")]
        Format::Parquet => parquet::read(job, medium),
        #[cfg(feature = "arrow")]
        Format::Arrow => arrow::read(job, medium.stream()),
        _ => Err(Error::not_readable(job.path, job.format, Content::Points)),
    }
}

fn read_npy(job: &Job<'_>, medium: Medium) -> Result<Decoded, Error> {
    if let Medium::File(file, path) = medium {
        let failed = |source| Error::reading(job.path, source);
        let length = file.metadata().map_err(failed)?.len();
        let mut stream = BufReader::new(file);
        let header = npy::header(job, &mut stream)?;
        header.check_bytes(job, length.saturating_sub(header.offset))?;
        return match header.in_place().filter(|_| job.options.columns.is_none()) {
            Some((n, dim, scalar)) => in_place(job, &path, header.offset, n, dim, scalar),
            None => npy::decode(job, &header, Box::new(stream)),
        };
    }
    let mut stream = medium.stream();
    let header = npy::header(job, &mut stream)?;
    npy::decode(job, &header, stream)
}

fn read_raw(job: &Job<'_>, medium: Medium) -> Result<Decoded, Error> {
    let layout = raw::layout(job)?;
    if let (Medium::File(file, path), None) = (&medium, &job.options.columns) {
        let length = file.metadata().map_err(|source| Error::reading(job.path, source))?.len();
        let n = raw::count(job, layout, length)?;
        return in_place(job, path, layout.offset, n, layout.dim, layout.scalar);
    }
    raw::decode(job, medium.stream())
}

/// Values that lie in the file as points do: mapped if they fit into the allowed memory, else read block by block.
fn in_place(
    job: &Job<'_>,
    path: &Path,
    offset: u64,
    n: u64,
    dim: usize,
    scalar: ScalarKind,
) -> Result<Decoded, Error> {
    let bytes = n.saturating_mul(dim as u64).saturating_mul(scalar.size() as u64);
    let source: Box<dyn PointSource> = match job.options.memory {
        Some(memory) if memory < bytes => {
            limits::check_point(job.path, bytes / n.max(1), Some(memory))?;
            Box::new(FileSource::open(path, offset, n, dim, scalar)?)
        }
        _ => Box::new(MappedSource::open(path, offset, n, dim, scalar)?),
    };
    Ok(Decoded { source, columns: Vec::new(), numbers: None, labels: Vec::new() })
}

/// The first line of what a decoder says; some go on with a trace of calls.
pub(crate) fn first_line(said: &dyn std::fmt::Display) -> String {
    said.to_string().lines().next().unwrap_or_default().trim_end().to_owned()
}

/// Runs a reader whose crate may panic on damaged bytes, and makes an error of that.
///
/// The crates for parquet, arrow and LAZ check most, but not all, of what a damaged file can hold before they index into it.
fn guarded(job: &Job<'_>, read: impl FnOnce() -> Result<Decoded, Error>) -> Result<Decoded, Error> {
    quiet::catch(read).unwrap_or_else(|_| {
        Err(Error::Damaged {
            path: job.path.to_owned(),
            format: job.format,
            place: FilePlace::File,
            problem: "its decoder stumbled over bytes that contradict each other".to_owned(),
        })
    })
}
