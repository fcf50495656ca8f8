//! The borrowed view of points in memory.

use bytemuck::Pod;

use crate::{Error, InputError};

mod sealed {
    pub trait Sealed {}
    impl Sealed for f32 {}
    impl Sealed for f64 {}
}

/// A coordinate: `f32` or `f64`. High-dimensional passes read either and calculate in `f64`.
pub trait Scalar:
    sealed::Sealed + Pod + Into<f64> + PartialOrd + Send + Sync + std::fmt::Display
{
    /// Which of the two it is.
    const KIND: ScalarKind;
    /// The coordinate nearest to `value`.
    fn from_f64(value: f64) -> Self;
    /// Wraps a view in the variant of [`Rows`] that fits its coordinate.
    fn rows(points: Points<'_, Self>) -> Rows<'_>;
}

impl Scalar for f32 {
    const KIND: ScalarKind = ScalarKind::F32;
    fn from_f64(value: f64) -> Self {
        value as f32
    }
    fn rows(points: Points<'_, Self>) -> Rows<'_> {
        Rows::F32(points)
    }
}

impl Scalar for f64 {
    const KIND: ScalarKind = ScalarKind::F64;
    fn from_f64(value: f64) -> Self {
        value
    }
    fn rows(points: Points<'_, Self>) -> Rows<'_> {
        Rows::F64(points)
    }
}

/// The way in which the coordinates of a source are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ScalarKind {
    /// IEEE 754 single precision.
    F32,
    /// IEEE 754 double precision.
    F64,
}

impl ScalarKind {
    /// Bytes of one coordinate.
    pub const fn size(self) -> usize {
        match self {
            ScalarKind::F32 => 4,
            ScalarKind::F64 => 8,
        }
    }
}

impl std::fmt::Display for ScalarKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(match self {
            ScalarKind::F32 => "f32",
            ScalarKind::F64 => "f64",
        })
    }
}

/// A borrowed n × d view of points, row-major and without gaps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Points<'a, T> {
    values: &'a [T],
    dim: usize,
}

impl<'a, T: Scalar> Points<'a, T> {
    /// Views `values` as points of dimension `dim`: row i is `values[i·dim .. (i+1)·dim]`. No values are no points.
    ///
    /// # Errors
    /// [`Error::ZeroDimension`], and [`Error::Ragged`] when a point would be cut short.
    pub fn new(values: &'a [T], dim: usize) -> Result<Self, Error> {
        if dim == 0 {
            return Err(Error::ZeroDimension);
        }
        match values.len() % dim {
            0 => Ok(Points { values, dim }),
            rest => Err(Error::Ragged { values: values.len(), dim, rest }),
        }
    }

    /// Number of points, n.
    pub fn len(&self) -> usize {
        self.values.len() / self.dim
    }

    /// Returns true if there is no point at all.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// Dimension, d.
    pub fn dim(&self) -> usize {
        self.dim
    }

    /// All n·d values, row after row.
    pub fn values(&self) -> &'a [T] {
        self.values
    }

    /// The d coordinates of point `i`.
    ///
    /// # Panics
    /// When `i ≥ n`.
    #[inline]
    pub fn row(&self, i: usize) -> &'a [T] {
        &self.values[i * self.dim..(i + 1) * self.dim]
    }

    /// The points in order.
    pub fn rows(&self) -> std::slice::ChunksExact<'a, T> {
        self.values.chunks_exact(self.dim)
    }

    /// The points `range.start..range.end` as a view of their own.
    ///
    /// # Panics
    /// When the range reaches beyond n.
    pub fn slice(&self, range: std::ops::Range<usize>) -> Points<'a, T> {
        Points { values: &self.values[range.start * self.dim..range.end * self.dim], dim: self.dim }
    }
}

/// Some points of a source, in the precision in which it keeps them.
#[derive(Clone, Copy, Debug)]
pub enum Rows<'a> {
    /// Single precision.
    F32(Points<'a, f32>),
    /// Double precision.
    F64(Points<'a, f64>),
}

impl Rows<'_> {
    /// Number of points.
    pub fn len(&self) -> usize {
        match self {
            Rows::F32(points) => points.len(),
            Rows::F64(points) => points.len(),
        }
    }

    /// Returns true if there is no point.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Copies point `i` to `out`, widened to `f64`.
    ///
    /// # Panics
    /// When `i` is not below [`len`](Self::len) or `out` is not of length d.
    pub fn copy_row(&self, i: usize, out: &mut [f64]) {
        match self {
            Rows::F32(points) => {
                let row = points.row(i);
                assert_eq!(row.len(), out.len());
                for (o, &v) in out.iter_mut().zip(row) {
                    *o = v.into();
                }
            }
            Rows::F64(points) => out.copy_from_slice(points.row(i)),
        }
    }

    /// Refuses a coordinate that is NaN or infinite; `first_row` is the number of the first of these rows.
    ///
    /// # Errors
    /// [`InputError::NonFinite`] for the first of them.
    pub fn check_finite(&self, first_row: u64) -> Result<(), InputError> {
        match self.first_non_finite() {
            None => Ok(()),
            Some((row, column, value)) => {
                Err(InputError::NonFinite { row: first_row + row as u64, column, value })
            }
        }
    }

    /// The first coordinate that is NaN or infinite, as (row, column, value).
    pub fn first_non_finite(&self) -> Option<(usize, usize, f64)> {
        fn find<T: Scalar>(points: &Points<'_, T>) -> Option<(usize, usize, f64)> {
            /// Tested without a branch for each.
            const CHUNK_VALUES: usize = 64;
            let is_finite = |&value: &T| value.into().is_finite();
            let all = |values: &[T]| values.iter().fold(true, |all, value| all & is_finite(value));
            let chunk = points.values().chunks(CHUNK_VALUES).position(|values| !all(values))?;
            let at =
                points.values()[chunk * CHUNK_VALUES..].iter().position(|value| !is_finite(value));
            let at = chunk * CHUNK_VALUES + at?;
            Some((at / points.dim(), at % points.dim(), points.values()[at].into()))
        }
        match self {
            Rows::F32(points) => find(points),
            Rows::F64(points) => find(points),
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::{Points, Scalar};

    fn first<T: Scalar>(values: &[T]) -> Option<(usize, usize)> {
        let points = Points::new(values, 1).unwrap();
        T::rows(points).first_non_finite().map(|(row, column, _)| (row, column))
    }

    #[test]
    fn the_first_value_that_is_not_finite_is_found_anywhere() {
        for n in [1usize, 63, 64, 65, 200] {
            let mut values: Vec<f64> = (0..n).map(|i| i as f64 * 1e300).collect();
            assert_eq!(first(&values), None);
            for at in 0..n {
                let finite = values[at];
                for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                    values[at] = bad;
                    values[n - 1] = if at + 1 < n { f64::NAN } else { bad };
                    assert_eq!(first(&values), Some((at, 0)), "{n}");
                }
                values[n - 1] = (n - 1) as f64 * 1e300;
                values[at] = finite;
            }
        }
        assert_eq!(first(&[1.0f32, f32::MAX, f32::INFINITY]), Some((2, 0)));
        let pairs = Points::new(&[0.0, 1.0, 2.0, f64::NAN], 2).unwrap();
        let (row, column, value) = f64::rows(pairs).first_non_finite().unwrap();
        assert!((row, column) == (1, 1) && value.is_nan());
    }
}
