//! The questions of a farthest-first traversal: how far coordinates reach, and which rows are farthest from the nearest of some centers.

use std::collections::BTreeSet;

use taut_kernels::Center;
use taut_kernels::extremes::largest;
use taut_points::{
    BlockHash, ByteReader, ByteWriter, Elsewhere, Monitor, PartsError, PointSource, PointsHash,
    Rows, Scalar, map_blocks,
};

use super::partial::Body;
use super::query::{Question, among_all};
use crate::Error;
use crate::frame::{Extent, Frame, extent_and_hashes};
use crate::streaming::nearest_squares;
use crate::top::{Far, Top};

#[derive(Clone, Debug, PartialEq)]
pub(super) enum TraversalQuestion {
    /// The extent of all rows, which are hashed, and refused if they are not finite.
    Extent,
    /// The rows farthest from the nearest of some centers, so many; centers and distances are in the units of a frame.
    Farthest { frame: Frame, centers: Vec<Vec<f64>>, keep: usize },
}

/// Measures the extent of rows that are held elsewhere.
pub(crate) fn ask_extent(
    elsewhere: &dyn Elsewhere,
    source: &dyn PointSource,
) -> Result<(Extent, PointsHash), Error> {
    let partial = Question::Traversal(TraversalQuestion::Extent).ask(elsewhere, source)?;
    let hash = partial.hash()?;
    match partial.body {
        Body::Traversal(TraversalBody::Extent(extent)) if extent.low.len() == source.dim() => {
            Ok((extent, hash))
        }
        _ => Err(PartsError::Question.into()),
    }
}

/// The rows, held elsewhere, that are farthest from the nearest of some centers, the farthest first.
pub(crate) fn ask_farthest(
    elsewhere: &dyn Elsewhere,
    source: &dyn PointSource,
    frame: &Frame,
    centers: &[Vec<f64>],
    keep: usize,
) -> Result<Vec<Far>, Error> {
    let centers = centers.to_vec();
    let question = TraversalQuestion::Farthest { frame: frame.clone(), centers, keep };
    match Question::Traversal(question).ask(elsewhere, source)?.body {
        Body::Traversal(TraversalBody::Farthest { far, .. }) => Ok(far),
        _ => Err(PartsError::Question.into()),
    }
}

impl TraversalQuestion {
    /// The answer of some rows, and with the extent the hashes of their blocks.
    pub(super) fn run(
        &self,
        part: &dyn PointSource,
        first_row: u64,
        monitor: &Monitor<'_>,
    ) -> Result<(Option<Vec<BlockHash>>, Body), Error> {
        match self {
            TraversalQuestion::Extent => {
                let surveyed = extent_and_hashes(part, monitor);
                let (extent, hashes) = surveyed.map_err(|error| among_all(error, first_row))?;
                Ok((Some(hashes), Body::Traversal(TraversalBody::Extent(extent))))
            }
            TraversalQuestion::Farthest { frame, centers, keep } => {
                let far = farthest(part, first_row, frame, centers, *keep, monitor)?;
                Ok((None, Body::Traversal(TraversalBody::Farthest { keep: *keep, far })))
            }
        }
    }

    pub(super) fn write(&self, bytes: &mut ByteWriter) {
        match self {
            TraversalQuestion::Extent => bytes.whole(0),
            TraversalQuestion::Farthest { frame, centers, keep } => {
                bytes.whole(1);
                frame.write(bytes);
                bytes.count(*keep);
                bytes.count(centers.len());
                centers.iter().for_each(|center| bytes.floats(center));
            }
        }
    }

    pub(super) fn read(bytes: &mut ByteReader<'_>, columns: usize) -> Result<Self, PartsError> {
        match bytes.whole()? {
            0 => Ok(TraversalQuestion::Extent),
            1 => {
                let frame = Frame::read(bytes, columns)?;
                let keep = bytes.size()?;
                let count = bytes.count(8)?;
                let centers = (0..count).map(|_| bytes.floats()).collect::<Result<Vec<_>, _>>()?;
                if centers.is_empty() || centers.iter().any(|center| center.len() != columns) {
                    return Err(bytes.wrong());
                }
                Ok(TraversalQuestion::Farthest { frame, centers, keep })
            }
            _ => Err(bytes.wrong()),
        }
    }
}

