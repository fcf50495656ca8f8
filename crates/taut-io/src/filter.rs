//! Points that are kept of those that a file has: within a box, and one in each cell of a grid.
//!
//! *Idea.* Cells that are taken are bits, 64 cells side by side in a word, and words are found by a hash table: where points
//! are dense that takes less than a byte a cell.
//! *Guarantee.* The first point of a cell is kept, in the order of the rows, whatever memory is allowed.

use std::collections::HashMap;

use taut_points::{Blocks, Rows, Scalar, Scratch, shown_number};

use crate::input::Job;
use crate::read::Decoded;
use crate::sink::Sink;
use crate::{Bounds, Error, FilterError, ReadOptions, Thinning};

/// Bytes that a word of the table takes, with its key and what a hash table keeps free.
const WORD_BYTES: u64 = 64;

/// Cells are numbered up to this, so that neighbors have different numbers.
const CELL_NUMBER_MAX: f64 = (1u64 << 50) as f64;

/// Most axes of a grid.
const AXES_MAX: usize = 3;

/// What is kept, and the cells that are taken. One for all files of a folder.
pub(crate) struct Filter {
    bounds: Option<Bounds>,
    thinning: Option<Thinning>,
    memory: Option<u64>,
    taken: HashMap<[i64; AXES_MAX], u64>,
}

impl Filter {
    pub(crate) fn of(options: &ReadOptions) -> Self {
        let (bounds, thinning) = (options.bounds.clone(), options.thinning.clone());
        Filter { bounds, thinning, memory: options.memory, taken: HashMap::new() }
    }

    /// Tests whether all points are kept.
    pub(crate) fn keeps_all(&self) -> bool {
        self.bounds.is_none() && self.thinning.is_none()
    }

    /// Makes ready for points with these names of coordinates, of which there may be none.
    pub(crate) fn sieve(
        &mut self,
        path: &str,
        dim: usize,
        names: &[String],
    ) -> Result<Sieve<'_>, Error> {
        let wrong = |option: &'static str, expected: String| FilterError::Option {
            path: path.to_owned(),
            option,
            expected,
        };
        let pairs = self.bounds.as_ref().map_or(0, |bounds| bounds.low.len());
        if pairs > dim {
            let expected = format!("at most {} numbers, as points have {dim} coordinates", 2 * dim);
            return Err(wrong("bounds", expected).into());
        }
        let mut axes: Vec<usize> = (0..dim).collect();
        if let Some(thinning) = &self.thinning {
            if let Some(except) = &thinning.except {
                let named = names.iter().position(|name| name == except);
                let number = named.or_else(|| except.parse().ok());
                axes.retain(|&axis| Some(axis) != number);
            }
            if axes.len() > AXES_MAX {
                let expected = format!("points of at most {AXES_MAX} coordinates");
                return Err(wrong("thin", expected).into());
            }
        }
        Ok(Sieve { filter: self, path: path.to_owned(), axes })
    }

    /// Keeps what is to be kept of points that were read, and hands its rows to `note`.
    pub(crate) fn apply(
        &mut self,
        job: &Job<'_>,
        decoded: Decoded,
        mut note: impl FnMut(u64),
    ) -> Result<Decoded, Error> {
        let Decoded { source, columns, numbers, mut labels } = decoded;
        let mut sieve = self.sieve(job.path, source.dim(), &columns)?;
        let mut kept = Kept::new(job, source.scalar(), source.dim());
        let (blocks, mut scratch) = (Blocks::of(&*source), Scratch::new());
        let mut labels_kept = Vec::new();
        for block in 0..blocks.count() {
            let range = blocks.range(block);
            let rows = source.read(range.clone(), &mut scratch)?;
            kept.add(&rows, range.start, &mut sieve, |row| {
                note(row);
                if let Some(label) = labels.get_mut(row as usize) {
                    labels_kept.push(std::mem::take(label));
                }
            })?;
        }
        let source = kept.finish()?;
        Ok(Decoded { source, columns, numbers, labels: labels_kept })
    }
}

