//! Where points come from: memory, a mapped file, or a file larger than memory, behind one trait.
//!
//! A [`PointSource`] hands out any range of rows, as often as asked, from any thread. That is all a streaming
//! algorithm of taut needs: it reads fixed blocks, keeps what it needs of each, and rereads a row by its number.

mod file;
mod mapped;
mod owned;
mod picked;
mod positioned;

use std::ops::Range;

pub use file::FileSource;
pub use mapped::MappedSource;
pub use owned::OwnedPoints;
pub use picked::PickedColumns;
pub use positioned::{read_at, read_exact_at, write_all_at, write_at};

use crate::room::try_reserve_exact;
use crate::{Elsewhere, Points, ReadError, Rows, Scalar, ScalarKind};

/// A rewindable set of n points of dimension d, read a range of rows at a time.
///
/// Implementations are shared between threads; reading the same rows twice must give the same values.
pub trait PointSource: Send + Sync {
    /// Number of points, n.
    fn len(&self) -> u64;

    /// Returns true if there is no point at all.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Dimension, d ≥ 1.
    fn dim(&self) -> usize;

    /// Returns how coordinates are stored.
    fn scalar(&self) -> ScalarKind;

    /// The points `range.start..range.end`: borrowed where they already are in memory, else read to `scratch`.
    ///
    /// # Errors
    /// [`ReadError::OutOfRange`], or what the medium says.
    fn read<'a>(
        &'a self,
        range: Range<u64>,
        scratch: &'a mut Scratch,
    ) -> Result<Rows<'a>, ReadError>;

    /// All rows, where the program holds them in its own memory; `None` for files, mapped or not, and for generators.
    fn in_memory(&self) -> Option<Rows<'_>> {
        None
    }

    /// Those who hold the rows, where they are held elsewhere and in parts.
    fn elsewhere(&self) -> Option<&dyn Elsewhere> {
        None
    }
}

/// Memory that a source may read to; keep one per thread and pass it again.
#[derive(Default)]
pub struct Scratch {
    // u64 words, so that a view as f32 or f64 is always aligned.
    words: Vec<u64>,
}

impl Scratch {
    /// An empty scratch; it grows to the largest block asked of it.
    pub fn new() -> Self {
        Self::default()
    }

    /// Room for the coordinates of `rows` points of dimension `dim`, with whatever they held before.
    ///
    /// # Errors
    /// [`ReadError::TooLarge`] when there is no memory for them.
    pub fn values<T: Scalar>(&mut self, rows: u64, dim: usize) -> Result<&mut [T], ReadError> {
        let too_large = || ReadError::TooLarge { rows, dim };
        let count = usize::try_from(rows).ok().and_then(|rows| rows.checked_mul(dim));
        let bytes = count.and_then(|count| count.checked_mul(size_of::<T>()));
        let (count, bytes) = count.zip(bytes).ok_or_else(too_large)?;
        let wanted = bytes.div_ceil(8);
        if wanted > self.words.len() {
            let more = wanted - self.words.len();
            try_reserve_exact(&mut self.words, more).map_err(|_| too_large())?;
            self.words.resize(wanted, 0);
        }
        Ok(&mut bytemuck::cast_slice_mut(&mut self.words)[..count])
    }
}

pub(crate) fn check_range(range: &Range<u64>, n: u64) -> Result<(), ReadError> {
    if range.start <= range.end && range.end <= n {
        Ok(())
    } else {
        Err(ReadError::OutOfRange { first: range.start, end: range.end, n })
    }
}

impl<T: Scalar> PointSource for Points<'_, T> {
    fn len(&self) -> u64 {
        Points::len(self) as u64
    }

    fn dim(&self) -> usize {
        Points::dim(self)
    }

    fn scalar(&self) -> ScalarKind {
        T::KIND
    }

    fn read<'a>(&'a self, range: Range<u64>, _: &'a mut Scratch) -> Result<Rows<'a>, ReadError> {
        check_range(&range, Points::len(self) as u64)?;
        Ok(T::rows(self.slice(range.start as usize..range.end as usize)))
    }

    fn in_memory(&self) -> Option<Rows<'_>> {
        Some(T::rows(*self))
    }
}

