//! Leaves of rows in any dimension, where each row is looked at on its own.
//!
//! *Idea.* In many dimensions neighbors are hardly nearer than others, so a leaf is no more than some rows that follow each
//! other. Each row knows how many chosen points it was compared with, and the nearest of them. A row that is nearer than
//! the farthest point can be is left alone. Where the nearest point chosen is a, a point c at |a − c| ≥ 2|x − a| is no
//! nearer: |x − c| ≥ |a − c| − |x − a|.
//! *Trap.* A row is compared with eight chosen points at once, with the row in the place of the center: (x − c)² and (c − x)²
//! are the same number, so the values are those of a pass over the rows.
//! *Reference.* Elkan, Using the triangle inequality to accelerate k-means, ICML 2003.

use taut_kernels::{Center, relative_error, squared_distances};
use taut_points::parallel::IntoParallel;
use taut_points::{Points, Scalar};

use super::chosen::{Chosen, Scratch};
use super::lazy::{Key, Leaf, Leaves, Top};
use crate::Error;

/// A leaf has this many rows.
const LEAF_ROWS: usize = 256;
/// Up to this dimension the kernel takes eight rows for the price of one; beyond, one at a time.
const EIGHT_MAX: usize = 96;

/// The known facts about a row.
#[derive(Clone, Copy)]
struct Known {
    /// With how many chosen points it was compared.
    seen: u32,
    nearest: u32,
}

pub(super) struct RowLeaf<'p, T> {
    points: Points<'p, T>,
    first_row: u64,
    /// Squared distances, as far as is known.
    least: Vec<f64>,
    known: Vec<Known>,
    top: Top,
}

pub(super) fn leaves<'p, T: Scalar>(points: &Points<'p, T>) -> Leaves<RowLeaf<'p, T>> {
    let leaves = (0..points.len().div_ceil(LEAF_ROWS))
        .into_par_iter()
        .map(|leaf| {
            let start = leaf * LEAF_ROWS;
            let points = points.slice(start..points.len().min(start + LEAF_ROWS));
            RowLeaf {
                points,
                first_row: start as u64,
                least: vec![f64::INFINITY; points.len()],
                known: vec![Known { seen: 0, nearest: 0 }; points.len()],
                top: Top { key: Key { value: f64::INFINITY, row: start as u64 }, seen: 0 },
            }
        })
        .collect();
    Leaves { leaves, stored: false }
}

impl<T: Scalar> RowLeaf<'_, T> {
    fn key(&self, i: usize) -> Key {
        Key { value: self.least[i], row: self.first_row + i as u64 }
    }

    /// Compares all rows with the first chosen point.
    fn begin(&mut self, chosen: &Chosen) -> u64 {
        let center = Center { high: chosen.rows(0..1).to_vec(), low: vec![] };
        squared_distances(self.points.values(), self.points.dim(), &center, &mut self.least);
        self.known.fill(Known { seen: 1, nearest: 0 });
        self.points.len() as u64
    }

    /// Compares row `i` with chosen points until it is up to date or below `floor`.
    fn compare(&mut self, i: usize, chosen: &Chosen, floor: Key, center: &mut Center) -> u64 {
        let dim = self.points.dim();
        center.high.clear();
        center.high.extend(self.points.row(i).iter().map(|&v| -> f64 { v.into() }));
        let at_once = if dim <= EIGHT_MAX { 8 } else { 1 };
        // Room for the rounding of both squared distances, their product by 4 and the value that is not calculated.
        let safe = 4.0 * (1.0 + 16.0 * relative_error(dim));
        let Known { seen, nearest } = self.known[i];
        let (mut next, mut nearest) = (seen as usize, nearest as usize);
        let mut distances = 0;
        while next < chosen.len() && self.key(i) >= floor {
            let bound = safe * self.least[i];
            let between = chosen.after(nearest).get(next - nearest - 1..).unwrap_or(&[]);
            let skipped = between.iter().take_while(|&&b| b >= bound).count();
            next += skipped;
            let end = chosen.len().min(next + at_once);
            let mut values = [0.0; 8];
            let values = &mut values[..end - next];
            if values.is_empty() {
                break;
            }
            squared_distances(chosen.rows(next..end), dim, center, values);
            distances += values.len() as u64;
            for (c, &value) in (next..).zip(values.iter()) {
                if value < self.least[i] {
                    self.least[i] = value;
                    nearest = c;
                }
            }
            next = end;
        }
        self.known[i] = Known { seen: next as u32, nearest: nearest as u32 };
        distances
    }
}

impl<T: Scalar> Leaf for RowLeaf<'_, T> {
    fn top(&self) -> Top {
        self.top
    }

    fn update(&mut self, chosen: &Chosen, floor: Key, scratch: &mut Scratch) -> Result<u64, Error> {
        let mut distances = if self.known[0].seen == 0 { self.begin(chosen) } else { 0 };
        let center = scratch.center.get_or_insert_with(|| Center { high: vec![], low: vec![] });
        // The farthest row that is up to date: others matter only above it.
        let mut best = Key::MIN;
        for i in 0..self.least.len() {
            let floor = floor.max(best);
            if self.key(i) < floor {
                continue;
            }
            distances += self.compare(i, chosen, floor, center);
            if self.known[i].seen as usize == chosen.len() {
                best = best.max(self.key(i));
            }
        }
        let top = (0..self.least.len()).map(|i| (self.key(i), i)).max();
        self.top = top.map_or(self.top, |(key, i)| Top { key, seen: self.known[i].seen as usize });
        Ok(distances)
    }
}
