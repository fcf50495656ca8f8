//! Passes over all points: whose leverage is largest.
//!
//! A pass is one read of the source in fixed blocks on all threads. It lists points under a total order, so the result
//! does not depend on how threads meet them. The first pass also hashes the points and refuses what is not finite.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

use taut_kernels::Center;
use taut_kernels::extremes::{all_finite, largest};
use taut_kernels::triangle::{POINTS, above, leverages};
use taut_points::parallel::ParallelSlice;
use taut_points::{
    BlockHash, Monitor, OrderBy, PointSource, Points, PointsHash, ReadError, Rows, Scalar, gather,
    hash_block, map_blocks,
};

use super::question::{Kind, Question, TakenIds};
use crate::Error;
use crate::passes::{PointsAnswer, ask_points};
use crate::top::{Far, Top};

/// Rows whose leverages are worked out before they are compared.
const ROWS_AT_ONCE: usize = 256;
/// One comparison disposes of this many leverages, where some of those at once are large.
const GROUP_SIZE: usize = 32;

/// The question that a pass answers.
#[derive(Clone, Copy)]
pub(super) struct Query<'q> {
    /// M, lower triangular by rows.
    pub(super) matrix: &'q [f64],
    /// c.
    pub(super) center: &'q Center,
    /// Only points with |M(x − c)|² above this are listed.
    pub(super) above: f64,
    pub(super) keep: usize,
}

pub(super) struct PassResult {
    /// The largest |M(x − c)|², or any lower number if none is above the threshold; infinite where a square is no `f64`.
    pub(super) largest: f64,
    /// Points above the threshold, the farthest first.
    pub(super) far: Vec<Far>,
    /// Every point beyond this is in `far`.
    pub(super) listed_above: f64,
}

/// The points of a source, as a solver sees them.
pub(crate) struct PointReader<'a> {
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

