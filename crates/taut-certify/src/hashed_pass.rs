//! One pass over all rows that hashes what it reads, and keeps the rows that the certificate names.
//!
//! *Trap.* A row that is read a second time may have changed since it was hashed: a proof from it would be about other
//! points than those the hash stands for. So no checker reads a row again without hashing all of them again.

use std::collections::{BTreeMap, BTreeSet};

use taut_points::{Monitor, PointSource, PointsHash, Rows, hash_block, map_blocks};

use crate::{CheckError, Violation};

/// Reads all rows once: what `block` finds in each block, in order, and the wanted rows.
///
/// # Errors
/// The error that `block` or the source returns, or [`Violation::Hash`] if the rows are not those of the hash `claimed`.
pub(crate) fn hashed_pass<T: Send>(
    source: &dyn PointSource,
    claimed: PointsHash,
    wanted: WantedRows,
    monitor: &Monitor<'_>,
    block: impl Fn(u64, &Rows<'_>) -> Result<T, CheckError> + Sync + Send,
) -> Result<(Vec<T>, KeptRows), CheckError> {
    let columns = source.dim();
    let blocks = map_blocks(source, monitor, |first, rows| {
        let found = block(first, &rows)?;
        Ok::<_, CheckError>((hash_block(&rows), wanted.of_block(first, &rows, columns), found))
    })?;
    let found = PointsHash::of_blocks(source.len(), columns, blocks.iter().map(|block| block.0));
    if found != claimed {
        let (claimed, found) = (claimed.to_string(), found.to_string());
        return Err(Violation::Hash { claimed, found }.into());
    }
    let mut values = vec![];
    let mut all = Vec::with_capacity(blocks.len());
    for (_, rows, found) in blocks {
        values.extend(rows);
        all.push(found);
    }
    Ok((all, KeptRows { ids: wanted.ids, columns, values }))
}

/// The first coordinate that is NaN or infinite, as an error.
pub(crate) fn all_finite(first: u64, rows: &Rows<'_>) -> Result<(), Violation> {
    match rows.first_non_finite() {
        None => Ok(()),
        Some((row, column, value)) => {
            Err(Violation::NonFinite { row: first + row as u64, column, value })
        }
    }
}

/// The numbers of the rows to keep.
pub(crate) struct WantedRows {
    /// Ascending, each once.
    ids: Vec<u64>,
}

/// The rows themselves, as `f64`.
pub(crate) struct KeptRows {
    ids: Vec<u64>,
    columns: usize,
    values: Vec<f64>,
}

impl WantedRows {
    /// Rows by number, in any order, with repetitions.
    pub(crate) fn of<'a>(ids: impl IntoIterator<Item = &'a u64>) -> Self {
        let ids: BTreeSet<u64> = ids.into_iter().copied().collect();
        WantedRows { ids: ids.into_iter().collect() }
    }

    /// The numbers from `first` to before `end`.
    pub(crate) fn among(&self, first: u64, end: u64) -> &[u64] {
        let place = |id| self.ids.partition_point(|&other| other < id);
        &self.ids[place(first)..place(end)]
    }

    /// No rows.
    pub(crate) fn none() -> Self {
        WantedRows { ids: vec![] }
    }

    /// The wanted rows of one block, row by row.
    pub(crate) fn of_block(&self, first: u64, rows: &Rows<'_>, columns: usize) -> Vec<f64> {
        let from = self.ids.partition_point(|&id| id < first);
        let end = first + rows.len() as u64;
        let ids = self.ids[from..].iter().take_while(|&&id| id < end);
        let mut values = vec![];
        for id in ids {
            let start = values.len();
            values.resize(start + columns, 0.0);
            rows.copy_row((id - first) as usize, &mut values[start..]);
        }
        values
    }
}

impl KeptRows {
    /// Rows by number, ascending, that were kept by others.
    pub(crate) fn of(rows: &BTreeMap<u64, Vec<f64>>, columns: usize) -> Self {
        let values = rows.values().flatten().copied().collect();
        KeptRows { ids: rows.keys().copied().collect(), columns, values }
    }

    /// The row of this number, which was wanted.
    pub(crate) fn row(&self, id: u64) -> &[f64] {
        let at = self.ids.partition_point(|&other| other < id);
        &self.values[at * self.columns..(at + 1) * self.columns]
    }
}

#[cfg(test)]
mod tests {
    use taut_points::{Points, hash_points};

    use super::*;

    #[test]
    fn wanted_rows_are_kept_in_whatever_block_they_are() {
        let values: Vec<f64> = (0..200_000).map(f64::from).collect();
        let points = Points::new(&values, 2).unwrap();
        let (monitor, wanted) = (Monitor::silent(), [99_999, 0, 40_000, 0, 70_001]);
        let claimed = hash_points(&points, &monitor).unwrap();
        let wanted_rows = WantedRows::of(&wanted);
        let (blocks, kept) =
            hashed_pass(&points, claimed, wanted_rows, &monitor, |_, rows| Ok(rows.len())).unwrap();
        assert!(blocks.len() > 1 && blocks.iter().sum::<usize>() == 100_000);
        for id in wanted {
            assert_eq!(kept.row(id), [2.0 * id as f64, 2.0 * id as f64 + 1.0]);
        }
    }
}
