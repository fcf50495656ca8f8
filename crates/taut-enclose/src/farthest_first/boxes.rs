//! Leaves of neighbors in up to three dimensions, with a box around each.
//!
//! *Idea.* Points in the order of a Hilbert curve, 256 to a leaf. A chosen point that is farther from the box than the
//! farthest point of the leaf is from those before it changes nothing; one comparison rules out all 256. Of the chosen
//! points that were missed the one next to the box is taken first: it lowers the bound most, which rules out most others.

use taut_kernels::columns::{GROUP_SIZE, add_gaps, lower};
use taut_oblivious::hilbert_order;
use taut_points::parallel::ParallelSlice;
use taut_points::{Points, Scalar};

use super::chosen::{Chosen, Scratch};
use super::lazy::{Key, Leaf, Leaves, Top};
use crate::Error;
use crate::frame::Frame;

/// Points of a leaf, a multiple of [`GROUP_SIZE`]: fewer have a smaller box that rules out more, and more boxes are to be asked.
const POINTS: usize = 256;

pub(super) struct BoxLeaf {
    /// Coordinate after coordinate of all points.
    columns: Vec<f64>,
    /// Squared distances, as far as is known.
    least: Vec<f64>,
    /// Their row numbers; the last one comes again and again to make a whole number of groups.
    rows: Vec<u32>,
    low: Vec<f64>,
    high: Vec<f64>,
    top: Top,
}

/// The points, copied, in leaves.
pub(super) fn leaves<T: Scalar>(points: &Points<'_, T>, frame: &Frame) -> Leaves<BoxLeaf> {
    let order = match points.dim() {
        1 => hilbert_order(points.len(), |i| [points.row(i)[0].into(), 0.0]),
        2 => hilbert_order(points.len(), |i| [0, 1].map(|j| points.row(i)[j].into())),
        _ => hilbert_order(points.len(), |i| [0, 1, 2].map(|j| points.row(i)[j].into())),
    };
    let leaves = order.par_chunks(POINTS).map(|rows| BoxLeaf::new(points, frame, rows)).collect();
    Leaves { leaves, stored: false }
}

impl BoxLeaf {
    fn new<T: Scalar>(points: &Points<'_, T>, frame: &Frame, rows: &[u32]) -> Self {
        let dim = points.dim();
        let count = rows.len().next_multiple_of(GROUP_SIZE);
        let mut rows = rows.to_vec();
        rows.resize(count, rows[rows.len() - 1]);
        let mut columns = vec![0.0; dim * count];
        let mut point = vec![0.0; dim];
        for (i, &row) in rows.iter().enumerate() {
            point.iter_mut().zip(points.row(row as usize)).for_each(|(p, &v)| *p = v.into());
            frame.bring_in(&mut point);
            for j in 0..dim {
                columns[j * count + i] = point[j];
            }
        }
        let column = |j: usize| columns[j * count..(j + 1) * count].iter().copied();
        let low = (0..dim).map(|j| column(j).fold(f64::INFINITY, f64::min)).collect();
        let high = (0..dim).map(|j| column(j).fold(f64::NEG_INFINITY, f64::max)).collect();
        let top = Top { key: Key { value: f64::INFINITY, row: rows[0].into() }, seen: 0 };
        BoxLeaf { columns, least: vec![f64::INFINITY; count], rows, low, high, top }
    }

    /// The lowest row of the points that are `value` away.
    fn first_row(&self, value: f64) -> u64 {
        let rows = self.rows.iter().zip(&self.least);
        rows.filter(|&(_, &v)| v == value).map(|(&row, _)| row).min().map_or(u64::MAX, u64::from)
    }
}

impl Leaf for BoxLeaf {
    fn top(&self) -> Top {
        self.top
    }

    fn update(&mut self, chosen: &Chosen, floor: Key, scratch: &mut Scratch) -> Result<u64, Error> {
        let dim = self.low.len();
        let first = self.top.seen;
        let gaps = &mut scratch.values;
        gaps.clear();
        gaps.resize(chosen.len() - first, 0.0);
        for j in 0..dim {
            add_gaps(&chosen.column(j)[first..], self.low[j], self.high[j], gaps);
        }
        let mut value = self.top.key.value;
        let mut distances = 0;
        let mut compare = |at: usize, value: &mut f64| {
            *value = lower(&self.columns, chosen.rows(first + at..first + at + 1), &mut self.least);
            distances += self.least.len() as u64;
        };
        let nearest =
            (0..gaps.len()).fold(0, |best, i| if gaps[i] < gaps[best] { i } else { best });
        if gaps[nearest] < value {
            compare(nearest, &mut value);
        }
        for (at, &gap) in gaps.iter().enumerate() {
            if at != nearest && gap < value {
                if value < floor.value {
                    break;
                }
                compare(at, &mut value);
            }
            self.top.seen = first + at + 1;
        }
        self.top.key = Key { value, row: self.first_row(value) };
        Ok(distances)
    }
}