/// A filter at work on the points of one file.
pub(crate) struct Sieve<'a> {
    filter: &'a mut Filter,
    path: String,
    axes: Vec<usize>,
}

impl Sieve<'_> {
    /// Tests whether a point is kept; `row` counts from 0.
    pub(crate) fn keeps(
        &mut self,
        row: u64,
        point: impl Fn(usize) -> f64,
        dim: usize,
    ) -> Result<bool, Error> {
        if let Some(column) = (0..dim).find(|&k| !point(k).is_finite()) {
            let (path, value) = (self.path.clone(), shown_number(point(column)));
            return Err(
                FilterError::Value { path, row: row.saturating_add(1), column, value }.into()
            );
        }
        if let Some(bounds) = &self.filter.bounds {
            let sides = bounds.low.iter().zip(&bounds.high).enumerate();
            if !sides.into_iter().all(|(k, (&low, &high))| (low..=high).contains(&point(k))) {
                return Ok(false);
            }
        }
        let Some(thinning) = &self.filter.thinning else { return Ok(true) };
        let mut cell = [0; AXES_MAX];
        for (to, &axis) in cell.iter_mut().zip(&self.axes) {
            let number = (point(axis) / thinning.cell).floor();
            if number.abs() > CELL_NUMBER_MAX {
                let expected =
                    "a longer side of cells: a coordinate is more than 2^50 of them from 0";
                let (path, expected) = (self.path.clone(), expected.to_owned());
                return Err(FilterError::Option { path, option: "thin", expected }.into());
            }
            *to = number as i64;
        }
        // 64 cells side by side: 64, 8 × 8 or 4 × 4 × 4.
        let shift = [6, 6, 3, 2][self.axes.len()];
        let word = cell.map(|number| number >> shift);
        let bit =
            cell.iter().rev().fold(0, |bit, number| bit << shift | (number & ((1 << shift) - 1)));
        let words = self.filter.taken.len() as u64 + 1;
        let (needed, memory) = (words * WORD_BYTES, self.filter.memory.unwrap_or(u64::MAX));
        let taken = self.filter.taken.entry(word).or_insert(0);
        if *taken == 0 && needed > memory.max(WORD_BYTES << 14) {
            let path = self.path.clone();
            return Err(FilterError::Memory { path, row: row + 1, memory }.into());
        }
        let is_new = *taken >> (bit & 63) & 1 == 0;
        *taken |= 1 << (bit & 63);
        Ok(is_new)
    }
}

/// The points that are kept, in either precision.
enum Kept<'a> {
    Single(Sink<'a, f32>),
    Double(Sink<'a, f64>),
}

impl<'a> Kept<'a> {
    fn new(job: &'a Job<'a>, scalar: taut_points::ScalarKind, dim: usize) -> Self {
        match scalar {
            taut_points::ScalarKind::F32 => Kept::Single(Sink::new(job, dim)),
            taut_points::ScalarKind::F64 => Kept::Double(Sink::new(job, dim)),
        }
    }

    fn add(
        &mut self,
        rows: &Rows<'_>,
        first: u64,
        sieve: &mut Sieve<'_>,
        note: impl FnMut(u64),
    ) -> Result<(), Error> {
        match (self, rows) {
            (Kept::Single(sink), Rows::F32(points)) => sift(sink, points, first, sieve, note),
            (Kept::Double(sink), Rows::F64(points)) => sift(sink, points, first, sieve, note),
            _ => Ok(()),
        }
    }

    fn finish(self) -> Result<Box<dyn taut_points::PointSource>, Error> {
        match self {
            Kept::Single(sink) => sink.finish(),
            Kept::Double(sink) => sink.finish(),
        }
    }
}

fn sift<T: Scalar>(
    sink: &mut Sink<'_, T>,
    points: &taut_points::Points<'_, T>,
    first: u64,
    sieve: &mut Sieve<'_>,
    mut note: impl FnMut(u64),
) -> Result<(), Error> {
    for (row, point) in (first..).zip(points.rows()) {
        if sieve.keeps(row, |k| point[k].into(), point.len())? {
            sink.push(point)?;
            note(row);
        }
    }
    Ok(())
}
