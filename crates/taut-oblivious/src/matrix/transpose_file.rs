//! Transposition of a matrix in a file that is larger than memory.
//!
//! *Problem.* Rows of the target are columns of the source; reading them one element at a time costs a block of the disk
//! for each.
//! *Idea.* Tiles: two buffers of half the memory each hold a tile and its transpose. A tile is read by rows and written
//! by columns, each a run of √(memory · width / 2) bytes: 32 KiB for numbers of 8 bytes in 256 MiB, however large the file.
//! Where the matrix is narrower than that, tiles are longer instead and runs join to one.
//! *Guarantee.* Every byte is read once and written once; the two buffers are all the memory that grows with the limit,
//! beside some 40 KiB a thread in which tiles are turned. The target appears under its name when it is whole: whatever
//! ends the work before leaves the earlier file as it was, and no other where the system has files without a name.
//! *Trap.* Mapping the files instead would fault page by page, without reading ahead, and a full disk would be a signal
//! instead of an error.
//! *Reference.* Thesis, section 5.3; Vitter, *Algorithms and Data Structures for External Memory*, 2008, section 7.2.

use std::borrow::Borrow;
use std::fs::File;
use std::path::{Path, PathBuf};

use taut_points::Monitor;

use crate::Error;
use crate::pages::Pages;
use crate::store::{self, Draft, Pending, Store};

pub(crate) mod check;

#[cfg(test)]
mod tests;
mod tile;

/// Where a row-major matrix lies in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FileMatrix {
    /// Rows.
    pub rows: u64,
    /// Columns.
    pub columns: u64,
    /// Bytes of an element, at least 1.
    pub width: usize,
    /// Bytes of the file before the first element.
    pub offset: u64,
}

impl FileMatrix {
    /// Bytes of the file up to the end of the matrix.
    ///
    /// # Errors
    /// [`Error::Option`] if the width is 0 or the file would have 2⁶⁴ bytes or more.
    pub fn end(&self) -> Result<u64, Error> {
        let refuse = |expected| {
            let value = format!(
                "{} × {} elements of {} bytes from byte {}",
                self.rows, self.columns, self.width, self.offset
            );
            Err(Error::Option { name: "matrix", value, expected })
        };
        if self.width == 0 {
            return refuse("elements of at least one byte");
        }
        let bytes = u128::from(self.rows) * u128::from(self.columns);
        let end =
            bytes.checked_mul(self.width as u128).and_then(|b| b.checked_add(self.offset.into()));
        match end.and_then(|end| u64::try_from(end).ok()) {
            Some(end) => Ok(end),
            None => refuse("less than 2⁶⁴ bytes"),
        }
    }

    /// Where the element at (i, j) begins.
    fn at(&self, i: u64, j: u64) -> u64 {
        self.offset + (i * self.columns + j) * self.width as u64
    }

    /// The transpose, after `header` bytes.
    fn transposed(&self, header: u64) -> Self {
        Self { rows: self.columns, columns: self.rows, width: self.width, offset: header }
    }
}

/// Options to transpose a file. Write `TransposeFileOptions { memory: 64 << 20, ..Default::default() }`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TransposeFileOptions {
    /// Most bytes of both buffers together, at least two elements; turning a tile takes some 40 KiB a thread besides.
    /// Default 256 MiB.
    pub memory: usize,
}

impl Default for TransposeFileOptions {
    fn default() -> Self {
        Self { memory: 256 << 20 }
    }
}

/// The result of the transposition of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FileTransposition {
    /// Bytes read: those of the matrix.
    pub bytes_read: u64,
    /// Bytes written: those of the matrix and of the header.
    pub bytes_written: u64,
    /// Tiles, each one read and one write per row and column, or less.
    pub tiles: u64,
    /// Bytes of the buffers.
    pub memory: usize,
}

