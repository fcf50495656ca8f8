//! From a path, a stream or bytes to points: what format it is, what compresses it, and who reads it.

use std::fs::{self, File};
use std::io::{self, BufRead, BufReader, Cursor, Read};
use std::path::{Path, PathBuf};

use bytes::Bytes;
use taut_points::PointSource;

use crate::describe::{ColumnDescription, ColumnKind};
use crate::device::refuse_device;
use crate::error::shown_path;
use crate::filter::Filter;
use crate::joined;
use crate::missing::{Dropped, drop_rows};
use crate::read::{self, Decoded, numeric};
use crate::{
    Columns, Compression, Content, Error, FilterError, Format, Missing, Place, ReadOptions,
    compress, labels,
};

/// Points of a file, and what is known of it.
pub struct Input {
    /// The points. They keep any temporary file alive.
    pub source: Box<dyn PointSource>,
    /// A name for each coordinate; empty where the file has none.
    pub columns: Vec<String>,
    /// The label of each point, if [`ReadOptions::label`] asked for them.
    pub labels: Vec<String>,
    /// The format that was read.
    pub format: Format,
    /// The file as shown to people; `standard input` for `-`.
    pub path: String,
    /// The column of the file for each coordinate, where some were selected.
    pub(crate) numbers: Option<Vec<usize>>,
    /// The rows that were left out of one file.
    pub(crate) dropped: Dropped,
    /// The files of a folder, in order; empty for one file.
    pub(crate) parts: Vec<Part>,
}

/// One of the files of a folder.
pub(crate) struct Part {
    /// Its first row among those of all files.
    pub(crate) start: u64,
    /// The file as shown to people.
    pub(crate) path: String,
    /// As of an [`Input`].
    pub(crate) numbers: Option<Vec<usize>>,
    /// The rows that were left out.
    pub(crate) dropped: Dropped,
}

impl std::fmt::Debug for Input {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Input")
            .field("path", &self.path)
            .field("format", &self.format)
            .field("len", &self.source.len())
            .field("dim", &self.source.dim())
            .field("scalar", &self.source.scalar())
            .field("columns", &self.columns)
            .finish_non_exhaustive()
    }
}

impl Input {
    /// The triangles of a mesh.
    pub(crate) fn of_mesh(source: Box<dyn PointSource>, format: Format, path: String) -> Self {
        let names = ["ax", "ay", "az", "bx", "by", "bz", "cx", "cy", "cz"];
        let columns = names.map(str::to_owned).to_vec();
        let (labels, numbers, dropped, parts) = (vec![], None, Dropped::default(), vec![]);
        Input { source, columns, labels, format, path, numbers, dropped, parts }
    }

    /// The number of rows that were left out because they lack a value.
    pub fn dropped_rows(&self) -> u64 {
        let parts: u64 = self.parts.iter().map(|part| part.dropped.count()).sum();
        self.dropped.count() + parts
    }

    /// The number of rows in the file, or in all files of a folder, with those that were left out because they lack a value or by
    /// a box or a grid; known where the former were asked to be left out.
    pub fn rows_in_file(&self) -> u64 {
        let parts: u64 = self.parts.iter().map(|part| part.dropped.all()).sum();
        self.dropped.all() + parts
    }

    /// The number in the file of a row of the points, both from 0; in a folder that in its own file.
    pub fn row_in_file(&self, row: u64) -> u64 {
        let part = self.parts.partition_point(|part| part.start <= row).checked_sub(1);
        match part.and_then(|part| self.parts.get(part)) {
            Some(part) => part.dropped.in_file(row - part.start),
            None => self.dropped.in_file(row),
        }
    }

    /// Where coordinate `column` of point `row` (both from 0, as solvers count) stands in the file.
    pub fn describe_cell(&self, row: u64, column: usize) -> Place {
        let part = self.parts.partition_point(|part| part.start <= row).checked_sub(1);
        let (path, numbers) = match part.and_then(|part| self.parts.get(part)) {
            Some(part) => (&part.path, &part.numbers),
            None => (&self.path, &self.numbers),
        };
        let number = numbers.as_ref().and_then(|numbers| numbers.get(column).copied());
        Place {
            path: path.clone(),
            row: self.row_in_file(row).saturating_add(1),
            line: None,
            column: number.unwrap_or(column),
            name: self.columns.get(column).cloned(),
        }
    }
}

/// The data that every reader gets.
pub(crate) struct Job<'a> {
    /// The file as shown to people.
    pub(crate) path: &'a str,
    pub(crate) format: Format,
    pub(crate) options: &'a ReadOptions,
}

/// Where bytes come from.
pub(crate) enum Medium {
    /// A regular file, at its beginning.
    File(File, PathBuf),
    Stream(Box<dyn BufRead>),
    Bytes(Bytes),
}

