//! Answers of some of the rows to a query, and how they are merged.

use std::collections::{BTreeMap, BTreeSet};

use taut_points::{
    BlockRuns, Blocks, ByteReader, ByteWriter, InstructionSet, PartsError, PointsHash,
    check_kernels,
};

use super::items::ItemBody;
use super::query::{Query, Question, Stamp};
use super::shells::ShellBody;
use super::traversal::TraversalBody;
use crate::ellipsoid::question::Answer;

/// The answer of some blocks of rows to a [`Query`].
///
/// It holds what was asked for, the rows by number that it names, with their coordinates, and which blocks it is about: with
/// their hash where the query is a first pass.
#[derive(Clone, Debug, PartialEq)]
pub struct Partial {
    pub(super) stamp: Stamp,
    pub(super) blocks: BlockRuns,
    pub(super) rows: BTreeMap<u64, Vec<f64>>,
    pub(super) body: Body,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum Body {
    /// Nothing was looked at yet.
    None,
    /// The rows are all.
    Rows,
    Items(ItemBody),
    Points(Answer),
    /// How far the farthest point is from the nearest center.
    Centers(f64),
    Traversal(TraversalBody),
    Shells(ShellBody),
}

impl Body {
    fn merge(self, other: Self) -> Result<Self, PartsError> {
        match (self, other) {
            (Body::None, body) | (body, Body::None) => Ok(body),
            (Body::Rows, Body::Rows) => Ok(Body::Rows),
            (Body::Items(a), Body::Items(b)) => Ok(Body::Items(a.merge(b)?)),
            (Body::Points(a), Body::Points(b)) => Ok(Body::Points(a.merge(b)?)),
            (Body::Centers(a), Body::Centers(b)) => Ok(Body::Centers(a.max(b))),
            (Body::Traversal(a), Body::Traversal(b)) => Ok(Body::Traversal(a.merge(b)?)),
            (Body::Shells(a), Body::Shells(b)) => Ok(Body::Shells(a.merge(b)?)),
            _ => Err(PartsError::Question),
        }
    }

    /// The numbers of the rows that it names.
    pub(super) fn rows(&self) -> BTreeSet<u64> {
        match self {
            Body::None | Body::Rows | Body::Centers(_) => BTreeSet::new(),
            Body::Items(items) => items.rows(),
            Body::Points(answer) => answer.rows(),
            Body::Traversal(found) => found.rows(),
            Body::Shells(found) => found.rows(),
        }
    }
}

/// The word that bytes of a partial begin with.
const PARTIAL: &str = "partial";

impl Partial {
    /// The answer of no rows, to begin a merge with.
    pub fn none(query: &Query) -> Self {
        let (blocks, rows) = (BlockRuns::default(), BTreeMap::new());
        Partial { stamp: query.stamp(), blocks, rows, body: Body::None }
    }

    /// The answer of these rows and those of another part, whichever is named first.
    ///
    /// # Errors
    /// [`PartsError::Question`] for answers to two queries, [`PartsError::Kernels`], [`PartsError::Twice`].
    pub fn merge(self, other: Self) -> Result<Self, PartsError> {
        self.stamp.check(&other.stamp)?;
        let stamp = self.stamp;
        let rows_of_block = Blocks::new(stamp.n, stamp.columns).range(0).end;
        let blocks = self.blocks.merge(other.blocks, rows_of_block)?;
        let body = self.body.merge(other.body)?;
        let mut rows = self.rows;
        rows.extend(other.rows);
        if !matches!(body, Body::Rows) {
            let named = body.rows();
            rows.retain(|id, _| named.contains(id));
        }
        Ok(Partial { stamp, blocks, rows, body })
    }

    /// Refuses an answer that is not one of all rows to this query.
    pub(super) fn check(&self, query: &Query) -> Result<(), PartsError> {
        query.stamp().check(&self.stamp)?;
        self.hash()?;
        let rows_asked = match query.question() {
            Question::Rows(ids) => ids.iter().copied().collect(),
            _ => self.body.rows(),
        };
        if rows_asked.iter().all(|id| self.rows.contains_key(id)) {
            return Ok(());
        }
        Err(PartsError::Bytes { what: PARTIAL })
    }

    /// The hash of all blocks.
    pub(super) fn hash(&self) -> Result<PointsHash, PartsError> {
        self.blocks.hash(self.stamp.n, self.stamp.columns)
    }

    /// The partial as bytes.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = ByteWriter::new(PARTIAL);
        let Stamp { query, kernels, n, columns } = self.stamp;
        for number in [query, kernels.to_bits(), n, columns as u64] {
            bytes.whole(number);
        }
        self.blocks.write(&mut bytes);
        bytes.count(self.rows.len());
        for (&id, row) in &self.rows {
            bytes.whole(id);
            row.iter().for_each(|&x| bytes.float(x));
        }
        match &self.body {
            Body::None => bytes.whole(0),
            Body::Rows => bytes.whole(1),
            Body::Items(items) => {
                bytes.whole(2);
                items.write(&mut bytes);
            }
            Body::Points(answer) => {
                bytes.whole(3);
                answer.write(&mut bytes);
            }
            Body::Centers(reach) => {
                bytes.whole(4);
                bytes.float(*reach);
            }
            Body::Traversal(found) => {
                bytes.whole(5);
                found.write(&mut bytes);
            }
            Body::Shells(found) => {
                bytes.whole(6);
                found.write(&mut bytes);
            }
        }
        bytes.into_bytes()
    }

    /// Reads what [`to_bytes`](Self::to_bytes) wrote.
    ///
    /// # Errors
    /// [`PartsError::Bytes`].
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, PartsError> {
        let mut bytes = ByteReader::new(PARTIAL, bytes)?;
        let (query, kernels, n) = (bytes.whole()?, bytes.whole()?, bytes.whole()?);
        let kernels = InstructionSet::from_bits(kernels).ok_or(bytes.wrong())?;
        let columns = bytes.size()?;
        let stamp = Stamp { query, kernels, n, columns };
        let blocks = BlockRuns::read(&mut bytes)?;
        let mut rows = BTreeMap::new();
        for _ in 0..bytes.count(columns.saturating_add(1).saturating_mul(8))? {
            let id = bytes.whole()?;
            let row: Result<Vec<f64>, PartsError> = (0..columns).map(|_| bytes.float()).collect();
            rows.insert(id, row?);
        }
        let body = match bytes.whole()? {
            0 => Body::None,
            1 => Body::Rows,
            2 => Body::Items(ItemBody::read(&mut bytes)?),
            3 => Body::Points(Answer::read(&mut bytes)?),
            4 => Body::Centers(bytes.float()?),
            5 => Body::Traversal(TraversalBody::read(&mut bytes)?),
            6 => Body::Shells(ShellBody::read(&mut bytes, columns)?),
            _ => return Err(bytes.wrong()),
        };
        bytes.end(Partial { stamp, blocks, rows, body })
    }
}

impl Stamp {
    fn check(&self, other: &Self) -> Result<(), PartsError> {
        if (self.query, self.n, self.columns) != (other.query, other.n, other.columns) {
            return Err(PartsError::Question);
        }
        check_kernels(self.kernels, other.kernels)
    }
}
