//! Point sets whose rows lie in several places: which blocks a place has, and what they hash to together.
//!
//! *Idea.* Each place works on whole [`Blocks`] and says which. What it says of neighboring blocks is put together as it is
//! merged, so that it takes a few bytes for each run of blocks and not for each block. The hash of a point set allows it: it
//! is a polynomial in the hashes of its blocks.
//! *Guarantee.* In whatever order parts are merged, the runs are the same. A block that comes twice or never is refused.

mod bytes;

pub use bytes::{ByteReader, ByteWriter};

use crate::hash::HashRun;
use crate::{BlockHash, Blocks, InstructionSet, OrderBy, PointSource, PointsHash, ReadError};

/// Why a part of a point set, or what was found in it, is refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PartsError {
    /// A part begins or ends within a block.
    #[error(
        "rows {first}..{end} are not whole blocks: of {n} rows a block has {rows}, so a part begins at a multiple of {rows}, and ends at one or with the last row"
    )]
    Boundary {
        /// The first row of the part.
        first: u64,
        /// One past its last row.
        end: u64,
        /// Number of all rows.
        n: u64,
        /// Rows of a block.
        rows: u64,
    },
    /// A part has rows of another length.
    #[error("a part has {found} columns: expected {expected}")]
    Columns {
        /// The columns of the part.
        found: usize,
        /// Those of the point set.
        expected: usize,
    },
    /// Two parts have a block in common.
    #[error("rows from {row} on come twice: each block belongs to one part")]
    Twice {
        /// The first row of that block.
        row: u64,
    },
    /// No part has some block.
    #[error("rows from {row} on are missing: the parts must hold all blocks")]
    Missing {
        /// The first row of that block.
        row: u64,
    },
    /// Two parts were worked on by kernels that round differently.
    #[error(
        "parts were worked on with the kernels {first} and {second}, which round differently: set TAUT_KERNELS to the smaller of the two everywhere"
    )]
    Kernels {
        /// One instruction set.
        first: &'static str,
        /// Another one.
        second: &'static str,
    },
    /// A part was looked at for another question.
    #[error("a part answers another question than the one that was asked")]
    Question,
    /// A solution was asked for before the last question was answered.
    #[error("the solver still has a question: run it on all parts and feed the answer")]
    Open,
    /// Bytes are not what they should be.
    #[error("the bytes are no {what} of this version of taut")]
    Bytes {
        /// The word for these bytes.
        what: &'static str,
    },
}

/// Rows that are held elsewhere, in parts: a solver asks those who hold them in place of reading.
pub trait Elsewhere: Send + Sync {
    /// The rows with these numbers, in that order, widened to `f64`.
    ///
    /// # Errors
    /// [`ReadError`] when nobody answers.
    fn rows(&self, ids: &[u64]) -> Result<Vec<f64>, ReadError>;

    /// Returns the answer of all parts together to a question, both as bytes.
    ///
    /// # Errors
    /// [`ReadError`] when nobody answers.
    fn ask(&self, question: &[u8]) -> Result<Vec<u8>, ReadError>;
}

/// The rows of a part, of a set of `n`.
///
/// # Errors
/// [`PartsError::Boundary`] if they are not whole blocks.
pub fn check_part(part: &dyn PointSource, first_row: u64, n: u64) -> Result<(), PartsError> {
    let rows = Blocks::new(n, part.dim()).range(0).end;
    let end = first_row.saturating_add(part.len());
    let ends_well = end <= n && (end == n || end.is_multiple_of(rows));
    if first_row.is_multiple_of(rows.max(1)) && ends_well {
        return Ok(());
    }
    Err(PartsError::Boundary { first: first_row, end, n, rows })
}

/// Blocks next to each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Run {
    first: u64,
    hash: HashRun,
}

/// Some of the blocks of a point set, with their hashes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct BlockRuns {
    /// Ascending; between two of them at least one block is missing.
    runs: Vec<Run>,
}

impl BlockRuns {
    /// Blocks next to each other, from block `first` on, with their hashes.
    pub fn of(first: u64, hashes: impl IntoIterator<Item = BlockHash>) -> Self {
        let hash = hashes.into_iter().map(HashRun::of).reduce(HashRun::then);
        BlockRuns { runs: hash.map(|hash| Run { first, hash }).into_iter().collect() }
    }

    /// These blocks and those of another part; `rows` are those of a block.
    ///
    /// # Errors
    /// [`PartsError::Twice`] if they have one in common.
    pub fn merge(self, other: Self, rows: u64) -> Result<Self, PartsError> {
        let mut all = self.runs;
        all.extend(other.runs);
        all.order_by_key(|run| run.first);
        let mut runs: Vec<Run> = vec![];
        for run in all {
            match runs.last_mut() {
                Some(last) if last.first + last.hash.blocks() > run.first => {
                    return Err(PartsError::Twice { row: run.first.saturating_mul(rows) });
                }
                Some(last) if last.first + last.hash.blocks() == run.first => {
                    last.hash = last.hash.then(run.hash);
                }
                _ => runs.push(run),
            }
        }
        Ok(BlockRuns { runs })
    }

