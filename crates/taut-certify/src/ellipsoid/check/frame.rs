//! The map x ↦ y = F(x − c) that takes the ellipsoid to the unit ball, scaled so that nothing over- or underflows.
//!
//! F and x − c are taken as F/s and (x − c)·s for the power of two s that brings the largest entry of F to [1, 2):
//! exactly, but for what underflows beside 1.

use std::ops::Range;

use super::super::Ellipsoid;
use super::enclosure::FAR_OUT;
use crate::arithmetic::{Field, U};

/// More than what underflow can add to a sum of products.
const UNDERFLOW: f64 = f64::from_bits((1023 - 900) << 52);

/// F, c and s.
pub(crate) struct Frame<'a> {
    pub(crate) dim: usize,
    pub(crate) rank: usize,
    pub(crate) center: &'a [f64],
    center_tail: &'a [f64],
    /// F/s by rows.
    factor: Vec<f64>,
    /// In which columns each row of F has its entries other than 0.
    spans: Vec<Range<usize>>,
    /// s.
    pub(crate) scale: f64,
}

impl<'a> Frame<'a> {
    pub(crate) fn of(ellipsoid: &'a Ellipsoid) -> Self {
        let rows = &ellipsoid.factor;
        let largest = rows.iter().flatten().fold(0.0f64, |m, v| m.max(v.abs()));
        let scale = power_of_two_below(largest);
        let span = |row: &Vec<f64>| {
            let first = row.iter().position(|&v| v != 0.0).unwrap_or(0);
            first..row.iter().rposition(|&v| v != 0.0).map_or(first, |last| last + 1)
        };
        Frame {
            dim: ellipsoid.center.len(),
            rank: rows.len(),
            center: &ellipsoid.center,
            center_tail: &ellipsoid.center_tail,
            factor: rows.iter().flatten().map(|v| v / scale).collect(),
            spans: rows.iter().map(span).collect(),
            scale,
        }
    }

    /// The row of F/s between its outermost entries other than 0, and where that is.
    #[inline(always)]
    pub(crate) fn row(&self, a: usize) -> (&[f64], Range<usize>) {
        let span = self.spans[a].clone();
        let start = a * self.dim;
        (&self.factor[start + span.start..start + span.end], span)
    }

    /// The whole row of F/s.
    pub(crate) fn full_row(&self, a: usize) -> &[f64] {
        &self.factor[a * self.dim..(a + 1) * self.dim]
    }

    #[inline(always)]
    pub(crate) fn tail(&self, column: usize) -> f64 {
        self.center_tail.get(column).copied().unwrap_or(0.0)
    }

    /// (x − c)·s.
    pub(crate) fn offset<N: Field>(&self, point: &[f64]) -> Vec<N> {
        (0..self.dim)
            .map(|b| {
                let offset = N::difference(point[b], self.center[b]);
                offset.minus(&N::of(self.tail(b))).scaled(self.scale)
            })
            .collect()
    }

    /// F(x − c) for an offset (x − c)·s.
    pub(crate) fn image<N: Field>(&self, offset: &[N]) -> Vec<N> {
        (0..self.rank)
            .map(|a| {
                let (row, span) = self.row(a);
                row.iter()
                    .zip(&offset[span])
                    .fold(N::of(0.0), |sum, (&f, x)| sum.plus(&N::of(f).times(x)))
            })
            .collect()
    }

    /// (x − c)/2ᵏ with all entries below 2 in size, and k; also where x − c lies beyond the largest number.
    pub(crate) fn small_offset(&self, point: &[f64]) -> (Vec<f64>, i32) {
        let large = |v: &f64| v.abs() >= 2f64.powi(1000);
        let is_large = point.iter().chain(self.center).any(large);
        let (part, shift) = if is_large { (0.25, 2) } else { (1.0, 0) };
        let offset: Vec<f64> = (0..self.dim)
            .map(|b| (point[b] * part - self.center[b] * part) - self.tail(b) * part)
            .collect();
        let largest = offset.iter().fold(0.0f64, |m, v| m.max(v.abs()));
        if largest == 0.0 {
            return (offset, 0);
        }
        // Subnormal numbers have a field of 0 and become no larger than 2.
        let k = ((largest.to_bits() >> 52) as i32 - 1023).max(-1022);
        let (half, rest) = (2f64.powi(-(k / 2)), 2f64.powi(-(k - k / 2)));
        (offset.iter().map(|v| v * half * rest).collect(), k + shift)
    }

    /// Whether |F(x − c)| is known to be above [`FAR_OUT`], for a point that lies too far out for anything finer.
    pub(crate) fn is_far_out(&self, point: &[f64]) -> bool {
        let (offset, k) = self.small_offset(point);
        let mut square = 0.0;
        for a in 0..self.rank {
            let (row, span) = self.row(a);
            let (mut value, mut size) = (0.0, 0.0);
            for (f, x) in row.iter().zip(&offset[span]) {
                value += f * x;
                size += (f * x).abs();
            }
            let least = value.abs() - 4.0 * (self.dim + 8) as f64 * U * size - UNDERFLOW;
            square += least.max(0.0).powi(2);
        }
        // Entries of F/s and of the offset are below 2, so that nothing overflows.
        0.5 * square.log2() + f64::from(k) > FAR_OUT.log2() + 1.0 - self.scale.log2()
            && square > f64::MIN_POSITIVE
    }

    /// What [`Frame::image`] may be off by, in length: for a point whose offset has the sizes `sizes`, when offsets are
    /// off by a few roundings and by `errors` beyond that. Rounded up.
    pub(crate) fn image_error<N: Field>(&self, sizes: &[f64], errors: Option<&[f64]>) -> f64 {
        let rounding = (self.dim + 8) as f64 * N::ROUNDOFF;
        let weight = |b: usize| {
            let tail = 4.0 * N::ROUNDOFF * (self.tail(b) * self.scale).abs();
            sizes[b] * rounding + tail + errors.map_or(0.0, |errors| errors[b])
        };
        let mut square = 0.0;
        for a in 0..self.rank {
            let (row, span) = self.row(a);
            let error: f64 = row
                .iter()
                .zip(span)
                .map(|(f, b)| f.abs() * weight(b) + f64::MIN_POSITIVE * sizes[b])
                .sum();
            square += (error + UNDERFLOW) * (error + UNDERFLOW);
        }
        square.sqrt() * (1.0 + (self.dim + self.rank + 16) as f64 * U)
    }
}

/// The power of two in (v/2, v], kept away from the ends of the range; 1 for 0.
pub(crate) fn power_of_two_below(value: f64) -> f64 {
    if value == 0.0 {
        return 1.0;
    }
    // Subnormal numbers have a field of 0 and are brought to the least power.
    let field = (value.to_bits() >> 52).clamp(1023 - 1000, 1023 + 1000);
    f64::from_bits(field << 52)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_of_two_are_found() {
        assert_eq!([1.0, 1.5, 0.75, 1e-9].map(power_of_two_below), [1.0, 1.0, 0.5, 2f64.powi(-30)]);
        assert_eq!(power_of_two_below(f64::MAX), 2f64.powi(1000));
        assert_eq!(power_of_two_below(5e-324), 2f64.powi(-1000));
    }
}
