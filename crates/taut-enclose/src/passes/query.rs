//! A question about all rows, and how it is answered for some of them.

use std::collections::BTreeMap;

use taut_points::{
    BlockHash, BlockRuns, Blocks, ByteReader, ByteWriter, Elsewhere, InputError, Monitor,
    PartsError, PointSource, check_part, gather, instruction_set,
};

use super::centers::CentersQuestion;
use super::items::ItemQuestion;
use super::partial::{Body, Partial};
use super::points::PointQuestion;
use super::shells::ShellQuestion;
use super::traversal::TraversalQuestion;
use crate::Error;

/// A question of a solver about all rows.
#[derive(Clone, Debug, PartialEq)]
pub struct Query {
    n: u64,
    columns: usize,
    question: Question,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum Question {
    /// The rows with these numbers, ascending.
    Rows(Vec<u64>),
    Items(ItemQuestion),
    Points(PointQuestion),
    Centers(CentersQuestion),
    Traversal(TraversalQuestion),
    Shells(ShellQuestion),
}

impl Question {
    /// Asks it of all rows of a source that are held elsewhere.
    pub(super) fn ask(
        self,
        elsewhere: &dyn Elsewhere,
        source: &dyn PointSource,
    ) -> Result<Partial, Error> {
        let query = Query::new(source.len(), source.dim(), self);
        Ok(Partial::from_bytes(&elsewhere.ask(&query.to_bytes())?)?)
    }
}

/// The word that bytes of a query begin with.
const QUERY: &str = "query";

impl Query {
    pub(super) fn new(n: u64, columns: usize, question: Question) -> Self {
        Query { n, columns, question }
    }

    /// The number of all rows.
    pub fn rows(&self) -> u64 {
        self.n
    }

    /// Numbers of a row.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// True where the answer takes a look at every row, and not at a few by number.
    pub fn is_pass(&self) -> bool {
        !matches!(self.question, Question::Rows(_))
    }

    /// Answers it for the rows of `part`, which are whole blocks and numbered from `first_row` on, on the threads of the current pool.
    ///
    /// # Errors
    /// [`Error::Parts`] where the part is not of the set that the query is about; [`Error::Input`] and [`Error::NegativeRadius`] for rows
    /// that are none, with their numbers, and when the source fails or the monitor stops the work.
    pub fn run(
        &self,
        part: &dyn PointSource,
        first_row: u64,
        monitor: &Monitor<'_>,
    ) -> Result<Partial, Error> {
        if part.is_empty() {
            return Ok(Partial::none(self));
        }
        if part.dim() != self.columns {
            let (found, expected) = (part.dim(), self.columns);
            return Err(PartsError::Columns { found, expected }.into());
        }
        check_part(part, first_row, self.n)?;
        let (blocks, body) = match &self.question {
            Question::Rows(_) => (self.blocks_of(part, first_row), Body::Rows),
            Question::Items(question) => {
                self.hashed(part, first_row, question.run(part, first_row, monitor)?)
            }
            Question::Points(question) => {
                self.hashed(part, first_row, question.run(part, first_row, monitor)?)
            }
            Question::Centers(question) => {
                self.hashed(part, first_row, question.run(part, first_row, monitor)?)
            }
            Question::Traversal(question) => {
                self.hashed(part, first_row, question.run(part, first_row, monitor)?)
            }
            Question::Shells(question) => {
                let first_block = self.block(first_row);
                let found = question.run(part, first_row, first_block, monitor)?;
                self.hashed(part, first_row, found)
            }
        };
        let end = first_row + part.len();
        let ids: Vec<u64> = match &self.question {
            Question::Rows(ids) => {
                ids.iter().copied().filter(|id| (first_row..end).contains(id)).collect()
            }
            _ => body.rows().into_iter().collect(),
        };
        let places: Vec<u64> = ids.iter().map(|id| id - first_row).collect();
        let values = gather(part, &places)?;
        let rows: BTreeMap<u64, Vec<f64>> =
            ids.into_iter().zip(values.chunks_exact(self.columns).map(<[f64]>::to_vec)).collect();
        Ok(Partial { stamp: self.stamp(), blocks, rows, body })
    }

    /// An answer with its blocks, hashed or not.
    fn hashed(
        &self,
        part: &dyn PointSource,
        first_row: u64,
        (hashes, body): (Option<Vec<BlockHash>>, Body),
    ) -> (BlockRuns, Body) {
        match hashes {
            Some(hashes) => (BlockRuns::of(self.block(first_row), hashes), body),
            None => (self.blocks_of(part, first_row), body),
        }
    }

    fn block(&self, row: u64) -> u64 {
        row / Blocks::new(self.n, self.columns).range(0).end.max(1)
    }

    /// The blocks of a part, without their hashes.
    fn blocks_of(&self, part: &dyn PointSource, first_row: u64) -> BlockRuns {
        let first = self.block(first_row);
        let last = self.block(first_row + part.len() - 1);
        BlockRuns::of(first, (first..=last).map(|_| BlockHash::from_bits(0)))
    }

    pub(super) fn stamp(&self) -> Stamp {
        // FNV-1a: it tells one query of a solver from another.
        let hash = self.to_bytes().into_iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
        });
        Stamp { query: hash, kernels: instruction_set(), n: self.n, columns: self.columns }
    }

    /// The query as bytes.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = ByteWriter::new(QUERY);
        bytes.whole(self.n);
        bytes.count(self.columns);
        match &self.question {
            Question::Rows(ids) => {
                bytes.whole(0);
                bytes.wholes(ids);
            }
            Question::Items(question) => {
                bytes.whole(1);
                question.write(&mut bytes);
            }
            Question::Points(question) => {
                bytes.whole(2);
                question.write(&mut bytes);
            }
            Question::Centers(question) => {
                bytes.whole(3);
                question.write(&mut bytes);
            }
            Question::Traversal(question) => {
                bytes.whole(4);
                question.write(&mut bytes);
            }
            Question::Shells(question) => {
                bytes.whole(5);
                question.write(&mut bytes);
            }
        }
        bytes.into_bytes()
    }

    /// Reads what [`to_bytes`](Self::to_bytes) wrote.
    ///
    /// # Errors
    /// [`PartsError::Bytes`].
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, PartsError> {
        let mut bytes = ByteReader::new(QUERY, bytes)?;
        let n = bytes.whole()?;
        let columns = bytes.size()?;
        let question = match bytes.whole()? {
            0 => Question::Rows(bytes.wholes()?),
            1 => Question::Items(ItemQuestion::read(&mut bytes, columns)?),
            2 => Question::Points(PointQuestion::read(&mut bytes, columns)?),
            3 => Question::Centers(CentersQuestion::read(&mut bytes, columns)?),
            4 => Question::Traversal(TraversalQuestion::read(&mut bytes, columns)?),
            5 => Question::Shells(ShellQuestion::read(&mut bytes, columns)?),
            _ => return Err(bytes.wrong()),
        };
        bytes.end(Query { n, columns, question })
    }

    pub(super) fn question(&self) -> &Question {
        &self.question
    }
}

/// The error with the number that its row has among all.
pub(super) fn among_all(error: Error, first_row: u64) -> Error {
    match error {
        Error::Input(InputError::NonFinite { row, column, value }) => {
            InputError::NonFinite { row: first_row + row, column, value }.into()
        }
        other => other,
    }
}

/// The facts that partials must have in common to be merged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stamp {
    /// The hash of the query.
    pub(super) query: u64,
    pub(super) kernels: taut_points::InstructionSet,
    pub(super) n: u64,
    pub(super) columns: usize,
}
