//! Raw values in a file that is mapped into memory: no copy, for files that fit.

use std::fs::File;
use std::ops::Range;
use std::path::Path;

use memmap2::Mmap;

use super::file::check_length;
use super::{PointSource, Scratch, check_range};
use crate::{Points, ReadError, Rows, Scalar, ScalarKind};

/// n × d little-endian values of a mapped file, starting at some byte; blocks are borrowed from the map.
///
/// Prefer [`FileSource`](super::FileSource) for files larger than memory: mapped pages count as memory of the
/// process. When the values are not aligned for their type, blocks are copied to the scratch instead.
#[derive(Debug)]
pub struct MappedSource {
    map: Mmap,
    offset: usize,
    n: u64,
    dim: usize,
    scalar: ScalarKind,
}

impl MappedSource {
    /// Maps `path`, whose values start at byte `offset`. The file must not change while the source lives.
    ///
    /// # Errors
    /// [`ReadError::Io`] if it cannot be opened or mapped, [`ReadError::Truncated`] if it is too short.
    pub fn open(
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
        let file = File::open(path).map_err(io)?;
        check_length(path, file.metadata().map_err(io)?.len(), offset, n, dim, scalar)?;
        // SAFETY: the map is private to this struct and only ever read. As with every map of a file, another
        // process that shortens the file while we read it ends this one with a signal; the docs say so.
        #[allow(unsafe_code)]
        let map = unsafe { Mmap::map(&file) }.map_err(io)?;
        Ok(MappedSource { map, offset: offset as usize, n, dim, scalar })
    }

    fn view<'a, T: Scalar>(&'a self, range: Range<u64>, scratch: &'a mut Scratch) -> Rows<'a> {
        let row = self.dim * size_of::<T>();
        let bytes = &self.map
            [self.offset + range.start as usize * row..self.offset + range.end as usize * row];
        let values: &[T] = match bytemuck::try_cast_slice(bytes) {
            Ok(values) => values,
            Err(_) => {
                let values = scratch.values::<T>(bytes.len() / size_of::<T>());
                bytemuck::cast_slice_mut::<T, u8>(values).copy_from_slice(bytes);
                values
            }
        };
        T::rows(Points::new(values, self.dim).expect("whole rows were cut"))
    }
}

impl PointSource for MappedSource {
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
        Ok(match self.scalar {
            ScalarKind::F32 => self.view::<f32>(range, scratch),
            ScalarKind::F64 => self.view::<f64>(range, scratch),
        })
    }
}
