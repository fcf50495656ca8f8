//! Passes over all items: who reaches farthest from a center.
//!
//! *Idea.* A pass is one read of the source in fixed blocks on all threads ([`pass`]); it returns the farthest items
//! under a total order, so it does not depend on how threads meet them. The first pass also hashes the points and
//! refuses coordinates that are not finite.
//! *Scale.* Squares overflow beyond 1e154 and vanish below 1e-162. When the first pass finds itself near either end,
//! all later reads multiply by an exact power of two that brings distances to about 1, after taking away a fixed
//! point where coordinates are so large beside their differences that they would overflow. Centers, reaches
//! and rows that leave this module are in those units; [`ItemReader::scale`] says which, and [`ItemReader::outside`] leads back.

mod pass;
mod row_bounds;

use taut_certify::Items;
use taut_points::{
    InputError, Monitor, PointSource, PointsHash, exponent_of, gather, map_blocks, two_to,
};

pub(crate) use self::pass::{Found, Pass, farther};
use self::row_bounds::RowBounds;
use crate::Error;
use crate::passes::{FirstAnswer, ask_first, ask_items, ask_spread};
use crate::top::Far;
use taut_kernels::{Center, DoubleDouble};

/// The sample whose mean is the origin of a solver's calculations has this many rows.
const SAMPLE_ROWS: u64 = 256;
/// Squared distances between 2⁻⁴⁰⁰ and 2⁴⁰⁰ leave room for every product the solvers form.
const SAFE_EXPONENT: i32 = 400;

/// In fewer dimensions a row is read as fast as its bound.
const BOUNDED_DIM_MIN: usize = 33;
/// Bounds on more rows than this are not kept: they take 128 MiB, and three times that while a pass makes new ones.
const BOUNDED_ROWS_MAX: u64 = 1 << 24;

/// The question that a pass answers.
#[derive(Clone, Copy)]
pub(crate) struct Query<'c> {
    /// From where.
    pub(crate) center: &'c Center,
    /// Only items with a squared reach above this are listed.
    pub(crate) above: f64,
    pub(crate) keep: usize,
    /// List at most two items per face of the cube around the center, too, of those with a squared reach above this.
    pub(crate) by_face_above: Option<f64>,
}

pub(crate) struct PassResult {
    /// The item that reaches farthest, listed or not.
    pub(crate) farthest: Far,
    /// The items above the threshold, farthest first.
    pub(crate) far: Vec<Far>,
    /// Every item that reaches farther than this (squared) is in `far`.
    pub(crate) listed_above: f64,
    /// Where asked for: at most two items per face of the cube around the center, farthest first.
    pub(crate) by_face: Vec<Far>,
}

/// How a solver sees rows.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct View {
    pub(crate) items: Items,
    pub(crate) dim: usize,
    pub(crate) scale: f64,
    /// The vector that is subtracted from coordinates before they are scaled, if anything.
    pub(crate) shift: Vec<f64>,
}

impl View {
    /// Brings rows to the units of the solver.
    fn scale_rows(&self, rows: &mut [f64]) {
        if self.scale == 1.0 {
            return;
        }
        for row in rows.chunks_exact_mut(self.items.columns(self.dim)) {
            row.iter_mut().zip(&self.shift).for_each(|(v, shift)| *v -= shift);
            row.iter_mut().for_each(|v| *v *= self.scale);
        }
    }
}

/// The items of a source, as seen by a solver.
pub(crate) struct ItemReader<'a> {
    source: &'a dyn PointSource,
    monitor: &'a Monitor<'a>,
    view: View,
    passes: u64,
    hash: Option<PointsHash>,
    largest: Option<Far>,
    /// From the last pass, where that is of use.
    row_bounds: Option<RowBounds>,
}

