//! Raw values in a file, read block by block: the source for points larger than memory.

use std::fs::File;
use std::ops::Range;
use std::path::{Path, PathBuf};

use super::positioned::read_exact_at;
use super::{PointSource, Scratch, check_range};
use crate::{Points, ReadError, Rows, Scalar, ScalarKind};

/// n × d little-endian values that lie in a file without gaps, starting at some byte.
///
/// Each block is one positioned read to the caller's scratch, so the memory needed is one block per thread,
/// whatever the size of the file, and nothing of the file is counted as memory of the process.
#[derive(Debug)]
pub struct FileSource {
    file: File,
    path: PathBuf,
    offset: u64,
    n: u64,
    dim: usize,
    scalar: ScalarKind,
}

impl FileSource {
    /// Opens `path`, whose values start at byte `offset`.
    ///
    /// # Errors
    /// [`ReadError::Io`] if it cannot be opened, [`ReadError::Truncated`] if it is too short for n points.
    pub fn open(
        path: &Path,
        offset: u64,
        n: u64,
        dim: usize,
        scalar: ScalarKind,
    ) -> Result<Self, ReadError> {
        let file = File::open(path).map_err(|source| ReadError::Io {
            path: path.to_owned(),
            first: 0,
            last: n.saturating_sub(1),
            source,
        })?;
        Self::from_file(file, path, offset, n, dim, scalar)
    }

    /// Takes an open file, whose values start at byte `offset`; `path` is what messages call it.
    ///
    /// The file needs no name any more: an unlinked temporary file is one that nothing can leave behind.
    ///
    /// # Errors
    /// As [`open`](Self::open).
    pub fn from_file(
        file: File,
        path: &Path,
        offset: u64,
        n: u64,
        dim: usize,
        scalar: ScalarKind,
    ) -> Result<Self, ReadError> {
        let io = |source| ReadError::Io {
            path: path.to_owned(),
            first: 0,
            last: n.saturating_sub(1),
            source,
        };
        let found = file.metadata().map_err(io)?.len();
        check_length(path, found, offset, n, dim, scalar)?;
        Ok(FileSource { file, path: path.to_owned(), offset, n, dim, scalar })
    }

    fn read_as<'a, T: Scalar>(
        &self,
        range: Range<u64>,
        scratch: &'a mut Scratch,
    ) -> Result<Rows<'a>, ReadError> {
        let row = (self.dim as u64).saturating_mul(size_of::<T>() as u64);
        let values: &mut [T] = scratch.values(range.end - range.start, self.dim)?;
        read_exact_at(
            &self.file,
            bytemuck::cast_slice_mut(values),
            self.offset + range.start * row,
        )
        .map_err(|source| ReadError::Io {
            path: self.path.clone(),
            first: range.start,
            last: range.end.saturating_sub(1),
            source,
        })?;
        Ok(T::rows(Points::new(values, self.dim).expect("whole rows were read")))
    }
}

/// Refuses a file of `found` bytes that ends before its n points do.
pub(super) fn check_length(
    path: &Path,
    found: u64,
    offset: u64,
    n: u64,
    dim: usize,
    scalar: ScalarKind,
) -> Result<(), ReadError> {
    let needed = n
        .checked_mul(dim as u64)
        .and_then(|values| values.checked_mul(scalar.size() as u64))
        .and_then(|bytes| bytes.checked_add(offset))
        .unwrap_or(u64::MAX);
    if found < needed || dim == 0 {
        return Err(ReadError::Truncated { path: path.to_owned(), found, needed, n, dim });
    }
    Ok(())
}

impl PointSource for FileSource {
    fn len(&self) -> u64 {
        self.n
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
        check_range(&range, self.n)?;
        match self.scalar {
            ScalarKind::F32 => self.read_as::<f32>(range, scratch),
            ScalarKind::F64 => self.read_as::<f64>(range, scratch),
        }
    }
}

#[cfg(target_endian = "big")]
compile_error!(
    "taut reads raw little-endian values in place: big-endian machines are not supported"
);
