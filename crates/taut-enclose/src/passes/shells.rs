//! The questions of a robust ellipsoid: how many rows lie in shells around a center, and the moments of those within one.
//!
//! *Idea.* Squared distances are not negative, so they are ordered as their bits are. Shells are ranges of bits, down to one number.
//! *Guarantee.* Moments of blocks are added up in pairs, and pairs of pairs, as the numbers of blocks say. So their bits do not depend on
//! which part has which blocks.

use std::collections::{BTreeMap, BTreeSet};

use taut_points::{
    BlockHash, ByteReader, ByteWriter, Elsewhere, Monitor, OrderBy, PartsError, PointSource,
    PointsHash,
};

use super::partial::Body;
use super::query::{Question, among_all};
use super::traversal::{read_far, write_far};
use crate::Error;
use crate::ellipsoid::point_reader::visit;
use crate::robust::{Estimate, Moments};
use crate::top::Far;

/// Shells of one question.
pub(crate) const SHELLS: usize = 4096;

/// A question about distances in a metric; a first one also hashes rows and refuses those that are not finite.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ShellQuestion {
    is_first: bool,
    metric: Estimate,
    kind: Kind,
}

/// Bounds are the bits of squared distances.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    /// How many rows are below a bound, in each of [`SHELLS`] from there on, and beyond.
    Count { low: u64, width: u64 },
    /// The moments of the rows below a bound, and the rows from there to the next.
    Border { low: u64, high: u64 },
}

/// Counts the rows, held elsewhere, below `low`, in shells of some width and beyond: [`SHELLS`] + 2 numbers. A first question also brings
/// the hash of the rows.
pub(crate) fn ask_counts(
    elsewhere: &dyn Elsewhere,
    source: &dyn PointSource,
    metric: &Estimate,
    (low, width): (u64, u64),
    is_first: bool,
) -> Result<(Vec<u64>, PointsHash), Error> {
    let kind = Kind::Count { low, width };
    let question = ShellQuestion { is_first, metric: metric.clone(), kind };
    let partial = Question::Shells(question).ask(elsewhere, source)?;
    let hash = partial.hash()?;
    match partial.body {
        Body::Shells(ShellBody::Count(counts)) => Ok((counts, hash)),
        _ => Err(PartsError::Question.into()),
    }
}

/// The moments, in a metric, of the rows that are nearer than `low`, and the rows from there to `high`, the nearest first.
pub(crate) fn ask_border(
    elsewhere: &dyn Elsewhere,
    source: &dyn PointSource,
    metric: &Estimate,
    (low, high): (u64, u64),
) -> Result<(Moments, Vec<Far>), Error> {
    let kind = Kind::Border { low, high };
    let question = ShellQuestion { is_first: false, metric: metric.clone(), kind };
    match Question::Shells(question).ask(elsewhere, source)?.body {
        Body::Shells(ShellBody::Border { sums, mut border }) => {
            border.order_by(&|a, b| a.reach2.total_cmp(&b.reach2).then(a.id.cmp(&b.id)));
            Ok((sums.total(source.dim()), border))
        }
        _ => Err(PartsError::Question.into()),
    }
}

impl ShellQuestion {
    /// The answer of some rows, which begin with some block, and in a first question the hashes of their blocks.
    pub(super) fn run(
        &self,
        part: &dyn PointSource,
        first_row: u64,
        first_block: u64,
        monitor: &Monitor<'_>,
    ) -> Result<(Option<Vec<BlockHash>>, Body), Error> {
        let (hashes, body) = match self.kind {
            Kind::Count { low, width } => self.count(part, low, width, monitor),
            Kind::Border { low, high } => {
                self.border(part, (first_row, first_block), low, high, monitor)
            }
        }
        .map_err(|error| among_all(error, first_row))?;
        let hashes = self.is_first.then(|| hashes.into_iter().flatten().collect());
        Ok((hashes, Body::Shells(body)))
    }

