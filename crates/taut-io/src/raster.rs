//! Rasters: values on a grid of square cells, as NumPy arrays and as ESRI ASCII grids.
//!
//! *Idea.* Cells come in any order. They are kept in memory, or in a temporary file where they take more than is allowed, and
//! are written row by row.
//! *Guarantee.* Values of `.asc` are the shortest decimals that read back to the same bits.
//! *Reference.* ESRI, *ASCII raster format*: six lines of a header, then rows from the north.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use taut_points::{Monitor, ReadError, try_reserve_exact};

use crate::create::AtomicFile;
use crate::error::shown_path;
use crate::space::check_space;
use crate::words::put_number;
use crate::write::OutputFile;
use crate::{Compression, Error, NpyArray, RasterError};

/// Values that are written or read at once.
const VALUES_AT_ONCE: usize = 1 << 15;

/// A grid of square cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RasterHeader {
    /// Columns, from the west.
    pub columns: u64,
    /// Rows, from the north.
    pub rows: u64,
    /// The x of the western border.
    pub west: f64,
    /// The y of the southern border.
    pub south: f64,
    /// The side of a cell.
    pub cell: f64,
    /// Stands for no value in ASCII grids, which have no NaN.
    pub no_value: f64,
}

/// A raster in the making: NaN where nothing was put.
pub struct RasterFile {
    header: RasterHeader,
    cells: Cells,
}

enum Cells {
    Memory(Vec<f64>),
    /// A file without name, and the folder that it is in.
    File(File, PathBuf),
}

/// The format of a raster.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Npy,
    Ascii,
}

/// Tests whether a raster can have this name: `.npy` or `.asc`, also compressed.
///
/// # Errors
/// [`RasterError::Name`].
pub fn check_raster(path: &Path) -> Result<(), Error> {
    kind(path).map(drop)
}

fn kind(path: &Path) -> Result<(Kind, Option<Compression>), Error> {
    let (extension, compression) = Compression::split(path);
    match extension.as_deref() {
        Some("npy") => Ok((Kind::Npy, compression)),
        Some("asc") => Ok((Kind::Ascii, compression)),
        _ => Err(RasterError::Name { path: shown_path(path) }.into()),
    }
}

impl RasterFile {
    /// A raster without values, in a file of `folder` (by default that for temporary files) if its cells take more than
    /// `memory` bytes.
    ///
    /// # Errors
    /// [`RasterError::Size`] for more cells than can be counted in bytes, [`Error::Spill`], [`Error::NoSpace`].
    pub fn new(header: RasterHeader, memory: u64, folder: Option<&Path>) -> Result<Self, Error> {
        let bytes = header.columns.checked_mul(header.rows).and_then(|cells| cells.checked_mul(8));
        let too_large = RasterError::Size { columns: header.columns, rows: header.rows };
        let Some(bytes) = bytes.filter(|&bytes| bytes < 1 << 62) else {
            return Err(too_large.into());
        };
        if bytes <= memory {
            let mut values = Vec::new();
            let cells = usize::try_from(bytes / 8).map_err(|_| too_large.clone())?;
            try_reserve_exact(&mut values, cells).map_err(|_| too_large)?;
            values.resize(cells, f64::NAN);
            return Ok(Self { header, cells: Cells::Memory(values) });
        }
        let folder = folder.map_or_else(std::env::temp_dir, Path::to_owned);
        let shown = folder.display().to_string();
        check_space(&folder.join("raster"), &shown, bytes)?;
        let failed = |source| spilled(&folder, source);
        let mut file = tempfile::tempfile_in(&folder).map_err(failed)?;
        let piece = f64::NAN.to_le_bytes().repeat(VALUES_AT_ONCE);
        let mut rest = bytes;
        while rest > 0 {
            let count = rest.min(piece.len() as u64);
            file.write_all(&piece[..count as usize]).map_err(failed)?;
            rest -= count;
        }
        Ok(Self { header, cells: Cells::File(file, folder) })
    }

    /// Puts values side by side: in a row from the north, from a column on.
    ///
    /// # Errors
    /// [`Error::Spill`].
    ///
    /// # Panics
    /// If there are no such cells.
    pub fn put(&mut self, row: u64, column: u64, values: &[f64]) -> Result<(), Error> {
        assert!(row < self.header.rows && column + values.len() as u64 <= self.header.columns);
        let first = row * self.header.columns + column;
        match &mut self.cells {
            Cells::Memory(cells) => {
                cells[first as usize..][..values.len()].copy_from_slice(values);
                Ok(())
            }
            Cells::File(file, folder) => {
                let written = file
                    .seek(SeekFrom::Start(first * 8))
                    .and_then(|_| file.write_all(bytemuck::cast_slice(values)));
                written.map_err(|source| spilled(folder, source))
            }
        }
    }