impl<'a> PointReader<'a> {
    pub(crate) fn new(
        source: &'a dyn PointSource,
        monitor: &'a Monitor<'a>,
    ) -> Result<Self, Error> {
        if source.is_empty() {
            return Err(Error::Empty);
        }
        Ok(PointReader { source, monitor, passes: 0, hash: None })
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

    /// The rows with the given numbers. Far apart, each is a wait for memory: of many coordinates on all threads.
    pub(crate) fn rows(&self, ids: &[u64]) -> Result<Vec<f64>, Error> {
        /// One task reads about this many coordinates: what is read before another thread has begun is not worth waking it.
        const TASK_VALUES: usize = 1 << 16;
        // A row waits for a cache line at least.
        let rows_of_task = TASK_VALUES.div_ceil(self.dim().max(8));
        if self.source.elsewhere().is_some() || ids.len() <= rows_of_task {
            return Ok(gather(self.source, ids)?);
        }
        let parts: Result<Vec<Vec<f64>>, ReadError> =
            ids.par_chunks(rows_of_task).map(|ids| gather(self.source, ids)).collect();
        Ok(parts?.concat())
    }

    /// The same, relative to an origin.
    pub(super) fn rows_from(&self, origin: &[f64], ids: &[u64]) -> Result<Vec<f64>, Error> {
        let mut rows = self.rows(ids)?;
        for row in rows.chunks_exact_mut(origin.len()) {
            row.iter_mut().zip(origin).for_each(|(x, o)| *x -= o);
        }
        Ok(rows)
    }

    /// Counts a pass; returns true if it is the first.
    fn begin_pass(&mut self) -> bool {
        self.passes += 1;
        self.monitor.pass(self.passes, self.len());
        self.hash.is_none()
    }

    /// One pass of another kind: calls `work` with the number of the first row and the rows of each block.
    pub(crate) fn visit<R: Send>(
        &mut self,
        work: impl Fn(u64, &[f64]) -> R + Sync,
    ) -> Result<Vec<R>, Error> {
        let first = self.begin_pass();
        let blocks = visit(self.source, self.monitor, first, work)?;
        self.keep_hash(blocks.iter().map(|block| block.1));
        Ok(blocks.into_iter().map(|block| block.0).collect())
    }

    /// Keeps the hash, if this was the first pass.
    fn keep_hash(&mut self, hashes: impl Iterator<Item = Option<BlockHash>>) {
        if self.hash.is_none() {
            let hashes = hashes.flatten();
            self.hash = Some(PointsHash::of_blocks(self.len(), self.dim(), hashes));
        }
    }

    /// One pass over points that are held elsewhere; `None` where they are not.
    pub(super) fn ask(
        &mut self,
        question: impl FnOnce() -> Question,
    ) -> Result<Option<PointsAnswer>, Error> {
        let Some(elsewhere) = self.source.elsewhere() else { return Ok(None) };
        let is_first = self.begin_pass();
        let answer = ask_points(elsewhere, self.source, question(), is_first)?;
        if is_first {
            self.hash = Some(answer.hash);
        }
        Ok(Some(answer))
    }

    pub(super) fn pass(&mut self, query: Query<'_>) -> Result<PassResult, Error> {
        let Query { matrix, center, above, keep } = query;
        let question = || Question {
            matrix: matrix.to_vec(),
            center: center.clone(),
            kind: Kind::Leverage { above, keep },
        };
        if let Some(answer) = self.ask(question)? {
            let (largest, far) = answer.leverage()?;
            return Ok(settled(query, largest, far));
        }
        let first = self.begin_pass();
        let (found, hashes) = measure(self.source, self.monitor, query, first)?;
        self.keep_hash(hashes.into_iter());
        Ok(found)
    }

    /// One pass that takes the rows with it whose |M(x − c)|² is above a threshold: of each block at most a share of its
    /// rows and a few, the farthest. `None` where a square is no `f64`.
    pub(super) fn take(
        &mut self,
        query: Query<'_>,
        share: f64,
    ) -> Result<Option<TakenRows>, Error> {
        let Query { matrix, center, above, .. } = query;
        let question = || Question {
            matrix: matrix.to_vec(),
            center: center.clone(),
            kind: Kind::Take { above, share },
        };
        if let Some(answer) = self.ask(question)? {
            let Some(TakenIds { ids, above }) = answer.taken()? else { return Ok(None) };
            let rows = self.rows(&ids)?;
            return Ok(Some(TakenRows { ids, rows: vec![rows], squares: None, above }));
        }
        let first = self.begin_pass();
        let (taken, hashes) = take(self.source, self.monitor, query, share, first)?;
        self.keep_hash(hashes.into_iter());
        Ok(taken)
    }
}

/// The hash of a block, or an error that names the first coordinate that is not finite.
fn hash_finite(first_row: u64, rows: &Rows<'_>) -> Result<BlockHash, Error> {
    rows.check_finite(first_row)?;
    Ok(hash_block(rows))
}

/// Calls `work` with the number of the first row and the rows of each block; in a first pass blocks are hashed, too.
pub(crate) fn visit<R: Send>(
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
    first: bool,
    work: impl Fn(u64, &[f64]) -> R + Sync,
) -> Result<Vec<(R, Option<BlockHash>)>, Error> {
    map_blocks(source, monitor, |row, rows| {
        let hash = if first { Some(hash_finite(row, &rows)?) } else { None };
        let result = match rows {
            Rows::F64(points) => work(row, points.values()),
            Rows::F32(points) => {
                let values: Vec<f64> = points.values().iter().map(|&v| v.into()).collect();
                work(row, &values)
            }
        };
        Ok((result, hash))
    })
}

/// The rows above a threshold, a share of each block; in a first pass blocks are hashed, too.
pub(super) fn take(
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
    query: Query<'_>,
    share: f64,
    first: bool,
) -> Result<(Option<TakenRows>, Vec<Option<BlockHash>>), Error> {
    let reports = map_blocks(source, monitor, |row, rows| match rows {
        Rows::F32(points) => take_block(query, share, row, &points, first),
        Rows::F64(points) => take_block(query, share, row, &points, first),
    })?;
    let hashes = reports.iter().map(|report| report.1).collect();
    // Growing these lists caused a quarter of the page faults of 10⁵ × 10 normal points.
    let count = reports.iter().filter_map(|(taken, _)| Some(taken.as_ref()?.ids.len())).sum();
    let mut squares = Vec::with_capacity(count);
    let (ids, rows) = (Vec::with_capacity(count), Vec::with_capacity(reports.len()));
    let mut all = TakenRows { ids, rows, squares: None, above: query.above };
    for (taken, _) in reports {
        let Some(taken) = taken else { return Ok((None, hashes)) };
        all.ids.extend(taken.ids);
        all.rows.extend(taken.rows);
        squares.extend(taken.squares.into_iter().flatten());
        all.above = all.above.max(taken.above);
    }
    all.squares = Some(squares);
    Ok((Some(all), hashes))
}

/// The result of a pass, from the points it lists, farthest first.
fn settled(query: Query<'_>, largest: f64, far: Vec<Far>) -> PassResult {
    let listed_above = match far.last() {
        Some(last) if far.len() == query.keep => last.reach2,
        _ => query.above,
    };
    PassResult { largest, far, listed_above }
}

/// Rows that a pass took with it.
pub(super) struct TakenRows {
    /// Row numbers, ascending.
    pub(super) ids: Vec<u64>,
    /// The coordinates as they are in the source, in parts: to put them together would take as long as to measure them.
    pub(super) rows: Vec<Vec<f64>>,
    /// Their |M(x − c)|², unless the pass was made elsewhere.
    pub(super) squares: Option<Vec<f64>>,
    /// No other row has an |M(x − c)|² above this.
    pub(super) above: f64,
}

/// Returns |M(x − c)|² of rows in memory, which stand in parts. The calling thread measures them: another would take about as long to wake as
/// most lists take to be measured.
pub(super) fn squares_of(dim: usize, parts: &[Vec<f64>], query: Query<'_>) -> Vec<f64> {
    let mut squares = vec![0.0; parts.iter().map(Vec::len).sum::<usize>() / dim];
    let (mut scratch, mut left) = (vec![], &mut squares[..]);
    for part in parts {
        let (of_part, rest) = left.split_at_mut(part.len() / dim);
        for (rows, squares) in part.chunks(ROWS_AT_ONCE * dim).zip(of_part.chunks_mut(ROWS_AT_ONCE))
        {
            leverages(rows, query.matrix, query.center, &mut scratch, squares);
        }
        left = rest;
    }
    squares
}

/// Returns what a pass over rows finds whose squares are known.
pub(super) fn pass_of_squares(ids: &[u64], squares: &[f64], query: Query<'_>) -> PassResult {
    let mut top = Top::new(query.keep);
    let far = ids.iter().zip(squares).map(|(&id, &reach2)| Far { id, reach2 });
    far.filter(|far| far.reach2 > query.above).for_each(|far| top.offer(far));
    let largest = if all_finite(squares) { largest(squares) } else { f64::INFINITY };
    settled(query, largest, top.into_sorted())
}

/// Measures all blocks of a source; in a first pass they are hashed, too.
pub(super) fn measure(
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
    query: Query<'_>,
    first: bool,
) -> Result<(PassResult, Vec<Option<BlockHash>>), Error> {
    let list = Mutex::new(Top::new(query.keep));
    // It only saves work: what is listed in the end does not depend on when threads see it.
    let bound = AtomicU64::new(query.above.to_bits());
    let reports = map_blocks(source, monitor, |row, rows| match rows {
        Rows::F32(points) => block(query, &list, &bound, row, &points, first),
        Rows::F64(points) => block(query, &list, &bound, row, &points, first),
    })?;
    let far = list.into_inner().unwrap_or_else(PoisonError::into_inner).into_sorted();
    let finite = reports.iter().all(|report| report.finite);
    let largest = reports.iter().map(|report| report.largest).fold(0.0, f64::max);
    let found = settled(query, if finite { largest } else { f64::INFINITY }, far);
    Ok((found, reports.into_iter().map(|report| report.hash).collect()))
}

/// This many rows of a block are taken beside its share.
const ROWS_BESIDE_SHARE: usize = 64;

/// Measures a block and takes far rows while they are near at hand.
fn take_block<T: Scalar>(
    query: Query<'_>,
    share: f64,
    first_row: u64,
    points: &Points<'_, T>,
    first: bool,
) -> Result<(Option<TakenRows>, Option<BlockHash>), Error> {
    let (mut scratch, mut values) = (vec![], [0.0; ROWS_AT_ONCE]);
    let mut bits = [0; ROWS_AT_ONCE / POINTS];
    let mut finite = true;
    let mut far: Vec<(u32, f64)> = vec![];
    for start in (0..points.len()).step_by(ROWS_AT_ONCE) {
        let part = points.slice(start..points.len().min(start + ROWS_AT_ONCE));
        let values = &mut values[..part.len()];
        leverages(part.values(), query.matrix, query.center, &mut scratch, values);
        finite &= all_finite(values);
        let bits = &mut bits[..part.len().div_ceil(POINTS)];
        above(values, query.above, bits);
        for (group, &bits) in bits.iter().enumerate() {
            let mut left = bits;
            while left != 0 {
                let i = group * POINTS + left.trailing_zeros() as usize;
                far.push(((start + i) as u32, values[i]));
                left &= left - 1;
            }
        }
    }
    let mut hash = None;
    if first {
        let rows = T::rows(*points);
        if !finite {
            rows.check_finite(first_row)?;
        }
        hash = Some(hash_block(&rows));
    }
    if !finite {
        return Ok((None, hash));
    }
    let mut none_above = query.above;
    let most = (share * points.len() as f64) as usize + ROWS_BESIDE_SHARE;
    if far.len() > most {
        // Equal values by row, so that of many copies of one point some are taken.
        let farther = |a: &(u32, f64), b: &(u32, f64)| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0));
        let (_, &mut (_, last), _) = far.select_nth_unstable_by(most - 1, farther);
        none_above = last;
        far.truncate(most);
        far.order_by_key(|(i, _)| *i);
    }
    let dim = points.dim();
    let ids = far.iter().map(|far| first_row + u64::from(far.0)).collect();
    let mut rows = Vec::with_capacity(far.len() * dim);
    for &(i, _) in &far {
        rows.extend(points.row(i as usize).iter().map(|&x| -> f64 { x.into() }));
    }
    let squares = Some(far.iter().map(|far| far.1).collect());
    let taken = TakenRows { ids, rows: vec![rows], squares, above: none_above };
    Ok((Some(taken), hash))
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
        for (group, values) in values.chunks(GROUP_SIZE).enumerate() {
            if !worth(largest(values), &top) {
                continue;
            }
            let first = first_row + (start + group * GROUP_SIZE) as u64;
            for (id, &reach2) in (first..).zip(values) {
                if worth(reach2, &top) {
                    top.offer(Far { id, reach2 });
                }
            }
        }
    }
    if first {
        let rows = T::rows(*points);
        // A coordinate that is not finite makes a leverage that is not; large coordinates do, too.
        if !report.finite {
            rows.check_finite(first_row)?;
        }
        report.hash = Some(hash_block(&rows));
    }
    let mut list = list.lock().unwrap_or_else(PoisonError::into_inner);
    list.merge(top);
    bound.fetch_max(list.bound().to_bits(), Ordering::Relaxed);
    Ok(report)
}

#[cfg(test)]
mod tests {
    use taut_points::{Distribution, generate};

    use super::*;
    use crate::{EllipsoidOptions, ellipsoid};

    /// By a pass over all rows first, and by one that takes rows for a list.
    #[test]
    fn rows_that_are_not_finite_are_named() {
        for n in [20_000, 70_000] {
            let mut values: Vec<f64> = generate(Distribution::Normal, n, 10, 5).unwrap();
            // Neither is in the sample of 4096.
            (values[123_458], values[190_003]) = (f64::NAN, f64::INFINITY);
            let narrow: Vec<f32> = values.iter().map(|&value| value as f32).collect();
            let wanted = Error::Input(taut_points::InputError::NonFinite {
                row: 12_345,
                column: 8,
                value: f64::NAN,
            });
            for threads in [1, 2] {
                let options = EllipsoidOptions { threads: Some(threads), ..Default::default() };
                let wide = ellipsoid(&Points::new(&values, 10).unwrap(), &options);
                assert_eq!(wide.unwrap_err().to_string(), wanted.to_string());
                let narrow = ellipsoid(&Points::new(&narrow, 10).unwrap(), &options);
                assert_eq!(narrow.unwrap_err().to_string(), wanted.to_string());
            }
        }
    }
}
