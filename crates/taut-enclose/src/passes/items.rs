//! The questions of the ball: which items reach farthest, and how far coordinates spread.

use std::collections::BTreeSet;

use taut_certify::Items;
use taut_kernels::Center;
use taut_points::{
    BlockHash, ByteReader, ByteWriter, Elsewhere, Monitor, PartsError, PointSource, PointsHash,
};

use super::partial::Body;
use super::query::Question;
use crate::Error;
use crate::item_reader::{Found, Pass, Query as PassQuery, View, farther, spread};
use crate::top::{Far, Top, TopByFace};

/// A pass over items.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ItemQuestion {
    view: View,
    center: Center,
    kind: Kind,
}

#[derive(Clone, Debug, PartialEq)]
enum Kind {
    /// The items that reach farthest; a first pass also hashes rows and refuses those that are no items.
    Farthest { is_first: bool, above: f64, keep: usize, by_face_above: Option<f64> },
    /// How far coordinates spread.
    Spread,
}

/// The answer of a first pass.
pub(crate) struct FirstAnswer {
    pub(crate) found: Found,
    pub(crate) hash: PointsHash,
    /// The largest radius, in the place of a reach; balls only.
    pub(crate) largest: Option<Far>,
    /// True if a square exceeded the largest `f64`.
    pub(crate) overflow: bool,
}

/// Makes the first pass over rows that are held elsewhere.
pub(crate) fn ask_first(
    elsewhere: &dyn Elsewhere,
    source: &dyn PointSource,
    view: &View,
    query: PassQuery<'_>,
) -> Result<FirstAnswer, Error> {
    let partial = Question::Items(ItemQuestion::of(view, query, true)).ask(elsewhere, source)?;
    let hash = partial.hash()?;
    match partial.body {
        Body::Items(ItemBody::Farthest { found, first: Some(first), .. }) => {
            Ok(FirstAnswer { found, hash, largest: first.largest, overflow: first.overflow })
        }
        _ => Err(PartsError::Question.into()),
    }
}

/// Makes a pass over rows that are held elsewhere.
pub(crate) fn ask_items(
    elsewhere: &dyn Elsewhere,
    source: &dyn PointSource,
    view: &View,
    query: PassQuery<'_>,
) -> Result<Found, Error> {
    match Question::Items(ItemQuestion::of(view, query, false)).ask(elsewhere, source)?.body {
        Body::Items(ItemBody::Farthest { found, .. }) => Ok(found),
        _ => Err(PartsError::Question.into()),
    }
}

/// Measures the spread of rows that are held elsewhere.
pub(crate) fn ask_spread(
    elsewhere: &dyn Elsewhere,
    source: &dyn PointSource,
    view: &View,
    center: &Center,
) -> Result<(f64, f64), Error> {
    let question = ItemQuestion { view: view.clone(), center: center.clone(), kind: Kind::Spread };
    match Question::Items(question).ask(elsewhere, source)?.body {
        Body::Items(ItemBody::Spread { spread, largest }) => Ok((spread, largest)),
        _ => Err(PartsError::Question.into()),
    }
}

impl ItemQuestion {
    fn of(view: &View, query: PassQuery<'_>, is_first: bool) -> Self {
        let PassQuery { center, above, keep, by_face_above } = query;
        let kind = Kind::Farthest { is_first, above, keep, by_face_above };
        ItemQuestion { view: view.clone(), center: center.clone(), kind }
    }

    /// The answer of some rows, and in a first pass the hashes of their blocks.
    pub(super) fn run(
        &self,
        part: &dyn PointSource,
        first_row: u64,
        monitor: &Monitor<'_>,
    ) -> Result<(Option<Vec<BlockHash>>, Body), Error> {
        let (is_first, query) = match self.kind {
            Kind::Spread => {
                let (spread, largest) = spread(part, &self.view, &self.center, monitor)?;
                return Ok((None, Body::Items(ItemBody::Spread { spread, largest })));
            }
            Kind::Farthest { is_first, above, keep, by_face_above } => {
                (is_first, PassQuery { center: &self.center, above, keep, by_face_above })
            }
        };
        let keep = query.keep;
        let pass = Pass::new(&self.view, query, first_row);
        if !is_first {
            let found = pass.run(part, monitor)?;
            return Ok((None, Body::Items(ItemBody::Farthest { keep, found, first: None })));
        }
        let report = pass.first(part, monitor)?;
        let first = Some(First { largest: report.largest, overflow: report.overflow });
        let body = ItemBody::Farthest { keep, found: report.found, first };
        Ok((Some(report.hashes), Body::Items(body)))
    }

    pub(super) fn write(&self, bytes: &mut ByteWriter) {
        let View { items, dim: _, scale, shift } = &self.view;
        bytes.whole(u64::from(*items == Items::Balls));
        bytes.float(*scale);
        bytes.floats(shift);
        bytes.floats(&self.center.high);
        bytes.floats(&self.center.low);
        match self.kind {
            Kind::Spread => bytes.whole(0),
            Kind::Farthest { is_first, above, keep, by_face_above } => {
                bytes.whole(if is_first { 2 } else { 1 });
                bytes.float(above);
                bytes.count(keep);
                bytes.floats(by_face_above.as_slice());
            }
        }
    }

