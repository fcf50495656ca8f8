//! The units in which squared distances between rows neither overflow nor vanish, and the pass that finds them.
//!
//! *Problem.* Squares overflow beyond 1e154 and vanish below 1e-162.
//! *Idea.* Where the largest extent of the points along an axis is near either end, coordinates are multiplied by the power
//! of two that brings it to about 1, which is exact. A column whose values are all equal is taken away first: it is the only
//! one that can still be too large, since any other has an extent of at least 2⁻⁵³ of its values.
//! *Guarantee.* Between 2⁻⁴⁵⁰ and 2⁴⁰⁰, in these units, a squared distance has the error of the kernel and no other.
//! *Trap.* What is smaller than 2⁻⁴⁵⁰ in these units squares to little or nothing: [`SQUARE_MIN`] is where a caller has to look
//! twice.

use taut_points::{
    BlockHash, ByteReader, ByteWriter, Monitor, PartsError, PointSource, Points, PointsHash, Rows,
    Scalar, exponent_of, gather, hash_block, map_blocks, two_to,
};

use crate::Error;
use crate::passes::ask_extent;

/// Extents between 2⁻²⁰⁰ and 2²⁰⁰ are left as they are.
const SAFE_EXPONENT: i32 = 200;

/// 2⁻⁹⁰⁰: squared distances below it have lost digits.
pub(crate) const SQUARE_MIN: f64 = two_to(-900);

/// The way in which coordinates are brought to the units of a calculation.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Frame {
    scale: f64,
    /// The vector that is subtracted before scaling: the value of a column that has but one, else 0. Empty where nothing is done.
    shift: Vec<f64>,
}

/// The result of a pass over all rows.
pub(crate) struct FramePass {
    pub(crate) frame: Frame,
    pub(crate) hash: PointsHash,
}

impl Frame {
    fn of(Extent { low, high }: &Extent) -> Self {
        // Halved, as the difference itself may overflow.
        let half = low.iter().zip(high).fold(0.0, |h: f64, (l, u)| h.max(u / 2.0 - l / 2.0));
        let extent = if half < 1.0 {
            low.iter().zip(high).fold(0.0, |e: f64, (l, u)| e.max(u - l))
        } else {
            half
        };
        if extent == 0.0 || exponent_of(extent).abs() <= SAFE_EXPONENT {
            return Frame { scale: 1.0, shift: vec![] };
        }
        let scale = two_to((-exponent_of(extent)).clamp(-1020, 1000));
        let shift = low.iter().zip(high).map(|(&l, &u)| if l == u { l } else { 0.0 }).collect();
        Frame { scale, shift }
    }

    pub(crate) fn write(&self, bytes: &mut ByteWriter) {
        bytes.float(self.scale);
        bytes.floats(&self.shift);
    }

    pub(crate) fn read(bytes: &mut ByteReader<'_>, columns: usize) -> Result<Self, PartsError> {
        let frame = Frame { scale: bytes.float()?, shift: bytes.floats()? };
        let fits = frame.is_plain() || frame.shift.len() == columns;
        if fits { Ok(frame) } else { Err(bytes.wrong()) }
    }

    /// Returns true if coordinates stay what they are.
    pub(crate) fn is_plain(&self) -> bool {
        self.shift.is_empty()
    }

    /// Brings rows to the units of this frame.
    pub(crate) fn bring_in(&self, rows: &mut [f64]) {
        if self.is_plain() {
            return;
        }
        for row in rows.chunks_exact_mut(self.shift.len()) {
            for (value, shift) in row.iter_mut().zip(&self.shift) {
                *value = (*value - shift) * self.scale;
            }
        }
    }

    /// All of `points` in the units of this frame.
    pub(crate) fn copy<T: Scalar>(&self, points: &Points<'_, T>) -> Vec<f64> {
        let mut rows: Vec<f64> = points.values().iter().map(|&v| v.into()).collect();
        self.bring_in(&mut rows);
        rows
    }

    /// A length in the units of the source.
    ///
    /// # Errors
    /// [`Error::Overflow`] where it is longer than the largest number.
    pub(crate) fn bring_out(&self, length: f64) -> Result<f64, Error> {
        let length = length / self.scale;
        if length.is_finite() { Ok(length) } else { Err(Error::Overflow) }
    }

    /// Rows of the source by number, in these units.
    pub(crate) fn gather(&self, source: &dyn PointSource, ids: &[u64]) -> Result<Vec<f64>, Error> {
        let mut rows = gather(source, ids)?;
        self.bring_in(&mut rows);
        Ok(rows)
    }
}

/// One pass: the hash of the rows, and the frame in which to measure them.
///
/// # Errors
/// [`Error::Empty`], [`Error::Input`].
pub(crate) fn frame_pass(
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
) -> Result<FramePass, Error> {
    if source.is_empty() {
        return Err(Error::Empty);
    }
    monitor.pass(1, source.len());
    let (extent, hash) = match source.elsewhere() {
        Some(elsewhere) => ask_extent(elsewhere, source)?,
        None => {
            let (extent, hashes) = extent_and_hashes(source, monitor)?;
            (extent, PointsHash::of_blocks(source.len(), source.dim(), hashes))
        }
    };
    Ok(FramePass { frame: Frame::of(&extent), hash })
}

/// The least and the greatest value of each column.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Extent {
    pub(crate) low: Vec<f64>,
    pub(crate) high: Vec<f64>,
}