    /// The complete file `path`, not yet in its place: `.npy`, an array of rows from the north with NaN for no value, or `.asc`.
    ///
    /// # Errors
    /// [`RasterError::Name`], those of [`create`](crate::create), of writing, and of the monitor.
    pub fn file(&mut self, path: &Path, monitor: &Monitor<'_>) -> Result<AtomicFile, Error> {
        let (kind, compression) = kind(path)?;
        let shown = shown_path(path);
        let header = self.header;
        let mut out = OutputFile::create(path, &shown, compression)?;
        match kind {
            Kind::Npy => {
                let shape = vec![header.rows, header.columns];
                let dtype = "<f8".to_owned();
                out.put(&NpyArray { dtype, width: 8, fortran: false, shape, offset: 0 }.header())?;
            }
            Kind::Ascii => out.put(ascii_header(&header).as_bytes())?,
        }
        let (mut column, mut text) = (0, Vec::new());
        self.each(|values| {
            monitor.check().map_err(ReadError::from)?;
            if kind == Kind::Npy {
                return out.put(bytemuck::cast_slice(values));
            }
            text.clear();
            for &value in values {
                put_number(if value.is_nan() { header.no_value } else { value + 0.0 }, &mut text);
                column += 1;
                let is_last = column == header.columns;
                text.push(if is_last { b'\n' } else { b' ' });
                column = if is_last { 0 } else { column };
            }
            out.put(&text)
        })?;
        out.finish()
    }

    /// All values, row by row, many at a time.
    fn each(&mut self, mut work: impl FnMut(&[f64]) -> Result<(), Error>) -> Result<(), Error> {
        match &mut self.cells {
            Cells::Memory(cells) => cells.chunks(VALUES_AT_ONCE).try_for_each(work),
            Cells::File(file, folder) => {
                let failed = |source: io::Error| spilled(folder, source);
                file.rewind().map_err(failed)?;
                let mut values = vec![0.0; VALUES_AT_ONCE];
                let mut rest = self.header.columns * self.header.rows;
                while rest > 0 {
                    let count = rest.min(VALUES_AT_ONCE as u64) as usize;
                    let piece = &mut values[..count];
                    file.read_exact(bytemuck::cast_slice_mut(piece)).map_err(failed)?;
                    work(piece)?;
                    rest -= count as u64;
                }
                Ok(())
            }
        }
    }
}

fn spilled(folder: &Path, source: io::Error) -> Error {
    Error::Spill { path: "the raster".to_owned(), folder: folder.display().to_string(), source }
}

fn ascii_header(header: &RasterHeader) -> String {
    let number = |value: f64| {
        let mut text = Vec::new();
        put_number(value + 0.0, &mut text);
        String::from_utf8_lossy(&text).into_owned()
    };
    format!(
        "ncols {}\nnrows {}\nxllcorner {}\nyllcorner {}\ncellsize {}\nNODATA_value {}\n",
        header.columns,
        header.rows,
        number(header.west),
        number(header.south),
        number(header.cell),
        number(header.no_value)
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{ReadOptions, open};

    const HEADER: RasterHeader =
        RasterHeader { columns: 3, rows: 2, west: -1.5, south: 10.0, cell: 0.5, no_value: -9999.0 };

    fn filled(memory: u64, folder: &Path) -> RasterFile {
        let mut raster = RasterFile::new(HEADER, memory, Some(folder)).unwrap();
        raster.put(1, 1, &[0.1, -2.0]).unwrap();
        raster.put(0, 0, &[7.0]).unwrap();
        raster.put(1, 1, &[0.1]).unwrap();
        raster
    }

    #[test]
    fn memory_and_files_give_the_same_rasters() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        for memory in [0, 1 << 20] {
            let mut raster = filled(memory, folder.path());
            assert_eq!(matches!(raster.cells, Cells::Memory(_)), memory > 0);
            for name in ["grid.asc", "grid.npy", "grid.asc.gz"] {
                raster.file(&at(name), &Monitor::silent()).unwrap().commit().unwrap();
            }
            let text = std::fs::read_to_string(at("grid.asc")).unwrap();
            let expected = "ncols 3\nnrows 2\nxllcorner -1.5\nyllcorner 10\ncellsize 0.5\nNODATA_value -9999\n\
                            7 -9999 -9999\n-9999 0.1 -2\n";
            assert_eq!(text, expected);
            let array = open(&at("grid.npy"), &ReadOptions::default()).unwrap();
            assert_eq!((array.source.len(), array.source.dim()), (2, 3));
            let found = taut_points::gather(&*array.source, &[0, 1]).unwrap();
            let bits = |values: &[f64]| values.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
            let nan = f64::NAN;
            assert_eq!(bits(&found), bits(&[7.0, nan, nan, nan, 0.1, -2.0]));
        }
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 3);
    }

    #[test]
    fn other_names_and_sizes_are_refused() {
        for name in ["grid.tif", "grid", "grid.csv", "grid.gz"] {
            let refused = check_raster(Path::new(name)).unwrap_err().to_string();
            assert!(refused.contains(".npy or .asc"), "{refused}");
        }
        let header = RasterHeader { columns: u64::MAX, ..HEADER };
        assert!(matches!(
            RasterFile::new(header, 1, None),
            Err(Error::Raster(RasterError::Size { .. }))
        ));
        let header = RasterHeader { columns: 1 << 50, rows: 1 << 8, ..HEADER };
        assert!(matches!(RasterFile::new(header, 1, None), Err(Error::NoSpace { .. })));
    }
}
