//! The questions that the ellipsoid asks of all points: what each is, its answer over some of them, and how answers merge.
//!
//! All are largest values and lists under a total order, except for the rows that a pass takes with it, of which each block
//! of rows gives a share: so they do not depend on how blocks are divided.

use std::collections::BTreeSet;

use taut_kernels::Center;
use taut_kernels::compensated::Map;
use taut_points::{
    BlockHash, ByteReader, ByteWriter, InputError, Monitor, PartsError, PointSource,
};

use super::flat::Span;
use super::point_reader::{Query, TakenRows, measure, take, visit};
use super::proof;
use crate::Error;
use crate::item_reader::farther;
use crate::top::{Far, Top};

/// A question about all points.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Question {
    /// The map and center, or the basis and origin, that it is about.
    pub(crate) matrix: Vec<f64>,
    pub(crate) center: Center,
    pub(crate) kind: Kind,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Kind {
    /// The points beyond a threshold with the largest |M(x − c)|², so many.
    Leverage { above: f64, keep: usize },
    /// These points with their rows: of each block a share.
    Take { above: f64, share: f64 },
    /// Tests whether coordinates are finite.
    Finite,
    /// The point farthest outside a span.
    Span,
    /// The points beyond a threshold, measured with twice the digits.
    Border { near: f64 },
}

/// The answer of some points.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Answer {
    Leverage {
        keep: usize,
        /// Infinite where a square is no `f64`.
        largest: f64,
        far: Vec<Far>,
    },
    /// `None` where a square is no `f64`.
    Take(Option<TakenIds>),
    Finite,
    /// A distance in the place of its square.
    Span(Far),
    Border(Vec<Far>),
}

/// The rows that a pass takes with it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct TakenIds {
    /// Ascending.
    pub(crate) ids: Vec<u64>,
    /// No other row is above this.
    pub(crate) above: f64,
}

impl Question {
    /// The answer of some points, and in a first pass the hashes of their blocks.
    pub(crate) fn run(
        &self,
        part: &dyn PointSource,
        first_row: u64,
        is_first: bool,
        monitor: &Monitor<'_>,
    ) -> Result<(Option<Vec<BlockHash>>, Answer), Error> {
        self.run_from_zero(part, is_first, monitor)
            .map(|(hashes, answer)| (hashes, answer.moved(first_row)))
            .map_err(|error| match error {
                Error::Input(InputError::NonFinite { row, column, value }) => {
                    InputError::NonFinite { row: first_row + row, column, value }.into()
                }
                other => other,
            })
    }

    /// The same, with rows numbered from 0 on.
    fn run_from_zero(
        &self,
        part: &dyn PointSource,
        is_first: bool,
        monitor: &Monitor<'_>,
    ) -> Result<(Option<Vec<BlockHash>>, Answer), Error> {
        let query = |above, keep| Query { matrix: &self.matrix, center: &self.center, above, keep };
        let (hashes, answer): (Vec<Option<BlockHash>>, Answer) = match self.kind {
            Kind::Leverage { above, keep } => {
                let (found, hashes) = measure(part, monitor, query(above, keep), is_first)?;
                (hashes, Answer::Leverage { keep, largest: found.largest, far: found.far })
            }
            Kind::Take { above, share } => {
                let (taken, hashes) = take(part, monitor, query(above, 0), share, is_first)?;
                let ids = |TakenRows { ids, above, .. }| TakenIds { ids, above };
                (hashes, Answer::Take(taken.map(ids)))
            }
            Kind::Finite => {
                let blocks = visit(part, monitor, is_first, |_, _| ())?;
                (blocks.into_iter().map(|block| block.1).collect(), Answer::Finite)
            }
            Kind::Span => {
                let span = Span::of_question(&self.matrix, &self.center);
                let blocks = visit(part, monitor, is_first, |first, rows| {
                    span.farthest_of_block(first, rows)
                })?;
                let far = blocks.iter().map(|block| block.0).reduce(farther);
                let far = far.unwrap_or(Far { id: 0, reach2: 0.0 });
                (blocks.into_iter().map(|block| block.1).collect(), Answer::Span(far))
            }
            Kind::Border { near } => {
                let map = Map { matrix: &self.matrix, center: &self.center, triangular: true };
                let blocks = visit(part, monitor, is_first, |first, rows| {
                    proof::border_of_block(map, near, first, rows)
                })?;
                let mut all = Top::new(proof::MEASURED_POINTS_MAX);
                let mut hashes = vec![];
                for (list, hash) in blocks {
                    all.merge(list);
                    hashes.push(hash);
                }
                (hashes, Answer::Border(all.into_sorted()))
            }
        };
        Ok((is_first.then(|| hashes.into_iter().flatten().collect()), answer))
    }

    pub(crate) fn write(&self, bytes: &mut ByteWriter) {
        bytes.floats(&self.matrix);
        bytes.floats(&self.center.high);
        bytes.floats(&self.center.low);
        match self.kind {
            Kind::Leverage { above, keep } => {
                bytes.whole(0);
                bytes.float(above);
                bytes.count(keep);
            }
            Kind::Take { above, share } => {
                bytes.whole(1);
                bytes.float(above);
                bytes.float(share);
            }
            Kind::Finite => bytes.whole(2),
            Kind::Span => bytes.whole(3),
            Kind::Border { near } => {
                bytes.whole(4);
                bytes.float(near);
            }
        }
    }