    /// The hash of n points of dimension d, if these are all of their blocks.
    ///
    /// # Errors
    /// [`PartsError::Missing`] if they are not.
    pub fn hash(&self, n: u64, dim: usize) -> Result<PointsHash, PartsError> {
        let blocks = Blocks::new(n, dim);
        match self.runs[..] {
            [Run { first: 0, hash }] if hash.blocks() == blocks.count() => {
                Ok(PointsHash::of_run(n, dim, hash))
            }
            [Run { first: 0, hash }, ..] => {
                // Blocks may be more than there are, where bytes were forged.
                let row = hash.blocks().saturating_mul(blocks.range(0).end);
                Err(PartsError::Missing { row })
            }
            _ => Err(PartsError::Missing { row: 0 }),
        }
    }

    /// Appends them to bytes.
    pub fn write(&self, bytes: &mut ByteWriter) {
        bytes.count(self.runs.len());
        for run in &self.runs {
            let (blocks, sum) = run.hash.to_bits();
            [run.first, blocks, sum].into_iter().for_each(|number| bytes.whole(number));
        }
    }

    /// Reads what [`write`](Self::write) wrote.
    ///
    /// # Errors
    /// [`PartsError::Bytes`].
    pub fn read(bytes: &mut ByteReader<'_>) -> Result<Self, PartsError> {
        let count = bytes.count(24)?;
        let mut runs: Vec<Run> = vec![];
        for _ in 0..count {
            let (first, blocks, sum) = (bytes.whole()?, bytes.whole()?, bytes.whole()?);
            let end = runs.last().map_or(0, |last| last.first + last.hash.blocks());
            if blocks == 0 || first < end || first.checked_add(blocks).is_none() {
                return Err(bytes.wrong());
            }
            runs.push(Run { first, hash: HashRun::from_bits(blocks, sum) });
        }
        Ok(BlockRuns { runs })
    }
}

/// Refuses parts that were worked on with other kernels than these.
///
/// # Errors
/// [`PartsError::Kernels`].
pub fn check_kernels(first: InstructionSet, second: InstructionSet) -> Result<(), PartsError> {
    if first == second {
        return Ok(());
    }
    Err(PartsError::Kernels { first: first.name(), second: second.name() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Monitor, Points, Scalar, hash_block, hash_points};

    /// Blocks of 60,000 numbers, cut in every way in two and put together in either order.
    #[test]
    fn parts_hash_to_the_hash_of_the_whole() {
        let values: Vec<f64> = (0..300_000).map(|i| (f64::from(i) * 0.7).sin()).collect();
        let dim = 3;
        let points = Points::new(&values, dim).unwrap();
        let n = PointSource::len(&points);
        let wanted = hash_points(&points, &Monitor::silent()).unwrap();
        let blocks = Blocks::new(n, dim);
        let rows = blocks.range(0).end;
        let run = |from: u64, end: u64| {
            let hash = |block| {
                let range = blocks.range(block);
                hash_block(&f64::rows(points.slice(range.start as usize..range.end as usize)))
            };
            BlockRuns::of(from, (from..end).map(hash))
        };
        let count = blocks.count();
        assert_eq!(count, 5);
        for cut in 0..=count {
            let (a, b) = (run(0, cut), run(cut, count));
            let merged = a.clone().merge(b.clone(), rows).unwrap();
            assert_eq!(merged.hash(n, dim), Ok(wanted), "cut at {cut}");
            assert_eq!(b.merge(a, rows).unwrap(), merged);
            let mut bytes = ByteWriter::new("test");
            merged.write(&mut bytes);
            let bytes = bytes.into_bytes();
            assert_eq!(BlockRuns::read(&mut ByteReader::new("test", &bytes).unwrap()), Ok(merged));
        }
        let twice = run(0, 3).merge(run(2, 5), rows);
        assert_eq!(twice, Err(PartsError::Twice { row: 2 * rows }));
        let gap = run(0, 2).merge(run(3, 5), rows).unwrap();
        assert_eq!(gap.hash(n, dim), Err(PartsError::Missing { row: 2 * rows }));
        assert_eq!(run(1, 5).hash(n, dim), Err(PartsError::Missing { row: 0 }));
        let forged =
            BlockRuns { runs: vec![Run { first: 0, hash: HashRun::from_bits(u64::MAX, 7) }] };
        assert_eq!(forged.hash(n, dim), Err(PartsError::Missing { row: u64::MAX }));
        assert_eq!(run(2, 2).hash(n, dim), Err(PartsError::Missing { row: 0 }));
    }

    #[test]
    fn a_part_is_whole_blocks() {
        let values = vec![0.0; 100_000];
        let part = |rows: usize| Points::new(&values[..rows], 1).unwrap();
        let rows = Blocks::VALUES as u64;
        let n = 2 * rows + 10;
        assert_eq!(check_part(&part(rows as usize), 0, n), Ok(()));
        assert_eq!(check_part(&part(rows as usize), rows, n), Ok(()));
        assert_eq!(check_part(&part(10), 2 * rows, n), Ok(()));
        for (count, first) in [(rows as usize, 1), (9, 2 * rows), (11, 2 * rows), (10, rows)] {
            assert!(check_part(&part(count), first, n).is_err(), "{count} from {first}");
        }
    }
}