/// Writes the file `to`: `header`, then the transpose of the matrix in the file `from`.
///
/// The names may be the same. `monitor` is told of one pass and of the elements of each tile. The target is written without
/// a name, or under a temporary one in its folder, brought to the disk and named. Where there is an earlier file of that
/// name, also behind a symbolic link, it is replaced and its permissions are kept. Room on the disk is reserved before the
/// work where the system can. O(rows · columns) and `options.memory` bytes.
///
/// # Errors
/// [`Error::Option`] if the memory holds less than two elements or is more than the system gives, or if the extent is not
/// possible, [`Error::Length`] if the file does not end with the matrix, [`Error::File`] if the system refuses,
/// [`Error::Cancelled`].
///
/// ```
/// use taut_oblivious::{FileMatrix, TransposeFileOptions, transpose_file};
/// use taut_points::Monitor;
///
/// let folder = std::env::temp_dir();
/// let (from, to) = (folder.join("taut-doc-from.bin"), folder.join("taut-doc-to.bin"));
/// std::fs::write(&from, b"abcdef")?;                                                  // two rows of three bytes
/// let matrix = FileMatrix { rows: 2, columns: 3, width: 1, offset: 0 };
/// transpose_file(&from, matrix, &to, b"", &TransposeFileOptions::default(), &Monitor::silent())?;
/// assert_eq!(std::fs::read(&to)?, b"adbecf");
/// # std::fs::remove_file(&from)?;
/// # std::fs::remove_file(&to)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn transpose_file(
    from: &Path,
    matrix: FileMatrix,
    to: &Path,
    header: &[u8],
    options: &TransposeFileOptions,
    monitor: &Monitor<'_>,
) -> Result<FileTransposition, Error> {
    transpose_file_pending(from, matrix, to, header, options, monitor)?.publish()
}

/// [`transpose_file`], but for the last step: the target is complete and has not its name yet, so that it can be looked at
/// before it replaces an earlier one.
///
/// # Errors
/// Those of [`transpose_file`].
pub fn transpose_file_pending(
    from: &Path,
    matrix: FileMatrix,
    to: &Path,
    header: &[u8],
    options: &TransposeFileOptions,
    monitor: &Monitor<'_>,
) -> Result<Pending<FileTransposition>, Error> {
    transpose_through(from, matrix, to, header, options, monitor, |file, _| file)
}

/// The same; `through` makes of each file what is read and written.
fn transpose_through<F: Store + Borrow<File>>(
    from: &Path,
    matrix: FileMatrix,
    to: &Path,
    header: &[u8],
    options: &TransposeFileOptions,
    monitor: &Monitor<'_>,
    through: impl Fn(File, &Path) -> F,
) -> Result<Pending<FileTransposition, F>, Error> {
    let plan = Plan::new(matrix, header.len() as u64, options)?;
    let source = through(open(from, &matrix)?, from);
    let target = Draft::beside(to, |file| through(file, to)).map_err(failed(to))?;
    let done = plan.run(&source, &target, header, monitor).map_err(|at| at.named(from, to))?;
    Ok(Pending::new(done, target, to, None))
}

fn open(path: &Path, matrix: &FileMatrix) -> Result<File, Error> {
    let (file, about) = store::open(path).map_err(failed(path))?;
    let bytes = about.len();
    let expected = matrix.end()?;
    if bytes == expected {
        Ok(file)
    } else {
        Err(Error::Length { path: path.display().to_string(), bytes, expected })
    }
}

/// Returns what the system said, and of which file.
fn failed(path: &Path) -> impl Fn(std::io::Error) -> Error + use<> {
    let path = PathBuf::from(path);
    move |source| Error::File { path: path.display().to_string(), source }
}

/// Why a run ended early, before files have names.
#[derive(Debug)]
enum Failure {
    Source(std::io::Error),
    Target(std::io::Error),
    /// Stopped, or no memory.
    Other(Error),
}

impl Failure {
    fn named(self, from: &Path, to: &Path) -> Error {
        match self {
            Self::Source(error) => failed(from)(error),
            Self::Target(error) => failed(to)(error),
            Self::Other(error) => error,
        }
    }
}

