//! The rows of the input, read once, and what arithmetic on them may rely on.

use taut_points::parallel::IntoParallel;
use taut_points::{
    BlockHash, Blocks, Monitor, PointSource, PointsHash, ReadError, Rows, Scalar, Scratch,
    hash_block,
};

use super::super::MeshViolation;
use super::signs::Signs;
use crate::arithmetic::parts;
use crate::hashed_pass::all_finite;
use crate::{CheckError, Violation};

pub(crate) struct Input<'a, const D: usize> {
    rows: Rows<'a>,
    pub(crate) hash: PointsHash,
    /// Power of two by which coordinates are multiplied.
    scale: f64,
    signs: Signs,
}

/// What is to be known of a block of rows.
pub(super) struct Block {
    pub(super) hash: BlockHash,
    /// No bit of a coordinate lies below 2^least, none above 2^most.
    pub(super) least: i32,
    pub(super) most: i32,
}

impl Block {
    pub(super) fn of(first: u64, rows: &Rows<'_>) -> Result<Self, Violation> {
        let (least, largest) = match rows {
            Rows::F32(points) => extent(points.values()),
            Rows::F64(points) => extent(points.values()),
        };
        if !f64::from_bits(largest).is_finite() {
            all_finite(first, rows)?;
        }
        let mut most = i32::MIN;
        if largest > 0 {
            let (mantissa, exponent) = parts(f64::from_bits(largest));
            most = exponent + (u64::BITS - mantissa.leading_zeros()) as i32;
        }
        Ok(Block { hash: hash_block(rows), least, most })
    }
}

/// The place of the lowest bit of all values, and the bits of the largest size: more than all others have if any value
/// is not finite.
fn extent<T: Scalar>(values: &[T]) -> (i32, u64) {
    values.iter().fold((i32::MAX, 0), |(least, largest), &value| {
        let x: f64 = value.into();
        (least.min(lowest_bit(x)), largest.max(x.abs().to_bits()))
    })
}

/// The place of the lowest bit of `x`, without a branch.
#[inline(always)]
fn lowest_bit(x: f64) -> i32 {
    let bits = x.to_bits();
    let field = (bits >> 52 & 0x7ff) as i32;
    let mantissa = bits & ((1 << 52) - 1) | u64::from(field != 0) << 52;
    let place = field.max(1) - 1075 + mantissa.trailing_zeros() as i32;
    if mantissa == 0 { i32::MAX } else { place }
}

impl<'a, const D: usize> Input<'a, D> {
    /// One pass. Rows that are not in memory are read to `scratch`.
    pub(crate) fn read(
        source: &'a dyn PointSource,
        scratch: &'a mut Scratch,
        monitor: &Monitor<'_>,
    ) -> Result<Self, CheckError> {
        let n = source.len();
        // The largest number is free to mean none.
        if n >= u64::from(u32::MAX) {
            return Err(MeshViolation::TooMany { rows: n }.into());
        }
        monitor.pass(1, n);
        let blocks = Blocks::of(source);
        let rows = source.read(0..n, scratch)?;
        let read = |block: u64| {
            monitor.check().map_err(ReadError::from)?;
            let range = blocks.range(block);
            let some = range.start as usize..range.end as usize;
            let part = match &rows {
                Rows::F32(points) => Rows::F32(points.slice(some)),
                Rows::F64(points) => Rows::F64(points.slice(some)),
            };
            let block = Block::of(range.start, &part)?;
            monitor.points(part.len() as u64);
            Ok::<_, CheckError>(block)
        };
        let blocks: Vec<_> = (0..blocks.count()).into_par_iter().map(read).collect();
        // The first violation by position, whichever thread met it.
        let blocks = blocks.into_iter().collect::<Result<Vec<Block>, CheckError>>()?;
        let hash = PointsHash::of_blocks(n, source.dim(), blocks.iter().map(|b| b.hash));
        let least = blocks.iter().map(|b| b.least).min().unwrap_or(i32::MAX);
        let most = blocks.iter().map(|b| b.most).max().unwrap_or(i32::MIN);
        let (scale, signs) = scaling(least, most);
        Ok(Input { rows, hash, scale, signs })
    }