    fn count(
        &self,
        part: &dyn PointSource,
        low: u64,
        width: u64,
        monitor: &Monitor<'_>,
    ) -> Result<(Vec<Option<BlockHash>>, ShellBody), Error> {
        let blocks = visit(part, monitor, self.is_first, |_, rows| {
            let squares = self.metric.distances_of(rows);
            let (mut below, mut within): (u64, Vec<u16>) = (0, vec![]);
            for bits in squares.iter().map(|square| square.to_bits()) {
                match bits.checked_sub(low).map(|above| above / width) {
                    None => below += 1,
                    Some(shell) if shell < SHELLS as u64 => within.push(shell as u16),
                    Some(_) => {}
                }
            }
            (squares.len() as u64, below, within)
        })?;
        let (mut counts, mut hashes) = (vec![0; SHELLS + 2], vec![]);
        for ((rows, below, within), hash) in blocks {
            counts[0] += below;
            counts[SHELLS + 1] += rows - below - within.len() as u64;
            within.iter().for_each(|&shell| counts[1 + usize::from(shell)] += 1);
            hashes.push(hash);
        }
        Ok((hashes, ShellBody::Count(counts)))
    }

    fn border(
        &self,
        part: &dyn PointSource,
        (first_row, first_block): (u64, u64),
        low: u64,
        high: u64,
        monitor: &Monitor<'_>,
    ) -> Result<(Vec<Option<BlockHash>>, ShellBody), Error> {
        let blocks = visit(part, monitor, self.is_first, |first, rows| {
            let squares = self.metric.distances_of(rows);
            let moments = self.metric.moments_of(rows, |row| squares[row].to_bits() < low);
            let is_border = |square: f64| (low..high).contains(&square.to_bits());
            let numbered = (first_row + first..).zip(squares.iter().copied());
            let border = numbered.filter(|(_, square)| is_border(*square));
            let border: Vec<Far> = border.map(|(id, reach2)| Far { id, reach2 }).collect();
            (moments, border)
        })?;
        let (mut sums, mut all, mut hashes) = (BlockSums::default(), vec![], vec![]);
        for (number, ((moments, border), hash)) in (first_block..).zip(blocks) {
            sums.add(0, number, moments);
            all.extend(border);
            hashes.push(hash);
        }
        Ok((hashes, ShellBody::Border { sums, border: all }))
    }

    pub(super) fn write(&self, bytes: &mut ByteWriter) {
        let Estimate { center, tail, matrix } = &self.metric;
        bytes.whole(u64::from(self.is_first));
        [center, tail, matrix].into_iter().for_each(|list| bytes.floats(list));
        let (kind, low, more) = match self.kind {
            Kind::Count { low, width } => (0, low, width),
            Kind::Border { low, high } => (1, low, high),
        };
        [kind, low, more].into_iter().for_each(|number| bytes.whole(number));
    }

    pub(super) fn read(bytes: &mut ByteReader<'_>, columns: usize) -> Result<Self, PartsError> {
        let is_first = bytes.whole()? == 1;
        let metric =
            Estimate { center: bytes.floats()?, tail: bytes.floats()?, matrix: bytes.floats()? };
        let kind = match (bytes.whole()?, bytes.whole()?, bytes.whole()?) {
            (0, low, width) if width > 0 => Kind::Count { low, width },
            (1, low, high) => Kind::Border { low, high },
            _ => return Err(bytes.wrong()),
        };
        let fits = columns > 0
            && metric.center.len() == columns
            && (metric.tail.is_empty() || metric.tail.len() == columns)
            && columns.checked_mul(columns) == Some(metric.matrix.len());
        if fits { Ok(ShellQuestion { is_first, metric, kind }) } else { Err(bytes.wrong()) }
    }
}

/// The answer of some rows.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum ShellBody {
    Count(Vec<u64>),
    Border { sums: BlockSums, border: Vec<Far> },
}

impl ShellBody {
    pub(super) fn merge(self, other: Self) -> Result<Self, PartsError> {
        match (self, other) {
            (ShellBody::Count(mut counts), ShellBody::Count(others)) => {
                counts.iter_mut().zip(others).for_each(|(count, other)| *count += other);
                Ok(ShellBody::Count(counts))
            }
            (
                ShellBody::Border { mut sums, mut border },
                ShellBody::Border { sums: others, border: more },
            ) => {
                others.nodes.into_iter().for_each(|((level, index), moments)| {
                    sums.add(level, index, moments);
                });
                border.extend(more);
                Ok(ShellBody::Border { sums, border })
            }
            _ => Err(PartsError::Question),
        }
    }

