//! Passes over all points: whose leverage is largest.
//!
//! A pass is one read of the source in fixed blocks on all threads. It lists points under a total order, so the result
//! does not depend on how threads meet them. The first pass also hashes the points and refuses what is not finite.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

use taut_points::{
    BlockHash, Monitor, PointSource, Points, PointsHash, Rows, Scalar, gather, hash_block,
    map_blocks,
};

use crate::Error;
use crate::kernel::Center;
use crate::kernel::extremes::{all_finite, largest};
use crate::kernel::triangle::leverages;
use crate::top::{Far, Top};

/// Rows whose leverages are worked out before they are compared.
const ROWS_AT_ONCE: usize = 256;
/// Leverages that one comparison disposes of, where some of those at once are large.
const GROUP: usize = 32;

/// What a pass is to look for.
#[derive(Clone, Copy)]
pub(super) struct Query<'q> {
    /// M, lower triangular by rows.
    pub(super) matrix: &'q [f64],
    /// c.
    pub(super) center: &'q Center,
    /// Only points with |M(x − c)|² above this are listed.
    pub(super) above: f64,
    /// How many of them at most.
    pub(super) keep: usize,
}

/// What a pass found.
pub(super) struct Found {
    /// The largest |M(x − c)|²; infinite where a square is no `f64`.
    pub(super) largest: f64,
    /// Points above the threshold, the farthest first.
    pub(super) far: Vec<Far>,
    /// Every point beyond this is in `far`.
    pub(super) listed_above: f64,
}

/// The points of a source, as a solver sees them.
pub(crate) struct Survey<'a> {
    source: &'a dyn PointSource,
    monitor: &'a Monitor<'a>,
    passes: u64,
    hash: Option<PointsHash>,
}

struct BlockReport {
    largest: f64,
    finite: bool,
    hash: Option<BlockHash>,
}

impl<'a> Survey<'a> {
    pub(crate) fn new(
        source: &'a dyn PointSource,
        monitor: &'a Monitor<'a>,
    ) -> Result<Self, Error> {
        if source.is_empty() {
            return Err(Error::Empty);
        }
        Ok(Survey { source, monitor, passes: 0, hash: None })
    }

    pub(crate) fn dim(&self) -> usize {
        self.source.dim()
    }

    pub(crate) fn len(&self) -> u64 {
        self.source.len()
    }

