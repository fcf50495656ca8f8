//! Centers of points that come by once, and centers of points that are in many places.
//!
//! *Problem.* Few centers near all points, and a bound on how much nearer others could be, when the points are read once, a
//! block at a time ([`StreamingCenters`]), or each part of them where it lies ([`CoreSetSummary`]).
//! *Idea of the stream.* An instance guesses a radius r and keeps points that are more than 2r apart; what is nearer to one of them
//! is counted as its own. When there are more than k, no k balls of radius r hold them: the guess grows by a factor α, and of
//! the points kept those go that are now too near to others. m instances, with guesses between each other, share the stream.
//! *Guarantee.* Whatever is dropped is within 2r + 2r/α + 2r/α² + … < 2rα/(α − 1) of a point kept, and of all instances
//! the one with the smallest guess is at most a factor α^(1/m) above a guess that failed: at most 2α^(1+1/m)/(α − 1)
//! times the optimum, which α = m + 1 makes smallest. One instance is the doubling algorithm and has 8.
//! *Trap.* What is counted as covered was never measured against the center it now has; the radius of a [`StreamingCenters`] is a sum of
//! distances, an upper bound. One more pass measures it.
//! *Reference.* Charikar, Chekuri, Feder and Motwani, SIAM J. Comput. 33(6), 2004 (doubling); McCutchen and Khuller, APPROX 2008,
//! and Guha, ICDT 2009 (instances in parallel).

mod core_set_summary;
mod cover_bytes;
mod instance;
mod measure;

use taut_certify::{Centers, Placement, Solution, Stop, Trace};
use taut_points::parallel::ParallelSlice;
use taut_points::{
    Blocks, InputError, Monitor, PointSource, Points, ReadError, Rows, Scalar, Scratch,
};

use crate::separated_set::{SeparatedSet, rounded_up};
use crate::{CentersMethod, Error};
pub use core_set_summary::CoreSetSummary;
use instance::{Instance, distance, least_distance};
use measure::measure;
pub(crate) use measure::{Reach, nearest_squares};

/// Options to cover a stream. Write `StreamingOptions { instances: 1 }`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StreamingOptions {
    /// Guesses of the radius that are kept at a time, m. Memory and time are proportional to it, and the factor falls from
    /// 8 with one to 2.96 with eight, 2.54 with 16, 2.17 with 64. From 1 to 1000, default 8.
    pub instances: usize,
}

impl Default for StreamingOptions {
    fn default() -> Self {
        StreamingOptions::DEFAULT
    }
}

impl StreamingOptions {
    /// The value of [`Default`].
    pub const DEFAULT: Self = StreamingOptions { instances: 8 };

    /// The factor that is proved beforehand, 2(m + 1)^(1 + 1/m)/m: the radius of a [`StreamingCenters`] is never more than this times its
    /// lower bound, to rounding.
    pub fn factor(&self) -> f64 {
        let m = self.instances as f64;
        2.0 * (m + 1.0).powf(1.0 + 1.0 / m) / m
    }
}

/// The report about a stream so far.
#[derive(Clone, Debug, PartialEq)]
pub struct StreamingReport {
    /// At most k points of the stream.
    pub centers: Vec<Vec<f64>>,
    /// Their rows.
    pub rows: Vec<u64>,
    /// Each point that came by is at most this far from one of them.
    pub radius: f64,
    /// No k balls of a smaller radius hold the points that came by.
    pub lower_bound: f64,
    /// The rows that prove it: k + 1 of which no two are nearer than twice the bound. None where the bound is 0.
    pub separated: Vec<u64>,
}

/// k centers of a stream of points, at any moment, in memory for m(k + 1) points.
///
/// The blocks may be of any size: the same rows in the same order give the same answer.
///
/// ```
/// use taut_enclose::{StreamingCenters, StreamingOptions};
/// use taut_points::Points;
///
/// let options = StreamingOptions::default();
/// let mut cover = StreamingCenters::new(2, 3, &options)?;
/// for step in 0..1000 {
///     let angle = f64::from(step);
///     cover.add(&Points::new(&[angle.cos(), angle.sin()], 2)?)?;
/// }
/// let found = cover.covered();
/// assert!(found.centers.len() <= 3 && found.separated.len() == 4);
/// assert!(found.radius <= options.factor() * found.lower_bound * (1.0 + 1e-9));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct StreamingCenters {
    dim: usize,
    k: usize,
    options: StreamingOptions,
    seen: u64,
    /// The first points that differ, up to k of them; empty once there are instances.
    first: Vec<f64>,
    first_rows: Vec<u64>,
    instances: Vec<Instance>,
    /// The best proof so far.
    separated: SeparatedSet,
}