impl<'a> ItemReader<'a> {
    /// Looks at the shape of the source; reads nothing yet.
    pub(crate) fn new(
        source: &'a dyn PointSource,
        items: Items,
        monitor: &'a Monitor<'a>,
    ) -> Result<Self, Error> {
        match items {
            Items::Balls if source.dim() < 2 => {
                return Err(Error::NoRadius { columns: source.dim() });
            }
            Items::Ellipsoids => {
                let (name, value) = ("inputs", "ellipsoids".into());
                return Err(Error::Input(InputError::Option {
                    name,
                    value,
                    expected: "points or balls",
                }));
            }
            Items::Points | Items::Balls => {}
        }
        if source.is_empty() {
            return Err(Error::Empty);
        }
        let dim = items.dim(source.dim());
        Ok(ItemReader {
            source,
            monitor,
            view: View { items, dim, scale: 1.0, shift: vec![] },
            passes: 0,
            hash: None,
            largest: None,
            row_bounds: None,
        })
    }

    /// Tests whether it is of use to know how far rows are at most.
    fn bounds_rows(&self) -> bool {
        self.view.items == Items::Points
            && self.view.scale == 1.0
            && self.dim() >= BOUNDED_DIM_MIN
            && self.len() <= BOUNDED_ROWS_MAX
    }

    /// Dimension of the space.
    pub(crate) fn dim(&self) -> usize {
        self.view.dim
    }

    pub(crate) fn len(&self) -> u64 {
        self.source.len()
    }

    /// Numbers in a row: coordinates, and the radius of a ball.
    pub(crate) fn columns(&self) -> usize {
        self.source.dim()
    }

    /// Tests whether this process holds all rows in its memory, and reads them there.
    pub(crate) fn is_in_memory(&self) -> bool {
        self.source.elsewhere().is_none() && self.source.in_memory().is_some()
    }

    /// Points or balls.
    pub(crate) fn items(&self) -> Items {
        self.view.items
    }

    /// The caller's monitor.
    pub(crate) fn monitor(&self) -> &'a Monitor<'a> {
        self.monitor
    }

    /// Passes made so far.
    pub(crate) fn passes(&self) -> u64 {
        self.passes
    }

    /// The exact power of two by which everything that leaves this module is multiplied.
    pub(crate) fn scale(&self) -> f64 {
        self.view.scale
    }

    /// The hash of the rows; known after the first pass.
    pub(crate) fn hash(&self) -> PointsHash {
        self.hash.expect("the first pass hashes the rows")
    }

    /// The ball with the largest radius, the first of them; known after the first pass over balls.
    pub(crate) fn largest(&self) -> Option<u64> {
        self.largest.map(|far| far.id)
    }

    /// The first pass: from the mean of a sample, after settling the scale. Returns the mean, too.
    pub(crate) fn first(&mut self, keep: usize) -> Result<(Center, PassResult), Error> {
        let center = self.sample_mean()?;
        let query = Query { center: &center, above: 0.0, keep, by_face_above: None };
        match self.first_from(query)? {
            Some(found) => Ok((center, found)),
            None => self.pass_from_mean(keep),
        }
    }

    /// A pass from the mean of a sample. Returns the mean, too.
    pub(crate) fn pass_from_mean(&mut self, keep: usize) -> Result<(Center, PassResult), Error> {
        let center = self.sample_mean()?;
        let query = Query { center: &center, above: 0.0, keep, by_face_above: None };
        let found = self.farthest(query)?;
        Ok((center, found))
    }

