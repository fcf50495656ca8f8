//! The points chosen so far, in the forms that comparing with them takes.

use taut_kernels::{Center, squared_distances};

/// Distances between chosen points are kept for this many of them: 64 MiB. Later ones are compared with all points that
/// are looked at.
const PAIRS_MAX: usize = 4096;

/// The points chosen so far.
pub(super) struct Chosen {
    dim: usize,
    /// One after the other, row-major.
    rows: Vec<f64>,
    /// The same by coordinate.
    columns: Vec<Vec<f64>>,
    /// `between[a][c − a − 1]` is the squared distance of chosen points a < c; up to three dimensions nobody asks.
    between: Vec<Vec<f64>>,
}

/// Memory for one thread.
#[derive(Default)]
pub(super) struct Scratch {
    /// As many values as there are missed points.
    pub(super) values: Vec<f64>,
    /// One point as a center.
    pub(super) center: Option<Center>,
    /// The buffer that a source reads into.
    pub(super) read: taut_points::Scratch,
}

impl Chosen {
    pub(super) fn new(dim: usize) -> Self {
        Chosen { dim, rows: vec![], columns: vec![vec![]; dim], between: vec![] }
    }

    pub(super) fn len(&self) -> usize {
        self.columns[0].len()
    }

    /// Adds a point.
    pub(super) fn push(&mut self, row: &[f64]) {
        let count = self.len();
        if self.dim > super::DIM_OF_BOXES_MAX && count < PAIRS_MAX {
            let center = Center { high: row.to_vec(), low: vec![] };
            let mut distances = vec![0.0; count];
            squared_distances(&self.rows, self.dim, &center, &mut distances);
            self.between.iter_mut().zip(distances).for_each(|(list, value)| list.push(value));
            self.between.push(vec![]);
        }
        self.rows.extend_from_slice(row);
        self.columns.iter_mut().zip(row).for_each(|(column, &value)| column.push(value));
    }

    /// Chosen points `range`, row-major.
    pub(super) fn rows(&self, range: std::ops::Range<usize>) -> &[f64] {
        &self.rows[range.start * self.dim..range.end * self.dim]
    }

    /// Coordinate `j` of all.
    pub(super) fn column(&self, j: usize) -> &[f64] {
        &self.columns[j]
    }

    /// The squared distances of chosen point `a` to those after it, as far as they are kept.
    pub(super) fn after(&self, a: usize) -> &[f64] {
        self.between.get(a).map_or(&[], |list| list)
    }
}
