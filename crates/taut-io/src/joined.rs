//! The files of a folder as one set of points, in the order of their names.
//!
//! *Guarantee.* Row r is the same point however much memory is allowed: files are one behind the other.

use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};

use taut_points::{OrderBy, PointSource, Points, ReadError, Rows, ScalarKind, Scratch};

use crate::error::shown_path;
use crate::filter::Filter;
use crate::input::{Input, Part};
use crate::missing::Dropped;
use crate::{Error, FilterError, ReadOptions, input};

/// Points of several sources, one behind the other.
struct Joined {
    sources: Vec<Box<dyn PointSource>>,
    /// The first row of each source, and the number of all rows.
    starts: Vec<u64>,
    dim: usize,
    scalar: ScalarKind,
}

impl PointSource for Joined {
    fn len(&self) -> u64 {
        self.starts.last().copied().unwrap_or(0)
    }

    fn dim(&self) -> usize {
        self.dim
    }

    fn scalar(&self) -> ScalarKind {
        self.scalar
    }

    fn read<'a>(
        &'a self,
        range: Range<u64>,
        scratch: &'a mut Scratch,
    ) -> Result<Rows<'a>, ReadError> {
        let n = self.len();
        if range.start > range.end || range.end > n {
            return Err(ReadError::OutOfRange { first: range.start, end: range.end, n });
        }
        let last = self.sources.len() - 1;
        let first =
            self.starts.partition_point(|&start| start <= range.start).clamp(1, last + 1) - 1;
        if range.end <= self.starts[first + 1] && self.sources[first].scalar() == self.scalar {
            let start = self.starts[first];
            return self.sources[first].read(range.start - start..range.end - start, scratch);
        }
        match self.scalar {
            ScalarKind::F32 => {
                let values = scratch.values::<f32>(range.end - range.start, self.dim)?;
                let dim = self.dim;
                self.copy(range, first, |row, point| {
                    for (to, &from) in values[row * dim..].iter_mut().zip(point) {
                        // It was single precision before.
                        *to = from as f32;
                    }
                })?;
                Ok(Rows::F32(Points::new(values, dim)?))
            }
            ScalarKind::F64 => {
                let values = scratch.values::<f64>(range.end - range.start, self.dim)?;
                let dim = self.dim;
                self.copy(range, first, |row, point| {
                    values[row * dim..(row + 1) * dim].copy_from_slice(point);
                })?;
                Ok(Rows::F64(Points::new(values, dim)?))
            }
        }
    }
}

impl Joined {
    /// Calls `work` with each point of a range and its place there; the range begins in source `first`.
    fn copy(
        &self,
        range: Range<u64>,
        first: usize,
        mut work: impl FnMut(usize, &[f64]),
    ) -> Result<(), ReadError> {
        let (mut scratch, mut point) = (Scratch::new(), vec![0.0; self.dim]);
        let mut done = 0;
        for (source, bounds) in self.sources.iter().zip(self.starts.windows(2)).skip(first) {
            let (start, end) = (range.start.max(bounds[0]), range.end.min(bounds[1]));
            if start >= end {
                break;
            }
            let rows = source.read(start - bounds[0]..end - bounds[0], &mut scratch)?;
            for row in 0..rows.len() {
                rows.copy_row(row, &mut point);
                work(done + row, &point);
            }
            done += rows.len();
        }
        Ok(())
    }
}

/// The files of a folder in the order of their names, but those whose name begins with a dot.
pub(crate) fn files(folder: &Path) -> Result<Vec<PathBuf>, Error> {
    let failed = |source| Error::reading(&shown_path(folder), source);
    let entries = fs::read_dir(folder).map_err(failed)?;
    let mut files = vec![];
    for entry in entries {
        let entry = entry.map_err(failed)?;
        if !entry.file_name().to_string_lossy().starts_with('.') {
            files.push(entry.path());
        }
    }
    files.order();
    Ok(files)
}

/// Opens the points of all files of a folder as one set.
pub(crate) fn open(
    folder: &Path,
    options: &ReadOptions,
    filter: &mut Filter,
) -> Result<Input, Error> {
    let path = shown_path(folder);
    let files = files(folder)?;
    if files.is_empty() {
        return Err(Error::Directory { path });
    }
    let memory = options.memory.map(|memory| memory / files.len() as u64);
    let options = ReadOptions { memory, ..options.clone() };
    let (mut parts, mut sources, mut starts) = (vec![], vec![], vec![0]);
    let mut whole: Option<Input> = None;
    let mut other_classes: Option<(Vec<u8>, Vec<u8>)> = None;
    for file in files {
        if file.is_dir() {
            return Err(Error::Directory { path: shown_path(&file) });
        }
        let opened = input::open_filtered(&file, &options, filter);
        match opened {
            Err(Error::Filter(FilterError::NothingKept { .. })) => continue,
            Err(Error::Filter(FilterError::NothingOfClasses { wanted, found, .. })) => {
                other_classes.get_or_insert((wanted, vec![])).1.extend(found);
                continue;
            }
            _ => {}
        }
        let Input { source, columns, labels, format, path: name, numbers, dropped, .. } = opened?;
        let start = starts.last().copied().unwrap_or(0);
        parts.push(Part { start, path: name.clone(), numbers: numbers.clone(), dropped });
        starts.push(start + source.len());
        match &mut whole {
            None => {
                whole = Some(Input {
                    source,
                    columns,
                    labels,
                    format,
                    path: name,
                    numbers,
                    dropped: Dropped::default(),
                    parts: vec![],
                })
            }
            Some(first) => {
                let (expected, found) = (first.source.dim(), source.dim());
                if expected != found {
                    let (path, other) = (name, first.path.clone());
                    return Err(Error::OtherDimension { path, found, other, expected });
                }
                first.labels.extend(labels);
                sources.push(source);
            }
        }
    }
    let Some(mut whole) = whole else {
        let Some((wanted, mut found)) = other_classes else {
            return Err(FilterError::NothingKept { path }.into());
        };
        found.sort_unstable();
        found.dedup();
        return Err(FilterError::NothingOfClasses { path, wanted, found }.into());
    };
    let (dim, first) = (whole.source.dim(), whole.source);
    sources.insert(0, first);
    let is_single = sources.iter().all(|source| source.scalar() == ScalarKind::F32);
    let scalar = if is_single { ScalarKind::F32 } else { ScalarKind::F64 };
    whole.source = Box::new(Joined { sources, starts, dim, scalar });
    Ok(Input { path, parts, ..whole })
}
