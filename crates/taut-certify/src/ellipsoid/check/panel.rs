//! |F(x − c)|² of many points at once, in plain `f64`, and up to where it proves them inside.
//!
//! *Idea.* Points are laid out in groups of eight, coordinate by coordinate, so that each entry of F is used for
//! eight points by vector instructions; two groups are taken together, with two sums for each, which hides the latency of the
//! additions. The zeros around a triangular F are skipped.
//! *Guarantee.* With e the bound of [`Frame::image_error`] for the largest offsets of the panel, |y| lies within e of
//! the length of the computed images, and their squares sum up with at most r + 2 roundings. So a sum of at most
//! ((1 − e)(1 − (r + 8)u))², rounded down, proves |y| ≤ 1.

use pulp::{Simd, WithSimd};
use taut_points::vectors;

use super::frame::Frame;
use crate::arithmetic::U;

const LANES: usize = 8;

type Lanes = [f64; LANES];

/// Up to [`Panel::ROWS`] points.
pub(super) struct Panel {
    rows: usize,
    dim: usize,
    /// (x − c)·s: for each group of eight points, d times the same coordinate of each.
    offsets: Vec<Lanes>,
    /// The largest size of each coordinate.
    extents: Vec<f64>,
    squares: Vec<Lanes>,
}

impl Panel {
    /// So few that their offsets stay in the first or second cache, so many that their bound costs little.
    pub(super) const ROWS: usize = 128;

    /// The offsets of points given by rows.
    pub(super) fn of(frame: &Frame<'_>, values: &[f64]) -> Self {
        let dim = frame.dim;
        let rows = values.len() / dim;
        let groups = rows.div_ceil(LANES);
        let mut offsets = vec![[0.0; LANES]; groups * dim];
        let (whole, rest) = values.split_at(rows / LANES * LANES * dim);
        let mut groups_of_offsets = offsets.chunks_exact_mut(dim);
        for (points, group) in whole.chunks_exact(LANES * dim).zip(&mut groups_of_offsets) {
            fill(frame, points, LANES, group);
        }
        if let Some(group) = groups_of_offsets.next() {
            fill(frame, rest, rows % LANES, group);
        }
        let squares = vec![[0.0; LANES]; groups];
        Panel { rows, dim, offsets, extents: vec![0.0; dim], squares }
    }

    pub(super) fn rows(&self) -> usize {
        self.rows
    }

    /// Takes the center in place of a point.
    pub(super) fn forget(&mut self, row: usize) {
        for offset in &mut self.offsets[row / LANES * self.dim..][..self.dim] {
            offset[row % LANES] = 0.0;
        }
    }

    /// Finds all squares; returns up to which a point is proved to be inside.
    pub(super) fn measure(&mut self, frame: &Frame<'_>) -> f64 {
        for group in self.offsets.chunks_exact(self.dim) {
            for (extent, offset) in self.extents.iter_mut().zip(group) {
                *extent = offset.iter().fold(*extent, |most, x| most.max(x.abs()));
            }
        }
        vectors().dispatch(Squares { frame, offsets: &self.offsets, squares: &mut self.squares });
        let rounding = (frame.rank + 8) as f64 * U;
        let error = frame.image_error::<f64>(&self.extents, None);
        let proved = (1.0 - error) * (1.0 - rounding);
        if proved > 0.0 { proved * proved * (1.0 - 4.0 * U) } else { -1.0 }
    }

    /// The points that are not proved to be inside, in order.
    pub(super) fn beyond(&self, threshold: f64) -> impl Iterator<Item = usize> {
        let is_open = move |square: &f64| {
            let is_proved = *square <= threshold;
            !is_proved
        };
        let groups = self.squares.iter().enumerate();
        groups
            .filter(move |(_, squares)| squares.iter().fold(false, |any, s| any | is_open(s)))
            .flat_map(move |(group, squares)| {
                let open = (0..LANES).filter(move |&lane| is_open(&squares[lane]));
                open.map(move |lane| group * LANES + lane)
            })
            .filter(|&row| row < self.rows)
    }

    pub(super) fn extents(&self) -> &[f64] {
        &self.extents
    }
}

/// The offsets of up to eight points; those that are missing stand at the center.
#[inline(always)]
fn fill(frame: &Frame<'_>, points: &[f64], count: usize, group: &mut [Lanes]) {
    let dim = group.len();
    for (b, offsets) in group.iter_mut().enumerate() {
        let (center, tail) = (frame.center[b], frame.tail(b));
        for lane in 0..count {
            offsets[lane] = ((points[lane * dim + b] - center) - tail) * frame.scale;
        }
    }
}

/// Σ over the rows f of F of (f·x)² for all offsets x.
struct Squares<'a> {
    frame: &'a Frame<'a>,
    offsets: &'a [Lanes],
    squares: &'a mut [Lanes],
}

impl WithSimd for Squares<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Squares { frame, offsets, squares } = self;
        // Registers that hold one coordinate of a group.
        let width = LANES / S::F64_LANES;
        let offsets = S::as_simd_f64s(offsets.as_flattened()).0;
        let squares = S::as_mut_simd_f64s(squares.as_flattened_mut()).0;
        let pairs = offsets.chunks(2 * width * frame.dim).zip(squares.chunks_mut(2 * width));
        for (pair, squares) in pairs {
            // The last group may be alone, and is its own partner then.
            let (group, partner) = (&pair[..width * frame.dim], squares.len() - width);
            let other = &pair[partner * frame.dim..];
            for register in 0..width {
                let (square, of_other) = squares_of(simd, frame, group, other, width, register);
                squares[register] = square;
                squares[partner + register] = of_other;
            }
        }
    }
}

/// The sums for one register of two groups, whose coordinates are `width` registers apart.
#[inline(always)]
fn squares_of<S: Simd>(
    simd: S,
    frame: &Frame<'_>,
    group: &[S::f64s],
    other: &[S::f64s],
    width: usize,
    register: usize,
) -> (S::f64s, S::f64s) {
    let zero = simd.splat_f64s(0.0);
    let (mut squares, mut of_other) = (zero, zero);
    for a in 0..frame.rank {
        let (row, span) = frame.row(a);
        let span = span.start * width..span.end * width;
        let columns = group[span.clone()].chunks_exact(width).zip(other[span].chunks_exact(width));
        let [mut even, mut odd, mut even_of_other, mut odd_of_other] = [zero; 4];
        let mut terms = row.iter().zip(columns);
        while let Some((&f, (x, y))) = terms.next() {
            let f = simd.splat_f64s(f);
            even = simd.mul_add_e_f64s(f, x[register], even);
            even_of_other = simd.mul_add_e_f64s(f, y[register], even_of_other);
            if let Some((&f, (x, y))) = terms.next() {
                let f = simd.splat_f64s(f);
                odd = simd.mul_add_e_f64s(f, x[register], odd);
                odd_of_other = simd.mul_add_e_f64s(f, y[register], odd_of_other);
            }
        }
        let (image, image_of_other) =
            (simd.add_f64s(even, odd), simd.add_f64s(even_of_other, odd_of_other));
        squares = simd.mul_add_e_f64s(image, image, squares);
        of_other = simd.mul_add_e_f64s(image_of_other, image_of_other, of_other);
    }
    (squares, of_other)
}
