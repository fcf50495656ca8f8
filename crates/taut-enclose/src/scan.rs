//! Passes over all items: who reaches farthest from a centre.
//!
//! *Idea.* A pass is one read of the source in fixed blocks on all threads; it returns the farthest items under a
//! total order, so it does not depend on how threads meet them. The first pass also hashes the points and refuses
//! coordinates that are not finite.
//! *Scale.* Squares overflow beyond 1e154 and vanish below 1e-162. When the first pass finds itself near either end,
//! all later reads multiply by an exact power of two that brings the points to about 1. Centres, reaches and rows
//! that leave this module are in those units; [`Scan::scale`] says which.

use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use taut_certify::Items;
use taut_points::{
    BlockHash, Monitor, PointSource, Points, PointsHash, Rows, Scalar, gather, hash_block,
    map_blocks,
};

use crate::Error;
use crate::kernel::{Center, squared_distances};
use crate::top::{Face, Far, Top, TopByFace};

/// Rows whose distances are worked out before they are compared: 4 KiB of results.
const ROWS_AT_ONCE: usize = 512;
/// Rows of the sample whose mean is the origin of a solver's calculations.
const SAMPLE: u64 = 256;
/// Squared distances between 2⁻⁴⁰⁰ and 2⁴⁰⁰ leave room for every product the solvers form.
const SAFE_EXPONENT: i32 = 400;

/// What a pass is to look for.
pub(crate) struct Query<'c> {
    /// From where.
    pub(crate) center: &'c Center,
    /// Only items with a squared reach above this are listed.
    pub(crate) above: f64,
    /// How many of them at most.
    pub(crate) keep: usize,
    /// List at most two items per face of the cube around the centre, too, of those with a squared reach above this.
    pub(crate) by_face_above: Option<f64>,
}

/// What a pass found.
pub(crate) struct Found {
    /// The item that reaches farthest, listed or not.
    pub(crate) farthest: Far,
    /// The items above the threshold, farthest first.
    pub(crate) far: Vec<Far>,
    /// Every item that reaches farther than this (squared) is in `far`.
    pub(crate) listed_above: f64,
    /// Where asked for: at most two items per face of the cube around the centre, farthest first.
    pub(crate) by_face: Vec<Far>,
}

/// The items of a source, as seen by a solver.
pub(crate) struct Scan<'a> {
    source: &'a dyn PointSource,
    items: Items,
    monitor: &'a Monitor<'a>,
    dim: usize,
    scale: f64,
    passes: u64,
    hash: Option<PointsHash>,
    largest: Option<Far>,
}

/// What one block adds to the first pass.
struct BlockReport {
    farthest: Far,
    hash: Option<BlockHash>,
    /// The largest radius, as a reach; balls only.
    largest: Option<Far>,
    overflow: bool,
}

impl<'a> Scan<'a> {
    /// Looks at the shape of the source; reads nothing yet.
    pub(crate) fn new(
        source: &'a dyn PointSource,
        items: Items,
        monitor: &'a Monitor<'a>,
    ) -> Result<Self, Error> {
        if items == Items::Balls && source.dim() < 2 {
            return Err(Error::NoRadius { columns: source.dim() });
        }
        if source.is_empty() {
            return Err(Error::Empty);
        }
        let dim = items.dim(source.dim());
        Ok(Scan { source, items, monitor, dim, scale: 1.0, passes: 0, hash: None, largest: None })
    }

    /// Dimension of the space.
    pub(crate) fn dim(&self) -> usize {
        self.dim
    }

    /// Number of items.
    pub(crate) fn len(&self) -> u64 {
        self.source.len()
    }

    /// Points or balls.
    pub(crate) fn items(&self) -> Items {
        self.items
    }

    /// Passes made so far.
    pub(crate) fn passes(&self) -> u64 {
        self.passes
    }