impl Extent {
    /// That of no rows.
    fn nothing(dim: usize) -> Self {
        Extent { low: vec![f64::INFINITY; dim], high: vec![f64::NEG_INFINITY; dim] }
    }

    pub(crate) fn merge(&mut self, other: &Extent) {
        self.low.iter_mut().zip(&other.low).for_each(|(l, &b)| *l = l.min(b));
        self.high.iter_mut().zip(&other.high).for_each(|(h, &b)| *h = h.max(b));
    }
}

/// The extent of rows, which have to be finite, and the hashes of their blocks.
pub(crate) fn extent_and_hashes(
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
) -> Result<(Extent, Vec<BlockHash>), Error> {
    let blocks = survey_blocks(source, monitor, |_| ())?;
    let mut all = Extent::nothing(source.dim());
    blocks.iter().for_each(|block| all.merge(&block.extent));
    Ok((all, blocks.into_iter().map(|block| block.hash).collect()))
}

/// The hash of a block, the least and the greatest value of each column, and what else was asked for.
pub(crate) struct SurveyedBlock<R> {
    pub(crate) hash: BlockHash,
    extent: Extent,
    pub(crate) more: R,
}

/// The blocks of finite rows, with something more done to each.
pub(crate) fn survey_blocks<R: Send>(
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
    more: impl Fn(&Rows<'_>) -> R + Sync,
) -> Result<Vec<SurveyedBlock<R>>, Error> {
    map_blocks(source, monitor, |first, rows| {
        let ((low, high), finite) = match &rows {
            Rows::F32(points) => extent(points),
            Rows::F64(points) => extent(points),
        };
        if !finite {
            rows.check_finite(first)?;
        }
        let extent = Extent { low, high };
        Ok(SurveyedBlock { hash: hash_block(&rows), extent, more: more(&rows) })
    })
}

/// The least and the greatest value of each column, and whether all values are finite.
fn extent<T: Scalar>(points: &Points<'_, T>) -> ((Vec<f64>, Vec<f64>), bool) {
    match points.dim() {
        1 => extent_of::<T, 1>(points),
        2 => extent_of::<T, 2>(points),
        3 => extent_of::<T, 3>(points),
        dim => {
            let first = points.row(0);
            let (mut low, mut high) = (first.to_vec(), first.to_vec());
            let mut bits = 0;
            for row in points.rows() {
                for j in 0..dim {
                    bits |= bits_if_odd(row[j]);
                    low[j] = if row[j] < low[j] { row[j] } else { low[j] };
                    high[j] = if row[j] > high[j] { row[j] } else { high[j] };
                }
            }
            let wide = |values: Vec<T>| values.into_iter().map(Into::into).collect();
            ((wide(low), wide(high)), bits << 1 == 0)
        }
    }
}

/// The same where a row fits into registers.
fn extent_of<T: Scalar, const D: usize>(points: &Points<'_, T>) -> ((Vec<f64>, Vec<f64>), bool) {
    let rows = points.values().as_chunks::<D>().0;
    let (mut low, mut high, mut bits) = (rows[0], rows[0], 0);
    for row in rows {
        for j in 0..D {
            bits |= bits_if_odd(row[j]);
            low[j] = if row[j] < low[j] { row[j] } else { low[j] };
            high[j] = if row[j] > high[j] { row[j] } else { high[j] };
        }
    }
    ((low.map(Into::into).to_vec(), high.map(Into::into).to_vec()), bits << 1 == 0)
}

/// Has a bit other than the sign where `value` is infinite or no number: times 0 it is NaN, and others are 0.
#[inline(always)]
fn bits_if_odd<T: Scalar>(value: T) -> u64 {
    (value.into() * 0.0).to_bits()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame_of(values: &[f64], dim: usize) -> Frame {
        frame_pass(&Points::new(values, dim).unwrap(), &Monitor::silent()).unwrap().frame
    }

    #[test]
    fn ordinary_sizes_are_left_alone() {
        for values in [[0.0, 1.0, 2.0], [1e30, -1e30, 0.0], [1e300, 1e300, 1e300]] {
            assert!(frame_of(&values, 1).is_plain(), "{values:?}");
        }
    }

    #[test]
    fn large_and_small_extents_come_to_about_one() {
        let largest = f64::MAX;
        for size in [5e-324, 1e-300, 1e-100, 1e100, 1e300, largest] {
            let values = [-size, size, 0.0, size];
            let frame = frame_of(&values, 2);
            let mut rows = values;
            frame.bring_in(&mut rows);
            let wide = rows[2] - rows[0];
            assert!((1e-30..32.0).contains(&wide) && (wide > 0.25 || size < 1e-300), "{size}");
            assert_eq!(rows[1], 0.0, "a column of one value is taken away");
            assert_eq!(frame.bring_out(wide / 2.0).unwrap(), size / 2.0);
        }
        let frame = frame_of(&[-largest, largest], 1);
        assert!(matches!(frame.bring_out(16.0), Err(Error::Overflow)));
    }

    #[test]
    fn the_first_coordinate_that_is_no_number_is_named() {
        for dim in [1, 2, 3, 5] {
            let mut values = vec![1.0f32; 7 * dim];
            values[4 * dim] = f32::INFINITY;
            values[5 * dim] = f32::NAN;
            let found = frame_pass(&Points::new(&values, dim).unwrap(), &Monitor::silent());
            assert!(
                matches!(
                    found,
                    Err(Error::Input(taut_points::InputError::NonFinite { row: 4, column: 0, .. }))
                ),
                "{dim}"
            );
        }
    }
}