fn farthest(
    part: &dyn PointSource,
    first_row: u64,
    frame: &Frame,
    centers: &[Vec<f64>],
    keep: usize,
    monitor: &Monitor<'_>,
) -> Result<Vec<Far>, Error> {
    let center = |high: &Vec<f64>| Center { high: high.clone(), low: vec![] };
    let (centers, dim): (Vec<Center>, usize) = (centers.iter().map(center).collect(), part.dim());
    let blocks = map_blocks(part, monitor, |first, rows| {
        let mut top = Top::new(keep);
        let first = first_row + first;
        match rows {
            Rows::F32(points) if frame.is_plain() => {
                list(points.values(), dim, &centers, first, &mut top);
            }
            Rows::F64(points) if frame.is_plain() => {
                list(points.values(), dim, &centers, first, &mut top);
            }
            Rows::F32(points) => list(&frame.copy(&points), dim, &centers, first, &mut top),
            Rows::F64(points) => list(&frame.copy(&points), dim, &centers, first, &mut top),
        }
        Ok::<_, Error>(top)
    })?;
    let mut all = Top::new(keep);
    blocks.into_iter().for_each(|block| all.merge(block));
    Ok(all.into_sorted())
}

/// Offers rows, numbered from `first` on, with their squared distances to the nearest center.
fn list<T: Scalar>(values: &[T], dim: usize, centers: &[Center], first: u64, top: &mut Top) {
    nearest_squares(values, dim, centers, |at, least| {
        if largest(least) < top.bound() {
            return;
        }
        for (id, &reach2) in (first + at as u64..).zip(least) {
            if reach2 >= top.bound() {
                top.offer(Far { id, reach2 });
            }
        }
    });
}

/// The answer of some rows.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum TraversalBody {
    Extent(Extent),
    Farthest { keep: usize, far: Vec<Far> },
}

impl TraversalBody {
    pub(super) fn merge(self, other: Self) -> Result<Self, PartsError> {
        match (self, other) {
            (TraversalBody::Extent(mut a), TraversalBody::Extent(b))
                if a.low.len() == b.low.len() =>
            {
                a.merge(&b);
                Ok(TraversalBody::Extent(a))
            }
            (
                TraversalBody::Farthest { keep, far },
                TraversalBody::Farthest { keep: same, far: other },
            ) if keep == same => {
                let mut top = Top::new(keep);
                far.into_iter().chain(other).for_each(|far| top.offer(far));
                Ok(TraversalBody::Farthest { keep, far: top.into_sorted() })
            }
            _ => Err(PartsError::Question),
        }
    }

    /// The numbers of the rows that it names.
    pub(super) fn rows(&self) -> BTreeSet<u64> {
        match self {
            TraversalBody::Extent(_) => BTreeSet::new(),
            TraversalBody::Farthest { far, .. } => far.iter().map(|far| far.id).collect(),
        }
    }

    pub(super) fn write(&self, bytes: &mut ByteWriter) {
        match self {
            TraversalBody::Extent(Extent { low, high }) => {
                bytes.whole(0);
                bytes.floats(low);
                bytes.floats(high);
            }
            TraversalBody::Farthest { keep, far } => {
                bytes.whole(1);
                bytes.count(*keep);
                write_far(bytes, far);
            }
        }
    }

    pub(super) fn read(bytes: &mut ByteReader<'_>) -> Result<Self, PartsError> {
        match bytes.whole()? {
            0 => {
                let (low, high) = (bytes.floats()?, bytes.floats()?);
                if low.len() != high.len() {
                    return Err(bytes.wrong());
                }
                Ok(TraversalBody::Extent(Extent { low, high }))
            }
            1 => {
                let keep = bytes.size()?;
                let mut top = Top::new(keep);
                read_far(bytes)?.into_iter().for_each(|far| top.offer(far));
                Ok(TraversalBody::Farthest { keep, far: top.into_sorted() })
            }
            _ => Err(bytes.wrong()),
        }
    }
}

/// Writes a list of rows and how far they reach.
pub(super) fn write_far(bytes: &mut ByteWriter, far: &[Far]) {
    bytes.count(far.len());
    for far in far {
        bytes.whole(far.id);
        bytes.float(far.reach2);
    }
}

/// Reads what [`write_far`] wrote.
pub(super) fn read_far(bytes: &mut ByteReader<'_>) -> Result<Vec<Far>, PartsError> {
    let count = bytes.count(16)?;
    (0..count).map(|_| Ok(Far { id: bytes.whole()?, reach2: bytes.float()? })).collect()
}
