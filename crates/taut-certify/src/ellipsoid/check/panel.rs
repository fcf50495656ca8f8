//! |F(x − c)|² of many points at once, in plain `f64`, and up to where it proves them inside.
//!
//! *Idea.* Points are laid out in groups of eight, coordinate by coordinate, so that each entry of F is used for
//! eight points by vector instructions. The zeros around a triangular F are skipped.
//! *Guarantee.* With e the bound of [`Frame::image_error`] for the largest offsets of the panel, |y| lies within e of
//! the length of the computed images, and their squares sum up with at most r + 2 roundings. So a sum of at most
//! ((1 − e)(1 − (r + 8)u))², rounded down, proves |y| ≤ 1.

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
        for (squares, group) in self.squares.iter_mut().zip(self.offsets.chunks_exact(self.dim)) {
            *squares = squares_of(frame, group);
        }
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

/// Σ over the rows f of F of (f·x)² for eight offsets x.
#[inline(always)]
fn squares_of(frame: &Frame<'_>, group: &[Lanes]) -> Lanes {
    let mut squares = [0.0; LANES];
    for a in 0..frame.rank {
        let (row, span) = frame.row(a);
        let mut image = [0.0; LANES];
        for (f, x) in row.iter().zip(&group[span]) {
            for lane in 0..LANES {
                image[lane] += f * x[lane];
            }
        }
        for lane in 0..LANES {
            squares[lane] += image[lane] * image[lane];
        }
    }
    squares
}