impl<S: PointSource + ?Sized> PointSource for &S {
    fn len(&self) -> u64 {
        (**self).len()
    }

    fn dim(&self) -> usize {
        (**self).dim()
    }

    fn scalar(&self) -> ScalarKind {
        (**self).scalar()
    }

    fn read<'a>(
        &'a self,
        range: Range<u64>,
        scratch: &'a mut Scratch,
    ) -> Result<Rows<'a>, ReadError> {
        (**self).read(range, scratch)
    }

    fn in_memory(&self) -> Option<Rows<'_>> {
        (**self).in_memory()
    }

    fn elsewhere(&self) -> Option<&dyn Elsewhere> {
        (**self).elsewhere()
    }
}

/// Copies the points with the given numbers, in that order, widened to `f64`: `ids.len()` × d, row-major.
///
/// # Errors
/// The error of [`PointSource::read`].
pub fn gather(source: &dyn PointSource, ids: &[u64]) -> Result<Vec<f64>, ReadError> {
    if let Some(elsewhere) = source.elsewhere() {
        return elsewhere.rows(ids);
    }
    let dim = source.dim();
    let (mut scratch, mut out) = (Scratch::new(), Vec::new());
    let too_large = || ReadError::TooLarge { rows: ids.len() as u64, dim };
    let count = ids.len().checked_mul(dim).ok_or_else(too_large)?;
    try_reserve_exact(&mut out, count).map_err(|_| too_large())?;
    match source.in_memory() {
        Some(Rows::F32(points)) => gather_in_memory(&points, ids, &mut out)?,
        Some(Rows::F64(points)) => gather_in_memory(&points, ids, &mut out)?,
        None => {
            out.resize(count, 0.0);
            for (&id, row) in ids.iter().zip(out.chunks_exact_mut(dim)) {
                source.read(id..id.saturating_add(1), &mut scratch)?.copy_row(0, row);
            }
        }
    }
    Ok(out)
}

/// Appends rows that are in memory. A processor has few copies in flight, so that rows copied one by one wait for memory one after the other;
/// the ends of some rows are read first, which overlaps their cache misses. 4096 of 10⁵ rows of ten coordinates take a sixth of the time.
fn gather_in_memory<T: Scalar>(
    points: &Points<'_, T>,
    ids: &[u64],
    out: &mut Vec<f64>,
) -> Result<(), ReadError> {
    /// Their ends, two cache lines each, stay in the first cache.
    const ROWS_TOUCHED: usize = 64;
    let len = points.len() as u64;
    for ids in ids.chunks(ROWS_TOUCHED) {
        let mut ends = 0.0;
        for &id in ids {
            check_range(&(id..id.saturating_add(1)), len)?;
            let row = points.row(id as usize);
            ends += row[0].into() + row[row.len() - 1].into();
        }
        std::hint::black_box(ends);
        for &id in ids {
            out.extend(points.row(id as usize).iter().map(|&x| x.into()));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gathered_rows_are_those_that_are_read() {
        for (n, dim) in [(1, 1), (200, 1), (150, 3), (40, 70)] {
            let values: Vec<f32> = (0..n * dim).map(|at| at as f32 + 0.1).collect();
            let wide: Vec<f64> = values.iter().map(|&value| value.into()).collect();
            let narrow = Points::new(&values, dim).unwrap();
            let ids: Vec<u64> = (0..3 * n as u64).map(|k| k * 7919 % n as u64).collect();
            let rows = ids.iter().flat_map(|&id| &wide[id as usize * dim..][..dim]);
            let expected: Vec<f64> = rows.copied().collect();
            assert_eq!(gather(&narrow, &ids).unwrap(), expected, "{n} × {dim}");
            let points = Points::new(&wide, dim).unwrap();
            assert_eq!(gather(&points, &ids).unwrap(), expected, "{n} × {dim}");
            assert!(gather(&points, &[]).unwrap().is_empty());
            for beyond in [n as u64, u64::MAX] {
                let refused = gather(&points, &[0, beyond]);
                assert!(matches!(refused, Err(ReadError::OutOfRange { .. })), "{refused:?}");
            }
        }
    }
}
