//! Rows that lack a value are left out, and known by their numbers in the file.
//!
//! *Idea.* Readers give NaN where a value is missing. One pass tells whether there is any; only then the others are copied.

use taut_points::{Blocks, PointSource, Rows, Scalar, ScalarKind, Scratch};

use crate::input::Job;
use crate::read::Decoded;
use crate::sink::Sink;
use crate::{Error, FilterError};

/// The rows of a file that were left out.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Dropped {
    /// Those that lack a value, ascending, from 0.
    rows: Vec<u64>,
    /// All rows of the file.
    all: u64,
    /// The rows that a filter kept, as they are numbered without those above; all where none.
    kept: Option<Vec<u64>>,
}

impl Dropped {
    /// The number of those that lack a value.
    pub(crate) fn count(&self) -> u64 {
        self.rows.len() as u64
    }

    /// The number of all rows of the file.
    pub(crate) fn all(&self) -> u64 {
        self.all
    }

    /// Takes note of the rows that a filter kept.
    pub(crate) fn keep(&mut self, kept: Vec<u64>) {
        self.kept = Some(kept);
    }

    /// The number in the file of a row that was kept.
    pub(crate) fn in_file(&self, row: u64) -> u64 {
        let at = |kept: &Vec<u64>| usize::try_from(row).ok().and_then(|row| kept.get(row).copied());
        let row = self.kept.as_ref().and_then(at).unwrap_or(row);
        // Before the k-th row left out there are rows[k] − k rows that were kept.
        let (mut low, mut high) = (0, self.rows.len());
        while low < high {
            let middle = (low + high) / 2;
            match self.rows[middle] - middle as u64 <= row {
                true => low = middle + 1,
                false => high = middle,
            }
        }
        row.saturating_add(low as u64)
    }
}

/// Leaves out the points that lack a coordinate.
pub(crate) fn drop_rows(job: &Job<'_>, decoded: Decoded) -> Result<(Decoded, Dropped), Error> {
    let Decoded { source, columns, numbers, labels } = decoded;
    let mut rows = Vec::new();
    each_block(&*source, |first, block| {
        let numbers = match block {
            Rows::F32(points) => incomplete(points.rows()),
            Rows::F64(points) => incomplete(points.rows()),
        };
        rows.extend(numbers.into_iter().map(|row| first + row));
        Ok(())
    })?;
    let dropped = Dropped { rows, all: source.len(), kept: None };
    if dropped.rows.is_empty() {
        return Ok((Decoded { source, columns, numbers, labels }, dropped));
    }
    if dropped.count() == source.len() {
        let (path, rows) = (job.path.to_owned(), source.len());
        return Err(FilterError::NoCompleteRows { path, rows }.into());
    }
    let source = match source.scalar() {
        ScalarKind::F32 => {
            let mut sink = Sink::<f32>::new(job, source.dim());
            each_block(&*source, |_, block| match block {
                Rows::F32(points) => keep(points.rows(), &mut sink),
                Rows::F64(_) => Ok(()),
            })?;
            sink.finish()?
        }
        ScalarKind::F64 => {
            let mut sink = Sink::<f64>::new(job, source.dim());
            each_block(&*source, |_, block| match block {
                Rows::F64(points) => keep(points.rows(), &mut sink),
                Rows::F32(_) => Ok(()),
            })?;
            sink.finish()?
        }
    };
    let mut next = dropped.rows.iter().peekable();
    let labels = (0u64..).zip(labels);
    let labels = labels.filter(|(row, _)| next.next_if(|&&left_out| left_out == *row).is_none());
    let labels = labels.map(|(_, label)| label).collect();
    Ok((Decoded { source, columns, numbers, labels }, dropped))
}

fn is_whole<T: Scalar>(point: &[T]) -> bool {
    let is_number = |&value: &T| {
        let value: f64 = value.into();
        !value.is_nan()
    };
    point.iter().all(is_number)
}

/// The numbers of rows that lack a coordinate.
fn incomplete<'a, T: Scalar>(rows: impl Iterator<Item = &'a [T]>) -> Vec<u64> {
    (0u64..).zip(rows).filter(|(_, point)| !is_whole(point)).map(|(row, _)| row).collect()
}

/// Adds the rows that lack none.
fn keep<'a, T: Scalar>(
    rows: impl Iterator<Item = &'a [T]>,
    sink: &mut Sink<'_, T>,
) -> Result<(), Error> {
    rows.filter(|point| is_whole(point)).try_for_each(|point| sink.push(point))
}

/// Calls `visit` with the first row of each block, and the block.
fn each_block(
    source: &dyn PointSource,
    mut visit: impl FnMut(u64, Rows<'_>) -> Result<(), Error>,
) -> Result<(), Error> {
    let (blocks, mut scratch) = (Blocks::of(source), Scratch::new());
    for block in 0..blocks.count() {
        let range = blocks.range(block);
        let first = range.start;
        visit(first, source.read(range, &mut scratch)?)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::Dropped;

    #[test]
    fn rows_that_are_kept_have_their_numbers_in_the_file() {
        for rows in [vec![], vec![0], vec![4], vec![0, 1, 2, 5, 6, 9]] {
            let dropped = Dropped { rows, all: 12, kept: None };
            let kept = (0..12).filter(|row| !dropped.rows.contains(row));
            for (at, row) in (0..).zip(kept) {
                assert_eq!(dropped.in_file(at), row, "{dropped:?}");
            }
            // A filter that keeps each second of the others.
            let mut thinned = dropped.clone();
            thinned.keep((0..12).step_by(2).collect());
            for at in 0..3 {
                assert_eq!(thinned.in_file(at), dropped.in_file(2 * at), "{thinned:?}");
            }
        }
    }
}