    /// The exact power of two by which everything that leaves this module is multiplied.
    pub(crate) fn scale(&self) -> f64 {
        self.scale
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
    pub(crate) fn first(&mut self, keep: usize) -> Result<(Center, Found), Error> {
        let center = self.sample_mean()?;
        let (found, overflow) =
            self.pass(&Query { center: &center, above: 0.0, keep, by_face_above: None }, true)?;
        let exponent = exponent(found.farthest.reach2);
        if !overflow && found.farthest.reach2 > 0.0 && exponent.abs() <= SAFE_EXPONENT {
            return Ok((center, found));
        }
        if !self.choose_scale(&center)? {
            return Ok((center, found));
        }
        let center = self.sample_mean()?;
        let found =
            self.farthest(&Query { center: &center, above: 0.0, keep, by_face_above: None })?;
        Ok((center, found))
    }

    /// One pass.
    pub(crate) fn farthest(&mut self, query: &Query<'_>) -> Result<Found, Error> {
        Ok(self.pass(query, false)?.0)
    }

    fn pass(&mut self, query: &Query<'_>, first: bool) -> Result<(Found, bool), Error> {
        self.passes += 1;
        self.monitor.pass(self.passes, self.len());
        let top = Mutex::new((Top::new(query.keep), TopByFace::default()));
        let bound = AtomicU64::new(query.above.to_bits());
        let this = &*self;
        let reports = map_blocks(self.source, self.monitor, |row, rows| match rows {
            Rows::F32(points) => this.block(row, &points, query, first, &top, &bound),
            Rows::F64(points) => this.block(row, &points, query, first, &top, &bound),
        })?;
        let mut farthest = reports[0].farthest;
        for report in &reports {
            if report.farthest.reach2 > farthest.reach2 {
                farthest = report.farthest;
            }
        }
        let overflow = reports.iter().any(|report| report.overflow);
        if first {
            let hashes = reports.iter().filter_map(|report| report.hash);
            self.hash = Some(PointsHash::of_blocks(self.len(), self.source.dim(), hashes));
            self.largest = reports
                .iter()
                .filter_map(|r| r.largest)
                .reduce(|a, b| if b.reach2 > a.reach2 { b } else { a });
        }
        let (top, by_face) = top.into_inner().expect("no thread panics while it holds the list");
        let far = top.into_sorted();
        let listed_above = match far.last() {
            Some(last) if far.len() == query.keep => last.reach2,
            _ => query.above,
        };
        Ok((
            Found { farthest, far, listed_above, by_face: by_face.into_sorted(query.keep) },
            overflow,
        ))
    }

    /// The part of a pass that one block is.
    fn block<T: Scalar>(
        &self,
        first_row: u64,
        points: &Points<'_, T>,
        query: &Query<'_>,
        first: bool,
        top: &Mutex<(Top, TopByFace)>,
        bound: &AtomicU64,
    ) -> Result<BlockReport, Error> {
        if self.scale != 1.0 {
            // Rare and not worth a kernel of its own: scale the block, then go on as usual.
            let scaled: Vec<f64> = points.values().iter().map(|&v| v.into() * self.scale).collect();
            let scaled =
                Points::new(&scaled, points.dim()).expect("the shape is that of the block");
            return self.block_at_scale(first_row, &scaled, query, first, top, bound);
        }
        self.block_at_scale(first_row, points, query, first, top, bound)
    }

    fn block_at_scale<T: Scalar>(
        &self,
        first_row: u64,
        points: &Points<'_, T>,
        query: &Query<'_>,
        first: bool,
        top: &Mutex<(Top, TopByFace)>,
        bound: &AtomicU64,
    ) -> Result<BlockReport, Error> {
        let mut report = BlockReport {
            farthest: Far { id: first_row, reach2: 0.0 },
            hash: first.then(|| hash_block(&T::rows(*points))),
            largest: None,
            overflow: false,
        };
        let mut here = Top::new(query.keep);
        let mut faces = TopByFace::default();
        let mut reaches = [0.0; ROWS_AT_ONCE];
        for start in (0..points.len()).step_by(ROWS_AT_ONCE) {
            let part = points.slice(start..points.len().min(start + ROWS_AT_ONCE));
            let reaches = &mut reaches[..part.len()];
            squared_distances(part.values(), part.dim(), query.center, reaches);
            if self.items == Items::Balls {
                add_radii(&part, reaches);
            }
            let base = first_row + start as u64;
            if first {
                self.inspect(base, &part, reaches, &mut report)?;
            }
            // Rows come in order, so what equals the bound of this block loses to the row that set it; what equals a
            // bound set by another block may still win by its number, and `Top` decides.
            let shared = f64::from_bits(bound.load(Ordering::Relaxed));
            let worth = |reach2: f64, here: &Top| {
                reach2 > query.above.max(here.bound()) && reach2 >= shared
            };
            let face_above = query.by_face_above.unwrap_or(f64::INFINITY);
            for (group, chunk) in reaches.chunks(64).enumerate() {
                let farthest = largest(chunk);
                if farthest > report.farthest.reach2 {
                    let at = chunk.iter().position(|&v| v == farthest).expect("it is one of them");
                    report.farthest = Far { id: base + (group * 64 + at) as u64, reach2: farthest };
                }
                if !worth(farthest, &here) && farthest <= face_above {
                    continue;
                }
                for (at, &reach2) in chunk.iter().enumerate() {
                    let row = group * 64 + at;
                    let far = Far { id: base + row as u64, reach2 };
                    if worth(reach2, &here) {
                        here.offer(far);
                    }
                    if reach2 > face_above {
                        faces.offer(face(&part.row(row)[..self.dim], query.center), far);
                    }
                }
            }
        }
        let mut shared = top.lock().expect("no thread panics while it holds the list");
        shared.0.merge(here);
        shared.1.merge(faces);
        bound.fetch_max(shared.0.bound().to_bits(), Ordering::Relaxed);
        Ok(report)
    }

    /// What only the first pass looks at: finite coordinates, radii, and whether squares overflow.
    fn inspect<T: Scalar>(
        &self,
        first_row: u64,
        points: &Points<'_, T>,
        reaches: &[f64],
        report: &mut BlockReport,
    ) -> Result<(), Error> {
        let finite = reaches.iter().fold(true, |all, v| all & v.is_finite());
        if !finite {
            if let Some((row, column, value)) = T::rows(*points).first_non_finite() {
                return Err(Error::NonFinite { row: first_row + row as u64, column, value });
            }
            report.overflow = true;
        }
        if self.items == Items::Balls {
            for (id, ball) in (first_row..).zip(points.rows()) {
                let radius: f64 = ball[self.dim].into();
                if radius < 0.0 {
                    return Err(Error::NegativeRadius { row: id, value: radius });
                }
                if report.largest.is_none_or(|largest| radius > largest.reach2) {
                    report.largest = Some(Far { id, reach2: radius });
                }
            }
        }
        Ok(())
    }

    /// The mean of up to 256 rows at equal distances: an origin near the middle of the points.
    fn sample_mean(&self) -> Result<Center, Error> {
        let count = SAMPLE.min(self.len());
        let ids: Vec<u64> = (0..count).map(|k| k * (self.len() / count)).collect();
        let mut mean = vec![0.0; self.dim];
        for row in gather(self.source, &ids)?.chunks_exact(self.source.dim()) {
            for (mean, value) in mean.iter_mut().zip(row) {
                // Divided first, so that the sum cannot overflow.
                *mean += value / count as f64 * self.scale;
            }
        }
        Ok(Center { high: mean, low: vec![] })
    }

    /// A pass for the largest |xⱼ − cⱼ|, and the scale from it; false when all items are one point.
    fn choose_scale(&mut self, center: &Center) -> Result<bool, Error> {
        self.passes += 1;
        self.monitor.pass(self.passes, self.len());
        let dim = self.dim;
        let spreads = map_blocks(self.source, self.monitor, |_, rows| {
            let mut row = vec![0.0; self.source.dim()];
            let mut largest = 0.0f64;
            for i in 0..rows.len() {
                rows.copy_row(i, &mut row);
                for (x, c) in row.iter().zip(&center.high) {
                    // May overflow to ∞, which asks for the same scale as the largest number.
                    largest = largest.max((x - c).abs());
                }
                if self.items == Items::Balls {
                    largest = largest.max(row[dim]);
                }
            }
            Ok::<_, Error>(largest)
        })?;
        let spread = spreads.into_iter().fold(0.0, f64::max);
        if spread == 0.0 {
            return Ok(false);
        }
        self.scale = 2f64.powi((-exponent(spread)).clamp(-1000, 1000));
        Ok(true)
    }

    /// The rows with the given numbers, in the units of this scan: n × (d, or d + 1 with the radius).
    pub(crate) fn rows(&self, ids: &[u64]) -> Result<Vec<f64>, Error> {
        let mut rows = gather(self.source, ids)?;
        if self.scale != 1.0 {
            rows.iter_mut().for_each(|v| *v *= self.scale);
        }
        Ok(rows)
    }
}

/// The exponent of the leading bit: 2ᵉ ≤ |value| < 2ᵉ⁺¹; that of the smallest `f64` for 0, of the largest for ∞.
fn exponent(value: f64) -> i32 {
    if value == 0.0 { -1074 } else { value.abs().min(f64::MAX).log2().floor() as i32 }
}

/// Turns |x − c|² into (|x − c| + r)², the radius r being the last value of each row.
fn add_radii<T: Scalar>(balls: &Points<'_, T>, reaches: &mut [f64]) {
    for (reach2, ball) in reaches.iter_mut().zip(balls.rows()) {
        let reach = reach2.sqrt() + ball[balls.dim() - 1].into();
        *reach2 = reach * reach;
    }
}

/// The largest value, by eight running maxima; values that are not numbers are passed over.
fn largest(values: &[f64]) -> f64 {
    let mut lanes = [0.0f64; 8];
    let (chunks, rest) = values.as_chunks::<8>();
    for chunk in chunks {
        for (lane, &value) in lanes.iter_mut().zip(chunk) {
            *lane = if value > *lane { value } else { *lane };
        }
    }
    lanes.iter().chain(rest).fold(0.0, |m, &v| if v > m { v } else { m })
}

fn face<T: Scalar>(row: &[T], center: &Center) -> Face {
    let mut face = (0, false);
    let mut largest = -1.0;
    for (j, (&x, &c)) in row.iter().zip(&center.high).enumerate() {
        let difference = x.into() - c;
        if difference.abs() > largest {
            largest = difference.abs();
            face = (j, difference < 0.0);
        }
    }
    face
}