    pub(super) fn read(bytes: &mut ByteReader<'_>, columns: usize) -> Result<Self, PartsError> {
        let items = if bytes.whole()? == 1 { Items::Balls } else { Items::Points };
        let (scale, shift) = (bytes.float()?, bytes.floats()?);
        let center = Center { high: bytes.floats()?, low: bytes.floats()? };
        let dim = items.dim(columns);
        let fits = |list: &[f64]| list.is_empty() || list.len() == dim;
        if dim == 0 || center.high.len() != dim || !fits(&center.low) || !fits(&shift) {
            return Err(bytes.wrong());
        }
        let kind = match bytes.whole()? {
            0 => Kind::Spread,
            number @ 1..=2 => Kind::Farthest {
                is_first: number == 2,
                above: bytes.float()?,
                keep: bytes.size()?,
                by_face_above: bytes.floats()?.first().copied(),
            },
            _ => return Err(bytes.wrong()),
        };
        Ok(ItemQuestion { view: View { items, dim, scale, shift }, center, kind })
    }
}

/// The answer of some items.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum ItemBody {
    Farthest { keep: usize, found: Found, first: Option<First> },
    Spread { spread: f64, largest: f64 },
}

/// The largest row and whether squares overflow, which a first pass finds as well.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct First {
    largest: Option<Far>,
    overflow: bool,
}

impl ItemBody {
    pub(super) fn merge(self, other: Self) -> Result<Self, PartsError> {
        match (self, other) {
            (
                ItemBody::Farthest { keep, found, first: a },
                ItemBody::Farthest { keep: same, found: other, first: b },
            ) if keep == same && a.is_some() == b.is_some() => {
                let first = a.zip(b).map(|(a, b)| First {
                    largest: a.largest.into_iter().chain(b.largest).reduce(farther),
                    overflow: a.overflow || b.overflow,
                });
                Ok(ItemBody::Farthest { keep, found: found.merge(other, keep), first })
            }
            (
                ItemBody::Spread { spread, largest },
                ItemBody::Spread { spread: other, largest: another },
            ) => Ok(ItemBody::Spread { spread: spread.max(other), largest: largest.max(another) }),
            _ => Err(PartsError::Question),
        }
    }

    /// The numbers of the rows that it names.
    pub(super) fn rows(&self) -> BTreeSet<u64> {
        let ItemBody::Farthest { found, first, .. } = self else { return BTreeSet::new() };
        let faces = found.by_face.items().map(|(_, far)| far);
        let largest = first.and_then(|first| first.largest);
        let all = [found.farthest].into_iter().chain(found.far.iter().copied()).chain(faces);
        all.chain(largest).map(|far| far.id).collect()
    }

    pub(super) fn write(&self, bytes: &mut ByteWriter) {
        let write_far = |bytes: &mut ByteWriter, far: &Far| {
            bytes.whole(far.id);
            bytes.float(far.reach2);
        };
        match self {
            ItemBody::Spread { spread, largest } => {
                bytes.whole(0);
                bytes.float(*spread);
                bytes.float(*largest);
            }
            ItemBody::Farthest { keep, found, first } => {
                bytes.whole(if first.is_some() { 2 } else { 1 });
                bytes.count(*keep);
                write_far(bytes, &found.farthest);
                bytes.count(found.far.len());
                found.far.iter().for_each(|far| write_far(bytes, far));
                let faces: Vec<_> = found.by_face.items().collect();
                bytes.count(faces.len());
                for ((axis, is_below), far) in &faces {
                    bytes.count(2 * axis + usize::from(*is_below));
                    write_far(bytes, far);
                }
                if let Some(First { largest, overflow }) = first {
                    bytes.whole(u64::from(*overflow));
                    bytes.whole(u64::from(largest.is_some()));
                    largest.iter().for_each(|far| write_far(bytes, far));
                }
            }
        }
    }

    pub(super) fn read(bytes: &mut ByteReader<'_>) -> Result<Self, PartsError> {
        fn far(bytes: &mut ByteReader<'_>) -> Result<Far, PartsError> {
            Ok(Far { id: bytes.whole()?, reach2: bytes.float()? })
        }
        let has_first = match bytes.whole()? {
            0 => {
                let (spread, largest) = (bytes.float()?, bytes.float()?);
                return Ok(ItemBody::Spread { spread, largest });
            }
            number @ 1..=2 => number == 2,
            _ => return Err(bytes.wrong()),
        };
        let keep = bytes.size()?;
        let farthest = far(bytes)?;
        let mut top = Top::new(keep);
        for _ in 0..bytes.count(16)? {
            top.offer(far(bytes)?);
        }
        let mut by_face = TopByFace::default();
        for _ in 0..bytes.count(24)? {
            let face = bytes.size()?;
            by_face.offer((face / 2, face % 2 == 1), far(bytes)?);
        }
        let found = Found { farthest, far: top.into_sorted(), by_face };
        let mut first = None;
        if has_first {
            let overflow = bytes.whole()? == 1;
            let has_largest = bytes.whole()? == 1;
            let largest = if has_largest { Some(far(bytes)?) } else { None };
            first = Some(First { largest, overflow });
        }
        Ok(ItemBody::Farthest { keep, found, first })
    }
}