impl StreamingCenters {
    /// Nothing seen yet.
    ///
    /// # Errors
    /// [`Error::Input`] when `dim`, `k` or an option is out of range.
    pub fn new(dim: usize, k: usize, options: &StreamingOptions) -> Result<Self, Error> {
        let wrong = |name, value: usize, expected| {
            Err(Error::Input(InputError::Option { name, value: value.to_string(), expected }))
        };
        if dim == 0 {
            return wrong("dim", dim, "at least 1");
        }
        if k == 0 {
            return wrong("k", k, "at least 1");
        }
        if !(1..=1000).contains(&options.instances) {
            return wrong("instances", options.instances, "from 1 to 1000");
        }
        Ok(StreamingCenters {
            dim,
            k,
            options: *options,
            seen: 0,
            first: vec![],
            first_rows: vec![],
            instances: vec![],
            separated: SeparatedSet::default(),
        })
    }

    /// Returns how many points came by.
    pub fn len(&self) -> u64 {
        self.seen
    }

    /// Returns the coordinates that a point has.
    pub fn dim(&self) -> usize {
        self.dim
    }

    /// Returns true if none has.
    pub fn is_empty(&self) -> bool {
        self.seen == 0
    }

    /// The next points; they are numbered on from those before. O(mkd) for each.
    ///
    /// # Errors
    /// [`Error::Input`] when the points have another dimension, [`Error::Input`] with the number of the row in the stream:
    /// then none of these points is counted. [`Error::Overflow`] when a distance is beyond the largest `f64` or smaller than
    /// the normal ones: then this cover is of no more use.
    pub fn add<T: Scalar>(&mut self, points: &Points<'_, T>) -> Result<(), Error> {
        self.add_while(points, &Monitor::silent())
    }

    /// The next points, all those of a source.
    ///
    /// # Errors
    /// As [`add`](Self::add), but blocks before the one with an error are counted; [`Error::Input`] when the source fails or the monitor stops
    /// the work.
    pub fn add_source(
        &mut self,
        source: &dyn PointSource,
        monitor: &Monitor<'_>,
    ) -> Result<(), Error> {
        let (blocks, mut scratch) = (Blocks::of(source), Scratch::new());
        for block in 0..blocks.count() {
            monitor.check().map_err(ReadError::from)?;
            let rows = source.read(blocks.range(block), &mut scratch)?;
            match &rows {
                Rows::F32(points) => self.add_while(points, monitor)?,
                Rows::F64(points) => self.add_while(points, monitor)?,
            }
            monitor.points(rows.len() as u64);
        }
        Ok(())
    }

    /// The same, as long as the monitor lets it.
    fn add_while<T: Scalar>(
        &mut self,
        points: &Points<'_, T>,
        monitor: &Monitor<'_>,
    ) -> Result<(), Error> {
        if points.dim() != self.dim {
            return Err(Error::Input(InputError::Option {
                name: "points",
                value: format!("of dimension {}", points.dim()),
                expected: "points of the dimension that the cover was made for",
            }));
        }
        T::rows(*points).check_finite(self.seen)?;
        let mut taken = 0;
        while self.instances.is_empty() && taken < points.len() {
            let row: Vec<f64> = points.row(taken).iter().map(|&v| v.into()).collect();
            self.begin(row, monitor)?;
            taken += 1;
        }
        let rest = points.slice(taken..points.len());
        let first_row = self.seen;
        let failed = self
            .instances
            .par_iter_mut()
            .map(|instance| instance.add(first_row, &rest, monitor))
            .collect::<Vec<_>>();
        for separated in failed {
            self.take(separated?);
        }
        self.seen += rest.len() as u64;
        Ok(())
    }