impl Medium {
    /// Opens the file at `path`, or standard input for `-`, and says how messages show it.
    pub(crate) fn open(path: &Path) -> Result<(Medium, String), Error> {
        if path.as_os_str() == "-" {
            refuse_device_at_stdin()?;
            let stream = Box::new(BufReader::with_capacity(1 << 18, io::stdin()));
            return Ok((Medium::Stream(stream), "standard input".to_owned()));
        }
        let display = shown_path(path);
        let failed = |source| Error::reading(&display, source);
        let kind = fs::metadata(path).map_err(failed)?;
        if kind.is_dir() {
            return Err(Error::Directory { path: display });
        }
        let file = File::open(path).map_err(failed)?;
        refuse_device(&file, &display)?;
        // A pipe has a path on some systems, but no place to go back to.
        let medium = match kind.is_file() {
            true => Medium::File(file, path.to_owned()),
            false => Medium::Stream(Box::new(BufReader::with_capacity(1 << 18, file))),
        };
        Ok((medium, display))
    }

    /// The bytes that the compression of the name, or that of the first bytes if `sniff` says so, stands for; and the first
    /// of them, of which there must be one.
    pub(crate) fn decompressed(
        self,
        display: &str,
        named: Option<Compression>,
        sniff: bool,
    ) -> Result<(Vec<u8>, Medium), Error> {
        let empty = || Error::Empty { path: display.to_owned() };
        let (head, medium) = self.peek(display)?;
        if head.is_empty() {
            return Err(empty());
        }
        let Some(compression) = named.or(Compression::of_magic(&head).filter(|_| sniff)) else {
            return Ok((head, medium));
        };
        let stream = compress::decoder(compression, medium.stream(), display)?;
        let (head, medium) = Medium::Stream(stream).peek(display)?;
        if head.is_empty() { Err(empty()) } else { Ok((head, medium)) }
    }

    pub(crate) fn stream(self) -> Box<dyn BufRead> {
        match self {
            Medium::File(file, _) => Box::new(BufReader::with_capacity(1 << 18, file)),
            Medium::Stream(stream) => stream,
            Medium::Bytes(bytes) => Box::new(Cursor::new(bytes)),
        }
    }

    /// For readers that jump about: a stream is first copied to a temporary file.
    pub(crate) fn seekable(self, job: &Job<'_>) -> Result<read::Seekable, Error> {
        Ok(match self {
            Medium::File(file, _) => read::Seekable::File(file),
            Medium::Bytes(bytes) => read::Seekable::Bytes(bytes),
            Medium::Stream(mut stream) => {
                let mut copy = crate::sink::temporary(job)?;
                let mut failed = None;
                // Told apart here, because a copy only says that one of the two sides failed.
                loop {
                    let chunk = stream.fill_buf().map_err(|e| Error::reading(job.path, e))?;
                    if chunk.is_empty() {
                        break;
                    }
                    failed = failed.or(io::Write::write_all(&mut copy, chunk).err());
                    let used = chunk.len();
                    stream.consume(used);
                }
                match failed {
                    Some(source) => return Err(crate::sink::failed(job, source)),
                    None => read::Seekable::File(copy),
                }
            }
        })
    }

    /// The first bytes (up to 8), which stay to be read.
    pub(crate) fn peek(self, path: &str) -> Result<(Vec<u8>, Medium), Error> {
        let failed = |source| Error::reading(path, source);
        let mut head = Vec::new();
        Ok(match self {
            Medium::Bytes(bytes) => (bytes[..bytes.len().min(8)].to_vec(), Medium::Bytes(bytes)),
            Medium::File(mut file, at) => {
                (&mut file).take(8).read_to_end(&mut head).map_err(failed)?;
                io::Seek::rewind(&mut file).map_err(failed)?;
                (head, Medium::File(file, at))
            }
            Medium::Stream(mut stream) => {
                (&mut stream).take(8).read_to_end(&mut head).map_err(failed)?;
                let whole = Cursor::new(head.clone()).chain(stream);
                (head, Medium::Stream(Box::new(whole)))
            }
        })
    }
}

/// Opens the points of `path`; `-` is standard input, and a folder stands for all files in it, one behind the other in the
/// order of their names.
///
/// Compression is recognized by the extension or by the first bytes. A file that is read in place (npy, raw) must
/// not change while its points are in use.
///
/// # Errors
/// [`Error`], with file, row, column and value. Values of files that are read in place are not looked at: a solver
/// reports what it finds there, and [`Input::describe_cell`] says where that is.
pub fn open(path: &Path, options: &ReadOptions) -> Result<Input, Error> {
    open_filtered(path, options, &mut Filter::of(options))
}