    pub(crate) fn source(&self) -> &'a dyn PointSource {
        self.source
    }

    pub(crate) fn monitor(&self) -> &'a Monitor<'a> {
        self.monitor
    }

    pub(crate) fn passes(&self) -> u64 {
        self.passes
    }

    /// Adds the passes that were made over the same points in other coordinates.
    pub(crate) fn count(&mut self, passes: u64) {
        self.passes += passes;
    }

    /// The hash of the rows; known after the first pass.
    pub(crate) fn hash(&self) -> PointsHash {
        self.hash.expect("the first pass hashes the rows")
    }

    /// The rows with the given numbers.
    pub(crate) fn rows(&self, ids: &[u64]) -> Result<Vec<f64>, Error> {
        Ok(gather(self.source, ids)?)
    }

    /// The same, relative to an origin.
    pub(super) fn rows_from(&self, origin: &[f64], ids: &[u64]) -> Result<Vec<f64>, Error> {
        let mut rows = self.rows(ids)?;
        for row in rows.chunks_exact_mut(origin.len()) {
            row.iter_mut().zip(origin).for_each(|(x, o)| *x -= o);
        }
        Ok(rows)
    }

    fn begin_pass(&mut self) {
        self.passes += 1;
        self.monitor.pass(self.passes, self.len());
    }

    /// One pass of another kind: calls `work` with the number of the first row and the rows of each block.
    pub(crate) fn visit<R: Send>(
        &mut self,
        work: impl Fn(u64, &[f64]) -> R + Sync,
    ) -> Result<Vec<R>, Error> {
        self.begin_pass();
        let first = self.hash.is_none();
        let reports = map_blocks(self.source, self.monitor, |row, rows| {
            let mut hash = None;
            if first {
                if let Some((at, column, value)) = rows.first_non_finite() {
                    return Err(Error::NonFinite { row: row + at as u64, column, value });
                }
                hash = Some(hash_block(&rows));
            }
            let result = match rows {
                Rows::F64(points) => work(row, points.values()),
                Rows::F32(points) => {
                    let values: Vec<f64> = points.values().iter().map(|&v| v.into()).collect();
                    work(row, &values)
                }
            };
            Ok((result, hash))
        })?;
        if first {
            let hashes = reports.iter().filter_map(|report| report.1);
            self.hash = Some(PointsHash::of_blocks(self.len(), self.dim(), hashes));
        }
        Ok(reports.into_iter().map(|report| report.0).collect())
    }

    /// One pass.
    pub(super) fn pass(&mut self, query: Query<'_>) -> Result<Found, Error> {
        self.begin_pass();
        let first = self.hash.is_none();
        let list = Mutex::new(Top::new(query.keep));
        // It only saves work: what is listed in the end does not depend on when threads see it.
        let bound = AtomicU64::new(query.above.to_bits());
        let reports = map_blocks(self.source, self.monitor, |row, rows| match rows {
            Rows::F32(points) => block(query, &list, &bound, row, &points, first),
            Rows::F64(points) => block(query, &list, &bound, row, &points, first),
        })?;
        if first {
            let hashes = reports.iter().filter_map(|report| report.hash);
            self.hash = Some(PointsHash::of_blocks(self.len(), self.dim(), hashes));
        }
        let far = list.into_inner().unwrap_or_else(PoisonError::into_inner).into_sorted();
        let listed_above = match far.last() {
            Some(last) if far.len() == query.keep => last.reach2,
            _ => query.above,
        };
        let finite = reports.iter().all(|report| report.finite);
        let largest = reports.iter().map(|report| report.largest).fold(0.0, f64::max);
        Ok(Found { largest: if finite { largest } else { f64::INFINITY }, far, listed_above })
    }
}

/// Measures a block; its far points are merged with those of the pass.
fn block<T: Scalar>(
    query: Query<'_>,
    list: &Mutex<Top>,
    bound: &AtomicU64,
    first_row: u64,
    points: &Points<'_, T>,
    first: bool,
) -> Result<BlockReport, Error> {
    let mut top = Top::new(query.keep);
    let mut scratch = vec![];
    let mut values = [0.0; ROWS_AT_ONCE];
    let mut report = BlockReport { largest: 0.0, finite: true, hash: None };
    for start in (0..points.len()).step_by(ROWS_AT_ONCE) {
        let part = points.slice(start..points.len().min(start + ROWS_AT_ONCE));
        let values = &mut values[..part.len()];
        leverages(part.values(), query.matrix, query.center, &mut scratch, values);
        let far = largest(values);
        report.finite &= all_finite(values);
        report.largest = report.largest.max(far);
        // Rows come in order, so what equals the bound of this block loses to the row that set it; what equals a
        // bound set by another block may still win by its number, and `Top` decides.
        let shared = f64::from_bits(bound.load(Ordering::Relaxed));
        let worth = |value: f64, top: &Top| value > query.above.max(top.bound()) && value >= shared;
        if !worth(far, &top) {
            continue;
        }
        for (group, values) in values.chunks(GROUP).enumerate() {
            if !worth(largest(values), &top) {
                continue;
            }
            let first = first_row + (start + group * GROUP) as u64;
            for (id, &reach2) in (first..).zip(values) {
                if worth(reach2, &top) {
                    top.offer(Far { id, reach2 });
                }
            }
        }
    }
    if first {
        let rows = T::rows(*points);
        // What is not finite among the coordinates makes a leverage that is not; large coordinates do, too.
        if !report.finite
            && let Some((row, column, value)) = rows.first_non_finite()
        {
            return Err(Error::NonFinite { row: first_row + row as u64, column, value });
        }
        report.hash = Some(hash_block(&rows));
    }
    let mut list = list.lock().unwrap_or_else(PoisonError::into_inner);
    list.merge(top);
    bound.fetch_max(list.bound().to_bits(), Ordering::Relaxed);
    Ok(report)
}
