//! The map x ↦ y = F(x − c) that takes the ellipsoid to the unit ball, scaled so that nothing over- or underflows.
//!
//! F and x − c are taken as F/s and (x − c)·s for the power of two s that brings the largest entry of F to [1, 2):
//! exactly, but for what underflows beside 1.

use std::ops::Range;

use super::super::Ellipsoid;
use super::enclosure::FAR_OUT;
use crate::arithmetic::{DoubleDouble, Field, Ring, U};

/// More than what underflow can add to a sum of products.
const UNDERFLOW: f64 = f64::from_bits((1023 - 900) << 52);

/// F, c and s.
#[derive(Clone)]
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
    /// The known facts about points off the hull of a flat set; all 0 where there is none.
    tilt: Tilt,
}

/// The distances by which the rows of F lean out of a hull, and inputs lie off it. The claim is about projections to the hull: F(x − c) differs
/// from the image of the projection of x by at most the product of the two.
#[derive(Clone, Default)]
struct Tilt {
    /// The root of the sum of squares of |(I − BᵀB)f| over the rows f of F/s, rounded up. No part of f off the hull is longer,
    /// whatever B lacks of being orthonormal.
    factor: f64,
    /// The distance stated for the hull, times s.
    distance: f64,
    /// The tolerance of the checker beside that distance, as a part of offsets and of widths.
    of_offset: f64,
    of_width: f64,
}

impl Tilt {
    fn of(ellipsoid: &Ellipsoid, scale: f64) -> Self {
        let Some(hull) = &ellipsoid.hull else { return Tilt::default() };
        let rounding = span_rounding(ellipsoid.center.len(), ellipsoid.factor.len());
        let rows = ellipsoid.factor.iter();
        let square: f64 = rows.map(|row| off_hull(&hull.basis, row, scale).powi(2)).sum();
        Tilt {
            factor: square.sqrt() * (1.0 + 1e-9),
            distance: hull.distance * scale,
            // Plain arithmetic finds the distance of an input to as much again.
            of_offset: 2.0 * rounding,
            of_width: 2.0 * rounding.sqrt(),
        }
    }

    /// Returns what images miss for an input whose offset and width have these lengths at most.
    fn error(&self, offset: f64, width: f64) -> f64 {
        match self.factor == 0.0 {
            true => 0.0,
            false => {
                let beside = self.of_offset * offset + self.of_width * width;
                self.factor * (self.distance + beside) * (1.0 + 1e-9)
            }
        }
    }
}

/// |(I − BᵀB)f|/s for a row f of F, in doubled precision and rounded up.
fn off_hull(basis: &[Vec<f64>], row: &[f64], scale: f64) -> f64 {
    let of = |v: f64| DoubleDouble::of(v / scale);
    let mut rest: Vec<DoubleDouble> = row.iter().map(|&f| of(f)).collect();
    for direction in basis {
        let along = direction.iter().zip(row).fold(DoubleDouble::of(0.0), |sum, (&b, &f)| {
            sum.plus(&DoubleDouble::of(b).times(&of(f)))
        });
        for (rest, &b) in rest.iter_mut().zip(direction) {
            *rest = rest.minus(&along.times(&DoubleDouble::of(b)));
        }
    }
    let size: f64 = row.iter().map(|f| (f / scale).abs()).sum();
    let steps = (basis.len() + 1) * (row.len() + 8);
    let rounding = 4.0 * steps as f64 * DoubleDouble::ROUNDOFF * size;
    let square: f64 = rest.iter().map(|v| v.rounded() * v.rounded()).sum();
    // A row along the hull to the last bit has no part off it.
    if square == 0.0 { 0.0 } else { square.sqrt() * (1.0 + 1e-9) + rounding }
}

/// 32(d + 4)√(r + 1)·u: what of a row of F, and of an offset, may appear to lie off a hull with a basis in `f64`.
pub(crate) fn span_rounding(dim: usize, rank: usize) -> f64 {
    32.0 * (dim + 4) as f64 * ((rank + 1) as f64).sqrt() * U
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
            tilt: Tilt::of(ellipsoid, scale),
        }
    }

    /// The same map from another center, for an answer that is its whole space.
    pub(crate) fn around<'b>(&self, center: &'b [f64]) -> Frame<'b>
    where
        'a: 'b,
    {
        let center_tail = &[][..];
        Frame { center, center_tail, ..self.clone() }
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

    /// Returns true if |F(x − c)| is known to be above [`FAR_OUT`], for a point that lies too far out for anything finer.
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
        // Entries of the offset are below 2 and those of F/s below 2²⁵, so that nothing overflows.
        0.5 * square.log2() + f64::from(k) > FAR_OUT.log2() + 1.0 - self.scale.log2()
            && square > f64::MIN_POSITIVE
    }

    /// Returns what [`Frame::image`] may be off by, in length: for a point whose offset has the sizes `sizes`, when offsets are
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
        let off_hull = self.tilt.error(sizes.iter().sum(), 0.0);
        (square.sqrt() + off_hull) * (1.0 + (self.dim + self.rank + 16) as f64 * U)
    }

    /// Returns what [`Frame::image_error`] lacks for points of an input that reaches so far from its center along the axes, times s.
    pub(crate) fn width_error(&self, widths: f64) -> f64 {
        self.tilt.error(widths, widths)
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
