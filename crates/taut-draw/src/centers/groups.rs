//! Rows in groups: the rows without the column of groups, and the center of each.
//!
//! *Idea.* A group has the center from which the farthest of its rows is nearest. Where the answer does not say it, one more pass
//! measures the groups; of each k numbers are kept.

use std::collections::HashMap;
use std::ops::Range;

use taut_certify::{Centers, CentersCertificate};
use taut_points::{
    Blocks, PointSource, Points, ReadError, Rows, Scalar, ScalarKind, Scratch, gather,
};

use super::nearest::Nearest;
use crate::Error;

/// The rows of a source without one of their columns.
pub(super) struct WithoutColumn<'a> {
    source: &'a dyn PointSource,
    column: usize,
}

impl<'a> WithoutColumn<'a> {
    /// The rows without this column, which is there and not the only one.
    pub(super) fn new(source: &'a dyn PointSource, column: usize) -> Self {
        WithoutColumn { source, column }
    }
}

impl PointSource for WithoutColumn<'_> {
    fn len(&self) -> u64 {
        self.source.len()
    }

    fn dim(&self) -> usize {
        self.source.dim() - 1
    }

    fn scalar(&self) -> ScalarKind {
        self.source.scalar()
    }

    fn read<'a>(
        &'a self,
        range: Range<u64>,
        scratch: &'a mut Scratch,
    ) -> Result<Rows<'a>, ReadError> {
        let (dim, wanted) = (self.dim(), range.end.saturating_sub(range.start));
        let mut whole = Scratch::new();
        match self.source.read(range, &mut whole)? {
            Rows::F32(rows) => {
                let values = scratch.values::<f32>(wanted, dim)?;
                copy_without(rows, self.column, values);
                Ok(Rows::F32(Points::new(values, dim)?))
            }
            Rows::F64(rows) => {
                let values = scratch.values::<f64>(wanted, dim)?;
                copy_without(rows, self.column, values);
                Ok(Rows::F64(Points::new(values, dim)?))
            }
        }
    }
}

fn copy_without<T: Scalar>(rows: Points<'_, T>, column: usize, values: &mut [T]) {
    for (to, row) in values.chunks_exact_mut(rows.dim() - 1).zip(rows.rows()) {
        to[..column].copy_from_slice(&row[..column]);
        to[column..].copy_from_slice(&row[column + 1..]);
    }
}

/// The center of each of these rows, which is that of its group.
pub(super) fn centers_of(
    ids: &[u64],
    answer: &Centers,
    certificate: &CentersCertificate,
    nearest: &Nearest,
    source: &dyn PointSource,
    column: usize,
) -> Result<Vec<usize>, Error> {
    if !answer.assignment.is_empty() {
        let center = |id: &u64| answer.assignment.get(*id as usize).map_or(0, |&c| c as usize);
        return Ok(ids.iter().map(center).collect());
    }
    let mut reaches: HashMap<u64, Vec<f64>> = HashMap::new();
    let (blocks, mut scratch) = (Blocks::of(source), Scratch::new());
    let mut row = vec![0.0; source.dim()];
    for block in 0..blocks.count() {
        let rows = source.read(blocks.range(block), &mut scratch)?;
        for i in 0..rows.len() {
            rows.copy_row(i, &mut row);
            let group = row.remove(column);
            let of_group = reaches
                .entry(key(group))
                .or_insert_with(|| vec![f64::NEG_INFINITY; answer.centers.len()]);
            for (center, most) in of_group.iter_mut().enumerate() {
                *most = most.max(nearest.reach_from(center, &row, certificate.items));
            }
            row.push(0.0);
        }
    }
    let least = |reaches: &Vec<f64>| {
        let order = |a: &usize, b: &usize| reaches[*a].total_cmp(&reaches[*b]);
        (0..reaches.len()).min_by(order).unwrap_or(0)
    };
    let numbers = gather(source, ids)?;
    let groups = numbers.iter().skip(column).step_by(source.dim());
    Ok(groups.map(|&group| reaches.get(&key(group)).map_or(0, least)).collect())
}

/// Groups are told apart by this; −0 is 0.
fn key(group: f64) -> u64 {
    (group + 0.0).to_bits()
}