/// The same with a filter that several files share.
pub(crate) fn open_filtered(
    path: &Path,
    options: &ReadOptions,
    filter: &mut Filter,
) -> Result<Input, Error> {
    if path.as_os_str() != "-" && path.is_dir() {
        return joined::open(path, options, filter);
    }
    let (medium, display) = Medium::open(path)?;
    let name = matches!(medium, Medium::File(..)).then_some(path);
    open_medium(medium, name, &display, options, filter)
}

/// The columns of a text that hold words: all but those of numbers.
pub(crate) fn text_columns(
    path: &Path,
    options: &ReadOptions,
    format: Format,
) -> Result<Vec<ColumnDescription>, Error> {
    let (medium, display) = Medium::open(path)?;
    let (_, medium) = medium.decompressed(&display, Format::of_path(path).1, true)?;
    let job = Job { path: &display, format, options };
    let found = numeric::columns(&job, medium.stream())?;
    let others = (0..found.first.len()).filter(|column| !found.numbers.contains(column));
    Ok(others
        .map(|column| ColumnDescription {
            name: match found.has_header {
                true => found.first[column].clone(),
                false => column.to_string(),
            },
            kind: ColumnKind::Text,
            missing: found.words[column][1],
            range: None,
        })
        .collect())
}

/// Refuses a device as standard input, which no path would name.
fn refuse_device_at_stdin() -> Result<(), Error> {
    #[cfg(unix)]
    {
        use std::os::fd::AsFd;
        if let Ok(descriptor) = io::stdin().as_fd().try_clone_to_owned() {
            refuse_device(&File::from(descriptor), "standard input")?;
        }
    }
    Ok(())
}

/// Opens the points of a file whose bytes are in memory; `name` tells the format as a path would.
///
/// # Errors
/// As [`open`].
pub fn open_bytes(bytes: Vec<u8>, name: &str, options: &ReadOptions) -> Result<Input, Error> {
    open_medium(
        Medium::Bytes(bytes.into()),
        Some(Path::new(name)),
        &shown_path(name.as_ref()),
        options,
        &mut Filter::of(options),
    )
}

/// What it means that a filter left no point.
fn nothing_kept(error: Error) -> Error {
    match error {
        Error::NoRows { path } => FilterError::NothingKept { path }.into(),
        other => other,
    }
}

fn open_medium(
    medium: Medium,
    name: Option<&Path>,
    display: &str,
    options: &ReadOptions,
    filter: &mut Filter,
) -> Result<Input, Error> {
    let (named_format, named_compression) = name.map_or((None, None), Format::of_path);
    let known = options.format.or(named_format.filter(|format| format.holds(Content::Points)));
    // Raw values may begin with any bytes, so only a name says that they are compressed.
    let sniff = known != Some(Format::Raw);
    let (head, medium) = medium.decompressed(display, named_compression, sniff)?;
    let unknown = || match named_format {
        Some(format) => Error::not_readable(display, format, Content::Points),
        None => Error::UnknownFormat { path: display.to_owned(), content: Content::Points },
    };
    let format = known
        .or_else(|| read::format_of_magic(&head))
        .or(name.is_none().then_some(Format::Csv))
        .ok_or_else(unknown)?;
    if options.feature.is_some() && !format.has_features() {
        return Err(Error::NoFeatures { path: display.to_owned(), format });
    }
    if options.classes.is_some() && !format.has_classes() {
        return Err(Error::NoClasses { path: display.to_owned(), format });
    }
    let label = options.label.as_deref().map(Columns::of_label);
    let with_label = labels::selecting(options, label.as_ref(), format);
    let job = Job { path: display, format, options: with_label.as_ref().unwrap_or(options) };
    let mut decoded = read::read(&job, medium, filter)?;
    if let Some(label) = label.filter(|_| !format.reads_labels()) {
        decoded = labels::split(decoded, &label, display, with_label.is_some())?;
    }
    let mut dropped = Dropped::default();
    if options.missing == Missing::Drop {
        (decoded, dropped) = drop_rows(&job, decoded)?;
    }
    if !filter.keeps_all() && !format.filters_as_it_reads() {
        let (mut rows, has_gaps) = (vec![], dropped.count() > 0);
        let note = |row| rows.extend(has_gaps.then_some(row));
        decoded = filter.apply(&job, decoded, note).map_err(nothing_kept)?;
        if has_gaps {
            dropped.keep(rows);
        }
    }
    let Decoded { source, columns, numbers, labels } = decoded;
    let (path, parts) = (display.to_owned(), vec![]);
    Ok(Input { source, columns, labels, format, path, numbers, dropped, parts })
}