    /// The numbers of the rows that it names.
    pub(super) fn rows(&self) -> BTreeSet<u64> {
        match self {
            ShellBody::Count(_) => BTreeSet::new(),
            ShellBody::Border { border, .. } => border.iter().map(|far| far.id).collect(),
        }
    }

    pub(super) fn write(&self, bytes: &mut ByteWriter) {
        match self {
            ShellBody::Count(counts) => {
                bytes.whole(0);
                bytes.wholes(counts);
            }
            ShellBody::Border { sums, border } => {
                bytes.whole(1);
                bytes.count(sums.nodes.len());
                for (&(level, index), moments) in &sums.nodes {
                    [level, index].into_iter().for_each(|number| bytes.whole(number));
                    moments.write(bytes);
                }
                write_far(bytes, border);
            }
        }
    }

    pub(super) fn read(bytes: &mut ByteReader<'_>, columns: usize) -> Result<Self, PartsError> {
        match bytes.whole()? {
            0 => {
                let counts = bytes.wholes()?;
                let fits = counts.len() == SHELLS + 2;
                if fits { Ok(ShellBody::Count(counts)) } else { Err(bytes.wrong()) }
            }
            1 => {
                let mut nodes = BTreeMap::new();
                for _ in 0..bytes.count(16)? {
                    let place = (bytes.whole()?, bytes.whole()?);
                    // No row number, and so no block, is beyond this.
                    if place.0 >= 64 || place.1 > u64::MAX >> place.0 {
                        return Err(bytes.wrong());
                    }
                    nodes.insert(place, Moments::read(bytes, columns)?);
                }
                Ok(ShellBody::Border { sums: BlockSums { nodes }, border: read_far(bytes)? })
            }
            _ => Err(bytes.wrong()),
        }
    }
}

/// Moments of blocks: node i of level l is that of the 2ˡ blocks from i·2ˡ on, and two nodes that make one of the next level become it.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct BlockSums {
    nodes: BTreeMap<(u64, u64), Moments>,
}

impl BlockSums {
    fn add(&mut self, mut level: u64, mut index: u64, mut moments: Moments) {
        while let Some(sibling) = self.nodes.remove(&(level, index ^ 1)) {
            let (mut first, second) =
                if index.is_multiple_of(2) { (moments, sibling) } else { (sibling, moments) };
            first.merge(&second);
            (moments, level, index) = (first, level + 1, index / 2);
        }
        self.nodes.insert((level, index), moments);
    }

    /// The moments of all blocks, in their order.
    fn total(self, dim: usize) -> Moments {
        let mut nodes: Vec<(u64, Moments)> =
            self.nodes.into_iter().map(|((level, index), node)| (index << level, node)).collect();
        nodes.order_by_key(|(first, _)| *first);
        let mut all = Moments::nothing(dim);
        nodes.iter().for_each(|(_, node)| all.merge(node));
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Thirteen blocks whose sums round: in any order, and in any two parts, they have the same bits.
    #[test]
    fn sums_do_not_depend_on_parts() {
        let metric = Estimate { center: vec![0.1], tail: vec![], matrix: vec![1.3] };
        let block = |number: u64| {
            let rows: Vec<f64> = (0..9).map(|i| 1.0 / (1.0 + (9 * number + i) as f64)).collect();
            metric.moments_of(&rows, |_| true)
        };
        let sum = |numbers: &[u64]| {
            let mut sums = BlockSums::default();
            numbers.iter().for_each(|&number| sums.add(0, number, block(number)));
            sums
        };
        let all: Vec<u64> = (0..13).collect();
        let wanted = sum(&all).total(1);
        let plain = all.iter().map(|&number| block(number)).reduce(|mut a, b| {
            a.merge(&b);
            a
        });
        assert_ne!(plain.unwrap(), wanted, "these sums do not round, and show nothing");
        for cut in 0..13 {
            let (late, early) = (&all[cut..], &all[..cut]);
            assert_eq!(sum(&[late, early].concat()).total(1), wanted);
            let border = vec![];
            let part =
                |numbers: &[u64]| ShellBody::Border { sums: sum(numbers), border: border.clone() };
            let ShellBody::Border { sums, .. } = part(late).merge(part(early)).unwrap() else {
                panic!("a border merged with a border is one");
            };
            assert_eq!(sums.nodes.len(), 3, "13 = 8 + 4 + 1");
            assert_eq!(sums.total(1), wanted);
        }
    }
}