    pub(crate) fn read(bytes: &mut ByteReader<'_>, columns: usize) -> Result<Self, PartsError> {
        let matrix = bytes.floats()?;
        let center = Center { high: bytes.floats()?, low: bytes.floats()? };
        let kind = match bytes.whole()? {
            0 => Kind::Leverage { above: bytes.float()?, keep: bytes.size()? },
            1 => Kind::Take { above: bytes.float()?, share: bytes.float()? },
            2 => Kind::Finite,
            3 => Kind::Span,
            4 => Kind::Border { near: bytes.float()? },
            _ => return Err(bytes.wrong()),
        };
        let is_square = matrix.len() == columns.saturating_mul(columns);
        let fits = match kind {
            Kind::Finite => true,
            Kind::Span => {
                matrix.len().is_multiple_of(columns.max(1)) && center.low.len() == columns
            }
            _ => is_square && (center.low.is_empty() || center.low.len() == columns),
        };
        if !fits || kind != Kind::Finite && center.high.len() != columns {
            return Err(bytes.wrong());
        }
        Ok(Question { matrix, center, kind })
    }
}

impl Answer {
    /// Returns the answer with row numbers that begin later.
    fn moved(mut self, first_row: u64) -> Self {
        match &mut self {
            Answer::Leverage { far, .. } | Answer::Border(far) => {
                far.iter_mut().for_each(|far| far.id += first_row);
            }
            Answer::Take(Some(taken)) => taken.ids.iter_mut().for_each(|id| *id += first_row),
            Answer::Span(far) => far.id += first_row,
            Answer::Take(None) | Answer::Finite => {}
        }
        self
    }

    pub(crate) fn merge(self, other: Self) -> Result<Self, PartsError> {
        fn lists(keep: usize, a: Vec<Far>, b: Vec<Far>) -> Vec<Far> {
            let mut top = Top::new(keep);
            a.into_iter().chain(b).for_each(|far| top.offer(far));
            top.into_sorted()
        }
        match (self, other) {
            (
                Answer::Leverage { keep, largest, far },
                Answer::Leverage { keep: same, largest: other, far: more },
            ) if keep == same => Ok(Answer::Leverage {
                keep,
                largest: largest.max(other),
                far: lists(keep, far, more),
            }),
            (Answer::Take(a), Answer::Take(b)) => Ok(Answer::Take(a.zip(b).map(|(mut a, b)| {
                a.ids.extend(b.ids);
                a.ids.sort_unstable();
                TakenIds { ids: a.ids, above: a.above.max(b.above) }
            }))),
            (Answer::Finite, Answer::Finite) => Ok(Answer::Finite),
            (Answer::Span(a), Answer::Span(b)) => Ok(Answer::Span(farther(a, b))),
            (Answer::Border(a), Answer::Border(b)) => {
                Ok(Answer::Border(lists(proof::MEASURED_POINTS_MAX, a, b)))
            }
            _ => Err(PartsError::Question),
        }
    }

    /// The numbers of the rows that it names and that a solver will ask for.
    pub(crate) fn rows(&self) -> BTreeSet<u64> {
        match self {
            Answer::Leverage { far, .. } => far.iter().map(|far| far.id).collect(),
            Answer::Take(Some(taken)) => taken.ids.iter().copied().collect(),
            Answer::Span(far) => BTreeSet::from([far.id]),
            // Few of them come near enough: these are asked for by number.
            Answer::Border(_) | Answer::Take(None) | Answer::Finite => BTreeSet::new(),
        }
    }

    pub(crate) fn write(&self, bytes: &mut ByteWriter) {
        let write_fars = |bytes: &mut ByteWriter, far: &[Far]| {
            bytes.count(far.len());
            for far in far {
                bytes.whole(far.id);
                bytes.float(far.reach2);
            }
        };
        match self {
            Answer::Leverage { keep, largest, far } => {
                bytes.whole(0);
                bytes.count(*keep);
                bytes.float(*largest);
                write_fars(bytes, far);
            }
            Answer::Take(None) => bytes.whole(1),
            Answer::Take(Some(taken)) => {
                bytes.whole(2);
                bytes.wholes(&taken.ids);
                bytes.float(taken.above);
            }
            Answer::Finite => bytes.whole(3),
            Answer::Span(far) => {
                bytes.whole(4);
                write_fars(bytes, &[*far]);
            }
            Answer::Border(far) => {
                bytes.whole(5);
                write_fars(bytes, far);
            }
        }
    }

    pub(crate) fn read(bytes: &mut ByteReader<'_>) -> Result<Self, PartsError> {
        fn fars(bytes: &mut ByteReader<'_>, keep: usize) -> Result<Vec<Far>, PartsError> {
            let mut top = Top::new(keep);
            for _ in 0..bytes.count(16)? {
                top.offer(Far { id: bytes.whole()?, reach2: bytes.float()? });
            }
            Ok(top.into_sorted())
        }
        Ok(match bytes.whole()? {
            0 => {
                let (keep, largest) = (bytes.size()?, bytes.float()?);
                Answer::Leverage { keep, largest, far: fars(bytes, keep)? }
            }
            1 => Answer::Take(None),
            2 => Answer::Take(Some(TakenIds { ids: bytes.wholes()?, above: bytes.float()? })),
            3 => Answer::Finite,
            4 => Answer::Span(*fars(bytes, 1)?.first().ok_or(bytes.wrong())?),
            5 => Answer::Border(fars(bytes, proof::MEASURED_POINTS_MAX)?),
            _ => return Err(bytes.wrong()),
        })
    }
}