    /// The first pass as another pass; `None` after a change of scale, in which nothing that it found holds.
    pub(crate) fn first_from(&mut self, query: Query<'_>) -> Result<Option<PassResult>, Error> {
        self.begin_pass();
        let answer = match self.source.elsewhere() {
            Some(elsewhere) => ask_first(elsewhere, self.source, &self.view, query)?,
            None => {
                let mut pass = Pass::new(&self.view, query, 0);
                if self.bounds_rows() {
                    pass = pass.telling_distances(None);
                }
                let mut report = pass.first(self.source, self.monitor)?;
                let distances = std::mem::take(&mut report.distances);
                self.row_bounds =
                    (!distances.is_empty()).then(|| RowBounds::new(query.center, distances));
                let (n, columns) = (self.source.len(), self.source.dim());
                let hash = PointsHash::of_blocks(n, columns, report.hashes);
                let (found, largest) = (report.found, report.largest);
                FirstAnswer { found, hash, largest, overflow: report.overflow }
            }
        };
        self.hash = Some(answer.hash);
        self.largest = answer.largest;
        let found = answer.found.settle(query);
        let safe = exponent_of(found.farthest.reach2).abs() <= SAFE_EXPONENT && !answer.overflow;
        let is_settled = safe || !self.choose_scale(query.center)?;
        if self.view.scale != 1.0 {
            self.row_bounds = None;
        }
        Ok(is_settled.then_some(found))
    }

    pub(crate) fn farthest(&mut self, query: Query<'_>) -> Result<PassResult, Error> {
        self.begin_pass();
        let found = match self.source.elsewhere() {
            Some(elsewhere) => ask_items(elsewhere, self.source, &self.view, query)?,
            None if self.bounds_rows() => self.farthest_of_those_read(query)?,
            None => Pass::new(&self.view, query, 0).run(self.source, self.monitor)?,
        };
        Ok(found.settle(query))
    }

    /// A pass that leaves out the rows that cannot be above what is asked for.
    fn farthest_of_those_read(&mut self, query: Query<'_>) -> Result<Found, Error> {
        let bounds = self.row_bounds.take();
        let above = query.by_face_above.map_or(query.above, |above| above.min(query.above));
        let known = bounds.as_ref().map(|bounds| bounds.from(query.center, above));
        let pass = Pass::new(&self.view, query, 0).telling_distances(known);
        let (found, distances) = pass.run_with_distances(self.source, self.monitor)?;
        if known.is_some() && found.farthest.reach2 <= above {
            // Of rows that were not read, all that is known is that they are not above: now all of them are read.
            self.begin_pass();
            return self.farthest_of_those_read(query);
        }
        self.row_bounds = Some(RowBounds::new(query.center, distances));
        Ok(found)
    }

    fn begin_pass(&mut self) {
        self.passes += 1;
        self.monitor.pass(self.passes, self.len());
    }

    /// The mean of up to 256 rows at equal distances: an origin near the middle of the points.
    fn sample_mean(&self) -> Result<Center, Error> {
        let count = SAMPLE_ROWS.min(self.len());
        let ids = self.sample_ids(count);
        let columns = self.source.dim();
        // Divided first, so that the sum cannot overflow. A power of two, which the count mostly is, divides as its inverse multiplies, to the
        // last bit and in a third of the time.
        let inverse = (count as f64).recip();
        let share = |value: f64| {
            if count.is_power_of_two() { value * inverse } else { value / count as f64 }
        };
        let (mut mean, mut first_shares) = (vec![], vec![]);
        // A copy of few rows stays in the cache. Other sources are asked once for all.
        let rows_at_once = if self.is_in_memory() { 32 } else { ids.len() };
        for ids in ids.chunks(rows_at_once) {
            let rows = self.rows(ids)?;
            if mean.is_empty() {
                mean.extend_from_slice(&rows[..self.view.dim]);
                first_shares.extend(mean.iter().map(|&value| share(value)));
            }
            for row in rows.chunks_exact(columns) {
                for ((mean, &value), first) in mean.iter_mut().zip(row).zip(&first_shares) {
                    // From the first row on, so that the mean of equal coordinates is that coordinate, to the last bit.
                    *mean += share(value) - first;
                }
            }
        }
        Ok(Center { high: mean, low: vec![] })
    }

    /// So many rows at equal distances, in the units of this reader.
    pub(crate) fn sample(&self, count: u64) -> Result<Vec<f64>, Error> {
        self.rows(&self.sample_ids(count))
    }

    fn sample_ids(&self, count: u64) -> Vec<u64> {
        (0..count).map(|k| k * (self.len() / count)).collect()
    }