/// The tiles of a matrix.
struct Plan {
    from: FileMatrix,
    to: FileMatrix,
    /// Rows of a tile.
    height: u64,
    /// Columns of a tile.
    width: u64,
}

impl Plan {
    fn new(from: FileMatrix, header: u64, options: &TransposeFileOptions) -> Result<Self, Error> {
        from.end()?;
        let to = from.transposed(header);
        to.end()?;
        let elements = (options.memory / 2 / from.width) as u64;
        if elements == 0 && from.rows > 0 && from.columns > 0 {
            return Err(Error::Option {
                name: "memory",
                value: format!("{} bytes", options.memory),
                expected: "room for two elements",
            });
        }
        // Whole pages in the inner of a matrix, so that runs do not share them.
        let page = (4096 / from.width as u64).max(1);
        let to_pages = |length: u64, all: u64| {
            if length >= all { all } else { (length / page * page).max(length.min(page)) }
        };
        let width = to_pages(elements.isqrt(), from.columns);
        let height = to_pages(elements / width.max(1), from.rows);
        let width = to_pages(elements / height.max(1), from.columns);
        Ok(Self { from, to, height, width })
    }

    fn run<S: Store, T: Store>(
        &self,
        source: &S,
        target: &T,
        header: &[u8],
        monitor: &Monitor<'_>,
    ) -> Result<FileTransposition, Failure> {
        let (rows, columns, bytes) = (self.from.rows, self.from.columns, self.from.width);
        monitor.pass(1, rows * columns);
        let room = self.height as usize * self.width as usize * bytes;
        let [mut tile, mut turned] = [buffer(room)?, buffer(room)?];
        target.reserve(self.to.at(columns, 0)).map_err(Failure::Target)?;
        target.write_all_at(header, 0).map_err(Failure::Target)?;
        let mut done = FileTransposition {
            bytes_read: 0,
            bytes_written: header.len() as u64,
            tiles: 0,
            memory: 2 * room,
        };
        if rows == 0 || columns == 0 {
            return Ok(done);
        }
        for top in (0..rows).step_by(self.height as usize) {
            let height = self.height.min(rows - top);
            for left in (0..columns).step_by(self.width as usize) {
                let width = self.width.min(columns - left);
                monitor.check().map_err(|stop| Failure::Other(stop.into()))?;
                let size = height as usize * width as usize * bytes;
                let [tile, turned] = [&mut tile, &mut turned].map(|b| &mut b.words_mut()[..size]);
                for (run, at) in runs(tile, &self.from, (top, left), (height, width)) {
                    source.read_exact_at(run, at).map_err(Failure::Source)?;
                }
                tile::turn(tile, (height as usize, width as usize), bytes, turned);
                for (run, at) in runs(turned, &self.to, (left, top), (width, height)) {
                    target.write_all_at(run, at).map_err(Failure::Target)?;
                }
                done.tiles += 1;
                done.bytes_read += size as u64;
                done.bytes_written += size as u64;
                monitor.points(height * width);
            }
        }
        Ok(done)
    }
}

/// Memory for a tile.
fn buffer(bytes: usize) -> Result<Pages<u8>, Failure> {
    Pages::try_zeroed(bytes).map_err(Failure::Other)
}

/// The rows of a tile in memory and where they lie in the file; one run if they lie side by side.
fn runs<'a>(
    tile: &'a mut [u8],
    matrix: &FileMatrix,
    (top, left): (u64, u64),
    (height, width): (u64, u64),
) -> impl Iterator<Item = (&'a mut [u8], u64)> + use<'a> {
    let joined = if width == matrix.columns { height } else { 1 };
    let run = (joined * width) as usize * matrix.width;
    let matrix = *matrix;
    (top..)
        .step_by(joined as usize)
        .map(move |i| matrix.at(i, left))
        .zip(tile.chunks_mut(run))
        .map(|(at, run)| (run, at))
}
