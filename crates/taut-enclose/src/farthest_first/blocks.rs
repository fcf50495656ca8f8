//! Leaves of rows that are read when they are looked at.
//!
//! *Idea.* A leaf is a block of the source. It is read when its farthest point may be the farthest of all; then its rows are
//! compared with all chosen points that were missed since, in chunks, each until it is below what can matter.

use taut_kernels::{Center, squared_distances};
use taut_points::{Blocks, PointSource, Points, Rows, Scalar};

use super::chosen::{Chosen, Scratch};
use super::lazy::{Key, Leaf, Leaves, Top};
use crate::Error;
use crate::frame::Frame;

/// Rows that are looked at together.
const CHUNK: usize = 128;

pub(super) struct BlockLeaf<'s> {
    source: &'s dyn PointSource,
    frame: &'s Frame,
    first_row: u64,
    /// Squared distances, as far as is known.
    least: Vec<f64>,
    /// The farthest row of each chunk.
    tops: Vec<Top>,
    top: Top,
}

/// The blocks of a source; nothing is read yet.
pub(super) fn leaves<'s>(source: &'s dyn PointSource, frame: &'s Frame) -> Leaves<BlockLeaf<'s>> {
    let blocks = Blocks::of(source);
    let leaves = (0..blocks.count())
        .map(|block| {
            let range = blocks.range(block);
            let least = vec![f64::INFINITY; (range.end - range.start) as usize];
            let chunks = range.clone().step_by(CHUNK);
            let top = |row| Top { key: Key { value: f64::INFINITY, row }, seen: 0 };
            BlockLeaf {
                source,
                frame,
                first_row: range.start,
                least,
                tops: chunks.map(top).collect(),
                top: top(range.start),
            }
        })
        .collect();
    Leaves { leaves, stored: true }
}

impl Leaf for BlockLeaf<'_> {
    fn top(&self) -> Top {
        self.top
    }

    fn update(&mut self, chosen: &Chosen, floor: Key, scratch: &mut Scratch) -> Result<u64, Error> {
        let range = self.first_row..self.first_row + self.least.len() as u64;
        let frame = self.frame;
        match self.source.read(range, &mut scratch.read)? {
            Rows::F32(points) if frame.is_plain() => Ok(self.compare(&points, chosen, floor)),
            Rows::F64(points) if frame.is_plain() => Ok(self.compare(&points, chosen, floor)),
            Rows::F32(points) => Ok(self.compare_scaled(&frame.copy(&points), chosen, floor)),
            Rows::F64(points) => Ok(self.compare_scaled(&frame.copy(&points), chosen, floor)),
        }
    }
}

impl BlockLeaf<'_> {
    fn compare_scaled(&mut self, values: &[f64], chosen: &Chosen, floor: Key) -> u64 {
        let points = Points::new(values, self.source.dim()).expect("the rows are whole");
        self.compare(&points, chosen, floor)
    }

    fn compare<T: Scalar>(&mut self, points: &Points<'_, T>, chosen: &Chosen, floor: Key) -> u64 {
        let mut distances = 0;
        // The farthest row that is up to date: others matter only above it.
        let mut best = Key::MIN;
        let mut center = Center { high: vec![], low: vec![] };
        let mut values = [0.0; CHUNK];
        for (chunk, top) in self.tops.iter_mut().enumerate() {
            let start = chunk * CHUNK;
            let end = self.least.len().min(start + CHUNK);
            let (rows, least) = (points.slice(start..end), &mut self.least[start..end]);
            let values = &mut values[..end - start];
            let floor = floor.max(best);
            while top.seen < chosen.len() && top.key >= floor {
                center.high.clear();
                center.high.extend_from_slice(chosen.rows(top.seen..top.seen + 1));
                squared_distances(rows.values(), rows.dim(), &center, values);
                distances += values.len() as u64;
                for (least, &value) in least.iter_mut().zip(values.iter()) {
                    *least = if value < *least { value } else { *least };
                }
                *top =
                    Top { key: farthest(self.first_row + start as u64, least), seen: top.seen + 1 };
            }
            if top.seen == chosen.len() {
                best = best.max(top.key);
            }
        }
        self.top = self.tops.iter().copied().max_by_key(|top| top.key).unwrap_or(self.top);
        distances
    }
}

/// The farthest of rows that follow each other from `first_row` on; not below 0.
fn farthest(first_row: u64, least: &[f64]) -> Key {
    let value = taut_kernels::extremes::largest(least);
    let at = least.iter().position(|&v| v == value).unwrap_or(0);
    Key { value, row: first_row + at as u64 }
}