    /// A pass for the largest |xⱼ − cⱼ|, and the scale from it; false when all items are one point.
    fn choose_scale(&mut self, center: &Center) -> Result<bool, Error> {
        self.begin_pass();
        let (spread, largest) = match self.source.elsewhere() {
            Some(elsewhere) => ask_spread(elsewhere, self.source, &self.view, center)?,
            None => spread(self.source, &self.view, center, self.monitor)?,
        };
        if spread == 0.0 {
            return Ok(false);
        }
        self.view.scale = two_to((-exponent_of(spread)).clamp(-1000, 1000));
        if exponent_of(largest) > SAFE_EXPONENT + exponent_of(spread) {
            self.view.shift = center.high.clone();
        }
        Ok(true)
    }

    /// The rows with the given numbers, in the units of this reader: n × d, or n × (d + 1) with the radius.
    pub(crate) fn rows(&self, ids: &[u64]) -> Result<Vec<f64>, Error> {
        let mut rows = self.rows_as_given(ids)?;
        self.view.scale_rows(&mut rows);
        Ok(rows)
    }

    /// The rows with the given numbers, as they are in the source.
    pub(crate) fn rows_as_given(&self, ids: &[u64]) -> Result<Vec<f64>, Error> {
        Ok(gather(self.source, ids)?)
    }

    /// A center in the units of this reader as one or two terms in those of the source.
    pub(crate) fn outside(&self, center: &Center) -> Center {
        if self.view.scale == 1.0 {
            return center.clone();
        }
        let mut outside = Center { high: vec![], low: vec![] };
        for (j, &high) in center.high.iter().enumerate() {
            let low = center.low.get(j).copied().unwrap_or(0.0);
            let shift = self.view.shift.get(j).copied().unwrap_or(0.0);
            let sum =
                DoubleDouble::sum(high / self.view.scale, low / self.view.scale) + shift.into();
            outside.high.push(sum.high);
            outside.low.push(sum.low);
        }
        if outside.low.iter().all(|&low| low == 0.0) {
            outside.low.clear();
        }
        outside
    }

    /// A center in the units of the source, brought to those of this reader; the inverse of [`outside`](Self::outside).
    pub(crate) fn inside(&self, center: &Center) -> Center {
        if self.view.scale == 1.0 {
            return center.clone();
        }
        let mut inside = Center { high: vec![], low: vec![] };
        for (j, &high) in center.high.iter().enumerate() {
            let low = center.low.get(j).copied().unwrap_or(0.0);
            let shift = self.view.shift.get(j).copied().unwrap_or(0.0);
            let sum = DoubleDouble::sum(high, -shift) + low.into();
            inside.high.push(sum.high * self.view.scale);
            inside.low.push(sum.low * self.view.scale);
        }
        if inside.low.iter().all(|&low| low == 0.0) {
            inside.low.clear();
        }
        inside
    }
}

/// The largest |xⱼ − cⱼ| or radius, and the largest coordinate.
pub(crate) fn spread(
    source: &dyn PointSource,
    view: &View,
    center: &Center,
    monitor: &Monitor<'_>,
) -> Result<(f64, f64), Error> {
    let spreads = map_blocks(source, monitor, |_, rows| {
        let mut row = vec![0.0; source.dim()];
        let (mut spread, mut largest) = (0.0f64, 0.0f64);
        for i in 0..rows.len() {
            rows.copy_row(i, &mut row);
            for (x, c) in row.iter().zip(&center.high) {
                // May overflow to ∞, which asks for the same scale as the largest number.
                spread = spread.max((x - c).abs());
                largest = largest.max(x.abs());
            }
            if view.items == Items::Balls {
                spread = spread.max(row[view.dim]);
            }
        }
        Ok::<_, Error>((spread, largest))
    })?;
    Ok(spreads.into_iter().fold((0.0, 0.0), |a, b| (a.0.max(b.0), a.1.max(b.1))))
}
