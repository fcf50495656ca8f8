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
///
/// *Trap.* Whoever opens a map promises that nobody changes the file while the source lives: this cannot be checked.
/// If another process writes to the file all the same, the values are undefined and so is what follows from them; if
/// it shortens the file, the operating system ends this process with a signal. Where that cannot be promised, use
/// [`FileSource`](super::FileSource), which only reports an error.
#[derive(Debug)]
pub struct MappedSource {
    map: Mmap,
    offset: usize,
    n: u64,
    dim: usize,
    scalar: ScalarKind,
}

impl MappedSource {
    /// Maps `path`, whose values start at byte `offset`. The caller promises that the file does not
    /// change while the source lives; what happens if it does is said at [`MappedSource`].
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
        // SAFETY: the map is private to this struct and only ever read here. That its bytes do not change under a
        // borrowed slice cannot be seen to from here: soundness rests on the promise that the docs of this function
        // and of the struct demand of the caller.
        #[allow(unsafe_code)]
        let map = unsafe { Mmap::map(&file) }.map_err(io)?;
        Ok(MappedSource { map, offset: offset as usize, n, dim, scalar })
    }

    fn view<'a, T: Scalar>(
        &'a self,
        range: Range<u64>,
        scratch: &'a mut Scratch,
    ) -> Result<Rows<'a>, ReadError> {
        let row = self.dim.saturating_mul(size_of::<T>());
        let bytes = &self.map
            [self.offset + range.start as usize * row..self.offset + range.end as usize * row];
        let values: &[T] = match bytemuck::try_cast_slice(bytes) {
            Ok(values) => values,
            Err(_) => {
                let values = scratch.values::<T>(range.end - range.start, self.dim)?;
                bytemuck::cast_slice_mut::<T, u8>(values).copy_from_slice(bytes);
                values
            }
        };
        Ok(T::rows(Points::new(values, self.dim).expect("whole rows were cut")))
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
        match self.scalar {
            ScalarKind::F32 => self.view::<f32>(range, scratch),
            ScalarKind::F64 => self.view::<f64>(range, scratch),
        }
    }
}