    /// One of the first points: kept if it differs from all before; the k + 1st begins the instances.
    fn begin(&mut self, row: Vec<f64>, monitor: &Monitor<'_>) -> Result<(), Error> {
        monitor.check().map_err(ReadError::from)?;
        let number = self.seen;
        self.seen += 1;
        if self.first.chunks_exact(self.dim).any(|known| known == row) {
            return Ok(());
        }
        self.first.extend(row);
        self.first_rows.push(number);
        if self.first_rows.len() <= self.k {
            return Ok(());
        }
        let (first, rows) = (std::mem::take(&mut self.first), std::mem::take(&mut self.first_rows));
        let least = least_distance(&first, self.dim, monitor)?;
        if !(f64::MIN_POSITIVE * 4.0..).contains(&least) {
            return Err(Error::Overflow);
        }
        self.take(SeparatedSet { rows: rows.clone(), distance: least });
        let m = self.options.instances;
        let ratio = m as f64 + 1.0;
        for i in 1..=m {
            let guess = least / 2.0 * ratio.powf(i as f64 / m as f64);
            let (k, dim) = (self.k, self.dim);
            let instance = Instance::new(k, dim, ratio, guess, &first, &rows, monitor)?;
            self.instances.push(instance);
        }
        Ok(())
    }

    /// Keeps the better proof, the earlier of two that are equal.
    fn take(&mut self, separated: SeparatedSet) {
        if separated.distance > self.separated.distance {
            self.separated = separated;
        }
    }

    /// The best centers for the points that came by so far.
    pub fn covered(&self) -> StreamingReport {
        let best = self.instances.iter().reduce(|a, b| if b.radius() < a.radius() { b } else { a });
        let (flat, rows, radius) = match best {
            Some(best) => (best.centers(), best.rows(), best.radius()),
            None => (&self.first[..], &self.first_rows[..], 0.0),
        };
        StreamingReport {
            centers: flat.chunks_exact(self.dim).map(<[f64]>::to_vec).collect(),
            rows: rows.to_vec(),
            radius,
            lower_bound: self.separated.bound(self.dim),
            separated: self.separated.rows.clone(),
        }
    }

    /// The best centers with their true radius and a certificate: one pass over `source`, which holds the points that came by,
    /// in the same order.
    ///
    /// # Errors
    /// [`Error::Input`] when `source` has another shape than the points that came by; [`Error::Empty`],
    /// [`Error::Input`], [`Error::Overflow`], [`Error::Input`].
    pub fn solution(
        &self,
        placement: Placement,
        source: &dyn PointSource,
        monitor: &Monitor<'_>,
    ) -> Result<Solution<Centers>, Error> {
        if (source.len(), source.dim()) != (self.seen, self.dim) {
            return Err(Error::Input(InputError::Option {
                name: "source",
                value: format!("{} points of dimension {}", source.len(), source.dim()),
                expected: "the points that the cover has seen",
            }));
        }
        let found = self.covered();
        let measured = measure(source, &found.centers, monitor)?;
        let trace = Trace {
            method: CentersMethod::Stream(self.options).name().into(),
            stop: Stop::Converged,
            passes: 1 + measured.passes,
            iterations: 0,
            core_set: found.separated.len() as u64,
            history: vec![],
            counters: [("instances".to_owned(), self.options.instances as u64)].into(),
        };
        let answer = Centers {
            centers: found.centers,
            rows: if placement == Placement::Rows { found.rows } else { vec![] },
            radius: measured.radius,
            lower_bound: 0.0,
            outliers: vec![],
            assignment: vec![],
        };
        let k = self.k as u64;
        self.separated.clone().prove(answer, k, placement, measured.points_hash, trace)
    }
}

/// k centers of a source in two passes: one for a [`StreamingCenters`], one to measure its radius.
pub(crate) fn centers_in_two_passes(
    source: &dyn PointSource,
    k: usize,
    placement: Placement,
    options: &StreamingOptions,
    monitor: &Monitor<'_>,
) -> Result<Solution<Centers>, Error> {
    let mut cover = StreamingCenters::new(source.dim(), k, options)?;
    monitor.pass(1, source.len());
    cover.add_source(source, monitor)?;
    cover.solution(placement, source, monitor)
}