    /// Rows of which the hash, the power of two and the signs are known.
    pub(super) fn of_rows(rows: Rows<'a>, hash: PointsHash, scale: f64, signs: Signs) -> Self {
        Input { rows, hash, scale, signs }
    }

    pub(crate) fn len(&self) -> usize {
        self.rows.len()
    }

    /// A row. Adding 0 turns −0 into 0 and leaves every other value as it is.
    #[inline(always)]
    pub(crate) fn row(&self, row: u32) -> [f64; D] {
        let at = row as usize * D;
        match &self.rows {
            Rows::F32(points) => {
                let values = &points.values()[at..at + D];
                std::array::from_fn(|k| f64::from(values[k]) + 0.0)
            }
            Rows::F64(points) => {
                let values = &points.values()[at..at + D];
                std::array::from_fn(|k| values[k] + 0.0)
            }
        }
    }

    /// The signs of determinants of rows that went through [`Input::scaled`].
    pub(crate) fn signs(&self) -> Signs {
        self.signs
    }

    /// The power of two by which [`Input::scaled`] multiplies.
    pub(crate) fn scale(&self) -> f64 {
        self.scale
    }

    /// A row, multiplied by the power of two.
    #[inline(always)]
    pub(crate) fn scaled(&self, row: &[f64; D]) -> [f64; D] {
        row.map(|x| x * self.scale)
    }

    /// Dimension of the affine hull. O(n).
    pub(crate) fn hull_dimension(&self) -> Option<u8> {
        if self.rows.is_empty() {
            return None;
        }
        let mut rows = 0..self.len() as u32;
        let Some(second) = rows.find(|&row| self.row(row) != self.row(0)) else {
            return Some(0);
        };
        let at = |row: u32| self.scaled(&self.row(row));
        let (a, b) = (at(0), at(second));
        let Some(third) = rows.find(|&row| self.axes(&a, &b, &at(row)).is_some()) else {
            return Some(1);
        };
        let c = at(third);
        let is_beside = |row: u32| {
            let mut tetrahedron = [[0.0; 3]; 4];
            for (to, from) in tetrahedron.iter_mut().zip([a, b, c, at(row)]) {
                to[..D].copy_from_slice(&from);
            }
            self.signs.orientation::<super::geometry::Tetrahedra, 3, 4>(&tetrahedron).is_ne()
        };
        Some(if D == 3 && rows.any(is_beside) { 3 } else { 2 })
    }

    /// The first two coordinates, in the order xy, xz, yz, in which three points are not on a line.
    pub(crate) fn axes(&self, a: &[f64; D], b: &[f64; D], c: &[f64; D]) -> Option<[usize; 2]> {
        let pairs = [[0, 1], [0, 2], [1, 2]];
        let pairs = if D == 2 { &pairs[..1] } else { &pairs[..] };
        pairs.iter().copied().find(|&axes| turn(&self.signs, a, b, c, axes).is_ne())
    }
}

/// The orientation of three points in two coordinates.
pub(crate) fn turn<const D: usize>(
    signs: &Signs,
    a: &[f64; D],
    b: &[f64; D],
    c: &[f64; D],
    [i, j]: [usize; 2],
) -> std::cmp::Ordering {
    let flat = [a, b, c].map(|p| [p[i], p[j]]);
    signs.orientation::<super::geometry::Triangles, 2, 3>(&flat)
}

/// The factor for coordinates whose bits lie between 2^least and 2^most.
pub(super) fn scaling(least: i32, most: i32) -> (f64, Signs) {
    if least > most {
        // All coordinates are 0.
        return (1.0, Signs { is_filtered: true, quantum: 1.0 });
    }
    // Powers of two that are themselves f64, and 2^−1024, which is subnormal: multiplying is exact all the same.
    let shift = (-most).clamp(-1024, 1000);
    if least + shift < -1074 {
        return (1.0, Signs { is_filtered: false, quantum: 0.0 });
    }
    let quantum = if least + shift >= -200 { power(least + shift) } else { 0.0 };
    (power(shift), Signs { is_filtered: true, quantum })
}

/// 2ᵏ for −1074 ≤ k ≤ 1023.
fn power(k: i32) -> f64 {
    match k {
        ..-1022 => f64::from_bits(1 << (k + 1074)),
        _ => f64::from_bits(((k + 1023) as u64) << 52),
    }
}
